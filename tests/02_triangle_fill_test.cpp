// SPDX-License-Identifier: MIT
#include "02_triangle_fill/triangle.hpp"

#include <array>
#include <cfloat>
#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "02_triangle_fill/flat_color.hpp"
#include "common/image/image.hpp"
#include "common/math/numerics.hpp"
#include "support/ascii_picture.hpp"
#include "support/cases.hpp"
#include "support/exact.hpp"
#include "support/first_difference.hpp"
#include "support/golden.hpp"
#include "support/look_up.hpp"
#include "support/triangulations.hpp"

using namespace rasterbook;
using rasterbook::test::exact_center, rasterbook::test::exact_twice_area,
    rasterbook::test::exactly_snapped, rasterbook::test::Pixels, rasterbook::test::same_pixels,
    rasterbook::test::look_up, rasterbook::test::are_equal;

namespace {

std::string name(vec2 a, vec2 b, vec2 c) {
    return "the triangle " + testing::PrintToString(std::array{a, b, c});
}

/// The covered pixels; also that each is inside and visited once.
Pixels covered(vec2 a, vec2 b, vec2 c, ivec2 size) {
    Pixels pixels;
    std::string wrong;
    fill_triangle(snap_triangle(a, b, c), size, [&](ivec2 p, vec3) {
        const bool is_inside = p.x >= 0 && p.y >= 0 && p.x < size.x && p.y < size.y;
        const bool is_new = pixels.insert({p.x, p.y}).second;
        if ((!is_inside || !is_new) && wrong.empty())
            wrong = testing::PrintToString(p) + (is_inside ? " twice" : ", which is outside");
    });
    if (!wrong.empty())
        ADD_FAILURE() << name(a, b, c) << " in a picture of " << size.x << " x " << size.y
                      << " pixels visits pixel " << wrong;
    return pixels;
}

int exact_side(ivec2 a, ivec2 b, ivec2 p) {
    const int128 twice_area = exact_twice_area(a, b, p);
    return (twice_area > 0) - (twice_area < 0);
}

/// The oracle: a centre on a side counts as where it gets when nudged right, or else nudged down.
bool exactly_covered(std::array<ivec2, 3> vertices, ivec2 pixel) {
    auto [a, b, c] = vertices;
    if (exact_side(a, b, c) == 0) return false;
    if (exact_side(a, b, c) < 0) std::swap(b, c);
    const ivec2 center = exact_center(pixel);
    const auto inside = [&](ivec2 from, ivec2 to) {
        for (const ivec2 nudge : {ivec2(0, 0), ivec2(1, 0), ivec2(0, 1)})
            if (const int side = exact_side(from, to, center + nudge)) return side > 0;
        return false;
    };
    return inside(a, b) && inside(b, c) && inside(c, a);
}

Pixels exactly_covered_pixels(std::array<ivec2, 3> vertices, ivec2 size) {
    Pixels pixels;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            if (exactly_covered(vertices, {x, y})) pixels.insert({x, y});
    return pixels;
}

/// For EXPECT_TRUE: snapped to the right places, with the right area.
testing::AssertionResult is_exactly_snapped(vec2 a, vec2 b, vec2 c) {
    const ScreenTriangle triangle = snap_triangle(a, b, c);
    const std::array exact = {exactly_snapped(a), exactly_snapped(b), exactly_snapped(c)};
    if (triangle.vertices != exact)
        return testing::AssertionFailure() << name(a, b, c) << " is snapped (Eq. 2.8) to "
                                           << testing::PrintToString(triangle.vertices)
                                           << ", expected " << testing::PrintToString(exact);
    const int128 twice_area = exact_twice_area(exact[0], exact[1], exact[2]);
    if (triangle.twice_area != twice_area)
        return testing::AssertionFailure()
               << name(a, b, c) << " has the twice_area (Eq. 2.2, in 64 bits: Eq. 2.9) "
               << triangle.twice_area << ", expected " << static_cast<std::int64_t>(twice_area);
    return testing::AssertionSuccess();
}

/// For EXPECT_TRUE: the edge function is exact.
testing::AssertionResult is_exact_edge_function(ivec2 a, ivec2 b, ivec2 p) {
    const std::int64_t actual = edge_function(a, b, p);
    const int128 exact = exact_twice_area(a, b, p);
    if (actual == exact) return testing::AssertionSuccess();
    return testing::AssertionFailure()
           << "edge_function(" << testing::PrintToString(a) << ", " << testing::PrintToString(b)
           << ", " << testing::PrintToString(p) << ") is " << actual << ", expected "
           << static_cast<std::int64_t>(exact);
}

/// For EXPECT_TRUE: where the way around a, b, c goes by p, the three edge functions add up.
testing::AssertionResult add_up(ivec2 a, ivec2 b, ivec2 c, ivec2 p) {
    const int128 sum =
        int128{edge_function(a, b, p)} + edge_function(b, c, p) + edge_function(c, a, p);
    if (sum == edge_function(a, b, c)) return testing::AssertionSuccess();
    return testing::AssertionFailure()
           << "a, b, c, p: " << testing::PrintToString(std::array{a, b, c, p})
           << ": E_ab(p) = " << edge_function(a, b, p) << ", E_bc(p) = " << edge_function(b, c, p)
           << ", E_ca(p) = " << edge_function(c, a, p)
           << "; their sum is not E_ab(c) = " << edge_function(a, b, c);
}

Image<int> hits_of(const std::vector<std::array<vec2, 3>>& triangles, ivec2 size) {
    Image<int> hits(size);
    for (const auto& [a, b, c] : triangles)
        fill_triangle(snap_triangle(a, b, c), size, [&](ivec2 p, vec3) { ++hits[p]; });
    return hits;
}

/// For EXPECT_TRUE: triangles without gap or overlap visit each pixel of the picture once.
testing::AssertionResult visit_each_pixel_once(const std::vector<std::array<vec2, 3>>& triangles,
                                               ivec2 size) {
    return test::each_pixel_once(hits_of(triangles, size));
}

// The worked example of the text.
constexpr vec2 a(1, 1), b(1, 5), c(5, 1);
constexpr ivec2 snapped_a(256, 256), snapped_b(256, 1280), snapped_c(1280, 256), center(640, 640);

}  // namespace

