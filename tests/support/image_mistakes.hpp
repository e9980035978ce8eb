// SPDX-License-Identifier: MIT
/// @file
/// The mistakes that the image doctor knows, by what gives them away.
#pragma once

#include <string>
#include <vector>

#include "support/image_doctor.hpp"

namespace rasterbook::test {

/// A mistake that explains a picture.
struct Finding {
    double explained;   ///< How much of the difference, up to 1.
    std::string words;  ///< For the reader: "LOOK: CAUSE".
};

/// The pictures to compare, of one size and not the same, and what is known of them.
struct Case {
    const Image<u8vec4>& actual;
    const Image<u8vec4>& expected;
    const PictureFacts& facts;
};

/// Flips, shifts by whole pixels, exchanged channels, gamma: the expected picture, made wrong in
/// that way, is the actual one.
std::vector<Finding> pixel_mistakes(const Case& c);

/// Shifts by half a pixel.
std::vector<Finding> half_pixel_mistakes(const Case& c);

/// Wrong triangles are seen. Of colours only the places where they change count.
std::vector<Finding> visibility_mistakes(const Case& c);

}  // namespace rasterbook::test
