// SPDX-License-Identifier: MIT
#include "02_triangle_fill/triangle.hpp"

#include <array>
#include <cfloat>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
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

/// The covered pixels; also that each is visited once.
Pixels covered(vec2 a, vec2 b, vec2 c, ivec2 size) {
    Pixels pixels;
    std::string twice;
    fill_triangle(snap_triangle(a, b, c), size, [&](ivec2 p, vec3) {
        if (!pixels.insert({p.x, p.y}).second) twice = testing::PrintToString(p);
    });
    EXPECT_EQ(twice, "") << "a pixel that is visited twice by " << name(a, b, c);
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

/// For EXPECT_TRUE: covers the pixels that the oracle says, and no others.
testing::AssertionResult is_exact(vec2 a, vec2 b, vec2 c, ivec2 size) {
    const std::array vertices = {exactly_snapped(a), exactly_snapped(b), exactly_snapped(c)};
    Pixels expected;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            if (exactly_covered(vertices, {x, y})) expected.insert({x, y});
    testing::AssertionResult result = same_pixels(covered(a, b, c, size), expected);
    return result ? result : result << name(a, b, c);
}

/// For EXPECT_TRUE: triangles without gap or overlap visit each pixel of the picture once.
testing::AssertionResult visit_each_pixel_once(const std::vector<std::array<vec2, 3>>& triangles,
                                               ivec2 size) {
    Image<int> hits(size);
    for (const auto& [a, b, c] : triangles)
        fill_triangle(snap_triangle(a, b, c), size, [&](ivec2 p, vec3) { ++hits[p]; });
    return test::each_pixel_once(hits);
}

using Columns = std::pair<std::int64_t, std::int64_t>;  // the first and the last

/// What a side leaves of columns 0 to 9; 0 to -1 for nothing.
Columns narrowed(const EdgeWalk& edge) {
    Columns columns(0, 9);
    edge.narrow(columns.first, columns.second);
    return columns.first <= columns.second ? columns : Columns(0, -1);
}

// The worked example of the text.
constexpr vec2 a(1, 1), b(1, 5), c(5, 1);
constexpr ivec2 snapped_a(256, 256), snapped_b(256, 1280), snapped_c(1280, 256), center(640, 640);
constexpr std::int64_t unit = 256 * 256;  // one square pixel

}  // namespace

TEST(TriangleFill, Eq2_1_SidesSeenCounterClockwiseHaveTheInsideOnTheirLeft) {
    EXPECT_GT(edge_function(snapped_a, snapped_b, snapped_c), 0)
        << "y points down: from (1, 1) to (1, 5), which is downwards, (5, 1) lies on the left";
    EXPECT_LT(edge_function(snapped_a, snapped_c, snapped_b), 0)
        << "from (1, 1) to (5, 1), (1, 5) lies on the right";
}

TEST(TriangleFill, Eq2_2_EdgeFunctionsOfTheWorkedExample) {
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
        ASSERT_EQ(edge_function(p, q, r), static_cast<std::int64_t>(exact_twice_area(p, q, r)))
            << "the edge function, in 64 bits, of " << testing::PrintToString(std::array{p, q, r})
            << "; seed 3, case " << i;
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
    EXPECT_EQ(snap_triangle(a, b, c).twice_area, 16 * unit)
        << "of the triangle (1, 1), (1, 5), (5, 1), in 1/65536 square pixel";
    EXPECT_EQ(edge_function(snapped_a, snapped_b, center) +
                  edge_function(snapped_b, snapped_c, center) +
                  edge_function(snapped_c, snapped_a, center),
              16 * unit)
        << "the sum of its edge functions at (2.5, 2.5)";
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
    EXPECT_EQ(edge.value, 8 * unit)
        << "from (1, 5) to (5, 1), at the centre of pixel (1, 2), which is (1.5, 2.5)";
    EXPECT_EQ(edge.step_x, -4 * unit) << "from (1, 5) to (5, 1): 256 times the normal's x";
    EXPECT_EQ(edge.step_y, -4 * unit) << "from (1, 5) to (5, 1): 256 times the normal's y";
}

TEST(TriangleFill, Eq2_6_ColumnsOfTheWorkedExample) {
    // Of row 2, counted from pixel 1; the centre of column 2 is on the side.
    EdgeWalk right(snapped_b, snapped_c, 1, {1, 2}), left(snapped_c, snapped_b, 1, {1, 2});
    right.least = 1, left.least = 0;
    EXPECT_EQ(narrowed(right), Columns(0, 1))
        << "of 0 to 9, by the right side from (1, 5) to (5, 1), whose least value is 1";
    EXPECT_EQ(narrowed(left), Columns(2, 9))
        << "of 0 to 9, by the left side from (5, 1) to (1, 5), whose least value is 0";
}

