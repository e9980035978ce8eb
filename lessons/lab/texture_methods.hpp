// SPDX-License-Identifier: MIT
/// @file
/// Other ways to map the textures of lesson 05 and to decode them; measured in
/// docs/accuracy/05_textures.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "05_textures/interpolation.hpp"
#include "05_textures/texture.hpp"
#include "common/app/lesson_app.hpp"

namespace rasterbook {

constexpr int affine = 0;  ///< For TextureMethod::mapping: no division at all.

/// Where perspective is divided out.
struct TextureMethod {
    int mapping = 1;  ///< Every so many pixels of a row, or `affine`.

    void declare(OptionParser& parser) {
        parser.choice("--mapping", mapping,
                      {{"affine", affine},
                       {"64", 64},
                       {"32", 32},
                       {"16", 16},
                       {"8", 8},
                       {"4", 4},
                       {"perspective", 1}},
                      "Where perspective is divided out of texture coordinates: nowhere, every so "
                      "many pixels of a row, or in each");
    }
};

/// Barycentric coordinates on the triangle: by a division in each pixel (Eq. 5.3), or what the
/// method puts in its place: the coordinates on the screen, or a division only every so many pixels
/// of a row, and straight lines between.
///
/// @see Abrash, "Michael Abrash's Graphics Programming Black Book", 1997, chapter 63: every 16.
class MappedBarycentrics {
  public:
    MappedBarycentrics(const TextureMethod& method, const ScreenTriangle& on_screen,
                       const ClippedTriangle& clipped)
        : mapping_(method.mapping),
          whole_from_piece_(clipped[0].barycentrics, clipped[1].barycentrics,
                            clipped[2].barycentrics),
          is_whole_(whole_from_piece_ == mat3(1)),
          exact_(perspective_setup(
              on_screen, method.mapping == affine ? without_perspective(clipped) : clipped)),
          edges_(edges_of(on_screen)),
          row_edges_(edges_),
          inv_area_(static_cast<float>(1.0 / std::abs(static_cast<double>(on_screen.twice_area)))) {
        if (mapping_ == affine)
            begin_ = perspective_correct(exact_, vec3(1, 0, 0));  // for the steps: all are the same
    }

    /// @param pixel           As fill_triangle gives them, in its order; some may be left out.
    /// @param screen_barycentrics  Of this pixel.
    FragmentBarycentrics at(ivec2 pixel, vec3 screen_barycentrics) {
        if (mapping_ == 1) return perspective_correct(exact_, screen_barycentrics);
        if (mapping_ == affine)
            return {is_whole_ ? screen_barycentrics : whole_from_piece_ * screen_barycentrics,
                    begin_.ddx, begin_.ddy};
        if (pixel.y != row_) begin_row(pixel.y);
        if (pixel.x >= span_end_) begin_span(pixel.x, screen_barycentrics);
        const auto from_begin = static_cast<float>(pixel.x - span_begin_);
        return {begin_.here + from_begin * span_step_, begin_.ddx, begin_.ddy};
    }

  private:
    static ClippedTriangle without_perspective(ClippedTriangle clipped) {
        for (ClippedVertex& vertex : clipped) vertex.position_clip.w = 1;
        return clipped;
    }

    static std::array<EdgeWalk, 3> edges_of(const ScreenTriangle& triangle) {
        const auto [a, b, c] = triangle.vertices;
        const int winding = is_front_facing(triangle) ? 1 : -1;
        return {EdgeWalk(b, c, winding, {0, 0}), EdgeWalk(c, a, winding, {0, 0}),
                EdgeWalk(a, b, winding, {0, 0})};
    }

    void begin_row(int y) {
        row_ = y, span_end_ = none;
        row_edges_ = edges_;
        std::int64_t first = 0, last = static_cast<std::int64_t>(coordinate_limit);
        for (EdgeWalk& edge : row_edges_) {
            edge.value += y * edge.step_y;
            edge.narrow(first, last);
        }
        row_last_ = static_cast<int>(last);
    }

    /// From x to mapping_ pixels further, but not beyond the row's last one: w may be anything
    /// there.
    void begin_span(int x, vec3 screen_barycentrics) {
        // One span begins where another ended, but for pixels that were left out.
        begin_ = x == span_end_ ? end_ : perspective_correct(exact_, screen_barycentrics);
        const int length = std::min(mapping_, row_last_ - x);
        span_begin_ = x, span_end_ = x + std::max(length, 1);
        span_step_ = vec3(0);
        if (length < 1) return;
        end_ = perspective_correct(exact_, screen_barycentrics_at(span_end_));
        span_step_ = (end_.here - begin_.here) / static_cast<float>(length);
    }

