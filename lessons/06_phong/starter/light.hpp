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
    // TODO: Eq. 6.6.
    return F(0.0f);
}

/// A spotlight's attenuation in a direction: 0 to 1 (Eq. 6.7).
///
/// @param cosine  Of the angle between where it shines and the way to the point.
template <typename F>
F spot_attenuation(F cosine, float cos_inner, float cos_outer) {
    // TODO: Eq. 6.7.
    return F(0.0f);
}

/// What arrives of a light at a point: all of a directional light's; a point light's is attenuated
/// by Eq. 6.6, a spotlight's by Eq. 6.6 times Eq. 6.7.
///
/// @param light           Finite numbers.
/// @param position_world  Not NaN. Where a point light or spotlight stands at this very point, or
///                        infinitely far away, its light comes from above.
template <typename F>
Incoming<F> incoming_light(const Light& light, Vec3<F> position_world) {
    // TODO: a directional light as it is; of a point light the vector to it in half distances, its
    // direction by unit_or(), and the attenuation by Eq. 6.6; of a spotlight also Eq. 6.7. The
    // light's kind is the same for all numbers of F: `if` may test it.
    return {Vec3<F>(vec3(0, 1, 0)), Vec3<F>(F(0.0f))};
}

}  // namespace rasterbook
