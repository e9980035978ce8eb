// SPDX-License-Identifier: MIT
/// @file
/// A file's camera, and how far away our own has to be. Introduced in lesson 11; derivation:
/// docs/derivations/11_scenes.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "04_mvp/camera.hpp"
#include "common/app/lesson_app.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// A file's camera. It only turns and moves, so its inverse is as exact as its numbers.
inline Camera camera_of(const SceneCamera& from) {
    // TODO, step 1: from.world_from_view has the camera's position in its last column, and in its
    // third one the direction back; center_world lies 1 in front. Its inverse, computed in double,
    // is Camera::view_from_world. The angle, the near and the far plane are the file's.
    return {vec3(0, 1, 8), glm::translate(mat4(1), -vec3(0, 1, 8)), from.fov_y_radians, from.near};
}

/// How much of the picture's width and height a fitted scene takes at most.
constexpr double fitted_share = 0.9;

/// From how far away a camera on the orbit just sees all of a box (Eq. 11.1).
///
/// @param bounds  World space.
/// @param size    Of the picture.
/// @return        In radii of the box; orbit.distance for an empty box, or one of no size.
inline float fitting_distance(const Orbit& orbit, const Bounds& bounds, ivec2 size) {
    // TODO, step 1: Eq. 11.1, over the eight corners of the box. direction_from_angles() gives the
    // direction back to the camera, and with 90 degrees more of pitch the direction up. What is
    // returned is D in radii of the box; where that is no positive, finite float, orbit.distance.
    return orbit.distance;
}

}  // namespace rasterbook
