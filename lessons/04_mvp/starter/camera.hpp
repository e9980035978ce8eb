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
        // TODO, step 2: Eq. 4.4 and 4.8.
        return mat4(1);
    }
};

/// The direction from a sphere's centre to a point of it, length 1 (Eq. 4.6).
///
/// @param yaw_radians    Around the y axis, from +z towards +x.
/// @param pitch_radians  Up from the horizon.
inline vec3 direction_from_angles(float yaw_radians, float pitch_radians) {
    // TODO, step 2: Eq. 4.6.
    return {0, 0, 1};
}

/// A camera on a sphere around a scene's centre. It looks at the centre.
///
/// @param orbit   orbit.distance is in radii of the scene: half of its box's diagonal.
/// @param bounds  Of the scene, world space. If it has no size, its radius counts as 1; if it is
///                empty, the same, around the origin.
inline Camera orbit_camera(const Orbit& orbit, const Bounds& bounds) {
    // TODO, step 2: the eye and the up direction by Eq. 4.6, around bounds.center(), or around the
    // origin if the box is empty: its centre would be NaN. bounds.radius() works for any box. The
    // view by Eq. 4.5; near as the text says after Eq. 4.8.
    return {vec3(0, 0, 1), mat4(1), 1, 1};
}

}  // namespace rasterbook
