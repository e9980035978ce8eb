// SPDX-License-Identifier: MIT
/// @file
/// Which pixels of a picture belong to which task. Introduced in lesson 10;
/// derivation: docs/derivations/10_threading.md.
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "02_triangle_fill/triangle.hpp"
#include "common/math/types.hpp"

namespace rasterbook {

/// Pixels from the upper left one to the lower right one, both included. There is none where
/// `last` comes before `first`.
struct PixelBox {
    ivec2 first, last;

    bool is_empty() const { return first.x > last.x || first.y > last.y; }
};

/// The pixels whose centres lie in the bounding box of a triangle: all that it may cover, and some
/// more (Eq. 10.6).
inline PixelBox box_around(const ScreenTriangle& triangle) {
    // TODO: step 1; as fill_triangle finds its first and its last pixel.
    return {ivec2(0), ivec2(-1)};
}

/// About as many pixels are looked at to draw a triangle: its own, and a few in each row and column
/// of its box.
inline double drawing_work(const ScreenTriangle& triangle) {
    const auto [first, last] = box_around(triangle);
    const double area =
        std::abs(static_cast<double>(triangle.twice_area)) / (2.0 * subpixels * subpixels);
    return area + 4.0 * (last.x - first.x + last.y - first.y + 2);
}

/// A box around what a triangle covers of some rows: all that it may cover there, and some more.
inline PixelBox box_in_rows(const ScreenTriangle& triangle, int first_row, int last_row) {
    const double top = double{subpixels} * first_row, bottom = double{subpixels} * (last_row + 1);
    double left = std::numeric_limits<double>::max(), right = -left;
    const auto reaches = [&](double x) { left = std::min(left, x), right = std::max(right, x); };
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec2 a = triangle.vertices[i], b = triangle.vertices[(i + 1) % 3];
        if (a.y >= top && a.y <= bottom) reaches(a.x);
        for (const double y : {top, bottom})
            if ((a.y < y) != (b.y < y)) reaches(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
    }
    if (left > right) return {ivec2(0), ivec2(-1)};
    return {{std::floor(left / subpixels), first_row}, {std::floor(right / subpixels), last_row}};
}

/// What two boxes have in common.
inline PixelBox common_box(const PixelBox& a, const PixelBox& b) {
    return {glm::max(a.first, b.first), glm::min(a.last, b.last)};
}

/// The pixels of one task: of a box, the first row and each `row_step`-th after it.
struct Tile {
    PixelBox box;
    int row_step = 1;
};

/// How to split a picture.
enum class Split { rows, interleaved, tiles };

/// A picture in tiles, or in rows that stand for them. Each pixel is in just one.
class Tiling {
  public:
    /// @param size     Of the picture, each side >= 0. Without pixels there are no tiles.
    /// @param workers  At least 1. Rows and interleaved rows make one tile for each, or one a row
    ///                 where there are fewer rows than workers.
    /// @param tile_size  Pixels along a tile's side, at least 1.
    Tiling(Split split, ivec2 size, std::size_t workers, int tile_size)
        : split_(split), size_(size), tile_size_(tile_size) {
        assert(workers >= 1 && tile_size >= 1);
        // TODO: how many columns and rows of tiles there are: step 1, one column, and a row for
        // each worker; step 2, Eq. 10.5.
    }

    ivec2 size() const { return size_; }
    std::size_t count() const {
        return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    }

    /// @param tile  From 0 to count() - 1.
    Tile operator[](std::size_t tile) const {
        // TODO: step 1, Eq. 10.3, and Eq. 10.4 by row_step; step 2, Eq. 10.5.
        return {{ivec2(0), size_ - 1}};
    }

    /// Calls take(tile) once for each tile that a triangle may reach into: of a large one in each
    /// row of tiles those from the triangle's leftmost point there to its rightmost one.
    template <typename Take>
    void for_each_in(const ScreenTriangle& triangle, Take&& take) const {
        const PixelBox box = common_box(box_around(triangle), {ivec2(0), size_ - 1});
        const ivec2 tiles = (box.last - box.first) / tile_size_;
        if (split_ != Split::tiles || tiles.x * tiles.y < 16) return for_each_in(box, take);
        for (int y = box.first.y / tile_size_ * tile_size_; y <= box.last.y; y += tile_size_)
            for_each_in(common_box(box, box_in_rows(triangle, y, y + tile_size_ - 1)), take);
    }

    /// Calls take(tile) once for each tile that has a pixel in the box.
    template <typename Take>
    void for_each_in(const PixelBox& box, Take&& take) const {
        // TODO: step 4, Eq. 10.6, the box cut to the picture; rows as the text says behind it.
    }

  private:
    /// Of one worker's rows (Eq. 10.3).
    int first_row(int worker) const {
        // TODO: step 1: Eq. 10.3; the product may need 64 bits.
        return worker - worker;
    }

    Split split_;
    ivec2 size_;
    int tile_size_;
    int columns_ = 0, rows_ = 0;  ///< Of tiles.
};

/// Visits the pixels of a tile that lie in a box, as boxes of whole rows: of interleaved rows, each
/// is one.
///
/// @param visit  Called as visit(PixelBox), never with an empty one.
template <typename Visit>
void for_each_strip(const Tile& tile, const PixelBox& box, Visit&& visit) {
    // TODO: step 1; what the two boxes have in common: all at once where row_step is 1, otherwise
    // each of the tile's rows.
}

/// Visits all of a tile.
template <typename Visit>
void for_each_strip(const Tile& tile, Visit&& visit) {
    for_each_strip(tile, tile.box, visit);
}

/// Visits the pixels of a tile whose centres a triangle covers.
template <typename Emit>
void fill_tile(const ScreenTriangle& triangle, const Tile& tile, Emit&& emit) {
    for_each_strip(tile, box_around(triangle), [&](const PixelBox& strip) {
        fill_triangle(triangle, strip.first, strip.last, traced(triangle.vertices, emit));
    });
}

}  // namespace rasterbook
