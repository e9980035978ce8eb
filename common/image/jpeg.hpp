// SPDX-License-Identifier: MIT
/// @file
/// JPEG by stb, whose decoder is lenient: what must not pass is checked before it starts.
#pragma once

#include <string>

#include "common/image/image.hpp"
#include "common/image/image_bytes.hpp"

namespace rasterbook {

/// @param bytes  A whole file that begins with FF D8 FF; fewer than 2^31 bytes.
/// @param file   Named in the error.
/// @param max_pixels  As many are accepted.
/// @param remark  If not null, takes what is missing though all pixels are there: the mark of the
///                end; else it stays as it is.
/// @throws InputError  When the file is truncated, damaged or claims more than its bytes can hold,
///          or has more than 100 scans (each one is a pass over the whole picture, however short).
Image<u8vec4> decode_jpeg(ByteView bytes, const std::filesystem::path& file,
                          std::uint64_t max_pixels = any_number, std::string* remark = nullptr);

}  // namespace rasterbook
