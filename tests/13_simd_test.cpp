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
#include <limits>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "03_z_buffer/depth_buffer.hpp"
#include "10_threading/thread_pool.hpp"
#include "11_scenes/scene_assets.hpp"
#include "11_scenes/scene_options.hpp"
#include "12_visibility_buffer/visible_shading.hpp"
#include "13_simd/simd.hpp"
#include "13_simd/wide_shading.hpp"
#include "13_simd/wide_triangles.hpp"
#include "support/any_scene.hpp"
#include "support/first_difference.hpp"
#include "support/lanes.hpp"
#include "support/look_up.hpp"
#include "support/name_of_split.hpp"
#include "support/pictures.hpp"
#include "support/printers.hpp"
#include "support/projected.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr int random_numbers = 100'000;
constexpr float nan_ = std::numeric_limits<float>::quiet_NaN();

/// Apart from compare(), which is compiled for each function and width.
void expect_success(const testing::AssertionResult& result, const char* name,
                    std::span<const float> a, std::span<const float> b) {
    EXPECT_TRUE(result) << name << " of a = " << list_of(a) << " and b = " << list_of(b);
}

/// Compares a function of two wide numbers with the same one of plain numbers.
template <int N, typename Function>
void compare(const char* name, const Function& function, std::uint32_t seed, int numbers = 20'000) {
    Dice dice(seed);
    for (int k = 0; k < numbers / N; ++k) {
        const auto a = any_numbers<N>(dice), b = any_numbers<N>(dice);
        const testing::AssertionResult result = has_in_lanes(
            function(in_lanes<N>(a), in_lanes<N>(b)),
            [&](int i) { return function(a.at(std::size_t(i)), b.at(std::size_t(i))); });
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
        if (i >= actual.size())
            return testing::AssertionFailure()
                   << "the pixel " << testing::PrintToString(expected[i].pixel)
                   << " is covered, and was not visited";
        if (i >= expected.size() || (actual[i].pixel != expected[i].pixel))
            return testing::AssertionFailure()
                   << "visited: " << testing::PrintToString(actual[i].pixel) << ", expected: "
                   << (i < expected.size() ? testing::PrintToString(expected[i].pixel)
                                           : "no other pixel");
        if (!(actual[i] == expected[i]))
            return testing::AssertionFailure()
                   << "barycentric coordinates of " << testing::PrintToString(actual[i].pixel)
                   << ": " << shown(actual[i].at) << ", expected " << shown(expected[i].at);
    }
    return testing::AssertionSuccess();
}

template <typename F, typename Fill>
std::vector<Filled> pixels_of(const Fill& fill) {
    std::vector<Filled> pixels;
    fill([&](ivec2 first, MaskOf<F> covered, const Vec3<F>& at) {
        for (int i = 0; i < width_of<F>; ++i)
            if (lane_of(covered, i))
                pixels.push_back(
                    {first + ivec2(i, 0), {lane_of(at.x, i), lane_of(at.y, i), lane_of(at.z, i)}});
    });
    return pixels;
}

template <typename F>
testing::AssertionResult fills_as_lesson_02(const ScreenTriangle& triangle, ivec2 first,
                                            ivec2 last) {
    std::vector<Filled> expected;
    fill_triangle(triangle, first, last,
                  [&](ivec2 pixel, Barycentrics at) { expected.push_back({pixel, at}); });
    return are_the_same(
        pixels_of<F>([&](auto&& emit) { fill_triangle<F>(triangle, first, last, emit); }),
        expected);
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

/// An unlit material whose colour comes from vertex colours, and a triangle of it.
struct ColoredTriangles {
    static constexpr std::uint32_t count = 3;
    SceneAssets assets;

    static Scene scene() {
        Scene scene;
        scene.materials.resize(1);
        scene.materials[0].illumination = 0;
        Mesh mesh;
        mesh.colors = {{1, 0.1f, 0.2f, 1},    {0.3f, 0.7f, 0, 1}, {0, 0.2f, 0.9f, 1},
                       {0.4f, 0.4f, 0.1f, 1}, {0, 1, 0.3f, 1},    {0.7f, 0, 0.5f, 1},
                       {0.9f, 0.8f, 0.6f, 1}, {0.1f, 0, 0, 1},    {0.5f, 1, 1, 1}};
        for (std::uint32_t i = 0; i < count; ++i) {
            mesh.positions.insert(mesh.positions.end(), {{-1, 1, 0}, {-1, -3, 0}, {3, 1, 0}});
            mesh.triangles.push_back({{Vertex{3 * i}, Vertex{3 * i + 1}, Vertex{3 * i + 2}}, 0});
        }
        for (const vec3 p : mesh.positions) mesh.bounds.add(p);
        scene.meshes.push_back(mesh);
        return scene;
    }
    ColoredTriangles() : assets(make_scene_assets(scene(), SceneRendererOptions())) {}

    ProjectedTriangle projected(ivec2 size, std::size_t number) const {
        const Mesh& mesh = assets.scene.meshes[0];
        const auto vertex = [&](std::size_t i) {
            const vec3 p = mesh.positions[3 * number + i];
            vec3 at(0);
            at[static_cast<int>(i)] = 1;
            return ClippedVertex{vec4(p, 1) * (1.0f + static_cast<float>((i + number) % 3)), at};
        };
        return project(mesh, mesh.triangles[number], {vertex(0), vertex(1), vertex(2)}, size);
    }
};

}  // namespace

TEST(Simd, Eq13_1_SelectOfTheWorkedExample) {
    const Floats<4> a = in_lanes<4>({3, 1, 4, 1}), b = in_lanes<4>({2, 7, 1, 8});
    constexpr std::array holds = {false, true, false, true};
    constexpr std::array expected = {2.0f, 1.0f, 1.0f, 1.0f};
    EXPECT_TRUE(has_in_lanes(a < b, [&](int i) { return holds.at(std::size_t(i)); }))
        << "the mask of (3, 1, 4, 1) < (2, 7, 1, 8)";
    EXPECT_TRUE(has_in_lanes(select(a < b, a, b), [&](int i) {
        return expected.at(std::size_t(i));
    })) << "select(a < b, a, b) of a = (3, 1, 4, 1), b = (2, 7, 1, 8)";
}

TEST(Simd, Eq13_1_SelectTakesTheBitsOfEachLane) {
    for_each_width([]<int N>() {
        Dice dice(N);
        for (int k = 0; k < 20'000 / N; ++k) {
            const auto a = any_numbers<N>(dice), b = any_numbers<N>(dice);
            const auto bits = dice.below(1u << N);
            const auto mask = mask_of_bits<N>(bits);
            const Floats<N> actual = select(mask, in_lanes<N>(a), in_lanes<N>(b));
            for (int i = 0; i < N; ++i)
                ASSERT_EQ(std::bit_cast<std::uint32_t>(actual[i]),
                          std::bit_cast<std::uint32_t>((bits >> i & 1 ? a : b).at(std::size_t(i))))
                    << "bits of lane " << i << " of select(m, a, b), where m "
                    << (bits >> i & 1 ? "holds" : "does not hold") << "; a = " << list_of(a)
                    << ", b = " << list_of(b);
            const Ints<N> numbers = lane_numbers<N>(), others(-7);
            ASSERT_TRUE(has_in_lanes(select(mask, numbers, others),
                                     [&](int i) { return bits >> i & 1 ? i : -7; }))
                << "select() of whole numbers, mask bits " << bits;
        }
    });
}

