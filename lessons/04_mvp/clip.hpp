// SPDX-License-Identifier: MIT
/// @file
/// Clipping and culling: what of a triangle the camera sees. Introduced in lesson 04;
/// derivation: docs/derivations/04_mvp.md.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <vector>

#include "common/math/types.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// A vertex of what is left of a triangle.
struct ClippedVertex {
    vec4 position_clip;
    vec3 barycentrics;  ///< Of the whole triangle's vertices: this vertex is their weighted sum.
};

using ClippedTriangle = std::array<ClippedVertex, 3>;

constexpr int frustum_planes = 6;

/// How far inside of one of the six planes a point is in NDC, times w: negative outside (Eq. 4.10).
/// In NDC, x and y run from -1 to 1, and z from 0, infinitely far away, to 1 on the near plane.
///
/// @param plane  0 to 5: left, right, bottom, top, near, far.
constexpr float plane_distance(int plane, vec4 position_clip) {
    const auto [x, y, z, w] =
        std::array{position_clip.x, position_clip.y, position_clip.z, position_clip.w};
    return std::array{w + x, w - x, w + y, w - y, w - z, z}[static_cast<std::size_t>(plane)];
}

/// Where the side from a to b crosses a plane (Eq. 4.11 and 4.12).
///
/// The side from b to a crosses it in the same point, bit for bit: triangles that share a side
/// still share it when both are cut.
///
/// @param a_by,b_by  The plane_distance of each; one of them is negative.
inline ClippedVertex crossing(const ClippedVertex& a, float a_by, const ClippedVertex& b,
                              float b_by) {
    // Eq. 4.12, not 4.11, whose products of coordinates and distances might overflow or vanish.
    const float whole = a_by - b_by, share_of_a = -b_by / whole, share_of_b = a_by / whole;
    return {share_of_a * a.position_clip + share_of_b * b.position_clip,
            share_of_a * a.barycentrics + share_of_b * b.barycentrics};
}

/// The vertices that clipping at six planes may leave: 9 of a convex polygon, but rounding may dent
/// it a little, and then a plane may cut off every second vertex and add two for each.
constexpr std::size_t max_clipped_vertices = 28;

/// What is left of one triangle: a polygon, as a fan.
class ClippedTriangles {
  public:
    const ClippedTriangle* begin() const { return triangles_.data(); }
    const ClippedTriangle* end() const { return triangles_.data() + count_; }
    void add(const ClippedTriangle& triangle) { triangles_[count_++] = triangle; }

  private:
    std::array<ClippedTriangle, max_clipped_vertices - 2> triangles_;
    std::size_t count_ = 0;
};

/// Coordinates in clip space stay below this: then no difference in Eq. 4.12 overflows.
constexpr float clip_limit = 0x1p125f;

/// A point that rounding has left a little outside of the frustum, moved onto its border. On the
/// screen it lies inside the picture, and its depth between 0 and 1; with a w of 0 it lies nowhere.
inline vec4 clamped_to_frustum(vec4 position_clip) {
    const float w = std::max(position_clip.w, 0.0f);
    return {glm::clamp(vec3(position_clip), vec3(-w, -w, 0), vec3(w)), w};
}

/// The part of a triangle inside the frustum, as triangles that keep its winding (Eq. 4.13).
///
/// @param vertices  Clip space. If a coordinate is not a number, or not below clip_limit in size,
///                  nothing is left.
/// @return          The triangle itself, if it is all inside; nothing, if it is all outside of one
///                  plane. No vertex has a coordinate beyond its w; no w and no z is negative.
/// @see Sutherland and Hodgman, "Reentrant polygon clipping", 1974
inline ClippedTriangles clip_triangle(const std::array<vec4, 3>& vertices) {
    ClippedTriangles clipped;
    unsigned outside_any = 0, outside_all = ~0u;
    for (const vec4 vertex : vertices) {
        if (!glm::all(glm::lessThan(glm::abs(vertex), vec4(clip_limit)))) return clipped;
        unsigned outside = 0;
        for (int plane = 0; plane < frustum_planes; ++plane)
            outside |= static_cast<unsigned>(plane_distance(plane, vertex) < 0) << plane;
        outside_any |= outside;
        outside_all &= outside;
    }
    if (outside_all != 0) return clipped;
    const ClippedTriangle whole = {
        {{vertices[0], {1, 0, 0}}, {vertices[1], {0, 1, 0}}, {vertices[2], {0, 0, 1}}}};
    if (outside_any == 0) {
        clipped.add(whole);
        return clipped;
    }

    std::array<ClippedVertex, max_clipped_vertices> polygon, rest;
    std::copy(whole.begin(), whole.end(), polygon.begin());
    std::size_t count = 3;
    for (int plane = 0; plane < frustum_planes; ++plane) {
        if ((outside_any >> plane & 1) == 0) continue;
        std::size_t rest_count = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const ClippedVertex& from = polygon[i];
            const ClippedVertex& to = polygon[i + 1 < count ? i + 1 : 0];
            const float from_by = plane_distance(plane, from.position_clip);
            const float to_by = plane_distance(plane, to.position_clip);
            if (from_by >= 0) rest[rest_count++] = from;
            if ((from_by >= 0) != (to_by >= 0))
                rest[rest_count++] = crossing(from, from_by, to, to_by);
        }
        std::copy_n(rest.begin(), rest_count, polygon.begin());
        count = rest_count;
    }
    for (std::size_t i = 0; i < count; ++i)
        polygon[i].position_clip = clamped_to_frustum(polygon[i].position_clip);
    for (std::size_t i = 2; i < count; ++i) clipped.add({polygon[0], polygon[i - 1], polygon[i]});
    return clipped;
}

/// A triangle's vertices in clip space.
inline std::array<vec4, 3> vertices_of(const Triangle& triangle,
                                       const std::vector<vec4>& positions_clip) {
    return {positions_clip[triangle.vertices[0].position],
            positions_clip[triangle.vertices[1].position],
            positions_clip[triangle.vertices[2].position]};
}

/// Whether nothing inside the box is visible, because all of its corners are outside of one plane
/// (Eq. 4.14).
///
/// False also for some boxes beside an edge of the frustum of which nothing is visible.
///
/// @param bounds  World space; or model space, with a matrix from there.
inline bool is_outside_frustum(const Bounds& bounds, const mat4& clip_from_world) {
    unsigned outside_all = ~0u;
    for (int i = 0; i < 8; ++i) {
        const vec3 corner(i & 1 ? bounds.max.x : bounds.min.x, i & 2 ? bounds.max.y : bounds.min.y,
                          i & 4 ? bounds.max.z : bounds.min.z);
        const vec4 corner_clip = clip_from_world * vec4(corner, 1);
        unsigned outside = 0;
        for (int plane = 0; plane < frustum_planes; ++plane)
            outside |= static_cast<unsigned>(plane_distance(plane, corner_clip) < 0) << plane;
        outside_all &= outside;
    }
    return outside_all != 0;
}

/// A point on the screen in pixels, and its depth, 0 to 1 (Eq. 4.9, after the division by w).
///
/// @param position_clip  Inside the frustum, w > 0. A w of 0 gives NaN, which snap_triangle
///                       refuses.
inline vec3 screen_from_clip(vec4 position_clip, ivec2 size) {
    const vec3 position_ndc = vec3(position_clip) / position_clip.w;
    return {(position_ndc.x + 1) * 0.5f * static_cast<float>(size.x),
            (1 - position_ndc.y) * 0.5f * static_cast<float>(size.y), position_ndc.z};
}

}  // namespace rasterbook
