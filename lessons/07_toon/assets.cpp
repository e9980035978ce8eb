// SPDX-License-Identifier: MIT
#include "07_toon/assets.hpp"

#include <utility>

namespace rasterbook {

ToonAssets make_toon_assets(Scene scene, const TextureOptions& texture,
                            const ToonVariant& shading) {
    complete_normals(scene);
    SurfaceTextures textures = load_surface_textures(scene, texture);
    if (shading.all_effects) add_neutral_inputs(scene, textures);
    auto effects = plan_effects(scene, textures, shading.all_effects);
    HullNormals hull_normals = make_hull_normals(scene, shading.outline);
    return {std::move(scene), std::move(textures), std::move(effects), std::move(hull_normals)};
}

}  // namespace rasterbook
