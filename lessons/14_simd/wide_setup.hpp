// SPDX-License-Identifier: MIT
/// @file
/// Triangles projected several at a time. Introduced in lesson 14;
/// derivation: docs/derivations/14_simd.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "02_triangle_fill/triangle.hpp"
#include "04_mvp/projection.hpp"
#include "10_threading/binned_triangles.hpp"
#include "14_simd/simd.hpp"
#include "14_simd/wide_textures.hpp"

namespace rasterbook {

/// The nearest whole number, halves to even, as std::lrint rounds them.
///
/// @param x  0 or more.
template <int N>
Floats<N> rounded(Floats<N> x) {
    const Floats<N> whole_from_here(0x1p23f);
    return select(x < whole_from_here, (x + whole_from_here) - whole_from_here, x);
}

/// Four floats at each of n / 4 addresses.
///
/// @param address_of  Called with first, first + 4, first + 8 ...
template <int n, typename AddressOf>
Vector<float, n> read_fours(int first, const AddressOf& address_of) {
    if constexpr (n == 4) {
        Vector<float, 4> four;
        std::memcpy(&four, address_of(first), sizeof four);
        return four;
    } else {
        return shuffled<n>(read_fours<n / 2>(first, address_of),
                           read_fours<n / 2>(first + n / 2, address_of),
                           [](int i) constexpr { return i; });
    }
}

/// A vertex of each of N triangles, in clip space.
///
/// @param vertex  0, 1 or 2.
template <int N>
glm::vec<4, Floats<N>> vertices_of(std::span<const Triangle> triangles, std::size_t vertex,
                                   const vec4* positions_clip) {
    const auto address_of = [&](int lane) {
        const Triangle& triangle = triangles[static_cast<std::size_t>(lane)];
        return &positions_clip[triangle.vertices[vertex].position];
    };
    return channels_of<N>({read_fours<N>(0, address_of), read_fours<N>(1, address_of),
                           read_fours<N>(2, address_of), read_fours<N>(3, address_of)});
}

/// N triangles on the screen, as project() of lesson 04 finds them.
template <int N>
struct WideScreenTriangles {
    std::array<Ints<N>, 3> x, y;   ///< Of the vertices, snapped.
    std::array<Floats<N>, 3> z;    ///< Depths.
    Vector<double, N> twice_area;  ///< Whole numbers.
    Mask<N> is_plain;  ///< All inside of the frustum, with nothing unusual. Else the rest means
                       ///< nothing.
};

/// Pictures have fewer pixels than this along a side: then a double holds twice an area exactly.
constexpr float wide_limit = 1 << 17;

/// @param triangles  N of them.
template <int N>
WideScreenTriangles<N> project_plain(std::span<const Triangle> triangles,
                                     const vec4* positions_clip, ivec2 size) {
    using F = Floats<N>;
    const F zero(0.0f), half(0.5f), one(1.0f), limit(wide_limit),
        steps(static_cast<float>(subpixels));
    const F width(static_cast<float>(size.x)), height(static_cast<float>(size.y));
    WideScreenTriangles<N> on_screen;
    on_screen.is_plain = first_lanes<F>(N);
    for (std::size_t v = 0; v < 3; ++v) {
        const auto at = vertices_of<N>(triangles, v, positions_clip);
        Mask<N> is_inside = at.w < F(clip_limit);
        for (int axis = 0; axis < 2; ++axis)  // Eq. 4.10
            is_inside = is_inside & (at.w + at[axis] >= zero) & (at.w - at[axis] >= zero);
        is_inside = is_inside & (at.w - at.z >= zero) & (at.z >= zero);
        // Eq. 4.9 and 2.8.
        const F x = (at.x / at.w + one) * half * width;
        const F y = (one - at.y / at.w) * half * height;
        on_screen.z[v] = at.z / at.w;
        const Mask<N> is_usable = is_inside & (x < limit) & (y < limit);  // false for NaN
        on_screen.x[v] = truncated(rounded(select(is_usable, x, zero) * steps));
        on_screen.y[v] = truncated(rounded(select(is_usable, y, zero) * steps));
        on_screen.is_plain = on_screen.is_plain & is_usable;
    }
    const auto from_first = [](const std::array<Ints<N>, 3>& of, std::size_t v) {
        return __builtin_convertvector((of[v] - of[0]).lanes, Vector<double, N>);
    };
    on_screen.twice_area = from_first(on_screen.y, 1) * from_first(on_screen.x, 2) -
                           from_first(on_screen.x, 1) * from_first(on_screen.y, 2);  // Eq. 2.2
    return on_screen;
}

/// Projects triangles and culls them, as many at once as F has numbers. Those that have to be
/// clipped, or are unusual, take the steps of lesson 10.
template <typename F>
std::size_t project_triangles(const Mesh& mesh, std::span<const Triangle> triangles,
                              const vec4* positions_clip, ivec2 size, Culling culling,
                              std::vector<ProjectedTriangle>& projected) {
    constexpr std::size_t N = width_of<F>;
    std::size_t culled = 0;
    if constexpr (N > 1)
        for (; triangles.size() >= N; triangles = triangles.subspan(N)) {
            const auto [x, y, z, twice_area, is_plain] =
                project_plain<N>(triangles.first(N), positions_clip, size);
            for (int i = 0; i < static_cast<int>(N); ++i) {
                const auto one = triangles.subspan(static_cast<std::size_t>(i), 1);
                if (!is_plain[i] || is_probing()) {
                    culled +=
                        project_triangles(mesh, one, positions_clip, size, culling, projected);
                    continue;
                }
                const auto area = static_cast<std::int64_t>(twice_area[i]);
                const bool is_back_facing = area <= 0;
                if (is_back_facing && culling == Culling::back_faces) {
                    ++culled;
                    continue;
                }
                if (area == 0) continue;
                const auto& [p, q, r] = one[0].vertices;
                projected.push_back(
                    {mesh,
                     one[0],
                     {{{positions_clip[p.position], {1, 0, 0}},
                       {positions_clip[q.position], {0, 1, 0}},
                       {positions_clip[r.position], {0, 0, 1}}}},
                     {{ivec2(x[0][i], y[0][i]), ivec2(x[1][i], y[1][i]), ivec2(x[2][i], y[2][i])},
                      area},
                     TriangleDepth(vec3(z[0][i], z[1][i], z[2][i])),
                     is_back_facing});
            }
        }
    return culled + project_triangles(mesh, triangles, positions_clip, size, culling, projected);
}

}  // namespace rasterbook
