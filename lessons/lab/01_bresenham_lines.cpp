// SPDX-License-Identifier: MIT
/// @file
/// Lesson 01's wireframe by other lines.
#include "common/app/lesson_app.hpp"
#include "common/app/orthographic_view.hpp"
#include "common/image/backdrop.hpp"
#include "lab/line_methods.hpp"

using namespace rasterbook;

struct Options : LessonOptions {
    LineMethod line = LineMethod::bresenham;

    void declare(OptionParser& parser) {
        parser.choice(
            "--line", line,
            {{"bresenham", LineMethod::bresenham},
             {"dda-float", LineMethod::dda_float},
             {"dda-fixed", LineMethod::dda_fixed},
             {"wu", LineMethod::wu}},
            "How lines are drawn: bresenham in whole numbers, each pixel right; dda-float "
            "adds the slope up in float, dda-fixed in 1/65536 pixel, and both drift; wu is "
            "smooth: two pixels share each step");
    }
};

static Image<vec3> render(const Options& options, const Scene& scene) {
    const OrthographicView view(scene, options.size);
    Image<vec3> color = backdrop(options.size);

    for (const Mesh& mesh : scene.meshes) {
        const std::vector<vec3> positions_screen = view.screen_from_model(mesh.positions);
        for (const Face& face : mesh.faces) {
            vec3 from = positions_screen[mesh.vertices_of(face).back().position];
            for (const Vertex& vertex : mesh.vertices_of(face)) {
                const vec3 to = positions_screen[vertex.position];
                const vec3 light = line_color(0.5f * (from.z + to.z));
                count(Counter::lines);
                draw_line_as(options.line, pixel_of(from), pixel_of(to), options.size,
                             LineEnd::excluded, [&](ivec2 pixel, float coverage) {
                                 count(Counter::line_pixels);
                                 color[pixel] += coverage * light;
                             });
                from = to;
            }
        }
    }
    return color;
}

int main(int argc, char** argv) {
    const auto make = [] {
        LessonProgram program =
            lesson_program<Options>("lab_01_bresenham_lines", "Other lines for lesson 01.",
                                    just_the_scene<Options>, render);
        program.fills_triangles = false;
        return program;
    };
    return run_lab(make, "--line bresenham", argc, argv);
}
