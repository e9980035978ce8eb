// SPDX-License-Identifier: MIT
/// @file
/// What a scene is lit by: `--light`, `--two-sided` and `--all-effects`.
#pragma once

#include "04_mvp/projection.hpp"
#include "06_phong/light.hpp"
#include "common/app/lesson_app.hpp"

namespace rasterbook {

/// What every scene with lights can be asked for, in this lesson and all later ones.
struct LightOptions {
    LightKind key_light = LightKind::point;
    bool two_sided = false;
    bool all_effects = false;

    Culling culling() const { return two_sided ? Culling::none : Culling::back_faces; }

    void declare(OptionParser& parser) {
        parser.choice("--light", key_light,
                      {{"directional", LightKind::directional},
                       {"point", LightKind::point},
                       {"spot", LightKind::spot}},
                      "What the scene is lit by");
        parser.flag("--two-sided", two_sided, "Draw the backs of faces, too");
        parser.flag("--all-effects", all_effects,
                    "Compute each effect also where it can change nothing");
    }
};

}  // namespace rasterbook
