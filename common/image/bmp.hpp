// SPDX-License-Identifier: MIT
/// @file
/// BMP, the plainest picture file: a header, then rows of blue, green and red.
#pragma once

#include <cstdint>

#include "common/image/image.hpp"
#include "common/image/image_bytes.hpp"

namespace rasterbook {

/// How many zero bytes follow a row of 3-byte pixels, so that each row takes a multiple of 4 bytes.
constexpr int bmp_row_padding(std::int64_t width) {
    return static_cast<int>((4 - 3 * width % 4) % 4);  // Eq. 1.9
}

/// The length of a BMP file of this size with 3 bytes a pixel: 54 bytes of header, then the rows.
constexpr std::uint64_t bmp_file_bytes(ivec2 size) {
    const auto row_bytes = std::uint64_t{3} * static_cast<std::uint64_t>(size.x) +
                           static_cast<std::uint64_t>(bmp_row_padding(size.x));
    return 54 + row_bytes * static_cast<std::uint64_t>(size.y);
}

/// The bytes of a BMP file with 24 bits a pixel, the bottom row first.
///
/// @param pixels  Width and height >= 1.
/// @param file    Named in the error.
/// @throws InputError  When the file's length does not fit into the 32 bits that the header has for
///         it.
Bytes encode_bmp(const Image<u8vec3>& pixels, const std::filesystem::path& file);

/// @param bytes  A whole file that begins with "BM". 24 or 32 bits a pixel, or 8 with a palette;
///               not compressed; the bottom or the top row first.
/// @param file   Named in the error.
/// @param max_pixels  As many are accepted.
/// @throws InputError  When the file is truncated or of another kind.
Image<u8vec4> decode_bmp(ByteView bytes, const std::filesystem::path& file,
                         std::uint64_t max_pixels = any_number);

}  // namespace rasterbook
