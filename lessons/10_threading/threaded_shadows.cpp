// SPDX-License-Identifier: MIT
#include "10_threading/threaded_shadows.hpp"

namespace rasterbook {

ShadowMaps draw_shadow_maps(Workers& pool, const ThreadOptions& threads,
                            const ShadowOptions& options, const ShadowScene& of) {
    const Tiling tiling = threads.tiling_of(ivec2(options.size), pool.size());
    return draw_shadow_maps(options, of, [&](ShadowMap& map, bool is_drawn) {
        draw_map(pool, map, of.scene, tiling, is_drawn);
    });
}

}  // namespace rasterbook
