// SPDX-License-Identifier: MIT
// What is clipped and culled, also for numbers from 10^-8 to 10^8 against long double, and for
// zeros, denormals, infinities and NaN.
#include "04_mvp/clip.hpp"

#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/projection.hpp"
#include "04_mvp/transform.hpp"
#include "common/app/counters.hpp"
#include "support/any_size.hpp"
#include "support/ascii_picture.hpp"
#include "support/look_up.hpp"
#include "support/plane_names.hpp"
#include "support/printers.hpp"
#include "support/projected.hpp"
#include "support/reference.hpp"
#include "support/seen_by_rays.hpp"
#include "support/special_numbers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

using Bits = std::array<std::uint32_t, 4>;

Bits bits_of(vec4 v) { return std::bit_cast<Bits>(std::array{v.x, v.y, v.z, v.w}); }

std::vector<ClippedTriangle> clipped(const ClipVertices& vertices) {
    const ClippedTriangles triangles = clip_triangle(vertices);
    return {triangles.begin(), triangles.end()};
}

/// The oracle for Eq. 4.10: left and right are w + x and w - x, and so on; near is w - z, far z.
real distance_inside(int plane, lvec4 point) {
    constexpr int signs[] = {1, -1, 1, -1, -1, 1};
    return (plane == 5 ? 0 : point.w) + signs[plane] * point[plane / 2];
}

/// A crossing of a crossing and so on, up to six. Each rounds its shares by 1 eps, which are the
/// same for positions and for barycentrics, and products and sums by half an eps.
constexpr real most_crossings = 6, of_shares = most_crossings * eps, of_sums = most_crossings * eps;

/// What a product below the range of float loses, times the greatest number.
constexpr real below_range = 0x1p-149L * 1e8L * 16;

/// How far a plane's cut may lie from where it should. The distances from which a crossing's
/// shares come round by half an eps of each, the shares by an eps; then position and barycentrics
/// by an eps each, now and in the crossings that come after.
constexpr real of_cut = 1.5L * eps + 2 * of_sums;

/// For EXPECT_TRUE: the vertices lie where their barycentrics say, and inside.
testing::AssertionResult is_part_of(const ClippedTriangle& part, const ClipVertices& vertices) {
    for (const ClippedVertex& vertex : part) {
        const lvec3 barycentrics(vertex.barycentrics);
        if (!glm::all(glm::greaterThanEqual(barycentrics, lvec3(0))))
            return testing::AssertionFailure() << "a barycentric coordinate below 0: "
                                               << testing::PrintToString(vertex.barycentrics);
        const auto weighted = [&](int axis) {
            Sum sum;
            for (int i = 0; i < 3; ++i)
                sum.add(barycentrics[i] * vertices[static_cast<std::size_t>(i)][axis]);
            return sum;
        };
        const real sum = barycentrics.x + barycentrics.y + barycentrics.z;
        if (const auto is_one = is_near(sum, 1, of_shares + of_sums); !is_one) return is_one;
        for (int axis = 0; axis < 4; ++axis) {
            // Coming back into the frustum moves it by what the cut was off.
            const Sum exact = weighted(axis), w = weighted(3);
            const real tolerance =
                2 * of_sums * exact.of_sizes + of_cut * (exact.of_sizes + w.of_sizes) + below_range;
            auto is_there = is_near(vertex.position_clip[axis], exact.value, tolerance);
            if (!is_there)
                return is_there << ", " << "xyzw"[axis] << " of a vertex with the barycentrics "
                                << testing::PrintToString(vertex.barycentrics);
        }
        for (int plane = 0; plane < frustum_planes; ++plane)
            if (distance_inside(plane, lvec4(vertex.position_clip)) < 0)
                return testing::AssertionFailure()
                       << testing::PrintToString(vertex.position_clip) << " is outside of the "
                       << plane_names[plane] << " plane";
    }
    return testing::AssertionSuccess();
}

/// The pixels of what is left and faces front.
Pixels covered_pixels(const ClipVertices& vertices, ivec2 size) {
    Pixels pixels;
    for (const ClippedTriangle& part : clip_triangle(vertices))
        if (const ProjectedTriangle triangle = projected(part, size); !triangle.is_back_facing)
            fill_triangle(triangle.on_screen, size,
                          [&](ivec2 pixel, vec3) { pixels.insert({pixel.x, pixel.y}); });
    return pixels;
}

