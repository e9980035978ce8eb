// SPDX-License-Identifier: MIT
/// @file
/// Shadow tests of several points at once: the same steps, and bits, as in lesson 09. Introduced in
/// lesson 14; derivation: docs/derivations/14_simd.md.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "09_shadow_maps/shadow_map.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "13_visibility_buffer/shadow_parts.hpp"
#include "14_simd/simd.hpp"
#include "14_simd/wide_casters.hpp"
#include "common/math/functions.hpp"

namespace rasterbook {

/// The biases of several points.
template <int N>
struct WideShadowBias {
    glm::vec<2, Floats<N>> slope;
    Floats<N> bias, bias_per_w;
    Vec3<Floats<N>> offset, offset_times_w;

    void set(Mask<N> lanes, const ShadowBias& of) {
        blend(lanes, slope, of.slope);
        blend(lanes, bias, of.bias);
        blend(lanes, bias_per_w, of.bias_per_w);
        blend(lanes, offset, of.offset);
        blend(lanes, offset_times_w, of.offset_times_w);
    }
};

/// The triangles that several points are on.
template <int N>
struct LaneBiasCaches {
    std::array<ShadowBiasCache*, N + 1> of_slot{};
    Ints<N> slot_of_lane{};

    void set(Mask<N> lanes, ShadowBiasCache& triangle, int slot) {
        of_slot[static_cast<std::size_t>(slot)] = &triangle;
        slot_of_lane = select(lanes, Ints<N>(slot), slot_of_lane);
    }
};

/// Where the taps of several points lie, and the depths that they are compared with.
template <int N>
struct WidePcfKernel {
    Mask<N> is_in_map;
    Ints<N> column, row;  ///< Of the texel in the middle; 0 where it is not in the map.
    Floats<N> depth;
    glm::vec<2, Floats<N>> slope;
};

/// The kernels around several points' positions in a map (Eq. 9.6).
///
/// @param asked  Which points are asked for; the others are not in the map.
template <int N>
WidePcfKernel<N> pcf_kernel(const ShadowMap& map, const WideShadowBias<N>& bias,
                            const Vec3<Floats<N>>& position_world, Mask<N> asked) {
    // TODO: step 3: lesson 09's steps for all points at once, each row of the matrix added up as
    // GLM does it: (x + y) + (z + w). What is not in the map says so in the mask, and is replaced
    // by 0 before it is truncated.
    // Until then, one point after the other:
    WidePcfKernel<N> kernel{first_lanes<Floats<N>>(0), Ints<N>(0), Ints<N>(0), Floats<N>(0.0f),
                            bias.slope};
    const auto of_lane = [](const Vec3<Floats<N>>& v, int i) {
        return vec3(v.x[i], v.y[i], v.z[i]);
    };
    for (int i = 0; i < N; ++i) {
        if (!asked[i]) continue;
        const PcfKernel of_point = pcf_kernel(map,
                                              ShadowBias{{bias.slope.x[i], bias.slope.y[i]},
                                                         bias.bias[i],
                                                         bias.bias_per_w[i],
                                                         of_lane(bias.offset, i),
                                                         of_lane(bias.offset_times_w, i)},
                                              of_lane(position_world, i));
        kernel.is_in_map.lanes[i] = of_point.is_in_map ? -1 : 0;
        kernel.column.set(i, of_point.middle.x), kernel.row.set(i, of_point.middle.y);
        kernel.depth.set(i, of_point.depth);
    }
    return kernel;
}

/// How many taps of each point's kernel say lit. Here it is the taps of a row that are compared at
/// once, since they are neighbours in memory, and those of N points are not.
template <int radius, int N>
Floats<N> lit_taps(const ShadowMap& map, const WidePcfKernel<N>& kernel) {
    // TODO: step 3: point by point, but all taps of a row at once: a vector of 4 or 8 floats holds
    // them. Skip points that are not in the map, and read no texel that is not a tap: another
    // thread may be drawing it. A comparison AND 1 is 1 where it holds: these are added up.
    // Depths at the taps are at least `cleared`: cleared > depth ? cleared : depth.
    // Until then, one point after the other:
    Floats<N> lit(0.0f);
    for (int i = 0; i < N; ++i) {
        if (!kernel.is_in_map[i]) continue;
        const PcfKernel of_point{true, ivec2(kernel.column[i], kernel.row[i]), kernel.depth[i],
                                 vec2(kernel.slope.x[i], kernel.slope.y[i])};
        constexpr int side = 2 * radius + 1;
        lit.set(i, std::round(pcf_visibility<radius>(map, of_point) * (side * side)));
    }
    return lit;
}

/// The visibility of a light at several points: the share of the taps that say lit (Eq. 9.7).
template <int N>
Floats<N> pcf_visibility(const ShadowMap& map, int radius, const WidePcfKernel<N>& kernel) {
    using F = Floats<N>;
    const F lit = radius == 0   ? lit_taps<0>(map, kernel)
                  : radius == 1 ? lit_taps<1>(map, kernel)
                  : radius == 2 ? lit_taps<2>(map, kernel)
                                : lit_taps<3>(map, kernel);
    const auto taps = static_cast<float>((2 * radius + 1) * (2 * radius + 1));
    return select(kernel.is_in_map, lit / F(taps), F(1.0f));
}

/// Draws those parts of a map that the taps of some kernels lie in, unless they are drawn.
template <int N>
void draw_around(const ShadowMapParts& parts, const WidePcfKernel<N>& kernel, int radius) {
    const Ints<N> outside(parts.map().size), before(-1);
    const Mask<N> in_map = kernel.is_in_map;
    if (!any_of(in_map)) return;
    const PixelBox all{ivec2(least_of(select(in_map, kernel.column, outside)),
                             least_of(select(in_map, kernel.row, outside))) -
                           radius,
                       ivec2(greatest_of(select(in_map, kernel.column, before)),
                             greatest_of(select(in_map, kernel.row, before))) +
                           radius};
    bool are_drawn = true;
    parts.tiling().for_each_in(all, [&](std::size_t part) { are_drawn &= parts.is_drawn(part); });
    if (are_drawn) return;
    for (int i = 0; i < N; ++i) {  // in a part of the box there may be no kernel
        const ivec2 middle(kernel.column[i], kernel.row[i]);
        if (in_map[i])
            parts.draw_in({middle - radius, middle + radius},
                          [](auto&... what) { draw_tile<Floats<N>>(what...); });
    }
}

/// In which lanes normals point to the back of a triangle.
template <int N>
Mask<N> is_behind(dvec3 front, const Vec3<Floats<N>>& normal) {
    using Doubles = Vector<double, N>;
    const auto product = [&](int i) {
        return front[i] * __builtin_convertvector(normal[i].lanes, Doubles);
    };
    return {
        __builtin_convertvector(product(0) + product(1) + product(2) < 0, Vector<std::int32_t, N>)};
}

/// Notes for `--probe` how much of a light reaches one of several points.
template <int N>
void trace_lane(const ShadowMapsOnDemand& on_demand, std::size_t l,
                const LaneBiasCaches<N>& triangles, const Vec3<Floats<N>>& position,
                const Vec3<Floats<N>>& normal) {
    if (!is_traced()) return;
    const int slot = triangles.slot_of_lane[pixel_trace->lane];
    light_visibility(on_demand, l, *triangles.of_slot[static_cast<std::size_t>(slot)],
                     traced_lane(position), traced_lane(normal));
}

/// How much of a light reaches several points, 0 to 1 each. All points that are in one map are
/// asked for together; mostly that is all of them.
///
/// @param asked  For which points; of the others, no map is asked.
template <int N>
Floats<N> light_visibility(const ShadowMapsOnDemand& on_demand, std::size_t l,
                           const LaneBiasCaches<N>& triangles, const Vec3<Floats<N>>& position,
                           const Vec3<Floats<N>>& normal, Mask<N> asked) {
    using F = Floats<N>;
    trace_lane(on_demand, l, triangles, position, normal);
    const ShadowMaps& shadow_maps = on_demand.maps();
    const LightShadowMaps& of_light = shadow_maps.of_light[l];
    if (of_light.maps.empty()) return F(1.0f);
    const Vec3<F> from_light = position - Vec3<F>(of_light.light.position_world);
    const Vec3<F> toward_light = of_light.light.kind == LightKind::directional
                                     ? Vec3<F>(of_light.light.direction_world)
                                     : unit_or(-from_light, Vec3<F>(vec3(0, 1, 0)));
    const F cosine = glm::dot(unit_or(normal, Vec3<F>(F(0.0f))), toward_light);
    const Mask<N> faces_light = cosine > F(0.0f);
    F visibility =
        select(faces_light, of_light.is_drawn ? min(cosine / F(full_cosine), F(1.0f)) : F(1.0f),
               F(of_light.is_drawn ? 0.0f : 1.0f));

    Ints<N> map_of_lane(static_cast<int>(of_light.map_of_view[0]));
    for (int i = 0; of_light.has_faces && i < N; ++i)
        map_of_lane.set(i, static_cast<int>(of_light.map_of_view[cube_face(
                               vec3(from_light.x[i], from_light.y[i], from_light.z[i]))]));
    Mask<N> left =
        asked & faces_light & !(map_of_lane == Ints<N>(static_cast<int>(LightShadowMaps::no_map)));
    count(Counter::shadow_tests, static_cast<std::uint64_t>(count_of(
                                     left & first_lanes<F>(static_cast<int>(fragments_at_once)))));
    while (any_of(left)) {
        const int map_number = map_of_lane[first_of(left)];
        const auto i = static_cast<std::size_t>(map_number);
        const Mask<N> together = left & (map_of_lane == Ints<N>(map_number));
        left = left & !together;
        const ShadowMap& map = of_light.maps[i];
        WideShadowBias<N> biases{};  // no bias where no point is asked for
        for (Mask<N> rest = together; any_of(rest);) {
            const int slot = triangles.slot_of_lane[first_of(rest)];
            const Mask<N> own = rest & (triangles.slot_of_lane == Ints<N>(slot));
            rest = rest & !own;
            ShadowBiasCache& triangle = *triangles.of_slot[static_cast<std::size_t>(slot)];
            const Mask<N> behind = is_behind(triangle.front(), normal);
            for (const bool is_back : {false, true}) {
                const Mask<N> on_side = own & (is_back ? behind : !behind);
                if (!any_of(on_side)) continue;
                biases.set(on_side, triangle.bias_in(map, of_light.first_map + i, shadow_maps.bias,
                                                     shadow_maps.radius, is_back));
            }
        }
        const WidePcfKernel<N> kernel = pcf_kernel(map, biases, position, together);
        draw_around(on_demand.parts()[of_light.first_map + i], kernel, shadow_maps.radius);
        visibility = select(together, visibility * pcf_visibility(map, shadow_maps.radius, kernel),
                            visibility);
    }
    return visibility;
}

}  // namespace rasterbook
