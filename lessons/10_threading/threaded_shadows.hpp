// SPDX-License-Identifier: MIT
/// @file
/// Lesson 09's shadow maps, drawn by several workers. Introduced in lesson 10.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "03_z_buffer/depth_buffer.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "10_threading/binned_triangles.hpp"
#include "10_threading/split.hpp"
#include "10_threading/thread_options.hpp"
#include "common/app/counters.hpp"
#include "common/app/workers.hpp"
#include "common/image/backdrop.hpp"

namespace rasterbook {

/// Clears a tile and its depths.
inline void clear_tile(Image<vec3>& color, DepthBuffer& depth, const Tile& tile) {
    for_each_strip(tile, [&](const PixelBox& strip) {
        draw_backdrop(color, strip.first, strip.last);
        depth.clear(strip.first, strip.last);
    });
}

/// Clears those of a map's depths that belong to a tile of its texels. The border around the map
/// belongs to the tiles that touch it.
inline void clear_tile(ShadowMap& map, const Tile& tile) {
    const ivec2 last_texel(map.size - 1);
    for_each_strip(tile, [&](const PixelBox& strip) {
        ivec2 first = strip.first + max_pcf_radius, last = strip.last + max_pcf_radius;
        for (int axis = 0; axis < 2; ++axis) {
            if (strip.first[axis] == 0) first[axis] -= max_pcf_radius;
            if (strip.last[axis] == last_texel[axis]) last[axis] += max_pcf_radius;
        }
        map.depths.clear(first, last);
    });
}

/// The triangles that cast shadows into a map, binned.
///
/// @param tiling  Of a picture of map.size * map.size.
/// @param set_up  Does what project_triangles() does.
inline BinnedTriangles casters_of(Workers& pool, const ShadowMap& map, const Scene& scene,
                                  const Tiling& tiling,
                                  ProjectTriangles* set_up = project_triangles) {
    std::vector<const Mesh*> meshes;
    for (const Mesh& mesh : scene.meshes)
        if (!is_outside_frustum(mesh.bounds, map.clip_from_world)) meshes.push_back(&mesh);
    const auto casts = [&](std::size_t material) {
        return casts_shadows(scene.materials[material]);
    };
    const Uncounted casters;
    const Untraced them;
    return {pool, scene, meshes, map.clip_from_world, tiling, Culling::none, casts, set_up};
}

/// Draws a caster's depths into a tile of a map.
inline void draw_caster(ShadowMap& map, const ProjectedTriangle& caster, const Tile& tile) {
    fill_tile(caster.on_screen, tile, [&](ivec2 texel, Barycentrics at) {
        count(Counter::shadow_fragments);
        map.depths.test_and_write(texel + max_pcf_radius, caster.depth.at(at));
    });
}

/// Clears a tile of a map's texels and draws the depths of the casters into it.
///
/// @param i  The tile's number in the tiling.
inline void draw_tile(ShadowMap& map, const BinnedTriangles& casters, const Tiling& tiling,
                      std::size_t i) {
    const Tile tile = tiling[i];
    const Untraced casters_alone;
    clear_tile(map, tile);
    casters.for_each_in(i,
                        [&](const ProjectedTriangle& caster) { draw_caster(map, caster, tile); });
}

/// Draws all tiles of a map.
///
/// @param casters   What there is a draw_tile() for.
template <typename Casters>
void draw_tiles(Workers& pool, ShadowMap& map, const Casters& casters, const Tiling& tiling) {
    pool.run(tiling.count(),
             [&](std::size_t i, std::size_t) { draw_tile(map, casters, tiling, i); });
}

/// Clears a map and draws the depths of a scene's casters into it: the same bits, and the same
/// count of fragments, as by draw_casters().
///
/// @param tiling    Of a picture of map.size * map.size.
/// @param is_drawn  Else the map is cleared only.
inline void draw_map(Workers& pool, ShadowMap& map, const Scene& scene, const Tiling& tiling,
                     bool is_drawn) {
    BinnedTriangles casters;
    if (is_drawn) casters = casters_of(pool, map, scene, tiling);
    draw_tiles(pool, map, casters, tiling);
}

/// The shadow maps of a scene, drawn by a pool.
ShadowMaps draw_shadow_maps(Workers& pool, const ThreadOptions& threads,
                            const ShadowOptions& options, const ShadowScene& of);

}  // namespace rasterbook
