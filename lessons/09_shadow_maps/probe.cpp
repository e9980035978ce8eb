// SPDX-License-Identifier: MIT
#include "09_shadow_maps/probe.hpp"

#include <array>
#include <cstddef>
#include <memory>

#include "04_mvp/camera.hpp"
#include "04_mvp/probe.hpp"
#include "06_phong/report.hpp"
#include "06_phong/studio_lights.hpp"
#include "08_normal_maps/report.hpp"
#include "09_shadow_maps/report.hpp"

namespace rasterbook {

PixelProbe shadow_probe(const ShadowSceneOptions& options, const ShadowAssets& assets) {
    const Camera camera = orbit_camera(options.orbit, assets.scene.bounds());
    const std::array lights = raking_lights(options.shading.key_light, assets.scene.bounds());
    return [&options, &assets, camera, lights,
            triangles = projected_triangles(assets.scene, camera.clip_from_world(options.size),
                                            options.size),
            shadow_maps = std::make_shared<const ShadowMaps>(draw_shadow_maps(
                options.shadow, {assets.scene, assets.shadow_bounds, lights,
                                 options.shading.all_effects}))](ivec2 pixel, PixelReport& report) {
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
        const vec3 smooth_normal = interpolate(surface.normals_world, on_surface.here);
        const vec3 normal =
            report_normal(report, triangle_normal_map(scene, assets.normal_maps, projected),
                          on_surface, smooth_normal, filter);
        const SurfacePoint<float> point =
            surface_point(surface, on_surface.here, normal, camera.position_world);
        report_point(report, point, scene.origin);
        ShadowBiasCache shadow_biases(surface.positions_world);
        report_lights(report, lights, point, highlight_of(surface), [&](std::size_t l) {
            return report_visibility(report, *shadow_maps, l, shadow_biases, point.position_world,
                                     smooth_normal);
        });
        const auto visibility = [&](std::size_t l) {
            return light_visibility(*shadow_maps, l, shadow_biases, point.position_world,
                                    smooth_normal);
        };
        return report_phong(report, base_color, ambient_light,
                            reflected_light(lights, point, highlight_of(surface), visibility));
    };
}

}  // namespace rasterbook
