// SPDX-License-Identifier: MIT
// The matrices and the camera, also for numbers of all sizes against GLM in double or a reference
// in long double; what is clipped and culled: 04_mvp_clip_test.cpp.
#include "04_mvp/transform.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "support/any_size.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/printers.hpp"
#include "support/reference.hpp"
#include "support/special_numbers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

using lmat3 = glm::mat<3, 3, long double>;

constexpr float quarter_turn = std::numbers::pi_v<float> / 2;

/// For EXPECT_TRUE: every element is as near to the exact one as `tolerance` says of it.
testing::AssertionResult near(const mat4& actual, const dmat4& exact,
                              const std::function<double(int row, int column)>& tolerance) {
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) {
            const double may_be = tolerance(row, column);
            if (auto is_it = is_near(actual[column][row], exact[column][row], may_be); !is_it)
                return is_it << ", in row " << row + 1 << ", column " << column + 1 << " of "
                             << testing::PrintToString(actual);
        }
    return testing::AssertionSuccess();
}

/// For EXPECT_TRUE: finite; above, a rotation within 4 eps; the last row as it should be.
testing::AssertionResult is_rigid(const mat4& m) {
    const auto wrong = [&m](const std::string& what) {
        return testing::AssertionFailure() << what << ": " << testing::PrintToString(m);
    };
    constexpr long double tolerance = 4 * FLT_EPSILON;  // as look_at promises
    for (int column = 0; column < 4; ++column)
        if (!is_finite(m[column])) return wrong("not finite");
    const lmat3 r{mat3(m)}, product = r * glm::transpose(r);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (!(std::abs(product[column][row] - (column == row)) <= tolerance))
                return wrong(row == column ? "a row that is no unit vector"
                                           : "two rows that are at no right angle");
    // Half of the three rows' errors.
    if (!(std::abs(glm::determinant(r) - 1) <= 2 * tolerance)) return wrong("a determinant not 1");
    if (glm::transpose(m)[3] != vec4(0, 0, 0, 1)) return wrong("the last row is not (0, 0, 0, 1)");
    return testing::AssertionSuccess();
}

std::string of_view(vec3 eye, vec3 center, vec3 up) {
    return "eye " + testing::PrintToString(eye) + ", center " + testing::PrintToString(center) +
           ", up " + testing::PrintToString(up);
}

vec3 moved(const mat4& m, vec3 point) { return vec3(m * vec4(point, 1)); }

const Bounds cube = {vec3(-1), vec3(1)};
constexpr float turn_tolerance = FLT_EPSILON;  // the cosine of pi/2 in float is -4e-8

/// For EXPECT_TRUE: for angles of all sizes as GLM's. Sines and cosines in float are within 1 ulp,
/// which is at most eps of each.
testing::AssertionResult turns_as_glm(mat4 (*turn)(float angle_radians), dvec3 axis) {
    AnySize any(1, 8);
    for (int i = 0; i < cases; ++i) {
        const float angle = any.number();
        const dmat4 exact = glm::rotate(dmat4(1), double{angle}, axis);
        auto is = near(turn(angle), exact, [&](int row, int column) {
            return double{FLT_EPSILON} * std::abs(exact[column][row]);
        });
        if (!is) return is << ", by " << angle << "; seed 1, case " << i;
    }
    return testing::AssertionSuccess();
}

}  // namespace

TEST(Mvp, Eq4_1_QuarterTurnAroundZTakesXToY) {
    const mat4 turn = rotation_z(quarter_turn);
    EXPECT_TRUE(are_near(moved(turn, {1, 0, 0}), dvec3(0, 1, 0), turn_tolerance)) << "of (1, 0, 0)";
    EXPECT_TRUE(are_near(moved(turn, {0, 1, 0}), dvec3(-1, 0, 0), turn_tolerance))
        << "of (0, 1, 0)";
    EXPECT_EQ(moved(turn, {0, 0, 7}), vec3(0, 0, 7));
}

TEST(Mvp, Eq4_1_RandomAnglesEqualGlm) {
    EXPECT_TRUE(turns_as_glm(rotation_z<float>, {0, 0, 1})) << "around z";
}

