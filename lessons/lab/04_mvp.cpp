// SPDX-License-Identifier: MIT
/// @file
/// Lesson 04's scene by other numbers, clipped otherwise, or without a camera.
#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/instance.hpp"
#include "04_mvp/projection.hpp"
#include "common/app/lesson_app.hpp"
#include "common/image/backdrop.hpp"
#include "lab/mvp_methods.hpp"

using namespace rasterbook;

struct Options : PotOptions {
    MvpMethod mvp;

    void declare(OptionParser& parser) {
        mvp.declare(parser);
        PotOptions::declare(parser);
    }
};

/// Of the teapot once more, as a coffee pot on the crate: scaled, then rotated, then moved.
static mat4 world_from_pot(float turn_degrees) {
    return translation(vec3(-3.7f, 2.4f, -2.6f)) * rotation_y(glm::radians(turn_degrees)) *
           scaling(vec3(0.4f, 0.75f, 0.3f));
}

static Image<vec3> render(const Options& options, const Scene& scene) {
    const std::vector<Instance> instances =
        instances_of(scene, world_from_pot(options.turn_degrees));
    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    if (options.mvp.asks_pixels()) return render_by_pixels(options, scene, instances, camera);
    Image<vec3> color = backdrop(options.size);
    DepthBuffer depth(options.size);

    for (const Instance& instance : instances) {
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
        for_each_visible_triangle(options.mvp, instance, camera, options.size, draw);
    }
    if (options.show_depth) return depth_picture(depth);
    return color;
}

int main(int argc, char** argv) {
    const auto make = [] {
        return lesson_program<Options>("lab_04_mvp", "Other numbers and clipping, for lesson 04.",
                                       just_the_scene<Options>, render);
    };
    return run_lab(make, "--precision double --offset 0 --clip six --view camera", argc, argv);
}
