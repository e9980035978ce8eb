// SPDX-License-Identifier: MIT
#include "common/image/png.hpp"

#include <png.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <new>
#include <string_view>
#include <vector>

namespace rasterbook {
namespace {

/// PNG stores numbers with the highest byte first.
std::uint32_t big_u32_at(ByteView bytes, std::size_t at) {
    return std::uint32_t{bytes[at]} << 24 | std::uint32_t{bytes[at + 1]} << 16 |
           std::uint32_t{bytes[at + 2]} << 8 | bytes[at + 3];
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
        throw InputError(file, "truncated: the end of the picture is missing");
    const auto* name = reinterpret_cast<const char*>(bytes.data() + at + 4);
    return {{name, 4}, at + 8, big_u32_at(bytes, at)};
}

/// Walks over all chunks to the last.
///
/// @return  The number of compressed bytes of pixels.
std::size_t checked_data_bytes(ByteView bytes, const std::filesystem::path& file) {
    std::size_t data_bytes = 0;
    PngChunk chunk = chunk_at(bytes, 8, file);
    if (chunk.name != "IHDR" || chunk.length != 13)
        throw InputError(file, "damaged: the PNG header is missing");
    while (chunk.name != "IEND") {
        chunk = chunk_at(bytes, chunk.end(), file);
        if (chunk.name == "IDAT") data_bytes += chunk.length;
    }
    return data_bytes;
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

/// libpng ends with a jump where something is wrong: past destructors, so that no function between
/// the jump and its landing may have any to run.
struct Failure {
    std::array<char, 200> text = {};
};

[[noreturn]] void fail(png_structp png, png_const_charp message) {
    Failure& failure = *static_cast<Failure*>(png_get_error_ptr(png));
    std::snprintf(failure.text.data(), failure.text.size(), "%s", message);
    png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

struct Reader {
    Failure failure;
    ByteView rest;  ///< What is not read yet.
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &failure, fail, ignore);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;

    explicit Reader(ByteView bytes) : rest(bytes) {}
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;
    ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void read_bytes(png_structp png, png_bytep target, std::size_t count) {
    Reader& reader = *static_cast<Reader*>(png_get_io_ptr(png));
    if (count > reader.rest.size()) png_error(png, "the end is missing");
    std::copy_n(reader.rest.begin(), count, target);
    reader.rest = reader.rest.subspan(count);
}

/// @param rows  Four bytes a pixel, the top row first.
/// @return  Whether all went well; else the failure says what did not.
bool read_rows(Reader& reader, png_bytepp rows) {
    if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
    png_set_read_fn(reader.png, &reader, read_bytes);
    png_set_user_limits(reader.png, max_side, max_side);
    png_read_info(reader.png, reader.info);
    png_set_scale_16(reader.png);  // to the nearest of 256 values
    png_set_expand(reader.png);    // palettes, fewer than 8 bits, and one color that is transparent
    png_set_gray_to_rgb(reader.png);
    png_set_add_alpha(reader.png, 255, PNG_FILLER_AFTER);
    png_read_image(reader.png, rows);
    return true;
}

struct Writer {
    Failure failure;
    Bytes bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &failure, fail, ignore);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;

    Writer() = default;
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;
    ~Writer() { png_destroy_write_struct(&png, &info); }
};

bool append(Bytes& bytes, std::span<const png_byte> more) {
    try {
        bytes.insert(bytes.end(), more.begin(), more.end());
        return true;
    } catch (const std::bad_alloc&) { return false; }
}

void write_bytes(png_structp png, png_bytep source, std::size_t count) {
    Writer& writer = *static_cast<Writer*>(png_get_io_ptr(png));
    if (!append(writer.bytes, {source, count})) png_error(png, "out of memory");
}

/// @param channels  Bytes of a pixel: 3, or 4 with opacity.
/// @param pixels    The top row first.
bool write_rows(Writer& writer, ivec2 size, std::size_t channels, png_const_bytep pixels) {
    if (setjmp(png_jmpbuf(writer.png)) != 0) return false;
    png_set_write_fn(writer.png, &writer, write_bytes, nullptr);
    png_set_user_limits(writer.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(size.x),
                 static_cast<png_uint_32>(size.y), 8,
                 channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(writer.png, 1);
    png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_write_info(writer.png, writer.info);
    for (int y = 0; y < size.y; ++y)
        png_write_row(writer.png, pixels + channels * static_cast<std::size_t>(size.x) *
                                               static_cast<std::size_t>(y));
    png_write_end(writer.png, nullptr);
    return true;
}

template <typename Pixel>
Bytes encoded(const Image<Pixel>& pixels, const std::filesystem::path& file) {
    Writer writer;
    if (writer.info == nullptr) throw InputError(file, "cannot be written: out of memory");
    if (!write_rows(writer, pixels.size(), sizeof(Pixel), &pixels.pixels().data()->r))
        throw InputError(file, std::string("cannot be written: ") + writer.failure.text.data());
    return std::move(writer.bytes);
}

}  // namespace

Bytes encode_png(const Image<u8vec3>& pixels, const std::filesystem::path& file) {
    static_assert(sizeof(u8vec3) == 3);
    return encoded(pixels, file);
}

Bytes encode_png(const Image<u8vec4>& pixels, const std::filesystem::path& file) {
    static_assert(sizeof(u8vec4) == 4);
    return encoded(pixels, file);
}

Image<u8vec4> decode_png(ByteView bytes, const std::filesystem::path& file,
                         std::uint64_t max_pixels) {
    static_assert(sizeof(u8vec4) == 4);
    const std::size_t data_bytes = checked_data_bytes(bytes, file);
    const ByteView header = bytes.subspan(16, 13);
    const ivec2 size = checked_size(big_u32_at(header, 0), big_u32_at(header, 4), max_pixels, file);
    // Deflate makes 258 bytes from 2 bits at best: 1032 from one.
    const std::uint64_t least = area(size) * bits_per_pixel(header, file) / (8 * 1032);
    check_compressed_bytes(size, least, data_bytes, file);

    Image<u8vec4> image(size);
    std::vector<png_bytep> rows;
    for (int y = 0; y < size.y; ++y) rows.push_back(&image[{0, y}].r);
    Reader reader(bytes);
    if (reader.info == nullptr) throw InputError(file, "out of memory");
    if (!read_rows(reader, rows.data()))
        throw InputError(file, std::string("damaged: ") + reader.failure.text.data());
    return image;
}

}  // namespace rasterbook
