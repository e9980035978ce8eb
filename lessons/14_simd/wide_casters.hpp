// SPDX-License-Identifier: MIT
/// @file
/// Shadow maps drawn several texels at a time. Introduced in lesson 14;
/// derivation: docs/derivations/14_simd.md.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "05_textures/interpolation.hpp"
#include "09_shadow_maps/shadow_map.hpp"
#include "10_threading/split.hpp"
#include "10_threading/threaded_shadows.hpp"
#include "11_scenes/blending.hpp"
#include "11_scenes/casters.hpp"
#include "11_scenes/opacity.hpp"
#include "14_simd/simd.hpp"
#include "14_simd/wide_textures.hpp"
#include "14_simd/wide_triangles.hpp"
#include "common/app/counters.hpp"

namespace rasterbook {

/// Draws a caster's depths into a tile of a map, but for its holes (Eq. 11.6).
///
/// @param covered  Is increased by the texels that the caster covers, its holes with them.
template <typename F>
void draw_caster_with_holes(TileDepths& depths, const Casters& casters,
                            const ProjectedTriangle& caster, const Tile& tile,
                            LaneSum<F>& covered) {
    const auto& [surface, setup, colors] = alpha_inputs(*casters.assets, caster);
    fill_tile<F>(caster.on_screen, tile, [&](ivec2 texel, MaskOf<F> inside, const Vec3<F>& where) {
        covered.add(inside);
        const F depth = depth_at<F>(caster.depth, where);
        const MaskOf<F> nearer = inside & (depth > load<F>(depths.from(texel)));
        if (!any_of(nearer)) return;
        count(Counter::alpha_tested_texels, static_cast<std::uint64_t>(count_of(nearer)));
        const PerspectiveBarycentrics<F> at = perspective_correct(setup, where);
        const glm::vec<4, F> in_texture = texture_color(surface, at, casters.filter);
        const MaskOf<F> is_there = passes_alpha_test(
            opacity_at(surface, colors, at.here, in_texture), surface.material.alpha_cutoff);
        depths.test_and_write<F>(texel, nearer & is_there, depth);
    });
}

/// Clears a tile of a map, and draws the casters that are binned there.
template <typename F>
void draw_tile(ShadowMap& map, const Casters& casters, const Tiling& tiling, std::size_t i) {
    const Tile tile = tiling[i];
    const auto [first, last] = tile.box;
    const bool touches_border =
        std::min(first.x, first.y) == 0 || std::max(last.x, last.y) == map.size - 1;
    if (touches_border) clear_tile(map, tile);  // the rest is written by copy_to()
    TileDepths depths(tile);
    LaneSum<F> covered_texels;
    casters.triangles.for_each_in(i, [&](const ProjectedTriangle& caster) {
        if (casters.has_holes(caster))
            return draw_caster_with_holes<F>(depths, casters, caster, tile, covered_texels);
        fill_tile<F>(caster.on_screen, tile,
                     [&](ivec2 texel, MaskOf<F> covered, const Vec3<F>& at) {
                         covered_texels.add(covered);
                         depths.test_and_write<F>(texel, covered, depth_at<F>(caster.depth, at));
                     });
    });
    count(Counter::shadow_fragments, covered_texels.total());
    depths.copy_to(map.depths.depths(), tile, ivec2(max_pcf_radius));
}

}  // namespace rasterbook
