// SPDX-License-Identifier: MIT
#include "common/image/png_jpeg.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string_view>

// Zeros, so that what a damaged file leaves undefined is the same in each run.
#define STBI_MALLOC(size) std::calloc(1, size)
#define STBI_REALLOC(block, size) std::realloc(block, size)
#define STBI_FREE(block) std::free(block)
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#include <stb/stb_image.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace rasterbook {
namespace {

constexpr std::string_view truncated = "truncated: the end of the picture is missing";

/// PNG and JPEG store numbers with the highest byte first.
std::uint32_t big_u16_at(ByteView bytes, std::size_t at) {
    return std::uint32_t{bytes[at]} << 8 | bytes[at + 1];
}

std::uint32_t big_u32_at(ByteView bytes, std::size_t at) {
    return big_u16_at(bytes, at) << 16 | big_u16_at(bytes, at + 2);
}

/// A PNG file is a signature of 8 bytes and then chunks: the length of the content, a name of four
/// letters, the content, a check sum.
struct PngChunk {
    std::string_view name;
    std::size_t begin = 0;  ///< Position of the content in the file
    std::size_t length = 0;
    std::size_t end() const { return begin + length + 4; }
};

/// @param at  Where the chunk begins, inside the file or at its end.
PngChunk chunk_at(ByteView bytes, std::size_t at, const std::filesystem::path& file) {
    if (bytes.size() - at < 12 || big_u32_at(bytes, at) > bytes.size() - at - 12)
        throw InputError(file, std::string(truncated));
    const auto* name = reinterpret_cast<const char*>(bytes.data() + at + 4);
    return {{name, 4}, at + 8, big_u32_at(bytes, at)};
}

struct PngOutline {
    std::size_t data_bytes = 0;  ///< Compressed pixels
    PngChunk palette;            ///< begin is 0 when there is none
};

/// Walks over all chunks: the decoder would take each one's claimed length as true.
PngOutline outline_of(ByteView bytes, const std::filesystem::path& file) {
    PngOutline outline;
    PngChunk chunk = chunk_at(bytes, 8, file);
    if (chunk.name != "IHDR" || chunk.length != 13)
        throw InputError(file, "damaged: the PNG header is missing");
    while (chunk.name != "IEND") {
        chunk = chunk_at(bytes, chunk.end(), file);
        if (chunk.name == "IDAT") outline.data_bytes += chunk.length;
        if (chunk.name == "PLTE") outline.palette = chunk;
    }
    return outline;
}

/// @param header  The content of IHDR.
std::uint64_t bits_per_pixel(ByteView header, const std::filesystem::path& file) {
    constexpr std::array<std::uint64_t, 7> channels{1, 0, 3, 1, 2, 0, 4};  // of each colour type
    const std::uint64_t bits = header[8];
    const std::size_t type = header[9];
    const bool is_index_or_grey = type == 3 || type == 0;
    if (type > 6 || channels[type] == 0 || bits == 0 || (bits < 8 && !is_index_or_grey))
        throw InputError(file, "damaged: there is no such kind of PNG");
    return bits * channels[type];
}

Image<u8vec4> decode(ByteView bytes, const std::filesystem::path& file) {
    ivec2 size;
    int channels = 0;
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
        stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &size.x, &size.y,
                              &channels, 4),
        stbi_image_free);
    if (!pixels)
        throw InputError(file, std::string("damaged or unsupported: ") + stbi_failure_reason());

    Image<u8vec4> image(size);
    const stbi_uc* stored = pixels.get();
    for (u8vec4& color : image.pixels()) {
        color = {stored[0], stored[1], stored[2], stored[3]};
        stored += 4;
    }
    return image;
}

/// A JPEG file is a sequence of segments: FF, a code other than 0 and FF, and often a length and
/// content. The compressed pixels between them have FF only before 0 or a restart code.
///
/// @return  The position of the next segment's code, or the end of the file.
std::size_t next_segment(ByteView bytes, std::size_t at) {
    for (++at; at < bytes.size(); ++at) {
        const bool is_restart = bytes[at] >= 0xd0 && bytes[at] <= 0xd7;
        if (bytes[at - 1] == 0xff && bytes[at] != 0 && bytes[at] != 0xff && !is_restart) return at;
    }
    return bytes.size();
}

