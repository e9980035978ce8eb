// SPDX-License-Identifier: MIT
/// @file
/// Visible fragments of a triangle, gathered, so that they can be shaded many at a time. Introduced
/// in lesson 06.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "06_phong/lit_points.hpp"
#include "common/math/types.hpp"

namespace rasterbook {

struct Fragment {
    ivec2 pixel;
    vec3 screen_weights;  ///< Of the piece's corners, as fill_triangle gives them.
};

/// Hands fragments over in the order in which they came, most_points at a time.
template <typename Shade>
class Fragments {
  public:
    /// @param shade  Called as shade(std::span<const Fragment>), never with none.
    explicit Fragments(Shade& shade) : shade_(shade) {}

    void add(const Fragment& fragment) {
        fragments_[count_++] = fragment;
        if (count_ == most_points) finish();
    }

    /// Hands over what is left.
    void finish() {
        if (count_ > 0) shade_(std::span<const Fragment>(fragments_.data(), count_));
        count_ = 0;
    }

  private:
    Shade& shade_;
    std::array<Fragment, most_points> fragments_;
    std::size_t count_ = 0;
};

}  // namespace rasterbook
