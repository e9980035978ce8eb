// SPDX-License-Identifier: MIT
/// @file
/// Polygons cut into triangles: the areas add up exactly and no triangle is inverted.
#include "common/model/triangulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <utility>

namespace rasterbook {
namespace {

__extension__ typedef __int128 int128;

constexpr unsigned seed = 1;

/// A point whose coordinates, scaled, are integers of at most 50 bits.
struct Point {
    std::int64_t x, y;
    auto operator<=>(const Point&) const = default;
};

int128 doubled_area(Point a, Point b, Point c) {
    return int128(b.x - a.x) * (c.y - a.y) - int128(b.y - a.y) * (c.x - a.x);
}

int128 doubled_area(const std::vector<Point>& polygon) {
    int128 sum = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i)
        sum += doubled_area(polygon[0], polygon[i - 1], polygon[i]);
    return sum;
}

/// The polygon in space: seen along an axis (0 to 2), on a sloping plane, so that x and y are kept.
std::vector<vec3> in_space(const std::vector<Point>& polygon, int axis = 2) {
    std::vector<vec3> points;
    for (const auto& [x, y] : polygon) {
        points.emplace_back();
        points.back()[(axis + 1) % 3] = float(x);
        points.back()[(axis + 2) % 3] = float(y);
        points.back()[axis] = float(x) / 4 - float(y) / 2;
    }
    return points;
}

/// A polygon of a text such as "0,0 4,0 0,4", and back.
std::vector<Point> polygon_of(const std::string& text) {
    std::istringstream in(text);
    std::vector<Point> polygon;
    char comma = ',';
    for (Point p{}; in >> p.x >> comma >> p.y;) polygon.push_back(p);
    return polygon;
}
std::string text_of(const std::vector<Point>& polygon) {
    std::string text;
    for (const auto& [x, y] : polygon) text += " " + std::to_string(x) + "," + std::to_string(y);
    return text;
}

/// For EXPECT_TRUE: the triangles of a polygon that does not cross itself are n - 2, wind as it
/// does, and have its area together. Along all axes and for both windings.
testing::AssertionResult is_cut_exactly(std::vector<Point> polygon) {
    for (int way = 0; way < 6; ++way) {
        const auto triangles = triangulate(in_space(polygon, way % 3));
        const int128 area = doubled_area(polygon);
        int128 sum = 0;
        bool is_inverted = false;
        for (const auto& [i, j, k] : triangles) {
            const int128 part = doubled_area(polygon.at(i), polygon.at(j), polygon.at(k));
            is_inverted |= area > 0 ? part < 0 : part > 0;
            sum += part;
        }
        if (triangles.size() != polygon.size() - 2 || is_inverted || sum != area)
            return testing::AssertionFailure()
                   << triangles.size() << " triangles" << (is_inverted ? ", one inverted" : "")
                   << (sum != area ? ", wrong area" : "") << ":" << text_of(polygon);
        std::ranges::reverse(polygon);
        if (way == 2) std::ranges::rotate(polygon, polygon.begin() + 1);
    }
    return testing::AssertionSuccess();
}
testing::AssertionResult is_cut_exactly(const char* polygon) {
    return is_cut_exactly(polygon_of(polygon));
}

std::vector<Point> circle(int vertex_count, double radius) {
    std::vector<Point> points;
    for (int i = 0; i < vertex_count; ++i) {
        const double angle = 2 * std::numbers::pi * i / vertex_count;
        points.push_back(
            {std::llround(radius * std::cos(angle)), std::llround(radius * std::sin(angle))});
    }
    return points;
}

/// A polygon with a hole, and the bridge from vertex 0 to the hole's vertex 0, there and back.
std::vector<Point> with_hole(std::vector<Point> outside, const std::vector<Point>& hole) {
    outside.push_back(outside[0]);
    outside.push_back(hole[0]);
    outside.insert(outside.end(), hole.rbegin(), hole.rend());
    return outside;
}

TEST(Orientation, IsExactBesideALine) {  // Kettner et al. 2004: most signs are wrong in double.
    const float ulp = std::numeric_limits<float>::epsilon() / 2;  // of numbers from 0.5 to 1
    for (int i = 0; i < 256; ++i)
        for (int j = 0; j < 256; ++j) {
            const vec2 p(0.5f + float(i) * ulp, 0.5f + float(j) * ulp);
            const int expected = (j > i) - (j < i);
            ASSERT_EQ(orientation({12, 12}, {24, 24}, p), expected) << i << " " << j;
            ASSERT_EQ(orientation({24, 24}, p, {12, 12}), expected) << i << " " << j;
            ASSERT_EQ(orientation({24, 24}, {12, 12}, p), -expected) << i << " " << j;
        }
}

/// Coefficients with x * v - y * u == the greatest common divisor of u and v.
Point bezout(std::int64_t u, std::int64_t v) {
    Point before{0, -1}, current{1, 0};  // each with x * v - y * u equal to u and v
    for (; v != 0;) {
        const std::int64_t quotient = u / v;
        before = std::exchange(current,
                               {before.x - quotient * current.x, before.y - quotient * current.y});
        u = std::exchange(v, u - quotient * v);
    }
    return before;
}

TEST(Orientation, HardCase_AreasFarBelowTheRoundingErrors) {
    std::mt19937 random(seed);
    for (int i = 0; i < 10'000; ++i) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", case " + std::to_string(i));
        const Point b{1 + std::int64_t(random() >> 8), 1 + std::int64_t(random() >> 8)};
        const Point a =
            bezout(b.x, b.y);  // As near to the line through 0 and b as whole numbers can be.
        const int expected = doubled_area(a, b, {-b.x, -b.y}) > 0 ? 1 : -1;
        const vec2 near(float(a.x), float(a.y));
        const vec2 far = std::ldexp(1.0f, int(random() % 80)) * vec2(float(b.x), float(b.y));
        ASSERT_EQ(orientation(near, far, -far), expected);
        ASSERT_EQ(orientation(far, near, -far), -expected);
        ASSERT_EQ(orientation(-far, near, far), expected);
    }
}

TEST(Orientation, HoldsForTheLargestAndTheSmallestFloats) {
    const float huge = std::numeric_limits<float>::max(),
                tiny = std::numeric_limits<float>::denorm_min();
    EXPECT_EQ(orientation({-huge, -huge}, {huge, huge}, {0, tiny}), 1);
    EXPECT_EQ(orientation({-huge, -huge}, {huge, huge}, {tiny, 0}), -1);
    EXPECT_EQ(orientation({-huge, -huge}, {huge, huge}, {tiny, tiny}), 0);
    EXPECT_EQ(orientation({0, 0}, {tiny, 0}, {0, tiny}), 1);
    EXPECT_EQ(orientation({tiny, tiny}, {huge, huge}, {1, 1}), 0);
    EXPECT_EQ(orientation({tiny, 0}, {huge, huge}, {1, 1}), 1);
}

TEST(Triangulate, AConvexPolygonIsAFan) {
    const auto triangles = triangulate(in_space(polygon_of("0,0 4,0 6,3 3,6 0,4")));
    const std::vector<std::array<std::uint32_t, 3>> fan{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
    EXPECT_EQ(triangles, fan);
    EXPECT_TRUE(is_cut_exactly(circle(1000, 8'000'000)));
}

TEST(Triangulate, AreasAddUpExactly) {
    for (const char* polygon : {"0,0 1,0 0,1", "0,0 4,0 1,1 0,4", "0,0 4,0 4,4 2,1 0,4",
                                "0,0 8,0 8,8 6,8 6,2 2,2 2,8 0,8",
                                // a spiral
                                "0,0 9,0 9,9 2,9 2,4 6,4 6,6 4,6 4,7 7,7 7,2 0,2"})
        EXPECT_TRUE(is_cut_exactly(polygon));
}

TEST(Triangulate, HardCase_OneUlpDecidesWhetherAVertexIsReflex) {
    // Vertex 2 lies one unit of 2^-24 beside the straight line from 1 to 3, inside or outside.
    const std::int64_t n = (1 << 24) - 1;
    EXPECT_TRUE(is_cut_exactly({{0, n}, {0, 0}, {n / 3, n / 3 + 1}, {n, n - 1}}));
    EXPECT_TRUE(is_cut_exactly({{0, n}, {0, 0}, {n / 3, n / 3 - 1}, {n, n - 1}}));
    EXPECT_TRUE(is_cut_exactly({{n, n}, {n - 1, n - 2}, {1, 1}, {n - 1, n - 1}}));
}

TEST(Triangulate, HardCase_RingWithABridgeToItsHole) {
    EXPECT_TRUE(is_cut_exactly(with_hole(circle(32, 1000), circle(32, 500))));
}

TEST(Triangulate, HardCase_SeveralHolesBridgedFromOneVertex) {
    std::vector<Point> polygon = polygon_of("0,0 90,0 90,90 0,90");
    for (const Point at : {Point{10, 60}, Point{40, 40}, Point{60, 10}})
        polygon =
            with_hole(polygon, {at, {at.x + 9, at.y}, {at.x + 9, at.y + 9}, {at.x, at.y + 9}});
    EXPECT_TRUE(is_cut_exactly(polygon));
}

TEST(Triangulate, HardCase_BridgesWithBends) {
    // Inside: to a hole. Outside: to another island; there the triangle at a bend looks like an
    // ear.
    EXPECT_TRUE(is_cut_exactly("0,0 20,0 20,20 0,20 0,0 5,9 9,10 9,12 12,12 12,10 9,10 5,9"));
    EXPECT_TRUE(is_cut_exactly("0,0 4,0 9,-3 9,5 12,5 12,9 9,9 9,5 9,-3 4,0 4,4 0,4"));
    // Found at random: several bridges meet at a bend; its triangle lies beside two of them.
    EXPECT_TRUE(is_cut_exactly("0,2 0,1 1,1 1,0 0,1 0,0 1,0 1,1 0,1 0,2 1,2 0,3"));
    EXPECT_TRUE(
        is_cut_exactly("1,1 1,0 2,1 2,2 3,1 3,2 2,2 1,3 1,2 0,2 0,1 0,0 1,0 1,1 1,2 0,1 0,2 1,2 "
                       "1,3 2,2 3,2 3,1 2,2"));
}

TEST(Triangulate, HardCase_VerticesThatTouch) {
    EXPECT_TRUE(is_cut_exactly("0,0 2,2 4,0 4,4 2,2 0,4")) << "a bow at a point";
    EXPECT_TRUE(is_cut_exactly("0,0 8,0 8,8 0,8 4,0 0,7")) << "on an edge";
    EXPECT_TRUE(is_cut_exactly("0,0 8,0 8,4 8,8 4,8 8,4 0,4")) << "on a vertex";
}

TEST(Triangulate, PolygonsWithoutAreaGiveTrianglesWithoutArea) {
    for (const char* polygon :
         {"1,1 1,1 1,1", "1,1 1,1 1,1 1,1 1,1", "0,0 3,3 1,1 2,2 5,5", "0,0 1,0 2,0 3,0",
          "0,0 4,0 4,3 4,0 8,1 4,0"})  // a tree, walked around
        EXPECT_TRUE(is_cut_exactly(polygon));
}

TEST(Triangulate, DuplicateAndStraightVerticesCostTrianglesWithoutArea) {
    EXPECT_TRUE(is_cut_exactly("0,0 0,0 4,0 4,0 4,0 4,4 0,4 0,4"));
    EXPECT_TRUE(is_cut_exactly("0,0 1,0 2,0 4,0 4,2 4,4 2,2 1,3 0,4 0,1"));
    EXPECT_TRUE(is_cut_exactly("0,0 4,0 9,0 4,0 4,4 0,4")) << "a spike outwards";
    EXPECT_TRUE(is_cut_exactly("0,0 4,0 4,4 2,2 4,4 0,4")) << "a spike inwards";
    EXPECT_TRUE(is_cut_exactly("0,0 4,0 9,1 4,0 4,4 4,4 0,4")) << "a spike and a duplicate";
    EXPECT_TRUE(is_cut_exactly("0,0 4,0 1,1 1,1 0,4")) << "a duplicate at a reflex vertex";
}

/// Grows a polygon at random whose edges touch but do not cross: from a grid of squares, each cut
/// into two triangles, it takes one triangle after the other over one of its edges. What closes up
/// leaves slits, holes with bridges, and vertices that touch.
std::vector<Point> grown_polygon(unsigned polygon_seed) {
    std::mt19937 random(polygon_seed);
    const auto below = [&](auto n) { return std::int64_t(random() % std::uint64_t(n)); };
    const std::int64_t size = 2 + below(5);
    const Point start{below(size), below(size)};
    std::vector<Point> polygon{start, {start.x + 1, start.y}, {start.x + 1, start.y + 1}};
    const auto sorted = [](std::array<Point, 3> triangle) {
        std::ranges::sort(triangle);
        return triangle;
    };
    std::set<std::array<Point, 3>> taken{sorted({polygon[0], polygon[1], polygon[2]})};

    const auto is_grid_edge = [&](Point p, Point q) {
        const std::int64_t dx = q.x - p.x, dy = q.y - p.y;
        return p != q && std::abs(dx) <= 1 && std::abs(dy) <= 1 && dx * dy >= 0 &&
               std::min(q.x, q.y) >= 0 && std::max(q.x, q.y) <= size;
    };
    const auto uses_of_edge = [&](Point p, Point q) {
        std::ptrdiff_t count = 0;
        for (std::size_t i = 0; i < polygon.size(); ++i)
            count +=
                std::minmax(polygon[i], polygon[(i + 1) % polygon.size()]) == std::minmax(p, q);
        return count;
    };
    std::size_t last = 0;  // the vertex added last
    for (std::int64_t steps = 1 + below(6 * size * size); steps > 0; --steps) {
        const bool goes_on = below(2) == 1;  // Else it happens everywhere and nothing gets far.
        const std::size_t i = goes_on ? last : std::size_t(below(polygon.size()));
        const Point p = polygon[i], q = polygon[(i + 1) % polygon.size()];
        for (int k = 0; k < 9; ++k) {
            const Point r{p.x + k % 3 - 1, p.y + k / 3 - 1};
            if (!is_grid_edge(p, r) || !is_grid_edge(q, r) || doubled_area(q, p, r) <= 0 ||
                taken.contains(sorted({p, q, r})) || uses_of_edge(p, r) > 1 ||
                uses_of_edge(q, r) > 1)
                continue;
            taken.insert(sorted({p, q, r}));
            last = i + 1;
            polygon.insert(polygon.begin() + std::ptrdiff_t(last), r);
            break;
        }
    }
    return polygon;
}

TEST(Triangulate, HardCase_RandomPolygonsWhoseEdgesTouch) {
    for (unsigned i = 0; i < 5000; ++i) {
        std::vector<Point> polygon = grown_polygon(seed + i);
        for (Point& p : polygon)
            p = {5 * p.x + 2 * p.y, 3 * p.y - p.x};  // so that edges have many slopes
        ASSERT_TRUE(is_cut_exactly(polygon)) << "seed " << seed << ", polygon " << i;
    }
}

TEST(Triangulate, RandomStarsAreCutExactly) {
    std::mt19937 random(seed);
    for (int i = 0; i < 500; ++i) {
        std::vector<Point> star = circle(3 + int(random() % 60), 4096);
        for (Point& p : star) {
            const auto factor = std::int64_t(1 + random() % 2000);
            p = {p.x * factor, p.y * factor};
        }
        ASSERT_TRUE(is_cut_exactly(star)) << "seed " << seed << ", star " << i;
    }
}

TEST(Triangulate, PolygonsThatCrossThemselvesGiveTriangles) {
    std::mt19937 random(seed);
    for (const std::size_t vertex_count : {4u, 5u, 8u, 50u, 2000u})
        for (int i = 0; i < 20; ++i) {
            std::vector<vec3> polygon(vertex_count);
            const auto side = 2 + random() % 50;  // small: many points are equal
            for (vec3& p : polygon) p = {random() % side, random() % side, random() % side};
            const auto triangles = triangulate(polygon);
            ASSERT_EQ(triangles.size(), vertex_count - 2);
            for (const auto& triangle : triangles)
                for (const std::uint32_t vertex : triangle) ASSERT_LT(vertex, vertex_count);
        }
}

}  // namespace
}  // namespace rasterbook
