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

using Quad = std::array<std::uint32_t, 4>;

constexpr vec3 upwards(0, 1, 0);

/// Quads cut along the diagonal from their first vertex, or along the other one where a bit is set.
Mesh cut(const std::vector<vec3>& positions, const std::vector<Quad>& quads, unsigned other) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t i = 0; i < quads.size(); ++i) {
        const auto [a, b, c, d] = quads[i];
        if (other >> i & 1)
            triangles.insert(triangles.end(), {{a, b, d}, {b, c, d}});
        else
            triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
    }
    return mesh_of(positions, triangles);
}

/// A ball of radius 1 of so many segments from pole to pole, and twice as many around.
Mesh ball(std::uint32_t segments) {
    std::vector<vec3> positions;
    const std::uint32_t around = 2 * segments;
    for (std::uint32_t row = 0; row <= segments; ++row)
        for (std::uint32_t column = 0; column < around; ++column) {
            const double polar = std::numbers::pi * row / segments;
            const double azimuth = 2 * std::numbers::pi * column / around;
            const double radius = row == 0 || row == segments ? 0 : std::sin(polar);
            positions.push_back(vec3(
                dvec3(radius * std::sin(azimuth), std::cos(polar), radius * std::cos(azimuth))));
        }
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t row = 0; row < segments; ++row)
        for (std::uint32_t column = 0; column < around; ++column) {
            const std::uint32_t next = (column + 1) % around;
            // At a pole all columns are its first vertex.
            const auto vertex = [&](std::uint32_t r, std::uint32_t c) {
                return r * around + (r == 0 || r == segments ? 0 : c);
            };
            if (row > 0)
                triangles.push_back(
                    {vertex(row, column), vertex(row + 1, next), vertex(row, next)});
            if (row + 1 < segments)
                triangles.push_back(
                    {vertex(row, column), vertex(row + 1, column), vertex(row + 1, next)});
            else
                triangles.back() = {vertex(row, column), vertex(row + 1, 0), vertex(row, next)};
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
    // The worked example: a square that is cut through the vertex at 0, and beyond an edge along z
    // one that is not, 45 degrees down.
    const float s = std::sqrt(0.5f);
    const Mesh mesh = cut({vec3(0), {-1, 0, 0}, {-1, 0, 1}, {0, 0, 1}, {s, -s, 1}, {s, -s, 0}},
                          {Quad{0, 1, 2, 3}, Quad{3, 4, 5, 0}}, 0);
    const SmoothNormals smooth(mesh);
    const vec3 flat(0, 1, 0), slope(s, s, 0);
    // The angles, their normals and the sum round a dozen times, each by less than 1e-5 degrees.
    constexpr double tolerance = 1e-4;
    EXPECT_LT(degrees_between(face_normal(mesh, mesh.triangles[0]), flat), tolerance)
        << "degrees from face_normal() to (0, 1, 0)";
    EXPECT_LT(degrees_between(face_normal(mesh, mesh.triangles[2]), slope), tolerance)
        << "degrees from face_normal() to (0.707, 0.707, 0)";
    for (const vec3 of_face : {flat, slope}) {
        const vec3 normal = smooth.at(0, of_face);
        EXPECT_NEAR(degrees_between(normal, flat), 22.5, tolerance)
            << "degrees from SmoothNormals::at(0, " << shown(of_face) << ") = " << shown(normal)
            << " to the face that is cut in two; 14.6, if each triangle counts once";
        EXPECT_NEAR(degrees_between(normal, slope), 22.5, tolerance)
            << "degrees from SmoothNormals::at(0, " << shown(of_face) << ") = " << shown(normal)
            << " to the other face";
    }
}

TEST(Phong, Eq6_9_AllAnglesOfATriangle) {
    const Mesh mesh = mesh_of({vec3(0), {1, 0, 0}, {1, std::sqrt(3.0f), 0}}, {{0, 1, 2}});
    constexpr float degree = std::numbers::pi_v<float> / 180;
    for (const auto& [vertex, degrees] : {std::pair{0, 60.0f}, {1, 90.0f}, {2, 30.0f}})
        EXPECT_NEAR(vertex_angle_radians(mesh, mesh.triangles[0], static_cast<std::size_t>(vertex)),
                    degrees * degree, 2 * FLT_EPSILON)
            << "radians; " << degrees << " degrees at vertex " << vertex;
}