/// Each table of codes is a byte, the number of codes of 1, 2, ... 16 bits, and their values. The
/// decoder has room for 255 codes and a mark for none, and does not look.
void check_code_tables(ByteView tables, const std::filesystem::path& file) {
    while (!tables.empty()) {
        std::size_t length = 17;
        for (std::size_t i = 1; i < 17 && i < tables.size(); ++i) length += tables[i];
        if (length > 17 + 255 || length > tables.size())
            throw InputError(file, "damaged: a table of codes has an impossible length");
        tables = tables.subspan(length);
    }
}

/// Walks over all segments to the mark of the end (FF D9), which must be there: the decoder would
/// paint what is missing grey. (A thumbnail inside a segment has its own mark, which is not it.)
///
/// @return  The number of scans.
int checked_scans(ByteView bytes, const std::filesystem::path& file) {
    constexpr std::uint8_t code_tables = 0xc4, start_of_scan = 0xda, end_of_image = 0xd9;
    int scans = 0;
    bool has_tables = false;
    std::size_t at = next_segment(bytes, 2);
    while (at < bytes.size() && bytes[at] != end_of_image) {
        if (bytes.size() - at < 3) break;
        const std::size_t length = std::max(big_u16_at(bytes, at + 1), 2u);  // with its own bytes
        if (bytes.size() - at - 1 < length) break;
        if (bytes[at] == code_tables) {
            check_code_tables(bytes.subspan(at + 3, length - 2), file);
            has_tables = true;
        }
        if (bytes[at] == start_of_scan) ++scans;
        if (scans > 0 && !has_tables) throw InputError(file, "damaged: no table of codes");
        at = next_segment(bytes, at + 1 + length);
    }
    if (at >= bytes.size() || bytes[at] != end_of_image)
        throw InputError(file, std::string(truncated));
    return scans;
}

}  // namespace

Bytes encode_png(const Image<u8vec3>& pixels, const std::filesystem::path& file) {
    const ivec2 size = pixels.size();
    if (3 * area(size) + area({1, size.y}) > std::numeric_limits<int>::max())  // stb counts in int
        throw InputError(file, "the picture is too large for PNG: 2 GiB is the limit");

    Bytes bytes;
    const auto append = [](void* target, void* data, int length) {
        const auto* begin = static_cast<const std::uint8_t*>(data);
        static_cast<Bytes*>(target)->insert(static_cast<Bytes*>(target)->end(), begin,
                                            begin + length);
    };
    if (!stbi_write_png_to_func(append, &bytes, size.x, size.y, 3, pixels.pixels().data(), 0))
        throw InputError(file, "cannot be written: out of memory");
    return bytes;
}

Image<u8vec4> decode_png(Bytes bytes, const std::filesystem::path& file) {
    const PngOutline outline = outline_of(bytes, file);
    const ByteView header = ByteView(bytes).subspan(16, 13);
    const ivec2 size = checked_size(big_u32_at(header, 0), big_u32_at(header, 4), file);
    // Deflate makes 258 bytes from 2 bits at best: 1032 from one.
    const std::uint64_t least = area(size) * bits_per_pixel(header, file) / (8 * 1032);
    check_compressed_bytes(size, least, outline.data_bytes, file);

    // A colour beyond the palette is black, as PNG recommends; the decoder does not look.
    const PngChunk& palette = outline.palette;
    if (palette.begin != 0 && palette.length < 768 && palette.length % 3 == 0) {
        const auto end =
            bytes.begin() + static_cast<std::ptrdiff_t>(palette.begin + palette.length);
        bytes.insert(end, 768 - palette.length, 0);
        bytes[palette.begin - 6] = 768 >> 8;
        bytes[palette.begin - 5] = 768 & 255;
    }
    return decode(bytes, file);
}

Image<u8vec4> decode_jpeg(ByteView bytes, const std::filesystem::path& file) {
    if (checked_scans(bytes, file) > 100) throw InputError(file, "more than 100 scans");
    ivec2 size;
    int channels = 0;
    if (!stbi_info_from_memory(bytes.data(), static_cast<int>(bytes.size()), &size.x, &size.y,
                               &channels))
        throw InputError(file, "damaged or unsupported: the JPEG header cannot be read");
    // A block of 8 x 8 pixels takes a bit or more.
    check_compressed_bytes(size, area((size + 7) / 8) / 8, bytes.size(), file);
    return decode(bytes, file);
}

}  // namespace rasterbook
