// SPDX-License-Identifier: MIT
/// @file
/// The Options and render() of lesson 07's laboratory, in namespace lab_07.
#pragma once

// All that it includes, so that what is left of it are its own lines.
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/projection.hpp"
#include "06_phong/studio_lights.hpp"
#include "06_phong/surface.hpp"
#include "07_toon/assets.hpp"
#include "common/app/lesson_app.hpp"
#include "common/image/backdrop.hpp"
#include "lab/toon_methods.hpp"

#define main static lab_main [[maybe_unused]]
namespace lab_07 {
inline int run_lab(const auto&...) { return 0; }
#include "lessons/lab/07_toon.cpp"
}  // namespace lab_07
#undef main
