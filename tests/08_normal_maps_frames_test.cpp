// SPDX-License-Identifier: MIT
// Tangent space: the directions of u and v on a triangle, tangent frames, and vertex tangents.
#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "04_mvp/transform.hpp"
#include "06_phong/normals.hpp"
#include "08_normal_maps/tangent_frame.hpp"
#include "08_normal_maps/vertex_tangents.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/one_triangle.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr vec3 along_x(1, 0, 0), along_y(0, 1, 0), along_z(0, 0, 1);

/// A few roundings of numbers up to 1.
constexpr float few_roundings = 4 * FLT_EPSILON;

/// What the lesson promises of every frame.
constexpr double most_off_a_right_angle = 1e-6;

testing::AssertionResult is_orthonormal(const TangentFrame& frame) {
    const dvec3 t = frame.tangent, b = frame.bitangent, n = frame.normal;
    const std::pair<const char*, double> all[] = {
        {"the tangent's length less 1", glm::length(t) - 1},
        {"the bitangent's length less 1", glm::length(b) - 1},
        {"the normal's length less 1", glm::length(n) - 1},
        {"the dot product of tangent and normal", glm::dot(t, n)},
        {"the dot product of bitangent and normal", glm::dot(b, n)},
        {"the dot product of tangent and bitangent", glm::dot(t, b)}};
    for (const auto& [what, off] : all)
        if (!(std::abs(off) <= most_off_a_right_angle))  // also for NaN
            return testing::AssertionFailure()
                   << what << " is " << off << ", expected 0; tangent "
                   << testing::PrintToString(frame.tangent) << ", bitangent "
                   << testing::PrintToString(frame.bitangent) << ", normal "
                   << testing::PrintToString(frame.normal);
    return testing::AssertionSuccess();
}

testing::AssertionResult are_near(vec3 actual, vec3 expected, float tolerance = few_roundings) {
    const vec3 off = glm::abs(actual - expected);
    if (std::max({off.x, off.y, off.z}) <= tolerance) return testing::AssertionSuccess();
    return testing::AssertionFailure()
           << testing::PrintToString(actual) << ", expected " << testing::PrintToString(expected);
}

/// "the triangle (0, 0, 0), (1, 0, 0), (0, 1, 0) with uvs (0, 0), (1, 0), (0, 1)"
std::string named(const std::array<vec3, 3>& positions, const std::array<vec2, 3>& uvs) {
    const auto list = [](const auto& all) {
        return testing::PrintToString(all[0]) + ", " + testing::PrintToString(all[1]) + ", " +
               testing::PrintToString(all[2]);
    };
    return "the triangle " + list(positions) + " with uvs " + list(uvs);
}

struct Directions {
    vec3 tangent, bitangent;
};

/// For EXPECT_TRUE: the directions that uv_directions() finds; not yet their handedness.
testing::AssertionResult has_directions(const std::array<vec3, 3>& positions,
                                        const std::array<vec2, 3>& uvs, const Directions& expected,
                                        float tolerance = few_roundings) {
    const UvDirections found = uv_directions(positions, uvs);
    const auto wrong = [&](const char* what) {
        return testing::AssertionFailure()
               << "the " << what << " of " << named(positions, uvs) << ": ";
    };
    if (const auto is = are_near(found.tangent, expected.tangent, tolerance); !is)
        return wrong("tangent") << is.message();
    if (const auto is = are_near(found.bitangent, expected.bitangent, tolerance); !is)
        return wrong("bitangent") << is.message();
    return testing::AssertionSuccess();
}

/// For EXPECT_TRUE: the frame that tangent_frame() makes.
testing::AssertionResult has_frame(vec3 tangent, vec3 normal, float handedness,
                                   const TangentFrame& expected) {
    const TangentFrame found = tangent_frame(tangent, normal, handedness);
    const auto wrong = [&](const char* what) {
        return testing::AssertionFailure()
               << "tangent_frame() of tangent " << testing::PrintToString(tangent) << ", normal "
               << testing::PrintToString(normal) << ", handedness " << handedness << ": its "
               << what << " is ";
    };
    if (const auto is = are_near(found.tangent, expected.tangent); !is)
        return wrong("tangent") << is.message();
    if (const auto is = are_near(found.bitangent, expected.bitangent); !is)
        return wrong("bitangent") << is.message();
    if (const auto is = are_near(found.normal, expected.normal); !is)
        return wrong("normal") << is.message();
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

    std::vector<vec4> tangents() const {
        return vertex_tangents(mesh, [&](const Triangle& triangle) {
            return std::array{mesh.uvs[triangle.vertices[0].uv], mesh.uvs[triangle.vertices[1].uv],
                              mesh.uvs[triangle.vertices[2].uv]};
        });
    }

    /// The frame at a triangle's vertex.
    TangentFrame frame(std::size_t triangle, std::size_t vertex) const {
        const std::uint32_t normal = mesh.triangles[triangle].vertices[vertex].normal;
        const vec4 tangent = tangents()[normal];
        return tangent_frame(vec3(tangent), mesh.normals[normal], tangent.w);
    }
};

/// Half a pipe around the y axis, with u around it and v up; from so many strips.
Patch half_pipe(std::uint32_t strips) {
    std::vector<vec3> positions, normals;
    std::vector<vec2> uvs;
    std::vector<std::array<std::uint32_t, 3>> faces;
    for (std::uint32_t i = 0; i <= strips; ++i) {
        const float share = static_cast<float>(i) / static_cast<float>(strips);
        const float angle = std::numbers::pi_v<float> * share;
        const vec3 out(std::cos(angle), 0, -std::sin(angle));
        for (const float v : {0.0f, 1.0f}) {
            positions.push_back(out + vec3(0, v, 0));
            normals.push_back(out);
            uvs.emplace_back(share, v);
        }
        if (i == strips) break;
        const std::uint32_t low = 2 * i;
        faces.push_back({low, low + 2, low + 3});
        faces.push_back({low, low + 3, low + 1});
    }
    return {positions, uvs, faces, normals};
}

}  // namespace

