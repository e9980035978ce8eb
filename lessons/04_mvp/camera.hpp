// SPDX-License-Identifier: MIT
/// @file
/// The camera: its position, its direction and its field of view. Introduced in lesson 04;
/// derivation: docs/derivations/04_mvp.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/trigonometric.hpp>

#include "04_mvp/transform.hpp"
#include "common/app/lesson_app.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

struct Camera {
    vec3 position_world;
    mat4 view_from_world;
    float fov_y_radians;   ///< From the lower to the upper border, in (0, pi).
    float near;            ///< Distance of the near plane in front of the camera, > 0.
    vec3 center_world{0};  ///< What it looks at.
    float far = std::numeric_limits<float>::infinity();  ///< Beyond it nothing is drawn; > near.

    /// The depth from which on something is drawn: 0 without a far plane.
    float farthest_depth() const { return std::isinf(far) ? 0 : near / far; }

    /// View first, then perspective (Eq. 4.4).
    ///
    /// @param size  Of the picture, in pixels.
    mat4 clip_from_world(ivec2 size) const {
        const float aspect = static_cast<float>(size.x) / static_cast<float>(size.y);
        return perspective(fov_y_radians, aspect, near) * view_from_world;
    }
};

/// The direction from a sphere's centre to a point of it, length 1 (Eq. 4.6).
///
/// @param yaw_radians    Around the y axis, from +z towards +x.
/// @param pitch_radians  Up from the horizon.
inline vec3 direction_from_angles(float yaw_radians, float pitch_radians) {
    const float horizontal = std::cos(pitch_radians);
    return {horizontal * std::sin(yaw_radians), std::sin(pitch_radians),
            horizontal * std::cos(yaw_radians)};
}

/// A camera on a sphere around a scene's centre. It looks at the centre.
///
/// @param orbit   orbit.distance is in radii of the scene: half of its box's diagonal.
/// @param bounds  Of the scene, world space. If it has no size, its radius counts as 1; if it is
///                empty, the same, around the origin.
inline Camera orbit_camera(const Orbit& orbit, const Bounds& bounds) {
    const bool is_empty = !(bounds.min.x <= bounds.max.x);
    const vec3 center = is_empty ? vec3(0) : bounds.center();
    const float radius = bounds.radius();
    const float distance = orbit.distance * radius;
    const float yaw_radians = glm::radians(orbit.yaw_degrees);
    const float pitch_radians = glm::radians(orbit.pitch_degrees);
    const vec3 eye = center + distance * direction_from_angles(yaw_radians, pitch_radians);
    const vec3 up = direction_from_angles(yaw_radians, pitch_radians + glm::radians(90.0f));
    // The scene lies between distance - radius and distance + radius.
    const float near = std::max(0.999f * (distance - radius), 0.001f * (distance + radius));
    return {eye, look_at(eye, center, up), glm::radians(orbit.fov_degrees), near, center};
}

}  // namespace rasterbook