/// For EXPECT_TRUE: as it is and turned over, covers the pixels whose rays hit its front, unless an
/// edge is within 1/256 pixel of the centre, which is how far snapping may move it.
testing::AssertionResult covers_what_rays_hit(const ClipVertices& vertices, ivec2 size) {
    for (const ClipVertices& turned : {vertices, {vertices[0], vertices[2], vertices[1]}}) {
        const RaySeen rays(turned);
        const Pixels actual = covered_pixels(turned, size);
        Pixels expected;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const bool is = actual.contains({x, y}), should = rays.is_seen({x, y}, size);
                const bool is_close = is != should && rays.is_near_border({x, y}, size, 1.0L / 256);
                if (is_close ? is : should) expected.insert({x, y});
            }
        if (auto are_the_same = same_pixels(actual, expected); !are_the_same)
            return are_the_same << "of the front of " << testing::PrintToString(turned);
    }
    return testing::AssertionSuccess();
}

constexpr ClipVertices all_inside = {
    {{-0.5f, -0.25f, 0.5f, 1}, {0.5f, -1, 0.25f, 1.5f}, {0, 2, 3, 3}}};

constexpr float below_clip_limit = 0x1.fffffep124f;
constexpr int many_cases = 1'000'000;

/// Ordinary numbers from -2 to 2, and so often in place of one a special one.
class Mix {
  public:
    explicit Mix(unsigned seed) : numbers_(seed) {}

    /// From now on one number in so many may be special.
    void set_rarity(unsigned rarity) { rarity_ = rarity; }
    float number() {
        if (numbers_.below(rarity_) > 0) return numbers_.ordinary();
        if (numbers_.below(8) > 0) return numbers_.any();
        return std::copysign(below_clip_limit, numbers_.ordinary());
    }
    vec3 vector() {
        const float x = number(), y = number(), z = number();
        return {x, y, z};
    }
    vec4 homogeneous() {
        const vec3 v = vector();
        return {v, number()};
    }
    /// The size of a number, in (0, most).
    float below(float most) {
        for (;;)
            if (const float x = std::abs(number()); x > 0 && x < most) return x;
    }

  private:
    SpecialNumbers numbers_;
    unsigned rarity_ = 1;
};

/// For EXPECT_TRUE: no number but those from `least` to `most`.
template <typename Vector>
testing::AssertionResult are_within(const char* what, const Vector& v, float least, float most) {
    for (int i = 0; i < v.length(); ++i)
        if (!(v[i] >= least && v[i] <= most))  // also for NaN
            return testing::AssertionFailure() << what << " " << testing::PrintToString(v);
    return testing::AssertionSuccess();
}

/// Draws a triangle as the lesson does, and looks at everything on its way to the pixels. For
/// EXPECT_TRUE: all that comes to a pixel is finite and in its range.
///
/// @param pixels  Grows by those visited.
testing::AssertionResult is_drawn(const ClipVertices& vertices, int& pixels) {
    constexpr ivec2 size(4, 3);
    // Each of six crossings rounds its shares by 1 eps, a product and a sum by half of one each.
    constexpr float of_barycentrics = 6 * 2 * FLT_EPSILON;
    // fill_triangle promises 2 ulp.
    constexpr float of_pixels = 2 * FLT_EPSILON;
    testing::AssertionResult result = testing::AssertionSuccess();
    const auto check = [&result](const testing::AssertionResult& next) {
        if (result && !next) result = next;
    };
    for (const ClippedTriangle& part : clip_triangle(vertices)) {
        std::array<vec3, 3> screen;
        for (std::size_t i = 0; i < 3; ++i) {
            const vec4 p = part[i].position_clip;
            check(are_within("a vertex in clip space", p, -p.w, p.w));
            check(are_within("a vertex's z and w", vec2(p.z, p.w), 0, 2 * clip_limit));
            check(are_within("a vertex's barycentrics", part[i].barycentrics, 0,
                             1 + of_barycentrics));
            screen[i] = screen_from_clip(p, size);
        }
        const ScreenTriangle on_screen = snap_triangle(screen[0], screen[1], screen[2]);
        if (on_screen.twice_area == 0) continue;
        for (const vec3 vertex : screen)
            check(are_within("a place and depth", vertex / vec3(size, 1), 0, 1));
        const TriangleDepth depth(vec3(screen[0].z, screen[1].z, screen[2].z));
        fill_triangle(on_screen, size, [&](ivec2, vec3 barycentrics) {
            ++pixels;
            check(are_within("a pixel's barycentrics", barycentrics, 0, 1 + of_pixels));
            // A product and three sums make up to twice that much.
            check(
                are_within("a pixel's depth", vec2(depth.at(barycentrics)), 0, 1 + 2 * of_pixels));
        });
    }
    if (!result) result << "\nof the triangle " << testing::PrintToString(vertices);
    return result;
}

}  // namespace

