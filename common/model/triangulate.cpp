// SPDX-License-Identifier: MIT
#include "common/model/triangulate.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

namespace rasterbook {
namespace {

/// A sum of doubles without any rounding: parts that do not overlap, in rising magnitude.
class ExactSum {
  public:
    void add(double x) {
        std::size_t kept = 0;
        for (const double part : parts_) {  // Knuth's two-sum: x + part = sum + error
            const double sum = x + part;
            const double rounded = sum - x;
            const double error = (x - (sum - rounded)) + (part - rounded);
            if (error != 0) parts_[kept++] = error;
            x = sum;
        }
        parts_.resize(kept);
        if (x != 0) parts_.push_back(x);
    }
    /// The largest part outweighs all others together.
    int sign() const { return parts_.empty() ? 0 : parts_.back() > 0 ? 1 : -1; }

  private:
    std::vector<double> parts_;
};

/// Adds p x q. Each product of two floats is exact in double.
void add_cross(ExactSum& sum, vec2 p, vec2 q) {
    sum.add(double(p.x) * double(q.y));
    sum.add(-double(p.y) * double(q.x));
}

/// The sign of the area that the closed line goes around.
int winding_sign(std::span<const vec2> points) {
    ExactSum doubled_area;
    for (std::size_t i = 0; i < points.size(); ++i)
        add_cross(doubled_area, points[i], points[(i + 1) % points.size()]);
    return doubled_area.sign();
}

bool lexicographically_less(vec2 p, vec2 q) { return p.x < q.x || (p.x == q.x && p.y < q.y); }

/// The polygon as seen along the axis on which its normal (Newell's) is longest.
std::vector<vec2> project(std::span<const vec3> polygon) {
    dvec3 normal(0);
    const dvec3 origin = polygon[0];  // Products of small differences keep the small terms.
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const dvec3 p = dvec3(polygon[i]) - origin;
        const dvec3 q = dvec3(polygon[i + 1 < polygon.size() ? i + 1 : 0]) - origin;
        normal += glm::cross(p, q);
    }
    const dvec3 length = glm::abs(normal);
    const int z = length.z >= length.x && length.z >= length.y ? 2 : length.y >= length.x ? 1 : 0;
    const int x = (z + 1) % 3, y = (z + 2) % 3;
    std::vector<vec2> points(polygon.size());
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = {polygon[i][x], polygon[i][y]};
    return points;
}

/// True when the polygon turns one way only, and once around: it has one rising and one falling
/// side.
bool is_convex(std::span<const vec2> points) {
    const std::size_t n = points.size();
    int turn = 0, reversals = 0;
    bool rising = lexicographically_less(points[n - 1], points[0]);
    for (std::size_t i = 0; i < n; ++i) {
        const vec2 p = points[i], q = points[i + 1 < n ? i + 1 : 0];
        const int next_turn = orientation(points[i > 0 ? i - 1 : n - 1], p, q);
        if (next_turn * turn < 0) return false;
        if (next_turn != 0) turn = next_turn;
        if (p == q) return false;  // Hides a turn.
        if (lexicographically_less(p, q) != rising) rising = !rising, ++reversals;
    }
    return reversals <= 2;
}

/// Finds points in a region; points can be taken out. A k-d tree in which the children of node i
/// are 2i + 1 and 2i + 2, each with half of the points.
class PointTree {
  public:
    struct Point {
        vec2 at;
        std::uint32_t number;
    };

    explicit PointTree(std::span<const vec2> points) : leaf_of_(points.size()) {
        points_.reserve(points.size());
        for (const vec2 at : points) points_.push_back({at, std::uint32_t(points_.size())});
        build(0, points_);
    }

    void remove(std::uint32_t number) {
        for (std::size_t node = leaf_of_[number];; node = (node - 1) / 2) {
            --nodes_[node].left;
            if (node == 0) return;
        }
    }

