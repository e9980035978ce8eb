// SPDX-License-Identifier: MIT
/// @file
/// Lesson 05: pictures on the surfaces.
#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "05_textures/bands.hpp"
#include "05_textures/textured_scene.hpp"
#include "common/backdrop.hpp"
#include "common/lesson_app.hpp"

using namespace rasterbook;

namespace {

struct Options : LessonOptions {
    Orbit orbit;
    bool show_depth = false;
    TextureVariant texture;

    Options() { model = "scene.obj"; }
    void declare(Knobs& knobs) {
        knobs.flag("--depth", show_depth,
                   "Show the depth buffer: near is bright, nothing is black");
        texture.declare(knobs);
    }
};

template <typename CounterPolicy>
Image<vec3> render(const Options& options, const TexturedScene& scene, CounterPolicy& counters) {
    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    const mat4 clip_from_world = camera.clip_from_world(options.size);
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
            const Material& material = scene.materials[triangle.material];
            const Texture* texture = scene.diffuse_textures[triangle.material].get();
            const std::array<vec2, 3> uvs = uvs_of(mesh, triangle, material.diffuse_map);
            for (const ClippedTriangle& clipped :
                 clip_triangle(corners_of(triangle, positions_clip))) {
                const vec3 a = screen_from_clip(clipped[0].position_clip, options.size);
                const vec3 b = screen_from_clip(clipped[1].position_clip, options.size);
                const vec3 c = screen_from_clip(clipped[2].position_clip, options.size);
                const ScreenTriangle on_screen = snap_triangle(a, b, c);
                if (!is_front_facing(on_screen)) {
                    counters.add(Counter::triangles_culled_by_facing);
                    continue;
                }
                const vec3 face_color = flat_color(mesh, triangle, material);
                const TriangleDepth triangle_depth(vec3(a.z, b.z, c.z));
                MappedWeights mapped(options.texture, on_screen, clipped);
                fill_in_bands(on_screen, options.size, [&](ivec2 pixel, vec3 screen_weights) {
                    counters.add(Counter::fragments_tested);
                    if (!depth.test_and_write(pixel, triangle_depth.at(screen_weights))) return;
                    counters.add(Counter::fragments_shaded);
                    color[pixel] = face_color;
                    if (texture == nullptr) return;
                    counters.add(Counter::texture_samples);
                    const FragmentUv uv = fragment_uv(uvs, mapped.at(pixel, screen_weights));
                    color[pixel] *= vec3(sample(*texture, options.texture.filter, uv));
                });
            }
        }
    }
    if (options.show_depth) return depth_picture(depth);
    return color;
}

}  // namespace

int main(int argc, char** argv) {
    return run_lesson<Options, TexturedScene>(
        argc, argv, "05_textures", "Draws a scene with textures.",
        [](const auto& options, const auto& scene, auto& counters) {
            return render(options, scene, counters);
        });
}