TEST(NormalMaps, Eq8_2_ATextureThatLiesAsItIs) {
    // u along x, v along y: the first side is 1 T + 0 B, the second 0 T + 1 B.
    EXPECT_TRUE(
        has_directions({vec3(0), along_x, along_y}, {vec2(0), {1, 0}, {0, 1}}, {along_x, along_y}));
    EXPECT_TRUE(has_directions({vec3(0), along_x, along_y}, {vec2(0), {-1, 0}, {0, 1}},
                               {-along_x, along_y}))
        << "mirrored: u grows the other way, v does not";
    // Twice along u: the first side is 2 T, which is T in direction.
    EXPECT_TRUE(
        has_directions({vec3(0), along_x, along_y}, {vec2(0), {2, 0}, {0, 1}}, {along_x, along_y}));
}

TEST(NormalMaps, Eq8_2_SidesAreSumsOfTheDirections) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(-1, 1);
    const auto position = [&] { return vec3(any(random), any(random), any(random)); };
    const auto uv = [&] { return vec2(any(random), any(random)); };
    for (int i = 0; i < 1000; ++i) {
        const std::array<vec3, 3> p{position(), position(), position()};
        const std::array<vec2, 3> t{uv(), uv(), uv()};
        const UvDirections found = uv_directions(p, t);
        const dvec3 e1 = dvec3(p[1]) - dvec3(p[0]), e2 = dvec3(p[2]) - dvec3(p[0]);
        const dvec2 d1 = dvec2(t[1]) - dvec2(t[0]), d2 = dvec2(t[2]) - dvec2(t[0]);
        // Lengths by Cramer's rule, apart from the stage: areas in space over the one in uv.
        const double area = std::abs(d1.x * d2.y - d1.y * d2.x);
        const dvec3 tangent = glm::length(d2.y * e1 - d1.y * e2) / area * dvec3(found.tangent);
        const dvec3 bitangent = glm::length(d1.x * e2 - d2.x * e1) / area * dvec3(found.bitangent);
        const double size = glm::length(tangent) + glm::length(bitangent);
        ASSERT_LT(glm::length(d1.x * tangent + d1.y * bitangent - e1), 4 * FLT_EPSILON * size)
            << "u1 T + v1 B is " << testing::PrintToString(vec3(d1.x * tangent + d1.y * bitangent))
            << ", and e1 is " << testing::PrintToString(vec3(e1)) << " of " << named(p, t)
            << " (seed 1, case " << i << ")";
        ASSERT_LT(glm::length(d2.x * tangent + d2.y * bitangent - e2), 4 * FLT_EPSILON * size)
            << "u2 T + v2 B is " << testing::PrintToString(vec3(d2.x * tangent + d2.y * bitangent))
            << ", and e2 is " << testing::PrintToString(vec3(e2)) << " of " << named(p, t)
            << " (seed 1, case " << i << ")";
    }
}

TEST(NormalMaps, Eq8_3_AWorkedExample) {
    const std::array<vec3, 3> p{vec3(1, 0, 1), {4, 0, 1}, {1, 0, -2}};
    const float s = std::sqrt(0.2f);
    EXPECT_TRUE(has_directions(p, {vec2(0), {0.5f, 0.25f}, {0.25f, 0.5f}},
                               {{2 * s, 0, s}, {-s, 0, -2 * s}}));
    // Its mirror image.
    EXPECT_TRUE(has_directions(p, {vec2(0), {-0.5f, 0.25f}, {-0.25f, 0.5f}},
                               {{-2 * s, 0, -s}, {-s, 0, -2 * s}}))
        << "mirrored: without the determinant's sign both directions turn round";
}

TEST(NormalMaps, Eq8_3_DirectionsOfKnownTriangles) {
    // u along x, v along y; of any size on either side.
    for (const float size : {1e-30f, 1e-3f, 1.0f, 1e30f})
        for (const float of_texture : {1e-30f, 1.0f, 1e30f}) {
            ASSERT_TRUE(has_directions({vec3(0), {size, 0, 0}, {0, size, 0}},
                                       {vec2(0), {of_texture, 0}, {0, of_texture}},
                                       {along_x, along_y}, 0));
        }
    // The texture turned by a quarter: u grows down along -y, v along x.
    EXPECT_TRUE(has_directions({vec3(0), {1, 0, 0}, {0, 1, 0}}, {vec2(0), {0, 1}, {-1, 0}},
                               {-along_y, along_x}, 0));
    // Slanted: lines of equal u need not stand at right angles to lines of equal v.
    const std::array<vec3, 3> p{vec3(0), {2, 0, 0}, {1, 1, 0}};
    const std::array<vec2, 3> uvs{vec2(0), {1, 0}, {0, 1}};
    EXPECT_TRUE(has_directions(p, uvs, {along_x, std::sqrt(0.5f) * vec3(1, 1, 0)}));
    EXPECT_EQ(uv_directions(p, uvs).tangent, along_x) << named(p, uvs);
}

TEST(NormalMaps, Eq8_3_DirectionsDoNotDependOnTheFirstVertex) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> any(-1, 1);
    for (int i = 0; i < 1000; ++i) {
        std::array<vec3, 3> p;
        std::array<vec2, 3> t;
        for (std::size_t k = 0; k < 3; ++k) {
            p[k] = {any(random), any(random), any(random)};
            t[k] = {any(random), any(random)};
        }
        const UvDirections first = uv_directions(p, t);
        // Both ways around: the other one is the triangle from behind, under the same texture.
        for (const auto& vertices : {std::array{1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}}) {
            const int a = vertices[0], b = vertices[1], c = vertices[2];
            const auto at = [](auto& of, int k) { return of[static_cast<std::size_t>(k)]; };
            const UvDirections other =
                uv_directions({at(p, a), at(p, b), at(p, c)}, {at(t, a), at(t, b), at(t, c)});
            // Roundings of double are far below those to float, but for very thin triangles.
            const auto order = [&] {
                return "the vertices in the order " + std::to_string(a) + std::to_string(b) +
                       std::to_string(c) + " of " + named(p, t) + " (seed 2, case " +
                       std::to_string(i) + ")";
            };
            ASSERT_TRUE(are_near(other.tangent, first.tangent)) << "the tangent, " << order();
            ASSERT_TRUE(are_near(other.bitangent, first.bitangent)) << "the bitangent, " << order();
        }
    }
}