TEST(Simd, Eq13_1_SelectOfVectorsWiderThanARegister) {
    // By AND and OR, on each machine: no register holds 32 floats.
    constexpr int N = 32;
    static_assert(N > native_width);
    Dice dice(N);
    for (int k = 0; k < 500; ++k) {
        const auto a = any_numbers<N>(dice), b = any_numbers<N>(dice);
        const std::uint32_t bits = dice.below(0xffffffffu);
        const auto mask = mask_of_bits<N>(bits);
        const Floats<N> actual = select(mask, in_lanes<N>(a), in_lanes<N>(b));
        for (int i = 0; i < N; ++i)
            ASSERT_EQ(std::bit_cast<std::uint32_t>(actual[i]),
                      std::bit_cast<std::uint32_t>((bits >> i & 1 ? a : b).at(std::size_t(i))))
                << "bits of lane " << i << " of 32 of select(m, a, b), where m "
                << (bits >> i & 1 ? "holds" : "does not hold") << "; a = " << list_of(a)
                << ", b = " << list_of(b);
    }
}

TEST(Simd, Eq13_3_FloorOfTheWorkedExample) {
    const Floats<4> x = in_lanes<4>({-1.5f, 1.5f, -2, 2});
    constexpr std::array truncations = {-1, 1, -2, 2};
    constexpr std::array floors = {-2.0f, 1.0f, -2.0f, 2.0f};
    EXPECT_TRUE(has_in_lanes(truncated(x), [&](int i) { return truncations.at(std::size_t(i)); }))
        << "-1.5, 1.5, -2 and 2 rounded towards 0";
    EXPECT_TRUE(has_in_lanes(floor(x), [&](int i) { return floors.at(std::size_t(i)); }))
        << "-1.5, 1.5, -2 and 2 rounded down";
}

TEST(Simd, Eq13_3_FloorHasTheBitsOfStdFloor) {
    for_each_width([]<int N>() {
        compare<N>(
            "floor(a), or floor(1,000,000 b)",
            [](auto a, auto b) {
                using F = decltype(a);
                const F scaled = b * F(1e6f);
                return select(floor(a) == a, floor(a), floor(scaled));
            },
            1, random_numbers);
        compare<N>("floor(a)", [](auto a, auto) { return floor(a); }, 2, random_numbers);
    });
    // All numbers around which the path changes, alone among others.
    for_each_width([]<int N>() {
        for (const float edge : {0.0f, 1.0f, 0x1p22f, 0x1p23f, 0x1p24f, 0x1p31f, 0x1p32f, FLT_MIN})
            for (const float sign : {1.0f, -1.0f})
                for (int ulps = -3; ulps <= 3; ++ulps) {
                    float x = edge;
                    for (int u = 0; u < std::abs(ulps); ++u)
                        x = std::nextafter(x, ulps < 0 ? -FLT_MAX : FLT_MAX);
                    x *= sign;
                    for (int lane = 0; lane < N; ++lane) {
                        NumbersOfLanes<N> numbers;
                        numbers.fill(-2.25f);
                        numbers.at(std::size_t(lane)) = x;
                        ASSERT_TRUE(has_in_lanes(
                            floor(in_lanes<N>(numbers)),
                            [&](int i) { return std::floor(numbers.at(std::size_t(i))); }))
                            << "floor of " << list_of(numbers);
                    }
                }
    });
}

TEST(Simd, HardCase_EachOperatorHasTheBitsOfFloat) {
    look_up("Eq. 13.1");
    for_each_width([]<int N>() {
        compare<N>("a + b", [](auto a, auto b) { return a + b; }, 1);
        compare<N>("a - b", [](auto a, auto b) { return a - b; }, 2);
        compare<N>("a * b", [](auto a, auto b) { return a * b; }, 3);
        compare<N>("a / b", [](auto a, auto b) { return a / b; }, 4);
        compare<N>("-a", [](auto a, auto) { return -a; }, 5);
        compare<N>("a += b", [](auto a, auto b) { return a += b, a; }, 6);
        compare<N>("a -= b", [](auto a, auto b) { return a -= b, a; }, 7);
        compare<N>("a *= b", [](auto a, auto b) { return a *= b, a; }, 8);
        compare<N>("a < b", [](auto a, auto b) { return a < b; }, 9);
        compare<N>("a > b", [](auto a, auto b) { return a > b; }, 10);
        compare<N>("a <= b", [](auto a, auto b) { return a <= b; }, 11);
        compare<N>("a >= b", [](auto a, auto b) { return a >= b; }, 12);
        compare<N>("a == b", [](auto a, auto b) { return a == b; }, 13);
        compare<N>("a == a", [](auto a, auto) { return a == a; }, 14);
        compare<N>(
            "(a < b) & (b > 1)", [](auto a, auto b) { return (a < b) & (b > decltype(b)(1.0f)); },
            15);
        compare<N>(
            "(a < b) | (b > 1)", [](auto a, auto b) { return (a < b) | (b > decltype(b)(1.0f)); },
            16);
        compare<N>("!(a < b)", [](auto a, auto b) { return !(a < b); }, 17);
        compare<N>("min(a, b)", [](auto a, auto b) { return rasterbook::min(a, b); }, 18);
        compare<N>("max(a, b)", [](auto a, auto b) { return rasterbook::max(a, b); }, 19);
        compare<N>(
            "clamp(a, -1, b)", [](auto a, auto b) { return clamp(a, decltype(a)(-1.0f), b); }, 20);
        compare<N>(
            "a * 3 + b: a fused multiply-add rounds once less",
            [](auto a, auto b) { return a * decltype(a)(3.1f) + b; }, 21);
        for (const float x : {0.0f, -0.0f, 1.5f, nan_, FLT_TRUE_MIN, FLT_MAX,
                              -std::numeric_limits<float>::infinity()})
            ASSERT_TRUE(has_in_lanes(Floats<N>(x), [&](int) { return x; }))
                << "the broadcast of " << rasterbook::test::in_words(x);
        for (const int x : {0, -1, 77, INT32_MAX, INT32_MIN})
            ASSERT_TRUE(has_in_lanes(Ints<N>(x), [&](int) { return x; }))
                << "the broadcast of " << x;
        Floats<N> floats(0.0f);
        Ints<N> ints(0);
        for (int i = 0; i < N; ++i) floats.set(i, 0.5f * static_cast<float>(i)), ints.set(i, 3 - i);
        for (int i = 0; i < N; ++i) {
            EXPECT_EQ(floats[i], 0.5f * static_cast<float>(i)) << "lane " << i << ", as it was set";
            EXPECT_EQ(lane_of(floats, i), floats[i]) << "lane_of(), lane " << i;
            EXPECT_EQ(ints[i], 3 - i) << "lane " << i << ", as it was set";
        }
        EXPECT_EQ(width_of<Floats<N>>, N);
        EXPECT_EQ(Floats<N>::width, N);
    });
    EXPECT_EQ(width_of<float>, 1);
}

