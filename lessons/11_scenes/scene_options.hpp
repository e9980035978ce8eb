// SPDX-License-Identifier: MIT
/// @file
/// What a scene can be asked for: `--quality`, `--camera` and `--explain`, and the options of the
/// earlier lessons.
#pragma once

#include <string>

#include "05_textures/texture_options.hpp"
#include "06_phong/light_options.hpp"
#include "08_normal_maps/normal_map_options.hpp"
#include "09_shadow_maps/shadow_options.hpp"
#include "10_threading/thread_options.hpp"
#include "common/app/lesson_app.hpp"

namespace rasterbook {

/// The options that decide most of a picture's time and error, set by what docs/accuracy/costs.md
/// measured.
struct Quality {
    Filter filter;
    int shadow_size, pcf, samples_per_side;
};

constexpr Quality fast_quality{Filter::bilinear, 1024, 3, 1};
constexpr Quality balanced_quality{Filter::trilinear, 2048, 3, 1};
constexpr Quality exact_quality{Filter::trilinear, 4096, 3, 4};

/// Options that only scenes have.
struct SceneOptions {
    std::string camera;
    bool explain = false;

    void declare(OptionParser& parser);
};

/// All that this lesson's program can be asked for.
struct SceneRendererOptions : LessonOptions {
    Orbit orbit;
    bool show_depth = false;
    SceneOptions scene;
    TextureOptions texture;
    LightOptions shading{.key_light = LightKind::directional};
    NormalMapOptions normal_map;
    ShadowOptions shadow;
    ThreadOptions threads;

    SceneRendererOptions() { model = "bumpy.glb"; }

    void declare(OptionParser& parser);
};

}  // namespace rasterbook
