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
    // Written so that NaN loses each comparison.
    if (wrap == Wrap::repeat) return std::max(0.0f, coordinate - std::floor(coordinate));
    if (wrap == Wrap::clamp) return std::min(std::max(0.0f, coordinate), 1.0f);
    const float there_and_back = coordinate - 2 * std::floor(0.5f * coordinate);
    return std::max(0.0f, std::min(there_and_back, 2 - there_and_back));
}

/// A position in the texture: x from 0 at its left to 1 at its right, y from 0 at its upper border
/// to 1 at its lower one (Eq. 5.5).
inline vec2 texture_position(vec2 uv, WrapModes wrap) {
    return {wrapped(uv.x, wrap.u), 1 - wrapped(uv.y, wrap.v)};
}

/// The texel in which a position lies.
///
/// @param position  0 to 1.
inline vec4 sample_nearest(const TextureLevel& level, vec2 position) {
    const ivec2 texel(position * vec2(level.size));  // not negative, so this rounds down
    return level.texels[glm::min(texel, level.size - 1) + 1];
}

/// The mean of the four texels around a position, by how near their centres are (Eq. 5.6).
///
/// @param position  0 to 1.
inline vec4 sample_bilinear(const TextureLevel& level, vec2 position) {
    const vec2 from_first_center = position * vec2(level.size) + 0.5f;   // the border's first texel
    const ivec2 first = glm::min(ivec2(from_first_center), level.size);  // above 2^23, + 0.5 rounds
    const vec2 share = from_first_center - vec2(first);
    const vec4* const upper = &level.texels[first];
    const vec4* const lower = upper + level.texels.size().x;
    // a + t (b - a) is exactly a where a and b are equal.
    const vec4 in_upper = upper[0] + share.x * (upper[1] - upper[0]);
    const vec4 in_lower = lower[0] + share.x * (lower[1] - lower[0]);
    return in_upper + share.y * (in_lower - in_upper);
}

/// The level at which a pixel's footprint is one texel long, by its longer side (Eq. 5.8).
///
/// @param ddx,ddy  How fast uv changes here, a pixel to the right and a pixel down.
/// @param size     Of level 0, in texels.
/// @return  0 where the footprint is a texel or less, and where any of the four numbers is NaN;
///          else it may be infinite.
inline float level_of_detail(vec2 ddx, vec2 ddy, ivec2 size) {
    const vec2 across = ddx * vec2(size), down = ddy * vec2(size);
    const float across_squared = glm::dot(across, across), down_squared = glm::dot(down, down);
    // std::max(25, NaN) is 25; a sum is NaN where either is.
    if (std::isnan(across_squared + down_squared)) return 0;
    const float longer_squared = std::max(across_squared, down_squared);
    return longer_squared > 1 ? 0.5f * log2(longer_squared) : 0.0f;
}

/// The mean of what two levels have at a position, by how near they are to `level` (Eq. 5.10).
///
/// @param position  0 to 1.
/// @param level  >= 0, infinite too; beyond the last level it is the last one.
inline vec4 sample_trilinear(const Texture& texture, vec2 position, float level) {
    const auto last = static_cast<float>(texture.levels.size() - 1);
    level = std::min(level, last);
    const auto finer = static_cast<std::size_t>(level);
    const vec4 in_finer = sample_bilinear(texture.levels[finer], position);
    const float share = level - static_cast<float>(finer);
    if (share == 0) return in_finer;
    const vec4 in_coarser = sample_bilinear(texture.levels[finer + 1], position);
    return in_finer + share * (in_coarser - in_finer);
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
    using lengths = glm::vec<2, std::int64_t>;
    // In whole numbers: a texel of the picture is `to` long, one of the next level `from`.
    const lengths from(picture.size()), to = glm::max(from / lengths(2), lengths(1));
    Image<vec4> half{ivec2(to)};
    for (int y = 0; y < half.size().y; ++y)
        for (int x = 0; x < half.size().x; ++x) {
            const lengths low = lengths(x, y) * from, high = low + from;
            const ivec2 first(low / to), last((high - lengths(1)) / to);
            dvec4 sum(0);
            for (int row = first.y; row <= last.y; ++row)
                for (int column = first.x; column <= last.x; ++column) {
                    const lengths begin = lengths(column, row) * to;
                    const dvec2 covered(glm::min(high, begin + to) - glm::max(low, begin));
                    sum += covered.x * covered.y * dvec4(picture[{column, row}]);
                }
            const dvec2 whole(from);
            half[{x, y}] = vec4(sum / (whole.x * whole.y));
        }
    return half;
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
    const ivec2 size = picture.size();
    TextureLevel level{size, Image<vec4>(size + 2)};
    for (int y = 0; y < size.y + 2; ++y)
        for (int x = 0; x < size.x + 2; ++x)
            level.texels[{x, y}] = picture[texel_beyond(ivec2(x, y) - 1, size, wrap)];
    return level;
}

/// A texture with all of its levels.
///
/// @param picture  Linear colour and alpha; at least one texel.
inline Texture make_texture(Image<vec4> picture, WrapModes wrap) {
    Texture texture{wrap, {with_border(picture, wrap)}};
    while (picture.size() != ivec2(1)) {
        picture = downsampled(picture);
        texture.levels.push_back(with_border(picture, wrap));
    }
    return texture;
}

/// An image's colours decoded from sRGB (Eq. 5.11); alpha is not encoded.
inline Image<vec4> linear_from_srgb8(const Image<u8vec4>& picture) {
    std::array<float, 256> linear;
    for (std::size_t value = 0; value < linear.size(); ++value)
        linear[value] = linear_from_srgb(static_cast<float>(value) / 255.0f);
    Image<vec4> decoded(picture.size());
    for (std::size_t i = 0; i < decoded.pixels().size(); ++i) {
        const u8vec4 texel = picture.pixels()[i];
        decoded.pixels()[i] = {linear[texel.r], linear[texel.g], linear[texel.b],
                               static_cast<float>(texel.a) / 255.0f};
    }
    return decoded;
}

/// An image whose stored values are plain numbers (UNORM), as floats.
inline Image<vec4> plain_numbers(const Image<u8vec4>& picture) {
    Image<vec4> numbers(picture.size());
    for (std::size_t i = 0; i < numbers.pixels().size(); ++i)
        numbers.pixels()[i] = vec4(picture.pixels()[i]) / 255.0f;
    return numbers;
}

}  // namespace rasterbook
