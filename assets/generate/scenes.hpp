// SPDX-License-Identifier: MIT
/// @file
/// The lessons' four scenes as glTF files, each with what it calls for and no more.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "assets/generate/baked_light.hpp"
#include "assets/generate/figure.hpp"
#include "assets/generate/gltf.hpp"
#include "assets/generate/models.hpp"

namespace rasterbook::assets {

/// A material of glTF without pictures.
inline json plain_material(const std::string& name, dvec3 base, double metallic, double roughness) {
    return {{"name", name},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {base.r, base.g, base.b, 1}},
              {"metallicFactor", metallic},
              {"roughnessFactor", roughness}}}};
}

/// Adds materials as they are asked for by name.
class NamedMaterials {
  public:
    NamedMaterials(GltfFile& file, std::map<std::string, json> known)
        : file_(file), known_(std::move(known)) {}

    int operator()(const std::string& name) {
        const auto [found, is_new] = indices_.try_emplace(name, 0);
        if (is_new) found->second = file_.add("materials", known_.at(name));
        return found->second;
    }

  private:
    GltfFile& file_;
    std::map<std::string, json> known_;
    std::map<std::string, int> indices_;
};

/// A material with a picture of that name, and perhaps one of its normals.
inline json with_pictures(GltfFile& file, json material, const std::string& picture,
                          bool has_normals) {
    const std::string begin = "../textures/" + picture;
    material["pbrMetallicRoughness"]["baseColorTexture"] = file.texture(begin + ".png");
    if (has_normals) material["normalTexture"] = file.texture(begin + "_normal.png");
    return material;
}

constexpr dvec3 light_tile(0.58, 0.55, 0.5), dark_tile(0.1, 0.15, 0.22);

/// A polygon in n * n pieces; only of four corners, and flat.
inline std::vector<Polygon> in_pieces(const Polygon& quad, int n) {
    const auto at = [&](int x, int y) {
        const double s = double(x) / n, t = double(y) / n;
        const auto mixed = [&](auto Vertex::* of) {
            return (1 - t) * ((1 - s) * (quad[0].*of) + s * (quad[1].*of)) +
                   t * ((1 - s) * (quad[3].*of) + s * (quad[2].*of));
        };
        return Vertex{mixed(&Vertex::position), mixed(&Vertex::uv), quad[0].normal};
    };
    std::vector<Polygon> pieces;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            pieces.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
    return pieces;
}

/// A crate with a frame around each side, and four boards in it.
inline std::vector<Part> boarded(const Part& crate) {
    constexpr int n = 10;
    std::map<std::string, Part> parts;
    for (const Polygon& side : crate.faces) {
        const std::vector<Polygon> pieces = in_pieces(side, n);
        for (int i = 0; i < n * n; ++i) {
            const int x = i % n, y = i / n;
            const bool is_frame = x == 0 || y == 0 || x == n - 1 || y == n - 1;
            const std::string name =
                is_frame ? "frame" : "board " + std::to_string((x - 1) / 2 % 3);
            Part& part = parts.try_emplace(name, Part{crate.group, name, {}}).first->second;
            part.faces.push_back(pieces[static_cast<std::size_t>(i)]);
        }
    }
    std::vector<Part> list;
    for (auto& [name, part] : parts) list.push_back(std::move(part));
    return list;
}

/// Teapot, crate and floor in light that was computed beforehand: colours of corners, no lamps.
inline GltfFile unlit_scene(const std::vector<Part>& teapot) {
    GltfFile file("Baked light");
    file.use_extension("KHR_materials_unlit");
    json unlit = plain_material("baked", dvec3(1), 0, 1);
    unlit["extensions"]["KHR_materials_unlit"] = json::object();
    const int material = file.add("materials", unlit);
    const BakedScene light{{{0, 1.12, 0}, {1.95, 1.2, 1.95}},
                           {{-3.7, 1.2, -2.6}, {1.2, 1.2, 1.2}, 0.8, 0.6}};
    const std::map<std::string, dvec3> paints = {
        {"glaze", {0.66, 0.15, 0.07}},    {"gilt", {0.95, 0.6, 0.2}},
        {"tea", {0.12, 0.035, 0.008}},    {"frame", {0.5, 0.3, 0.13}},
        {"board 0", {0.66, 0.45, 0.24}},  {"board 1", {0.58, 0.38, 0.19}},
        {"board 2", {0.62, 0.42, 0.23}},  {"tiles", {0.66, 0.61, 0.52}},
        {"dark_tiles", {0.1, 0.26, 0.28}}};
    const auto add = [&](const std::string& name, const std::vector<Part>& parts, BakedPart kind,
                         int pieces) {
        GltfPrimitive primitive(material, {.normals = false, .uvs = false, .colors = true});
        for (const Part& part : parts)
            for (const Polygon& whole : part.faces)
                for (const Polygon& polygon :
                     pieces > 1 ? in_pieces(whole, pieces) : std::vector<Polygon>{whole}) {
                    std::vector<GltfVertex> corners;
                    for (const Vertex& v : polygon) {
                        const dvec3 color = paints.at(part.material) *
                                            baked_light(light, kind, v.position, v.normal);
                        GltfVertex corner{vec3(v.position)};
                        corner.color = vec3(glm::clamp(color, dvec3(0), dvec3(1)));
                        corners.push_back(corner);
                    }
                    primitive.add(corners);
                }
        file.add_node({{"name", name}, {"mesh", file.add_mesh(name, {primitive})}});
    };
    add("teapot", teapot, BakedPart::ball, 1);
    std::vector<Part> sides;
    for (Part& part : boarded(crate("")))
        sides.push_back(placed(std::move(part), 0.8, 0.6, {-3.7, 0, -2.6}));
    add("crate", sides, BakedPart::box, 1);
    add("floor", chessboard(floor("tiles", 12, 3), "dark_tiles"), BakedPart::floor, 6);
    file.add_camera("front", {-5.5, 5, 9.5}, {-0.7, 1.1, -0.4}, 0.62);
    return file;
}

