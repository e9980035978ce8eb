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
        // TODO, step 1: the three changes that turn every line into the one of the text.
        major_start = minor_start = major_length = minor_length = 0;
        minor_direction = 1;
        steep = swapped = false;
    }

    /// Rows moved along the minor axis after `step` steps: the rise (Eq. 1.1), rounded to the
    /// nearest row (Eq. 1.2) by one division of whole numbers (Eq. 1.3).
    std::int64_t rows_after(std::int64_t step) const {
        // TODO, step 2: Eq. 1.3, in 128 bits; 0 in step 0, where it might divide by 0.
        return 0;
    }

    /// The first step that has moved at least `rows` rows (Eq. 1.7); past the last step if none
    /// has.
    std::int64_t first_step_with(std::int64_t rows) const {
        // TODO, step 3: Eq. 1.7, in 128 bits, and what the text says for rows outside its range.
        return 0;
    }
};

/// A run of steps; empty when first > last.
struct StepRange {
    std::int64_t first, last;
};

/// The steps whose pixels lie in an image of `size` pixels (Eq. 1.8), without that of the line's
/// second end if it is excluded.
inline StepRange steps_inside(const LineSteps& line, ivec2 size, LineEnd end) {
    // TODO, step 3: Eq. 1.8; then leave out the first or the last step if it is the pixel b and
    // excluded.
    return {0, -1};
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
    // TODO, step 1: add the slope in float (Eq. 1.1), round to the nearest row (Eq. 1.2), and plot
    // what lies inside of the image.
    // TODO, step 2: a decision variable in place of the sum (Eq. 1.5).
    // TODO, step 3: only the steps inside, from the row and the decision variable of the first one
    // on (Eq. 1.3, 1.4).
}

}  // namespace rasterbook
