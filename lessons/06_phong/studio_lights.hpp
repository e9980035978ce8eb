// SPDX-License-Identifier: MIT
/// @file
/// The lights of lessons 06 to 08, and the ambient light that later ones share. Introduced in
/// lesson 06.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/trigonometric.hpp>

#include "06_phong/light.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// A warm key light from the upper left, and a cool one from behind that draws the rims.
///
/// @param key      The key light's kind.
/// @param bounds   Of the scene, world space.
/// @param key_way  Where the key light stands as seen from the scene's centre; of any length,
///                 and above where it is 0.
inline std::array<Light, 2> studio_lights(LightKind key, const Bounds& bounds,
                                          vec3 key_way = {-1.2f, 0.5f, 0.6f}) {
    const vec3 center = bounds.center();
    const float radius = bounds.radius();
    const vec3 toward_key = unit_or(key_way, vec3(0, 1, 0));
    const vec3 toward_rim = unit_or(vec3(0.95f, 0.38f, -0.55f), vec3(0, 1, 0));
    Light light{key, vec3(1.0f, 0.92f, 0.8f), toward_key};
    if (key != LightKind::directional) {
        light.position_world = center + 0.9f * radius * toward_key;
        light.half_distance = std::max(radius, std::numeric_limits<float>::min());
        light.color *= 2.4f;
    }
    if (key == LightKind::spot) {
        light.direction_world = -toward_key;
        light.cos_inner = std::cos(glm::radians(18.0f));
        light.cos_outer = std::cos(glm::radians(32.0f));
    }
    return {light, Light{LightKind::directional, vec3(0.6f, 0.82f, 1.15f), toward_rim}};
}

constexpr vec3 ambient_light(0.04f, 0.05f, 0.07f);  ///< Linear.

}  // namespace rasterbook
