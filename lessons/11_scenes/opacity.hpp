// SPDX-License-Identifier: MIT
/// @file
/// How opaque a surface is in a point: by its material, its texture and its vertices' colours.
/// Introduced in lesson 11; derivation: docs/derivations/11_scenes.md.
#pragma once

#include <array>
#include <cstddef>

#include "03_z_buffer/depth_buffer.hpp"
#include "05_textures/interpolation.hpp"
#include "06_phong/surface.hpp"
#include "11_scenes/blending.hpp"
#include "11_scenes/scene_assets.hpp"

namespace rasterbook {

/// A triangle's material with its textures, and its vertex attributes. A toon material's ambient
/// colour is its shade.
inline TriangleSurface triangle_surface(const SceneAssets& assets,
                                        const ProjectedTriangle& projected) {
    TriangleSurface surface = triangle_surface(
        assets.scene, assets.textures, assets.effects[projected.triangle.material], projected);
    if (surface.material.toon) surface.own_color.ambient = surface.material.toon->shade;
    return surface;
}

/// The colors of a triangle's vertices.
///
/// @tparam G  As F in SurfaceInputs.
template <typename G>
struct ColorInputs {
    bool are_there = false;
    std::array<glm::vec<4, G>, 3> of_vertices{};

    /// Exactly the vertices' color where all three agree: barycentric coordinates add up to 1 but
    /// for rounding (Eq. 11.2).
    template <typename F>
    glm::vec<4, F> at(Vec3<F> at) const {
        using Color = glm::vec<4, F>;
        return Color(of_vertices[0]) + at.y * Color(of_vertices[1] - of_vertices[0]) +
               at.z * Color(of_vertices[2] - of_vertices[0]);
    }
};
using VertexColors = ColorInputs<float>;

inline VertexColors vertex_colors(const ProjectedTriangle& projected) {
    const std::vector<vec4>& colors = projected.mesh.colors;
    VertexColors result{!colors.empty()};
    for (std::size_t i = 0; result.are_there && i < 3; ++i)
        result.of_vertices[i] = colors[projected.triangle.vertices[i].position];
    return result;
}

/// The colours of a fragment: the material's own, times its textures, times the vertices' colours.
///
/// @param in_texture  Of texture_sample().
template <typename F, typename G, typename H>
FragmentColor<F> surface_color(const SurfaceInputs<G>& surface, const ColorInputs<H>& colors,
                               const PerspectiveBarycentrics<F>& at, const Vec3<F>& in_texture,
                               Filter filter) {
    FragmentColor<F> color = surface_color(surface, at, in_texture, filter);
    if (!colors.are_there) return color;
    count_each<F>(Counter::colored_fragments);
    const Vec3<F> of_vertices(colors.at(at.here));
    trace("colour of vertices", of_vertices, "Eq. 11.2");
    color.tint(of_vertices);
    return color;
}

/// How opaque a fragment is, 0 to 1: by the material, its texture and the vertices (Eq. 11.6). What
/// has neither holes nor is glass is opaque.
///
/// @param in_texture  Of texture_sample().
template <typename F>
F opacity_at(const TriangleSurface& surface, const VertexColors& colors, Vec3<F> at,
             const glm::vec<4, F>& in_texture) {
    if (surface.material.alpha != AlphaMode::mask && !is_transparent(surface.material))
        return F(1.0f);
    F opacity = F(surface.material.opacity) * in_texture.a;
    if (colors.are_there) opacity *= colors.at(at).a;
    return clamp(opacity, F(0.0f), F(1.0f));
}

/// What the opacity of a triangle's points depends on.
struct AlphaInputs {
    TriangleSurface surface;
    PerspectiveSetup setup;
    VertexColors colors;
};

inline AlphaInputs alpha_inputs(const SceneAssets& assets, const ProjectedTriangle& projected) {
    return {triangle_surface(assets, projected), perspective_setup(projected),
            vertex_colors(projected)};
}

/// Whether there is a hole in a surface, and not the surface (Eq. 11.6).
inline bool is_hole(const TriangleSurface& surface, float opacity) {
    if (surface.material.alpha != AlphaMode::mask) return false;
    count(Counter::alpha_tested_fragments);
    if (passes_alpha_test(opacity, surface.material.alpha_cutoff)) return false;
    trace_hole(opacity, surface.material.alpha_cutoff);
    return true;
}

/// The depth test alone. Nothing is written yet: there may be a hole.
inline bool is_nearer(const DepthBuffer& buffer, ivec2 pixel, float depth) {
    trace_depth(buffer.depths()[pixel], depth);
    return depth > buffer.depths()[pixel];
}

}  // namespace rasterbook
