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
#include "08_normal_maps/normal_map_options.hpp"
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
    std::array<Vec3<F>, 3> tangents{};  ///< Of the vertices; for MapSpace::tangent.
    F handedness{1};
};
using TriangleNormalMap = NormalMapInputs<float>;

/// All but the tangents.
inline TriangleNormalMap normal_map_inputs(const Scene& scene, const NormalMaps& maps,
                                           const ProjectedTriangle& projected) {
    const std::size_t material = projected.triangle.material;
    TriangleNormalMap map{.texture = maps.textures[material].get()};
    if (map.texture == nullptr) return map;
    const TextureMap& named = normal_map_of(scene.materials[material]);
    map.space = maps.spaces[material];
    map.side = projected.is_back_facing ? -1.0f : 1.0f;
    map.bump_multiplier = named.bump_multiplier;
    map.uvs = uvs_of(projected.mesh, projected.triangle, named, map.texture);
    return map;
}

/// @param scene  With tangents, as make_tangents() leaves them.
inline TriangleNormalMap triangle_normal_map(const Scene& scene, const NormalMaps& maps,
                                             const ProjectedTriangle& projected) {
    TriangleNormalMap map = normal_map_inputs(scene, maps, projected);
    if (map.texture == nullptr || map.space == MapSpace::object) return map;
    const auto tangent = [&](std::size_t i) {
        return projected.mesh.tangents[projected.triangle.vertices[i].normal];
    };
    for (std::size_t i = 0; i < 3; ++i) map.tangents[i] = map.side * vec3(tangent(i));
    map.handedness = map.side * tangent(0).w;
    return map;
}

/// The frame in a fragment (Eq. 8.5).
template <typename F, typename G>
TangentBasis<F> frame_at(const NormalMapInputs<G>& map, Vec3<F> at, Vec3<F> normal) {
    return tangent_frame(Vec3<F>(interpolate(map.tangents, at)), normal, F(map.handedness));
}

/// Notes for `--probe` how a normal is perturbed.
template <typename F>
void note_perturbed(const TangentBasis<F>& frame, const Vec3<F>& in_map, const Vec3<F>& normal) {
    trace("  tangent", frame.tangent, "Eq. 8.5");
    trace("  bitangent", frame.bitangent, "Eq. 8.5");
    trace("  normal, perturbed", perturbed(frame, in_map, normal), "Eq. 8.7");
}

/// A fragment's normal, perturbed by the map.
///
/// @param normal  Interpolated, not yet scaled.
/// @return        Of any length.
template <typename F, typename G>
Vec3<F> normal_mapped(const NormalMapInputs<G>& map, const PerspectiveBarycentrics<F>& at,
                      Vec3<F> normal, Filter filter) {
    if (map.texture == nullptr) return normal;
    count_each<F>(Counter::normal_map_samples);
    trace("normal, interpolated", normal, "Eq. 5.1");
    label_sample("normal map");
    Vec3<F> in_map = sample_normal(*map.texture, filter, fragment_uv(map.uvs, at));
    trace("  normal of the map", in_map, "Eq. 8.1");
    if (map.space == MapSpace::object) return F(map.side) * in_map;
    const F bump(map.bump_multiplier);
    if (map.bump_multiplier != 1) in_map.x *= bump, in_map.y *= bump;
    if constexpr (has_probe)
        if (is_traced()) note_perturbed(frame_at(map, at.here, normal), in_map, normal);
    return perturbed(frame_at(map, at.here, normal), in_map, normal);
}

/// The direction to the key light: low, so that its light rakes over the surface.
constexpr vec3 low_key(-1.2f, 0.3f, 0.22f);

}  // namespace rasterbook
