// SPDX-License-Identifier: MIT
/// @file
/// Scenes of known overdraw: layers that each fill the picture, in triangles of known size, drawn
/// in a known order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "common/model/mesh.hpp"

namespace rasterbook::test {

enum class LayerOrder { back_to_front, random, front_to_back, some_back_to_front };

/// What shading a layer takes: each has all that the one before it has.
enum class LayerLook { flat, textured, phong, shadow };

/// Layers before a camera, parallel to the picture.
struct Layers {
    ivec2 size;  ///< Of the picture; cells divide it.
    int count;   ///< Of layers, at least 1.
    ivec2 cell;  ///< Pixels of a rectangle of two triangles, in each layer.
    LayerOrder order;
    double back_share = 0;  ///< Of the cells: these are drawn back to front, of some_back_to_front.
    LayerLook look;
};

/// A layer's colour, linear; the nearest one is layer 0.
inline vec3 color_of_layer(int layer) {
    const auto step = static_cast<float>(layer % 16);
    return {0.9f - 0.05f * step, 0.3f + 0.04f * step, 0.2f + 0.03f * step};
}

/// In random order, each cell has an order of its own, so that a picture of many cells shows the
/// mean of many orders. The j-th rectangles of all cells are drawn before the (j+1)-th ones.
inline Scene layered_scene(const Layers& layers) {
    const auto distance_of = [](int layer) { return 2 + 0.05f * static_cast<float>(layer); };
    const float aspect = static_cast<float>(layers.size.x) / static_cast<float>(layers.size.y);
    Mesh mesh{.name = "layers"};
    mesh.normals = {vec3(0, 0, 1)};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const auto add_rectangle = [&](ivec2 first, int layer) {
        const float distance = distance_of(layer);
        const auto begin = static_cast<std::uint32_t>(mesh.positions.size());
        const ivec2 last = first + layers.cell;
        for (const ivec2 pixel : {ivec2(first.x, last.y), last, ivec2(last.x, first.y), first}) {
            const vec2 on_screen = 2.0f * vec2(pixel) / vec2(layers.size) - 1.0f;
            mesh.positions.emplace_back(on_screen.x * aspect * distance, -on_screen.y * distance,
                                        -distance);
            mesh.bounds.add(mesh.positions.back());
        }
        const auto vertex = [&](std::uint32_t i) { return Vertex{begin + i, i, 0}; };
        const auto material = static_cast<std::uint32_t>(layer + 1);
        mesh.triangles.push_back({{vertex(0), vertex(1), vertex(2)}, material});
        mesh.triangles.push_back({{vertex(0), vertex(2), vertex(3)}, material});
    };
    const ivec2 cells = layers.size / layers.cell;
    const auto count = static_cast<std::size_t>(layers.count);
    std::vector<std::vector<int>> layers_of(static_cast<std::size_t>(cells.x * cells.y),
                                            std::vector<int>(count));
    std::mt19937 random(12);
    const double back_cells = layers.order == LayerOrder::some_back_to_front
                                  ? layers.back_share * static_cast<double>(layers_of.size())
                                  : 0;
    for (std::size_t cell = 0; cell < layers_of.size(); ++cell) {
        std::vector<int>& order = layers_of[cell];
        std::iota(order.begin(), order.end(), 0);
        if (layers.order == LayerOrder::back_to_front || static_cast<double>(cell) < back_cells)
            std::ranges::reverse(order);
        if (layers.order == LayerOrder::random) std::ranges::shuffle(order, random);
    }
    for (std::size_t j = 0; j < count; ++j)
        for (int y = 0; y < cells.y; ++y)
            for (int x = 0; x < cells.x; ++x)
                add_rectangle(ivec2(x, y) * layers.cell,
                              layers_of[static_cast<std::size_t>(y * cells.x + x)][j]);

    Scene scene;
    scene.is_gltf = true;
    scene.materials.resize(count + 1);
    for (int layer = 0; layer < layers.count; ++layer) {
        Material& material = scene.materials[static_cast<std::size_t>(layer + 1)];
        material.diffuse = color_of_layer(layer);
        material.illumination = layers.look >= LayerLook::phong ? 2 : 0;
        material.specular = vec3(0.2f);
        material.shininess = 30;
        if (layers.look >= LayerLook::textured)
            material.diffuse_map.file =
                std::filesystem::path(RASTERBOOK_ASSETS) / "textures" / "brick.png";
    }
    scene.meshes.push_back(std::move(mesh));
    scene.cameras.push_back({"before the layers", mat4(1), std::numbers::pi_v<float> / 2, 0.5f,
                             std::numeric_limits<float>::infinity()});
    scene.lights.push_back({.name = "sun",
                            .kind = SceneLight::Kind::directional,
                            .color = vec3(3),
                            .position_world = vec3(0),
                            .direction_world = glm::normalize(vec3(0.3f, -0.4f, -1)),
                            .range = std::numeric_limits<float>::infinity()});
    return scene;
}

}  // namespace rasterbook::test
