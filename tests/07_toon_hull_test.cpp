// SPDX-License-Identifier: MIT
// The outlines by the facing ratio and by the inverted hull: how wide they are, and where they are
// missing.
#include <array>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "07_toon/outline.hpp"
#include "support/cases.hpp"
#include "support/lit_sphere.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/printers.hpp"
#include "support/toon_pictures.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

const Scene& sphere() {  // of radius 1; its vertices lie on the sphere, its faces .0003 inside
    static const Scene scene = scene_of_one(sphere_mesh(128, 256));
    return scene;
}

/// Seen from `distance` in its radii, so that it is in the middle of the picture.
lesson_07::Options before_the_sphere(float distance, ivec2 size) {
    lesson_07::Options options;
    options.size = size;
    // In radii of its bounding box, whose corners are not on the sphere.
    options.orbit = {-30, 27, distance / sphere().bounds().radius(), 36};
    return options;
}

/// The radius of a cone around the way to the middle of the picture, in pixels.
double radius_px(double sine, const lesson_07::Options& options) {
    const double tangent = sine / std::sqrt(1 - sine * sine);
    return options.size.y / 2.0 * tangent / std::tan(glm::radians(36.0) / 2);
}

double disc_area(double radius) { return std::numbers::pi * radius * radius; }

/// A cube almost in orthographic projection: from far away, with a small field of view.
lesson_07::Options before_the_cube(float yaw_degrees) {
    lesson_07::Options options;
    options.size = {400, 300};
    options.orbit = {yaw_degrees, 0, 200, 0.4f};
    options.shading.outline = Outline::hull;
    options.shading.outline_width_px = 24;
    return options;
}

/// That cube's side z = 1 alone.
Scene one_side() {
    Scene scene = scene_of_one(cube_mesh(true));
    std::vector<Triangle>& triangles = scene.meshes[0].triangles;
    triangles.erase(triangles.begin(), triangles.end() - 2);
    return scene;
}

/// The ink above the body in one column, in pixels.
int rim_above(const Image<Seen>& seen, int x) {
    int rim = 0;
    for (int y = 0; y < seen.size().y && seen[{x, y}] != Seen::body; ++y)
        rim += seen[{x, y}] == Seen::ink;
    return rim;
}

std::array<long double, 2> on_screen(const std::array<long double, 3>& p, ivec2 size) {
    return {(p[0] / p[2] + 1) / 2 * size.x, (1 - p[1] / p[2]) / 2 * size.y};
}

}  // namespace

TEST(Toon, Eq7_7_ExampleOfARing) {
    // A ray from (0, 0, 5) at an angle to the direction to the centre of the sphere of radius 1.
    const auto seen_at = [](double degrees) {
        const dvec3 eye(0, 0, 5);
        const dvec3 ray(std::sin(glm::radians(degrees)), 0, -std::cos(glm::radians(degrees)));
        const double along = -glm::dot(eye, ray);
        const double inside = along * along - (glm::dot(eye, eye) - 1);
        if (inside < 0) return Seen::paper;
        const dvec3 point = eye + (along - std::sqrt(inside)) * ray;
        return is_facing_outline(facing_ratio(vec3(point), vec3(-ray)), 0.35f) ? Seen::ink
                                                                               : Seen::body;
    };
    EXPECT_EQ(seen_at(10.79), Seen::body) << "10.79 degrees: inside of the ring; least 0.35";
    EXPECT_EQ(seen_at(10.81), Seen::ink) << "10.81 degrees: just in the ring; least 0.35";
    EXPECT_EQ(seen_at(11.53), Seen::ink) << "11.53 degrees: just in the ring; least 0.35";
    EXPECT_EQ(seen_at(11.55), Seen::paper) << "11.55 degrees: beside the sphere; least 0.35";
}

