// SPDX-License-Identifier: MIT
/// @file
/// One colour for a whole triangle, by the way it faces: a stand-in until lesson 06 derives
/// lighting.
#pragma once

#include <algorithm>

#include "common/math/numerics.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// The material's diffuse colour under a warm directional light from the upper left and a cool
/// ambient light from above.
///
/// @return  Linear colour. A triangle without area counts as facing up.
inline vec3 flat_color(const Mesh& mesh, const Triangle& triangle, const Material& material) {
    constexpr vec3 up(0, 1, 0), sun_color(1.05f, 0.97f, 0.86f), sky_color(0.17f, 0.22f, 0.30f);
    const vec3 toward_sun = normalize_or(vec3(-0.75f, 0.85f, 0.3f), up);
    const auto [a, b, c] = triangle.vertices;
    const dvec3 origin = mesh.positions[a.position];  // double: a product of floats may overflow
    const dvec3 ab = dvec3(mesh.positions[b.position]) - origin;
    const dvec3 ac = dvec3(mesh.positions[c.position]) - origin;
    const vec3 normal(normalize_or(glm::cross(ab, ac), dvec3(up)));
    const float sun = std::max(glm::dot(normal, toward_sun), 0.0f);
    const float sky = 0.5f + 0.5f * normal.y;
    return material.diffuse * (sun * sun_color + sky * sky_color);
}

}  // namespace rasterbook
