// SPDX-License-Identifier: MIT
/// @file
/// What a model file becomes: meshes of polygons and of triangles, and their materials.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "common/math/types.hpp"

namespace rasterbook {

/// Marks a corner without uv or normal.
constexpr std::uint32_t no_index = std::numeric_limits<std::uint32_t>::max();

/// One corner of a face: indices into the arrays of its mesh.
struct Corner {
    std::uint32_t position;
    std::uint32_t uv = no_index;      ///< no_index where the file gives none.
    std::uint32_t normal = no_index;  ///< no_index where the file gives none.

    bool operator==(const Corner&) const = default;
};

/// A polygon as the file has it: a run of `corner_count` >= 3 corners in Mesh::corners.
struct Face {
    std::uint32_t first_corner;
    std::uint32_t corner_count;
    std::uint32_t material;  ///< Index into Scene::materials.
};

/// One of the n - 2 triangles that a face of n corners is cut into; same winding as the face.
struct Triangle {
    std::array<Corner, 3> corners;
    std::uint32_t material;  ///< Index into Scene::materials.
};

/// A box with sides along the axes; empty when min > max.
struct Bounds {
    vec3 min{std::numeric_limits<float>::infinity()};
    vec3 max{-std::numeric_limits<float>::infinity()};

    void add(vec3 point) { min = glm::min(min, point), max = glm::max(max, point); }
    vec3 center() const { return 0.5f * min + 0.5f * max; }

    /// Half of the diagonal; 1 for a box of no size or an empty one. Taken in double, where the
    /// squares of lengths neither overflow nor underflow.
    float radius() const {
        const double diagonal = min.x <= max.x ? glm::length(dvec3(max) - dvec3(min)) : 0;
        return diagonal > 0 ? static_cast<float>(diagonal / 2) : 1.0f;
    }
};

/// One group of a model file, with arrays of its own.
struct Mesh {
    std::string name;
    std::vector<vec3> positions;  ///< Model space.
    std::vector<vec2> uvs;        ///< v points up, as in OBJ.
    std::vector<vec3> normals;    ///< Model space, as in the file: perhaps not of unit length.
    std::vector<Corner> corners;
    std::vector<Face> faces;
    std::vector<Triangle> triangles;
    Bounds bounds;  ///< Of the positions that faces use.

    std::span<const Corner> corners_of(const Face& face) const {
        return std::span(corners).subspan(face.first_corner, face.corner_count);
    }
};

/// A picture that a material names, with the options that MTL puts before its name.
struct TextureMap {
    std::filesystem::path file;     ///< Ready to open; empty when there is no map.
    std::filesystem::path library;  ///< The material library that names it.
    std::size_t line = 0;           ///< Of that library, from 1.
    vec3 offset{0.0f};              ///< -o, in uv.
    vec3 scale{1.0f};               ///< -s, in uv.
    float bump_multiplier = 1.0f;   ///< -bm.
    bool clamp = false;             ///< -clamp on.
};

/// What MTL says of a surface. Colours are linear, as written.
struct Material {
    std::string name;
    vec3 ambient{1.0f};       ///< Ka
    vec3 diffuse{0.8f};       ///< Kd
    vec3 specular{0.0f};      ///< Ks
    vec3 emission{0.0f};      ///< Ke
    float shininess = 0.0f;   ///< Ns, >= 0
    float opacity = 1.0f;     ///< d, or 1 - Tr; 0 to 1
    int illumination = 2;     ///< illum: 0 colour only, 1 diffuse, 2 and above with highlights
    TextureMap diffuse_map;   ///< map_Kd
    TextureMap specular_map;  ///< map_Ks
    TextureMap opacity_map;   ///< map_d
    TextureMap bump_map;      ///< map_Bump, bump: heights
    TextureMap normal_map;    ///< norm, map_Norm: tangent-space normals
};

/// All that a model file holds. Material 0 is the default material for faces without one.
struct Scene {
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<std::string> warnings;  ///< What the loader passed over, each "FILE:LINE: ...".

    Bounds bounds() const {
        Bounds all;
        for (const Mesh& mesh : meshes) all.add(mesh.bounds.min), all.add(mesh.bounds.max);
        return all;
    }
};

}  // namespace rasterbook
