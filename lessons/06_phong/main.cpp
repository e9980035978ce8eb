// SPDX-License-Identifier: MIT
/// @file
/// Lesson 06: light on the surfaces.
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "05_textures/textured_scene.hpp"
#include "06_phong/lit_scene.hpp"
#include "06_phong/shading_variants.hpp"
#include "common/backdrop.hpp"
#include "common/lesson_app.hpp"

using namespace rasterbook;

namespace {

struct Options : LessonOptions {
    Orbit orbit;
    bool show_depth = false;
    TextureVariant texture;
    ShadingVariant shading;
    LightKind key_light = LightKind::point;
    bool two_sided = false;
    bool all_effects = false;

    Options() { model = "scene.obj"; }
    void declare(Knobs& knobs) {
        knobs.flag("--depth", show_depth,
                   "Show the depth buffer: near is bright, nothing is black");
        texture.declare(knobs);
        shading.declare(knobs);
        knobs.choice("--light", key_light,
                     {{"sun", LightKind::directional},
                      {"lamp", LightKind::point},
                      {"spot", LightKind::spot}},
                     "What the scene is lit by");
        knobs.flag("--two-sided", two_sided, "Draw the backs of faces, too");
        knobs.flag("--all-effects", all_effects,
                   "Compute each effect also where it can change nothing");
    }
};

template <typename CounterPolicy>
Image<vec3> render(const Options& options, const LitScene& scene, CounterPolicy& counters) {
    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    const std::array lights = studio_lights(options.key_light, scene.bounds());
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
            const Effects effects = scene.effects[triangle.material];
            const Texture* texture = scene.diffuse_textures[triangle.material].get();
            const Texture* specular_texture = scene.specular_textures[triangle.material].get();
            const std::array<vec2, 3> uvs = uvs_of(mesh, triangle, material.diffuse_map);
            const std::array<vec2, 3> specular_uvs = uvs_of(mesh, triangle, material.specular_map);
            for (const ClippedTriangle& clipped :
                 clip_triangle(corners_of(triangle, positions_clip))) {
                const vec3 a = screen_from_clip(clipped[0].position_clip, options.size);
                const vec3 b = screen_from_clip(clipped[1].position_clip, options.size);
                const vec3 c = screen_from_clip(clipped[2].position_clip, options.size);
                const ScreenTriangle on_screen = snap_triangle(a, b, c);
                const bool is_back = !is_front_facing(on_screen);
                if (is_back && !options.two_sided) {
                    counters.add(Counter::triangles_culled_by_facing);
                    continue;
                }
                const TriangleDepth triangle_depth(vec3(a.z, b.z, c.z));
                MappedWeights mapped(options.texture, on_screen, clipped);
                const TriangleLight light(options.shading, lights, camera.position_world, mesh,
                                          triangle, is_back, effects, material.shininess);
                fill_triangle(on_screen, options.size, [&](ivec2 pixel, vec3 screen_weights) {
                    counters.add(Counter::fragments_tested);
                    if (!depth.test_and_write(pixel, triangle_depth.at(screen_weights))) return;
                    counters.add(Counter::fragments_shaded);
                    const FragmentWeights weights = mapped.at(pixel, screen_weights);
                    SurfaceColor surface = surface_color(material);
                    if (effects.diffuse_map) {
                        counters.add(Counter::texture_samples);
                        const FragmentUv uv = fragment_uv(uvs, weights);
                        surface.tint(vec3(sample(*texture, options.texture.filter, uv)));
                    }
                    if (effects.specular_map) {
                        counters.add(Counter::texture_samples);
                        const FragmentUv uv = fragment_uv(specular_uvs, weights);
                        surface.specular *=
                            vec3(sample(*specular_texture, options.texture.filter, uv));
                    }
                    if (effects.light) counters.add(Counter::fragments_lit);
                    if (effects.highlight) counters.add(Counter::highlights);
                    color[pixel] = effects.light
                                       ? phong(surface, ambient_light, light.at(weights.here))
                                       : surface.emission + surface.diffuse;
                });
            }
        }
    }
    return options.show_depth ? depth_picture(depth) : color;
}

}  // namespace

int main(int argc, char** argv) {
    return run_lesson<Options, LitScene>(
        argc, argv, "06_phong", "Draws a scene in the light of lamps.",
        [](const auto& options, const auto& scene, auto& counters) {
            return render(options, scene, counters);
        });
}
