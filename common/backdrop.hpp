// SPDX-License-Identifier: MIT
/// @file
/// What stands behind the model.
#pragma once

#include "common/image.hpp"

namespace rasterbook {

/// A dark blue that brightens towards the bottom; linear colour.
inline Image<vec3> backdrop(ivec2 size) {
    constexpr vec3 top(0.004f, 0.007f, 0.016f), bottom(0.017f, 0.029f, 0.056f);
    Image<vec3> image(size);
    for (int y = 0; y < size.y; ++y) {
        const float down = (static_cast<float>(y) + 0.5f) / static_cast<float>(size.y);
        for (int x = 0; x < size.x; ++x) image[{x, y}] = glm::mix(top, bottom, down);
    }
    return image;
}

}  // namespace rasterbook
