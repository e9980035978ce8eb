// SPDX-License-Identifier: MIT
/// @file
/// A picture in memory: rows of pixels, the top row first.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include <glm/common.hpp>

#include "common/math/types.hpp"

namespace rasterbook {

/// The pixel in which a point of screen space lies.
///
/// @param position_screen  Finite, each coordinate within the range of int.
inline ivec2 pixel_of(vec2 position_screen) { return ivec2(glm::floor(position_screen)); }

/// For a picture whose pixels are not set when it is made. The system hands out memory when it is
/// written for the first time, and that takes time: so it can be done by whoever draws there.
struct Unset {};
constexpr Unset unset;

/// Leaves a pixel of which nothing is said as the memory was.
template <typename Pixel>
struct PixelAllocator : std::allocator<Pixel> {
    template <typename Other>
    struct rebind {
        using other = PixelAllocator<Other>;
    };

    PixelAllocator() = default;
    template <typename Other>
    PixelAllocator(const PixelAllocator<Other>&) {}

    template <typename Other>
    void construct(Other* pixel) {
        ::new (static_cast<void*>(pixel)) Other;
    }
};

/// A width x height array of pixels, stored row by row from the top-left corner, without padding.
///
/// The pixel (x, y) covers the square from (x, y) to (x + 1, y + 1) of screen space.
template <typename Pixel>
class Image {
  public:
    Image() = default;

    /// @param size  Width and height in pixels, each >= 0.
    explicit Image(ivec2 size, Pixel value = Pixel{}) : size_(size) {
        assert(size.x >= 0 && size.y >= 0 && "an image has no negative side");
        pixels_.assign(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), value);
    }

    /// With pixels of any value: each is to be written before it is read.
    Image(ivec2 size, Unset) : size_(size) {
        assert(size.x >= 0 && size.y >= 0 && "an image has no negative side");
        pixels_.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
    }

    ivec2 size() const { return size_; }
    bool contains(ivec2 p) const { return p.x >= 0 && p.y >= 0 && p.x < size_.x && p.y < size_.y; }

    /// @param p  A pixel inside the picture.
    Pixel& operator[](ivec2 p) { return pixels_[index(p)]; }
    const Pixel& operator[](ivec2 p) const { return pixels_[index(p)]; }

    /// All pixels, row by row.
    std::span<Pixel> pixels() { return {pixels_.data(), pixels_.size()}; }
    std::span<const Pixel> pixels() const { return {pixels_.data(), pixels_.size()}; }

    bool operator==(const Image&) const = default;

  private:
    std::size_t index(ivec2 p) const {
#ifndef NDEBUG
        if (!contains(p)) fail_outside(p);
#endif
        return static_cast<std::size_t>(p.y) * static_cast<std::size_t>(size_.x) +
               static_cast<std::size_t>(p.x);
    }

    /// An assertion that says which pixel of which image was asked for.
    [[noreturn]] void fail_outside(ivec2 p) const {
        std::fprintf(stderr, "pixel (%d, %d) lies outside of the image of %d x %d pixels\n", p.x,
                     p.y, size_.x, size_.y);
        std::abort();
    }

    ivec2 size_{0, 0};
    std::vector<Pixel, PixelAllocator<Pixel>> pixels_;
};

/// The mean of each square of `per_side` * `per_side` pixels.
///
/// @param picture  Linear colour; its sides are multiples of per_side.
inline Image<vec3> averaged(Image<vec3> picture, int per_side) {
    assert(picture.size() % per_side == ivec2(0) && "a pixel's samples are all there");
    if (per_side == 1) return picture;
    Image<vec3> means(picture.size() / per_side, vec3(0.0f));
    const float share = 1.0f / static_cast<float>(per_side * per_side);
    for (int y = 0; y < picture.size().y; ++y)
        for (int x = 0; x < picture.size().x; ++x)
            means[ivec2(x, y) / per_side] += share * picture[{x, y}];
    return means;
}

}  // namespace rasterbook
