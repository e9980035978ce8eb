// SPDX-License-Identifier: MIT
/// @file
/// TGA: a header of 18 bytes, then the pixels, plain or in runs.
#pragma once

#include "common/image/image.hpp"
#include "common/image/image_bytes.hpp"

namespace rasterbook {

/// The bytes of a TGA file with 24 bits a pixel, not compressed, the top row first, without the
/// optional footer.
///
/// @param pixels  Width and height >= 1.
/// @param file    Named in the error.
/// @throws InputError  When a side exceeds the 65535 pixels that the header's 16 bits can state.
Bytes encode_tga(const Image<u8vec3>& pixels, const std::filesystem::path& file);

/// TGA has no mark that tells it from other files. So the header must make sense: what cannot be a
/// TGA is taken for a file that is no picture at all.
///
/// @param bytes  A whole file: palette, true colour or grey (types 1, 2, 3) or the same in runs
///               (types 9, 10, 11); 8, 24 or 32 bits; rows and columns in either order.
/// @param file   Named in the error.
/// @param max_pixels  As many are accepted.
/// @throws InputError  When the file is no picture, truncated or of another kind.
Image<u8vec4> decode_tga(ByteView bytes, const std::filesystem::path& file,
                         std::uint64_t max_pixels = any_number);

}  // namespace rasterbook
