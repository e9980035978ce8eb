// SPDX-License-Identifier: MIT
/// @file
/// What a light sees first, and whether a point lies behind it. Introduced in lesson 09;
/// derivation: docs/derivations/09_shadow_maps.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <glm/matrix.hpp>

#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/clip.hpp"
#include "04_mvp/projection.hpp"
#include "04_mvp/transform.hpp"
#include "common/app/counters.hpp"
#include "common/math/numerics.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// The PCF kernel of a shadow test has up to 2 * 3 + 1 taps a side.
constexpr int max_pcf_radius = 3;

/// By how much snap_triangle may move a vertex, in texels: half a step.
constexpr double snapping = 0.5 / subpixels;

/// Roundings on the way from a vertex to a map's depth and to a fragment's: at most 64 of 2^-24,
/// relative to the sizes of what is added up (Eq. 9.15).
constexpr double rounding = 64 * 0x1p-24;

/// Depths between 0 and 1 have 24 binary digits or more; the barycentric coordinates and the
/// depth's sum are rounded a few times.
constexpr double depth_quanta = 8 * 0x1p-24;

/// The depth of what a light sees first, for each texel; 0 where it sees nothing.
struct ShadowMap {
    int size;                ///< Texels a side.
    mat4 clip_from_world;    ///< As light_view.hpp makes it.
    mat4 texels_from_world;  ///< x right, y down in texels, depth 0 to 1, all times w (Eq. 9.6).
    dmat4 plane_from_world;  ///< Of texels_from_world, as it is in float (Eq. 9.8).
    bool is_perspective;     ///< Else w is 1.
    double rounding_texels;  ///< By how much a position may be off, times w (Eq. 9.15).
    double rounding_depth;   ///< By how much a depth may be off, times w.
    double slope_in_middle;  ///< |dz/dx| + |dz/dy| of a surface tilted by arctan 2.
    DepthBuffer depths;      ///< With max_pcf_radius texels around it, in which nothing is seen.

    /// @param reach  World space: a box around all casters and receivers.
    ShadowMap(const mat4& clip, bool perspective, int texels, const Bounds& reach)
        : ShadowMap(clip, perspective, texels, reach,
                    DepthBuffer(ivec2(texels + 2 * max_pcf_radius))) {}

    /// @param memory  Becomes `depths`: of texels + 2 max_pcf_radius a side.
    ShadowMap(const mat4& clip, bool perspective, int texels, const Bounds& reach,
              DepthBuffer memory)
        : size(texels),
          clip_from_world(clip),
          texels_from_world(1),  // TODO: step 1: Eq. 9.6, viewport<double>() times clip
          plane_from_world(1),   // TODO: step 2: (T^-1)^T of Eq. 9.8, in double
          is_perspective(perspective),
          depths(std::move(memory)) {
        [[maybe_unused]] const dvec4 farthest(
            glm::max(glm::abs(dvec3(reach.min)), glm::abs(dvec3(reach.max))), 1);
        const dmat4 rows = glm::transpose(dmat4(texels_from_world));
        // TODO: step 5: Eq. 9.15, in Robust, "How much is rounded". A_x, A_y, A_z and A_w are the
        // dot products of |rows[0]| to |rows[3]| and `farthest`.
        //     rounding_texels = rounding * (max(A_x, A_y) + size * A_w)
        //     rounding_depth = rounding * (A_z + A_w)
        rounding_texels = 0;
        rounding_depth = 0;
        slope_in_middle = slope_at(reach.center(), rows);
    }

  private:
    /// |dz/dx| + |dz/dy| of a surface tilted to the right by arctan 2, on the map's axis and as far
    /// from the light as a point.
    double slope_at(dvec3 point, const dmat4& rows) const {
        const dmat4 world_from_texels = glm::inverse(dmat4(texels_from_world));
        const double half = 0.5 * size;
        const dvec3 into = glm::normalize(dvec3(is_perspective ? rows[3] : rows[2]));
        dvec3 place(world_from_texels * dvec4(half, half, 0.5, 1));
        if (is_perspective) {
            const dvec3 eye = dvec3(world_from_texels[2]) / world_from_texels[2].w;  // x y w = 0
            place = eye + glm::distance(point, eye) * into;
        }
        const dvec3 right = glm::normalize(dvec3(rows[0]) - half * dvec3(rows[3]));
        const dvec3 normal = 2.0 * right - into;
        const dvec4 plane = plane_from_world * dvec4(normal, -glm::dot(normal, place));  // Eq. 9.8
        const double slope = (std::abs(plane.x) + std::abs(plane.y)) / std::abs(plane.z);
        return slope <= 1 ? slope : 1;
    }
};

