// SPDX-License-Identifier: MIT
/// @file
/// When two pictures count as the same.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdlib>
#include <string>

#include "common/image/image.hpp"

namespace rasterbook::test {

// The pictures are made with + - * / and square roots, which are the same everywhere, and with a
// few functions of which C libraries may differ in the last bit: the camera's sines and tangent;
// powers in the sRGB code, in textures from lesson 05 on as well, and there a logarithm for their
// levels; powers of highlights, cosines of spots and arc tangents for missing normals from lesson
// 06 on. That changes a level here and there: with all of these an ulp off, 45 pixels of lesson
// 06's picture differ, by one level each.
constexpr int levels_that_may_differ = 1;
constexpr double share_of_pixels_that_may_differ = 0.005;

/// Of red, green and blue, 0 to 255; opacity does not count.
inline int greatest_difference(u8vec4 a, u8vec4 b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

/// Whether two pixels differ by no more than a rounding.
inline bool looks_the_same(u8vec4 a, u8vec4 b) {
    return greatest_difference(a, b) <= levels_that_may_differ;
}

struct PictureDifference {
    std::size_t differing = 0;  ///< Pixels that are not equal.
    std::size_t allowed = 0;    ///< As many may differ, by levels_that_may_differ.
    std::size_t jumps = 0;      ///< Pixels that differ by more than levels_that_may_differ.
    int greatest = 0;           ///< Of all pixels, 0 to 255.

    /// @param may_jump  So many pixels may differ by any amount: where light is snapped to tones, a
    ///                  last bit decides on which side of a threshold a pixel lies.
    bool is_tolerable(std::size_t may_jump = 0) const {
        return differing <= allowed && jumps <= may_jump;
    }

    std::string in_words(std::size_t may_jump) const {
        const std::string rounding = std::to_string(allowed) + " pixels may differ by " +
                                     std::to_string(levels_that_may_differ) + ", from rounding";
        const std::string tones =
            may_jump > 0 ? ", and " + std::to_string(may_jump) + " of them by any amount" : "";
        return std::to_string(differing) + " pixels differ, by up to " + std::to_string(greatest) +
               " of 255 (" + rounding + tones + ")";
    }
};

/// @param actual,expected  Of one size.
inline PictureDifference picture_difference(const Image<u8vec4>& actual,
                                            const Image<u8vec4>& expected) {
    assert(actual.size() == expected.size() && "only pictures of one size can be compared");
    PictureDifference found;
    for (std::size_t i = 0; i < expected.pixels().size(); ++i) {
        const int difference = greatest_difference(expected.pixels()[i], actual.pixels()[i]);
        found.greatest = std::max(found.greatest, difference);
        found.differing += difference > 0;
        found.jumps += difference > levels_that_may_differ;
    }
    found.allowed = static_cast<std::size_t>(share_of_pixels_that_may_differ *
                                             static_cast<double>(expected.pixels().size()));
    return found;
}

}  // namespace rasterbook::test
