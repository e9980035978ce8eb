// SPDX-License-Identifier: MIT
/// @file
/// Pictures in files: BMP and TGA by hand (bmp.hpp, tga.hpp; lesson 01 explains them), PNG by
/// libpng, JPEG by stb.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "common/image/image.hpp"
#include "common/image/image_bytes.hpp"

namespace rasterbook {

/// Reads a PNG, JPEG, BMP or TGA file; the format is told by the content, not by the name.
///
/// No memory is set aside for a claim that the file's bytes cannot hold.
///
/// @param max_pixels  As many are accepted.
/// @param remark      If not null, takes what is wrong with a file that can be read nevertheless.
/// @return  Red, green, blue, opacity as stored (colours in files are sRGB), the top row first.
///          A missing opacity is 255; grey becomes three equal values; 16 bits a channel are
///          rounded to 8.
/// @throws InputError  When the file is missing, not a regular file, longer than 2^31 - 1 bytes,
///          truncated, of an unsupported kind, of zero size, has a side over 2^24, or claims more
///          pixels than its bytes can hold or than are accepted.
Image<u8vec4> read_image(const std::filesystem::path& file, std::uint64_t max_pixels = any_number,
                         std::string* remark = nullptr);

/// Reads a picture whose file is in memory already.
///
/// @param bytes       Fewer than 2^31.
/// @param name        Named in errors.
/// @param max_pixels  As many are accepted.
/// @param remark      If not null, takes what is wrong with a picture that can be read
///                    nevertheless.
Image<u8vec4> decode_image(std::span<const std::uint8_t> bytes, const std::filesystem::path& name,
                           std::uint64_t max_pixels = any_number, std::string* remark = nullptr);

/// Writes a picture as PNG, BMP or TGA, by the ending of the name (in any case).
///
/// The file appears whole or not at all: it is written beside its name and renamed at the end.
///
/// @param pixels  Red, green, blue in sRGB; width and height >= 1.
/// @throws InputError  When the ending is unknown, the format cannot hold a picture of this size or
///          the file cannot be written.
void write_image(const std::filesystem::path& file, const Image<u8vec3>& pixels);

/// @throws InputError  Unless the name ends in .png, .bmp or .tga: to be asked before a long
///         rendering.
void check_image_name(const std::filesystem::path& file);

}  // namespace rasterbook
