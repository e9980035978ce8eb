// SPDX-License-Identifier: MIT
/// @file
/// A scene and what its materials ask for. Introduced in lesson 06.
#pragma once

#include <utility>
#include <vector>

#include "05_textures/texture_options.hpp"
#include "06_phong/effects.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// What is made once, before the first picture.
struct PhongAssets {
    Scene scene;
    SurfaceTextures textures;
    std::vector<EffectMask> effects;
};

/// @param all_effects  Each effect is planned also where it can change nothing.
/// @throws InputError  When an image cannot be read.
PhongAssets make_phong_assets(Scene scene, const TextureOptions& texture, bool all_effects);

/// @param options  Has TextureOptions `texture` and LightOptions `shading`.
template <typename Options>
PhongAssets make_phong_assets(Scene scene, const Options& options) {
    return make_phong_assets(std::move(scene), options.texture, options.shading.all_effects);
}

}  // namespace rasterbook