TEST(Mvp, Eq4_2_QuarterTurnsAroundXAndY) {
    const mat4 around_x = rotation_x(quarter_turn), around_y = rotation_y(quarter_turn);
    EXPECT_TRUE(are_near(moved(around_x, {0, 1, 0}), dvec3(0, 0, 1), turn_tolerance))
        << "(0, 1, 0) a quarter turn around x";
    EXPECT_TRUE(are_near(moved(around_x, {0, 0, 1}), dvec3(0, -1, 0), turn_tolerance))
        << "(0, 0, 1) a quarter turn around x";
    EXPECT_TRUE(are_near(moved(around_y, {0, 0, 1}), dvec3(1, 0, 0), turn_tolerance))
        << "(0, 0, 1) a quarter turn around y";
    EXPECT_TRUE(are_near(moved(around_y, {1, 0, 0}), dvec3(0, 0, -1), turn_tolerance))
        << "(1, 0, 0) a quarter turn around y";
}

TEST(Mvp, Eq4_2_RandomAnglesEqualGlm) {
    EXPECT_TRUE(turns_as_glm(rotation_x<float>, {1, 0, 0})) << "around x";
    EXPECT_TRUE(turns_as_glm(rotation_y<float>, {0, 1, 0})) << "around y";
}

TEST(Mvp, Eq4_3_APointIsMovedAndStretched) {
    const vec3 by(1, 2, 3);
    EXPECT_EQ(moved(translation(by), {5, 6, 7}), vec3(6, 8, 10));
    EXPECT_EQ(moved(scaling(by), {5, 6, 7}), vec3(5, 12, 21));
    EXPECT_EQ(translation(by) * vec4(5, 5, 5, 0), vec4(5, 5, 5, 0)) << "a direction is not moved";
    EXPECT_EQ(translation(by), glm::translate(mat4(1), by));
    EXPECT_EQ(scaling(by), glm::scale(mat4(1), by));
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
        const double of_move = (of_axes + 1.5 * double{FLT_EPSILON}) * glm::length(dvec3(eye));
        const mat4 view = look_at(eye, center, up);
        ASSERT_TRUE(near(view, glm::lookAtRH(dvec3(eye), dvec3(center), up_used),
                         [&](int, int column) { return column == 3 ? of_move : of_axes; }))
            << of_view(eye, center, up) << ", seed 4, case " << i;
        ASSERT_TRUE(is_rigid(view)) << of_view(eye, center, up) << ", seed 4, case " << i;
    }
    EXPECT_GT(replaced, cases / 100);
}

TEST(Mvp, Eq4_6_DirectionsOfTheWorkedExample) {
    const auto direction = [](float yaw_degrees, float pitch_degrees) {
        return direction_from_angles(glm::radians(yaw_degrees), glm::radians(pitch_degrees));
    };
    EXPECT_EQ(direction(0, 0), vec3(0, 0, 1)) << "yaw 0, pitch 0";
    EXPECT_TRUE(are_near(direction(90, 0), dvec3(1, 0, 0), turn_tolerance))
        << "yaw 90 degrees, pitch 0";
    EXPECT_TRUE(are_near(direction(0, 30), dvec3(0, 0.5f, std::sqrt(0.75f)), turn_tolerance))
        << "yaw 0, pitch 30 degrees";
    for (const float yaw : {-300.0f, 0.0f, 17.0f, 90.0f}) {
        ASSERT_TRUE(are_near(direction(yaw, 90), dvec3(0, 1, 0), turn_tolerance))
            << "yaw " << yaw << " degrees, pitch 90";
        ASSERT_TRUE(are_near(direction(yaw, -90), dvec3(0, -1, 0), turn_tolerance))
            << "yaw " << yaw << " degrees, pitch -90";
    }
}

