// SPDX-License-Identifier: MIT
// What is clipped and culled; numbers that are no numbers: 04_mvp_special_test.cpp.
#include "04_mvp/clip.hpp"

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "02_triangle_fill/triangle.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/projection.hpp"
#include "04_mvp/transform.hpp"
#include "common/app/counters.hpp"
#include "support/ascii_picture.hpp"
#include "support/cases.hpp"
#include "support/first_difference.hpp"
#include "support/look_up.hpp"
#include "support/plane_names.hpp"
#include "support/printers.hpp"
#include "support/projected.hpp"

using namespace rasterbook;
using rasterbook::test::look_up, rasterbook::test::Pixels, rasterbook::test::projected,
    rasterbook::test::same_pixels;

namespace {

using Vertices = std::array<vec4, 3>;
using lvec3 = glm::vec<3, long double>;
using Bits = std::array<std::uint32_t, 4>;

/// For EXPECT_TRUE: equal to the last bit.
testing::AssertionResult same_bits(vec4 actual, vec4 expected) {
    for (int i = 0; i < 4; ++i)
        if (std::bit_cast<std::uint32_t>(actual[i]) != std::bit_cast<std::uint32_t>(expected[i]))
            return testing::AssertionFailure()
                   << testing::PrintToString(actual) << ", expected "
                   << testing::PrintToString(expected) << "; " << "xyzw"[i] << " differs"
                   << test::ulps_between(actual[i], expected[i]);
    return testing::AssertionSuccess();
}

Bits bits_of(vec4 v) { return std::bit_cast<Bits>(std::array{v.x, v.y, v.z, v.w}); }

std::string places(const std::set<Bits>& points) {
    std::string text;
    for (const Bits& bits : points) {
        const auto p = std::bit_cast<std::array<float, 4>>(bits);
        text += testing::PrintToString(vec4(p[0], p[1], p[2], p[3])) + ' ';
    }
    return text;
}

std::vector<ClippedTriangle> clipped(const Vertices& vertices) {
    const ClippedTriangles triangles = clip_triangle(vertices);
    return {triangles.begin(), triangles.end()};
}

float greatest_size(const Vertices& vertices) {
    float greatest = 0;
    for (const vec4 vertex : vertices)
        for (int i = 0; i < 4; ++i) greatest = std::max(greatest, std::abs(vertex[i]));
    return greatest;
}

/// For EXPECT_TRUE: what is left lies in the frustum, and the barycentrics say where it comes from.
///
/// One crossing rounds four times: at the difference of the distances, the quotient, the product
/// and the sum, half an eps each. A vertex goes through at most six crossings.
testing::AssertionResult is_part_of(const ClippedTriangle& part, const Vertices& vertices) {
    const float tolerance = 6 * 4 * FLT_EPSILON / 2;
    const float greatest = greatest_size(vertices);
    for (const ClippedVertex& vertex : part) {
        const vec3 barycentrics = vertex.barycentrics;
        for (int i = 0; i < 3; ++i)
            if (!(barycentrics[i] >= -tolerance && barycentrics[i] <= 1 + tolerance))
                return testing::AssertionFailure() << "barycentrics outside of 0 to 1: "
                                                   << testing::PrintToString(barycentrics);
        if (!(std::abs(barycentrics.x + barycentrics.y + barycentrics.z - 1) <= tolerance))
            return testing::AssertionFailure() << "barycentrics that do not add up to 1: "
                                               << testing::PrintToString(barycentrics);
        const dvec4 sum = dvec4(vertices[0]) * double{barycentrics.x} +
                          dvec4(vertices[1]) * double{barycentrics.y} +
                          dvec4(vertices[2]) * double{barycentrics.z};
        for (int i = 0; i < 4; ++i)
            if (!(std::abs(sum[i] - vertex.position_clip[i]) <= tolerance * greatest))
                return testing::AssertionFailure()
                       << "the vertex " << testing::PrintToString(vertex.position_clip)
                       << " has the barycentrics " << testing::PrintToString(barycentrics)
                       << ", which give " << testing::PrintToString(sum);
        for (int plane = 0; plane < frustum_planes; ++plane)
            if (!(plane_distance(plane, vertex.position_clip) >= -tolerance * greatest))
                return testing::AssertionFailure()
                       << testing::PrintToString(vertex.position_clip) << " is outside of the "
                       << test::plane_names[plane] << " plane";
    }
    return testing::AssertionSuccess();
}

ScreenTriangle on_screen(const ClippedTriangle& part, ivec2 size) {
    return projected(part, size).on_screen;
}

Pixels covered_pixels(const Vertices& vertices, ivec2 size) {
    Pixels pixels;
    for (const ClippedTriangle& part : clip_triangle(vertices))
        fill_triangle(on_screen(part, size), size,
                      [&](ivec2 pixel, vec3) { pixels.insert({pixel.x, pixel.y}); });
    return pixels;
}

/// The oracle: whether the ray through a point of the screen hits the triangle between the planes.
///
/// The ray's points with w > 0 are multiples of (x, y, w = 1) in normalised device coordinates:
/// which sum of the vertices is that?
bool is_hit(const Vertices& vertices, lvec3 ray) {
    const auto column = [&](std::size_t i) {
        return lvec3(vertices[i].x, vertices[i].y, vertices[i].w);
    };
    const lvec3 a = column(0), b = column(1), c = column(2);
    const long double whole = glm::dot(a, glm::cross(b, c));
    if (whole == 0) return false;
    const lvec3 shares = lvec3(glm::dot(ray, glm::cross(b, c)), glm::dot(ray, glm::cross(c, a)),
                               glm::dot(ray, glm::cross(a, b))) /
                         whole;
    const long double z =
        shares.x * vertices[0].z + shares.y * vertices[1].z + shares.z * vertices[2].z;
    return shares.x >= 0 && shares.y >= 0 && shares.z >= 0 && z >= 0 && z <= 1;
}

bool is_hit(const Vertices& vertices, dvec2 point, ivec2 size) {
    return is_hit(vertices, {static_cast<long double>(point.x) * 2 / size.x - 1,
                             1 - static_cast<long double>(point.y) * 2 / size.y, 1});
}

/// Whether an edge is within 1/256 pixel of the centre, which is how far snapping may move it.
bool is_close_to_edge(const Vertices& vertices, dvec2 center, ivec2 size) {
    constexpr int directions = 16;
    for (int i = 0; i < directions; ++i) {
        const double angle = 2 * std::numbers::pi * i / directions;
        const dvec2 beside = center + dvec2(std::cos(angle), std::sin(angle)) / 256.0;
        if (is_hit(vertices, beside, size) != is_hit(vertices, center, size)) return true;
    }
    return false;
}

/// For EXPECT_TRUE: each pixel is as the oracle has it, unless an edge is close to its centre.
testing::AssertionResult covers_what_rays_hit(const Vertices& vertices, ivec2 size, int& covering) {
    const Pixels actual = covered_pixels(vertices, size);
    Pixels expected;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const dvec2 center(x + 0.5, y + 0.5);
            const bool is = actual.contains({x, y});
            bool should = is_hit(vertices, center, size);
            if (is != should && is_close_to_edge(vertices, center, size)) should = is;
            if (should) expected.insert({x, y});
        }
    covering += !expected.empty();
    return same_pixels(actual, expected);
}

