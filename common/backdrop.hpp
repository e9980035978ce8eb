// SPDX-License-Identifier: MIT
/// @file
/// What stands behind the model.
#pragma once

#include "common/image.hpp"

namespace rasterbook {

/// A dark blue that brightens towards the bottom; linear colour.
///
/// @param y  A row of a picture of `height` rows.
inline vec3 backdrop_color(int y, int height) {
    constexpr vec3 top(0.004f, 0.007f, 0.016f), bottom(0.017f, 0.029f, 0.056f);
    const float down = (static_cast<float>(y) + 0.5f) / static_cast<float>(height);
    return glm::mix(top, bottom, down);
}

/// A picture that holds nothing else.
inline Image<vec3> backdrop(ivec2 size) {
    Image<vec3> image(size);
    for (int y = 0; y < size.y; ++y) {
        const vec3 color = backdrop_color(y, size.y);
        for (int x = 0; x < size.x; ++x) image[{x, y}] = color;
    }
    return image;
}

/// For drawings with dark outlines: pale paper; linear colour.
constexpr vec3 paper_color(0.72f, 0.66f, 0.52f);

/// Whether the picture is the backdrop still, or paper.
inline bool is_backdrop(const Image<vec3>& picture) {
    for (int y = 0; y < picture.size().y; ++y) {
        const vec3 color = backdrop_color(y, picture.size().y);
        for (int x = 0; x < picture.size().x; ++x)
            if (picture[{x, y}] != color && picture[{x, y}] != paper_color) return false;
    }
    return true;
}

}  // namespace rasterbook
