// SPDX-License-Identifier: MIT
/// @file
/// Which triangle is seen in each pixel, whatever its colour: by whole numbers, without the stages,
/// so that a stage that is wrong does not make the judge wrong as well.
#pragma once

#include <array>
#include <span>

#include "common/image/image.hpp"

namespace rasterbook::test {

/// A triangle as it reaches the screen: x right and y down in pixels; depth, greater is nearer.
using ScreenPatch = std::array<vec3, 3>;

enum class Facing { front, back, both };
enum class Winner { nearest, farthest, last };

struct VisibilityRule {
    Facing drawn = Facing::front;
    Winner winner = Winner::nearest;  ///< Of equal depths the first in the list.
};

struct Visibility {
    static constexpr int nothing = -1;

    Image<int> ids;        ///< Index into the list of patches, or `nothing`.
    Image<double> depths;  ///< Of that patch at the pixel's centre; 0 where there is nothing.
};

/// @param patches  In the order in which they are drawn. One with a coordinate that is not a number
///                 or lies 2^21 pixels away or more covers nothing.
Visibility visible(std::span<const ScreenPatch> patches, ivec2 size, VisibilityRule rule);

}  // namespace rasterbook::test
