// SPDX-License-Identifier: MIT
/// @file
/// Lesson 13's wide numbers beside plain ones, lane by lane.
#pragma once

#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <type_traits>

#include <gtest/gtest.h>

#include "13_simd/simd.hpp"
#include "support/any_scene.hpp"
#include "support/near.hpp"

namespace rasterbook::test {

/// Calls take.operator()<N>() for each width that is not one float.
template <typename Take>
void for_each_width(Take&& take) {
    take.template operator()<4>();
    take.template operator()<8>();
    take.template operator()<16>();
}

/// Bit for bit; but which NaN a computation gives, no standard says.
inline bool agree(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || (a != a && b != b);
}
inline bool agree(int a, int b) { return a == b; }

inline std::string in_words(float x) {
    return x == 0 && std::signbit(x) ? "-0" : std::isnan(x) ? "NaN" : shown(x);
}
inline std::string in_words(int x) { return std::to_string(x); }
inline std::string in_words(bool x) { return x ? "yes" : "no"; }

/// Ordinary numbers and special ones: where something ends, rounds or overflows.
inline float any_float(Dice& dice) {
    constexpr std::array special = {0.0f,
                                    -0.0f,
                                    1.0f,
                                    -1.0f,
                                    0.5f,
                                    -0.5f,
                                    -1.5f,
                                    2.0f,
                                    0x1.fffffep-1f,
                                    126.0f,
                                    127.0f,
                                    128.0f,
                                    -126.0f,
                                    -127.0f,
                                    0x1p22f,
                                    -0x1p22f - 0.5f,
                                    0x1p23f,
                                    -0x1p23f,
                                    0x1p23f - 0.5f,
                                    0x1p24f,
                                    0x1p31f,
                                    -0x1p31f,
                                    0x1.fffffep30f,
                                    0x1p63f,
                                    FLT_MAX,
                                    -FLT_MAX,
                                    FLT_MIN,
                                    -FLT_MIN,
                                    FLT_TRUE_MIN,
                                    -FLT_TRUE_MIN,
                                    1e-40f,
                                    std::numeric_limits<float>::infinity(),
                                    -std::numeric_limits<float>::infinity(),
                                    std::numeric_limits<float>::quiet_NaN()};
    switch (dice.below(4)) {
        case 0:
            return special.at(dice.below(special.size()));
        case 1: {  // any bits, but for NaN that signal
            const float x = std::bit_cast<float>(dice.below(0xffffffffu));
            return std::isnan(x) ? dice.between(-1e6f, 1e6f) : x;
        }
        default:
            return dice.between(-3, 3);
    }
}

template <int N>
using NumbersOfLanes = std::array<float, static_cast<std::size_t>(N)>;

/// Any numbers; or ordinary ones, and any in one lane.
template <int N>
NumbersOfLanes<N> any_numbers(Dice& dice) {
    NumbersOfLanes<N> numbers;
    const bool are_ordinary = dice.one_in(2);
    for (float& x : numbers) x = are_ordinary ? dice.between(-3, 3) : any_float(dice);
    if (are_ordinary) numbers.at(dice.below(N)) = any_float(dice);
    return numbers;
}

template <int N>
Floats<N> in_lanes(const NumbersOfLanes<N>& numbers) {
    Floats<N> x;
    for (int i = 0; i < N; ++i) x.lanes[i] = numbers.at(static_cast<std::size_t>(i));
    return x;
}
template <int N>
Vec3<Floats<N>> in_lanes(const std::array<vec3, static_cast<std::size_t>(N)>& points) {
    Vec3<Floats<N>> v;
    for (int i = 0; i < N; ++i)
        for (int c = 0; c < 3; ++c) v[c].lanes[i] = points.at(static_cast<std::size_t>(i))[c];
    return v;
}

/// Holds in the lanes whose bits are set.
template <int N>
Mask<N> mask_of_bits(std::uint32_t bits) {
    Mask<N> mask;
    for (int i = 0; i < N; ++i) mask.lanes[i] = bits >> i & 1 ? -1 : 0;
    return mask;
}

/// What has_in_lanes() says of the lanes' numbers: compiled once, not for each width and function.
inline testing::AssertionResult have_the_same(std::span<const float> actual,
                                              std::span<const float> expected) {
    for (std::size_t i = 0; i < actual.size(); ++i)
        if (!agree(actual[i], expected[i]))
            return testing::AssertionFailure()
                   << "lane " << i << " of " << actual.size() << " has " << in_words(actual[i])
                   << ", expected " << in_words(expected[i]) << apart(actual[i], expected[i]);
    return testing::AssertionSuccess();
}
inline testing::AssertionResult have_the_same(std::span<const int> actual,
                                              std::span<const int> expected) {
    for (std::size_t i = 0; i < actual.size(); ++i)
        if (actual[i] != expected[i])
            return testing::AssertionFailure() << "lane " << i << " of " << actual.size() << " has "
                                               << actual[i] << ", expected " << expected[i];
    return testing::AssertionSuccess();
}
/// A mask is all ones where it holds, else all zeros.
inline testing::AssertionResult have_the_same(std::span<const int> actual,
                                              std::span<const bool> expected) {
    for (std::size_t i = 0; i < actual.size(); ++i)
        if (actual[i] != (expected[i] ? -1 : 0))
            return testing::AssertionFailure()
                   << "lane " << i << " of " << actual.size() << " has the bits of " << actual[i]
                   << ", expected those of "
                   << (expected[i] ? "-1 (it holds)" : "0 (it does not hold)");
    return testing::AssertionSuccess();
}

/// For EXPECT_TRUE: a wide result (Floats, Ints or a Mask) has in each lane what the plain
/// computation gives for this lane.
///
/// @param expected  Called as expected(lane).
template <template <int> typename Wide, int N, typename Expected>
testing::AssertionResult has_in_lanes(const Wide<N>& actual, const Expected& expected) {
    std::array<std::decay_t<decltype(actual.lanes[0])>, std::size_t(N)> lanes;
    std::array<decltype(actual[0]), std::size_t(N)> lanes_expected;
    for (int i = 0; i < N; ++i) {
        lanes[std::size_t(i)] = actual.lanes[i];
        lanes_expected[std::size_t(i)] = expected(i);
    }
    return have_the_same(lanes, lanes_expected);
}

/// "(2.5, -0)"
template <typename Numbers>
std::string list_of(const Numbers& numbers) {
    std::string text;
    for (const auto x : numbers) text += (text.empty() ? "(" : ", ") + in_words(x);
    return text + ")";
}

}  // namespace rasterbook::test
