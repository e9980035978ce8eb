// SPDX-License-Identifier: MIT
/// @file
/// The scenes of beside_opengl.cpp. They are made in memory, since the files of the large ones
/// would take megabytes; textures and toon.glb are the course's.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <glm/matrix.hpp>

#include "04_mvp/transform.hpp"
#include "benchmarks/beside_opengl.hpp"
#include "support/pictures.hpp"

namespace rasterbook {

namespace {

/// A mesh of 2 n^2 triangles, counter-clockwise as seen from where (s, t) has s to the right and t
/// downwards.
///
/// @param place   Called as place(s, t), each 0 to 1: the position.
/// @param copies  So often the texture is repeated along each side.
template <typename Place>
Mesh sheet(std::uint32_t material, int n, float copies, Place&& place) {
    Mesh mesh;
    for (int y = 0; y <= n; ++y)
        for (int x = 0; x <= n; ++x) {
            const vec2 at = vec2(x, y) / static_cast<float>(n);
            mesh.positions.push_back(place(at.x, at.y));
            mesh.uvs.push_back(copies * vec2(at.x, 1 - at.y));
            mesh.bounds.add(mesh.positions.back());
        }
    const auto vertex = [n](int x, int y) {
        const auto index = static_cast<std::uint32_t>(y * (n + 1) + x);
        return Vertex{index, index};
    };
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const Vertex a = vertex(x, y), b = vertex(x, y + 1), c = vertex(x + 1, y + 1),
                         d = vertex(x + 1, y);
            mesh.triangles.push_back({{a, b, c}, material});
            mesh.triangles.push_back({{a, c, d}, material});
        }
    return mesh;
}

/// Hills and valleys, 16 units wide, that cast shadows on each other.
Mesh hills(std::uint32_t material, int n) {
    return sheet(material, n, 6, [](float s, float t) {
        const float height = std::sin(17 * s + 2 * t) * std::cos(13 * t) + 0.4f * std::sin(31 * s);
        return vec3(16 * s - 8, 0.9f * height, 16 * t - 8);
    });
}

TextureMap texture(const std::string& name) {
    TextureMap map;
    map.file = std::filesystem::path(RASTERBOOK_ASSETS) / "textures" / name;
    map.library = map.file;
    return map;
}

Material unlit_material(vec3 color, const std::string& picture = {}) {
    Material material;
    material.name = "unlit";
    material.illumination = 0;
    material.diffuse = color;
    if (!picture.empty()) material.diffuse_map = texture(picture);
    return material;
}

/// Lit, with a highlight and a texture.
Material phong_material(const std::string& picture) {
    Material material;
    material.name = "phong";
    material.diffuse = vec3(0.9f), material.specular = vec3(0.3f);
    material.shininess = 40;
    material.diffuse_map = texture(picture);
    return material;
}

Material bumpy_material() {
    Material material = phong_material("brick.png");
    material.normal_map = texture("brick_normal.png");
    return material;
}

/// @param meshes  Of the materials.
Scene scene_of(std::vector<Mesh> meshes, std::vector<Material> materials, vec3 eye, vec3 target) {
    Scene scene;
    scene.meshes = std::move(meshes), scene.materials = std::move(materials);
    scene.is_gltf = true;
    scene.cameras.push_back(
        {"front", glm::inverse(look_at(eye, target, vec3(0, 1, 0))), 0.6f, 0.1f, 500.0f});
    scene.lights.push_back({"sun", SceneLight::Kind::directional, 3.0f * vec3(1, 0.92f, 0.8f),
                            vec3(0), glm::normalize(vec3(0.8f, -0.5f, -0.3f)), 0});
    return scene;
}

Scene hilly(Material material, int n) {
    return scene_of({hills(0, n)}, {std::move(material)}, {0, 9, 9}, {0, 0, 0});
}

/// To the horizon.
Scene plane() {
    return scene_of(
        {sheet(0, 1, 400, [](float s, float t) { return vec3(400 * s - 200, 0, 400 * t - 390); })},
        {unlit_material(vec3(1), "tiles.png")}, {0, 2, 5}, {0, 0, -1});
}

/// A sheet that faces the camera and covers the picture.
Mesh wall(std::uint32_t material, float x, float z) {
    return sheet(material, 1, 2,
                 [=](float s, float t) { return vec3(16 * s - 8 + x, 6 - 12 * t, z); });
}

/// Eight upright bands side by side, each of one color.
Scene bands_of_one_color() {
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    for (std::uint32_t i = 0; i < 8; ++i) {
        const auto step = static_cast<float>(i);
        meshes.push_back(sheet(
            i, 1, 1, [step](float s, float t) { return vec3(2 * (step + s) - 8, 6 - 12 * t, 0); }));
        materials.push_back(unlit_material(vec3(0.1f * step, 0.5f, 0.9f - 0.1f * step)));
    }
    return scene_of(std::move(meshes), std::move(materials), {0, 0, 13}, {0, 0, 0});
}

/// Ten walls in front of each other, the farthest one first; a gap between them for shadows.
Scene layers() {
    std::vector<Mesh> meshes;
    for (int i = 0; i < 10; ++i)
        meshes.push_back(wall(0, 0.3f * static_cast<float>(i % 2), 0.2f * static_cast<float>(i)));
    return scene_of(std::move(meshes), {phong_material("wood.png")}, {0, 0, 13}, {0, 0, 0});
}

}  // namespace

std::vector<BenchmarkScene> benchmark_scenes() {
    return {
        {"small_triangles", "200,000 triangles, a texture, no light",
         [] { return hilly(unlit_material(vec3(1), "brick.png"), 316); }},
        {"textured_plane", "2 triangles to the horizon, a texture, no light", plane},
        {"large_triangles", "16 triangles of one color each, no light", bands_of_one_color},
        {"small_flat", "200,000 triangles of one color, no light",
         [] { return hilly(unlit_material(vec3(0.3f, 0.5f, 0.7f)), 316); }},
        {"effects_many", "400,000 triangles: texture, normal map, Phong, shadow",
         [] { return hilly(bumpy_material(), 447); }},
        {"effects_few", "the same with 800 triangles", [] { return hilly(bumpy_material(), 20); }},
        {"toon", "toon.glb: toon materials, outlines, shadow",
         [] { return test::loaded("toon.glb"); }},
        {"overdraw", "10 layers from back to front: texture, Phong, shadow", layers}};
}

}  // namespace rasterbook
