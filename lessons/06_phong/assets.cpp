// SPDX-License-Identifier: MIT
#include "06_phong/assets.hpp"

#include <utility>

#include "06_phong/load_surface_textures.hpp"
#include "06_phong/normals.hpp"

namespace rasterbook {

PhongAssets make_phong_assets(Scene scene, const TextureOptions& texture, bool all_effects) {
    complete_normals(scene);
    SurfaceTextures textures = load_surface_textures(scene, texture);
    if (all_effects) add_neutral_inputs(scene, textures);
    auto effects = plan_effects(scene, textures, all_effects);
    return {std::move(scene), std::move(textures), std::move(effects)};
}

}  // namespace rasterbook
