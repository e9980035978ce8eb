// SPDX-License-Identifier: MIT
// What is clipped and culled, for numbers from 10^-8 to 10^8, against long double.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "04_mvp/clip.hpp"
#include "04_mvp/transform.hpp"
#include "support/any_size.hpp"
#include "support/plane_names.hpp"
#include "support/printers.hpp"
#include "support/reference.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

using Vertices = std::array<vec4, 3>;

/// The oracle for Eq. 4.10: left and right are w + x and w - x, and so on; near is w - z, far z.
Sum distance_inside(int plane, lvec4 point) {
    constexpr int axes[] = {0, 0, 1, 1, 2, 2};
    constexpr int signs[] = {1, -1, 1, -1, -1, 1};
    Sum sum;
    if (plane != 5) sum.add(point.w);
    sum.add(signs[plane] * point[axes[plane]]);
    return sum;
}

/// The weighted sum of a coordinate of the vertices.
Sum weighted(const Vertices& vertices, lvec3 barycentrics, int axis) {
    Sum sum;
    for (int i = 0; i < 3; ++i)
        sum.add(barycentrics[i] * vertices[static_cast<std::size_t>(i)][axis]);
    return sum;
}

/// How far inside of a plane the point of a triangle with these barycentrics is.
Sum distance_inside(int plane, const Vertices& vertices, lvec3 barycentrics) {
    Sum sum;
    for (int i = 0; i < 3; ++i) {
        const Sum vertex = distance_inside(plane, lvec4(vertices[static_cast<std::size_t>(i)]));
        sum.value += barycentrics[i] * vertex.value,
            sum.of_sizes += barycentrics[i] * vertex.of_sizes;
    }
    return sum;
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
testing::AssertionResult is_exact_part_of(const ClippedTriangle& part, const Vertices& vertices) {
    for (const ClippedVertex& vertex : part) {
        real sum = 0;
        for (int i = 0; i < 3; ++i) {
            if (!(vertex.barycentrics[i] >= 0))
                return testing::AssertionFailure() << "a barycentric coordinate below 0: "
                                                   << testing::PrintToString(vertex.barycentrics);
            sum += vertex.barycentrics[i];
        }
        if (const auto is_one = is_near(1, sum, of_shares + of_sums); !is_one) return is_one;
        for (int axis = 0; axis < 4; ++axis) {
            // Coming back into the frustum moves it by what the cut was off.
            const Sum exact = weighted(vertices, lvec3(vertex.barycentrics), axis);
            const Sum w = weighted(vertices, lvec3(vertex.barycentrics), 3);
            const auto passes_alpha_test =
                is_near(vertex.position_clip[axis], exact.value,
                        2 * of_sums * exact.of_sizes + of_cut * (exact.of_sizes + w.of_sizes) +
                            below_range);
            if (!passes_alpha_test) return passes_alpha_test;
        }
        for (int plane = 0; plane < frustum_planes; ++plane)
            if (distance_inside(plane, lvec4(vertex.position_clip)).value < 0)
                return testing::AssertionFailure()
                       << testing::PrintToString(vertex.position_clip) << " is outside of the "
                       << plane_names[plane] << " plane";
    }
    return testing::AssertionSuccess();
}

/// Whether the point of a triangle with these barycentrics lies in the frustum; nothing where that
/// is within rounding.
std::optional<bool> is_inside(const Vertices& vertices, lvec3 barycentrics) {
    bool is_deep = true;
    for (int plane = 0; plane < frustum_planes; ++plane) {
        const Sum distance = distance_inside(plane, vertices, barycentrics);
        const real tolerance = of_cut * distance.of_sizes + below_range;
        if (distance.value < -tolerance) return false;
        is_deep &= distance.value > tolerance;
    }
    return is_deep ? std::optional(true) : std::nullopt;
}

/// In how many of the parts the point is, less those that are turned over; nothing on a border.
std::optional<int> times_covered(const ClippedTriangles& parts, lvec3 barycentrics) {
    int times = 0;
    for (const ClippedTriangle& part : parts) {
        const lvec3 a(part[0].barycentrics), b(part[1].barycentrics), c(part[2].barycentrics);
        const real sides[] = {glm::dot(barycentrics, glm::cross(b, c)),
                              glm::dot(barycentrics, glm::cross(c, a)),
                              glm::dot(barycentrics, glm::cross(a, b))};
        int positive = 0, negative = 0;
        for (const real side : sides) positive += side > 0, negative += side < 0;
        if (positive + negative < 3 && (positive == 0 || negative == 0)) return std::nullopt;
        times += (positive == 3) - (negative == 3);
    }
    return times;
}

}  // namespace

TEST(Mvp, Eq4_10_PlaneDistancesOfAllSizes) {
    AnySize any(1, decades);
    for (int i = 0; i < cases; ++i) {
        const vec4 point = any.homogeneous();
        for (int plane = 0; plane < frustum_planes; ++plane) {
            const Sum exact = distance_inside(plane, lvec4(point));
            ASSERT_TRUE(is_near(plane_distance(plane, point), exact.value,
                                eps / 2 * std::abs(exact.value)))  // one sum
                << "from the " << plane_names[plane] << " plane, of "
                << testing::PrintToString(point) << "; seed 1, case " << i;
        }
    }
}