    /// True when is_hit(point) is, for some point in boxes for which may_hit(min, max) is true.
    /// Also asks about points that were taken out, as long as others in their box are left.
    template <typename MayHit, typename IsHit>
    bool any_of(const MayHit& may_hit, const IsHit& is_hit, std::size_t node = 0) const {
        const Node& here = nodes_[node];
        if (here.left == 0 || !may_hit(here.min, here.max)) return false;
        if (here.points.size() <= leaf_size_) return std::ranges::any_of(here.points, is_hit);
        return any_of(may_hit, is_hit, 2 * node + 1) || any_of(may_hit, is_hit, 2 * node + 2);
    }

  private:
    struct Node {
        std::span<Point> points;
        std::size_t left;  ///< Those not taken out.
        vec2 min{std::numeric_limits<float>::infinity()};
        vec2 max{-std::numeric_limits<float>::infinity()};
    };

    void build(std::size_t node, std::span<Point> points);

    static constexpr std::size_t leaf_size_ = 8;
    std::vector<Point> points_;           ///< Those of a node side by side.
    std::vector<std::uint32_t> leaf_of_;  ///< For each point its node.
    std::vector<Node> nodes_;
};

void PointTree::build(std::size_t node, std::span<Point> points) {
    Node here{.points = points, .left = points.size()};
    for (const auto& [at, number] : points) {
        here.min = glm::min(here.min, at), here.max = glm::max(here.max, at);
        leaf_of_[number] = std::uint32_t(node);
    }
    if (nodes_.size() <= node) nodes_.resize(node + 1);
    nodes_[node] = here;
    if (points.size() <= leaf_size_) return;
    const int axis = here.max.x - here.min.x >= here.max.y - here.min.y ? 0 : 1;
    const std::size_t half = points.size() / 2;
    const auto is_before = [axis](const Point& p, const Point& q) {
        return p.at[axis] < q.at[axis];
    };
    std::nth_element(points.begin(), points.begin() + std::ptrdiff_t(half), points.end(),
                     is_before);
    build(2 * node + 1, points.first(half));
    build(2 * node + 2, points.subspan(half));
}

/// False only when no point of the box is in the triangle a, b, c or on ab or bc.
bool may_touch(vec2 a, vec2 b, vec2 c, vec2 box_min, vec2 box_max) {
    const vec2 min = glm::min(a, glm::min(b, c)), max = glm::max(a, glm::max(b, c));
    const auto leftmost = [&](vec2 p, vec2 q) {  // Of the box, seen from p towards q.
        return vec2(q.y < p.y ? box_max.x : box_min.x, q.x > p.x ? box_max.y : box_min.y);
    };
    return box_min.x <= max.x && box_min.y <= max.y && box_max.x >= min.x && box_max.y >= min.y &&
           orientation(a, b, leftmost(a, b)) >= 0 && orientation(b, c, leftmost(b, c)) >= 0 &&
           orientation(c, a, leftmost(c, a)) > 0;
}

/// A polygon that loses one vertex after the other.
///
/// Why the areas add up: a polygon whose edges do not cross winds around each point once (inside)
/// or not at all (outside). Cutting off a vertex takes 1 from the winding number all over its
/// triangle. So it is enough to cut only triangles that are wound around once everywhere: is_ear()
/// sees to that. Triangles without area change nothing and are always allowed.
class EarClipper {
  public:
    using Index = std::uint32_t;

    /// @param points  Counter-clockwise.
    explicit EarClipper(std::span<const vec2> points)
        : points_(points), tree_(points), before_(points.size()), after_(points.size()) {
        const auto n = Index(points.size());
        for (Index i = 0; i < n; ++i) before_[i] = (i + n - 1) % n, after_[i] = (i + 1) % n;
        left_ = n, triangles_.reserve(n - 2);
    }

