// SPDX-License-Identifier: MIT
/// @file
/// Lesson 04's coffee pot, the teapot once more, put on the crate by GLM's matrices in double.
#pragma once

#include <algorithm>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "common/model/mesh.hpp"

namespace rasterbook::test {

constexpr dvec3 pot_scale(0.4, 0.75, 0.3), pot_position(-3.7, 2.4, -2.6);
constexpr double pot_turn_degrees = -40;  ///< Where --turn does not say otherwise.

inline dmat4 pot_moved() { return glm::translate(dmat4(1), pot_position); }
inline dmat4 pot_scaled() { return glm::scale(dmat4(1), pot_scale); }
inline dmat4 pot_turned(double turn_degrees) {
    return glm::rotate(dmat4(1), glm::radians(turn_degrees), dvec3(0, 1, 0));
}

inline dmat4 world_from_pot(double turn_degrees) {
    return pot_moved() * pot_turned(turn_degrees) * pot_scaled();
}

/// A scene with the pot alone, its positions in the world; empty where the lesson draws none. Its
/// normals and bounds are the teapot's still.
inline Scene pot_of(const Scene& scene, const dmat4& world_from_model) {
    Scene pot;
    const auto teapot = std::ranges::find(scene.meshes, "teapot", &Mesh::name);
    if (teapot == scene.meshes.end() ||
        std::ranges::find(scene.meshes, "crate", &Mesh::name) == scene.meshes.end())
        return pot;
    pot.materials = scene.materials;
    pot.meshes.push_back(*teapot);
    for (vec3& position : pot.meshes[0].positions)
        position = vec3(world_from_model * dvec4(position, 1));
    return pot;
}

}  // namespace rasterbook::test
