// SPDX-License-Identifier: MIT
/// @file
/// What every scene keeps to that is read from a file, however damaged that is.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "common/model/mesh.hpp"

namespace rasterbook::test {

inline constexpr auto has_finite_numbers = [](const auto& v) {
    for (int i = 0; i < v.length(); ++i)
        if (!std::isfinite(v[i])) return false;
    return true;
};

/// For EXPECT_TRUE: indices in range, bounds of what is drawn, and finite numbers.
inline testing::AssertionResult is_sound(const Scene& scene) {
    const auto wrong = [](const char* what, const std::string& name) {
        return testing::AssertionFailure() << what << " of \"" << name << "\"";
    };
    for (const Mesh& mesh : scene.meshes) {
        const auto is_in_range = [&](const Vertex& vertex) {
            return vertex.position < mesh.positions.size() &&
                   (vertex.uv == no_index || vertex.uv < mesh.uvs.size()) &&
                   (vertex.normal == no_index || vertex.normal < mesh.normals.size());
        };
        std::size_t triangle_count = 0, vertex_count = 0;
        for (const Face& face : mesh.faces) {
            if (face.material >= scene.materials.size() || face.first_vertex != vertex_count ||
                face.vertex_count < 3)
                return wrong("a face", mesh.name);
            vertex_count += face.vertex_count, triangle_count += face.vertex_count - 2;
        }
        if (mesh.faces.empty() || mesh.vertices.size() != vertex_count ||
            mesh.triangles.size() != triangle_count)
            return wrong("the number of vertices or triangles", mesh.name);
        if (!std::ranges::all_of(mesh.vertices, is_in_range)) return wrong("a vertex", mesh.name);
        for (const auto& [vertices, material] : mesh.triangles)
            if (material >= scene.materials.size() || !std::ranges::all_of(vertices, is_in_range))
                return wrong("a triangle", mesh.name);
        Bounds bounds;
        for (const Vertex& vertex : mesh.vertices) bounds.add(mesh.positions[vertex.position]);
        if (bounds.min != mesh.bounds.min || bounds.max != mesh.bounds.max)
            return wrong("the bounds", mesh.name);
        if (!mesh.colors.empty() && mesh.colors.size() != mesh.positions.size())
            return wrong("the number of colours", mesh.name);
        if (!std::ranges::all_of(mesh.positions, has_finite_numbers) ||
            !std::ranges::all_of(mesh.normals, has_finite_numbers) ||
            !std::ranges::all_of(mesh.uvs, has_finite_numbers) ||
            !std::ranges::all_of(mesh.colors, has_finite_numbers))
            return wrong("a number", mesh.name);
    }
    for (const Material& m : scene.materials)
        for (const vec3& v : {m.ambient, m.diffuse, m.specular, m.emission,
                              vec3(m.shininess, m.opacity, m.alpha_cutoff),
                              vec3(m.diffuse_map.offset), vec3(m.diffuse_map.scale)})
            if (!has_finite_numbers(v)) return wrong("a number", m.name);
    for (const SceneCamera& camera : scene.cameras)
        for (int i = 0; i < 4; ++i)
            if (!has_finite_numbers(camera.world_from_view[i]) || !(camera.near > 0))
                return wrong("a number", camera.name);
    for (const SceneLight& light : scene.lights)
        if (!has_finite_numbers(light.color) || !has_finite_numbers(light.position_world) ||
            !has_finite_numbers(light.direction_world) || !(light.cos_outer < light.cos_inner))
            return wrong("a number", light.name);
    return testing::AssertionSuccess();
}

}  // namespace rasterbook::test
