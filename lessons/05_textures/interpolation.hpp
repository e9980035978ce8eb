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
    return weights.x * corners[0] + weights.y * corners[1] + weights.z * corners[2];
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
        // Only the proportions of the w count; those to the least one do not overflow.
        const float least_w = std::min(
            {clipped[0].position_clip.w, clipped[1].position_clip.w, clipped[2].position_clip.w});
        const auto nearness = [&](std::size_t i) {
            return std::max(least_w / clipped[i].position_clip.w, least_nearness);
        };
        nearness_ = {nearness(0), nearness(1), nearness(2)};
        const mat3 weights(clipped[0].weights, clipped[1].weights, clipped[2].weights);
        is_whole_ = weights == mat3(1);
        shares_ = {nearness_.x * weights[0], nearness_.y * weights[1], nearness_.z * weights[2]};

        // How weights change on the screen: Eq. 2.5 over the area, as in Eq. 2.4.
        const dvec2 a(on_screen.corners[0]), b(on_screen.corners[1]), c(on_screen.corners[2]);
        const double per_area = subpixels / static_cast<double>(on_screen.twice_area);
        shares_step_x_ = shares_ * vec3(per_area * dvec3(c.y - b.y, a.y - c.y, b.y - a.y));
        shares_step_y_ = shares_ * vec3(per_area * dvec3(b.x - c.x, c.x - a.x, a.x - b.x));
    }

    /// @param screen_weights  Of the piece's corners, as fill_triangle gives them.
    /// @return                Each weight within 16 ulp of its exact value, but for what clipping
    ///                        rounds.
    FragmentWeights at(vec3 screen_weights) const {
        // Eq. 5.3; the matrix is diagonal for a triangle that is not clipped, and nearly all are.
        const vec3 shares = is_whole_ ? nearness_ * screen_weights : shares_ * screen_weights;
        const float per_sum = 1 / sum(shares);
        const vec3 here = shares * per_sum;  // Eq. 5.2
        // Eq. 5.7
        return {here, (shares_step_x_ - here * sum(shares_step_x_)) * per_sum,
                (shares_step_y_ - here * sum(shares_step_y_)) * per_sum};
    }

  private:
    static float sum(vec3 v) { return v.x + v.y + v.z; }

    vec3 nearness_;  ///< 1/w of the piece's corners, times the least w.
    mat3 shares_;    ///< Columns: the weights of the piece's corners, times their nearness.
    bool is_whole_;
    vec3 shares_step_x_, shares_step_y_;
};

}  // namespace rasterbook