TEST(TriangleFill, Eq2_1_SidesSeenCounterClockwiseHaveTheInsideOnTheirLeft) {
    EXPECT_GT(edge_function(snapped_a, snapped_b, snapped_c), 0)
        << "y points down: from (1, 1) to (1, 5), which is downwards, (5, 1) lies on the left";
    EXPECT_LT(edge_function(snapped_a, snapped_c, snapped_b), 0)
        << "from (1, 1) to (5, 1), (1, 5) lies on the right";
}

TEST(TriangleFill, Eq2_2_EdgeFunctionsOfTheWorkedExample) {
    constexpr std::int64_t unit = 256 * 256;  // one square pixel
    EXPECT_EQ(edge_function(snapped_b, snapped_c, center), 4 * unit)
        << "from b = (1, 5) to c = (5, 1), at (2.5, 2.5); in 1/65536 square pixel";
    EXPECT_EQ(edge_function(snapped_c, snapped_a, center), 6 * unit)
        << "from c = (5, 1) to a = (1, 1), at (2.5, 2.5); in 1/65536 square pixel";
    EXPECT_EQ(edge_function(snapped_a, snapped_b, center), 6 * unit)
        << "from a = (1, 1) to b = (1, 5), at (2.5, 2.5); in 1/65536 square pixel";
    EXPECT_EQ(edge_function(snapped_b, snapped_c, {384, 1152}), 0) << "a centre on the side";
}

TEST(TriangleFill, Eq2_9_EdgeFunctionsAreExactUpToTheCoordinateLimit) {
    constexpr int most = (1 << 30) - 1;
    EXPECT_EQ(edge_function({-most, -most}, {-most, most}, {most, -most}),
              4 * std::int64_t{most} * most);
    std::mt19937 random(3);
    std::uniform_int_distribution<int> any(-most, most);
    for (int i = 0; i < 100'000; ++i) {
        const ivec2 p(any(random), any(random)), q(any(random), any(random)),
            r(any(random), any(random));
        ASSERT_TRUE(is_exact_edge_function(p, q, r)) << "in 64 bits; seed 3, case " << i;
    }
}

TEST(TriangleFill, Eq2_10_FanHasThePolygonsArea) {
    const std::vector<ivec2> polygon = {
        {256, 512}, {512, 1792}, {1536, 2048}, {2304, 1024}, {1280, 0}};
    std::int64_t by_fan = 0, by_sides = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const ivec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
        by_fan += edge_function(polygon[0], p, q);
        by_sides += std::int64_t{p.y} * q.x - std::int64_t{p.x} * q.y;
    }
    EXPECT_EQ(by_fan, by_sides);
}

TEST(TriangleFill, Eq2_8_VerticesSnapToTheNearest256thOfAPixel) {
    const ScreenTriangle t = snap_triangle({1.0f, 2.001f}, {-3.003f, 0.5f}, {1000.1f, 7.0f});
    EXPECT_EQ(t.vertices, (std::array<ivec2, 3>{{{256, 512}, {-769, 128}, {256026, 1792}}}));
    constexpr float half = 0.5f / 256;
    EXPECT_EQ(snap_triangle({half, 3 * half}, {-half, 5 * half}, {-3 * half, 1}).vertices,
              (std::array<ivec2, 3>{{{0, 2}, {0, 2}, {-2, 256}}}))
        << "a half goes to the even neighbour";
}