TEST(TriangleFill, Eq2_6_ColumnsWhereTheDivisionLeavesARest) {
    const auto columns = [](std::int64_t value, std::int64_t step_x) {
        EdgeWalk edge(snapped_b, snapped_c, 1, {1, 2});
        edge.value = value, edge.step_x = step_x, edge.least = 1;
        return narrowed(edge);
    };
    EXPECT_EQ(columns(-9, 4), Columns(3, 9)) << "-9, -5, -1, 3: a left side rounds up";
    EXPECT_EQ(columns(10, -4), Columns(0, 2)) << "10, 6, 2, -2: a right side rounds down";
    EXPECT_EQ(columns(-2, -4), Columns(0, -1)) << "outside from the first column on: none";
    EXPECT_EQ(columns(5, 0), Columns(0, 9)) << "a level side, inside: all";
    EXPECT_EQ(columns(0, 0), Columns(0, -1)) << "a level side, on it and not owned: none";
}

TEST(TriangleFill, Eq2_7_LeastValueOfEachKindOfSide) {
    const auto least = [](ivec2 from, ivec2 to) { return EdgeWalk(from, to, 1, {0, 0}).least; };
    EXPECT_EQ(least({512, 256}, {256, 1280}), 0) << "down on the left: a left side";
    EXPECT_EQ(least({1280, 256}, {256, 256}), 0) << "level, towards the left: on top";
    EXPECT_EQ(least({256, 1280}, {512, 256}), 1) << "up on the right: a right side";
    EXPECT_EQ(least({256, 1280}, {1280, 1280}), 1) << "level, towards the right: at the bottom";
}

TEST(TriangleFill, Eq2_7_OwnedColumnsOfTheWorkedExample) {
    EXPECT_EQ(narrowed(EdgeWalk(snapped_b, snapped_c, 1, {1, 2})), Columns(0, 1))
        << "of 0 to 9: the centre of column 2 is on the side from (1, 5) to (5, 1), a right one";
    EXPECT_EQ(narrowed(EdgeWalk(snapped_c, snapped_b, 1, {1, 2})), Columns(2, 9))
        << "of 0 to 9: for the neighbour it is a left side, which owns the centre on it";
}