constexpr Vertices all_inside = {{{-0.5f, -0.25f, 0.5f, 1}, {0.5f, -1, 0.25f, 1.5f}, {0, 2, 3, 3}}};

}  // namespace

TEST(Mvp, Eq4_10_DistanceToEachPlane) {
    const vec4 point(1, 2, 3, 8);
    const float expected[] = {9, 7, 10, 6, 5, 3};  // left, right, bottom, top, near, far
    for (int plane = 0; plane < frustum_planes; ++plane)
        EXPECT_EQ(plane_distance(plane, point), expected[plane])
            << "(1, 2, 3, 8) from the " << test::plane_names[plane] << " plane";
    EXPECT_EQ(plane_distance(1, {0, 0, 0, 1}), 1) << "the middle from the right plane";
    EXPECT_EQ(plane_distance(1, {3, 0, 0, 1}), -2) << "(3, 0, 0, 1) lies outside of it";
}

TEST(Mvp, Eq4_10_PlanesBoundTheCube) {
    const vec4 middle(0, 0, 1, 2);
    const vec4 on_plane[] = {{-2, 0, 1, 2}, {2, 0, 1, 2}, {0, -2, 1, 2},
                             {0, 2, 1, 2},  {0, 0, 2, 2}, {0, 0, 0, 2}};
    for (int plane = 0; plane < frustum_planes; ++plane) {
        const vec4 point = on_plane[plane];
        for (int other = 0; other < frustum_planes; ++other)
            ASSERT_EQ(plane_distance(other, point),
                      plane_distance(other, middle) * (other == plane         ? 0.0f
                                                       : other == (plane ^ 1) ? 2.0f
                                                                              : 1.0f))
                << testing::PrintToString(point) << ", which is on the " << test::plane_names[plane]
                << " plane, from the " << test::plane_names[other] << " one";
    }
}

