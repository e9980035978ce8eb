// SPDX-License-Identifier: MIT
/// @file
/// Lesson 02's edge functions and coverage, for the figure edge_functions.js.
#include <array>
#include <cstdint>

#include "02_triangle_fill/triangle.hpp"

namespace rasterbook {
namespace {

constexpr int max_pixels = 16 * 16;
std::array<std::uint8_t, max_pixels> coverage;

/// Of one edge at one pixel's centre, in square pixels; positive inside.
struct Edge {
    double value;
    double least;  ///< 0 if the edge owns the centres on it, else 1/65536.
};
std::array<Edge, 3> edges;  ///< Opposite a, b and c.

double in_square_pixels(std::int64_t value) { return double(value) / (subpixels * subpixels); }

}  // namespace

/// Twice the triangle's area in square pixels; > 0 if seen counter-clockwise.
extern "C" double twice_area(float ax, float ay, float bx, float by, float cx, float cy) {
    return in_square_pixels(snap_triangle({ax, ay}, {bx, by}, {cx, cy}).twice_area);
}

/// 1 for each covered pixel of an image, row by row.
///
/// @param columns,rows  At most 16.
extern "C" std::uint8_t* covered(float ax, float ay, float bx, float by, float cx, float cy,
                                 int columns, int rows) {
    coverage.fill(0);
    const auto mark = [&](ivec2 pixel, Barycentrics) { coverage[pixel.y * columns + pixel.x] = 1; };
    fill_triangle(snap_triangle({ax, ay}, {bx, by}, {cx, cy}), ivec2(columns, rows), mark);
    return coverage.data();
}

/// The three edges at the centre of pixel (x, y), opposite a, b and c.
extern "C" Edge* edges_at(float ax, float ay, float bx, float by, float cx, float cy, int x,
                          int y) {
    const ScreenTriangle triangle = snap_triangle({ax, ay}, {bx, by}, {cx, cy});
    const auto& [a, b, c] = triangle.vertices;
    const int winding = is_front_facing(triangle) ? 1 : -1;
    const auto edge = [&](ivec2 from, ivec2 to) {
        const EdgeWalk walk(from, to, winding, {x, y});
        return Edge{in_square_pixels(walk.value), in_square_pixels(walk.least)};
    };
    edges = {edge(b, c), edge(c, a), edge(a, b)};
    return edges.data();
}

}  // namespace rasterbook
