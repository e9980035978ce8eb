// SPDX-License-Identifier: MIT
#include "common/image/image_io.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <string>

#include "common/image/bmp.hpp"
#include "common/image/file.hpp"
#include "common/image/jpeg.hpp"
#include "common/image/png.hpp"
#include "common/image/tga.hpp"

namespace rasterbook {
namespace {

template <std::size_t N>
bool begins_with(ByteView bytes, const std::array<std::uint8_t, N>& signature) {
    return bytes.size() >= N && std::equal(signature.begin(), signature.end(), bytes.begin());
}

}  // namespace

Image<u8vec4> read_image(const std::filesystem::path& file, std::uint64_t max_pixels,
                         std::string* remark) {
    constexpr auto max_bytes = std::numeric_limits<int>::max();  // as stb counts
    return decode_image(read_whole_file(file, max_bytes), file, max_pixels, remark);
}

Image<u8vec4> decode_image(ByteView bytes, const std::filesystem::path& name,
                           std::uint64_t max_pixels, std::string* remark) {
    constexpr auto png = std::to_array<std::uint8_t>({0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'});
    constexpr auto jpeg = std::to_array<std::uint8_t>({0xff, 0xd8, 0xff});
    constexpr auto bmp = std::to_array<std::uint8_t>({'B', 'M'});

    if (bytes.empty()) throw InputError(name, "the file is empty");
    if (begins_with(bytes, png)) return decode_png(bytes, name, max_pixels);
    if (begins_with(bytes, jpeg)) return decode_jpeg(bytes, name, max_pixels, remark);
    if (begins_with(bytes, bmp)) return decode_bmp(bytes, name, max_pixels);
    return decode_tga(bytes, name, max_pixels);
}

void write_image(const std::filesystem::path& file, const Image<u8vec3>& pixels) {
    assert(pixels.size().x >= 1 && pixels.size().y >= 1 && "a picture file has at least one pixel");
    check_image_name(file);
    const std::string ending = ending_of(file);
    if (ending == ".png")
        write_whole_file(file, encode_png(pixels, file));
    else if (ending == ".bmp")
        write_whole_file(file, encode_bmp(pixels, file));
    else
        write_whole_file(file, encode_tga(pixels, file));
}

void check_image_name(const std::filesystem::path& file) {
    const std::string ending = ending_of(file);
    if (ending != ".png" && ending != ".bmp" && ending != ".tga")
        throw InputError(file, "the name of a picture must end in .png, .bmp or .tga");
}

}  // namespace rasterbook
