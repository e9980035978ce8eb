// SPDX-License-Identifier: MIT
// The matrices and the camera; what is clipped and culled: 04_mvp_clip_test.cpp; numbers of all
// sizes against a reference, where not here: 04_mvp_math_test.cpp.
#include "04_mvp/transform.hpp"

#include <cfloat>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "support/any_size.hpp"
#include "support/look_up.hpp"
#include "support/printers.hpp"
#include "support/special_numbers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

using lmat3 = glm::mat<3, 3, long double>;
using lvec3 = glm::vec<3, long double>;

constexpr float quarter_turn = std::numbers::pi_v<float> / 2;

/// For EXPECT_TRUE: every element is as near to the exact one as `tolerance` says of it.
template <int n, typename T>
testing::AssertionResult near(const glm::mat<n, n, T>& actual, const glm::mat<n, n, double>& exact,
                              const std::function<double(int row, int column)>& tolerance) {
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column)
            if (!(std::abs(actual[column][row] - exact[column][row]) <= tolerance(row, column)))
                return testing::AssertionFailure()
                       << "row " << row + 1 << ", column " << column + 1 << " of the matrix is "
                       << test::text_of(actual[column][row]) << ", expected "
                       << test::text_of(exact[column][row]) << ", off by "
                       << std::abs(actual[column][row] - exact[column][row]) /
                              tolerance(row, column)
                       << " times what it may be; all of it: " << testing::PrintToString(actual);
    return testing::AssertionSuccess();
}

/// For EXPECT_TRUE: finite; above, a rotation within 4 eps; the last row as it should be.
testing::AssertionResult is_rigid(const mat4& m) {
    constexpr long double tolerance = 4 * FLT_EPSILON;  // as look_at promises
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(m[column][row]))
                return testing::AssertionFailure() << "not finite: " << testing::PrintToString(m);
    const lmat3 r{mat3(m)};
    const lmat3 product = r * glm::transpose(r);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (const long double error = product[column][row] - (column == row);
                !(std::abs(error) <= tolerance))
                return testing::AssertionFailure()
                       << "rows " << row + 1 << " and " << column + 1
                       << (row == column ? ": no unit vector, by " : ": no right angle, by ")
                       << error << "; " << testing::PrintToString(m);
    if (!(std::abs(glm::determinant(r) - 1) <= 2 * tolerance))  // half of the three rows' errors
        return testing::AssertionFailure() << "determinant " << glm::determinant(r)
                                           << " instead of 1: " << testing::PrintToString(m);
    if (glm::transpose(m)[3] != vec4(0, 0, 0, 1))
        return testing::AssertionFailure()
               << "the last row is not (0, 0, 0, 1): " << testing::PrintToString(m);
    return testing::AssertionSuccess();
}

/// For EXPECT_TRUE: what the camera looks at lies before it, in the middle.
testing::AssertionResult sees_in_the_middle(const mat4& view, vec3 eye, vec3 center) {
    const dvec3 seen(dmat4(view) * dvec4(center, 1));
    const double distance = glm::length(dvec3(eye) - dvec3(center));
    // The rotation is within 4 eps, and so is the product with the eye in the last column.
    const double tolerance =
        8 * double{FLT_EPSILON} * (glm::length(dvec3(eye)) + glm::length(dvec3(center)));
    if (glm::length(seen - dvec3(0, 0, -distance)) <= 2 * tolerance)
        return testing::AssertionSuccess();
    return testing::AssertionFailure() << "the center is seen at " << testing::PrintToString(seen)
                                       << ", expected (0, 0, " << -distance << ")";
}

/// For EXPECT_TRUE: each coordinate is within the tolerance.
testing::AssertionResult is_point(vec3 actual, vec3 expected, float tolerance) {
    for (int i = 0; i < 3; ++i)
        if (!(std::abs(actual[i] - expected[i]) <= tolerance))
            return testing::AssertionFailure() << testing::PrintToString(actual) << ", expected "
                                               << testing::PrintToString(expected);
    return testing::AssertionSuccess();
}

std::string of_view(vec3 eye, vec3 center, vec3 up) {
    return "eye " + testing::PrintToString(eye) + ", center " + testing::PrintToString(center) +
           ", up " + testing::PrintToString(up);
}

vec3 moved(const mat4& m, vec3 point) { return vec3(m * vec4(point, 1)); }

constexpr float turn_tolerance = FLT_EPSILON;  // the cosine of pi/2 in float is -4e-8

/// For EXPECT_TRUE: sines and cosines in float are within 1 ulp, which is at most eps of each.
testing::AssertionResult is_turn(const mat4& actual, float angle_radians, dvec3 axis) {
    const dmat4 exact = glm::rotate(dmat4(1), double{angle_radians}, axis);
    return near<4>(actual, exact, [&](int row, int column) {
        return double{FLT_EPSILON} * std::abs(exact[column][row]);
    });
}

}  // namespace

TEST(Mvp, Eq4_1_QuarterTurnAroundZTakesXToY) {
    const mat4 turn = rotation_z(quarter_turn);
    EXPECT_TRUE(is_point(moved(turn, {1, 0, 0}), {0, 1, 0}, turn_tolerance)) << "of (1, 0, 0)";
    EXPECT_TRUE(is_point(moved(turn, {0, 1, 0}), {-1, 0, 0}, turn_tolerance)) << "of (0, 1, 0)";
    EXPECT_EQ(moved(turn, {0, 0, 7}), vec3(0, 0, 7));
}

