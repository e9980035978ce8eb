// SPDX-License-Identifier: MIT
// Numbers from 10^-8 to 10^8 against long double, or against exact values; the turns, look_at and
// perspective are compared with GLM in 04_mvp_test.cpp.
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "04_mvp/transform.hpp"
#include "support/any_size.hpp"
#include "support/printers.hpp"
#include "support/reference.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// What the row of a matrix makes of a point.
Sum row_times_point(const mat4& m, int row, vec3 point) {
    Sum sum;
    for (int column = 0; column < 3; ++column) sum.add(real{m[column][row]} * point[column]);
    sum.add(m[3][row]);
    return sum;
}

/// A product and at most three sums.
constexpr real of_four_terms = 4 * eps / 2;

mat4 any_matrix(AnySize& any) {
    mat4 m;
    for (int column = 0; column < 4; ++column) m[column] = any.homogeneous();
    return m;
}

Bounds any_box(AnySize& any) {
    Bounds box;
    const vec3 place = any.vector();
    box.add(place), box.add(place + any.vector());
    return box;
}

}  // namespace

TEST(Mvp, Eq4_4_VerticesOfAllSizesThroughMatricesOfAllSizes) {
    AnySize any(1, decades);
    for (int i = 0; i < cases / 4; ++i) {
        const mat4 m = any_matrix(any);
        const std::vector<vec3> points = {any.vector(), any.vector(), any.vector(), any.vector()};
        const std::vector<vec4> transformed = transform(m, points);
        ASSERT_EQ(transformed.size(), points.size());
        for (std::size_t k = 0; k < points.size(); ++k)
            for (int row = 0; row < 4; ++row) {
                const Sum exact = row_times_point(m, row, points[k]);
                ASSERT_TRUE(
                    is_near(transformed[k][row], exact.value, of_four_terms * exact.of_sizes))
                    << "row " << row + 1 << " of the matrix times "
                    << testing::PrintToString(points[k]) << "; " << testing::PrintToString(m)
                    << "; seed 1, case " << i;
            }
    }
}

TEST(Mvp, Eq4_8_ViewsOfAllSizesThenPerspective) {
    AnySize any(2, decades);
    for (int i = 0; i < cases; ++i) {
        const float near_ = any.positive();
        const real fov = any.whole(1, 179) * std::numbers::pi_v<real> / 180;
        const Camera camera = {any.vector(), any_matrix(any), static_cast<float>(fov), near_};
        const ivec2 size(any.whole(1, 16384), any.whole(1, 16384));
        const mat4 actual = camera.clip_from_world(size);

        const real f = 1 / std::tan(real{camera.fov_y_radians} / 2);
        const real of_x = f * size.y / size.x;
        // An ulp of the tangent and a division; for x, two of the aspect more.
        const real of_f = 1.5L * eps, of_fx = 2.5L * eps;
        for (int column = 0; column < 4; ++column) {
            const vec4 view = camera.view_from_world[column];
            // GLM adds up four products, of which three or two are 0 here.
            const real x = of_x * view.x, y = f * view.y;
            ASSERT_TRUE(is_near(actual[column][0], x, (of_fx + eps / 2) * std::abs(x)))
                << "seed 2, case " << i;
            ASSERT_TRUE(is_near(actual[column][1], y, (of_f + eps / 2) * std::abs(y)))
                << "seed 2, case " << i;
            ASSERT_EQ(actual[column][2], near_ * view.w) << "seed 2, case " << i;
            ASSERT_EQ(actual[column][3], -view.z) << "seed 2, case " << i;
        }
    }
}

