// SPDX-License-Identifier: MIT
/// @file
/// Texture sampling and shadow tests of several pixels at once. Introduced in lesson 13;
/// derivation: docs/derivations/13_simd.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>

#include "05_textures/texture.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "12_visibility_buffer/shadow_parts.hpp"
#include "13_simd/wide_raster.hpp"
#include "13_simd/simd.hpp"

namespace rasterbook {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

template <typename F>
using Vec2 = glm::vec<2, F>;
template <typename F>
using Vec4 = glm::vec<4, F>;

/// As wrapped() of one coordinate.
template <int N>
Floats<N> wrapped(Floats<N> coordinate, Wrap wrap) {
    using F = Floats<N>;
    const F zero(0.0f), one(1.0f);
    if (wrap == Wrap::repeat) return max(coordinate - floor(coordinate), zero);
    if (wrap == Wrap::clamp) return clamp(coordinate, zero, one);
    const F there_and_back = coordinate - F(2.0f) * floor(F(0.5f) * coordinate);
    const F back = F(2.0f) - there_and_back;
    return max(select(back < there_and_back, back, there_and_back), zero);
}

/// As texture_position().
template <int N>
Vec2<Floats<N>> texture_position(Vec2<Floats<N>> uv, Wrap wrap) {
    return {wrapped(uv.x, wrap), Floats<N>(1.0f) - wrapped(uv.y, wrap)};
}

/// The mean of the four texels around a position in a level of its own for each pixel: as
/// sample_bilinear().
///
/// @param level  Of each pixel.
/// @param position  0 to 1.
template <int N>
Vec4<Floats<N>> sample_bilinear(const Texture& texture, Ints<N> level,
                                const Vec2<Floats<N>>& position) {
    using F = Floats<N>;
    using Four = Vector<float, 4>;
    F width, height;
    for (int i = 0; i < N; ++i) {
        const ivec2 size = texture.levels[static_cast<std::size_t>(level[i])].size;
        width.set(i, static_cast<float>(size.x)), height.set(i, static_cast<float>(size.y));
    }
    const F x = position.x * width + F(0.5f), y = position.y * height + F(0.5f);
    const Ints<N> column = min(truncated(x), truncated(width));
    const Ints<N> row = min(truncated(y), truncated(height));
    const F share_x = x - to_floats(column), share_y = y - to_floats(row);
    std::array<std::array<float, N>, 4> channels;
    for (int i = 0; i < N; ++i) {
        const Image<vec4>& texels = texture.levels[static_cast<std::size_t>(level[i])].texels;
        const vec4* const upper = &texels[{column[i], row[i]}];
        const vec4* const lower = upper + texels.size().x;
        const auto at = [](const vec4* texel) {
            Four channels_of;
            std::memcpy(&channels_of, texel, sizeof channels_of);
            return channels_of;
        };
        const Four in_upper = at(upper) + share_x[i] * (at(upper + 1) - at(upper));
        const Four in_lower = at(lower) + share_x[i] * (at(lower + 1) - at(lower));
        const Four mean = in_upper + share_y[i] * (in_lower - in_upper);
        for (std::size_t c = 0; c < 4; ++c)
            channels[c][static_cast<std::size_t>(i)] = mean[static_cast<int>(c)];
    }
    Vec4<F> color;
    for (int c = 0; c < 4; ++c)
        std::memcpy(&color[c], &channels[static_cast<std::size_t>(c)], sizeof(F));
    return color;
}

/// As level_of_detail().
template <int N>
Floats<N> level_of_detail(const Vec2<Floats<N>>& ddx, const Vec2<Floats<N>>& ddy, ivec2 size) {
    using F = Floats<N>;
    const Vec2<F> texels{vec2(size)};
    const Vec2<F> across = ddx * texels, down = ddy * texels;
    const F across_squared = glm::dot(across, across), down_squared = glm::dot(down, down);
    const F sum = across_squared + down_squared;
    const F longer_squared =
        select(across_squared < down_squared, down_squared, across_squared);
    const Mask<N> is_longer = (longer_squared > F(1.0f)) & (sum == sum);
    return select(is_longer, F(0.5f) * log2(longer_squared), F(0.0f));
}

/// As sample().
template <int N>
Vec4<Floats<N>> sample(const Texture& texture, Filter filter,
                       const TextureCoordinates<Floats<N>>& uv) {
    using F = Floats<N>;
    const Vec2<F> position = texture_position<N>(uv.here, texture.wrap);
    if (filter == Filter::nearest) {
        Vec4<F> color;
        for (int i = 0; i < N; ++i) {
            const vec4 texel =
                sample_nearest(texture.levels[0], {position.x[i], position.y[i]});
            for (int c = 0; c < 4; ++c) color[c].set(i, texel[c]);
        }
        return color;
    }
    if (filter == Filter::bilinear) return sample_bilinear<N>(texture, Ints<N>(0), position);
    const F last(static_cast<float>(texture.levels.size() - 1));
    const F found = level_of_detail<N>(uv.ddx, uv.ddy, texture.levels[0].size);
    const F level = select(last < found, last, found);
    const Ints<N> finer = truncated(level);
    const Vec4<F> in_finer = sample_bilinear<N>(texture, finer, position);
    const F share = level - to_floats(finer);
    const Mask<N> is_between = share > F(0.0f);
    if (!any_of(is_between)) return in_finer;
    const Ints<N> coarser = select(is_between, finer + Ints<N>(1), finer);
    const Vec4<F> in_coarser = sample_bilinear<N>(texture, coarser, position);
    // where share is 0, both are the same texels' mean, and so is their own
    return in_finer + share * (in_coarser - in_finer);
}

/// As PcfKernel, of several points of one triangle.
template <int N>
struct WidePcfKernel {
    Mask<N> is_in_map;
    Ints<N> column, row;
    Floats<N> depth;
    vec2 slope;
};

/// As pcf_kernel().
///
/// @param of  Which points are asked for.
template <int N>
WidePcfKernel<N> pcf_kernel(const ShadowMap& map, const Receiver& receiver,
                            const Vec3<Floats<N>>& position_world, Mask<N> of) {
    using F = Floats<N>;
    using Matrix = glm::mat<4, 4, float>;
    const Matrix& m = map.texels_from_world;
    const auto row_times = [&](int row, const Vec3<F>& p) {  // as GLM adds
        return (F(m[0][row]) * p.x + F(m[1][row]) * p.y) + (F(m[2][row]) * p.z + F(m[3][row]));
    };
    F w(1.0f), per_w(1.0f);
    if (map.is_perspective) w = row_times(3, position_world);
    const Vec3<F> moved =
        position_world + Vec3<F>(receiver.offset) + w * Vec3<F>(receiver.offset_times_w);
    Vec3<F> place(row_times(0, moved), row_times(1, moved), row_times(2, moved));
    Mask<N> is_in_map = of;
    if (map.is_perspective) {
        const F w_moved = row_times(3, moved);
        is_in_map = is_in_map & (w_moved > F(0.0f));
        per_w = F(1.0f) / w_moved;
        place = place * per_w;
    }
    const F zero(0.0f), end(static_cast<float>(map.size));
    is_in_map = is_in_map & (place.x >= zero) & (place.y >= zero) & (place.x < end) &
                (place.y < end);
    const Ints<N> column = truncated(select(is_in_map, place.x, zero));
    const Ints<N> row = truncated(select(is_in_map, place.y, zero));
    const F depth = place.z - (F(receiver.bias) + F(receiver.bias_per_w) * per_w) +
                    F(receiver.slope.x) * (to_floats(column) + F(0.5f) - place.x) +
                    F(receiver.slope.y) * (to_floats(row) + F(0.5f) - place.y);
    return {is_in_map, column, row, depth, receiver.slope};
}

/// How many taps of each pixel's kernel say lit, `taps` of a row at a time.
template <int taps, int N>
Floats<N> lit_taps(const ShadowMap& map, int radius, const WidePcfKernel<N>& kernel) {
    using Row = Vector<float, taps>;
    using Bits = Vector<std::int32_t, taps>;
    const Image<float>& depths = map.depths.depths();
    const int stride = depths.size().x, side = 2 * radius + 1;
    const Ints<N> first = (kernel.row + Ints<N>(max_pcf_radius - radius)) * Ints<N>(stride) +
                          (kernel.column + Ints<N>(max_pcf_radius - radius));
    Row across{};
    Bits counts{};
    for (int x = 0; x < side; ++x)
        across[x] = kernel.slope.x * static_cast<float>(x - radius), counts[x] = 1;
    const float* const from = depths.pixels().data();
    Vector<std::int32_t, N> lit;
    for (int i = 0; i < N; ++i) {
        const float* texels = from + first[i];
        Bits found{};
        for (int y = -radius; y <= radius; ++y, texels += stride) {
            const Row at_taps = (kernel.depth[i] + kernel.slope.y * static_cast<float>(y)) + across;
            const Row at_texels = DepthBuffer::cleared < at_taps ? Row{} + DepthBuffer::cleared : at_taps;
            Row seen;
            std::memcpy(&seen, texels, sizeof seen);
            found += (at_texels <= seen) & counts;
        }
        int sum = 0;
        for (int x = 0; x < taps; ++x) sum += found[x];
        lit[i] = sum;
    }
    return to_floats(Ints<N>(lit));
}

/// As pcf_visibility().
template <int N>
Floats<N> pcf_visibility(const ShadowMap& map, int radius, const WidePcfKernel<N>& kernel) {
    using F = Floats<N>;
    const F lit = radius == 1 ? lit_taps<4, N>(map, 1, kernel) : lit_taps<8, N>(map, radius, kernel);
    const int side = 2 * radius + 1;
    return select(kernel.is_in_map, lit / F(static_cast<float>(side * side)), F(1.0f));
}

/// Counts for each pixel what is counted for all at once.
template <typename CounterPolicy>
struct LaneCounters {
    CounterPolicy& counters;
    int pixels;

