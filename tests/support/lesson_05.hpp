// SPDX-License-Identifier: MIT
/// @file
/// Lesson 05's Options, make_assets() and render(), in namespace lesson_05.
/// In tests of the reader's headers, too, it is the course's main.cpp.
#pragma once

// All that main.cpp includes, so that what is left of it are its own lines.
#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/projection.hpp"
#include "05_textures/load_textures.hpp"
#include "05_textures/textures.hpp"
#include "common/app/lesson_app.hpp"
#include "common/image/backdrop.hpp"
#include "support/run_no_lesson.hpp"

#define main static lesson_main [[maybe_unused]]
namespace lesson_05 {
using rasterbook::test::run_lesson;
#include "lessons/05_textures/main.cpp"
}  // namespace lesson_05
#undef main
