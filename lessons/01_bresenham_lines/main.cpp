// SPDX-License-Identifier: MIT
/// @file
/// Lesson 01: the model as a wireframe.
#include "01_bresenham_lines/line.hpp"
#include "common/app/lesson_app.hpp"
#include "common/app/orthographic_view.hpp"
#include "common/image/backdrop.hpp"

using namespace rasterbook;

static Image<vec3> render(const LessonOptions& options, const Scene& scene) {
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
                draw_line(pixel_of(from), pixel_of(to), options.size, LineEnd::excluded,
                          [&](ivec2 pixel) {
                              count(Counter::line_pixels);
                              color[pixel] += light;
                          });
                from = to;
            }
        }
    }
    return color;
}

int main(int argc, char** argv) {
    return run_lesson<LessonOptions>(argc, argv, "01_bresenham_lines",
                                     "Draws a model as a wireframe.", render);
}
