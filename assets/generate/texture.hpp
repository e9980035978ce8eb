// SPDX-License-Identifier: MIT
/// @file
/// Painting a texture texel by texel, and normals from its heights.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "assets/generate/noise.hpp"
#include "common/image/image.hpp"
#include "common/math/types.hpp"

namespace rasterbook::assets {

constexpr int texture_side = 512;  ///< Texels.

/// One texel of a material before it is encoded.
struct Texel {
    dvec3 color;      ///< sRGB, 0 to 1: mixed as stored, for without pow it stays portable.
    double specular;  ///< 0 to 1.
    double height;    ///< 0 to 1.
};

/// @param texel_at  Called with the centre of each texel; x right and y down, in texels.
template <std::invocable<dvec2> TexelAt>
auto paint(TexelAt&& texel_at) {
    Image<decltype(texel_at(dvec2()))> image{ivec2(texture_side)};
    for (int y = 0; y < texture_side; ++y)
        for (int x = 0; x < texture_side; ++x) image[{x, y}] = texel_at(dvec2(x + 0.5, y + 0.5));
    return image;
}

/// A colour as painters write it: 0xRRGGBB.
constexpr dvec3 rgb(int hex) { return dvec3(hex >> 16, (hex >> 8) & 255, hex & 255) / 255.0; }

inline std::uint8_t encode(double value) {
    return std::uint8_t(std::floor(glm::clamp(value, 0.0, 1.0) * 255 + 0.5));
}

inline u8vec3 encode(dvec3 color) { return {encode(color.x), encode(color.y), encode(color.z)}; }

/// A unit vector in bytes, the nearest UNORM values. Of the flat normal: (128, 128, 255).
inline u8vec3 encode_normal(dvec3 n) { return encode((n + 1.0) / 2.0); }

inline Image<u8vec3> color_image(const Image<Texel>& texels) {
    return paint([&](dvec2 p) { return encode(texels[ivec2(p)].color); });
}

inline Image<u8vec3> specular_image(const Image<Texel>& texels) {
    return paint([&](dvec2 p) { return encode(dvec3(texels[ivec2(p)].specular)); });
}

inline Image<u8vec3> height_image(const Image<Texel>& texels) {
    return paint([&](dvec2 p) { return encode(dvec3(texels[ivec2(p)].height)); });
}

/// Tangent-space normals by central differences; x along u, y along v (upwards), z outwards.
///
/// @param relief  From height 0 to height 1, in sides of the texture.
inline Image<u8vec3> normal_image(const Image<Texel>& texels, double relief) {
    const auto height = [&](int x, int y) {
        return texels[{wrap(x, texture_side), wrap(y, texture_side)}].height;
    };
    return paint([&](dvec2 p) {
        const ivec2 i(p);
        const double along_u = (height(i.x + 1, i.y) - height(i.x - 1, i.y)) / 2;
        const double along_v = (height(i.x, i.y - 1) - height(i.x, i.y + 1)) / 2;
        const double slope = relief * texture_side;
        return encode_normal(glm::normalize(dvec3(-slope * along_u, -slope * along_v, 1)));
    });
}

/// From the middle of a box with round corners: negative inside, in texels. @see Quilez 2011
inline double distance_to_box(dvec2 p, dvec2 half_size, double corner_radius = 0) {
    const dvec2 q = glm::abs(p) - half_size + corner_radius;
    return glm::length(glm::max(q, dvec2(0))) + glm::min(glm::max(q.x, q.y), 0.0) - corner_radius;
}

}  // namespace rasterbook::assets
