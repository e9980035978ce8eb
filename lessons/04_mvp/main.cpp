// SPDX-License-Identifier: MIT
/// @file
/// Lesson 04: models put into the world, through a camera, in perspective.
#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/instance.hpp"
#include "04_mvp/mvp_variants.hpp"
#include "04_mvp/probe.hpp"
#include "04_mvp/projection.hpp"
#include "common/app/lesson_app.hpp"
#include "common/image/backdrop.hpp"

using namespace rasterbook;

struct Options : LessonOptions {
    Orbit orbit;
    bool show_depth = false;
    float turn_degrees = -40;
    MvpVariant mvp;

    Options() { model = "scene.obj"; }
    void declare(Knobs& knobs) {
        knobs.number("--turn", turn_degrees, -36000, 36000,
                     "The coffee pot's rotation, in degrees, counter-clockwise from above");
        mvp.declare(knobs);
    }
};

static std::vector<Instance> make_instances(const Options& options, const Scene& scene) {
    // The teapot again, as a coffee pot on the crate: scaled, then rotated, then moved.
    const mat4 world_from_pot = translation(vec3(-3.7f, 2.4f, -2.6f)) *
                                rotation_y(glm::radians(options.turn_degrees)) *
                                scaling(vec3(0.4f, 0.75f, 0.3f));
    return instances_of(scene, world_from_pot);
}

static Image<vec3> render(const Options& options, const Scene& scene) {
    const std::vector<Instance> instances = make_instances(options, scene);
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
    return run_lesson<Options>(argc, argv, "04_mvp", "Draws a scene through a camera.", render,
                               [](const auto& options, const auto& scene) {
                                   return mvp_probe(options, scene, make_instances(options, scene));
                               });
}