TEST(Mvp, Eq4_1_RandomAnglesEqualGlm) {
    AnySize any(1, 8);
    for (int i = 0; i < cases; ++i) {
        const float angle = any.number();
        ASSERT_TRUE(is_turn(rotation_z(angle), angle, {0, 0, 1}))
            << "around z by " << angle << "; seed 1, case " << i;
    }
}

TEST(Mvp, Eq4_2_QuarterTurnsAroundXAndY) {
    const mat4 around_x = rotation_x(quarter_turn), around_y = rotation_y(quarter_turn);
    EXPECT_TRUE(is_point(moved(around_x, {0, 1, 0}), {0, 0, 1}, turn_tolerance))
        << "(0, 1, 0) a quarter turn around x";
    EXPECT_TRUE(is_point(moved(around_x, {0, 0, 1}), {0, -1, 0}, turn_tolerance))
        << "(0, 0, 1) a quarter turn around x";
    EXPECT_EQ(moved(around_x, {7, 0, 0}), vec3(7, 0, 0));
    EXPECT_TRUE(is_point(moved(around_y, {0, 0, 1}), {1, 0, 0}, turn_tolerance))
        << "(0, 0, 1) a quarter turn around y";
    EXPECT_TRUE(is_point(moved(around_y, {1, 0, 0}), {0, 0, -1}, turn_tolerance))
        << "(1, 0, 0) a quarter turn around y";
    EXPECT_EQ(moved(around_y, {0, 7, 0}), vec3(0, 7, 0));
}

TEST(Mvp, Eq4_2_RandomAnglesEqualGlm) {
    AnySize any(2, 8);
    for (int i = 0; i < cases; ++i) {
        const float angle = any.number();
        ASSERT_TRUE(is_turn(rotation_x(angle), angle, {1, 0, 0}))
            << "around x by " << angle << "; seed 2, case " << i;
        ASSERT_TRUE(is_turn(rotation_y(angle), angle, {0, 1, 0}))
            << "around y by " << angle << "; seed 2, case " << i;
    }
}

TEST(Mvp, Eq4_3_APointIsMovedAndStretched) {
    EXPECT_EQ(moved(translation(vec3(1, 2, 3)), {5, 6, 7}), vec3(6, 8, 10));
    EXPECT_EQ(moved(scaling(vec3(1, 2, 3)), {5, 6, 7}), vec3(5, 12, 21));
    EXPECT_EQ(translation(vec3(1, 2, 3)) * vec4(5, 5, 5, 0), vec4(5, 5, 5, 0))
        << "a direction is not moved";
}

TEST(Mvp, Eq4_3_EqualsGlmBitForBit) {
    AnySize any(3, 30);
    for (int i = 0; i < cases; ++i) {
        const vec3 v = any.vector();
        ASSERT_EQ(translation(v), glm::translate(mat4(1), v)) << "seed 3, case " << i;
        ASSERT_EQ(scaling(v), glm::scale(mat4(1), v)) << "seed 3, case " << i;
    }
}

TEST(Mvp, Eq4_4_TheRightOneActsFirst) {
    const mat4 move = translation(vec3(1, 2, 3)), stretch = scaling(vec3(2));
    EXPECT_EQ(moved(move * stretch, vec3(1)), vec3(3, 4, 5)) << "stretched, then moved";
    EXPECT_EQ(moved(stretch * move, vec3(1)), vec3(4, 6, 8)) << "moved, then stretched";
}

TEST(Mvp, Eq4_4_TransformedPointsAreTheMatrixTimesThem) {
    const std::vector<vec4> transformed =
        transform(translation(vec3(1, 2, 3)) * scaling(vec3(2)), {{1, 1, 1}, {0, 0, 0}});
    EXPECT_EQ(transformed, (std::vector<vec4>{{3, 4, 5, 1}, {1, 2, 3, 1}}));
    EXPECT_TRUE(transform(mat4(1), {}).empty());
}

TEST(Mvp, Eq4_5_LooksAtTheCenterAlongMinusZ) {
    const vec3 up(0, 1, 0);
    const mat4 from_the_front = look_at(vec3(0, 0, 5), vec3(0), up);
    EXPECT_EQ(moved(from_the_front, vec3(0, 0, 5)), vec3(0)) << "the eye is the origin";
    EXPECT_EQ(moved(from_the_front, vec3(0)), vec3(0, 0, -5))
        << "the center lies on -z, 5 away: from (0, 0, 5) it is seen there";
    EXPECT_EQ(moved(from_the_front, vec3(1, 2, 0)), vec3(1, 2, -5))
        << "from there x is to the right, y up";
    const mat4 from_the_right = look_at(vec3(5, 0, 0), vec3(0), up);
    EXPECT_EQ(moved(from_the_right, vec3(0)), vec3(0, 0, -5)) << "the center from (5, 0, 0)";
    EXPECT_EQ(from_the_right * vec4(0, 0, -1, 0), vec4(1, 0, 0, 0))
        << "what lies to the north is on the right of who looks west";
    EXPECT_EQ(from_the_right * vec4(0, 1, 0, 0), vec4(0, 1, 0, 0));
}

