// SPDX-License-Identifier: MIT
/// @file
/// Lesson 04: the scene through a camera, in perspective.
#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "04_mvp/mvp_variants.hpp"
#include "common/backdrop.hpp"
#include "common/lesson_app.hpp"

using namespace rasterbook;

namespace {

struct Options : LessonOptions {
    Orbit orbit;
    bool show_depth = false;
    MvpVariant mvp;

    Options() { model = "scene.obj"; }
    void declare(Knobs& knobs) {
        knobs.flag("--depth", show_depth,
                   "Show the depth buffer: near is bright, nothing is black");
        mvp.declare(knobs);
    }
};

template <typename CounterPolicy>
Image<vec3> render(const Options& options, const Scene& scene, CounterPolicy& counters) {
    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    if (options.mvp.clipping == Clipping::pixels)
        return render_by_pixels(options, scene, camera, counters);
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    Image<vec3> color = backdrop(options.size);
    DepthBuffer depth(options.size);

    for (const Mesh& mesh : scene.meshes) {
        counters.add(Counter::meshes_in);
        if (is_outside_frustum(mesh.bounds, clip_from_world)) {
            counters.add(Counter::meshes_culled_by_frustum);
            continue;
        }
        const std::vector<vec4> positions_clip =
            transform(options.mvp, camera, options.size, mesh.positions);
        for (const Triangle& triangle : mesh.triangles) {
            counters.add(Counter::triangles_in);
            for (const ClippedTriangle& clipped :
                 clip(options.mvp, corners_of(triangle, positions_clip), options.size)) {
                const vec3 a = screen_from_clip(clipped[0].position_clip, options.size);
                const vec3 b = screen_from_clip(clipped[1].position_clip, options.size);
                const vec3 c = screen_from_clip(clipped[2].position_clip, options.size);
                const ScreenTriangle on_screen = snap_triangle(a, b, c);
                if (!is_front_facing(on_screen)) {
                    counters.add(Counter::triangles_culled_by_facing);
                    continue;
                }
                const vec3 face_color =
                    flat_color(mesh, triangle, scene.materials[triangle.material]);
                const TriangleDepth triangle_depth(vec3(a.z, b.z, c.z));
                fill_triangle(on_screen, options.size, [&](ivec2 pixel, vec3 weights) {
                    counters.add(Counter::fragments_tested);
                    if (!depth.test_and_write(pixel, triangle_depth.at(weights))) return;
                    counters.add(Counter::fragments_shaded);
                    color[pixel] = face_color;
                });
            }
        }
    }
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