/// Draws the depth of a mesh as the light sees it, front and back faces.
///
/// Each texel of the map's own that a triangle covers counts as a Counter::shadow_fragments,
/// written or not; nothing else is counted.
///
/// @param casts  Called as casts(material), an index into Scene::materials: whether triangles of it
///               cast shadows.
template <typename Casts>
void draw_casters(ShadowMap& map, const Mesh& mesh, Casts&& casts) {
    if (is_outside_frustum(mesh.bounds, map.clip_from_world)) return;
    // TODO: step 1: as for_each_visible_triangle() of lesson 04, with transform(), clip_triangle()
    // and project(), then fill_triangle() and test_and_write(). But only what casts is drawn, front
    // and back faces alike, and only depths, in a picture of map.size x map.size. Its texel (0, 0)
    // is (max_pcf_radius, max_pcf_radius) of map.depths. Count Counter::shadow_fragments.
}

/// What keeps a lit surface from shadowing itself.
enum class Bias { none, constant, slope, plane, normal };

/// What a shadow test adds to a point of a triangle, or moves it by. A table in Robust, "Five
/// biases and what they return", says which Bias sets which field.
struct ShadowBias {
    vec2 slope{0};           ///< Change of depth to the right and to the lower texel (Eq. 9.11).
    float bias = 0;          ///< Added to the point's depth (Eq. 9.9 to 9.11); leaks: Eq. 9.14.
    float bias_per_w = 0;    ///< To be divided by the moved point's w, and added to the bias.
    vec3 offset{0};          ///< World space: moves the point (Eq. 9.12).
    vec3 offset_times_w{0};  ///< To be multiplied by w of the point not yet moved, and added.
};

/// No depth in a map is greater: with this bias, all points are lit.
constexpr ShadowBias always_lit{.bias = 2};

/// The sum of a plane's slopes beyond which its depth passes through all of the map within a texel.
/// The light sees such a surface edge-on, and gives it hardly anything: it is called lit.
/// normal_offset_bias() needs no such limit.
constexpr double max_slope = 1;

/// The plane of a triangle on which shadows fall, as a map sees it.
struct ReceiverPlane {
    dvec3 normal;  ///< World space, unit length, to the side that is seen.
    dvec4 plane;   ///< In the map's texels and depths (Eq. 9.8).

    double across() const { return std::abs(plane.x) + std::abs(plane.y); }
    double along() const { return std::abs(plane.z); }

    /// The sum of the slopes; not a number in a triangle of no area.
    double slope() const { return across() / along(); }
};

/// @param vertices  World space.
/// @param outward   Any vector to that side of the triangle which is seen.
/// @return          None of a triangle of no area, edge-on, not finite, or turned away from the
///                  light.
inline std::optional<ReceiverPlane> receiver_plane(const ShadowMap& map,
                                                   const std::array<vec3, 3>& vertices,
                                                   dvec3 outward) {
    // TODO: step 2: the normal by normalize_or() of the cross product of two sides, in double; 0 if
    // the triangle has no area. The plane as the map sees it, Eq. 9.8; if dot(normal, outward) < 0,
    // change the signs of both. None unless plane.z > 0: depth is greater towards the light.
    return {};
}

/// How far the farthest tap's centre is from the point, in texels (Eq. 9.9).
///
/// @param radius  Of the PCF kernel: 0 to max_pcf_radius.
constexpr double reach_texels(int radius) {
    // TODO: step 2: Eq. 9.9
    return 0;
}

/// What a surface that is tilted by arctan 2 takes, whatever the triangle.
inline ShadowBias constant_bias(const ShadowMap& map, int radius) {
    return {.bias = static_cast<float>(reach_texels(radius) * map.slope_in_middle)};
}

/// As much as a plane's depth changes within some texels, and roundings.
///
/// @param slope  Of the plane, at most max_slope.
inline ShadowBias bias_within(const ShadowMap& map, double texels, double slope) {
    // TODO: step 2: texels times slope (Eq. 9.9), and depth_quanta. Step 5, derived in Robust from
    // "The last two per cent of the bias" on:
    //     bias = (texels + snapping) slope + depth_quanta
    //     bias_per_w = map.rounding_texels slope + map.rounding_depth
    return {};
}

/// As much as the plane's depth changes within the kernel (Eq. 9.10).
inline ShadowBias slope_scaled_bias(const ShadowMap& map, int radius, const ReceiverPlane& plane) {
    // TODO: step 2: always_lit unless slope() <= max_slope. (Ask it this way round: a comparison
    // with NaN is false.) Else bias_within() the reach.
    return {};
}

/// Each tap is compared with the plane's depth there: only roundings are left to add (Eq. 9.11).
inline ShadowBias receiver_plane_bias(const ShadowMap& map, const ReceiverPlane& plane) {
    // TODO: step 2: always_lit unless slope() <= max_slope. Else bias_within() 0 texels, and z_x
    // and z_y in `slope`.
    return {};
}

