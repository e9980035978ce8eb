// SPDX-License-Identifier: MIT
/// @file
/// The scene of the course's cover: an evening at the workbench. A low sun shines through a window
/// that is not in the picture.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "assets/generate/scenes.hpp"
#include "assets/generate/shield.hpp"
#include "assets/generate/workbench.hpp"

namespace rasterbook::assets {

/// The file's materials, by name.
inline std::map<std::string, json> workshop_materials(GltfFile& file) {
    std::map<std::string, json> all;
    const auto plain = [&](const std::string& name, dvec3 base, double metallic,
                           double roughness) -> json& {
        return all[name] = plain_material(name, base, metallic, roughness);
    };
    const auto textured = [&](const std::string& name, dvec3 base, double metallic,
                              double roughness, const std::string& picture, bool has_normals) {
        json& material = plain(name, base, metallic, roughness);
        material = with_pictures(file, material, picture, has_normals);
    };
    textured("table", {0.95, 0.74, 0.56}, 0, 0.6, "wood", false);
    textured("box", {0.9, 0.62, 0.38}, 0, 0.9, "wood", false);
    textured("bricks", {0.85, 0.82, 0.8}, 0, 0.85, "brick", true);
    textured("copper", {0.96, 0.82, 0.72}, 0.4, 0.43, "hammered", true);
    textured("paper", dvec3(0.92), 0, 1, "graph_paper", false);
    plain("bronze", {0.58, 0.36, 0.15}, 0.32, 0.53)["normalTexture"] =
        file.texture("../textures/shield_normal.png");
    plain("plaster", dvec3(0.6), 0, 1);
    plain("tea", {0.12, 0.035, 0.008}, 0, 0.25);
    plain("foot", {0.2, 0.23, 0.21}, 0, 0.3);
    plain("lead", dvec3(0.08), 0, 0.5);
    plain("bare wood", {0.75, 0.5, 0.28}, 0, 0.9);
    plain("paint", {0.68, 0.33, 0.02}, 0, 0.4);
    plain("brass", {0.9, 0.7, 0.3}, 0.5, 0.35);
    plain("rubber", {0.8, 0.4, 0.35}, 0, 0.9);

    const auto blended = [&](const std::string& name, dvec3 base, double opacity) -> json& {
        json& material = plain(name, base, 0, 0.3);
        material["pbrMetallicRoughness"]["baseColorFactor"][3] = opacity;
        material["alphaMode"] = "BLEND";
        return material;
    };
    blended("glass", {0.06, 0.075, 0.075}, 0.12)["doubleSided"] = true;
    blended("rim", {0.06, 0.075, 0.075}, 0.5);
    const json unlit = json::object();
    plain("tea in glass", dvec3(1), 0, 1)["extensions"]["KHR_materials_unlit"] = unlit;
    blended("light through tea", {0.85, 0.24, 0.02}, 0.08)["extensions"]["KHR_materials_unlit"] =
        unlit;

    // A toon material does not ask how bright its light is: its two colours have to fit the room.
    const auto toy = [&](const std::string& name, dvec3 paint, double outline) -> json& {
        json& material = all[name] = toon_material(name, paint * dvec3(0.95, 0.8, 0.62),
                                                   paint * dvec3(0.16, 0.13, 0.17), outline);
        material["extensions"]["VRMC_materials_mtoon"]["shadingShiftFactor"] = -0.4;
        return material;
    };
    toy("coat", {0.8, 0.13, 0.06}, 0.014);
    toy("cream", {0.87, 0.72, 0.42}, 0.014);
    toy("panel", {0.87, 0.72, 0.42}, 0);
    toy("trim", {0.03, 0.36, 0.38}, 0.014);
    toy("visor", {0.05, 0.07, 0.14}, 0);
    toy("steel", {0.36, 0.4, 0.5}, 0.014);
    toy("lamp", {0.8, 0.42, 0.04}, 0.014)["emissiveFactor"] = {0.15, 0.08, 0.01};
    toy("eyes", {0.1, 0.1, 0.1}, 0)["emissiveFactor"] = {0.45, 0.75, 0.7};
    return all;
}

/// The sun is not a point: four lights side by side give shadows soft edges, the softer the farther
/// away what casts them. Beside it, the blue of the evening: from the room, and along the wall.
inline void add_workshop_lights(GltfFile& file) {
    const dvec3 above_sun = glm::cross(beside_sun, toward_sun);
    for (const dvec2 offset : {dvec2(-3, -1), dvec2(-1, 3), dvec2(1, -3), dvec2(3, 1)}) {
        const dvec3 toward = toward_sun + 0.0017 * (offset.x * beside_sun + offset.y * above_sun);
        file.add_light("sun", 20.0 * toward, dvec3(0),
                       {{"type", "directional"}, {"color", {1, 0.72, 0.42}}, {"intensity", 1.85}});
    }
    const auto add_spotlight = [&](const char* name, dvec3 eye, dvec3 target, dvec3 color,
                                   double intensity) {
        file.add_light(name, eye, target,
                       {{"type", "spot"},
                        {"color", {color.r, color.g, color.b}},
                        {"intensity", intensity},
                        {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.9}}}});
    };
    add_spotlight("sky", {1, 10, 10}, {0, 0.5, -1}, {0.25, 0.5, 1}, 90);
    add_spotlight("along the wall", {8.5, 6, -1.2}, {0, 1, -1}, {0.4, 0.6, 1}, 50);
}