    std::vector<std::array<Index, 3>> run() {
        cut_ears();
        while (left_ >= 3) cut(after_[any_]);  // The last triangle; or all, if it crosses itself.
        return std::move(triangles_);
    }

  private:
    bool is_cut(Index i) const { return after_[before_[i]] != i; }
    void cut(Index vertex);
    void cut_ears();
    bool is_spike(Index vertex) const;
    bool is_ear(Index vertex);
    int winding_number_inside(Index vertex) const;

    std::span<const vec2> points_;
    PointTree tree_;
    std::vector<Index> before_, after_;  ///< The ring of the vertices that are left.
    Index left_, any_ = 0;               ///< How many, and one of them.
    bool crosses_itself_ = false;        ///< Set when that is noticed: then any triangles will do.
    std::vector<std::array<Index, 3>> triangles_;
};

void EarClipper::cut(Index vertex) {
    const Index a = before_[vertex], c = after_[vertex];
    triangles_.push_back({a, vertex, c});
    after_[a] = c, before_[c] = a, any_ = a, --left_;
    tree_.remove(vertex);
}

/// Spikes as soon as they stand out, ears in turn around the polygon. A vertex is tried
/// again when it has a new neighbour: else its triangle leaves the polygon as it did before.
void EarClipper::cut_ears() {
    std::vector<Index> suspects(left_);  // Maybe spikes.
    std::deque<Index> candidates;        // No spikes, maybe ears.
    for (Index i = left_, vertex = any_; i > 0; vertex = after_[vertex]) suspects[--i] = vertex;
    while (left_ > 3 && !(suspects.empty() && candidates.empty()) && !crosses_itself_) {
        const bool look_for_spike = !suspects.empty();
        const Index vertex = look_for_spike ? suspects.back() : candidates.front();
        look_for_spike ? suspects.pop_back() : candidates.pop_front();
        if (is_cut(vertex)) continue;
        if (look_for_spike ? is_spike(vertex) : is_ear(vertex)) {
            suspects.insert(suspects.end(), {after_[vertex], before_[vertex]});
            cut(vertex);
        } else if (look_for_spike) {
            candidates.push_back(vertex);
        }
    }
}

/// True where the line turns back on itself or stands still.
bool EarClipper::is_spike(Index vertex) const {
    const vec2 a = points_[before_[vertex]], b = points_[vertex], c = points_[after_[vertex]];
    const dvec2 to_a = dvec2(a) - dvec2(b), to_c = dvec2(c) - dvec2(b);
    // In one line, so that signs are enough.
    return orientation(a, b, c) == 0 && to_a.x * to_c.x >= 0 && to_a.y * to_c.y >= 0;
}

/// True when the polygon winds once around all of the triangle a, b, c at vertex b.
///
/// An edge that passes through the triangle has an end there or on ab or bc: a straight line that
/// comes in over ac cannot leave over ac.
bool EarClipper::is_ear(Index vertex) {
    const vec2 a = points_[before_[vertex]], b = points_[vertex], c = points_[after_[vertex]];
    if (orientation(a, b, c) <= 0) return false;

    bool runs_back_to_a = false, runs_back_to_c = false;
    const auto blocks = [&](const PointTree::Point& point) {
        const auto [p, i] = point;
        const int at_ab = orientation(a, b, p), at_bc = orientation(b, c, p);
        if (at_ab < 0 || at_bc < 0 || orientation(c, a, p) <= 0) return false;
        if (i == vertex || is_cut(i)) return false;
        if (at_ab > 0 && at_bc > 0) return true;
        for (const vec2 q : {points_[before_[i]], points_[after_[i]]}) {  // p is on ab or bc.
            const int to_ab = orientation(a, b, q), to_bc = orientation(b, c, q);
            if ((at_ab > 0 || to_ab > 0) && (at_bc > 0 || to_bc > 0)) return true;
            runs_back_to_a |= p == b && to_ab == 0 && to_bc > 0;
            runs_back_to_c |= p == b && to_bc == 0 && to_ab > 0;
        }
        return false;
    };
    const auto may_block = [&](vec2 min, vec2 max) { return may_touch(a, b, c, min, max); };
    if (tree_.any_of(may_block, blocks)) return false;
    // An edge that is passed one way only has the inside on its left. Where both ab and bc are
    // passed both ways, the triangle may lie beside a bridge that leads outside.
    if (!runs_back_to_a || !runs_back_to_c) return true;
    const int winding_number = winding_number_inside(vertex);
    crosses_itself_ |= winding_number < 0 || winding_number > 1;
    return winding_number == 1;
}

/// Counts the edges that a ray to the right crosses, up as +1 and down as -1. It starts infinitely
/// near vertex b in its triangle, at b + e (a - b) + e^2 (c - b): where b leaves it open a decides,
/// and then c.
int EarClipper::winding_number_inside(Index vertex) const {
    const std::array abc{points_[vertex], points_[before_[vertex]], points_[after_[vertex]]};
    const auto is_below_start = [&](vec2 p) {
        if (p.y != abc[0].y) return p.y < abc[0].y;
        return p.y != abc[1].y ? p.y < abc[1].y : p.y < abc[2].y;
    };
    const auto side_of_start = [&](vec2 p, vec2 q) {
        for (const vec2 start : abc)
            if (const int side = orientation(p, q, start)) return side;
        return 0;
    };
    int winding_number = 0;
    Index i = vertex;
    do {
        const vec2 p = points_[i], q = points_[after_[i]];
        const bool from_below = is_below_start(p), to_below = is_below_start(q);
        if (from_below && !to_below) winding_number += side_of_start(p, q) > 0;
        if (!from_below && to_below) winding_number -= side_of_start(p, q) < 0;
        i = after_[i];
    } while (i != vertex);
    return winding_number;
}

}  // namespace

