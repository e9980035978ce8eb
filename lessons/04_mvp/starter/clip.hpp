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
    // TODO, step 3: Eq. 4.10.
    return 0;
}

/// Where the side from a to b crosses a plane (Eq. 4.11 and 4.12).
///
/// The side from b to a crosses it in the same point, bit for bit: triangles that share a side
/// still share it when both are cut.
///
/// @param a_by,b_by  The plane_distance of each; one of them is negative.
inline ClippedVertex crossing(const ClippedVertex& a, float a_by, const ClippedVertex& b,
                              float b_by) {
    // TODO, step 3: Eq. 4.12, each share by a division of its own: with 1 minus the other, the two
    // ways would differ.
    return a;
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
    // TODO, step 3: nothing is left, if a coordinate is NaN or not below clip_limit in size. Then
    // the two tests before the cuts: a triangle that is all inside stays as it is. Then Eq. 4.13,
    // plane by plane. After the last plane, clamped_to_frustum() for each vertex, and the fan.
    return {};
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
    // TODO, step 3: Eq. 4.10 and 4.14.
    return false;
}

/// A point on the screen in pixels, and its depth, 0 to 1 (Eq. 4.9, after the division by w).
///
/// @param position_clip  Inside the frustum, w > 0. A w of 0 gives NaN, which snap_triangle
///                       refuses.
inline vec3 screen_from_clip(vec4 position_clip, ivec2 size) {
    // TODO, step 2: divide by w; then Eq. 4.9 written out; viewport() would round differently.
    return vec3(0);
}

}  // namespace rasterbook
