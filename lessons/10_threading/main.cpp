// SPDX-License-Identifier: MIT
/// @file
/// Lesson 10: threads.
#include "04_mvp/camera.hpp"
#include "06_phong/studio_lights.hpp"
#include "06_phong/surface.hpp"
#include "10_threading/binned_triangles.hpp"
#include "10_threading/thread_options.hpp"
#include "10_threading/threaded_shadows.hpp"
#include "common/app/lesson_app.hpp"

using namespace rasterbook;

static Image<vec3> render(const ThreadedSceneOptions& options, const ShadowAssets& assets,
                          Workers& pool) {
    const auto& [scene, textures, normal_maps, effects, shadow_bounds] = assets;
    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    const std::array lights = raking_lights(options.shading.key_light, scene.bounds());
    const ShadowMaps shadow_maps =
        draw_shadow_maps(pool, options.threads, options.shadow,
                         {scene, shadow_bounds, lights, options.shading.all_effects});
    Image<vec3> color(options.size, unset);
    DepthBuffer depth(options.size, unset);

    const auto draw = [&](const ProjectedTriangle& projected, const Tile& tile) {
        const TriangleSurface surface =
            triangle_surface(scene, textures, effects[projected.triangle.material], projected);
        const PerspectiveSetup setup = perspective_setup(projected);
        const TriangleNormalMap normal_map = triangle_normal_map(scene, normal_maps, projected);
        ShadowBiasCache shadow_biases(surface.positions_world);

        fill_tile(projected.on_screen, tile, [&](ivec2 pixel, Barycentrics on_screen) {
            count(Counter::fragments_tested);
            if (!depth.test_and_write(pixel, projected.depth.at(on_screen))) return;
            count(Counter::fragments_shaded);
            const FragmentBarycentrics on_surface = perspective_correct(setup, on_screen);
            const SurfaceColor base_color =
                surface_color(surface, on_surface, options.texture.filter);
            if (!surface.effects[Effect::light]) {
                color[pixel] = unlit(base_color);
                return;
            }
            const vec3 smooth_normal = interpolate(surface.normals_world, on_surface.here);
            const vec3 normal =
                normal_mapped(normal_map, on_surface, smooth_normal, options.texture.filter);
            const SurfacePoint<float> point =
                surface_point(surface, on_surface.here, normal, camera.position_world);
            const auto visibility = [&](std::size_t light) {
                return light_visibility(shadow_maps, light, shadow_biases, point.position_world,
                                        smooth_normal);
            };
            const ReflectedLight reflected =
                reflected_light(lights, point, highlight_of(surface), visibility);
            color[pixel] = phong(base_color, ambient_light, reflected);
        });
    };
    const Tiling tiling = options.threads.tiling_of(options.size, pool.size());
    const BinnedTriangles triangles(pool, scene, meshes_in_view(scene, clip_from_world),
                                    clip_from_world, tiling, options.shading.culling());
    pool.run(tiling.count(), [&](std::size_t i, std::size_t worker) {
        const Tile tile = tiling[i];
        clear_tile(color, depth, tile);
        triangles.for_each_in(i,
                              [&](const ProjectedTriangle& projected) { draw(projected, tile); });
        if (options.threads.show) tint(color, tile, worker);
    });
    if (options.show_depth) return depth_picture(depth);
    return color;
}

int main(int argc, char** argv) {
    return run_lesson<ThreadedSceneOptions>(
        argc, argv, "10_threading", "Draws the same picture with several threads.",
        load_shadow_scene, [](const auto& options, const auto& assets) {
            return render(options, assets, kept_pool(options.threads.threads));
        });
}
