// SPDX-License-Identifier: MIT
/// @file
/// What a scene calls for, and why it does not call for the rest. Introduced in lesson 11;
/// derivation: docs/derivations/11_scenes.md.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "06_phong/shading_variants.hpp"
#include "08_normal_maps/normal_map_variants.hpp"
#include "09_shadow_maps/shadowed_scene.hpp"
#include "11_scenes/toon_look.hpp"

namespace rasterbook {

/// What may be computed for a material.
enum class Effect {
    light,
    highlight,
    texture,
    specular_map,
    vertex_colors,
    normal_map,
    shadow,
    toon,
    outline,
    mask,
    blend,
    count
};

constexpr std::size_t effect_count = static_cast<std::size_t>(Effect::count);

constexpr std::array<std::string_view, effect_count> effect_names = {
    "light",  "highlight", "texture", "specular map", "vertex colours", "normal map",
    "shadow", "toon",      "outline", "mask",         "blend"};

/// A material's effects. Where one does not run, why.
struct MaterialPlan {
    std::array<bool, effect_count> runs{};
    std::array<std::string, effect_count> why_not;
    bool is_seen = false;   ///< A triangle has it.
    bool is_glass = false;  ///< What lies behind shines through, whatever is forced.
    bool two_sided = false;

    bool operator[](Effect effect) const { return runs[static_cast<std::size_t>(effect)]; }

    /// @param reason  For which it does not run, if so.
    void set(Effect effect, bool is_on, std::string reason) {
        const auto i = static_cast<std::size_t>(effect);
        runs[i] = is_on;
        why_not[i] = is_on ? std::string() : std::move(reason);
    }
};

/// The plan of a scene: for each material its effects.
///
/// With all effects forced, each one runs that can be given inputs which change nothing: a white
/// texture, a black highlight, white corners, a flat normal map, empty depth maps, an opacity of 1;
/// and for unlit materials the two colours of a comic, both the same.
class ScenePlan {
  public:
    std::vector<MaterialPlan> materials;

    /// @param has_lights    Whether there is any light.
    /// @param has_shadows   Whether a light throws shadows: there are a caster and a receiver.
    /// @param normal_maps   Whether they are read at all.
    /// @param options       Whether all effects are forced, and all materials seen from behind.
    ScenePlan(const ShadowedScene& scene, bool has_lights, bool has_shadows, bool normal_maps,
              const LightOptions& options)
        : materials(scene.materials.size()) {
        const bool all_effects = options.all_effects;
        std::vector<bool> has_colors(scene.materials.size());
        for (const Mesh& mesh : scene.meshes)
            for (const Triangle& triangle : mesh.triangles) {
                materials[triangle.material].is_seen = true;
                if (!mesh.colors.empty()) has_colors[triangle.material] = true;
            }
        for (std::size_t i = 0; i < materials.size(); ++i) {
            MaterialPlan& plan = materials[i];
            const Material& material = scene.materials[i];
            const bool is_unlit = material.illumination == 0, is_toon = material.toon.has_value();
            const bool is_lit = !is_unlit && !is_toon;
            const bool is_outline = i >= first_outline_material(scene.materials);
            const char* const unlit = is_toon ? "a comic's paint" : "unlit";
            plan.two_sided = !is_outline && (material.two_sided || options.two_sided);
            plan.set(Effect::light, is_lit && has_lights, is_lit ? "no lights" : unlit);
            plan.set(Effect::highlight, is_lit && scene.effects[i].highlight,
                     !is_lit                      ? unlit
                     : material.illumination == 1 ? "illum 1"
                                                  : "black");
            plan.set(Effect::texture, scene.effects[i].diffuse_map, "names no picture");
            plan.set(Effect::specular_map, is_lit && scene.effects[i].specular_map,
                     is_lit ? "names no picture" : unlit);
            plan.set(Effect::vertex_colors, has_colors[i] || all_effects, "corners have none");
            plan.set(Effect::normal_map, !is_unlit && scene.normal_textures[i] != nullptr,
                     is_unlit       ? "unlit"
                     : !normal_maps ? "none are read"
                                    : "names none");
            plan.set(Effect::shadow, !is_unlit && (has_shadows || all_effects),
                     is_unlit ? "unlit" : "nothing is thrown");
            plan.set(Effect::toon, is_toon || (is_unlit && plan.is_seen && all_effects),
                     "not asked for");
            plan.set(Effect::outline, has_outline(material), "not asked for");
            const bool is_masked = material.alpha == AlphaMode::mask;
            plan.is_glass =
                !is_masked && (material.alpha == AlphaMode::blend || material.opacity < 1);
            plan.set(Effect::mask, is_masked, "opaque");
            plan.set(Effect::blend, plan.is_glass || all_effects,
                     is_masked ? "holes only" : "opaque");
        }
    }

    /// Whether an effect runs for any material that is seen.
    bool any(Effect effect) const {
        for (const MaterialPlan& plan : materials)
            if (plan.is_seen && plan[effect]) return true;
        return false;
    }

    /// Whether it runs for all of them, and there are some.
    bool all(Effect effect) const {
        bool has_some = false;
        for (const MaterialPlan& plan : materials) {
            if (plan.is_seen && !plan[effect]) return false;
            has_some = has_some || plan.is_seen;
        }
        return has_some;
    }
};

}  // namespace rasterbook