/// Moves the point off the surface, until its depth suffices (Eq. 9.12). Where that is nowhere, the
/// triangle's plane contains the light.
inline ShadowBias normal_offset_bias(const ShadowMap& map, int radius, const ReceiverPlane& plane) {
    // TODO: step 5: Eq. 9.12, derived in Robust, "Off the surface". With `row` the first three
    // numbers of the last row of map.texels_from_world:
    //     K = (reach_texels + snapping) across + depth_quanta along
    //     E = map.rounding_texels across + map.rounding_depth along
    //     g = dot(normal, row)
    //     offset_times_w = K / (1 - K g) normal,  offset = E / (1 - K g) normal
    // always_lit unless K g < 1.
    return {};
}

/// Fits the bias to a triangle.
///
/// With Bias::slope, plane and normal, a lit plane nowhere shadows itself. Triangles without a
/// receiver_plane() are lit: they get no light anyway, or next to none where their interpolated
/// normals still face the light.
///
/// @param radius    Of the PCF kernel: 0 to max_pcf_radius.
/// @param vertices  World space.
/// @param outward   Any vector to that side of the triangle which is seen.
inline ShadowBias shadow_bias(const ShadowMap& map, Bias bias, int radius,
                              const std::array<vec3, 3>& vertices, dvec3 outward) {
    if (bias == Bias::none) return {};
    if (bias == Bias::constant) return constant_bias(map, radius);
    const std::optional<ReceiverPlane> plane = receiver_plane(map, vertices, outward);
    if (!plane) return always_lit;
    if (bias == Bias::slope) return slope_scaled_bias(map, radius, *plane);
    if (bias == Bias::plane) return receiver_plane_bias(map, *plane);
    return normal_offset_bias(map, radius, *plane);
}

/// Where the taps of a shadow test lie, and the depth that they are compared with.
struct PcfKernel {
    bool is_in_map = false;  ///< Else the point is lit.
    ivec2 middle{0};         ///< The texel in which the point lies.
    float depth = 0;         ///< Compared with the middle texel: the surface's, plus the bias.
    vec2 slope{0};           ///< As in ShadowBias.
};

/// The kernel around a point's position in the map (Eq. 9.6).
///
/// @param position_world  Outside of the map, behind the light (after it is moved) or not a number:
///                        not in the map.
inline PcfKernel pcf_kernel(const ShadowMap& map, const ShadowBias& bias, vec3 position_world) {
    // TODO: step 1: find the point's position in the map (Eq. 9.6). It is in the map if x >= 0,
    // y >= 0, x < R and y < R; in a perspective only if w > 0, too: ask that before anything is
    // divided. `depth` is z plus bias.bias.
    //
    // Step 5: first move the point by offset + w offset_times_w (Eq. 9.12), where w is that of the
    // point not yet moved, 1 for a directional light. All else is of the moved point. Add bias +
    // bias_per_w / w to its depth (Eq. 9.10), slope.x times the way from the point to the
    // centre of its texel, in texels to the right, and slope.y times that down (Eq. 9.11).
    return {};
}

/// The visibility of a light at a point: the share of the kernel's taps that say lit, 0 to 1
/// (Eq. 9.7 and 9.13).
///
/// @tparam radius  0 to max_pcf_radius: 1, 9, 25 or 49 taps.
template <int radius>
float pcf_visibility(const ShadowMap& map, const PcfKernel& kernel) {
    static_assert(radius >= 0 && radius <= max_pcf_radius);
    // TODO: step 1: the test of Eq. 9.7 for the texel in the middle. Texel (i, j) is
    //     map.depths.depths()[{i + max_pcf_radius, j + max_pcf_radius}].
    // Return 1, lit, where the kernel is not in the map.
    //
    // Step 3: Eq. 9.7 for each tap of the kernel, which may reach into the border, and Eq. 9.13.
    //
    // Step 5: the depth changes by kernel.slope from tap to tap (Eq. 9.11); then comes the maximum.
    return 1;
}

/// The visibility of a light at a point (Eq. 9.13).
template <int radius>
float pcf_visibility(const ShadowMap& map, const ShadowBias& bias, vec3 position_world) {
    return pcf_visibility<radius>(map, pcf_kernel(map, bias, position_world));
}

/// The visibility of a light, by a radius that is known only when the program runs.
inline float pcf_visibility(const ShadowMap& map, int radius, const PcfKernel& kernel) {
    switch (radius) {
        case 0:
            return pcf_visibility<0>(map, kernel);
        case 1:
            return pcf_visibility<1>(map, kernel);
        case 2:
            return pcf_visibility<2>(map, kernel);
        default:
            return pcf_visibility<3>(map, kernel);
    }
}

}  // namespace rasterbook
