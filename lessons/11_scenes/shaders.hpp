// SPDX-License-Identifier: MIT
/// @file
/// Shaders: the pipeline of a triangle, compiled once for each permutation, and chosen once for a
/// material. Introduced in lesson 11; derivation: docs/derivations/11_scenes.md.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "05_textures/interpolation.hpp"
#include "06_phong/phong.hpp"
#include "06_phong/studio_lights.hpp"
#include "06_phong/surface.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "10_threading/split.hpp"
#include "11_scenes/blending.hpp"
#include "11_scenes/permutation.hpp"
#include "11_scenes/scene_assets.hpp"
#include "11_scenes/toon_material.hpp"

namespace rasterbook {

/// What a picture is drawn with, and into.
///
/// @tparam Maps  ShadowMaps, or other maps that there is a light_visibility() for.
template <typename Maps = ShadowMaps>
struct Frame {
    const SceneAssets& assets;
    Filter filter;
    vec3 eye_world;
    const Maps& shadow_maps;
    Image<vec3>& color;
    DepthBuffer& depth;
};

/// @param options  Those of lesson 11 or a later one.
template <typename Options, typename Maps>
Frame<Maps> make_frame(const Options& options, const SceneAssets& assets, const Camera& camera,
                       const Maps& shadow_maps, Image<vec3>& color, DepthBuffer& depth) {
    return {assets, options.texture.filter, camera.position_world, shadow_maps, color, depth};
}

/// The colors of a triangle's vertices.
///
/// @tparam G  As F in SurfaceInputs.
template <typename G>
struct ColorInputs {
    bool are_there = false;
    std::array<glm::vec<4, G>, 3> of_vertices{};

