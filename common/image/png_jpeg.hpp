// SPDX-License-Identifier: MIT
/// @file
/// PNG and JPEG by stb, whose decoders are lenient: what must not pass is checked before they
/// start.
#pragma once

#include "common/image/image.hpp"
#include "common/image/image_bytes.hpp"

namespace rasterbook {

/// The bytes of a PNG file with 8 bits a channel.
///
/// @param pixels  Width and height >= 1.
/// @param file    Named in the error.
/// @throws InputError  When the picture has 2^31 bytes or more.
Bytes encode_png(const Image<u8vec3>& pixels, const std::filesystem::path& file);

/// @param bytes  A whole file that begins with PNG's signature; fewer than 2^31 bytes.
/// @param file   Named in the error.
/// @throws InputError  When the file is truncated, damaged or claims more than its bytes can hold.
Image<u8vec4> decode_png(Bytes bytes, const std::filesystem::path& file);

/// @param bytes  A whole file that begins with FF D8 FF; fewer than 2^31 bytes.
/// @param file   Named in the error.
/// @throws InputError  When the file is truncated, damaged or claims more than its bytes can hold,
///          or has more than 100 scans (each one is a pass over the whole picture, however short).
Image<u8vec4> decode_jpeg(ByteView bytes, const std::filesystem::path& file);

}  // namespace rasterbook
