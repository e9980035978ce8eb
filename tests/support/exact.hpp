// SPDX-License-Identifier: MIT
/// @file
/// Exact oracles for what lies on the screen: whole numbers of 128 bits, nothing of the stages.
#pragma once

#include <cmath>

#include "common/math/numerics.hpp"
#include "common/math/types.hpp"

namespace rasterbook::test {

/// A point of the screen in 1/256 pixel: the product rounds nothing, the rest is one rounding.
inline ivec2 exactly_snapped(vec2 point) {
    return {static_cast<int>(std::nearbyint(256 * double{point.x})),
            static_cast<int>(std::nearbyint(256 * double{point.y}))};
}

/// A pixel's centre in 1/256 pixel.
inline ivec2 exact_center(ivec2 pixel) { return pixel * 256 + 128; }

/// Twice the area of a, b, p by the rule of Sarrus; > 0 where seen counter-clockwise.
inline int128 exact_twice_area(ivec2 a, ivec2 b, ivec2 p) {
    const auto product = [](int u, int v) { return int128{u} * v; };
    return -(product(a.x, b.y) + product(b.x, p.y) + product(p.x, a.y) - product(a.y, b.x) -
             product(b.y, p.x) - product(p.y, a.x));  // y points down: what turns left is negative
}

}  // namespace rasterbook::test
