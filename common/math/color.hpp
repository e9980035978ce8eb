// SPDX-License-Identifier: MIT
/// @file
/// Light and its code in files: shading is linear, files hold sRGB (IEC 61966-2-1).
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>

#include "common/image/image.hpp"

namespace rasterbook {

/// The sRGB code of a linear amount of light; both 0 to 1. Values outside are continued, not
/// clamped.
template <std::floating_point T>
T srgb_from_linear(T linear) {
    return linear <= T(0.0031308) ? T(12.92) * linear
                                  : T(1.055) * std::pow(linear, T(1) / T(2.4)) - T(0.055);
}

/// The amount of light that an sRGB code stands for; both 0 to 1.
template <std::floating_point T>
T linear_from_srgb(T srgb) {
    return srgb <= T(0.04045) ? srgb / T(12.92) : std::pow((srgb + T(0.055)) / T(1.055), T(2.4));
}

/// A linear amount of light as the nearest of 256 sRGB codes; clamped to 0 and 255, NaN becomes 0.
inline std::uint8_t srgb8_from_linear(float linear) {
    if (!(linear > 0.0f)) return 0;
    if (linear >= 1.0f) return 255;
    return static_cast<std::uint8_t>(255.0f * srgb_from_linear(linear) + 0.5f);
}

/// A linear picture as it is stored in a file.
inline Image<u8vec3> srgb8_from_linear(const Image<vec3>& linear) {
    Image<u8vec3> srgb(linear.size());
    for (std::size_t i = 0; i < linear.pixels().size(); ++i) {
        const vec3 color = linear.pixels()[i];
        srgb.pixels()[i] = {srgb8_from_linear(color.r), srgb8_from_linear(color.g),
                            srgb8_from_linear(color.b)};
    }
    return srgb;
}

}  // namespace rasterbook
