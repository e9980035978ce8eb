// SPDX-License-Identifier: MIT
/// @file
/// Which of several surfaces is visible in a pixel. Introduced in lesson 03;
/// derivation: docs/derivations/03_z_buffer.md.
#pragma once

#include <algorithm>

#include "common/image/image.hpp"

namespace rasterbook {

/// The depth of the nearest surface so far, for each pixel.
///
/// Depths run from 0, nearest, to 1, farthest; a cleared pixel holds 1.
class DepthBuffer {
  public:
    static constexpr float cleared = 1.0f;  ///< The depth of a pixel that nothing covers yet.

    /// @param size  Width and height in pixels.
    explicit DepthBuffer(ivec2 size) : depths_(size, cleared) {}

    /// The same, with each pixel still to be cleared.
    DepthBuffer(ivec2 size, Unset) : depths_(size, unset) {}

    /// Clears a part.
    ///
    /// @param first,last  Its upper left and lower right pixel; last before first: no pixel.
    void clear(ivec2 first, ivec2 last) {
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) depths_[{x, y}] = cleared;
    }

    /// The depth test: whether `depth` is nearer than all before it in this pixel; if so, it is
    /// stored (Eq. 3.1).
    ///
    /// Of equal depths the first stays: -0 equals 0. NaN is never nearer.
    bool test_and_write(ivec2 pixel, float depth) {
        // TODO: Eq. 3.1.
        return false;
    }

    const Image<float>& depths() const { return depths_; }
    Image<float>& depths() { return depths_; }

  private:
    Image<float> depths_;
};

/// The depth inside a triangle, interpolated from the vertices' depths (Eq. 3.2).
///
/// Measured from the nearest vertex, so that the error is small where the triangle's depths differ
/// little, a triangle of one depth has exactly that depth everywhere, and the order of the vertices
/// does not change a single bit.
class TriangleDepth {
  public:
    /// @param depths  Of the three vertices, finite.
    explicit TriangleDepth(vec3 depths) : nearest_(0), beyond_nearest_(0) {
        // TODO: in step 1, for Eq. 3.2, beyond_nearest_ is the depths themselves, and nearest_
        // stays 0. In step 3, for Eq. 3.3, the smallest depth, and how far each lies behind it.
    }

    /// @param barycentrics  On the screen, >= 0, as fill_triangle gives them.
    /// @return              Not nearer than the nearest vertex.
    float at(vec3 barycentrics) const {
        // TODO: Eq. 3.3, which is Eq. 3.2 as long as nearest_ is 0; mind the bracket.
        return 0;
    }

    float nearest() const { return nearest_; }
    vec3 beyond_nearest() const { return beyond_nearest_; }  ///< By how much each is farther.

  private:
    float nearest_;
    vec3 beyond_nearest_;
};

/// The depth buffer as a picture: the nearest pixel is white, the farthest dark, an empty one
/// black.
///
/// @return  Linear colour.
inline Image<vec3> depth_picture(const DepthBuffer& buffer) {
    constexpr float cleared = DepthBuffer::cleared;
    float nearest = cleared, farthest = 0.0f;
    for (const float depth : buffer.depths().pixels())
        if (depth < cleared)
            nearest = std::min(nearest, depth), farthest = std::max(farthest, depth);
    const float extent = std::max(farthest - nearest, 1e-6f);

    Image<vec3> picture(buffer.depths().size(), vec3(0.0f));
    for (std::size_t i = 0; i < picture.pixels().size(); ++i) {
        const float depth = buffer.depths().pixels()[i];
        const float shade = 1.0f - 0.9f * (depth - nearest) / extent;
        if (depth < cleared) picture.pixels()[i] = vec3(shade * shade);  // even steps to the eye
    }
    return picture;
}

}  // namespace rasterbook
