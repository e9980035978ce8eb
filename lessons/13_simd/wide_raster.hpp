// SPDX-License-Identifier: MIT
/// @file
/// Triangles filled several pixels at a time. Introduced in lesson 13;
/// derivation: docs/derivations/13_simd.md.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "02_triangle_fill/triangle.hpp"
#include "04_mvp/projection.hpp"
#include "10_threading/split.hpp"
#include "13_simd/simd.hpp"

namespace rasterbook {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

/// One edge of a triangle at N pixels of a row. A double holds its whole numbers exactly.
template <int N>
struct WideEdge {
    using Doubles = Vector<double, N>;
    Doubles at_row;         ///< At the first N pixels of a row.
    double step_x, step_y;  ///< From N pixels to the next N, and to the next row.
    Floats<N> least;

    WideEdge(ivec2 a, ivec2 b, int winding, ivec2 first_pixel) {
        const EdgeWalk edge(a, b, winding, first_pixel);
        for (int i = 0; i < N; ++i) at_row[i] = i;
        at_row = static_cast<double>(edge.value) + at_row * static_cast<double>(edge.step_x);
        step_x = static_cast<double>(N * edge.step_x);
        step_y = static_cast<double>(edge.step_y);
        least = Floats<N>(static_cast<float>(edge.least));
    }
};

/// As fill_triangle() of lesson 02, N pixels of a row at a time.
///
/// @param emit  Called as emit(first_pixel, covered, Vec3<Floats<N>>).
template <int N, typename Emit>
void fill_triangle_wide(const ScreenTriangle& triangle, ivec2 first, ivec2 last, Emit&& emit) {
    if (triangle.twice_area == 0) return;
    const auto [a, b, c] = triangle.vertices;
    const ivec2 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
    const ivec2 first_pixel = glm::max((low + (subpixels / 2 - 1)) >> subpixel_bits, first);
    const ivec2 last_pixel = glm::min((high - subpixels / 2) >> subpixel_bits, last);
    if (first_pixel.x > last_pixel.x) return;
    const int winding = triangle.twice_area > 0 ? 1 : -1;
    WideEdge<N> edge_a(b, c, winding, first_pixel), edge_b(c, a, winding, first_pixel),
        edge_c(a, b, winding, first_pixel);
    const auto per_area =
        static_cast<float>(1.0 / static_cast<double>(winding * triangle.twice_area));
    for (int y = first_pixel.y; y <= last_pixel.y; ++y) {
        auto at_a = edge_a.at_row, at_b = edge_b.at_row, at_c = edge_c.at_row;
        for (int x = first_pixel.x; x <= last_pixel.x; x += N) {
            const auto floats = [](const auto& at) {
                return Floats<N>(__builtin_convertvector(at, Vector<float, N>));
            };
            // Rounding keeps the order: what is at least 0 or 1 stays so.
            const Floats<N> share_a = floats(at_a), share_b = floats(at_b), share_c = floats(at_c);
            Mask<N> covered = (share_a >= edge_a.least) & (share_b >= edge_b.least) &
                              (share_c >= edge_c.least);
            if (x + N - 1 > last_pixel.x) covered = covered & first_lanes<N>(last_pixel.x - x + 1);
            if (any_of(covered))
                emit(ivec2(x, y), covered,
                     Vec3<Floats<N>>(share_a, share_b, share_c) * Floats<N>(per_area));
            at_a += edge_a.step_x, at_b += edge_b.step_x, at_c += edge_c.step_x;
        }
        edge_a.at_row += edge_a.step_y, edge_b.at_row += edge_b.step_y;
        edge_c.at_row += edge_c.step_y;
    }
}

/// As fill_tile() of lesson 10.
template <int N, typename Emit>
void fill_tile_wide(const ScreenTriangle& triangle, const Tile& tile, Emit&& emit) {
    for_each_strip(tile, box_around(triangle), [&](const PixelBox& strip) {
        fill_triangle_wide<N>(triangle, strip.first, strip.last, emit);
    });
}

/// Draws the depths of a triangle where they are nearer; returns where that was.
template <int N>
Mask<N> test_and_write_wide(float* depths, Mask<N> covered, Floats<N> depth) {
    Floats<N> before;
    std::memcpy(&before, depths, sizeof before);
    const Mask<N> nearer = covered & (depth < before);
    const Floats<N> now = select(nearer, depth, before);
    std::memcpy(depths, &now, sizeof now);
    return nearer;
}

#pragma GCC diagnostic pop
}  // namespace rasterbook