TEST(Mvp, Eq4_11_CrossingOfTheWorkedExample) {
    const ClippedVertex from = {{0, 0, 0, 1}, {1, 0, 0}}, to = {{3, 0, 0, 1}, {0, 1, 0}};
    const ClippedVertex there = crossing(from, 1, to, -2);
    EXPECT_EQ(there.position_clip, vec4(1, 0, 0, 1))
        << "from (0, 0, 0, 1), inside of the right plane by 1, to (3, 0, 0, 1), by -2";
    EXPECT_NEAR(there.barycentrics.x, 2.0f / 3, FLT_EPSILON);
    EXPECT_NEAR(there.barycentrics.y, 1.0f / 3, FLT_EPSILON);
    EXPECT_EQ(there.barycentrics.z, 0);
}

TEST(Mvp, Eq4_12_BothWaysCrossInTheSamePoint) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(-3, 3);
    int crossings = 0;
    for (int i = 0; i < 200'000; ++i) {
        const auto vector = [&] {
            return vec4(any(random), any(random), any(random), any(random));
        };
        const ClippedVertex from = {vector(), vec3(vector())}, to = {vector(), vec3(vector())};
        const int plane = i % frustum_planes;
        const float from_by = plane_distance(plane, from.position_clip),
                    to_by = plane_distance(plane, to.position_clip);
        if ((from_by >= 0) == (to_by >= 0)) continue;
        ++crossings;
        const ClippedVertex there = crossing(from, from_by, to, to_by),
                            back = crossing(to, to_by, from, from_by);
        ASSERT_TRUE(same_bits(back.position_clip, there.position_clip))
            << "the crossing from b to a, and from a to b: Eq. 4.12 is symmetric. a "
            << testing::PrintToString(from.position_clip) << ", inside by " << from_by << ", b "
            << testing::PrintToString(to.position_clip) << ", by " << to_by << "; seed 1, case "
            << i;
        ASSERT_EQ(back.barycentrics, there.barycentrics)
            << "at the crossing from b to a, and from a to b; seed 1, case " << i;
        // Half an eps for each of four roundings, of the greatest number there is, 3 or 6.
        ASSERT_NEAR(plane_distance(plane, there.position_clip), 0, 12 * FLT_EPSILON)
            << "the crossing " << testing::PrintToString(there.position_clip) << " from the "
            << test::plane_names[plane] << " plane; seed 1, case " << i;
    }
    EXPECT_GT(crossings, 80'000);
}

TEST(Mvp, Eq4_13_WhatIsLeftOfTheWorkedExample) {
    // A right angle at the middle; its sides end twice as far away as the picture.
    const Vertices vertices = {{{0, 0, 0, 1}, {2, 0, 0, 1}, {0, 2, 0, 1}}};
    std::set<std::pair<float, float>> left;
    for (const ClippedTriangle& part : clipped(vertices)) {
        EXPECT_TRUE(is_part_of(part, vertices));
        for (const ClippedVertex& vertex : part)
            left.insert({vertex.position_clip.x, vertex.position_clip.y});
    }
    EXPECT_EQ(left, (std::set<std::pair<float, float>>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}))
        << "x and y of what is left of (0, 0), (2, 0), (0, 2), with w = 1";
}