TEST(TriangleFill, Eq2_4_AtThePixelsOfTheWorkedExample) {
    EXPECT_EQ(EdgeWalk(snapped_b, snapped_c, 1, {2, 2}).value, 4 * unit)
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

TEST(TriangleFill, Eq2_4_BarycentricsAreWithinTwoUlpOfTheExactOnes) {
    // Three roundings of half an ulp each, one of 1/area; and of the exact ones themselves.
    constexpr double two_ulp = (2 + 1e-6) * FLT_EPSILON;
    std::mt19937 random(2);
    std::uniform_real_distribution<float> coordinate(-400, 500);
    const auto point = [&] { return vec2(coordinate(random), coordinate(random)); };
    int visited = 0;
    for (int i = 0; i < test::cases_of(2'000); ++i) {
        const vec2 first = point(), second = point(), third = point();
        const ivec2 p = exactly_snapped(first), q = exactly_snapped(second),
                    r = exactly_snapped(third);
        const ScreenTriangle triangle = snap_triangle(first, second, third);
        ASSERT_EQ(triangle.vertices, (std::array{p, q, r}))
            << "the vertices (Eq. 2.8) of " << name(first, second, third);
        ASSERT_EQ(triangle.twice_area, static_cast<std::int64_t>(exact_twice_area(p, q, r)))
            << "twice the area (Eq. 2.2) of " << name(first, second, third);
        bool is_right = true;
        fill_triangle(triangle, {64, 48}, [&](ivec2 pixel, vec3 barycentrics) {
            ++visited;
            const ivec2 at = exact_center(pixel);
            const auto share = [&](ivec2 from, ivec2 to) {
                return static_cast<double>(exact_twice_area(from, to, at)) /
                       static_cast<double>(triangle.twice_area);
            };
            const dvec3 exact(share(q, r), share(r, p), share(p, q));
            if (!is_right) return;
            is_right = glm::all(
                glm::lessThanEqual(glm::abs(dvec3(barycentrics) - exact), two_ulp * exact));
            EXPECT_TRUE(is_right) << name(first, second, third) << ", pixel "
                                  << testing::PrintToString(pixel) << ": the barycentrics are "
                                  << testing::PrintToString(barycentrics) << ", expected "
                                  << testing::PrintToString(exact)
                                  << " (below 0: it is not covered); seed 2, case " << i;
        });
        if (!is_right) return;
    }
    EXPECT_GT(visited, test::cases_of(100'000));
}

TEST(TriangleFill, Eq2_4_PartsOfAPictureTogetherShowAllOfIt) {
    constexpr ivec2 size(64, 48);
    const ScreenTriangle t = snap_triangle({-9.3f, 3.1f}, {30.1f, 51.9f}, {60.7f, -7.2f});
    Image<vec3> whole(size), parts(size);  // where nothing is visited, all coordinates are 0
    fill_triangle(t, size, [&](ivec2 p, vec3 barycentrics) { whole[p] = barycentrics; });
    for (const ivec2 first : {ivec2(0, 0), ivec2(40, 0), ivec2(0, 7), ivec2(40, 7)}) {
        const ivec2 last(first.x == 0 ? 39 : 63, first.y == 0 ? 6 : 47);
        fill_triangle(t, first, last,
                      [&](ivec2 p, vec3 barycentrics) { parts[p] += barycentrics; });
    }
    EXPECT_TRUE(are_equal(parts, whole)) << "the sums of what four parts hold";
    EXPECT_NE(whole[ivec2(20, 20)], vec3(0)) << "a pixel in the middle is not visited";
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

TEST(TriangleFill, ExhaustiveAllTrianglesOfAQuarterPixelLatticeAreExact) {
    look_up("Eq. 2.7 for centres on a side, Eq. 2.6 for the columns");
    constexpr int side = 9, points = side * side;
    const auto point = [](int i) {
        return vec2(static_cast<float>(i % side), static_cast<float>(i / side)) * 0.25f;
    };
    for (int i = 0; i < points; ++i)
        for (int j = 0; j < points; ++j)
            for (int k = 0; k < points; ++k)
                ASSERT_TRUE(is_exact(point(i), point(j), point(k), {3, 3}));
}

TEST(TriangleFill, RandomTrianglesOfAllSizesAreExact) {
    look_up("Eq. 2.6 and 2.9");
    std::mt19937 random(4);
    std::uniform_real_distribution<float> exponent(0, 22), sign(-1, 1);
    const auto number = [&] { return 0.9f * sign(random) * std::exp2(exponent(random)); };
    const auto point = [&] { return vec2(10, 8) + vec2(number(), number()); };
    for (int i = 0; i < 20'000; ++i)
        ASSERT_TRUE(is_exact(point(), point(), point(), {20, 16})) << ", seed 4, case " << i;
}

TEST(TriangleFill, RandomTriangulationsCoverEachPixelOnce) {
    look_up("Eq. 2.7 for centres on a side, Eq. 2.6 for the columns");
    constexpr ivec2 size(64, 48);
    for (unsigned seed = 0; seed < 10'000; ++seed)
        ASSERT_TRUE(visit_each_pixel_once(test::random_triangulation(size, seed), size))
            << "seed " << seed;
}

TEST(TriangleFill, HardCase_FansWithFarVerticesCoverEachPixelOnce) {
    look_up("Eq. 2.8 and 2.9: whole numbers do not round");
    for (const float radius : {4e3f, 4e4f, 4e5f, 4e6f}) {
        std::vector<vec2> rim;
        for (int k = 0; k < 300; ++k) {
            const double angle = -2 * std::numbers::pi * (k + 0.3) / 300;
            rim.push_back(radius * vec2(std::cos(angle), std::sin(angle)));
        }
        const auto triangles = test::fan({600.37f, 500.81f}, rim);
        EXPECT_TRUE(visit_each_pixel_once(triangles, {1280, 960})) << "radius " << radius;
    }
}

TEST(TriangleFill, HardCase_OrientationOfNearlyCollinearPointsIsExact) {
    look_up("Eq. 2.2, and 2.8 for what snapping does to it");
    // Kettner's grid, on the lattice where edge functions live: p one unit from another, q and r
    // far.
    for (int i = 0; i < 256; ++i)
        for (int j = 0; j < 256; ++j) {
            const ivec2 p((1 << 20) + i, (1 << 20) + j), q(24 << 20), r(48 << 20);
            ASSERT_EQ(edge_function(p, q, r), static_cast<std::int64_t>(exact_twice_area(p, q, r)))
                << "the edge function of " << testing::PrintToString(std::array{p, q, r});
        }
}

TEST(TriangleFill, HardCase_ZeroAreaCoversNothing) {
    look_up("Eq. 2.8, and what snapping does to thin triangles");
    constexpr std::array<vec2, 3> a_point = {{{2.5f, 2.5f}, {2.5f, 2.5f}, {2.5f, 2.5f}}},
                                  through_centers = {{{0.5f, 0.5f}, {7.5f, 7.5f}, {3.5f, 3.5f}}},
                                  along_a_row = {{{0.5f, 2.5f}, {7.5f, 2.5f}, {3.5f, 2.5f}}},
                                  after_snapping = {{{0.5f, 2.5f}, {7.5f, 2.5f}, {3.5f, 2.501f}}};
    for (const auto& [p, q, r] : {a_point, through_centers, along_a_row, after_snapping})
        EXPECT_TRUE(same_pixels(covered(p, q, r, {8, 8}), {})) << name(p, q, r);
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
    for (int i = 0; i < 5'000; ++i) {
        const vec2 p(x(random), y(random)), q(x(random), y(random));
        const vec2 r = glm::mix(p, q, along(random)) + vec2(across(random), across(random));
        ASSERT_TRUE(is_exact(p, q, r, size)) << ", seed 7, case " << i;
    }
}

TEST(TriangleFill, HardCase_AllOrdersAndWindingsCoverTheSamePixelsWithTheSameBarycentrics) {
    look_up("Eq. 2.4 and Front and back");
    const std::array<vec2, 3> p = {{{3.3f, 1.7f}, {1.2f, 13.9f}, {14.6f, 9.1f}}};
    const auto drawn = [&](const std::array<int, 3>& order) {  // each vertex' share in its place
        Image<vec3> barycentrics({16, 16});
        const auto at = [&](std::size_t i) { return p[static_cast<std::size_t>(order[i])]; };
        fill_triangle(snap_triangle(at(0), at(1), at(2)), {16, 16}, [&](ivec2 pixel, vec3 w) {
            for (int n = 0; n < 3; ++n)
                barycentrics[pixel][order[static_cast<std::size_t>(n)]] = w[n];
        });
        return barycentrics;
    };
    const Image<vec3> expected = drawn({0, 1, 2});
    EXPECT_NE(expected[ivec2(6, 8)], vec3(0)) << "a pixel in the middle is not covered";
    for (const std::array<int, 3>& order :
         {std::array{1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}})
        ASSERT_TRUE(are_equal(drawn(order), expected))
            << "the barycentrics, vertices in the order " << testing::PrintToString(order);
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
                ASSERT_EQ(snap_triangle(p[0], p[1], p[2]).twice_area, 0) << name(p[0], p[1], p[2]);
            }
}

TEST(TriangleFill, HardCase_TriangleFromAMillionPixelsAwayCoversTheWholePicture) {
    look_up("Eq. 2.9");
    constexpr ivec2 size(64, 48);
    for (const float far : {1e6f, 4.19e6f})
        // A square cut by its diagonal, which runs through the picture's pixel centres.
        EXPECT_TRUE(visit_each_pixel_once(
            {{{{-far, -far}, {-far, far}, {far, far}}}, {{{-far, -far}, {far, far}, {far, -far}}}},
            size))
            << "the halves of a square, which reaches " << far << " pixels to all sides";
    EXPECT_TRUE(visit_each_pixel_once({{{{-1e6f, -1e6f}, {0, 2e6f}, {1e6f, -1e6f}}}}, size));
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
    for (const ivec2 empty : {ivec2(0, 0), {5, 0}, {0, 5}})
        EXPECT_TRUE(covered({-9, -9}, {-9, 9}, {9, -9}, empty).empty())
            << testing::PrintToString(empty);
}

TEST(TriangleFill, PictureOfTheLesson) {
    EXPECT_TRUE(test::equals_golden("02_triangle_fill", "02_triangle_fill"));
}

TEST(TriangleFill, PictureOfTheBarycentrics) {
    EXPECT_TRUE(test::equals_golden("02_triangle_fill", "02_triangle_fill_barycentric",
                                    {"--model", "triangle.obj", "--paint", "barycentric"}));
}
