// SPDX-License-Identifier: MIT
// The outlines by the facing ratio and by the inverted hull: how wide they are, and where they are
// missing.
#include <array>
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

/// The mean width of an outline whose outer or inner border is a circle.
double width_px(double ink_px, double inner_radius_px) {
    return std::sqrt((ink_px + disc_area(inner_radius_px)) / std::numbers::pi) - inner_radius_px;
}

std::array<long double, 2> on_screen(const std::array<long double, 3>& p, ivec2 size) {
    return {(p[0] / p[2] + 1) / 2 * size.x, (1 - p[1] / p[2]) / 2 * size.y};
}

}  // namespace

TEST(Toon, Eq7_7_HardCase_RingOnASphere) {
    for (const ivec2 size : {ivec2(320, 180), ivec2(640, 360), ivec2(900, 500)})
        for (const float distance : {4.0f, 8.0f})
            for (const float least : {0.1f, 0.35f, 0.7f}) {
                lesson_07::Options options = before_the_sphere(distance, size);
                options.shading.outline = Outline::facing;
                options.shading.min_facing = least;
                const Image<Seen> seen = seen_in(toon_picture(sphere(), options));
                const double outer = radius_px(1 / distance, options);
                const double inner = radius_px(std::sqrt(1 - least * least) / distance, options);
                // Each circle's pixels are counted at their centres, the mesh's are a little
                // inside.
                const double tolerance = 0.5 * (outer + inner) / 100 + 4 * std::sqrt(outer);
                const std::string what = "pixels of a sphere " + shown(distance) +
                                         " radii away, least " + shown(least) + ", in " +
                                         testing::PrintToString(size);
                ASSERT_NEAR(count_of(seen, Seen::ink), disc_area(outer) - disc_area(inner),
                            tolerance * 2)
                    << "inked " << what;
                ASSERT_NEAR(count_of(seen, Seen::body), disc_area(inner), tolerance * 2)
                    << "other " << what;
            }
}

TEST(Toon, HardCase_TheFacingOutlineGrowsWithTheSphere) {
    look_up("Eq. 7.7");
    const auto width_at = [&](float distance, ivec2 size) {
        lesson_07::Options options = before_the_sphere(distance, size);
        options.shading.outline = Outline::facing;
        const Image<Seen> seen = seen_in(toon_picture(sphere(), options));
        const double body_radius_px = std::sqrt(count_of(seen, Seen::body) / std::numbers::pi);
        return width_px(count_of(seen, Seen::ink), body_radius_px);
    };
    const double width = width_at(4, {640, 360});
    EXPECT_NEAR(width_at(4, {1280, 720}), 2 * width, 0.2);
    EXPECT_LT(width_at(8, {640, 360}), 0.6 * width);
}

