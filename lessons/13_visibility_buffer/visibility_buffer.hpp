// SPDX-License-Identifier: MIT
/// @file
/// Which triangle is visible in each pixel. Introduced in lesson 13; derivation:
/// docs/derivations/13_visibility_buffer.md.
#pragma once

#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "02_triangle_fill/triangle.hpp"
#include "04_mvp/projection.hpp"
#include "10_threading/split.hpp"

namespace rasterbook {

/// A triangle's number among the opaque ones of its tile, in drawing order.
using TriangleId = std::uint32_t;

constexpr TriangleId no_triangle = std::numeric_limits<TriangleId>::max();

/// Pixels that follow each other in a row.
struct PixelSpan {
    ivec2 first;
    int length;
};

/// The barycentric coordinates of all of a triangle's pixels, before they are divided by its area:
/// three planes over the screen (Eq. 13.2).
class BarycentricPlanes {
  public:
    /// @param triangle  With an area.
    explicit BarycentricPlanes(const ScreenTriangle& triangle)
        : inv_area_(static_cast<float>(1.0 / std::abs(static_cast<double>(triangle.twice_area)))) {
        const int winding = triangle.twice_area > 0 ? 1 : -1;
        for (std::size_t i = 0; i < 3; ++i) {  // as fill_triangle() walks: opposite to the vertex
            const EdgeWalk edge(triangle.vertices[(i + 1) % 3], triangle.vertices[(i + 2) % 3],
                                winding, ivec2(0));
            at_origin_[i] = edge.value, step_x_[i] = edge.step_x, step_y_[i] = edge.step_y;
        }
    }

    /// Calls take(pixel, Barycentrics) for each pixel of a span: the same bits that fill_triangle()
    /// gives.
    template <typename Take>
    void for_each_in(const PixelSpan& span, Take&& take) const {
        std::array<std::int64_t, 3> share;  // of the area, times two
        for (std::size_t i = 0; i < 3; ++i)
            share[i] = at_origin_[i] + span.first.x * step_x_[i] + span.first.y * step_y_[i];
        for (int x = 0; x < span.length; ++x) {
            take(span.first + ivec2(x, 0), Barycentrics(share[0], share[1], share[2]) * inv_area_);
            for (std::size_t i = 0; i < 3; ++i) share[i] += step_x_[i];
        }
    }

  private:
    std::array<std::int64_t, 3> at_origin_, step_x_, step_y_;
    float inv_area_;
};

/// Where the pixels of a tile are kept: row by row.
class TileLayout {
  public:
    /// @param padding  At least so many elements behind each row may be written, and mean nothing.
    explicit TileLayout(const Tile& tile, int padding = 0)
        : first_(tile.box.first),
          width_(tile.box.last.x - first_.x + 1),
          pitch_((width_ + padding + tile.row_step - 1) / tile.row_step),
          size_(static_cast<std::size_t>(tile.box.last.y - first_.y + tile.row_step) *
                static_cast<std::size_t>(pitch_)) {}

    std::size_t size() const { return size_; }  ///< Of an array that holds them.
    int width() const { return width_; }        ///< Of the tile, in pixels.

    /// The index of a pixel in one of the tile's own rows.
    std::size_t operator[](ivec2 pixel) const {
        const ivec2 from_first = pixel - first_;
        return static_cast<std::size_t>(from_first.y) * static_cast<std::size_t>(pitch_) +
               static_cast<std::size_t>(from_first.x);
    }

  private:
    ivec2 first_;
    int width_;
    int pitch_;  ///< From a row of the picture to the next. Only each row_step-th is the tile's.
    std::size_t size_;
};

/// The triangles of a tile in drawing order, and for each of its pixels the one that is nearest so
/// far.
class VisibilityBuffer {
  public:
    /// @param max_ids  So many triangles can be told apart: 1 to no_triangle.
    /// @param padding  So many ids behind each row may be written, and mean nothing.
    explicit VisibilityBuffer(std::size_t max_ids, int padding = 0)
        : max_ids_(max_ids), padding_(padding) {
        assert(max_ids >= 1 && max_ids <= no_triangle);
    }

    /// Begins a tile: there is no triangle in it yet.
    void begin(const Tile& tile) {
        tile_ = tile;
        layout_ = TileLayout(tile, padding_);
        clear();
    }

    const Tile& tile() const { return tile_; }
    /// Those that were added, by id.
    std::span<const ProjectedTriangle* const> triangles() const { return triangles_; }

    /// Whether all ids are taken.
    bool is_full() const { return triangles_.size() == max_ids_; }

    /// Adds a triangle, and returns its id.
    ///
    /// @param projected  Has to outlive the next take_visible().
    TriangleId add(const ProjectedTriangle& projected) {
        assert(!is_full() && "its id would be another triangle's");
        triangles_.push_back(&projected);
        return static_cast<TriangleId>(triangles_.size() - 1);
    }

    /// Notes that a triangle is the nearest in this pixel so far (Eq. 13.1).
    void write(ivec2 pixel, TriangleId id) { ids_[layout_[pixel]] = id; }

    /// The ids from a pixel to the end of its row.
    TriangleId* ids_from(ivec2 pixel) { return &ids_[layout_[pixel]]; }

    /// Visits each triangle that is visible in a pixel, in drawing order, with its pixels row by
    /// row (Eq. 13.3). Then the tile has no triangles any more.
    ///
    /// @param visit  Called as visit(const ProjectedTriangle&, std::span<const PixelSpan>).
    template <typename Visit>
    void take_visible(Visit&& visit) {
        // Count, so that each triangle's spans have their place; then put them there.
        end_.assign(triangles_.size() + 1, 0);
        found_.clear();
        for_each_span([&](const PixelSpan& span, TriangleId id) {
            found_.emplace_back(span, id);
            ++end_[id + 1];
        });
        for (std::size_t id = 1; id < end_.size(); ++id) end_[id] += end_[id - 1];
        spans_.resize(found_.size());
        for (const auto& [span, id] : found_) spans_[end_[id]++] = span;
        std::size_t begin = 0;
        for (std::size_t id = 0; id < triangles_.size(); begin = end_[id++])
            if (begin < end_[id])
                visit(*triangles_[id],
                      std::span<const PixelSpan>(spans_).subspan(begin, end_[id] - begin));
        clear();
    }

    /// The tile has no triangles any more.
    void clear() {
        triangles_.clear();
        ids_.assign(layout_.size(), no_triangle);
    }

  private:
    /// Calls take(span, id) for all pixels of the tile in which there is a triangle.
    template <typename Take>
    void for_each_span(Take&& take) const {
        const auto [first, last] = tile_.box;
        for (int y = first.y; y <= last.y; y += tile_.row_step) {
            const TriangleId* const ids = &ids_[layout_[{first.x, y}]];
            for (int x = 0, end = 0; x < layout_.width(); x = end) {
                while (end < layout_.width() && ids[end] == ids[x]) ++end;
                if (ids[x] != no_triangle) take(PixelSpan{{first.x + x, y}, end - x}, ids[x]);
            }
        }
    }

    std::size_t max_ids_;
    int padding_;
    Tile tile_{};
    TileLayout layout_{tile_};
    std::vector<TriangleId> ids_;
    std::vector<const ProjectedTriangle*> triangles_;
    std::vector<std::pair<PixelSpan, TriangleId>> found_;  ///< Row by row.
    std::vector<PixelSpan> spans_;                         ///< Triangle by triangle.
    std::vector<std::size_t> end_;                         ///< Of each triangle's spans in spans_.
};

}  // namespace rasterbook
