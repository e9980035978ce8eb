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
    // TODO: as fill_triangle finds its first and its last pixel.
    return {ivec2(0), ivec2(-1)};
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
        // TODO: how many columns and rows of parts there are, after Eq. 10.3 to 10.5.
    }

    ivec2 size() const { return size_; }
    std::size_t count() const {
        return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    }

    /// @param part  From 0 to count() - 1.
    Part operator[](std::size_t part) const {
        // TODO: Eq. 10.3 to 10.5.
        return {{ivec2(0), size_ - 1}};
    }

    /// Calls take(part) once for each part that has a pixel in the box.
    template <typename Take>
    void for_each_in(const PixelBox& box, Take&& take) const {
        // TODO: Eq. 10.6, the box cut to the picture.
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
    // TODO: what the two boxes have in common; of that, all at once where row_step is 1, or else
    // each of the part's rows.
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
