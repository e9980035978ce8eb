// SPDX-License-Identifier: MIT
/// @file
/// Lesson 06: light on the surfaces.
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "05_textures/bands.hpp"
#include "05_textures/textured_scene.hpp"
#include "06_phong/fragments.hpp"
#include "06_phong/lit_scene.hpp"
#include "06_phong/many_samples.hpp"
#include "06_phong/shading_variants.hpp"
#include "common/backdrop.hpp"
#include "common/lesson_app.hpp"

using namespace rasterbook;

namespace {

struct Options : LessonOptions {
    Orbit orbit;
    bool show_depth = false;
    TextureOptions texture;
    ShadingVariant shading;

    Options() { model = "scene.obj"; }
    void declare(Knobs& knobs) {
        knobs.flag("--depth", show_depth,
                   "Show the depth buffer: near is bright, nothing is black");
        texture.declare(knobs);
        shading.declare(knobs);
    }
};

template <typename CounterPolicy>
Image<vec3> render(const Options& options, const LitScene& scene, CounterPolicy& counters) {
    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    const std::array lights = studio_lights(options.shading.key_light, scene.bounds());
    Image<vec3> color = backdrop(options.size);
    DepthBuffer depth(options.size);

    for (const Mesh& mesh : scene.meshes) {
        counters.add(Counter::meshes_in);
        if (is_outside_frustum(mesh.bounds, clip_from_world)) {
            counters.add(Counter::meshes_culled_by_frustum);
            continue;
        }
        const std::vector<vec4> positions_clip = transform(clip_from_world, mesh.positions);
        for (const Triangle& triangle : mesh.triangles) {
            counters.add(Counter::triangles_in);
            const TriangleSurface surface(scene, mesh, triangle);
            for (const ClippedTriangle& clipped :
                 clip_triangle(corners_of(triangle, positions_clip))) {
                const vec3 a = screen_from_clip(clipped[0].position_clip, options.size);
                const vec3 b = screen_from_clip(clipped[1].position_clip, options.size);
                const vec3 c = screen_from_clip(clipped[2].position_clip, options.size);
                const ScreenTriangle on_screen = snap_triangle(a, b, c);
                const bool is_back = !is_front_facing(on_screen);
                if (is_back && !options.shading.two_sided) {
                    counters.add(Counter::triangles_culled_by_facing);
                    continue;
                }
                const TriangleDepth triangle_depth(vec3(a.z, b.z, c.z));
                const PerspectiveWeights perspective(on_screen, clipped);
                const TriangleLight light(options.shading, lights, camera.position_world, mesh,
                                          triangle, is_back, surface);
                const auto shade = [&](const ManyFragments& fragments) {
                    const ManyWeights weights = weights_of(fragments, perspective);
                    const auto own = surface.colors(weights, options.texture.filter, counters);
                    LitPoints points;
                    if (surface.effects.light) light.add(weights, points, counters);
                    light.compute(points);
                    for (std::size_t i = 0; i < fragments.count; ++i)
                        color[fragments.pixels[i]] =
                            surface.effects.light ? phong(own[i], ambient_light, points.light(i))
                                                  : unlit(own[i]);
                };
                Fragments visible(shade);
                fill_in_bands(on_screen, options.size, [&](ivec2 pixel, vec3 screen_weights) {
                    counters.add(Counter::fragments_tested);
                    if (!depth.test_and_write(pixel, triangle_depth.at(screen_weights))) return;
                    counters.add(Counter::fragments_shaded);
                    visible.add(pixel, screen_weights);
                });
                visible.finish();
            }
        }
    }
    if (options.show_depth) return depth_picture(depth);
    return color;
}

}  // namespace

int main(int argc, char** argv) {
    return run_lesson<Options, LitScene>(
        argc, argv, "06_phong", "Draws a scene in the light of lamps.",
        [](const auto& options, const auto& scene, auto& counters) {
            return render(options, scene, counters);
        });
}
