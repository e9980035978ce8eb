// SPDX-License-Identifier: MIT
// Whether a picture that the reader's program has drawn in a page is the expected one, by the rule
// of tests/support/golden.cpp, and what it looks like.
#include <cstddef>
#include <cstdlib>
#include <string>
#include <vector>

#include "common/image/image.hpp"
#include "support/image_doctor.hpp"
#include "support/picture_difference.hpp"

#define EXPORTED(name) extern "C" __attribute__((export_name(#name)))

namespace rasterbook {

namespace {

std::vector<u8vec4> pixels;  ///< Of the reader's picture, then of the expected one.
ivec2 size(0);
std::string answer;

}  // namespace

/// Room for two pictures, one behind the other: four bytes a pixel, row by row.
EXPORTED(room) u8vec4* room(int width, int height) {
    size = ivec2(width, height);
    pixels.resize(2 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return pixels.data();
}

/// Compares the pictures.
///
/// @param may_jump  So many pixels may differ by any amount (PictureDifference).
/// @return          Empty where they count as the same.
EXPORTED(judge) const char* judge(std::size_t may_jump) {
    Image<u8vec4> actual(size), expected(size);
    const std::size_t count = pixels.size() / 2;
    for (std::size_t i = 0; i < count; ++i) {
        actual.pixels()[i] = pixels[i];
        expected.pixels()[i] = pixels[count + i];
    }
    const test::PictureDifference difference = test::picture_difference(actual, expected);
    answer.clear();
    if (!difference.is_tolerable(may_jump))
        answer = difference.in_words(may_jump) +
                 "\nThe picture: " + test::diagnose(actual, expected, {});
    return answer.c_str();
}

}  // namespace rasterbook

// Pictures of a page's sizes are taken, so nothing is thrown.
extern "C" void* __cxa_allocate_exception(std::size_t) { std::abort(); }
extern "C" [[noreturn]] void __cxa_throw(void*, void*, void (*)(void*)) { std::abort(); }