TEST(TriangleFill, Eq2_3_EdgeFunctionsAddUpToTwiceTheArea) {
    EXPECT_EQ(snap_triangle(a, b, c).twice_area, 16 * 256 * 256)
        << "of the triangle (1, 1), (1, 5), (5, 1), in 1/65536 square pixel";
    EXPECT_TRUE(add_up(snapped_a, snapped_b, snapped_c, center));
}

TEST(TriangleFill, Eq2_9_EdgeFunctionsOfAllSizesAddUpToTwiceTheArea) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> any(-(1 << 30) + 1, (1 << 30) - 1);
    for (int i = 0; i < 100'000; ++i) {
        const ivec2 p(any(random), any(random)), q(any(random), any(random)),
            r(any(random), any(random)), s(any(random), any(random));
        ASSERT_TRUE(add_up(p, q, r, s)) << "in 64 bits; seed 1, case " << i;
    }
}

TEST(TriangleFill, FacingIsSeenFromTheFront) {
    look_up("Eq. 2.3 and Front and back");
    EXPECT_TRUE(is_front_facing(snap_triangle(a, b, c)))
        << "(1, 1), (1, 5), (5, 1) is seen counter-clockwise, as y points down";
    EXPECT_FALSE(is_front_facing(snap_triangle(a, c, b)))
        << "(1, 1), (5, 1), (1, 5) is seen clockwise";
    EXPECT_FALSE(is_front_facing(snap_triangle(a, a, b))) << "a triangle of no area";
}

TEST(TriangleFill, Eq2_5_EdgeStepsEqualTheEdgeFunctionAtTheNeighbours) {
    const EdgeWalk edge(snapped_b, snapped_c, 1, {1, 2});
    constexpr std::int64_t unit = 256 * 256;  // one square pixel
    EXPECT_EQ(edge.value, 8 * unit)
        << "from (1, 5) to (5, 1), at the centre of pixel (1, 2), which is (1.5, 2.5)";
    EXPECT_EQ(edge.step_x, -4 * unit) << "from (1, 5) to (5, 1): 256 times the normal's x";
    EXPECT_EQ(edge.step_y, -4 * unit) << "from (1, 5) to (5, 1): 256 times the normal's y";
    EXPECT_EQ(edge.value, edge_function(snapped_b, snapped_c, {384, 640}));
    EXPECT_EQ(edge.value + edge.step_x, edge_function(snapped_b, snapped_c, {640, 640}));
    EXPECT_EQ(edge.value + edge.step_y, edge_function(snapped_b, snapped_c, {384, 896}));
}

TEST(TriangleFill, Eq2_6_ColumnsOfTheWorkedExample) {
    // Columns 0 to 9 of row 2, counted from pixel 1; the centre of column 2 is on the side.
    const auto narrowed = [](ivec2 from, ivec2 to, std::int64_t least) {
        EdgeWalk edge(from, to, 1, {1, 2});
        edge.least = least;
        std::int64_t first = 0, last = 9;
        edge.narrow(first, last);
        return std::pair(first, last);
    };
    using Columns = std::pair<std::int64_t, std::int64_t>;
    EXPECT_EQ(narrowed(snapped_b, snapped_c, 1), Columns(0, 1))
        << "of 0 to 9, by the right side from (1, 5) to (5, 1), whose least value is 1";
    EXPECT_EQ(narrowed(snapped_c, snapped_b, 0), Columns(2, 9))
        << "of 0 to 9, by the left side from (5, 1) to (1, 5), whose least value is 0";
}

TEST(TriangleFill, Eq2_6_ColumnsWhereTheDivisionLeavesARest) {
    const auto narrowed = [](std::int64_t value, std::int64_t step_x) {
        EdgeWalk edge(snapped_b, snapped_c, 1, {1, 2});
        edge.value = value, edge.step_x = step_x, edge.least = 1;
        std::int64_t first = 0, last = 9;
        edge.narrow(first, last);
        return first <= last ? std::pair(first, last)
                             : std::pair<std::int64_t, std::int64_t>(0, -1);
    };
    using Columns = std::pair<std::int64_t, std::int64_t>;
    EXPECT_EQ(narrowed(-9, 4), Columns(3, 9)) << "-9, -5, -1, 3: a left side rounds up";
    EXPECT_EQ(narrowed(10, -4), Columns(0, 2)) << "10, 6, 2, -2: a right side rounds down";
    EXPECT_EQ(narrowed(-2, -4), Columns(0, -1)) << "outside from the first column on: none";
    EXPECT_EQ(narrowed(5, 0), Columns(0, 9)) << "a level side, inside: all";
    EXPECT_EQ(narrowed(0, 0), Columns(0, -1)) << "a level side, on it and not owned: none";
}

TEST(TriangleFill, Eq2_7_LeastValueOfEachKindOfSide) {
    const auto least = [](ivec2 from, ivec2 to) { return EdgeWalk(from, to, 1, {0, 0}).least; };
    EXPECT_EQ(least({512, 256}, {256, 1280}), 0) << "down on the left: a left side";
    EXPECT_EQ(least({1280, 256}, {256, 256}), 0) << "level, towards the left: on top";
    EXPECT_EQ(least({256, 1280}, {512, 256}), 1) << "up on the right: a right side";
    EXPECT_EQ(least({256, 1280}, {1280, 1280}), 1) << "level, towards the right: at the bottom";
}

