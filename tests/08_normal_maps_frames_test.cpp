// SPDX-License-Identifier: MIT
// Tangent space: the directions of u and v on a triangle, tangent frames, and vertex tangents; some
// of them against long double.
#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "04_mvp/transform.hpp"
#include "06_phong/normals.hpp"
#include "08_normal_maps/tangent_frame.hpp"
#include "08_normal_maps/vertex_tangents.hpp"
#include "support/cases.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/one_triangle.hpp"
#include "support/printers.hpp"
#include "support/reference.hpp"
#include "support/special_numbers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr vec3 along_x(1, 0, 0), along_y(0, 1, 0), along_z(0, 0, 1);

/// A few roundings of numbers up to 1.
constexpr float few_roundings = 4 * FLT_EPSILON;

/// What the lesson promises of every frame.
testing::AssertionResult is_orthonormal(const TangentFrame& frame) {
    const dvec3 t = frame.tangent, b = frame.bitangent, n = frame.normal;
    for (const auto& [what, off] : {std::pair{"the tangent's length less 1", glm::length(t) - 1},
                                    {"the bitangent's length less 1", glm::length(b) - 1},
                                    {"the normal's length less 1", glm::length(n) - 1},
                                    {"the dot product of tangent and normal", glm::dot(t, n)},
                                    {"the dot product of bitangent and normal", glm::dot(b, n)},
                                    {"the dot product of tangent and bitangent", glm::dot(t, b)}})
        if (!(std::abs(off) <= 1e-6))  // also for NaN
            return testing::AssertionFailure()
                   << what << " is " << off << ", expected 0; tangent " << shown(frame.tangent)
                   << ", bitangent " << shown(frame.bitangent) << ", normal "
                   << shown(frame.normal);
    return testing::AssertionSuccess();
}

std::string named(const std::array<vec3, 3>& positions, const std::array<vec2, 3>& uvs) {
    return "the triangle " + testing::PrintToString(positions) + " with uvs " +
           testing::PrintToString(uvs);
}

/// For EXPECT_TRUE: the directions that uv_directions() finds; not yet their handedness.
testing::AssertionResult has_directions(const std::array<vec3, 3>& positions,
                                        const std::array<vec2, 3>& uvs, vec3 tangent,
                                        vec3 bitangent, float tolerance = few_roundings) {
    const UvDirections found = uv_directions(positions, uvs);
    if (const auto is = are_near(found.tangent, dvec3(tangent), tolerance); !is)
        return testing::AssertionFailure()
               << "the tangent of " << named(positions, uvs) << ": " << is.message();
    if (const auto is = are_near(found.bitangent, dvec3(bitangent), tolerance); !is)
        return testing::AssertionFailure()
               << "the bitangent of " << named(positions, uvs) << ": " << is.message();
    return testing::AssertionSuccess();
}

/// A mesh as the scene has it when tangents are built: each vertex has its own normal.
struct Patch {
    Mesh mesh;

    /// @param faces  Three indices into positions and uvs each.
    Patch(std::vector<vec3> positions, std::vector<vec2> uvs,
          const std::vector<std::array<std::uint32_t, 3>>& faces,
          const std::vector<vec3>& normals = {}) {
        mesh = mesh_of(std::move(positions), faces);
        mesh.uvs.assign(uvs.begin(), uvs.end());
        mesh.normals = normals;
        for (Triangle& triangle : mesh.triangles)
            for (Vertex& vertex : triangle.vertices) {
                vertex.uv = vertex.position;
                if (!normals.empty()) vertex.normal = vertex.position;
            }
        complete_normals(mesh);
    }

    /// A single triangle.
    Patch(const std::array<vec3, 3>& positions, const std::array<vec2, 3>& uvs,
          const std::vector<vec3>& normals = {})
        : Patch({positions.begin(), positions.end()}, {uvs.begin(), uvs.end()}, {{0, 1, 2}},
                normals) {}

    std::vector<vec4> tangents() const {
        return vertex_tangents(mesh, [&](const Triangle& triangle) {
            return std::array{mesh.uvs[triangle.vertices[0].uv], mesh.uvs[triangle.vertices[1].uv],
                              mesh.uvs[triangle.vertices[2].uv]};
        });
    }

    /// The tangent at a triangle's vertex.
    vec4 tangent(std::size_t triangle, std::size_t vertex) const {
        return tangents()[mesh.triangles[triangle].vertices[vertex].normal];
    }

    /// The frame at a triangle's vertex.
    TangentFrame frame(std::size_t triangle, std::size_t vertex) const {
        const vec4 along_u = tangent(triangle, vertex);
        const std::uint32_t normal = mesh.triangles[triangle].vertices[vertex].normal;
        return tangent_frame(vec3(along_u), mesh.normals[normal], along_u.w);
    }
};

}  // namespace

