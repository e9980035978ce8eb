// SPDX-License-Identifier: MIT
/// @file
/// Cuts polygons into triangles: a fan where that is enough, else ears, judged by exact signs.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/math/types.hpp"

namespace rasterbook {

/// The sign of the area of the triangle a, b, c: +1 counter-clockwise, -1 clockwise, 0 in one line.
///
/// Exact for all finite points: no rounding changes the answer.
/// @see Shewchuk 1997, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
///      Predicates
int orientation(vec2 a, vec2 b, vec2 c);

/// Cuts a polygon of n >= 3 vertices into n - 2 triangles with the same winding.
///
/// The polygon is seen along the axis on which its normal is longest. When no two of its edges
/// cross in that view, the areas of the triangles there add up to the polygon's and none is
/// inverted. Edges may touch, and two may run along each other, as the sides of a bridge to a hole
/// do. Vertices in one line or at one point give triangles without area; a polygon that crosses
/// itself gives any n - 2 triangles. Time is O(n) for convex polygons and about O(n log n) for most
/// others; it nears O(n^1.5) when most ears are long and thin.
///
/// @return  For each triangle three numbers of vertices, 0 to n - 1.
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const vec3> polygon);

/// Of a polygon that returns to one point more often, triangulate() takes much longer.
constexpr std::size_t max_returns = 1000;

/// How often a polygon passes through the point that it passes through most often.
std::size_t most_returns(std::span<const vec3> polygon);

}  // namespace rasterbook
