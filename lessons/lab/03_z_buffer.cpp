// SPDX-License-Identifier: MIT
/// @file
/// Lesson 03's triangles with depths in other formats.
#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "common/app/lesson_app.hpp"
#include "common/app/orthographic_view.hpp"
#include "common/image/backdrop.hpp"
#include "lab/depth_formats.hpp"

using namespace rasterbook;

struct Options : PaintOptions {
    bool show_depth = false;
    DepthMethod depth;

    void declare(OptionParser& parser) {
        depth.declare(parser);
        PaintOptions::declare(parser);
    }
};

static Image<vec3> render(const Options& options, const Scene& scene) {
    const OrthographicView view(scene, options.size);
    Image<vec3> color = backdrop(options.size);
    DepthBuffer depth(options.size, options.depth.farthest());

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
                const float z = options.depth.kept(triangle_depth.at(barycentrics));
                if (!depth.test_and_write(pixel, z)) return;
                count(Counter::fragments_shaded);
                color[pixel] = options.paint == Paint::flat ? face_color : barycentrics;
            });
        }
    }
    if (options.show_depth) return depth_picture(depth);
    return color;
}

int main(int argc, char** argv) {
    const auto make = [] {
        return lesson_program<Options>("lab_03_z_buffer",
                                       "Other formats for depths, for lesson 03.",
                                       just_the_scene<Options>, render);
    };
    return run_lab(make, "--format float --range 1", argc, argv);
}
