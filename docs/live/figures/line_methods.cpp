// SPDX-License-Identifier: MIT
/// @file
/// Lesson 01's lines and their decision variable, for the figure line_methods.js.
#include <array>
#include <cstdint>

#include "lab/line_methods.hpp"

namespace rasterbook {
namespace {

constexpr int max_pixels = 32 * 32;
std::array<float, max_pixels> coverage;

/// What the texts' table shows of a step.
struct Step {
    double rise;         ///< Eq. 1.1
    double row;          ///< Eq. 1.2, counted from the row of step 0.
    double error;        ///< Decision variable after the step (Eq. 1.4).
    double float_row;    ///< The DDA's sum in float, from the row of step 0.
    double fixed_row;    ///< The DDA's sum in fixed point.
    double major_start;  ///< Column of step 0; row if the line is steep.
    double major_length, minor_length;
    double steep, direction;
};
Step shown;

}  // namespace

/// How much of each pixel a method covers, row by row.
///
/// @param method        As in LineMethod.
/// @param columns,rows  At most 32.
extern "C" float* coverage_of(int method, int ax, int ay, int bx, int by, int columns, int rows) {
    coverage.fill(0);
    draw_line_as(LineMethod(method), {ax, ay}, {bx, by}, ivec2(columns, rows), LineEnd::included,
                 [&](ivec2 pixel, float share) { coverage[pixel.y * columns + pixel.x] = share; });
    return coverage.data();
}

/// @param step  0 to the line's longer extent.
extern "C" Step* step_of(int ax, int ay, int bx, int by, int step) {
    const LineSteps line({ax, ay}, {bx, by});
    const std::int64_t row = line.rows_after(step);
    const double length = line.major_length > 0 ? double(line.major_length) : 1;
    FloatRow float_row(line, 0);
    FixedRow<16> fixed_row(line, 0);
    for (int i = 0; i < step; ++i) float_row.step(), fixed_row.step();
    shown = {step * double(line.minor_length) / length,
             double(row),
             double(2 * step * line.minor_length - 2 * row * line.major_length),
             float_row.row,
             double(fixed_row.row) / 65536,
             double(line.major_start),
             double(line.major_length),
             double(line.minor_length),
             double(line.steep),
             double(line.minor_direction)};
    return &shown;
}

}  // namespace rasterbook