TEST(Mvp, Eq4_5_RandomCamerasEqualGlm) {
    AnySize any(4, 8);
    int replaced = 0;
    for (int i = 0; i < cases; ++i) {
        const vec3 eye = any.vector(), center = any.vector();
        const vec3 up = i % 4 ? any.vector() : (eye - center) + any.positive() * any.vector();
        const dvec3 back = glm::normalize(dvec3(eye) - dvec3(center)), size = glm::abs(back);
        double sine = glm::length(glm::cross(glm::normalize(dvec3(up)), back));
        dvec3 up_used = up;
        // The difference of eye and center rounds by half an eps, and so do the two unit vectors.
        // Their product has the errors of both, and 1.5 ulp of its own.
        const double of_product = 1.5 * double{FLT_EPSILON};
        if (std::abs(sine - 64 * FLT_EPSILON) <= 2 * of_product) continue;  // either way
        if (sine < 64 * FLT_EPSILON) {
            const double least = std::min({size.x, size.y, size.z});
            up_used = dvec3(size.x == least, size.y == least, size.z == least);
            const double second =
                size.x + size.y + size.z - least - std::max({size.x, size.y, size.z});
            if (second - least <= 4 * double{FLT_EPSILON} * second) continue;  // either of the two
            sine = glm::length(glm::cross(up_used, back));
            ++replaced;
        }
        // Scaled to 1, right is off by the error of the product, divided by its length, by that
        // of the product's own rounding and by half an eps. New up has the errors of right and
        // back and another 1.5 ulp. What is of second order is below 3 %, since the sine is above
        // 64 eps. The last column is a dot product with the eye: three roundings more.
        const double of_axes = 1.03 * (of_product / sine + 4.5 * double{FLT_EPSILON});
        ASSERT_TRUE(near<4>(
            look_at(eye, center, up), glm::lookAtRH(dvec3(eye), dvec3(center), up_used),
            [&](int, int column) {
                return column == 3 ? (of_axes + 1.5 * double{FLT_EPSILON}) * glm::length(dvec3(eye))
                                   : of_axes;
            }))
            << of_view(eye, center, up) << ", seed 4, case " << i;
        ASSERT_TRUE(is_rigid(look_at(eye, center, up)))
            << of_view(eye, center, up) << ", seed 4, case " << i;
    }
    EXPECT_GT(replaced, cases / 100);
}

TEST(Mvp, Eq4_6_DirectionsOfTheWorkedExample) {
    const auto direction = [](float yaw_degrees, float pitch_degrees) {
        return direction_from_angles(glm::radians(yaw_degrees), glm::radians(pitch_degrees));
    };
    EXPECT_EQ(direction(0, 0), vec3(0, 0, 1)) << "yaw 0, pitch 0";
    EXPECT_TRUE(is_point(direction(90, 0), {1, 0, 0}, turn_tolerance)) << "yaw 90 degrees, pitch 0";
    EXPECT_TRUE(is_point(direction(180, 0), {0, 0, -1}, turn_tolerance))
        << "yaw 180 degrees, pitch 0";
    EXPECT_TRUE(is_point(direction(0, 30), {0, 0.5f, std::sqrt(0.75f)}, turn_tolerance))
        << "yaw 0, pitch 30 degrees";
    for (const float yaw : {-300.0f, 0.0f, 17.0f, 90.0f}) {
        ASSERT_TRUE(is_point(direction(yaw, 90), {0, 1, 0}, turn_tolerance))
            << "yaw " << yaw << " degrees, pitch 90";
        ASSERT_TRUE(is_point(direction(yaw, -90), {0, -1, 0}, turn_tolerance))
            << "yaw " << yaw << " degrees, pitch -90";
    }
}

TEST(Mvp, Eq4_6_EqualsTwoTurnsOfTheZAxis) {
    AnySize any(5, 8);
    for (int i = 0; i < cases; ++i) {
        const float yaw = any.number(), pitch = any.number();
        const dmat4 around_y = glm::rotate(dmat4(1), double{yaw}, dvec3(0, 1, 0));
        const dvec4 turned =
            glm::rotate(around_y, -double{pitch}, dvec3(1, 0, 0)) * dvec4(0, 0, 1, 0);
        const vec3 direction = direction_from_angles(yaw, pitch);
        // Two functions within 1 ulp and a product; the turns have some roundings of double.
        for (int axis = 0; axis < 3; ++axis)
            ASSERT_NEAR(direction[axis], turned[axis],
                        2.5 * double{FLT_EPSILON} * std::abs(turned[axis]) + 4 * DBL_EPSILON)
                << "xyz"[axis] << " for yaw " << yaw << " and pitch " << pitch
                << " in radians; seed 5, case " << i;
    }
}

