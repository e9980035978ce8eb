// SPDX-License-Identifier: MIT
/// @file
/// The lights of a scene file, or those that a file without lights is given. Introduced in lesson
/// 11; derivation: docs/derivations/11_scenes.md.
#pragma once

#include <algorithm>
#include <limits>
#include <numbers>
#include <span>

#include "06_phong/light.hpp"
#include "07_toon/toon.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// Light of colour 1 makes a white surface white: so many lux.
constexpr float lux_of_white = std::numbers::pi_v<float>;

/// A file's point light has no size, and at its position its light would be infinite: here it is
/// as large as this share of the scene's radius. A spotlight is, too.
constexpr float point_light_size = 1.0f / 128;

/// A file's light in units of the lessons' (Eq. 11.3 and 11.4). Its range, a hint, is ignored.
///
/// @param scene_radius  World space, > 0; any float. Farther from a point light than 10 times its
///                      size, less than 1% of its light is missing.
inline Light light_of(const SceneLight& from, float scene_radius) {
    // TODO: its kind, position, direction (of a directional light: towards it) and cone; Eq. 11.3,
    // and of a point light or a spotlight Eq. 11.4.
    Light light{LightKind::directional, from.color, -from.direction_world};
    return light;
}

/// What a file's lights are multiplied by before they are drawn with (Eq. 11.5): 1, if none of
/// them is more than twice as bright as white at the scene's middle; else so much that the
/// brightest is white there. A point light or spotlight nearer than one radius of the scene counts
/// as one radius away.
///
/// @param bounds  Of the scene, world space.
/// @return  > 0, at most 1.
inline float exposure_of(std::span<const SceneLight> lights, const Bounds& bounds) {
    // TODO: Eq. 11.5, in double.
    return 1;
}

}  // namespace rasterbook
