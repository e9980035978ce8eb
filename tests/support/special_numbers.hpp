// SPDX-License-Identifier: MIT
/// @file
/// Numbers as they come in files with mistakes.
#pragma once

#include <cfloat>
#include <cmath>
#include <iterator>
#include <limits>
#include <random>

#include "common/math/types.hpp"

namespace rasterbook::test {

inline constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
inline constexpr float infinity = std::numeric_limits<float>::infinity();

inline bool is_finite(vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Ordinary numbers from -2 to 2, and special ones as often.
class SpecialNumbers {
  public:
    explicit SpecialNumbers(unsigned seed) : random_(seed) {}

    unsigned below(unsigned count) { return static_cast<unsigned>(random_()) % count; }
    float ordinary() { return ordinary(static_cast<unsigned>(random_())); }
    /// Any number, finite or not.
    float any() {
        const auto bits = static_cast<unsigned>(random_());
        const float sign = bits & 1 ? 1.0f : -1.0f;
        return bits & 2 ? sign * special[(bits >> 2) % std::size(special)] : ordinary(bits);
    }
    vec2 any_two() {
        const float x = any(), y = any();
        return {x, y};
    }
    vec3 any_three() {
        const float x = any(), y = any(), z = any();
        return {x, y, z};
    }
    vec3 place() {
        const float x = finite(), y = finite(), z = finite();
        return {x, y, z};
    }

  private:
    float finite() {
        for (;;)
            if (const float x = any(); std::isfinite(x)) return x;
    }
    static float ordinary(unsigned bits) {
        return (bits & 1 ? 2.0f : -2.0f) * static_cast<float>(bits >> 8) * 0x1p-24f;
    }

    static constexpr float special[] = {
        0,    FLT_TRUE_MIN, 1e-40f, FLT_MIN, 1e-30f,      1e-8f,   FLT_EPSILON, 0.5f,        1, 128,
        1e8f, 1e15f,        1e30f,  1e37f,   FLT_MAX / 2, FLT_MAX, infinity,    not_a_number};
    std::mt19937 random_;
};

}  // namespace rasterbook::test
