// SPDX-License-Identifier: MIT
/// @file
/// Lesson 06: light on the surfaces.
#include "04_mvp/camera.hpp"
#include "06_phong/assets.hpp"
#include "06_phong/studio_lights.hpp"
#include "06_phong/surface.hpp"
#include "common/app/lesson_app.hpp"
#include "common/image/backdrop.hpp"

using namespace rasterbook;

static Image<vec3> render(const PhongOptions& options, const PhongAssets& assets) {
    const auto& [scene, textures, effects] = assets;
    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    const std::array lights = studio_lights(options.shading.key_light, scene.bounds());
    Image<vec3> color = backdrop(options.size);
    DepthBuffer depth(options.size);

    const auto draw = [&](const ProjectedTriangle& projected) {
        const TriangleSurface surface =
            triangle_surface(scene, textures, effects[projected.triangle.material], projected);
        const PerspectiveSetup setup = perspective_setup(projected);

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
            const vec3 normal = interpolate(surface.normals_world, on_surface.here);
            const SurfacePoint<float> point =
                surface_point(surface, on_surface.here, normal, camera.position_world);
            const ReflectedLight reflected = reflected_light(lights, point, highlight_of(surface));
            color[pixel] = phong(base_color, ambient_light, reflected);
        });
    };
    for_each_visible_triangle(scene, clip_from_world, options.size, options.shading.culling(),
                              draw);
    if (options.show_depth) return depth_picture(depth);
    return color;
}

int main(int argc, char** argv) {
    return run_lesson<PhongOptions>(argc, argv, "06_phong", "Draws a scene with Phong lighting.",
                                    load_phong_scene, render);
}