TEST(Phong, Eq6_9_FacesBeyondASharpEdgeDoNotCount) {
    // Two squares that meet along z, the second one bent down by so many degrees.
    for (const int bend : {1, 30, 49, 51, 60, 90, 120, 179}) {
        const auto down = static_cast<float>(-std::sin(glm::radians(static_cast<double>(bend))));
        const auto across = static_cast<float>(std::cos(glm::radians(static_cast<double>(bend))));
        Mesh mesh =
            cut({vec3(0), {-1, 0, 0}, {-1, 0, 1}, {0, 0, 1}, {across, down, 1}, {across, down, 0}},
                {Quad{0, 1, 2, 3}, Quad{3, 4, 5, 0}}, 0);
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

TEST(Phong, Eq6_9_AnyCutOfPolygonsGivesTheSameNormals) {
    // A roof cut off above, all edges below 40 degrees; its sides are even exactly.
    const std::vector<vec3> positions = {{1, 1, 1}, {-1, 1, 1}, {-1, 1, -1}, {1, 1, -1},
                                         {3, 0, 3}, {-3, 0, 3}, {-3, 0, -3}, {3, 0, -3}};
    const std::vector<Quad> quads = {
        {0, 3, 2, 1}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    const Mesh one = cut(positions, quads, 0);
    const SmoothNormals first(one);
    for (unsigned way = 1; way < 32; ++way) {
        const SmoothNormals smooth(cut(positions, quads, way));
        for (std::uint32_t position = 0; position < 8; ++position)
            for (const Triangle& triangle : one.triangles) {
                const vec3 of_face = face_normal(one, triangle);
                // Six angles of at most pi, each rounded twice or so; the sum's length is above 1.
                ASSERT_LT(glm::length(first.at(position, of_face) - smooth.at(position, of_face)),
                          20 * FLT_EPSILON)
                    << "a roof cut in two ways: " << shown(first.at(position, of_face)) << " and "
                    << shown(smooth.at(position, of_face)) << " in position " << position
                    << ", cut " << way;
            }
    }
    // And they are the roof's: the upper corners' normals lean out evenly.
    const vec3 vertex = normalize_or(first.at(0, upwards), upwards);
    EXPECT_NEAR(vertex.x, vertex.z, 2 * FLT_EPSILON);
    EXPECT_GT(vertex.x, 0.1f);
}

TEST(Phong, Eq6_9_RoundBall) {
    Mesh mesh = ball(24);
    complete_normals(mesh);
    double worst = 0, worst_of_face = 0;
    for (const Triangle& triangle : mesh.triangles)
        for (const Vertex& vertex : triangle.vertices) {
            const vec3 exact = mesh.positions[vertex.position];
            worst = std::max(worst, degrees_between(mesh.normals[vertex.normal], exact));
            worst_of_face =
                std::max(worst_of_face, degrees_between(face_normal(mesh, triangle), exact));
        }
    EXPECT_LT(worst, 1) << "degrees between a vertex's normal and its radius";
    EXPECT_GT(worst_of_face, 5);  // a segment is 7.5 degrees: there was something to do
}

TEST(Phong, HardCase_ACrateWithoutNormalsStaysSharp) {
    look_up("Eq. 6.9");
    Scene crate = load_obj(std::filesystem::path(RASTERBOOK_ASSETS) / "models/crate.obj");
    for (Mesh& mesh : crate.meshes) {
        std::vector<vec3> in_file;
        for (Triangle& triangle : mesh.triangles)
            for (Vertex& vertex : triangle.vertices) {
                in_file.push_back(mesh.normals[vertex.normal]);
                vertex.normal = no_index;
            }
        complete_normals(mesh);
        ASSERT_EQ(mesh.normals.size(), in_file.size());
        std::size_t i = 0;
        for (const Triangle& triangle : mesh.triangles)
            for (const Vertex& vertex : triangle.vertices) {
                ASSERT_EQ(mesh.normals[vertex.normal], face_normal(mesh, triangle));
                ASSERT_LT(degrees_between(mesh.normals[vertex.normal], in_file[i]), 1e-3)
                    << "degrees between " << shown(mesh.normals[vertex.normal])
                    << " and the file's normal, " << shown(in_file[i]);
                ++i;
            }
    }
}

TEST(Phong, HardCase_SomeVerticesWithoutNormals) {
    look_up("Eq. 6.9");
    // The file's normals stay, but for their length; the others are those of the faces around.
    Mesh mesh = mesh_of({vec3(0), {0, 0, 1}, {1, 0, 0}}, {{0, 1, 2}});
    mesh.normals = {{3, 4, 0}, vec3(0)};
    mesh.triangles[0].vertices[0].normal = 0;
    mesh.triangles[0].vertices[1].normal = 1;
    complete_normals(mesh);
    ASSERT_EQ(mesh.normals.size(), 3u);
    EXPECT_EQ(mesh.normals[mesh.triangles[0].vertices[0].normal], vec3(0.6f, 0.8f, 0))
        << "of (3, 4, 0) in the file";
    EXPECT_EQ(mesh.normals[mesh.triangles[0].vertices[1].normal],
              upwards);  // of length 0: the face's
    EXPECT_EQ(mesh.normals[mesh.triangles[0].vertices[2].normal], upwards);
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

TEST(Phong, HardCase_FacesThatCancel) {
    look_up("Eq. 6.9");
    // Both sides of one sheet: each side keeps its own normal.
    Mesh sheet = mesh_of({vec3(0), {0, 0, 1}, {1, 0, 0}}, {{0, 1, 2}, {0, 2, 1}});
    complete_normals(sheet);
    ASSERT_EQ(sheet.normals.size(), 6u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(sheet.normals[sheet.triangles[0].vertices[i].normal], upwards);
        EXPECT_EQ(sheet.normals[sheet.triangles[1].vertices[i].normal], -upwards);
    }
}

TEST(Phong, HardCase_WhereThousandsOfFacesMeetASheetKeepsItsTwoSides) {
    look_up("Robust: Which faces count");
    // A disc of narrow triangles around its middle, each with one of its back.
    constexpr std::uint32_t sides = 1000;
    // In double the angles' roundings add up to nothing; the sum is rounded to float.
    constexpr double tolerance = 1e-6;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<vec3> positions = {vec3(0)};
        std::vector<std::array<std::uint32_t, 3>> triangles;
        for (std::uint32_t i = 0; i < sides; ++i) {
            const double azimuth = 2 * std::numbers::pi * i / sides;
            vec3 on_rim(0);
            on_rim[(axis + 1) % 3] = static_cast<float>(std::cos(azimuth));
            on_rim[(axis + 2) % 3] = static_cast<float>(std::sin(azimuth));
            positions.push_back(on_rim);
            const std::uint32_t a = 1 + i, b = 1 + (i + 1) % sides;
            triangles.insert(triangles.end(), {{0, a, b}, {0, b, a}});
        }
        const SmoothNormals smooth(mesh_of(positions, triangles));
        for (const float side : {1.0f, -1.0f}) {
            vec3 of_face(0);
            of_face[axis] = side;
            const dvec3 sum = smooth.at(0, of_face);
            ASSERT_NEAR(glm::length(sum - 2 * std::numbers::pi * dvec3(of_face)), 0, tolerance)
                << "SmoothNormals::at() the middle of the side whose normal is " << shown(of_face)
                << " is " << shown(vec3(sum)) << " instead of 2 pi times that";
        }
    }
}

TEST(Phong, Eq6_9_HardCase_SmoothingGroupsDecideAndMeshesDoNot) {
    // A ball's triangles in any smoothing groups, and dealt out to any meshes of one file.
    const Mesh whole = ball(6);
    std::mt19937 random(16);
    for (const std::uint32_t count : {1u, 3u}) {
        Scene scene;
        scene.meshes.resize(count);
        for (Mesh& mesh : scene.meshes) {
            mesh.positions = whole.positions;
            if (count == 1) continue;
            for (std::uint32_t i = 0; i < whole.positions.size(); ++i)
                mesh.shared_positions.push_back(i);
        }
        constexpr std::array groups = {no_smoothing, 1u, 2u, smooth_by_angle};
        std::vector<std::uint32_t> group_of;
        std::vector<const Triangle*> dealt;  // in the scene
        std::vector<const Mesh*> mesh_of_dealt;
        for (Mesh& mesh : scene.meshes) mesh.triangles.reserve(whole.triangles.size());
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
    std::vector<vec3> positions = {{0, 0.7f, 0}};
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double azimuth = 2 * std::numbers::pi * i / sides;
        positions.push_back(vec3(dvec3(std::sin(azimuth), 0, std::cos(azimuth))));
        triangles.push_back({0, 1 + i, 1 + (i + 1) % sides});
    }
    Mesh mesh = mesh_of(positions, triangles);
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
    constexpr std::uint32_t sides = 5000;
    std::vector<vec3> positions = {{0, 0.7f, 0}};
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double part = static_cast<double>(i) / sides;
        const double azimuth = 2 * std::numbers::pi * part * part;
        positions.push_back(vec3(dvec3(std::sin(azimuth), 0, std::cos(azimuth))));
        triangles.push_back({0, 1 + i, 1 + (i + 1) % sides});
    }
    const Mesh mesh = mesh_of(positions, triangles);
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
