// SPDX-License-Identifier: MIT
/// @file
/// Toon materials of a file: a lit colour and a shade. Drawn from lesson 11 on; explained in
/// lessons/07_toon/toon_materials.md.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "06_phong/light.hpp"
#include "06_phong/phong.hpp"
#include "07_toon/toon.hpp"
#include "common/app/counters.hpp"
#include "common/math/functions.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// How much of the lit colour a light gives, before shadows: 0 to 1 (Eq. 7.15).
///
/// @param cosine  Of the angle between normal and light. NaN counts as no light.
template <typename F>
F toon_step(F cosine, const ToonMaterial& look) {
    const F turned = cosine + F(look.shift);
    const float half_width = 1 - look.toony;
    if (half_width <= 0) return select(turned >= F(0.0f), F(1.0f), F(0.0f));
    return clamp((turned + F(half_width)) / F(2 * half_width), F(0.0f), F(1.0f));
}

/// The level of light on a point: 0 is its colour in the shade, 1 its lit one (Eq. 7.16).
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

/// Notes for `--probe` how much of each light counts, before shadows.
template <typename F>
void trace_toon_lights(std::span<const Light> lights, const Vec3<F>& position_world,
                       const Vec3<F>& normal_world, const ToonMaterial& look) {
    if (!is_traced()) return;
    for (std::size_t l = 0; l < lights.size(); ++l) {
        const Incoming<F> incoming = incoming_light(lights[l], position_world);
        const F cosine = glm::dot(unit_or(normal_world, Vec3<F>(F(0.0f))), incoming.toward);
        trace(("light " + std::to_string(l + 1)).c_str(), incoming.color);
        trace("  cosine", cosine, "Eq. 6.1");
        trace("  step", toon_step(cosine, look), "Eq. 7.15");
    }
}

/// The colour of a fragment of a toon material.
///
/// @param color                         Its `ambient` is the colour in the shade.
/// @param position_world,normal_world,share  As toon_level() takes them.
template <typename F, typename Share>
Vec3<F> toon_color(const FragmentColor<F>& color, std::span<const Light> lights,
                   Vec3<F> position_world, Vec3<F> normal_world, const ToonMaterial& look,
                   Share&& share) {
    count_each<F>(Counter::toon_fragments);
    trace_toon_lights(lights, position_world, normal_world, look);
    const F level = toon_level(lights, position_world, normal_world, look, share);
    trace("shade", color.ambient);
    trace("lit", color.diffuse);
    trace("level", level, "Eq. 7.16");
    return color.emission + toon_paint(color.ambient, color.diffuse, level);
}

}  // namespace rasterbook
