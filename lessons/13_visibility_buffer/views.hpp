// SPDX-License-Identifier: MIT
/// @file
/// What this lesson shows of itself, for `--show`.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/projection.hpp"
#include "10_threading/thread_options.hpp"
#include "13_visibility_buffer/shadow_parts.hpp"
#include "13_visibility_buffer/visibility_buffer.hpp"
#include "13_visibility_buffer/visibility_options.hpp"
#include "common/image/image.hpp"
#include "common/math/color.hpp"

namespace rasterbook {

/// A triangle's colour for Show::ids: of any few in a row of a mesh, no two look alike.
inline vec3 color_of_triangle(const ProjectedTriangle& projected) {
    return color_of(
        static_cast<std::size_t>(&projected.triangle - projected.mesh.triangles.data()));
}

/// How often each pixel was shaded, for Show::shading (Eq. 13.4).
class HeatMap {
  public:
    /// @param show  Unless it is Show::shading, nothing is counted.
    HeatMap(Show show, ivec2 size) : is_on_(show == Show::shading) {
        if (is_on_) times_ = Image<std::uint32_t>(size);
    }

    void add(ivec2 pixel) {
        if (is_on_) ++times_[pixel];
    }
    void add(const PixelSpan& span) {
        for (int x = 0; is_on_ && x < span.length; ++x) add(span.first + ivec2(x, 0));
    }

    /// From black, never, over violet, once, to white, eight times or more.
    Image<vec3> picture() const {
        // matplotlib's "inferno", sRGB
        constexpr std::array<vec3, 9> ramp = {vec3(0, 0, 4), {60, 9, 101},   {120, 28, 109},
                                              {165, 44, 96}, {207, 68, 70},  {237, 105, 37},
                                              {251, 155, 6}, {247, 209, 61}, {252, 255, 220}};
        Image<vec3> picture(times_.size());
        for (std::size_t i = 0; i < times_.pixels().size(); ++i) {
            const vec3 encoded = ramp[std::min<std::size_t>(times_.pixels()[i], ramp.size() - 1)];
            for (int c = 0; c < 3; ++c) picture.pixels()[i][c] = linear_from_srgb(encoded[c] / 255);
        }
        return picture;
    }

  private:
    bool is_on_;
    Image<std::uint32_t> times_;
};

/// The first shadow map: the nearest texel is white, what no pixel asked for is blue, and each part
/// has an upper and a left border. Black: texels without a caster, or no map at all.
inline Image<vec3> picture_of(const ShadowMapsOnDemand& on_demand, ivec2 size) {
    Image<vec3> picture(size, vec3(0));
    if (on_demand.parts().empty()) return picture;
    const ShadowMapParts& parts = on_demand.parts().front();
    const Tiling& tiling = parts.tiling();
    const Image<float>& depths = parts.map().depths.depths();
    float nearest = DepthBuffer::cleared, farthest = 1;
    for (std::size_t part = 0; part < tiling.count(); ++part) {
        const auto [first, last] = tiling[part].box;
        for (int y = first.y; parts.is_drawn(part) && y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) {
                const float depth = depths[ivec2(x, y) + max_pcf_radius];
                if (depth == DepthBuffer::cleared) continue;
                nearest = std::max(nearest, depth), farthest = std::min(farthest, depth);
            }
    }
    const int side = std::min(size.x, size.y), texels = parts.map().size;
    const auto texel = [&](int pixel) {
        return static_cast<int>(std::int64_t{pixel} * texels / side);
    };
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const ivec2 here(texel(x), texel(y));
            std::size_t part = 0;
            tiling.for_each_in(PixelBox{here, here}, [&](std::size_t i) { part = i; });
            const ivec2 first = tiling[part].box.first;
            vec3 color(0.05f, 0.12f, 0.35f);
            if (parts.is_drawn(part)) {
                const float depth = depths[here + max_pcf_radius];
                const float shade =
                    1 - 0.9f * (nearest - depth) / std::max(nearest - farthest, 1e-6f);
                color = vec3(depth > DepthBuffer::cleared ? shade * shade : 0);
            }
            const bool is_border =
                x == 0 || y == 0 || texel(x - 1) < first.x || texel(y - 1) < first.y;
            picture[(size - side) / 2 + ivec2(x, y)] = is_border ? 0.5f * color + 0.02f : color;
        }
    return picture;
}

}  // namespace rasterbook
