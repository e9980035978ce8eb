// SPDX-License-Identifier: MIT
/// @file
/// What a model file becomes: meshes of polygons and of triangles, their materials, and the cameras
/// and lights of the file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "common/math/types.hpp"
#include "common/model/load_budget.hpp"

namespace rasterbook {

/// Marks a vertex without uv or normal.
constexpr std::uint32_t no_index = std::numeric_limits<std::uint32_t>::max();

/// Smoothing groups beside those that OBJ counts from 1: `s off`, and where the file says nothing.
constexpr std::uint32_t no_smoothing = 0, smooth_by_angle = no_index;

/// One vertex of a face: indices into the arrays of its mesh.
struct Vertex {
    std::uint32_t position;
    std::uint32_t uv = no_index;      ///< no_index where the file gives none.
    std::uint32_t normal = no_index;  ///< no_index where the file gives none.

    bool operator==(const Vertex&) const = default;
};

/// A polygon as the file has it: a run of `vertex_count` >= 3 vertices in Mesh::vertices.
struct Face {
    std::uint32_t first_vertex;
    std::uint32_t vertex_count;
    std::uint32_t material;  ///< Index into Scene::materials.
};

/// One of the n - 2 triangles that a face of n vertices is cut into; same winding as the face.
struct Triangle {
    std::array<Vertex, 3> vertices;
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
    std::vector<dvec2> uvs;       ///< v points up, as in OBJ; they may be far from 0.
    std::vector<vec3> normals;    ///< Model space, as in the file: perhaps not of unit length.
    std::vector<vec4> colors{};   ///< Of the positions, linear, with opacity, 0 to 1; empty: white.
    std::vector<vec4> tangents{};  ///< Of the normals, with handedness; empty until lesson 08.
    std::vector<Vertex> vertices;
    std::vector<Face> faces;
    std::vector<Triangle> triangles;
    Bounds bounds;  ///< Of the positions that faces use.

    // For vertices without normals.
    std::vector<std::uint32_t> smoothing_groups{};  ///< Of the triangles; empty: smooth_by_angle.
    std::vector<std::uint32_t> shared_positions{};  ///< Of the positions: their numbers in the
                                                    ///< file, where meshes may share some.

    std::span<const Vertex> vertices_of(const Face& face) const {
        return std::span(vertices).subspan(face.first_vertex, face.vertex_count);
    }
};

/// A picture that a material names, with the options that MTL puts before its name.
struct TextureMap {
    std::filesystem::path file;      ///< Ready to open; empty when there is no map.
    std::filesystem::path library;   ///< The material library, or glTF file, that names it.
    std::size_t line = 0;            ///< Of that library, from 1; 0: none in particular.
    dvec3 offset{0.0};               ///< -o, in uv.
    dvec3 scale{1.0};                ///< -s, in uv.
    float bump_multiplier = 1.0f;    ///< -bm, or the scale of a glTF normal map.
    bvec2 clamp{false};              ///< -clamp on; across and up, which glTF tells apart.
    bvec2 mirror{false};             ///< Every other copy is mirrored; only where `clamp` is off.
    bool nearest_magnified = false;  ///< Texels larger than a pixel are sharp, as in pixel art.
    bool nearest_minified = false;   ///< Smaller ones are not averaged.
    std::string asked_by{};          ///< For messages; empty: the statement of MTL.
    std::string unreadable{};        ///< Why there is no image to be read; empty: there is one.

    /// The bytes of the picture's file where that stands inside the model's file; `file` is then
    /// only a name, one for each picture.
    std::shared_ptr<const std::vector<std::uint8_t>> embedded{};
};

/// How a surface's opacity is to be taken.
enum class AlphaMode {
    opaque,  ///< It does not count, but for `d` of an OBJ file's material.
    mask,    ///< From alpha_cutoff on a point is there, below it is a hole.
    blend,   ///< What lies behind shines through.
};

/// A surface that wants to be drawn as in a comic, as MToon has it.
struct ToonMaterial {
    /// Of what outline_width is a length.
    enum class Outline { none, world, screen };

    vec3 shade{1.0f};    ///< Its colour away from the light, linear; lit it has Kd.
    float toony = 0.9f;  ///< The border of the light: 1 is sharp, 0 as wide as the sphere.
    float shift = 0.0f;  ///< -1 to 1, added to N.L: the lit side is larger or smaller.
    Outline outline = Outline::none;
    float outline_width = 0.0f;  ///< World space, or in heights of the picture.
    vec3 outline_color{0.0f};    ///< Linear.
};

/// Loaders bring the colours of materials into -max_color to max_color: a sum of them is finite,
/// and so is a product with the light of a lesson.
constexpr float max_color = 1e37f;

/// What MTL says of a surface, and what glTF says beyond it. Colours are linear, as written but for
/// max_color.
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
    TextureMap emission_map;  ///< map_Ke
    TextureMap opacity_map;   ///< map_d
    TextureMap bump_map;      ///< map_Bump, bump: heights
    TextureMap normal_map;    ///< norm, map_Norm: tangent-space normals

    AlphaMode alpha = AlphaMode::opaque;  ///< Of opacity times the diffuse map's fourth channel.
    float alpha_cutoff = 0.5f;            ///< For AlphaMode::mask.
    bool two_sided = false;               ///< The back is to be seen, too.
    std::optional<ToonMaterial> toon{};   ///< Only where the file asks for it.
};

/// A camera of a scene file.
struct SceneCamera {
    std::string name;
    mat4 world_from_view;  ///< Turns and moves, no more: the camera looks along its -z.
    float fov_y_radians;   ///< From the lower to the upper border, in (0, pi).
    float near;            ///< > 0, world space.
    float far;             ///< > near; infinite where the file gives none.
};

/// A light of a scene file.
struct SceneLight {
    enum class Kind { directional, point, spot };

    std::string name;
    Kind kind;
    vec3 color;            ///< Linear, times the intensity: lux if directional, else candela.
    vec3 position_world;   ///< Of a point light or spot.
    vec3 direction_world;  ///< Length 1: where a directional light or spot shines.
    float range;           ///< Beyond it a point light or spot ends, world space; may be infinite.
    float cos_inner = 1;   ///< Cosine of the angle up to which a spot shines fully.
    float cos_outer = 0;   ///< Of the angle from which on it does not shine, < cos_inner.
};

/// All that a model file holds. Material 0 is the default material for faces without one.
struct Scene {
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<std::string> warnings;   ///< What the loader passed over, each "FILE:LINE: ...".
    std::vector<SceneCamera> cameras{};  ///< As glTF has them; the lessons' own until lesson 11.
    std::vector<SceneLight> lights{};    ///< The same.
    bool is_gltf = false;                ///< The file is of a kind that may have both.
    LoadBudget budget{};                 ///< What is left for its images.
    std::filesystem::path file{};        ///< That it was read from.

    /// World space: what all positions are relative to, those of meshes, cameras and lights. Not 0
    /// only where a file's scene stands far from 0 (WorldBox::origin()).
    dvec3 origin{0.0};

    Bounds bounds() const {
        Bounds all;
        for (const Mesh& mesh : meshes) all.add(mesh.bounds.min), all.add(mesh.bounds.max);
        return all;
    }
};

}  // namespace rasterbook