TEST(Toon, Eq7_7_HardCase_RingOnASphere) {
    for (const ivec2 size : {ivec2(320, 180), ivec2(900, 500)})
        for (const float distance : {4.0f, 8.0f})
            for (const float least : {0.1f, 0.35f, 0.7f}) {
                lesson_07::Options options = before_the_sphere(distance, size);
                options.shading.outline = Outline::facing;
                options.shading.min_facing = least;
                const Image<Seen> seen = seen_in(toon_picture(sphere(), options));
                const double outer = radius_px(1 / distance, options);
                const double inner = radius_px(std::sqrt(1 - least * least) / distance, options);
                // Pixels are counted at their centres, and the mesh's are a little inside.
                const double tolerance = (outer + inner) / 100 + 8 * std::sqrt(outer);
                const std::string what = "pixels of a sphere " + shown(distance) +
                                         " radii away, least " + shown(least) + ", in " +
                                         testing::PrintToString(size);
                ASSERT_NEAR(count_of(seen, Seen::ink), disc_area(outer) - disc_area(inner),
                            tolerance)
                    << "inked " << what;
                ASSERT_NEAR(count_of(seen, Seen::body), disc_area(inner), tolerance)
                    << "other " << what;
            }
}

TEST(Toon, HardCase_ASheetSeenFromBehindFacesTheEye) {
    look_up("Eq. 7.6, normals of backs");
    lesson_07::Options options = before_the_cube(180);
    options.shading.outline = Outline::facing;
    options.shading.two_sided = true;
    const Image<Seen> seen = seen_in(toon_picture(one_side(), options));
    EXPECT_EQ(count_of(seen, Seen::ink), 0);
    EXPECT_GT(count_of(seen, Seen::body), 5000);
}

TEST(Toon, Eq7_8_ExampleOfTwoFaces) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    mesh.triangles = {{{Vertex{0}, Vertex{1}, Vertex{2}}, 0},   // its normal is (1, 0, 0)
                      {{Vertex{0}, Vertex{2}, Vertex{3}}, 0}};  // and that is (0, 1, 0)
    EXPECT_TRUE(are_near(hull_normals(mesh)[0], {std::sqrt(0.5), std::sqrt(0.5), 0}, FLT_EPSILON))
        << "hull_normals()[0], where faces with the normals (1, 0, 0) and (0, 1, 0) meet, each "
           "with a right angle";
}

TEST(Toon, Eq7_8_VerticesOfACubeGrowOutwards) {
    for (const bool is_shared : {true, false}) {
        Mesh cube = cube_mesh(is_shared);
        for (std::size_t i = 0; i < 6; i += 2) {  // three faces cut along their other diagonal
            const auto [a, b, c] = cube.triangles[i].vertices;
            const Vertex d = cube.triangles[i + 1].vertices[2];
            cube.triangles[i].vertices = {b, c, d};
            cube.triangles[i + 1].vertices = {b, d, a};
        }
        const std::vector<vec3> normals = hull_normals(cube);
        for (std::size_t i = 0; i < normals.size(); ++i)
            ASSERT_TRUE(are_near(normals[i], dvec3(cube.positions[i]) / std::sqrt(3.0), 1e-6))
                << "hull_normals() at the cube's vertex " << shown(cube.positions[i])
                << (is_shared ? ", one position for its faces"
                              : ", a position for each of its faces")
                << "; by angles: a face's two triangles do not count two thirds";
    }
}

TEST(Toon, Eq7_8_EqualPositionsGetTheSameBits) {
    Mesh mesh = cube_mesh(false);
    for (vec3& position : mesh.positions) position -= vec3(1, 0, 1);  // some at 0
    for (std::size_t i = 0; i < mesh.positions.size() / 2; ++i)       // those of three faces
        for (int axis = 0; axis < 3; ++axis)
            if (mesh.positions[i][axis] == 0) mesh.positions[i][axis] = -0.0f;
    const std::vector<vec3> normals = hull_normals(mesh);
    for (std::size_t i = 0; i < normals.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (mesh.positions[i] == mesh.positions[k]) {
                ASSERT_EQ(normals[i], normals[k]) << "hull_normals() of positions " << i << " and "
                                                  << k << ", both at " << shown(mesh.positions[i]);
            }
}

TEST(Toon, Eq7_8_SheetWithTwoSidesStays) {
    Mesh sheet;
    sheet.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}};
    sheet.triangles = {{{Vertex{0}, Vertex{1}, Vertex{2}}, 0},
                       {{Vertex{0}, Vertex{2}, Vertex{1}}, 0}};
    for (const vec3 normal : hull_normals(sheet)) EXPECT_EQ(normal, vec3(0)) << "both sides cancel";
    EXPECT_TRUE(hull_normals(Mesh()).empty());
}

