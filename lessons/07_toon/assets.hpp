// SPDX-License-Identifier: MIT
/// @file
/// A scene, what its materials ask for, and what its outlines need. Introduced in lesson 07.
#pragma once

#include <utility>
#include <vector>

#include "05_textures/texture_options.hpp"
#include "06_phong/effects.hpp"
#include "07_toon/toon_variants.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// What is made once, before the first picture.
struct ToonAssets {
    Scene scene;
    SurfaceTextures textures;
    std::vector<EffectMask> effects;
    HullNormals hull_normals;
};

/// @throws InputError  When an image cannot be read.
ToonAssets make_toon_assets(Scene scene, const TextureOptions& texture, const ToonVariant& shading);

/// @param options  As of make_phong_assets(), with ToonVariant `shading`.
template <typename Options>
ToonAssets make_toon_assets(Scene scene, const Options& options) {
    return make_toon_assets(std::move(scene), options.texture, options.shading);
}

}  // namespace rasterbook
