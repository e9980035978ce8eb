// SPDX-License-Identifier: MIT
/// @file
/// Other formats to store the depths of lesson 03 in; measured in docs/accuracy/03_z_buffer.md.
#pragma once

#include <cmath>
#include <cstdint>

#include "common/app/lesson_app.hpp"

namespace rasterbook {

enum class DepthFormat { float32, from_near, ndc, unorm16, unorm24 };

/// A depth from 0 to 1 as one of 2^bits evenly spaced whole numbers, the nearest one.
template <int bits>
std::uint32_t unorm(float depth) {
    static_assert(bits <= 24, "a float has no more digits");
    return static_cast<std::uint32_t>(std::lrint(depth * static_cast<float>((1 << bits) - 1)));
}

/// A depth from -1 to 1 as one from 0 to 1.
constexpr float zero_to_one(float depth_ndc) { return (depth_ndc + 1.0f) / 2.0f; }

struct DepthMethod {
    DepthFormat format = DepthFormat::float32;
    float range = 1.0f;  ///< >= 1: the model fills the farthest 1/range of the depths.

    void declare(OptionParser& parser) {
        parser.choice(
            "--format", format,
            {{"float", DepthFormat::float32},
             {"from-near", DepthFormat::from_near},
             {"ndc", DepthFormat::ndc},
             {"unorm16", DepthFormat::unorm16},
             {"unorm24", DepthFormat::unorm24}},
            "What a depth is kept as: float is 1 at the near plane and 0 far away, from-near the "
            "other "
            "way round; ndc is float by way of a depth from -1 to 1; unorm16 and unorm24 are whole "
            "numbers of so many bits");
        parser.choice(
            "--range", range,
            {{"1", 1.0f}, {"100", 100.0f}, {"10000", 10'000.0f}, {"1000000", 1e6f}},
            "Squeeze the model into the farthest part of the depths, one N-th of them, as "
            "a near plane much too near does");
    }

    /// What the buffer stores of a depth, as a float in the same order: greater is nearer.
    ///
    /// @param depth  Of the model: 1 for near to 0 for far.
    float kept(float depth) const {
        const float squeezed = depth / range;
        switch (format) {
            case DepthFormat::float32:
                return squeezed;
            case DepthFormat::from_near:
                return -(1.0f - squeezed);
            case DepthFormat::ndc:
                return zero_to_one(2.0f * squeezed - 1.0f);
            // 0 is the depth of an empty pixel.
            case DepthFormat::unorm16:
                return static_cast<float>(unorm<16>(squeezed)) / ((1 << 16) - 1);
            case DepthFormat::unorm24:
                return static_cast<float>(unorm<24>(squeezed)) / ((1 << 24) - 1);
        }
        return depth;
    }

    bool operator==(const DepthMethod&) const = default;

    /// What the buffer is cleared to.
    float farthest() const { return kept(0.0f); }
};

}  // namespace rasterbook
