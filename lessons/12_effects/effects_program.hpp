// SPDX-License-Identifier: MIT
/// @file
/// The program around the picture of a scene with its plan: lesson 11's, with `--explain`.
#pragma once

#include <string>
#include <utility>

#include "10_threading/thread_options.hpp"
#include "11_scenes/camera_choice.hpp"
#include "12_effects/explain.hpp"
#include "12_effects/planned_scene.hpp"
#include "common/app/lesson_app.hpp"

namespace rasterbook {

/// Runs a lesson of scenes: reads the command line and the model, renders, writes the picture.
///
/// @tparam Options  EffectsOptions, or derived from it.
/// @param render    Called as render(const Options&, const PlannedScene&, Workers&, StepClock&).
template <typename Options, typename Render>
int run_effects_lesson(int argc, char** argv, std::string name, std::string title, Render render) {
    return run_lesson<Options>(
        argc, argv, std::move(name), std::move(title), load_planned_scene,
        [render](const Options& options, const PlannedScene& assets) {
            StepClock clock;
            Image<vec3> picture =
                render(options, assets, kept_pool(options.threads.threads), clock);
            if (options.explain)
                explain(assets, camera_of_picture(options, assets.scene).name, clock);
            return picture;
        });
}

}  // namespace rasterbook
