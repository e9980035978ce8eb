// SPDX-License-Identifier: MIT
// The worked examples of the derivation with its own numbers, and its claims about rims and balls.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "07_toon/outline.hpp"
#include "lab/toon_methods.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/printers.hpp"
#include "support/toon_pictures.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// A cube almost in orthographic projection: from far away, with a small field of view.
lesson_07::Options before_the_cube(float yaw_degrees) {
    lesson_07::Options options;
    options.size = {400, 300};
    options.orbit = {yaw_degrees, 0, 200, 0.4f};
    options.shading.outline = Outline::hull;
    options.shading.outline_width_px = 24;
    return options;
}

/// The ink above the body in one column, in pixels.
int rim_above(const Image<Seen>& seen, int x) {
    int rim = 0;
    for (int y = 0; y < seen.size().y && seen[{x, y}] != Seen::body; ++y)
        rim += seen[{x, y}] == Seen::ink;
    return rim;
}

}  // namespace

TEST(Toon, Eq7_1_AnExampleOfBrightness) {
    EXPECT_EQ(brightness(vec3(0.7f, 0.68f, 0.6f)), 0.7f);
    EXPECT_EQ(brightness(vec3(0.7f, 0, 0)), 0.7f);
}

TEST(Toon, Eq7_2_ExamplesOfTones) {
    EXPECT_EQ(tone_of(0.1f, 4), 0);
    EXPECT_EQ(tone_of(std::nextafter(0.25f, 0.0f), 4), 0) << "just below 1/4";
    EXPECT_EQ(tone_of(0.25f, 4), 1);
    EXPECT_EQ(tone_of(0.7f, 4), 2);
    EXPECT_EQ(tone_of(0.75f, 4), 3);
    EXPECT_EQ(tone_of(1, 4), 3) << "the brightest tone is 3";
    EXPECT_EQ(tone_of(2.4f, 4), 3) << "the brightest tone is 3";
    EXPECT_EQ(tone_of(std::numeric_limits<float>::quiet_NaN(), 4), 0);
    // In float, ten times the float below 7/10 is 7.
    const float rounded = 0.7f * 10;
    EXPECT_EQ(rounded, 7);
    EXPECT_EQ(tone_of(0.7f, 10), 6)
        << "the float 0.7 is 0.699999988, below 7/10; in float, ten times that is rounded to 7";
}

TEST(Toon, Eq7_4_ExampleOfACoat) {
    const SurfaceColor coat{{0.8f, 0.13f, 0.06f}, {0.8f, 0.13f, 0.06f}, vec3(0.7f), vec3(0)};
    const vec3 painted = toon(coat, toon_ambient_light, {{0.7f, 0.68f, 0.6f}, vec3(0)}, 4);
    EXPECT_TRUE(are_near(painted, {0.6533, 0.1062, 0.0532}, 0.00005))
        << "toon() of the robot's coat in the diffuse light (0.7, 0.68, 0.6), of 4 tones: Ka = Kd "
           "= (0.8, 0.13, 0.06), Ia = (0.15, 0.15, 0.22)";
    const auto bell = [](double degrees) {
        return vec3(static_cast<float>(std::pow(std::cos(glm::radians(degrees)), 40)));
    };
    EXPECT_TRUE(is_highlight(coat, {vec3(0), bell(7.35)}))
        << "Ks = 0.7, specular light " << bell(7.35).x << ": together above 1/2";
    EXPECT_FALSE(is_highlight(coat, {vec3(0), bell(7.45)}))
        << "Ks = 0.7, specular light " << bell(7.45).x << ": together below 1/2";
    EXPECT_FALSE(is_highlight({vec3(0), vec3(0), vec3(0.4f), vec3(0)}, {vec3(0), bell(0)}))
        << "Ks = 0.4, specular light 1: together below 1/2";
}

TEST(Toon, Eq7_5_ExamplesOnAndBesideAThreshold) {
    EXPECT_NEAR(smoothly_quantised(0.25f, 0.1f, 4), 1 / 6.0, FLT_EPSILON);
    EXPECT_NEAR(smoothly_quantised(0.27f, 0.1f, 4), 0.7 / 3,
                2 * FLT_EPSILON);  // 0.27f and 0.1f, too
    EXPECT_NEAR(smoothly_quantised(0.31f, 0.1f, 4), 1 / 3.0, FLT_EPSILON);
}

