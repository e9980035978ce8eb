// SPDX-License-Identifier: MIT
/// @file
/// Texture samples of several pixels at once: the same steps, and bits, as in lesson 05. Introduced
/// in lesson 14; derivation: docs/derivations/14_simd.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "05_textures/texture.hpp"
#include "14_simd/simd.hpp"
#include "common/math/functions.hpp"

namespace rasterbook {

/// A vertex attribute at several pixels of a triangle.
template <int n, int N>
glm::vec<n, Floats<N>> interpolate(const std::array<glm::vec<n, float>, 3>& of_vertices,
                                   const Vec3<Floats<N>>& barycentrics) {
    using Attribute = glm::vec<n, Floats<N>>;
    return barycentrics.x * Attribute(of_vertices[0]) + barycentrics.y * Attribute(of_vertices[1]) +
           barycentrics.z * Attribute(of_vertices[2]);
}

/// Several texture coordinates brought into the texture (Eq. 5.4).
template <int N>
Floats<N> wrapped(Floats<N> coordinate, Wrap wrap) {
    using F = Floats<N>;
    const F zero(0.0f), one(1.0f), two(2.0f);
    if (wrap == Wrap::repeat) return max(coordinate - floor(coordinate), zero);
    if (wrap == Wrap::clamp) return clamp(coordinate, zero, one);
    const F there_and_back = coordinate - two * floor(F(0.5f) * coordinate);
    const F back = two - there_and_back;
    return max(select(back < there_and_back, back, there_and_back), zero);
}

/// Texels of N / 4 pixels, and those to their right.
template <int N>
struct TexelPairs {
    Vector<float, N> left, right;
};

/// A texel's four channels are neighbours in memory, as are two texels of a row; those of N pixels
/// are not. So a vector of N floats has the texels of N / 4 pixels: k, k + 4, k + 8 ...
///
/// @param texels  The first one's address.
/// @param at      Of each pixel's left texel: its place behind the first one.
template <int k, int N>
TexelPairs<N> read_texels(const float* texels, const Ints<N>& at) {
    const auto pair_of = [&](int pixel) {
        Vector<float, 8> pair;
        std::memcpy(&pair, texels + std::ptrdiff_t{at[pixel]} * 4, sizeof pair);
        return pair;
    };
    const auto left = [](int i) constexpr { return i / 4 * 8 + i % 4; };
    const auto right = [](int i) constexpr { return i / 4 * 8 + i % 4 + 4; };
    if constexpr (N == 16) {
        const auto all = [](int i) constexpr { return i; };
        const auto a = shuffled<N>(pair_of(k), pair_of(k + 4), all);
        const auto b = shuffled<N>(pair_of(k + 8), pair_of(k + 12), all);
        return {shuffled<N>(a, b, left), shuffled<N>(a, b, right)};
    } else {
        const auto a = pair_of(k), b = pair_of(N == 8 ? k + 4 : k);
        return {shuffled<N>(a, b, left), shuffled<N>(a, b, right)};
    }
}

/// From vectors of the texels of pixels 0, 4, 8 ..., of pixels 1, 5, 9 ..., and so on to vectors of
/// the four channels: in each group of four numbers, columns become rows (Eq. 14.7).
template <int N>
glm::vec<4, Floats<N>> channels_of(const std::array<Vector<float, N>, 4>& texels) {
    const auto [a, b, c, d] = texels;
    const auto first_two = [](int i) constexpr {  // a0 b0 a1 b1
        return i / 4 * 4 + i % 4 / 2 + i % 2 * N;
    };
    const auto last_two = [](int i) constexpr {  // a2 b2 a3 b3
        return i / 4 * 4 + 2 + i % 4 / 2 + i % 2 * N;
    };
    const auto first_halves = [](int i) constexpr {  // a0 b0, c0 d0
        return i / 4 * 4 + i % 2 + i % 4 / 2 * N;
    };
    const auto last_halves = [](int i) constexpr {  // a1 b1, c1 d1
        return i / 4 * 4 + 2 + i % 2 + i % 4 / 2 * N;
    };
    const auto ab01 = shuffled<N>(a, b, first_two), ab23 = shuffled<N>(a, b, last_two);
    const auto cd01 = shuffled<N>(c, d, first_two), cd23 = shuffled<N>(c, d, last_two);
    return {Floats<N>(shuffled<N>(ab01, cd01, first_halves)),
            Floats<N>(shuffled<N>(ab01, cd01, last_halves)),
            Floats<N>(shuffled<N>(ab23, cd23, first_halves)),
            Floats<N>(shuffled<N>(ab23, cd23, last_halves))};
}

/// The four texels around each of N positions.
template <int N>
struct TexelsAround {
    Ints<N> upper_left;          ///< Of the four, as an index into the level's texels.
    Floats<N> share_x, share_y;  ///< Of the right ones and of the lower ones, 0 to 1.
};

/// @param x,y  Positions in the texture, 0 to 1.
template <int N>
TexelsAround<N> texels_around(const TextureLevel& level, Floats<N> x, Floats<N> y) {
    using F = Floats<N>;
    const F from_first_x = x * F(static_cast<float>(level.size.x)) + F(0.5f);
    const F from_first_y = y * F(static_cast<float>(level.size.y)) + F(0.5f);
    const Ints<N> column = min(truncated(from_first_x), Ints<N>(level.size.x));
    const Ints<N> row = min(truncated(from_first_y), Ints<N>(level.size.y));
    return {row * Ints<N>(level.texels.size().x) + column, from_first_x - to_floats(column),
            from_first_y - to_floats(row)};
}

/// The mean of the four texels around each of several positions (Eq. 5.6).
///
/// @param x,y  Positions in the texture, 0 to 1.
template <int N>
glm::vec<4, Floats<N>> sample_bilinear(const TextureLevel& level, Floats<N> x, Floats<N> y) {
    // TODO: step 3: texels_around() finds the texels of all N pixels. For k = 0 to 3, the mean of
    // the four texels of pixels k, k + 4 ... in one vector: read_texels<k>() reads them, and
    // shuffled() gives each texel its pixel's shares, four times. channels_of() makes channels of
    // the four means.
    return glm::vec<4, Floats<N>>(Floats<N>(1.0f));
}

/// Asks memory for many of the texels that sample_bilinear() would read, and waits for none.
template <int N>
void prefetch_bilinear(const TextureLevel& level, Floats<N> x, Floats<N> y) {
    const Ints<N> at = texels_around(level, x, y).upper_left;
    const vec4* const upper = level.texels.pixels().data();
    for (int i = 0; i < N; i += 4) {  // a cache line has four texels of a row
        __builtin_prefetch(upper + at[i]);
        __builtin_prefetch(upper + at[i] + level.texels.size().x);
    }
}

/// The texel in which each of several positions lies.
template <int N>
glm::vec<4, Floats<N>> sample_nearest(const TextureLevel& level, Floats<N> x, Floats<N> y) {
    glm::vec<4, Floats<N>> color;
    for (int i = 0; i < N; ++i) {
        const vec4 texel = sample_nearest(level, {x[i], y[i]});
        for (int c = 0; c < 4; ++c) color[c].set(i, texel[c]);
    }
    return color;
}

/// The mip level for each of several fragments (Eq. 5.8).
template <int N>
Floats<N> level_of_detail(const glm::vec<2, Floats<N>>& ddx, const glm::vec<2, Floats<N>>& ddy,
                          ivec2 size) {
    using F = Floats<N>;
    const glm::vec<2, F> texels{vec2(size)};
    const glm::vec<2, F> across = ddx * texels, down = ddy * texels;
    const F across_squared = glm::dot(across, across), down_squared = glm::dot(down, down);
    const F longer_squared = select(across_squared < down_squared, down_squared, across_squared);
    const F sum = across_squared + down_squared;  // NaN where either is
    return select((sum == sum) & (longer_squared > F(1.0f)), F(0.5f) * log2(longer_squared),
                  F(0.0f));
}

/// Samples a texture that has a filter of its own, as pixel art does: one lane after the other.
template <int N>
[[gnu::noinline]] glm::vec<4, Floats<N>> sample_one_by_one(
    const Texture& texture, Filter filter, const TextureCoordinates<Floats<N>>& uv) {
    const auto lane = [](const glm::vec<2, Floats<N>>& v, int i) { return vec2(v.x[i], v.y[i]); };
    glm::vec<4, Floats<N>> color;
    for (int i = 0; i < N; ++i) {
        const vec4 own =
            sample(texture, filter, FragmentUv{lane(uv.here, i), lane(uv.ddx, i), lane(uv.ddy, i)});
        for (int c = 0; c < 4; ++c) color[c].set(i, own[c]);
    }
    return color;
}

/// Notes for `--probe` how one of several fragments samples a texture.
template <int N>
void trace_lane(const Texture& texture, Filter filter, const TextureCoordinates<Floats<N>>& uv) {
    if (is_traced())
        sample(texture, filter,
               FragmentUv{traced_lane(uv.here), traced_lane(uv.ddx), traced_lane(uv.ddy)});
}

/// A texture's colours and alphas in several fragments. Structs of vectors are passed to functions
/// through memory, and that may take longer than the function itself. `flatten` inlines all that is
/// called here, and all that those call.
template <int N>
[[gnu::flatten]] glm::vec<4, Floats<N>> sample(const Texture& texture, Filter filter,
                                               const TextureCoordinates<Floats<N>>& uv) {
    using F = Floats<N>;
    trace_lane(texture, filter, uv);
    const Untraced others;
    if (has_own_filter(texture)) return sample_one_by_one(texture, filter, uv);
    const F x = wrapped(uv.here.x, texture.wrap.u);
    const F y = F(1.0f) - wrapped(uv.here.y, texture.wrap.v);
    if (filter == Filter::nearest) return sample_nearest(texture.levels[0], x, y);
    // The pixels that come next are mostly the N to the right. Clamped, as both become an index.
    const F x_ahead = clamp(x + F(N) * uv.ddx.x, F(0.0f), F(1.0f));
    const F y_ahead = clamp(y - F(N) * uv.ddx.y, F(0.0f), F(1.0f));
    if (filter == Filter::bilinear) {
        const glm::vec<4, F> color = sample_bilinear(texture.levels[0], x, y);
        prefetch_bilinear(texture.levels[0], x_ahead, y_ahead);
        return color;
    }
    // TODO: step 3: as sample_trilinear(). The finer level is another one in each lane: take all
    // lanes between the same two levels together, by a mask, until none is left. The coarser level
    // has to be there only where some lane's share of it is not 0. Last of all, it may be faster to
    // prefetch both levels of lane 0.
    return glm::vec<4, F>(F(1.0f));
}

}  // namespace rasterbook
