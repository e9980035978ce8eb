// SPDX-License-Identifier: MIT
/// @file
/// Shadow maps of a scene in which some materials have holes: light falls through them. Introduced
/// in lesson 11; derivation: docs/derivations/11_scenes.md.
#pragma once

#include <cstddef>
#include <utility>

#include "05_textures/interpolation.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "10_threading/threaded_shadows.hpp"
#include "11_scenes/opacity.hpp"

namespace rasterbook {

/// The triangles that cast shadows into a map, and what says where their holes are.
struct Casters {
    BinnedTriangles triangles;
    const SceneAssets* assets = nullptr;  ///< Null: none of them has holes.
    Filter filter{};                      ///< Of their textures.

    Casters(BinnedTriangles whole) : triangles(std::move(whole)) {}
    Casters(BinnedTriangles some, const SceneAssets* of, Filter by)
        : triangles(std::move(some)), assets(of), filter(by) {}

    bool has_holes(const ProjectedTriangle& caster) const {
        return assets && assets->effects[caster.triangle.material][Effect::mask];
    }
};

/// Draws a caster's depths into a tile of a map, but for its holes (Eq. 11.6).
inline void draw_caster_with_holes(ShadowMap& map, const Casters& casters,
                                   const ProjectedTriangle& caster, const Tile& tile) {
    // TODO, step 3: as main.cpp does it, with alpha_inputs(*casters.assets, caster) of opacity.hpp,
    // and with texture_color() in place of texture_sample(): what is nearer than
    // map.depths.depths()[texel + max_pcf_radius] takes the alpha test (Eq. 11.6) before its depth
    // is written. Count each fragment as one of Counter::shadow_fragments, and each that is tested
    // as one of Counter::alpha_tested_texels.
    draw_caster(map, caster, tile);
}

/// Clears a tile of a map, and draws the casters that are binned there.
inline void draw_tile(ShadowMap& map, const Casters& casters, const Tiling& tiling, std::size_t i) {
    const Tile tile = tiling[i];
    const Untraced casters_alone;
    clear_tile(map, tile);
    casters.triangles.for_each_in(i, [&](const ProjectedTriangle& caster) {
        if (casters.has_holes(caster))
            draw_caster_with_holes(map, casters, caster, tile);
        else
            draw_caster(map, caster, tile);
    });
}

/// The shadow maps of all lights of a scene.
ShadowMaps draw_shadow_maps(Workers& pool, const SceneOptions& options, const SceneAssets& assets);

}  // namespace rasterbook