TEST(NormalMaps, Eq8_4_HandednessSaysWhereTheBitangentLies) {
    const std::array<vec3, 3> p{vec3(0), along_x, along_y};
    EXPECT_EQ(uv_directions(p, {vec2(0), {1, 0}, {0, 1}}).handedness, 1);
    EXPECT_EQ(uv_directions(p, {vec2(0), {-1, 0}, {0, 1}}).handedness, -1);
    EXPECT_EQ(uv_directions(p, {vec2(0), {1, 0}, {0, -1}}).handedness, -1);
    EXPECT_EQ(uv_directions(p, {vec2(0), {-1, 0}, {0, -1}}).handedness, 1);
    EXPECT_EQ(uv_directions(p, {vec2(0), {0.5f, 0.25f}, {0.25f, 0.5f}}).handedness, 1)
        << "the worked example with Eq. 8.3";
    EXPECT_EQ(uv_directions(p, {vec2(0), {-0.5f, 0.25f}, {-0.25f, 0.5f}}).handedness, -1)
        << "its mirror image";
    std::mt19937 random(3);
    std::uniform_real_distribution<float> any(-1, 1);
    for (int i = 0; i < 1000; ++i) {
        std::array<vec3, 3> q;
        std::array<vec2, 3> t;
        for (std::size_t k = 0; k < 3; ++k) {
            q[k] = {any(random), any(random), any(random)};
            t[k] = {any(random), any(random)};
        }
        const UvDirections found = uv_directions(q, t);
        const dvec3 out = glm::cross(dvec3(q[1] - q[0]), dvec3(q[2] - q[0]));
        const double triple =
            glm::dot(glm::cross(dvec3(found.tangent), dvec3(found.bitangent)), glm::normalize(out));
        // Any vertex may come first; but the other way around, the texture is seen from behind.
        const int h = found.handedness;
        ASSERT_EQ(uv_directions({q[1], q[2], q[0]}, {t[1], t[2], t[0]}).handedness, h);
        ASSERT_EQ(uv_directions({q[1], q[0], q[2]}, {t[1], t[0], t[2]}).handedness, -h);
        if (std::abs(triple) < 1e-5) continue;  // T and B nearly parallel
        ASSERT_EQ(found.handedness, triple > 0 ? 1 : -1)
            << "T x B leads " << (triple > 0 ? "out of" : "into") << " the surface of "
            << named(q, t) << " (seed 3, case " << i << ")";
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
    int agree = 0;
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
        const dvec2 d1 = dvec2(t[1]) - dvec2(t[0]), d2 = dvec2(t[2]) - dvec2(t[0]);
        agree += expected != 0 && d1.x * d2.y == d2.x * d1.y;
    }
    EXPECT_GT(agree, 5000);
}

TEST(NormalMaps, Eq8_5_AWorkedExample) {
    const vec3 n(0.6f, 0.8f, 0);
    EXPECT_TRUE(are_near(across(along_x, n), {0.64f, -0.48f, 0}))
        << "what across() leaves of (1, 0, 0), with the normal (0.6, 0.8, 0)";
    EXPECT_TRUE(has_frame(along_x, n, 1, {{0.8f, -0.6f, 0}, -along_z, n}));
    EXPECT_TRUE(has_frame(along_x, n, -1, {{0.8f, -0.6f, 0}, along_z, n}));
    // Of a texture that lies slanted, as in the example with Eq. 8.3: orthogonal all the same.
    const float s = std::sqrt(0.2f);
    const vec3 tangent(2 * s, 0, s);
    EXPECT_TRUE(has_frame(tangent, along_y, 1, {tangent, {s, 0, -2 * s}, along_y}));
}

TEST(NormalMaps, Eq8_5_TheComponentAlongTheNormalIsRemoved) {
    for (const float handedness : {1.0f, -1.0f}) {
        const TangentFrame frame = tangent_frame({0.8f, 0, 0.6f}, along_z, handedness);
        EXPECT_TRUE(are_near(frame.tangent, along_x));
        EXPECT_TRUE(are_near(frame.bitangent, handedness * along_y));
        EXPECT_EQ(frame.normal, along_z);
    }
}

TEST(NormalMaps, HardCase_LengthsDoNotCountInAFrame) {
    look_up("Robust: Where little is left");
    for (const float handedness : {1.0f, -1.0f})
        for (const float length : {1e-37f, 1e-10f, 1e10f, 1e37f}) {
            const TangentFrame other =
                tangent_frame(length * vec3(0.8f, 0, 0.6f), length * along_z, handedness);
            ASSERT_TRUE(are_near(other.tangent, along_x)) << "all lengths times " << length;
            ASSERT_TRUE(is_orthonormal(other)) << "all lengths times " << length;
        }
    // What is left of nearly nothing is not lost.
    const TangentFrame steep = tangent_frame({0x1p-10f, 0, 1}, along_z, 1.0f);
    EXPECT_EQ(steep.tangent, along_x);
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

TEST(NormalMaps, Eq8_5_FramesAreOrthonormal) {
    // One step is exact enough where the tangent is not too near the normal.
    std::mt19937 random(10);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 10'000; ++i) {
        const vec3 n = unit_or({normal(random), normal(random), normal(random)}, along_x);
        const vec3 t = unit_or({normal(random), normal(random), normal(random)}, along_y);
        if (std::abs(glm::dot(t, n)) > 0.8f) continue;
        ASSERT_TRUE(is_orthonormal(tangent_frame(t, n, i % 2 ? 1.0f : -1.0f)))
            << "of tangent " << testing::PrintToString(t) << ", normal "
            << testing::PrintToString(n) << " (seed 10, case " << i << ")";
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
            << "of tangent " << testing::PrintToString(t) << ", normal "
            << testing::PrintToString(n) << " (seed 4, case " << i << ")";
    }
}

