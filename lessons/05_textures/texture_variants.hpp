// SPDX-License-Identifier: MIT
/// @file
/// Cheaper ways to map a texture, to be seen with `--mapping`, `--filter`, `--wrap` and `--srgb`,
/// and measured in docs/accuracy/05_textures.md.
#pragma once

#include <algorithm>
#include <cstdint>

#include "05_textures/texture.hpp"
#include "common/lesson_app.hpp"

namespace rasterbook {

/// What the codes in a picture are taken for: sRGB, or amounts of light.
enum class Decoding { srgb, ignored };

constexpr int affine = 0;  ///< For TextureVariant::mapping: no division at all.

struct TextureVariant {
    int mapping = 1;  ///< Perspective is divided out every so many pixels of a row, or `affine`.
    Filter filter = Filter::trilinear;
    Wrap wrap = Wrap::repeat;  ///< Of maps that do not ask for -clamp.
    Decoding decoding = Decoding::srgb;
    bool keep_going = false;  ///< A picture that cannot be read is replaced.

    void declare(Knobs& knobs) {
        knobs.choice("--mapping", mapping,
                     {{"affine", affine},
                      {"64", 64},
                      {"32", 32},
                      {"16", 16},
                      {"8", 8},
                      {"4", 4},
                      {"perspective", 1}},
                     "Textures in perspective: not at all, every so many pixels, or everywhere");
        knobs.choice("--filter", filter,
                     {{"nearest", Filter::nearest},
                      {"bilinear", Filter::bilinear},
                      {"trilinear", Filter::trilinear}},
                     "The nearest texel, a mean of four, or of four in each of two sizes");
        knobs.choice("--wrap", wrap,
                     {{"repeat", Wrap::repeat}, {"mirror", Wrap::mirror}, {"clamp", Wrap::clamp}},
                     "What lies beyond a texture's border");
        knobs.choice("--srgb", decoding,
                     {{"decoded", Decoding::srgb}, {"ignored", Decoding::ignored}},
                     "What the codes in a picture are taken for: sRGB, or amounts of light");
        knobs.flag("--keep-going", keep_going,
                   "A texture that cannot be read is a warning, and a chessboard takes its place");
    }

    /// A picture's colours as the variant has it.
    Image<vec4> decoded(const Image<u8vec4>& picture) const {
        return decoding == Decoding::srgb ? linear_from_srgb8(picture) : plain_numbers(picture);
    }
};

/// PerspectiveWeights, or what the variant puts in its place: a division only every so many pixels,
/// and straight lines between.
///
/// @see Abrash, "Michael Abrash's Graphics Programming Black Book", 1997, chapter 63: every 16.
class MappedWeights {
  public:
    MappedWeights(const TextureVariant& variant, const ScreenTriangle& on_screen,
                  const ClippedTriangle& clipped)
        : mapping_(variant.mapping),
          on_screen_(on_screen),
          exact_(on_screen, variant.mapping == affine ? without_perspective(clipped) : clipped) {}

    /// @param pixel           As fill_triangle gives them, all of a triangle's, in its order.
    /// @param screen_weights  The same.
    FragmentWeights at(ivec2 pixel, vec3 screen_weights) {
        return mapping_ <= 1 ? exact_.at(screen_weights) : in_span(pixel, screen_weights);
    }

  private:
    FragmentWeights in_span(ivec2 pixel, vec3 screen_weights) {
        if (pixel.y != row_) {
            row_ = pixel.y, span_end_ = pixel.x;
            row_end_ = pixel.x + pixels_right_of(pixel);
        }
        if (pixel.x >= span_end_) begin_span(pixel.x, screen_weights);
        FragmentWeights weights = at_begin_;
        weights.here += static_cast<float>(pixel.x - span_begin_) * span_step_;
        return weights;
    }

    static ClippedTriangle without_perspective(ClippedTriangle clipped) {
        for (ClippedCorner& corner : clipped) corner.position_clip.w = 1;
        return clipped;
    }

    /// How many more pixels of its row the triangle covers.
    int pixels_right_of(ivec2 pixel) const {
        std::int64_t first = 0, last = coordinate_limit;
        const auto [a, b, c] = on_screen_.corners;
        const int winding = on_screen_.twice_area > 0 ? 1 : -1;
        for (const EdgeWalk& edge : {EdgeWalk(b, c, winding, pixel), EdgeWalk(c, a, winding, pixel),
                                     EdgeWalk(a, b, winding, pixel)})
            edge.narrow(first, last);
        return static_cast<int>(last);
    }

    void begin_span(int x, vec3 screen_weights) {
        const int length = std::clamp(row_end_ - x, 1, mapping_);
        const auto pixels = static_cast<float>(length);
        at_begin_ = exact_.at(screen_weights);
        const vec3 at_end = row_end_ == x
                                ? at_begin_.here
                                : exact_.at(screen_weights + pixels * exact_.screen_step_x()).here;
        span_begin_ = x, span_end_ = x + length;
        span_step_ = (at_end - at_begin_.here) / pixels;
    }

    int mapping_;
    const ScreenTriangle& on_screen_;
    PerspectiveWeights exact_;
    int row_ = -1, row_end_ = 0;  ///< The row's last pixel.
    int span_begin_ = 0, span_end_ = 0;
    FragmentWeights at_begin_{};
    vec3 span_step_{0};
};

}  // namespace rasterbook
