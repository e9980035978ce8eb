// SPDX-License-Identifier: MIT
#include "03_z_buffer/depth_buffer.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <iostream>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "02_triangle_fill/triangle.hpp"
#include "common/math/numerics.hpp"
#include "support/cases.hpp"
#include "support/exact.hpp"
#include "support/first_difference.hpp"
#include "support/golden.hpp"
#include "support/look_up.hpp"

using namespace rasterbook;
using rasterbook::test::exact_center, rasterbook::test::exact_twice_area,
    rasterbook::test::exactly_snapped, rasterbook::test::look_up;

namespace {

constexpr float uncovered = -1.0f;  ///< Where a triangle has no depth.

struct Patch {
    std::array<vec3, 3> vertices;  ///< x, y in pixels, depth
    int id;
};

/// Draws the triangles with depth; each pixel holds the id of the visible one, -1 where there is
/// none.
Image<int> visible(const std::vector<Patch>& patches, ivec2 size) {
    Image<int> ids(size, -1);
    DepthBuffer depth(size);
    for (const Patch& patch : patches) {
        const auto& [a, b, c] = patch.vertices;
        const TriangleDepth triangle_depth(vec3(a.z, b.z, c.z));
        fill_triangle(snap_triangle(a, b, c), size, [&](ivec2 pixel, vec3 barycentrics) {
            if (depth.test_and_write(pixel, triangle_depth.at(barycentrics))) ids[pixel] = patch.id;
        });
    }
    return ids;
}

Image<float> depths_of(const std::array<vec3, 3>& p, ivec2 offset, ivec2 size) {
    Image<float> depths(size, uncovered);
    const TriangleDepth triangle_depth(vec3(p[0].z, p[1].z, p[2].z));
    fill_triangle(snap_triangle(p[0], p[1], p[2]), offset + size,
                  [&](ivec2 pixel, vec3 barycentrics) {
                      depths[pixel - offset] = triangle_depth.at(barycentrics);
                  });
    return depths;
}

/// The plane through the snapped vertices at a pixel's centre, in long double.
long double exact_depth(const std::array<vec3, 3>& p, ivec2 pixel) {
    const ivec2 a = exactly_snapped(p[0]), b = exactly_snapped(p[1]), c = exactly_snapped(p[2]);
    const auto area = [](ivec2 from, ivec2 to, ivec2 at) {
        return static_cast<long double>(exact_twice_area(from, to, at));
    };
    const ivec2 at = exact_center(pixel);
    return (area(b, c, at) * p[0].z + area(c, a, at) * p[1].z + area(a, b, at) * p[2].z) /
           area(a, b, c);
}

/// The error that the derivation finds for Eq. 3.3 where the exact depth is this: 4 eps of what it
/// is above the smallest depth, and half an eps of itself.
long double depth_tolerance(const std::array<vec3, 3>& p, long double exact) {
    const long double above_low = exact - std::min({p[0].z, p[1].z, p[2].z});
    return 4 * FLT_EPSILON * std::max(above_low, 0.0L) + FLT_EPSILON / 2 * exact;
}

std::string name(const std::array<vec3, 3>& p) {
    return "the triangle (x, y, depth) " + testing::PrintToString(p);
}

/// For EXPECT_TRUE: within the derived error.
testing::AssertionResult is_exact_depth(const std::array<vec3, 3>& p, ivec2 pixel, float depth) {
    const long double exact = exact_depth(p, pixel), error = std::abs(depth - exact);
    const long double tolerance = depth_tolerance(p, exact);
    if (error <= tolerance) return testing::AssertionSuccess();
    return testing::AssertionFailure()
           << "the depth at pixel " << testing::PrintToString(pixel) << " is "
           << test::text_of(depth) << ", expected " << exact << ", off by " << error / tolerance
           << " times what Eq. 3.3 may be; " << name(p);
}

std::vector<Patch> random_patches(unsigned seed, int count, ivec2 size) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> x(-20, static_cast<float>(size.x) + 20),
        y(-20, static_cast<float>(size.y) + 20), z(0, 1);
    std::vector<Patch> patches;
    for (int i = 0; i < count; ++i) {
        const auto vertex = [&] { return vec3(x(random), y(random), z(random)); };
        patches.push_back({{vertex(), vertex(), vertex()}, i});
    }
    return patches;
}

constexpr ivec2 origin(0, 0);

}  // namespace

