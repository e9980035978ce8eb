// SPDX-License-Identifier: MIT
#include "06_phong/probe.hpp"

#include <array>
#include <cstddef>

#include "04_mvp/camera.hpp"
#include "04_mvp/probe.hpp"
#include "06_phong/report.hpp"
#include "06_phong/studio_lights.hpp"

namespace rasterbook {

PixelProbe phong_probe(const PhongProbeOptions& options, const PhongAssets& assets) {
    const Camera camera = orbit_camera(options.orbit, assets.scene.bounds());
    return [options, &assets, camera,
            triangles = projected_triangles(assets.scene, camera.clip_from_world(options.size),
                                            options.size)](ivec2 pixel, PixelReport& report) {
        const Scene& scene = assets.scene;
        const ShadingVariant& shading = options.shading;
        const auto seen = report_triangles(report, triangles, shading.culling(), scene, pixel);
        if (!seen) return report_backdrop(report, pixel, options.size);
        const ProjectedTriangle& projected = *seen->projected;
        const EffectMask effects = assets.effects[projected.triangle.material];
        const auto [surface, on_surface, base_color] = report_surface(
            report, *seen, triangle_surface(scene, assets.textures, effects, projected),
            options.texture.filter);
        if (!effects[Effect::light]) return report_unlit(report, base_color);
        const std::array lights = studio_lights(shading.key_light, scene.bounds());
        const VertexLighting at_vertices =
            light_vertices(shading, lights, camera.position_world, surface, projected);
        if (at_vertices.is_used()) {
            report.line("light", "computed for the face or its vertices");
            return report_phong(report, base_color, ambient_light, at_vertices.at(on_surface.here));
        }
        const vec3 normal = interpolate(surface.normals_world, on_surface.here);
        SurfacePoint<float> point =
            surface_point(surface, on_surface.here, normal, camera.position_world);
        scale_normal(shading, normal, point);
        report_point(report, point, scene.origin);
        const VariantHighlight highlight = highlight_of(shading, surface);
        report_lights(report, lights, point, highlight, [](std::size_t) { return 1.0f; });
        return report_phong(report, base_color, ambient_light,
                            reflected_light(lights, point, highlight));
    };
}

}  // namespace rasterbook
