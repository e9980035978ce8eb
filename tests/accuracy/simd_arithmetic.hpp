// SPDX-License-Identifier: MIT
/// @file
/// Lesson 13's drawing, 16 pixels at a time, with other arithmetic. Each is a shared library of
/// simd_arithmetic.cpp, so that none of its functions takes the place of the course's.
#pragma once

#include <cstdint>

#include "13_simd/simd.hpp"
#include "13_simd/width.hpp"

namespace rasterbook::test {

/// 1/x of perspective and 1/sqrt(x) of unit vectors from an estimate and so many Newton steps.
WideDrawing drawing_hardware_0();
WideDrawing drawing_hardware_1();
WideDrawing drawing_bits_1();
WideDrawing drawing_bits_2();

/// Products and sums fused as the compiler likes.
WideDrawing drawing_contracted();

/// The power of a highlight by a function of the caller's.
using PowerInLanes = Floats<16> (*)(const Floats<16>& x, const Floats<16>& y);
WideDrawing drawing_powers();
void set_power(PowerInLanes power);

struct BatchesCounted {
    std::uint64_t count = 0, pixels = 0;
};

/// As the course has it, but batches of pixels are counted.
///
/// @param width  4, 8 or 16.
WideDrawing drawing_counted(int width);
BatchesCounted& batches_counted();

}  // namespace rasterbook::test