TEST(Mvp, Eq4_10_DistanceToEachPlane) {
    const vec4 point(1, 2, 3, 8);
    const float expected[] = {9, 7, 10, 6, 5, 3};
    for (int plane = 0; plane < frustum_planes; ++plane)
        EXPECT_EQ(plane_distance(plane, point), expected[plane])
            << "(1, 2, 3, 8) from the " << plane_names[plane] << " plane";
    EXPECT_EQ(plane_distance(1, {0, 0, 0, 1}), 1) << "the middle from the right plane";
    EXPECT_EQ(plane_distance(1, {3, 0, 0, 1}), -2) << "(3, 0, 0, 1) lies outside of it";
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
    AnySize any(2, decades);
    for (int i = 0; i < cases; ++i) {
        const ClippedVertex a = {any.homogeneous(), any.vector()},
                            b = {any.homogeneous(), any.vector()};
        const float a_by = i % 16 ? any.positive() : 0, b_by = -any.positive();
        const ClippedVertex there = crossing(a, a_by, b, b_by), back = crossing(b, b_by, a, a_by);
        const std::string of_case = "; a " + testing::PrintToString(a.position_clip) +
                                    ", inside by " + text_of(a_by) + ", b " +
                                    testing::PrintToString(b.position_clip) + ", by " +
                                    text_of(b_by) + "; seed 2, case " + std::to_string(i);
        ASSERT_TRUE(bits_of(back.position_clip) == bits_of(there.position_clip) &&
                    back.barycentrics == there.barycentrics)
            << "the crossing from b to a is " << testing::PrintToString(back.position_clip)
            << ", and from a to b " << testing::PrintToString(there.position_clip)
            << ": Eq. 4.12 is symmetric" << of_case;
        const real whole = real{a_by} - b_by;
        for (int k = 0; k < 7; ++k) {
            const auto number = [k](const ClippedVertex& vertex) {
                return k < 4 ? vertex.position_clip[k] : vertex.barycentrics[k - 4];
            };
            Sum exact;
            exact.add(-b_by / whole * number(a)), exact.add(a_by / whole * number(b));
            // The difference, the quotient, the product and the sum, half an eps each.
            ASSERT_TRUE(is_near(number(there), exact.value, 4 * eps / 2 * exact.of_sizes))
                << (k < 4 ? "position_clip[" : "barycentrics[") << (k < 4 ? k : k - 4) << ']'
                << of_case;
        }
    }
}

TEST(Mvp, Eq4_13_WhatIsLeftOfTheWorkedExample) {
    // A right angle at the middle; its sides end twice as far away as the picture.
    const ClipVertices vertices = {{{0, 0, 0, 1}, {2, 0, 0, 1}, {0, 2, 0, 1}}};
    std::set<std::pair<float, float>> left;
    for (const ClippedTriangle& part : clipped(vertices)) {
        EXPECT_TRUE(is_part_of(part, vertices));
        for (const ClippedVertex& vertex : part)
            left.insert({vertex.position_clip.x, vertex.position_clip.y});
    }
    EXPECT_EQ(left, (std::set<std::pair<float, float>>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}))
        << "x and y of what is left of (0, 0), (2, 0), (0, 2), with w = 1";
    EXPECT_TRUE(covers_what_rays_hit({{{0, 0, 0.5f, 1}, {2, 0, 0.5f, 1}, {0, 2, 0.5f, 1}}}, {8, 6}))
        << "with z = 0.5";
}

