// SPDX-License-Identifier: MIT
/// @file
/// What a scene calls for, and why it does not call for the rest. Introduced in lesson 11;
/// derivation: docs/derivations/11_scenes.md.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "06_phong/effects.hpp"
#include "08_normal_maps/normal_mapping.hpp"

namespace rasterbook {

constexpr std::array<std::string_view, effect_count> effect_names = {
    "light",      "highlight", "texture", "specular map", "emission map", "vertex colours",
    "normal map", "shadow",    "toon",    "outline",      "mask",         "blend"};

/// A material's effects. Where one does not run, why.
struct MaterialPlan {
    EffectMask effects;
    std::array<std::string_view, effect_count> why_not;
    bool is_seen = false;         ///< A triangle has it.
    bool is_transparent = false;  ///< Blended, also without --all-effects.
    bool two_sided = false;

    bool operator[](Effect effect) const { return effects[effect]; }

    /// @param reason  Why it does not run; of no meaning if it does. A literal: it is not copied.
    void set(Effect effect, bool is_on, const char* reason) {
        effects.set(effect, is_on);
        why_not[static_cast<std::size_t>(effect)] = is_on ? "" : reason;
    }
};

/// The plan of a scene: for each material its effects.
struct ScenePlan {
    std::vector<MaterialPlan> materials;

    /// Whether an effect runs for any material that is seen.
    bool any(Effect effect) const {
        for (const MaterialPlan& plan : materials)
            if (plan.is_seen && plan[effect]) return true;
        return false;
    }
};

/// What a plan depends on beside the scene itself.
struct PlanInputs {
    bool has_lights;   ///< There is any light.
    bool has_shadows;  ///< There are a caster and a receiver.
    bool normal_maps;  ///< They are read at all.
    bool two_sided;    ///< All materials are seen from behind, too.
    bool all_effects;  ///< Each effect runs that can be given inputs which change nothing.
};

/// Plans what is computed.
///
/// With all effects forced, each one runs that can be given inputs which change nothing: a white
/// texture, a black highlight, white vertices, a flat normal map, empty shadow maps, an opacity of
/// 1; and for unlit materials the two colours of a toon material, both the same.
///
/// @param scene,textures,normal_maps  With those inputs already.
ScenePlan plan_scene(const Scene& scene, const SurfaceTextures& textures,
                     const NormalMaps& normal_maps, const PlanInputs& inputs);

}  // namespace rasterbook
