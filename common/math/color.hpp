// SPDX-License-Identifier: MIT
/// @file
/// Light and its code in files: shading is linear, files hold sRGB (IEC 61966-2-1).
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
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

/// sRGB-encoded values from a table, in a fourth of the time.
///
/// Floats from 2^-13 to 1 that have their upper 16 bits in common lie so close that they have one
/// code, or two that follow each other. For each such group, the table has the first code and the
/// least float of the next one.
class SrgbTable {
  public:
    SrgbTable() {
        for (std::uint32_t i = 0; i < code_.size(); ++i) {
            const std::uint32_t begin = first + (i << 16);
            code_[i] = srgb8_from_linear(std::bit_cast<float>(begin));
            std::uint32_t same = begin, next = begin + 0x10000;  // bits of floats
            while (next - same > 1) {
                const std::uint32_t middle = same + (next - same) / 2;
                const bool is_same = srgb8_from_linear(std::bit_cast<float>(middle)) == code_[i];
                (is_same ? same : next) = middle;
            }
            next_[i] = std::bit_cast<float>(next);
        }
    }

    std::uint8_t operator[](float linear) const {
        // NaN loses each comparison.
        const float x = linear > least ? (linear < 1.0f ? linear : 1.0f) : least;
        const std::uint32_t i = (std::bit_cast<std::uint32_t>(x) - first) >> 16;
        return static_cast<std::uint8_t>(code_[i] + (x >= next_[i]));
    }

  private:
    static constexpr float least = 0x1p-13f;  ///< Of code 0, as is all below.
    static constexpr std::uint32_t first = std::bit_cast<std::uint32_t>(least);
    static constexpr std::size_t groups = ((std::bit_cast<std::uint32_t>(1.0f) - first) >> 16) + 1;

    std::array<std::uint8_t, groups> code_;
    std::array<float, groups> next_;
};

/// A linear picture as it is stored in a file.
inline Image<u8vec3> srgb8_from_linear(const Image<vec3>& linear) {
    static const SrgbTable codes;
    Image<u8vec3> srgb(linear.size());
    for (std::size_t i = 0; i < linear.pixels().size(); ++i) {
        const vec3 color = linear.pixels()[i];
        srgb.pixels()[i] = {codes[color.r], codes[color.g], codes[color.b]};
    }
    return srgb;
}

}  // namespace rasterbook
