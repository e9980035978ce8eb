// SPDX-License-Identifier: MIT
/// @file
/// Frames of lessons 12, 13 and 14 as their programs draw them, on one thread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include "14_simd/width.hpp"
#include "accuracy/simd_arithmetic.hpp"
#include "accuracy/visibility_frames.hpp"

namespace rasterbook::test {

/// In place of a width: other arithmetic.
enum Arithmetic { hardware_0 = 100, hardware_1, contracted };

WideDrawing drawing_of_arithmetic(int width_or_arithmetic);

}  // namespace rasterbook::test

// Lesson 14's render(), which takes these for widths.
#define drawing_of_width rasterbook::test::drawing_of_arithmetic
#include "support/lesson_14.hpp"
#undef drawing_of_width

namespace rasterbook::test {

inline Image<vec3> frame(const lesson_14::Options& options, const PlannedScene& assets) {
    StepClock clock;
    return lesson_14::render(options, assets, one_thread(), clock);
}

/// @param width  Or an Arithmetic.
inline lesson_14::Options of_width(int width, lesson_14::Options options = {}) {
    options.wide.width = width;
    return options;
}

/// Differences of 8-bit values, three to a pixel.
struct ValueDifference {
    double percent = 0, greatest = 0;

    ValueDifference(const Image<vec3>& a, const Image<vec3>& b) {
        const Image<u8vec3> file_a = srgb8_from_linear(a), file_b = srgb8_from_linear(b);
        for (std::size_t i = 0; i < file_a.pixels().size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const int apart = std::abs(file_a.pixels()[i][c] - file_b.pixels()[i][c]);
                percent += apart != 0;
                greatest = std::max(greatest, static_cast<double>(apart));
            }
        percent *= 100 / (3 * pixels_of(a));
    }
};

}  // namespace rasterbook::test
