// SPDX-License-Identifier: MIT
/// @file
/// Tangent frames: how a texture lies on a surface. Introduced in lesson 08; derivation:
/// docs/derivations/08_normal_maps.md.
#pragma once

#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "common/math/functions.hpp"
#include "common/math/numerics.hpp"
#include "common/math/types.hpp"

namespace rasterbook {

/// The directions in which the texture coordinates grow on a triangle.
struct UvDirections {
    vec3 tangent{0};     ///< u grows, v stays; length 1, or 0 where there is no such direction.
    vec3 bitangent{0};   ///< v grows, u stays; the same.
    int handedness = 0;  ///< -1 where the texture is mirrored, else 1; 0: no area in the texture.
};

/// The directions that take the triangle's sides from the texture to the surface (Eq. 8.2): solved
/// by the inverse of a 2x2 matrix (Eq. 8.3). Its determinant has the sign of the handedness
/// (Eq. 8.4). With handedness 0, both directions are 0.
///
/// @param positions,uvs  Of the vertices. Any numbers: with a uv that is not finite, the handedness
///          is 0; with a position that is not, it is that of the uvs, and both directions are 0.
/// @return  As exact for tiny triangles as for huge ones. The sides are taken from the first
///          vertex: another one that comes first changes roundings. All is computed in double, with
///          an error of 2^-51 times (|e1 v2| + |e2 v1|) / |v2 e1 - v1 e2|, and then rounded to
///          float. The handedness is exact where the differences of the uvs are: between floats
///          that are 0 or less than 2^29 times each other.
template <typename Uv = vec2>
UvDirections uv_directions(const std::array<vec3, 3>& positions, const std::array<Uv, 3>& uvs) {
    // double: products of floats may overflow or vanish
    const dvec3 e1 = dvec3(positions[1]) - dvec3(positions[0]);
    const dvec3 e2 = dvec3(positions[2]) - dvec3(positions[0]);
    const dvec2 d1 = dvec2(uvs[1]) - dvec2(uvs[0]), d2 = dvec2(uvs[2]) - dvec2(uvs[0]);
    const double determinant = difference_of_products(d1.x, d2.y, d2.x, d1.y);
    const int handedness = (determinant > 0) - (determinant < 0);  // Eq. 8.4
    if (handedness == 0 || !std::isfinite(determinant)) return {};
    // Eq. 8.3. Only directions count: of the determinant, the sign is enough.
    const double sign = handedness;
    return {vec3(normalize_or(sign * (d2.y * e1 - d1.y * e2), dvec3(0))),
            vec3(normalize_or(sign * (d1.x * e2 - d2.x * e1), dvec3(0))), handedness};
}

/// What is left of v when its component along the normal is taken away (Eq. 8.5).
///
/// @param normal  Length 1.
template <typename F>
Vec3<F> across(Vec3<F> v, Vec3<F> normal) {
    return v - glm::dot(v, normal) * normal;
}

/// A direction perpendicular to n: along the axis, x, y or z, along which n is shortest in absolute
/// value (the first of equals), less its component along n.
///
/// @param n  Length 1.
/// @return   Length 1.
template <typename F>
Vec3<F> any_orthogonal(Vec3<F> n) {
    const Vec3<F> size(max(n.x, -n.x), max(n.y, -n.y), max(n.z, -n.z));
    const Vec3<F> x(vec3(1, 0, 0)), y(vec3(0, 1, 0)), z(vec3(0, 0, 1));
    const Vec3<F> axis =
        select((size.x <= size.y) & (size.x <= size.z), x, select(size.y <= size.z, y, z));
    return unit_or(across(axis, n), axis);
}

/// The TBN basis: orthonormal, unless a method of the lab leaves it skewed.
template <typename F>
struct TangentBasis {
    Vec3<F> tangent, bitangent, normal;
};
using TangentFrame = TangentBasis<float>;

/// One step of Eq. 8.5 is exact enough if the square of what across() leaves is more than this
/// times the square of the tangent: then the two are less than 30 degrees apart.
constexpr float mostly = 0.75f;

/// If that square is no more than this times the tangent's, no digit of what is left is true: it is
/// 2^-20 of the tangent's length at most.
constexpr float hardly_any = 0x1p-40f;

/// What is left of a tangent perpendicular to the normal, scaled to length 1 (Eq. 8.5).
///
/// @param tangent  Any numbers.
/// @param normal   Length 1.
/// @return         any_orthogonal(normal) where nothing is left: the tangent is 0, not finite, or
///                 parallel to the normal but for `hardly_any` of its square.
template <typename F>
Vec3<F> unit_orthogonal(Vec3<F> tangent, Vec3<F> normal) {
    const Vec3<F> left = across(tangent, normal);
    const F left_squared = glm::dot(left, left), squared = glm::dot(tangent, tangent);
    const Vec3<F> unit = left * (F(1.0f) / sqrt(left_squared));
    const auto is_usable =
        (left_squared > F(mostly) * squared) & (left_squared > F(1e-30f)) & (squared < F(1e30f));
    if (all_of(is_usable)) return unit;
    // Robust: where little is left, it is mostly rounding error, and may lean along the normal.
    // Scale it, and take that component away once more.
    const Vec3<F> little = across(unit_or(tangent, normal), normal);
    const Vec3<F> less = unit_or(across(unit_or(little, normal), normal), normal);
    const auto is_something = glm::dot(little, little) > F(hardly_any);
    return select(is_usable, unit, select(is_something, less, any_orthogonal(normal)));
}

/// The frame at a point (Eq. 8.5).
///
/// @param tangent     Any numbers; any_orthogonal() takes its place where nothing of it is
///                    perpendicular to the normal.
/// @param normal      Of any length; up where it is zero-length or not finite.
/// @param handedness  -1 or 1.
/// @return            Orthonormal within 2^-20, also for numbers that are not finite.
template <typename F>
TangentBasis<F> tangent_frame(Vec3<F> tangent, Vec3<F> normal, F handedness) {
    const Vec3<F> n = unit_or(normal, Vec3<F>(vec3(0, 1, 0)));
    const Vec3<F> t = unit_orthogonal(tangent, n);
    return {t, handedness * glm::cross(n, t), n};
}

}  // namespace rasterbook
