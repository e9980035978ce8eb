// SPDX-License-Identifier: MIT
#include "common/image/jpeg.hpp"

#include <algorithm>
#include <cstdlib>
#include <memory>

// Zeros, so that what a damaged file leaves undefined is the same in each run.
#define STBI_MALLOC(size) std::calloc(1, size)
#define STBI_REALLOC(block, size) std::realloc(block, size)
#define STBI_FREE(block) std::free(block)
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#include <stb/stb_image.h>

namespace rasterbook {
namespace {

std::uint32_t big_u16_at(ByteView bytes, std::size_t at) {
    return std::uint32_t{bytes[at]} << 8 | bytes[at + 1];
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
        throw InputError(file, "truncated: the end of the picture is missing");
    return scans;
}

}  // namespace

Image<u8vec4> decode_jpeg(ByteView bytes, const std::filesystem::path& file,
                          std::uint64_t max_pixels) {
    if (checked_scans(bytes, file) > 100) throw InputError(file, "more than 100 scans");
    ivec2 size;
    int channels = 0;
    if (!stbi_info_from_memory(bytes.data(), static_cast<int>(bytes.size()), &size.x, &size.y,
                               &channels))
        throw InputError(file, "damaged or unsupported: the JPEG header cannot be read");
    size = checked_size(size.x, size.y, max_pixels, file);
    // A block of 8 x 8 pixels takes a bit or more.
    check_compressed_bytes(size, area((size + 7) / 8) / 8, bytes.size(), file);

    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
        stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &size.x, &size.y,
                              &channels, 4),
        stbi_image_free);
    if (!pixels) {
        const char* const reason = stbi_failure_reason();  // null where the decoder gives none
        throw InputError(file,
                         "damaged or unsupported" + (reason ? std::string(": ") + reason : ""));
    }
    Image<u8vec4> image(size);
    const stbi_uc* stored = pixels.get();
    for (u8vec4& color : image.pixels()) {
        color = {stored[0], stored[1], stored[2], stored[3]};
        stored += 4;
    }
    return image;
}

}  // namespace rasterbook
