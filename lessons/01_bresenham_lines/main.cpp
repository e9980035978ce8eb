// SPDX-License-Identifier: MIT
/// @file
/// Lesson 01: the model as a wireframe.
#include "01_bresenham_lines/line.hpp"
#include "common/backdrop.hpp"
#include "common/lesson_app.hpp"
#include "common/parallel_view.hpp"

using namespace rasterbook;

namespace {

struct Options : LessonOptions {};

/// What a line adds to its pixels: near lines are bright, far ones dim. Linear colour.
vec3 line_color(float depth) {
    constexpr vec3 near_color(0.30f, 0.42f, 0.36f), far_color(0.0f, 0.012f, 0.07f);
    return glm::mix(near_color, far_color, depth);
}

template <typename CounterPolicy>
Image<vec3> render(const Options& options, const Scene& scene, CounterPolicy& counters) {
    const ParallelView view(scene, options.size);
    Image<vec3> color = backdrop(options.size);

    for (const Mesh& mesh : scene.meshes) {
        const std::vector<vec3> positions_screen = view.screen_from_model(mesh.positions);
        for (const Face& face : mesh.faces) {
            vec3 from = positions_screen[mesh.corners_of(face).back().position];
            for (const Corner& corner : mesh.corners_of(face)) {
                const vec3 to = positions_screen[corner.position];
                const vec3 light = line_color(0.5f * (from.z + to.z));
                counters.add(Counter::lines);
                draw_line(pixel_of(from), pixel_of(to), options.size, LineEnd::excluded,
                          [&](ivec2 pixel) {
                              counters.add(Counter::line_pixels);
                              color[pixel] += light;
                          });
                from = to;
            }
        }
    }
    return color;
}

}  // namespace

int main(int argc, char** argv) {
    return run_lesson<Options>(argc, argv, "01_bresenham_lines", "Draws a model as a wireframe.",
                               [](const auto& options, const auto& scene, auto& counters) {
                                   return render(options, scene, counters);
                               });
}