TEST(Mvp, Eq4_6_TheCameraStandsOnASphereAroundTheScene) {
    AnySize any(3, 1);
    for (int i = 0; i < cases; ++i) {
        Bounds box;
        const vec3 place = any.vector();
        box.add(place), box.add(place + any.vector());
        const Orbit orbit = {100 * any.number(), 0.01f * static_cast<float>(any.whole(-9000, 9000)),
                             0.5f + any.positive(), static_cast<float>(any.whole(1, 170))};
        const Camera camera = orbit_camera(orbit, box);

        const dvec3 center = (dvec3(box.min) + dvec3(box.max)) / 2.0;
        const double radius = glm::distance(dvec3(box.min), dvec3(box.max)) / 2;
        const double distance = orbit.distance * radius;
        dmat4 turn = glm::rotate(dmat4(1), glm::radians(double{orbit.yaw_degrees}), {0, 1, 0});
        turn = glm::rotate(turn, -glm::radians(double{orbit.pitch_degrees}), {1, 0, 0});
        const dvec3 eye = center + distance * dvec3(turn[2]);
        const dmat4 view = glm::inverse(glm::translate(dmat4(1), eye) * turn);
        const double near_ = std::max(0.999 * (distance - radius), 0.001 * (distance + radius));
        // Angles of up to 1000 degrees round most, then places of up to 100 at a distance of 0.1.
        constexpr double of_turn = 2e-4, of_place = 2e-2;
        SCOPED_TRACE("seed 3, case " + std::to_string(i));
        ASSERT_TRUE(near(camera.view_from_world, view,
                         [](int, int column) { return column == 3 ? of_place : of_turn; }));
        ASSERT_LE(glm::distance(dvec3(camera.center_world), center), 1e-5);
        ASSERT_LE(glm::distance(dvec3(camera.position_world), eye), of_turn * distance);
        ASSERT_NEAR(camera.near, near_, 1e-5 * distance);
        ASSERT_NEAR(camera.fov_y_radians, glm::radians(double{orbit.fov_degrees}), 1e-6);
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
        ASSERT_TRUE(near(perspective(fov, aspect, near_), exact,
                         [&](int row, int column) {
                             return std::abs(exact[column][row]) * (row < 2 ? of_sides : 0);
                         }))
            << "field of view " << fov << ", aspect " << aspect << ", near " << near_
            << "; seed 6, case " << i;
    }
}

TEST(Mvp, Eq4_8_TheCameraFirstViewsThenProjects) {
    const Camera camera = {{0, 0, 5}, translation(vec3(0, 0, -5)), quarter_turn, 1};
    const vec4 clip = camera.clip_from_world({300, 200}) * vec4(2, 1, 3, 1);
    EXPECT_EQ(clip.w, 2)
        << "what lies at z = 3 is 2 in front of the camera at z = 5: the view acts "
           "first (Eq. 4.4), perspective on what it makes";
    EXPECT_TRUE(are_near(vec3(clip), dvec3(4.0f / 3, 1, 1), 8 * FLT_EPSILON));  // five roundings
}

TEST(Mvp, Eq4_9_CornersAndMiddleOfTheViewport) {
    const mat4 screen_from_ndc = viewport<float>({4, 2});
    EXPECT_EQ(moved(screen_from_ndc, {-1, 1, 1}), vec3(0, 0, 1))
        << "the upper left corner, near, of 4 x 2 pixels";
    EXPECT_EQ(moved(screen_from_ndc, {0, 0, 0.5f}), vec3(2, 1, 0.5f))
        << "the middle of 4 x 2 pixels";
    EXPECT_EQ(moved(screen_from_ndc, {1, -1, 0}), vec3(4, 2, 0))
        << "the lower right corner, far away, of 4 x 2 pixels";
    EXPECT_EQ(viewport<float>({5, 3}), glm::translate(mat4(1), vec3(2.5f, 1.5f, 0)) *
                                           glm::scale(mat4(1), vec3(2.5f, -1.5f, 1)))
        << "of 5 x 3 pixels";
}

