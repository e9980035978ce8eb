// SPDX-License-Identifier: MIT
/// @file
/// Visible fragments of a triangle, gathered, so that they can be shaded many at a time. Introduced
/// in lesson 06.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

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

}  // namespace rasterbook