TEST(Toon, Eq7_9_ExampleOfFivePixels) {
    const ivec2 size(400, 200);
    const mat4 clip_from_view = perspective(glm::radians(90.0f), 2.0f, 1.0f);
    const vec4 position = clip_from_view * vec4(1.2f, 1.6f, -2, 1);
    const vec4 moved = pushed(position, clip_from_view * vec4(0.48f, 0.64f, 0.6f, 0), 5, size);
    EXPECT_TRUE(are_near(moved, dvec4(0.63, 1.68, 1, 2), 2 * FLT_EPSILON))
        << "pushed() of (0.6, 1.6, 1, 2) along (0.24, 0.64, -, -0.6) by 5 pixels of 400 x 200";
    EXPECT_TRUE(are_near(vec2(screen_from_clip(moved, size)), dvec2(263, 16), 1e-4))
        << "on the screen, from (260, 20)";
    EXPECT_EQ(pushed({0, 0, 1, 4}, {0, 0, 1, -1}, 3, size), vec4(0, 0, 1, 4))
        << "towards the eye: it stays";
    EXPECT_EQ(pushed({2, 2, 1, 4}, {1, 1, 0, 2}, 3, size), vec4(2, 2, 1, 4))
        << "away from the eye: it stays";
}

TEST(Toon, Eq7_9_MovesAlongItsNormal) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(-1, 1), octave(-20, 20);
    for (int i = 0; i < cases_of(100'000); ++i) {
        const float scale = std::exp2(octave(random));
        const float w = scale * (1.1f + any(random));
        const vec4 position(w * any(random), w * any(random), w * any(random), w);
        const vec4 normal(any(random), any(random), any(random), any(random));
        const ivec2 size(1 + random() % 4000, 1 + random() % 4000);
        const float width = 10 * (1.01f + any(random));
        const vec4 moved = pushed(position, normal, width, size);
        const std::string what = "pushed(" + shown(position) + ", " + shown(normal) + ", " +
                                 shown(width) + ", " + testing::PrintToString(size) + ") is " +
                                 shown(moved) + "; seed 1, case " + std::to_string(i);
        ASSERT_EQ(moved.z, position.z) << what;
        ASSERT_EQ(moved.w, position.w) << what;

        const auto from = on_screen({position.x, position.y, position.w}, size);
        const auto to = on_screen({moved.x, moved.y, moved.w}, size);
        const long double x = to[0] - from[0], y = to[1] - from[1];
        // A coordinate of up to w is rounded by 2^-24 of itself: of 4000 pixels, .0003.
        ASSERT_LE(std::abs(std::hypot(x, y) - width), 0.001L)
            << "on the screen it moves by " << std::hypot(x, y) << " pixels; " << what;
        // As a small step along the normal moves it.
        const long double step = 1e-6L * scale;
        const auto ahead = on_screen(
            {position.x + step * normal.x, position.y + step * normal.y, w + step * normal.w},
            size);
        const long double ahead_x = ahead[0] - from[0], ahead_y = ahead[1] - from[1];
        const long double length = std::hypot(ahead_x, ahead_y);
        if (length < 1e-5L) continue;  // nearly towards the eye: float has no direction
        ASSERT_GE((x * ahead_x + y * ahead_y) / (length * width), 0.999L)
            << "the cosine between this push and a small step along the normal; " << what;
    }
}

