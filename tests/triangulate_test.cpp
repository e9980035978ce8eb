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

TEST(Orientation, EqualsTheSignInIntegers) {
    std::mt19937 random(seed);
    constexpr int shift = 24;  // Coordinates are whole multiples of 2^-24.
    const auto coordinate = [&] {
        return std::int64_t(random()) >> (8 + random() % 24) << random() % 24;
    };
    const auto to_float = [](Point p) {
        return vec2(std::ldexp(float(p.x), -shift), std::ldexp(float(p.y), -shift));
    };
    int zeros = 0;
    for (int i = 0; i < 200'000; ++i) {
        const Point a{coordinate(), coordinate()}, d{coordinate() >> 8, coordinate() >> 8};
        const std::int64_t m = 1 + random() % 7, n = 1 + random() % 5;
        Point b{a.x + m * d.x, a.y + m * d.y}, c{a.x - n * d.x, a.y - n * d.y};
        for (Point* p : {&b, &c})  // Nearly in one line, as far as floats go.
            *p = {std::int64_t(float(p->x)), std::int64_t(float(p->y))};
        const int128 area = doubled_area(a, b, c);
        const int expected = (area > 0) - (area < 0);
        zeros += expected == 0;
        ASSERT_EQ(orientation(to_float(a), to_float(b), to_float(c)), expected)
            << "seed " << seed << ", case " << i;
    }
    EXPECT_GT(zeros, 1000);
    EXPECT_LT(zeros, 199'000);
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
    const auto triangles = triangulate(in_space({{0, 0}, {4, 0}, {6, 3}, {3, 6}, {0, 4}}));
    const std::vector<std::array<std::uint32_t, 3>> fan{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
    EXPECT_EQ(triangles, fan);
    EXPECT_TRUE(is_cut_exactly(circle(1000, 8'000'000)));
}

TEST(Triangulate, AreasAddUpExactly) {
    EXPECT_TRUE(is_cut_exactly({{0, 0}, {1, 0}, {0, 1}}));
    EXPECT_TRUE(is_cut_exactly({{0, 0}, {4, 0}, {1, 1}, {0, 4}}));
    EXPECT_TRUE(is_cut_exactly({{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}}));
    EXPECT_TRUE(is_cut_exactly({{0, 0}, {8, 0}, {8, 8}, {6, 8}, {6, 2}, {2, 2}, {2, 8}, {0, 8}}));
    EXPECT_TRUE(is_cut_exactly({{0, 0},
                                {9, 0},
                                {9, 9},
                                {2, 9},
                                {2, 4},
                                {6, 4},
                                {6, 6},
                                {4, 6},
                                {4, 7},
                                {7, 7},
                                {7, 2},
                                {0, 2}}));  // a spiral
}

TEST(Triangulate, HardCase_OneUlpDecidesWhetherAVertexIsReflex) {
    // Vertex 2 lies one unit of 2^-24 beside the straight line from 1 to 3, inside or outside.
    const std::int64_t n = (1 << 24) - 1;
    EXPECT_TRUE(is_cut_exactly({{0, n}, {0, 0}, {n / 3, n / 3 + 1}, {n, n - 1}}));
    EXPECT_TRUE(is_cut_exactly({{0, n}, {0, 0}, {n / 3, n / 3 - 1}, {n, n - 1}}));
    EXPECT_TRUE(is_cut_exactly({{n, n}, {n - 1, n - 2}, {1, 1}, {n - 1, n - 1}}));
}

TEST(Triangulate, HardCase_RingWithABridgeToItsHole) {
    const std::vector<Point> ring = with_hole(circle(32, 1000), circle(32, 500));
    EXPECT_EQ(ring.size(), 66u);
    EXPECT_TRUE(is_cut_exactly(ring));
}

TEST(Triangulate, HardCase_SeveralHolesBridgedFromOneVertex) {
    std::vector<Point> polygon{{0, 0}, {90, 0}, {90, 90}, {0, 90}};
    for (const Point at : {Point{10, 60}, Point{40, 40}, Point{60, 10}})
        polygon =
            with_hole(polygon, {at, {at.x + 9, at.y}, {at.x + 9, at.y + 9}, {at.x, at.y + 9}});
    EXPECT_TRUE(is_cut_exactly(polygon));
}

TEST(Triangulate, HardCase_BridgesWithBends) {
    // Inside: to a hole. Outside: to another island; there the triangle at a bend looks like an
    // ear.
    EXPECT_TRUE(is_cut_exactly({{0, 0},
                                {20, 0},
                                {20, 20},
                                {0, 20},
                                {0, 0},
                                {5, 9},
                                {9, 10},
                                {9, 12},
                                {12, 12},
                                {12, 10},
                                {9, 10},
                                {5, 9}}));
    EXPECT_TRUE(is_cut_exactly({{0, 0},
                                {4, 0},
                                {9, -3},
                                {9, 5},
                                {12, 5},
                                {12, 9},
                                {9, 9},
                                {9, 5},
                                {9, -3},
                                {4, 0},
                                {4, 4},
                                {0, 4}}));
}

TEST(Triangulate, HardCase_VerticesThatTouch) {
    EXPECT_TRUE(
        is_cut_exactly({{0, 0}, {2, 2}, {4, 0}, {4, 4}, {2, 2}, {0, 4}}));  // a bow at a point
    EXPECT_TRUE(is_cut_exactly({{0, 0}, {8, 0}, {8, 8}, {0, 8}, {4, 0}, {0, 7}}));  // on an edge
    EXPECT_TRUE(
        is_cut_exactly({{0, 0}, {8, 0}, {8, 4}, {8, 8}, {4, 8}, {8, 4}, {0, 4}}));  // on a vertex
}

TEST(Triangulate, PolygonsWithoutAreaGiveTrianglesWithoutArea) {
    EXPECT_TRUE(is_cut_exactly({{1, 1}, {1, 1}, {1, 1}}));
    EXPECT_TRUE(is_cut_exactly({{1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 1}}));
    EXPECT_TRUE(is_cut_exactly({{0, 0}, {3, 3}, {1, 1}, {2, 2}, {5, 5}}));
    EXPECT_TRUE(is_cut_exactly({{0, 0}, {1, 0}, {2, 0}, {3, 0}}));
    EXPECT_TRUE(
        is_cut_exactly({{0, 0}, {4, 0}, {4, 3}, {4, 0}, {8, 1}, {4, 0}}));  // a tree, walked around
}

TEST(Triangulate, DuplicateAndStraightVerticesCostTrianglesWithoutArea) {
    EXPECT_TRUE(is_cut_exactly({{0, 0}, {0, 0}, {4, 0}, {4, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 4}}));
    EXPECT_TRUE(is_cut_exactly(
        {{0, 0}, {1, 0}, {2, 0}, {4, 0}, {4, 2}, {4, 4}, {2, 2}, {1, 3}, {0, 4}, {0, 1}}));
    EXPECT_TRUE(
        is_cut_exactly({{0, 0}, {4, 0}, {9, 0}, {4, 0}, {4, 4}, {0, 4}}));  // a spike outwards
    EXPECT_TRUE(is_cut_exactly({{0, 0}, {4, 0}, {4, 4}, {2, 2}, {4, 4}, {0, 4}}));  // inwards
    EXPECT_TRUE(is_cut_exactly(
        {{0, 0}, {4, 0}, {9, 1}, {4, 0}, {4, 4}, {4, 4}, {0, 4}}));         // and a duplicate
    EXPECT_TRUE(is_cut_exactly({{0, 0}, {4, 0}, {1, 1}, {1, 1}, {0, 4}}));  // at a reflex vertex
}

/// Grows a polygon at random whose edges touch but do not cross: from a grid, cut into triangles,
/// it takes one triangle after the other over one of its edges, and now and then draws a line out
/// along an edge of the grid and back. What closes up leaves slits, holes with bridges, and
/// vertices that touch.
class PolygonGrower {
  public:
    explicit PolygonGrower(unsigned polygon_seed) : random_(polygon_seed), size_(2 + below(5)) {
        for (std::int64_t i = 0; i < size_ * size_; ++i) rises_.push_back(below(2) == 1);
        const Point vertex{below(size_), below(size_)}, right{vertex.x + 1, vertex.y};
        polygon_ = {vertex, right, {vertex.x + (rises_at(vertex) ? 1 : 0), vertex.y + 1}};
        taken_.insert(sorted(polygon_[0], polygon_[1], polygon_[2]));
    }

    std::vector<Point> grow() {
        const std::int64_t steps = 1 + below(6 * size_ * size_), lines_percent = 25 * below(4);
        for (std::int64_t step = 0; step < steps; ++step) {
            const bool goes_on =
                below(2) == 1;  // Else all happens everywhere and nothing gets far.
            const auto at =
                std::size_t(goes_on ? std::int64_t(last_) : below(std::int64_t(polygon_.size())));
            below(100) < lines_percent ? draw_line(at) : take_triangle(at);
        }
        return polygon_;
    }

  private:
    using Triangle = std::array<Point, 3>;

    std::int64_t below(std::int64_t n) { return std::int64_t(random_() % std::uint64_t(n)); }
    static Triangle sorted(Point a, Point b, Point c) {
        Triangle triangle{a, b, c};
        std::ranges::sort(triangle);
        return triangle;
    }
    bool rises_at(Point cell) const { return rises_[std::size_t(cell.y * size_ + cell.x)]; }
    Point after(std::size_t i) const { return polygon_[(i + 1) % polygon_.size()]; }
    Point before(std::size_t i) const {
        return polygon_[(i + polygon_.size() - 1) % polygon_.size()];
    }

    bool is_grid_edge(Point p, Point q) const {
        const std::int64_t dx = q.x - p.x, dy = q.y - p.y;
        const auto is_in_grid = [&](Point r) {
            return std::min(r.x, r.y) >= 0 && std::max(r.x, r.y) <= size_;
        };
        if (p == q || std::max(std::abs(dx), std::abs(dy)) > 1 || !is_in_grid(p) || !is_in_grid(q))
            return false;
        return dx == 0 || dy == 0 ||
               (dx == dy) == rises_at({std::min(p.x, q.x), std::min(p.y, q.y)});
    }
    std::vector<Point> neighbours(Point p) const {
        std::vector<Point> points;
        for (const std::int64_t dx : {-1, 0, 1})
            for (const std::int64_t dy : {-1, 0, 1})
                if (is_grid_edge(p, {p.x + dx, p.y + dy})) points.push_back({p.x + dx, p.y + dy});
        return points;
    }
    std::ptrdiff_t uses_of_edge(Point p, Point q) const {
        std::ptrdiff_t count = 0;
        for (std::size_t i = 0; i < polygon_.size(); ++i)
            count += std::minmax(polygon_[i], after(i)) == std::minmax(p, q);
        return count;
    }

    /// Takes in the triangle outside the edge that begins at vertex i.
    void take_triangle(std::size_t i) {
        const Point p = polygon_[i], q = after(i);
        for (const Point r : neighbours(p))
            if (is_grid_edge(q, r) && doubled_area(q, p, r) > 0 &&
                !taken_.contains(sorted(p, q, r)) &&
                std::max({uses_of_edge(p, q) - 1, uses_of_edge(p, r), uses_of_edge(q, r)}) < 2) {
                taken_.insert(sorted(p, q, r));
                last_ = i + 1;
                polygon_.insert(polygon_.begin() + std::ptrdiff_t(last_), r);
                return;
            }
    }

    /// Draws a line from vertex i to a neighbour in the grid and back, where it meets no other.
    void draw_line(std::size_t i) {
        const Point p = polygon_[i];
        const std::vector<Point> ends = neighbours(p);
        const Point end = ends[std::size_t(below(std::int64_t(ends.size())))];
        if (uses_of_edge(p, end) > 0 || !is_outside(p, end)) return;
        if (before(i) != after(i) && !is_between(p, before(i), end, after(i))) return;
        for (std::size_t other = 0; other < polygon_.size(); ++other)
            if (other != i && polygon_[other] == p &&
                is_parted(p, other, {before(i), end, after(i)}))
                return;
        last_ = i + 1;
        polygon_.insert(polygon_.begin() + std::ptrdiff_t(last_), {end, p});
    }
    bool is_outside(Point p, Point q) const {
        const auto points = neighbours(p);
        return std::ranges::any_of(points, [&](Point r) {
            return is_grid_edge(q, r) && !taken_.contains(sorted(p, q, r));
        });
    }
    /// Going around p counter-clockwise from a, one meets b before c.
    static bool is_between(Point p, Point a, Point b, Point c) {
        const auto turn = [&](Point q) {  // 0 to 7 eighths from the direction to a
            const auto eighth = [&](Point r) {
                return std::lround(std::atan2(double(r.y - p.y), double(r.x - p.x)) * 4 /
                                   std::numbers::pi);
            };
            return (eighth(q) - eighth(a) + 8) % 8;
        };
        return turn(b) > 0 && turn(b) < turn(c);
    }
    /// True when the line through p at another vertex may have some of the points on either side.
    bool is_parted(Point p, std::size_t other, const std::array<Point, 3>& points) const {
        const Point a = before(other), c = after(other);
        const auto is_on_line = [&](Point q) { return q == a || q == c; };
        const auto is_left = [&](Point q) { return a == c || is_between(p, a, q, c); };
        return std::ranges::any_of(points, is_on_line) ||
               !(std::ranges::all_of(points, is_left) || std::ranges::none_of(points, is_left));
    }

    std::mt19937 random_;
    std::int64_t size_;
    std::vector<bool> rises_;  ///< For each cell: its diagonal goes up to the right.
    std::set<Triangle> taken_;
    std::vector<Point> polygon_;
    std::size_t last_ = 0;  ///< The vertex added last.
};

TEST(Triangulate, HardCase_RandomPolygonsWhoseEdgesTouch) {
    for (unsigned i = 0; i < 5000; ++i) {
        std::vector<Point> polygon = PolygonGrower(seed + i).grow();
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

TEST(Triangulate, LargePolygonsAreCutExactly) {
    constexpr int n = 50'000;
    std::vector<Point> comb, spiral, inner_side;
    for (int i = 0; i < n; ++i) comb.push_back({i, i % 2 == 0 ? 0 : -1'000'000});
    comb.push_back({n, 1}), comb.push_back({-1, 1});
    for (int i = 0; i < n / 2; ++i) {
        const double angle = i * std::numbers::pi / 100, radius = 1000 + 100 * angle;
        spiral.push_back(
            {std::llround(radius * std::cos(angle)), std::llround(radius * std::sin(angle))});
        inner_side.push_back({std::llround((radius - 300) * std::cos(angle)),
                              std::llround((radius - 300) * std::sin(angle))});
    }
    spiral.insert(spiral.end(), inner_side.rbegin(), inner_side.rend());
    const std::vector<Point> ring = with_hole(circle(n / 2, 8e6), circle(n / 2, 7e6));
    for (const std::vector<Point>& polygon : {comb, spiral, ring}) {
        const auto triangles = triangulate(in_space(polygon));
        int128 sum = 0;
        for (const auto& [i, j, k] : triangles)
            sum += doubled_area(polygon[i], polygon[j], polygon[k]);
        EXPECT_TRUE(sum == doubled_area(polygon));
    }
}

}  // namespace
}  // namespace rasterbook
