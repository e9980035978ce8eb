// SPDX-License-Identifier: MIT
/// @file
/// Triangles filled several pixels at a time. Introduced in lesson 14;
/// derivation: docs/derivations/14_simd.md.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "09_shadow_maps/shadow_map.hpp"
#include "10_threading/binned_triangles.hpp"
#include "10_threading/split.hpp"
#include "10_threading/threaded_shadows.hpp"
#include "11_scenes/scene_assets.hpp"
#include "13_visibility_buffer/visibility_buffer.hpp"
#include "14_simd/simd.hpp"
#include "common/image/backdrop.hpp"

namespace rasterbook {

/// The three edge functions of a triangle at N pixels of a row (Eq. 14.2).
///
/// @tparam Whole  Holds all of these whole numbers exactly: Ints<N> for small triangles, Doubles<N>
///                for others.
template <typename Whole>
struct WideEdges {
    static constexpr int N = Whole::width;
    std::array<Whole, 3> at;  ///< Inside > 0.
    std::array<Whole, 3> to_next_pixels;

    /// @param column  Of the first pixel, counted from where the edges are.
    WideEdges(const std::array<EdgeWalk, 3>& edges, std::int64_t column) {
        // TODO: step 2: Eq. 14.2: each edge's values at N pixels, and what they change by to the
        // next N pixels.
        const auto in_all_lanes = [](std::int64_t x) {
            return Whole(static_cast<typename Whole::Number>(x));
        };
        for (std::size_t i = 0; i < 3; ++i) at[i] = to_next_pixels[i] = in_all_lanes(0);
    }

    void advance() {
        for (std::size_t i = 0; i < 3; ++i) at[i] += to_next_pixels[i];
    }

    /// Rounding keeps the order: what is at least 0 or 1 stays so.
    Vec3<Floats<N>> as_floats() const {
        return {to_floats(at[0]), to_floats(at[1]), to_floats(at[2])};
    }
};

/// In this many pixels each way, a triangle's edge functions fit into 32 bits, also in the columns
/// that the walk goes beyond its box: 100 * (131 + 100) * 65536 < 2^31.
constexpr int pixels_in_32_bits = 100;

/// Visits the pixels of a box that a triangle covers, N of a row at a time. Always inlined: then
/// `emit` keeps in registers what it would otherwise load for each row.
template <typename Whole, typename Emit>
[[gnu::always_inline]] inline void fill_box(std::array<EdgeWalk, 3> edges, float inv_area,
                                            const PixelBox& box, Emit&& emit) {
    constexpr int N = Whole::width;
    using F = Floats<N>;
    // TODO: step 2: the same by WideEdges, N pixels at a time. A lane is covered where all three
    // are at least their `least` (Eq. 14.2), and where its pixel is in the box. Emit each N pixels
    // with their mask. Then the next N, the next row. Where Whole is Doubles<N>, begin and end each
    // row as lesson 02 does: by narrow().
    //
    // Until then, a pixel at a time, in the first lane:
    for (int y = box.first.y; y <= box.last.y; ++y)
        for (int x = box.first.x; x <= box.last.x; ++x) {
            bool is_covered = true;
            Vec3<F> share;
            for (int i = 0; i < 3; ++i) {
                const EdgeWalk& edge = edges[static_cast<std::size_t>(i)];
                const std::int64_t value =
                    edge.value + (x - box.first.x) * edge.step_x + (y - box.first.y) * edge.step_y;
                is_covered = is_covered && value >= edge.least;
                share[i] = F(static_cast<float>(value));
            }
            if (is_covered) emit(ivec2(x, y), first_lanes<F>(1), share * F(inv_area));
        }
}

/// Whether no pixel of a box is inside of an edge: a trivial reject. The edge function is largest
/// in a corner.
inline bool is_outside(const EdgeWalk& edge, const PixelBox& box) {
    const ivec2 steps = box.last - box.first;
    return edge.value + std::max<std::int64_t>(0, steps.x * edge.step_x) +
               std::max<std::int64_t>(0, steps.y * edge.step_y) <
           edge.least;
}

/// Visits the pixels whose centres a triangle covers, as many of a row at a time as F has numbers.
///
/// @param triangle  Its vertices lie less than 2^17 pixels from the origin: then a double holds its
///                  edge functions exactly.
/// @param emit      Called as emit(ivec2 first_pixel, MaskOf<F> covered, Vec3<F> barycentrics).
///                  Where the mask does not hold, the coordinates are of no meaning.
template <typename F, typename Emit>
void fill_triangle(const ScreenTriangle& triangle, ivec2 first, ivec2 last, Emit&& emit) {
    if constexpr (width_of<F> == 1) {
        fill_triangle(triangle, first, last,
                      [&](ivec2 pixel, Barycentrics at) { emit(pixel, true, at); });
    } else {
        const PixelBox around = box_around(triangle), box = common_box(around, {first, last});
        if (triangle.twice_area == 0 || box.is_empty()) return;
        const auto [a, b, c] = triangle.vertices;
        const int winding = triangle.twice_area > 0 ? 1 : -1;
        const std::array<EdgeWalk, 3> edges{EdgeWalk(b, c, winding, box.first),
                                            EdgeWalk(c, a, winding, box.first),
                                            EdgeWalk(a, b, winding, box.first)};
        const auto inv_area =
            static_cast<float>(1.0 / static_cast<double>(winding * triangle.twice_area));
        const ivec2 size = around.last - around.first + 1;
        if (std::max(size.x, size.y) < pixels_in_32_bits)
            fill_box<Ints<width_of<F>>>(edges, inv_area, box, emit);
        else if (std::ranges::none_of(edges, [&](auto& edge) { return is_outside(edge, box); }))
            fill_box<Doubles<width_of<F>>>(edges, inv_area, box, emit);
    }
}

/// Visits the pixels of a tile that a triangle covers.
template <typename F, typename Emit>
void fill_tile(const ScreenTriangle& triangle, const Tile& tile, Emit&& emit) {
    for_each_strip(tile, box_around(triangle), [&](const PixelBox& strip) {
        fill_triangle<F>(triangle, strip.first, strip.last, emit);
    });
}

/// The depths inside a triangle, interpolated from the vertices' depths (Eq. 3.3).
template <typename F>
F depth_at(const TriangleDepth& depth, const Vec3<F>& barycentrics) {
    return F(depth.farthest()) + glm::dot(barycentrics, Vec3<F>(depth.above_farthest()));
}

/// The depths of a tile's pixels, in memory of their own. Behind each row there is some that may be
/// written and means nothing: so all numbers of an F can be read and written at once, although the
/// last ones may lie beyond the tile.
class TileDepths {
  public:
    static constexpr int padding = 16;  ///< As many as the widest F has.