TEST(NormalMaps, HardCase_WhereNothingRemainsAnAxisIsTaken) {
    look_up("Robust: Where no tangent is left");
    // The axis of the normal's smallest component; the first one of equals.
    EXPECT_EQ(any_orthogonal(along_x), along_y);
    EXPECT_EQ(any_orthogonal(along_y), along_x);
    EXPECT_EQ(any_orthogonal(along_z), along_x);
    EXPECT_TRUE(are_near(any_orthogonal(vec3(0.6f, 0, -0.8f)), along_y));
    EXPECT_TRUE(
        are_near(any_orthogonal(vec3(0.48f, -0.64f, 0.6f)), {0.877f, 0.350f, -0.328f}, 0.0005f));
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    double least_degrees = 90;
    for (int i = 0; i < 100'000; ++i) {
        const vec3 n = unit_or({normal(random), normal(random), normal(random)}, along_x);
        const vec3 size = glm::abs(n), found = any_orthogonal(n);
        ASSERT_NEAR(glm::dot(found, n), 0, 1e-6f)
            << "any_orthogonal() of " << testing::PrintToString(n) << " (seed 7, case " << i << ")";
        ASSERT_NEAR(glm::length(found), 1, 1e-6f)
            << "any_orthogonal() of " << testing::PrintToString(n) << " (seed 7, case " << i << ")";
        const float least = std::min({size.x, size.y, size.z});
        least_degrees = std::min(least_degrees, glm::degrees(std::acos(double{least})));
        // Its component along that axis is the largest possible: the sine of the angle to n.
        ASSERT_NEAR(std::max({found.x, found.y, found.z}), std::sqrt(1 - least * least), 1e-6f)
            << "any_orthogonal() of " << testing::PrintToString(n)
            << ": not along the axis to which it leans least (seed 7, case " << i << ")";
    }
    EXPECT_NEAR(least_degrees, 54.7, 0.3);
    // So little of the tangent may be left, and no less.
    for (const float sign : {1.0f, -1.0f}) {
        EXPECT_EQ(unit_orthogonal({0, sign * 0x1p-19f, 1}, along_z), sign * along_y);
        EXPECT_EQ(unit_orthogonal({0, sign * 0x1p-21f, 1}, along_z), along_x);
    }
}

TEST(NormalMaps, Eq8_6_AWorkedExample) {
    // On the floor, around the origin: 90 degrees with u along x, 45 degrees with u along
    // (0.8, 0, -0.6). The uv of the second triangle: as far as its vertices lie along that, and
    // across it.
    const vec3 first_end = along_x, second_end(0, 0, -1);
    const vec3 third_end = unit_or({-1, 0, -1}, along_x);
    const auto slanted_uv = [](vec3 p) {
        return vec2(0.8f * p.x - 0.6f * p.z, -0.6f * p.x - 0.8f * p.z);
    };
    const Patch patch({vec3(0), first_end, second_end, second_end, third_end},
                      {vec2(0), {1, 0}, {0, 1}, slanted_uv(second_end), slanted_uv(third_end)},
                      {{0, 1, 2}, {0, 3, 4}});
    EXPECT_TRUE(are_near(uv_directions({vec3(0), second_end, third_end},
                                       {vec2(0), vec2(patch.mesh.uvs[3]), vec2(patch.mesh.uvs[4])})
                             .tangent,
                         {0.8f, 0, -0.6f}));
    for (std::size_t triangle = 0; triangle < 2; ++triangle) {
        const TangentFrame frame = patch.frame(triangle, 0);
        ASSERT_TRUE(are_near(frame.tangent, unit_or({2.8f, 0, -0.6f}, along_x), 1e-6f))
            << "the shared vertex's tangent: (1, 0, 0) at 90 degrees, (0.8, 0, -0.6) at 45";
        EXPECT_EQ(frame.normal, along_y);
    }
    EXPECT_NEAR(degrees_between(patch.frame(0, 0).tangent, along_x), 12.1, 0.05);
    EXPECT_NEAR(degrees_between(patch.frame(0, 0).tangent, {0.8f, 0, -0.6f}), 24.8, 0.05);
}

TEST(NormalMaps, Eq8_6_TangentsOfAPipePointAround) {
    for (const std::uint32_t strips : {4u, 16u, 64u}) {
        const Patch pipe = half_pipe(strips);
        const std::vector<vec4> tangents = pipe.tangents();
        for (const Triangle& triangle : pipe.mesh.triangles)
            for (const Vertex& vertex : triangle.vertices) {
                const vec3 out = pipe.mesh.normals[vertex.normal];
                const vec3 around(out.z, 0, -out.x);
                // At the two ends there is a face on one side only; orthogonal to the normal, its
                // tangent points around all the same.
                ASSERT_TRUE(are_near(vec3(tangents[vertex.normal]), around))
                    << "half a pipe of " << strips << " strips, the vertex at "
                    << testing::PrintToString(pipe.mesh.positions[vertex.position]);
                ASSERT_EQ(tangents[vertex.normal].w, 1) << "handedness";
            }
    }
}

