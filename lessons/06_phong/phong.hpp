// SPDX-License-Identifier: MIT
/// @file
/// How much light a surface sends to the eye. Introduced in lesson 06;
/// derivation: docs/derivations/06_phong.md.
#pragma once

#include <cstddef>
#include <span>

#include "06_phong/light.hpp"
#include "common/math/functions.hpp"
#include "common/model/mesh.hpp"
#include "common/probe/traced_light.hpp"

namespace rasterbook {

/// The direction into which a mirror sends light that comes from `toward_light` (Eq. 6.2).
///
/// @param normal,toward_light  Length 1.
template <typename F>
Vec3<F> reflected(Vec3<F> normal, Vec3<F> toward_light) {
    return F(2.0f) * glm::dot(normal, toward_light) * normal - toward_light;
}

/// A point of a surface, and who looks at it.
template <typename F>
struct SurfacePoint {
    Vec3<F> position_world;
    Vec3<F> normal_world;  ///< Length 1.
    Vec3<F> toward_eye;    ///< Length 1; of no meaning where there is no highlight.
};

/// The cosine that Phong's highlight is a power of: 0 to 1 (Eq. 6.3).
template <typename F>
F phong_cosine(const SurfacePoint<F>& point, Vec3<F> toward_light) {
    const Vec3<F> mirrored = reflected(point.normal_world, toward_light);
    // Not above 1 by rounding: with a great exponent, the power of that would be infinite.
    return clamp(glm::dot(mirrored, point.toward_eye), F(0.0f), F(1.0f));
}

/// A highlight darker than this counts as 0. Nobody could see it, and products with colours stay
/// far from subnormal numbers, with which processors are slow.
constexpr float min_highlight = 0x1p-26f;

/// Phong's highlight (Eq. 6.3): the cosine between the mirrored light and the eye, to a power.
struct PhongHighlight {
    bool is_on;       ///< Whether the material has one.
    float shininess;  ///< The power, Ns, >= 0.

    /// @return  0 to 1. What lies behind the surface is not asked here but by add_light().
    template <typename F>
    F operator()(const SurfacePoint<F>& point, Vec3<F> toward_light) const {
        const F highlight = power(phong_cosine(point, toward_light), F(shininess));
        return select(highlight < F(min_highlight), F(0.0f), highlight);
    }
};

/// What a surface sends to the eye, before it is coloured by the material.
template <typename F>
struct LightSum {
    Vec3<F> diffuse{F(0.0f)};
    Vec3<F> specular{F(0.0f)};
};
using ReflectedLight = LightSum<float>;

/// Adds one light: diffuse (Eq. 6.1), and as a highlight (Eq. 6.3). A surface that is turned away,
/// N.L <= 0, gets nothing.
///
/// @param visibility  Called as visibility(), and only where the light counts: where N.L > 0 and
///                    some of it arrives. 0 to 1: how much of it reaches the point. For several
///                    points at once, as visibility(mask).
/// @param highlight   PhongHighlight, or another that is called as it is.
template <typename F, typename Visibility, typename Highlight>
void add_light(LightSum<F>& sum, const Light& light, const SurfacePoint<F>& point,
               const Visibility& visibility, const Highlight& highlight) {
    const Incoming<F> incoming = incoming_light(light, point.position_world);
    const F cosine = glm::dot(point.normal_world, incoming.toward);
    const F brightest = max(max(incoming.color.x, incoming.color.y), incoming.color.z);
    const auto is_lit = min(brightest, cosine) > F(0.0f);
    if (!any_of(is_lit)) return;
    const Vec3<F> arriving = call_where(is_lit, visibility) * incoming.color;
    sum.diffuse += select(is_lit, cosine, F(0.0f)) * arriving;
    if (!highlight.is_on) return;
    sum.specular += select(is_lit, highlight(point, incoming.toward), F(0.0f)) * arriving;
}

/// The light of all lights.
///
/// @param visibility  Called as visibility(l), the number of a light, where add_light() asks for
/// it.
template <typename F, typename Highlight, typename Visibility>
LightSum<F> reflected_light(std::span<const Light> lights, const SurfacePoint<F>& point,
                            const Highlight& highlight, const Visibility& visibility) {
    LightSum<F> sum;
    for (std::size_t l = 0; l < lights.size(); ++l) {
        const TracedLight traced(l, lights[l], point, highlight, sum);
        add_light(
            sum, lights[l], point, [&](auto... mask) { return F(visibility(l, mask...)); },
            highlight);
    }
    return sum;
}

/// The light of all lights that a point reflects, with nothing in between.
template <typename F, typename Highlight>
LightSum<F> reflected_light(std::span<const Light> lights, const SurfacePoint<F>& point,
                            const Highlight& highlight) {
    return reflected_light(lights, point, highlight, [](auto...) { return 1.0f; });
}

/// The colours of a surface in one fragment; linear.
template <typename F>
struct FragmentColor {
    Vec3<F> ambient, diffuse, specular, emission;

    /// One colour for several pixels at once.
    template <typename G>
    explicit operator FragmentColor<G>() const {
        return {Vec3<G>(ambient), Vec3<G>(diffuse), Vec3<G>(specular), Vec3<G>(emission)};
    }

    /// Tints diffuse and ambient light alike: it is the same surface for both.
    void tint(Vec3<F> color) { ambient *= color, diffuse *= color; }
};
using SurfaceColor = FragmentColor<float>;

/// A material's own colours. Of the ambient light it reflects at most as much as of a light's: many
/// exporters write Ka = 1 for everything.
inline SurfaceColor surface_color(const Material& material) {
    return {glm::min(material.ambient, material.diffuse), material.diffuse, material.specular,
            material.emission};
}

/// What a fragment of illum 0 sends to the eye: its colour, whatever the light.
template <typename F>
Vec3<F> unlit(const FragmentColor<F>& color) {
    return color.emission + color.diffuse;
}

/// All the light that a fragment sends to the eye (Eq. 6.5); it may exceed 1.
///
/// @param color     Each number from -1e37 to 1e37; of greater ones the sum may be infinite.
/// @param ambient   Ambient light, 0 to 1.
/// @param light     0 to 10.
template <typename F>
Vec3<F> phong(const FragmentColor<F>& color, vec3 ambient, const LightSum<F>& light) {
    trace_sum(ambient, light);
    return color.emission + color.ambient * Vec3<F>(ambient) + color.diffuse * light.diffuse +
           color.specular * light.specular;
}

}  // namespace rasterbook
