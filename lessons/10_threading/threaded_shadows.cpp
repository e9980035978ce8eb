// SPDX-License-Identifier: MIT
#include "10_threading/threaded_shadows.hpp"

namespace rasterbook {

ShadowMaps draw_shadow_maps(Workers& pool, const ThreadOptions& threads,
                            const ShadowVariant& variant, bool all_effects, const Scene& scene,
                            const ShadowBounds& bounds, std::span<const Light> lights,
                            std::span<const bool> casts) {
    const Tiling tiling = threads.tiling_of(ivec2(variant.size), pool.size());
    return draw_shadow_maps(
        variant, all_effects, scene, bounds, lights, casts,
        [&](ShadowMap& map, bool is_drawn) { draw_map(pool, map, scene, tiling, is_drawn); });
}

}  // namespace rasterbook
