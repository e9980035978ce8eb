// SPDX-License-Identifier: MIT
// Normals for models that come without.
#include <array>
#include <cfloat>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "06_phong/normals.hpp"
#include "common/model/obj.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/one_triangle.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr vec3 upwards(0, 1, 0);

/// Two squares that meet along z at a corner of each, position 0: a flat one, cut in two triangles
/// through it, and one that is bent down and cut the other way.
Mesh bent_squares(double degrees) {
    const auto down = static_cast<float>(-std::sin(glm::radians(degrees)));
    const auto across = static_cast<float>(std::cos(glm::radians(degrees)));
    return mesh_of(
        {vec3(0), {-1, 0, 0}, {-1, 0, 1}, {0, 0, 1}, {across, down, 1}, {across, down, 0}},
        {{0, 1, 2}, {0, 2, 3}, {3, 4, 5}, {3, 5, 0}});
}

/// Narrow faces around the tip of a cone, position 0.
///
/// @param turn_of  Where a position lies around it, of 0 to 1.
template <typename TurnOf>
Mesh cone(std::uint32_t sides, const TurnOf& turn_of) {
    std::vector<vec3> positions = {{0, 0.7f, 0}};
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double azimuth = 2 * std::numbers::pi * turn_of(static_cast<double>(i) / sides);
        positions.push_back(vec3(dvec3(std::sin(azimuth), 0, std::cos(azimuth))));
        triangles.push_back({0, 1 + i, 1 + (i + 1) % sides});
    }
    return mesh_of(positions, triangles);
}

}  // namespace

TEST(Phong, Eq6_9_AFaceIsCounterClockwiseSeenFromItsFront) {
    const Mesh floor = mesh_of({vec3(0), {0, 0, 1}, {1, 0, 0}}, {{0, 1, 2}, {0, 2, 1}});
    EXPECT_EQ(face_normal(floor, floor.triangles[0]), upwards)
        << "of the vertices (0, 0, 0), (0, 0, 1), (1, 0, 0)";
    EXPECT_EQ(face_normal(floor, floor.triangles[1]), -upwards)
        << "of the vertices (0, 0, 0), (1, 0, 0), (0, 0, 1)";
}

TEST(Phong, Eq6_9_AngleCountsAndNotTheNumberOfTriangles) {
    // The worked example.
    const Mesh mesh = bent_squares(45);
    const SmoothNormals smooth(mesh);
    const float s = std::sqrt(0.5f);
    const vec3 flat(0, 1, 0), slope(s, s, 0);
    // The angles, their normals and the sum round a dozen times, each by less than 1e-5 degrees.
    constexpr double tolerance = 1e-4;
    EXPECT_LT(degrees_between(face_normal(mesh, mesh.triangles[0]), flat), tolerance)
        << "degrees from face_normal() to (0, 1, 0)";
    EXPECT_LT(degrees_between(face_normal(mesh, mesh.triangles[2]), slope), tolerance)
        << "degrees from face_normal() to (0.707, 0.707, 0)";
    for (const vec3 of_face : {flat, slope})
        for (const vec3 other : {flat, slope})
            EXPECT_NEAR(degrees_between(smooth.at(0, of_face), other), 22.5, tolerance)
                << "degrees from SmoothNormals::at(0, " << shown(of_face) << ") to " << shown(other)
                << "; 14.6 or 30.4, if each triangle counts once";
}

TEST(Phong, Eq6_9_FacesBeyondASharpEdgeDoNotCount) {
    for (const int bend : {1, 49, 51, 90, 179}) {
        Mesh mesh = bent_squares(bend);
        complete_normals(mesh);
        const vec3 at_edge = mesh.normals[mesh.triangles[0].vertices[0].normal];
        const vec3 apart = mesh.normals[mesh.triangles[0].vertices[1].normal];
        ASSERT_EQ(apart, upwards)
            << "complete_normals() at a vertex where only this face is: its own, of length 1";
        ASSERT_NEAR(degrees_between(at_edge, upwards), bend < 50 ? 0.5 * bend : 0, 1e-4)
            << "degrees by which the normal at an edge of " << bend << " degrees leans, "
            << shown(at_edge) << " for the face whose own is (0, 1, 0)";
    }
}

