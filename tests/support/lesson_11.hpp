// SPDX-License-Identifier: MIT
/// @file
/// Lesson 11's Options and render(), in namespace lesson_11.
/// In tests of the reader's headers, too, it is the course's main.cpp.
#pragma once

// All that main.cpp includes, so that what is left of it are its own lines.
#include "10_threading/thread_pool.hpp"
#include "10_threading/threaded_shadows.hpp"
#include "11_scenes/casters.hpp"
#include "11_scenes/scene_camera.hpp"
#include "11_scenes/scene_options.hpp"
#include "11_scenes/scene_program.hpp"
#include "11_scenes/shaders.hpp"
#include "support/run_no_lesson.hpp"

#define main static lesson_main [[maybe_unused]]
#ifdef RENDER_IS_COMPILED_APART
#define render render_here
#endif
namespace lesson_11 {
using rasterbook::test::run_scene_lesson;
#include "lessons/11_scenes/main.cpp"
#ifdef RENDER_IS_COMPILED_APART
#undef render
Image<vec3> render(const Options&, const SceneAssets&, Workers&, StepClock&);
#endif
}  // namespace lesson_11
#undef main
