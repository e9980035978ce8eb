// SPDX-License-Identifier: MIT
/// @file
/// A triangle's direction, and its angles. Introduced in lesson 06;
/// derivation: docs/derivations/06_phong.md.
#pragma once

#include <cmath>
#include <cstddef>

#include "common/math/numerics.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// The direction out of a triangle's front, length 1; up for a triangle of no area.
inline vec3 face_normal(const Mesh& mesh, const Triangle& triangle) {
    // double: products of floats may overflow or vanish
    const dvec3 a = mesh.positions[triangle.vertices[0].position];
    const dvec3 b = mesh.positions[triangle.vertices[1].position];
    const dvec3 c = mesh.positions[triangle.vertices[2].position];
    return vec3(normalize_or(glm::cross(b - a, c - a), dvec3(0, 1, 0)));
}

/// The angle between the two sides at a triangle's vertex, 0 to pi; 0 for a triangle of no area,
/// which would otherwise count with pi for a normal that means nothing.
inline float vertex_angle_radians(const Mesh& mesh, const Triangle& triangle, std::size_t vertex) {
    const dvec3 here = mesh.positions[triangle.vertices[vertex].position];
    const dvec3 u = dvec3(mesh.positions[triangle.vertices[(vertex + 1) % 3].position]) - here;
    const dvec3 v = dvec3(mesh.positions[triangle.vertices[(vertex + 2) % 3].position]) - here;
    const double twice_area = glm::length(glm::cross(u, v));
    return twice_area > 0 ? static_cast<float>(std::atan2(twice_area, glm::dot(u, v))) : 0.0f;
}

}  // namespace rasterbook