TEST(Toon, HardCase_TheRimOfABodyOutsideReachesIn) {
    look_up("Eq. 7.9");
    const Camera camera{vec3(0), mat4(1), glm::radians(90.0f), 1};
    const ivec2 size(64);
    Mesh cube = cube_mesh(true);
    cube.bounds = {};
    for (vec3& position : cube.positions) {  // its right side: x = -91, w from 50 to 90
        position = 20.0f * position + vec3(-111, 0, -70);
        cube.bounds.add(position);
    }
    ASSERT_TRUE(is_outside_frustum(cube.bounds, camera.clip_from_world(size)));
    for (const auto& [width, is_in] : {std::pair{0.25f, false}, {6.0f, true}}) {
        const CountedSince counters;
        Image<vec3> color(size, paper_color);
        DepthBuffer depth(size);
        draw_hull(cube, hull_normals(cube), camera, width, depth, color);
        EXPECT_EQ(counters[Counter::outline_pixels] > 0, is_in)
            << "whether pixels are counted, of a cube just outside at the left, width " << width;
        EXPECT_EQ(color[ivec2(0, 32)] == ink, is_in)
            << "whether the rim reaches into pixel (0, 32), width " << width;
    }
}

TEST(Toon, HardCase_TheOutlineOfACubeHasNoGaps) {
    look_up("Eq. 7.8");
    for (const bool is_shared : {true, false})
        for (int yaw = -180; yaw < 180; yaw += 15)
            for (const float pitch : {-90.0f, -35.0f, 0.0f, 10.0f, 60.0f}) {
                const Scene cube = scene_of_one(cube_mesh(is_shared));
                lesson_07::Options options = small_toon();
                options.orbit = {static_cast<float>(yaw), pitch, 3, 36};
                const auto seen_with = [&](Outline outline) {
                    options.shading.outline = outline;
                    return seen_in(toon_picture(cube, options));
                };
                const std::string what =
                    " of a cube whose faces " + std::string(is_shared ? "share" : "do not share") +
                    " positions, with --yaw " + std::to_string(yaw) + " --pitch " + shown(pitch);
                ASSERT_EQ(gaps_in_outline(seen_with(Outline::edges)), 0) << "gaps in edges" << what;
                const Image<Seen> seen = seen_with(Outline::hull);
                ASSERT_EQ(gaps_in_outline(seen), 0) << "gaps in the hull" << what;
                // The hull lies outside: it hides nothing of the cube.
                ASSERT_EQ(count_of(seen, Seen::body),
                          count_of(seen_with(Outline::none), Seen::body))
                    << "pixels with a hull and without," << what;
            }
}

TEST(Toon, Eq7_10_AnExampleOfEitherSide) {
    Mesh mesh;
    mesh.positions = {{0, 0, -2}, {1, 0, -2}, {0, 1, -2}};
    EXPECT_FALSE(is_seen_from_behind(mesh, {{Vertex{0}, Vertex{1}, Vertex{2}}, 0}, vec3(0)))
        << "(0, 0, -2), (1, 0, -2), (0, 1, -2), from the origin: its front";
    EXPECT_TRUE(is_seen_from_behind(mesh, {{Vertex{0}, Vertex{2}, Vertex{1}}, 0}, vec3(0)))
        << "(0, 0, -2), (0, 1, -2), (1, 0, -2), from the origin: its back";
}

