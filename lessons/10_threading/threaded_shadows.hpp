// SPDX-License-Identifier: MIT
/// @file
/// Lesson 09's depth maps, drawn by several workers. Introduced in lesson 10.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "03_z_buffer/depth_buffer.hpp"
#include "09_shadow_maps/shadowed_scene.hpp"
#include "10_threading/binned_triangles.hpp"
#include "10_threading/split.hpp"
#include "10_threading/thread_options.hpp"
#include "10_threading/thread_pool.hpp"
#include "common/backdrop.hpp"
#include "common/counters.hpp"

namespace rasterbook {

/// Clears a part of a picture and its depths.
inline void clear_part(Image<vec3>& color, DepthBuffer& depth, const Part& part) {
    for_each_strip(part, [&](const PixelBox& strip) {
        draw_backdrop(color, strip.first, strip.last);
        depth.clear(strip.first, strip.last);
    });
}

/// Clears what of a map's depths belongs to a part of its texels. The border around the map belongs
/// to the parts that touch it.
inline void clear_part(ShadowMap& map, const Part& part) {
    const ivec2 last_texel(map.size - 1);
    for_each_strip(part, [&](const PixelBox& strip) {
        ivec2 first = strip.first + most_pcf_radius, last = strip.last + most_pcf_radius;
        for (int axis = 0; axis < 2; ++axis) {
            if (strip.first[axis] == 0) first[axis] -= most_pcf_radius;
            if (strip.last[axis] == last_texel[axis]) last[axis] += most_pcf_radius;
        }
        map.depths.clear(first, last);
    });
}

/// Clears a map and draws the depths of a scene's casters into it: the same bits, and the same
/// count of fragments, as by draw_casters().
///
/// @param pool      Has size() and run() as ThreadPool does.
/// @param parts     Of a picture of map.size * map.size.
/// @param is_drawn  Else the map is cleared only.
/// @param counters  One for each worker of the pool.
template <typename Pool, typename CounterPolicy>
void draw_map(Pool& pool, ShadowMap& map, const ShadowedScene& scene, const Parts& parts,
              bool is_drawn, WorkerCounters<CounterPolicy>& counters) {
    std::vector<const Mesh*> meshes;
    for (const Mesh& mesh : scene.meshes)
        if (is_drawn && !is_outside_frustum(mesh.bounds, map.clip_from_world))
            meshes.push_back(&mesh);
    WorkerCounters<NoCounters> uncounted(pool.size());
    const auto casts = [&](std::size_t material) { return scene.casts(material); };
    const BinnedTriangles casters(pool, meshes, map.clip_from_world, parts, true, casts, uncounted);
    pool.run(parts.count(), [&](std::size_t part, std::size_t worker) {
        CounterPolicy& own_counters = counters[worker];
        clear_part(map, parts[part]);
        for (const Chunk& chunk : casters.chunks)
            for (const std::size_t i : chunk.of(part)) {
                const ReadyTriangle& ready = chunk.triangles[i];
                const TriangleDepth depth(ready.depths);
                fill_part(ready.on_screen, parts[part], [&](ivec2 texel, vec3 weights) {
                    own_counters.add(Counter::shadow_fragments);
                    map.depths.test_and_write(texel + most_pcf_radius, depth.at(weights));
                });
            }
    });
}

/// The depth maps of all lights, as lesson 09 draws them.
///
/// @param counters  One for each worker of the pool.
template <typename Pool, typename CounterPolicy>
Shadows draw_shadows(Pool& pool, const ThreadOptions& threads, const ShadowVariant& variant,
                     bool all_effects, const ShadowedScene& scene,
                     std::span<const Light, light_casts.size()> lights,
                     WorkerCounters<CounterPolicy>& counters) {
    const Parts parts = threads.parts_of(ivec2(variant.size), pool.size());
    return {variant, all_effects, scene, lights, counters[0], [&](ShadowMap& map, bool is_drawn) {
                draw_map(pool, map, scene, parts, is_drawn, counters);
            }};
}

}  // namespace rasterbook
