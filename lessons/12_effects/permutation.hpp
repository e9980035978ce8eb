// SPDX-License-Identifier: MIT
/// @file
/// Shader permutations: the sets of effects that a shader is compiled with, and which of them a
/// material takes. Introduced in lesson 12; derivation: docs/derivations/12_effects.md.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "06_phong/effects.hpp"
#include "11_scenes/blending.hpp"

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
/// asked at run time (Eq. 12.2).
constexpr std::array all_permutations = {
    Permutation{ShadingModel::unlit, false, false}, Permutation{ShadingModel::phong, false, false},
    Permutation{ShadingModel::phong, false, true},  Permutation{ShadingModel::phong, true, false},
    Permutation{ShadingModel::phong, true, true},   Permutation{ShadingModel::toon, true, true}};

/// The number of the permutation that is compiled with all that a material calls for, and with as
/// little beyond it as possible.
inline std::size_t permutation_of(EffectMask wanted) {
    Permutation effects{wanted[Effect::toon]    ? ShadingModel::toon
                        : wanted[Effect::light] ? ShadingModel::phong
                                                : ShadingModel::unlit,
                        wanted[Effect::normal_map], wanted[Effect::shadow]};
    if (effects.model != ShadingModel::phong)
        effects.normal_map = effects.shadow = effects.model == ShadingModel::toon;
    for (std::size_t i = 0; i < all_permutations.size(); ++i)
        if (all_permutations[i] == effects) return i;
    assert(false && "all sets have a permutation");
    return 0;
}

/// For each material its shader: one of those that are compiled, for all permutations, from one
/// generic lambda.
///
/// @tparam Draw  Of a lambda whose template argument is a Permutation, and which is called with a
///               triangle, a tile and what takes its transparent fragments.
template <typename Draw>
class Shaders {
  public:
    /// @param effects  Of each material.
    Shaders(const Draw& draw, std::span<const EffectMask> effects) : draw_(draw) {
        for (const EffectMask wanted : effects)
            of_material_.push_back(compiled[permutation_of(wanted)]);
    }

    void operator()(const ProjectedTriangle& projected, const Tile& tile,
                    TransparentFragments& transparent) const {
        of_material_[projected.triangle.material](draw_, projected, tile, transparent);
    }

  private:
    using Shader = void (*)(const Draw&, const ProjectedTriangle&, const Tile&,
                            TransparentFragments&);

    template <std::size_t i>
    static void call(const Draw& draw, const ProjectedTriangle& projected, const Tile& tile,
                     TransparentFragments& transparent) {
        draw.template operator()<all_permutations[i]>(projected, tile, transparent);
    }

    static constexpr auto compiled = []<std::size_t... i>(std::index_sequence<i...>) {
        return std::array<Shader, sizeof...(i)>{&call<i>...};
    }(std::make_index_sequence<all_permutations.size()>());

    const Draw& draw_;
    std::vector<Shader> of_material_;
};

}  // namespace rasterbook
