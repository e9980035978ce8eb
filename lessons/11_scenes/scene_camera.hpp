// SPDX-License-Identifier: MIT
/// @file
/// A file's camera, and how far away our own has to be. Introduced in lesson 11; derivation:
/// docs/derivations/11_scenes.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "04_mvp/camera.hpp"
#include "common/app/lesson_app.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// A file's camera. It only turns and moves, so its inverse is as exact as its numbers.
inline Camera camera_of(const SceneCamera& from) {
    const dmat4 world_from_view(from.world_from_view);
    const vec3 eye(world_from_view[3]);
    return {eye,       mat4(glm::inverse(world_from_view)), from.fov_y_radians,
            from.near, eye - vec3(world_from_view[2]),      from.far};
}

/// How much of the picture's width and height a fitted scene takes at most.
constexpr double fitted_share = 0.9;

/// From how far away a camera on the orbit just sees all of a box (Eq. 11.1).
///
/// @param bounds  World space.
/// @param size    Of the picture.
/// @return        In radii of the box; orbit.distance for an empty box, or one of no size.
inline float fitting_distance(const Orbit& orbit, const Bounds& bounds, ivec2 size) {
    const float yaw_radians = glm::radians(orbit.yaw_degrees);
    const float pitch_radians = glm::radians(orbit.pitch_degrees);
    const dvec3 back = direction_from_angles(yaw_radians, pitch_radians);
    const dvec3 up = direction_from_angles(yaw_radians, pitch_radians + glm::radians(90.0f));
    const dvec3 right = glm::cross(up, back);
    const double tangent_y = fitted_share * std::tan(double{glm::radians(orbit.fov_degrees)} / 2);
    const double tangent_x = tangent_y * size.x / size.y;
    double distance = 0;
    for (int i = 0; i < 8; ++i) {
        const dvec3 corner(i & 1 ? bounds.max.x : bounds.min.x, i & 2 ? bounds.max.y : bounds.min.y,
                           i & 4 ? bounds.max.z : bounds.min.z);
        const dvec3 from_center = corner - dvec3(bounds.center());
        const double x = std::abs(glm::dot(from_center, right)) / tangent_x;
        const double y = std::abs(glm::dot(from_center, up)) / tangent_y;
        distance = std::max(distance, glm::dot(from_center, back) + std::max(x, y));
    }
    const bool is_usable = distance > 0 && distance <= std::numeric_limits<float>::max();
    return is_usable ? static_cast<float>(distance / bounds.radius()) : orbit.distance;
}

}  // namespace rasterbook