TEST(Toon, Eq7_10_BacksOfFaces) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> any(-1, 1);
    Mesh mesh;
    mesh.positions.resize(3);
    mesh.triangles = {{{Vertex{0}, Vertex{1}, Vertex{2}}, 0}};
    for (int i = 0; i < cases_of(100'000); ++i) {
        const float scale = std::exp2(120 * any(random));  // also where floats would overflow
        const vec3 eye = scale * vec3(any(random), any(random), any(random));
        glm::mat<3, 3, long double> from_eye;
        for (int k = 0; k < 3; ++k) {
            vec3& p = mesh.positions[static_cast<std::size_t>(k)];
            p = scale * vec3(any(random), any(random), any(random));
            for (int axis = 0; axis < 3; ++axis)
                from_eye[k][axis] = (static_cast<long double>(p[axis]) - eye[axis]) / scale;
        }
        const long double volume = glm::determinant(from_eye);  // times 6
        if (std::abs(volume) < 1e-12L) continue;                // edge-on: either
        ASSERT_EQ(is_seen_from_behind(mesh, mesh.triangles[0], eye), volume > 0)
            << "whether the back is seen of " << shown(mesh.positions[0]) << ", "
            << shown(mesh.positions[1]) << ", " << shown(mesh.positions[2]) << " from "
            << shown(eye) << "; seed 3, case " << i;
    }
}

TEST(Toon, Eq7_10_HardCase_RimsOfACube) {
    const Scene cube = scene_of_one(cube_mesh(true));
    const float width = 24;
    const Image<Seen> face_on = seen_in(toon_picture(cube, before_the_cube(0)));
    for (const int x : {180, 200, 220})
        ASSERT_NEAR(rim_above(face_on, x), width / std::sqrt(2), 1)
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

TEST(Toon, HardCase_ASheetHasNoRimWhereItShowsItsFront) {
    look_up("Eq. 7.10, a sheet that is not closed");
    for (const float yaw : {0.0f, 30.0f, -50.0f}) {
        const Image<Seen> seen = seen_in(toon_picture(one_side(), before_the_cube(yaw)));
        ASSERT_EQ(count_of(seen, Seen::ink), 0) << "pixels inked, with --yaw " << yaw;
        ASSERT_GT(count_of(seen, Seen::body), 5000) << "pixels of the body, with --yaw " << yaw;
    }
}

TEST(Toon, HardCase_TheHullAlsoDrawsLinesWithinThePicture) {
    look_up("Eq. 7.10, an arm in front of the body");
    // A small cube in front of a large one, and the same one that sticks half in it.
    for (const auto& [z, expected] : {std::pair{1.6f, 2 * 4 / std::sqrt(2)}, {1.0f, 0.0}}) {
        Scene scene = scene_of_one(cube_mesh(true));
        Mesh small = cube_mesh(true);
        for (vec3& position : small.positions) position = 0.3f * position + vec3(0, 0, z);
        scene.meshes.push_back(small);
        lesson_07::Options options = before_the_cube(0);
        options.shading.outline_width_px = 4;
        const Image<Seen> seen = seen_in(toon_picture(scene, options));
        int within = 0;
        for (int x = 150; x < 250; ++x) within += seen[{x, 150}] == Seen::ink;
        EXPECT_NEAR(within, expected, expected == 0 ? 0 : 2)
            << "pixels inked in a row across a small cube around z = " << z
            << " and a large one from -1 to 1, which hides the rim that lies behind its face";
    }
}

TEST(Toon, HardCase_TheHullOfABowlHidesNothing) {
    look_up("Eq. 7.10");
    // A bowl: around its bottom, hull normals point to the middle, and small faces turn around.
    Mesh bowl = sphere_mesh(64, 128);
    for (Triangle& triangle : bowl.triangles) std::swap(triangle.vertices[1], triangle.vertices[2]);
    for (vec3& normal : bowl.normals) normal = -normal;
    std::erase_if(bowl.triangles, [&](const Triangle& triangle) {
        return bowl.positions[triangle.vertices[0].position].y > -0.3f;
    });
    lesson_07::Options options = small_toon();
    options.orbit = {-30, 80, 2, 36};
    options.shading.outline = Outline::none;
    const Image<Seen> bare = seen_in(toon_picture(scene_of_one(bowl), options));
    options.shading.outline = Outline::hull;
    options.shading.outline_width_px = 10;
    const Image<Seen> seen = seen_in(toon_picture(scene_of_one(bowl), options));
    EXPECT_GT(count_of(bare, Seen::body), 5000);
    EXPECT_EQ(count_of(seen, Seen::body), count_of(bare, Seen::body));
}
