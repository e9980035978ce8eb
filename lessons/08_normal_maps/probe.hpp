// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?": normal maps in one pixel, in this lesson and all later ones, for `--probe`.
#pragma once

#include <array>
#include <cstddef>

#include "04_mvp/camera.hpp"
#include "04_mvp/probe.hpp"
#include "06_phong/probe.hpp"
#include "06_phong/studio_lights.hpp"
#include "06_phong/surface.hpp"
#include "08_normal_maps/assets.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "common/app/counters.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// Says what a normal map makes of a normal.
///
/// @param normal  Interpolated, not yet scaled.
/// @return        Of any length.
inline vec3 report_normal(PixelReport& report, const TriangleNormalMap& map,
                          const NormalMapVariant& variant, const FragmentBarycentrics& at,
                          vec3 normal, Filter filter) {
    if (map.texture == nullptr) return normal;
    NoCounters uncounted;
    report.line("normal, interpolated", normal, "Eq. 5.1");
    const FragmentUv uv = fragment_uv(map.uvs, at);
    report_sample(report, "normal map", *map.texture, filter, uv);
    report.line("  normal of the map", sample_normal(*map.texture, filter, uv), "Eq. 8.1");
    if (map.space == MapSpace::tangent) {
        const TangentBasis<float> frame = frame_at(map, variant, at.here, normal);
        report.line("  tangent", frame.tangent, "Eq. 8.5");
        report.line("  bitangent", frame.bitangent, "Eq. 8.5");
    }
    const vec3 mapped = normal_mapped(map, variant, at, normal, filter, uncounted);
    report.line("  normal, perturbed", mapped, "Eq. 8.7");
    return mapped;
}

/// Explains pixels of this lesson's picture.
///
/// @param options  With TextureOptions `texture`, LightOptions `shading` and NormalMapVariant
///                 `normal_map`. Both have to outlive the probe.
template <typename Options>
PixelProbe normal_map_probe(const Options& options, const NormalMapAssets& assets) {
    const Camera camera = orbit_camera(options.orbit, assets.scene.bounds());
    return [&options, &assets, camera,
            triangles = projected_triangles(assets.scene, camera.clip_from_world(options.size),
                                            options.size)](ivec2 pixel, PixelReport& report) {
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
        const vec3 normal = report_normal(
            report, triangle_normal_map(options.normal_map, scene, assets.normal_maps, projected),
            options.normal_map, on_surface, interpolate(surface.normals_world, on_surface.here),
            filter);
        const SurfacePoint<float> point =
            surface_point(surface, on_surface.here, normal, camera.position_world, uncounted);
        report_point(report, point);
        const std::array lights = studio_lights(options.shading.key_light, scene.bounds(), low_key);
        report_lights(report, lights, point, highlight_of(surface),
                      [](std::size_t) { return 1.0f; });
        return report_phong(report, base_color, ambient_light,
                            reflected_light(lights, point, highlight_of(surface)));
    };
}

}  // namespace rasterbook
