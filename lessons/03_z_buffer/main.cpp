// SPDX-License-Identifier: MIT
/// @file
/// Lesson 03: the model as filled triangles, of which each pixel keeps the nearest.
#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "common/app/lesson_app.hpp"
#include "common/app/orthographic_view.hpp"
#include "common/image/backdrop.hpp"

using namespace rasterbook;

struct Options : PaintOptions {
    bool show_depth = false;
};

static Image<vec3> render(const Options& options, const Scene& scene) {
    const OrthographicView view(scene, options.size);
    Image<vec3> color = backdrop(options.size);
    DepthBuffer depth(options.size);

    for (const Mesh& mesh : scene.meshes) {
        const std::vector<vec3> positions_screen = view.screen_from_model(mesh.positions);
        for (const Triangle& triangle : mesh.triangles) {
            const vec3 a = positions_screen[triangle.vertices[0].position];
            const vec3 b = positions_screen[triangle.vertices[1].position];
            const vec3 c = positions_screen[triangle.vertices[2].position];
            const ScreenTriangle on_screen = snap_triangle(a, b, c);
            count_triangle(mesh, triangle, on_screen);
            if (!is_front_facing(on_screen)) continue;
            const vec3 face_color = flat_color(mesh, triangle, scene.materials[triangle.material]);
            const TriangleDepth triangle_depth(vec3(a.z, b.z, c.z));
            fill_triangle(on_screen, options.size, [&](ivec2 pixel, vec3 barycentrics) {
                count(Counter::fragments_tested);
                if (!depth.test_and_write(pixel, triangle_depth.at(barycentrics))) return;
                count(Counter::fragments_shaded);
                color[pixel] = options.paint == Paint::flat ? face_color : barycentrics;
            });
        }
    }
    if (options.show_depth) return depth_picture(depth);
    return color;
}

int main(int argc, char** argv) {
    return run_lesson<Options>(argc, argv, "03_z_buffer",
                               "Draws a model as filled triangles with a depth buffer.", render);
}