TEST(Toon, HardCase_TheFacingOutlineFailsOnACube) {
    look_up("Eq. 7.6");
    const Scene cube = scene_of_one(cube_mesh(true));
    int with_a_flooded_face = 0;
    for (int yaw = 0; yaw < 360; yaw += 10) {
        lesson_07::Options options = small_toon();
        options.orbit = {static_cast<float>(yaw), 27, 3, 36};
        options.shading.outline = Outline::facing;
        const Image<Seen> seen = seen_in(toon_picture(cube, options));
        const int in = count_of(seen, Seen::ink), body = count_of(seen, Seen::body);
        with_a_flooded_face += in > (in + body) / 20;
        ASSERT_GT(gaps_in_outline(seen), 100)  // of about 250 pixels of its border
            << "gaps in the outline of a cube by the facing ratio, with --yaw " << yaw;

        options.shading.outline = Outline::hull;
        ASSERT_EQ(gaps_in_outline(seen_in(toon_picture(cube, options))), 0)
            << "gaps in the outline of a cube by a hull or by edges, with --yaw " << yaw;
        options.shading.outline = Outline::edges;
        ASSERT_EQ(gaps_in_outline(seen_in(toon_picture(cube, options))), 0)
            << "gaps in the outline of a cube by a hull or by edges, with --yaw " << yaw;
    }
    EXPECT_GT(with_a_flooded_face, 5);
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
        ASSERT_EQ(cube.positions.size(), is_shared ? 8u : 24u);
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
    int shared = 0;
    for (std::size_t i = 0; i < normals.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (mesh.positions[i] == mesh.positions[k]) {
                ++shared;
                ASSERT_EQ(normals[i], normals[k])
                    << "hull_normals() of positions " << i << " and " << k << ", both at "
                    << shown(mesh.positions[i]) << "; in full: " << shown(normals[i]) << " and "
                    << shown(normals[k]);
            }
    EXPECT_EQ(shared, 24);
}

TEST(Toon, Eq7_8_VerticesOfASphereGrowAlongTheirRadii) {
    const Mesh mesh = sphere_mesh(64, 128);  // with seam and poles several times
    const std::vector<vec3> normals = hull_normals(mesh);
    for (const Triangle& triangle : mesh.triangles)
        for (const Vertex& vertex : triangle.vertices)  // the diagonals of quads turn it a bit
            ASSERT_GT(glm::dot(normals[vertex.position], mesh.positions[vertex.position]), 0.9995f)
                << "the cosine between " << shown(normals[vertex.position]) << " and the radius "
                << shown(mesh.positions[vertex.position]);
}

TEST(Toon, Eq7_8_SheetWithTwoSidesStays) {
    Mesh sheet;
    sheet.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}};
    sheet.triangles = {{{Vertex{0}, Vertex{1}, Vertex{2}}, 0},
                       {{Vertex{0}, Vertex{2}, Vertex{1}}, 0}};
    for (const vec3 normal : hull_normals(sheet)) EXPECT_EQ(normal, vec3(0)) << "both sides cancel";
    EXPECT_TRUE(hull_normals(Mesh()).empty());
}

TEST(Toon, Eq7_9_AnExampleStraightAhead) {
    // Straight ahead at w = 4, to the right: 3 of 100 pixels, which are 2 in NDC.
    EXPECT_EQ(pushed({0, 0, 1, 4}, {1, 0, 0, 0}, 3, {100, 50}), vec4(0.24f, 0, 1, 4))
        << "3 of 100 pixels to the right at w = 4: 3 * 2/100 * 4";
    EXPECT_EQ(pushed({0, 0, 1, 4}, {0, 1, 0, 0}, 3, {100, 50}), vec4(0, 0.48f, 1, 4))
        << "3 of 50 pixels up at w = 4: 3 * 2/50 * 4";
    // Straight towards the eye or away from it: it stays.
    EXPECT_EQ(pushed({0, 0, 1, 4}, {0, 0, 1, -1}, 3, {100, 50}), vec4(0, 0, 1, 4))
        << "towards the eye: it stays";
    EXPECT_EQ(pushed({2, 2, 1, 4}, {1, 1, 0, 2}, 3, {100, 50}), vec4(2, 2, 1, 4))
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
            << "the cosine between the ways on the screen, of this push and of a small step along "
               "the normal; "
            << what;
    }
}

TEST(Toon, HardCase_TheHullIsAsWideAtAnyDistanceAndSize) {
    look_up("Eq. 7.9");
    for (const ivec2 size : {ivec2(320, 180), ivec2(640, 360), ivec2(300, 900)})
        for (const float distance : {4.0f, 6.0f, 12.0f})
            for (const float width : {1.0f, 2.0f, 3.5f, 8.0f}) {
                lesson_07::Options options = before_the_sphere(distance, size);
                if (radius_px(1 / distance, options) + width > size.x / 2.0 ||
                    radius_px(1 / distance, options) + width > size.y / 2.0)
                    continue;
                options.shading.outline = Outline::hull;
                options.shading.outline_width_px = width;
                const Image<Seen> seen = seen_in(toon_picture(sphere(), options));
                const double body_radius_px =
                    std::sqrt(count_of(seen, Seen::body) / std::numbers::pi);
                const std::string what = " of a sphere " + shown(distance) + " radii away, width " +
                                         shown(width) + ", in " + testing::PrintToString(size) +
                                         " pixels";
                ASSERT_NEAR(body_radius_px, radius_px(1 / distance, options), 0.1)
                    << "the radius" << what;
                // What counting pixels of two circles leaves: the mean width, to a seventh.
                ASSERT_NEAR(width_px(count_of(seen, Seen::ink), body_radius_px), width, 0.15)
                    << "the mean width of the rim" << what;
                if (width >= 2) { ASSERT_EQ(gaps_in_outline(seen), 0) << "gaps" << what; }
            }
}

