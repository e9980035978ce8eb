// SPDX-License-Identifier: MIT
// Numbers of several lanes beside plain ones, triangles filled in vectors, depths of a tile, and
// batches of pixels.
#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "03_z_buffer/depth_buffer.hpp"
#include "10_threading/thread_pool.hpp"
#include "12_effects/effects_options.hpp"
#include "12_effects/planned_scene.hpp"
#include "13_visibility_buffer/visible_shading.hpp"
#include "14_simd/simd.hpp"
#include "14_simd/wide_shading.hpp"
#include "14_simd/wide_triangles.hpp"
#include "support/any_scene.hpp"
#include "support/first_difference.hpp"
#include "support/lanes.hpp"
#include "support/look_up.hpp"
#include "support/one_triangle.hpp"
#include "support/pictures.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// Apart from compare(), which is compiled for each function and width.
void expect_success(const testing::AssertionResult& result, const char* name,
                    std::span<const float> a, std::span<const float> b) {
    EXPECT_TRUE(result) << name << " of a = " << list_of(a) << " and b = " << list_of(b);
}

/// Compares a function of two wide numbers with the same one of plain numbers.
template <int N, typename Function>
void compare(const char* name, const Function& function, int numbers = 20'000) {
    Dice dice(N);
    for (int k = 0; k < numbers / N; ++k) {
        const auto a = any_numbers<N>(dice), b = any_numbers<N>(dice);
        const testing::AssertionResult result = has_in_lanes(
            function(in_lanes<N>(a), in_lanes<N>(b)), [&](int i) { return function(a[i], b[i]); });
        if (!result) return expect_success(result, name, a, b);
    }
}

/// "(0.5, 2), (3, 4), (5, 6)"
std::string in_words(const std::array<vec2, 3>& v) {
    return testing::PrintToString(v[0]) + ", " + testing::PrintToString(v[1]) + ", " +
           testing::PrintToString(v[2]);
}

struct Filled {
    ivec2 pixel;
    Barycentrics at;
    bool operator==(const Filled& other) const {
        return pixel == other.pixel && std::memcmp(&at, &other.at, sizeof at) == 0;
    }
};

/// For EXPECT_TRUE: the pixels of vectors of N are those that lesson 02 visits, with their bits.
testing::AssertionResult are_the_same(const std::vector<Filled>& actual,
                                      const std::vector<Filled>& expected) {
    for (std::size_t i = 0; i < std::max(actual.size(), expected.size()); ++i) {
        if (i < std::min(actual.size(), expected.size()) && actual[i] == expected[i]) continue;
        const auto one = [&](const std::vector<Filled>& of) {
            if (i >= of.size()) return std::string("no other pixel");
            return "the pixel " + testing::PrintToString(of[i].pixel) +
                   " with the barycentric coordinates " + shown(of[i].at);
        };
        return testing::AssertionFailure()
               << "visited: " << one(actual) << "; expected: " << one(expected);
    }
    return testing::AssertionSuccess();
}

/// For EXPECT_TRUE: vectors of F visit the pixels that lesson 02 visits, with their bits; and
/// WideBarycentricPlanes finds these again.
template <typename F>
testing::AssertionResult fills_as_lesson_02(const ScreenTriangle& triangle, ivec2 first,
                                            ivec2 last) {
    constexpr int N = width_of<F>;
    std::vector<Filled> actual, expected, found_again;
    fill_triangle(triangle, first, last,
                  [&](ivec2 pixel, Barycentrics at) { expected.push_back({pixel, at}); });
    fill_triangle<F>(triangle, first, last, [&](ivec2 pixel, MaskOf<F> covered, const Vec3<F>& at) {
        for (int i = 0; i < N; ++i)
            if (lane_of(covered, i)) actual.push_back({pixel + ivec2(i, 0), lane_of(at, i)});
    });
    if constexpr (N > 1)
        for (std::size_t k = 0; k < expected.size(); k += N) {
            Ints<N> x(0), y(0);
            const int count = std::min(N, static_cast<int>(expected.size() - k));
            for (int i = 0; i < count; ++i) {
                const ivec2 pixel = expected[k + std::size_t(i)].pixel;
                x.set(i, pixel.x), y.set(i, pixel.y);
            }
            const Vec3<F> at = WideBarycentricPlanes<N>(triangle).at(x, y);
            for (int i = 0; i < count; ++i) found_again.push_back({{x[i], y[i]}, lane_of(at, i)});
        }
    const testing::AssertionResult visits = are_the_same(actual, expected);
    if (N == 1 || !visits) return visits;
    return are_the_same(found_again, expected) << " (found again by WideBarycentricPlanes)";
}