TEST(Toon, Eq7_5_SlantedBordersAreOffByAnEighth) {
    // The share of a pixel above one half where the brightness runs evenly over it: by counting.
    constexpr int side = 64;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(-1, 1);
    double greatest = 0;
    for (int i = 0; i < 2000; ++i) {
        const double along_x = any(random), along_y = i % 2 ? along_x : any(random);
        const double change = std::abs(along_x) + std::abs(along_y);
        const double here = 0.5 + 0.5 * change * any(random);
        int above = 0;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                above += here + along_x * ((x + 0.5) / side - 0.5) +
                             along_y * ((y + 0.5) / side - 0.5) >=
                         0.5;
        const double share = static_cast<double>(above) / (side * side);
        const double found = highlight_share(static_cast<float>(here), static_cast<float>(change));
        greatest = std::max(greatest, std::abs(found - share));
    }
    // Counting is off by as many squares as a border meets, half of each: 1 / side.
    EXPECT_NEAR(greatest, 0.125, 1.0 / side);
    // Along rows or columns it is exact but for the counting.
    EXPECT_FLOAT_EQ(highlight_share(0.475f, 0.1f), 0.25f);
}

TEST(Toon, Eq7_7_ExampleOfARing) {
    // A ray from (0, 0, 5) at an angle to the direction to the centre of the sphere of radius 1.
    const auto is_ink = [](double degrees) {
        const dvec3 eye(0, 0, 5);
        const dvec3 ray(std::sin(glm::radians(degrees)), 0, -std::cos(glm::radians(degrees)));
        const double along = -glm::dot(eye, ray);
        const double inside = along * along - (glm::dot(eye, eye) - 1);
        if (inside < 0) return Seen::paper;
        const dvec3 point = eye + (along - std::sqrt(inside)) * ray;
        return is_facing_outline(facing_ratio(vec3(point), vec3(-ray)), 0.35f) ? Seen::ink
                                                                               : Seen::body;
    };
    EXPECT_EQ(is_ink(10.79), Seen::body)
        << "10.79 degrees from the centre: inside of the ring; least 0.35";
    EXPECT_EQ(is_ink(10.81), Seen::ink)
        << "10.81 degrees from the centre: just in the ring; least 0.35";
    EXPECT_EQ(is_ink(11.53), Seen::ink)
        << "11.53 degrees from the centre: just in the ring; least 0.35";
    EXPECT_EQ(is_ink(11.55), Seen::paper)
        << "11.55 degrees from the centre: beside the sphere; least 0.35";
}

TEST(Toon, Eq7_8_ExampleOfTwoFaces) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    mesh.triangles = {{{Vertex{0}, Vertex{1}, Vertex{2}}, 0},   // its normal is (1, 0, 0)
                      {{Vertex{0}, Vertex{2}, Vertex{3}}, 0}};  // and that is (0, 1, 0)
    const vec3 normal = hull_normals(mesh)[0];
    EXPECT_TRUE(are_near(normal, {std::sqrt(0.5), std::sqrt(0.5), 0}, FLT_EPSILON))
        << "hull_normals()[0], where faces with the normals (1, 0, 0) and (0, 1, 0) meet, each "
           "with a right angle";
    EXPECT_EQ(normal.z, 0) << "hull_normals()[0]";
}

TEST(Toon, Eq7_9_ExampleOfFivePixels) {
    const ivec2 size(400, 200);
    constexpr float tolerance = 2 * FLT_EPSILON;  // of numbers from 1 to 2
    const mat4 clip_from_view = perspective(glm::radians(90.0f), 2.0f, 1.0f);
    const vec4 position = clip_from_view * vec4(1.2f, 1.6f, -2, 1);
    const vec4 moved = pushed(position, clip_from_view * vec4(0.48f, 0.64f, 0.6f, 0), 5, size);
    const char* what =
        "pushed() of (0.6, 1.6, 1, 2) along (0.24, 0.64, -, -0.6) by 5 pixels of 400 x 200";
    EXPECT_TRUE(are_near(vec2(moved), dvec2(0.63, 1.68), tolerance)) << what;
    EXPECT_EQ(moved.z, position.z) << what;
    EXPECT_EQ(moved.w, 2) << what;
    const vec3 from = screen_from_clip(position, size), to = screen_from_clip(moved, size);
    EXPECT_TRUE(are_near(vec2(from), dvec2(260, 20), 1e-4)) << "on the screen";
    EXPECT_TRUE(are_near(vec2(to), dvec2(263, 16), 1e-4)) << "on the screen, " << what;
}

