// SPDX-License-Identifier: MIT
// Random bytes as a picture's file of one format: it is decoded, or refused by an InputError.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include <zlib.h>

#include "common/image/bmp.hpp"
#include "common/image/jpeg.hpp"
#include "common/image/png.hpp"
#include "common/image/tga.hpp"

using namespace rasterbook;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

struct Format {
    std::string_view name, signature;
    decltype(&decode_tga) decode;
};
constexpr Format formats[] = {
    {"bmp", "BM", decode_bmp},
    {"jpeg", "\xff\xd8\xff",
     [](auto bytes, const auto& file, auto most) { return decode_jpeg(bytes, file, most); }},
    {"png", "\x89PNG\r\n\x1a\n", decode_png},
    {"tga", "", decode_tga}};
constexpr Format format = *std::ranges::find(formats, TARGET, &Format::name);

/// Makes the check sum of each chunk of a PNG file right: else libpng would look at none of them.
void repair_check_sums(std::uint8_t* data, std::size_t size) {
    const auto number_at = [&](std::size_t at) {
        return std::size_t{data[at]} << 24 | std::size_t{data[at + 1]} << 16 |
               std::size_t{data[at + 2]} << 8 | data[at + 3];
    };
    for (std::size_t at = 8; at + 12 <= size && number_at(at) <= size - at - 12;) {
        const std::size_t length = number_at(at), end = at + 8 + length;
        const auto sum = crc32(0, data + at + 4, static_cast<uInt>(4 + length));
        for (std::size_t i = 0; i < 4; ++i)
            data[end + i] = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
        at = end + 4;
    }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
    const std::size_t mutated = LLVMFuzzerMutate(data, size, max_size);
    if (format.name == "png" && seed % 8 != 0) repair_check_sums(data, mutated);
    return mutated;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::uint64_t max_pixels = 10'000;
    static const std::filesystem::path name(TARGET);
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    if (!text.starts_with(format.signature)) return -1;  // it would not come to this decoder
    try {
        const Image<u8vec4> picture = format.decode({data, size}, name, max_pixels);
        if (picture.pixels().empty() || picture.pixels().size() > max_pixels) std::abort();
    } catch (const InputError&) {}
    return 0;
}