TEST(NormalMaps, Eq8_6_AnglesCountAndNotTheNumberOfTriangles) {
    // Two squares in a plane meet at the origin's right and left; u turns by 60 degrees from one to
    // the other. The left one is cut through the vertex or not: it counts with 90 degrees anyway.
    const float c = 0.5f, s = std::sqrt(0.75f);
    for (const bool through_the_vertex : {false, true}) {
        // uv of the left square: such that u grows along (c, s); it is 0 at the shared vertices.
        std::vector<vec3> positions{vec3(0), along_x, {1, 1, 0}, along_y, {-1, 1, 0}, {-1, 0, 0}};
        std::vector<vec2> uvs{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {-c + s, s + c}, {-c, s}};
        // The vertex on the left that is shared has the uv of the other's: the origin.
        positions.push_back(along_y), uvs.push_back({s, c});
        std::vector<std::array<std::uint32_t, 3>> faces{{0, 1, 3}, {1, 2, 3}};
        if (through_the_vertex)
            faces.insert(faces.end(), {{0, 6, 4}, {0, 4, 5}});
        else
            faces.insert(faces.end(), {{0, 6, 5}, {6, 4, 5}});
        const Patch patch(positions, uvs, faces);
        EXPECT_NEAR(degrees_between(patch.frame(2, 0).tangent, along_x), 30, 1e-4)
            << "degrees between the shared vertex's tangent and x: two squares with tangents at 0 "
               "and 60 degrees; the second is cut into triangles "
            << (through_the_vertex ? "through that vertex" : "beside that vertex");
        // By itself the left square has its own: 60 degrees.
        EXPECT_NEAR(degrees_between(patch.frame(2, 1).tangent, along_x), 60, 1e-4);
        EXPECT_NEAR(degrees_between(patch.frame(0, 1).tangent, along_x), 0, 1e-4);
    }
}

TEST(NormalMaps, HardCase_NoAreaInTheTexture) {
    look_up("Robust: A triangle without area in the texture");
    const float infinity = std::numeric_limits<float>::infinity(), no_number = std::nanf("");
    const std::array<vec3, 3> p{vec3(0), along_x, along_y};
    // Two uvs are equal; all are; they lie on a line; they are not numbers.
    for (const std::array<vec2, 3>& uvs : {std::array{vec2(0.25f), vec2(0.25f), vec2(1)},
                                           {vec2(0), vec2(1, 0), vec2(0)},
                                           {vec2(0.5f), vec2(0.5f), vec2(0.5f)},
                                           {vec2(0), vec2(1), vec2(2)},
                                           {vec2(0), vec2(0.1f, 0.3f), vec2(0.2f, 0.6f)},
                                           {vec2(no_number), vec2(1, 0), vec2(0, 1)},
                                           {vec2(0), vec2(infinity, 0), vec2(0, 1)},
                                           {vec2(1e38f, 0), vec2(infinity), vec2(0, 1)}}) {
        const UvDirections found = uv_directions(p, uvs);
        ASSERT_EQ(found.handedness, 0) << named(p, uvs);
        ASSERT_EQ(found.tangent, vec3(0)) << named(p, uvs);
        ASSERT_EQ(found.bitangent, vec3(0)) << named(p, uvs);
        const Patch patch({p.begin(), p.end()}, {uvs.begin(), uvs.end()}, {{0, 1, 2}});
        for (std::size_t vertex = 0; vertex < 3; ++vertex) {
            const TangentFrame frame = patch.frame(0, vertex);
            ASSERT_TRUE(is_orthonormal(frame)) << named(p, uvs);
            ASSERT_EQ(frame.normal, along_z) << named(p, uvs);
            ASSERT_EQ(frame.tangent, along_x)
                << "the axis to which the normal leans least; " << named(p, uvs);
            ASSERT_EQ(frame.bitangent, along_y) << named(p, uvs);
        }
    }
    // Such a triangle leaves its neighbours' tangents alone.
    const Patch beside({vec3(0), along_x, along_y, {1, 1, 0}, {-1, 0, 0}},
                       {vec2(0), {0, 1}, {-1, 0}, {-1, 1}, vec2(0)}, {{0, 1, 2}, {0, 2, 4}});
    EXPECT_TRUE(are_near(beside.frame(0, 0).tangent, -along_y));
    EXPECT_TRUE(are_near(beside.frame(1, 0).tangent, -along_y)) << "it takes that of its neighbour";
}

TEST(NormalMaps, HardCase_NoAreaOnTheSurface) {
    look_up("Eq. 8.3");
    const std::array<vec2, 3> uvs{vec2(0), vec2(1, 0), vec2(0, 1)};
    const float infinity = std::numeric_limits<float>::infinity();
    for (const std::array<vec3, 3>& p : {std::array{vec3(1), vec3(1), vec3(1)},
                                         {vec3(0), vec3(0), vec3(1)},
                                         {vec3(0), vec3(1), vec3(2)},
                                         {vec3(0), vec3(infinity), vec3(1, 0, 0)}}) {
        ASSERT_EQ(uv_directions(p, uvs).handedness, 1)
            << "that is the texture's alone; " << named(p, uvs);
        const Patch patch({p.begin(), p.end()}, {uvs.begin(), uvs.end()}, {{0, 1, 2}});
        for (std::size_t vertex = 0; vertex < 3; ++vertex)
            ASSERT_TRUE(is_orthonormal(patch.frame(0, vertex))) << named(p, uvs);
    }
    // With a vertex that is not finite there are no directions; the handedness remains.
    for (const float not_finite : {infinity, -infinity, std::nanf("")})
        for (const std::size_t vertex : {0u, 1u, 2u}) {
            std::array<vec3, 3> p{vec3(0), along_x, along_y};
            p[vertex].z = not_finite;
            const UvDirections found = uv_directions(p, {uvs[0], uvs[2], uvs[1]});
            EXPECT_EQ(found.tangent, vec3(0)) << not_finite << " at vertex " << vertex;
            EXPECT_EQ(found.bitangent, vec3(0)) << not_finite << " at vertex " << vertex;
            EXPECT_EQ(found.handedness, -1) << not_finite << " at vertex " << vertex;
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
            const std::string where = std::string("two squares that meet at x = 0; ") +
                                      (is_mirrored ? "the mirrored one on the left, triangle "
                                                   : "the one on the right, triangle ") +
                                      std::to_string(triangle) + ", vertex " +
                                      std::to_string(vertex);
            ASSERT_TRUE(is_orthonormal(frame)) << where;
            ASSERT_EQ(frame.tangent, is_mirrored ? -along_x : along_x) << where;
            ASSERT_EQ(frame.bitangent, along_y) << "v grows upwards on either side; " << where;
            ASSERT_EQ(frame.normal, along_z) << where;
        }
}