TEST(TriangleFill, Eq2_7_OwnedColumnsOfTheWorkedExample) {
    const auto narrowed = [](ivec2 from, ivec2 to) {
        std::int64_t first = 0, last = 9;
        EdgeWalk(from, to, 1, {1, 2}).narrow(first, last);
        return std::pair(first, last);
    };
    using Columns = std::pair<std::int64_t, std::int64_t>;
    EXPECT_EQ(narrowed(snapped_b, snapped_c), Columns(0, 1))
        << "of 0 to 9: the centre of column 2 is on the side from (1, 5) to (5, 1), a right one";
    EXPECT_EQ(narrowed(snapped_c, snapped_b), Columns(2, 9))
        << "of 0 to 9: for the neighbour it is a left side, which owns the centre on it";
}

TEST(TriangleFill, Eq2_4_AtThePixelsOfTheWorkedExample) {
    EXPECT_EQ(EdgeWalk(snapped_b, snapped_c, 1, {2, 2}).value, 4 * 256 * 256)
        << "the value of the side from b to c at pixel (2, 2), whose centre is (2.5, 2.5): Eq. 2.5";
    Image<vec3> barycentrics({8, 8});
    fill_triangle(snap_triangle(a, b, c), barycentrics.size(),
                  [&](ivec2 p, vec3 w) { barycentrics[p] = w; });
    EXPECT_EQ(barycentrics[ivec2(2, 2)], vec3(0.25f, 0.375f, 0.375f))
        << "the shares of a = (1, 1), b = (1, 5), c = (5, 1) at pixel (2, 2); (0, 0, 0): it was "
           "not visited";
    // Here no two are equal.
    EXPECT_EQ(barycentrics[ivec2(1, 2)], vec3(0.5f, 0.375f, 0.125f))
        << "the shares of a = (1, 1), b = (1, 5), c = (5, 1) at pixel (1, 2)";
}

TEST(TriangleFill, TriangleSeenClockwiseIsFilledToo) {
    look_up("Eq. 2.4 and Front and back");
    EXPECT_TRUE(same_pixels(covered(a, c, b, {8, 8}), covered(a, b, c, {8, 8})))
        << "(1, 1), (5, 1), (1, 5) is (1, 1), (1, 5), (5, 1) seen from behind";
}

