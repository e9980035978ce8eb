// SPDX-License-Identifier: MIT
/// @file
/// What shading has to know of a triangle and of a point on it. Introduced in lesson 06.
#pragma once

#include <array>
#include <cstddef>

#include "04_mvp/projection.hpp"
#include "05_textures/interpolation.hpp"
#include "05_textures/textures.hpp"
#include "06_phong/effects.hpp"
#include "06_phong/phong.hpp"
#include "common/app/counters.hpp"

namespace rasterbook {

/// A triangle's material with its textures, and its vertex attributes.
///
/// @tparam F  float; or several floats at once, each of a triangle of its own.
template <typename F>
struct SurfaceInputs {
    const Material& material;
    EffectMask effects;
    const Texture *texture, *specular_texture, *emission_texture;  ///< Null: none was read.
    SurfaceColor own_color;                                        ///< Of the material alone.
    std::array<glm::vec<2, F>, 3> uvs{}, specular_uvs{}, emission_uvs{};  ///< Only of what is read.
    std::array<Vec3<F>, 3> positions_world;
    std::array<Vec3<F>, 3> normals_world;  ///< Length 1, of the side that is seen; 0: none.
};
using TriangleSurface = SurfaceInputs<float>;

/// @param scene    As complete_normals() leaves its meshes.
/// @param effects  Of the triangle's material.
inline TriangleSurface triangle_surface(const Scene& scene, const SurfaceTextures& textures,
                                        EffectMask effects, const ProjectedTriangle& projected) {
    const Mesh& mesh = projected.mesh;
    const Triangle& triangle = projected.triangle;
    const std::size_t i = triangle.material;
    TriangleSurface surface{.material = scene.materials[i],
                            .effects = effects,
                            .texture = textures.diffuse[i].get(),
                            .specular_texture = textures.specular[i].get(),
                            .emission_texture = textures.emission[i].get(),
                            .own_color = surface_color(scene.materials[i]),
                            .positions_world = {},
                            .normals_world = {}};
    if (surface.effects[Effect::texture])
        surface.uvs = uvs_of(mesh, triangle, surface.material.diffuse_map, surface.texture);
    if (surface.effects[Effect::specular_map])
        surface.specular_uvs =
            uvs_of(mesh, triangle, surface.material.specular_map, surface.specular_texture);
    if (surface.effects[Effect::emission_map])
        surface.emission_uvs =
            uvs_of(mesh, triangle, surface.material.emission_map, surface.emission_texture);
    for (std::size_t v = 0; v < 3; ++v) {
        const Vertex& vertex = triangle.vertices[v];
        surface.positions_world[v] = mesh.positions[vertex.position];
        if (vertex.normal == no_index) continue;
        const vec3 normal = mesh.normals[vertex.normal];
        surface.normals_world[v] = projected.is_back_facing ? -normal : normal;
    }
    return surface;
}

/// What a surface's colour texture holds at a point: linear colour and alpha, 0 to 1; without one,
/// white.
///
/// @tparam G  F, or float where all of them are of one triangle.
template <typename F, typename G>
glm::vec<4, F> texture_color(const SurfaceInputs<G>& surface, const PerspectiveBarycentrics<F>& at,
                             Filter filter) {
    if (!surface.effects[Effect::texture]) return glm::vec<4, F>(F(1.0f));
    trace("diffuse of material", surface.own_color.diffuse);
    return sample(*surface.texture, filter, fragment_uv(surface.uvs, at));
}

/// texture_color() of a fragment, counted.
template <typename F, typename G>
glm::vec<4, F> texture_sample(const SurfaceInputs<G>& surface, const PerspectiveBarycentrics<F>& at,
                              Filter filter) {
    if (surface.effects[Effect::texture]) count_each<F>(Counter::texture_samples);
    return texture_color(surface, at, filter);
}

/// The colours of a fragment: the material's own, times its textures.
///
/// @param in_texture  Of texture_sample().
template <typename F, typename G>
FragmentColor<F> surface_color(const SurfaceInputs<G>& surface,
                               const PerspectiveBarycentrics<F>& at, const Vec3<F>& in_texture,
                               Filter filter) {
    FragmentColor<F> color(surface.own_color);
    trace_perspective(at.here);
    if (surface.effects[Effect::texture]) color.tint(in_texture);
    if (surface.effects[Effect::specular_map]) {
        count_each<F>(Counter::texture_samples);
        label_sample("specular texture");
        color.specular *= Vec3<F>(
            sample(*surface.specular_texture, filter, fragment_uv(surface.specular_uvs, at)));
    }
    if (surface.effects[Effect::emission_map]) {
        count_each<F>(Counter::texture_samples);
        label_sample("emission texture");
        color.emission *= Vec3<F>(
            sample(*surface.emission_texture, filter, fragment_uv(surface.emission_uvs, at)));
    }
    trace("diffuse colour", color.diffuse);
    if (surface.effects[Effect::highlight]) trace("specular colour", color.specular);
    if (surface.effects[Effect::emission_map]) trace("emission", color.emission);
    return color;
}

/// The colours of a fragment whose colour texture has not been sampled yet.
template <typename F, typename G>
FragmentColor<F> surface_color(const SurfaceInputs<G>& surface,
                               const PerspectiveBarycentrics<F>& at, Filter filter) {
    const Vec3<F> in_texture(texture_sample(surface, at, filter));
    return surface_color(surface, at, in_texture, filter);
}

/// A point of a surface as light falls on it.
///
/// @param normal_world  Of any length (Eq. 6.8); the first vertex's where it is zero or not finite.
template <typename F, typename G>
SurfacePoint<F> surface_point(const SurfaceInputs<G>& surface, Vec3<F> at, Vec3<F> normal_world,
                              vec3 eye_world) {
    count_each<F>(Counter::fragments_lit);
    SurfacePoint<F> point{interpolate(surface.positions_world, at),
                          unit_or(normal_world, Vec3<F>(surface.normals_world[0])),
                          Vec3<F>(F(0.0f))};
    if (surface.effects[Effect::highlight]) {
        count_each<F>(Counter::highlights);
        point.toward_eye = unit_or(Vec3<F>(eye_world) - point.position_world, point.normal_world);
    }
    trace_position(point.position_world);
    trace("normal", point.normal_world, "Eq. 6.8");
    return point;
}

/// The highlight of its material.
template <typename G>
PhongHighlight highlight_of(const SurfaceInputs<G>& surface) {
    return {surface.effects[Effect::highlight], surface.material.shininess};
}

}  // namespace rasterbook
