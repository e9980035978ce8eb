// SPDX-License-Identifier: MIT
/// @file
/// Triangles for our stages and for OpenGL: those that lead to trouble among them.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "02_triangle_fill/triangle.hpp"
#include "support/opengl.hpp"

namespace rasterbook::test {

using Random = std::mt19937;
using Vertices = std::array<vec4, 3>;  ///< In clip space.
using Steps = std::array<ivec2, 3>;    ///< On the screen, in 1/256 pixel.

inline int any(Random& random, int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
}

inline float any_float(Random& random, float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
}

inline ivec2 any_point(Random& random, int low, int high) {
    const int x = any(random, low, high);
    return {x, any(random, low, high)};  // not both at once: the order would be the compiler's
}

inline Steps any_steps(Random& random, int low, int high) {
    Steps steps;
    for (ivec2& vertex : steps) vertex = any_point(random, low, high);
    return steps;
}

inline void for_each_pixel(ivec2 size, auto&& visit) {
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) visit(ivec2(x, y));
}

/// One way to choose triangles whose vertices are whole steps.
struct Kind {
    std::string name;
    OpenGlView view;
    std::function<Steps(Random&)> choose;
};

inline std::vector<Kind> kinds() {
    constexpr int side = 64, last = side * subpixels, half_pixel = subpixels / 2;
    const OpenGlView whole{ivec2(side)};
    // A viewport of which the picture is the middle: neither OpenGL nor we cut what is beside it.
    constexpr int reach = 8000, viewport = 16384;
    const OpenGlView middle(ivec2(side), ivec2(viewport), ivec2((side - viewport) / 2));
    return {{"anywhere", whole, [](Random& random) { return any_steps(random, 0, last); }},
            {"on centres and borders of pixels", whole,
             [](Random& random) {
                 Steps steps = any_steps(random, 0, 24);
                 for (ivec2& vertex : steps) vertex *= half_pixel;
                 return steps;
             }},
            {"two that share a side through a centre", whole,
             [steps = Steps{}, is_second = true](Random& random) mutable {
                 is_second = !is_second;
                 if (is_second) return Steps{steps[1], steps[0], last - steps[2]};
                 const ivec2 center = any_point(random, 16, 47) * subpixels + half_pixel;
                 const ivec2 half_side = any_point(random, -16, 16) * any(random, 1, subpixels);
                 steps = {center - half_side, center + half_side, any_point(random, 0, last)};
                 return steps;
             }},
            {"slivers", whole,
             [](Random& random) {
                 Steps steps = any_steps(random, 4, last - 4);
                 const ivec2 on_the_way = (steps[1] - steps[0]) / 8 * any(random, 0, 8);
                 steps[2] = steps[0] + on_the_way + any_point(random, -4, 4);
                 return steps;
             }},
            {"smaller than two pixels", whole,
             [](Random& random) {
                 Steps steps = any_steps(random, 0, 2 * subpixels);
                 const ivec2 corner = any_point(random, 0, last - 2 * subpixels);
                 for (ivec2& step : steps) step += corner;
                 return steps;
             }},
            {"reaching far beyond the picture", middle, [](Random& random) {
                 const ivec2 inside = any_point(random, 0, last);
                 const ivec2 way = any_point(random, -reach, reach);
                 const int there = any(random, 0, subpixels - 2);
                 const int back = any(random, 0, subpixels - 2);
                 return Steps{inside + way * there, inside - way * back,
                              any_point(random, -reach * subpixels, reach * subpixels)};
             }}};
}

/// Clip coordinates that lead to these steps without a rounding: viewports and w are powers of two.
/// Every other triangle is only gently inclined in depth.
inline Vertices clip_from_steps(const Steps& steps, const OpenGlView& view, Random& random) {
    Vertices vertices;
    const bool is_steep = any(random, 0, 1) == 1;
    const vec2 slope(any_float(random, -0.25f, 0.25f), any_float(random, -0.25f, 0.25f));
    for (std::size_t i = 0; i < 3; ++i) {
        const vec2 pixels = vec2(steps[i]) / float{subpixels} - vec2(view.viewport_low);
        const vec2 ndc = pixels / vec2(view.viewport_size) * 2.0f - 1.0f;
        const float z = is_steep ? any_float(random, 0, 1) : 0.5f + 0.5f * glm::dot(slope, ndc);
        vertices[i] = vec4(ndc.x, -ndc.y, z, 1) * std::ldexp(1.0f, any(random, -4, 4));
    }
    return vertices;
}

}  // namespace rasterbook::test
