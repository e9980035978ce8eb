// SPDX-License-Identifier: MIT
/// @file
/// A scene, what its materials ask for, and what its outlines need. Introduced in lesson 07.
#pragma once

#include <utility>
#include <vector>

#include "06_phong/effects.hpp"
#include "06_phong/normals.hpp"
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

/// @param options  As of make_phong_assets(), with ToonVariant `shading`.
/// @throws InputError  When an image cannot be read.
template <typename Options>
ToonAssets make_toon_assets(Scene scene, const Options& options) {
    complete_normals(scene);
    SurfaceTextures textures = load_surface_textures(scene, options.texture);
    if (options.shading.all_effects) add_neutral_inputs(scene, textures);
    auto effects = plan_effects(scene, textures, options.shading.all_effects);
    HullNormals hull_normals = make_hull_normals(scene, options.shading.outline);
    return {std::move(scene), std::move(textures), std::move(effects), std::move(hull_normals)};
}

}  // namespace rasterbook