TEST(TriangleFill, Eq2_4_BarycentricsAreWithinTwoUlpOfTheExactOnes) {
    constexpr long double two_ulp =
        2.0L * FLT_EPSILON;  // three roundings of half an ulp each, one of 1/area
    std::mt19937 random(2);
    std::uniform_real_distribution<float> coordinate(-400, 500);
    int visited = 0;
    std::string first_wrong;
    for (int i = 0; i < test::cases_of(2'000); ++i) {
        const auto point = [&] { return vec2(coordinate(random), coordinate(random)); };
        const vec2 first = point(), second = point(), third = point();
        const ivec2 p = exactly_snapped(first), q = exactly_snapped(second),
                    r = exactly_snapped(third);
        ASSERT_TRUE(is_exactly_snapped(first, second, third)) << "seed 2, case " << i;
        const auto area = static_cast<long double>(exact_twice_area(p, q, r));
        fill_triangle(
            snap_triangle(first, second, third), {64, 48}, [&](ivec2 pixel, vec3 barycentrics) {
                ++visited;
                const ivec2 at = exact_center(pixel);
                const auto share = [&](ivec2 from, ivec2 to) {
                    return static_cast<long double>(exact_twice_area(from, to, at)) / area;
                };
                const long double exact[] = {share(q, r), share(r, p), share(p, q)};
                for (int k = 0; k < 3; ++k)
                    if (exact[k] < 0 && first_wrong.empty())
                        first_wrong = name(first, second, third) + ": pixel " +
                                      testing::PrintToString(pixel) + " is visited and not covered";
                    else if (!(barycentrics[k] >= 0 &&
                               std::abs(barycentrics[k] - exact[k]) <= two_ulp * exact[k]) &&
                             first_wrong.empty()) {
                        std::ostringstream text;
                        text << name(first, second, third) << ", pixel "
                             << testing::PrintToString(pixel) << ": the coordinate of vertex "
                             << "abc"[k] << " is " << barycentrics[k] << ", expected " << exact[k];
                        if (exact[k] > 0)
                            text << ", off by "
                                 << std::abs(barycentrics[k] - exact[k]) / exact[k] / FLT_EPSILON
                                 << " ulp, which may be 2";
                        first_wrong = text.str();
                    }
            });
        ASSERT_EQ(first_wrong, "") << "seed 2, case " << i;
    }
    EXPECT_GT(visited, test::cases_of(100'000));
}

TEST(TriangleFill, Eq2_4_BarycentricsDoNotDependOnThePicturesSize) {
    const ScreenTriangle t = snap_triangle({-700.3f, -20.7f}, {50.1f, 911.9f}, {803.7f, -77.2f});
    Image<vec3> barycentrics({64, 48});
    fill_triangle(t, {64, 48}, [&](ivec2 p, vec3 w) { barycentrics[p] = w; });
    int visited = 0;
    fill_triangle(t, {31, 17}, [&](ivec2 p, vec3 w) {
        if (!HasFailure()) {
            EXPECT_EQ(w, barycentrics[p])
                << "at pixel " << testing::PrintToString(p)
                << " of a picture of 31 x 17 pixels, and of one of 64 x 48";
        }
        ++visited;
    });
    EXPECT_EQ(visited, 31 * 17);
}

TEST(TriangleFill, Eq2_4_PartsOfAPictureTogetherShowAllOfIt) {
    constexpr ivec2 size(64, 48);
    const ScreenTriangle t = snap_triangle({-9.3f, 3.1f}, {30.1f, 51.9f}, {60.7f, -7.2f});
    const vec3 unseen(-1);
    Image<vec3> whole(size, unseen), parts(size, unseen);
    fill_triangle(t, size, [&](ivec2 p, vec3 barycentrics) { whole[p] = barycentrics; });
    for (const ivec2 first : {ivec2(0, 0), ivec2(40, 0), ivec2(0, 7), ivec2(40, 7)}) {
        const ivec2 last(first.x == 0 ? 39 : 63, first.y == 0 ? 6 : 47);
        fill_triangle(t, first, last, [&](ivec2 p, vec3 barycentrics) {
            if (HasFailure()) return;
            EXPECT_EQ(glm::clamp(p, first, last), p)
                << "pixel " << testing::PrintToString(p) << " lies outside of the part from "
                << testing::PrintToString(first) << " to " << testing::PrintToString(last);
            EXPECT_EQ(parts[p], unseen) << "pixel " << testing::PrintToString(p) << " twice";
            parts[p] = barycentrics;
        });
    }
    EXPECT_TRUE(are_equal(parts, whole)) << "what four parts together hold";
    EXPECT_FALSE(whole == Image<vec3>(size, unseen)) << "nothing is visited";
    fill_triangle(t, {40, 7}, {39, 47}, [](ivec2, vec3) { FAIL() << "in nothing"; });
}

TEST(TriangleFill, Eq2_7_SharedSideBelongsToOneOfTwoNeighbours) {
    EXPECT_TRUE(
        same_pixels(covered(a, b, c, {8, 8}), {{1, 1}, {2, 1}, {3, 1}, {1, 2}, {2, 2}, {1, 3}}))
        << "(1, 1), (1, 5), (5, 1): its right side runs through centres";
    Pixels expected;
    for (int y = 1; y <= 4; ++y)
        for (int x = 5 - y; x <= 4; ++x) expected.insert({x, y});
    EXPECT_TRUE(same_pixels(covered(b, {5, 5}, c, {8, 8}), expected))
        << "its neighbour (1, 5), (5, 5), (5, 1): the same side is a left one";
}

TEST(TriangleFill, Eq2_7_LeftAndTopSidesOwnTheCentresOnThem) {
    // A square whose sides run through pixel centres: row and column 1 are in, 3 are out.
    Pixels pixels = covered({1.5f, 1.5f}, {1.5f, 3.5f}, {3.5f, 1.5f}, {8, 8});
    EXPECT_TRUE(same_pixels(pixels, {{1, 1}, {2, 1}, {1, 2}}))
        << "(1.5, 1.5), (1.5, 3.5), (3.5, 1.5): a left, a right and a top side through centres";
    pixels.merge(covered({1.5f, 3.5f}, {3.5f, 3.5f}, {3.5f, 1.5f}, {8, 8}));
    EXPECT_TRUE(same_pixels(pixels, {{1, 1}, {2, 1}, {1, 2}, {2, 2}}));
}

TEST(TriangleFill, ExhaustiveAllTrianglesOfAQuarterPixelLatticeAreExact) {
    look_up("Eq. 2.7 for centres on a side, Eq. 2.6 for the columns");
    constexpr int side = 9, points = side * side;
    const auto point = [](int i) {
        return vec2(static_cast<float>(i % side), static_cast<float>(i / side)) * 0.25f;
    };
    int triangles = 0;
    for (int i = 0; i < points; ++i)
        for (int j = 0; j < points; ++j)
            for (int k = 0; k < points; ++k, ++triangles) {
                const std::array vertices = {exactly_snapped(point(i)), exactly_snapped(point(j)),
                                             exactly_snapped(point(k))};
                unsigned actual = 0, expected = 0;
                fill_triangle(snap_triangle(point(i), point(j), point(k)), {3, 3},
                              [&](ivec2 p, vec3) { actual |= 1u << (3 * p.y + p.x); });
                for (int bit = 0; bit < 9; ++bit)
                    expected |= static_cast<unsigned>(exactly_covered(vertices, {bit % 3, bit / 3}))
                                << bit;
                if (actual != expected)
                    FAIL() << name(point(i), point(j), point(k)) << ": "
                           << test::ascii_difference(covered(point(i), point(j), point(k), {3, 3}),
                                                     exactly_covered_pixels(vertices, {3, 3}));
            }
    EXPECT_EQ(triangles, 531'441);
}

TEST(TriangleFill, RandomTrianglesOfAllSizesAreExact) {
    look_up("Eq. 2.6 and 2.9");
    std::mt19937 random(4);
    std::uniform_real_distribution<float> exponent(0, 22), sign(-1, 1);
    for (int i = 0; i < 20'000; ++i) {
        const auto point = [&] {
            return vec2(10, 8) + vec2(sign(random) * std::exp2(exponent(random)),
                                      sign(random) * std::exp2(exponent(random))) *
                                     0.9f;
        };
        const vec2 p = point(), q = point(), r = point();
        const std::array vertices = {exactly_snapped(p), exactly_snapped(q), exactly_snapped(r)};
        ASSERT_TRUE(
            same_pixels(covered(p, q, r, {20, 16}), exactly_covered_pixels(vertices, {20, 16})))
            << name(p, q, r) << ", seed 4, case " << i;
    }
}

TEST(TriangleFill, RandomTriangulationsCoverEachPixelOnce) {
    look_up("Eq. 2.7 for centres on a side, Eq. 2.6 for the columns");
    constexpr ivec2 size(64, 48);
    for (unsigned seed = 0; seed < 10'000; ++seed) {
        ASSERT_TRUE(visit_each_pixel_once(test::random_triangulation(size, seed), size))
            << "seed " << seed;
    }
}

TEST(TriangleFill, HardCase_FansAroundPixelCentresCoverEachPixelOnce) {
    look_up("Eq. 2.7: centres on a side belong to one of two neighbours");
    constexpr ivec2 size(256, 192);
    std::mt19937 random(5);
    std::uniform_int_distribution<int> x(0, size.x - 1), y(0, size.y - 1), spread(-600, 600);
    for (int i = 0; i < 100; ++i) {
        // Rim vertices on pixel centres too: through many centres in between run sides.
        std::vector<vec2> rim;
        for (const vec2 step : {vec2(0, 1), vec2(1, 0), vec2(0, -1), vec2(-1, 0)})
            for (int k = -600; k < 600; k += 75)
                rim.push_back(vec2(0.5f) + 600.0f * vec2(-step.y, step.x) +
                              static_cast<float>(k) * step);
        const vec2 middle = vec2(x(random), y(random)) + 0.5f;
        ASSERT_TRUE(visit_each_pixel_once(test::fan(middle, rim), size)) << "fan " << i;
    }
}

/// The same hits with edge functions in float and the top-left rule, to see that a case is hard.
Image<int> hits_in_float(const std::vector<std::array<vec2, 3>>& triangles, ivec2 size) {
    Image<int> hits(size);
    for (const auto& vertices : triangles)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const vec2 at = vec2(x, y) + 0.5f;
                bool inside = true;
                for (std::size_t i = 0; i < 3; ++i) {
                    const vec2 from = vertices[i], e = vertices[(i + 1) % 3] - from;
                    const float value = e.y * (at.x - from.x) - e.x * (at.y - from.y);
                    inside &= value > 0 || (value == 0 && (e.y > 0 || (e.y == 0 && e.x < 0)));
                }
                hits[{x, y}] += inside;
            }
    return hits;
}

std::vector<vec2> round_rim(float radius, int vertices) {
    std::vector<vec2> rim;
    for (int k = 0; k < vertices; ++k) {
        const double angle = -2 * std::numbers::pi * (k + 0.3) / vertices;
        rim.push_back(radius * vec2(std::cos(angle), std::sin(angle)));
    }
    return rim;
}

TEST(TriangleFill, HardCase_FansWithFarVerticesCoverEachPixelOnce) {
    look_up("Eq. 2.8 and 2.9: whole numbers do not round");
    constexpr ivec2 size(1280, 960);
    for (const float radius : {4e3f, 4e4f, 4e5f, 4e6f}) {
        const auto triangles = test::fan({600.37f, 500.81f}, round_rim(radius, 300));
        EXPECT_TRUE(visit_each_pixel_once(triangles, size)) << "radius " << radius;
    }
}

TEST(TriangleFill, FansWithFarVerticesAreHardForFloat) {
    look_up("Eq. 2.8");
    constexpr ivec2 size(1280, 960);
    for (const float radius : {4e3f, 4e6f}) {
        const Image<int> hits =
            hits_in_float(test::fan({600.37f, 500.81f}, round_rim(radius, 36)), size);
        int gaps = 0, doubles = 0;
        for (const int count : hits.pixels()) gaps += count == 0, doubles += count > 1;
        EXPECT_GT(gaps + doubles, 0) << "radius " << radius;
        std::cout << "edge functions in float, rim at " << radius << " pixels: " << gaps
                  << " gaps, " << doubles << " double hits\n";
    }
}

TEST(TriangleFill, HardCase_OrientationOfNearlyCollinearPointsIsExact) {
    look_up("Eq. 2.2, and 2.8 for what snapping does to it");
    // Kettner's grid, on the lattice where edge functions live: p one unit from another, q and r
    // far.
    int wrong = 0;
    for (int i = 0; i < 256; ++i)
        for (int j = 0; j < 256; ++j) {
            const ivec2 p((1 << 20) + i, (1 << 20) + j), q(24 << 20, 24 << 20),
                r(48 << 20, 48 << 20);
            const std::int64_t value = edge_function(p, q, r);
            wrong += (value > 0) - (value < 0) != exact_side(p, q, r);
            ASSERT_EQ(wrong, 0) << "the sign of edge_function(" << testing::PrintToString(p) << ", "
                                << testing::PrintToString(q) << ", " << testing::PrintToString(r)
                                << "), which is " << value;
        }
    // And as it stands: 0.5 plus a few ulp snaps to 0.5, which is collinear with 12 and 24.
    const float ulp = std::nextafter(0.5f, 1.0f) - 0.5f;
    for (int i = 0; i < 256; ++i)
        for (int j = 0; j < 256; ++j) {
            const vec2 p(0.5f + static_cast<float>(i) * ulp, 0.5f + static_cast<float>(j) * ulp);
            ASSERT_EQ(snap_triangle(p, {12, 12}, {24, 24}).twice_area, 0)
                << "0.5 plus " << i << " and plus " << j << " ulp, (12, 12), (24, 24)";
        }
}

TEST(TriangleFill, HardCase_ZeroAreaCoversNothing) {
    look_up("Eq. 2.8, and what snapping does to thin triangles");
    EXPECT_TRUE(covered({2.5f, 2.5f}, {2.5f, 2.5f}, {2.5f, 2.5f}, {8, 8}).empty());
    EXPECT_TRUE(covered({0.5f, 0.5f}, {7.5f, 7.5f}, {3.5f, 3.5f}, {8, 8}).empty())
        << "collinear, through centres";
    EXPECT_TRUE(covered({0.5f, 2.5f}, {7.5f, 2.5f}, {3.5f, 2.5f}, {8, 8}).empty())
        << "along a row of centres";
    EXPECT_TRUE(covered({0.5f, 2.5f}, {7.5f, 2.5f}, {3.5f, 2.501f}, {8, 8}).empty())
        << "only after snapping";
}

TEST(TriangleFill, HardCase_SmallestTriangleCoversTheCentreThatItOwns) {
    look_up("Eq. 2.7");
    constexpr float step = 1.0f / 256;
    const vec2 p(2.5f, 3.5f), q = p + vec2(step, step), r = p + vec2(step, 0);
    EXPECT_EQ(snap_triangle(p, q, r).twice_area, 1) << "half a square of the snapped grid";
    EXPECT_TRUE(same_pixels(covered(p, q, r, {8, 8}), {{2, 3}}))
        << "a vertex on a centre, between a left and a top side";
}

TEST(TriangleFill, HardCase_SliversThinnerThanASubpixelAreExact) {
    look_up("Eq. 2.8, and what snapping does to thin triangles");
    constexpr ivec2 size(40, 30);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> x(0, size.x), y(0, size.y), along(-1, 2),
        across(-0.02f, 0.02f);
    int covering = 0;
    for (int i = 0; i < 5'000; ++i) {
        const vec2 p(x(random), y(random)), q(x(random), y(random));
        const vec2 r = glm::mix(p, q, along(random)) + vec2(across(random), across(random));
        const Pixels expected = exactly_covered_pixels(
            {exactly_snapped(p), exactly_snapped(q), exactly_snapped(r)}, size);
        ASSERT_TRUE(same_pixels(covered(p, q, r, size), expected))
            << name(p, q, r) << ", seed 7, case " << i;
        covering += !expected.empty();
    }
    EXPECT_GT(covering, 100) << "too few of them cover anything: the test would see nothing";
}

TEST(TriangleFill, HardCase_AllOrdersAndWindingsCoverTheSamePixelsWithTheSameBarycentrics) {
    look_up("Eq. 2.4 and Front and back");
    const std::array<vec2, 3> p = {{{3.3f, 1.7f}, {1.2f, 13.9f}, {14.6f, 9.1f}}};
    const Pixels expected = covered(p[0], p[1], p[2], {16, 16});
    EXPECT_GT(expected.size(), 40u);
    Image<vec3> barycentrics({16, 16});
    fill_triangle(snap_triangle(p[0], p[1], p[2]), {16, 16},
                  [&](ivec2 pixel, vec3 w) { barycentrics[pixel] = w; });
    for (const auto& order : std::vector<std::array<std::size_t, 3>>{
             {0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}) {
        const vec2 first = p[order[0]], second = p[order[1]], third = p[order[2]];
        ASSERT_TRUE(same_pixels(covered(first, second, third, {16, 16}), expected))
            << "vertices in the order " << testing::PrintToString(order);
        Image<vec3> barycentrics_now({16, 16}), expected_now({16, 16});
        fill_triangle(snap_triangle(first, second, third), {16, 16}, [&](ivec2 pixel, vec3 w) {
            barycentrics_now[pixel] = w;
            for (int n = 0; n < 3; ++n)
                expected_now[pixel][n] =
                    barycentrics[pixel][static_cast<int>(order[static_cast<std::size_t>(n)])];
        });
        ASSERT_TRUE(are_equal(barycentrics_now, expected_now))
            << "the barycentrics, vertices in the order " << testing::PrintToString(order);
    }
}

TEST(TriangleFill, HardCase_NotANumberInfiniteAndHugeVerticesCoverNothing) {
    look_up("Eq. 2.9: what is refused");
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                    infinity = std::numeric_limits<float>::infinity();
    for (const float bad :
         {nan, infinity, -infinity, FLT_MAX / 16, -FLT_MAX / 16, FLT_MAX, 4194304.0f, -4194304.0f})
        for (const int axis : {0, 1})
            for (int vertex = 0; vertex < 3; ++vertex) {
                std::array<vec2, 3> p = {{{1, 1}, {1, 7}, {7, 1}}};
                p[static_cast<std::size_t>(vertex)][axis] = bad;
                const ScreenTriangle t = snap_triangle(p[0], p[1], p[2]);
                ASSERT_EQ(t.twice_area, 0) << name(p[0], p[1], p[2]);
                ASSERT_FALSE(is_front_facing(t)) << name(p[0], p[1], p[2]);
                ASSERT_TRUE(covered(p[0], p[1], p[2], {8, 8}).empty()) << name(p[0], p[1], p[2]);
            }
}

TEST(TriangleFill, HardCase_TriangleFromAMillionPixelsAwayCoversTheWholePicture) {
    look_up("Eq. 2.9");
    constexpr ivec2 size(64, 48);
    constexpr std::size_t all = 64 * 48;
    for (const float far : {1e6f, 4.19e6f}) {
        // A square cut by its diagonal, which runs through the picture's pixel centres.
        const std::size_t lower = covered({-far, -far}, {-far, far}, {far, far}, size).size();
        const std::size_t upper = covered({-far, -far}, {far, far}, {far, -far}, size).size();
        EXPECT_EQ(lower + upper, all) << "pixels that the halves of a square cover, which reaches "
                                      << far << " pixels to all sides";
        EXPECT_GT(lower, all / 4) << far;
    }
    EXPECT_EQ(covered({-1e6f, -1e6f}, {0, 2e6f}, {1e6f, -1e6f}, size).size(), all)
        << "pixels of 64 x 48 that (-1e6, -1e6), (0, 2e6), (1e6, -1e6) covers";
}

TEST(TriangleFill, HardCase_TriangleOfNoAreaFacesUp) {
    look_up("Robust, Triangles that collapse");
    const Triangle of_points{{{{0}, {1}, {2}}}};
    const auto normal_of = [&](const std::vector<vec3>& positions) {
        Mesh mesh;
        mesh.positions = positions;
        return flat_normal(mesh, of_points);
    };
    EXPECT_EQ(normal_of({{1, 2, 3}, {4, 2, 3}, {1, 2, -5}}), vec3(0, 1, 0)) << "it lies flat";
    EXPECT_EQ(normal_of({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}), vec3(0, 1, 0)) << "one point";
    EXPECT_EQ(normal_of({{1, 2, 3}, {2, 4, 6}, {3, 6, 9}}), vec3(0, 1, 0)) << "one line";
}

TEST(TriangleFill, HardCase_EmptyPictureVisitsNothing) {
    look_up("Eq. 2.5 and All the steps in order, step 2");
    EXPECT_TRUE(covered({-9, -9}, {-9, 9}, {9, -9}, {0, 0}).empty());
    EXPECT_TRUE(covered({-9, -9}, {-9, 9}, {9, -9}, {5, 0}).empty());
    EXPECT_TRUE(covered({-9, -9}, {-9, 9}, {9, -9}, {0, 5}).empty());
}

TEST(TriangleFill, PictureOfTheLesson) {
    EXPECT_TRUE(test::equals_golden("02_triangle_fill", "02_triangle_fill"));
}

TEST(TriangleFill, PictureOfTheBarycentrics) {
    EXPECT_TRUE(test::equals_golden("02_triangle_fill", "02_triangle_fill_barycentric",
                                    {"--model", "triangle.obj", "--paint", "barycentric"}));
}
