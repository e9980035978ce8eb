// SPDX-License-Identifier: MIT
/// @file
/// Shadow tests of several points at once: the same steps, and bits, as in lesson 09. Introduced in
/// lesson 14; derivation: docs/derivations/14_simd.md.
#pragma once

#include <array>
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
    using F = Floats<N>;
    const mat4& m = map.texels_from_world;
    const auto row_times = [&](int row, const Vec3<F>& p) {  // added up as by GLM
        return (F(m[0][row]) * p.x + F(m[1][row]) * p.y) + (F(m[2][row]) * p.z + F(m[3][row]));
    };
    F w(1.0f), inv_w(1.0f);
    if (map.is_perspective) w = row_times(3, position_world);
    const Vec3<F> moved = position_world + bias.offset + w * bias.offset_times_w;
    Mask<N> is_in_map = asked;
    if (map.is_perspective) {
        const F moved_w = row_times(3, moved);
        is_in_map = is_in_map & (moved_w > F(0.0f));
        inv_w = F(1.0f) / moved_w;
    }
    const Vec3<F> place =
        Vec3<F>(row_times(0, moved), row_times(1, moved), row_times(2, moved)) * inv_w;
    const F first(0.0f), end(static_cast<float>(map.size));
    is_in_map =
        is_in_map & (place.x >= first) & (place.y >= first) & (place.x < end) & (place.y < end);
    const Ints<N> column = truncated(select(is_in_map, place.x, first));
    const Ints<N> row = truncated(select(is_in_map, place.y, first));
    const F depth = place.z + (bias.bias + bias.bias_per_w * inv_w) +
                    bias.slope.x * (to_floats(column) + F(0.5f) - place.x) +
                    bias.slope.y * (to_floats(row) + F(0.5f) - place.y);
    return {is_in_map, column, row, depth, bias.slope};
}

/// How many taps of each point's kernel say lit. Here it is the taps of a row that are compared at
/// once, since they are neighbours in memory, and those of N points are not.
template <int radius, int N>
Floats<N> lit_taps(const ShadowMap& map, const WidePcfKernel<N>& kernel) {
    constexpr int side = 2 * radius + 1, taps = side <= 4 ? 4 : 8;
    using Row = Vector<float, taps>;
    using Counts = Vector<std::int32_t, taps>;
    const Image<float>& depths = map.depths.depths();
    Row from_middle{};
    Counts counted{};
    for (int x = 0; x < side; ++x) from_middle[x] = static_cast<float>(x - radius), counted[x] = 1;
    Ints<N> lit(0);
    for (int i = 0; i < N; ++i) {
        if (!kernel.is_in_map[i]) continue;  // texel (0, 0) may be another thread's just now
        const ivec2 first = ivec2(kernel.column[i], kernel.row[i]) + (max_pcf_radius - radius);
        const Row across = kernel.slope.x[i] * from_middle;
        Counts in_column{};
        for (int y = 0; y < side; ++y) {
            const float in_row =
                kernel.depth[i] + kernel.slope.y[i] * static_cast<float>(y - radius);
            const Row at_taps = in_row + across;
            const Row cleared = Row{} + DepthBuffer::cleared;
            const Row at_texels = cleared > at_taps ? cleared : at_taps;
            const float* const from = &depths[first + ivec2(0, y)];
            Row texels{};
            for (int x = 0; x < side; ++x) texels[x] = from[x];
            in_column += (at_texels >= texels) & counted;
        }
        int sum = 0;
        for (int x = 0; x < taps; ++x) sum += in_column[x];
        lit.set(i, sum);
    }
    return to_floats(lit);
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
