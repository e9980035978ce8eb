// SPDX-License-Identifier: MIT
/// @file
/// Lesson 02's Options and render(), in namespace lesson_02.
/// In tests of the reader's headers, too, it is the course's main.cpp.
#pragma once

// All that main.cpp includes, so that what is left of it are its own lines.
#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "common/app/lesson_app.hpp"
#include "common/app/orthographic_view.hpp"
#include "common/image/backdrop.hpp"
#include "support/run_no_lesson.hpp"

#define main static lesson_main [[maybe_unused]]
namespace lesson_02 {
using rasterbook::test::run_lesson;
#include "lessons/02_triangle_fill/main.cpp"
}  // namespace lesson_02
#undef main