TEST(NormalMaps, Eq8_2_ATextureThatLiesAsItIs) {
    // u along x, v along y: the first side is 1 T + 0 B, the second 0 T + 1 B.
    const std::array<vec3, 3> p{vec3(0), along_x, along_y};
    EXPECT_TRUE(has_directions(p, {vec2(0), {1, 0}, {0, 1}}, along_x, along_y));
    EXPECT_TRUE(has_directions(p, {vec2(0), {-1, 0}, {0, 1}}, -along_x, along_y))
        << "mirrored: u grows the other way, v does not";
    // Twice along u: the first side is 2 T, which is T in direction.
    EXPECT_TRUE(has_directions(p, {vec2(0), {2, 0}, {0, 1}}, along_x, along_y));
}

TEST(NormalMaps, Eq8_3_AWorkedExample) {
    const std::array<vec3, 3> p{vec3(1, 0, 1), {4, 0, 1}, {1, 0, -2}};
    const float s = std::sqrt(0.2f);
    EXPECT_TRUE(
        has_directions(p, {vec2(0), {0.5f, 0.25f}, {0.25f, 0.5f}}, {2 * s, 0, s}, {-s, 0, -2 * s}));
    EXPECT_TRUE(has_directions(p, {vec2(0), {-0.5f, 0.25f}, {-0.25f, 0.5f}}, {-2 * s, 0, -s},
                               {-s, 0, -2 * s}))
        << "mirrored: without the determinant's sign both directions turn round";
}

TEST(NormalMaps, Eq8_3_DirectionsOfKnownTriangles) {
    // The texture turned by a quarter: u grows down along -y, v along x; of any size on either
    // side.
    for (const float size : {1e-30f, 1e-3f, 1.0f, 1e30f})
        for (const float of_texture : {1e-30f, 1.0f, 1e30f}) {
            ASSERT_TRUE(has_directions({vec3(0), {size, 0, 0}, {0, size, 0}},
                                       {vec2(0), {0, of_texture}, {-of_texture, 0}}, -along_y,
                                       along_x, 0));
        }
    // Slanted: lines of equal u need not stand at right angles to lines of equal v.
    EXPECT_TRUE(has_directions({vec3(0), {2, 0, 0}, {1, 1, 0}}, {vec2(0), {1, 0}, {0, 1}}, along_x,
                               std::sqrt(0.5f) * vec3(1, 1, 0)));
}

