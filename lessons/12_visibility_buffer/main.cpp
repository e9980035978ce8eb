// SPDX-License-Identifier: MIT
/// @file
/// Lesson 12: the visibility buffer.
#include "10_threading/thread_pool.hpp"
#include "11_scenes/scene_camera.hpp"
#include "11_scenes/scene_options.hpp"
#include "11_scenes/scene_program.hpp"
#include "12_visibility_buffer/shadow_parts.hpp"
#include "12_visibility_buffer/views.hpp"
#include "12_visibility_buffer/visibility_options.hpp"
#include "12_visibility_buffer/visible_shading.hpp"

using namespace rasterbook;

struct Options : SceneRendererOptions {
    VisibilityOptions visibility;

    Options() { threads.tile = 64; }  // a triangle is set up again in each tile
    void declare(OptionParser& parser) {
        SceneRendererOptions::declare(parser);
        visibility.declare(parser);
    }
};

static Image<vec3> render(const Options& options, const SceneAssets& assets, Workers& pool,
                          StepClock& clock) {
    const auto& [scene, textures, normal_maps, bounds, lit_by, plan, hulls, is_on_paper] = assets;
    const Camera camera = camera_of_picture(options, scene).camera;
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    clock.begin("casters");
    const ShadowMapsOnDemand shadow_maps(pool, options.visibility.shadow_part, options, assets);
    Image<vec3> color(options.size, unset);
    DepthBuffer depth(options.size, unset, camera.farthest_depth());
    std::vector<VisibilityBuffer> visible_of(pool.size(),
                                             VisibilityBuffer(options.visibility.most_ids()));
    HeatMap heat(options.visibility.show, options.size);

    clock.begin("triangles");
    const std::vector<Mesh> outlines = outlines_of(assets, camera);
    const std::vector<const Mesh*> meshes = seen_meshes(scene, outlines, clip_from_world);
    const Tiling tiling = options.threads.tiling_of(options.size, pool.size());
    const BinnedPasses passes = bin_passes(pool, assets, meshes, clip_from_world, tiling);

    clock.begin("picture");
    const VisibleShaders<ShadowMapsOnDemand> shaders(plan);
    const Frame frame = make_frame(options, assets, camera, shadow_maps, color, depth);
    pool.run(tiling.count(), [&](std::size_t i, std::size_t worker) {
        const Tile tile = tiling[i];
        clear_tile(color, depth, tile);
        if (is_on_paper) draw_paper(color, tile);
        VisibilityBuffer& visible = visible_of[worker];
        visible.begin(tile);
        const auto shade = [&] {
            shade_visible(frame, shaders, visible, options.visibility.show, heat);
        };
        for (const BinnedTriangles& pass : passes.opaque)
            pass.for_each_in(i, [&](const ProjectedTriangle& projected) {
                if (visible.is_full()) shade();
                draw_id(frame, projected, tile, visible);
            });
        shade();
        TransparentFragments transparent;
        for_each_part(tile, count_in(passes.blended, i), [&](const Tile& part) {
            for (const BinnedTriangles& pass : passes.blended)
                pass.for_each_in(i, [&](const ProjectedTriangle& projected) {
                    draw_transparent(frame, projected, part, shaders, transparent, heat);
                });
            transparent.blend_over(color);
        });
        if (options.threads.show) tint(color, tile, worker);
    });
    if (options.show_depth) return depth_picture(depth);
    if (options.visibility.show == Show::shading) return heat.picture();
    if (options.visibility.show == Show::shadow_map) return picture_of(shadow_maps, options.size);
    return color;
}

int main(int argc, char** argv) {
    return run_scene_lesson<Options>(argc, argv, "12_visibility_buffer",
                                     "Draws a scene of any file, and shades what is seen.", render);
}
