// A small program to begin with: surfaces in the colours of their normals, with the triangles'
// edges. Every lesson's headers are at hand; an option becomes a control below the picture.
#include <algorithm>

#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/projection.hpp"
#include "common/app/lesson_app.hpp"
#include "common/image/backdrop.hpp"

using namespace rasterbook;

struct Options : LessonOptions {
    Orbit orbit;
    float edge = 0.03f;

    Options() { model = "figure.obj"; }
    void declare(OptionParser& parser) {
        parser.number("--edge", edge, 0, 0.3f,
                      "The edges' width, as a share of a triangle's heights");
    }
};

Image<vec3> render(const Options& options, const Scene& scene) {
    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    Image<vec3> color = backdrop(options.size);
    DepthBuffer depth(options.size);

    const auto draw = [&](const ProjectedTriangle& projected) {
        const vec3 normal = flat_normal(projected.mesh, projected.triangle);
        fill_triangle(projected.on_screen, options.size, [&](ivec2 pixel, vec3 on_screen) {
            if (!depth.test_and_write(pixel, projected.depth.at(on_screen))) return;
            const float least = std::min({on_screen.x, on_screen.y, on_screen.z});
            color[pixel] = least < options.edge ? vec3(0.02f) : 0.5f + 0.5f * normal;
        });
    };
    for_each_visible_triangle(scene, camera.clip_from_world(options.size), options.size,
                              Culling::back_faces, draw);
    return color;
}

int main(int argc, char** argv) {
    return run_lesson<Options>(argc, argv, "sandbox", "Draws what you write.", render);
}