TEST(NormalMaps, HardCase_TexturesOfAnySize) {
    look_up("Eq. 8.3");
    const Patch expected = half_pipe(8);
    for (const vec2 scale : {vec2(1e-36f), vec2(1e-20f, 1), vec2(1, 1e20f), vec2(1e36f),
                             vec2(1e-30f, 1e30f), vec2(0x1p-120f)}) {
        Patch pipe = half_pipe(8);
        for (dvec2& uv : pipe.mesh.uvs) uv *= scale;
        const std::vector<vec4> tangents = pipe.tangents(), plain = expected.tangents();
        for (std::size_t i = 0; i < plain.size(); ++i) {
            ASSERT_TRUE(are_near(vec3(tangents[i]), vec3(plain[i])))
                << "uvs times " << testing::PrintToString(scale);
            ASSERT_EQ(tangents[i].w, plain[i].w) << "uvs times " << testing::PrintToString(scale);
        }
    }
    // And the same of surfaces.
    for (const float scale : {1e-36f, 1e-20f, 1e20f, 1e36f}) {
        Patch pipe = half_pipe(8);
        for (vec3& position : pipe.mesh.positions) position *= scale;
        const std::vector<vec4> tangents = pipe.tangents(), plain = expected.tangents();
        for (std::size_t i = 0; i < plain.size(); ++i)
            ASSERT_TRUE(are_near(vec3(tangents[i]), vec3(plain[i]))) << "positions times " << scale;
    }
}

TEST(NormalMaps, HardCase_TangentAlongTheNormal) {
    look_up("Robust: Where no tangent is left");
    for (const vec3 n : {along_x, along_y, along_z, -along_z, vec3(0.6f, 0, 0.8f),
                         unit_or(vec3(1), along_x), unit_or(vec3(-3, 1, 2), along_x)})
        for (const float length : {-1e30f, -1.0f, 0.0f, 1e-30f, 1.0f, 1e30f}) {
            const TangentFrame frame = tangent_frame(length * n, n, 1.0f);
            ASSERT_TRUE(is_orthonormal(frame));
            ASSERT_EQ(frame.tangent, any_orthogonal(frame.normal))
                << "the tangent is " << length << " times the normal " << testing::PrintToString(n);
            ASSERT_LT(glm::length(frame.normal - n), few_roundings);
        }
    // A file may have normals that are parallel to the surface's tangent.
    const Patch patch({vec3(0), along_x, along_y}, {vec2(0), {1, 0}, {0, 1}}, {{0, 1, 2}},
                      {along_x, -along_x, along_z});
    for (std::size_t vertex = 0; vertex < 3; ++vertex)
        EXPECT_TRUE(is_orthonormal(patch.frame(0, vertex))) << vertex;
    EXPECT_EQ(patch.frame(0, 0).tangent, along_y);
    EXPECT_EQ(patch.frame(0, 2).tangent, along_x);
    // A mirrored one keeps its handedness.
    const Patch mirrored({vec3(0), along_x, along_y}, {vec2(0), {-1, 0}, {0, 1}}, {{0, 1, 2}},
                         {along_x, along_x, along_x});
    for (const vec4 tangent : mirrored.tangents()) EXPECT_EQ(tangent, vec4(along_y, -1));
}

TEST(NormalMaps, HardCase_ZeroNormal) {
    look_up("Eq. 8.5");
    const float infinity = std::numeric_limits<float>::infinity(), no_number = std::nanf("");
    for (const vec3 n : {vec3(0), vec3(no_number), vec3(infinity, 0, 0), vec3(0, -infinity, 1)}) {
        const TangentFrame frame = tangent_frame({1, 2, 0}, n, -1.0f);
        EXPECT_TRUE(is_orthonormal(frame));
        EXPECT_EQ(frame.normal, along_y);
        EXPECT_TRUE(are_near(frame.tangent, along_x));
        EXPECT_TRUE(are_near(frame.bitangent, along_z));
    }
    // Of a file: the vertex takes that of its face.
    const Patch patch({vec3(0), along_x, along_y}, {vec2(0), {1, 0}, {0, 1}}, {{0, 1, 2}},
                      {vec3(0), vec3(0), vec3(0)});
    EXPECT_EQ(patch.frame(0, 0).normal, along_z);
    EXPECT_EQ(patch.frame(0, 0).tangent, along_x);
}

