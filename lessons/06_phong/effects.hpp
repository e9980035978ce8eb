// SPDX-License-Identifier: MIT
/// @file
/// What the materials of a scene call for; nothing else is computed. Introduced in lesson 06.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "05_textures/textures.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// What may be computed for a material: in this lesson the first five.
enum class Effect {
    light,
    highlight,
    texture,
    specular_map,
    emission_map,
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

/// A set of effects.
class EffectMask {
  public:
    constexpr bool operator[](Effect effect) const { return (bits_ & bit(effect)) != 0; }
    constexpr void set(Effect effect, bool is_on = true) {
        bits_ = is_on ? bits_ | bit(effect) : bits_ & ~bit(effect);
    }
    constexpr bool operator==(const EffectMask&) const = default;

  private:
    static constexpr std::uint32_t bit(Effect effect) {
        return std::uint32_t{1} << static_cast<int>(effect);
    }

    std::uint32_t bits_ = 0;
};

inline bool is_lit(const Material& material) { return material.illumination >= 1; }

inline bool has_highlight(const Material& material) {
    return material.illumination >= 2 && material.specular != vec3(0);
}

/// What is read of a scene's image files: for each material.
struct SurfaceTextures {
    MaterialTextures diffuse;   ///< map_Kd
    MaterialTextures specular;  ///< map_Ks, plain numbers; only where there is a highlight.
    MaterialTextures emission;  ///< map_Ke, only where there is emission.
};

/// The plan: for each material its effects.
///
/// @param all_effects  A highlight runs for every lit material.
inline std::vector<EffectMask> plan_effects(const Scene& scene, const SurfaceTextures& textures,
                                            bool all_effects) {
    std::vector<EffectMask> effects(scene.materials.size());
    for (std::size_t i = 0; i < effects.size(); ++i) {
        const Material& material = scene.materials[i];
        effects[i].set(Effect::light, is_lit(material));
        effects[i].set(Effect::highlight,
                       has_highlight(material) || (all_effects && is_lit(material)));
        effects[i].set(Effect::texture, textures.diffuse[i] != nullptr);
        effects[i].set(Effect::specular_map, textures.specular[i] != nullptr);
        effects[i].set(Effect::emission_map, textures.emission[i] != nullptr);
    }
    return effects;
}

}  // namespace rasterbook
