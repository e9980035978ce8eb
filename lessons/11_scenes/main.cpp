// SPDX-License-Identifier: MIT
/// @file
/// Lesson 11: scenes of any file.
#include "10_threading/thread_pool.hpp"
#include "10_threading/threaded_shadows.hpp"
#include "11_scenes/casters.hpp"
#include "11_scenes/scene_camera.hpp"
#include "11_scenes/scene_options.hpp"
#include "11_scenes/scene_program.hpp"
#include "11_scenes/shaders.hpp"

using namespace rasterbook;

using Options = SceneRendererOptions;

static Image<vec3> render(const Options& options, const SceneAssets& assets, Workers& pool,
                          StepClock& clock) {
    const auto& [scene, textures, normal_maps, bounds, lit_by, plan, hulls, is_on_paper] = assets;
    const Camera camera = camera_of_picture(options, scene).camera;
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    clock.begin("shadow maps");
    const ShadowMaps shadow_maps = draw_shadow_maps(pool, options, assets);
    Image<vec3> color(options.size, unset);
    DepthBuffer depth(options.size, unset, camera.farthest_depth());

    clock.begin("triangles");
    const std::vector<Mesh> outlines = outlines_of(assets, camera);
    const std::vector<const Mesh*> meshes = seen_meshes(scene, outlines, clip_from_world);
    const Tiling tiling = options.threads.tiling_of(options.size, pool.size());
    const BinnedPasses passes = bin_passes(pool, assets, meshes, clip_from_world, tiling);

    clock.begin("picture");
    const Shaders shaders(plan);
    const Frame frame = make_frame(options, assets, camera, shadow_maps, color, depth);
    pool.run(tiling.count(), [&](std::size_t i, std::size_t worker) {
        const Tile tile = tiling[i];
        clear_tile(color, depth, tile);
        if (is_on_paper) draw_paper(color, tile);
        TransparentFragments transparent;
        const auto draw = [&](const BinnedTriangles& pass, const Tile& part) {
            pass.for_each_in(i, [&](const ProjectedTriangle& projected) {
                shaders[projected.triangle.material](frame, projected, part, transparent);
            });
        };
        for (const BinnedTriangles& pass : passes.opaque) draw(pass, tile);
        for_each_part(tile, count_in(passes.blended, i), [&](const Tile& part) {
            for (const BinnedTriangles& pass : passes.blended) draw(pass, part);
            transparent.blend_over(color);
        });
        if (options.threads.show) tint(color, tile, worker);
    });
    if (options.show_depth) return depth_picture(depth);
    return color;
}

int main(int argc, char** argv) {
    return run_scene_lesson<Options>(argc, argv, "11_scenes",
                                     "Draws a scene of any file, and what it calls for.", render);
}
