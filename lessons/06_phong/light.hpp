// SPDX-License-Identifier: MIT
/// @file
/// Where light comes from, and how much of it arrives. Introduced in lesson 06;
/// derivation: docs/derivations/06_phong.md.
#pragma once

#include <algorithm>
#include <cmath>

#include "common/math/numerics.hpp"
#include "common/math/types.hpp"

namespace rasterbook {

/// v scaled to length 1, or `fallback` when it has no direction. Faster than normalize_or().
///
/// @return  Each component within 2.3 * 2^-23 of its size of its exact value.
inline vec3 unit_or(vec3 v, vec3 fallback) {
    const float squared = glm::dot(v, v);
    constexpr float least = 1e-30f, most = 1e30f;  // beyond, squares lose digits or overflow
    if (squared > least && squared < most) return v * (1 / std::sqrt(squared));
    return normalize_or(v, fallback);
}

/// As from the sun, from a lamp, or from a lamp with a shade.
enum class LightKind { directional, point, spot };

struct Light {
    LightKind kind;
    vec3 color;               ///< Linear; what arrives from a directional light, or at the lamp.
    vec3 direction_world;     ///< Length 1: towards a directional light; where a spot shines.
    vec3 position_world{0};   ///< Of a point light or spot.
    float half_distance = 1;  ///< Where half of a lamp's light arrives, >= FLT_MIN; world space.
    float cos_full = 1;       ///< Cosine of the angle up to which a spot shines fully.
    float cos_none = 0;       ///< Of the angle from which on it does not shine, < cos_full.
};

/// The light that arrives at a point.
struct Incoming {
    vec3 toward;  ///< Direction to the light, length 1.
    vec3 color;   ///< Linear.
};

/// The share of a lamp's light that arrives over a distance: 1 at the lamp (Eq. 6.6).
///
/// @param in_half_distances  The way to the lamp, in units of the lamp's half_distance.
inline float attenuation(vec3 in_half_distances) {
    return 1 / (1 + glm::dot(in_half_distances, in_half_distances));
}

/// The share of a spot's light that it sends into a direction: 0 to 1 (Eq. 6.7).
///
/// @param cosine  Of the angle to where it shines.
inline float spot_share(float cosine, float cos_full, float cos_none) {
    const float t = std::clamp((cosine - cos_none) / (cos_full - cos_none), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

/// What arrives of a light at a point: all of a sun's, a share of a lamp's (Eq. 6.6) and of a
/// spot's (Eq. 6.6 times Eq. 6.7).
///
/// @param light           Finite numbers.
/// @param position_world  Not NaN. Where a lamp or spot stands at this very point, or infinitely
///                        far away, its light comes from above.
inline Incoming incoming_light(const Light& light, vec3 position_world) {
    if (light.kind == LightKind::directional) return {light.direction_world, light.color};
    const vec3 way = (light.position_world - position_world) * (1 / light.half_distance);
    const vec3 toward = unit_or(way, vec3(0, 1, 0));
    float share = attenuation(way);
    if (light.kind == LightKind::spot)
        share *=
            spot_share(-glm::dot(toward, light.direction_world), light.cos_full, light.cos_none);
    return {toward, share * light.color};
}

}  // namespace rasterbook
