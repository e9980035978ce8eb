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
    // The edge's normal, to its left (Eq. 2.1).
    const std::int64_t normal_x = std::int64_t{b.y} - a.y, normal_y = std::int64_t{a.x} - b.x;
    return normal_x * (std::int64_t{p.x} - a.x) + normal_y * (std::int64_t{p.y} - a.y);
}

/// The triangle with its vertices snapped to the nearest 1/256 pixel, halves to even (Eq. 2.8).
///
/// @param a,b,c  Screen space, pixels. When a coordinate is not a number or is not below
///               coordinate_limit in size, the triangle becomes one of no area, which covers
///               nothing.
inline ScreenTriangle snap_triangle(vec2 a, vec2 b, vec2 c) {
    const auto is_usable = [](vec2 p) {  // false for NaN
        return std::abs(p.x) < coordinate_limit && std::abs(p.y) < coordinate_limit;
    };
    if (!is_usable(a) || !is_usable(b) || !is_usable(c)) return {};
    const auto snap = [](vec2 p) {
        return ivec2(std::lrint(p.x * subpixels), std::lrint(p.y * subpixels));
    };
    const ivec2 snapped_a = snap(a), snapped_b = snap(b), snapped_c = snap(c);
    return {{snapped_a, snapped_b, snapped_c}, edge_function(snapped_a, snapped_b, snapped_c)};
}

/// Whether the vertices are seen counter-clockwise. False for a triangle of no area.
constexpr bool is_front_facing(const ScreenTriangle& triangle) { return triangle.twice_area > 0; }

/// One edge of a triangle, evaluated at one pixel centre after the other (Eq. 2.5).
struct EdgeWalk {
    std::int64_t value;           ///< Edge function, inside > 0, at the first column of the row.
    std::int64_t step_x, step_y;  ///< Change from a pixel to its right and lower neighbour.
    std::int64_t least;           ///< Inside or owned from this value on: 0 or 1 (Eq. 2.7).

    /// @param winding      1 for a triangle seen counter-clockwise, -1 for one seen clockwise.
    /// @param first_pixel  Column and row of the pixel at whose centre the walk begins.
    EdgeWalk(ivec2 a, ivec2 b, int winding, ivec2 first_pixel) {
        const std::int64_t normal_x = winding * (std::int64_t{b.y} - a.y);
        const std::int64_t normal_y = winding * (std::int64_t{a.x} - b.x);
        const ivec2 center = first_pixel * subpixels + subpixels / 2;
        value = winding * edge_function(a, b, center);
        step_x = normal_x * subpixels;
        step_y = normal_y * subpixels;
        least = normal_x > 0 || (normal_x == 0 && normal_y > 0) ? 0 : 1;
    }

    /// Cuts [first, last], columns counted from the first one, down to those inside (Eq. 2.6).
    void narrow(std::int64_t& first, std::int64_t& last) const {
        const std::int64_t missing = least - value;
        if (step_x > 0) {
            if (missing > 0) first = std::max(first, (missing + step_x - 1) / step_x);
        } else if (missing > 0) {
            last = -1;
        } else if (step_x < 0) {
            last = std::min(last, missing / step_x);  // neither is > 0, so this rounds down
        }
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
    if (triangle.twice_area == 0) return;
    const auto [a, b, c] = triangle.vertices;
    const ivec2 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
    // The first centre at or after `low`, the last at or before `high`; >> rounds down.
    const ivec2 first_pixel = glm::max((low + (subpixels / 2 - 1)) >> subpixel_bits, first);
    const ivec2 last_pixel = glm::min((high - subpixels / 2) >> subpixel_bits, last);
    if (first_pixel.x > last_pixel.x) return;

    const int winding = triangle.twice_area > 0 ? 1 : -1;
    // Opposite to its vertex, an edge's value is the vertex's share of twice the area (Eq. 2.3).
    EdgeWalk edge_a(b, c, winding, first_pixel);
    EdgeWalk edge_b(c, a, winding, first_pixel);
    EdgeWalk edge_c(a, b, winding, first_pixel);
    const auto inv_area =
        static_cast<float>(1.0 / static_cast<double>(winding * triangle.twice_area));

    for (int y = first_pixel.y; y <= last_pixel.y; ++y) {
        std::int64_t left = 0, right = last_pixel.x - first_pixel.x;  // from first_pixel.x
        for (const EdgeWalk* edge : {&edge_a, &edge_b, &edge_c}) edge->narrow(left, right);
        std::int64_t share_a = edge_a.value + left * edge_a.step_x;
        std::int64_t share_b = edge_b.value + left * edge_b.step_x;
        std::int64_t share_c = edge_c.value + left * edge_c.step_x;
        const int last_x = first_pixel.x + static_cast<int>(right);
        for (int x = first_pixel.x + static_cast<int>(left); x <= last_x; ++x) {
            emit(ivec2(x, y), Barycentrics(share_a, share_b, share_c) * inv_area);  // Eq. 2.4
            share_a += edge_a.step_x;
            share_b += edge_b.step_x;
            share_c += edge_c.step_x;
        }
        for (EdgeWalk* edge : {&edge_a, &edge_b, &edge_c}) edge->value += edge->step_y;
    }
}

/// Visits the pixels of an image whose centres a triangle covers.
///
/// @param size  Width and height in pixels, each 0 to 2^22.
template <std::invocable<ivec2, Barycentrics> Emit>
void fill_triangle(const ScreenTriangle& triangle, ivec2 size, Emit&& emit) {
    fill_triangle(triangle, ivec2(0), size - 1, traced(triangle.vertices, emit));
}

}  // namespace rasterbook
