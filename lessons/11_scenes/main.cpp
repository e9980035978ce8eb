// SPDX-License-Identifier: MIT
/// @file
/// Lesson 11: scenes of any file.
#include "06_phong/studio_lights.hpp"
#include "07_toon/toon_material.hpp"
#include "11_scenes/camera_choice.hpp"
#include "11_scenes/casters.hpp"
#include "11_scenes/opacity.hpp"
#include "11_scenes/passes.hpp"
#include "common/app/lesson_app.hpp"

using namespace rasterbook;

static Image<vec3> render(const SceneOptions& options, const SceneAssets& assets, Workers& pool) {
    const Scene& scene = assets.scene;
    const Camera camera = camera_of_picture(options, scene).camera;
    const std::span<const Light> lights = assets.lit_by.lights;
    const ShadowMaps shadow_maps = draw_shadow_maps(pool, options, assets);
    Image<vec3> color(options.size, unset);
    DepthBuffer depth(options.size, unset, camera.farthest_depth());

    const auto draw = [&](const ProjectedTriangle& projected, const Tile& tile,
                          TransparentFragments& transparent) {
        const TriangleSurface surface = triangle_surface(assets, projected);
        const VertexColors colors = vertex_colors(projected);
        const PerspectiveSetup setup = perspective_setup(projected);
        const TriangleNormalMap normal_map =
            triangle_normal_map(scene, assets.normal_maps, projected);
        ShadowBiasCache shadow_biases(surface.positions_world);

        fill_tile(projected.on_screen, tile, [&](ivec2 pixel, Barycentrics on_screen) {
            count(Counter::fragments_tested);
            const float z = projected.depth.at(on_screen);
            if (!is_nearer(depth, pixel, z)) return;
            const FragmentBarycentrics on_surface = perspective_correct(setup, on_screen);
            const vec4 in_texture = texture_sample(surface, on_surface, options.texture.filter);
            const float opacity = opacity_at(surface, colors, on_surface.here, in_texture);
            if (is_hole(surface, opacity)) return;
            count(Counter::fragments_shaded);
            const auto write = [&](vec3 shaded) {
                if (surface.effects[Effect::blend]) {
                    transparent.add({pixel, z, opacity, shaded});
                    return;
                }
                depth.test_and_write(pixel, z);
                color[pixel] = shaded;
            };
            const SurfaceColor base_color = surface_color(surface, colors, on_surface,
                                                          vec3(in_texture), options.texture.filter);
            if (!surface.effects[Effect::light]) return write(unlit(base_color));
            const vec3 smooth_normal = interpolate(surface.normals_world, on_surface.here);
            const vec3 normal =
                normal_mapped(normal_map, on_surface, smooth_normal, options.texture.filter);
            const SurfacePoint<float> point =
                surface_point(surface, on_surface.here, normal, camera.position_world);
            const auto visibility = [&](std::size_t light) {
                return light_visibility(shadow_maps, light, shadow_biases, point.position_world,
                                        smooth_normal);
            };
            if (surface.material.toon)
                return write(toon_color(base_color, lights, point.position_world, normal,
                                        *surface.material.toon, visibility));
            const ReflectedLight reflected =
                reflected_light(lights, point, highlight_of(surface), visibility);
            write(phong(base_color, ambient_light, reflected));
        });
    };
    const Tiling tiling = options.threads.tiling_of(options.size, pool.size());
    const BinnedPasses triangles(pool, assets, camera, tiling);
    pool.run(tiling.count(), [&](std::size_t i, std::size_t worker) {
        const Tile tile = tiling[i];
        clear_tile(assets, color, depth, tile);
        TransparentFragments transparent;
        triangles.for_each_opaque_in(
            i, [&](const ProjectedTriangle& projected) { draw(projected, tile, transparent); });
        for_each_part(tile, triangles.count_blended_in(i), [&](const Tile& part) {
            triangles.for_each_blended_in(
                i, [&](const ProjectedTriangle& projected) { draw(projected, part, transparent); });
            transparent.blend_over(color);
        });
        if (options.threads.show) tint(color, tile, worker);
    });
    if (options.show_depth) return depth_picture(depth);
    return color;
}

int main(int argc, char** argv) {
    return run_lesson<SceneOptions>(
        argc, argv, "11_scenes",
        "Draws a scene of any file, with its cameras, lights, holes and glass.", load_scene_assets,
        [](const auto& options, const auto& assets) {
            return render(options, assets, kept_pool(options.threads.threads));
        });
}