TEST(NormalMaps, Eq8_3_DirectionsAsExactAsTheDocumentationSays) {
    // What one rounding is off by, at most.
    constexpr real half_ulp_of_float = 0x1p-24L, half_ulp_of_double = 0x1p-53L;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> exponent(-8, 8);
    const auto any = [&] {  // sizes are spread evenly over orders of magnitude
        const float size = std::pow(10.0f, exponent(random));
        return random() & 1 ? size : -size;
    };
    int judged = 0;
    for (int i = 0; i < cases_of(200'000); ++i) {
        std::array<vec3, 3> p;
        std::array<vec2, 3> uvs;
        for (vec3& position : p) position = {any(), any(), any()};
        for (vec2& uv : uvs) uv = {any(), any()};
        const real u1 = real{uvs[1].x} - uvs[0].x, v1 = real{uvs[1].y} - uvs[0].y;
        const real u2 = real{uvs[2].x} - uvs[0].x, v2 = real{uvs[2].y} - uvs[0].y;
        const real determinant = u1 * v2 - u2 * v1;
        // Two differences, two products and their difference round, each by half an ulp of double.
        if (std::abs(determinant) <=
            4 * half_ulp_of_double * (std::abs(u1 * v2) + std::abs(u2 * v1)))
            continue;
        const UvDirections found = uv_directions(p, uvs);
        ASSERT_EQ(found.handedness, determinant > 0 ? 1 : -1)
            << "the determinant is " << determinant << " (seed 1, case " << i << ")";

        const lvec3 e1 = lvec3(p[1]) - lvec3(p[0]), e2 = lvec3(p[2]) - lvec3(p[0]);
        const real sign = found.handedness;
        for (const auto& [direction, raw, sizes] :
             {std::tuple{found.tangent, sign * (v2 * e1 - v1 * e2),
                         std::abs(v2) * glm::length(e1) + std::abs(v1) * glm::length(e2)},
              {found.bitangent, sign * (u1 * e2 - u2 * e1),
               std::abs(u2) * glm::length(e1) + std::abs(u1) * glm::length(e2)}}) {
            // The same roundings; scaling to length 1 may double what is off across the vector.
            const real off = 2 * 4 * half_ulp_of_double * sizes / glm::length(raw);
            if (!(off < 0.1L)) continue;  // all digits are lost to cancellation
            ++judged;
            const real tolerance = off + 2 * half_ulp_of_float;  // and to float, three components
            ASSERT_TRUE(is_near(glm::length(lvec3(direction) - glm::normalize(raw)), 0, tolerance))
                << "seed 1, case " << i;
        }
    }
    EXPECT_GT(judged, cases_of(200'000));
}

TEST(NormalMaps, Eq8_4_HandednessSaysWhereTheBitangentLies) {
    for (const auto& [first, second, handedness] :
         {std::tuple{vec2(1, 0), vec2(0, 1), 1},
          {vec2(-1, 0), vec2(0, 1), -1},
          {vec2(1, 0), vec2(0, -1), -1},
          {vec2(-1, 0), vec2(0, -1), 1},
          {vec2(0.5f, 0.25f), vec2(0.25f, 0.5f), 1},  // the worked example with Eq. 8.3
          {vec2(-0.5f, 0.25f), vec2(-0.25f, 0.5f), -1}}) {
        const std::array<vec3, 3> p{vec3(0), along_x, along_y};
        const std::array<vec2, 3> t{vec2(0), first, second};
        EXPECT_EQ(uv_directions(p, t).handedness, handedness) << named(p, t);
        // Any vertex may come first; but the other way around, the texture is seen from behind.
        EXPECT_EQ(uv_directions({p[1], p[2], p[0]}, {t[1], t[2], t[0]}).handedness, handedness);
        EXPECT_EQ(uv_directions({p[1], p[0], p[2]}, {t[1], t[0], t[2]}).handedness, -handedness);
    }
}

TEST(NormalMaps, HardCase_TheSignIsExactWhereProductsAgree) {
    look_up("Robust: Products and signs in double");
    // Two vertices far out on the line u = v, and one near the origin, a little beside that line or
    // on it. The determinant's products agree in all digits of a double, or nearly.
    std::mt19937 random(6);
    const auto whole = [&](int least, int most) {
        return static_cast<float>(std::uniform_int_distribution(least, most)(random));
    };
    for (int i = 0; i < 10'000; ++i) {
        const float first = 0x1p20f * whole(0x800000, 0xfffff0),
                    second = first + 0x1p20f * whole(-3, 3);
        const float u = whole(0, 0xfffff), v = u + whole(-3, 3);
        const std::array<vec3, 3> p{vec3(0), along_x, along_y};
        const std::array<vec2, 3> t{vec2(u, v), vec2(first), vec2(second)};
        // The determinant is (first - second) (u - v): multiply it out.
        const int expected = ((first > second) - (first < second)) * ((u > v) - (u < v));
        // From each vertex the same.
        for (const std::array<vec2, 3>& uvs :
             {t, std::array{t[1], t[2], t[0]}, std::array{t[2], t[0], t[1]}})
            ASSERT_EQ(uv_directions(p, uvs).handedness, expected)
                << named(p, uvs)
                << ": the determinant's products round to nearly the same number; "
                   "difference_of_products() knows their difference (seed 6, case "
                << i << ")";
    }
}

TEST(NormalMaps, Eq8_5_AWorkedExample) {
    const vec3 n(0.6f, 0.8f, 0);
    EXPECT_TRUE(are_near(across(along_x, n), {0.64, -0.48, 0}, few_roundings))
        << "what across() leaves of (1, 0, 0), with the normal (0.6, 0.8, 0)";
    for (const float h : {1.0f, -1.0f}) {
        const TangentFrame frame = tangent_frame(along_x, n, h);
        const std::string what =
            " of tangent_frame() of tangent (1, 0, 0), normal (0.6, 0.8, 0), "
            "handedness " +
            shown(h);
        EXPECT_TRUE(are_near(frame.tangent, {0.8, -0.6, 0}, few_roundings)) << "tangent" << what;
        EXPECT_TRUE(are_near(frame.bitangent, {0, 0, -h}, few_roundings)) << "bitangent" << what;
        EXPECT_TRUE(are_near(frame.normal, dvec3(n), few_roundings)) << "normal" << what;
    }
}

TEST(NormalMaps, HardCase_LengthsDoNotCountInAFrame) {
    look_up("Robust: Where little is left");
    for (const float length : {1e-37f, 1e-10f, 1e10f, 1e37f}) {
        const TangentFrame other =
            tangent_frame(length * vec3(0.8f, 0, 0.6f), length * along_z, -1.0f);
        ASSERT_TRUE(are_near(other.tangent, dvec3(along_x), few_roundings))
            << "the tangent, all lengths times " << length;
        ASSERT_TRUE(is_orthonormal(other)) << "all lengths times " << length;
    }
    // What is left of nearly nothing is not lost.
    EXPECT_EQ(tangent_frame({0x1p-10f, 0, 1}, along_z, 1.0f).tangent, along_x);
}

TEST(NormalMaps, Eq8_5_TakesTheStepsAsTheyAreWhereSquaresAreOrdinary) {
    // The same bits as by hand, for tangents so short that the square of what is left is just above
    // 1e-30, so long that their own is just below 1e30, and ordinary ones.
    std::mt19937 random(11);
    std::normal_distribution<float> normal;
    const auto some = [&] { return vec3(normal(random), normal(random), normal(random)); };
    for (int i = 0; i < 3000; ++i) {
        const vec3 n = unit_or(some(), along_x), t = unit_or(some(), along_y);
        const float part_left = glm::length(across(t, n));
        if (part_left < 0.9f) continue;  // t leans by up to 26 degrees; one step does up to 30
        for (const float size : {1.05e-15f / part_left, 1.0f, 0.95e15f}) {
            const vec3 tangent = size * t, left = across(tangent, n);
            ASSERT_EQ(unit_orthogonal(tangent, n), left * (1 / std::sqrt(glm::dot(left, left))))
                << "of tangent " << shown(tangent) << ", normal " << shown(n) << ", of which "
                << shown(left) << " is left (seed 11, case " << i << ")";
        }
    }
}

TEST(NormalMaps, HardCase_FramesAreOrthonormalNearTheNormal) {
    look_up("Robust: Where little is left");
    std::mt19937 random(4);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> exponent(-30, 0);
    for (int i = 0; i < 200'000; ++i) {
        const vec3 n(normal(random), normal(random), normal(random));
        vec3 t(normal(random), normal(random), normal(random));
        if (i % 2) t = n + std::exp2(exponent(random)) * t;  // more and more along the normal
        ASSERT_TRUE(is_orthonormal(tangent_frame(t, n, i % 4 < 2 ? 1.0f : -1.0f)))
            << "of tangent " << shown(t) << ", normal " << shown(n) << " (seed 4, case " << i
            << ")";
    }
}

TEST(NormalMaps, HardCase_WhereNothingRemainsAnAxisIsTaken) {
    look_up("Robust: Where no tangent is left");
    // The axis of the normal's smallest component; the first one of equals.
    EXPECT_EQ(any_orthogonal(along_x), along_y);
    EXPECT_EQ(any_orthogonal(along_y), along_x);
    EXPECT_EQ(any_orthogonal(along_z), along_x);
    EXPECT_TRUE(
        are_near(any_orthogonal(vec3(0.48f, -0.64f, 0.6f)), {0.877, 0.350, -0.328}, 0.0005));
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 100'000; ++i) {
        const vec3 n = unit_or({normal(random), normal(random), normal(random)}, along_x);
        const vec3 size = glm::abs(n), found = any_orthogonal(n);
        const std::string what =
            "any_orthogonal() of " + shown(n) + " (seed 7, case " + std::to_string(i) + ")";
        ASSERT_NEAR(glm::dot(found, n), 0, 1e-6f) << what;
        ASSERT_NEAR(glm::length(found), 1, 1e-6f) << what;
        // Its component along that axis is the largest possible: the sine of the angle to n.
        const float least = std::min({size.x, size.y, size.z});
        ASSERT_NEAR(std::max({found.x, found.y, found.z}), std::sqrt(1 - least * least), 1e-6f)
            << what << ": not along the axis to which it leans least";
    }
    // So little of the tangent may be left, and no less.
    for (const float sign : {1.0f, -1.0f}) {
        EXPECT_EQ(unit_orthogonal({0, sign * 0x1p-19f, 1}, along_z), sign * along_y);
        EXPECT_EQ(unit_orthogonal({0, sign * 0x1p-21f, 1}, along_z), along_x);
    }
}

TEST(NormalMaps, HardCase_TangentAlongTheNormal) {
    look_up("Robust: Where no tangent is left");
    for (const vec3 n : {along_y, -along_z, vec3(0.6f, 0, 0.8f), unit_or(vec3(-3, 1, 2), along_x)})
        for (const float length : {-1e30f, -1.0f, 0.0f, 1e-30f, 1e30f}) {
            const TangentFrame frame = tangent_frame(length * n, n, 1.0f);
            ASSERT_TRUE(is_orthonormal(frame));
            ASSERT_EQ(frame.tangent, any_orthogonal(frame.normal))
                << "the tangent is " << length << " times the normal " << shown(n);
        }
    // A file may have normals that are parallel to the surface's tangent. A mirrored one keeps its
    // handedness.
    const Patch mirrored(std::array{vec3(0), along_x, along_y}, {vec2(0), {-1, 0}, {0, 1}},
                         {along_x, -along_x, along_z});
    EXPECT_EQ(mirrored.tangent(0, 0), vec4(along_y, -1));
    EXPECT_EQ(mirrored.tangent(0, 1), vec4(along_y, -1));
    EXPECT_EQ(mirrored.tangent(0, 2), vec4(-along_x, -1));
}

TEST(NormalMaps, HardCase_ZeroNormal) {
    look_up("Eq. 8.5");
    for (const vec3 n :
         {vec3(0), vec3(not_a_number), vec3(infinity, 0, 0), vec3(0, -infinity, 1)}) {
        const TangentFrame frame = tangent_frame({1, 2, 0}, n, -1.0f);
        EXPECT_TRUE(is_orthonormal(frame));
        EXPECT_EQ(frame.normal, along_y);
        EXPECT_TRUE(are_near(frame.tangent, dvec3(along_x), few_roundings));
        EXPECT_TRUE(are_near(frame.bitangent, dvec3(along_z), few_roundings));
    }
    // Of a file: the vertex takes that of its face.
    const Patch patch(std::array{vec3(0), along_x, along_y}, {vec2(0), {1, 0}, {0, 1}},
                      {vec3(0), vec3(0), vec3(0)});
    EXPECT_EQ(patch.frame(0, 0).normal, along_z);
    EXPECT_EQ(patch.frame(0, 0).tangent, along_x);
}

TEST(NormalMaps, HardCase_SpecialNumbersOfFrames) {
    look_up("Robust: Where no tangent is left");
    SpecialNumbers mix(4);
    for (int i = 0; i < 1'000'000; ++i) {
        const std::array p{mix.any_three(), mix.any_three(), mix.any_three()};
        const std::array t{mix.any_two(), mix.any_two(), mix.any_two()};
        const UvDirections found = uv_directions(p, t);
        for (const vec3 direction : {found.tangent, found.bitangent})
            ASSERT_TRUE(direction == vec3(0) ||
                        std::abs(glm::length(direction) - 1) <= 2 * FLT_EPSILON)
                << named(p, t) << " (seed 4, case " << i << ")";
        const vec3 normal = mix.any_three(), tangent = i % 2 ? found.tangent : mix.any_three();
        const float handedness = mix.below(2) ? 1.0f : -1.0f;
        const TangentFrame frame = tangent_frame(tangent, normal, handedness);
        ASSERT_TRUE(is_orthonormal(frame)) << "of tangent " << shown(tangent) << ", normal "
                                           << shown(normal) << " (seed 4, case " << i << ")";
        ASSERT_GT(handedness * glm::dot(glm::cross(frame.normal, frame.tangent), frame.bitangent),
                  0.9f)
            << "seed 4, case " << i;
    }
}

TEST(NormalMaps, Eq8_6_AWorkedExample) {
    // Two faces on the floor, around the origin: 90 degrees with u along x, 45 degrees with u along
    // (0.8, 0, -0.6). The uv of the second one: as far as its vertices lie along that, and across
    // it.
    const vec3 second(0, 0, -1), third = unit_or({-1, 0, -1}, along_x);
    const auto slanted_uv = [](vec3 p) {
        return vec2(0.8f * p.x - 0.6f * p.z, -0.6f * p.x - 0.8f * p.z);
    };
    const Patch patch({vec3(0), along_x, second, second, third},
                      {vec2(0), {1, 0}, {0, 1}, slanted_uv(second), slanted_uv(third)},
                      {{0, 1, 2}, {0, 3, 4}});
    for (std::size_t triangle = 0; triangle < 2; ++triangle) {
        const TangentFrame frame = patch.frame(triangle, 0);
        ASSERT_TRUE(are_near(frame.tangent, glm::normalize(dvec3(2.8, 0, -0.6)), 1e-6))
            << "the shared vertex's tangent: (1, 0, 0) at 90 degrees, (0.8, 0, -0.6) at 45";
        EXPECT_EQ(frame.normal, along_y);
    }
    EXPECT_NEAR(degrees_between(patch.frame(0, 0).tangent, along_x), 12.1, 0.05);
    EXPECT_NEAR(degrees_between(patch.frame(0, 0).tangent, {0.8f, 0, -0.6f}), 24.8, 0.05);
}

TEST(NormalMaps, Eq8_6_FansOfSlantedFaces) {
    // Faces at an angle to the vertex's normal, each with its own texture: by the formula.
    std::mt19937 random(8);
    std::uniform_real_distribution<float> any(-1, 1);
    const auto some = [&] { return vec3(any(random), any(random), any(random)); };
    for (int i = 0; i < 500; ++i) {
        std::vector<vec3> positions{vec3(0)}, normals{vec3(any(random), any(random), 3)};
        std::vector<vec2> uvs{vec2(0)};
        std::vector<std::array<std::uint32_t, 3>> faces;
        const dvec3 n = glm::normalize(dvec3(normals[0]));
        dvec3 sum(0);
        for (std::uint32_t k = 0; k < 5; ++k) {
            const vec3 e1 = some(), e2 = some();
            const vec2 d1 = vec2(1, 0) + 0.4f * vec2(some()), d2 = vec2(0, 1) + 0.4f * vec2(some());
            positions.insert(positions.end(), {e1, e2});
            normals.insert(normals.end(), {along_z, along_z});
            uvs.insert(uvs.end(), {d1, d2});
            faces.push_back({0, 2 * k + 1, 2 * k + 2});
            const dvec3 tangent =
                glm::normalize(double{d2.y} * dvec3(e1) - double{d1.y} * dvec3(e2));  // det > 0
            const double angle =
                std::acos(glm::dot(glm::normalize(dvec3(e1)), glm::normalize(dvec3(e2))));
            sum += angle * glm::normalize(tangent - glm::dot(tangent, n) * n);
        }
        if (glm::length(sum) < 0.5) continue;  // they nearly cancel
        // Some roundings of each of five terms up to pi, over the length of their sum.
        const vec4 found =
            Patch(positions, uvs, faces, normals).tangent(static_cast<std::size_t>(i % 5), 0);
        ASSERT_TRUE(are_near(found, dvec4(glm::normalize(sum), 1), 5e-5))
            << "tangent and handedness of the vertex that five slanted faces share, with the "
               "normal "
            << shown(normals[0]) << " (seed 8, case " << i << ")";
    }
}

TEST(NormalMaps, Eq8_6_AtAMirroredTexturesSeamTangentsAreNotMixed) {
    // Two squares beside each other, the second one with the texture mirrored at the seam x = 0.
    const Patch patch({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 0, 0}, {-1, 1, 0}},
                      {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {1, 0}, {1, 1}},
                      {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {3, 5, 4}});
    for (std::size_t triangle = 0; triangle < 4; ++triangle)
        for (std::size_t vertex = 0; vertex < 3; ++vertex) {
            const TangentFrame frame = patch.frame(triangle, vertex);
            const bool is_mirrored = triangle >= 2;
            const std::string where =
                "two squares that meet at x = 0, the left one's texture mirrored; triangle " +
                std::to_string(triangle) + ", vertex " + std::to_string(vertex);
            ASSERT_EQ(frame.tangent, is_mirrored ? -along_x : along_x) << where;
            ASSERT_EQ(frame.bitangent, along_y) << "v grows upwards on either side; " << where;
            ASSERT_EQ(frame.normal, along_z) << where;
        }
}

TEST(NormalMaps, HardCase_NoAreaInTheTexture) {
    look_up("Robust: A triangle without area in the texture");
    const std::array<vec3, 3> p{vec3(0), along_x, along_y};
    // Two uvs are equal; all are; they lie on a line; they are not numbers.
    for (const std::array<vec2, 3>& uvs : {std::array{vec2(0), vec2(1, 0), vec2(0)},
                                           {vec2(0.5f), vec2(0.5f), vec2(0.5f)},
                                           {vec2(0), vec2(0.1f, 0.3f), vec2(0.2f, 0.6f)},
                                           {vec2(not_a_number), vec2(1, 0), vec2(0, 1)},
                                           {vec2(0), vec2(infinity, 0), vec2(0, 1)},
                                           {vec2(1e38f, 0), vec2(infinity), vec2(0, 1)}}) {
        ASSERT_EQ(uv_directions(p, uvs).handedness, 0) << named(p, uvs);
        ASSERT_TRUE(has_directions(p, uvs, vec3(0), vec3(0)));
        for (const vec4 tangent : Patch(p, uvs).tangents())
            ASSERT_EQ(tangent, vec4(along_x, 1))
                << "the axis to which the normal leans least; " << named(p, uvs);
    }
    // Such a triangle leaves its neighbours' tangents alone.
    const Patch beside({vec3(0), along_x, along_y, {1, 1, 0}, {-1, 0, 0}},
                       {vec2(0), {0, 1}, {-1, 0}, {-1, 1}, vec2(0)}, {{0, 1, 2}, {0, 2, 4}});
    EXPECT_EQ(beside.tangent(0, 0), vec4(-along_y, 1));
    EXPECT_EQ(beside.tangent(1, 0), vec4(-along_y, 1)) << "it takes that of its neighbour";
}

TEST(NormalMaps, HardCase_NoAreaOnTheSurface) {
    look_up("Eq. 8.3");
    const std::array<vec2, 3> uvs{vec2(0), vec2(1, 0), vec2(0, 1)};
    for (const std::array<vec3, 3>& p : {std::array{vec3(1), vec3(1), vec3(1)},
                                         {vec3(0), vec3(0), vec3(1)},
                                         {vec3(0), vec3(1), vec3(2)},
                                         {vec3(0), vec3(infinity), vec3(1, 0, 0)}}) {
        ASSERT_EQ(uv_directions(p, uvs).handedness, 1)
            << "that is the texture's alone; " << named(p, uvs);
        const Patch patch(p, uvs);
        for (std::size_t vertex = 0; vertex < 3; ++vertex)
            ASSERT_TRUE(is_orthonormal(patch.frame(0, vertex))) << named(p, uvs);
    }
    // With a vertex that is not finite there are no directions; the handedness remains.
    for (const float not_finite : {infinity, -infinity, not_a_number})
        for (const std::size_t vertex : {0u, 1u, 2u}) {
            std::array<vec3, 3> p{vec3(0), along_x, along_y};
            p[vertex].z = not_finite;
            const std::array<vec2, 3> mirrored{uvs[0], uvs[2], uvs[1]};
            EXPECT_TRUE(has_directions(p, mirrored, vec3(0), vec3(0)));
            EXPECT_EQ(uv_directions(p, mirrored).handedness, -1) << named(p, mirrored);
        }
}

TEST(NormalMaps, HardCase_OrderDoesNotMatter) {
    look_up("Robust: The order must not matter");
    // A closed fan of crumpled triangles around a vertex, some of them mirrored, one without area.
    std::mt19937 random(5);
    std::uniform_real_distribution<float> any(-1, 1);
    constexpr std::uint32_t rim = 24;
    std::vector<vec3> positions{vec3(0)}, normals{along_z};
    std::vector<vec2> uvs{vec2(0)};
    std::vector<std::array<std::uint32_t, 3>> faces;
    for (std::uint32_t i = 0; i < rim; ++i) {
        const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / rim;
        positions.emplace_back(std::cos(angle), std::sin(angle), 0.3f * any(random));
        normals.push_back(vec3(any(random), any(random), 2));
        uvs.push_back(vec2(positions.back()) + 0.4f * vec2(any(random), any(random)));
        faces.push_back({0, i + 1, (i + 1) % rim + 1});
    }
    uvs[7] = uvs[8];
    // Of a face's vertex: by that vertex and the next one. Each face has its own copies of them.
    using Tangents = std::map<std::pair<std::uint32_t, std::uint32_t>, vec4>;
    const auto tangents = [&] {
        std::vector<vec3> own_positions, own_normals;
        std::vector<vec2> own_uvs;
        std::vector<std::array<std::uint32_t, 3>> own_faces;
        for (const auto& face : faces) {
            const auto first = static_cast<std::uint32_t>(own_positions.size());
            own_faces.push_back({first, first + 1, first + 2});
            for (const std::uint32_t i : face) {
                own_positions.push_back(positions[i]);
                own_normals.push_back(normals[i]);
                own_uvs.push_back(uvs[i]);
            }
        }
        const Patch patch(own_positions, own_uvs, own_faces, own_normals);
        Tangents found;
        for (std::size_t t = 0; t < faces.size(); ++t)
            for (std::size_t i = 0; i < 3; ++i)
                found[{faces[t][i], faces[t][(i + 1) % 3]}] = patch.tangent(t, i);
        return found;
    };
    const Tangents expected = tangents();
    for (int shuffle = 0; shuffle < 50; ++shuffle) {
        std::shuffle(faces.begin(), faces.end(), random);
        for (auto& face : faces)  // any of its vertices may come first
            std::rotate(face.begin(), face.begin() + random() % 3, face.end());
        ASSERT_EQ(tangents(), expected) << "seed 5, shuffle " << shuffle;
    }
}

TEST(NormalMaps, HardCase_NegativeZeroIsTheSamePosition) {
    look_up("Robust: Which vertices are the same");
    // The square of two triangles, of which the second has its own vertices, with -0 for 0.
    const float c = 0.6f, s = 0.8f;  // its texture is turned
    const Patch patch(
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-0.0f, -0.0f, -0.0f}, {1, 1, -0.0f}, {-0.0f, 1, -0.0f}},
        {{0, 0}, {1, 0}, {1, 1}, {-0.0f, -0.0f}, {c - s, c + s}, {-s, c}}, {{0, 1, 2}, {3, 4, 5}},
        {along_z, along_z, along_z, {0, -0.0f, 1}, {0, -0.0f, 1}, {0, -0.0f, 1}});
    EXPECT_EQ(patch.tangent(0, 0), patch.tangent(1, 0));
    EXPECT_GT(degrees_between(patch.frame(0, 0).tangent, along_x), 10) << "a mean of two";
}