TEST(ZBuffer, Eq3_1_KeepsTheGreatestOfAFewDepths) {
    DepthBuffer depth({1, 1});
    EXPECT_EQ(depth.depths()[origin], 0.0f) << "in a new buffer";
    EXPECT_TRUE(depth.test_and_write(origin, 0.5f)) << "the first: 0.5 is nearer than 0";
    EXPECT_EQ(depth.depths()[origin], 0.5f) << "kept after 0.5";
    EXPECT_FALSE(depth.test_and_write(origin, 0.25f)) << "0.25 lies behind 0.5";
    EXPECT_EQ(depth.depths()[origin], 0.5f) << "kept after 0.5 and 0.25";
    EXPECT_TRUE(depth.test_and_write(origin, 0.75f)) << "0.75 is nearer than 0.5";
    EXPECT_EQ(depth.depths()[origin], 0.75f) << "kept after 0.5, 0.25 and 0.75";
}

TEST(ZBuffer, Eq3_1_KeepsTheGreatestOfManyDepths) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(0, 1);
    DepthBuffer depth({1, 1});
    float greatest = 0;
    for (int i = 0; i < 1000; ++i) {
        const float z = any(random);
        ASSERT_EQ(depth.test_and_write(origin, z), z > greatest) << z << " after " << greatest;
        greatest = std::max(greatest, z);
        ASSERT_EQ(depth.depths()[origin], greatest) << "kept after " << z;
    }
}

TEST(ZBuffer, Eq3_2_DepthOfTheWorkedExample) {
    // Shares 1/4, 3/8, 3/8 of depths 0.25, 0.5, 0.75 at pixel (2, 2).
    const auto depths = depths_of({{{1, 1, 0.25f}, {1, 5, 0.5f}, {5, 1, 0.75f}}}, {0, 0}, {8, 8});
    EXPECT_EQ(depths[ivec2(2, 2)], 0.53125f)
        << "the barycentrics 1/4, 3/8, 3/8 of the depths 0.25, 0.5, 0.75";
}

TEST(ZBuffer, Eq3_3_MeasuredFromTheFarthestVertexIsTheSameDepth) {
    EXPECT_EQ(TriangleDepth(vec3(0.25f, 0.5f, 0.75f)).at(vec3(0.25f, 0.375f, 0.375f)), 0.53125f);
    EXPECT_EQ(TriangleDepth(vec3(0.75f, 0.25f, 0.5f)).at(vec3(0.375f, 0.25f, 0.375f)), 0.53125f)
        << "here the second vertex is the farthest";
}

