// SPDX-License-Identifier: MIT
#include "common/image/jpeg.hpp"

#include <algorithm>
#include <bitset>
#include <cstdlib>
#include <map>
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

/// What the scans of a file hold.
struct JpegScans {
    int count = 0;
    bool has_end = false;       ///< The mark FF D9. (A thumbnail inside a segment has its own.)
    bool has_restarts = false;  ///< Marks may divide the pixels of a scan: FF D0 to FF D7.

    /// Of each component the coefficients, 0 to 63, that no scan has to the last bit: progressive
    /// files have them one after the other.
    std::map<std::uint8_t, std::bitset<64>> missing;

    bool are_all_there() const {
        return !missing.empty() &&
               std::ranges::all_of(missing, [](const auto& of) { return of.second.none(); });
    }
    /// @param frame  Content of a segment: 6 bytes, and 3 for each component.
    void begin_frame(ByteView frame) {
        for (std::size_t at = 6; at + 2 < frame.size(); at += 3) missing[frame[at]].set();
    }
    /// @param scan  Content of a segment: a number, 2 bytes for each of so many components, and
    ///              which coefficients there are, from the first to the last.
    void add(ByteView scan) {
        ++count;
        const std::size_t end = scan.empty() ? 0 : 1 + 2 * std::size_t{scan[0]};
        if (end == 0 || end + 3 > scan.size() || (scan[end + 2] & 0x0f) != 0) return;
        for (std::size_t at = 1; at < end; at += 2)
            for (std::size_t i = scan[end]; i <= scan[end + 1] && i < 64; ++i)
                missing[scan[at]].reset(i);
    }
};

[[noreturn]] void fail_truncated(const std::filesystem::path& file) {
    throw InputError(file, "truncated: the end of the picture is missing");
}

/// Walks over all segments to the mark of the end. Without it all scans must have begun: the
/// decoder would paint what is missing grey.
JpegScans checked_scans(ByteView bytes, const std::filesystem::path& file) {
    constexpr std::uint8_t code_tables = 0xc4, end_of_image = 0xd9, start_of_scan = 0xda,
                           restarts = 0xdd;
    const auto is_frame = [](std::uint8_t code) { return code >= 0xc0 && code <= 0xc2; };
    JpegScans scans;
    bool has_tables = false;
    std::size_t at = next_segment(bytes, 2);
    while (at < bytes.size() && bytes[at] != end_of_image) {
        if (bytes.size() - at < 3) fail_truncated(file);
        const std::size_t length = std::max(big_u16_at(bytes, at + 1), 2u);  // with its own bytes
        if (bytes.size() - at - 1 < length) fail_truncated(file);
        const ByteView content = bytes.subspan(at + 3, length - 2);
        if (bytes[at] == code_tables) check_code_tables(content, file);
        has_tables = has_tables || bytes[at] == code_tables;
        if (is_frame(bytes[at])) scans.begin_frame(content);
        if (bytes[at] == start_of_scan) scans.add(content);
        if (bytes[at] == restarts) scans.has_restarts = true;
        if (scans.count > 0 && !has_tables) throw InputError(file, "damaged: no table of codes");
        at = next_segment(bytes, at + 1 + length);
    }
    scans.has_end = at < bytes.size();
    if (!scans.has_end && !scans.are_all_there()) fail_truncated(file);
    return scans;
}

Image<u8vec4> decoded(ByteView bytes, const std::filesystem::path& file) {
    ivec2 size;
    int channels = 0;
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

/// The picture of a file without the mark of its end, if no pixel is missing: then it is the same
/// whatever comes behind.
Image<u8vec4> decoded_without_end(ByteView bytes, bool has_restarts,
                                  const std::filesystem::path& file) {
    while (bytes.back() == 0xff) bytes = bytes.first(bytes.size() - 1);  // half a mark
    const auto followed_by = [&](Bytes more) {
        more.insert(more.begin(), bytes.begin(), bytes.end());
        more.insert(more.end(), {0xff, 0xd9});
        return decoded(more, file);
    };
    try {
        Image<u8vec4> image = followed_by({});  // the decoder goes on with zeros
        Bytes no_codes(64, 0xfe);
        bool is_whole = image == followed_by(no_codes);
        no_codes[0] = 0xff, no_codes[1] = 0xd0;  // what is missing may begin with a mark
        if (has_restarts) is_whole = is_whole && image == followed_by(no_codes);
        if (is_whole) return image;
    } catch (const InputError&) {}  // there is no such code
    fail_truncated(file);
}

}  // namespace

Image<u8vec4> decode_jpeg(ByteView bytes, const std::filesystem::path& file,
                          std::uint64_t max_pixels, std::string* remark) {
    const JpegScans scans = checked_scans(bytes, file);
    if (scans.count > 100) throw InputError(file, "more than 100 scans");
    ivec2 size;
    int channels = 0;
    if (!stbi_info_from_memory(bytes.data(), static_cast<int>(bytes.size()), &size.x, &size.y,
                               &channels))
        throw InputError(file, "damaged or unsupported: the JPEG header cannot be read");
    size = checked_size(size.x, size.y, max_pixels, file);
    // A block of 8 x 8 pixels takes a bit or more.
    check_compressed_bytes(size, area((size + 7) / 8) / 8, bytes.size(), file);
    if (scans.has_end) return decoded(bytes, file);
    if (remark) *remark = "the mark of its end is missing";
    return decoded_without_end(bytes, scans.has_restarts, file);
}

}  // namespace rasterbook
