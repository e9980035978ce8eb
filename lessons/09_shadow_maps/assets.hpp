// SPDX-License-Identifier: MIT
/// @file
/// A scene with its normal maps, and where its shadows can be. Introduced in lesson 09.
#pragma once

#include <utility>
#include <vector>

#include "05_textures/texture_options.hpp"
#include "06_phong/effects.hpp"
#include "06_phong/light_options.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "common/app/lesson_app.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

struct ShadowSceneOptions : LessonOptions {
    Orbit orbit;
    bool show_depth = false;
    TextureOptions texture;
    LightOptions shading{.key_light = LightKind::directional};
    NormalMapOptions normal_map;
    ShadowOptions shadow;

    ShadowSceneOptions() { model = "scene_bumpy.obj"; }
    void declare(OptionParser& parser) {
        declare_all(parser, texture, shading, normal_map, shadow);
    }
};

/// What is made once, before the first picture.
struct ShadowAssets {
    Scene scene;
    SurfaceTextures textures;
    NormalMaps normal_maps;
    std::vector<EffectMask> effects;
    ShadowBounds shadow_bounds;
};

/// @throws InputError  When an image cannot be read.
ShadowAssets load_shadow_scene(Scene scene, const ShadowSceneOptions& options);

}  // namespace rasterbook
