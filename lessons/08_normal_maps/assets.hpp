// SPDX-License-Identifier: MIT
/// @file
/// A scene with its normal maps. Introduced in lesson 08.
#pragma once

#include <utility>
#include <vector>

#include "05_textures/texture_options.hpp"
#include "06_phong/effects.hpp"
#include "06_phong/light_options.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "common/app/lesson_app.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

struct NormalMapSceneOptions : LessonOptions {
    Orbit orbit;
    bool show_depth = false;
    TextureOptions texture;
    LightOptions shading;
    NormalMapOptions normal_map;

    NormalMapSceneOptions() { model = "scene_bumpy.obj"; }
    void declare(OptionParser& parser) { declare_all(parser, texture, shading, normal_map); }
};

/// What is made once, before the first picture.
struct NormalMapAssets {
    Scene scene;
    SurfaceTextures textures;
    NormalMaps normal_maps;
    std::vector<EffectMask> effects;
};

/// @throws InputError  When an image cannot be read.
NormalMapAssets make_normal_map_assets(Scene scene, const TextureOptions& texture, bool all_effects,
                                       const NormalMapOptions& normal_map);

inline NormalMapAssets load_normal_map_scene(Scene scene, const NormalMapSceneOptions& options) {
    return make_normal_map_assets(std::move(scene), options.texture, options.shading.all_effects,
                                  options.normal_map);
}

}  // namespace rasterbook
