// SPDX-License-Identifier: MIT
/// @file
/// The program around the picture of a scene: lesson_app.hpp's, with a pool of threads and
/// `--explain`.
#pragma once

#include <string>
#include <utility>

#include "10_threading/thread_options.hpp"
#include "11_scenes/explain.hpp"
#include "11_scenes/scene_assets.hpp"
#include "11_scenes/scene_camera.hpp"
#include "common/app/lesson_app.hpp"

namespace rasterbook {

/// Runs a lesson of scenes: reads the command line and the model, renders, writes the picture.
///
/// @tparam Options  Derived from SceneRendererOptions.
/// @param render    Called as render(const Options&, const SceneAssets&, Workers&,
///                  StepClock&).
template <typename Options, typename Render>
int run_scene_lesson(int argc, char** argv, std::string name, std::string title, Render render) {
    return run_lesson<Options>(
        argc, argv, std::move(name), std::move(title), make_scene_assets<Options>,
        [render](const Options& options, const SceneAssets& assets) {
            StepClock clock;
            Image<vec3> picture =
                render(options, assets, kept_pool(options.threads.threads), clock);
            if (options.scene.explain)
                explain(assets.scene, assets.plan, camera_of_picture(options, assets.scene).name,
                        lights_in_words(assets.lit_by, assets.plan), clock);
            return picture;
        });
}

}  // namespace rasterbook