TEST(ZBuffer, DepthsAreWithinTheDerivedErrorOfTheExactPlane) {
    look_up("Eq. 3.3: how large its error is");
    int compared = 0;
    for (const auto& [p, id] : random_patches(2, test::cases_of(2'000), {40, 30})) {
        const auto depths = depths_of(p, {0, 0}, {40, 30});
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 40; ++x)
                if (depths[{x, y}] != uncovered) {
                    ++compared;
                    ASSERT_TRUE(is_exact_depth(p, {x, y}, depths[{x, y}])) << "seed 2, case " << id;
                    ASSERT_GE(depths[ivec2(x, y)], std::min({p[0].z, p[1].z, p[2].z}))
                        << "the depth at pixel (" << x << ", " << y << ") of " << name(p)
                        << ", and the least of its vertices; seed 2, case " << id;
                }
    }
    EXPECT_GT(compared, test::cases_of(100'000));
}

TEST(ZBuffer, HardCase_FarDepthsKeepTheirDigitsBesideNearOnes) {
    look_up("Relative errors survive the sum");
    // A floor from the eye to the horizon: depths from 1 to a billionth, in one triangle.
    for (const float farthest : {0x1p-10f, 1e-6f, 1e-9f, 0x1p-100f}) {
        const std::array<vec3, 3> p = {{{0, 200, 1}, {50, 0.75f, farthest}, {100, 200, 1}}};
        const auto depths = depths_of(p, {0, 0}, {100, 200});
        for (int y = 0; y < 200; ++y)
            for (int x = 0; x < 100; ++x)
                if (depths[{x, y}] != uncovered) {
                    ASSERT_TRUE(is_exact_depth(p, {x, y}, depths[{x, y}]));
                }
    }
}

TEST(ZBuffer, TriangleOfOneDepthHasExactlyThatDepth) {
    look_up("Eq. 3.3: all differences are 0");
    int covered = 0;
    for (const float z : {0.0f, 0.1f, 0.7f, 0.333333f, 1.0f})
        for (const auto& [p, id] : random_patches(3, 100, {40, 30})) {
            const auto depths =
                depths_of({{vec3(vec2(p[0]), z), vec3(vec2(p[1]), z), vec3(vec2(p[2]), z)}}, {0, 0},
                          {40, 30});
            for (const float depth : depths.pixels()) {
                ASSERT_TRUE(depth == z || depth == uncovered)
                    << test::text_of(depth) << " where all three depths are " << test::text_of(z)
                    << test::ulps_between(depth, z);
                covered += depth == z;
            }
        }
    EXPECT_GT(covered, 10'000);
}

TEST(ZBuffer, HardCase_OfEqualDepthsTheFirstStays) {
    look_up("Eq. 3.1: greater, not greater or equal");
    DepthBuffer depth({1, 1});
    EXPECT_TRUE(depth.test_and_write(origin, 0.5f));
    EXPECT_FALSE(depth.test_and_write(origin, 0.5f)) << "0.5 after 0.5: the first stays";
    EXPECT_TRUE(depth.test_and_write(origin, std::nextafter(0.5f, 1.0f))) << "1 ulp nearer";
}

TEST(ZBuffer, HardCase_OfOneTriangleInThreeOrdersTheFirstStays) {
    look_up("Eq. 3.3, and mind the bracket");
    const std::array<vec3, 3> p = {{{1, 1, 0.3f}, {2, 30, 0.9f}, {38, 5, 0.6f}}};
    const Image<int> ids =
        visible({{p, 1}, {{p[1], p[2], p[0]}, 2}, {{p[2], p[0], p[1]}, 3}}, {40, 30});
    for (const int id : ids.pixels())
        ASSERT_TRUE(id == 1 || id == -1)
            << "triangle " << id << ", drawn later, covers triangle 1 of the same depths, "
            << name(p);
}

TEST(ZBuffer, HardCase_ClearValueZeroOneAndMinusZero) {
    look_up("Eq. 3.1: the buffer starts at 0");
    DepthBuffer depth({1, 1});
    EXPECT_EQ(depth.depths()[origin], 0.0f) << "in a new buffer";
    EXPECT_FALSE(depth.test_and_write(origin, 0.0f)) << "infinitely far away: not drawn";
    EXPECT_FALSE(depth.test_and_write(origin, -0.0f)) << "-0 equals 0";
    EXPECT_TRUE(depth.test_and_write(origin, FLT_TRUE_MIN)) << "the least there is";
    EXPECT_TRUE(depth.test_and_write(origin, 1.0f)) << "on the near plane";
    EXPECT_FALSE(depth.test_and_write(origin, std::numeric_limits<float>::quiet_NaN()))
        << "NaN is not nearer than 1";
    EXPECT_EQ(depth.depths()[origin], 1.0f);
}

TEST(ZBuffer, HardCase_WhatIsNotNearerThanTheFarthestIsNeverDrawn) {
    look_up("Eq. 3.1: what the buffer is cleared to");
    DepthBuffer depth({2, 1}, unset, 0.25f);
    depth.clear(ivec2(0), ivec2(1, 0));
    EXPECT_FALSE(depth.test_and_write(origin, 0.25f)) << "at the farthest depth, 0.25";
    EXPECT_TRUE(depth.test_and_write(origin, 0.5f));
    const Image<vec3> shown = depth_picture(depth);
    EXPECT_EQ(shown[origin], vec3(1));
    EXPECT_EQ(shown[ivec2(1, 0)], vec3(0)) << "an empty pixel of depth 0.25";
    EXPECT_EQ((DepthBuffer({1, 1}, 0.25f).depths()[origin]), 0.25f) << "in a new buffer";
}

TEST(ZBuffer, HardCase_ClearsAPartAndNothingElse) {
    look_up("Eq. 3.1: the buffer starts at 0");
    const ivec2 size(7, 5);
    for (const auto& [first, last] : {std::pair(ivec2(0), size - 1),
                                      {ivec2(2, 1), ivec2(4, 3)},
                                      {ivec2(3), ivec2(3)},
                                      {ivec2(4, 1), ivec2(3, 4)},
                                      {ivec2(0, 5), ivec2(6, 4)}}) {
        DepthBuffer depth(size, unset);
        depth.clear(ivec2(0), size - 1);
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                ASSERT_TRUE(depth.test_and_write({x, y}, 0.25f))
                    << "pixel (" << x << ", " << y << ") of a cleared buffer";
        depth.clear(first, last);
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const bool is_in = x >= first.x && y >= first.y && x <= last.x && y <= last.y;
                ASSERT_EQ((depth.depths()[{x, y}]), is_in ? 0.0f : 0.25f)
                    << "pixel (" << x << ", " << y << "), of all 0.25, after clearing from "
                    << testing::PrintToString(first) << " to " << testing::PrintToString(last);
            }
    }
}

TEST(ZBuffer, HardCase_NotANumberIsNeverNearer) {
    look_up("Eq. 3.1; every comparison with NaN is false");
    DepthBuffer depth({1, 1});
    EXPECT_FALSE(depth.test_and_write(origin, std::numeric_limits<float>::quiet_NaN()))
        << "NaN is not nearer than 0";
    EXPECT_EQ(depth.depths()[origin], 0.0f) << "kept after NaN";
}

TEST(ZBuffer, HardCase_DrawOrderDoesNotChangeThePicture) {
    look_up("Eq. 3.1");
    std::vector<Patch> patches = random_patches(4, 12, {60, 40});
    const Image<int> first = visible(patches, {60, 40});
    EXPECT_GT(std::set<int>(first.pixels().begin(), first.pixels().end()).size(), 5u);
    std::mt19937 random(5);
    for (int i = 0; i < 200; ++i) {
        std::shuffle(patches.begin(), patches.end(), random);
        ASSERT_TRUE(test::are_equal(visible(patches, {60, 40}), first))
            << "the visible one of 12 triangles, drawn in another order, " << i;
    }
}

TEST(ZBuffer, HardCase_RotatedVerticesGiveTheSameBits) {
    look_up("Eq. 3.3, and mind the bracket");
    std::set<float> different;
    for (const auto& [p, id] : random_patches(6, 3'000, {40, 30})) {
        const auto depths = depths_of(p, {0, 0}, {40, 30});
        for (const auto& turned : {std::array{p[1], p[2], p[0]}, std::array{p[2], p[0], p[1]},
                                   std::array{p[2], p[1], p[0]}})
            ASSERT_TRUE(test::are_equal(depths_of(turned, {0, 0}, {40, 30}), depths))
                << "the depth of " << name(turned) << " and in another order " << name(p)
                << "; seed 6, case " << id;
        different.insert(depths.pixels().begin(), depths.pixels().end());
    }
    EXPECT_GT(different.size(), 100'000u);
}

/// The greatest error of the plane z = c + sx x + sy y in float, with c at the picture's origin.
long double error_of_plane_from_origin(const std::array<vec3, 3>& p, const Image<float>& depths,
                                       ivec2 offset) {
    const ScreenTriangle t = snap_triangle(p[0], p[1], p[2]);
    const dvec2 a = dvec2(t.vertices[0]) / 256.0, b = dvec2(t.vertices[1]) / 256.0,
                c = dvec2(t.vertices[2]) / 256.0;
    const dvec3 u(b - a, double{p[1].z} - p[0].z), v(c - a, double{p[2].z} - p[0].z),
        normal = glm::cross(u, v);
    const auto slope_x = static_cast<float>(-normal.x / normal.z),
               slope_y = static_cast<float>(-normal.y / normal.z);
    const float at_origin =
        p[0].z - slope_x * static_cast<float>(a.x) - slope_y * static_cast<float>(a.y);
    long double worst = 0;
    for (int y = 0; y < depths.size().y; ++y)
        for (int x = 0; x < depths.size().x; ++x)
            if (depths[{x, y}] != uncovered) {
                const vec2 center = vec2(offset + ivec2(x, y)) + 0.5f;
                const float z = at_origin + slope_x * center.x + slope_y * center.y;
                worst = std::max(worst, std::abs(z - exact_depth(p, offset + ivec2(x, y))));
            }
    return worst;
}

TEST(ZBuffer, HardCase_SteepSmallTrianglesFarFromTheOrigin) {
    look_up("Eq. 3.3, in place of slopes from the origin");
    constexpr ivec2 corner(2990, 2990);
    constexpr std::int64_t least_twice_area = 100 * 256 * 256;  // thinner ones are harder still
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(3000, 3016), z(0, 1);
    long double worst = 0, worst_from_origin = 0;
    int triangles = 0;
    for (int i = 0; i < 2'000; ++i) {
        const auto point = [&] { return vec3(place(random), place(random), z(random)); };
        const std::array<vec3, 3> p = {point(), point(), point()};
        if (std::abs(snap_triangle(p[0], p[1], p[2]).twice_area) < least_twice_area) continue;
        ++triangles;
        const auto depths = depths_of(p, corner, {40, 40});
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x)
                if (depths[{x, y}] != uncovered)
                    worst = std::max(
                        worst, std::abs(depths[{x, y}] - exact_depth(p, corner + ivec2(x, y))));
        worst_from_origin =
            std::max(worst_from_origin, error_of_plane_from_origin(p, depths, corner));
    }
    std::cout << "worst depth error at (3000, 3000), " << triangles << " triangles: " << worst
              << "; with slopes from the picture's origin: " << worst_from_origin << '\n';
    EXPECT_LE(worst, 4.5L * FLT_EPSILON)  // depth_tolerance() of depths from 0 to 1
        << "the worst error of a depth, triangles of 16 pixels at (3000, 3000)";
    EXPECT_GE(worst_from_origin, 100 * worst);  // the case is hard
}

TEST(ZBuffer, HardCase_InterpenetratingTrianglesMeetOnTheExactLine) {
    look_up("Eq. 3.1 and 3.3");
    constexpr ivec2 size(60, 40);
    std::mt19937 random(8);
    std::uniform_real_distribution<float> z(0, 1);
    int crossings = 0;
    for (int i = 0; i < 500; ++i) {
        const auto over_all = [&] {
            return std::array<vec3, 3>{
                {{-70, -50, z(random)}, {-20, 190, z(random)}, {200, -40, z(random)}}};
        };
        const std::array<vec3, 3> p = over_all(), q = over_all();
        const Image<int> ids = visible({{p, 0}, {q, 1}}, size);
        int first_in_front = 0;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const long double of_p = exact_depth(p, {x, y}), of_q = exact_depth(q, {x, y});
                const long double behind = of_p - of_q;
                first_in_front += behind > 0;
                if (std::abs(behind) <= depth_tolerance(p, of_p) + depth_tolerance(q, of_q))
                    continue;
                ASSERT_EQ((ids[{x, y}]), behind > 0 ? 0 : 1)
                    << "what is seen at pixel (" << x << ", " << y << "): 0 for " << name(p)
                    << ", 1 for " << name(q) << "; seed 8, case " << i;
            }
        crossings += first_in_front > 0 && first_in_front < size.x * size.y;
    }
    EXPECT_GT(crossings, 50) << "too few pairs cross in the picture: the test would see nothing";
}

TEST(ZBuffer, NearestIsShownWhiteTheFarthestDarkAndEmptyBlack) {
    look_up("Eq. 3.1: what the buffer holds in the end");
    for (const float extent : {0.5f, 0x1p-19f, 0x1p-100f}) {  // as many greys for little depths
        const float least = extent == 0x1p-100f ? extent : 0.25f;
        SCOPED_TRACE("depths from " + test::text_of(least) + " on by " + test::text_of(extent));
        DepthBuffer depth({2, 2});
        depth.test_and_write({0, 0}, least + extent);
        depth.test_and_write({1, 0}, least + extent / 2);
        depth.test_and_write({1, 1}, least);
        const Image<vec3> shown = depth_picture(depth);
        EXPECT_EQ(shown[ivec2(0, 0)], vec3(1)) << "the nearest";
        EXPECT_EQ(shown[ivec2(0, 1)], vec3(0)) << "an empty pixel";
        constexpr float rounding = 1e-6f;  // of a few products and sums below 1
        EXPECT_NEAR(shown[ivec2(1, 0)].g, 0.55f * 0.55f, rounding) << "midway";
        EXPECT_NEAR(shown[ivec2(1, 1)].g, 0.1f * 0.1f, rounding) << "the farthest";
    }
    DepthBuffer of_one_depth({2, 1});
    of_one_depth.test_and_write(origin, 0.5f);
    EXPECT_EQ(depth_picture(of_one_depth)[origin], vec3(1)) << "nearest and farthest at once";
}

TEST(ZBuffer, PictureOfTheLesson) {
    EXPECT_TRUE(test::equals_golden("03_z_buffer", "03_z_buffer"));
}

TEST(ZBuffer, PictureOfTheDepth) {
    EXPECT_TRUE(test::equals_golden("03_z_buffer", "03_z_buffer_depth", {"--depth"}));
}
