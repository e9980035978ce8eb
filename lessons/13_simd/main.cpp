// SPDX-License-Identifier: MIT
/// @file
/// Lesson 13: SIMD.
#include "10_threading/thread_pool.hpp"
#include "11_scenes/scene_camera.hpp"
#include "11_scenes/scene_options.hpp"
#include "11_scenes/scene_program.hpp"
#include "12_visibility_buffer/shadow_parts.hpp"
#include "12_visibility_buffer/views.hpp"
#include "12_visibility_buffer/visibility_options.hpp"
#include "12_visibility_buffer/visible_shading.hpp"
#include "13_simd/wide_triangles.hpp"
#include "13_simd/width.hpp"

using namespace rasterbook;

struct Options : SceneRendererOptions {
    VisibilityOptions visibility;
    WidthOptions wide;

    Options() { threads.tile = 64; }  // a triangle is set up again in each tile
    void declare(OptionParser& parser) {
        SceneRendererOptions::declare(parser);
        visibility.declare(parser);
        wide.declare(parser);
    }
};

static Image<vec3> render(const Options& options, const SceneAssets& assets, Workers& pool,
                          StepClock& clock) {
    const auto& [scene, textures, normal_maps, bounds, lit_by, plan, hulls, is_on_paper] = assets;
    const Camera camera = camera_of_picture(options, scene).camera;
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    const WideDrawing wide = drawing_of_width(options.wide.width);
    clock.begin("casters");
    const ShadowMapsOnDemand shadow_maps(pool, options.visibility.shadow_part, options, assets,
                                         wide.project_triangles);
    Image<vec3> color(options.size, unset);
    DepthBuffer depth(options.size, unset, camera.farthest_depth());
    std::vector<VisibilityBuffer> visible_of(
        pool.size(), VisibilityBuffer(options.visibility.most_ids(), TileDepths::padding));
    HeatMap heat(options.visibility.show, options.size);

    clock.begin("triangles");
    const std::vector<Mesh> outlines = outlines_of(assets, camera);
    const std::vector<const Mesh*> meshes = seen_meshes(scene, outlines, clip_from_world);
    const Tiling tiling = options.threads.tiling_of(options.size, pool.size());
    const BinnedPasses passes =
        bin_passes(pool, assets, meshes, clip_from_world, tiling, wide.project_triangles);

    clock.begin("picture");
    const Frame frame = make_frame(options, assets, camera, shadow_maps, color, depth);
    pool.run(tiling.count(), [&](std::size_t i, std::size_t worker) {
        const Tile tile = tiling[i];
        TileDepths depths(tile, depth.farthest());
        VisibilityBuffer& visible = visible_of[worker];
        visible.begin(tile);
        const auto shade = [&] {
            wide.shade_visible(frame, visible, options.visibility.show, heat);
        };
        for (const BinnedTriangles& pass : passes.opaque)
            pass.for_each_in(i, [&](const ProjectedTriangle& projected) {
                if (visible.is_full()) shade();
                wide.draw_id(frame, projected, tile, depths, visible);
            });
        shade();
        draw_background(color, tile, depths, is_on_paper);
        TransparentFragments transparent;
        for_each_part(tile, count_in(passes.blended, i), [&](const Tile& part) {
            for (const BinnedTriangles& pass : passes.blended)
                pass.for_each_in(i, [&](const ProjectedTriangle& projected) {
                    wide.draw_transparent(frame, projected, part, depths, transparent, heat);
                });
            transparent.blend_over(color);
        });
        if (options.show_depth) depths.copy_to(depth.depths(), tile, ivec2(0));
        if (options.threads.show) tint(color, tile, worker);
    });
    if (options.show_depth) return depth_picture(depth);
    if (options.visibility.show == Show::shading) return heat.picture();
    if (options.visibility.show == Show::shadow_map) return picture_of(shadow_maps, options.size);
    return color;
}

int main(int argc, char** argv) {
    return run_scene_lesson<Options>(
        argc, argv, "13_simd", "Draws a scene of any file, several pixels at a time.", render);
}
