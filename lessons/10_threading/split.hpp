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
    const auto [a, b, c] = triangle.vertices;
    const ivec2 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
    return {(low + (subpixels / 2 - 1)) >> subpixel_bits, (high - subpixels / 2) >> subpixel_bits};
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
        if (size.x <= 0 || size.y <= 0) return;
        const auto ceiling = [&](int side) { return (side - 1) / tile_size + 1; };
        columns_ = split == Split::tiles ? ceiling(size.x) : 1;
        rows_ = split == Split::tiles
                    ? ceiling(size.y)
                    : static_cast<int>(std::min(workers, static_cast<std::size_t>(size.y)));
    }

    ivec2 size() const { return size_; }
    std::size_t count() const {
        return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    }

    /// @param tile  From 0 to count() - 1.
    Tile operator[](std::size_t tile) const {
        const int column = static_cast<int>(tile % static_cast<std::size_t>(columns_));
        const int row = static_cast<int>(tile / static_cast<std::size_t>(columns_));
        const ivec2 end = size_ - 1;
        if (split_ == Split::interleaved) return {{{0, row}, end}, rows_};  // Eq. 10.4
        if (split_ == Split::tiles) {                                       // Eq. 10.5
            const ivec2 first = tile_size_ * ivec2(column, row);
            return {{first, glm::min(first + (tile_size_ - 1), end)}};
        }
        return {{{0, first_row(row)}, {end.x, first_row(row + 1) - 1}}};
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
        const auto [first, last] = common_box(box, {ivec2(0), size_ - 1});
        if (first.x > last.x || first.y > last.y) return;
        if (split_ == Split::interleaved) {
            for (int y = first.y; y <= std::min(last.y, first.y + rows_ - 1); ++y)
                take(static_cast<std::size_t>(y % rows_));
            return;
        }
        const auto row_of = [&](int y) {
            if (split_ == Split::tiles) return y / tile_size_;
            return static_cast<int>(((std::int64_t{y} + 1) * rows_ - 1) / size_.y);  // Eq. 10.3
        };
        const auto column_of = [&](int x) { return split_ == Split::tiles ? x / tile_size_ : 0; };
        for (int row = row_of(first.y); row <= row_of(last.y); ++row)
            for (int column = column_of(first.x); column <= column_of(last.x); ++column)
                take(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                     static_cast<std::size_t>(column));
    }

  private:
    /// Of one worker's rows (Eq. 10.3).
    int first_row(int worker) const {
        return static_cast<int>(std::int64_t{worker} * size_.y / rows_);
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
    PixelBox strip = common_box(tile.box, box);
    const int skipped = strip.first.y - tile.box.first.y, step = tile.row_step;
    strip.first.y += (step - skipped % step) % step;
    if (strip.is_empty()) return;
    const int end = strip.last.y;
    if (step > 1) strip.last.y = strip.first.y;
    for (; strip.first.y <= end; strip.first.y += step, strip.last.y += step) {
        visit(strip);
        if (step == 1) return;
    }
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