    /// Cleared.
    ///
    /// @param farthest  As DepthBuffer has it.
    explicit TileDepths(const Tile& tile, float farthest = DepthBuffer::cleared)
        : layout_(tile, padding), depths_(layout_.size(), farthest), farthest_(farthest) {}

    /// Those from a pixel to the end of its row.
    float* from(ivec2 pixel) { return &depths_[layout_[pixel]]; }

    /// The depth test for as many pixels of a row as F has numbers.
    ///
    /// @return  Where the depths are nearer, and have been written.
    template <typename F>
    MaskOf<F> test_and_write(ivec2 pixel, MaskOf<F> covered, F depth) {
        // TODO: step 2: load as many depths, compare, select, store; `padding` makes room for it.
        // Until then, the first lane alone:
        float* const nearest = from(pixel);
        if (!lane_of(covered, 0) || !(lane_of(depth, 0) > *nearest)) return first_lanes<F>(0);
        *nearest = lane_of(depth, 0);
        return first_lanes<F>(1);
    }

    /// Calls take(span) for the pixels that nothing covers.
    template <typename Take>
    void for_each_empty_span(const Tile& tile, Take&& take) {
        using F = Floats<native_width>;
        const auto is_empty = [this](auto depth) { return depth == decltype(depth)(farthest_); };
        const auto is_covered = [&](auto depth) { return !is_empty(depth); };
        const auto [first, last] = tile.box;
        for (int y = first.y; y <= last.y; y += tile.row_step) {
            const float* const depths = from({first.x, y});
            for (int x = 0, end = 0; x < layout_.width(); x = end) {
                x = first_where<F>(depths, x, layout_.width(), is_empty);
                end = first_where<F>(depths, x, layout_.width(), is_covered);
                if (end > x) take(PixelSpan{{first.x + x, y}, end - x});
            }
        }
    }

    /// Writes them into an image, at the tile's place moved by `offset`.
    void copy_to(Image<float>& image, const Tile& tile, ivec2 offset) {
        const auto [first, last] = tile.box;
        for (int y = first.y; y <= last.y; y += tile.row_step)
            std::copy_n(from({first.x, y}), layout_.width(), &image[ivec2(first.x, y) + offset]);
    }

  private:
    TileLayout layout_;
    std::vector<float> depths_;
    float farthest_;
};

/// Draws what lies behind the triangles, where none of them is. Before that, the pixels have no
/// colour: nobody writes what is overwritten anyway.
inline void draw_background(Image<vec3>& color, const Tile& tile, TileDepths& depths,
                            bool is_on_paper) {
    depths.for_each_empty_span(tile, [&](const PixelSpan& span) {
        fill<Floats<native_width>>(
            &color[span.first], span.length,
            is_on_paper ? paper_color : backdrop_color(span.first.y, color.size().y));
    });
}

}  // namespace rasterbook
