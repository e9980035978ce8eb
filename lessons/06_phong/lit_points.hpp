// SPDX-License-Identifier: MIT
/// @file
/// Light on many points at once: the same steps as for one, reflected_light(), and the same bits.
///
/// Each number of all points stands side by side in memory, so that one instruction of the
/// processor computes 4, 8 or 16 of them. Introduced in lesson 06.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "06_phong/light.hpp"
#include "06_phong/phong.hpp"
#include "common/math/types.hpp"

namespace rasterbook {

constexpr std::size_t most_points = 64;  ///< Few enough to stay in the fastest cache.

/// One number of each point.
using Numbers = std::array<float, most_points>;

/// A vector of each point.
struct Vectors {
    Numbers x, y, z;

    vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
    void set(std::size_t i, vec3 v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
};

/// Up to 64 points of a surface, and the light that they send to the eye.
struct LitPoints {
    std::size_t count = 0;
    Vectors position_world, normal_world;
    Vectors diffuse, specular;

    ReflectedLight light(std::size_t i) const { return {diffuse[i], specular[i]}; }
    void set_light(std::size_t i, const ReflectedLight& light) {
        diffuse.set(i, light.diffuse), specular.set(i, light.specular);
    }
};

/// 1/|v| by the steps of unit_or() where those are simple.
///
/// @param unusable  Becomes other than 0 where v is so long or so short that its square is not a
///                  usable number; then the result means nothing. Without a jump: a loop over many
///                  vectors asks it at its end.
inline float one_over_length(vec3 v, int& unusable) {
    const float squared = glm::dot(v, v);
    unusable |= (squared > 1e-30f ? 0 : 1) | (squared < 1e30f ? 0 : 1);
    return 1 / std::sqrt(squared);
}

/// The light of all lights on all points (Eq. 6.1 and 6.3), with highlights by the mirror
/// direction.
///
/// @param points  Their normals are of any length (Eq. 6.8).
/// @param power   As of reflected_light().
/// @param share   Called as share(l, i): how much of light l reaches point i, 0 to 1.
/// @return        Whether all is computed: false where a vector is so long or so short that its
///                square is not a usable number. Then the lights of the points mean nothing.
template <typename Power, typename Share>
bool reflect_light(std::span<const Light> lights, vec3 eye_world, bool has_highlight,
                   LitPoints& points, Power&& power, Share&& share) {
    // No step of a loop leaves it or calls what is not inlined: the compiler takes many i at once.
    const std::size_t count = points.count;
    int unusable = 0;
    const auto per_length = [&](vec3 v) { return one_over_length(v, unusable); };
    const Vectors& position = points.position_world;
    Vectors normal, toward_eye;
    for (std::size_t i = 0; i < count; ++i) {
        const vec3 mixed = points.normal_world[i];
        normal.set(i, mixed * per_length(mixed));
    }
    if (has_highlight)
        for (std::size_t i = 0; i < count; ++i) {
            const vec3 way = eye_world - position[i];
            toward_eye.set(i, way * per_length(way));
        }
    for (std::size_t i = 0; i < count; ++i) points.set_light(i, {});

    for (std::size_t l = 0; l < lights.size(); ++l) {
        const Light light = lights[l];
        Vectors toward;
        Numbers arriving, cosine;
        if (light.kind == LightKind::directional)
            for (std::size_t i = 0; i < count; ++i) {
                toward.set(i, light.direction_world);
                arriving[i] = share(l, i);
            }
        else
            for (std::size_t i = 0; i < count; ++i) {
                const vec3 way = (light.position_world - position[i]) * (1 / light.half_distance);
                toward.set(i, way * per_length(way));
                arriving[i] = attenuation(way) * share(l, i);
            }
        if (light.kind == LightKind::spot)
            for (std::size_t i = 0; i < count; ++i)
                arriving[i] *= spot_share(-glm::dot(toward[i], light.direction_world),
                                          light.cos_full, light.cos_none);
        for (std::size_t i = 0; i < count; ++i) {
            cosine[i] = glm::dot(normal[i], toward[i]);
            const float lit = cosine[i] > 0 ? cosine[i] : 0.0f;
            points.diffuse.set(i, points.diffuse[i] + lit * (arriving[i] * light.color));
        }
        if (!has_highlight) continue;
        for (std::size_t i = 0; i < count; ++i) {
            const float mirrored = glm::dot(reflected(normal[i], toward[i]), toward_eye[i]);
            cosine[i] = cosine[i] > 0 ? std::min(std::max(0.0f, mirrored), 1.0f) : -1.0f;
        }
        for (std::size_t i = 0; i < count; ++i) cosine[i] = cosine[i] < 0 ? 0.0f : power(cosine[i]);
        for (std::size_t i = 0; i < count; ++i)
            points.specular.set(i, points.specular[i] + cosine[i] * (arriving[i] * light.color));
    }
    return unusable == 0;
}

}  // namespace rasterbook
