// SPDX-License-Identifier: MIT
/// @file
/// Tones of lesson 07 with smooth borders; measured in docs/accuracy/07_toon.md.
#pragma once

#include <algorithm>
#include <cmath>

#include "07_toon/toon.hpp"

namespace rasterbook {

/// The mean level of the tones over a pixel in which the brightness runs linearly from half of
/// `change` below `brightness` to half of it above (Eq. 7.5).
///
/// @param change  >= 0; for 0 and NaN there is nothing to smooth.
inline float smoothly_quantised(float brightness, float change, int tones) {
    const auto area = [tones](double b) {  // below the staircase, from 0 to b
        if (!(b > 0)) return 0.0;
        const double k = std::min(std::floor(b * tones), tones - 1.0);
        return (k * (k - 1) / 2 / tones + k * (b - k / tones)) / (tones - 1);
    };
    const double from = brightness - double{change} / 2, to = brightness + double{change} / 2;
    if (!(from < to) || tones == 1) return quantised(brightness, tones);  // also for NaN
    if (to <= 0 || from >= 1) return from >= 1 ? 1.0f : 0.0f;
    if (std::isinf(change)) return 0.5f;  // it reaches as far below all tones as above
    return static_cast<float>(std::clamp((area(to) - area(from)) / (to - from), 0.0, 1.0));
}

/// The share of a pixel, 0 to 1, that lies in a highlight, where the brightness runs linearly from
/// half of `change` below `brightness` to half of it above.
inline float highlight_share(float brightness, float change) {
    if (!(change > 0)) return brightness >= min_tone_highlight ? 1.0f : 0.0f;
    const float share = (brightness - min_tone_highlight) / change + 0.5f;
    return std::min(std::max(0.0f, share), 1.0f);  // 0 first: never NaN
}

/// What a fragment sends to the eye, its tones and highlight smoothed over one pixel.
///
/// @param light,right,below  In the fragment, a pixel to the right, and a pixel below.
inline vec3 smooth_toon(const SurfaceColor& color, vec3 from_all_around,
                        const ReflectedLight& light, const ReflectedLight& right,
                        const ReflectedLight& below, int tones) {
    const auto change = [&](auto&& brightness_of) {
        const float here = brightness_of(light);
        return std::abs(brightness_of(right) - here) + std::abs(brightness_of(below) - here);
    };
    const auto diffuse = [](const ReflectedLight& of) { return brightness(of.diffuse); };
    const auto specular = [&](const ReflectedLight& of) {
        return brightness(color.specular * of.specular);
    };
    const float level = smoothly_quantised(diffuse(light), change(diffuse), tones);
    return glm::mix(paint(color, from_all_around, level, false), vec3(1),
                    highlight_share(specular(light), change(specular)));
}

}  // namespace rasterbook
