// SPDX-License-Identifier: MIT
/// @file
/// What a scene can be asked for: `--quality`, `--camera`, and the options of lesson 10.
#pragma once

#include <string>

#include "05_textures/texture_options.hpp"
#include "10_threading/thread_options.hpp"

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

struct SceneOptions : ThreadedSceneOptions {
    std::string camera;

    SceneOptions() { model = "arbor.glb"; }
    void declare(OptionParser& parser);
};

}  // namespace rasterbook
