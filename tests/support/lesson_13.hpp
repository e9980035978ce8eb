// SPDX-License-Identifier: MIT
/// @file
/// Lesson 13's Options and render(), in namespace lesson_13.
/// In tests of the reader's headers, too, it is the course's main.cpp.
#pragma once

// All that main.cpp includes, so that what is left of it are its own lines.
#include "10_threading/thread_pool.hpp"
#include "11_scenes/camera_choice.hpp"
#include "11_scenes/passes.hpp"
#include "12_effects/effects_program.hpp"
#include "13_visibility_buffer/shadow_parts.hpp"
#include "13_visibility_buffer/views.hpp"
#include "13_visibility_buffer/visibility_options.hpp"
#include "13_visibility_buffer/visible_shading.hpp"
#include "support/run_no_lesson.hpp"

#define main static lesson_main [[maybe_unused]]
#ifdef RENDER_IS_COMPILED_APART
#define render render_here
#endif
namespace lesson_13 {
using rasterbook::test::run_effects_lesson;
#include "lessons/13_visibility_buffer/main.cpp"
#ifdef RENDER_IS_COMPILED_APART
#undef render
Image<vec3> render(const Options&, const PlannedScene&, Workers&, StepClock&);
#endif
}  // namespace lesson_13
#undef main