TEST(Mvp, Eq4_13_WhatIsAllInsideStaysBitForBit) {
    const auto parts = clipped(all_inside);
    ASSERT_EQ(parts.size(), 1u) << "triangles left of one that is all inside";
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(bits_of(parts[0][i].position_clip), bits_of(all_inside[i])) << "vertex " << i;
        EXPECT_EQ(parts[0][i].barycentrics, vec3(i == 0, i == 1, i == 2)) << "vertex " << i;
    }
}

TEST(Mvp, Eq4_13_NothingIsLeftOutsideOfOnePlane) {
    for (int plane = 0; plane < frustum_planes; ++plane) {
        ClipVertices vertices = all_inside;
        for (vec4& vertex : vertices) {
            constexpr float beyond[] = {-1.001f, 1.001f, -1.001f, 1.001f, 1.001f, -0.001f};
            vertex[plane / 2] = beyond[plane] * vertex.w;
        }
        ASSERT_TRUE(clipped(vertices).empty())
            << "something is left outside of the " << plane_names[plane]
            << " plane: " << testing::PrintToString(vertices);
    }
}

TEST(Mvp, Eq4_13_WhatIsLeftOfTrianglesOfAllSizes) {
    for (const unsigned seed : {3u, 4u}) {
        AnySize any(seed, seed == 3 ? decades : 1);
        for (int i = 0; i < cases; ++i) {
            ClipVertices vertices;
            for (vec4& vertex : vertices) {
                vertex = any.homogeneous();
                if (i % 2) vertex.w = std::abs(vertex.w);
            }
            for (const ClippedTriangle& part : clip_triangle(vertices))
                ASSERT_TRUE(is_part_of(part, vertices))
                    << "; of the triangle " << testing::PrintToString(vertices) << "; seed " << seed
                    << ", case " << i;
        }
    }
}

