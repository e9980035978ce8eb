// SPDX-License-Identifier: MIT
/// @file
/// Lesson 10: threads.
#include <optional>

#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "05_textures/bands.hpp"
#include "05_textures/textured_scene.hpp"
#include "06_phong/fragments.hpp"
#include "06_phong/many_samples.hpp"
#include "06_phong/shading_variants.hpp"
#include "08_normal_maps/bumpy_scene.hpp"
#include "08_normal_maps/normal_map_variants.hpp"
#include "09_shadow_maps/shadow_variants.hpp"
#include "09_shadow_maps/shadowed_scene.hpp"
#include "10_threading/binned_triangles.hpp"
#include "10_threading/thread_options.hpp"
#include "10_threading/thread_pool.hpp"
#include "10_threading/threaded_shadows.hpp"
#include "common/backdrop.hpp"
#include "common/lesson_app.hpp"

using namespace rasterbook;

namespace {

struct Options : LessonOptions {
    Orbit orbit;
    bool show_depth = false;
    TextureOptions texture;
    LightOptions shading{.key_light = LightKind::directional};
    NormalMapVariant normal_map;
    ShadowVariant shadow;
    ThreadOptions threads;

    Options() { model = "scene_bumpy.obj"; }
    void declare(Knobs& knobs) {
        knobs.flag("--depth", show_depth,
                   "Show the depth buffer: near is bright, nothing is black");
        texture.declare(knobs);
        shading.declare(knobs);
        normal_map.declare(knobs);
        shadow.declare(knobs);
        threads.declare(knobs);
    }
};

template <typename Pool, typename CounterPolicy>
Image<vec3> render(const Options& options, const ShadowedScene& scene, Pool& pool,
                   CounterPolicy& total) {
    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    const std::array lights = raking_lights(options.shading.key_light, scene.bounds());
    WorkerCounters<CounterPolicy> counters_of(pool.size());
    const Shadows shadows = draw_shadows(pool, options.threads, options.shadow,
                                         options.shading.all_effects, scene, lights, counters_of);
    Image<vec3> color(options.size, unset);
    DepthBuffer depth(options.size, unset);

    std::vector<const Mesh*> meshes;
    for (const Mesh& mesh : scene.meshes) {
        total.add(Counter::meshes_in);
        if (is_outside_frustum(mesh.bounds, clip_from_world)) {
            total.add(Counter::meshes_culled_by_frustum);
            continue;
        }
        if (!scene.tangents_of(mesh).empty()) total.add(Counter::meshes_with_tangents);
        meshes.push_back(&mesh);
    }
    const Parts parts = options.threads.parts_of(options.size, pool.size());
    const BinnedTriangles triangles(
        pool, meshes, clip_from_world, parts, options.shading.two_sided,
        [](std::size_t) { return true; }, counters_of);
    pool.run(parts.count(), [&](std::size_t part, std::size_t worker) {
        CounterPolicy& counters = counters_of[worker];
        clear_part(color, depth, parts[part]);
        for (const Chunk& chunk : triangles.chunks)
            for (const std::size_t index : chunk.of(part)) {
                const auto& [mesh, triangle, clipped, on_screen, depths, is_back] =
                    chunk.triangles[index];
                const TriangleSurface surface(scene, mesh, triangle);
                const TriangleDepth triangle_depth(depths);
                const PerspectiveWeights perspective(on_screen, clipped);
                const TriangleRelief relief(options.normal_map, scene, mesh, triangle, is_back);
                const TriangleLight light(ShadingVariant{options.shading}, lights,
                                          camera.position_world, mesh, triangle, is_back, surface);
                TriangleShadows shadow(shadows, mesh, triangle);
                const auto shade = [&](const ManyFragments& fragments) {
                    const ManyWeights weights = weights_of(fragments, perspective);
                    const auto own = surface.colors(weights, options.texture.filter, counters);
                    BumpyPoints points;
                    if (surface.effects.light) {
                        light.add(weights, points, counters);
                        relief.add(weights, options.texture.filter, points, counters);
                    }
                    shadow.look_up(points, counters);
                    relief.tilt(points);
                    light.compute(points, shadow);
                    for (std::size_t i = 0; i < fragments.count; ++i)
                        color[fragments.pixels[i]] =
                            surface.effects.light ? phong(own[i], ambient_light, points.light(i))
                                                  : unlit(own[i]);
                };
                Fragments visible(shade);
                fill_part(on_screen, parts[part], [&](ivec2 pixel, vec3 screen_weights) {
                    counters.add(Counter::fragments_tested);
                    if (!depth.test_and_write(pixel, triangle_depth.at(screen_weights))) return;
                    counters.add(Counter::fragments_shaded);
                    visible.add(pixel, screen_weights);
                });
                visible.finish();
            }
        if (options.threads.show) tint(color, parts[part], worker);
    });
    counters_of.add_to(total);
    if (options.show_depth) return depth_picture(depth);
    return color;
}

}  // namespace

int main(int argc, char** argv) {
    std::optional<ThreadPool> pool;
    return run_lesson<Options, ShadowedScene>(
        argc, argv, "10_threading", "Draws the same picture with several threads.",
        [&](const auto& options, const auto& scene, auto& counters) {
            if (!pool) pool.emplace(options.threads.threads);  // once for all frames
            return render(options, scene, *pool, counters);
        });
}
