// SPDX-License-Identifier: MIT
/// @file
/// The light on a triangle, as lesson 06 computes it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "04_mvp/projection.hpp"
#include "06_phong/effects.hpp"
#include "06_phong/normals.hpp"
#include "06_phong/phong.hpp"
#include "06_phong/surface.hpp"
#include "lab/shading_methods.hpp"

namespace rasterbook::test {

/// A directional light.
inline Light sun(vec3 toward, vec3 color = vec3(1)) {
    return {LightKind::directional, color, toward};
}

/// A mesh of triangles over positions; vertices have no normals.
inline Mesh mesh_of(std::vector<vec3> positions,
                    const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    Mesh mesh;
    mesh.positions = std::move(positions);
    for (const vec3 position : mesh.positions) mesh.bounds.add(position);
    for (const auto& [a, b, c] : triangles)
        mesh.triangles.push_back({{Vertex{a}, Vertex{b}, Vertex{c}}, 0});
    return mesh;
}

/// A triangle as shading takes it, wherever it may be on the screen.
inline ProjectedTriangle not_on_screen(const Mesh& mesh, const Triangle& triangle, bool is_back) {
    return {mesh, triangle, {}, {}, TriangleDepth(vec3(0)), is_back};
}

/// One triangle of a scene in its lights.
class LitTriangle {
  public:
    /// @param scene  As complete_normals() leaves its meshes. It and the lights have to stay.
    LitTriangle(const ShadingMethod& variant, std::span<const Light> lights, vec3 eye_world,
                const Scene& scene, const SurfaceTextures& textures, EffectMask effects,
                const ProjectedTriangle& projected)
        : variant_(variant),
          lights_(lights),
          eye_world_(eye_world),
          surface_(triangle_surface(scene, textures, effects, projected)),
          highlight_(highlight_of(variant, surface_)),
          at_vertices_(light_vertices(variant, lights, eye_world, surface_, projected)) {}

    const TriangleSurface& surface() const { return surface_; }

    ReflectedLight at(Barycentrics barycentrics) const {
        if (at_vertices_.is_used()) return at_vertices_.at(barycentrics);
        const vec3 normal = interpolate(surface_.normals_world, barycentrics);
        SurfacePoint<float> point = surface_point(surface_, barycentrics, normal, eye_world_);
        scale_normal(variant_, normal, point);
        return reflected_light(lights_, point, highlight_);
    }

  private:
    ShadingMethod variant_;
    std::span<const Light> lights_;
    vec3 eye_world_;
    TriangleSurface surface_;
    HighlightBy highlight_;
    VertexLighting at_vertices_;
};

class OneTriangle {
  public:
    OneTriangle(const std::array<vec3, 3>& positions, const std::array<vec3, 3>& normals,
                const Material& material, const ShadingMethod& variant = {})
        : variant_(variant), scene_(scene_of(positions, normals, material)) {}

    ReflectedLight light_at(Barycentrics barycentrics, std::span<const Light> lights, vec3 eye,
                            bool is_back = false) const {
        const Mesh& mesh = scene_.meshes[0];
        return LitTriangle(variant_, lights, eye, scene_, textures_, effects_,
                           not_on_screen(mesh, mesh.triangles[0], is_back))
            .at(barycentrics);
    }

    Mesh& mesh() { return scene_.meshes[0]; }
    Material& material() { return scene_.materials[0]; }
    ShadingMethod& variant() { return variant_; }

  private:
    static Scene scene_of(const std::array<vec3, 3>& positions, const std::array<vec3, 3>& normals,
                          const Material& material) {
        Mesh mesh = mesh_of({positions.begin(), positions.end()}, {{0, 1, 2}});
        mesh.normals.assign(normals.begin(), normals.end());
        for (std::uint32_t i = 0; i < 3; ++i) mesh.triangles[0].vertices[i].normal = i;
        complete_normals(mesh);
        Scene scene;
        scene.meshes.push_back(std::move(mesh));
        scene.materials.push_back(material);
        return scene;
    }

    ShadingMethod variant_;
    Scene scene_;
    SurfaceTextures textures_{MaterialTextures(1), MaterialTextures(1), MaterialTextures(1)};
    EffectMask effects_ = plan_effects(scene_, textures_, false)[0];
};

}  // namespace rasterbook::test
