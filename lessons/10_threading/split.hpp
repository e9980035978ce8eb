// SPDX-License-Identifier: MIT
/// @file
/// Which pixels of a picture belong to which task. Introduced in lesson 10;
/// derivation: docs/derivations/10_threading.md.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "02_triangle_fill/triangle.hpp"
#include "05_textures/bands.hpp"
#include "common/math/types.hpp"

namespace rasterbook {

/// Pixels from the upper left one to the lower right one, both included. There is none where
/// `last` comes before `first`.
struct PixelBox {
    ivec2 first, last;

    bool is_empty() const { return first.x > last.x || first.y > last.y; }
};

/// The pixels whose centres lie in the box around a triangle: all that it may cover, and some more
/// (Eq. 10.6).
inline PixelBox box_around(const ScreenTriangle& triangle) {
    const auto [a, b, c] = triangle.corners;
    const ivec2 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
    return {(low + (subpixels / 2 - 1)) >> subpixel_bits, (high - subpixels / 2) >> subpixel_bits};
}

/// What two boxes have in common.
inline PixelBox common_box(const PixelBox& a, const PixelBox& b) {
    return {glm::max(a.first, b.first), glm::min(a.last, b.last)};
}

/// The pixels of one task: of a box, the first row and each `row_step`-th after it.
struct Part {
    PixelBox box;
    int row_step = 1;
};

/// How to split a picture.
enum class Split { rows, interleaved, tiles };

/// A picture in parts. Each pixel is in just one.
class Parts {
  public:
    /// @param size     Of the picture, each side >= 0. Without pixels there are no parts.
    /// @param workers  At least 1. Rows and interleaved rows make one part for each, or one a row
    ///                 where there are fewer rows than workers.
    /// @param tile     Pixels along a tile's side, at least 1.
    Parts(Split split, ivec2 size, std::size_t workers, int tile)
        : split_(split), size_(size), tile_(tile) {
        assert(workers >= 1 && tile >= 1);
        if (size.x <= 0 || size.y <= 0) return;
        const auto ceiling = [&](int side) { return (side - 1) / tile + 1; };
        columns_ = split == Split::tiles ? ceiling(size.x) : 1;
        rows_ = split == Split::tiles
                    ? ceiling(size.y)
                    : static_cast<int>(std::min(workers, static_cast<std::size_t>(size.y)));
    }

    ivec2 size() const { return size_; }
    std::size_t count() const {
        return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    }

    /// @param part  From 0 to count() - 1.
    Part operator[](std::size_t part) const {
        const int column = static_cast<int>(part % static_cast<std::size_t>(columns_));
        const int row = static_cast<int>(part / static_cast<std::size_t>(columns_));
        const ivec2 end = size_ - 1;
        if (split_ == Split::interleaved) return {{{0, row}, end}, rows_};  // Eq. 10.4
        if (split_ == Split::tiles) {                                       // Eq. 10.5
            const ivec2 first = tile_ * ivec2(column, row);
            return {{first, glm::min(first + (tile_ - 1), end)}};
        }
        const int height = size_.y / rows_;  // Eq. 10.3
        return {{{0, row * height}, {end.x, row + 1 < rows_ ? (row + 1) * height - 1 : end.y}}};
    }

    /// Calls take(part) once for each part that has a pixel in the box.
    template <typename Take>
    void for_each_in(const PixelBox& box, Take&& take) const {
        const auto [first, last] = common_box(box, {ivec2(0), size_ - 1});
        if (first.x > last.x || first.y > last.y) return;
        if (split_ == Split::interleaved) {
            for (int y = first.y; y <= std::min(last.y, first.y + rows_ - 1); ++y)
                take(static_cast<std::size_t>(y % rows_));
            return;
        }
        const int height = split_ == Split::tiles ? tile_ : size_.y / rows_;
        const auto row_of = [&](int y) { return std::min(y / height, rows_ - 1); };
        const auto column_of = [&](int x) { return split_ == Split::tiles ? x / tile_ : 0; };
        for (int row = row_of(first.y); row <= row_of(last.y); ++row)
            for (int column = column_of(first.x); column <= column_of(last.x); ++column)
                take(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                     static_cast<std::size_t>(column));
    }

  private:
    Split split_;
    ivec2 size_;
    int tile_;
    int columns_ = 0, rows_ = 0;  ///< Of parts.
};

/// Visits what of a part lies in a box, as boxes of whole rows: of interleaved rows, each is one.
///
/// @param visit  Called as visit(PixelBox), never with an empty one.
template <typename Visit>
void for_each_strip(const Part& part, const PixelBox& box, Visit&& visit) {
    PixelBox strip = common_box(part.box, box);
    const int skipped = strip.first.y - part.box.first.y, step = part.row_step;
    strip.first.y += (step - skipped % step) % step;
    if (strip.is_empty()) return;
    const int end = strip.last.y;
    if (step > 1) strip.last.y = strip.first.y;
    for (; strip.first.y <= end; strip.first.y += step, strip.last.y += step) {
        visit(strip);
        if (step == 1) return;
    }
}

/// Visits all of a part.
template <typename Visit>
void for_each_strip(const Part& part, Visit&& visit) {
    for_each_strip(part, part.box, visit);
}

/// As fill_in_bands, of a part of a picture.
template <typename Emit>
void fill_part(const ScreenTriangle& triangle, const Part& part, Emit&& emit) {
    for_each_strip(part, box_around(triangle), [&](const PixelBox& strip) {
        fill_in_bands(triangle, strip.first, strip.last, emit);
    });
}

}  // namespace rasterbook
