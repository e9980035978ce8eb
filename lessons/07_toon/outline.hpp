// SPDX-License-Identifier: MIT
/// @file
/// Outlines that need more than one fragment: the inverted hull, and screen-space edge detection in
/// depth and normals. Introduced in lesson 07; derivation: docs/derivations/07_toon.md.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "04_mvp/projection.hpp"
#include "06_phong/face_normal.hpp"
#include "common/app/counters.hpp"
#include "common/math/functions.hpp"

namespace rasterbook {

constexpr vec3 ink(0.006f, 0.005f, 0.009f);  ///< The colour of outlines; linear.

/// For each position of a mesh the direction in which its hull grows: the mean of the normals of
/// all faces that touch it, weighted by their angles there (Eq. 7.8).
///
/// Equal positions get the same direction, also where the file has one for each face; so the hull
/// has no gap at a crease.
///
/// @return  Of length 1; 0 where there is none, as on a sheet with faces for both sides.
inline std::vector<vec3> hull_normals(const Mesh& mesh) {
    std::vector<vec3> sums(mesh.positions.size(), vec3(0));
    for (const Triangle& triangle : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i)
            sums[triangle.vertices[i].position] +=
                vertex_angle_radians(mesh, triangle, i) * face_normal(mesh, triangle);

    const auto place = [&](std::size_t i) {  // its bits: their order has a place for NaN, too
        return std::bit_cast<std::array<std::uint32_t, 3>>(mesh.positions[i] + 0.0f);  // -0 is 0
    };
    std::vector<std::size_t> by_place(sums.size());
    std::iota(by_place.begin(), by_place.end(), std::size_t{0});
    // Sums are rounded: those of one position are added in their order in the mesh.
    std::sort(by_place.begin(), by_place.end(), [&](std::size_t i, std::size_t j) {
        return std::pair(place(i), i) < std::pair(place(j), j);
    });
    for (std::size_t begin = 0, end; begin < by_place.size(); begin = end) {
        vec3 sum(0);
        for (end = begin; end < by_place.size() && place(by_place[end]) == place(by_place[begin]);)
            sum += sums[by_place[end++]];
        const vec3 normal = unit_or(sum, vec3(0));
        for (std::size_t i = begin; i < end; ++i) sums[by_place[i]] = normal;
    }
    return sums;
}

/// A vertex pushed on the screen by `width_px` pixels, in the direction in which it moves there
/// when it moves along its normal (Eq. 7.9). Its depth and its w stay.
///
/// @param normal_clip  clip_from_world * vec4(normal, 0). A normal that points straight to the
///                     eye or away from it has no direction on the screen: the vertex stays.
inline vec4 pushed(vec4 position_clip, vec4 normal_clip, float width_px, ivec2 size) {
    const vec2 half_size = 0.5f * vec2(size);
    const vec2 way = vec2(normal_clip) * position_clip.w - vec2(position_clip) * normal_clip.w;
    const vec2 direction(unit_or(vec3(half_size * way, 0), vec3(0)));
    const vec2 push = width_px * position_clip.w * direction / half_size;
    return position_clip + vec4(push, 0, 0);
}

/// Whether a face shows the eye its back (Eq. 7.10). In double, where products do not overflow.
inline bool is_seen_from_behind(const Mesh& mesh, const Triangle& triangle, vec3 eye_world) {
    const dvec3 a = mesh.positions[triangle.vertices[0].position];
    const dvec3 b = mesh.positions[triangle.vertices[1].position];
    const dvec3 c = mesh.positions[triangle.vertices[2].position];
    return glm::dot(a - dvec3(eye_world), glm::cross(b - a, c - a)) > 0;
}

/// Draws the inverted hull of a closed body: the faces on its far side, pushed outwards, in ink.
/// The body occludes all of them but a rim of `width_px` pixels (Eq. 7.9).
///
/// The rim has that width wherever the body is round; at the sides of a cube it is 0.577 to 1 times
/// as wide. A sheet that is not closed has no rim where it shows its front. Counts each fragment of
/// the hull as one of outline_tests, and each one inked as one of outline_pixels.
///
/// @param normals  hull_normals() of the mesh.
/// @param depth    All bodies are drawn already. Takes the hull's depths where it is visible.
inline void draw_hull(const Mesh& mesh, const std::vector<vec3>& normals, const Camera& camera,
                      float width_px, DepthBuffer& depth, Image<vec3>& color) {
    const ivec2 size = color.size();
    const mat4 clip_from_world = camera.clip_from_world(size);
    // No test of the bounds: of a body just outside of the picture, the rim may reach into it.
    std::vector<vec4> positions_clip = transform(clip_from_world, mesh.positions);
    for (std::size_t i = 0; i < positions_clip.size(); ++i)
        positions_clip[i] =
            pushed(positions_clip[i], clip_from_world * vec4(normals[i], 0), width_px, size);
    for (const Triangle& triangle : mesh.triangles) {
        // Asked of the body: pushing may turn a small face around.
        if (!is_seen_from_behind(mesh, triangle, camera.position_world)) continue;
        for (const ClippedTriangle& clipped :
             clip_triangle(vertices_of(triangle, positions_clip))) {
            const ProjectedTriangle back = project(mesh, triangle, clipped, size);
            fill_triangle(back.on_screen, size, [&](ivec2 pixel, Barycentrics barycentrics) {
                count(Counter::outline_tests);
                if (!depth.test_and_write(pixel, back.depth.at(barycentrics))) return;
                count(Counter::outline_pixels);
                color[pixel] = ink;
            });
        }
    }
}

/// From where on a change counts as an edge.
///
/// No crease of a box, a common prism or a regular solid changes the normals by exactly as much,
/// however it runs over the picture: otherwise rounding would decide what is inked (Eq. 7.14).
struct EdgeThresholds {
    float depth = 0.02f;    ///< A jump, as a share of the distance.
    float normals = 0.45f;  ///< Of unit vectors: along a row or column, a turn of 26 degrees.
};

/// 1/w of what is visible in a pixel, which on a plane is linear on the screen (Eq. 7.11).
///
/// @param depth  From a depth buffer, 0 to 1; where nothing is seen, 0 as infinitely far away.
inline float inverse_w(float depth, const Camera& camera) { return depth / camera.near; }

/// The second difference along x or y; the rows beside count half (Eq. 7.12). It is 0 for a plane,
/// however steep; the first difference would grow with the slope.
///
/// @param at     Called as at(ivec2 offset), each component -1, 0 or 1.
/// @param along  (1, 0) or (0, 1).
template <typename At>
float second_difference(At&& at, ivec2 along) {
    const ivec2 across(along.y, along.x);
    const auto line = [&](ivec2 row) { return at(row - along) - 2 * at(row) + at(row + along); };
    return 0.25f * (line(-across) + 2 * line(ivec2(0)) + line(across));
}

/// Sobel's first difference along x or y; the rows beside count half (Eq. 7.13). At an edge between
/// two values it is their difference.
///
/// @param at,along  As for second_difference().
template <typename At>
vec3 sobel(At&& at, ivec2 along) {
    const ivec2 across(along.y, along.x);
    const auto line = [&](ivec2 row) { return at(row + along) - at(row - along); };
    return 0.25f * (line(-across) + 2.0f * line(ivec2(0)) + line(across));
}

/// Screen-space edge detection: inks the pixels around which depth or normals change by more than a
/// threshold (Eq. 7.14): silhouettes, creases, and where one body touches another.
///
/// @param normals   Of what is seen, length 1; 0 where nothing is.
/// @param width_px  Of lines along rows and columns, rounded up to an even number; slanted ones are
///                  thinner, or up to 1.41 times as wide. 0: each pixel is asked, none inked. In a
///                  picture that is at most that even number of pixels wide or high, none is
///                  asked.
inline void draw_edges(const DepthBuffer& depth, const Image<vec3>& normals, const Camera& camera,
                       float width_px, const EdgeThresholds& thresholds, Image<vec3>& color) {
    const int reach = static_cast<int>(std::ceil(width_px / 2));
    const ivec2 size = color.size();
    if (std::min(size.x, size.y) <= 2 * reach) return;
    const ivec2 x(1, 0), y(0, 1);
    for (ivec2 pixel(0); pixel.y < size.y; ++pixel.y)
        for (pixel.x = 0; pixel.x < size.x; ++pixel.x) {
            count(Counter::outline_tests);
            // At the border, those of the next pixel that has neighbours on all sides.
            const ivec2 center = glm::clamp(pixel, ivec2(reach), size - 1 - reach);
            const auto inverse_w_at = [&](ivec2 offset) {
                return inverse_w(depth.depths()[center + reach * offset], camera);
            };
            const auto normal_at = [&](ivec2 offset) { return normals[center + reach * offset]; };
            const float bend =
                std::hypot(second_difference(inverse_w_at, x), second_difference(inverse_w_at, y));
            const vec3 turn_x = sobel(normal_at, x), turn_y = sobel(normal_at, y);
            const float turn = std::sqrt(glm::dot(turn_x, turn_x) + glm::dot(turn_y, turn_y));
            if (bend > thresholds.depth * inverse_w_at(ivec2(0)) || turn > thresholds.normals) {
                count(Counter::outline_pixels);
                color[pixel] = ink;
            }
        }
}

}  // namespace rasterbook
