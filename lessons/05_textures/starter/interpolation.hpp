// SPDX-License-Identifier: MIT
/// @file
/// What a triangle's corners have, in between, in perspective. Introduced in lesson 05;
/// derivation: docs/derivations/05_textures.md.
#pragma once

#include <algorithm>
#include <array>

#include "02_triangle_fill/triangle.hpp"
#include "04_mvp/clip.hpp"

namespace rasterbook {

/// The weighted sum of what three corners have (Eq. 5.1).
template <typename Attribute>
Attribute interpolate(const std::array<Attribute, 3>& corners, vec3 weights) {
    // TODO: Eq. 5.1.
    return corners[0];
}

/// The shares that a triangle's corners have in a fragment.
struct FragmentWeights {
    vec3 here;    ///< At the pixel's centre, >= 0 but for rounding; their sum is 1.
    vec3 step_x;  ///< How fast they change here, a pixel to the right.
    vec3 step_y;  ///< The same a pixel down.
};

/// A corner whose w is more than 2^80 times the least one counts as that far away: on the side
/// between two such corners all shares would become 0, and there is a division by their sum.
constexpr float least_nearness = 0x1p-80f;

/// From weights on the screen, of a clipped piece's corners, to weights on the surface, of the
/// whole triangle's.
class PerspectiveWeights {
  public:
    /// @param on_screen  The piece on the screen.
    /// @param clipped    The same piece in clip space, w > 0.
    PerspectiveWeights(const ScreenTriangle& on_screen, const ClippedTriangle& clipped) {
        // TODO: what all pixels of the piece have in common, so that it is computed once: the
        // proportions of the w, the columns of Eq. 5.3, and how fast the weights on the screen
        // change (Eq. 2.5 over the area, in double).
    }

    /// @param screen_weights  Of the piece's corners, as fill_triangle gives them.
    /// @return                Each weight within 16 ulp of its exact value, but for what clipping
    ///                        rounds.
    FragmentWeights at(vec3 screen_weights) const {
        // TODO: Eq. 5.2 and 5.3, and 5.7 for the steps.
        return {screen_weights, vec3(0), vec3(0)};
    }

  private:
    // TODO: what the constructor keeps for at().
};

}  // namespace rasterbook