TEST(NormalMaps, HardCase_VerticesOfTinyModelsAreNotTheSame) {
    look_up("Robust: Which vertices are the same");
    // Two triangles that have nothing in common but uvs and normals; in one, the texture is turned.
    for (const float size : {1.0f, 0x1p-30f, 0x1p-100f}) {
        const auto at = [&](float x, float y) { return size * vec3(x, y, 0); };
        const Patch patch({at(0, 0), at(1, 0), at(0, 1), at(8, 0), at(8, 1), at(7, 0)},
                          {{0, 0}, {1, 0}, {0, 1}, {0, 0}, {1, 0}, {0, 1}}, {{0, 1, 2}, {3, 4, 5}},
                          std::vector<vec3>(6, along_z));
        EXPECT_EQ(patch.tangent(0, 0), vec4(along_x, 1)) << "of a model of size " << size;
        EXPECT_EQ(patch.tangent(1, 0), vec4(along_y, 1)) << "of a model of size " << size;
    }
}

TEST(NormalMaps, HardCase_AnyVertexMayComeFirst) {
    look_up("Robust: The order must not matter");
    // Needles, in space and in the texture: what is left of Eq. 8.3's difference is mostly
    // rounding, and another vertex to start from would round otherwise.
    std::mt19937 random(9);
    std::uniform_real_distribution<float> any(-1, 1);
    const auto some = [&](float size) {
        return size * vec3(any(random), any(random), any(random));
    };
    for (int i = 0; i < 5000; ++i) {
        const float share = 0.5f + 0.4f * any(random);
        const vec3 p = some(1e-3f), q = some(1);
        const vec2 t(some(1e-3f)), u(some(1));
        const std::vector<vec3> positions{p, q, p + share * (q - p) + some(1e-6f)};
        const std::vector<vec2> uvs{t, u, t + share * (u - t) + vec2(some(1e-6f))};
        const std::vector<vec3> normals(3, vec3(0.1f, 0.2f, 1));
        const Patch first(positions, uvs, {{0, 1, 2}}, normals);
        const Patch second(positions, uvs, {{1, 2, 0}}, normals);
        const Patch third(positions, uvs, {{2, 0, 1}}, normals);
        for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_EQ(second.tangent(0, (k + 2) % 3), first.tangent(0, k)) << "seed 9, case " << i;
            ASSERT_EQ(third.tangent(0, (k + 1) % 3), first.tangent(0, k)) << "seed 9, case " << i;
        }
    }
}

