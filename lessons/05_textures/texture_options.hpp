// SPDX-License-Identifier: MIT
/// @file
/// How textures are read: `--filter`, `--wrap`, `--srgb` and `--keep-going`.
#pragma once

#include "05_textures/texture.hpp"
#include "common/app/lesson_app.hpp"

namespace rasterbook {

/// What an image's stored values are taken for: sRGB, or amounts of light.
enum class Decoding { srgb, ignored };

/// How textures are read, in this lesson and all later ones.
struct TextureOptions {
    Filter filter = Filter::trilinear;
    Wrap wrap = Wrap::repeat;  ///< Of maps that ask for none themselves.
    Decoding decoding = Decoding::srgb;
    bool keep_going = false;  ///< An image that cannot be read is replaced.

    void declare(OptionParser& parser) {
        parser.choice("--filter", filter,
                      {{"nearest", Filter::nearest},
                       {"bilinear", Filter::bilinear},
                       {"trilinear", Filter::trilinear}},
                      "The nearest texel, the mean of four, or of four in each of two mip levels");
        parser.choice("--wrap", wrap,
                      {{"repeat", Wrap::repeat}, {"mirror", Wrap::mirror}, {"clamp", Wrap::clamp}},
                      "What lies beyond a texture's border");
        parser.choice("--srgb", decoding,
                      {{"decoded", Decoding::srgb}, {"ignored", Decoding::ignored}},
                      "Whether a texture's sRGB-encoded values are decoded to linear");
        parser.flag("--keep-going", keep_going,
                    "A texture that cannot be read is a warning, and a chessboard takes its place");
    }

    /// An image's colours, decoded as the options say.
    Image<vec4> decoded(const Image<u8vec4>& picture) const {
        return decoding == Decoding::srgb ? linear_from_srgb8(picture) : plain_numbers(picture);
    }
};

}  // namespace rasterbook
