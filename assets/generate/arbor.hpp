// SPDX-License-Identifier: MIT
/// @file
/// Leaves on a trellis, which are holes in a texture, and two panes of glass that cut through each
/// other.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <string>
#include <vector>

#include "assets/generate/gltf.hpp"
#include "assets/generate/models.hpp"
#include "assets/generate/noise.hpp"
#include "assets/generate/scenes.hpp"
#include "assets/generate/texture.hpp"

namespace rasterbook::assets {

constexpr int leaf_cells = 6;  ///< Leaves along a side of the texture.

/// The colour of one leaf at a point, sRGB; none beside the leaf.
///
/// @param p     From the leaf's middle, in cells.
/// @param cell  Of which each leaf has its own shade and direction.
inline std::optional<dvec3> leaf_color(dvec2 p, ivec2 cell) {
    const dvec2 along = glm::normalize(
        dvec2(random(cell.x, cell.y, 3) - 0.5, 0.35 + 0.5 * random(cell.x, cell.y, 4)));
    const double u = glm::dot(p, along) / 0.72, v = glm::dot(p, dvec2(-along.y, along.x)) / 0.72;
    const double width = 0.52 * (1 - u * u) * (1 + 0.55 * u);  // broad below, pointed above
    if (std::abs(u) >= 1 || std::abs(v) >= width) return std::nullopt;
    const double vein = 1 - smooth_step(0.01, 0.045, std::abs(v));
    // Ribs branch off upwards.
    const double rib = 5 * (u + 0.8 * std::abs(v));
    const double to_rib = std::abs(rib - std::floor(rib + 0.5));
    const double ribs = 0.5 * (1 - smooth_step(0.03, 0.12, to_rib));
    const double shade = 0.75 + 0.4 * random(cell.x, cell.y, 5) + (v > 0 ? 0.1 : -0.06);
    return glm::clamp(shade * glm::mix(rgb(0x4C7A2B), rgb(0xA9C46C), std::max(vein, ribs)), 0.0,
                      1.0);
}

/// Leaves over leaves; alpha is 0 beside them.
inline Image<u8vec4> leaves_image() {
    Image<u8vec4> image(ivec2(texture_side), u8vec4(encode(rgb(0x3B5F24)), 0));
    for (int y = 0; y < texture_side; ++y)
        for (int x = 0; x < texture_side; ++x) {
            const dvec2 p =
                (dvec2(x, texture_side - 1 - y) + 0.5) * double(leaf_cells) / double(texture_side);
            const ivec2 here(p);
            for (int i = 0; i < 9; ++i) {  // neighbours reach over
                const ivec2 cell = here + ivec2(i % 3, i / 3) - 1;
                const ivec2 of(wrap(cell.x, leaf_cells), wrap(cell.y, leaf_cells));
                if (random(of.x, of.y, 9) < 0.06) continue;
                const dvec2 middle =
                    dvec2(cell) + 0.5 +
                    0.35 * (dvec2(random(of.x, of.y, 1), random(of.x, of.y, 2)) - 0.5);
                if (const auto color = leaf_color(p - middle, of))
                    image[{x, y}] = u8vec4(encode(*color), 255);
            }
        }
    return image;
}

/// An upright rectangle on the ground; u along it, v up.
///
/// @param from,to  Its lower corners.
/// @param uvs      How often the texture lies along it, and up.
inline Part panel(const std::string& material, dvec3 from, dvec3 to, double height, dvec2 uvs) {
    const dvec3 up(0, height, 0), normal = glm::normalize(glm::cross(to - from, up));
    return {"panel",
            material,
            {{{from, {0, 0}, normal},
              {to, {uvs.x, 0}, normal},
              {to + up, uvs, normal},
              {from + up, {0, uvs.y}, normal}}}};
}

/// A trellis in leaf with the sun behind it, and two panes of glass.
inline GltfFile arbor_scene() {
    GltfFile file("Leaves and glass");
    file.use_extension("KHR_lights_punctual");
    json leaves = with_pictures(file, plain_material("leaves", dvec3(1), 0, 0.9), "leaves", false);
    leaves["alphaMode"] = "MASK";
    leaves["doubleSided"] = true;
    const auto glass = [](const std::string& name, dvec3 color) {
        json material = plain_material(name, color, 0, 0.3);
        material["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.55;
        material["alphaMode"] = "BLEND";
        material["doubleSided"] = true;
        return material;
    };
    const json tiles = plain_material("tiles", light_tile, 0, 0.5);
    NamedMaterials material(
        file, {{"leaves", leaves},
               {"red glass", glass("red glass", {0.9, 0.06, 0.06})},
               {"blue glass", glass("blue glass", {0.05, 0.22, 0.9})},
               {"post", with_pictures(file, plain_material("post", {0.9, 0.62, 0.38}, 0, 0.9),
                                      "wood", false)},
               {"tiles", with_pictures(file, tiles, "tiles", false)}});
    const auto add = [&](const std::string& name, const std::vector<Part>& parts) {
        file.add_node(
            {{"name", name}, {"mesh", file.add_mesh(name, primitives_of(parts, {}, material))}});
    };
    add("floor", {floor("tiles", 24, 4)});
    const auto box = [](dvec3 at, dvec3 size) {
        Part part = crate("post");
        for (Polygon& side : part.faces)
            for (Vertex& vertex : side) vertex.position = at + vertex.position * size / 2.4;
        return part;
    };
    add("trellis", {panel("leaves", {-4.6, 0, -1.2}, {1.2, 0, -2.4}, 4.2, {2.4, 1.75}),
                    box({-4.7, 0, -1.2}, {0.22, 4.4, 0.22}), box({1.3, 0, -2.4}, {0.22, 4.4, 0.22}),
                    panel("leaves", {-6.4, 0, 1.5}, {-4.8, 0, -1.2}, 4.2, {1.25, 1.75}),
                    box({-6.5, 0, 1.6}, {0.22, 4.4, 0.22})});
    add("panes", {panel("red glass", {1.6, 0, 1.9}, {4.9, 0, -0.4}, 2.5, {1, 1}),
                  panel("blue glass", {1.7, 0, -0.7}, {4.4, 0, 2.3}, 3.0, {1, 1})});
    Part block = placed(crate("post"), 0.8, 0.6, {-1.2, 0, 0.9});
    for (Polygon& side : block.faces)
        for (Vertex& vertex : side) vertex.position.y *= 0.42;
    add("block", {block});
    file.add_camera("front", {1.6, 4.2, 11.5}, {-0.6, 1.75, -0.4}, 0.62);
    file.add_light("sun", {-5.5, 7, -6}, {0, 0, 0},
                   {{"type", "directional"}, {"color", {1, 0.9, 0.72}}, {"intensity", 4}});
    file.add_light("sky", {4, 6, 8}, {0, 0, 0},
                   {{"type", "directional"}, {"color", {0.6, 0.8, 1}}, {"intensity", 0.9}});
    return file;
}

}  // namespace rasterbook::assets
