// SPDX-License-Identifier: MIT
/// @file
/// Lesson 12's Options and render(), in namespace lesson_12.
/// In tests of the reader's headers, too, it is the course's main.cpp.
#pragma once

// All that main.cpp includes, so that what is left of it are its own lines.
#include "06_phong/studio_lights.hpp"
#include "07_toon/toon_material.hpp"
#include "11_scenes/camera_choice.hpp"
#include "11_scenes/casters.hpp"
#include "11_scenes/opacity.hpp"
#include "11_scenes/passes.hpp"
#include "12_effects/effects_program.hpp"
#include "12_effects/permutation.hpp"
#include "support/run_no_lesson.hpp"

#define main static lesson_main [[maybe_unused]]
#ifdef RENDER_IS_COMPILED_APART
#define render render_here
#endif
namespace lesson_12 {
using rasterbook::test::run_effects_lesson;
#include "lessons/12_effects/main.cpp"
using Options = EffectsOptions;
#ifdef RENDER_IS_COMPILED_APART
#undef render
Image<vec3> render(const Options&, const PlannedScene&, Workers&, StepClock&);
#endif
}  // namespace lesson_12
#undef main
