// SPDX-License-Identifier: MIT
/// @file
/// Lesson 09: shadows.
#include "04_mvp/camera.hpp"
#include "06_phong/studio_lights.hpp"
#include "06_phong/surface.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "09_shadow_maps/assets.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "common/app/lesson_app.hpp"
#include "common/image/backdrop.hpp"

using namespace rasterbook;

static Image<vec3> render(const ShadowSceneOptions& options, const ShadowAssets& assets) {
    const auto& [scene, textures, normal_maps, effects, shadow_bounds] = assets;
    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    const std::array lights = raking_lights(options.shading.key_light, scene.bounds());
    const ShadowMaps shadow_maps = draw_shadow_maps(
        options.shadow, {scene, shadow_bounds, lights, options.shading.all_effects});
    Image<vec3> color = backdrop(options.size);
    DepthBuffer depth(options.size);

    const auto draw = [&](const ProjectedTriangle& projected) {
        const TriangleSurface surface =
            triangle_surface(scene, textures, effects[projected.triangle.material], projected);
        const PerspectiveSetup setup = perspective_setup(projected);
        const TriangleNormalMap normal_map = triangle_normal_map(scene, normal_maps, projected);
        ShadowBiasCache shadow_biases(surface.positions_world);

        fill_triangle(projected.on_screen, options.size, [&](ivec2 pixel, Barycentrics on_screen) {
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
    for_each_visible_triangle(scene, clip_from_world, options.size, options.shading.culling(),
                              draw);
    if (options.show_depth) return depth_picture(depth);
    return color;
}

int main(int argc, char** argv) {
    return run_lesson<ShadowSceneOptions>(
        argc, argv, "09_shadow_maps", "Draws a scene with shadow maps.", load_shadow_scene, render);
}
