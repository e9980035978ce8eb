// SPDX-License-Identifier: MIT
/// @file
/// Lesson 07: light in tones, and outlines.
#include "04_mvp/camera.hpp"
#include "06_phong/studio_lights.hpp"
#include "06_phong/surface.hpp"
#include "07_toon/assets.hpp"
#include "common/app/lesson_app.hpp"
#include "common/image/backdrop.hpp"

using namespace rasterbook;

static Image<vec3> render(const ToonOptions& options, const ToonAssets& assets) {
    const auto& [scene, textures, effects, hull_normals] = assets;
    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    const std::array lights = studio_lights(options.shading.key_light, scene.bounds());
    Image<vec3> color(options.size, paper_color);
    DepthBuffer depth(options.size);
    Image<vec3> normals;
    if (options.shading.outline == Outline::edges) normals = Image<vec3>(options.size, vec3(0));

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
            color[pixel] = unlit(base_color);
            if (surface.effects[Effect::light]) {
                count(Counter::toon_fragments);
                const vec3 normal = interpolate(surface.normals_world, on_surface.here);
                const SurfacePoint<float> point =
                    surface_point(surface, on_surface.here, normal, camera.position_world);
                const ReflectedLight reflected =
                    reflected_light(lights, point, highlight_of(surface));
                color[pixel] =
                    toon(base_color, toon_ambient_light, reflected, options.shading.tones);
            }
            add_to_outline(options.shading, surface, on_surface.here, camera.position_world, pixel,
                           normals, color);
        });
    };
    for_each_visible_triangle(scene, clip_from_world, options.size, options.shading.culling(),
                              draw);
    draw_outlines(options.shading, scene, hull_normals, camera, options.samples_per_side, normals,
                  depth, color);
    if (options.show_depth) return depth_picture(depth);
    return color;
}

int main(int argc, char** argv) {
    return run_lesson<ToonOptions>(argc, argv, "07_toon", "Draws a scene as a comic does.",
                                   load_toon_scene, render);
}
