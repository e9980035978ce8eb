// SPDX-License-Identifier: MIT
/// @file
/// Noise from integer hashes: the same on every machine, and periodic so that textures tile.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "common/math/types.hpp"

namespace rasterbook::assets {

constexpr int without_end = 1 << 20;  ///< A period that no texture reaches.

/// A well mixed number for a place and a seed (the last step is MurmurHash3's finaliser).
constexpr std::uint32_t hash(int x, int y, std::uint32_t seed) {
    std::uint32_t h = seed * 0x9E3779B9u;
    h = (h ^ std::uint32_t(x)) * 0x85EBCA6Bu;
    h = (h ^ (h >> 15) ^ std::uint32_t(y)) * 0xC2B2AE35u;
    h = (h ^ (h >> 16)) * 0x85EBCA6Bu;
    h = (h ^ (h >> 13)) * 0xC2B2AE35u;
    return h ^ (h >> 16);
}

/// A random number from 0 (included) to 1 (excluded).
constexpr double random(int x, int y, std::uint32_t seed) {
    return hash(x, y, seed) / 4294967296.0;
}

constexpr int wrap(int i, int period) { return (i % period + period) % period; }

/// 0 up to `from`, 1 from `to` on, smooth between.
constexpr double smooth_step(double from, double to, double x) {
    const double t = (x - from) / (to - from);
    if (t <= 0) return 0;
    if (t >= 1) return 1;
    return t * t * (3 - 2 * t);
}

/// Gradient noise: smooth, 0 at whole places, about -0.7 to 0.7. @see Perlin 2002
///
/// @param p       In cells.
/// @param period  After so many cells it repeats.
inline double noise(dvec2 p, ivec2 period, std::uint32_t seed) {
    const dvec2 cell(std::floor(p.x), std::floor(p.y));
    const dvec2 t = p - cell;
    std::array<double, 4> ramps{};
    for (int corner = 0; corner < 4; ++corner) {
        const ivec2 offset(corner & 1, corner >> 1);
        const int x = wrap(int(cell.x) + offset.x, period.x);
        const int y = wrap(int(cell.y) + offset.y, period.y);
        const dvec2 gradient(2 * random(x, y, seed) - 1, 2 * random(x, y, seed + 77) - 1);
        const dvec2 away = t - dvec2(offset);
        ramps[std::size_t(corner)] = 1.4 * (gradient.x * away.x + gradient.y * away.y);
    }
    const auto fade = [](double s) { return s * s * s * (s * (6 * s - 15) + 10); };
    const double upper = ramps[0] + (ramps[1] - ramps[0]) * fade(t.x);
    const double lower = ramps[2] + (ramps[3] - ramps[2]) * fade(t.x);
    return upper + (lower - upper) * fade(t.y);
}

/// Octaves of noise, each twice as fine and half as strong as the one before.
///
/// @param uv     0 to 1 across the texture, which it tiles.
/// @param cells  Of the coarsest octave.
inline double layered_noise(dvec2 uv, ivec2 cells, int octaves, std::uint32_t seed) {
    double sum = 0, strength = 1;
    for (int octave = 0; octave < octaves; ++octave) {
        sum += strength * noise(uv * dvec2(cells), cells, seed + std::uint32_t(octave));
        cells *= 2;
        strength /= 2;
    }
    return sum;
}

}  // namespace rasterbook::assets
