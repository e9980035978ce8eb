// SPDX-License-Identifier: MIT
/// @file
/// The matrices that take a point from model space to the screen. Introduced in lesson 04;
/// derivation: docs/derivations/04_mvp.md.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>

#include "common/math/numerics.hpp"
#include "common/math/types.hpp"

namespace rasterbook {

/// Translation by t (Eq. 4.3).
///
///     1  0  0  t.x
///     0  1  0  t.y
///     0  0  1  t.z
///     0  0  0  1
template <std::floating_point T>
constexpr glm::mat<4, 4, T> translation(glm::vec<3, T> t) {
    // TODO, step 1: Eq. 4.3. matrix_from_rows<T>() of types.hpp takes the rows, as on paper.
    return glm::mat<4, 4, T>(1);
}

/// Scaling along the axes by the factors s (Eq. 4.3); negative ones mirror.
template <std::floating_point T>
constexpr glm::mat<4, 4, T> scaling(glm::vec<3, T> s) {
    // TODO, step 1: Eq. 4.3.
    return glm::mat<4, 4, T>(1);
}

/// Rotation around the x axis, y towards z (Eq. 4.2).
///
///     1  0   0  0
///     0  c  -s  0
///     0  s   c  0
///     0  0   0  1
template <std::floating_point T>
glm::mat<4, 4, T> rotation_x(T angle_radians) {
    // TODO, step 1: Eq. 4.2.
    return glm::mat<4, 4, T>(1);
}

/// Rotation around the y axis, z towards x (Eq. 4.2).
///
///      c  0  s  0
///      0  1  0  0
///     -s  0  c  0
///      0  0  0  1
template <std::floating_point T>
glm::mat<4, 4, T> rotation_y(T angle_radians) {
    // TODO, step 1: Eq. 4.2.
    return glm::mat<4, 4, T>(1);
}

/// Rotation around the z axis, x towards y (Eq. 4.1).
///
///     c  -s  0  0
///     s   c  0  0
///     0   0  1  0
///     0   0  0  1
template <std::floating_point T>
glm::mat<4, 4, T> rotation_z(T angle_radians) {
    // TODO, step 1: Eq. 4.1.
    return glm::mat<4, 4, T>(1);
}

/// The view matrix: the eye becomes the origin, and what it looks at lies on -z (Eq. 4.5).
///
/// @param eye,center  World space. If they are the same point, the camera looks along -z.
/// @param up          What shall point up in the picture, of any length. If it is zero or not
///                    finite, or the sine of its angle with the view is at most 64 eps, the axis
///                    that is least parallel to the view takes its place; of equals, y first, then
///                    x. (eps is std::numeric_limits<T>::epsilon().)
/// @return            view_from_world: its upper 3x3 part is a rotation within 4 eps.
template <std::floating_point T>
glm::mat<4, 4, T> look_at(glm::vec<3, T> eye, glm::vec<3, T> center, glm::vec<3, T> up) {
    // TODO, step 2: Eq. 4.5, with normalize_or() and cross_product() of numerics.hpp, which keep
    // the 4 eps. Back is (0, 0, 1) if it has no direction. Scale up to length 1 first: then the
    // length of up x back is the sine. The axis least parallel to back is the one along which
    // back's coordinate is smallest in size.
    return glm::mat<4, 4, T>(1);
}

/// The projection matrix of a perspective, from view space to clip space (Eq. 4.7 and 4.8). After
/// the division by w, the depth is near / distance.
///
///     f/aspect  0   0  0
///     0         f   0  0         f = 1 / tan(fov_y / 2)
///     0         0   0  near
///     0         0  -1  0
///
/// @param fov_y_radians  The angle from the lower to the upper border, in (0, pi).
/// @param aspect         Width divided by height, > 0.
/// @param near           Distance of the near plane, > 0. There is no far plane.
/// @return               Each element with a relative error of at most 2 eps.
template <std::floating_point T>
glm::mat<4, 4, T> perspective(T fov_y_radians, T aspect, T near) {
    // TODO, step 2: Eq. 4.7 and 4.8.
    return glm::mat<4, 4, T>(1);
}

/// From normalised device coordinates to the screen, in pixels (Eq. 4.9). The depth stays.
///
///     W/2   0    0    W/2
///     0    -H/2  0    H/2
///     0     0    1    0
///     0     0    0    1
///
/// @param size  Of the picture: W, H.
template <std::floating_point T>
constexpr glm::mat<4, 4, T> viewport(ivec2 size) {
    // TODO, step 2: Eq. 4.9.
    return glm::mat<4, 4, T>(1);
}

/// The normal matrix: what normals are multiplied by where points are multiplied by `m`. It is the
/// matrix of cofactors (Eq. 4.15), and there is one also where m is singular.
///
/// @param m  Model space to world space, its upper left part. Finite; products of two elements
///           neither overflow nor underflow.
/// @return   Takes u x v to mu x mv, so where m mirrors, a normal that points out of a body points
///           into it. The length of a normal is lost. Each element is within 1.5 ulp.
template <std::floating_point T>
glm::mat<3, 3, T> normal_matrix(const glm::mat<3, 3, T>& m) {
    // TODO, step 1: Eq. 4.15, with cross_product() of numerics.hpp, which keeps the 1.5 ulp.
    return glm::mat<3, 3, T>(1);
}

/// Points multiplied by `m`, as homogeneous coordinates.
inline std::vector<vec4> transform(const mat4& m, const std::vector<vec3>& points) {
    // TODO, step 1: m times (x, y, z, 1) for each point (Eq. 4.4).
    return std::vector<vec4>(points.size(), vec4(0, 0, 0, 1));
}

}  // namespace rasterbook