inline GltfFile workshop_scene(const std::vector<Part>& teapot) {
    GltfFile file("An evening at the workbench");
    for (const char* extension :
         {"KHR_lights_punctual", "KHR_materials_unlit", "VRMC_materials_mtoon"})
        file.use_extension(extension);
    NamedMaterials material(file, workshop_materials(file));
    // Turned from x towards -z by an angle of which half has this tangent.
    const auto place = [&](const std::string& name, const std::vector<GltfPrimitive>& mesh,
                           dvec3 at = dvec3(0), double tangent = 0, double scale = 1) {
        const double length = std::sqrt(1 + tangent * tangent);
        file.add_node({{"name", name},
                       {"mesh", file.add_mesh(name, mesh)},
                       {"translation", {at.x, at.y, at.z}},
                       {"rotation", turned(1 / length, tangent / length)},
                       {"scale", {scale, scale, scale}}});
    };
    const auto plain = [&](const std::vector<Part>& parts) {
        return primitives_of(parts, {.uvs = false}, material);
    };
    const auto textured = [&](const std::vector<Part>& parts) {
        return primitives_of(parts, {}, material);
    };
    place("table", {table_top(material("table"))});
    place("wall", {brick_wall(material("bricks"))});
    place("window", plain(window_wall()));

    std::vector<Part> pot = teapot, robot, box;
    for (Part& part : pot)
        if (part.material != "tea") part.material = "copper";
    for (Part& part : figure()) {
        if (part.material == "glass") part.material = "visor";
        if (part.material == "platform") continue;
        (part.material == "box" ? box : robot).push_back(std::move(part));
    }
    place("teapot", textured(pot), {0.35, 0, -0.5}, -0.33, 0.86);
    place("shield", textured({shield("bronze")}), {-2.65, 0, wall_z + 0.55}, 0.04);
    const dvec3 robot_at(3.47, -0.155, 0.9);  // sunk by the height of its platform
    place("robot", plain(robot), robot_at, -0.3, 0.62);
    place("box", textured(box), robot_at, -0.3, 0.62);
    place("sheet", textured({sheet()}), {-2.1, 0, 2.3}, 0.03);
    place("pencil", plain(pencil()), {0.65, 0, 2.15}, 0.34);
    const dvec3 glass_at(-4, 0, 1.1);
    place("glass", plain(tea_glass()), glass_at);
    place("tea", {tea_in_glass(material("tea in glass"))}, glass_at);
    place("light through tea", {light_through_tea(material("light through tea"))}, glass_at);

    file.add_camera("front", {-3.1, 5.3, 13.5}, {0.25, 0.85, 0.1}, 0.468);
    file.add_camera("whole set", {9, 13, 26}, {-1.2, 2.3, 2}, 0.6);
    add_workshop_lights(file);
    return file;
}

}  // namespace rasterbook::assets