int orientation(vec2 a, vec2 b, vec2 c) {
    const double left = (double(b.x) - double(a.x)) * (double(c.y) - double(a.y));
    const double right = (double(b.y) - double(a.y)) * (double(c.x) - double(a.x));
    const double area = left - right;
    constexpr double epsilon = std::numeric_limits<double>::epsilon() / 2;
    const double error_bound = (3 + 16 * epsilon) * epsilon * (std::abs(left) + std::abs(right));
    if (std::abs(area) > error_bound) return area > 0 ? 1 : -1;
    if (left == 0 && right == 0) return 0;  // Differences of unequal floats do not round to 0.

    ExactSum sum;
    add_cross(sum, a, b), add_cross(sum, b, c), add_cross(sum, c, a);
    return sum.sign();
}

std::size_t most_returns(std::span<const vec3> polygon) {
    if (polygon.size() <= max_returns) return polygon.size();  // it cannot be too many
    std::vector<std::array<float, 3>> points;
    for (const vec3 p : polygon) points.push_back({p.x + 0.0f, p.y + 0.0f, p.z + 0.0f});
    std::ranges::sort(points);
    std::size_t most = 0;
    for (std::size_t begin = 0, i = 0; i < points.size(); ++i) {
        if (points[i] != points[begin]) begin = i;
        most = std::max(most, i - begin + 1);
    }
    return most;
}

std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const vec3> polygon) {
    assert(polygon.size() >= 3 && "a polygon has at least 3 vertices");
    std::vector<vec2> points = project(polygon);
    if (!is_convex(points)) {
        if (winding_sign(points) < 0)
            for (vec2& p : points) std::swap(p.x, p.y);
        return EarClipper(points).run();
    }
    std::vector<std::array<std::uint32_t, 3>> fan;  // Eq. 2.10
    fan.reserve(polygon.size() - 2);
    for (std::uint32_t i = 2; i < polygon.size(); ++i) fan.push_back({0, i - 1, i});
    return fan;
}

}  // namespace rasterbook
