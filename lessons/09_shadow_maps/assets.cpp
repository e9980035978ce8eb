// SPDX-License-Identifier: MIT
#include "09_shadow_maps/assets.hpp"

#include <utility>

#include "08_normal_maps/assets.hpp"

namespace rasterbook {

ShadowAssets load_shadow_scene(Scene scene, const ShadowSceneOptions& options) {
    NormalMapAssets made = make_normal_map_assets(std::move(scene), options.texture,
                                                  options.shading.all_effects, options.normal_map);
    const ShadowBounds bounds = shadow_bounds(made.scene);
    return {std::move(made.scene), std::move(made.textures), std::move(made.normal_maps),
            std::move(made.effects), bounds};
}

}  // namespace rasterbook