TEST(Toon, Eq7_10_HardCase_RimsOfACube) {
    const Scene cube = scene_of_one(cube_mesh(true));
    const float width = 24;
    // Face-on: its vertices move along the diagonals.
    const lesson_07::Options face_on = before_the_cube(0);
    const Image<Seen> square = seen_in(toon_picture(cube, face_on));
    for (const int x : {180, 200, 220})
        ASSERT_NEAR(rim_above(square, x), width / std::sqrt(2), 1)
            << "the rim's height in column " << x
            << " above a cube seen face-on; its vertices move by 24 pixels, along the diagonals";
    // Edge-on: the full width above the middle edge, less and less towards the outer vertices,
    // which move along (sqrt(2), 1).
    const Image<Seen> edge_on = seen_in(toon_picture(cube, before_the_cube(45)));
    int left = 0;
    while (left < 200 && edge_on[{left, 150}] != Seen::body) ++left;
    ASSERT_LT(left, 190) << "in row 150, the first column in which the cube is seen, of 400";
    const double least = width / std::sqrt(3), outer = 200 - left + width * std::sqrt(2 / 3.0);
    for (int x = left + 1; x < 200; ++x)
        ASSERT_NEAR(rim_above(edge_on, x), width + (least - width) * (199.5 - x) / outer, 1)
            << "the rim's height in column " << x << " above a cube seen edge-on, of width 24";
}

TEST(Toon, Eq7_10_AnExampleOfEitherSide) {
    Mesh mesh;
    mesh.positions = {{0, 0, -2}, {1, 0, -2}, {0, 1, -2}};
    EXPECT_FALSE(is_seen_from_behind(mesh, {{Vertex{0}, Vertex{1}, Vertex{2}}, 0}, vec3(0)))
        << "(0, 0, -2), (1, 0, -2), (0, 1, -2), from the origin: its front";
    EXPECT_TRUE(is_seen_from_behind(mesh, {{Vertex{0}, Vertex{2}, Vertex{1}}, 0}, vec3(0)))
        << "(0, 0, -2), (0, 1, -2), (1, 0, -2), from the origin: its back";
}

TEST(Toon, Eq7_11_ExampleOfADepth) {
    const Camera near_2{vec3(0), mat4(1), 1, 2};
    EXPECT_EQ(inverse_w(0.5f, near_2), 0.25f) << "near 2, at a distance of 4";
    EXPECT_EQ(inverse_w(DepthBuffer::cleared, near_2), 0) << "where nothing is seen";
}

TEST(Toon, Eq7_12_ExampleOfAFloorAndAStep) {
    const ivec2 x(1, 0);
    const auto bend_of = [&](auto&& of_column, int column) {
        return second_difference([&](ivec2 p) { return of_column(column + p.x); }, x);
    };
    // Eight pixels of a floor, from w = 1 to w = 3.
    const auto inverse_w_at = [](int i) { return 1 - static_cast<float>(i) / 12; };
    const auto distance_at = [&](int i) { return 1 / inverse_w_at(i); };
    for (int i = 1; i < 8; ++i)
        ASSERT_NEAR(bend_of(inverse_w_at, i), 0, 4 * FLT_EPSILON)
            << "second_difference() of 1/w, which falls evenly by 1/12 a pixel; pixel " << i;
    EXPECT_NEAR(bend_of(distance_at, 1), 0.018, 0.0005) << "of w itself";
    EXPECT_NEAR(bend_of(distance_at, 2), 0.024, 0.0005) << "of w itself";
    EXPECT_NEAR(bend_of(distance_at, 3), 0.033, 0.0005) << "of w itself";
    // A step from w = 10 to w = 10.5.
    const auto step = [](int i) { return i < 4 ? 0.1f : 1 / 10.5f; };
    EXPECT_NEAR(bend_of(step, 3), -0.00476, 0.000005) << "of 0.1, 0.1, 0.09524";
    EXPECT_NEAR(bend_of(step, 4), 0.00476, 0.000005) << "of 0.1, 0.09524, 0.09524";
}

