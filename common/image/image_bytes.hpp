// SPDX-License-Identifier: MIT
/// @file
/// What the picture formats share: numbers and colours as bytes, and checks of what a header
/// claims.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "common/image/input_error.hpp"
#include "common/math/types.hpp"

namespace rasterbook {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

/// BMP and TGA store numbers with the lowest byte first, whatever the machine's own order is.
inline void append_u16(Bytes& bytes, std::uint16_t value) {
    bytes.push_back(static_cast<std::uint8_t>(value));
    bytes.push_back(static_cast<std::uint8_t>(value >> 8));
}

inline void append_u32(Bytes& bytes, std::uint32_t value) {
    append_u16(bytes, static_cast<std::uint16_t>(value));
    append_u16(bytes, static_cast<std::uint16_t>(value >> 16));
}

/// BMP and TGA store blue first.
inline void append_bgr(Bytes& bytes, u8vec3 color) {
    bytes.insert(bytes.end(), {color.b, color.g, color.r});
}

/// The number of pixels (or blocks) of a picture, which may exceed an int.
inline std::uint64_t area(ivec2 size) {
    return static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y);
}

/// @param at  The position of the lowest byte; all bytes of the number lie inside.
inline std::uint32_t u16_at(ByteView bytes, std::size_t at) {
    return bytes[at] | std::uint32_t{bytes[at + 1]} << 8;
}

inline std::uint32_t u32_at(ByteView bytes, std::size_t at) {
    return u16_at(bytes, at) | u16_at(bytes, at + 2) << 16;
}

/// @param stored  Grey; or blue, green, red; or these and a fourth byte.
/// @param has_opacity  Whether the fourth byte is one: some files leave it unused.
inline u8vec4 color_from_stored(ByteView stored, bool has_opacity) {
    if (stored.size() == 1) return {stored[0], stored[0], stored[0], 255};
    const bool opaque = stored.size() < 4 || !has_opacity;
    return {stored[2], stored[1], stored[0], opaque ? std::uint8_t{255} : stored[3]};
}

/// Of a picture that is read, so that no product of both sides with a few bytes a pixel overflows
/// 64 bits.
constexpr int max_side = 1 << 24;

/// For a picture that may have as many pixels as its bytes can hold.
constexpr std::uint64_t any_number = std::numeric_limits<std::uint64_t>::max();

/// The size of a picture whose header claims these sides.
///
/// @param max_pixels   As many are accepted.
/// @throws InputError  When a side is below 1 or above max_side, or there are more pixels.
inline ivec2 checked_size(std::int64_t width, std::int64_t height, std::uint64_t max_pixels,
                          const std::filesystem::path& file) {
    if (width < 1 || height < 1 || width > max_side || height > max_side)
        throw InputError(file, "a picture of " + std::to_string(width) + " x " +
                                   std::to_string(height) + " pixels: each side must lie in 1 to " +
                                   std::to_string(max_side));
    if (area({width, height}) > max_pixels)
        throw InputError(file, "a picture of " + std::to_string(width) + " x " +
                                   std::to_string(height) + " pixels: only " +
                                   std::to_string(max_pixels) +
                                   " are left of those that are accepted; see --limit pixels=N");
    return {width, height};
}

/// To be asked before memory is set aside for what a header claims.
///
/// @throws InputError  When fewer bytes are there than needed.
inline void check_pixel_bytes(std::uint64_t needed, std::uint64_t there,
                              const std::filesystem::path& file) {
    if (there < needed)
        throw InputError(file, "truncated: " + std::to_string(there) + " of " +
                                   std::to_string(needed) + " bytes of pixels are there");
}

/// Checks that there are as many bytes as compressed pixels take at least.
///
/// @param least  The number of bytes that so many pixels take at the best compression.
inline void check_compressed_bytes(ivec2 size, std::uint64_t least, std::uint64_t there,
                                   const std::filesystem::path& file) {
    if (there < least)
        throw InputError(file, "too short for the " + std::to_string(size.x) + " x " +
                                   std::to_string(size.y) + " pixels that it claims");
}

}  // namespace rasterbook
