// SPDX-License-Identifier: MIT
/// @file
/// Lesson 12's shader as a function, for several ways to go through the pixels.
#pragma once

#include <cstddef>
#include <span>

#include "05_textures/interpolation.hpp"
#include "06_phong/studio_lights.hpp"
#include "07_toon/toon_material.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "11_scenes/opacity.hpp"
#include "12_effects/permutation.hpp"
#include "12_effects/planned_scene.hpp"

namespace rasterbook {

/// What a picture is drawn with, and into.
///
/// @tparam Maps  ShadowMaps, or other maps that there is a light_visibility() for.
template <typename Maps = ShadowMaps>
struct Frame {
    const PlannedScene& assets;
    Filter filter;
    vec3 eye_world;
    const Maps& shadow_maps;
    Image<vec3>& color;
    DepthBuffer& depth;
};

/// @param options  Those of lesson 12 or a later one.
template <typename Options, typename Maps>
Frame<Maps> make_frame(const Options& options, const PlannedScene& assets, const Camera& camera,
                       const Maps& shadow_maps, Image<vec3>& color, DepthBuffer& depth) {
    return {assets, options.texture.filter, camera.position_world, shadow_maps, color, depth};
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
    const TriangleSurface surface = triangle_surface(assets, projected);
    TriangleNormalMap normal_map;
    if (with.normal_map)
        normal_map = triangle_normal_map(assets.scene, assets.normal_maps, projected);
    return {surface, perspective_setup(projected), vertex_colors(projected), normal_map,
            ShadowBiasCache(surface.positions_world)};
}

/// The colour of a fragment: the stages of lessons 05 to 12, without those that the permutation
/// lacks.
///
/// @param inputs      TriangleInputs; or those of several triangles, one in each number of F.
/// @param in_texture  The colour of texture_sample().
template <Permutation with, typename F, typename Maps, typename Inputs>
Vec3<F> shaded(const Frame<Maps>& frame, Inputs& inputs, const PerspectiveBarycentrics<F>& at,
               const Vec3<F>& in_texture) {
    const auto& surface = inputs.surface;
    const std::span<const Light> lights = frame.assets.lit_by.lights;
    const FragmentColor<F> own =
        surface_color(surface, inputs.colors, at, in_texture, frame.filter);
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
            return toon_color(own, lights, point.position_world, normal, *surface.material.toon,
                              visibility);
        }
    }
}

}  // namespace rasterbook