/// The crate as a mesh of its own, to be placed by nodes.
inline int add_crate(GltfFile& file, int material) {
    return file.add_mesh("crate", primitives_of({crate("")}, {}, [&](auto&) { return material; }));
}

/// A turn about the vertical axis, from x towards -z, by twice the angle of these two.
inline json turned(double cosine, double sine) { return json::array({0, sine, 0, cosine}); }

/// A teapot on a stack of wooden crates, each a node, in the sun.
inline GltfFile textured_scene(const std::vector<Part>& teapot) {
    GltfFile file("Crates");
    file.use_extension("KHR_lights_punctual");
    const json tiles = plain_material("tiles", light_tile, 0, 0.5);
    const json dark_tiles = plain_material("dark_tiles", dark_tile, 0, 0.5);
    NamedMaterials material(
        file, {{"glaze", plain_material("glaze", {0.03, 0.25, 0.3}, 0, 0.35)},
               {"gilt", plain_material("gilt", {0.95, 0.6, 0.2}, 0.6, 0.35)},
               {"tea", plain_material("tea", {0.12, 0.035, 0.008}, 0, 0.25)},
               {"wood", with_pictures(file, plain_material("wood", {0.9, 0.62, 0.38}, 0, 0.9),
                                      "wood", false)},
               {"tiles", with_pictures(file, tiles, "tiles", false)},
               {"dark_tiles", with_pictures(file, dark_tiles, "tiles", false)}});
    const int crate_mesh = add_crate(file, material("wood"));
    const int pot = file.add_mesh("teapot", primitives_of(teapot, {}, material));
    const int ground = file.add_mesh(
        "floor", primitives_of(chessboard(floor("tiles", 16, 4), "dark_tiles"), {}, material));
    file.add_node({{"name", "floor"}, {"mesh", ground}});
    // Below a node that shrinks them all.
    json stack{{"name", "stack"}, {"scale", {0.8, 0.8, 0.8}}, {"children", json::array()}};
    const auto place = [&](const char* name, int mesh, dvec3 at, json rotation) {
        stack["children"].push_back(file.add("nodes", {{"name", name},
                                                       {"mesh", mesh},
                                                       {"translation", {at.x, at.y, at.z}},
                                                       {"rotation", std::move(rotation)}}));
    };
    const double r5 = std::sqrt(5.0), r10 = std::sqrt(10.0), r26 = std::sqrt(26.0),
                 r50 = std::sqrt(50.0);
    place("left crate", crate_mesh, {-2.1, 0, 0.2}, turned(5 / r26, 1 / r26));
    place("right crate", crate_mesh, {1.4, 0, -0.4}, turned(7 / r50, -1 / r50));
    place("far crate", crate_mesh, {-0.6, 0, -3.4}, turned(3 / r10, 1 / r10));
    place("upper crate", crate_mesh, {-0.4, 2.4, -0.2}, turned(2 / r5, -1 / r5));
    place("teapot", pot, {4.6, 0, 2.6}, turned(3 / r10, -1 / r10));
    file.add_node(std::move(stack));
    file.add_camera("front", {-4.3, 4.6, 12}, {1.0, 1.5, 0}, 0.62);
    file.add_camera("above", {7, 10, 6}, {0.3, 1, 0}, 0.6);
    file.add_light("sun", {-5, 11, 8}, {0, 0, 0},
                   {{"type", "directional"}, {"color", {1, 0.92, 0.8}}, {"intensity", 3.2}});
    file.add_light("sky", {7, 6, -2}, {0, 0, 0},
                   {{"type", "directional"}, {"color", {0.6, 0.8, 1}}, {"intensity", 0.9}});
    return file;
}

