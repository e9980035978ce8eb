// SPDX-License-Identifier: MIT
/// @file
/// An order of pixels in which a texture is read that does not fit into the cache. Introduced in
/// lesson 05.
#pragma once

#include <algorithm>

#include "02_triangle_fill/triangle.hpp"
#include "common/math/types.hpp"

namespace rasterbook {

/// Columns that are filled together. What the row below asks of textures is mostly near to what
/// this row asked; in rows as short as this it is still in the fastest cache.
constexpr int band_width = 64;

/// As fill_triangle, in bands of columns, the left one first.
template <typename Emit>
void fill_in_bands(const ScreenTriangle& triangle, ivec2 first, ivec2 last, Emit&& emit) {
    const auto [a, b, c] = triangle.corners;
    const int left = std::max(std::min({a.x, b.x, c.x}) >> subpixel_bits, first.x);
    const int right = std::min(std::max({a.x, b.x, c.x}) >> subpixel_bits, last.x);
    for (int x = left; x <= right; x += band_width)
        fill_triangle(triangle, {x, first.y}, {std::min(x + band_width - 1, right), last.y}, emit);
}

/// The same of a whole picture.
template <typename Emit>
void fill_in_bands(const ScreenTriangle& triangle, ivec2 size, Emit&& emit) {
    fill_in_bands(triangle, ivec2(0), size - 1, emit);
}

}  // namespace rasterbook