TEST(Phong, HardCase_ACrateWithoutNormalsStaysSharp) {
    look_up("Eq. 6.9");
    Scene crate = load_obj(std::filesystem::path(RASTERBOOK_ASSETS) / "models/crate.obj");
    for (Mesh& mesh : crate.meshes) {
        for (Triangle& triangle : mesh.triangles)
            for (Vertex& vertex : triangle.vertices) vertex.normal = no_index;
        complete_normals(mesh);
        ASSERT_EQ(mesh.normals.size(), 3 * mesh.triangles.size());
        for (const Triangle& triangle : mesh.triangles)
            for (const Vertex& vertex : triangle.vertices)
                ASSERT_EQ(mesh.normals[vertex.normal], face_normal(mesh, triangle));
    }
}

TEST(Phong, HardCase_SomeVerticesWithoutNormals) {
    look_up("Eq. 6.9");
    // The file's normals stay, but for their length; the others are those of the faces around.
    Mesh mesh = mesh_of({vec3(0), {0, 0, 1}, {1, 0, 0}}, {{0, 1, 2}});
    mesh.normals = {vec3(0), {3, 4, 0}};
    mesh.triangles[0].vertices[0].normal = 1;
    mesh.triangles[0].vertices[1].normal = 0;
    complete_normals(mesh);
    ASSERT_EQ(mesh.normals.size(), 3u);
    EXPECT_EQ(mesh.normals[mesh.triangles[0].vertices[0].normal], vec3(0.6f, 0.8f, 0))
        << "of (3, 4, 0) in the file";
    EXPECT_EQ(mesh.normals[mesh.triangles[0].vertices[1].normal], upwards)
        << "of length 0 in the file: the face's";
    EXPECT_EQ(mesh.normals[mesh.triangles[0].vertices[2].normal], upwards) << "none in the file";
}

TEST(Phong, HardCase_TrianglesOfNoAreaChangeNoNormals) {
    look_up("Eq. 6.9");
    // A slope, and a triangle that is a line through its lower corners, with an angle of 180
    // degrees at the one in the middle.
    const std::vector<vec3> positions = {{-1, 0, 1}, {0, 0, 1}, {1, 0, 1}, {1, 1, -1}, {-1, 1, -1}};
    const Mesh slope = mesh_of(positions, {{0, 1, 4}, {1, 2, 3}, {1, 3, 4}});
    const Mesh with_line =
        mesh_of(positions, {{0, 1, 4}, {1, 2, 3}, {1, 3, 4}, {0, 2, 1}, {1, 1, 1}});
    const vec3 of_face = face_normal(slope, slope.triangles[0]);
    EXPECT_GT(glm::dot(of_face, upwards), cos_sharp);
    for (std::uint32_t position = 0; position < 5; ++position)
        EXPECT_EQ(SmoothNormals(slope).at(position, of_face),
                  SmoothNormals(with_line).at(position, of_face))
            << "position " << position << ", without triangles of no area and with two of them";
    Mesh lone = mesh_of({vec3(1), vec3(2), vec3(3)}, {{0, 1, 2}});
    complete_normals(lone);
    for (const vec3 normal : lone.normals) EXPECT_EQ(normal, upwards);
}

TEST(Phong, HardCase_WhereThousandsOfFacesMeetASheetKeepsItsTwoSides) {
    look_up("Robust: Which faces count");
    // A disc of narrow triangles around its middle, each with one of its back.
    Mesh disc = cone(1000, [](double part) { return part; });
    disc.positions[0] = vec3(0);
    for (const Triangle& front : std::vector(disc.triangles)) {
        const auto [a, b, c] = front.vertices;
        disc.triangles.push_back({{a, c, b}, 0});
    }
    const SmoothNormals smooth(disc);
    for (const vec3 of_face : {upwards, -upwards})
        // In double the angles' roundings add up to nothing; the sum is rounded to float.
        ASSERT_TRUE(are_near(smooth.at(0, of_face), 2 * std::numbers::pi * dvec3(of_face), 1e-6))
            << "SmoothNormals::at() the middle of the side whose normal is " << shown(of_face);
}

