// SPDX-License-Identifier: MIT
/// @file
/// Copper shaped by a hammer: overlapping round dents.
#pragma once

#include <array>
#include <cmath>

#include "assets/generate/texture.hpp"

namespace rasterbook::assets {

constexpr double hammered_relief = 0.030;  ///< From the deepest dent, in sides of the texture.

/// The lesser of two, rounded off where they differ by less than `width`. @see Quilez 2013
constexpr double smooth_min(double a, double b, double width) {
    const double overlap = glm::max(width - glm::abs(a - b), 0.0) / width;
    return glm::min(a, b) - overlap * overlap * width / 4;
}

/// What the hammer left: one blow in each cell of a grid, each a shallow bowl.
struct Dents {
    double height;  ///< Of the metal, 0 to about 0.7.
    double ridge;   ///< 1 where two bowls meet, 0 away from there.
};

inline Dents dents_at(dvec2 uv) {
    const int cells = 11;
    const dvec2 p = uv * double(cells);
    double height = 1, lowest = 1, second = 1;
    for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx) {
            const dvec2 cell(std::floor(p.x) + dx, std::floor(p.y) + dy);
            const int x = wrap(int(cell.x), cells), y = wrap(int(cell.y), cells);
            const dvec2 middle = cell + 0.15 + 0.7 * dvec2(random(x, y, 201), random(x, y, 202));
            const dvec2 away = p - middle;
            const double depth = 0.03 + 0.28 * random(x, y, 203);
            const double bowl = depth + 0.62 * (away.x * away.x + away.y * away.y);
            height = smooth_min(height, bowl, 0.08);
            second = glm::min(second, glm::max(bowl, lowest));
            lowest = glm::min(lowest, bowl);
        }
    return {height, smooth_step(0.13, 0.0, second - lowest)};
}

inline Texel hammered_texel(dvec2 p) {
    const dvec2 uv = p / double(texture_side);
    const Dents dents = dents_at(uv);
    const double clouds = layered_noise(uv, ivec2(5), 4, 211);
    const double brushed = layered_noise(uv, ivec2(96, 24), 2, 221);
    // Cloths polish the ridges; in the dents the copper keeps its dark bloom.
    const double polish = 0.5 * dents.ridge * smooth_step(0.10, 0.45, dents.height);
    const double bloom = glm::clamp(0.45 + 0.55 * clouds - 0.5 * polish, 0.0, 1.0);

    const dvec3 copper = glm::mix(rgb(0xBC6E49), rgb(0xDE9A70), polish) * (1 + 0.07 * brushed);
    const dvec3 color = glm::mix(copper, rgb(0x8A4A32), 0.6 * bloom);
    return {color, glm::mix(0.95, 0.55, bloom) + 0.06 * brushed, dents.height + 0.012 * brushed};
}

}  // namespace rasterbook::assets
