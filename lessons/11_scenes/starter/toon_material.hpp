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
    // TODO: Eq. 11.4. What becomes of NaN, and of a border of no width?
    return select(cosine > F(0.0f), F(1.0f), F(0.0f));
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
    // TODO: Eq. 11.5. incoming_light() and brightness() help, and call_where(counts, share, l).
    return F(1.0f);
}

/// From the colour in the shade to the lit one. Where both are equal, it is exactly that colour.
template <typename F>
Vec3<F> toon_paint(Vec3<F> shade, Vec3<F> lit, F level) {
    // TODO: Eq. 11.5.
    return lit;
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
    // TODO: Eq. 11.6, before the bounds are found.
    mesh.bounds = {};
    for (const vec3 position : mesh.positions) mesh.bounds.add(position);
    return mesh;
}

}  // namespace rasterbook
