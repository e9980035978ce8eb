// SPDX-License-Identifier: MIT
#include "08_normal_maps/probe.hpp"

#include <array>
#include <cstddef>

#include "04_mvp/camera.hpp"
#include "04_mvp/probe.hpp"
#include "06_phong/report.hpp"
#include "06_phong/studio_lights.hpp"
#include "08_normal_maps/report.hpp"

namespace rasterbook {

PixelProbe normal_map_probe(const NormalMapSceneOptions& options, const NormalMapAssets& assets) {
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
        const vec3 normal =
            report_normal(report, triangle_normal_map(scene, assets.normal_maps, projected),
                          on_surface, interpolate(surface.normals_world, on_surface.here), filter);
        const SurfacePoint<float> point =
            surface_point(surface, on_surface.here, normal, camera.position_world);
        report_point(report, point, scene.origin);
        const std::array lights = studio_lights(options.shading.key_light, scene.bounds(), low_key);
        report_lights(report, lights, point, highlight_of(surface),
                      [](std::size_t) { return 1.0f; });
        return report_phong(report, base_color, ambient_light,
                            reflected_light(lights, point, highlight_of(surface)));
    };
}

}  // namespace rasterbook
