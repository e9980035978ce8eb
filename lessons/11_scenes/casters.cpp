// SPDX-License-Identifier: MIT
#include "11_scenes/casters.hpp"

namespace rasterbook {

ShadowMaps draw_shadow_maps(Workers& pool, const SceneOptions& options, const SceneAssets& assets) {
    const Tiling tiling = options.threads.tiling_of(ivec2(options.shadow.size), pool.size());
    return draw_shadow_maps(options.shadow, shadow_scene(assets, options.shading.all_effects),
                            [&](ShadowMap& map, bool is_drawn) {
                                Casters casters({}, &assets, options.texture.filter);
                                if (is_drawn)
                                    casters.triangles = casters_of(pool, map, assets.scene, tiling);
                                draw_tiles(pool, map, casters, tiling);
                            });
}

}  // namespace rasterbook