TEST(Toon, HardCase_ASheetHasNoRimWhereItShowsItsFront) {
    look_up("Eq. 7.10, a sheet that is not closed");
    Scene sheet = scene_of_one(cube_mesh(true));
    sheet.meshes[0].triangles.erase(sheet.meshes[0].triangles.begin(),
                                    sheet.meshes[0].triangles.end() - 2);  // z = 1 is left
    for (const float yaw : {0.0f, 30.0f, -50.0f}) {
        const Image<Seen> seen = seen_in(toon_picture(sheet, before_the_cube(yaw)));
        ASSERT_EQ(count_of(seen, Seen::ink), 0) << "pixels inked, with --yaw " << yaw;
        ASSERT_GT(count_of(seen, Seen::body), 5000) << "pixels of the body, with --yaw " << yaw;
    }
}

TEST(Toon, HardCase_ASheetSeenFromBehindFacesTheEye) {
    look_up("Eq. 7.6, normals of backs");
    Scene sheet = scene_of_one(cube_mesh(true));
    sheet.meshes[0].triangles.erase(sheet.meshes[0].triangles.begin(),
                                    sheet.meshes[0].triangles.end() - 2);  // z = 1 is left
    lesson_07::Options options = before_the_cube(180);
    options.shading.outline = Outline::facing;
    options.shading.two_sided = true;
    const Image<Seen> seen = seen_in(toon_picture(sheet, options));
    EXPECT_EQ(count_of(seen, Seen::ink), 0);
    EXPECT_GT(count_of(seen, Seen::body), 5000);
}

TEST(Toon, HardCase_TheHullAlsoDrawsLinesWithinThePicture) {
    look_up("Eq. 7.10, an arm in front of the body");
    // A small cube in front of a large one, and the same one that sticks half in it.
    for (const bool is_apart : {true, false}) {
        Scene scene = scene_of_one(cube_mesh(true));
        Mesh small = cube_mesh(true);
        for (vec3& position : small.positions)
            position = 0.3f * position + vec3(0, 0, is_apart ? 1.6f : 1);
        scene.meshes.push_back(small);
        lesson_07::Options options = before_the_cube(0);
        options.shading.outline_width_px = 4;
        const Image<Seen> seen = seen_in(toon_picture(scene, options));
        int within = 0;
        for (int x = 150; x < 250; ++x) within += seen[{x, 150}] == Seen::ink;
        if (is_apart)
            EXPECT_NEAR(within, 2 * 4 / std::sqrt(2), 2);
        else
            EXPECT_EQ(within, 0) << "the rim lies behind the large one's face";
    }
}

TEST(Toon, HardCase_SmallBallsAreInkAllOver) {
    look_up("Eq. 7.14, small round bodies");
    // Balls in orthographic projection, of radius R pixels, with lines of 2 r pixels.
    const Camera near_1{vec3(0), mat4(1), 1, 1};
    for (const int r : {1, 2, 3})
        for (const auto& [radius_over_r, is_all_ink] : {std::pair{6.2f, true}, {6.35f, false}}) {
            const float radius = radius_over_r * static_cast<float>(r);
            const ivec2 size(61), middle(30);
            DepthBuffer depth(size);
            Image<vec3> normals(size, vec3(0)), color(size, vec3(1));
            for (ivec2 p(0); p.y < size.y; ++p.y)
                for (p.x = 0; p.x < size.x; ++p.x) {
                    const vec2 n = vec2(p - middle) / radius;
                    if (glm::dot(n, n) > 1) continue;
                    normals[p] = vec3(n, std::sqrt(1 - glm::dot(n, n)));
                    depth.test_and_write(p, 0.5f);
                }
            draw_edges(depth, normals, near_1, 2 * static_cast<float>(r), {}, color);
            int bare = 0;
            for (ivec2 p(0); p.y < size.y; ++p.y)
                for (p.x = 0; p.x < size.x; ++p.x) bare += normals[p] != vec3(0) && color[p] != ink;
            ASSERT_EQ(bare == 0, is_all_ink)
                << "whether a ball of radius " << radius << " is all ink, lines of " << 2 * r
                << " pixels; without ink: " << bare;
            ASSERT_EQ(color[middle] == ink, is_all_ink)
                << "whether the middle of a ball of radius " << radius << " is ink, lines of "
                << 2 * r << " pixels";
        }
}
