// SPDX-License-Identifier: MIT
/// @file
/// glTF's materials as the lessons' light model has them; derivation: docs/gltf.md.
#pragma once

#include <algorithm>

#include <glm/common.hpp>

#include "common/math/types.hpp"

namespace rasterbook {

/// Numbers of MTL: Kd, Ks and Ns.
struct PhongNumbers {
    vec3 diffuse, specular;
    float shininess;
};

/// What a surface without metal reflects at once, at a right angle.
constexpr float reflected_by_insulators = 0.04f;

/// The highlight that comes nearest to that of a rough surface: Ns = (1 / r^4 - 1) / 2 by the
/// mirror direction, with Ks = F / (4 r^4), but no brighter than the light itself.
///
/// @param base       Colour, linear, 0 to 1.
/// @param metallic   0 to 1.
/// @param roughness  0 to 1. Below 0.14 and near 1, Ns is at the ends of its range.
/// @return           Each colour 0 to 1; Ns 1 to 1024.
/// @see Karis, "Specular BRDF Reference", 2013; Walter and others, "Microfacet Models for
///      Refraction through Rough Surfaces", 2007
inline PhongNumbers phong_from_metallic_roughness(vec3 base, float metallic, float roughness) {
    constexpr float least = 0.01f;  // whose fourth power is far from underflow
    const float r = std::max(roughness, least), r4 = r * r * r * r;
    const vec3 at_once = glm::mix(vec3(reflected_by_insulators), base, metallic);
    const vec3 specular = at_once / (4 * r4);
    const float brightest = std::max({specular.r, specular.g, specular.b, 1.0f});
    return {base * (1 - metallic), specular / brightest,
            std::clamp((1 / r4 - 1) / 2, 1.0f, 1024.0f)};
}

}  // namespace rasterbook
