// SPDX-License-Identifier: MIT
#include "common/image/bmp.hpp"

#include <limits>

namespace rasterbook {
namespace {

constexpr std::uint32_t file_header_bytes = 14;
constexpr std::uint32_t info_header_bytes = 40;  // Windows' BITMAPINFOHEADER
constexpr std::uint32_t header_bytes = file_header_bytes + info_header_bytes;
constexpr const char* unsupported =
    "unsupported BMP: only 8, 24 or 32 bits a pixel, not compressed";

/// What the reader needs to know of a header.
struct BmpHeader {
    ivec2 size;
    bool top_row_first;
    std::size_t bytes_per_pixel;  ///< 1 (an index into the palette), 3 or 4
    bool has_opacity;
    ByteView palette;  ///< 4 bytes a colour
    ByteView rows;     ///< From the first row to the end of the file
};

/// The header has grown over the years; each version begins like the first one.
bool is_known_version(std::uint32_t info_bytes) {
    return info_bytes == 40 || info_bytes == 52 || info_bytes == 56 || info_bytes == 108 ||
           info_bytes == 124;
}

/// Whether 32-bit pixels with masks for their channels are the ordinary blue, green, red, opacity.
bool has_ordinary_masks(ByteView bytes, std::uint32_t opacity_mask) {
    return bytes.size() >= 66 && u32_at(bytes, 54) == 0x00ff0000u &&
           u32_at(bytes, 58) == 0x0000ff00u && u32_at(bytes, 62) == 0x000000ffu &&
           (opacity_mask == 0 || opacity_mask == 0xff000000u);
}

ByteView read_palette(ByteView bytes, std::size_t begin, const std::filesystem::path& file) {
    const std::uint32_t claimed = u32_at(bytes, 46);
    const std::size_t colors = claimed == 0 ? 256 : claimed;
    if (colors > 256 || bytes.size() - begin < 4 * colors)
        throw InputError(file, "truncated or damaged: the palette claims " +
                                   std::to_string(colors) + " colours");
    return bytes.subspan(begin, 4 * colors);
}

/// The length of the header, once it is certain that all of it is there.
std::uint32_t checked_info_bytes(ByteView bytes, const std::filesystem::path& file) {
    if (bytes.size() < header_bytes) throw InputError(file, "truncated inside the BMP header");
    const std::uint32_t info_bytes = u32_at(bytes, 14);
    if (!is_known_version(info_bytes)) throw InputError(file, unsupported);
    if (bytes.size() < file_header_bytes + info_bytes)
        throw InputError(file, "truncated inside the BMP header");
    return info_bytes;
}

BmpHeader read_header(ByteView bytes, const std::filesystem::path& file, std::uint64_t max_pixels) {
    const std::uint32_t info_bytes = checked_info_bytes(bytes, file);
    const std::uint32_t pixels_begin = u32_at(bytes, 10);
    const std::uint32_t bits = u16_at(bytes, 28);
    const std::uint32_t compression = u32_at(bytes, 30);
    // Only a header of 56 bytes or more has a mask for the opacity.
    const std::uint32_t opacity_mask = info_bytes >= 56 ? u32_at(bytes, 66) : 0;
    const bool plain = compression == 0 && (bits == 8 || bits == 24 || bits == 32);
    const bool masked = compression == 3 && bits == 32 && has_ordinary_masks(bytes, opacity_mask);
    if (!plain && !masked) throw InputError(file, unsupported);
    if (pixels_begin < file_header_bytes + info_bytes || pixels_begin > bytes.size())
        throw InputError(file, "truncated or damaged: the pixels begin outside the file");

    const auto width = static_cast<std::int32_t>(u32_at(bytes, 18));
    const auto height = static_cast<std::int32_t>(u32_at(bytes, 22));
    const std::int64_t rows = height;  // in 64 bits, where every number has a negative
    return {.size = checked_size(width, rows < 0 ? -rows : rows, max_pixels, file),
            .top_row_first = rows < 0,
            .bytes_per_pixel = bits / 8,
            .has_opacity = masked && opacity_mask != 0,
            .palette =
                bits == 8 ? read_palette(bytes, file_header_bytes + info_bytes, file) : ByteView{},
            .rows = bytes.subspan(pixels_begin)};
}

u8vec4 palette_color(ByteView palette, std::size_t index, const std::filesystem::path& file) {
    if (4 * index >= palette.size())
        throw InputError(file, "a pixel has colour " + std::to_string(index) + " of a palette of " +
                                   std::to_string(palette.size() / 4));
    return color_from_stored(palette.subspan(4 * index, 4), false);
}

void append_header(Bytes& bytes, ivec2 size, std::uint32_t file_bytes) {
    for (const char letter : {'B', 'M'}) bytes.push_back(static_cast<std::uint8_t>(letter));
    append_u32(bytes, file_bytes);
    append_u32(bytes, 0);             // reserved
    append_u32(bytes, header_bytes);  // where the pixels begin

    append_u32(bytes, info_header_bytes);
    append_u32(bytes, static_cast<std::uint32_t>(size.x));
    append_u32(bytes, static_cast<std::uint32_t>(size.y));  // > 0: the bottom row comes first
    append_u16(bytes, 1);                                   // planes
    append_u16(bytes, 24);                                  // bits a pixel
    append_u32(bytes, 0);                                   // not compressed
    append_u32(bytes, file_bytes - header_bytes);
    append_u32(bytes, 2835);  // pixels a metre in x: 72 an inch
    append_u32(bytes, 2835);  // pixels a metre in y
    append_u32(bytes, 0);     // no palette
    append_u32(bytes, 0);     // no colour matters more than another
}

}  // namespace

Bytes encode_bmp(const Image<u8vec3>& pixels, const std::filesystem::path& file) {
    const ivec2 size = pixels.size();
    const std::uint64_t file_bytes = bmp_file_bytes(size);
    if (file_bytes > std::numeric_limits<std::uint32_t>::max())
        throw InputError(file, "the picture is too large for BMP: 4 GiB is the limit");

    Bytes bytes;
    bytes.reserve(file_bytes);
    append_header(bytes, size, static_cast<std::uint32_t>(file_bytes));
    for (int y = size.y - 1; y >= 0; --y) {
        for (int x = 0; x < size.x; ++x) append_bgr(bytes, pixels[{x, y}]);
        for (int i = 0; i < bmp_row_padding(size.x); ++i) bytes.push_back(0);
    }
    return bytes;
}

Image<u8vec4> decode_bmp(ByteView bytes, const std::filesystem::path& file,
                         std::uint64_t max_pixels) {
    const BmpHeader header = read_header(bytes, file, max_pixels);
    const std::size_t pixel_bytes = header.bytes_per_pixel;
    const std::size_t row_bytes =
        (static_cast<std::size_t>(header.size.x) * pixel_bytes + 3) / 4 * 4;
    check_pixel_bytes(row_bytes * static_cast<std::size_t>(header.size.y), header.rows.size(),
                      file);

    Image<u8vec4> image(header.size);
    for (int row = 0; row < header.size.y; ++row) {
        const int y = header.top_row_first ? row : header.size.y - 1 - row;
        ByteView stored = header.rows.subspan(static_cast<std::size_t>(row) * row_bytes);
        for (int x = 0; x < header.size.x; ++x, stored = stored.subspan(pixel_bytes))
            image[{x, y}] = header.palette.empty()
                                ? color_from_stored(stored.first(pixel_bytes), header.has_opacity)
                                : palette_color(header.palette, stored[0], file);
    }
    return image;
}

}  // namespace rasterbook
