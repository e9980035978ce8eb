// SPDX-License-Identifier: MIT
#include "09_shadow_maps/assets.hpp"

#include <utility>

#include "08_normal_maps/assets.hpp"

namespace rasterbook {

ShadowAssets make_shadow_assets(Scene scene, const TextureOptions& texture, bool all_effects,
                                const NormalMapOptions& normal_map) {
    NormalMapAssets made =
        make_normal_map_assets(std::move(scene), texture, all_effects, normal_map);
    const ShadowBounds bounds = shadow_bounds(made.scene);
    return {std::move(made.scene), std::move(made.textures), std::move(made.normal_maps),
            std::move(made.effects), bounds};
}

}  // namespace rasterbook
