// SPDX-License-Identifier: MIT
/// @file
/// Sets of pixels, compared as a picture that shows which are missing and which are too many.
#pragma once

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "support/printers.hpp"

namespace rasterbook::test {

using Pixels = std::set<std::pair<int, int>>;  ///< (x, y)

/// `#` right, `?` missing, `!` extra, `.` rightly empty; cut to the area around the pixels.
inline std::string ascii_difference(const Pixels& actual, const Pixels& expected) {
    constexpr int greatest_width = 100, greatest_height = 60;
    Pixels all = actual;
    all.insert(expected.begin(), expected.end());
    if (all.empty()) return "(no pixels)\n";
    int left = all.begin()->first, right = left, top = all.begin()->second, bottom = top;
    for (const auto& [x, y] : all) {
        left = std::min(left, x), right = std::max(right, x);
        top = std::min(top, y), bottom = std::max(bottom, y);
    }
    std::string picture = "top-left pixel (" + std::to_string(left) + ", " + std::to_string(top) +
                          "), # right, ? missing, ! extra\n";
    for (int y = top; y <= std::min(bottom, top + greatest_height - 1); ++y) {
        for (int x = left; x <= std::min(right, left + greatest_width - 1); ++x) {
            const bool is = actual.contains({x, y}), should = expected.contains({x, y});
            picture += is ? (should ? '#' : '!') : (should ? '?' : '.');
        }
        picture += '\n';
    }
    return picture;
}

/// For EXPECT_TRUE: two sets of pixels are the same; says with a picture where they are not.
inline testing::AssertionResult same_pixels(const Pixels& actual, const Pixels& expected) {
    if (actual == expected) return testing::AssertionSuccess();
    return testing::AssertionFailure()
           << "other pixels than expected; " << ascii_difference(actual, expected);
}

}  // namespace rasterbook::test
