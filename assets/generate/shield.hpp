// SPDX-License-Identifier: MIT
/// @file
/// A round shield with a letter, as of the hoplites of Sparta: both halves show one half of a
/// texture, the left one mirrored.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <utility>

#include "assets/generate/figure.hpp"
#include "assets/generate/hammered.hpp"
#include "assets/generate/models.hpp"
#include "assets/generate/texture.hpp"

namespace rasterbook::assets {

constexpr double shield_relief =
    0.03;  ///< From the lowest to the highest, in sides of the texture.

/// How far a point lies from the line between two others.
inline double distance_to_segment(dvec2 p, dvec2 from, dvec2 to) {
    const dvec2 side = to - from;
    const double along = glm::dot(p - from, side) / glm::dot(side, side);
    return glm::distance(p, from + glm::clamp(along, 0.0, 1.0) * side);
}

/// What is embossed, about 0 to 1: a rim, studs, a groove, and a lambda for Lacedaemon; on a ground
/// that was beaten flat.
///
/// @param p  x right and y up; the shield's radius is 1.
inline double shield_height(dvec2 p) {
    p.x = glm::abs(p.x);  // the halves are mirror images
    const double r = glm::length(p);
    const double beaten = smooth_step(0, 0.12, p.x) * smooth_step(0.93, 0.85, r);
    double height = 0.2 + 0.4 * glm::mix(0.3, dents_at(p / 2.0).height, beaten);
    height += 0.5 * smooth_step(0.86, 0.9, r) * smooth_step(0.98, 0.94, r);
    height -= 0.3 * smooth_step(0.025, 0.005, glm::abs(r - 0.65));
    for (const dvec2 stud : circle(16)) {
        const double across = glm::distance(p, 0.76 * stud) / 0.055;
        if (across < 1) height += 0.6 * (1 - across * across) * (1 - across * across);
    }
    const double to_letter = distance_to_segment(p, {0, 0.44}, {0.3, -0.4});
    height += 0.7 * smooth_step(0.085, 0.04, to_letter);
    return height;
}

/// The texture of a whole shield, turned by a quarter: u runs up on it, v to the left. The model
/// shows the lower half alone, where v is at most 0.5.
inline Texel shield_texel(dvec2 p) {
    const dvec2 uv(p.x / texture_side, 1 - p.y / texture_side);
    return {dvec3(0), 0, shield_height({1 - 2 * uv.y, 2 * uv.x - 1})};
}

/// A piece of a sphere that leans back on y = 0, its rim a circle.
inline Part shield(const std::string& material) {
    const double rim = 1.5, depth = 0.3, sphere = (rim * rim + depth * depth) / (2 * depth);
    const int rows = 8, columns = 64;
    const std::vector<dvec2> around = circle(columns);
    const auto vertex = [&](int row, int column) {
        const dvec2 p = rim * row / rows * around[std::size_t(column % columns)];
        const double to_middle = std::sqrt(sphere * sphere - glm::dot(p, p));
        return Vertex{{p.x, p.y, to_middle - (sphere - depth)},
                      (1.0 + dvec2(p.y, -glm::abs(p.x)) / rim) / 2.0,
                      dvec3(p.x, p.y, to_middle) / sphere};
    };
    Part part{"shield", material, {}};
    for (int row = 0; row < rows; ++row)
        for (int i = 0; i < columns; ++i) {
            Polygon face{vertex(row, i), vertex(row + 1, i), vertex(row + 1, i + 1)};
            if (row > 0) face.push_back(vertex(row, i + 1));
            part.faces.push_back(std::move(face));
        }
    const auto leant_back = [](dvec3 v) {
        return dvec3(v.x, 0.96 * v.y + 0.28 * v.z, 0.96 * v.z - 0.28 * v.y);
    };
    for (Polygon& face : part.faces)
        for (Vertex& of_face : face) {
            of_face.position = leant_back(of_face.position) + dvec3(0, 0.96 * rim, 0);
            of_face.normal = leant_back(of_face.normal);
        }
    return placed(std::move(part), 0.96, -0.28, dvec3(0));
}

}  // namespace rasterbook::assets