TEST(Mvp, Eq4_9_ScreenIsTheViewportAfterTheDivision) {
    EXPECT_EQ(screen_from_clip({-3, 3, 3, 3}, {4, 2}), vec3(0, 0, 1))
        << "(-1, 1, 1) times a w of 3: the upper left corner, near";
    EXPECT_EQ(screen_from_clip({0, 0, 1.5f, 3}, {4, 2}), vec3(2, 1, 0.5f)) << "the middle";
    EXPECT_EQ(screen_from_clip({3, -3, 0, 3}, {4, 2}), vec3(4, 2, 0))
        << "(1, -1, 0) times a w of 3: the lower right corner, far away";
}

TEST(Mvp, Eq4_15_ASlopeStretchedAlongX) {
    EXPECT_EQ(normal_matrix(mat3(scaling(vec3(2, 1, 1)))) * vec3(1, 1, 0), vec3(1, 2, 0))
        << "what is stretched along x is less steep against x";
    EXPECT_EQ(normal_matrix(mat3(scaling(vec3(2, 3, 5)))), mat3(scaling(vec3(15, 10, 6))))
        << "the cofactors of what stretches by 2, 3 and 5";
}

TEST(Mvp, Eq4_15_NormalMatricesOfAllSizes) {
    AnySize any(6, decades);
    for (int i = 0; i < cases; ++i) {
        mat3 m(any.vector(), any.vector(), any.vector());
        if (i % 2) m[1] = any.positive() * m[0] + 1e-6f * any.vector();  // nearly parallel
        if (i % 8 == 0) m[2] = m[0];                                     // singular
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

TEST(Mvp, HardCase_LookAtWithUpThatIsNoUp) {
    look_up("Eq. 4.5, and what takes the place of up");
    AnySize any(11, 1);
    for (int i = 0; i < 20'000; ++i) {
        const vec3 eye = any.vector(), center = any.vector(), back = eye - center;
        const mat4 without = look_at(eye, center, vec3(0));
        ASSERT_TRUE(is_rigid(without)) << of_view(eye, center, vec3(0)) << ", seed 11, case " << i;
        for (const vec3 up : {back, any.number() * back, vec3(not_a_number),
                              vec3(0, not_a_number, 0), vec3(infinity, 0, 0), vec3(-0.0f)})
            ASSERT_EQ(look_at(eye, center, up), without)
                << of_view(eye, center, up) << ", which is parallel or no direction: as with "
                << "up (0, 0, 0); seed 11, case " << i;
    }
    for (const vec3 axis : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(1, 1, 0)})
        for (const float size : {1e-30f, -1e-30f, 1.0f, -1.0f, 1e30f, -1e30f})
            ASSERT_EQ(look_at(axis, vec3(0), size * axis), look_at(axis, vec3(0), vec3(0)))
                << of_view(axis, vec3(0), size * axis) << ": as with up (0, 0, 0)";
    // Where it looks from, and the axis that is least parallel: of equals y first, then x.
    const std::pair<vec3, vec3> least_parallel[] = {{{1, 1, 1}, {0, 1, 0}}, {{1, 1, 2}, {0, 1, 0}},
                                                    {{2, 1, 1}, {0, 1, 0}}, {{2, 1, 3}, {0, 1, 0}},
                                                    {{1, 2, 1}, {1, 0, 0}}, {{0, 1, 0}, {1, 0, 0}},
                                                    {{1, 2, 3}, {1, 0, 0}}, {{1, 2, 2}, {1, 0, 0}},
                                                    {{2, 3, 1}, {0, 0, 1}}, {{2, 2, 1}, {0, 0, 1}}};
    for (const auto& [eye, axis] : least_parallel)
        ASSERT_EQ(look_at(eye, vec3(0), vec3(0)), look_at(eye, vec3(0), axis))
            << of_view(eye, vec3(0), vec3(0)) << ": as with up " << testing::PrintToString(axis);
}

TEST(Mvp, HardCase_LookAtFromTheCenterItself) {
    look_up("Eq. 4.5");
    const vec3 eye(1, 2, 3);
    EXPECT_EQ(look_at(eye, eye, vec3(0, 1, 0)), glm::translate(mat4(1), -eye))
        << "then it looks along -z";
    for (const vec3 up : {vec3(0), vec3(0, 0, 1), vec3(not_a_number), vec3(1e-6f, 0, 1)})
        EXPECT_TRUE(is_rigid(look_at(eye, eye, up))) << of_view(eye, eye, up);
}

TEST(Mvp, HardCase_LookAtOverTinyAndHugeDistances) {
    look_up("Eq. 4.5: the length of what is normalised is taken in a wider type");
    AnySize any(13, 1);
    for (int i = 0; i < 10'000; ++i) {
        const vec3 eye = any.vector(), up = any.vector();
        const mat4 expected = look_at(eye, vec3(0), up);
        for (const float size : {0x1p-100f, 0x1p100f}) {  // powers of two: nothing rounds anew
            mat4 actual = look_at(size * eye, vec3(0), up);
            actual[3] = vec4(vec3(actual[3]) / size, 1);
            ASSERT_EQ(actual, expected) << of_view(size * eye, vec3(0), up) << ", then divided by "
                                        << size << "; seed 13, case " << i;
            ASSERT_EQ(look_at(eye, vec3(0), size * up), expected)
                << of_view(eye, vec3(0), size * up) << ", seed 13, case " << i;
        }
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
        const Orbit orbit = {yaw(random),
                             i % 3   ? pitch(random)
                             : i % 2 ? 90.0f
                                     : -90.0f,
                             1 + 0.3f * std::pow(10.0f, power(random))};
        const Camera camera = orbit_camera(orbit, bounds);
        SCOPED_TRACE("a scene from " + testing::PrintToString(bounds.min) + " to " +
                     testing::PrintToString(bounds.max) + ", yaw " + text_of(orbit.yaw_degrees) +
                     ", pitch " + text_of(orbit.pitch_degrees) + ", distance " +
                     text_of(orbit.distance) + "; seed 14, case " + std::to_string(i));
        ASSERT_GT(camera.near, 0);
        ASSERT_EQ(camera.farthest_depth(), 0);
        ASSERT_TRUE(is_rigid(camera.view_from_world));
        for (const float x : {bounds.min.x, bounds.max.x})
            for (const float y : {bounds.min.y, bounds.max.y})
                for (const float z : {bounds.min.z, bounds.max.z})
                    ASSERT_GE(-(dmat4(camera.view_from_world) * dvec4(x, y, z, 1)).z, camera.near)
                        << "the distance of a corner";
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
        SCOPED_TRACE("a scene " + text_of(size) + " times as large");
        EXPECT_EQ(camera.position_world, size * expected.position_world);
        EXPECT_EQ(camera.near, size * expected.near);
        EXPECT_EQ(mat3(camera.view_from_world), mat3(expected.view_from_world));
    }
}

TEST(Mvp, HardCase_OrbitFromInsideTheScene) {
    look_up("Eq. 4.8: near must stay above 0");
    for (const float distance : {0.01f, 0.5f, 0.999f, 1.0f, 1.001f})
        ASSERT_NEAR(orbit_camera({.distance = distance}, cube).near,
                    0.001f * (1 + distance) * std::sqrt(3.0f), 1e-4f)
            << distance << " radii from the center";
}

TEST(Mvp, HardCase_LookingStraightDownUpIsWhereTheWayAroundLeads) {
    look_up("Eq. 4.6, and which way is up");
    constexpr double tolerance = 1e-3;  // a hundredth of a degree is 1.7e-4
    for (const float yaw_degrees : {0.0f, 30.0f, 60.0f, 200.0f})
        for (const float pitch_degrees : {-90.0f, 90.0f}) {
            const Orbit straight{yaw_degrees, pitch_degrees, 3, 40};
            const Orbit nearly{yaw_degrees, pitch_degrees * 0.9999f, 3, 40};
            ASSERT_TRUE(near(orbit_camera(straight, cube).view_from_world,
                             dmat4(orbit_camera(nearly, cube).view_from_world),
                             [](int, int) { return tolerance; }))
                << "at pitch " << pitch_degrees << ", and nearly there, yaw " << yaw_degrees;
        }
}