    /// Exactly the vertices' color where all three agree: barycentric coordinates add up to 1 but
    /// for rounding.
    template <typename F>
    glm::vec<4, F> at(Vec3<F> at) const {
        using Color = glm::vec<4, F>;
        return Color(of_vertices[0]) + at.y * Color(of_vertices[1] - of_vertices[0]) +
               at.z * Color(of_vertices[2] - of_vertices[0]);
    }
};
using VertexColors = ColorInputs<float>;

inline VertexColors vertex_colors(EffectMask effects, const ProjectedTriangle& projected) {
    const std::vector<vec4>& colors = projected.mesh.colors;
    VertexColors result{effects[Effect::vertex_colors] && !colors.empty()};
    for (std::size_t i = 0; result.are_there && i < 3; ++i)
        result.of_vertices[i] = colors[projected.triangle.vertices[i].position];
    return result;
}

/// How opaque a fragment is, 0 to 1: by the material, its texture and the vertices (Eq. 11.7).
///
/// @param in_texture  Of texture_sample().
template <typename F>
F opacity_at(const TriangleSurface& surface, const VertexColors& colors, Vec3<F> at,
             const glm::vec<4, F>& in_texture) {
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
    const EffectMask effects = assets.plan.materials[projected.triangle.material].effects;
    return {triangle_surface(assets.scene, assets.textures, effects, projected),
            perspective_setup(projected), vertex_colors(effects, projected)};
}

/// What a shader has to know of a triangle: the same for all of its pixels.
struct TriangleInputs {
    TriangleSurface surface;
    PerspectiveSetup setup;
    VertexColors colors;
    TriangleNormalMap normal_map;
    ShadowBiasCache shadow_biases;
};

template <typename Maps>
TriangleInputs triangle_inputs(const Permutation& with, const Frame<Maps>& frame,
                               const ProjectedTriangle& projected) {
    const SceneAssets& assets = frame.assets;
    const EffectMask effects = assets.plan.materials[projected.triangle.material].effects;
    TriangleSurface surface = triangle_surface(assets.scene, assets.textures, effects, projected);
    if (with.model == ShadingModel::toon)
        surface.own_color.ambient =
            surface.material.toon->shade;  // toon paint has no ambient colour
    TriangleNormalMap normal_map;
    if (with.normal_map)
        normal_map = triangle_normal_map(assets.scene, assets.normal_maps, projected);
    return {surface, perspective_setup(projected), vertex_colors(effects, projected), normal_map,
            ShadowBiasCache(surface.positions_world)};
}

/// Notes for `--probe` how much of each light counts for a toon material, before shadows.
template <typename F>
void trace_toon_lights(std::span<const Light> lights, const Vec3<F>& position_world,
                       const Vec3<F>& normal, const ToonMaterial& look) {
    if (!is_traced()) return;
    for (std::size_t l = 0; l < lights.size(); ++l) {
        const Incoming<F> incoming = incoming_light(lights[l], position_world);
        const F cosine = glm::dot(unit_or(normal, Vec3<F>(F(0.0f))), incoming.toward);
        trace(("light " + std::to_string(l + 1)).c_str(), incoming.color);
        trace("  cosine", cosine, "Eq. 6.1");
        trace("  step", toon_step(cosine, look), "Eq. 11.4");
    }
}

/// The colour of a fragment: the stages of lessons 05 to 11, without those that the permutation
/// lacks.
///
/// @param inputs      TriangleInputs; or those of several triangles, one in each number of F.
/// @param in_texture  The colour of texture_sample().
template <Permutation with, typename F, typename Maps, typename Inputs>
Vec3<F> shaded(const Frame<Maps>& frame, Inputs& inputs, const PerspectiveBarycentrics<F>& at,
               const Vec3<F>& in_texture) {
    const auto& surface = inputs.surface;
    const std::span<const Light> lights = frame.assets.lit_by.lights;
    FragmentColor<F> own = surface_color(surface, at, in_texture, frame.filter);
    if (inputs.colors.are_there) {  // Eq. 11.10
        count_each<F>(Counter::colored_fragments);
        const Vec3<F> of_vertices(inputs.colors.at(at.here));
        trace("colour of vertices", of_vertices, "Eq. 11.10");
        own.tint(of_vertices);
    }
    if constexpr (with.model == ShadingModel::unlit) {
        return unlit(own);
    } else {
        const Vec3<F> own_normal = interpolate(surface.normals_world, at.here);
        Vec3<F> normal = own_normal;
        if constexpr (with.normal_map)
            normal = normal_mapped(inputs.normal_map, at, own_normal, frame.filter);
        const SurfacePoint<F> point = surface_point(surface, at.here, normal, frame.eye_world);
        const auto visibility = [&](std::size_t l, auto... mask) {
            if constexpr (with.shadow)
                return light_visibility(frame.shadow_maps, l, inputs.shadow_biases,
                                        point.position_world, own_normal, mask...);
            else
                return F(1.0f);
        };
        if constexpr (with.model == ShadingModel::phong) {
            return phong(own, ambient_light,
                         reflected_light(lights, point, highlight_of(surface), visibility));
        } else {
            count_each<F>(Counter::toon_fragments);
            trace_toon_lights(lights, point.position_world, normal, *surface.material.toon);
            const F level = toon_level(lights, point.position_world, normal, *surface.material.toon,
                                       visibility);
            trace("shade", own.ambient);
            trace("lit", own.diffuse);
            trace("level", level, "Eq. 11.5");
            return own.emission + toon_paint(own.ambient, own.diffuse, level);
        }
    }
}

/// Draws what of a triangle lies in a tile.
///
/// @param transparent  Takes the transparent fragments.
template <Permutation with>
void draw_triangle(const Frame<>& frame, const ProjectedTriangle& projected, const Tile& tile,
                   TransparentFragments& transparent) {
    const MaterialPlan& plan = frame.assets.plan.materials[projected.triangle.material];
    TriangleInputs triangle = triangle_inputs(with, frame, projected);
    const bool is_masked = plan[Effect::mask], is_blended = plan[Effect::blend];
    fill_tile(projected.on_screen, tile, [&](ivec2 pixel, Barycentrics on_screen) {
        count(Counter::fragments_tested);
        const float depth = projected.depth.at(on_screen);
        trace_depth(frame.depth.depths()[pixel], depth);
        if (!(depth > frame.depth.depths()[pixel])) return;
        const FragmentBarycentrics at = perspective_correct(triangle.setup, on_screen);
        const vec4 in_texture = texture_sample(triangle.surface, at, frame.filter);
        float opacity = 1;  // of all that is neither glass nor has holes
        if (is_masked || plan.is_transparent)
            opacity = opacity_at(triangle.surface, triangle.colors, at.here, in_texture);
        if (is_masked) {
            count(Counter::alpha_tested_fragments);
            if (!passes_alpha_test(opacity, triangle.surface.material.alpha_cutoff))
                return trace_hole(opacity, triangle.surface.material.alpha_cutoff);
            opacity = 1;
        }
        count(Counter::fragments_shaded);
        const vec3 color = shaded<with>(frame, triangle, at, vec3(in_texture));
        if (is_blended) {  // what lies behind stays visible: no depth is written
            count(Counter::blended_fragments);
            trace_blended(opacity, color);
            transparent.add({pixel, depth, opacity, color});
        } else {
            frame.depth.test_and_write(pixel, depth);
            frame.color[pixel] = color;
        }
    });
}

/// For each material its shader.
class Shaders {
  public:
    using Shader = void (*)(const Frame<>&, const ProjectedTriangle&, const Tile&,
                            TransparentFragments&);

    explicit Shaders(const ScenePlan& plan);

    Shader operator[](std::size_t material) const { return of_material_[material]; }

  private:
    std::vector<Shader> of_material_;
};

}  // namespace rasterbook