TEST(NormalMaps, HardCase_TangentsThatCancel) {
    look_up("Eq. 8.6");
    // Two triangles with one position and uv in common, and opposite textures. Up to 2^21 shares
    // are added as they are, all bits of them: opposite ones leave 0. So they do among a million
    // others, of triangles that are points: those are 0 but count.
    const vec3 first(1, 0.3f, 0), second(-0.2f, 1, 0);
    for (const std::size_t points : std::initializer_list<std::size_t>{0, 0x100000 / 3}) {
        std::vector<std::array<std::uint32_t, 3>> faces(points, {0, 0, 0});
        faces.insert(faces.end(), {{0, 1, 2}, {0, 3, 4}});
        const Patch patch({vec3(0), first, second, -first, -second},
                          {vec2(0), {1, 0}, {0, 1}, {1, 0}, {0, 1}}, faces,
                          std::vector<vec3>(5, along_z));
        const std::vector<vec4> tangents = patch.tangents();
        for (const Triangle& triangle :
             {patch.mesh.triangles.end()[-2], patch.mesh.triangles.back()})
            EXPECT_EQ(tangents[triangle.vertices[0].normal], vec4(any_orthogonal(along_z), 1))
                << "at a vertex of two triangles with opposite tangents and of " << points
                << " points";
    }
}

