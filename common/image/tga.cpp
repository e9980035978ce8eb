// SPDX-License-Identifier: MIT
#include "common/image/tga.hpp"

namespace rasterbook {
namespace {

constexpr std::size_t header_bytes = 18;
enum ImageType : std::uint8_t { with_palette = 1, true_color = 2, grey = 3 };
constexpr std::uint8_t in_runs = 8;  // added to the type
constexpr std::uint8_t right_column_first = 0x10, top_row_first = 0x20;

struct Palette {
    ByteView entries;
    std::size_t entry_bytes = 0;
    std::size_t first_index = 0;  ///< The index of entries[0]
};

/// What the reader needs to know of a header.
struct TgaHeader {
    ivec2 size;
    std::uint8_t type;  ///< An ImageType
    bool has_runs;
    std::size_t bytes_per_pixel;
    std::uint8_t descriptor;
    Palette palette;
    ByteView pixels;  ///< From the first pixel to the end of the file

    bool has_opacity() const { return (descriptor & 0x0f) != 0; }
};

/// Whether the first 18 bytes can be a TGA header at all.
bool is_tga(ByteView bytes) {
    if (bytes.size() < header_bytes) return false;
    const int palette_type = bytes[1];
    const int type = bytes[2] & ~in_runs;
    const int palette_bits = bytes[7];
    const bool palette_fits = palette_type == 1 || (palette_type == 0 && type != with_palette);
    const bool entries_fit = palette_type == 0 || palette_bits == 15 || palette_bits == 16 ||
                             palette_bits == 24 || palette_bits == 32;
    const int bits = bytes[16];
    return palette_fits && entries_fit && (type >= with_palette && type <= grey) &&
           (bits == 8 || bits == 15 || bits == 16 || bits == 24 || bits == 32) &&
           (bytes[17] & 0xc0) == 0;
}

TgaHeader read_header(ByteView bytes, const std::filesystem::path& file, std::uint64_t max_pixels) {
    if (!is_tga(bytes)) throw InputError(file, "not a PNG, JPEG, BMP or TGA picture");
    const auto type = static_cast<std::uint8_t>(bytes[2] & ~in_runs);
    const std::size_t bits = bytes[16];
    const std::size_t entry_bytes = bytes[1] == 0 ? 0 : (bytes[7] + 7u) / 8u;
    const bool bits_fit = type == true_color ? bits == 24 || bits == 32 : bits == 8;
    if (!bits_fit || (type == with_palette && entry_bytes < 3))
        throw InputError(file, "unsupported TGA: only 8 bits of grey, or 24 or 32 of colour");

    const std::size_t palette_begin = header_bytes + bytes[0];  // after a free text
    const std::size_t palette_bytes = entry_bytes * u16_at(bytes, 5);
    if (bytes.size() < palette_begin + palette_bytes)
        throw InputError(file, "truncated before the pixels");
    return {.size = checked_size(u16_at(bytes, 12), u16_at(bytes, 14), max_pixels, file),
            .type = type,
            .has_runs = (bytes[2] & in_runs) != 0,
            .bytes_per_pixel = bits / 8,
            .descriptor = bytes[17],
            .palette = {bytes.subspan(palette_begin, palette_bytes), entry_bytes, u16_at(bytes, 3)},
            .pixels = bytes.subspan(palette_begin + palette_bytes)};
}

/// Each packet is a byte, whose low 7 bits are the number of pixels less one, and then that many
/// pixels, or, when the top bit is set, a single one to be repeated.
///
/// @param wanted  The number of bytes that come out.
Bytes expand_runs(ByteView packets, std::size_t wanted, std::size_t pixel_bytes,
                  const std::filesystem::path& file) {
    Bytes pixels;
    pixels.reserve(wanted);
    while (pixels.size() < wanted) {
        if (packets.empty()) check_pixel_bytes(wanted, pixels.size(), file);
        const bool is_run = (packets[0] & 0x80) != 0;
        const std::size_t count = (packets[0] & 0x7fu) + 1u;
        const std::size_t stored = (is_run ? 1 : count) * pixel_bytes;
        if (packets.size() < 1 + stored) check_pixel_bytes(wanted, pixels.size(), file);
        if (wanted - pixels.size() < count * pixel_bytes)
            throw InputError(file, "damaged: a run goes past the last pixel");

        const ByteView content = packets.subspan(1, stored);
        for (std::size_t i = 0; i < (is_run ? count : 1); ++i)
            pixels.insert(pixels.end(), content.begin(), content.end());
        packets = packets.subspan(1 + stored);
    }
    return pixels;
}

u8vec4 palette_color(const TgaHeader& header, std::size_t index,
                     const std::filesystem::path& file) {
    const Palette& palette = header.palette;
    const std::size_t at = (index - palette.first_index) * palette.entry_bytes;
    if (index < palette.first_index || at >= palette.entries.size())
        throw InputError(file, "a pixel has colour " + std::to_string(index) +
                                   ", which the palette does not have");
    return color_from_stored(palette.entries.subspan(at, palette.entry_bytes),
                             header.has_opacity());
}

/// @param stored  All pixels, not in runs.
Image<u8vec4> image_from_stored(const TgaHeader& header, ByteView stored,
                                const std::filesystem::path& file) {
    Image<u8vec4> image(header.size);
    for (int row = 0; row < header.size.y; ++row) {
        const int y = header.descriptor & top_row_first ? row : header.size.y - 1 - row;
        for (int column = 0; column < header.size.x; ++column) {
            const int x =
                header.descriptor & right_column_first ? header.size.x - 1 - column : column;
            const ByteView pixel = stored.first(header.bytes_per_pixel);
            image[{x, y}] = header.type == with_palette
                                ? palette_color(header, pixel[0], file)
                                : color_from_stored(pixel, header.has_opacity());
            stored = stored.subspan(header.bytes_per_pixel);
        }
    }
    return image;
}

}  // namespace

Bytes encode_tga(const Image<u8vec3>& pixels, const std::filesystem::path& file) {
    const ivec2 size = pixels.size();
    if (size.x > 65535 || size.y > 65535)
        throw InputError(file,
                         "the picture is too large for TGA: 65535 pixels a side is the limit");

    Bytes bytes;
    bytes.push_back(0);           // length of a free text
    bytes.push_back(0);           // no palette
    bytes.push_back(true_color);  // not in runs
    append_u16(bytes, 0);         // the palette's first index,
    append_u16(bytes, 0);         // its number of colours
    bytes.push_back(0);           // and the bits of each
    append_u16(bytes, 0);         // where the picture stands on the screen, in x
    append_u16(bytes, 0);         // and in y
    append_u16(bytes, static_cast<std::uint16_t>(size.x));
    append_u16(bytes, static_cast<std::uint16_t>(size.y));
    bytes.push_back(24);  // bits a pixel
    bytes.push_back(top_row_first);
    bytes.reserve(header_bytes + 3 * pixels.pixels().size());
    for (const u8vec3 color : pixels.pixels()) append_bgr(bytes, color);
    return bytes;
}

Image<u8vec4> decode_tga(ByteView bytes, const std::filesystem::path& file,
                         std::uint64_t max_pixels) {
    const TgaHeader header = read_header(bytes, file, max_pixels);
    const std::size_t pixel_bytes = header.bytes_per_pixel;
    const std::size_t wanted = area(header.size) * pixel_bytes;
    if (!header.has_runs) {
        check_pixel_bytes(wanted, header.pixels.size(), file);
        return image_from_stored(header, header.pixels, file);
    }
    // 128 pixels take a packet of 1 + pixel_bytes bytes or more.
    const std::uint64_t least = (area(header.size) + 127) / 128 * (1 + pixel_bytes);
    check_compressed_bytes(header.size, least, header.pixels.size(), file);
    return image_from_stored(header, expand_runs(header.pixels, wanted, pixel_bytes, file), file);
}

}  // namespace rasterbook
