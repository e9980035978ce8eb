// SPDX-License-Identifier: MIT
/// @file
/// A scene with lights and normal maps. Introduced in lesson 08.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "06_phong/lit_points.hpp"
#include "06_phong/lit_scene.hpp"
#include "08_normal_maps/normal_map.hpp"
#include "08_normal_maps/normal_map_variants.hpp"
#include "08_normal_maps/tangent_frame.hpp"

namespace rasterbook {

/// A model with lights, the normal maps of its materials, and tangents where those call for them.
struct BumpyScene : LitScene {
    MaterialTextures normal_textures;     ///< `norm`, or else `map_Bump`; null for what is not lit.
    std::vector<MapSpace> normal_spaces;  ///< For each material.
    std::vector<std::vector<vec4>> tangents;  ///< For each mesh as of vertex_tangents(), or none.

    /// @param options  Has TextureOptions `texture`, LightOptions `shading` and NormalMapVariant
    ///                 `normal_map`; with shading.all_effects, a lit material without a map is
    ///                 given one that tilts nothing.
    template <typename Options>
    BumpyScene(Scene scene, const Options& options) : LitScene(std::move(scene), options) {
        const NormalMapVariant& variant = options.normal_map;
        const auto calls_for_map = [&](const Material& material) {
            return material.illumination >= 1 && variant.space != MapSpace::none;
        };
        normal_textures = load_textures(
            &Material::normal_map, "norm", options.texture,
            [&](const Image<u8vec4>& picture, Wrap) { return variant.normals(picture); },
            calls_for_map);
        const MaterialTextures bumps = load_textures(
            &Material::bump_map, "map_Bump", options.texture,
            [&](const Image<u8vec4>& picture, Wrap wrap) {
                return variant.normals_of_bumps(picture, wrap);
            },
            [&](const Material& material) {
                return calls_for_map(material) && material.normal_map.file.empty();
            });
        normal_spaces.assign(materials.size(), MapSpace::tangent);
        for (std::size_t i = 0; i < materials.size(); ++i) {
            if (normal_textures[i]) normal_spaces[i] = variant.space;
            if (bumps[i]) normal_textures[i] = bumps[i];
            if (!normal_textures[i] && effects[i].light && options.shading.all_effects)
                normal_textures[i] = std::make_shared<Texture>(
                    make_texture(Image<vec4>({1, 1}, vec4(0, 0, 1, 1)), Wrap::repeat));
        }
        tangents.resize(meshes.size());
        if (variant.frame != FrameOf::vertex) return;
        for (std::size_t i = 0; i < meshes.size(); ++i)
            if (calls_for_tangents(meshes[i]))
                tangents[i] = vertex_tangents(meshes[i], [&](const Triangle& triangle) {
                    return normal_map_uvs(meshes[i], triangle);
                });
    }

    /// @param mesh  One of the scene's own.
    const std::vector<vec4>& tangents_of(const Mesh& mesh) const {
        return tangents[static_cast<std::size_t>(&mesh - meshes.data())];
    }

    /// The map of a material that its normals come from.
    const TextureMap& normal_map_of(const Material& material) const {
        return material.normal_map.file.empty() ? material.bump_map : material.normal_map;
    }

    std::array<vec2, 3> normal_map_uvs(const Mesh& mesh, const Triangle& triangle) const {
        return uvs_of(mesh, triangle, normal_map_of(materials[triangle.material]));
    }

  private:
    bool calls_for_tangents(const Mesh& mesh) const {
        return std::ranges::any_of(mesh.triangles, [&](const Triangle& triangle) {
            return normal_textures[triangle.material] &&
                   normal_spaces[triangle.material] == MapSpace::tangent;
        });
    }
};

/// Where the key light stands: low, so that its light rakes over what stands out.
constexpr vec3 low_key(-1.2f, 0.3f, 0.22f);

/// Up to 64 points that are lit together, what the normal map has there, and their weights.
struct BumpyPoints : LitPoints {
    Vectors in_map, weights;
};

/// What a triangle's normal map makes of its normals.
class TriangleRelief {
  public:
    /// @param mesh     One of the scene's own.
    /// @param is_back  The triangle is seen from behind: what stands out there is a dent here.
    TriangleRelief(const NormalMapVariant& variant, const BumpyScene& scene, const Mesh& mesh,
                   const Triangle& triangle, bool is_back)
        : texture_(scene.normal_textures[triangle.material].get()) {
        if (!texture_) return;
        const Material& material = scene.materials[triangle.material];
        variant_ = variant;
        space_ = scene.normal_spaces[triangle.material];
        side_ = is_back ? -1.0f : 1.0f;
        steepness_ = scene.normal_map_of(material).bump_multiplier;
        uvs_ = scene.normal_map_uvs(mesh, triangle);
        if (space_ == MapSpace::object) return;
        if (variant.frame == FrameOf::vertex) {
            const std::vector<vec4>& tangents = scene.tangents_of(mesh);
            for (std::size_t i = 0; i < 3; ++i)
                tangents_[i] = side_ * vec3(tangents[triangle.corners[i].normal]);
            handedness_ = side_ * tangents[triangle.corners[0].normal].w;
            return;
        }
        const std::array positions{mesh.positions[triangle.corners[0].position],
                                   mesh.positions[triangle.corners[1].position],
                                   mesh.positions[triangle.corners[2].position]};
        const UvDirections directions = uv_directions(positions, uvs_);
        handedness_ = directions.handedness < 0 ? -side_ : side_;
        tangents_.fill(side_ * directions.tangent);
        const vec3 normal = side_ * face_normal(mesh, triangle);
        face_ = tangent_frame(tangents_[0], normal, handedness_);
    }