TEST(NormalMaps, HardCase_TransformedModels) {
    look_up("Robust: Models that are transformed");
    // The roof of the worked example.
    const mat3 twice_as_wide(2, 0, 0, 0, 1, 0, 0, 0, 1);
    EXPECT_EQ(twice_as_wide * vec3(1, -1, 0), vec3(2, -1, 0));
    EXPECT_EQ(normal_matrix(twice_as_wide) * vec3(1, 1, 0), vec3(1, 2, 0));
    // What is found on the stretched model is what the matrices make of what was found before it:
    // tangents transform like points, normals by the cofactor matrix.
    const mat3 stretch = matrix_from_rows({2, 0.5f, 0}, {0, 0.25f, 1}, {-1, 0, 3});
    for (const float mirror : {1.0f, -1.0f}) {
        const mat3 m = stretch * mat3(mirror, 0, 0, 0, 1, 0, 0, 0, 1);
        const std::array<vec3, 3> p{vec3(0.5f, 0, 1), {1, 2, 0}, {0, 1, 1}};
        const std::array<vec2, 3> uvs{vec2(0.5f, 0), {1, 0.25f}, {0, 1}};
        const std::array<vec3, 3> q{m * p[0], m * p[1], m * p[2]};
        const UvDirections before = uv_directions(p, uvs);
        EXPECT_TRUE(has_directions(q, uvs, unit_or(m * before.tangent, along_x),
                                   unit_or(m * before.bitangent, along_x), 1e-6f));
        EXPECT_EQ(uv_directions(q, uvs).handedness, before.handedness)
            << "that is the texture's alone";
    }
}