TEST(Mvp, Eq4_13_WhatIsAllInsideStaysBitForBit) {
    const auto parts = clipped(all_inside);
    ASSERT_EQ(parts.size(), 1u) << "triangles left of one that is all inside";
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_TRUE(same_bits(parts[0][i].position_clip, all_inside[i])) << "vertex " << "abc"[i];
        EXPECT_EQ(parts[0][i].barycentrics, vec3(i == 0, i == 1, i == 2)) << "vertex " << "abc"[i];
    }
}

TEST(Mvp, Eq4_13_NothingIsLeftOutsideOfOnePlane) {
    EXPECT_FALSE(clipped(all_inside).empty()) << "nothing is left of a triangle all inside";
    for (int plane = 0; plane < frustum_planes; ++plane) {
        Vertices vertices = all_inside;
        for (vec4& vertex : vertices) {
            constexpr float beyond[] = {-1.001f, 1.001f, -1.001f, 1.001f, 1.001f, -0.001f};
            vertex[plane / 2] = beyond[plane] * vertex.w;
        }
        ASSERT_TRUE(clipped(vertices).empty())
            << "something is left outside of the " << test::plane_names[plane]
            << " plane: " << testing::PrintToString(vertices);
    }
}

TEST(Mvp, BarycentricsOfWhatIsLeftSayWhereItComesFrom) {
    look_up("Eq. 4.13, and 4.12 for positions and barycentrics alike");
    std::mt19937 random(2);
    std::uniform_real_distribution<float> any(-3, 3);
    int cut = 0;
    for (int i = 0; i < test::cases_of(100'000); ++i) {
        const auto vertex = [&] {
            return vec4(any(random), any(random), any(random), any(random) + 1);
        };
        const Vertices vertices = {vertex(), vertex(), vertex()};
        const auto parts = clipped(vertices);
        for (const ClippedTriangle& part : parts)
            ASSERT_TRUE(is_part_of(part, vertices))
                << "of the triangle " << testing::PrintToString(vertices) << "; seed 2, case " << i;
        cut += parts.size() > 2;
    }
    EXPECT_GT(cut, test::cases_of(10'000))
        << "triangles of which more than two parts are left, of " << test::cases_of(100'000);
}

TEST(Mvp, WhatIsLeftKeepsTheWinding) {
    look_up("Eq. 4.13: the vertices stay in their order");
    constexpr ivec2 size(640, 480);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> any(-3, 3);
    int parts = 0;
    for (int i = 0; i < 20'000; ++i) {
        const auto vertex = [&] {
            return vec4(any(random), any(random), any(random), any(random) + 2);
        };
        const Vertices vertices = {vertex(), vertex(), vertex()};
        const auto row = [&](std::size_t k) {
            return dvec3(vertices[k].x, vertices[k].y, vertices[k].w);
        };
        const double turn = glm::dot(row(0), glm::cross(row(1), row(2)));
        for (const ClippedTriangle& part : clip_triangle(vertices)) {
            const std::int64_t twice_area = on_screen(part, size).twice_area;
            constexpr std::int64_t pixel = 65536;  // slivers may be turned by the snapping
            if (std::abs(twice_area) < 4 * pixel) continue;
            ASSERT_EQ(twice_area > 0, turn > 0)
                << "a part is seen counter-clockwise, and the triangle "
                << testing::PrintToString(vertices) << "; seed 3, case " << i;
            ++parts;
        }
    }
    EXPECT_GT(parts, 10'000);
}

TEST(Mvp, HardCase_SharedEdgeIsCutInTheSamePoints) {
    look_up("Eq. 4.12: the same from both ends, bit for bit");
    std::mt19937 random(4);
    std::uniform_real_distribution<float> any(-3, 3);
    int cut = 0;
    for (int i = 0; i < 100'000; ++i) {
        const auto vertex = [&] {
            return vec4(any(random), any(random), any(random), any(random) + 1.5f);
        };
        const vec4 first = vertex(), second = vertex(), third = vertex(), fourth = vertex();
        const auto on_edge = [&](const Vertices& vertices) {
            std::set<Bits> points;
            for (const ClippedTriangle& part : clip_triangle(vertices))
                for (const ClippedVertex& p : part)
                    if (p.barycentrics.z == 0) points.insert(bits_of(p.position_clip));
            return points;
        };
        const auto points = on_edge({first, second, third});
        const auto other = on_edge({second, first, fourth});
        if (points.empty() || other.empty()) continue;  // one of them is all outside
        ASSERT_TRUE(points == other)
            << "two triangles share the side from " << testing::PrintToString(first) << " to "
            << testing::PrintToString(second)
            << ", and are cut there in other points: " << places(points) << "and " << places(other)
            << "; seed 4, case " << i;
        cut += points != std::set<Bits>{bits_of(first), bits_of(second)};
    }
    EXPECT_GT(cut, 10'000);
}

TEST(Mvp, HardCase_TrianglesAroundTheCameraCoverWhatItsRaysHit) {
    look_up("Eq. 4.10 to 4.13");
    constexpr ivec2 size(32, 24);
    const mat4 clip_from_view = perspective(1.2f, 32.0f / 24, 0.25f);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> spread(0.3f, 12), any(-1, 1);
    int covering = 0;
    for (int i = 0; i < 10'000; ++i) {
        const float reach = spread(random);
        const auto vertex = [&] {
            return clip_from_view *
                   vec4(reach * any(random), reach * any(random), reach * any(random), 1);
        };
        const Vertices vertices = {vertex(), vertex(), vertex()};
        ASSERT_TRUE(covers_what_rays_hit(vertices, size, covering))
            << "of the triangle " << testing::PrintToString(vertices)
            << " in clip space; seed 5, case " << i;
    }
    EXPECT_GT(covering, 3'000);
}

TEST(Mvp, HardCase_TriangleAcrossAllSixPlanes) {
    look_up("Eq. 4.13: plane by plane");
    const Vertices vertices = {{{-10, -9, 4.5f, 1}, {12, -9, 0, 1}, {0, 10, -1.5f, 1}}};
    for (int plane = 0; plane < frustum_planes; ++plane)
        EXPECT_LT(std::min({plane_distance(plane, vertices[0]), plane_distance(plane, vertices[1]),
                            plane_distance(plane, vertices[2])}),
                  0);
    int covering = 0;
    EXPECT_TRUE(covers_what_rays_hit(vertices, {64, 48}, covering));
    EXPECT_EQ(covering, 1);
    for (const ClippedTriangle& part : clip_triangle(vertices))
        EXPECT_TRUE(is_part_of(part, vertices));
}

TEST(Mvp, HardCase_NearPlaneThroughVertices) {
    look_up("Eq. 4.13: a vertex on the plane is inside");
    const vec4 on(0.25f, 0, 1, 1), also_on(-0.5f, 0.25f, 1, 1), third_on(0, -0.5f, 1, 1),
        inside(0, 0.5f, 0.5f, 1), beside(0.5f, 0.5f, 0.25f, 1), outside(0, 0, 1.5f, 1),
        far_outside(0.5f, 0, 2, 1);
    for (const Vertices& vertices : {Vertices{on, inside, beside}, Vertices{on, also_on, inside},
                                     Vertices{on, also_on, third_on}}) {
        const auto parts = clipped(vertices);
        ASSERT_EQ(parts.size(), 1u);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_EQ(bits_of(parts[0][i].position_clip), bits_of(vertices[i]));
    }
    for (const Vertices& vertices :
         {Vertices{on, outside, far_outside}, Vertices{on, also_on, outside},
          Vertices{far_outside, on, outside}})
        for (const ClippedTriangle& part : clip_triangle(vertices)) {
            EXPECT_TRUE(is_part_of(part, vertices));
            EXPECT_EQ(on_screen(part, {640, 480}).twice_area, 0) << "a point or a side is left";
        }
    int covering = 0;
    EXPECT_TRUE(covers_what_rays_hit({on, inside, outside}, {64, 48}, covering));
    EXPECT_TRUE(covers_what_rays_hit({outside, on, inside}, {64, 48}, covering));
    EXPECT_EQ(covering, 2);
}

TEST(Mvp, HardCase_CameraInsideATriangle) {
    look_up("Eq. 4.13: w is 0 at the eye, and the near plane lies before it");
    const mat4 clip_from_view = perspective(1.0f, 4.0f / 3, 0.001f);
    const auto floor_at = [&](float y) {
        return Vertices{clip_from_view * vec4(-50, y, 40, 1), clip_from_view * vec4(60, y, 30, 1),
                        clip_from_view * vec4(0, y, -80, 1)};
    };
    EXPECT_TRUE(covered_pixels(floor_at(0), {64, 48}).empty()) << "seen from its edge";
    int covering = 0;
    for (const float y : {-0.01f, 0.01f, -1.0f})
        EXPECT_TRUE(covers_what_rays_hit(floor_at(y), {64, 48}, covering)) << y;
    EXPECT_EQ(covering, 3);
}

TEST(Mvp, HardCase_WZeroNegativeAndTiny) {
    look_up("Eq. 4.10: what lies behind the eye is outside of a plane");
    constexpr ivec2 size(64, 48);
    for (const float w : {0.0f, -0.0f, -1.0f, -1e-40f}) {
        EXPECT_TRUE(covered_pixels({{{0, 0, 1, w}, {1, 0, 1, w}, {0, 1, 1, w}}}, size).empty());
        int covering = 0;
        EXPECT_TRUE(covers_what_rays_hit(
            {{{0.1f, 0.2f, w + 0.5f, w}, all_inside[1], all_inside[2]}}, size, covering))
            << "w " << w;
        EXPECT_EQ(covering, 1);
    }
    EXPECT_TRUE(covered_pixels({vec4(0), vec4(0), vec4(0)}, size).empty());
    EXPECT_TRUE(covered_pixels({vec4(0), all_inside[1], all_inside[2]}, size).empty())
        << "a vertex at the eye has no place on the screen";
    // A tiny w is ordinary: positions on the screen are quotients.
    constexpr float tiny = 0x1p-135f;
    EXPECT_EQ(
        covered_pixels({{tiny * all_inside[0], tiny * all_inside[1], tiny * all_inside[2]}}, size),
        covered_pixels(all_inside, size));
}

TEST(Mvp, HardCase_TinyAndHugeVerticesAreCutAsOthers) {
    look_up("Eq. 4.12: products of vertices may overflow, quotients do not");
    constexpr ivec2 size(64, 48);
    const Vertices vertices = {{{-1, -2, 0.5f, 1}, {3, 0, 0.75f, 2}, {0, 2, 0.875f, 1.5f}}};
    const Pixels expected = covered_pixels(vertices, size);
    EXPECT_GT(expected.size(), 500u);
    for (const float scale : {0x1p-120f, 0x1p-70f, 0x1p70f, 0x1p120f})
        EXPECT_TRUE(same_pixels(
            covered_pixels({{scale * vertices[0], scale * vertices[1], scale * vertices[2]}}, size),
            expected))
            << scale;
}

TEST(Mvp, Eq4_14_BoxesOutsideOfAPlaneAreCulled) {
    const mat4 clip_from_view = perspective(1.5707963f, 1.0f, 1.0f);
    const auto box = [](vec3 center) { return Bounds{center - 0.5f, center + 0.5f}; };
    EXPECT_FALSE(is_outside_frustum(box({0, 0, -5}), clip_from_view));
    for (const vec3 center : {vec3(-7, 0, -5), vec3(7, 0, -5), vec3(0, -7, -5), vec3(0, 7, -5),
                              vec3(0, 0, -0.3f), vec3(0, 0, 5), vec3(0, 0, 50)})
        EXPECT_TRUE(is_outside_frustum(box(center), clip_from_view))
            << "a box of side 1 around " << testing::PrintToString(center)
            << " is all outside of one plane";
    for (const vec3 center : {vec3(-5.4f, 0, -5), vec3(5.4f, 0, -5), vec3(0, -5.4f, -5),
                              vec3(0, 5.4f, -5), vec3(0, 0, -0.6f), vec3(0, 0, -1e9f)})
        EXPECT_FALSE(is_outside_frustum(box(center), clip_from_view))
            << "a box of side 1 around " << testing::PrintToString(center)
            << " reaches across a plane, or lies far away";
    EXPECT_FALSE(is_outside_frustum({{-90, -1, -4}, {90, 1, -3}}, clip_from_view))
        << "from (-90, -1, -4) to (90, 1, -3): some corners are outside of the left plane, the "
           "others of the right one, and the middle is seen";
}

TEST(Mvp, Eq4_14_NoBoxIsCulledOfWhichAPointIsSeen) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> any(-1, 1), share(0, 1);
    int culled = 0, seen = 0;
    for (int i = 0; i < test::cases_of(20'000); ++i) {
        const auto point = [&](float reach) {
            return reach * vec3(any(random), any(random), any(random));
        };
        const Camera camera = {
            {}, look_at(point(5), point(5), vec3(0, 1, 0)), 0.1f + 2.5f * share(random), 0.1f};
        const mat4 clip_from_world = camera.clip_from_world({64, 48});
        Bounds bounds;
        const vec3 place = point(8);
        bounds.add(place), bounds.add(place + point(4));
        const bool is_culled = is_outside_frustum(bounds, clip_from_world);
        bool is_seen = false;
        for (int k = 0; k < 100 && !is_seen; ++k) {
            const dvec3 inside = glm::mix(dvec3(bounds.min), dvec3(bounds.max),
                                          dvec3(share(random), share(random), share(random)));
            const dvec4 clip = dmat4(clip_from_world) * dvec4(inside, 1);
            is_seen = glm::all(glm::lessThan(glm::abs(dvec3(clip)), dvec3(clip.w)));
        }
        ASSERT_FALSE(is_culled && is_seen)
            << "the box from " << testing::PrintToString(bounds.min) << " to "
            << testing::PrintToString(bounds.max) << " is culled, and a point of it is seen by "
            << testing::PrintToString(clip_from_world) << "; seed 7, case " << i;
        culled += is_culled, seen += is_seen;
    }
    EXPECT_GT(culled, test::cases_of(2'000));
    EXPECT_GT(seen, test::cases_of(2'000));
}

TEST(Mvp, HardCase_BoxAroundTheCameraIsNotCulled) {
    look_up("Eq. 4.14: outside of one and the same plane");
    const mat4 clip_from_view = perspective(1.0f, 1.0f, 0.1f);
    EXPECT_FALSE(is_outside_frustum({vec3(-9), vec3(9)}, clip_from_view));
    EXPECT_FALSE(is_outside_frustum({{-90, -1, -4}, {90, 1, -3}}, clip_from_view));
    EXPECT_FALSE(is_outside_frustum({{0, 0, -1}, {0, 0, -1}}, clip_from_view)) << "a point";
    EXPECT_TRUE(is_outside_frustum({{-90, -90, 0.1f}, {90, 90, 1}}, clip_from_view)) << "behind";
}

TEST(Mvp, Eq4_9_ProjectingDividesByWAndSnaps) {
    const Mesh mesh;
    const Triangle triangle{};
    // In NDC (-0.5, 0.5, 0.5), (-0.5, -0.5, 0.25) and (0.5, 0.5, 1).
    const ClippedTriangle clipped = {{{{-1, 1, 1, 2}, {1, 0, 0}},
                                      {{-0.5f, -0.5f, 0.25f, 1}, {0, 1, 0}},
                                      {{2, 2, 4, 4}, {0, 0, 1}}}};
    const ProjectedTriangle front = project(mesh, triangle, clipped, {8, 4});
    EXPECT_TRUE(&front.mesh == &mesh);
    EXPECT_TRUE(&front.triangle == &triangle);
    EXPECT_EQ(front.on_screen.vertices,
              (std::array{256 * ivec2(2, 1), 256 * ivec2(2, 3), 256 * ivec2(6, 1)}))
        << "in 1/256 pixel; (-1, 1), (-1, -1) and (1, 1) halved, in a picture of 8 x 4 pixels";
    EXPECT_FALSE(front.is_back_facing);
    EXPECT_EQ(front.depth.at({1, 0, 0}), 0.5f);
    EXPECT_EQ(front.depth.at({0, 1, 0}), 0.25f);
    EXPECT_EQ(front.depth.at({0, 0, 1}), 1);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(front.clipped[i].position_clip, clipped[i].position_clip);
        EXPECT_EQ(front.clipped[i].barycentrics, clipped[i].barycentrics);
    }
    const ClippedTriangle turned = {{clipped[0], clipped[2], clipped[1]}};
    EXPECT_TRUE(project(mesh, triangle, turned, {8, 4}).is_back_facing);
    const ClippedTriangle degenerate = {{clipped[0], clipped[0], clipped[1]}};
    EXPECT_TRUE(project(mesh, triangle, degenerate, {8, 4}).is_back_facing) << "never drawn";
}

TEST(Mvp, EachVisibleTriangleIsVisitedInTheScenesOrder) {
    look_up("Eq. 4.14: what is culled; and each piece of Eq. 4.13 in its order");
    const mat4 clip_from_world = perspective(1.0f, 1.0f, 1.0f);
    constexpr ivec2 size(64);
    const auto mesh = [](float z, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
        Mesh result;
        result.positions = {{0, 0, z}, {1, 0, z}, {0, 1, z}, {0, 0, 5}};
        for (const auto& [a, b, c] : triangles) {
            result.triangles.push_back({{Vertex{a}, Vertex{b}, Vertex{c}}, 0});
            for (const std::uint32_t i : {a, b, c}) result.bounds.add(result.positions[i]);
        }
        return result;
    };
    Scene scene;
    scene.meshes.push_back(mesh(-4, {{0, 1, 2}, {0, 2, 1}}));  // front and back
    scene.meshes.push_back(mesh(4, {{0, 1, 2}}));              // behind the camera
    scene.meshes.push_back(mesh(-3, {{1, 2, 3}, {0, 1, 2}}));  // one cut by the near plane
    scene.meshes[2].tangents.resize(1);

    struct Visited {
        const Mesh* mesh;
        const Triangle* triangle;
        bool is_back_facing;
        bool operator==(const Visited&) const = default;
    };
    const auto visited = [&](Culling culling) {
        std::vector<Visited> all;
        for_each_visible_triangle(
            scene, clip_from_world, size, culling, [&](const ProjectedTriangle& triangle) {
                all.push_back({&triangle.mesh, &triangle.triangle, triangle.is_back_facing});
            });
        return all;
    };
    const Mesh &first = scene.meshes[0], &last = scene.meshes[2];
    thread_counters = {};
    const std::vector<Visited> fronts = visited(Culling::back_faces);
    const Counters culled = std::exchange(thread_counters, {});
    std::vector<Visited> both = visited(Culling::none);
    const Counters all = thread_counters;
    const auto parts = std::ranges::count(both, &last.triangles[0], &Visited::triangle);
    EXPECT_GE(parts, 1) << "what the near plane leaves";
    std::vector<Visited> expected = {{&first, &first.triangles[0], false},
                                     {&first, &first.triangles[1], true}};
    const bool is_back = both.at(2).is_back_facing;
    for (int i = 0; i < parts; ++i) expected.push_back({&last, &last.triangles[0], is_back});
    expected.push_back({&last, &last.triangles[1], false});
    EXPECT_TRUE(both == expected);
    std::erase_if(both, [](const Visited& one) { return one.is_back_facing; });
    EXPECT_TRUE(fronts == both);
    for (const Counters& counters : {culled, all}) {
        EXPECT_EQ(counters[Counter::meshes_in], 3u);
        EXPECT_EQ(counters[Counter::meshes_culled_by_frustum], 1u);
        EXPECT_EQ(counters[Counter::meshes_with_tangents], 1u);
        EXPECT_EQ(counters[Counter::triangles_in], 4u);
    }
    EXPECT_EQ(all[Counter::triangles_culled_by_facing], 0u);
    EXPECT_EQ(culled[Counter::triangles_culled_by_facing], expected.size() - fronts.size());
}
