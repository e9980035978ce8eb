// SPDX-License-Identifier: MIT
/// @file
/// A scene of squares, of which each covers the picture.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "04_mvp/transform.hpp"
#include "common/model/mesh.hpp"
#include "support/one_triangle.hpp"

namespace rasterbook::test {

/// A scene of squares of side 2 around (0, 0, z), as seen by a camera far in front of them: each
/// covers the picture. Unlit, unless a test says otherwise.
class Squares {
  public:
    Scene scene;

    Squares() {
        scene.materials.resize(1);
        scene.cameras = {{"front", translation(vec3(0, 0, 10)), 0.15f, 1, 100}};
    }

    /// @param tilt  The depth grows by so much from the left side to the right one.
    Material& add(float z, vec3 color, float tilt = 0) {
        Mesh mesh =
            mesh_of({{-1, -1, z + tilt}, {1, -1, z - tilt}, {1, 1, z - tilt}, {-1, 1, z + tilt}},
                    {{0, 1, 2}, {0, 2, 3}});
        mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        mesh.normals = {{0, 0, 1}};
        for (Triangle& triangle : mesh.triangles)
            for (Vertex& vertex : triangle.vertices) vertex = {vertex.position, vertex.position, 0};
        return add(std::move(mesh), color);
    }

    Material& add_glass(float z, vec3 color, float opacity, float tilt = 0) {
        Material& glass = add(z, color, tilt);
        glass.alpha = AlphaMode::blend, glass.opacity = opacity;
        return glass;
    }

    /// Another mesh, with a material of its own.
    Material& add(Mesh mesh, vec3 color) {
        const auto material = static_cast<std::uint32_t>(scene.materials.size());
        for (Triangle& triangle : mesh.triangles) triangle.material = material;
        scene.meshes.push_back(std::move(mesh));
        Material& added = scene.materials.emplace_back();
        added.name = "square " + std::to_string(material);
        added.illumination = 0;
        added.diffuse = added.ambient = color;
        return added;
    }
};

}  // namespace rasterbook::test
