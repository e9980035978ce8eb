// SPDX-License-Identifier: MIT
/// @file
/// Lesson 10's Options, make_assets() and render(), in namespace lesson_10.
/// In tests of the reader's headers, too, it is the course's main.cpp.
#pragma once

// All that main.cpp includes, so that what is left of it are its own lines.
#include <utility>

#include "04_mvp/camera.hpp"
#include "06_phong/studio_lights.hpp"
#include "06_phong/surface.hpp"
#include "10_threading/binned_triangles.hpp"
#include "10_threading/thread_options.hpp"
#include "10_threading/thread_pool.hpp"
#include "10_threading/threaded_shadows.hpp"
#include "common/app/lesson_app.hpp"
#include "support/run_no_lesson.hpp"

#define main static lesson_main [[maybe_unused]]
#ifdef RENDER_IS_COMPILED_APART
#define render render_here
#endif
namespace lesson_10 {
using rasterbook::test::run_lesson;
#include "lessons/10_threading/main.cpp"
using Options = ThreadedSceneOptions;
inline auto make_assets(Scene scene, const Options& options) {
    return load_shadow_scene(std::move(scene), options);
}
#ifdef RENDER_IS_COMPILED_APART
[[maybe_unused]] static constexpr auto* named_here =
    &render_here;  // main.cpp calls it in a template
#undef render
Image<vec3> render(const Options&, const ShadowAssets&, Workers&);
#endif
}  // namespace lesson_10
#undef main
