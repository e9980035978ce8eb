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
        // TODO: step 2: for each vertex the plane of the edge function opposite to it (Eq. 13.2).
        // EdgeWalk has its value in a pixel, here ivec2(0), and its steps. As in fill_triangle(), a
        // winding of 1 or -1, the sign of twice_area, makes the inside positive.
    }

    /// Calls take(pixel, Barycentrics) for each pixel of a span: the same bits that fill_triangle()
    /// gives.
    template <typename Take>
    void for_each_in(const PixelSpan& span, Take&& take) const {
        // TODO: step 2: Eq. 13.2 in the span's first pixel, in whole numbers; from each pixel to
        // the next, add the steps to the right. For each pixel, make three floats of the sums, as
        // Barycentrics, and multiply them by inv_area_: fill_triangle() does so, too, and a
        // division would round differently.
    }

  private:
    std::array<std::int64_t, 3> at_origin_{}, step_x_{}, step_y_{};
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
        // TODO: step 1: keep it; its id is its place in the list.
        return 0;
    }

    /// Notes that a triangle is the nearest in this pixel so far (Eq. 13.1).
    void write(ivec2 pixel, TriangleId id) {
        // TODO: step 1: the pixel's id is this one from now on. layout_[pixel] is its index.
    }

    /// The ids from a pixel to the end of its row.
    TriangleId* ids_from(ivec2 pixel) { return &ids_[layout_[pixel]]; }

    /// Visits each triangle that is visible in a pixel, in drawing order, with its pixels row by
    /// row (Eq. 13.3). Then the tile has no triangles any more.
    ///
    /// @param visit  Called as visit(const ProjectedTriangle&, std::span<const PixelSpan>).
    template <typename Visit>
    void take_visible(Visit&& visit) {
        // TODO: step 1: for_each_span() finds the tile's spans row by row. Keep them in found_, and
        // count those of each id. Add the counts up: they say where an id's spans begin in spans_
        // (Eq. 13.3). Put each span there, and visit the triangles that have spans, in the order of
        // their ids.
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
