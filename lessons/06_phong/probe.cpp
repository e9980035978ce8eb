// SPDX-License-Identifier: MIT
#include "06_phong/probe.hpp"

#include <array>
#include <cstddef>

#include "04_mvp/camera.hpp"
#include "04_mvp/probe.hpp"
#include "06_phong/report.hpp"
#include "06_phong/studio_lights.hpp"

namespace rasterbook {

PixelProbe phong_probe(const PhongOptions& options, const PhongAssets& assets) {
    const Camera camera = orbit_camera(options.orbit, assets.scene.bounds());
    return [&options, &assets, camera,
            triangles = projected_triangles(assets.scene, camera.clip_from_world(options.size),
                                            options.size)](ivec2 pixel, PixelReport& report) {
        const Scene& scene = assets.scene;
        const auto seen =
            report_triangles(report, triangles, options.shading.culling(), scene, pixel);
        if (!seen) return report_backdrop(report, pixel, options.size);
        const ProjectedTriangle& projected = *seen->projected;
        const EffectMask effects = assets.effects[projected.triangle.material];
        const auto [surface, on_surface, base_color] = report_surface(
            report, *seen, triangle_surface(scene, assets.textures, effects, projected),
            options.texture.filter);
        if (!effects[Effect::light]) return report_unlit(report, base_color);
        const std::array lights = studio_lights(options.shading.key_light, scene.bounds());
        const vec3 normal = interpolate(surface.normals_world, on_surface.here);
        const SurfacePoint<float> point =
            surface_point(surface, on_surface.here, normal, camera.position_world);
        report_point(report, point, scene.origin);
        report_lights(report, lights, point, highlight_of(surface),
                      [](std::size_t) { return 1.0f; });
        return report_phong(report, base_color, ambient_light,
                            reflected_light(lights, point, highlight_of(surface)));
    };
}

}  // namespace rasterbook
