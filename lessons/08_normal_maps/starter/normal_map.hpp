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
    // TODO: Eq. 8.1 as (2 c - greatest) / greatest, where greatest is 2^bits - 1; in float, since a
    // difference of unsigned numbers wraps.
    return 0;
}

/// The normals of a map of 8 bits a component, x right, y up and z out of the surface; w is 1.
/// Lengths are 1 but for the values' steps. The flat texel (128, 128, 255) is 0.318 degrees off.
inline Image<vec4> normals_from_unorm(const Image<u8vec4>& image, Green green) {
    // TODO: component_from_unorm() of red, green and blue; green down changes the sign of y; w
    // is 1.
    return Image<vec4>(image.size(), vec4(0, 0, 1, 1));
}

/// The normals of a height map, (-a, -b, 1) of Eq. 8.9: x and y say how steeply it falls to the
/// right and upwards in the image. A map of one height has (0, 0, 1) everywhere.
///
/// @param image  Its red is the height: 255 is as high above 0 as the map is wide.
/// @param wrap   What lies beyond the image's borders.
inline Image<vec4> normals_from_heights(const Image<u8vec4>& image, WrapModes wrap) {
    // TODO: Eq. 8.9 with s = 1, as normal_mapped() multiplies by the material's s later; red over
    // 255 is the height; z and w are 1. Beyond the border: the texel at the opposite one for
    // Wrap::repeat, else that at the border itself.
    return Image<vec4>(image.size(), vec4(0, 0, 1, 1));
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
    // TODO: Eq. 8.8.
    return {xy, F(1.0f)};
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
    // TODO: the numerator of Eq. 8.7; its N, of length 1, is frame.normal. Robust: where x and y
    // are 0, `normal` as it is, by select().
    return normal;
}

}  // namespace rasterbook
