// SPDX-License-Identifier: MIT
/// @file
/// PNG by libpng. What a file claims is checked before memory is taken for it.
#pragma once

#include "common/image/image.hpp"
#include "common/image/image_bytes.hpp"

namespace rasterbook {

/// The bytes of a PNG file with 8 bits a channel; compressed so that it takes little time.
///
/// @param pixels  Width and height >= 1.
/// @param file    Named in the error.
/// @throws InputError  When there is no memory for it.
Bytes encode_png(const Image<u8vec3>& pixels, const std::filesystem::path& file);
Bytes encode_png(const Image<u8vec4>& pixels,
                 const std::filesystem::path& file);  ///< With opacity.

/// @param bytes  A whole file that begins with PNG's signature.
/// @param file   Named in the error.
/// @param max_pixels  As many are accepted.
/// @throws InputError  When the file is truncated, damaged or claims more than its bytes can hold.
Image<u8vec4> decode_png(ByteView bytes, const std::filesystem::path& file,
                         std::uint64_t max_pixels = any_number);

}  // namespace rasterbook
