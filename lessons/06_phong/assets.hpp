// SPDX-License-Identifier: MIT
/// @file
/// A scene and what its materials ask for. Introduced in lesson 06.
#pragma once

#include <utility>
#include <vector>

#include "06_phong/effects.hpp"
#include "06_phong/normals.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// What is made once, before the first picture.
struct PhongAssets {
    Scene scene;
    SurfaceTextures textures;
    std::vector<EffectMask> effects;
};

/// @param options  Has TextureOptions `texture` and LightOptions `shading`.
/// @throws InputError  When an image cannot be read.
template <typename Options>
PhongAssets make_phong_assets(Scene scene, const Options& options) {
    complete_normals(scene);
    SurfaceTextures textures = load_surface_textures(scene, options.texture);
    if (options.shading.all_effects) add_neutral_inputs(scene, textures);
    auto effects = plan_effects(scene, textures, options.shading.all_effects);
    return {std::move(scene), std::move(textures), std::move(effects)};
}

}  // namespace rasterbook
