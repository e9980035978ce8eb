// SPDX-License-Identifier: MIT
/// @file
/// A scene with its normal maps, and where its shadows can be. Introduced in lesson 09.
#pragma once

#include <utility>
#include <vector>

#include "05_textures/texture_options.hpp"
#include "06_phong/effects.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// What is made once, before the first picture.
struct ShadowAssets {
    Scene scene;
    SurfaceTextures textures;
    NormalMaps normal_maps;
    std::vector<EffectMask> effects;
    ShadowBounds shadow_bounds;
};

/// @throws InputError  When an image cannot be read.
ShadowAssets make_shadow_assets(Scene scene, const TextureOptions& texture, bool all_effects,
                                const NormalMapOptions& normal_map);

/// @param options  As of make_normal_map_assets().
template <typename Options>
ShadowAssets make_shadow_assets(Scene scene, const Options& options) {
    return make_shadow_assets(std::move(scene), options.texture, options.shading.all_effects,
                              options.normal_map);
}

}  // namespace rasterbook