/// Triangles of each kind that fill_triangle() treats differently, around a picture of 300 pixels.
std::array<vec2, 3> any_triangle(Dice& dice) {
    constexpr std::array extents = {0.6f, 3.0f, 12.0f, 49.0f, 50.3f, 90.0f, 2000.0f, 60000.0f};
    const float extent = extents.at(dice.below(extents.size()));
    const vec2 middle(dice.between(-40, 340), dice.between(-40, 340));
    std::array<vec2, 3> v;
    for (vec2& vertex : v) vertex = middle + extent * vec2(dice.in_cube(1));
    switch (dice.below(6)) {
        case 0:  // a sliver
            v[2] = 0.5f * (v[0] + v[1]) + vec2(dice.in_cube(0.02f));
            break;
        case 1:  // vertices, and so edges, on pixels' centres
            for (vec2& vertex : v) vertex = glm::floor(vertex) + 0.5f;
            break;
        case 2:  // as wide as the limit of 32 bits, or a little more or less
            v[1] = v[0] + vec2(dice.between(98.9f, 100.1f), dice.between(-100, 100));
            break;
        case 3:
            v[1] = v[0] + vec2(dice.between(-100, 100), dice.between(98.9f, 100.1f));
            break;
        default:
            break;
    }
    return v;
}

}  // namespace

TEST(Simd, Eq14_1_SelectOfTheWorkedExample) {
    const Floats<4> a = in_lanes<4>({3, 1, 4, 1}), b = in_lanes<4>({2, 7, 1, 8});
    const PerLane<bool, 4> holds{false, true, false, true};
    const PerLane<float, 4> expected{2, 1, 1, 1};
    EXPECT_TRUE(has_in_lanes(a < b, [&](int i) { return holds[i]; }))
        << "the mask of (3, 1, 4, 1) < (2, 7, 1, 8)";
    EXPECT_TRUE(has_in_lanes(select(a < b, a, b), [&](int i) { return expected[i]; }))
        << "select(a < b, a, b) of a = (3, 1, 4, 1), b = (2, 7, 1, 8)";
}

TEST(Simd, Eq14_1_SelectTakesTheBitsOfEachLane) {
    const auto check = []<int N>() {
        Dice dice(N);
        for (int k = 0; k < 20'000 / N; ++k) {
            const auto a = any_numbers<N>(dice), b = any_numbers<N>(dice);
            const std::uint32_t bits = dice.below(0xffffffffu);
            ASSERT_TRUE(has_in_lanes(select(mask_of_bits<N>(bits), in_lanes<N>(a), in_lanes<N>(b)),
                                     [&](int i) { return bits >> i & 1 ? a[i] : b[i]; }))
                << "select(m, a, b), where m has the bits " << bits << "; a = " << list_of(a)
                << ", b = " << list_of(b);
        }
    };
    for_each_width(check);
    check.operator()<32>();  // no register holds so many: by AND and OR, on each machine
}

TEST(Simd, Eq14_3_FloorOfTheWorkedExample) {
    const Floats<4> x = in_lanes<4>({-1.5f, 1.5f, -2, 2});
    const PerLane<int, 4> truncations{-1, 1, -2, 2}, floors{-2, 1, -2, 2};
    EXPECT_TRUE(has_in_lanes(truncated(x), [&](int i) { return truncations[i]; }))
        << "-1.5, 1.5, -2 and 2 rounded towards 0";
    EXPECT_TRUE(has_in_lanes(floor(x), [&](int i) { return static_cast<float>(floors[i]); }))
        << "-1.5, 1.5, -2 and 2 rounded down";
}

