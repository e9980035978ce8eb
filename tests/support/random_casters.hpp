// SPDX-License-Identifier: MIT
/// @file
/// Shadow maps and casters, to see which parts of a map are drawn.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "09_shadow_maps/shadow_map.hpp"
#include "common/model/mesh.hpp"
#include "support/any_scene.hpp"
#include "support/one_triangle.hpp"

namespace rasterbook::test {

/// A map of NDC, in memory full of -1: what is not drawn keeps it.
inline ShadowMap map_of_minus_one(int size) {
    Bounds bounds;
    bounds.add(vec3(-1)), bounds.add(vec3(1));
    ShadowMap map(mat4(1), false, size, bounds);
    const ivec2 all = map.depths.depths().size();
    for (int y = 0; y < all.y; ++y)
        for (int x = 0; x < all.x; ++x) map.depths.depths()[{x, y}] = -1;
    return map;
}

/// Triangles in NDC, all of which cast shadows.
inline Scene random_casters(int triangles, std::uint32_t seed) {
    Dice dice(seed);
    Scene scene;
    scene.materials.resize(1);
    std::vector<vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> indices;
    for (int k = 0; k < triangles; ++k) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (int v = 0; v < 3; ++v)
            positions.push_back(dice.in_cube(1.2f) * vec3(1, 1, 0.5f) + vec3(0, 0, 0.5f));
        indices.push_back({first, first + 1, first + 2});
    }
    scene.meshes.push_back(mesh_of(positions, indices));
    return scene;
}

}  // namespace rasterbook::test