TEST(Mvp, Eq4_7_SimilarTrianglesOfTheWorkedExample) {
    const mat4 clip_from_view = perspective(quarter_turn, 2.0f, 1.0f);
    const vec4 clip = clip_from_view * vec4(1, 1, -1, 1);
    // tan(pi/4) in float and a division
    EXPECT_NEAR(clip.x, 0.5f, 4 * FLT_EPSILON)
        << "x of (1, 1, -1) by 90 degrees, with the aspect 2";
    EXPECT_NEAR(clip.y, 1, 4 * FLT_EPSILON) << "y of (1, 1, -1) by 90 degrees, with the aspect 2";
    EXPECT_EQ(clip.w, 1) << "w of (1, 1, -1) is its distance, -z";
    EXPECT_NEAR(perspective(glm::radians(60.0f), 1.0f, 1.0f)[1][1], std::sqrt(3.0f),
                4 * FLT_EPSILON)
        << "f for 60 degrees is 1 / tan(30 degrees)";
}

TEST(Mvp, Eq4_8_NearAndFarAwayOfTheWorkedExample) {
    const mat4 clip_from_view = perspective(quarter_turn, 2.0f, 1.0f);
    EXPECT_EQ((clip_from_view * vec4(1, 1, -1, 1)).z, 1) << "z of any point is near, 1";
    const auto depth = [&](float distance) {
        const vec4 clip = clip_from_view * vec4(0, 0, -distance, 1);
        EXPECT_EQ(clip.w, distance) << "w of what is so far away";
        return clip.z / clip.w;
    };
    EXPECT_EQ(depth(1), 1) << "z/w on the near plane";
    EXPECT_EQ(depth(1.5f), 1 / 1.5f) << "z/w at a distance of 1.5";
    EXPECT_EQ(depth(4), 0.25f) << "z/w at a distance of 4";
    EXPECT_EQ(depth(FLT_MAX), 1 / FLT_MAX) << "z/w as far away as floats go";
}

TEST(Mvp, Eq4_8_RandomViewsEqualGlm) {
    AnySize any(6, 8);
    constexpr float below_pi = 3.1415925f;  // the next float is above
    for (int i = 0; i < cases; ++i) {
        const float aspect = any.positive(), near_ = any.positive();
        float fov = any.positive();
        if (fov > below_pi) fov = below_pi - 0.3f / fov;  // the same up to pi
        // 1 ulp of the tangent, a division, one more by the aspect.
        const double of_sides = 2 * double{FLT_EPSILON};
        dmat4 exact = glm::perspectiveRH_NO(double{fov}, double{aspect}, 1.0, 2.0);
        exact[2].z = 0, exact[3].z = near_;  // where GLM has a far plane
        ASSERT_TRUE(near<4>(perspective(fov, aspect, near_), exact,
                            [&](int row, int column) {
                                return std::abs(exact[column][row]) * (row < 2 ? of_sides : 0);
                            }))
            << "field of view " << fov << ", aspect " << aspect << ", near " << near_
            << "; seed 6, case " << i;
    }
}

TEST(Mvp, Eq4_8_TheLeftHandedFormIsOursWithZMirrored) {
    const double fov = 1, aspect = 1.5, near_ = 0.5, far_ = 1e20;
    const dmat4 left_handed = glm::perspectiveLH_ZO(fov, aspect, far_, near_);  // reversed
    EXPECT_EQ((left_handed * dvec4(0, 0, 3, 1)).w, 3) << "there w is z, not -z";
    EXPECT_TRUE(near<4>(perspective(fov, aspect, near_) * scaling(dvec3(1, 1, -1)), left_handed,
                        [](int, int) { return 4 * DBL_EPSILON; }));
}

TEST(Mvp, Eq4_8_TheCameraFirstViewsThenProjects) {
    const Camera camera = {{0, 0, 5}, translation(vec3(0, 0, -5)), quarter_turn, 1};
    const vec4 clip = camera.clip_from_world({300, 200}) * vec4(2, 1, 3, 1);
    EXPECT_EQ(clip.w, 2)
        << "what lies at z = 3 is 2 in front of the camera at z = 5: the view acts "
           "first (Eq. 4.4), perspective on what it makes";
    EXPECT_TRUE(is_point(vec3(clip), {4.0f / 3, 1, 1}, 8 * FLT_EPSILON));  // five roundings
}

TEST(Mvp, Eq4_7_TheOneParameterFormDiffersByAScale) {
    // w = 1 - z/c, as many short texts have it: an eye at (0, 0, c) that projects onto z = 0.
    const double c = 3, fov = 1, f = 1 / std::tan(fov / 2);
    dmat4 one_parameter(1);
    one_parameter[2][3] = -1 / c;
    const dmat4 ours = perspective(fov, 1.0, 0.5) * translation(dvec3(0, 0, -c));
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-2, 2);
    for (int i = 0; i < 1000; ++i) {
        const dvec4 point(any(random), any(random), any(random), 1);
        const dvec4 theirs_clip = one_parameter * point, ours_clip = ours * point;
        for (int axis = 0; axis < 2; ++axis)  // a handful of roundings of numbers below 4
            ASSERT_NEAR(ours_clip[axis] / ours_clip.w, f / c * theirs_clip[axis] / theirs_clip.w,
                        32 * DBL_EPSILON)
                << "seed 7, case " << i;
    }
}

