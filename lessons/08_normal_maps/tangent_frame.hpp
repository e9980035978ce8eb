// SPDX-License-Identifier: MIT
/// @file
/// Tangent frames: how a texture lies on a surface. Introduced in lesson 08; derivation:
/// docs/derivations/08_normal_maps.md.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>

#include "06_phong/normals.hpp"
#include "common/math/functions.hpp"
#include "common/math/numerics.hpp"
#include "common/model/mesh.hpp"

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
///          float. The handedness is exact where the differences of the uvs are: between numbers
///          that are 0 or less than 2^29 times each other.
inline UvDirections uv_directions(const std::array<vec3, 3>& positions,
                                  const std::array<vec2, 3>& uvs) {
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

/// The TBN basis: orthonormal, unless a variant leaves it skewed.
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

/// What one vertex adds to the tangent that it shares with others.
struct TangentShare {
    std::array<std::uint32_t, 9> key;  ///< Those with the same bits share a tangent.
    std::uint32_t normal;              ///< Index of the vertex's normal.
    std::array<std::int64_t, 3> share;
};

/// A triangle's share at one of its vertices: its angle there times its tangent (Eq. 8.6), in
/// whole numbers of 2^-40. Which vertex of the triangle comes first in the file does not change a
/// bit.
///
/// @param mesh  As complete_normals() leaves it: each vertex has a normal of its own.
/// @param uvs   Of the triangle's vertices.
/// @return      A share of 0 where nothing of the tangent is perpendicular to the normal.
inline TangentShare tangent_share(const Mesh& mesh, const Triangle& triangle,
                                  const std::array<vec2, 3>& uvs, std::size_t vertex) {
    const std::size_t next = (vertex + 1) % 3, last = (vertex + 2) % 3;
    const auto position = [&](std::size_t i) {
        return mesh.positions[triangle.vertices[i].position];
    };
    // Seen from this vertex, as if it were the first one.
    const auto [tangent, bitangent, handedness] = uv_directions(
        {position(vertex), position(next), position(last)}, {uvs[vertex], uvs[next], uvs[last]});
    const std::uint32_t normal = triangle.vertices[vertex].normal;
    const vec3 p = position(vertex), n = mesh.normals[normal];
    const vec2 uv = uvs[vertex];
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x + 0.0f); };  // -0 is 0
    TangentShare own{{bits(p.x), bits(p.y), bits(p.z), bits(n.x), bits(n.y), bits(n.z), bits(uv.x),
                      bits(uv.y), handedness < 0 ? 1u : 0u},
                     normal,
                     {0, 0, 0}};
    const vec3 left = across(tangent, n);
    if (!(glm::dot(left, left) > hardly_any)) return own;
    const double angle_radians = vertex_angle_radians(mesh, triangle, vertex);
    const dvec3 share = angle_radians * dvec3(unit_orthogonal(tangent, n));
    own.share = {std::llround(0x1p40 * share.x), std::llround(0x1p40 * share.y),
                 std::llround(0x1p40 * share.z)};
    return own;
}

/// A tangent for each vertex: the mean of those of the triangles around it, weighted by their
/// angles there (Eq. 8.6). Vertices with the same position, normal, uv and handedness share one.
///
/// Sums of whole numbers have no order: neither that of the triangles nor that of the vertices
/// changes a bit. Where 2^21 triangles or more share a vertex, the last bits of each share do not
/// count, so that the sum stays in range.
///
/// @param mesh    As complete_normals() leaves it: each vertex has a normal of its own.
/// @param uvs_of  Called as uvs_of(triangle); gives std::array<vec2, 3>.
/// @return        For each of the mesh's normals: tangent, of length 1 and perpendicular to the
///                normal, and handedness, that of the triangles, -1 or 1; 1 where theirs is 0.
///                Where no triangle adds anything, the tangent is any_orthogonal().
template <std::invocable<const Triangle&> UvsOf>
std::vector<vec4> vertex_tangents(const Mesh& mesh, UvsOf&& uvs_of) {
    std::vector<TangentShare> shares;
    shares.reserve(3 * mesh.triangles.size());
    for (const Triangle& triangle : mesh.triangles)
        for (std::size_t vertex = 0; vertex < 3; ++vertex)
            shares.push_back(tangent_share(mesh, triangle, uvs_of(triangle), vertex));
    std::ranges::sort(shares, {}, &TangentShare::key);

    std::vector<vec4> tangents(mesh.normals.size(), vec4(0));
    for (auto begin = shares.begin(); begin != shares.end();) {
        const auto end =
            std::ranges::upper_bound(begin, shares.end(), begin->key, {}, &TangentShare::key);
        const int left_out_bits =
            static_cast<int>(std::bit_width(static_cast<std::size_t>(end - begin) >> 21));
        std::array<std::int64_t, 3> sum{};
        for (auto i = begin; i != end; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis)
                sum[axis] += i->share[axis] >> left_out_bits;
        const vec3 tangent =
            unit_orthogonal(vec3(sum[0], sum[1], sum[2]), mesh.normals[begin->normal]);
        for (; begin != end; ++begin)
            tangents[begin->normal] = vec4(tangent, begin->key.back() == 1 ? -1 : 1);
    }
    return tangents;
}

}  // namespace rasterbook
