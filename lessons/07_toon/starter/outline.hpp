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
    // TODO: Eq. 7.8: with face_normal and vertex_angle_radians of lesson 06, sum over the faces
    // around each index, in the order of the mesh. Then add up the sums of equal positions, in the
    // order of their indices, and scale to length 1, with unit_or(sum, vec3(0)). To find equal
    // positions, sort the indices by the bits of position + 0.0f (std::bit_cast): so -0 equals 0,
    // and NaN has its place, too.
    return std::vector<vec3>(mesh.positions.size(), vec3(0));
}

/// A vertex pushed on the screen by `width_px` pixels, in the direction in which it moves there
/// when it moves along its normal (Eq. 7.9). Its depth and its w stay.
///
/// @param normal_clip  clip_from_world * vec4(normal, 0). A normal that points straight to the
///                     eye or away from it has no direction on the screen: the vertex stays.
inline vec4 pushed(vec4 position_clip, vec4 normal_clip, float width_px, ivec2 size) {
    // TODO: Eq. 7.9. unit_or(vec3(M, 0), vec3(0)) scales M to length 1. Where M is 0 it gives 0:
    // the vertex stays.
    return position_clip;
}

/// Whether a face shows the eye its back (Eq. 7.10). In double, where products do not overflow.
inline bool is_seen_from_behind(const Mesh& mesh, const Triangle& triangle, vec3 eye_world) {
    // TODO: Eq. 7.10.
    return false;
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
    // TODO: transform the positions, push each one, and then for each triangle, as in lesson 04's
    // for_each_visible_triangle: clip_triangle, project. Give the projected triangle's on_screen to
    // fill_triangle, and for each pixel its depth.at(barycentrics) to depth.test_and_write. But
    // only faces that are seen from behind (asked of the mesh as it was) are drawn. Do not ask
    // project's is_back_facing: on the screen they are clockwise; nor is_outside_frustum: of a body
    // just outside of the picture, the rim may reach into it. What passes the depth test is ink.
    // Count Counter::outline_tests for each depth test and Counter::outline_pixels for each pixel
    // inked, and nothing else.
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
inline float inverse_w(float depth, const Camera& camera) {
    // TODO: Eq. 7.11, in float.
    return 0;
}

/// The second difference along x or y; the rows beside count half (Eq. 7.12). It is 0 for a plane,
/// however steep; the first difference would grow with the slope.
///
/// @param at     Called as at(ivec2 offset), each component -1, 0 or 1.
/// @param along  (1, 0) or (0, 1).
template <typename At>
float second_difference(At&& at, ivec2 along) {
    // TODO: Eq. 7.12, in float.
    return 0;
}

/// Sobel's first difference along x or y; the rows beside count half (Eq. 7.13). At an edge between
/// two values it is their difference.
///
/// @param at,along  As for second_difference().
template <typename At>
vec3 sobel(At&& at, ivec2 along) {
    // TODO: Eq. 7.13.
    return vec3(0);
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
    // TODO: for each pixel Eq. 7.14, of the numbers in depth.depths(), with the neighbours `reach`
    // = width_px / 2, rounded up, pixels away; at the picture's border all of it, also the
    // threshold, for the nearest pixel that has neighbours on all sides. Take the root for depth
    // with std::hypot: a square may vanish or overflow. Count Counter::outline_tests for each pixel
    // (also if `reach` is 0) and Counter::outline_pixels for each one inked. In a picture of at
    // most twice `reach` pixels in width or height, do nothing and count nothing.
}

}  // namespace rasterbook