TEST(Mvp, Eq4_9_CornersAndMiddleOfTheViewport) {
    const mat4 screen_from_ndc = viewport<float>({4, 2});
    EXPECT_EQ(moved(screen_from_ndc, {-1, 1, 1}), vec3(0, 0, 1))
        << "the upper left corner, near, of 4 x 2 pixels";
    EXPECT_EQ(moved(screen_from_ndc, {0, 0, 0.5f}), vec3(2, 1, 0.5f))
        << "the middle of 4 x 2 pixels";
    EXPECT_EQ(moved(screen_from_ndc, {1, -1, 0}), vec3(4, 2, 0))
        << "the lower right corner, far away, of 4 x 2 pixels";
    EXPECT_EQ(moved(viewport<float>({5, 3}), {0, 0, 0}), vec3(2.5f, 1.5f, 0));
}

TEST(Mvp, Eq4_9_ScreenIsTheViewportAfterTheDivision) {
    EXPECT_EQ(screen_from_clip({-3, 3, 3, 3}, {4, 2}), vec3(0, 0, 1))
        << "(-1, 1, 1) times a w of 3: the upper left corner, near";
    EXPECT_EQ(screen_from_clip({0, 0, 1.5f, 3}, {4, 2}), vec3(2, 1, 0.5f)) << "the middle";
    EXPECT_EQ(screen_from_clip({3, -3, 0, 3}, {4, 2}), vec3(4, 2, 0))
        << "(1, -1, 0) times a w of 3: the lower right corner, far away";
    const mat4 clip_from_view = perspective(quarter_turn, 2.0f, 1.0f);
    EXPECT_EQ(screen_from_clip(clip_from_view * vec4(0, 0, -2, 1), {4, 2}).z, 0.5f)
        << "the depth at twice the near plane's distance";
    std::mt19937 random(8);
    std::uniform_real_distribution<float> any(-1, 1);
    constexpr ivec2 size(1279, 719);
    for (int i = 0; i < cases; ++i) {
        const vec4 clip(any(random), any(random), any(random), 1.5f + any(random));
        const dvec4 exact = viewport<double>(size) * (dvec4(clip) / double{clip.w});
        const vec3 screen = screen_from_clip(clip, size);
        for (int axis = 0; axis < 3; ++axis) {
            // Half an eps of the quotient, of the sum and of the product with the size.
            const double span = axis == 2 ? 1 : size[axis];
            const double largest = 1 + std::abs(double{clip[axis]} / clip.w);
            ASSERT_NEAR(screen[axis], exact[axis], span * largest * double{FLT_EPSILON})
                << "xyz"[axis] << " of " << testing::PrintToString(clip)
                << " in 1279 x 719 pixels; "
                << "seed 8, case " << i;
        }
    }
}

TEST(Mvp, Eq4_9_FormWithSizeMinusOneMeansPixelsByTheirIndex) {
    // (W - 1)/2 in other texts: corners of the cube land on the centres of the picture's corners.
    constexpr dvec2 size(4, 2);
    for (const dvec2 ndc : {dvec2(-1, 1), dvec2(1, -1), dvec2(0.25, 0.5)}) {
        const dvec2 theirs = dvec2(ndc.x + 1, 1 - ndc.y) * (size - 1.0) / 2.0;
        const dvec2 ours = dvec2(viewport<double>(ivec2(size)) * dvec4(ndc, 0, 1));
        EXPECT_EQ(theirs * size, ours * (size - 1.0)) << "a picture that is one pixel too small";
    }
}

TEST(Mvp, Eq4_15_ASlopeStretchedAlongX) {
    EXPECT_EQ(normal_matrix(mat3(scaling(vec3(2, 1, 1)))) * vec3(1, 1, 0), vec3(1, 2, 0))
        << "what is stretched along x is less steep against x";
    EXPECT_EQ(normal_matrix(mat3(scaling(vec3(2, 3, 5)))), mat3(scaling(vec3(15, 10, 6))))
        << "the cofactors of what stretches by 2, 3 and 5";
}

TEST(Mvp, Eq4_15_EqualsInverseTransposeTimesDeterminant) {
    AnySize any(9, 3);
    for (int i = 0; i < cases; ++i) {
        const mat3 m(any.vector(), any.vector(), any.vector());
        const lmat3 exact = glm::determinant(lmat3(m)) * glm::transpose(glm::inverse(lmat3(m)));
        const mat3 normals = normal_matrix(m);
        // Each element is a difference of products within 1.5 ulp; the inverse in long double has
        // the error of its own sums of products up to the product of three columns' sizes.
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row)
                ASSERT_LE(std::abs(normals[column][row] - exact[column][row]),
                          1.5L * FLT_EPSILON * std::abs(exact[column][row]) + 1e-9L)
                    << "row " << row + 1 << ", column " << column + 1 << " is "
                    << test::text_of(normals[column][row]) << ", expected " << exact[column][row]
                    << ", for " << testing::PrintToString(m) << "; seed 9, case " << i;
    }
}

