// SPDX-License-Identifier: MIT
/// @file
/// What "Why this pixel?" says of light, in this lesson and all later ones, for `--probe`.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "04_mvp/probe.hpp"
#include "05_textures/interpolation.hpp"
#include "05_textures/probe.hpp"
#include "06_phong/surface.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// What a fragment has before light falls on it.
struct SeenSurface {
    TriangleSurface surface;
    FragmentBarycentrics on_surface;
    SurfaceColor base_color;
};

/// Says which colours a surface has in a fragment.
inline SeenSurface report_surface(PixelReport& report, const SeenFragment& seen,
                                  const TriangleSurface& surface, Filter filter) {
    const FragmentBarycentrics at =
        perspective_correct(perspective_setup(*seen.projected), seen.on_screen);
    report_perspective(report, *seen.projected, at);
    if (surface.effects[Effect::texture]) {
        report.line("diffuse of material", surface.own_color.diffuse);
        report_sample(report, "texture", *surface.texture, filter, fragment_uv(surface.uvs, at));
    }
    if (surface.effects[Effect::specular_map])
        report_sample(report, "specular texture", *surface.specular_texture, filter,
                      fragment_uv(surface.specular_uvs, at));
    if (surface.effects[Effect::emission_map])
        report_sample(report, "emission texture", *surface.emission_texture, filter,
                      fragment_uv(surface.emission_uvs, at));
    const SurfaceColor color = surface_color(surface, at, filter);
    report.line("diffuse colour", color.diffuse);
    if (surface.effects[Effect::highlight]) report.line("specular colour", color.specular);
    if (color.emission != vec3(0)) report.line("emission", color.emission);
    return {surface, at, color};
}

/// Says where the light of a fragment is computed, and with which normal.
///
/// @param origin  Of the scene: the world position of what is 0 in it.
inline void report_point(PixelReport& report, const SurfacePoint<float>& point, dvec3 origin) {
    report.line("position in the world", words(origin + dvec3(point.position_world)), "Eq. 5.1");
    report.line("normal", point.normal_world, "Eq. 6.8");
}

/// Says what each light adds to a fragment.
///
/// @param visibility  Called as visibility(l), the number of a light: may say more.
template <typename Highlight, typename Visibility>
void report_lights(PixelReport& report, std::span<const Light> lights,
                   const SurfacePoint<float>& point, const Highlight& highlight,
                   const Visibility& visibility) {
    constexpr std::array kinds = {"directional light", "point light", "spotlight"};
    for (std::size_t l = 0; l < lights.size(); ++l) {
        const Light& light = lights[l];
        const Incoming<float> incoming = incoming_light(light, point.position_world);
        const float cosine = glm::dot(point.normal_world, incoming.toward);
        report.line(("light " + std::to_string(l + 1)).c_str(),
                    kinds[static_cast<std::size_t>(light.kind)]);
        report.line("  arriving", incoming.color,
                    light.kind == LightKind::directional ? ""
                    : light.kind == LightKind::point     ? "Eq. 6.6"
                                                         : "Eq. 6.6 and 6.7");
        report.line("  cosine", words(cosine) + (cosine > 0 ? "" : ": turned away"), "Eq. 6.1");
        if (!(cosine > 0)) continue;
        if (highlight.is_on)
            report.line("  highlight",
                        words(highlight(point, incoming.toward)) + ", shininess " +
                            words(highlight.shininess),
                        "Eq. 6.3");
        LightSum<float> added;
        add_light(added, light, point, [&] { return visibility(l); }, highlight);
        report.line("  adds diffuse", added.diffuse);
        if (added.specular != vec3(0)) report.line("  adds specular", added.specular);
    }
}

/// Says what a fragment sends to the eye.
inline vec3 report_phong(PixelReport& report, const SurfaceColor& color, vec3 ambient,
                         const ReflectedLight& light) {
    report.line("ambient light", ambient);
    report.line("diffuse light", light.diffuse);
    report.line("specular light", light.specular);
    const vec3 sum = phong(color, ambient, light);
    report.line("sum", sum, "Eq. 6.5");
    return sum;
}

/// Says that a fragment has its colour whatever the light.
inline vec3 report_unlit(PixelReport& report, const SurfaceColor& color) {
    report.line("light", "none: the material is unlit");
    return unlit(color);
}

}  // namespace rasterbook
