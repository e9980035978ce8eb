// SPDX-License-Identifier: MIT
/// @file
/// What a scene calls for, and why it does not call for the rest. Introduced in lesson 12;
/// derivation: docs/derivations/12_effects.md.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "06_phong/effects.hpp"
#include "07_toon/material_outlines.hpp"
#include "11_scenes/scene_assets.hpp"

namespace rasterbook {

constexpr std::array<std::string_view, effect_count> effect_names = {
    "light",      "highlight", "texture", "specular map", "emission map", "vertex colours",
    "normal map", "shadow",    "toon",    "outline",      "mask",         "blend"};

/// A material's effects. Where one does not run, why.
struct MaterialPlan {
    EffectMask effects;
    std::array<std::string_view, effect_count> why_not;
    bool is_seen = false;  ///< A triangle has it.

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

/// What a material's plan depends on beside the material.
struct PlanInputs {
    EffectMask has;        ///< What lesson 08 knows: the maps that it has, and a highlight.
    bool has_colors;       ///< Vertices with it have colours.
    bool has_shadows;      ///< There are a caster and a receiver.
    bool has_normal_maps;  ///< They are read at all.
    bool all_effects;      ///< Each effect runs that can be given inputs which change nothing.
};

/// Plans what is computed for a material (Eq. 12.1).
///
/// With all effects forced, each one runs that can be given inputs which change nothing: a white
/// texture, a black highlight, white vertices, a flat normal map, empty shadow maps, an opacity of
/// 1; and for unlit materials the two colours of a toon material, both the same.
inline MaterialPlan plan_material(const Material& material, const PlanInputs& inputs) {
    const bool is_toon = material.toon.has_value(), is_unlit = !is_lit(material);
    const bool is_phong = !is_unlit && !is_toon;
    const bool is_masked = material.alpha == AlphaMode::mask;
    const char* const unlit = is_toon ? "a comic's paint" : "unlit";
    const auto has = [&](Effect effect) { return inputs.has[effect]; };
    MaterialPlan plan;
    plan.set(Effect::light, is_phong, unlit);
    plan.set(Effect::highlight, is_phong && has(Effect::highlight),
             !is_phong                    ? unlit
             : material.illumination == 1 ? "illum 1"
                                          : "black");
    plan.set(Effect::texture, has(Effect::texture), "names no picture");
    plan.set(Effect::specular_map, is_phong && has(Effect::specular_map),
             is_phong ? "names no picture" : unlit);
    plan.set(Effect::emission_map, has(Effect::emission_map), "names no picture");
    plan.set(Effect::vertex_colors, inputs.has_colors || inputs.all_effects, "vertices have none");
    plan.set(Effect::normal_map, !is_unlit && has(Effect::normal_map),
             is_unlit                  ? "unlit"
             : !inputs.has_normal_maps ? "none are read"
                                       : "names none");
    plan.set(Effect::shadow, !is_unlit && (inputs.has_shadows || inputs.all_effects),
             is_unlit ? "unlit" : "nothing casts one");
    plan.set(Effect::toon, is_toon, "not asked for");
    plan.set(Effect::outline, has_outline(material), "not asked for");
    plan.set(Effect::mask, is_masked, is_transparent(material) ? "no holes" : "opaque");
    plan.set(Effect::blend, is_transparent(material) || inputs.all_effects,
             is_masked ? "holes only" : "opaque");
    return plan;
}

}  // namespace rasterbook
