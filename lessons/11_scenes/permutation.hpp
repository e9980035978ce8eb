// SPDX-License-Identifier: MIT
/// @file
/// Shader permutations: the sets of effects that a shader is compiled with, and which of them a
/// material takes. Introduced in lesson 11; derivation: docs/derivations/11_scenes.md.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>

#include "11_scenes/scene_plan.hpp"

namespace rasterbook {

/// How a fragment gets its colour.
enum class ShadingModel { unlit, phong, toon };

/// The effects that a shader is compiled with.
struct Permutation {
    ShadingModel model = ShadingModel::unlit;
    bool normal_map = false;
    bool shadow = false;

    bool operator==(const Permutation&) const = default;
};

/// All permutations. Toon materials share one, since they are few: whether there is a normal map is
/// asked at run time (Eq. 11.3).
constexpr std::array all_permutations = {
    Permutation{ShadingModel::unlit, false, false}, Permutation{ShadingModel::phong, false, false},
    Permutation{ShadingModel::phong, false, true},  Permutation{ShadingModel::phong, true, false},
    Permutation{ShadingModel::phong, true, true},   Permutation{ShadingModel::toon, true, true}};

/// The permutation that is compiled with all that a material's plan has, and with as little beyond
/// it as possible.
inline std::size_t permutation_of(const MaterialPlan& plan) {
    Permutation effects{plan[Effect::toon]    ? ShadingModel::toon
                        : plan[Effect::light] ? ShadingModel::phong
                                              : ShadingModel::unlit,
                        plan[Effect::normal_map], plan[Effect::shadow]};
    if (effects.model != ShadingModel::phong)
        effects.normal_map = effects.shadow = effects.model == ShadingModel::toon;
    for (std::size_t i = 0; i < all_permutations.size(); ++i)
        if (all_permutations[i] == effects) return i;
    assert(false && "all sets have a permutation");
    return 0;
}

}  // namespace rasterbook
