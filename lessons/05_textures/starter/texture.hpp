// SPDX-License-Identifier: MIT
/// @file
/// A picture on a surface: which of its texels a point sees. Introduced in lesson 05;
/// derivation: docs/derivations/05_textures.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "05_textures/interpolation.hpp"
#include "common/image.hpp"
#include "common/math/color.hpp"

namespace rasterbook {

/// What lies beyond a picture's borders: the picture again, the picture mirrored, or its border.
enum class Wrap { repeat, mirror, clamp };

/// Which texels make a fragment's colour: the nearest one, the four around it, or four of each of
/// two levels.
enum class Filter { nearest, bilinear, trilinear };

/// A picture of linear red, green and blue, and opacity, ready to be sampled.
struct TextureLevel {
    ivec2 size;          ///< In texels, without the border.
    Image<vec4> texels;  ///< With a border of one texel that holds what lies beyond the picture.
};

/// A picture and smaller copies of it.
struct Texture {
    Wrap wrap;
    std::vector<TextureLevel>
        levels;  ///< Each half as wide and high as the one before; 1 x 1 last.
};

/// A texture coordinate brought into the picture, 0 to 1 (Eq. 5.4). What is not a number becomes 0,
/// and so does infinity, but for Wrap::clamp.
inline float wrapped(float coordinate, Wrap wrap) {
    // TODO: Eq. 5.4; mind what is not a number.
    return 0;
}

/// A place in the picture: x from 0 at its left to 1 at its right, y from 0 at its upper border to
/// 1 at its lower one (Eq. 5.5).
inline vec2 place_from_uv(vec2 uv, Wrap wrap) {
    // TODO: Eq. 5.5, up to the place.
    return vec2(0);
}

/// The texel in which a place lies.
///
/// @param place  0 to 1.
inline vec4 sample_nearest(const TextureLevel& level, vec2 place) {
    // TODO: Eq. 5.5; the texels are stored with a border of one.
    return vec4(0);
}

/// The mean of the four texels around a place, by how near their centres are (Eq. 5.6).
///
/// @param place  0 to 1.
inline vec4 sample_bilinear(const TextureLevel& level, vec2 place) {
    // TODO: Eq. 5.6, counted from the border's first texel.
    return vec4(0);
}

/// The level at which a pixel's footprint is one texel long, by its longer side (Eq. 5.8).
///
/// @param step_x,step_y  Change of uv from a pixel to its right and to its lower neighbour.
/// @param size           Of level 0, in texels.
/// @return               0 where the footprint is a texel or less, and for NaN.
inline float level_of_detail(vec2 step_x, vec2 step_y, ivec2 size) {
    // TODO: Eq. 5.8.
    return 0;
}

/// The mean of what two levels have at a place, by how near they are to `level` (Eq. 5.10).
///
/// @param place  0 to 1.
/// @param level  >= 0; beyond the last level it is the last one.
inline vec4 sample_trilinear(const Texture& texture, vec2 place, float level) {
    // TODO: Eq. 5.10; mind the last level.
    return vec4(0);
}

/// Where on a texture a fragment lies, and how fast that changes.
struct FragmentUv {
    vec2 here, step_x, step_y;  ///< As in FragmentWeights.
};

/// @param uvs  Of the triangle's corners.
inline FragmentUv fragment_uv(const std::array<vec2, 3>& uvs, const FragmentWeights& weights) {
    return {interpolate(uvs, weights.here), interpolate(uvs, weights.step_x),
            interpolate(uvs, weights.step_y)};
}

/// The texture's colour, linear, and opacity in a fragment.
inline vec4 sample(const Texture& texture, Filter filter, const FragmentUv& uv) {
    const vec2 place = place_from_uv(uv.here, texture.wrap);
    if (filter == Filter::nearest) return sample_nearest(texture.levels[0], place);
    if (filter == Filter::bilinear) return sample_bilinear(texture.levels[0], place);
    const float level = level_of_detail(uv.step_x, uv.step_y, texture.levels[0].size);
    return sample_trilinear(texture, place, level);
}

/// A picture half as wide and high, rounded down, but at least 1: each texel is the mean of what it
/// covers (Eq. 5.9). A picture of one colour keeps it exactly.
inline Image<vec4> halved(const Image<vec4>& picture) {
    // TODO: the size, and Eq. 5.9 in both directions, summed in double.
    return Image<vec4>(ivec2(1));
}

/// The picture with a border of one texel, as bilinear filtering asks for.
inline TextureLevel with_border(const Image<vec4>& picture, Wrap wrap) {
    // TODO: the picture, and around it what lies beyond (the border, after Eq. 5.6).
    return {picture.size(), Image<vec4>(picture.size() + 2)};
}

/// A texture with all of its levels.
///
/// @param picture  Linear colour and opacity; at least one texel.
inline Texture make_texture(Image<vec4> picture, Wrap wrap) {
    // TODO: the other levels, down to a single texel, each half of the one before (Eq. 5.9).
    return {wrap, {with_border(picture, wrap)}};
}

/// A picture's colours decoded from sRGB (Eq. 5.11); opacity is not encoded.
inline Image<vec4> linear_from_srgb8(const Image<u8vec4>& picture) {
    // TODO: Eq. 5.11, which common/math/color.hpp has; opacity is not encoded.
    return Image<vec4>(picture.size());
}

}  // namespace rasterbook
