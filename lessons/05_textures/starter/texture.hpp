// SPDX-License-Identifier: MIT
/// @file
/// Textures: which texels a point of a surface sees. Introduced in lesson 05;
/// derivation: docs/derivations/05_textures.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "05_textures/interpolation.hpp"
#include "common/image/image.hpp"
#include "common/math/color.hpp"
#include "common/math/functions.hpp"
#include "common/probe/traced_texture.hpp"

namespace rasterbook {

/// What lies beyond a texture's border: the texture again, mirrored, or its outermost texels.
enum class Wrap { repeat, mirror, clamp };

/// What lies beyond a texture's left and right border (u), and beyond its lower and upper one (v).
struct WrapModes {
    Wrap u, v;

    constexpr WrapModes(Wrap both) : u(both), v(both) {}
    constexpr WrapModes(Wrap across, Wrap up) : u(across), v(up) {}
    constexpr Wrap operator[](int axis) const { return axis == 0 ? u : v; }
    auto operator<=>(const WrapModes&) const = default;
};

/// Which texels make a fragment's colour: the nearest one, the four around it, or four of each of
/// two levels.
enum class Filter { nearest, bilinear, trilinear };

/// One level of a mip chain: linear red, green and blue, and alpha, ready to be sampled.
struct TextureLevel {
    ivec2 size;          ///< In texels, without the border.
    Image<vec4> texels;  ///< With a border of one texel that holds what lies beyond.
};

/// A mip chain: an image and smaller copies of it.
struct Texture {
    WrapModes wrap;
    std::vector<TextureLevel>
        levels;  ///< Each half as wide and high as the one before; 1 x 1 last.
    /// The most that the model's file asks for, where a pixel's footprint is a texel or less, and
    /// where it is more.
    Filter magnified = Filter::trilinear, minified = Filter::trilinear;
};

/// A texture coordinate wrapped to 0 to 1 (Eq. 5.4). NaN becomes 0, and so does infinity, but for
/// Wrap::clamp.
inline float wrapped(float coordinate, Wrap wrap) {
    // TODO: Eq. 5.4; mind NaN and infinity.
    return 0;
}

/// A position in the texture: x from 0 at its left to 1 at its right, y from 0 at its upper border
/// to 1 at its lower one (Eq. 5.5).
inline vec2 texture_position(vec2 uv, WrapModes wrap) {
    // TODO: Eq. 5.5, up to the position.
    return vec2(0);
}

/// The texel in which a position lies.
///
/// @param position  0 to 1.
inline vec4 sample_nearest(const TextureLevel& level, vec2 position) {
    // TODO: Eq. 5.5; the texels are stored with a border of one texel.
    return vec4(0);
}

/// The mean of the four texels around a position, by how near their centres are (Eq. 5.6).
///
/// @param position  0 to 1.
inline vec4 sample_bilinear(const TextureLevel& level, vec2 position) {
    // TODO: Eq. 5.6, counted from the border's first texel; column and row at most level.size (see
    // Robust, "More than 8 million columns").
    return vec4(0);
}

/// The level at which a pixel's footprint is one texel long, by its longer side (Eq. 5.8).
///
/// @param ddx,ddy  How fast uv changes here, a pixel to the right and a pixel down.
/// @param size     Of level 0, in texels.
/// @return  0 where the footprint is a texel or less, and where any of the four numbers is NaN;
///          else it may be infinite.
inline float level_of_detail(vec2 ddx, vec2 ddy, ivec2 size) {
    // TODO: Eq. 5.8, with log2() of common/math/functions.hpp; mind NaN.
    return 0;
}

/// The mean of what two levels have at a position, by how near they are to `level` (Eq. 5.10).
///
/// @param position  0 to 1.
/// @param level  >= 0, infinite too; beyond the last level it is the last one.
inline vec4 sample_trilinear(const Texture& texture, vec2 position, float level) {
    // TODO: Eq. 5.10; mind the last level, before the level becomes a whole number.
    return vec4(0);
}

/// Where on a texture a fragment lies, and how fast that changes.
template <typename F>
struct TextureCoordinates {
    glm::vec<2, F> here, ddx, ddy;  ///< As in PerspectiveBarycentrics.
};
using FragmentUv = TextureCoordinates<float>;

/// @param uvs  Of the triangle's vertices.
template <typename Uv, typename F>
TextureCoordinates<F> fragment_uv(const std::array<Uv, 3>& uvs,
                                  const PerspectiveBarycentrics<F>& at) {
    trace_perspective(at.here);
    return {interpolate(uvs, at.here), interpolate(uvs, at.ddx), interpolate(uvs, at.ddy)};
}

/// Whether a texture asks for a simpler filter than the best, as pixel art does.
inline bool has_own_filter(const Texture& texture) {
    return std::min(texture.magnified, texture.minified) != Filter::trilinear;
}

/// The filter of a fragment: the program's, or the texture's own where that is simpler.
///
/// @param level  Of detail: above 0, the texture is minified.
inline Filter filter_at(const Texture& texture, Filter filter, float level) {
    return std::min(filter, level > 0 ? texture.minified : texture.magnified);
}

/// The texture's colour, linear, and alpha in a fragment.
inline vec4 sample(const Texture& texture, Filter filter, const FragmentUv& uv) {
    float level = 0;
    if (filter == Filter::trilinear || has_own_filter(texture))
        level = level_of_detail(uv.ddx, uv.ddy, texture.levels[0].size);
    filter = filter_at(texture, filter, level);
    const vec2 position = texture_position(uv.here, texture.wrap);
    trace_sample(texture, filter, uv, position, level);
    if (filter == Filter::nearest) return sample_nearest(texture.levels[0], position);
    if (filter == Filter::bilinear) return sample_bilinear(texture.levels[0], position);
    return sample_trilinear(texture, position, level);
}

/// The next level: half as wide and high, rounded down, but at least 1; each texel is the mean of
/// what it covers (Eq. 5.9). An image of one colour keeps it exactly: what double rounds is far
/// below half a step of float.
inline Image<vec4> downsampled(const Image<vec4>& picture) {
    // TODO: the size, and Eq. 5.9 in both directions: lengths in whole numbers (64 bits hold the
    // largest), the sum in double.
    return Image<vec4>(ivec2(1));
}

/// The texel to take for one just outside of the texture: that at the opposite side, or the
/// outermost one. (A mirror image begins with the outermost texel once more.)
inline ivec2 texel_beyond(ivec2 texel, ivec2 size, WrapModes wrap) {
    const ivec2 opposite = (texel + size) % size;
    texel = glm::clamp(texel, ivec2(0), size - 1);
    for (int axis = 0; axis < 2; ++axis)
        if (wrap[axis] == Wrap::repeat) texel[axis] = opposite[axis];
    return texel;
}

/// An image with a border of one texel, as bilinear filtering asks for.
inline TextureLevel with_border(const Image<vec4>& picture, WrapModes wrap) {
    // TODO: the picture, and around it what lies beyond (the border, after Eq. 5.5).
    return {picture.size(), Image<vec4>(picture.size() + 2)};
}

/// A texture with all of its levels.
///
/// @param picture  Linear colour and alpha; at least one texel.
inline Texture make_texture(Image<vec4> picture, WrapModes wrap) {
    // TODO: the other levels, down to a single texel, each half as wide and high as the one before
    // (Eq. 5.9).
    return {wrap, {with_border(picture, wrap)}};
}

/// An image's colours decoded from sRGB (Eq. 5.11); alpha is not encoded.
inline Image<vec4> linear_from_srgb8(const Image<u8vec4>& picture) {
    // TODO: Eq. 5.11 by linear_from_srgb(), in float; alpha is only divided by 255.
    return Image<vec4>(picture.size());
}

/// An image whose stored values are plain numbers (UNORM), as floats.
inline Image<vec4> plain_numbers(const Image<u8vec4>& picture) {
    Image<vec4> numbers(picture.size());
    for (std::size_t i = 0; i < numbers.pixels().size(); ++i)
        numbers.pixels()[i] = vec4(picture.pixels()[i]) / 255.0f;
    return numbers;
}

}  // namespace rasterbook
