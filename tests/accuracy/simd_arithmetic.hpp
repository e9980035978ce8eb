// SPDX-License-Identifier: MIT
/// @file
/// Lesson 14's drawing, 16 pixels at a time, with other arithmetic. Each is a shared library of
/// simd_arithmetic.cpp, so that none of its functions takes the place of the course's.
#pragma once

#include "14_simd/width.hpp"

namespace rasterbook::test {

/// 1/x of perspective and 1/sqrt(x) of unit vectors from AVX-512's estimates, without and with a
/// Newton step.
WideDrawing drawing_hardware_0();
WideDrawing drawing_hardware_1();

/// Products and sums fused as the compiler likes.
WideDrawing drawing_contracted();

}  // namespace rasterbook::test