TEST(Mvp, Eq4_12_CrossingsOfAllSizes) {
    AnySize any(2, decades);
    for (int i = 0; i < cases; ++i) {
        const ClippedVertex a = {any.homogeneous(), any.vector()},
                            b = {any.homogeneous(), any.vector()};
        const float a_by = i % 16 ? any.positive() : 0, b_by = -any.positive();
        const bool is_a_first = i % 2;
        const ClippedVertex there =
            is_a_first ? crossing(a, a_by, b, b_by) : crossing(b, b_by, a, a_by);
        const real whole = real{a_by} - b_by;
        for (int k = 0; k < 7; ++k) {
            const auto number = [k](const ClippedVertex& vertex) {
                return k < 4 ? vertex.position_clip[k] : vertex.barycentrics[k - 4];
            };
            Sum exact;
            exact.add(-b_by / whole * number(a)), exact.add(a_by / whole * number(b));
            // The difference, the quotient, the product and the sum, half an eps each.
            ASSERT_TRUE(is_near(number(there), exact.value, 4 * eps / 2 * exact.of_sizes))
                << (k < 4 ? "position_clip[" : "barycentrics[") << (k < 4 ? k : k - 4)
                << "] between " << testing::PrintToString(a.position_clip) << ", inside by " << a_by
                << ", and " << testing::PrintToString(b.position_clip) << ", by " << b_by
                << (is_a_first ? "" : ", called the other way round") << "; seed 2, case " << i;
        }
    }
}

TEST(Mvp, Eq4_13_WhatIsLeftOfTrianglesOfAllSizes) {
    int inside = 0, outside = 0, cut = 0;
    for (const unsigned seed : {3u, 4u}) {
        AnySize any(seed, seed == 3 ? decades : 1), any_share(seed, 4);
        for (int i = 0; i < cases; ++i) {
            Vertices vertices;
            for (vec4& vertex : vertices) {
                vertex = any.homogeneous();
                if (i % 2) vertex.w = std::abs(vertex.w);
            }
            const ClippedTriangles parts = clip_triangle(vertices);
            for (const ClippedTriangle& part : parts)
                ASSERT_TRUE(is_exact_part_of(part, vertices))
                    << "of the triangle " << testing::PrintToString(vertices) << "; seed " << seed
                    << ", case " << i;
            cut += parts.end() - parts.begin() > 1;
            for (int k = 0; k < 8; ++k) {
                const lvec3 barycentrics = glm::abs(lvec3(any_share.vector()));
                const auto expected = is_inside(vertices, barycentrics);
                const auto times = times_covered(parts, barycentrics);
                if (!expected || !times) continue;
                ASSERT_EQ(*times, *expected ? 1 : 0)
                    << "in so many of the " << parts.end() - parts.begin()
                    << " parts is the point of the triangle " << testing::PrintToString(vertices)
                    << " whose barycentrics are in proportion to "
                    << testing::PrintToString(barycentrics) << "; it is "
                    << (*expected ? "inside" : "outside") << " of the frustum; seed " << seed
                    << ", case " << i << ", point " << k;
                ++(*expected ? inside : outside);
            }
        }
    }
    EXPECT_GT(inside, cases / 2);
    EXPECT_GT(outside, cases);
    EXPECT_GT(cut, cases / 10);
}

TEST(Mvp, Eq4_14_RandomBoxesOfAllSizes) {
    AnySize any(5, decades);
    int culled = 0, kept = 0;
    for (int i = 0; i < cases; ++i) {
        Bounds box;
        const vec3 place = any.vector();
        box.add(place), box.add(place + any.vector());
        mat4 clip_from_world;
        for (int column = 0; column < 4; ++column) clip_from_world[column] = any.homogeneous();
        if (i % 2)
            clip_from_world = perspective(1.0f, 1.5f, 1e-3f * any.positive()) *
                              look_at(any.vector(), any.vector(), vec3(0, 1, 0));
        std::array<bool, frustum_planes> is_beyond, reaches_in;  // of each plane
        is_beyond.fill(true), reaches_in.fill(false);
        for (const float x : {box.min.x, box.max.x})
            for (const float y : {box.min.y, box.max.y})
                for (const float z : {box.min.z, box.max.z}) {
                    lvec4 vertex(0), sizes(0);
                    for (int row = 0; row < 4; ++row) {
                        Sum sum;
                        sum.add(real{x} * clip_from_world[0][row]);
                        sum.add(real{y} * clip_from_world[1][row]);
                        sum.add(real{z} * clip_from_world[2][row]);
                        sum.add(clip_from_world[3][row]);
                        vertex[row] = sum.value, sizes[row] = sum.of_sizes;
                    }
                    for (int plane = 0; plane < frustum_planes; ++plane) {
                        // A product and four sums, of which plane_distance has one.
                        const real tolerance = 5 * eps / 2 * (sizes.w + sizes[plane / 2]);
                        const real distance = distance_inside(plane, vertex).value;
                        const auto of_plane = static_cast<std::size_t>(plane);
                        is_beyond[of_plane] &= distance < -tolerance;
                        reaches_in[of_plane] |= distance > tolerance;
                    }
                }
        const bool is_beyond_one = std::ranges::count(is_beyond, true) > 0;
        const bool reaches_into_all = std::ranges::count(reaches_in, false) == 0;
        const bool is_outside = is_outside_frustum(box, clip_from_world);
        const auto of_box = [&] {
            return "the box from " + testing::PrintToString(box.min) + " to " +
                   testing::PrintToString(box.max) + " by " +
                   testing::PrintToString(clip_from_world) + ", case " + std::to_string(i);
        };
        ASSERT_TRUE(!is_beyond_one || is_outside)
            << "not culled, though it is outside of one plane: " << of_box();
        ASSERT_TRUE(!reaches_into_all || !is_outside)
            << "culled, though it reaches into all planes: " << of_box();
        culled += is_beyond_one, kept += reaches_into_all;
    }
    EXPECT_GT(culled, cases / 10);
    EXPECT_GT(kept, cases / 10);
}
