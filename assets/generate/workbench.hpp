// SPDX-License-Identifier: MIT
/// @file
/// What stands on the workbench and around it, each thing around the origin or where it belongs.
#pragma once

#include <glm/geometric.hpp>
#include <string>
#include <utility>
#include <vector>

#include "assets/generate/figure.hpp"
#include "assets/generate/gltf.hpp"
#include "assets/generate/models.hpp"
#include "assets/generate/noise.hpp"

namespace rasterbook::assets {

constexpr double wall_z = -3;  ///< Of the brick wall behind the workbench.

/// The direction towards the sun, low on the left; and a level one at a right angle to it.
constexpr dvec3 toward_sun(-0.72, 0.34, 0.56), beside_sun(0.61, 0, 0.79);

/// Adds a face of one colour.
///
/// @param uv_begin,uv_end  Of its first corner and of its third one.
inline void add_tinted(GltfPrimitive& to, const Polygon& face, dvec2 uv_begin, dvec2 uv_end,
                       double tint) {
    std::vector<GltfVertex> corners;
    for (const Vertex& v : face)
        corners.push_back({vec3(v.position), vec3(v.normal),
                           vec2(uv_begin + v.uv * (uv_end - uv_begin)), vec3(float(tint))});
    to.add(corners);
}

/// Planks side by side, with gaps. Each shows the upper or the lower board of wood.png, from bolt
/// to bolt, there and back again; turned or not, lighter or darker: no two look alike.
inline GltfPrimitive table_top(int material) {
    constexpr double width = 1.12, gap = 0.035, left = -7.5, length = 3.2, board = 0.14;
    GltfPrimitive planks(material, {.colors = true});
    for (int i = 0; i < 12; ++i) {
        const auto chance = [&](int of) { return random(i, of, 501); };
        const bool is_upper = chance(1) < 0.5, is_turned = chance(2) < 0.5;
        const dvec2 between_bolts = is_upper ? dvec2(0.52, 0.88) : dvec2(0.12, 0.48);
        const double v = is_upper ? 0.858 : 0.002, tint = 0.72 + 0.28 * chance(3);
        const double y = -0.012 * chance(4), z = wall_z + (i + 1) * width - gap;
        for (int k = 0; k < 6; ++k) {
            dvec2 from(between_bolts.x, v), to(between_bolts.y, v + board);
            if (k % 2 == 1) std::swap(from.x, to.x);
            if (is_turned) std::swap(from.y, to.y);
            const dvec3 corner(left + (k - chance(0)) * length, y, z), right(length, 0, 0);
            add_tinted(planks, quad(corner, right, {0, 0, gap - width}), from, to, tint);
            to.y = from.y + 0.1 * (to.y - from.y);  // the edge towards us
            add_tinted(planks, quad(corner - dvec3(0, 0.3, 0), right, {0, 0.3, 0}), from, to,
                       0.5 * tint);
        }
    }
    return planks;
}

/// A wall of single bricks. Each shows any one of those in brick.png: so the wall does not repeat.
inline GltfPrimitive brick_wall(int material) {
    constexpr double left = -8, width = 1.36, height = 0.68;
    GltfPrimitive bricks(material, {.colors = true});
    for (int course = 0; course < 9; ++course)
        for (int i = 0; i < 14; ++i) {
            const int column = int(4 * random(i, course, 511)),
                      row = int(8 * random(i, course, 512));
            const dvec2 uv((column - row % 2 / 2.0) / 4, 1 - (row + 1) / 8.0);
            const dvec3 corner(left + width * (i - course % 2 / 2.0), height * course, wall_z);
            add_tinted(bricks, quad(corner, {width, 0, 0}, {0, height, 0}), uv,
                       uv + dvec2(1 / 4.0, 1 / 8.0), 0.8 + 0.2 * random(i, course, 513));
        }
    return bricks;
}

inline Part cuboid(const std::string& material, dvec3 low, dvec3 high) {
    const dvec3 x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
    return {"cuboid",
            material,
            {quad(low + z, x, y), quad(low + x + z, -z, y), quad(low + x, -x, y), quad(low, z, y),
             quad(low + y + z, x, -z), quad(low, x, z)}};
}

/// A wall with a window to the left of the picture: the sun shines through between its bars.
inline std::vector<Part> window_wall() {
    constexpr double left = 2.2, right = 13.4, sill = 1.8, top = 9.3, bar = 0.12;
    const auto board = [](double from_z, double to_z, double from_y, double to_y) {
        return cuboid("plaster", {-9.3, from_y, from_z}, {-9, to_y, to_z});
    };
    std::vector<Part> parts{board(-3, 27, -1, sill), board(-3, 27, top, 16),
                            board(-3, left, sill, top), board(right, 27, sill, top),
                            board(left, right, 8.08 - bar, 8.08 + bar)};
    for (const double share : {1 / 3.0, 2 / 3.0}) {
        const double z = left + share * (right - left);
        parts.push_back(board(z - bar, z + bar, sill, top));
    }
    return parts;
}

/// A sheet of paper, one corner of which has curled up.
inline Part sheet() {
    constexpr int n = 12;
    constexpr double side = 3.25, height = 1.3;
    const auto vertex = [](int column, int row) {
        const dvec2 uv(double(column) / n, double(row) / n);
        const double curl = glm::max(uv.x + uv.y - 1.45, 0.0), slope = 2 * height * curl / side;
        return Vertex{{side * (uv.x - 0.5), 0.014 + height * curl * curl, side * (0.5 - uv.y)},
                      uv,
                      glm::normalize(dvec3(-slope, 1, slope))};
    };
    Part part{"sheet", "paper", {}};
    for (int row = 0; row < n; ++row)
        for (int i = 0; i < n; ++i)
            part.faces.push_back(
                {vertex(i, row), vertex(i + 1, row), vertex(i + 1, row + 1), vertex(i, row + 1)});
    return part;
}

/// A pencil that lies along the z axis, its tip at the origin.
inline std::vector<Part> pencil() {
    constexpr double r = 0.12, tip = 0.035;
    const dvec2 slant = glm::normalize(dvec2(0.4, tip - r)), out(1, 0), back(0, 1);
    const auto turned = [&](const char* material, const Profile& profile) {
        const dmat3 y_to_z(dvec3(1, 0, 0), dvec3(0, 0, 1), dvec3(0, -1, 0));
        return revolved(material, profile, 12, {y_to_z, {0, r, 0}});
    };
    return {turned("lead", {{{0, 0}, slant}, {{tip, 0.15}, slant}}),
            turned("bare wood", {{{tip, 0.15}, slant}, {{r, 0.55}, slant}}),
            turned("paint", {{{r, 0.55}, out}, {{r, 3.1}, out}}),
            turned("brass", {{{r + 0.01, 3.1}, out}, {{r + 0.01, 3.32}, out}}),
            turned("rubber", {{{r, 3.3}, out}, {{r, 3.6}, out}, {{0, 3.62}, back}})};
}

constexpr double glass_radius = 0.62, tea_level = 1.15;

/// A glass on y = 0 around the y axis; in it stands what casts the shadow of the tea.
inline std::vector<Part> tea_glass() {
    constexpr double r = glass_radius, height = 1.6;
    const dvec2 out = glm::normalize(dvec2(height, -0.2 * r)), up(0, 1);
    const Profile wall{{{0.8 * r, 0}, out}, {{r, height}, out}};
    const Profile core{{{0.7 * r, 0.02}, out}, {{0.8 * r, 1.1}, out}, {{0, 1.1}, up}};
    return {revolved("foot", core, 24, {}), revolved("glass", wall, 48, {}),
            revolved("rim", ring_profile(0.98 * r, 0.025, 8), 48, {dmat3(1), {0, height, 0}})};
}

/// The tea. In the lessons, light passes through nothing; so what sunlight would do is painted: tea
/// glows where the light leaves it.
inline GltfPrimitive tea_in_glass(int material) {
    constexpr double low = 0.74 * glass_radius, high = 0.88 * glass_radius;
    const dvec2 out(1, 0), up(0, 1);
    const Profile profile{{{low, 0.12}, out},
                          {{high, tea_level}, out},
                          {{high, tea_level}, up},
                          {{0, tea_level}, up}};
    GltfPrimitive tea(material, {.normals = false, .uvs = false, .colors = true});
    for (const Polygon& face : revolved("", profile, 48, {}).faces) {
        std::vector<GltfVertex> corners;
        for (const Vertex& v : face) {
            const double away =
                0.5 + 0.5 * (beside_sun.z * v.position.x - beside_sun.x * v.position.z) / high;
            const double glow = v.normal.y > 0.5 ? 0.15 + 0.45 * away : away * away;
            const dvec3 color = glm::mix(dvec3(0.06, 0.01, 0.001), dvec3(0.85, 0.19, 0.012), glow);
            corners.push_back({vec3(v.position)});
            corners.back().color = vec3(color * (1 - 0.3 * v.position.y / tea_level));
        }
        tea.add(corners);
    }
    return tea;
}

/// Light that has passed through the tea: patches on the table, each upon a larger one.
inline GltfPrimitive light_through_tea(int material) {
    const dvec3 away(beside_sun.z, 0, -beside_sun.x);
    GltfPrimitive light(material, {.normals = false, .uvs = false});
    for (int i = 0; i < 8; ++i) {
        const double share = 1 - 0.11 * i;
        std::vector<GltfVertex> rim;
        for (const dvec2 on : circle(24))
            rim.push_back({vec3((1.45 + share * on.x) * away - 0.34 * share * on.y * beside_sun +
                                dvec3(0, 0.004 + 0.001 * i, 0))});
        light.add(rim);
    }
    return light;
}

}  // namespace rasterbook::assets