TEST(Toon, HardCase_TheRimOfABodyOutsideReachesIn) {
    look_up("Eq. 7.9");
    // A cube just outside of the picture, to the left.
    Camera camera{vec3(0), mat4(1), glm::radians(90.0f), 1};
    const ivec2 size(64);
    Mesh cube = cube_mesh(true);
    cube.bounds = {};
    for (vec3& position : cube.positions) {
        position =
            20.0f * position + vec3(-111, 0, -70);  // its right side: x = -91, w from 50 to 90
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

TEST(Toon, HardCase_TheHullOfACubeHasNoGaps) {
    look_up("Eq. 7.8");
    for (const bool is_shared : {true, false})
        for (int yaw = -180; yaw < 180; yaw += 15)
            for (const float pitch : {-90.0f, -35.0f, 0.0f, 10.0f, 60.0f}) {
                lesson_07::Options options = small_toon();
                options.orbit = {static_cast<float>(yaw), pitch, 3, 36};
                options.shading.outline = Outline::hull;
                const Image<Seen> seen =
                    seen_in(toon_picture(scene_of_one(cube_mesh(is_shared)), options));
                const std::string what =
                    "a cube whose faces " + std::string(is_shared ? "share" : "do not share") +
                    " positions, with --yaw " + std::to_string(yaw) + " --pitch " + shown(pitch);
                ASSERT_EQ(gaps_in_outline(seen), 0) << "gaps in the hull of " << what;
                options.shading.outline = Outline::none;
                const Image<Seen> bare =
                    seen_in(toon_picture(scene_of_one(cube_mesh(is_shared)), options));
                // The hull lies outside: it hides nothing of the cube.
                ASSERT_EQ(count_of(seen, Seen::body), count_of(bare, Seen::body))
                    << "pixels with a hull and without, of " << what;
            }
}

TEST(Toon, Eq7_10_BacksOfFaces) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> any(-1, 1);
    Mesh mesh;
    mesh.positions.resize(3);
    mesh.triangles = {{{Vertex{0}, Vertex{1}, Vertex{2}}, 0}};
    int backs = 0;
    for (int i = 0; i < 100'000; ++i) {
        const float scale = std::exp2(120 * any(random));  // also where floats would overflow
        for (vec3& p : mesh.positions) p = scale * vec3(any(random), any(random), any(random));
        const vec3 eye = scale * vec3(any(random), any(random), any(random));
        // Six times the volume of the eye and the vertices, by its first column.
        const auto from_eye = [&](int k, int axis) {
            return (static_cast<long double>(mesh.positions[static_cast<std::size_t>(k)][axis]) -
                    eye[axis]) /
                   scale;
        };
        const auto minor = [&](int k, int l) {
            return from_eye(k, 1) * from_eye(l, 2) - from_eye(k, 2) * from_eye(l, 1);
        };
        const long double volume = from_eye(0, 0) * minor(1, 2) + from_eye(1, 0) * minor(2, 0) +
                                   from_eye(2, 0) * minor(0, 1);
        if (std::abs(volume) < 1e-12L) continue;  // edge-on: either
        ASSERT_EQ(is_seen_from_behind(mesh, mesh.triangles[0], eye), volume > 0)
            << "whether the back is seen of " << shown(mesh.positions[0]) << ", "
            << shown(mesh.positions[1]) << ", " << shown(mesh.positions[2]) << " from "
            << shown(eye) << "; seed 3, case " << i;
        backs += volume > 0;
    }
    EXPECT_GT(backs, 40'000);
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
