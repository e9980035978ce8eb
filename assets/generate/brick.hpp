// SPDX-License-Identifier: MIT
/// @file
/// A brick wall in running bond: 4 bricks by 8 courses.
#pragma once

#include <cmath>

#include "assets/generate/texture.hpp"

namespace rasterbook::assets {

constexpr double brick_relief = 0.014;  ///< Of the joints, in sides of the texture.

/// Fired clay: mostly warm reds, some pale, some burnt dark.
inline dvec3 brick_tint(int column, int course) {
    const double kind = random(column, course, 11);
    const double warmth = random(column, course, 12);
    if (kind < 0.14) return glm::mix(rgb(0x5E352C), rgb(0x6F4436), warmth);
    if (kind < 0.34) return glm::mix(rgb(0xB9745A), rgb(0xC08468), warmth);
    return glm::mix(rgb(0x96493A), rgb(0xAC5B43), warmth);
}

/// The edges of hand-made bricks are not straight: how far they stray, in texels.
inline dvec2 wobble(dvec2 uv) {
    return 2.6 * dvec2(layered_noise(uv, ivec2(16), 3, 21), layered_noise(uv, ivec2(16), 3, 31));
}

inline Texel brick_texel(dvec2 p) {
    const dvec2 size(128, 64);
    const dvec2 uv = p / double(texture_side);
    const int course = int(p.y / size.y);
    const double shift = course % 2 == 0 ? 0.0 : size.x / 2;
    const double x = p.x + shift;
    const int column = wrap(int(std::floor(x / size.x)), 4);
    const dvec2 from_middle(x - (std::floor(x / size.x) + 0.5) * size.x,
                            p.y - (course + 0.5) * size.y);
    const double edge = distance_to_box(from_middle + wobble(uv), size / 2.0 - 4.5, 7);

    const double grit = layered_noise(uv, ivec2(64), 3, 41);
    const double clouds = layered_noise(uv, ivec2(12), 4, 51);
    const double pit = smooth_step(0.34, 0.62, noise(uv * 96.0, ivec2(96), 61));
    const double inside = smooth_step(1.5, -1.5, edge);
    const double rounding = smooth_step(2.5, -8, edge);

    const dvec3 clay = brick_tint(column, course) * (1 + 0.16 * clouds + 0.15 * grit - 0.30 * pit) *
                       (0.86 + 0.14 * rounding);
    const dvec3 mortar = rgb(0xB4AA98) * (0.88 + 0.20 * grit + 0.08 * clouds) *
                         (0.72 + 0.28 * smooth_step(0, 5, edge));
    const double tilt = 0.10 * (random(column, course, 71) - 0.5);
    const double brick_height =
        0.28 + 0.55 * rounding + tilt + 0.05 * clouds + 0.025 * grit - 0.14 * pit;
    const double mortar_height = 0.16 + 0.035 * grit + 0.04 * clouds;
    return {glm::mix(mortar, clay, inside),
            glm::mix(0.05, 0.22 + 0.10 * clouds - 0.12 * pit, inside),
            glm::mix(mortar_height, brick_height, inside)};
}

}  // namespace rasterbook::assets
