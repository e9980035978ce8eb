// SPDX-License-Identifier: MIT
/// @file
/// Lesson 04: the scene through a camera, in perspective.
#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/mvp_variants.hpp"
#include "04_mvp/projection.hpp"
#include "common/app/lesson_app.hpp"
#include "common/image/backdrop.hpp"

using namespace rasterbook;

namespace {

struct Options : LessonOptions {
    Orbit orbit;
    bool show_depth = false;
    MvpVariant mvp;

    Options() { model = "scene.obj"; }
    void declare(Knobs& knobs) { mvp.declare(knobs); }
};

template <typename CounterPolicy>
Image<vec3> render(const Options& options, const Scene& scene, CounterPolicy& counters) {
    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    if (options.mvp.clipping == Clipping::pixels)
        return render_by_pixels(options, scene, camera, counters);
    Image<vec3> color = backdrop(options.size);
    DepthBuffer depth(options.size);

    const auto draw = [&](const ProjectedTriangle& projected) {
        const Material& material = scene.materials[projected.triangle.material];
        const vec3 face_color = flat_color(projected.mesh, projected.triangle, material);

        fill_triangle(projected.on_screen, options.size, [&](ivec2 pixel, Barycentrics on_screen) {
            counters.add(Counter::fragments_tested);
            if (!depth.test_and_write(pixel, projected.depth.at(on_screen))) return;
            counters.add(Counter::fragments_shaded);
            color[pixel] = face_color;
        });
    };
    for_each_visible_triangle(options.mvp, scene, camera, options.size, counters, draw);
    if (options.show_depth) return depth_picture(depth);
    return color;
}

}  // namespace

int main(int argc, char** argv) {
    return run_lesson<Options>(argc, argv, "04_mvp", "Draws a scene through a camera.",
                               [](const auto& options, const auto& scene, auto& counters) {
                                   return render(options, scene, counters);
                               });
}
