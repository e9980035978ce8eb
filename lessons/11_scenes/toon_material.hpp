// SPDX-License-Identifier: MIT
/// @file
/// Toon materials of a file: a lit colour and a shade, and an outline of their own. Introduced in
/// lesson 11; derivation: docs/derivations/11_scenes.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "04_mvp/camera.hpp"
#include "06_phong/light.hpp"
#include "07_toon/toon.hpp"
#include "common/math/functions.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// How much of the lit colour a light gives, before shadows: 0 to 1 (Eq. 11.4).
///
/// @param cosine  Of the angle between normal and light. NaN counts as no light.
template <typename F>
F toon_step(F cosine, const ToonMaterial& look) {
    const F turned = cosine + F(look.shift);
    const float half_width = 1 - look.toony;
    if (half_width <= 0) return select(turned >= F(0.0f), F(1.0f), F(0.0f));
    return clamp((turned + F(half_width)) / F(2 * half_width), F(0.0f), F(1.0f));
}

/// The level of light on a point: 0 is its colour in the shade, 1 its lit one (Eq. 11.5).
///
/// How bright the lights are does not count, only how bright they are beside the brightest one
/// there: so a picture in one light has two colours for each paint, and the ramp between them.
///
/// @param normal_world  Of any length. Without a direction, all lights graze it: the cosine is 0.
/// @param share         Called as share(l), only where the light counts: its visibility, 0 to 1.
///                      From a half on it is taken for 1, else for 0: a drawing's shadows have
///                      edges. For several points at once, called as share(l, mask).
/// @return  0 to 1; 0 where no light arrives.
template <typename F, typename Share>
F toon_level(std::span<const Light> lights, Vec3<F> position_world, Vec3<F> normal_world,
             const ToonMaterial& look, Share&& share) {
    const Vec3<F> normal = unit_or(normal_world, Vec3<F>(F(0.0f)));
    F sum(0.0f), brightest(0.0f);
    for (std::size_t l = 0; l < lights.size(); ++l) {
        const Incoming incoming = incoming_light(lights[l], position_world);
        const F arriving = brightness(incoming.color);
        brightest = max(arriving, brightest);
        const F lit = arriving * toon_step(glm::dot(normal, incoming.toward), look);
        const auto counts = lit > F(0.0f);
        if (any_of(counts)) sum += select(F(call_where(counts, share, l)) >= F(0.5f), lit, F(0.0f));
    }
    return select(brightest > F(0.0f), min(sum / brightest, F(1.0f)), F(0.0f));
}

/// From the colour in the shade to the lit one. Where both are equal, it is exactly that colour.
template <typename F>
Vec3<F> toon_paint(Vec3<F> shade, Vec3<F> lit, F level) {
    return shade + level * (lit - shade);
}

/// A mesh's outline: its faces turned inside out, of the outline's colour, to be pushed outwards.
struct OutlineHull {
    Mesh mesh;
    std::vector<vec3> places, normals;  ///< Of each position before it is pushed; of the push.
    std::vector<float> widths;          ///< World space, or in heights of the picture.
    std::vector<bool> on_screen;        ///< Whether its width is in heights of the picture.
};

/// Whether a material has an outline of its own.
inline bool has_outline(const Material& material) {
    return material.toon && material.toon->outline != ToonMaterial::Outline::none &&
           material.toon->outline_width > 0;
}

/// A hull as a camera is to see it: each point is pushed along its normal, by the outline's width
/// in the world, or by the length that looks so wide where the point is (Eq. 11.6).
inline Mesh pushed(const OutlineHull& hull, const Camera& camera) {
    Mesh mesh = hull.mesh;
    const float height_per_distance =
        2 * static_cast<float>(std::tan(double{camera.fov_y_radians} / 2));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        float width = hull.widths[i];
        if (hull.on_screen[i]) {
            const vec3 seen(camera.view_from_world * vec4(hull.places[i], 1));
            width *= height_per_distance * std::max(-seen.z, 0.0f);
        }
        mesh.positions[i] = hull.places[i] + width * hull.normals[i];
        mesh.bounds.add(mesh.positions[i]);
    }
    return mesh;
}

}  // namespace rasterbook
