// SPDX-License-Identifier: MIT
/// @file
/// Vertex attributes inside a triangle, in perspective. Introduced in lesson 05;
/// derivation: docs/derivations/05_textures.md.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "02_triangle_fill/triangle.hpp"
#include "04_mvp/clip.hpp"
#include "04_mvp/projection.hpp"

namespace rasterbook {

/// A vertex attribute inside a triangle: the sum of the three vertices' own, each times its
/// barycentric coordinate (Eq. 5.1).
template <typename Attribute, typename F>
Attribute interpolate(const std::array<Attribute, 3>& of_vertices, Vec3<F> barycentrics) {
    return barycentrics.x * of_vertices[0] + barycentrics.y * of_vertices[1] +
           barycentrics.z * of_vertices[2];
}

/// Perspective-correct barycentric coordinates, and their derivatives.
template <typename F>
struct PerspectiveBarycentrics {
    Vec3<F> here;  ///< At the pixel's centre; their sum is 1 but for rounding.
    Vec3<F> ddx;   ///< Per pixel to the right.
    Vec3<F> ddy;   ///< Per pixel down.
};
using FragmentBarycentrics = PerspectiveBarycentrics<float>;

/// What all pixels of a triangle have in common: the numerators of Eq. 5.3, linear on the screen.
struct PerspectiveSetup {
    vec3 inverse_w;  ///< 1/w of the clipped piece's vertices, times the least w.
    /// Of those vertices: barycentric coordinates in the whole triangle, times inverse_w.
    std::array<vec3, 3> numerators;
    vec3 numerators_ddx, numerators_ddy;
    bool is_whole;  ///< Nothing was clipped off: the numerators are a diagonal matrix.
};

/// Robust: a vertex whose w is more than 2^80 times the least one counts as 2^80 times as far.
/// Else, on the side between two such vertices, all numerators might become 0, or so small that
/// their sum has no finite reciprocal.
constexpr float min_inverse_w = 0x1p-80f;

/// @param clipped  A piece with a w of 0, or without area, has no fragments: what is returned for
///                 it is not used, and may be anything.
inline PerspectiveSetup perspective_setup(const ScreenTriangle& on_screen,
                                          const ClippedTriangle& clipped) {
    // Only the ratios of the w count; those to the least one do not overflow.
    const float least_w = std::min(
        {clipped[0].position_clip.w, clipped[1].position_clip.w, clipped[2].position_clip.w});
    const auto inverse_w = [&](std::size_t i) {
        return std::max(least_w / clipped[i].position_clip.w, min_inverse_w);
    };
    PerspectiveSetup setup;
    setup.inverse_w = {inverse_w(0), inverse_w(1), inverse_w(2)};
    setup.is_whole =
        mat3(clipped[0].barycentrics, clipped[1].barycentrics, clipped[2].barycentrics) == mat3(1);
    for (std::size_t i = 0; i < 3; ++i)
        setup.numerators[i] = setup.inverse_w[static_cast<int>(i)] * clipped[i].barycentrics;

    // How barycentric coordinates change on the screen: Eq. 2.5 over twice the area, as in Eq. 2.4.
    const dvec2 a(on_screen.vertices[0]), b(on_screen.vertices[1]), c(on_screen.vertices[2]);
    const double inv_area = subpixels / static_cast<double>(on_screen.twice_area);
    setup.numerators_ddx =
        interpolate(setup.numerators, vec3(inv_area * dvec3(c.y - b.y, a.y - c.y, b.y - a.y)));
    setup.numerators_ddy =
        interpolate(setup.numerators, vec3(inv_area * dvec3(b.x - c.x, c.x - a.x, a.x - b.x)));
    return setup;
}

inline PerspectiveSetup perspective_setup(const ProjectedTriangle& projected) {
    return perspective_setup(projected.on_screen, projected.clipped);
}

/// From barycentric coordinates on the screen to those on the surface, of the whole triangle
/// (Eq. 5.3).
///
/// @tparam F         float; or several floats at once, as common/math/functions.hpp has it.
/// @param on_screen  Of the clipped piece, as fill_triangle gives them.
/// @return           Coordinates >= 0, each within 16 ulp of its exact value; 22 ulp in a piece
///                   that was cut, taking its vertices' coordinates as they are.
template <typename F>
inline PerspectiveBarycentrics<F> perspective_correct(const PerspectiveSetup& setup,
                                                      Vec3<F> on_screen) {
    const auto sum = [](Vec3<F> v) { return v.x + v.y + v.z; };
    const Vec3<F> numerators = setup.is_whole ? Vec3<F>(setup.inverse_w) * on_screen
                                              : on_screen.x * Vec3<F>(setup.numerators[0]) +
                                                    on_screen.y * Vec3<F>(setup.numerators[1]) +
                                                    on_screen.z * Vec3<F>(setup.numerators[2]);
    const F inverse_sum = F(1.0f) / sum(numerators);
    const Vec3<F> here = numerators * inverse_sum;  // Eq. 5.2
    const Vec3<F> ddx(setup.numerators_ddx), ddy(setup.numerators_ddy);
    return {here, (ddx - here * sum(ddx)) * inverse_sum,  // Eq. 5.7
            (ddy - here * sum(ddy)) * inverse_sum};
}

}  // namespace rasterbook
