// SPDX-License-Identifier: MIT
/// @file
/// A scene, what its materials ask for, and what its outlines need. Introduced in lesson 07.
#pragma once

#include <utility>
#include <vector>

#include "05_textures/texture_options.hpp"
#include "06_phong/effects.hpp"
#include "07_toon/toon_options.hpp"
#include "common/app/lesson_app.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

struct ToonOptions : LessonOptions {
    Orbit orbit;
    bool show_depth = false;
    TextureOptions texture;
    ToonShading shading;

    ToonOptions() { model = "figure.obj", orbit.distance = 2.75f, orbit.pitch_degrees = 13; }
    void declare(OptionParser& parser) { declare_all(parser, texture, shading); }
};

/// What is made once, before the first picture.
struct ToonAssets {
    Scene scene;
    SurfaceTextures textures;
    std::vector<EffectMask> effects;
    HullNormals hull_normals;
};

/// @throws InputError  When an image cannot be read.
ToonAssets load_toon_scene(Scene scene, const ToonOptions& options);

}  // namespace rasterbook
