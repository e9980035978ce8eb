// SPDX-License-Identifier: MIT
/// @file
/// Tangents of a mesh's vertices. Introduced in lesson 08; derivation:
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

#include "06_phong/face_normal.hpp"
#include "08_normal_maps/tangent_frame.hpp"
#include "common/math/types.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// What one vertex adds to the tangent that it shares with others.
struct TangentShare {
    std::array<std::uint32_t, 11> key;  ///< Those with the same bits share a tangent.
    std::uint32_t normal;               ///< Index of the vertex's normal.
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
                                  const std::array<dvec2, 3>& uvs, std::size_t vertex) {
    [[maybe_unused]] const std::size_t next = (vertex + 1) % 3, last = (vertex + 2) % 3;
    const auto position = [&](std::size_t i) {
        return mesh.positions[triangle.vertices[i].position];
    };
    // TODO: uv_directions<dvec2>() as seen from this vertex, as if it were the first one. It gives
    // the tangent, and the handedness in place of 1.
    const int handedness = 1;
    const std::uint32_t normal = triangle.vertices[vertex].normal;
    const vec3 p = position(vertex), n = mesh.normals[normal];
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x + 0.0f); };  // -0 is 0
    const auto [u, v] =
        std::bit_cast<std::array<std::array<std::uint32_t, 2>, 2>>(uvs[vertex] + 0.0);
    TangentShare own{{bits(p.x), bits(p.y), bits(p.z), bits(n.x), bits(n.y), bits(n.z), u[0], u[1],
                      v[0], v[1], handedness < 0 ? 1u : 0u},
                     normal,
                     {0, 0, 0}};
    // TODO: a term of Eq. 8.6: vertex_angle_radians() times unit_orthogonal(), the product in
    // double, then each component times 2^40 (0x1p40) and rounded by std::llround(). But 0 unless
    // the square of what across() leaves is above `hardly_any`.
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
/// @param uvs_of  Called as uvs_of(triangle); gives three dvec2, or vec2.
/// @return        For each of the mesh's normals: tangent, of length 1 and perpendicular to the
///                normal, and handedness, that of the triangles, -1 or 1; 1 where theirs is 0.
///                Where no triangle adds anything, the tangent is any_orthogonal().
template <std::invocable<const Triangle&> UvsOf>
std::vector<vec4> vertex_tangents(const Mesh& mesh, UvsOf&& uvs_of) {
    std::vector<TangentShare> shares;
    shares.reserve(3 * mesh.triangles.size());
    for (const Triangle& triangle : mesh.triangles) {
        const auto [a, b, c] = uvs_of(triangle);
        for (std::size_t vertex = 0; vertex < 3; ++vertex)
            shares.push_back(tangent_share(mesh, triangle, {dvec2(a), dvec2(b), dvec2(c)}, vertex));
    }
    std::sort(shares.begin(), shares.end(),
              [](const TangentShare& a, const TangentShare& b) { return a.key < b.key; });

    std::vector<vec4> tangents(mesh.normals.size(), vec4(0));
    for (auto begin = shares.begin(); begin != shares.end();) {
        auto end = begin;
        while (end != shares.end() && end->key == begin->key) ++end;
        const int left_out_bits =
            static_cast<int>(std::bit_width(static_cast<std::size_t>(end - begin) >> 21));
        std::array<std::int64_t, 3> sum{};
        for (auto i = begin; i != end; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis)
                sum[axis] = i->share[axis] >> left_out_bits;  // TODO: their sum
        const vec3 tangent =
            unit_orthogonal(vec3(sum[0], sum[1], sum[2]), mesh.normals[begin->normal]);
        for (; begin != end; ++begin)
            tangents[begin->normal] = vec4(tangent, begin->key.back() == 1 ? -1 : 1);
    }
    return tangents;
}

}  // namespace rasterbook
