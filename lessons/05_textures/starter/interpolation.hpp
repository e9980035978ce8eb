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
    // TODO: Eq. 5.1.
    return of_vertices[0];
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
    // TODO: the 1/w of Eq. 5.3, of which only the ratios count, none below min_inverse_w; the
    // numerators; and whether the piece is the whole triangle: its barycentrics are (1, 0, 0),
    // (0, 1, 0) and (0, 0, 1). In step 3, how fast they change (Eq. 2.5 over the area, times
    // `subpixels`, in double).
    return {};
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
    // TODO: Eq. 5.2 and 5.3, and in step 3 Eq. 5.7 for the derivatives. First turn the setup's
    // vectors into Vec3<F>. In a whole triangle the numerators are just inverse_w times on_screen.
    return {on_screen, Vec3<F>(F(0.0f)), Vec3<F>(F(0.0f))};
}

}  // namespace rasterbook
