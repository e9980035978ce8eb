// SPDX-License-Identifier: MIT
#include "03_z_buffer/depth_buffer.hpp"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "02_triangle_fill/triangle.hpp"
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

/// For EXPECT_TRUE: within the derived error where there is a depth, and not farther than the
/// farthest vertex.
testing::AssertionResult are_exact_depths(const std::array<vec3, 3>& p, ivec2 offset, ivec2 size) {
    const Image<float> depths = depths_of(p, offset, size);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const float depth = depths[{x, y}];
            if (depth == uncovered) continue;
            const long double exact = exact_depth(p, offset + ivec2(x, y));
            const long double error = std::abs(depth - exact), may_be = depth_tolerance(p, exact);
            if (error <= may_be && depth >= std::min({p[0].z, p[1].z, p[2].z})) continue;
            return testing::AssertionFailure()
                   << "the depth at pixel " << testing::PrintToString(offset + ivec2(x, y))
                   << " is " << test::text_of(depth) << ", expected " << exact << ", off by "
                   << error / may_be << " times what Eq. 3.3 may be; " << name(p);
        }
    return testing::AssertionSuccess();
}

std::vector<std::array<vec3, 3>> random_triangles(unsigned seed, int count, ivec2 size) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> x(-20, static_cast<float>(size.x) + 20),
        y(-20, static_cast<float>(size.y) + 20), z(0, 1);
    std::vector<std::array<vec3, 3>> triangles(static_cast<std::size_t>(count));
    for (auto& vertices : triangles)
        for (vec3& vertex : vertices) vertex = {x(random), y(random), z(random)};
    return triangles;
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
    for (const auto& p : random_triangles(2, test::cases_of(2'000), {40, 30}))
        ASSERT_TRUE(are_exact_depths(p, {0, 0}, {40, 30}));
}

TEST(ZBuffer, HardCase_FarDepthsKeepTheirDigitsBesideNearOnes) {
    look_up("Relative errors survive the sum");
    // A floor from the eye to the horizon: depths from 1 to a billionth, in one triangle.
    for (const float farthest : {0x1p-10f, 1e-6f, 1e-9f, 0x1p-100f})
        ASSERT_TRUE(are_exact_depths({{{0, 200, 1}, {50, 0.75f, farthest}, {100, 200, 1}}}, {0, 0},
                                     {100, 200}));
}

TEST(ZBuffer, TriangleOfOneDepthHasExactlyThatDepth) {
    look_up("Eq. 3.3: all differences are 0");
    for (const float z : {0.0f, 0.1f, 0.7f, 0.333333f, 1.0f})
        for (const vec3 shares : {vec3(0.1f, 0.2f, 0.7f), vec3(1.0f / 3), vec3(0.9f, 0.1f, 0)})
            EXPECT_EQ(TriangleDepth(vec3(z)).at(shares), z)
                << "with barycentrics " << testing::PrintToString(shares);
}

TEST(ZBuffer, HardCase_OfEqualDepthsTheFirstStays) {
    look_up("Eq. 3.1: greater, not greater or equal");
    DepthBuffer depth({1, 1});
    EXPECT_TRUE(depth.test_and_write(origin, 0.5f));
    EXPECT_FALSE(depth.test_and_write(origin, 0.5f)) << "0.5 after 0.5: the first stays";
    EXPECT_TRUE(depth.test_and_write(origin, std::nextafter(0.5f, 1.0f))) << "1 ulp nearer";
}

TEST(ZBuffer, HardCase_ClearValueZeroOneAndMinusZero) {
    look_up("Eq. 3.1: the buffer starts at 0");
    DepthBuffer depth({1, 1});
    EXPECT_FALSE(depth.test_and_write(origin, 0.0f)) << "infinitely far away: not drawn";
    EXPECT_FALSE(depth.test_and_write(origin, -0.0f)) << "-0 equals 0";
    EXPECT_TRUE(depth.test_and_write(origin, FLT_TRUE_MIN)) << "the least there is";
    EXPECT_TRUE(depth.test_and_write(origin, 1.0f)) << "on the near plane";
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
    const ivec2 size(7, 5), first(2, 1), last(4, 3);
    DepthBuffer depth(size, unset);
    depth.clear(ivec2(0), size - 1);
    Image<float> expected(size, 0.25f);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            depth.test_and_write({x, y}, 0.25f);
            if (x >= first.x && y >= first.y && x <= last.x && y <= last.y) expected[{x, y}] = 0;
        }
    depth.clear(first, last);
    depth.clear({6, 1}, {5, 4});  // nothing: the last pixel lies before the first
    EXPECT_TRUE(test::are_equal(depth.depths(), expected))
        << "of all 0.25, after clearing from (2, 1) to (4, 3)";
}

TEST(ZBuffer, HardCase_NotANumberIsNeverNearer) {
    look_up("Eq. 3.1; every comparison with NaN is false");
    for (const float before : {0.0f, 1.0f}) {
        DepthBuffer depth({1, 1});
        depth.test_and_write(origin, before);
        EXPECT_FALSE(depth.test_and_write(origin, std::numeric_limits<float>::quiet_NaN()))
            << "NaN is not nearer than " << before;
        EXPECT_EQ(depth.depths()[origin], before) << "kept after NaN";
    }
}

TEST(ZBuffer, HardCase_DrawOrderDoesNotChangeThePicture) {
    look_up("Eq. 3.1");
    constexpr ivec2 size(60, 40);
    auto triangles = random_triangles(4, 12, size);
    const auto drawn = [&] {
        DepthBuffer buffer(size);
        for (const auto& p : triangles) {
            const TriangleDepth depth(vec3(p[0].z, p[1].z, p[2].z));
            fill_triangle(snap_triangle(p[0], p[1], p[2]), size, [&](ivec2 pixel, vec3 shares) {
                buffer.test_and_write(pixel, depth.at(shares));
            });
        }
        return buffer.depths();
    };
    const Image<float> first = drawn();
    std::mt19937 random(5);
    for (int i = 0; i < 200; ++i) {
        std::shuffle(triangles.begin(), triangles.end(), random);
        ASSERT_TRUE(test::are_equal(drawn(), first)) << "12 triangles in another order, " << i;
    }
}

TEST(ZBuffer, HardCase_RotatedVerticesGiveTheSameBits) {
    look_up("Eq. 3.3, and mind the bracket");
    for (const auto& p : random_triangles(6, 3'000, {40, 30})) {
        const auto depths = depths_of(p, {0, 0}, {40, 30});
        for (const auto& turned : {std::array{p[1], p[2], p[0]}, std::array{p[2], p[0], p[1]},
                                   std::array{p[2], p[1], p[0]}})
            ASSERT_TRUE(test::are_equal(depths_of(turned, {0, 0}, {40, 30}), depths))
                << "the depth of " << name(turned) << " and in another order " << name(p);
    }
}

TEST(ZBuffer, HardCase_SteepSmallTrianglesFarFromTheOrigin) {
    look_up("Eq. 3.3, in place of slopes from the origin");
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(3000, 3016), z(0, 1);
    const auto point = [&] { return vec3(place(random), place(random), z(random)); };
    for (int i = 0; i < 2'000; ++i)
        ASSERT_TRUE(are_exact_depths({point(), point(), point()}, {2990, 2990}, {40, 40}))
            << "; seed 7, case " << i;
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