    void add(Counter counter) {
        for (int i = 0; i < pixels; ++i) counters.add(counter);
    }
};

/// How much of a light reaches several points of a triangle.
template <int N, typename CounterPolicy>
Floats<N> light_visibility(const ShadowMapsOnDemand& on_demand, std::size_t l,
                           TriangleReceiver& triangle, const Vec3<Floats<N>>& position,
                           const Vec3<Floats<N>>& normal,
                           LaneCounters<CounterPolicy>& counters) {
    using F = Floats<N>;
    const ShadowMaps& shadow_maps = on_demand.maps();
    const LightShadowMaps& of_light = shadow_maps.of_light[l];
    if (of_light.maps.empty()) return F(1.0f);
    const int radius = shadow_maps.radius;
    const Vec3<F> from_light = position - Vec3<F>(of_light.light.position_world);
    const Vec3<F> toward_light = of_light.light.kind == LightKind::directional
                                     ? Vec3<F>(of_light.light.direction_world)
                                     : unit_or(-from_light, Vec3<F>(vec3(0, 1, 0)));
    const F cosine = glm::dot(unit_or(normal, Vec3<F>(F(0.0f))), toward_light);
    const Mask<N> faces_light = cosine > F(0.0f);
    const F unlit(of_light.is_drawn ? 0.0f : 1.0f);
    if (!any_of(faces_light)) return unlit;
    const F faded =
        of_light.is_drawn ? min(cosine / F(full_cosine), F(1.0f)) : F(1.0f);
    F visibility(1.0f);
    if (!of_light.has_faces) {
        const std::size_t m = of_light.map_of_view[0];
        if (m == LightShadowMaps::no_map) return select(faces_light, faded, unlit);
        count_lanes(counters.counters, Counter::shadow_tests, faces_light & first_lanes<N>(counters.pixels));
        const auto doubles = [](const F& x) { return __builtin_convertvector(x.lanes, Vector<double, N>); };
        const auto toward = triangle.front.x * doubles(normal.x) + triangle.front.y * doubles(normal.y) + triangle.front.z * doubles(normal.z);
        const Mask<N> is_back = F(__builtin_convertvector(toward, Vector<float, N>)) < F(0.0f);
        const ShadowMap& map = of_light.maps[m];
        for (const bool back : {false, true}) {
            const Mask<N> same = faces_light & (back ? is_back : !is_back);
            if (!any_of(same)) continue;
            std::optional<Receiver>& bias = triangle.biases[of_light.first_map + m][back];
            if (!bias)
                bias = receiver(map, shadow_maps.bias, radius, triangle.vertices,
                                back ? -triangle.front : triangle.front);
            const WidePcfKernel<N> kernel = pcf_kernel<N>(map, *bias, position, same);
            const ShadowMapParts& parts = on_demand.parts()[of_light.first_map + m];
            parts.draw_around_all(kernel.is_in_map, kernel.column, kernel.row, radius, counters.counters);
            visibility = select(same, pcf_visibility<N>(map, radius, kernel), visibility);
        }
        return select(faces_light, faded * visibility, unlit);
    }
    // Each map's pixels, each side's: almost always there is one of each.
    std::array<std::size_t, N> map_of;
    std::array<bool, N> is_back;
    for (int i = 0; i < N; ++i) {
        const auto lane = static_cast<std::size_t>(i);
        map_of[lane] = of_light.map_of_view[of_light.has_faces
                                                ? cube_face({from_light.x[i], from_light.y[i],
                                                             from_light.z[i]})
                                                : 0];
        is_back[lane] = glm::dot(triangle.front,
                                 dvec3(normal.x[i], normal.y[i], normal.z[i])) < 0;
        if (!faces_light[i]) map_of[lane] = LightShadowMaps::no_map;
        if (map_of[lane] != LightShadowMaps::no_map && i < counters.pixels)
            counters.counters.add(Counter::shadow_tests);
    }
    for (int first = 0; first < N; ++first) {
        const std::size_t m = map_of[static_cast<std::size_t>(first)];
        if (m == LightShadowMaps::no_map) continue;
        const bool back = is_back[static_cast<std::size_t>(first)];
        Mask<N> same{};
        for (int i = first; i < N; ++i) {
            const auto lane = static_cast<std::size_t>(i);
            if (map_of[lane] == m && is_back[lane] == back)
                same.lanes[i] = -1, map_of[lane] = LightShadowMaps::no_map;
        }
        const ShadowMap& map = of_light.maps[m];
        std::optional<Receiver>& bias = triangle.biases[of_light.first_map + m][back];
        if (!bias)
            bias = receiver(map, shadow_maps.bias, radius, triangle.vertices,
                            back ? -triangle.front : triangle.front);
        const WidePcfKernel<N> kernel = pcf_kernel<N>(map, *bias, position, same);
        const ShadowMapParts& parts = on_demand.parts()[of_light.first_map + m];
        for (int i = 0; i < N; ++i)
            if (kernel.is_in_map[i])
                parts.draw_around({kernel.column[i], kernel.row[i]}, radius, counters.counters);
        visibility = select(same, pcf_visibility<N>(map, radius, kernel), visibility);
    }
    return select(faces_light, faded * visibility, unlit);
}

#pragma GCC diagnostic pop
}  // namespace rasterbook