    /// Reads the map for all points.
    ///
    /// @param weights  Theirs.
    template <typename CounterPolicy>
    void add(const ManyWeights& weights, Filter filter, BumpyPoints& points,
             CounterPolicy& counters) const {
        if (!texture_) return;
        points.weights = weights.here;
        const auto take = [&](std::size_t i, vec4 texel) {
            counters.add(Counter::normal_map_samples);
            points.in_map.set(i, vec3(texel));
        };
        if (texture_->wrap == Wrap::mirror)
            for (std::size_t i = 0; i < weights.count; ++i)
                take(i, vec4(sample_normal(*texture_, filter, fragment_uv(uvs_, weights[i])), 1));
        else
            sample_many(*texture_, filter, uvs_, weights, take);
        if (variant_.channels == Channels::xy)
            for (std::size_t i = 0; i < weights.count; ++i)
                points.in_map.set(i, with_z(vec2(points.in_map[i])));
        if (space_ == MapSpace::object || steepness_ == 1) return;
        for (std::size_t i = 0; i < weights.count; ++i)
            points.in_map.x[i] *= steepness_, points.in_map.y[i] *= steepness_;
    }

    /// Tilts the normals of points as the map has it. Their lengths are not 1.
    void tilt(BumpyPoints& points) const {
        if (!texture_) return;
        if (space_ == MapSpace::object) {
            for (std::size_t i = 0; i < points.count; ++i)
                points.normal_world.set(i, side_ * points.in_map[i]);
            return;
        }
        if (is_orthonormal_at_pixels() && tilt_at_once(points)) return;
        for (std::size_t i = 0; i < points.count; ++i) {
            const vec3 mixed = points.normal_world[i];
            points.normal_world.set(
                i, tilted(frame_at(points.weights[i], mixed), points.in_map[i], mixed));
        }
    }

  private:
    bool is_orthonormal_at_pixels() const {
        return variant_.frame == FrameOf::pixel || (variant_.frame == FrameOf::vertex &&
                                                    variant_.orthonormal == Orthonormal::at_pixels);
    }

    TangentFrame frame_at(vec3 weights, vec3 mixed_normal) const {
        if (variant_.frame == FrameOf::face)
            return {face_.tangent, face_.bitangent, unit_or(mixed_normal, face_.normal)};
        const vec3 tangent = interpolate(tangents_, weights);
        if (!is_orthonormal_at_pixels())
            return {tangent, handedness_ * glm::cross(mixed_normal, tangent), mixed_normal};
        return tangent_frame(tangent, mixed_normal, handedness_);
    }

    /// The same bits as of frame_at() and tilted(), many points at a time: the steps of unit_or()
    /// and unit_across() in their usual case.
    ///
    /// @return  Whether all is done: false, and nothing has changed, where a vector is so long or
    ///          so short that its square is not a usable number, or a tangent leads along a normal.
    bool tilt_at_once(BumpyPoints& points) const {
        // No step of the loop leaves it, or reads what the loop might write: the compiler takes
        // many i at once.
        const std::array tangents = tangents_;
        const float handedness = handedness_;
        int unusable = 0;
        Vectors all;
        for (std::size_t i = 0; i < points.count; ++i) {
            const vec3 mixed = points.normal_world[i], in_map = points.in_map[i];
            const vec3 n = mixed * one_over_length(mixed, unusable);
            const vec3 tangent = interpolate(tangents, points.weights[i]);
            const vec3 left = across(tangent, n);
            const float of_length = glm::dot(left, left), of_all = glm::dot(tangent, tangent);
            unusable |= (of_length > mostly * of_all ? 0 : 1) | (of_length > 1e-30f ? 0 : 1) |
                        (of_all < 1e30f ? 0 : 1);
            const vec3 t = left * (1 / std::sqrt(of_length));  // Eq. 8.5
            const TangentFrame frame{t, handedness * glm::cross(n, t), n};
            all.set(i, tilted(frame, in_map, mixed));
        }
        if (unusable == 0) points.normal_world = all;
        return unusable == 0;
    }

    const Texture* texture_;  ///< Null where there is no map; then the rest means nothing.
    NormalMapVariant variant_;
    MapSpace space_ = MapSpace::tangent;
    float side_ = 1;       ///< -1 as seen from behind.
    float steepness_ = 1;  ///< -bm
    std::array<vec2, 3> uvs_;
    std::array<vec3, 3> tangents_;  ///< Of the corners, or thrice that of the face.
    float handedness_ = 1;
    TangentFrame face_;  ///< For FrameOf::face.
};

}  // namespace rasterbook
