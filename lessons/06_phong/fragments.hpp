// SPDX-License-Identifier: MIT
/// @file
/// Visible fragments of a triangle, gathered, so that they can be shaded many at a time. Introduced
/// in lesson 06.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "02_triangle_fill/triangle.hpp"
#include "06_phong/lit_points.hpp"
#include "common/math/types.hpp"

namespace rasterbook {

/// Up to most_points fragments.
struct ManyFragments {
    std::size_t count = 0;
    std::array<ivec2, most_points> pixels;
    Vectors screen_weights;  ///< Of the piece's corners, as fill_triangle gives them.
};

/// Hands fragments over in the order in which they came, most_points at a time.
template <typename Shade>
class Fragments {
  public:
    /// @param shade  Called as shade(const ManyFragments&), never with none.
    explicit Fragments(Shade& shade) : shade_(shade) {}

    void add(ivec2 pixel, vec3 screen_weights) {
        fragments_.pixels[fragments_.count] = pixel;
        fragments_.screen_weights.set(fragments_.count++, screen_weights);
        if (fragments_.count == most_points) finish();
    }

    /// Hands over what is left.
    void finish() {
        if (fragments_.count > 0) shade_(std::as_const(fragments_));
        fragments_.count = 0;
    }

  private:
    Shade& shade_;
    ManyFragments fragments_;
};

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
