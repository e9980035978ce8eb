// SPDX-License-Identifier: MIT
/// @file
/// Normals in a texture, as UNORM values or as heights, and the surface normals that they perturb.
/// Introduced in lesson 08; derivation: docs/derivations/08_normal_maps.md.
#pragma once

#include <cmath>
#include <cstdint>

#include "05_textures/texture.hpp"
#include "08_normal_maps/tangent_frame.hpp"
#include "common/image/image.hpp"

namespace rasterbook {

/// Where green points in a normal map: up in the image as in OpenGL, or down as in Direct3D.
enum class Green { up, down };

/// A component of a normal, -1 to 1, as glTF prescribes it (Eq. 8.1): of a UNORM value, 0 to 1,
/// twice that less 1. The least value is exactly -1 and the greatest exactly 1; none is exactly 0.
///
/// @param value  As the image has it: 0 to 2^bits - 1.
/// @param bits   2 to 16.
constexpr float component_from_unorm(std::uint32_t value, int bits = 8) {
    const float greatest = static_cast<float>((1u << bits) - 1);
    return (2 * static_cast<float>(value) - greatest) / greatest;  // one rounding
}

/// The normals of a map of 8 bits a component, x right, y up and z out of the surface; w is 1.
/// Lengths are 1 but for the values' steps. The flat texel (128, 128, 255) is 0.318 degrees off.
inline Image<vec4> normals_from_unorm(const Image<u8vec4>& image, Green green) {
    const float up = green == Green::up ? 1.0f : -1.0f;
    Image<vec4> normals(image.size());
    for (std::size_t i = 0; i < normals.pixels().size(); ++i) {
        const u8vec4 texel = image.pixels()[i];
        normals.pixels()[i] = {component_from_unorm(texel.r), up * component_from_unorm(texel.g),
                               component_from_unorm(texel.b), 1};
    }
    return normals;
}

/// The normals of a height map, (-a, -b, 1) of Eq. 8.9: x and y say how steeply it falls to the
/// right and upwards in the image. A map of one height has (0, 0, 1) everywhere.
///
/// @param image  Its red is the height: 255 is as high above 0 as the map is wide.
/// @param wrap   What lies beyond the image's borders.
inline Image<vec4> normals_from_heights(const Image<u8vec4>& image, WrapModes wrap) {
    const ivec2 size = image.size();
    const auto height = [&](ivec2 texel) {
        return static_cast<float>(image[texel_beyond(texel, size, wrap)].r) / 255.0f;
    };
    const vec2 per_two_texels = 0.5f * vec2(size);
    Image<vec4> normals(size);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const float to_right = height({x + 1, y}) - height({x - 1, y});
            const float upwards = height({x, y - 1}) - height({x, y + 1});
            normals[{x, y}] = {-per_two_texels.x * to_right, -per_two_texels.y * upwards, 1, 1};
        }
    return normals;
}

/// Whether red, green and blue are the same in all texels. A `map_Bump` should be such a height
/// map; some exporters write their normal maps there.
inline bool is_gray(const Image<u8vec4>& image) {
    for (const u8vec4 texel : image.pixels())
        if (texel.r != texel.g || texel.g != texel.b) return false;
    return true;
}

/// The third component of a normal of length 1 from the other two (Eq. 8.8); 0 where they are too
/// long for one.
template <typename F>
Vec3<F> with_z(glm::vec<2, F> xy) {
    return {xy, sqrt(max(F(1.0f) - glm::dot(xy, xy), F(0.0f)))};
}

/// A sample of a normal map, in the directions in which the texture coordinates grow. Where
/// different unit normals are interpolated, it is shorter than 1; of heights, its z is 1.
template <typename F>
Vec3<F> sample_normal(const Texture& texture, Filter filter, const TextureCoordinates<F>& uv) {
    Vec3<F> normal(sample(texture, filter, uv));
    // In each second copy of a mirrored texture its right is on the left.
    for (int axis = 0; axis < 2; ++axis) {
        if (texture.wrap[axis] != Wrap::mirror) continue;
        const F there_and_back = F(0.5f) * uv.here[axis];
        const auto is_back = there_and_back - floor(there_and_back) >= F(0.5f);
        normal[axis] = select(is_back, -normal[axis], normal[axis]);
    }
    return normal;
}

/// A surface's normal, perturbed by the map (Eq. 8.7).
///
/// @param frame       Of the surface; finite.
/// @param normal_map  In that frame.
/// @param normal      The surface's own, not yet scaled: it is left as it is, to the last bit,
///                    where x and y are 0.
/// @return            Of any length; scaling comes last.
template <typename F>
Vec3<F> perturbed(const TangentBasis<F>& frame, Vec3<F> normal_map, Vec3<F> normal) {
    const auto is_flat = (normal_map.x == F(0.0f)) & (normal_map.y == F(0.0f));
    return select(is_flat, normal,
                  normal_map.x * frame.tangent + normal_map.y * frame.bitangent +
                      normal_map.z * frame.normal);
}

}  // namespace rasterbook