TEST(Mvp, HardCase_SharedEdgeIsCutInTheSamePoints) {
    look_up("Eq. 4.12: the same from both ends, bit for bit");
    std::mt19937 random(4);
    std::uniform_real_distribution<float> any(-3, 3);
    const auto vertex = [&] {
        return vec4(any(random), any(random), any(random), any(random) + 1.5f);
    };
    const auto on_edge = [&](const ClipVertices& vertices) {
        std::set<Bits> points;
        for (const ClippedTriangle& part : clip_triangle(vertices))
            for (const ClippedVertex& p : part)
                if (p.barycentrics.z == 0) points.insert(bits_of(p.position_clip));
        return points;
    };
    int cut = 0;
    for (int i = 0; i < 100'000; ++i) {
        const vec4 first = vertex(), second = vertex();
        const auto points = on_edge({first, second, vertex()});
        const auto other = on_edge({second, first, vertex()});
        if (points.empty() || other.empty()) continue;  // one of them is all outside
        ASSERT_TRUE(points == other)
            << "two triangles share the side from " << testing::PrintToString(first) << " to "
            << testing::PrintToString(second)
            << ", and are cut there in other points; seed 4, case " << i;
        cut += points != std::set<Bits>{bits_of(first), bits_of(second)};
    }
    EXPECT_GT(cut, 10'000);
}

TEST(Mvp, HardCase_TrianglesAroundTheCameraCoverWhatItsRaysHit) {
    look_up("Eq. 4.10 to 4.13");
    const mat4 clip_from_view = perspective(1.2f, 32.0f / 24, 0.25f);
    AnySize any_size(5, 1);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> spread(0.3f, 12), any(-1, 1);
    for (int i = 0; i < 10'000; ++i) {
        const float reach = spread(random);
        ClipVertices vertices;
        for (vec4& vertex : vertices) {
            const vec3 view = reach * vec3(any(random), any(random), any(random));
            vertex = i % 2 ? clip_from_view * vec4(view, 1) : any_size.homogeneous();
        }
        ASSERT_TRUE(covers_what_rays_hit(vertices, {32, 24})) << "; seed 5, case " << i;
    }
}

TEST(Mvp, HardCase_TriangleAcrossAllSixPlanes) {
    look_up("Eq. 4.13: plane by plane");
    const ClipVertices vertices = {{{-10, -9, 4.5f, 1}, {12, -9, 0, 1}, {0, 10, -1.5f, 1}}};
    EXPECT_TRUE(covers_what_rays_hit(vertices, {64, 48}));
    for (const ClippedTriangle& part : clip_triangle(vertices))
        EXPECT_TRUE(is_part_of(part, vertices));
}

TEST(Mvp, HardCase_NearPlaneThroughVertices) {
    look_up("Eq. 4.13: a vertex on the plane is inside");
    const vec4 on(0.25f, 0, 1, 1), also_on(-0.5f, 0.25f, 1, 1), third_on(0, -0.5f, 1, 1),
        inside(0, 0.5f, 0.5f, 1), beside(0.5f, 0.5f, 0.25f, 1), outside(0, 0, 1.5f, 1),
        far_outside(0.5f, 0, 2, 1);
    for (const ClipVertices& vertices :
         {ClipVertices{on, inside, beside}, {on, also_on, inside}, {on, also_on, third_on}}) {
        const auto parts = clipped(vertices);
        ASSERT_EQ(parts.size(), 1u);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_EQ(bits_of(parts[0][i].position_clip), bits_of(vertices[i]));
    }
    for (const ClipVertices& vertices : {ClipVertices{on, outside, far_outside},
                                         {on, also_on, outside},
                                         {far_outside, on, outside}})
        for (const ClippedTriangle& part : clip_triangle(vertices)) {
            EXPECT_TRUE(is_part_of(part, vertices));
            EXPECT_EQ(projected(part, {640, 480}).on_screen.twice_area, 0)
                << "a point or a side is left";
        }
    EXPECT_TRUE(covers_what_rays_hit({on, inside, outside}, {64, 48}));
    EXPECT_TRUE(covers_what_rays_hit({outside, on, inside}, {64, 48}));
}

TEST(Mvp, HardCase_CameraInsideATriangle) {
    look_up("Eq. 4.13: w is 0 at the eye, and the near plane lies before it");
    const mat4 clip_from_view = perspective(1.0f, 4.0f / 3, 0.001f);
    const auto floor_at = [&](float y) {
        return ClipVertices{clip_from_view * vec4(-50, y, 40, 1),
                            clip_from_view * vec4(60, y, 30, 1),
                            clip_from_view * vec4(0, y, -80, 1)};
    };
    EXPECT_TRUE(covered_pixels(floor_at(0), {64, 48}).empty()) << "seen from its edge";
    for (const float y : {-0.01f, 0.01f, -1.0f})
        EXPECT_TRUE(covers_what_rays_hit(floor_at(y), {64, 48})) << y;
}

TEST(Mvp, HardCase_WZeroNegativeAndTiny) {
    look_up("Eq. 4.10: what lies behind the eye is outside of a plane");
    constexpr ivec2 size(64, 48);
    const auto& [a, b, c] = all_inside;
    for (const float w : {0.0f, -0.0f, -1.0f, -1e-40f}) {
        EXPECT_TRUE(covered_pixels({{{0, 0, 1, w}, {1, 0, 1, w}, {0, 1, 1, w}}}, size).empty());
        EXPECT_TRUE(covers_what_rays_hit({vec4(0.1f, 0.2f, w + 0.5f, w), b, c}, size)) << "w " << w;
    }
    EXPECT_TRUE(covered_pixels({vec4(0), b, c}, size).empty())
        << "a vertex at the eye has no place on the screen";
    constexpr float tiny = 0x1p-135f;
    EXPECT_TRUE(same_pixels(covered_pixels({tiny * a, tiny * b, tiny * c}, size),
                            covered_pixels(all_inside, size)))
        << "a tiny w is ordinary: positions on the screen are quotients";
}

TEST(Mvp, HardCase_TinyAndHugeVerticesAreCutAsOthers) {
    look_up("Eq. 4.12: products of vertices may overflow, quotients do not");
    constexpr ivec2 size(64, 48);
    const vec4 a(-1, -2, 0.5f, 1), b(3, 0, 0.75f, 2), c(0, 2, 0.875f, 1.5f);
    const Pixels expected = covered_pixels({a, b, c}, size);
    EXPECT_GT(expected.size(), 500u);
    for (const float scale : {0x1p-120f, 0x1p-70f, 0x1p70f, 0x1p120f})
        EXPECT_TRUE(same_pixels(covered_pixels({scale * a, scale * b, scale * c}, size), expected))
            << scale;
}

TEST(Mvp, HardCase_SpecialNumbersInVerticesReachNoPixel) {
    look_up("Eq. 4.13: what counts as outside, and what rounding leaves there");
    Mix mix(1);
    int pixels = 0;
    for (int i = 0; i < many_cases; ++i) {
        mix.set_rarity(static_cast<unsigned>(i % 8 + 1));
        ClipVertices vertices;
        for (vec4& vertex : vertices) vertex = mix.homogeneous();
        ASSERT_TRUE(is_drawn(vertices, pixels)) << "seed 1, case " << i;
    }
    EXPECT_GT(pixels, many_cases / 10);
}

TEST(Mvp, HardCase_SpecialNumbersBeforeTheCameraReachNoPixel) {
    look_up("Eq. 4.5, 4.8 and 4.13");
    Mix mix(2);
    int pixels = 0;
    for (int i = 0; i < many_cases; ++i) {
        mix.set_rarity(static_cast<unsigned>(i % 8 + 1));
        const mat4 view_from_world = look_at(mix.vector(), mix.vector(), mix.vector());
        constexpr float one = 1 + 4 * FLT_EPSILON;  // as look_at promises
        for (int axis = 0; axis < 3; ++axis)
            ASSERT_TRUE(are_within("an axis", mat3(view_from_world)[axis], -one, one))
                << "seed 2, case " << i;
        // What perspective() takes: a field of view in (0, pi), near > 0.
        const mat4 clip_from_view =
            perspective(mix.below(3.1415925f), mix.below(infinity), mix.below(FLT_MAX));
        mat4 world_from_model(1);
        if (i % 4 >= 2)
            for (int column = 0; column < 4; ++column) world_from_model[column] = mix.homogeneous();
        const std::vector<vec4> clip =
            transform(clip_from_view * view_from_world * world_from_model,
                      {mix.vector(), mix.vector(), mix.vector()});
        ASSERT_TRUE(is_drawn({clip[0], clip[1], clip[2]}, pixels)) << "seed 2, case " << i;
    }
    EXPECT_GT(pixels, many_cases / 100);
}

TEST(Mvp, HardCase_NotANumberInAVertexLeavesNothing) {
    look_up("Eq. 4.13, and what counts as outside");
    for (const float bad : {not_a_number, infinity, -infinity, clip_limit, -0x1p126f})
        for (std::size_t i = 0; i < 3; ++i)
            for (int axis = 0; axis < 4; ++axis) {
                ClipVertices vertices = all_inside;
                vertices[i][axis] = bad;
                EXPECT_EQ(clipped(vertices).size(), 0u)
                    << bad << ", vertex " << i << ", axis " << axis;
            }
}

TEST(Mvp, Eq4_14_BoxesOutsideOfAPlaneAreCulled) {
    const mat4 clip_from_view = perspective(1.5707963f, 1.0f, 1.0f);
    const auto is_culled = [&](vec3 center) {
        return is_outside_frustum({center - 0.5f, center + 0.5f}, clip_from_view);
    };
    for (const vec3 center : {vec3(-7, 0, -5), vec3(7, 0, -5), vec3(0, -7, -5), vec3(0, 7, -5),
                              vec3(0, 0, -0.3f), vec3(0, 0, 5), vec3(0, 0, 50)})
        EXPECT_TRUE(is_culled(center))
            << "a box of side 1 around " << testing::PrintToString(center)
            << " is all outside of one plane";
    for (const vec3 center :
         {vec3(0, 0, -5), vec3(-5.4f, 0, -5), vec3(5.4f, 0, -5), vec3(0, -5.4f, -5),
          vec3(0, 5.4f, -5), vec3(0, 0, -0.6f), vec3(0, 0, -1e9f)})
        EXPECT_FALSE(is_culled(center))
            << "a box of side 1 around " << testing::PrintToString(center)
            << " is inside, reaches across a plane, or lies far away";
    EXPECT_FALSE(is_outside_frustum({{-90, -1, -4}, {90, 1, -3}}, clip_from_view))
        << "from (-90, -1, -4) to (90, 1, -3): some corners are outside of the left plane, the "
           "others of the right one, and the middle is seen";
}

TEST(Mvp, Eq4_14_BoxesAreCulledIfAllCornersAreOutsideOfOnePlane) {
    // Of small whole numbers: nothing rounds, and many corners lie on a plane.
    std::mt19937 random(5);
    std::uniform_int_distribution<int> any(-9, 9);
    int culled = 0;
    for (int i = 0; i < cases; ++i) {
        Bounds box;
        for (int k = 0; k < 2; ++k) box.add(vec3(any(random), any(random), any(random)));
        mat4 clip_from_world;
        for (int column = 0; column < 4; ++column)
            clip_from_world[column] = vec4(any(random), any(random), any(random), any(random));
        bool expected = false;
        for (int plane = 0; plane < frustum_planes; ++plane) {
            int outside = 0;
            for (const float x : {box.min.x, box.max.x})
                for (const float y : {box.min.y, box.max.y})
                    for (const float z : {box.min.z, box.max.z})
                        outside += distance_inside(plane, clip_from_world * vec4(x, y, z, 1)) < 0;
            expected |= outside == 8;
        }
        ASSERT_EQ(is_outside_frustum(box, clip_from_world), expected)
            << "whether the box is culled from " << testing::PrintToString(box.min) << " to "
            << testing::PrintToString(box.max) << " by " << testing::PrintToString(clip_from_world)
            << "; seed 5, case " << i;
        culled += expected;
    }
    EXPECT_GT(culled, cases / 10);
}

TEST(Mvp, HardCase_BoxAroundTheCameraIsNotCulled) {
    look_up("Eq. 4.14: outside of one and the same plane");
    const mat4 clip_from_view = perspective(1.0f, 1.0f, 0.1f);
    EXPECT_FALSE(is_outside_frustum({vec3(-9), vec3(9)}, clip_from_view));
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
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(front.depth.at({i == 0, i == 1, i == 2}),
                  vec3(0.5f, 0.25f, 1)[static_cast<int>(i)]);
        EXPECT_EQ(front.clipped[i].position_clip, clipped[i].position_clip);
        EXPECT_EQ(front.clipped[i].barycentrics, clipped[i].barycentrics);
    }
    EXPECT_TRUE(projected({{clipped[0], clipped[2], clipped[1]}}, {8, 4}).is_back_facing);
    EXPECT_TRUE(projected({{clipped[0], clipped[0], clipped[1]}}, {8, 4}).is_back_facing)
        << "of no area: never drawn";
}

