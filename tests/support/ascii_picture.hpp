// SPDX-License-Identifier: MIT
/// @file
/// Sets of pixels, compared as a picture that shows which are missing and which are too many.
#pragma once

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "common/image/image.hpp"
#include "support/printers.hpp"

namespace rasterbook::test {

using Pixels = std::set<std::pair<int, int>>;  ///< (x, y)

/// `#` right, `?` missing, `!` extra, `.` rightly empty; cut to the area around the pixels, and to
/// what lies around the first one that is wrong.
inline std::string ascii_difference(const Pixels& actual, const Pixels& expected) {
    Pixels all = actual, wrong;
    all.insert(expected.begin(), expected.end());
    if (all.empty()) return "(no pixels)\n";
    std::ranges::set_symmetric_difference(actual, expected, std::inserter(wrong, wrong.end()));
    const auto [x0, y0] = wrong.empty() ? *all.begin() : *wrong.begin();
    ivec2 low(x0, y0), high(x0, y0);
    for (const auto& [x, y] : all)
        low = glm::min(low, ivec2(x, y)), high = glm::max(high, ivec2(x, y));
    constexpr ivec2 before(20, 8), after(59, 15);
    low = glm::max(low, ivec2(x0, y0) - before), high = glm::min(high, ivec2(x0, y0) + after);
    std::string picture = "top-left pixel (" + std::to_string(low.x) + ", " +
                          std::to_string(low.y) + "), # right, ? missing, ! extra\n";
    for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) {
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

/// For EXPECT_TRUE: all counts are 1; says how many are not, with a picture around the first.
inline testing::AssertionResult each_pixel_once(const Image<int>& hits) {
    int gaps = 0, doubles = 0;
    ivec2 first(-1);
    for (int y = 0; y < hits.size().y; ++y)
        for (int x = 0; x < hits.size().x; ++x) {
            const int count = hits[{x, y}];
            gaps += count == 0, doubles += count > 1;
            if (count != 1 && first.x < 0) first = {x, y};
        }
    if (first.x < 0) return testing::AssertionSuccess();
    const ivec2 low = glm::max(first - ivec2(20, 4), ivec2(0));
    const ivec2 high = glm::min(first + ivec2(20, 8), hits.size() - 1);
    std::ostringstream text;
    text << gaps << " pixels are never visited, " << doubles
         << " more than once; around the first, (" << first.x << ", " << first.y
         << "): # once, ? never, ! more than once\n";
    for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x)
            text << (hits[{x, y}] == 1 ? '#' : hits[{x, y}] == 0 ? '?' : '!');
        text << '\n';
    }
    return testing::AssertionFailure() << text.str();
}

}  // namespace rasterbook::test
