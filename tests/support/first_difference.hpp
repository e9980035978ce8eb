// SPDX-License-Identifier: MIT
/// @file
/// For EXPECT_TRUE: two pictures agree; or else where they differ first, in words.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "common/image/image.hpp"
#include "support/near.hpp"
#include "support/printers.hpp"

namespace rasterbook::test {

/// " (3 ulp apart)" for two floats, between which as many lie and one; for other values nothing.
template <typename Value>
std::string ulps_between(const Value& a, const Value& b) {
    if constexpr (std::same_as<Value, float>) {
        if (a == a && b == b)
            return " (" + std::to_string(std::abs(ulps_above(a, b))) + " ulp apart)";
    }
    return "";
}

template <typename Value>
std::string text_of_pixel(const Value& value) {
    if constexpr (std::floating_point<Value>)
        return text_of(value);
    else
        return testing::PrintToString(value);
}

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
           << testing::PrintToString(first) << ": " << text_of_pixel(actual[first]) << ", expected "
           << text_of_pixel(expected[first]) << ulps_between(actual[first], expected[first]);
}

/// For EXPECT_TRUE: two pictures are equal.
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
