// SPDX-License-Identifier: MIT
/// @file
/// Where light comes from, and how much of it arrives. Introduced in lesson 06;
/// derivation: docs/derivations/06_phong.md.
#pragma once

#include <glm/geometric.hpp>

#include "common/math/functions.hpp"
#include "common/math/types.hpp"

namespace rasterbook {

/// Far away as the sun, at a position as a bare bulb, or in a cone as a bulb with a shade.
enum class LightKind { directional, point, spot };

struct Light {
    LightKind kind;
    vec3 color;            ///< Linear; what arrives from a directional light, or at a point light.
    vec3 direction_world;  ///< Length 1: towards a directional light; where a spotlight shines.
    vec3 position_world{0};   ///< Of a point light or spotlight.
    float half_distance = 1;  ///< Where half of its light arrives; >= FLT_MIN, world.
    float cos_inner = 1;      ///< Cosine of the angle up to which a spotlight shines fully.
    float cos_outer = 0;      ///< Of the angle from which on it does not shine, < cos_inner.
};

/// The light that arrives at a point.
template <typename F>
struct Incoming {
    Vec3<F> toward;  ///< Direction to the light, length 1.
    Vec3<F> color;   ///< Linear.
};

/// A point light's attenuation over a distance: 1 at the light (Eq. 6.6).
///
/// @param in_half_distances  From the point to the light, in units of its half_distance.
template <typename F>
F distance_attenuation(Vec3<F> in_half_distances) {
    return F(1.0f) / (F(1.0f) + glm::dot(in_half_distances, in_half_distances));
}

/// A spotlight's attenuation in a direction: 0 to 1 (Eq. 6.7).
///
/// @param cosine  Of the angle between where it shines and the way to the point.
template <typename F>
F spot_attenuation(F cosine, float cos_inner, float cos_outer) {
    const F t = clamp((cosine - F(cos_outer)) / F(cos_inner - cos_outer), F(0.0f), F(1.0f));
    return t * t * (F(3.0f) - F(2.0f) * t);
}

/// What arrives of a light at a point: all of a directional light's; a point light's is attenuated
/// by Eq. 6.6, a spotlight's by Eq. 6.6 times Eq. 6.7.
///
/// @param light           Finite numbers.
/// @param position_world  Not NaN. Where a point light or spotlight stands at this very point, or
///                        infinitely far away, its light comes from above.
template <typename F>
Incoming<F> incoming_light(const Light& light, Vec3<F> position_world) {
    if (light.kind == LightKind::directional)
        return {Vec3<F>(light.direction_world), Vec3<F>(light.color)};
    const Vec3<F> to_light =
        (Vec3<F>(light.position_world) - position_world) * F(1 / light.half_distance);
    const Vec3<F> toward = unit_or(to_light, Vec3<F>(vec3(0, 1, 0)));
    F attenuation = distance_attenuation(to_light);
    if (light.kind == LightKind::spot)
        attenuation *= spot_attenuation(-glm::dot(toward, Vec3<F>(light.direction_world)),
                                        light.cos_inner, light.cos_outer);
    return {toward, attenuation * Vec3<F>(light.color)};
}

}  // namespace rasterbook
