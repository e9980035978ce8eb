// SPDX-License-Identifier: MIT
/// @file
/// Normals from the maps that a scene's materials name. Introduced in lesson 08.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "04_mvp/projection.hpp"
#include "05_textures/interpolation.hpp"
#include "05_textures/textures.hpp"
#include "06_phong/effects.hpp"
#include "06_phong/face_normal.hpp"
#include "08_normal_maps/normal_map.hpp"
#include "08_normal_maps/normal_map_variants.hpp"
#include "08_normal_maps/tangent_frame.hpp"
#include "common/app/counters.hpp"

namespace rasterbook {

/// The normal maps of a scene: one for each material.
struct NormalMaps {
    MaterialTextures textures;     ///< `norm`, or else `map_Bump`; null: none.
    std::vector<MapSpace> spaces;  ///< Of its normals.
};

/// Lesson 06's plan, with normal maps.
inline std::vector<EffectMask> plan_effects(const Scene& scene, const SurfaceTextures& textures,
                                            const NormalMaps& normal_maps, bool all_effects) {
    std::vector<EffectMask> effects = plan_effects(scene, textures, all_effects);
    for (std::size_t i = 0; i < effects.size(); ++i)
        effects[i].set(Effect::normal_map, normal_maps.textures[i] != nullptr);
    return effects;
}

/// The map of a material that its normals come from.
inline const TextureMap& normal_map_of(const Material& material) {
    return material.normal_map.file.empty() ? material.bump_map : material.normal_map;
}

/// A triangle's normal map, and what its vertices have for it.
///
/// @tparam F  As in SurfaceInputs.
template <typename F>
struct NormalMapInputs {
    const Texture* texture = nullptr;  ///< Null if there is no map; then the rest means nothing.
    MapSpace space = MapSpace::tangent;
    F side{1};                  ///< -1 as seen from behind: a bump in front is a dent there.
    float bump_multiplier = 1;  ///< -bm
    std::array<glm::vec<2, F>, 3> uvs{};
    std::array<Vec3<F>, 3> tangents{};  ///< Of the vertices; or of the face, the same for all.
    F handedness{1};
    TangentBasis<F> face{};  ///< For FrameOf::face: as Eq. 8.3 finds it.
};
using TriangleNormalMap = NormalMapInputs<float>;

/// @param scene  With tangents, as make_tangents() leaves them.
inline TriangleNormalMap triangle_normal_map(const NormalMapVariant& variant, const Scene& scene,
                                             const NormalMaps& maps,
                                             const ProjectedTriangle& projected) {
    const std::vector<vec3>& positions = projected.mesh.positions;
    const std::array<Vertex, 3>& indices = projected.triangle.vertices;
    const std::size_t material = projected.triangle.material;
    TriangleNormalMap map{.texture = maps.textures[material].get()};
    if (map.texture == nullptr) return map;
    const TextureMap& named = normal_map_of(scene.materials[material]);
    map.space = maps.spaces[material];
    map.side = projected.is_back_facing ? -1.0f : 1.0f;
    map.bump_multiplier = named.bump_multiplier;
    map.uvs = uvs_of(projected.mesh, projected.triangle, named, map.texture);
    if (map.space == MapSpace::object) return map;
    float handedness = 1;
    if (variant.frame == FrameOf::vertex) {
        const std::vector<vec4>& tangents = projected.mesh.tangents;
        for (std::size_t i = 0; i < 3; ++i)
            map.tangents[i] = map.side * vec3(tangents[indices[i].normal]);
        handedness = tangents[indices[0].normal].w;
    } else {
        const UvDirections directions =
            uv_directions({positions[indices[0].position], positions[indices[1].position],
                           positions[indices[2].position]},
                          map.uvs);
        map.tangents.fill(map.side * directions.tangent);
        map.face = {map.side * directions.tangent, map.side * directions.bitangent,
                    map.side * face_normal(projected.mesh, projected.triangle)};
        if (directions.handedness < 0) handedness = -1;
    }
    map.handedness = map.side * (variant.handedness == Handedness::ignored ? 1 : handedness);
    return map;
}

/// The frame in a fragment, as the variant has it.
template <typename F, typename G>
TangentBasis<F> frame_at(const NormalMapInputs<G>& map, const NormalMapVariant& variant, Vec3<F> at,
                         Vec3<F> normal) {
    if (variant.frame == FrameOf::face)
        return {Vec3<F>(map.face.tangent), Vec3<F>(map.face.bitangent),
                unit_or(normal, Vec3<F>(map.face.normal))};
    const Vec3<F> tangent = interpolate(map.tangents, at);
    const F handedness(map.handedness);
    if (variant.frame == FrameOf::vertex && variant.orthonormal == Orthonormal::at_vertices)
        return {tangent, handedness * glm::cross(normal, tangent), normal};
    return tangent_frame(tangent, normal, handedness);
}

/// A fragment's normal, perturbed by the map.
///
/// @param normal  Interpolated, not yet scaled.
/// @return        Of any length.
template <typename F, typename G>
Vec3<F> normal_mapped(const NormalMapInputs<G>& map, const NormalMapVariant& variant,
                      const PerspectiveBarycentrics<F>& at, Vec3<F> normal, Filter filter) {
    if (map.texture == nullptr) return normal;
    count_each<F>(Counter::normal_map_samples);
    Vec3<F> in_map = sample_normal(*map.texture, filter, fragment_uv(map.uvs, at));
    if (variant.channels == Channels::xy) in_map = with_z(glm::vec<2, F>(in_map));
    if (map.space == MapSpace::object) return F(map.side) * in_map;
    const F bump(map.bump_multiplier);
    if (map.bump_multiplier != 1) in_map.x *= bump, in_map.y *= bump;
    return perturbed(frame_at(map, variant, at.here, normal), in_map, normal);
}

/// The direction to the key light: low, so that its light rakes over the surface.
constexpr vec3 low_key(-1.2f, 0.3f, 0.22f);

}  // namespace rasterbook
