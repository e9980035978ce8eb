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
    return matrix_from_rows<T>({1, 0, 0, t.x}, {0, 1, 0, t.y}, {0, 0, 1, t.z}, {0, 0, 0, 1});
}

/// Scaling along the axes by the factors s (Eq. 4.3); negative ones mirror.
template <std::floating_point T>
constexpr glm::mat<4, 4, T> scaling(glm::vec<3, T> s) {
    return matrix_from_rows<T>({s.x, 0, 0, 0}, {0, s.y, 0, 0}, {0, 0, s.z, 0}, {0, 0, 0, 1});
}

/// Rotation around the x axis, y towards z (Eq. 4.2).
///
///     1  0   0  0
///     0  c  -s  0
///     0  s   c  0
///     0  0   0  1
template <std::floating_point T>
glm::mat<4, 4, T> rotation_x(T angle_radians) {
    const T c = std::cos(angle_radians), s = std::sin(angle_radians);
    return matrix_from_rows<T>({1, 0, 0, 0}, {0, c, -s, 0}, {0, s, c, 0}, {0, 0, 0, 1});
}

/// Rotation around the y axis, z towards x (Eq. 4.2).
///
///      c  0  s  0
///      0  1  0  0
///     -s  0  c  0
///      0  0  0  1
template <std::floating_point T>
glm::mat<4, 4, T> rotation_y(T angle_radians) {
    const T c = std::cos(angle_radians), s = std::sin(angle_radians);
    return matrix_from_rows<T>({c, 0, s, 0}, {0, 1, 0, 0}, {-s, 0, c, 0}, {0, 0, 0, 1});
}

/// Rotation around the z axis, x towards y (Eq. 4.1).
///
///     c  -s  0  0
///     s   c  0  0
///     0   0  1  0
///     0   0  0  1
template <std::floating_point T>
glm::mat<4, 4, T> rotation_z(T angle_radians) {
    const T c = std::cos(angle_radians), s = std::sin(angle_radians);
    return matrix_from_rows<T>({c, -s, 0, 0}, {s, c, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1});
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
    using Vector = glm::vec<3, T>;
    const Vector back = normalize_or(eye - center, Vector(0, 0, 1));
    const Vector size = glm::abs(back);
    const Vector other_up = size.y <= size.x && size.y <= size.z ? Vector(0, 1, 0)
                            : size.x <= size.z                   ? Vector(1, 0, 0)
                                                                 : Vector(0, 0, 1);
    const Vector unit_up = normalize_or(up, other_up);
    Vector right = cross_product(unit_up, back);
    // Nearly parallel: what is left of the product is rounding.
    constexpr T least_sine = T(64) * std::numeric_limits<T>::epsilon();
    if (!(glm::dot(right, right) > least_sine * least_sine)) right = cross_product(other_up, back);
    right = normalize_or(right, Vector(1, 0, 0));
    const Vector new_up = cross_product(back, right);
    const auto row = [&](Vector axis) { return glm::vec<4, T>(axis, -glm::dot(axis, eye)); };
    return matrix_from_rows<T>(row(right), row(new_up), row(back), {0, 0, 0, 1});
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
    // In double, as the last bit of a tangent in float is not the same on all processors.
    const T f = 1 / static_cast<T>(std::tan(double{fov_y_radians} / 2));
    return matrix_from_rows<T>({f / aspect, 0, 0, 0}, {0, f, 0, 0}, {0, 0, 0, near}, {0, 0, -1, 0});
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
    const T w = static_cast<T>(size.x) / 2, h = static_cast<T>(size.y) / 2;
    return matrix_from_rows<T>({w, 0, 0, w}, {0, -h, 0, h}, {0, 0, 1, 0}, {0, 0, 0, 1});
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
    return {cross_product(m[1], m[2]), cross_product(m[2], m[0]), cross_product(m[0], m[1])};
}

/// Points multiplied by `m`, as homogeneous coordinates.
inline std::vector<vec4> transform(const mat4& m, const std::vector<vec3>& points) {
    std::vector<vec4> transformed;
    transformed.reserve(points.size());
    for (const vec3 point : points) transformed.push_back(m * vec4(point, 1));
    return transformed;
}

}  // namespace rasterbook
