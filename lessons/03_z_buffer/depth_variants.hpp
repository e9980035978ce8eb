// SPDX-License-Identifier: MIT
/// @file
/// Other formats to store depths in, to be seen with `--format` and `--range`, and measured in
/// docs/accuracy/03_z_buffer.md.
#pragma once

#include <cmath>
#include <cstdint>

#include "common/app/lesson_app.hpp"

namespace rasterbook {

enum class DepthFormat { float32, reversed, reversed_ndc, unorm16, unorm24 };

/// A depth from 0 to 1 as one of 2^bits evenly spaced whole numbers, the nearest one.
template <int bits>
std::uint32_t unorm(float depth) {
    static_assert(bits <= 24, "a float has no more digits");
    return static_cast<std::uint32_t>(std::lrint(depth * static_cast<float>((1 << bits) - 1)));
}

/// A depth from -1 to 1 as one from 0 to 1.
constexpr float zero_to_one(float depth_ndc) { return (depth_ndc + 1.0f) / 2.0f; }

struct DepthVariant {
    DepthFormat format = DepthFormat::float32;
    float range = 1.0f;  ///< >= 1: the model fills the farthest 1/range of the depths.

    void declare(Knobs& knobs) {
        knobs.choice(
            "--format", format,
            {{"float", DepthFormat::float32},
             {"reversed", DepthFormat::reversed},
             {"reversed-ndc", DepthFormat::reversed_ndc},
             {"unorm16", DepthFormat::unorm16},
             {"unorm24", DepthFormat::unorm24}},
            "What a depth is kept as; reversed floats are 0 at the far end, and reversed-ndc first "
            "computes a depth from -1 to 1");
        knobs.choice("--range", range,
                     {{"1", 1.0f}, {"100", 100.0f}, {"10000", 10'000.0f}, {"1000000", 1e6f}},
                     "Squeeze the model into the farthest part of the depths, one N-th of them, as "
                     "a near plane much too near does");
    }

    /// What the buffer stores of a depth, as a float in the same order: less is nearer.
    ///
    /// @param depth  Of the model: 0 for near to 1 for far.
    float kept(float depth) const {
        if (format == DepthFormat::float32 && range == 1.0f) return depth;
        const float from_far = (1.0f - depth) / range;
        switch (format) {
            case DepthFormat::float32:
                return 1.0f - from_far;
            case DepthFormat::reversed:
                return -from_far;
            case DepthFormat::reversed_ndc:
                return -zero_to_one(2.0f * from_far - 1.0f);
            // The greatest number of the format becomes 1, as in an empty pixel.
            case DepthFormat::unorm16:
                return static_cast<float>(unorm<16>(1.0f - from_far) + 1) * 0x1p-16f;
            case DepthFormat::unorm24:
                return static_cast<float>(unorm<24>(1.0f - from_far) + 1) * 0x1p-24f;
        }
        return depth;
    }
};

}  // namespace rasterbook
