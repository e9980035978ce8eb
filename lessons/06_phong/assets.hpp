// SPDX-License-Identifier: MIT
/// @file
/// A scene and what its materials ask for. Introduced in lesson 06.
#pragma once

#include <utility>
#include <vector>

#include "05_textures/texture_options.hpp"
#include "06_phong/effects.hpp"
#include "06_phong/light_options.hpp"
#include "common/app/lesson_app.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

struct PhongOptions : LessonOptions {
    Orbit orbit;
    bool show_depth = false;
    TextureOptions texture;
    LightOptions shading;

    PhongOptions() { model = "scene.obj"; }
    void declare(OptionParser& parser) { declare_all(parser, texture, shading); }
};

/// What is made once, before the first picture.
struct PhongAssets {
    Scene scene;
    SurfaceTextures textures;
    std::vector<EffectMask> effects;
};

/// @param all_effects  Each effect is planned also where it can change nothing.
/// @throws InputError  When an image cannot be read.
PhongAssets make_phong_assets(Scene scene, const TextureOptions& texture, bool all_effects);

inline PhongAssets load_phong_scene(Scene scene, const PhongOptions& options) {
    return make_phong_assets(std::move(scene), options.texture, options.shading.all_effects);
}

}  // namespace rasterbook