/// Hammered copper, brick and tiles in a low sun, and a lamp with a shade.
inline GltfFile bumpy_scene(const std::vector<Part>& teapot) {
    GltfFile file("Relief in a low sun");
    file.use_extension("KHR_lights_punctual");
    const json tiles = plain_material("tiles", light_tile, 0, 0.45);
    const json dark_tiles = plain_material("dark_tiles", dark_tile, 0, 0.45);
    NamedMaterials material(
        file,
        {{"copper", with_pictures(file, plain_material("copper", {1, 0.86, 0.76}, 0.45, 0.42),
                                  "hammered", true)},
         {"tea", plain_material("tea", {0.12, 0.035, 0.008}, 0, 0.25)},
         {"brick", with_pictures(file, plain_material("brick", dvec3(1), 0, 0.8), "brick", true)},
         {"tiles", with_pictures(file, tiles, "tiles", true)},
         {"dark_tiles", with_pictures(file, dark_tiles, "tiles", true)}});
    std::map<std::string, std::vector<Part>> groups;
    for (Part& part : scene(teapot, "copper", "brick", "tiles"))
        groups[part.group].push_back(std::move(part));
    for (const auto& [name, parts] : groups)
        file.add_node(
            {{"name", name}, {"mesh", file.add_mesh(name, primitives_of(parts, {}, material))}});
    file.add_camera("front", {-5.2, 5.2, 9.2}, {-0.8, 1.1, -0.4}, 0.62);
    file.add_light("sun", {-9, 5, 2}, {0, 0, 0},
                   {{"type", "directional"}, {"color", {1, 0.87, 0.68}}, {"intensity", 4.2}});
    file.add_light("lamp", {3.5, 6, 3.5}, {0, 1, 0},
                   {{"type", "spot"},
                    {"color", {0.5, 0.7, 1}},
                    {"intensity", 60},
                    {"range", 20},
                    {"spot", {{"innerConeAngle", 0.3}, {"outerConeAngle", 0.45}}}});
    return file;
}

/// A toon material: a lit colour and a shade, and the width of the outline.
inline json toon_material(const std::string& name, dvec3 lit, dvec3 shade, double outline) {
    json material = plain_material(name, lit, 0, 1);
    material["extensions"]["VRMC_materials_mtoon"] = {
        {"specVersion", "1.0"},
        {"shadeColorFactor", {shade.r, shade.g, shade.b}},
        {"shadingToonyFactor", 0.95},
        {"shadingShiftFactor", -0.1},
        {"outlineWidthMode", outline > 0 ? "worldCoordinates" : "none"},
        {"outlineWidthFactor", outline},
        {"outlineColorFactor", {0.02, 0.015, 0.03}}};
    return material;
}

/// The robot as VRM files ask for it: light in two colours, and outlines.
inline GltfFile toon_scene() {
    GltfFile file("Robot");
    file.use_extension("KHR_lights_punctual");
    file.use_extension("VRMC_materials_mtoon");
    json lamp = toon_material("lamp", {0.8, 0.42, 0.04}, {0.5, 0.18, 0.03}, 0.025);
    lamp["emissiveFactor"] = {0.15, 0.08, 0.01};
    json eyes = toon_material("eyes", {0.1, 0.1, 0.1}, {0.08, 0.08, 0.1}, 0);
    eyes["emissiveFactor"] = {0.55, 0.85, 0.8};
    // Glass and panel are sunk so flat into what is around them that an outline would break off.
    NamedMaterials material(
        file,
        {{"coat", toon_material("coat", {0.8, 0.13, 0.06}, {0.34, 0.03, 0.06}, 0.025)},
         {"cream", toon_material("cream", {0.87, 0.72, 0.42}, {0.5, 0.3, 0.2}, 0.025)},
         {"panel", toon_material("panel", {0.87, 0.72, 0.42}, {0.5, 0.3, 0.2}, 0)},
         {"trim", toon_material("trim", {0.03, 0.36, 0.38}, {0.01, 0.13, 0.2}, 0.025)},
         {"glass", toon_material("glass", {0.05, 0.07, 0.14}, {0.02, 0.025, 0.06}, 0)},
         {"steel", toon_material("steel", {0.36, 0.4, 0.5}, {0.12, 0.13, 0.22}, 0.025)},
         {"lamp", lamp},
         {"eyes", eyes},
         {"box", toon_material("box", {0.75, 0.4, 0.12}, {0.34, 0.13, 0.06}, 0.025)},
         {"platform", toon_material("platform", {0.3, 0.5, 0.25}, {0.08, 0.2, 0.16}, 0.025)}});
    std::map<std::string, std::vector<Part>> groups;
    for (Part& part : figure(48)) groups[part.group].push_back(std::move(part));
    for (const auto& [name, parts] : groups)
        file.add_node(
            {{"name", name},
             {"mesh", file.add_mesh(name, primitives_of(parts, {.uvs = false}, material))}});
    file.add_camera("front", {-3.4, 3.6, 8.2}, {-0.1, 1.87, 0}, 0.58);
    file.add_light("sun", {-7, 6, 3}, {0, 0, 0},
                   {{"type", "directional"}, {"color", {1, 1, 1}}, {"intensity", 3}});
    return file;
}

}  // namespace rasterbook::assets
