// SPDX-License-Identifier: MIT
#include "07_toon/assets.hpp"

#include <utility>

#include "06_phong/assets.hpp"

namespace rasterbook {

ToonAssets load_toon_scene(Scene scene, const ToonOptions& options) {
    PhongAssets made =
        make_phong_assets(std::move(scene), options.texture, options.shading.all_effects);
    HullNormals hull_normals = make_hull_normals(made.scene, options.shading.outline);
    return {std::move(made.scene), std::move(made.textures), std::move(made.effects),
            std::move(hull_normals)};
}

}  // namespace rasterbook
