// SPDX-License-Identifier: MIT
#include "11_scenes/shaders.hpp"

namespace rasterbook {

namespace {

template <std::size_t... i>
constexpr std::array<Shaders::Shader, sizeof...(i)> compiled(std::index_sequence<i...>) {
    return {&draw_triangle<all_permutations[i]>...};
}

}  // namespace

Shaders::Shaders(const ScenePlan& plan) {
    constexpr auto table = compiled(std::make_index_sequence<all_permutations.size()>());
    for (const MaterialPlan& material : plan.materials)
        of_material_.push_back(table[permutation_of(material)]);
}

}  // namespace rasterbook
