// SPDX-License-Identifier: MIT
/// @file
/// Random small scenes with all that a file may ask for, to be drawn by two lessons and compared.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "04_mvp/transform.hpp"
#include "05_textures/texture.hpp"
#include "11_scenes/scene_assets.hpp"
#include "common/image/bmp.hpp"
#include "common/image/image.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook::test {

/// The same numbers for the same seed, whatever the standard library.
class Dice {
  public:
    explicit Dice(std::uint32_t seed) : random_(seed) {}

    std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(random_() % end); }
    bool one_in(std::uint32_t n) { return below(n) == 0; }
    float between(float least, float most) {
        return least + (most - least) * static_cast<float>(random_() >> 8) * 0x1p-24f;
    }
    vec3 in_cube(float half_side) {
        const float x = between(-half_side, half_side), y = between(-half_side, half_side);
        return {x, y, between(-half_side, half_side)};
    }
    vec3 color() { return in_cube(0.5f) + 0.5f; }

  private:
    std::mt19937 random_;
};

/// Kinds of materials, in the order of a scene's; 0 is the default one.
enum class AnyMaterial { standard, unlit, shiny, textured, masked, glass, toon, count };

inline Material material_of(AnyMaterial kind, Dice& dice) {
    Material material;
    material.diffuse = material.ambient = dice.color();
    material.two_sided = dice.one_in(2);
    const auto picture = [&] {
        Image<u8vec3> image({4, 4});
        for (u8vec3& texel : image.pixels()) texel = u8vec3(255.0f * dice.color());
        TextureMap map;
        const std::size_t number = dice.below(1'000'000);
        map.file = "picture " + std::to_string(number);
        map.clamp = {number % 3 == 0, number % 5 == 0};
        map.mirror = {number % 3 == 1, number % 5 == 1};
        map.nearest_magnified = number % 7 == 0, map.nearest_minified = number % 11 == 0;
        map.embedded = std::make_shared<const Bytes>(encode_bmp(image, map.file));
        return map;
    };
    if (kind == AnyMaterial::unlit) material.illumination = 0;
    if (kind == AnyMaterial::shiny)
        material.specular = dice.color(), material.shininess = dice.between(1, 60);
    if (kind == AnyMaterial::textured) {
        material.diffuse_map = picture();
        if (dice.one_in(2)) material.normal_map = picture();
    }
    if (kind == AnyMaterial::masked) {
        material.alpha = AlphaMode::mask, material.alpha_cutoff = dice.between(0.3f, 0.7f);
        if (dice.one_in(2)) material.illumination = 0;
        if (dice.one_in(2)) material.diffuse_map = picture();
    }
    if (kind == AnyMaterial::glass)
        material.alpha = AlphaMode::blend, material.opacity = dice.between(0, 1);
    if (kind == AnyMaterial::toon) {
        using Outline = ToonMaterial::Outline;
        constexpr std::array outlines = {Outline::none, Outline::world, Outline::screen};
        material.illumination = 1;
        material.toon = ToonMaterial{.shade = dice.color(),
                                     .outline = outlines[dice.below(3)],
                                     .outline_width = dice.between(0, 0.1f),
                                     .outline_color = dice.color()};
    }
    if (dice.one_in(4)) material.emission = dice.color(), material.emission_map = picture();
    return material;
}

/// A triangle's vertices: of any size and place, also behind the camera and edge-on. Many are
/// coincident with one before, or of the same depth in all pixels.
inline std::array<vec3, 3> any_vertices(const std::vector<vec3>& before, Dice& dice) {
    if (!before.empty() && dice.one_in(3)) {
        const std::size_t first = 3 * dice.below(static_cast<std::uint32_t>(before.size() / 3));
        std::array same = {before[first], before[first + 1], before[first + 2]};
        if (dice.one_in(2)) std::swap(same[0], same[1]);  // seen from its back
        return same;
    }
    constexpr std::array<float, 5> extents = {0.02f, 0.3f, 1, 1, 30};
    const float extent = extents[dice.below(5)];
    const vec3 middle = dice.in_cube(1.2f);
    std::array<vec3, 3> vertices;
    for (vec3& vertex : vertices) vertex = middle + dice.in_cube(extent);
    if (dice.one_in(3)) {  // towards the camera, at one of three depths
        const float z = 0.5f * static_cast<float>(dice.below(3));
        for (vec3& vertex : vertices) vertex.z = z;
    }
    if (dice.one_in(10)) vertices[2] = 0.5f * (vertices[0] + vertices[1]);  // without an area
    return vertices;
}

