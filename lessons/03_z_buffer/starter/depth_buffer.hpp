// SPDX-License-Identifier: MIT
/// @file
/// Which of several surfaces is visible in a pixel. Introduced in lesson 03;
/// derivation: docs/derivations/03_z_buffer.md.
#pragma once

#include <algorithm>
#include <limits>

#include "common/image/image.hpp"
#include "common/probe/pixel_trace.hpp"

namespace rasterbook {

/// The depth of the nearest surface so far, for each pixel.
///
/// Depths run from 1 at the near plane to 0, infinitely far away: greater is nearer.
class DepthBuffer {
  public:
    static constexpr float cleared = 0.0f;  ///< The depth of a pixel that nothing covers yet.

    /// @param size      Width and height in pixels.
    /// @param farthest  What a pixel is cleared to: what is not nearer than this is never drawn.
    explicit DepthBuffer(ivec2 size, float farthest = cleared)
        : depths_(size, farthest), farthest_(farthest) {}

    /// With each pixel still to be cleared.
    DepthBuffer(ivec2 size, Unset, float farthest = cleared)
        : depths_(size, unset), farthest_(farthest) {}

    /// Clears a part.
    ///
    /// @param first,last  Its upper left and lower right pixel; last before first: no pixel.
    void clear(ivec2 first, ivec2 last) {
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) depths_[{x, y}] = farthest_;
    }

    /// The depth test: whether `depth` is nearer than all before it in this pixel; if so, it is
    /// stored (Eq. 3.1).
    ///
    /// Of equal depths the first stays: -0 equals 0. NaN is never nearer.
    bool test_and_write(ivec2 pixel, float depth) {
        trace_depth(depths_[pixel], depth);
        // TODO: Eq. 3.1.
        return false;
    }

    const Image<float>& depths() const { return depths_; }
    Image<float>& depths() { return depths_; }
    float farthest() const { return farthest_; }

  private:
    Image<float> depths_;
    float farthest_;
};

/// The depth inside a triangle, interpolated from the vertices' depths (Eq. 3.2).
///
/// Measured from the farthest vertex, so that the error is small where the triangle's depths differ
/// little, a triangle of one depth has exactly that depth everywhere, and the order of the vertices
/// does not change a single bit.
class TriangleDepth {
  public:
    /// @param depths  Of the three vertices, finite.
    explicit TriangleDepth(vec3 depths) : farthest_(0), above_farthest_(0) {
        trace("depths of a, b, c", depths);
        // TODO: in step 1, for Eq. 3.2, above_farthest_ is the depths themselves, and farthest_
        // stays 0. In step 3, for Eq. 3.3, the smallest depth, and by how much each exceeds it.
    }

    /// @param barycentrics  On the screen, >= 0, as fill_triangle gives them.
    /// @return              Not farther than the farthest vertex.
    float at(vec3 barycentrics) const {
        // TODO: Eq. 3.3, which is Eq. 3.2 as long as farthest_ is 0; mind the bracket.
        return 0;
    }

    float farthest() const { return farthest_; }
    vec3 above_farthest() const { return above_farthest_; }  ///< By how much each is nearer.

  private:
    float farthest_;
    vec3 above_farthest_;
};

/// The depth buffer as a picture: the nearest pixel is white, the farthest dark, an empty one
/// black.
///
/// @return  Linear colour.
inline Image<vec3> depth_picture(const DepthBuffer& buffer) {
    float nearest = buffer.farthest(), farthest = std::numeric_limits<float>::max();
    for (const float depth : buffer.depths().pixels())
        if (depth > buffer.farthest())
            nearest = std::max(nearest, depth), farthest = std::min(farthest, depth);
    const float extent = nearest > farthest ? nearest - farthest : 1.0f;

    Image<vec3> picture(buffer.depths().size(), vec3(0.0f));
    for (std::size_t i = 0; i < picture.pixels().size(); ++i) {
        const float depth = buffer.depths().pixels()[i];
        const float shade = 1.0f - 0.9f * (nearest - depth) / extent;
        if (depth > buffer.farthest())
            picture.pixels()[i] = vec3(shade * shade);  // even steps to the eye
    }
    return picture;
}

}  // namespace rasterbook
