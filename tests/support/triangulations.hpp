// SPDX-License-Identifier: MIT
/// @file
/// Sets of triangles that cover a whole picture without overlap, made to be hard.
#pragma once

#include <array>
#include <random>
#include <vector>

#include "common/math/types.hpp"

namespace rasterbook::test {

using Triangles = std::vector<std::array<vec2, 3>>;

/// The triangles from a center to each side of the closed rim around it.
inline Triangles fan(vec2 center, const std::vector<vec2>& rim) {
    Triangles triangles;
    for (std::size_t i = 0; i < rim.size(); ++i)
        triangles.push_back({center, rim[i], rim[(i + 1) % rim.size()]});
    return triangles;
}

/// A rectangle around the picture, cut at random: new corners inside triangles, which makes ever
/// thinner ones, and moved diagonals. Vertices lie on 1/256 pixel, many of them on pixel centres.
///
/// @param size  Of the picture, in pixels.
inline Triangles random_triangulation(ivec2 size, unsigned seed) {
    std::mt19937 random(seed);
    const vec2 low(-1.0f), high = vec2(size) + 1.0f;
    Triangles triangles = {{low, {low.x, high.y}, high}, {low, high, {high.x, low.y}}};
    const bool on_centers = seed % 2 == 0;
    const auto area = [](vec2 a, vec2 b, vec2 c) {  // exact: the coordinates are short
        const dvec2 u = dvec2(b) - dvec2(a), v = dvec2(c) - dvec2(a);
        return u.y * v.x - u.x * v.y;
    };
    for (int i = 0; i < 24; ++i) {
        const std::size_t chosen = random() % triangles.size();
        const auto [a, b, c] = triangles[chosen];
        std::uniform_real_distribution<float> share(0.02f, 0.48f);
        vec2 p = a + share(random) * (b - a) + share(random) * (c - a);
        p = on_centers ? glm::floor(p) + 0.5f : glm::round(p * 256.0f) / 256.0f;
        if (area(a, b, p) <= 0 || area(b, c, p) <= 0 || area(c, a, p) <= 0)
            continue;  // rounded out of it
        triangles[chosen] = {a, b, p};
        triangles.push_back({b, c, p});
        triangles.push_back({c, a, p});
    }
    return triangles;
}

}  // namespace rasterbook::test
