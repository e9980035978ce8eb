// SPDX-License-Identifier: MIT
/// @file
/// A scene with its plan.
#pragma once

#include "12_effects/effects_options.hpp"
#include "12_effects/plan.hpp"

namespace rasterbook {

/// A scene of which only those effects are drawn that its plan has.
struct PlannedScene : SceneAssets {
    ScenePlan plan;
};

/// @throws InputError  When an image cannot be read.
PlannedScene load_planned_scene(Scene scene, const EffectsOptions& options);

}  // namespace rasterbook
