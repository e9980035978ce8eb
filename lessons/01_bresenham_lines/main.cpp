// SPDX-License-Identifier: MIT
/// @file
/// Lesson 01: the model as a wireframe.
#include "01_bresenham_lines/line_variants.hpp"
#include "common/app/lesson_app.hpp"
#include "common/app/orthographic_view.hpp"
#include "common/image/backdrop.hpp"

using namespace rasterbook;

struct Options : LessonOptions {
    LineMethod line = LineMethod::bresenham;

    void declare(Knobs& knobs) {
        knobs.choice("--line", line,
                     {{"bresenham", LineMethod::bresenham},
                      {"dda-float", LineMethod::dda_float},
                      {"dda-fixed", LineMethod::dda_fixed},
                      {"wu", LineMethod::wu}},
                     "How lines are drawn; Wu's are smooth");
    }
};

/// What a line adds to its pixels: near lines are bright, far ones dim. Linear colour.
static vec3 line_color(float depth) {
    constexpr vec3 near_color(0.30f, 0.42f, 0.36f), far_color(0.0f, 0.012f, 0.07f);
    return glm::mix(far_color, near_color, depth);
}

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
    return run_lesson<Options>(argc, argv, "01_bresenham_lines", "Draws a model as a wireframe.",
                               render);
}
