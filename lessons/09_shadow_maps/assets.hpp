// SPDX-License-Identifier: MIT
/// @file
/// A scene with its normal maps, and where its shadows can be. Introduced in lesson 09.
#pragma once

#include <utility>
#include <vector>

#include "06_phong/effects.hpp"
#include "06_phong/normals.hpp"
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

/// @param options  As of make_normal_map_assets().
/// @throws InputError  When an image cannot be read.
template <typename Options>
ShadowAssets make_shadow_assets(Scene scene, const Options& options) {
    const bool all_effects = options.shading.all_effects;
    complete_normals(scene);
    SurfaceTextures textures = load_surface_textures(scene, options.texture);
    NormalMaps normal_maps =
        load_normal_maps(scene, options.texture, options.normal_map, all_effects);
    make_tangents(scene, normal_maps, options.normal_map);
    if (all_effects) add_neutral_inputs(scene, textures);
    auto effects = plan_effects(scene, textures, normal_maps, all_effects);
    const ShadowBounds bounds = shadow_bounds(scene);
    return {std::move(scene), std::move(textures), std::move(normal_maps), std::move(effects),
            bounds};
}

}  // namespace rasterbook