TEST(Simd, HardCase_TheFunctionsOfAllLessonsHaveTheBitsOfFloat) {
    look_up("Eq. 13.1");
    for_each_width([]<int N>() {
        compare<N>("sqrt(a)", [](auto a, auto) { return rasterbook::sqrt(a); }, 1, random_numbers);
        compare<N>("exp2(a)", [](auto a, auto) { return rasterbook::exp2(a); }, 2, random_numbers);
        compare<N>(
            "exp2(40 a)", [](auto a, auto) { return rasterbook::exp2(decltype(a)(40.0f) * a); }, 3,
            random_numbers);
        compare<N>("log2(a)", [](auto a, auto) { return rasterbook::log2(a); }, 4, random_numbers);
        compare<N>(
            "power(|a| up to 1, |b| up to 100)",
            [](auto a, auto b) {
                using F = decltype(a);
                const F x = clamp(rasterbook::max(a, -a), F(0.0f), F(1.0f));
                const F y = clamp(F(40.0f) * rasterbook::max(b, -b), F(0.0f), F(100.0f));
                return power(x, y);
            },
            5, random_numbers);
        compare<N>(
            "the mantissa of a, where it has one",
            [](auto a, auto) {
                using F = decltype(a);
                return float_parts(select((a >= F(FLT_MIN)) & (a <= F(FLT_MAX)), a, F(3.0f)))
                    .mantissa;
            },
            6);
        compare<N>(
            "the exponent of a, where it has one",
            [](auto a, auto) {
                using F = decltype(a);
                return float_parts(select((a >= F(FLT_MIN)) & (a <= F(FLT_MAX)), a, F(3.0f)))
                    .exponent;
            },
            7);
        compare<N>(
            "2^n, n the whole part of a",
            [](auto a, auto) {
                using F = decltype(a);
                return two_to_the(clamp(floor(a), F(-126.0f), F(127.0f)));
            },
            8);
    });
}

TEST(Simd, HardCase_DirectionsHaveTheBitsOfFloat) {
    look_up("Eq. 13.1");
    // Very short and very long ones take a detour: in their lane alone.
    for_each_width([]<int N>() {
        Dice dice(N);
        const vec3 fallback(0.25f, -1, -0.0f);
        int detours = 0;
        for (int k = 0; k < random_numbers / N; ++k) {
            std::array<vec3, std::size_t(N)> v;
            for (vec3& of_lane : v) of_lane = dice.in_cube(2);
            const auto special = dice.below(N + 1);  // in one lane, in all, or in none
            for (std::uint32_t i = 0; i < N; ++i) {
                if (i != special && !(special == 0 && k % 2)) continue;
                const float size = std::exp2(dice.between(-149, 127));
                for (int c = 0; c < 3; ++c)
                    v.at(i)[c] = dice.one_in(2) ? any_float(dice) : v.at(i)[c] * size;
                const float squared = glm::dot(v.at(i), v.at(i));
                detours += !(squared > 1e-30f && squared < 1e30f);
            }
            const Vec3<Floats<N>> actual = unit_or(in_lanes<N>(v), Vec3<Floats<N>>(fallback));
            for (int c = 0; c < 3; ++c)
                ASSERT_TRUE(has_in_lanes(
                    actual[c], [&](int i) { return unit_or(v.at(std::size_t(i)), fallback)[c]; }))
                    << "component " << c << " of unit_or() of " << testing::PrintToString(v)
                    << "; one direction must not decide for another";
        }
        EXPECT_GT(detours, 2000 / N) << "directions that are very short or long";
    });
}

TEST(Simd, HardCase_WholeNumbersAndMasks) {
    look_up("Eq. 13.1");
    for_each_width([]<int N>() {
        Dice dice(N + 100);
        for (int k = 0; k < 4000; ++k) {
            std::array<int, std::size_t(N)> a, b;
            const int reach = k % 2 ? 30'000 : 2;  // the product of two fits
            for (int& x : a) x = static_cast<int>(dice.below(2u * unsigned(reach) + 1)) - reach;
            for (int& x : b) x = static_cast<int>(dice.below(2u * unsigned(reach) + 1)) - reach;
            if (dice.one_in(3))
                a.at(dice.below(N)) = dice.one_in(2) ? INT32_MAX / 2 : -INT32_MAX / 2;
            Ints<N> wide_a(0), wide_b(0);
            for (int i = 0; i < N; ++i)
                wide_a.set(i, a.at(std::size_t(i))), wide_b.set(i, b.at(std::size_t(i)));
            const std::string of = " of a = " + list_of(a) + ", b = " + list_of(b);
            const auto each = [&](auto&& function) {
                return [&, function](int i) {
                    return function(a.at(std::size_t(i)), b.at(std::size_t(i)));
                };
            };
            ASSERT_TRUE(has_in_lanes(wide_a + wide_b, each([](int x, int y) { return x + y; })))
                << "a + b" << of;
            ASSERT_TRUE(has_in_lanes(wide_a - wide_b, each([](int x, int y) { return x - y; })))
                << "a - b" << of;
            ASSERT_TRUE(has_in_lanes(wide_b * wide_b, each([](int, int y) { return y * y; })))
                << "b * b" << of;
            ASSERT_TRUE(has_in_lanes(wide_a < wide_b, each([](int x, int y) { return x < y; })))
                << "a < b" << of;
            ASSERT_TRUE(has_in_lanes(wide_a == wide_b, each([](int x, int y) { return x == y; })))
                << "a == b" << of;
            ASSERT_TRUE(has_in_lanes(rasterbook::min(wide_a, wide_b),
                                     each([](int x, int y) { return std::min(x, y); })))
                << "min(a, b)" << of;
            ASSERT_TRUE(has_in_lanes(to_floats(wide_a),
                                     each([](int x, int) { return static_cast<float>(x); })))
                << "a as floats" << of;
            const Doubles<N> exact_a(wide_a), exact_b(wide_b);
            ASSERT_TRUE(has_in_lanes(to_floats(exact_a + exact_b),
                                     each([](double x, double y) { return float(x + y); })))
                << "a + b in doubles, as floats" << of;
            ASSERT_TRUE(has_in_lanes(to_floats(exact_a * exact_b),
                                     each([](double x, double y) { return float(x * y); })))
                << "a * b in doubles, as floats" << of;
            ASSERT_EQ(least_of(wide_a), *std::ranges::min_element(a)) << "the least" << of;
            ASSERT_EQ(greatest_of(wide_a), *std::ranges::max_element(a)) << "the greatest" << of;

            std::uint32_t holds = dice.below(1u << N);
            if (dice.one_in(3)) holds = dice.one_in(2) ? 1u << dice.below(N) : (1u << N) - 1;
            if (dice.one_in(8)) holds = 0;
            if (dice.one_in(8)) holds = ((1u << N) - 1) ^ (1u << dice.below(N));
            const auto mask = mask_of_bits<N>(holds);
            const std::string bits = "a mask with the bits " + std::to_string(holds);
            ASSERT_EQ(bits_of(mask), holds) << bits;
            ASSERT_EQ(any_of(mask), holds != 0) << "any_of() of " << bits;
            ASSERT_EQ(all_of(mask), holds == (1u << N) - 1) << "all_of() of " << bits;
            ASSERT_EQ(count_of(mask), std::popcount(holds)) << "count_of() of " << bits;
            if (holds) {
                ASSERT_EQ(first_of(mask), std::countr_zero(holds)) << "first_of() of " << bits;
            }
            for (int i = 0; i < N; ++i) {
                ASSERT_EQ(mask[i], holds >> i & 1) << "lane " << i << " of " << bits;
                ASSERT_EQ(lane_of(mask, i), holds >> i & 1) << "lane " << i << " of " << bits;
            }
        }
        for (int count = -1; count <= N + 2; ++count)
            EXPECT_TRUE(
                has_in_lanes(first_lanes<Floats<N>>(count), [&](int i) { return i < count; }))
                << "the first " << count << " lanes";
        EXPECT_TRUE(has_in_lanes(lane_numbers<N>(), [](int i) { return i; }));
    });
    EXPECT_EQ(bits_of(Mask<4>{{0, -1, -1, 0}}), 6u);
    for (int count = -1; count <= 3; ++count)
        EXPECT_EQ(first_lanes<float>(count), count > 0) << "of one lane, the first " << count;
    EXPECT_EQ(count_of(true), 1);
    EXPECT_EQ(count_of(false), 0);
    EXPECT_TRUE(lane_of(true, 0));
    EXPECT_EQ(lane_of(2.5f, 0), 2.5f);
}

