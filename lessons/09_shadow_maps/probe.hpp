// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?": shadows in one pixel, in this lesson and all later ones, for `--probe`.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>

#include "04_mvp/camera.hpp"
#include "04_mvp/probe.hpp"
#include "06_phong/probe.hpp"
#include "06_phong/studio_lights.hpp"
#include "06_phong/surface.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "08_normal_maps/probe.hpp"
#include "09_shadow_maps/assets.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "common/app/counters.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// Says which depths a shadow test compares.
///
/// @param map       The map's number, counted through all lights.
/// @param receiver  With the bias that has been fitted to it for this map.
inline void report_shadow_test(PixelReport& report, const ShadowMaps& shadow_maps, std::size_t l,
                               std::size_t map, const TriangleReceiver& receiver,
                               const PcfKernel& kernel) {
    const LightShadowMaps& of_light = shadow_maps.of_light[l];
    const ShadowMap& asked = of_light.maps[map - of_light.first_map];
    const float in_map = asked.depths.depths()[kernel.middle + max_pcf_radius];
    report.line("  shadow map",
                "texel " + words(kernel.middle) + " of " + std::to_string(asked.size) + "x" +
                    std::to_string(asked.size),
                "Eq. 9.6");
    for (const auto& bias : receiver.biases[map])
        if (bias) report.line("  bias", bias->bias, "Eq. 9.10");
    const float depth = std::min(kernel.depth, DepthBuffer::cleared);
    report.line(
        "  depths compared",
        words(depth, 7) + (depth <= in_map ? " is not behind " : " is behind ") + words(in_map, 7),
        "Eq. 9.7");
    const int side = 2 * shadow_maps.radius + 1;
    const float lit = pcf_visibility(asked, shadow_maps.radius, kernel);
    report.line("  taps that say lit",
                std::to_string(std::lrint(lit * static_cast<float>(side * side))) + " of " +
                    std::to_string(side * side),
                "Eq. 9.13");
}

/// Says how much of a light reaches a point of a triangle, and why.
inline float report_visibility(PixelReport& report, const ShadowMaps& shadow_maps, std::size_t l,
                               TriangleReceiver& receiver, vec3 position, vec3 normal) {
    NoCounters uncounted;
    bool is_tested = false;
    const float visibility =
        light_visibility(shadow_maps, l, receiver, position, normal, uncounted,
                         [&](std::size_t map, const PcfKernel& kernel) {
                             is_tested = true;
                             report_shadow_test(report, shadow_maps, l, map, receiver, kernel);
                         });
    if (is_tested)
        report.line("  visibility", visibility, "Eq. 9.16");
    else
        report.line("  visibility",
                    words(visibility) + (shadow_maps.of_light[l].maps.empty()
                                             ? ": the light casts no shadows"
                                         : visibility == 0 ? ": the surface is turned away"
                                                           : ": outside of the shadow map"));
    return visibility;
}

/// Explains pixels of the pictures of this lesson and lesson 10, which are the same.
///
/// @param options  With TextureOptions `texture`, LightOptions `shading`, NormalMapVariant
///                 `normal_map` and ShadowVariant `shadow`. Both have to outlive the probe.
template <typename Options>
PixelProbe shadow_probe(const Options& options, const ShadowAssets& assets) {
    const Camera camera = orbit_camera(options.orbit, assets.scene.bounds());
    const std::array lights = raking_lights(options.shading.key_light, assets.scene.bounds());
    NoCounters unused;
    return [&options, &assets, camera, lights,
            triangles = projected_triangles(assets.scene, camera.clip_from_world(options.size),
                                            options.size),
            shadow_maps = std::make_shared<const ShadowMaps>(draw_shadow_maps(
                options.shadow, options.shading.all_effects, assets.scene, assets.shadow_bounds,
                lights, unused))](ivec2 pixel, PixelReport& report) {
        const Scene& scene = assets.scene;
        const Filter filter = options.texture.filter;
        const auto seen =
            report_triangles(report, triangles, options.shading.culling(), scene, pixel);
        if (!seen) return report_backdrop(report, pixel, options.size);
        const ProjectedTriangle& projected = *seen->projected;
        const EffectMask effects = assets.effects[projected.triangle.material];
        const auto [surface, on_surface, base_color] = report_surface(
            report, *seen, triangle_surface(scene, assets.textures, effects, projected), filter);
        if (!effects[Effect::light]) return report_unlit(report, base_color);
        NoCounters uncounted;
        const vec3 smooth_normal = interpolate(surface.normals_world, on_surface.here);
        const vec3 normal = report_normal(
            report, triangle_normal_map(options.normal_map, scene, assets.normal_maps, projected),
            options.normal_map, on_surface, smooth_normal, filter);
        const SurfacePoint<float> point =
            surface_point(surface, on_surface.here, normal, camera.position_world, uncounted);
        report_point(report, point);
        TriangleReceiver receiver = triangle_receiver(surface.positions_world);
        report_lights(report, lights, point, highlight_of(surface), [&](std::size_t l) {
            return report_visibility(report, *shadow_maps, l, receiver, point.position_world,
                                     smooth_normal);
        });
        const auto visibility = [&](std::size_t l) {
            return light_visibility(*shadow_maps, l, receiver, point.position_world, smooth_normal,
                                    uncounted);
        };
        return report_phong(report, base_color, ambient_light,
                            reflected_light(lights, point, highlight_of(surface), visibility));
    };
}

}  // namespace rasterbook