TEST(NormalMaps, HardCase_OrderDoesNotMatter) {
    look_up("Robust: The order must not matter");
    // A closed fan of crumpled triangles around a vertex, some of them mirrored, some without area.
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
        uvs.push_back(vec2(std::cos(angle), std::sin(angle)) +
                      0.4f * vec2(any(random), any(random)));
        faces.push_back({0, i + 1, (i + 1) % rim + 1});
    }
    uvs[7] = uvs[8];
    const Patch expected(positions, uvs, faces, normals);
    const std::vector<vec4> tangents = expected.tangents();
    const auto tangent_of = [](const Patch& patch, const std::vector<vec4>& all, vec3 at,
                               vec3 face_middle) {
        for (const Triangle& triangle : patch.mesh.triangles) {
            vec3 low = patch.mesh.positions[triangle.vertices[0].position], high = low;
            for (const Vertex& vertex : triangle.vertices) {
                low = glm::min(low, patch.mesh.positions[vertex.position]);
                high = glm::max(high, patch.mesh.positions[vertex.position]);
            }
            if (low + high != face_middle) continue;
            for (const Vertex& vertex : triangle.vertices)
                if (patch.mesh.positions[vertex.position] == at) return all[vertex.normal];
        }
        ADD_FAILURE() << "no such vertex";
        return vec4(0);
    };
    const auto middle_of = [&](const std::array<std::uint32_t, 3>& face) {
        vec3 low = positions[face[0]], high = low;
        for (const std::uint32_t i : face)
            low = glm::min(low, positions[i]), high = glm::max(high, positions[i]);
        return low + high;
    };
    for (int shuffle = 0; shuffle < 200; ++shuffle) {
        // Vertices in another order, faces too, and each may begin with any of its vertices.
        std::vector<std::uint32_t> new_index(positions.size());
        for (std::uint32_t i = 0; i < new_index.size(); ++i) new_index[i] = i;
        std::shuffle(new_index.begin(), new_index.end(), random);
        std::vector<vec3> other_positions(positions.size()), other_normals(positions.size());
        std::vector<vec2> other_uvs(positions.size());
        for (std::size_t i = 0; i < positions.size(); ++i) {
            other_positions[new_index[i]] = positions[i];
            other_normals[new_index[i]] = normals[i];
            other_uvs[new_index[i]] = uvs[i];
        }
        auto other_faces = faces;
        for (auto& face : other_faces) {
            for (std::uint32_t& i : face) i = new_index[i];
            std::rotate(face.begin(), face.begin() + random() % 3, face.end());
        }
        std::shuffle(other_faces.begin(), other_faces.end(), random);
        const Patch other(other_positions, other_uvs, other_faces, other_normals);
        const std::vector<vec4> found = other.tangents();
        for (const auto& face : faces)
            for (const std::uint32_t i : face) {
                const vec4 a = tangent_of(expected, tangents, positions[i], middle_of(face));
                const vec4 b = tangent_of(other, found, positions[i], middle_of(face));
                ASSERT_EQ(std::memcmp(&a, &b, sizeof a), 0)
                    << "seed 5, shuffle " << shuffle << ": " << testing::PrintToString(a) << " and "
                    << testing::PrintToString(b);
            }
    }
}

TEST(NormalMaps, Eq8_6_FansOfSlantedFaces) {
    // Faces at an angle to the vertex's normal, each with its own texture: by the formula.
    std::mt19937 random(8);
    std::uniform_real_distribution<float> any(-1, 1);
    const auto unit = [](dvec3 v) { return v / std::sqrt(glm::dot(v, v)); };
    for (int i = 0; i < 500; ++i) {
        constexpr std::uint32_t count = 5;
        std::vector<vec3> positions{vec3(0)}, normals{vec3(any(random), any(random), 3)};
        std::vector<vec2> uvs{vec2(0)};
        std::vector<std::array<std::uint32_t, 3>> faces;
        const dvec3 n = unit(normals[0]);
        dvec3 sum(0);
        for (std::uint32_t k = 0; k < count; ++k) {
            const vec3 e1(any(random), any(random), any(random)),
                e2(any(random), any(random), any(random));
            const vec2 d1(1 + 0.4f * any(random), 0.4f * any(random));
            const vec2 d2(0.4f * any(random), 1 + 0.4f * any(random));
            positions.insert(positions.end(), {e1, e2});
            normals.insert(normals.end(), {along_z, along_z});
            uvs.insert(uvs.end(), {d1, d2});
            faces.push_back({0, 2 * k + 1, 2 * k + 2});
            const dvec3 tangent =
                unit(double{d2.y} * dvec3(e1) - double{d1.y} * dvec3(e2));  // det > 0
            const double angle = std::acos(glm::dot(unit(e1), unit(e2)));
            sum += angle * unit(tangent - glm::dot(tangent, n) * n);
        }
        if (glm::length(sum) < 0.5) continue;  // they nearly cancel
        const Patch patch(positions, uvs, faces, normals);
        for (std::size_t k = 0; k < count; ++k) {
            const vec4 found = patch.tangents()[patch.mesh.triangles[k].vertices[0].normal];
            // Some roundings of each of five terms up to pi, over the length of their sum.
            ASSERT_TRUE(are_near(vec3(found), vec3(unit(sum)), 5e-5f))
                << "the tangent of the vertex that five slanted faces share, with the normal "
                << testing::PrintToString(normals[0]) << " (seed 8, case " << i << ")";
            ASSERT_EQ(found.w, 1) << "handedness";
        }
    }
}

TEST(NormalMaps, HardCase_NegativeZeroIsTheSamePosition) {
    look_up("Robust: Which vertices are the same");
    // The square of two triangles, of which the second has its own vertices, with -0 for 0.
    const float c = 0.6f, s = 0.8f;  // its texture is turned
    const Patch patch(
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-0.0f, -0.0f, -0.0f}, {1, 1, -0.0f}, {-0.0f, 1, -0.0f}},
        {{0, 0}, {1, 0}, {1, 1}, {-0.0f, -0.0f}, {c - s, c + s}, {-s, c}}, {{0, 1, 2}, {3, 4, 5}},
        std::vector<vec3>(6, vec3(0, -0.0f, 1)));
    const Patch plain({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 1, 0}},
                      {{0, 0}, {1, 0}, {1, 1}, {-s, c}, {c - s, c + s}}, {{0, 1, 2}, {0, 4, 3}},
                      std::vector<vec3>(5, along_z));
    EXPECT_EQ(patch.frame(0, 0).tangent, patch.frame(1, 0).tangent);
    EXPECT_EQ(patch.frame(0, 0).tangent, plain.frame(0, 0).tangent);
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
        EXPECT_TRUE(are_near(patch.frame(0, 0).tangent, along_x)) << "of a model of size " << size;
        EXPECT_TRUE(are_near(patch.frame(1, 0).tangent, along_y)) << "of a model of size " << size;
    }
}

