// SPDX-License-Identifier: MIT
/// @file
/// The light on a single triangle, as lesson 06 computes it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "06_phong/lit_scene.hpp"
#include "06_phong/shading_variants.hpp"
#include "common/counters.hpp"

namespace rasterbook::test {

/// As from the sun.
inline Light sun(vec3 toward, vec3 color = vec3(1)) {
    return {LightKind::directional, color, toward};
}

/// A mesh of triangles over positions; corners have no normals.
inline Mesh mesh_of(std::vector<vec3> positions,
                    const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    Mesh mesh;
    mesh.positions = std::move(positions);
    for (const vec3 position : mesh.positions) mesh.bounds.add(position);
    for (const auto& [a, b, c] : triangles)
        mesh.triangles.push_back({{Corner{a}, Corner{b}, Corner{c}}, 0});
    return mesh;
}

class OneTriangle {
  public:
    OneTriangle(const std::array<vec3, 3>& positions, const std::array<vec3, 3>& normals,
                const Material& material, const ShadingVariant& variant = {})
        : options_{{}, variant}, scene_(scene_of(positions, normals, material), options_) {}

    ReflectedLight light_at(vec3 weights, std::span<const Light> lights, vec3 eye,
                            bool is_back = false) const {
        const Mesh& mesh = scene_.meshes[0];
        const Triangle& triangle = mesh.triangles[0];
        const TriangleSurface surface(scene_, mesh, triangle);
        NoCounters none;
        return TriangleLight(options_.shading, lights, eye, mesh, triangle, is_back, surface)
            .at(weights, none);
    }

    Mesh& mesh() { return scene_.meshes[0]; }
    Material& material() { return scene_.materials[0]; }
    ShadingVariant& variant() { return options_.shading; }

  private:
    struct Options {
        TextureOptions texture;
        ShadingVariant shading;
    };

    static Scene scene_of(const std::array<vec3, 3>& positions, const std::array<vec3, 3>& normals,
                          const Material& material) {
        Mesh mesh = mesh_of({positions.begin(), positions.end()}, {{0, 1, 2}});
        mesh.normals.assign(normals.begin(), normals.end());
        for (std::uint32_t i = 0; i < 3; ++i) mesh.triangles[0].corners[i].normal = i;
        Scene scene;
        scene.meshes.push_back(std::move(mesh));
        scene.materials.push_back(material);
        return scene;
    }

    Options options_;
    LitScene scene_;
};

}  // namespace rasterbook::test
