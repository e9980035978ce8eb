// SPDX-License-Identifier: MIT
/// @file
/// Lesson 02's triangles filled by other numbers.
#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "common/app/lesson_app.hpp"
#include "common/app/orthographic_view.hpp"
#include "common/image/backdrop.hpp"
#include "lab/fill_methods.hpp"

using namespace rasterbook;

struct Options : PaintOptions {
    FillMethod fill;

    void declare(OptionParser& parser) {
        fill.declare(parser);
        PaintOptions::declare(parser);
    }
};

static Image<vec3> render(const Options& options, const Scene& scene) {
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
            fill(options.fill, on_screen, {a, b, c}, options.size,
                 [&](ivec2 pixel, vec3 barycentrics) {
                     count(Counter::fragments_shaded);
                     color[pixel] = options.paint == Paint::flat ? face_color : barycentrics;
                 });
        }
    }
    return color;
}

int main(int argc, char** argv) {
    const auto make = [] {
        return lesson_program<Options>("lab_02_triangle_fill", "Other numbers for lesson 02.",
                                       just_the_scene<Options>, render);
    };
    return run_lab(make, "--edges int64 --subpixel-bits 16", argc, argv);
}
