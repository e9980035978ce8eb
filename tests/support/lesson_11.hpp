// SPDX-License-Identifier: MIT
/// @file
/// Lesson 11's Options and render(), in namespace lesson_11.
/// In tests of the reader's headers, too, it is the course's main.cpp.
#pragma once

// All that main.cpp includes, so that what is left of it are its own lines.
#include "06_phong/studio_lights.hpp"
#include "07_toon/toon_material.hpp"
#include "11_scenes/camera_choice.hpp"
#include "11_scenes/casters.hpp"
#include "11_scenes/opacity.hpp"
#include "11_scenes/passes.hpp"
#include "common/app/lesson_app.hpp"
#include "support/run_no_lesson.hpp"

#define main static lesson_main [[maybe_unused]]
#ifdef RENDER_IS_COMPILED_APART
#define render render_here
#endif
namespace lesson_11 {
using rasterbook::test::run_lesson;
#include "lessons/11_scenes/main.cpp"
using Options = SceneOptions;
#ifdef RENDER_IS_COMPILED_APART
[[maybe_unused]] static constexpr auto* named_here =
    &render_here;  // main.cpp calls it in a template
#undef render
Image<vec3> render(const Options&, const SceneAssets&, Workers&);
#endif
}  // namespace lesson_11
#undef main
