// SPDX-License-Identifier: MIT
/// @file
/// Lesson 14: SIMD.
#include "10_threading/thread_pool.hpp"
#include "11_scenes/camera_choice.hpp"
#include "11_scenes/passes.hpp"
#include "12_effects/effects_program.hpp"
#include "13_visibility_buffer/shadow_parts.hpp"
#include "13_visibility_buffer/views.hpp"
#include "13_visibility_buffer/visibility_options.hpp"
#include "13_visibility_buffer/visible_shading.hpp"
#include "14_simd/wide_triangles.hpp"
#include "14_simd/width.hpp"

using namespace rasterbook;

struct Options : EffectsOptions {
    VisibilityOptions visibility;
    WidthOptions wide;

    Options() { threads.tile = 64; }  // a triangle is set up again in each tile
    void declare(OptionParser& parser) {
        EffectsOptions::declare(parser);
        visibility.declare(parser);
        wide.declare(parser);
    }
};

static Image<vec3> render(const Options& options, const PlannedScene& assets, Workers& pool,
                          StepClock& clock) {
    const Camera camera = camera_of_picture(options, assets.scene).camera;
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
    const Tiling tiling = options.threads.tiling_of(options.size, pool.size());
    const BinnedPasses triangles(pool, assets, camera, tiling, wide.project_triangles);

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
        triangles.for_each_opaque_in(i, [&](const ProjectedTriangle& projected) {
            if (visible.is_full()) shade();
            wide.draw_id(frame, projected, tile, depths, visible);
        });
        shade();
        draw_background(color, tile, depths, assets.is_drawing);
        TransparentFragments transparent;
        for_each_part(tile, triangles.count_blended_in(i), [&](const Tile& part) {
            triangles.for_each_blended_in(i, [&](const ProjectedTriangle& projected) {
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
    return run_effects_lesson<Options>(
        argc, argv, "14_simd", "Draws a scene of any file, several pixels at a time.", render);
}
