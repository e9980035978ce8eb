// SPDX-License-Identifier: MIT
/// @file
/// A scene with its normal maps. Introduced in lesson 08.
#pragma once

#include <utility>
#include <vector>

#include "05_textures/texture_options.hpp"
#include "06_phong/effects.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// What is made once, before the first picture.
struct NormalMapAssets {
    Scene scene;
    SurfaceTextures textures;
    NormalMaps normal_maps;
    std::vector<EffectMask> effects;
};

/// @throws InputError  When an image cannot be read.
NormalMapAssets make_normal_map_assets(Scene scene, const TextureOptions& texture, bool all_effects,
                                       const NormalMapVariant& normal_map);

/// @param options  As of make_phong_assets(), with NormalMapVariant `normal_map`.
template <typename Options>
NormalMapAssets make_normal_map_assets(Scene scene, const Options& options) {
    return make_normal_map_assets(std::move(scene), options.texture, options.shading.all_effects,
                                  options.normal_map);
}

}  // namespace rasterbook
