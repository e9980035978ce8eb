// SPDX-License-Identifier: MIT
/// @file
/// Lesson 11: scenes of any file.
#include <iostream>
#include <optional>
#include <syncstream>

#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "05_textures/textured_scene.hpp"
#include "06_phong/shading_variants.hpp"
#include "08_normal_maps/normal_map_variants.hpp"
#include "09_shadow_maps/shadow_variants.hpp"
#include "10_threading/binned_triangles.hpp"
#include "10_threading/thread_options.hpp"
#include "10_threading/thread_pool.hpp"
#include "10_threading/threaded_shadows.hpp"
#include "11_scenes/explain.hpp"
#include "11_scenes/finished_scene.hpp"
#include "11_scenes/kernels.hpp"
#include "11_scenes/scene_camera.hpp"
#include "11_scenes/scene_options.hpp"
#include "common/backdrop.hpp"
#include "common/lesson_app.hpp"

using namespace rasterbook;

namespace {

struct Options : LessonOptions {
    Orbit orbit;
    bool show_depth = false;
    SceneOptions scene;
    TextureOptions texture;
    LightOptions shading{.key_light = LightKind::directional};
    NormalMapVariant normal_map;
    ShadowVariant shadow;
    ThreadOptions threads;

    Options() { model = "bumpy.glb"; }
    void declare(Knobs& knobs) {
        knobs.flag("--depth", show_depth,
                   "Show the depth buffer: near is bright, nothing is black");
        scene.declare(knobs, *this);
        texture.declare(knobs);
        shading.declare(knobs);
        normal_map.declare(knobs);
        shadow.declare(knobs);
        threads.declare(knobs);
    }
};

template <typename Pool, typename CounterPolicy, typename Clock>
Image<vec3> render(const Options& options, const FinishedScene& scene, Pool& pool,
                   CounterPolicy& total, Clock& clock) {
    const Camera camera = camera_of_picture(options, options.scene.camera, scene).camera;
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    WorkerCounters<CounterPolicy> counters_of(pool.size());
    clock.begin("shadow maps");
    const Shadows shadows =
        draw_shadows(pool, options.threads, options.shadow, options.shading.all_effects, scene,
                     scene.lit_by.lights, counters_of, scene.lit_by.casts);
    Image<vec3> color(options.size, unset);
    DepthBuffer depth(options.size, unset);

    clock.begin("triangles");
    const std::vector<Mesh> outlines = outlines_of(scene, camera);
    const std::vector<const Mesh*> meshes = seen_meshes(scene, outlines, clip_from_world, total);
    const Parts parts = options.threads.parts_of(options.size, pool.size());
    std::vector<BinnedTriangles> passes;
    for (const Pass& pass : passes_of(scene, meshes))
        passes.emplace_back(
            pool, pass.meshes, clip_from_world, parts, pass.two_sided,
            [&](std::size_t material) { return pass.takes(scene, material); }, counters_of);

    clock.begin("picture");
    const Kernels<CounterPolicy> kernels(scene.plan);
    const ShadingVariant shading{options.shading};
    const Frame frame{
        scene, shading, options.normal_map, options.texture.filter, camera.position_world, shadows,
        color, depth};
    pool.run(parts.count(), [&](std::size_t part, std::size_t worker) {
        clear_part(color, depth, parts[part]);
        if (scene.is_on_paper) draw_paper(color, parts[part]);
        Layers layers;
        for (const BinnedTriangles& pass : passes)
            for (const Chunk& chunk : pass.chunks)
                for (const std::size_t index : chunk.of(part)) {
                    const ReadyTriangle& ready = chunk.triangles[index];
                    kernels[ready.triangle.material](frame, ready, parts[part], layers,
                                                     counters_of[worker]);
                }
        layers.draw_over(color);
        if (options.threads.show) tint(color, parts[part], worker);
    });
    clock.end();
    counters_of.add_to(total);
    if (options.show_depth) return depth_picture(depth);
    return color;
}

}  // namespace

int main(int argc, char** argv) {
    return run_lesson<Options, FinishedScene>(
        argc, argv, "11_scenes", "Draws a scene of any file, and what it calls for.",
        [](const auto& options, const auto& scene, auto& counters) {
            thread_local std::optional<ThreadPool> pool;
            if (!pool) pool.emplace(options.threads.threads);  // once for all frames
            NoClock no_clock;
            if (!options.scene.explain) return render(options, scene, *pool, counters, no_clock);
            StepClock clock;
            Counters counted;
            Image<vec3> picture = render(options, scene, *pool, counted, clock);
            const auto [camera, name] = camera_of_picture(options, options.scene.camera, scene);
            std::osyncstream out(std::cout);  // not between the words of another frame
            explain(out, scene, name, counted, clock);
            if constexpr (requires { counters.add(counted); }) counters.add(counted);
            return picture;
        });
}
