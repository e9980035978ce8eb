// SPDX-License-Identifier: MIT
/// @file
/// Which pixels a triangle covers. Introduced in lesson 02; derivation:
/// docs/derivations/02_triangle_fill.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>

#include "common/math/types.hpp"
#include "common/probe/pixel_trace.hpp"

namespace rasterbook {

constexpr int subpixel_bits = 8;
constexpr int subpixels = 1 << subpixel_bits;  ///< Steps of a snapped coordinate in one pixel.
static_assert(subpixel_bits >= 1, "a pixel's centre has to be a whole step");

/// Coordinates stay below this many pixels from the origin: then no edge function leaves 64 bits
/// (Eq. 2.9).
constexpr float coordinate_limit = 1 << 22;

/// The barycentric coordinates of a point: the three vertices' shares in it (Eq. 2.4).
using Barycentrics = vec3;

/// A triangle on the screen, its vertices snapped to 1/256 pixel.
struct ScreenTriangle {
    std::array<ivec2, 3> vertices;  ///< In 1/256 pixel, x right, y down.
    std::int64_t twice_area;        ///< In 1/65536 square pixel; > 0 where seen counter-clockwise.
};

/// Twice the area of the triangle a, b, p: positive for p on the left of the way from a to b as
/// seen on the screen, 0 on the line, negative on the right (Eq. 2.2).
///
/// @param a,b,p  In 1/256 pixel, each coordinate below 2^30 in size.
/// @return       Exact, in 1/65536 square pixel.
/// @see Pineda, "A parallel algorithm for polygon rasterization", 1988
constexpr std::int64_t edge_function(ivec2 a, ivec2 b, ivec2 p) {
    // TODO, step 1: Eq. 2.1 and 2.2; widen before you multiply.
    return 0;
}

/// The triangle with its vertices snapped to the nearest 1/256 pixel, halves to even (Eq. 2.8).
///
/// @param a,b,c  Screen space, pixels. When a coordinate is not a number or is not below
///               coordinate_limit in size, the triangle becomes one of no area, which covers
///               nothing.
inline ScreenTriangle snap_triangle(vec2 a, vec2 b, vec2 c) {
    // TODO, step 1: Eq. 2.8; twice the area by Eq. 2.2. Reject what is not usable ("What
    // is rejected").
    return {};
}

/// Whether the vertices are seen counter-clockwise. False for a triangle of no area.
constexpr bool is_front_facing(const ScreenTriangle& triangle) {
    // TODO, step 1: the sign of the area.
    return false;
}

/// One edge of a triangle, evaluated at one pixel centre after the other (Eq. 2.5).
struct EdgeWalk {
    std::int64_t value;           ///< Edge function, inside > 0, at the first column of the row.
    std::int64_t step_x, step_y;  ///< Change from a pixel to its right and lower neighbour.
    std::int64_t least;           ///< Inside or owned from this value on: 0 or 1 (Eq. 2.7).

    /// @param winding      1 for a triangle seen counter-clockwise, -1 for one seen clockwise.
    /// @param first_pixel  Column and row of the pixel at whose centre the walk begins.
    EdgeWalk(ivec2 a, ivec2 b, int winding, ivec2 first_pixel) {
        // TODO, step 1: Eq. 2.2 at the pixel's centre; Eq. 2.5 in steps of a pixel; all of it times
        // the winding.
        // TODO, step 3: Eq. 2.7.
        value = step_x = step_y = least = 0;
    }

    /// Cuts [first, last], columns counted from the first one, down to those inside (Eq. 2.6).
    void narrow(std::int64_t& first, std::int64_t& last) const {
        // TODO, step 3: Eq. 2.6.
    }
};

/// Visits each pixel of an image, or of a part of one, whose centre the triangle covers.
///
/// A centre on an edge belongs to the triangle if the edge is a left or a top one, so that
/// triangles which share an edge visit each pixel once (Eq. 2.7). The order of the vertices does
/// not matter.
///
/// @param triangle  A triangle of no area visits nothing.
/// @param first     The part's upper left pixel, from 0 on.
/// @param last      Its lower right one, below 2^22. If it lies before `first`, nothing is visited.
/// @param emit      Called as emit(ivec2 pixel, Barycentrics), row by row, once for each pixel,
///                  with the coordinates of its centre: >= 0, each within 2 ulp of its exact value
///                  (Eq. 2.4), and the same whatever the part.
template <std::invocable<ivec2, Barycentrics> Emit>
void fill_triangle(const ScreenTriangle& triangle, ivec2 first, ivec2 last, Emit&& emit) {
    // TODO, step 1: emit the pixels of the bounding box at which no edge's value is negative, with
    // Barycentrics(0) for now.
    // TODO, step 2: with their barycentric coordinates (Eq. 2.4).
    // TODO, step 3: "All the steps in order" in the derivation.
}

/// Visits the pixels of an image whose centres a triangle covers.
///
/// @param size  Width and height in pixels, each 0 to 2^22.
template <std::invocable<ivec2, Barycentrics> Emit>
void fill_triangle(const ScreenTriangle& triangle, ivec2 size, Emit&& emit) {
    fill_triangle(triangle, ivec2(0), size - 1, traced(triangle.vertices, emit));
}

}  // namespace rasterbook
