// SPDX-License-Identifier: MIT
/// @file
/// Lesson 05: textures on the surfaces.
#include "02_triangle_fill/flat_color.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/projection.hpp"
#include "05_textures/load_textures.hpp"
#include "05_textures/textures.hpp"
#include "common/app/lesson_app.hpp"
#include "common/image/backdrop.hpp"

using namespace rasterbook;

static Image<vec3> render(const TexturedSceneOptions& options, const TexturedScene& assets) {
    const auto& [scene, textures] = assets;
    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    Image<vec3> color = backdrop(options.size);
    DepthBuffer depth(options.size);

    const auto draw = [&](const ProjectedTriangle& projected) {
        const Material& material = scene.materials[projected.triangle.material];
        const vec3 face_color = flat_color(projected.mesh, projected.triangle, material);
        const Texture* const texture = textures[projected.triangle.material].get();
        const std::array<vec2, 3> uvs =
            uvs_of(projected.mesh, projected.triangle, material.diffuse_map, texture);
        const PerspectiveSetup setup = perspective_setup(projected);

        fill_triangle(projected.on_screen, options.size, [&](ivec2 pixel, Barycentrics on_screen) {
            count(Counter::fragments_tested);
            if (!depth.test_and_write(pixel, projected.depth.at(on_screen))) return;
            count(Counter::fragments_shaded);
            color[pixel] = face_color;
            if (texture == nullptr) return;
            count(Counter::texture_samples);
            const FragmentUv uv = fragment_uv(uvs, perspective_correct(setup, on_screen));
            color[pixel] *= vec3(sample(*texture, options.texture.filter, uv));
        });
    };
    for_each_visible_triangle(scene, clip_from_world, options.size, Culling::back_faces, draw);
    if (options.show_depth) return depth_picture(depth);
    return color;
}

int main(int argc, char** argv) {
    return run_lesson<TexturedSceneOptions>(
        argc, argv, "05_textures", "Draws a scene with textures.", load_textured_scene, render);
}
