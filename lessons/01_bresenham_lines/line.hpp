// SPDX-License-Identifier: MIT
/// @file
/// Which pixels a straight line visits. Introduced in lesson 01; derivation:
/// docs/derivations/01_bresenham_lines.md.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include "common/math/numerics.hpp"
#include "common/math/types.hpp"

namespace rasterbook {

/// Whether a line's last pixel is its own, or is left to the line that continues there.
enum class LineEnd { included, excluded };

/// A line prepared for stepping: along its major axis, the longer one, towards larger coordinates.
///
/// Both orders of the ends prepare the same steps (Eq. 1.6); only `swapped` tells them apart.
struct LineSteps {
    std::int64_t major_start, minor_start;  ///< The pixel of step 0.
    std::int64_t major_length;              ///< The number of the last step, 0 .. 2^32 - 1.
    std::int64_t minor_length;              ///< Change along the minor axis, 0 .. major_length.
    int minor_direction;                    ///< -1 or +1; +1 for a level line.
    bool steep;                             ///< The major axis is y; rows are then columns.
    bool swapped;                           ///< Step 0 is the line's second end.

    /// @param a,b  The ends, whole pixels, any int32 value; a == b is a line of one pixel.
    LineSteps(ivec2 a, ivec2 b) {
        std::int64_t ax = a.x, ay = a.y, bx = b.x, by = b.y;
        steep = std::abs(bx - ax) < std::abs(by - ay);
        if (steep) {
            std::swap(ax, ay);
            std::swap(bx, by);
        }
        swapped = ax > bx;
        if (swapped) {
            std::swap(ax, bx);
            std::swap(ay, by);
        }
        major_start = ax;
        minor_start = ay;
        major_length = bx - ax;
        minor_length = std::abs(by - ay);
        minor_direction = by < ay ? -1 : 1;
    }

    /// Rows moved along the minor axis after `step` steps: the rise (Eq. 1.1), rounded to the
    /// nearest row (Eq. 1.2) by one division of whole numbers (Eq. 1.3).
    std::int64_t rows_after(std::int64_t step) const {
        if (step == 0) return 0;
        const int128 doubled_rise = int128{2} * step * minor_length;  // reaches 2^65
        return static_cast<std::int64_t>((doubled_rise + major_length - 1) / (2 * major_length));
    }

    /// The first step that has moved at least `rows` rows (Eq. 1.7); past the last step if none
    /// has.
    std::int64_t first_step_with(std::int64_t rows) const {
        if (rows <= 0) return 0;
        if (rows > minor_length) return major_length + 1;
        const int128 doubled_midpoint = int128{2 * rows - 1} * major_length;  // reaches 2^65
        return static_cast<std::int64_t>(doubled_midpoint / (2 * minor_length)) + 1;
    }
};

/// A run of steps; empty when first > last.
struct StepRange {
    std::int64_t first, last;
};

/// The steps whose pixels lie in an image of `size` pixels (Eq. 1.8), without that of the line's
/// second end if it is excluded.
inline StepRange steps_inside(const LineSteps& line, ivec2 size, LineEnd end) {
    const std::int64_t major_size = line.steep ? size.y : size.x;
    const std::int64_t minor_size = line.steep ? size.x : size.y;
    const bool down = line.minor_direction > 0;
    const std::int64_t rows_to_enter =
        down ? -line.minor_start : line.minor_start - (minor_size - 1);
    const std::int64_t rows_to_leave = rows_to_enter + minor_size;
    const bool shorter = end == LineEnd::excluded;  // the walk may have started at that end
    return {std::max({std::int64_t{shorter && line.swapped ? 1 : 0}, -line.major_start,
                      line.first_step_with(rows_to_enter)}),
            std::min({line.major_length - (shorter && !line.swapped ? 1 : 0),
                      major_size - 1 - line.major_start, line.first_step_with(rows_to_leave) - 1})};
}

/// Visits each pixel of the line from a to b that lies in an image of `size` pixels.
///
/// These are exactly the pixels of the whole line that are inside, found in time proportional to
/// their number, however far away the ends are. Every visited centre lies within half a pixel of
/// the line, measured along the minor axis (Eq. 1.5), and b -> a visits the same pixels
/// (Eq. 1.6).
///
/// @param a,b   Screen space, whole pixels, any int32 value.
/// @param size  Width and height in pixels; nothing is visited when either is 0.
/// @param end   With LineEnd::excluded pixel b is left out, so that lines in a chain meet in pixels
///              that are visited once; a == b then visits nothing.
/// @param plot  Called as plot(ivec2), once for each pixel, towards larger major coordinates.
/// @see Bresenham, "Algorithm for computer control of a digital plotter", 1965
template <std::invocable<ivec2> Plot>
void draw_line(ivec2 a, ivec2 b, ivec2 size, LineEnd end, Plot&& plot) {
    const LineSteps line(a, b);
    const StepRange steps = steps_inside(line, size, end);
    if (steps.first > steps.last) return;

    const std::int64_t rows = line.rows_after(steps.first);
    auto error = static_cast<std::int64_t>(int128{2} * steps.first * line.minor_length -
                                           int128{2} * rows * line.major_length);  // Eq. 1.4
    auto major = static_cast<int>(line.major_start + steps.first);
    auto minor = static_cast<int>(line.minor_start + line.minor_direction * rows);
    const auto last = static_cast<int>(line.major_start + steps.last);
    for (; major <= last; ++major) {
        plot(line.steep ? ivec2(minor, major) : ivec2(major, minor));
        error += 2 * line.minor_length;
        const bool next_row = error > line.major_length;  // Eq. 1.5
        error -= next_row ? 2 * line.major_length : 0;
        minor += next_row ? line.minor_direction : 0;
    }
}

}  // namespace rasterbook