TEST(Simd, HardCase_LanesAreCountedOneByOne) {
    look_up("Eq. 13.1");
    const auto count = []<typename F>(F, std::uint32_t seed, int masks) {
        Dice dice(seed);
        LaneSum<F> sum;
        std::uint64_t expected = 0;
        EXPECT_EQ(sum.total(), 0u) << "before anything is counted";
        for (int k = 0; k < masks; ++k) {
            const int lanes = static_cast<int>(dice.below(width_of<F> + 1));
            const MaskOf<F> mask = first_lanes<F>(lanes);
            sum.add(mask);
            expected += static_cast<std::uint64_t>(lanes);
            if (k % 997 == 0) {
                ASSERT_EQ(sum.total(), expected)
                    << "lanes in which " << k + 1 << " masks of " << width_of<F> << " lanes held";
            }
        }
        ASSERT_EQ(sum.total(), expected)
            << "lanes in which " << masks << " masks of " << width_of<F> << " lanes held";
    };
    count(1.0f, 1, 70'000);
    for_each_width([&]<int N>() { count(Floats<N>(), N, 70'000); });
}

TEST(Simd, HardCase_AFilledRunIsThatAlone) {
    look_up("Eq. 13.2");
    const vec3 before(7), point(-0.0f, 0.25f, nan_);
    const auto fill_all = [&]<typename F>(F) {
        for (int count = 0; count <= 40; ++count) {
            std::array<vec3, 60> points;
            points.fill(before);
            fill<F>(&points[3], count, point);
            for (int i = 0; i < 60; ++i) {
                const vec3& expected = i >= 3 && i < 3 + count ? point : before;
                for (int c = 0; c < 3; ++c)
                    ASSERT_TRUE(agree(points.at(std::size_t(i))[c], expected[c]))
                        << "component " << c << " of point " << i << " of 60, after " << count
                        << " from point 3 on were filled, "
                        << width_of<F> << " at a time: " << points.at(std::size_t(i))[c];
            }
        }
    };
    fill_all(1.0f);
    for_each_width([&]<int N>() { fill_all(Floats<N>()); });
}

TEST(Simd, HardCase_TheFirstOfManyFloatsIsFound) {
    look_up("Eq. 13.2");
    const auto find_all = [&]<typename F>(F) {
        const auto is_one = [](auto x) { return x == decltype(x)(1.0f); };
        for (int place = 0; place < 40; ++place) {
            std::array<float, 60> floats{};
            floats.at(std::size_t(place)) = floats[50] = 1;
            for (int i = 0; i <= 40; ++i)
                for (int end = i; end <= 40; ++end)
                    ASSERT_EQ(first_where<F>(floats.data(), i, end, is_one),
                              place >= i && place < end ? place : end)
                        << "the first 1 of floats " << i << " to " << end - 1 << ", by "
                        << width_of<F> << "; floats " << place << " and 50 are 1, the others 0";
        }
    };
    find_all(1.0f);
    for_each_width([&]<int N>() { find_all(Floats<N>()); });
}

TEST(Simd, HardCase_WhatIsWrittenWhereAMaskHoldsIsThatAlone) {
    look_up("Eq. 13.1");
    for_each_width([]<int N>() {
        Dice dice(N);
        for (int k = 0; k < 300; ++k) {
            std::array<std::uint32_t, 40> ids;
            ids.fill(7);
            std::array<float, 40> floats;
            floats.fill(0.5f);
            const auto at = dice.below(40 - N + 1);  // any address of a float
            const auto holds = dice.below(1u << N);
            const auto mask = mask_of_bits<N>(holds);
            write_where(mask, &ids.at(at), 0xfffffffeu);
            const auto numbers = any_numbers<N>(dice);
            store(&floats.at(at), in_lanes<N>(numbers));
            for (std::uint32_t i = 0; i < 40; ++i) {
                const bool is_inside = i >= at && i < at + N;
                ASSERT_EQ(ids.at(i), is_inside && (holds >> (i - at) & 1) ? 0xfffffffeu : 7u)
                    << "number " << i << " of 40, after " << N << " from number " << at
                    << " on were written where a mask holds with the bits " << holds;
                ASSERT_TRUE(agree(floats.at(i), is_inside ? numbers.at(i - at) : 0.5f))
                    << "float " << i << " of 40, after " << N << " from float " << at
                    << " on were stored";
            }
            ASSERT_TRUE(has_in_lanes(load<Floats<N>>(&floats.at(at)),
                                     [&](int i) { return numbers.at(std::size_t(i)); }))
                << "loaded from float " << at << " on";
        }
    });
    std::uint32_t id = 3;
    write_where(false, &id, 4);
    EXPECT_EQ(id, 3u);
    write_where(true, &id, 4);
    EXPECT_EQ(id, 4u);
    float x = 1;
    store(&x, 2.0f);
    EXPECT_EQ(load<float>(&x), 2.0f);
}

TEST(Simd, Eq13_2_EdgeFunctionsOfTheWorkedExample) {
    const ScreenTriangle triangle = snap_triangle({0, 0}, {0, 4}, {8, 0});
    const auto [a, b, c] = triangle.vertices;
    const ivec2 first(4, 1);
    const std::array<EdgeWalk, 3> edges{EdgeWalk(b, c, 1, first), EdgeWalk(c, a, 1, first),
                                        EdgeWalk(a, b, 1, first)};
    constexpr std::array<std::array<int, 4>, 3> expected = {
        {{2, -2, -6, -10}, {12, 12, 12, 12}, {18, 22, 26, 30}}};
    constexpr std::array next = {-16, 0, 16};
    const auto check = [&](auto whole) {
        using Whole = decltype(whole);
        WideEdges<Whole> wide(edges, 0);
        for (std::size_t i = 0; i < 3; ++i) {
            for (int l = 0; l < 4; ++l) {
                EXPECT_EQ(wide.at[i][l] / 65536.0, expected.at(i).at(static_cast<std::size_t>(l)))
                    << "edge function " << i << " at the pixel (" << 4 + l
                    << ", 1), in square pixels";
                EXPECT_EQ(wide.to_next_pixels[i][l] / 65536.0, next.at(i))
                    << "what is added to edge function " << i << " for the next four pixels";
            }
        }
        wide.advance();
        const WideEdges<Whole> from_column_4(edges, 4);
        for (std::size_t i = 0; i < 3; ++i)
            for (int l = 0; l < 4; ++l) {
                EXPECT_EQ(wide.at[i][l] / 65536.0,
                          expected.at(i).at(static_cast<std::size_t>(l)) + next.at(i))
                    << "edge function " << i << ", four pixels to the right";
                EXPECT_EQ(from_column_4.at[i][l], wide.at[i][l])
                    << "edge function " << i << ", begun four pixels to the right";
            }
    };
    check(Ints<4>{}), check(Doubles<4>{});
    int vectors = 0;
    fill_triangle<Floats<4>>(
        triangle, first, {7, 1}, [&](ivec2 pixel, Mask<4> covered, const Vec3<Floats<4>>& at) {
            ++vectors;
            EXPECT_EQ(pixel, first);
            EXPECT_TRUE(has_in_lanes(covered, [](int i) { return i == 0; }))
                << "the mask of the pixels (4, 1) to (7, 1)";
            EXPECT_EQ((vec3(at.x[0], at.y[0], at.z[0])), vec3(2, 12, 18) / 32.0f)
                << "barycentric coordinates of the pixel (4, 1)";
        });
    EXPECT_EQ(vectors, 1) << "vectors of a row of four pixels";
}

TEST(Simd, Eq13_2_TrianglesHaveLesson02sPixelsAndBits) {
    const auto check = []<typename F>(F, std::uint32_t seed) {
        Dice dice(seed);
        int small = 0, large = 0;
        std::size_t pixels = 0;
        for (int k = 0; k < 7000; ++k) {
            const std::array<vec2, 3> v = any_triangle(dice);
            const ScreenTriangle triangle = snap_triangle(v[0], v[1], v[2]);
            // A part of the picture: its first and last columns cut vectors anywhere.
            ivec2 first(0), last(299);
            if (dice.one_in(2)) {
                const vec2 inside = (v[0] + v[1] + v[2]) / 3.0f;
                first = glm::clamp(ivec2(inside) - ivec2(dice.below(20), dice.below(20)), 0, 290);
                last = first + ivec2(dice.below(40), dice.below(30)) - 1;  // some have no pixel
            }
            ASSERT_TRUE(fills_as_lesson_02<F>(triangle, first, last))
                << "in " << width_of<F> << " lanes, the triangle " << in_words(v) << " in pixels "
                << testing::PrintToString(first) << " to " << testing::PrintToString(last)
                << " (seed " << seed << ", " << k << ")";
            const PixelBox box = box_around(triangle);
            const ivec2 size = box.last - box.first;
            (std::max(size.x, size.y) < 98 ? small : large) += triangle.twice_area != 0;
            fill_triangle(triangle, first, last, [&](ivec2, Barycentrics) { ++pixels; });
        }
        EXPECT_GT(std::min(small, large), 1000) << "triangles of less than 100 pixels, and others";
        EXPECT_GT(pixels, 500'000u);
    };
    check(1.0f, 1), check(Floats<4>(), 2), check(Floats<8>(), 3), check(Floats<16>(), 4);
}

TEST(Simd, Eq13_2_TilesOfAllSplitsHaveLesson10sPixels) {
    for_each_width([]<int N>() {
        Dice dice(N);
        for (int k = 0; k < 500; ++k) {
            const ivec2 size(1 + dice.below(70), 1 + dice.below(50));
            const Split split = splits[std::size_t(k) % 3];
            const Tiling tiling(split, size, 1 + dice.below(5),
                                1 + static_cast<int>(dice.below(30)));
            std::array<vec2, 3> v = any_triangle(dice);
            for (vec2& vertex : v) vertex *= vec2(size) / 300.0f;
            const ScreenTriangle triangle = snap_triangle(v[0], v[1], v[2]);
            for (std::size_t i = 0; i < tiling.count(); ++i) {
                const Tile tile = tiling[i];
                std::vector<Filled> expected;
                fill_tile(triangle, tile,
                          [&](ivec2 pixel, Barycentrics at) { expected.push_back({pixel, at}); });
                ASSERT_TRUE(are_the_same(pixels_of<Floats<N>>([&](auto&& emit) {
                                             fill_tile<Floats<N>>(triangle, tile, emit);
                                         }),
                                         expected))
                    << "in " << N << " lanes, the triangle " << in_words(v) << " in tile " << i
                    << " of " << tiling.count() << ", " << name_of(split) << " of "
                    << testing::PrintToString(size) << " pixels (" << k << ")";
            }
        }
    });
}

TEST(Simd, Eq13_2_HardCase_TheLargestTrianglesOf32BitsDoNotOverflow) {
    // Less than 100 pixels wide and high, with the vectors behind the box's last column: in 64
    // bits, none of these numbers is 2^31 or more.
    std::int64_t greatest = 0;
    Dice dice(5);
    constexpr int side = pixels_in_32_bits * subpixels - 1;
    for (int k = 0; k < 3000; ++k) {
        std::array<ivec2, 3> v;
        for (ivec2& vertex : v)
            vertex = {k % 2 ? static_cast<int>(dice.below(2)) * side
                            : static_cast<int>(dice.below(side + 1)),
                      static_cast<int>(dice.below(2)) * side};
        const ivec2 offset(dice.below(256), dice.below(256));
        for (ivec2& vertex : v) vertex += offset;
        const ScreenTriangle triangle{v, edge_function(v[0], v[1], v[2])};
        if (triangle.twice_area == 0) continue;
        const PixelBox box = box_around(triangle);
        const int winding = triangle.twice_area > 0 ? 1 : -1;
        // From any first column on: a tile may begin there.
        const ivec2 first(box.first.x + static_cast<int>(dice.below(99)), box.first.y);
        for (std::size_t i = 0; i < 3; ++i) {
            const EdgeWalk edge(v.at((i + 1) % 3), v.at((i + 2) % 3), winding, first);
            for (const int x : {0, 15, box.last.x - first.x + 31})
                for (const int y : {0, box.last.y - first.y})
                    greatest = std::max(greatest,
                                        std::abs(edge.value + x * edge.step_x + y * edge.step_y));
        }
        ASSERT_TRUE(fills_as_lesson_02<Floats<16>>(triangle, {0, 0}, {120, 120}))
            << "a triangle as large as 32 bits hold (" << k << ")";
        ASSERT_TRUE(fills_as_lesson_02<Floats<16>>(triangle, first, {120, 120}))
            << "a triangle as large as 32 bits hold (" << k << ")";
        // The same in doubles.
        const std::array<EdgeWalk, 3> edges{EdgeWalk(v[1], v[2], winding, box.first),
                                            EdgeWalk(v[2], v[0], winding, box.first),
                                            EdgeWalk(v[0], v[1], winding, box.first)};
        const auto pixels_by = [&]<typename Whole>(Whole) {
            return pixels_of<Floats<16>>(
                [&](auto&& emit) { fill_box<Whole>(edges, 1.0f, box, emit); });
        };
        ASSERT_TRUE(are_the_same(pixels_by(Ints<16>{}), pixels_by(Doubles<16>{})))
            << "in 32 bits, and in doubles (" << k << ")";
    }
    EXPECT_GT(greatest, 850'000'000) << "the largest edge function";
    EXPECT_LT(greatest, std::int64_t{100} * 256 * (131 + 100) * 256)
        << "the largest edge function, and the bound of Robust, \"32 bits or 53\"";
    EXPECT_LT(
        std::int64_t{pixels_in_32_bits} * 256 * (pixels_in_32_bits + 31 + pixels_in_32_bits) * 256,
        std::int64_t{1} << 31)
        << "the bound for pixels_in_32_bits";
}

TEST(Simd, Eq13_2_HardCase_TrianglesThatDoNotFitInto32BitsTakeDoubles) {
    // Half of a square of 182 pixels or more has a corner whose edge function is above 2^31.
    for (int side = 90; side <= 300; ++side)
        for (int corner = 0; corner < 4; ++corner) {
            const auto s = static_cast<float>(side);
            std::array<vec2, 3> v = {vec2(0.25f), {s, 0.25f}, {0.25f, s}};
            for (vec2& vertex : v) {
                if (corner & 1) vertex.x = s + 1 - vertex.x;
                if (corner & 2) vertex.y = s + 1 - vertex.y;
            }
            const ScreenTriangle triangle = snap_triangle(v[0], v[1], v[2]);
            ASSERT_TRUE(fills_as_lesson_02<Floats<16>>(triangle, ivec2(0), ivec2(310)))
                << "in 16 lanes, a triangle " << side << " pixels wide and high: " << in_words(v);
        }
}

TEST(Simd, Eq13_2_ARowOfALargeTriangleBeginsAndEndsWithItsPixels) {
    for_each_width([]<int N>() {
        Dice dice(N);
        for (int k = 0; k < 300; ++k) {
            std::array<vec2, 3> v;
            for (vec2& vertex : v) vertex = 300.0f * (vec2(dice.in_cube(1)) + 1.0f);
            const ScreenTriangle triangle = snap_triangle(v[0], v[1], v[2]);
            const PixelBox box = box_around(triangle);
            if (std::max(box.last.x - box.first.x, box.last.y - box.first.y) < 100) continue;
            std::vector<int> in_row(601), vectors(601);
            fill_triangle(triangle, ivec2(0), ivec2(600), [&](ivec2 pixel, Barycentrics) {
                ++in_row.at(static_cast<std::size_t>(pixel.y));
            });
            fill_triangle<Floats<N>>(triangle, ivec2(0), ivec2(600), [&](ivec2 pixel, auto...) {
                ++vectors.at(static_cast<std::size_t>(pixel.y));
            });
            for (std::size_t y = 0; y < in_row.size(); ++y)
                ASSERT_EQ(vectors[y], (in_row[y] + N - 1) / N)
                    << "vectors of " << N << " for the " << in_row[y] << " pixels in row " << y
                    << " of the triangle " << in_words(v);
        }
    });
}

TEST(Simd, Eq13_2_HardCase_ATileThatAnEdgeTouchesInOnePixelIsFilled) {
    // The centre of the pixel (127, 127) is on the left edge: the only one of the tile.
    const ScreenTriangle triangle = snap_triangle({255, 0}, {0, 255}, {255, 255});
    for_each_width([&]<int N>() {
        EXPECT_EQ(pixels_of<Floats<N>>([&](auto&& emit) {
                      fill_triangle<Floats<N>>(triangle, ivec2(64), ivec2(127), emit);
                  }).size(),
                  1u)
            << "in " << N << " lanes";
    });
}

TEST(Simd, Eq13_2_HardCase_TrianglesFarAwayAndHuge) {
    // Up to 2^17 pixels from the origin, the doubles are exact.
    for_each_width([]<int N>() {
        Dice dice(N);
        std::size_t pixels = 0;
        for (int k = 0; k < 1500; ++k) {
            std::array<vec2, 3> v;
            for (vec2& vertex : v) {
                vertex = 131071.0f * vec2(dice.in_cube(1));
                if (dice.one_in(4)) vertex = glm::sign(vertex) * 131071.0f;
                if (dice.one_in(4)) vertex = glm::floor(vertex / 256.0f) + 0.5f;
            }
            const ScreenTriangle triangle = snap_triangle(v[0], v[1], v[2]);
            // Pixels around a point of an edge.
            const vec2 on_edge = glm::mix(v[0], v[1], dice.between(0, 1));
            const ivec2 first = glm::clamp(ivec2(on_edge) - ivec2(20, 3), 0, 131000);
            ASSERT_TRUE(fills_as_lesson_02<Floats<N>>(triangle, first, first + ivec2(40, 6)))
                << "in " << N << " lanes, the triangle " << in_words(v) << " in pixels from "
                << testing::PrintToString(first) << " on (" << k << ")";
            fill_triangle(triangle, first, first + ivec2(40, 6),
                          [&](ivec2, Barycentrics) { ++pixels; });
        }
        EXPECT_GT(pixels, 30'000u);
    });
}

TEST(Simd, Eq13_2_TileDepthsAreADepthBuffers) {
    const auto check = []<typename F>(F, std::uint32_t seed) {
        Dice dice(seed);
        std::size_t nearer = 0, tests = 0;
        for (int k = 0; k < 120; ++k) {
            const ivec2 size(1 + dice.below(40), 1 + dice.below(20));
            const Split split = splits[std::size_t(k) % 3];
            const Tiling tiling(split, size, 1 + dice.below(4),
                                1 + static_cast<int>(dice.below(20)));
            DepthBuffer whole(size);
            Image<float> image(size + 5, -3);
            for (std::size_t t = 0; t < tiling.count(); ++t) {
                const Tile tile = tiling[t];
                TileDepths depths(tile);
                const std::string where =
                    std::to_string(width_of<F>) + " lanes, tile " + std::to_string(t) + " of " +
                    std::to_string(tiling.count()) + ", " + name_of(split) + " of " +
                    testing::PrintToString(size) + " pixels (" + std::to_string(k) + ")";
                for (int i = 0; i < 60; ++i) {
                    const auto rows = static_cast<std::uint32_t>(
                        (tile.box.last.y - tile.box.first.y) / tile.row_step + 1);
                    const auto columns =
                        static_cast<std::uint32_t>(tile.box.last.x - tile.box.first.x + 1);
                    const ivec2 pixel =
                        tile.box.first + ivec2(dice.below(columns),
                                               static_cast<int>(dice.below(rows)) * tile.row_step);
                    std::array<float, std::size_t(width_of<F>)> at;
                    for (float& x : at) {
                        x = 0.125f * static_cast<float>(dice.below(10));
                        if (dice.one_in(8)) x = any_float(dice);
                    }
                    const std::uint32_t bits = dice.below(1u << width_of<F>);
                    const auto covers = [&](int lane) {
                        return (bits >> lane & 1) && pixel.x + lane <= tile.box.last.x;
                    };
                    MaskOf<F> covered, written;
                    F depth;
                    std::memcpy(&depth, at.data(), sizeof depth);
                    if constexpr (width_of<F> == 1)
                        covered = covers(0);
                    else
                        for (int l = 0; l < width_of<F>; ++l) covered.lanes[l] = covers(l) ? -1 : 0;
                    written = depths.test_and_write<F>(pixel, covered, depth);
                    for (int l = 0; l < width_of<F>; ++l) {
                        const ivec2 there = pixel + ivec2(l, 0);
                        const bool expected =
                            covers(l) && whole.test_and_write(there, at.at(std::size_t(l)));
                        ASSERT_EQ(lane_of(written, l), expected)
                            << "whether the depth " << at.at(std::size_t(l)) << " at "
                            << testing::PrintToString(there) << " is nearer; " << where;
                        nearer += expected, ++tests;
                    }
                }
                for (int y = tile.box.first.y; y <= tile.box.last.y; y += tile.row_step)
                    for (int x = tile.box.first.x; x <= tile.box.last.x; ++x)
                        ASSERT_EQ(*depths.from({x, y}), (whole.depths()[{x, y}]))
                            << "the depth at (" << x << ", " << y << "); " << where;
                depths.copy_to(image, tile, ivec2(3, 2));
            }
            for (int y = 0; y < size.y + 5; ++y)
                for (int x = 0; x < size.x + 5; ++x) {
                    const ivec2 p(x - 3, y - 2);
                    const bool is_in = p.x >= 0 && p.y >= 0 && p.x < size.x && p.y < size.y;
                    ASSERT_EQ((image[{x, y}]), is_in ? whole.depths()[p] : -3.0f)
                        << "pixel (" << x << ", " << y << ") of an image that the depths of "
                        << testing::PrintToString(size) << " pixels are copied into, moved by "
                        << "(3, 2); " << name_of(split) << " (" << k << ")";
                }
        }
        EXPECT_GT(nearer, 1000u);
        EXPECT_GT(tests, 4 * nearer);
    };
    check(1.0f, 1), check(Floats<4>(), 2), check(Floats<8>(), 3), check(Floats<16>(), 4);
}

TEST(Simd, Eq13_2_HardCase_BehindARowNothingOfTheNextIsTouched) {
    // Two rows; a vector at the first one's last column, then one at the second one's first.
    for (const int width : {1, 2, 15, 16, 17, 33}) {
        const Tile tile{{{5, 3}, {4 + width, 4}}};
        TileDepths depths(tile);
        float* const first = depths.from({5, 3});
        float* const second = depths.from({5, 4});
        ASSERT_GE(second - first, width + TileDepths::padding)
            << "floats from a row's first pixel to the next row's, in a tile of " << width
            << " columns";
        depths.test_and_write<Floats<16>>({4 + width, 3}, first_lanes<Floats<16>>(1),
                                          Floats<16>(0.125f));
        // What lies beyond may be anything, and must not come back as a depth of the tile.
        depths.test_and_write<Floats<16>>({4 + width, 3}, first_lanes<Floats<16>>(16),
                                          Floats<16>(0.25f));
        for (int x = 0; x < width; ++x) {
            EXPECT_EQ(second[x], 0.0f) << "column " << x << " of the second row";
            EXPECT_EQ(first[x], x == width - 1 ? 0.25f : 0.0f) << "column " << x << " of the first";
        }
        Image<float> image({width + 20, 3}, -1);
        depths.copy_to(image, {{{5, 3}, {4 + width, 4}}}, ivec2(-5, -3));
        for (int x = width; x < width + 20; ++x)
            ASSERT_EQ((image[{x, 0}]), -1.0f) << "what lies behind a row is not copied";
    }
}

TEST(Simd, HardCase_EmptySpansAreThePixelsThatNothingCovers) {
    look_up("Eq. 13.2");
    Dice dice(7);
    for (int k = 0; k < 400; ++k) {
        const ivec2 first(dice.below(9), dice.below(9)),
            size(1 + dice.below(40), 1 + dice.below(6));
        Tile tile{{first, first + size - 1}};
        if (k % 2) tile.row_step = 2;
        TileDepths depths(tile);
        Image<int> is_empty(first + size, 0), found(first + size, 0);
        for (int y = first.y; y < first.y + size.y; y += tile.row_step)
            for (int x = first.x; x < first.x + size.x; ++x) {
                const bool is_covered = k % 5 && dice.one_in(k % 7 ? 2 : 12);
                depths.test_and_write<float>({x, y}, is_covered, 0.5f);
                is_empty[{x, y}] = !is_covered;
            }
        ivec2 last(-1);
        depths.for_each_empty_span(tile, [&](const PixelSpan& span) {
            ASSERT_GT(span.length, 0);
            ASSERT_TRUE(last.y < span.first.y || last.x < span.first.x)
                << "a span touches the one before it, or comes before it";
            last = span.first + ivec2(span.length, 0);
            for (int x = 0; x < span.length; ++x) ++found[span.first + ivec2(x, 0)];
        });
        ASSERT_EQ(found, is_empty)
            << "pixels of empty spans; tile of " << size.x << " x " << size.y << " from "
            << testing::PrintToString(first) << " on, rows by " << tile.row_step;
    }
}

TEST(Simd, Eq13_2_DepthsHaveLesson03sBits) {
    for_each_width([]<int N>() {
        Dice dice(N);
        for (int k = 0; k < 4000; ++k) {
            const TriangleDepth depth(dice.in_cube(0.5f) + 0.5f);
            std::array<vec3, std::size_t(N)> at;
            for (vec3& of_lane : at)
                of_lane = dice.one_in(10) ? vec3(any_float(dice), any_float(dice), any_float(dice))
                                          : dice.in_cube(1);
            ASSERT_TRUE(has_in_lanes(depth_at(depth, in_lanes<N>(at)),
                                     [&](int i) { return depth.at(at.at(std::size_t(i))); }))
                << "depths at " << testing::PrintToString(at);
        }
    });
}

TEST(Simd, Eq13_4_BatchesOfTheWorkedExample) {
    const auto used = [](std::uint64_t n, std::uint64_t lanes) {
        return static_cast<double>(n) / static_cast<double>(lanes * ((n + lanes - 1) / lanes));
    };
    EXPECT_EQ(used(20, 16), 0.625);
    EXPECT_EQ(used(20, 4), 1.0);
    const ColoredTriangles triangles;
    const ivec2 size(20, 20);
    ThreadPool pool(1);
    const ShadowMapsOnDemand maps(pool, 32, ShadowOptions{},
                                  {triangles.assets.scene, ShadowBounds(), {}});
    Image<vec3> color(size);
    DepthBuffer depth(size);
    const Frame<ShadowMapsOnDemand> frame{
        triangles.assets, Filter::nearest, vec3(0), maps, color, depth};
    // 20 pixels in rows of 2 to 6 pixels: all of one triangle, or the first rows of another.
    const std::array spans = {PixelSpan{{2, 0}, 2}, PixelSpan{{1, 1}, 3}, PixelSpan{{1, 2}, 4},
                              PixelSpan{{0, 3}, 5}, PixelSpan{{0, 4}, 6}};
    const ProjectedTriangle one = triangles.projected(size, 0),
                            other = triangles.projected(size, 1);
    for (const std::size_t of_other : {0u, 2u}) {
        const std::array visible = {VisibleTriangle{&other, std::span(spans).first(of_other)},
                                    VisibleTriangle{&one, std::span(spans).subspan(of_other)}};
        const auto counted_and_last = [&](auto&& shade) {
            const CountedSince counters;
            shade();
            return std::pair(counters[Counter::fragments_shaded], fragments_at_once);
        };
        const auto shaded_by_16 =
            counted_and_last([&] { shade_pixels<Permutation{}, Floats<16>>(frame, visible); });
        EXPECT_EQ(shaded_by_16, std::pair(std::uint64_t{20}, std::uint64_t{4}))
            << "pixels, and those of the last batch, of 16 lanes";
        const auto shaded_by_4 =
            counted_and_last([&] { shade_pixels<Permutation{}, Floats<4>>(frame, visible); });
        EXPECT_EQ(shaded_by_4, std::pair(std::uint64_t{20}, std::uint64_t{4}))
            << "pixels, and those of the last batch, of 4 lanes";
    }
}

TEST(Simd, Eq13_4_BatchesHaveLesson12sPixelsAndLeaveNoLaneEmptyButTheLasts) {
    const ColoredTriangles triangles;
    const ivec2 size(80, 40);
    ThreadPool pool(1);
    const ShadowMapsOnDemand maps(pool, 32, ShadowOptions{},
                                  {triangles.assets.scene, ShadowBounds(), {}});
    const std::array projected = {triangles.projected(size, 0), triangles.projected(size, 1),
                                  triangles.projected(size, 2)};
    for_each_width([&]<int N>() {
        Dice dice(N);
        for (int k = 0; k < 300; ++k) {
            std::array<std::vector<PixelSpan>, ColoredTriangles::count> spans;
            const std::uint32_t triangle_count = k % 2 ? 1 : ColoredTriangles::count;
            std::uint64_t pixels = 0;
            const std::uint32_t longest = k % 3 ? 5 : 70;
            for (int y = 0; y < size.y; ++y)
                for (int x = static_cast<int>(dice.below(k % 5 ? 90 : 20)); x < size.x;) {
                    const int length =
                        std::min(size.x - x, 1 + static_cast<int>(dice.below(longest)));
                    spans.at(dice.below(triangle_count)).push_back({{x, y}, length});
                    pixels += static_cast<std::uint64_t>(length);
                    x += length + 1 + static_cast<int>(dice.below(80));
                }
            if (k == 0) spans = {}, pixels = 0;
            Image<vec3> expected(size, vec3(-1)), actual = expected;
            DepthBuffer depth(size);
            const Frame<ShadowMapsOnDemand> before{
                triangles.assets, Filter::nearest, vec3(0), maps, expected, depth};
            const Frame<ShadowMapsOnDemand> frame{
                triangles.assets, Filter::nearest, vec3(0), maps, actual, depth};
            std::vector<VisibleTriangle> visible;
            for (std::size_t t = 0; t < spans.size(); ++t) {
                visible.push_back({&projected.at(t), spans.at(t)});
                shade_pixels<Permutation{}>(before, projected.at(t), spans.at(t));
            }
            const CountedSince counters;
            shade_pixels<Permutation{}, Floats<N>>(frame, visible);
            const std::uint64_t counted = counters[Counter::fragments_shaded];
            const std::string where = std::to_string(pixels) + " pixels in " +
                                      std::to_string(triangle_count) + " triangles, " +
                                      std::to_string(N) + " lanes (" + std::to_string(k) + ")";
            ASSERT_TRUE(have_the_same_bits(actual, expected))
                << "beside lesson 12's shade_pixels(); " << where;
            ASSERT_EQ(counted, pixels) << "pixels that are counted as shaded, of " << where;
            if (pixels > 0) {
                ASSERT_EQ(fragments_at_once, (pixels - 1) % N + 1)
                    << "pixels of the last batch, if all others are full; " << where;
            }
        }
    });
}

TEST(Simd, Eq13_4_HardCase_BarycentricsAreFoundAgainInEachLane) {
    for_each_width([]<int N>() {
        Dice dice(N);
        std::size_t pixels = 0;
        for (int k = 0; k < 400; ++k) {
            std::array<vec2, 3> v = any_triangle(dice);
            if (dice.one_in(4))
                for (vec2& vertex : v) vertex = 131071.0f * vec2(dice.in_cube(1));
            const ScreenTriangle triangle = snap_triangle(v[0], v[1], v[2]);
            if (triangle.twice_area == 0) continue;
            const ivec2 first =
                glm::clamp(ivec2((v[0] + v[1] + v[2]) / 3.0f) - ivec2(8, 3), 0, 131000);
            std::vector<Filled> expected;
            fill_triangle(triangle, first, first + ivec2(16, 6),
                          [&](ivec2 pixel, Barycentrics at) { expected.push_back({pixel, at}); });
            if (expected.empty()) continue;
            const WideBarycentricPlanes<N> planes(triangle);
            for (int batch = 0; batch < 5; ++batch) {
                std::array<Filled, std::size_t(N)> some;
                Ints<N> x(0), y(0);
                for (int i = 0; i < N; ++i) {  // pixels that are not neighbours
                    some.at(std::size_t(i)) =
                        expected[dice.below(static_cast<std::uint32_t>(expected.size()))];
                    x.set(i, some.at(std::size_t(i)).pixel.x);
                    y.set(i, some.at(std::size_t(i)).pixel.y);
                }
                const Vec3<Floats<N>> at = planes.at(x, y);
                for (int i = 0; i < N; ++i)
                    ASSERT_TRUE(are_the_same({{{x[i], y[i]}, {at.x[i], at.y[i], at.z[i]}}},
                                             {some.at(std::size_t(i))}))
                        << "lane " << i << " of " << N << ", the triangle " << in_words(v) << " ("
                        << k << ")";
                pixels += N;
            }
        }
        EXPECT_GT(pixels, 1000u * N);
    });
}

TEST(Simd, Eq13_5_StepsOfTheWorkedExample) {
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
