// SPDX-License-Identifier: MIT
/// @file
/// Lesson 02: the model as filled triangles, each painted over those before it.
#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "common/app/lesson_app.hpp"
#include "common/app/orthographic_view.hpp"
#include "common/image/backdrop.hpp"

using namespace rasterbook;

static Image<vec3> render(const PaintOptions& options, const Scene& scene) {
    const OrthographicView view(scene, options.size);
    Image<vec3> color = backdrop(options.size);

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
            fill_triangle(on_screen, options.size, [&](ivec2 pixel, vec3 barycentrics) {
                count(Counter::fragments_shaded);
                color[pixel] = options.paint == Paint::flat ? face_color : barycentrics;
            });
        }
    }
    return color;
}

int main(int argc, char** argv) {
    return run_lesson<PaintOptions>(argc, argv, "02_triangle_fill",
                                    "Draws a model as filled triangles, in the file's order.",
                                    render);
}
