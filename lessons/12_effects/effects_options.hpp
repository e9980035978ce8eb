// SPDX-License-Identifier: MIT
/// @file
/// The options of lesson 11, and `--explain`.
#pragma once

#include "11_scenes/scene_options.hpp"

namespace rasterbook {

struct EffectsOptions : SceneOptions {
    bool explain = false;

    EffectsOptions() { model = "bumpy.glb"; }

    void declare(OptionParser& parser) {
        SceneOptions::declare(parser);
        parser.flag("--explain", explain,
                    "Say what is drawn, what is left out and why, and how long it takes");
    }
};

}  // namespace rasterbook
