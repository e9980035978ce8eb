// SPDX-License-Identifier: MIT
#include "08_normal_maps/assets.hpp"

#include <utility>

#include "06_phong/load_surface_textures.hpp"
#include "06_phong/normals.hpp"
#include "08_normal_maps/load_normal_maps.hpp"

namespace rasterbook {

NormalMapAssets make_normal_map_assets(Scene scene, const TextureOptions& texture, bool all_effects,
                                       const NormalMapOptions& normal_map) {
    complete_normals(scene);
    SurfaceTextures textures = load_surface_textures(scene, texture);
    NormalMaps normal_maps =
        load_normal_maps(scene, texture, normal_map.space, all_effects, normal_map);
    make_tangents(scene, normal_maps);
    if (all_effects) add_neutral_inputs(scene, textures);
    auto effects = plan_effects(scene, textures, normal_maps, all_effects);
    return {std::move(scene), std::move(textures), std::move(normal_maps), std::move(effects)};
}

}  // namespace rasterbook