TEST(Mvp, Eq4_15_NormalsStandOnTransformedTangentsAlsoWhereMIsSingular) {
    AnySize any(10, 1);
    int mirroring = 0;
    for (int i = 0; i < cases; ++i) {
        mat3 m(any.vector(), any.vector(), any.vector());
        if (i % 4 == 0) m[2] = m[0];  // flat
        if (i % 8 == 0) m = mat3(m[0], m[1], vec3(0));
        if (i % 100 == 0) m[1] = 2.0f * m[0];  // a line: no normal
        mirroring += glm::determinant(m) < 0;
        const lvec3 u(any.vector()), v(any.vector());
        const lvec3 across = glm::cross(u, v), u_moved = lmat3(m) * u, v_moved = lmat3(m) * v;
        const lvec3 normal = lmat3(normal_matrix(m)) * across;
        // The matrix's elements are within 1.5 ulp, the rest is as good as exact. It is the normal
        // of the moved tangents, and so also points to the side from which they turn left.
        const lvec3 expected = glm::cross(u_moved, v_moved);
        for (int axis = 0; axis < 3; ++axis) {
            long double size = 0;
            for (int k = 0; k < 3; ++k) size += std::abs(normal_matrix(m)[k][axis] * across[k]);
            ASSERT_LE(std::abs(normal[axis] - expected[axis]), 1.5L * FLT_EPSILON * size + 1e-12L)
                << "xyz"[axis] << " of the moved normal is " << normal[axis] << ", expected "
                << expected[axis] << ", for " << testing::PrintToString(m) << "; seed 10, case "
                << i;
        }
    }
    EXPECT_GT(mirroring, cases / 4);
}

TEST(Mvp, HardCase_LookAtWithUpThatIsNoUp) {
    look_up("Eq. 4.5, and what takes the place of up");
    AnySize any(11, 1);
    for (int i = 0; i < 20'000; ++i) {
        const vec3 eye = any.vector(), center = any.vector(), back = eye - center;
        const mat4 without = look_at(eye, center, vec3(0));
        ASSERT_TRUE(is_rigid(without)) << of_view(eye, center, vec3(0)) << ", seed 11, case " << i;
        ASSERT_TRUE(sees_in_the_middle(without, eye, center))
            << of_view(eye, center, vec3(0)) << ", seed 11, case " << i;
        for (const vec3 up : {back, -back, any.number() * back, vec3(not_a_number),
                              vec3(0, not_a_number, 0), vec3(infinity, 0, 0), vec3(-0.0f)})
            ASSERT_EQ(look_at(eye, center, up), without)
                << of_view(eye, center, up) << ", which is parallel or no direction: as with "
                << "up (0, 0, 0); seed 11, case " << i;
    }
    for (const vec3 axis : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(1, 1, 0)})
        for (const float sign : {1.0f, -1.0f})
            for (const float size : {1e-30f, 1.0f, 1e30f}) {
                ASSERT_TRUE(is_rigid(look_at(sign * axis, vec3(0), size * axis)))
                    << of_view(sign * axis, vec3(0), size * axis);
                ASSERT_EQ(look_at(sign * axis, vec3(0), size * axis),
                          look_at(sign * axis, vec3(0), vec3(0)))
                    << of_view(sign * axis, vec3(0), size * axis) << ": as with up (0, 0, 0)";
            }
    // Where it looks from, and the axis that is least parallel: of equals y first, then x.
    const std::pair<vec3, vec3> least_parallel[] = {{{1, 1, 1}, {0, 1, 0}}, {{1, 1, 2}, {0, 1, 0}},
                                                    {{2, 1, 1}, {0, 1, 0}}, {{2, 1, 3}, {0, 1, 0}},
                                                    {{1, 2, 1}, {1, 0, 0}}, {{0, 1, 0}, {1, 0, 0}},
                                                    {{1, 2, 3}, {1, 0, 0}}, {{1, 2, 2}, {1, 0, 0}},
                                                    {{2, 3, 1}, {0, 0, 1}}, {{2, 2, 1}, {0, 0, 1}}};
    for (const auto& [eye, axis] : least_parallel)
        ASSERT_EQ(look_at(eye, vec3(0), vec3(0)), look_at(eye, vec3(0), axis))
            << of_view(eye, vec3(0), vec3(0)) << ": as with up " << testing::PrintToString(axis);
    const mat4 level = look_at(vec3(0, 0, 1), vec3(0), vec3(0));
    EXPECT_EQ(level, glm::translate(mat4(1), vec3(0, 0, -1)))
        << "up is y where that is least parallel";
}

TEST(Mvp, HardCase_LookAtFromTheCenterItself) {
    look_up("Eq. 4.5");
    EXPECT_EQ(look_at(vec3(1, 2, 3), vec3(1, 2, 3), vec3(0, 1, 0)),
              glm::translate(mat4(1), vec3(-1, -2, -3)))
        << "then it looks along -z";
    for (const vec3 up : {vec3(0), vec3(0, 0, 1), vec3(not_a_number), vec3(1e-6f, 0, 1)})
        ASSERT_TRUE(is_rigid(look_at(vec3(1, 2, 3), vec3(1, 2, 3), up)))
            << of_view(vec3(1, 2, 3), vec3(1, 2, 3), up);
}