TEST(Mvp, Eq4_6_OrbitsOfAllSizes) {
    AnySize any(3, decades);
    int turned = 0;
    for (int i = 0; i < cases; ++i) {
        const Bounds box = any_box(any);
        Orbit orbit;
        orbit.yaw_degrees = any.number();
        orbit.pitch_degrees = 0.01f * static_cast<float>(any.whole(-9000, 9000));
        orbit.distance = any.positive();
        orbit.fov_degrees = 0.1f * static_cast<float>(any.whole(10, 1700));
        const Camera camera = orbit_camera(orbit, box);

        const lvec3 center = (lvec3(box.min) + lvec3(box.max)) / real{2};
        const real diagonal = glm::length(lvec3(box.max) - lvec3(box.min));
        const real radius = diagonal > 0 ? diagonal / 2 : 1;  // as documented
        const real distance = orbit.distance * radius;
        const real degree = std::numbers::pi_v<real> / 180;
        const real yaw = orbit.yaw_degrees * degree, pitch = orbit.pitch_degrees * degree;
        const auto around = [yaw](real height) {
            return lvec3(std::cos(height) * std::sin(yaw), std::sin(height),
                         std::cos(height) * std::cos(yaw));
        };

        // Half an eps: of the center, of each of its coordinates; of the radius, which is double
        // before; of the distance.
        const real of_center = eps / 2 * glm::length(center), of_radius = 0.51L * eps * radius;
        const real of_distance = orbit.distance * of_radius + eps / 2 * distance;
        // A degree in float and the product with it, half an eps each; for up, pitch and a right
        // angle are added, which is off by an eps, and the sum by half an eps of at most pi.
        // Then two functions within 1 ulp and a product.
        const real of_angles = eps * (std::abs(yaw) + std::abs(pitch));
        const real of_direction = of_angles + 2.5L * eps;
        const real of_up = of_angles + eps * (1.6L + 1.6L) + 2.5L * eps;
        const lvec3 eye = center + distance * around(pitch);
        const real of_eye = of_center + of_distance + (distance + of_distance) * of_direction +
                            eps / 2 * (distance + of_distance + glm::length(eye) + of_center);
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_TRUE(is_near(camera.center_world[axis], center[axis], of_center))
                << "seed 3, case " << i;
            ASSERT_TRUE(is_near(camera.position_world[axis], eye[axis], of_eye * 1.001L))
                << "seed 3, case " << i;
        }
        ASSERT_TRUE(is_near(camera.fov_y_radians, orbit.fov_degrees * degree,
                            eps * orbit.fov_degrees * degree));

        // 0.999 or 0.001 in float, the sum or difference and the product: three halves of an eps.
        const real near_ = std::max(0.999L * (distance - radius), 0.001L * (distance + radius));
        const real of_sum = of_distance + of_radius;
        ASSERT_TRUE(is_near(camera.near, near_, of_sum + 1.51L * eps * (near_ + of_sum)))
            << "seed 3, case " << i;

        // The view goes back from center to eye, both as they are in float.
        const real of_back = (of_eye + of_center) / distance + 2 * eps;
        if (of_back + of_up > 0.01L) continue;  // far from the origin nothing is left of a turn
        ++turned;
        const lvec3 right(std::cos(yaw), 0, -std::sin(yaw));
        const std::array<lvec3, 3> axes = {right, around(pitch + 90 * degree), around(pitch)};
        // As in Eq4_5_RandomCamerasEqualGlm with a sine near 1; twice, for what is of second order.
        const real of_axes = 1.03L * (2 * (of_back + of_up) + 6 * eps);
        for (int row = 0; row < 3; ++row) {
            const lvec3 exact = axes[static_cast<std::size_t>(row)];
            for (int axis = 0; axis < 3; ++axis)
                ASSERT_TRUE(is_near(camera.view_from_world[axis][row], exact[axis], of_axes))
                    << "seed 3, case " << i << ", row " << row;
            ASSERT_TRUE(is_near(camera.view_from_world[3][row], -glm::dot(exact, eye),
                                (of_axes + 2 * eps) * (glm::length(eye) + of_eye) + of_eye))
                << "seed 3, case " << i << ", row " << row;
        }
    }
    EXPECT_GT(turned, cases / 4);
}

TEST(Mvp, Eq4_9_ViewportsOfAllSizesAreExact) {
    AnySize any(4, decades);
    for (int i = 0; i < cases; ++i) {
        const ivec2 size(std::lround(any.positive()), std::lround(any.positive()));
        const mat4 m = viewport<float>(size);
        const real w = size.x / real{2}, h = size.y / real{2};
        const real rows[4][4] = {{w, 0, 0, w}, {0, -h, 0, h}, {0, 0, 1, 0}, {0, 0, 0, 1}};
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column) {
                // Above 2^24 a float does not hold every whole number.
                const bool is_held = std::abs(rows[row][column]) <= 0x1p23L;
                ASSERT_TRUE(is_near(m[column][row], rows[row][column],
                                    is_held ? 0 : eps / 2 * std::abs(rows[row][column])))
                    << "seed 4, case " << i << ", row " << row << ", column " << column;
            }
    }
}

TEST(Mvp, Eq4_9_ScreenOfPointsOfAllSizes) {
    AnySize any(5, decades);
    for (int i = 0; i < cases; ++i) {
        const float w = any.positive();
        // From the middle of NDC to its sides, and from its sides to the middle.
        const auto inside = [&] {
            const float share = std::min(any.positive(), 1.0f), x = any.number() < 0 ? -w : w;
            return i % 2 ? share * x : x - share * x;
        };
        const vec4 clip(inside(), inside(), std::abs(inside()), w);
        const ivec2 size(any.whole(1, 16384), any.whole(1, 16384));
        const vec3 screen = screen_from_clip(clip, size);
        ASSERT_EQ(screen.z, clip.z / w) << "seed 5, case " << i;
        for (int axis = 0; axis < 2; ++axis) {
            const real ndc = (axis == 1 ? -1 : 1) * real{clip[axis]} / w;
            const real half = size[axis] / real{2};
            // The quotient, the sum, and the product with the size, half an eps each.
            const real tolerance = half * (eps / 2 * std::abs(ndc) + eps * (1 + ndc + eps));
            ASSERT_TRUE(is_near(screen[axis], half * (1 + ndc), tolerance))
                << "seed 5, case " << i << ", axis " << axis;
            ASSERT_GE(screen[axis], 0) << "seed 5, case " << i;
            ASSERT_LE(screen[axis], 2 * half) << "seed 5, case " << i;
        }
    }
}

TEST(Mvp, Eq4_15_NormalMatricesOfAllSizes) {
    AnySize any(6, decades);
    for (int i = 0; i < cases; ++i) {
        mat3 m(any.vector(), any.vector(), any.vector());
        if (i % 2) m[1] = any.positive() * m[0] + 1e-6f * any.vector();  // nearly parallel
        const mat3 actual = normal_matrix(m);
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row) {
                // The minor without that column and row, its sign by going around.
                const int c1 = (column + 1) % 3, c2 = (column + 2) % 3;
                const int r1 = (row + 1) % 3, r2 = (row + 2) % 3;
                const real exact = real{m[c1][r1]} * m[c2][r2] - real{m[c1][r2]} * m[c2][r1];
                // 1.5 ulp, as documented. The products are exact in long double.
                ASSERT_TRUE(is_near(actual[column][row], exact, 1.5L * eps * std::abs(exact)))
                    << "seed 6, case " << i << ", row " << row << ", column " << column;
            }
    }
}
