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
    // TODO: the cross product of two sides, scaled by normalize_or(); in double, since products
    // of floats may overflow or vanish. A vertex is at
    // mesh.positions[triangle.vertices[i].position].
    return {0, 1, 0};
}

/// The angle between the two sides at a triangle's vertex, 0 to pi; 0 for a triangle of no area,
/// which would otherwise count with pi for a normal that means nothing.
inline float vertex_angle_radians(const Mesh& mesh, const Triangle& triangle, std::size_t vertex) {
    // TODO: by atan2(), as the text says behind Eq. 6.9; in double, too.
    return 0;
}

}  // namespace rasterbook
