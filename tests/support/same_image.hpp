// SPDX-License-Identifier: MIT
/// @file
/// Pictures of numbers, compared pixel by pixel: says where the first is that differs.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "common/image/image.hpp"
#include "support/printers.hpp"

namespace rasterbook::test {

/// " (3 ulp apart)" for two floats, between which as many lie and one; for other values nothing.
template <typename Value>
std::string ulps_between(const Value& a, const Value& b) {
    if constexpr (std::same_as<Value, float>) {
        const auto place = [](float x) {  // in the order of all floats
            const auto bits = static_cast<std::int64_t>(std::bit_cast<std::int32_t>(x));
            return bits < 0 ? -(bits & 0x7fffffff) : bits;
        };
        if (a == a && b == b)
            return " (" + std::to_string(std::abs(place(a) - place(b))) + " ulp apart)";
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

/// For EXPECT_TRUE: two pictures are equal.
///
/// @param what  Of a pixel, as "the depth" of it.
template <typename Value>
testing::AssertionResult same_image(const std::string& what, const Image<Value>& actual,
                                    const Image<Value>& expected) {
    if (actual.size() != expected.size())
        return testing::AssertionFailure()
               << "a picture of " << testing::PrintToString(actual.size()) << " pixels, expected "
               << testing::PrintToString(expected.size());
    int differing = 0;
    ivec2 first(0);
    for (int y = 0; y < actual.size().y; ++y)
        for (int x = 0; x < actual.size().x; ++x)
            if (!(actual[{x, y}] == expected[{x, y}]) && differing++ == 0) first = {x, y};
    if (differing == 0) return testing::AssertionSuccess();
    return testing::AssertionFailure()
           << what << " at pixel " << testing::PrintToString(first) << " is "
           << text_of_pixel(actual[first]) << ", expected " << text_of_pixel(expected[first])
           << ulps_between(actual[first], expected[first]) << "; " << differing << " pixels differ";
}

}  // namespace rasterbook::test
