// SPDX-License-Identifier: MIT
/// @file
/// A mesh that stands in the world, perhaps more than once. Introduced in lesson 04;
/// derivation: docs/derivations/04_mvp.md.
#pragma once

#include <algorithm>
#include <vector>

#include "04_mvp/transform.hpp"
#include "common/app/lesson_app.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// A mesh, and the model matrix that puts it into the world: scaled, then rotated, then moved
/// (Eq. 4.4). Several instances may share a mesh.
struct Instance {
    const Mesh& mesh;
    mat4 world_from_model;
};

struct PotOptions : LessonOptions {
    Orbit orbit;
    bool show_depth = false;
    float turn_degrees = -40;

    PotOptions() { model = "scene.obj"; }
    void declare(OptionParser& parser) {
        parser.number("--turn", turn_degrees, -36000, 36000,
                      "The coffee pot's rotation, in degrees, counter-clockwise from above");
    }
};

/// The meshes of a scene as they stand; and where there are a teapot and a crate, the teapot again.
///
/// @param world_from_pot  The model matrix of the second teapot.
/// @return                Refers to the scene's meshes.
inline std::vector<Instance> instances_of(const Scene& scene, const mat4& world_from_pot) {
    std::vector<Instance> instances;
    for (const Mesh& mesh : scene.meshes) instances.push_back({mesh, mat4(1)});
    const auto teapot = std::ranges::find(scene.meshes, "teapot", &Mesh::name);
    const auto crate = std::ranges::find(scene.meshes, "crate", &Mesh::name);
    if (teapot != scene.meshes.end() && crate != scene.meshes.end())
        instances.push_back({*teapot, world_from_pot});
    return instances;
}

/// An instance's positions in the world.
inline std::vector<vec3> positions_world(const Instance& instance) {
    const std::vector<vec4> positions =
        transform(instance.world_from_model, instance.mesh.positions);
    return {positions.begin(), positions.end()};
}

}  // namespace rasterbook
