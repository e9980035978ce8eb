// SPDX-License-Identifier: MIT
/// @file
/// Where a scene stands, and the point that it is stored relative to.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "common/math/types.hpp"

namespace rasterbook {

/// Farther from 0 than so many of its radii, a scene is stored relative to a point near its middle.
constexpr double max_radii_from_origin = 8;

/// The box of a file's positions, in double: a float of ten million has steps of 1.
struct WorldBox {
    dvec3 min{std::numeric_limits<double>::infinity()};
    dvec3 max{-std::numeric_limits<double>::infinity()};

    void add(dvec3 position_world) {
        min = glm::min(min, position_world), max = glm::max(max, position_world);
    }

    /// Scene::origin: 0 for a scene around 0 or near it, or one of no size. Else each coordinate is
    /// the multiple of g next to the middle's, g being the power of two from 2 to 4 radii. A scene
    /// that is moved by multiples of g therefore keeps its floats, all their bits.
    dvec3 origin() const {
        const dvec3 middle = 0.5 * (min + max);
        const double radius = 0.5 * glm::length(max - min);
        const dvec3 away = glm::abs(middle);
        if (!(radius > 0 && std::max({away.x, away.y, away.z}) > max_radii_from_origin * radius))
            return dvec3(0);
        const double g = std::ldexp(1.0, std::ilogb(radius) + 2);
        return g * glm::round(middle / g);
    }
};

}  // namespace rasterbook
