// SPDX-License-Identifier: MIT
/// @file
/// What stands behind the model.
#pragma once

#include "common/image/image.hpp"

namespace rasterbook {

/// A dark blue that brightens towards the bottom; linear colour.
///
/// @param y  A row of a picture of `height` rows.
inline vec3 backdrop_color(int y, int height) {
    constexpr vec3 top(0.004f, 0.007f, 0.016f), bottom(0.017f, 0.029f, 0.056f);
    const float down = (static_cast<float>(y) + 0.5f) / static_cast<float>(height);
    return glm::mix(top, bottom, down);
}

/// Draws it into a part of a picture.
///
/// @param first,last  The part's upper left and lower right pixel; last before first: no pixel.
inline void draw_backdrop(Image<vec3>& picture, ivec2 first, ivec2 last) {
    for (int y = first.y; y <= last.y; ++y) {
        const vec3 color = backdrop_color(y, picture.size().y);
        for (int x = first.x; x <= last.x; ++x) picture[{x, y}] = color;
    }
}

/// A picture that holds nothing else.
inline Image<vec3> backdrop(ivec2 size) {
    Image<vec3> image(size, unset);
    draw_backdrop(image, ivec2(0), size - 1);
    return image;
}

/// For drawings with dark outlines: pale paper; linear colour.
constexpr vec3 paper_color(0.72f, 0.66f, 0.52f);

/// Whether the picture is the backdrop still, or paper. Most are told apart in the middle row.
inline bool is_backdrop(const Image<vec3>& picture) {
    const int height = picture.size().y;
    for (int i = 0; i < height; ++i) {
        const int y = (i + height / 2) % height;
        const vec3 color = backdrop_color(y, height);
        for (int x = 0; x < picture.size().x; ++x)
            if (picture[{x, y}] != color && picture[{x, y}] != paper_color) return false;
    }
    return true;
}

/// What a line of a wireframe adds to its pixels: near lines are bright, far ones dim. Linear
/// colour.
///
/// @param depth  1 for near to 0 for far.
inline vec3 line_color(float depth) {
    constexpr vec3 near_color(0.30f, 0.42f, 0.36f), far_color(0.0f, 0.012f, 0.07f);
    return glm::mix(far_color, near_color, depth);
}

}  // namespace rasterbook
