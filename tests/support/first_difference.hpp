// SPDX-License-Identifier: MIT
/// @file
/// For EXPECT_TRUE: two pictures agree; or else where they differ first, in words.
#pragma once

#include <cstddef>
#include <cstring>

#include <gtest/gtest.h>

#include "common/image/image.hpp"
#include "support/printers.hpp"

namespace rasterbook::test {

/// @param agree  Called as agree(a, b) with two pixels.
template <typename Pixel, typename Agree>
testing::AssertionResult agree_everywhere(const Image<Pixel>& actual, const Image<Pixel>& expected,
                                          Agree&& agree) {
    const ivec2 size = expected.size();
    if (actual.size() != size)
        return testing::AssertionFailure() << testing::PrintToString(actual.size())
                                           << " pixels, expected " << testing::PrintToString(size);
    std::size_t differing = 0;
    ivec2 first(0);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            if (!agree(actual[{x, y}], expected[{x, y}]) && differing++ == 0) first = {x, y};
    if (differing == 0) return testing::AssertionSuccess();
    return testing::AssertionFailure()
           << differing << " of " << size.x * size.y << " pixels differ; the first is "
           << testing::PrintToString(first) << ": " << testing::PrintToString(actual[first])
           << ", expected " << testing::PrintToString(expected[first]);
}

/// By ==.
template <typename Pixel>
testing::AssertionResult are_equal(const Image<Pixel>& actual, const Image<Pixel>& expected) {
    return agree_everywhere(actual, expected,
                            [](const Pixel& a, const Pixel& b) { return a == b; });
}

/// In every bit: -0 differs from 0, and NaN agrees with itself.
template <typename Pixel>
testing::AssertionResult have_the_same_bits(const Image<Pixel>& actual,
                                            const Image<Pixel>& expected) {
    return agree_everywhere(actual, expected, [](const Pixel& a, const Pixel& b) {
        return std::memcmp(&a, &b, sizeof a) == 0;
    });
}

}  // namespace rasterbook::test