TEST(NormalMaps, HardCase_AnyVertexMayComeFirst) {
    look_up("Robust: The order must not matter");
    // Needles, in space and in the texture: what is left of Eq. 8.3's difference is mostly
    // rounding, and another vertex to start from would round otherwise.
    std::mt19937 random(9);
    std::uniform_real_distribution<float> any(-1, 1);
    for (int i = 0; i < 5000; ++i) {
        const float share = 0.5f + 0.4f * any(random);
        const auto some = [&](float size) {
            return size * vec3(any(random), any(random), any(random));
        };
        const vec3 p = some(1e-3f), q = some(1);
        const vec2 t(some(1e-3f)), u(some(1));
        const std::vector<vec3> positions{p, q, p + share * (q - p) + some(1e-6f)};
        const std::vector<vec2> uvs{t, u, t + share * (u - t) + vec2(some(1e-6f))};
        const std::vector<vec3> normals(3, vec3(0.1f, 0.2f, 1));
        const Patch first(positions, uvs, {{0, 1, 2}}, normals);
        const Patch second(positions, uvs, {{1, 2, 0}}, normals);
        const Patch third(positions, uvs, {{2, 0, 1}}, normals);
        for (std::size_t k = 0; k < 3; ++k) {
            const auto tangent_of = [&](const Patch& patch, std::size_t vertex) {
                return patch.tangents()[patch.mesh.triangles[0].vertices[vertex].normal];
            };
            const vec4 expected = tangent_of(first, k);
            ASSERT_EQ(tangent_of(second, (k + 2) % 3), expected) << "seed 9, case " << i;
            ASSERT_EQ(tangent_of(third, (k + 1) % 3), expected) << "seed 9, case " << i;
        }
    }
}

TEST(NormalMaps, HardCase_TangentsThatCancel) {
    look_up("Eq. 8.6");
    // Two triangles with one position and uv in common, and opposite textures.
    const Patch patch({vec3(0), along_x, along_y, -along_x, -along_y},
                      {vec2(0), {1, 0}, {0, 1}, {1, 0}, {0, 1}}, {{0, 1, 2}, {0, 3, 4}});
    for (std::size_t triangle = 0; triangle < 2; ++triangle) {
        const TangentFrame frame = patch.frame(triangle, 0);
        EXPECT_TRUE(is_orthonormal(frame));
        EXPECT_EQ(frame.tangent, any_orthogonal(frame.normal));
    }
}

TEST(NormalMaps, HardCase_InACrowdOfAMillionTangentsStillCancel) {
    look_up("Robust: The order must not matter");
    // Up to 2^21 shares are added as they are, all bits of them: opposite ones leave 0. All but two
    // of these triangles are points, whose three shares are 0 but count as triangles.
    std::vector<std::array<std::uint32_t, 3>> faces(0x100000 / 3, {0, 0, 0});
    faces.insert(faces.end(), {{0, 1, 2}, {0, 3, 4}});
    const vec3 first(1, 0.3f, 0), second(-0.2f, 1, 0);
    const Patch patch({vec3(0), first, second, -first, -second},
                      {vec2(0), {1, 0}, {0, 1}, {1, 0}, {0, 1}}, faces,
                      std::vector<vec3>(5, along_z));
    const std::vector<vec4> tangents = patch.tangents();
    for (const Triangle& triangle : {patch.mesh.triangles.end()[-2], patch.mesh.triangles.back()})
        EXPECT_EQ(tangents[triangle.vertices[0].normal], vec4(any_orthogonal(along_z), 1))
            << "at a vertex of two triangles with opposite tangents and a third of a million "
               "points";
}

TEST(NormalMaps, HardCase_TransformedModels) {
    look_up("Robust: Models that are transformed");
    // What is found on the stretched model is what the matrices make of what was found before it:
    // tangents transform like points, normals by the cofactor matrix.
    // The roof of the worked example.
    const mat3 twice_as_wide(2, 0, 0, 0, 1, 0, 0, 0, 1);
    EXPECT_EQ(twice_as_wide * vec3(1, -1, 0), vec3(2, -1, 0));
    EXPECT_EQ(normal_matrix(twice_as_wide) * vec3(1, 1, 0), vec3(1, 2, 0));
    const mat3 stretch = matrix_from_rows({2, 0.5f, 0}, {0, 0.25f, 1}, {-1, 0, 3});
    for (const float mirror : {1.0f, -1.0f}) {
        const mat3 m = stretch * mat3(mirror, 0, 0, 0, 1, 0, 0, 0, 1);
        const std::array<vec3, 3> p{vec3(0.5f, 0, 1), {1, 2, 0}, {0, 1, 1}};
        const std::array<vec2, 3> uvs{vec2(0.5f, 0), {1, 0.25f}, {0, 1}};
        const std::array<vec3, 3> q{m * p[0], m * p[1], m * p[2]};
        const UvDirections before = uv_directions(p, uvs), after = uv_directions(q, uvs);
        EXPECT_TRUE(are_near(after.tangent, unit_or(m * before.tangent, along_x), 1e-6f));
        EXPECT_TRUE(are_near(after.bitangent, unit_or(m * before.bitangent, along_x), 1e-6f));
        EXPECT_EQ(after.handedness, before.handedness) << "that is the texture's alone";
        const vec3 out = unit_or(glm::cross(p[1] - p[0], p[2] - p[0]), along_x);
        const vec3 stretched_out = unit_or(glm::cross(q[1] - q[0], q[2] - q[0]), along_x);
        EXPECT_TRUE(are_near(stretched_out, unit_or(normal_matrix(m) * out, along_x), 1e-6f));
        EXPECT_GT(glm::length(stretched_out - unit_or(m * out, along_x)), 0.1f)
            << "normals do not transform like points";
        const TangentFrame frame = tangent_frame(m * before.tangent, normal_matrix(m) * out, 1.0f);
        EXPECT_TRUE(is_orthonormal(frame));
        EXPECT_TRUE(are_near(frame.tangent, after.tangent, 1e-6f)) << "already across";
        // Outwards is -C N if M mirrors, and the handedness changes: B still points to where v
        // grows.
        const vec3 outwards = mirror * (normal_matrix(m) * out);
        const float h = mirror * static_cast<float>(before.handedness);
        const TangentFrame outside = tangent_frame(m * before.tangent, outwards, h);
        EXPECT_NEAR(glm::dot(outside.bitangent, after.bitangent),
                    glm::length(glm::cross(after.tangent, after.bitangent)), 1e-6f);
    }
}
