// SPDX-License-Identifier: MIT
/// @file
/// What a scene can be asked for: `--quality`, `--camera` and `--explain`, and the knobs of the
/// earlier lessons.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "05_textures/texture_variants.hpp"
#include "06_phong/shading_variants.hpp"
#include "08_normal_maps/normal_map_variants.hpp"
#include "09_shadow_maps/shadow_variants.hpp"
#include "10_threading/thread_options.hpp"
#include "common/app/lesson_app.hpp"

namespace rasterbook {

/// The knobs that decide most of a picture's time and error, set by what docs/accuracy/costs.md
/// measured.
struct Quality {
    Filter filter;
    int shadow_size, pcf, samples_per_side;
};

constexpr Quality fast_quality{Filter::bilinear, 1024, 3, 1};
constexpr Quality balanced_quality{Filter::trilinear, 2048, 3, 1};
constexpr Quality exact_quality{Filter::trilinear, 4096, 3, 4};

struct SceneOptions {
    std::string camera;
    bool explain = false;

    /// To be called before the other knobs are declared: what they say counts more than --quality.
    ///
    /// @param options  LessonOptions with TextureOptions `texture` and ShadowVariant `shadow`.
    template <typename Options>
    void declare(Knobs& knobs, Options& options) {
        const auto choose = [&options](const Quality& quality) {
            options.texture.filter = quality.filter;
            options.shadow.size = quality.shadow_size;
            options.shadow.pcf = quality.pcf;
            if (options.samples_per_side == LessonOptions().samples_per_side)
                options.samples_per_side = quality.samples_per_side;
        };
        knobs.choice("--quality", "balanced",
                     {{"fast", [=] { choose(fast_quality); }},
                      {"balanced", [=] { choose(balanced_quality); }},
                      {"exact", [=] { choose(exact_quality); }}},
                     "Sets --filter, --shadow-size, --pcf and --samples together");
        knobs.text(
            "--camera", camera, "NAME|NUMBER|orbit|fit",
            "One of the file's cameras, or our own [the first one, if no orbit is asked for]");
        knobs.flag("--explain", explain,
                   "Say what is drawn, what is left out and why, and how long it takes");
    }
};

/// All that this lesson's program can be asked for.
struct SceneRendererOptions : LessonOptions {
    Orbit orbit;
    bool show_depth = false;
    SceneOptions scene;
    TextureOptions texture;
    LightOptions shading{.key_light = LightKind::directional};
    NormalMapVariant normal_map;
    ShadowVariant shadow;
    ThreadOptions threads;

    SceneRendererOptions() { model = "bumpy.glb"; }
    void declare(Knobs& knobs) {
        scene.declare(knobs, *this);
        declare_all(knobs, texture, shading, normal_map, shadow, threads);
    }
};

}  // namespace rasterbook