TEST(Mvp, EachVisibleTriangleIsVisitedInTheScenesOrder) {
    look_up("Eq. 4.14: what is culled; and each piece of Eq. 4.13 in its order");
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

    using Visited = std::tuple<const Mesh*, const Triangle*, bool>;  // and whether it is a back
    const auto visited = [&](Culling culling) {
        thread_counters = {};
        std::vector<Visited> all;
        for_each_visible_triangle(
            scene, perspective(1.0f, 1.0f, 1.0f), ivec2(64), culling,
            [&](const ProjectedTriangle& visible) {
                all.push_back({&visible.mesh, &visible.triangle, visible.is_back_facing});
            });
        EXPECT_EQ(thread_counters[Counter::meshes_in], 3u);
        EXPECT_EQ(thread_counters[Counter::meshes_culled_by_frustum], 1u);
        EXPECT_EQ(thread_counters[Counter::meshes_with_tangents], 1u);
        EXPECT_EQ(thread_counters[Counter::triangles_in], 4u);
        return all;
    };
    const Mesh &first = scene.meshes[0], &last = scene.meshes[2];
    std::vector<Visited> both = visited(Culling::none);
    EXPECT_EQ(thread_counters[Counter::triangles_culled_by_facing], 0u);
    ASSERT_GE(both.size(), 4u) << "the near plane leaves something of the one that it cuts";
    std::vector<Visited> expected = {{&first, &first.triangles[0], false},
                                     {&first, &first.triangles[1], true}};
    const bool is_cut_one_a_back = std::get<bool>(both[2]);
    expected.resize(both.size() - 1, {&last, &last.triangles[0], is_cut_one_a_back});
    expected.push_back({&last, &last.triangles[1], false});
    EXPECT_TRUE(both == expected);
    const std::vector<Visited> fronts = visited(Culling::back_faces);
    EXPECT_EQ(thread_counters[Counter::triangles_culled_by_facing], both.size() - fronts.size());
    std::erase_if(both, [](const Visited& one) { return std::get<bool>(one); });
    EXPECT_TRUE(fronts == both);
}