TEST(Mvp, HardCase_LookAtWithNearlyParallelUp) {
    look_up("Eq. 4.5: cross products and what rounding leaves of them");
    AnySize any(12, 1);
    for (int i = 0; i < 20'000; ++i) {
        const vec3 back = glm::normalize(any.vector());
        const vec3 aside = glm::normalize(glm::cross(back, any.vector()));
        const float angle = std::pow(10.0f, -6 + 3 * static_cast<float>(i) / 20'000);
        const vec3 up = (i % 2 ? 1.0f : -1.0f) * back + angle * aside;
        const mat4 view = look_at(back, vec3(0), up);
        ASSERT_TRUE(is_rigid(view)) << of_view(back, vec3(0), up) << ", seed 12, case " << i;
        const lvec3 exact_right = glm::normalize(glm::cross(lvec3(up), lvec3(back)));
        const long double sine = glm::length(glm::cross(lvec3(up), lvec3(back)));
        if (sine < 1e-5L) continue;  // below 64 eps another up is taken
        // Up and back become unit vectors within 1 ulp, then as in Eq4_5_RandomCamerasEqualGlm.
        for (int axis = 0; axis < 3; ++axis)
            ASSERT_LE(std::abs(view[axis][0] - exact_right[axis]), 6 * FLT_EPSILON / sine)
                << "xyz"[axis] << " of right is " << test::text_of(view[axis][0]) << ", expected "
                << exact_right[axis] << "; " << of_view(back, vec3(0), up)
                << ", the sine between them " << sine << "; seed 12, case " << i;
    }
}

TEST(Mvp, HardCase_LookAtOverTinyAndHugeDistances) {
    look_up("Eq. 4.5: the length of what is normalised is taken in a wider type");
    AnySize any(13, 1);
    for (int i = 0; i < 10'000; ++i) {
        const vec3 eye = any.vector(), up = any.vector();
        const mat4 expected = look_at(eye, vec3(0), up);
        ASSERT_TRUE(is_rigid(expected)) << of_view(eye, vec3(0), up) << ", seed 13, case " << i;
        ASSERT_TRUE(sees_in_the_middle(expected, eye, vec3(0)))
            << of_view(eye, vec3(0), up) << ", seed 13, case " << i;
        for (const float size : {0x1p-100f, 0x1p100f}) {  // powers of two: nothing rounds anew
            mat4 actual = look_at(size * eye, vec3(0), up);
            ASSERT_TRUE(is_rigid(actual))
                << of_view(size * eye, vec3(0), up) << ", seed 13, case " << i;
            actual[3] = vec4(vec3(actual[3]) / size, 1);
            ASSERT_EQ(actual, expected) << of_view(size * eye, vec3(0), up) << ", then divided by "
                                        << size << "; seed 13, case " << i;
            ASSERT_EQ(look_at(eye, vec3(0), size * up), expected)
                << of_view(eye, vec3(0), size * up) << ", seed 13, case " << i;
        }
    }
    for (const float size : {1e-30f, 1e30f})
        EXPECT_TRUE(is_rigid(look_at(vec3(size, size, 0), vec3(0), vec3(0, 1, 0))))
            << of_view(vec3(size, size, 0), vec3(0), vec3(0, 1, 0));
}

TEST(Mvp, HardCase_PerspectiveAtItsLimits) {
    look_up("Eq. 4.7 and 4.8");
    for (const float fov_degrees : {1e-3f, 1.0f, 90.0f, 179.9f})
        for (const float aspect : {1e-4f, 1.0f, 16384.0f})
            for (const float near_ : {1e-30f, 1e-6f, 1.0f, 1e30f}) {
                const mat4 m = perspective(glm::radians(fov_degrees), aspect, near_);
                std::ostringstream text;
                text << "field of view " << fov_degrees << " degrees, aspect " << aspect
                     << ", near " << near_ << ": " << testing::PrintToString(m);
                const std::string of_case = text.str();
                for (int column = 0; column < 4; ++column)
                    for (int row = 0; row < 4; ++row)
                        ASSERT_TRUE(std::isfinite(m[column][row])) << of_case;
                ASSERT_GT(m[0][0], 0) << of_case;
                ASSERT_GT(m[1][1], 0) << of_case;
                const vec4 on_near = m * vec4(0, 0, -near_, 1);
                ASSERT_EQ(on_near.z / on_near.w, 1) << of_case;
                const vec4 far_away = m * vec4(0, 0, -8 * near_, 1);
                ASSERT_EQ(far_away.z / far_away.w, 0.125f) << of_case;
            }
}

TEST(Mvp, HardCase_DepthTellsApartWhatDiffersByTwoMillionthsHoweverFarAway) {
    look_up("Eq. 4.8: floats are finest near 0");
    for (const float near_ : {1e-5f, 0.1f, 1e4f}) {
        const mat4 m = perspective(1.0f, 1.0f, near_);
        const auto depth = [&](float distance) {
            return screen_from_clip(m * vec4(0, 0, -distance, 1), {1, 1}).z;
        };
        for (float distance = near_; distance < 1e25f; distance *= 1.7f)
            ASSERT_GT(depth(distance), depth(1.0000003f * distance))
                << "at a distance of " << distance << ", near " << near_;
    }
}

TEST(Mvp, HardCase_WholeSceneLiesBehindTheNearPlane) {
    look_up("Eq. 4.6: the scene in a sphere around its centre");
    std::mt19937 random(14);
    std::uniform_real_distribution<float> yaw(-720, 720), pitch(-90, 90), power(0, 6),
        place(-50, 50), side(0, 2);
    for (int i = 0; i < 20'000; ++i) {
        const float scale = std::pow(10.0f, place(random) / 5);
        Bounds bounds;
        bounds.min = scale * vec3(place(random), place(random), place(random));
        bounds.max = bounds.min + scale * vec3(side(random), side(random), side(random) + 1);
        Orbit orbit;
        orbit.yaw_degrees = yaw(random);
        orbit.pitch_degrees = i % 3 ? pitch(random) : i % 2 ? 90.0f : -90.0f;
        orbit.distance = 1 + 0.3f * std::pow(10.0f, power(random));
        const Camera camera = orbit_camera(orbit, bounds);
        std::ostringstream text;
        text << "a scene from " << testing::PrintToString(bounds.min) << " to "
             << testing::PrintToString(bounds.max) << ", yaw " << orbit.yaw_degrees << ", pitch "
             << orbit.pitch_degrees << ", distance " << orbit.distance << "; seed 14, case " << i;
        const std::string of_case = text.str();
        ASSERT_GT(camera.near, 0) << of_case;
        ASSERT_EQ(camera.farthest_depth(), 0) << of_case;
        ASSERT_TRUE(is_rigid(camera.view_from_world)) << of_case;
        for (int corner = 0; corner < 8; ++corner) {
            const dvec4 world(corner & 1 ? bounds.max.x : bounds.min.x,
                              corner & 2 ? bounds.max.y : bounds.min.y,
                              corner & 4 ? bounds.max.z : bounds.min.z, 1);
            const double distance = -(dmat4(camera.view_from_world) * world).z;
            ASSERT_GE(distance, camera.near) << "of a corner; " << of_case;
        }
        const vec4 middle = camera.clip_from_world({16, 9}) * vec4(bounds.center(), 1);
        // The eye is as far from the origin as 100 radii more than its distance: some eps of that.
        const float tolerance = 1e-4f * middle.w / std::tan(camera.fov_y_radians / 2);
        ASSERT_NEAR(middle.x, 0, tolerance) << of_case;
        ASSERT_NEAR(middle.y, 0, tolerance) << of_case;
    }
}

TEST(Mvp, HardCase_OrbitAroundScenesOfNoSize) {
    look_up("Eq. 4.6");
    Bounds point;
    point.add(vec3(1, 2, 3));
    for (const Bounds& bounds : {Bounds(), point}) {
        const Camera camera = orbit_camera(Orbit(), bounds);
        const vec3 center = bounds.min.x <= bounds.max.x ? vec3(1, 2, 3) : vec3(0);
        EXPECT_NEAR(glm::distance(camera.position_world, center), Orbit().distance,
                    8 * FLT_EPSILON);
        EXPECT_TRUE(is_rigid(camera.view_from_world));
        EXPECT_NEAR(camera.near, 0.999f * (Orbit().distance - 1), 4 * FLT_EPSILON);
    }
}

TEST(Mvp, HardCase_OrbitAroundTinyAndHugeScenes) {
    look_up("Eq. 4.6: all in radii of the scene");
    const auto camera_around = [](float size) {
        Bounds bounds;
        bounds.add(size * vec3(-1, -2, -3)), bounds.add(size * vec3(3, 2, 1));
        return orbit_camera(Orbit(), bounds);
    };
    const Camera expected = camera_around(1);
    for (const float size : {0x1p-100f, 0x1p-66f, 0x1p66f, 0x1p120f}) {
        const Camera camera = camera_around(size);
        ASSERT_EQ(camera.position_world, size * expected.position_world)
            << "a scene " << size << " times as large";
        ASSERT_EQ(camera.near, size * expected.near) << "a scene " << size << " times as large";
        ASSERT_EQ(mat3(camera.view_from_world), mat3(expected.view_from_world))
            << "a scene " << size << " times as large";
    }
}

TEST(Mvp, HardCase_OrbitFromInsideTheScene) {
    look_up("Eq. 4.8: near must stay above 0");
    Bounds bounds;
    bounds.add(vec3(-1)), bounds.add(vec3(1));
    for (const float distance : {0.01f, 0.5f, 0.999f, 1.0f, 1.001f}) {
        Orbit orbit;
        orbit.distance = distance;
        const Camera camera = orbit_camera(orbit, bounds);
        ASSERT_NEAR(camera.near, 0.001f * (1 + distance) * std::sqrt(3.0f), 1e-4f)
            << distance << " radii from the center";
    }
}

TEST(Mvp, HardCase_LookingStraightDownUpIsWhereTheWayAroundLeads) {
    look_up("Eq. 4.6, and which way is up");
    Bounds bounds;
    bounds.add(vec3(-1)), bounds.add(vec3(1));
    constexpr float tolerance = 1e-3f;  // a hundredth of a degree is 1.7e-4
    for (const float yaw_degrees : {0.0f, 30.0f, 60.0f, 200.0f})
        for (const float sign : {-1.0f, 1.0f}) {
            Orbit nearly{yaw_degrees, sign * 89.99f, 3, 40},
                straight{yaw_degrees, sign * 90, 3, 40};
            const mat4 before = orbit_camera(nearly, bounds).view_from_world;
            const mat4 after = orbit_camera(straight, bounds).view_from_world;
            for (int column = 0; column < 4; ++column)
                for (int row = 0; row < 4; ++row)
                    ASSERT_NEAR(after[column][row], before[column][row], tolerance)
                        << "row " << row + 1 << ", column " << column + 1 << " at pitch "
                        << straight.pitch_degrees << " and at " << nearly.pitch_degrees << ", yaw "
                        << yaw_degrees;
        }
}