    /// What fill_triangle gives in the row's pixel x, bit for bit.
    vec3 screen_barycentrics_at(int x) const {
        const auto share = [&](const EdgeWalk& edge) { return edge.value + x * edge.step_x; };
        return vec3(share(row_edges_[0]), share(row_edges_[1]), share(row_edges_[2])) * inv_area_;
    }

    static constexpr int none = -1;

    int mapping_;
    mat3 whole_from_piece_;
    bool is_whole_;
    PerspectiveSetup exact_;
    std::array<EdgeWalk, 3> edges_, row_edges_;  ///< From column 0, of row 0 and of this row.
    float inv_area_;
    int row_ = none, row_last_ = none;  ///< The row, and its last pixel.
    int span_begin_ = none, span_end_ = none;
    FragmentBarycentrics begin_{}, end_{};  ///< Of the span; `end_` at span_end_.
    vec3 span_step_{0};
};

/// A level whose texels stay the values of the file: four bytes each, a quarter of TextureLevel's.
struct EncodedLevel {
    ivec2 size;            ///< In texels, without the border.
    Image<u8vec4> texels;  ///< With a border, as TextureLevel has.
};

inline EncodedLevel make_encoded_level(const Image<u8vec4>& picture, WrapModes wrap) {
    const ivec2 size = picture.size();
    EncodedLevel level{size, Image<u8vec4>(size + 2)};
    for (int y = 0; y < size.y + 2; ++y)
        for (int x = 0; x < size.x + 2; ++x)
            level.texels[{x, y}] = picture[texel_beyond(ivec2(x, y) - 1, size, wrap)];
    return level;
}

/// The mean of the four texels around a position (Eq. 5.6).
///
/// @param read  Called as read(u8vec4 texel): what the mean is taken of.
template <std::invocable<u8vec4> Read>
vec4 sample_bilinear(const EncodedLevel& level, vec2 position, Read&& read) {
    const vec2 from_first_center = position * vec2(level.size) + 0.5f;
    const ivec2 first(from_first_center);
    const vec2 share = from_first_center - vec2(first);
    const u8vec4* const upper = &level.texels[first];
    const u8vec4* const lower = upper + level.texels.size().x;
    const vec4 left = read(upper[0]), left_below = read(lower[0]);
    const vec4 in_upper = left + share.x * (read(upper[1]) - left);
    const vec4 in_lower = left_below + share.x * (read(lower[1]) - left_below);
    return in_upper + share.y * (in_lower - in_upper);
}

/// Stored values taken for amounts of light.
inline vec4 undecoded(u8vec4 texel) { return vec4(texel) / 255.0f; }

/// Colour decoded from sRGB (Eq. 5.11), each channel 0 to 1; alpha is not encoded.
inline vec4 decoded_exactly(vec4 color) {
    return {linear_from_srgb(color.r), linear_from_srgb(color.g), linear_from_srgb(color.b),
            color.a};
}

/// The 256 amounts of light that a stored value may stand for, computed once.
class DecodingTable {
  public:
    DecodingTable() {
        for (std::size_t value = 0; value < linear_.size(); ++value)
            linear_[value] = linear_from_srgb(static_cast<float>(value) / 255.0f);
    }

    vec4 operator()(u8vec4 texel) const {
        return {linear_[texel.r], linear_[texel.g], linear_[texel.b],
                static_cast<float>(texel.a) / 255.0f};
    }

  private:
    std::array<float, 256> linear_;
};

/// Each of the four texels is decoded by a table.
inline vec4 sample_by_table(const EncodedLevel& level, vec2 position, const DecodingTable& table) {
    return sample_bilinear(level, position, table);
}

/// Each of the four texels is decoded with its power.
inline vec4 sample_by_power(const EncodedLevel& level, vec2 position) {
    return sample_bilinear(level, position, [](u8vec4 t) { return decoded_exactly(undecoded(t)); });
}

/// The mean of the stored values is decoded, which is not the mean of what they stand for.
inline vec4 sample_then_decode(const EncodedLevel& level, vec2 position) {
    return decoded_exactly(sample_bilinear(level, position, undecoded));
}

}  // namespace rasterbook