TEST(Simd, Eq14_3_FloorHasTheBitsOfStdFloor) {
    for_each_width([]<int N>() {
        compare<N>("floor(a)", [](auto a, auto) { return floor(a); }, 100'000);
        compare<N>(
            "floor(1,000,000 b)", [](auto, auto b) { return floor(b * decltype(b)(1e6f)); },
            100'000);
        // All numbers around which the path changes.
        for (const float edge : {0.0f, 1.0f, 0x1p22f, 0x1p23f, 0x1p24f, 0x1p31f, 0x1p32f, FLT_MIN})
            for (const float sign : {1.0f, -1.0f})
                for (int ulps = -3; ulps <= 3; ++ulps) {
                    float x = edge;
                    for (int u = 0; u < std::abs(ulps); ++u)
                        x = std::nextafter(x, ulps < 0 ? -FLT_MAX : FLT_MAX);
                    x *= sign;
                    ASSERT_TRUE(
                        has_in_lanes(floor(Floats<N>(x)), [&](int) { return std::floor(x); }))
                        << "floor of " << shown(x) << " in all lanes";
                }
    });
}

TEST(Simd, HardCase_EachOperatorHasTheBitsOfFloat) {
    look_up("Eq. 14.1");
    for_each_width([]<int N>() {
        compare<N>("a + b", [](auto a, auto b) { return a + b; });
        compare<N>("a - b", [](auto a, auto b) { return a - b; });
        compare<N>("a * b", [](auto a, auto b) { return a * b; });
        compare<N>("a / b", [](auto a, auto b) { return a / b; });
        compare<N>("-a", [](auto a, auto) { return -a; });
        compare<N>("a += b", [](auto a, auto b) { return a += b, a; });
        compare<N>("a -= b", [](auto a, auto b) { return a -= b, a; });
        compare<N>("a *= b", [](auto a, auto b) { return a *= b, a; });
        compare<N>("a < b", [](auto a, auto b) { return a < b; });
        compare<N>("a > b", [](auto a, auto b) { return a > b; });
        compare<N>("a <= b", [](auto a, auto b) { return a <= b; });
        compare<N>("a >= b", [](auto a, auto b) { return a >= b; });
        compare<N>("a == b", [](auto a, auto b) { return a == b; });
        compare<N>("a == a", [](auto a, auto) { return a == a; });
        compare<N>("(a < b) & (b > a + a)", [](auto a, auto b) { return (a < b) & (b > a + a); });
        compare<N>("(a < b) | (b > a + a)", [](auto a, auto b) { return (a < b) | (b > a + a); });
        compare<N>("!(a < b)", [](auto a, auto b) { return !(a < b); });
        compare<N>("a * 3.1 + b: a fused multiply-add rounds once less",
                   [](auto a, auto b) { return a * decltype(a)(3.1f) + b; });
        for (const float x : {0.0f, -0.0f, 1.5f, not_a_number, FLT_TRUE_MIN, FLT_MAX, -infinity})
            ASSERT_TRUE(has_in_lanes(Floats<N>(x), [&](int) { return x; }))
                << "the broadcast of " << rasterbook::test::in_words(x);
        Floats<N> floats(0.0f);
        for (int i = 0; i < N; ++i) floats.set(i, 0.5f * static_cast<float>(i));
        for (int i = 0; i < N; ++i) {
            EXPECT_EQ(floats[i], 0.5f * static_cast<float>(i)) << "lane " << i << ", as it was set";
            EXPECT_EQ(lane_of(floats, i), floats[i]) << "lane_of(), lane " << i;
        }
    });
}

TEST(Simd, HardCase_TheFunctionsOfAllLessonsHaveTheBitsOfFloat) {
    look_up("Eq. 14.1");
    // Those of which lighting is made, and float_parts() and two_to_the() with them.
    for_each_width([]<int N>() {
        constexpr int many = 100'000;
        compare<N>("min(a, b)", [](auto a, auto b) { return rasterbook::min(a, b); });
        compare<N>("max(a, b)", [](auto a, auto b) { return rasterbook::max(a, b); });
        compare<N>("sqrt(a)", [](auto a, auto) { return rasterbook::sqrt(a); }, many);
        compare<N>("log2(a)", [](auto a, auto) { return rasterbook::log2(a); }, many);
        compare<N>("exp2(a)", [](auto a, auto) { return rasterbook::exp2(a); }, many);
        compare<N>(
            "exp2(40 a)", [](auto a, auto) { return rasterbook::exp2(decltype(a)(40.0f) * a); },
            many);
        compare<N>(
            "power(|a| up to 1, |40 b| up to 100)",
            [](auto a, auto b) {
                using F = decltype(a);
                const F x = clamp(rasterbook::max(a, -a), F(0.0f), F(1.0f));
                return power(x, clamp(F(40.0f) * rasterbook::max(b, -b), F(0.0f), F(100.0f)));
            },
            many);
    });
}

TEST(Simd, HardCase_WholeNumbersAndDoubles) {
    look_up("Eq. 14.1");
    for_each_width([]<int N>() {
        Dice dice(N + 100);
        for (int k = 0; k < 4000; ++k) {
            PerLane<int, N> a, b;
            const int reach = k % 2 ? 30'000 : 2;  // the product of two fits
            for (auto* const numbers : {&a, &b})
                for (int& x : *numbers)
                    x = static_cast<int>(dice.below(2u * unsigned(reach) + 1)) - reach;
            if (dice.one_in(3))
                a.at(dice.below(N)) = dice.one_in(2) ? INT32_MAX / 2 : -INT32_MAX / 2;
            Ints<N> wide_a(0), wide_b(7);
            for (int i = 0; i < N; ++i) wide_a.set(i, a[i]), wide_b.set(i, b[i]);
            const auto expect = [&](const char* what, const auto& actual, const auto& function) {
                ASSERT_TRUE(has_in_lanes(actual, [&](int i) { return function(a[i], b[i]); }))
                    << what << " of a = " << list_of(a) << ", b = " << list_of(b);
            };
            expect("a + b", wide_a + wide_b, std::plus());
            expect("a - b", wide_a - wide_b, std::minus());
            expect("b * b", wide_b * wide_b, [](int, int y) { return y * y; });
            expect("a < b", wide_a < wide_b, std::less());
            expect("a == b", wide_a == wide_b, std::equal_to());
            expect("select(a < b, a, b)", select(wide_a < wide_b, wide_a, wide_b),
                   [](int x, int y) { return std::min(x, y); });
            expect("a as floats", to_floats(wide_a), [](int x, int) { return float(x); });
            const Doubles<N> exact_a(wide_a), exact_b(wide_b);
            expect("a + b in doubles, as floats", to_floats(exact_a + exact_b),
                   [](double x, double y) { return float(x + y); });
            expect("a * b in doubles, as floats", to_floats(exact_a * exact_b),
                   [](double x, double y) { return float(x * y); });
            ASSERT_EQ(least_of(wide_a), *std::ranges::min_element(a)) << "of " << list_of(a);
            ASSERT_EQ(greatest_of(wide_a), *std::ranges::max_element(a)) << "of " << list_of(a);
        }
    });
}

TEST(Simd, HardCase_MasksAreAskedInEachLane) {
    look_up("Eq. 14.1");
    for_each_width([]<int N>() {
        Dice dice(N);
        constexpr std::uint32_t all = (1u << N) - 1;
        for (int k = 0; k < 4000; ++k) {
            const std::uint32_t one = 1u << dice.below(N);
            const std::array some = {dice.below(all + 1), one, all, all ^ one, 0u};
            const std::uint32_t holds = some.at(dice.below(5));
            const auto mask = mask_of_bits<N>(holds);
            const std::string bits = "a mask with the bits " + std::to_string(holds);
            ASSERT_EQ(bits_of(mask), holds) << bits;
            ASSERT_EQ(any_of(mask), holds != 0) << "any_of() of " << bits;
            ASSERT_EQ(all_of(mask), holds == all) << "all_of() of " << bits;
            ASSERT_EQ(count_of(mask), std::popcount(holds)) << "count_of() of " << bits;
            if (holds) {
                ASSERT_EQ(first_of(mask), std::countr_zero(holds)) << "first_of() of " << bits;
            }
            for (int i = 0; i < N; ++i)
                ASSERT_EQ(lane_of(mask, i), holds >> i & 1) << "lane " << i << " of " << bits;
        }
        for (int count = -1; count <= N + 2; ++count)
            EXPECT_TRUE(
                has_in_lanes(first_lanes<Floats<N>>(count), [&](int i) { return i < count; }))
                << "the first " << count << " lanes";
    });
    for (int count = -1; count <= 3; ++count)
        EXPECT_EQ(first_lanes<float>(count), count > 0) << "of one lane, the first " << count;
}

TEST(Simd, Eq14_2_EdgeFunctionsOfTheWorkedExample) {
    const ScreenTriangle triangle = snap_triangle({0, 0}, {0, 4}, {8, 0});
    const auto [a, b, c] = triangle.vertices;
    const ivec2 first(4, 1);
    const std::array<EdgeWalk, 3> edges{EdgeWalk(b, c, 1, first), EdgeWalk(c, a, 1, first),
                                        EdgeWalk(a, b, 1, first)};
    constexpr std::array<PerLane<int, 4>, 3> expected = {
        {{2, -2, -6, -10}, {12, 12, 12, 12}, {18, 22, 26, 30}}};
    constexpr std::array next = {-16, 0, 16};
    const auto check = [&](auto whole) {
        WideEdges<decltype(whole)> wide(edges, 0);
        const WideEdges<decltype(whole)> from_column_4(edges, 4);
        for (std::size_t i = 0; i < 3; ++i)
            for (int l = 0; l < 4; ++l) {
                EXPECT_EQ(wide.at[i][l] / 65536.0, expected.at(i)[l])
                    << "edge function " << i << " at the pixel (" << 4 + l
                    << ", 1), in square pixels";
                EXPECT_EQ(wide.to_next_pixels[i][l] / 65536.0, next.at(i))
                    << "what is added to edge function " << i << " for the next four pixels";
                EXPECT_EQ(from_column_4.at[i][l] / 65536.0, expected.at(i)[l] + next.at(i))
                    << "edge function " << i << ", begun four pixels to the right";
            }
    };
    check(Ints<4>{}), check(Doubles<4>{});
    int vectors = 0;
    fill_triangle<Floats<4>>(triangle, first, {7, 1},
                             [&](ivec2 pixel, Mask<4> covered, const Vec3<Floats<4>>& at) {
                                 ++vectors;
                                 EXPECT_EQ(pixel, first);
                                 EXPECT_TRUE(has_in_lanes(covered, [](int i) { return i == 0; }))
                                     << "the mask of the pixels (4, 1) to (7, 1)";
                                 EXPECT_EQ(lane_of(at, 0), vec3(2, 12, 18) / 32.0f)
                                     << "barycentric coordinates of the pixel (4, 1)";
                             });
    EXPECT_EQ(vectors, 1) << "vectors of a row of four pixels";
}

TEST(Simd, Eq14_2_TrianglesHaveLesson02sPixelsAndBits) {
    for_each_number_type([]<typename F>(F) {
        Dice dice(width_of<F>);
        int small = 0, large = 0;
        for (int k = 0; k < 8000; ++k) {
            std::array<vec2, 3> v = any_triangle(dice);
            ivec2 first(0), last(299);
            if (k % 8 == 0) {
                // Up to 2^17 pixels from the origin, the doubles are exact. Around an edge.
                for (vec2& vertex : v) {
                    vertex = 131071.0f * vec2(dice.in_cube(1));
                    if (dice.one_in(4)) vertex = glm::sign(vertex) * 131071.0f;
                    if (dice.one_in(4)) vertex = glm::floor(vertex / 256.0f) + 0.5f;
                }
                const vec2 on_edge = glm::mix(v[0], v[1], dice.between(0, 1));
                first = glm::clamp(ivec2(on_edge) - ivec2(20, 3), 0, 131000);
                last = first + ivec2(40, 6);
            } else if (dice.one_in(2)) {
                // A part of the picture: its first and last columns cut vectors anywhere.
                const vec2 inside = (v[0] + v[1] + v[2]) / 3.0f;
                first = glm::clamp(ivec2(inside) - ivec2(dice.below(20), dice.below(20)), 0, 290);
                last = first + ivec2(dice.below(40), dice.below(30)) - 1;  // some have no pixel
            }
            const ScreenTriangle triangle = snap_triangle(v[0], v[1], v[2]);
            ASSERT_TRUE(fills_as_lesson_02<F>(triangle, first, last))
                << "in " << width_of<F> << " lanes, the triangle " << in_words(v) << " in pixels "
                << testing::PrintToString(first) << " to " << testing::PrintToString(last)
                << " (case " << k << ")";
            const PixelBox box = box_around(triangle);
            const ivec2 size = box.last - box.first;
            (std::max(size.x, size.y) < 98 ? small : large) += triangle.twice_area != 0;
        }
        EXPECT_GT(std::min(small, large), 1000) << "triangles of less than 100 pixels, and others";
    });
}

TEST(Simd, Eq14_2_HardCase_TheLargestTrianglesOf32BitsDoNotOverflow) {
    // Less than 100 pixels wide and high, with the vectors behind the box's last column.
    Dice dice(5);
    constexpr int side = pixels_in_32_bits * subpixels - 1;
    for (int k = 0; k < 3000; ++k) {
        std::array<ivec2, 3> v;
        const ivec2 offset(dice.below(256), dice.below(256));
        for (ivec2& vertex : v) {
            const int on_border = static_cast<int>(dice.below(2)) * side;
            vertex = offset + ivec2(k % 2 ? on_border : static_cast<int>(dice.below(side + 1)),
                                    static_cast<int>(dice.below(2)) * side);
        }
        const ScreenTriangle triangle{v, edge_function(v[0], v[1], v[2])};
        // From any first column on: a tile may begin there.
        for (const int column : {0, static_cast<int>(dice.below(99))})
            ASSERT_TRUE(fills_as_lesson_02<Floats<16>>(triangle, {column, 0}, {120, 120}))
                << "a triangle as large as 32 bits hold (" << k << ")";
    }
    constexpr std::int64_t pixels = pixels_in_32_bits;
    EXPECT_LT(pixels * 256 * (pixels + 31 + pixels) * 256, std::int64_t{1} << 31)
        << "the bound of Robust, \"32 bits or 53\"";
}

TEST(Simd, Eq14_2_ARowOfALargeTriangleBeginsAndEndsWithItsPixels) {
    for_each_width([]<int N>() {
        Dice dice(N);
        for (int k = 0; k < 300; ++k) {
            std::array<vec2, 3> v;
            for (vec2& vertex : v) vertex = 300.0f * (vec2(dice.in_cube(1)) + 1.0f);
            const ScreenTriangle triangle = snap_triangle(v[0], v[1], v[2]);
            const PixelBox box = box_around(triangle);
            if (std::max(box.last.x - box.first.x, box.last.y - box.first.y) < 100) continue;
            std::vector<int> pixels(601), vectors(601);
            fill_triangle(triangle, ivec2(0), ivec2(600), [&](ivec2 pixel, Barycentrics) {
                ++pixels.at(static_cast<std::size_t>(pixel.y));
            });
            fill_triangle<Floats<N>>(triangle, ivec2(0), ivec2(600), [&](ivec2 pixel, auto...) {
                ++vectors.at(static_cast<std::size_t>(pixel.y));
            });
            for (std::size_t y = 0; y < pixels.size(); ++y)
                ASSERT_EQ(vectors[y], (pixels[y] + N - 1) / N)
                    << "vectors of " << N << " for the " << pixels[y] << " pixels in row " << y
                    << " of the triangle " << in_words(v);
        }
    });
}

TEST(Simd, Eq14_2_HardCase_ATileThatAnEdgeTouchesInOnePixelIsFilled) {
    // The centre of the pixel (127, 127) is on the left edge: the only one of the tile.
    const ScreenTriangle triangle = snap_triangle({255, 0}, {0, 255}, {255, 255});
    for_each_width([&]<int N>() {
        int pixels = 0;
        fill_triangle<Floats<N>>(
            triangle, ivec2(64), ivec2(127),
            [&](ivec2, Mask<N> covered, const auto&) { pixels += count_of(covered); });
        EXPECT_EQ(pixels, 1) << "in " << N << " lanes";
    });
}

TEST(Simd, Eq14_2_TileDepthsAreADepthBuffers) {
    for_each_number_type([]<typename F>(F) {
        constexpr int N = width_of<F>;
        Dice dice(N);
        std::size_t nearer = 0;
        for (int k = 0; k < 600; ++k) {
            const ivec2 first(dice.below(9), dice.below(9)),
                size(1 + dice.below(40), 1 + dice.below(6));
            const Tile tile{{first, first + size - 1}, 1 + k % 2};
            TileDepths depths(tile);
            DepthBuffer expected(first + size);
            for (int i = 0; i < 60; ++i) {
                const int row = static_cast<int>(dice.below(6)) % size.y / tile.row_step;
                const ivec2 pixel =
                    first + ivec2(static_cast<int>(dice.below(40)) % size.x, row * tile.row_step);
                PerLane<float, N> at;
                for (float& x : at)
                    x = dice.one_in(8) ? any_float(dice) : 0.125f * float(dice.below(10));
                // What lies beyond the tile may be covered, too: no pixel must change by it.
                const std::uint32_t bits = dice.below(1u << N);
                MaskOf<F> covered;
                if constexpr (N == 1)
                    covered = bits != 0;
                else
                    covered = mask_of_bits<N>(bits);
                const auto written = depths.test_and_write<F>(pixel, covered, load<F>(at.data()));
                for (int l = 0; l < N && pixel.x + l <= tile.box.last.x; ++l) {
                    const bool is_nearer =
                        (bits >> l & 1) && expected.test_and_write(pixel + ivec2(l, 0), at[l]);
                    ASSERT_EQ(lane_of(written, l), is_nearer)
                        << "whether the depth " << at[l] << " is written, in lane " << l << " of "
                        << N << " from " << testing::PrintToString(pixel) << " on (" << k << ")";
                    nearer += is_nearer;
                }
            }
            for (ivec2 p = first; p.y <= tile.box.last.y; p.y += tile.row_step)
                for (p.x = first.x; p.x <= tile.box.last.x; ++p.x)
                    ASSERT_EQ(*depths.from(p), expected.depths()[p])
                        << "the depth at " << testing::PrintToString(p) << ", " << N << " lanes ("
                        << k << ")";
        }
        EXPECT_GT(nearer, 1000u);
    });
}

TEST(Simd, Eq14_4_BatchesOfTheWorkedExample) {
    const auto used = [](std::uint64_t n, std::uint64_t lanes) {
        return static_cast<double>(n) / static_cast<double>(lanes * ((n + lanes - 1) / lanes));
    };
    EXPECT_EQ(used(20, 16), 0.625);
    EXPECT_EQ(used(20, 4), 1.0);
    // Two unlit triangles over all of a picture, with colours at their vertices.
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].illumination = 0;
    scene.meshes = {
        mesh_of({{-1, 1, 0}, {-1, -3, 0}, {3, 1, 0}, {-1, 1, 0}, {-1, -3, 0}, {3, 1, 0}},
                {{0, 1, 2}, {3, 4, 5}})};
    Dice dice(1);
    for (int v = 0; v < 6; ++v) scene.meshes[0].colors.emplace_back(dice.color(), 1);
    const PlannedScene assets = load_planned_scene(scene, EffectsOptions());
    const Mesh& mesh = assets.scene.meshes[0];
    const ivec2 size(20, 20);
    ThreadPool pool(1);
    const ShadowMapsOnDemand maps(pool, 32, ShadowOptions{}, {assets.scene, ShadowBounds(), {}});
    Image<vec3> expected(size), actual(size);
    DepthBuffer depth(size);
    const auto frame = [&](Image<vec3>& color) {
        return Frame<ShadowMapsOnDemand>{assets, Filter::nearest, vec3(0), maps, color, depth};
    };
    // 20 pixels in rows of 2 to 6: two rows of one triangle, and three of the other.
    const std::array spans = {PixelSpan{{2, 0}, 2}, PixelSpan{{1, 1}, 3}, PixelSpan{{1, 2}, 4},
                              PixelSpan{{0, 3}, 5}, PixelSpan{{0, 4}, 6}};
    std::vector<ProjectedTriangle> projected;
    for (const Triangle& triangle : mesh.triangles) {
        ClippedTriangle clipped;
        for (std::size_t v = 0; v < 3; ++v)
            clipped.at(v) = {static_cast<float>(1 + v) * vec4(mesh.positions[v], 1),
                             mat3(1)[static_cast<int>(v)]};
        projected.push_back(project(mesh, triangle, clipped, size));
    }
    const std::array visible = {VisibleTriangle{&projected[0], std::span(spans).first(2)},
                                VisibleTriangle{&projected[1], std::span(spans).subspan(2)}};
    for (const auto& [triangle, some] : visible)
        shade_pixels<Permutation{}>(frame(expected), *triangle, some);
    const CountedSince counters;
    shade_pixels<Permutation{}, Floats<16>>(frame(actual), visible);
    EXPECT_EQ(counters[Counter::fragments_shaded], 20u);
    EXPECT_EQ(fragments_at_once, 4u) << "pixels of the last batch, of 16 lanes";
    EXPECT_TRUE(have_the_same_bits(actual, expected)) << "beside lesson 13's shade_pixels()";
}

TEST(Simd, Eq14_5_StepsOfTheWorkedExample) {
    // A row of 144 pixels, and 16 steps that nothing divides: with one lane, 0.9 of 160 steps.
    const ScreenTriangle triangle = snap_triangle({0, 0}, {0, 2}, {500, 0});
    const auto steps_of = [&]<typename F>(F) {
        int steps = 16;
        fill_triangle<F>(triangle, {0, 0}, {143, 0}, [&](auto&&...) { ++steps; });
        return steps;
    };
    const auto speed_up = [](double p, double lanes) { return 1 / ((1 - p) + p / lanes); };
    const int steps = steps_of(1.0f);
    EXPECT_EQ(steps, 160) << "steps with one lane";
    EXPECT_NEAR(static_cast<double>(steps) / steps_of(Floats<16>()), speed_up(0.9, 16), 1e-12)
        << "how much fewer steps 16 lanes take";
    EXPECT_NEAR(static_cast<double>(steps) / steps_of(Floats<4>()), speed_up(0.9, 4), 1e-12)
        << "how much fewer steps 4 lanes take";
    EXPECT_NEAR(speed_up(0.9, 16), 6.4, 1e-12);
    EXPECT_NEAR(speed_up(0.9, 4), 3.08, 0.005);
    EXPECT_NEAR(speed_up(0.9, 1e9), 10, 1e-6);
}
