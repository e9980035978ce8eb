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
#include "10_threading/threaded_shadows.hpp"
#include "13_simd/simd.hpp"

namespace rasterbook {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

/// One edge of a triangle at N pixels of a row, in whole numbers of a type that holds them exactly.
template <typename Whole, int N>
struct WideEdge {
    Vector<Whole, N> at_row;  ///< At the first N pixels of a row.
    Whole step_x, step_y;     ///< From N pixels to the next N, and to the next row.
    Floats<N> least;

    explicit WideEdge(const EdgeWalk& edge)
        : step_x(static_cast<Whole>(N * edge.step_x)),
          step_y(static_cast<Whole>(edge.step_y)),
          least(static_cast<float>(edge.least)) {
        for (int i = 0; i < N; ++i) at_row[i] = static_cast<Whole>(i);
        at_row = static_cast<Whole>(edge.value) + at_row * static_cast<Whole>(edge.step_x);
    }
};

template <typename Whole, int N, typename Emit>
void fill_wide(const std::array<EdgeWalk, 3>& edges, float per_area, ivec2 first, ivec2 last, Emit&& emit) {
    using F = Floats<N>;
    WideEdge<Whole, N> edge_a(edges[0]), edge_b(edges[1]), edge_c(edges[2]);
    for (int y = first.y; y <= last.y; ++y) {
        auto at_a = edge_a.at_row, at_b = edge_b.at_row, at_c = edge_c.at_row;
        for (int x = first.x; x <= last.x; x += N) {
            const auto floats = [](const auto& at) {
                return F(__builtin_convertvector(at, Vector<float, N>));
            };
            // Rounding keeps the order: what is at least 0 or 1 stays so.
            const F share_a = floats(at_a), share_b = floats(at_b), share_c = floats(at_c);
            const Mask<N> covered = (share_a >= edge_a.least) & (share_b >= edge_b.least) &
                                    (share_c >= edge_c.least) & first_lanes<N>(last.x - x + 1);
            if (std::is_same_v<Whole, std::int32_t> || any_of(covered)) emit(ivec2(x, y), covered, Vec3<F>(share_a, share_b, share_c) * F(per_area));
            at_a += edge_a.step_x, at_b += edge_b.step_x, at_c += edge_c.step_x;
        }
        edge_a.at_row += edge_a.step_y, edge_b.at_row += edge_b.step_y;
        edge_c.at_row += edge_c.step_y;
    }
}

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
    const std::array<EdgeWalk, 3> edges{EdgeWalk(b, c, winding, first_pixel),
                                        EdgeWalk(c, a, winding, first_pixel),
                                        EdgeWalk(a, b, winding, first_pixel)};
    const auto per_area =
        static_cast<float>(1.0 / static_cast<double>(winding * triangle.twice_area));
    const ivec2 extent = high - low;
    if (std::max(extent.x, extent.y) < 100 * subpixels)
        fill_wide<std::int32_t, N>(edges, per_area, first_pixel, last_pixel, emit);
    else
        fill_wide<double, N>(edges, per_area, first_pixel, last_pixel, emit);
}

/// As fill_tile() of lesson 10.
template <int N, typename Emit>
void fill_tile_wide(const ScreenTriangle& triangle, const Tile& tile, Emit&& emit) {
    for_each_strip(tile, box_around(triangle), [&](const PixelBox& strip) {
        fill_triangle_wide<N>(triangle, strip.first, strip.last, emit);
    });
}

template <int N, typename CounterPolicy>
inline void count_lanes(CounterPolicy& counters, Counter counter, Mask<N> mask) {
    for (std::uint32_t bits = bits_of(mask); bits; bits &= bits - 1) counters.add(counter);
}
template <int N>
inline void count_lanes(NoCounters&, Counter, Mask<N>) {}

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

/// As draw_tile() of lesson 10.
template <int N, typename CounterPolicy>
void draw_tile_wide(ShadowMap& map, const BinnedTriangles& casters, const Tiling& tiling,
                    std::size_t i, CounterPolicy& counters) {
    const Tile tile = tiling[i];
    clear_tile(map, tile);  // also what lies around the map
    const auto [first, last] = tile.box;
    const int width = last.x - first.x + 1, pitch = width + N;
    thread_local std::vector<float> depths;
    depths.assign(static_cast<std::size_t>(pitch * (last.y - first.y + 1)), DepthBuffer::cleared);
    casters.for_each_in(i, [&](const ProjectedTriangle& caster) {
        fill_tile_wide<N>(caster.on_screen, tile,
                          [&](ivec2 texel, Mask<N> covered, const Vec3<Floats<N>>& at) {
                              count_lanes(counters, Counter::shadow_fragments, covered);
                              const ivec2 in_tile = texel - first;
                              test_and_write_wide<N>(&depths[static_cast<std::size_t>(
                                                         in_tile.y * pitch + in_tile.x)],
                                                     covered, caster.depth.at(at));
                          });
    });
    for (int y = first.y; y <= last.y; ++y)
        std::copy_n(&depths[static_cast<std::size_t>((y - first.y) * pitch)], width,
                    &map.depths.depths()[ivec2(first.x, y) + max_pcf_radius]);
}

#pragma GCC diagnostic pop
}  // namespace rasterbook
