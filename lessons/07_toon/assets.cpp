// SPDX-License-Identifier: MIT
#include "07_toon/assets.hpp"

#include <utility>

#include "06_phong/assets.hpp"

namespace rasterbook {

ToonAssets make_toon_assets(Scene scene, const TextureOptions& texture,
                            const ToonVariant& shading) {
    PhongAssets made = make_phong_assets(std::move(scene), texture, shading.all_effects);
    HullNormals hull_normals = make_hull_normals(made.scene, shading.outline);
    return {std::move(made.scene), std::move(made.textures), std::move(made.effects),
            std::move(hull_normals)};
}

}  // namespace rasterbook