inline Mesh any_mesh(std::uint32_t materials, Dice& dice) {
    Mesh mesh;
    mesh.uvs = {{0, 0}, {2, 0}, {1, 3}, {-0.5f, 0.5f}};
    const auto triangles = 1 + dice.below(30);
    const bool has_colors = dice.one_in(3);
    for (std::uint32_t i = 0; i < triangles; ++i) {
        Triangle triangle{{}, dice.below(materials)};
        const std::array vertices = any_vertices(mesh.positions, dice);
        for (std::size_t v = 0; v < 3; ++v) {
            triangle.vertices[v] = {static_cast<std::uint32_t>(mesh.positions.size()),
                                    dice.below(4), no_index};
            mesh.positions.push_back(vertices[v]);
            mesh.bounds.add(vertices[v]);
            if (has_colors) mesh.colors.emplace_back(dice.color(), dice.between(0, 1));
        }
        mesh.faces.push_back(
            {static_cast<std::uint32_t>(mesh.vertices.size()), 3, triangle.material});
        mesh.vertices.insert(mesh.vertices.end(), triangle.vertices.begin(),
                             triangle.vertices.end());
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

/// A scene in a camera that looks at it from (0, 0, 4), in up to three lights.
inline Scene any_scene(std::uint32_t seed) {
    Dice dice(seed);
    Scene scene;
    for (int kind = 0; kind < static_cast<int>(AnyMaterial::count); ++kind)
        scene.materials.push_back(material_of(static_cast<AnyMaterial>(kind), dice));
    // Some scenes have materials of the first kinds alone: all that a map is asked for, or nothing.
    const std::uint32_t kinds = dice.one_in(4) ? 1 + dice.below(7) : 7;
    const auto meshes = 1 + dice.below(3);
    for (std::uint32_t i = 0; i < meshes; ++i) scene.meshes.push_back(any_mesh(kinds, dice));
    constexpr std::array far_planes = {std::numeric_limits<float>::infinity(), 100.0f, 4.0f};
    scene.cameras = {{"front", translation(vec3(0, 0, 4)), 0.9f, 0.5f, far_planes[seed % 3]}};
    const auto lights = dice.below(4);
    for (std::uint32_t i = 0; i < lights; ++i) {
        constexpr std::array light_kinds = {SceneLight::Kind::directional, SceneLight::Kind::point,
                                            SceneLight::Kind::spot};
        scene.lights.push_back({"light", light_kinds[dice.below(3)], 5.0f * dice.color(),
                                2.0f * dice.in_cube(1),
                                glm::normalize(dice.in_cube(1) + vec3(0, -2, 0)),
                                std::numeric_limits<float>::infinity()});
    }
    scene.is_gltf = true;
    return scene;
}

/// Holes in the textures of masked materials: a BMP file has none.
inline void add_holes(SceneAssets& assets) {
    for (std::size_t m = 0; m < assets.scene.materials.size(); ++m) {
        if (assets.scene.materials[m].alpha != AlphaMode::mask || !assets.textures.diffuse[m])
            continue;
        Image<vec4> picture({8, 8});
        for (std::size_t i = 0; i < picture.pixels().size(); ++i)
            picture.pixels()[i] = vec4(0.5f, 0.2f, 0.9f, i * 7 % 3 == 0 ? 0.1f : 1.0f);
        assets.textures.diffuse[m] =
            std::make_shared<const Texture>(make_texture(std::move(picture), Wrap::repeat));
    }
}

}  // namespace rasterbook::test