TEST(Phong, Eq6_9_HardCase_SmoothingGroupsDecideAndMeshesDoNot) {
    // Triangles of a bumpy ground in any smoothing groups, and dealt out to any meshes of one file.
    std::mt19937 random(16);
    constexpr std::uint32_t side = 10;
    std::vector<vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t i = 0; i < side * side; ++i) {
        positions.emplace_back(i % side, 2e-9f * static_cast<float>(random() % 500'000'000),
                               i / side);
        if (i % side == 0 || i < side) continue;
        triangles.push_back({i, i - side, i - 1});
        triangles.push_back({i - 1, i - side, i - side - 1});
    }
    const Mesh whole = mesh_of(positions, triangles);
    for (const std::uint32_t count : {1u, 3u}) {
        Scene scene;
        scene.meshes.resize(count);
        for (Mesh& mesh : scene.meshes) {
            mesh.positions = whole.positions;
            mesh.triangles.reserve(whole.triangles.size());
            for (std::uint32_t i = 0; count > 1 && i < whole.positions.size(); ++i)
                mesh.shared_positions.push_back(i);
        }
        constexpr std::array groups = {no_smoothing, 1u, 2u, smooth_by_angle};
        std::vector<std::uint32_t> group_of;
        std::vector<const Triangle*> dealt;  // in the scene
        std::vector<const Mesh*> mesh_of_dealt;
        for (const Triangle& triangle : whole.triangles) {
            Mesh& mesh = scene.meshes[random() % count];
            group_of.push_back(groups[random() % groups.size()]);
            mesh.triangles.push_back(triangle), mesh.smoothing_groups.push_back(group_of.back());
            dealt.push_back(&mesh.triangles.back()), mesh_of_dealt.push_back(&mesh);
        }
        const auto expected = [&](std::size_t t, std::size_t i) {
            const vec3 own = face_normal(whole, whole.triangles[t]);
            if (group_of[t] == no_smoothing) return own;
            dvec3 sum(0);
            for (std::size_t other = 0; other < whole.triangles.size(); ++other)
                for (std::size_t k = 0; k < 3; ++k) {
                    const Triangle& around = whole.triangles[other];
                    const vec3 normal = face_normal(whole, around);
                    if (around.vertices[k].position == whole.triangles[t].vertices[i].position &&
                        group_of[other] == group_of[t] &&
                        (group_of[t] != smooth_by_angle || glm::dot(normal, own) > cos_sharp))
                        sum += double{vertex_angle_radians(whole, around, k)} * dvec3(normal);
                }
            return vec3(sum);
        };
        complete_normals(scene);
        for (std::size_t t = 0; t < dealt.size(); ++t)
            for (std::size_t i = 0; i < 3; ++i)
                ASSERT_LT(degrees_between(mesh_of_dealt[t]->normals[dealt[t]->vertices[i].normal],
                                          expected(t, i)),
                          1e-3)
                    << "vertex " << i << " of triangle " << t << " in smoothing group "
                    << group_of[t] << ", of " << count << " meshes";
    }
}

TEST(Phong, Eq6_9_HardCase_WhereThousandsOfFacesMeetEachInAGroupOfItsOwn) {
    constexpr std::uint32_t sides = 100'000;
    Mesh mesh = cone(sides, [](double part) { return part; });
    for (std::uint32_t i = 0; i < sides; ++i) mesh.smoothing_groups.push_back(sides - i);
    complete_normals(mesh);  // in time that grows as the number of faces
    for (const Triangle& triangle : mesh.triangles)
        ASSERT_LT(
            degrees_between(mesh.normals[triangle.vertices[0].normal], face_normal(mesh, triangle)),
            0.1);
}

TEST(Phong, HardCase_NormalsOfTinyAndHugeFaces) {
    look_up("Eq. 6.9");
    for (const float size : {1e-45f, 1e-40f, 1e-30f, 1e-19f, 1e19f, 1e30f, 3e38f}) {
        Mesh mesh =
            mesh_of({vec3(0), {size, 0, 0}, {size, size, 0}, {0, size, 0}}, {{0, 1, 2}, {0, 2, 3}});
        EXPECT_NEAR(vertex_angle_radians(mesh, mesh.triangles[0], 0), std::numbers::pi / 4,
                    FLT_EPSILON);
        complete_normals(mesh);
        for (const vec3 normal : mesh.normals)
            ASSERT_EQ(normal, vec3(0, 0, 1)) << "of a square with sides of " << size;
    }
}

TEST(Phong, Eq6_9_HardCase_WhereThousandsOfFacesMeetNormalsAreNearlyThoseOfAllFaces) {
    // A cone, on one side of narrow faces and on the other of wide ones.
    const Mesh mesh = cone(5000, [](double part) { return part * part; });
    const SmoothNormals smooth(mesh);
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 7) {
        const vec3 own = face_normal(mesh, mesh.triangles[i]);
        dvec3 expected(0);
        for (const Triangle& other : mesh.triangles)
            if (const vec3 normal = face_normal(mesh, other); glm::dot(normal, own) > cos_sharp)
                expected += double{vertex_angle_radians(mesh, other, 0)} * dvec3(normal);
        ASSERT_LT(degrees_between(smooth.at(0, own), vec3(expected)), 2) << "face " << i;
    }
}
