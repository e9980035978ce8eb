// SPDX-License-Identifier: MIT
/// @file
/// Lesson 04: models put into the world, through a camera, in perspective.
#include "02_triangle_fill/flat_color.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/instance.hpp"
#include "04_mvp/projection.hpp"
#include "common/app/lesson_app.hpp"
#include "common/image/backdrop.hpp"

using namespace rasterbook;

/// Of the teapot once more, as a coffee pot on the crate: scaled, then rotated, then moved.
static mat4 world_from_pot(float turn_degrees) {
    return translation(vec3(-3.7f, 2.4f, -2.6f)) * rotation_y(glm::radians(turn_degrees)) *
           scaling(vec3(0.4f, 0.75f, 0.3f));
}

static Image<vec3> render(const PotOptions& options, const Scene& scene) {
    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    Image<vec3> color = backdrop(options.size);
    DepthBuffer depth(options.size);

    for (const Instance& instance : instances_of(scene, world_from_pot(options.turn_degrees))) {
        const mat3 normal_from_model = normal_matrix(mat3(instance.world_from_model));
        const auto draw = [&](const ProjectedTriangle& projected) {
            const Material& material = scene.materials[projected.triangle.material];
            const vec3 normal = normal_from_model * flat_normal(projected.mesh, projected.triangle);
            const vec3 face_color = flat_color(normalize_or(normal, vec3(0, 1, 0)), material);

            fill_triangle(projected.on_screen, options.size, [&](ivec2 pixel, vec3 on_screen) {
                count(Counter::fragments_tested);
                if (!depth.test_and_write(pixel, projected.depth.at(on_screen))) return;
                count(Counter::fragments_shaded);
                color[pixel] = face_color;
            });
        };
        for_each_visible_triangle(instance.mesh, clip_from_world * instance.world_from_model,
                                  options.size, Culling::back_faces, draw);
    }
    if (options.show_depth) return depth_picture(depth);
    return color;
}

int main(int argc, char** argv) {
    return run_lesson<PotOptions>(argc, argv, "04_mvp", "Draws a scene through a camera.", render);
}
