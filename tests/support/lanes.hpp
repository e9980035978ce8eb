// SPDX-License-Identifier: MIT
/// @file
/// Lesson 14's wide numbers beside plain ones, lane by lane.
#pragma once

#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

#include <gtest/gtest.h>

#include "14_simd/simd.hpp"
#include "support/any_scene.hpp"
#include "support/near.hpp"
#include "support/special_numbers.hpp"

namespace rasterbook::test {

/// Calls take.operator()<N>() for each width that is not one float.
template <typename Take>
void for_each_width(Take&& take) {
    take.template operator()<4>();
    take.template operator()<8>();
    take.template operator()<16>();
}

/// Calls take(F()) for one float, and for floats of each width.
template <typename Take>
void for_each_number_type(Take&& take) {
    take(0.0f), take(Floats<4>(0.0f)), take(Floats<8>(0.0f)), take(Floats<16>(0.0f));
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

/// Ordinary numbers and special ones: where something ends, rounds or overflows.
inline float any_float(Dice& dice) {
    constexpr std::array special = {
        0.0f,    FLT_TRUE_MIN,   1e-40f,  FLT_MIN, 0.5f,    0x1.fffffep-1f, 1.0f,           1.5f,
        2.0f,    126.0f,         127.0f,  128.0f,  0x1p22f, 0x1p22f + 0.5f, 0x1p23f - 0.5f, 0x1p23f,
        0x1p24f, 0x1.fffffep30f, 0x1p31f, 0x1p63f, FLT_MAX, infinity,       not_a_number};
    switch (dice.below(4)) {
        case 0:
            return (dice.one_in(2) ? 1.0f : -1.0f) * special.at(dice.below(special.size()));
        case 1: {  // any bits, but for NaN that signal
            const float x = std::bit_cast<float>(dice.below(0xffffffffu));
            return std::isnan(x) ? dice.between(-1e6f, 1e6f) : x;
        }
        default:
            return dice.between(-3, 3);
    }
}

/// A plain value for each lane.
template <typename T, int N>
struct PerLane : std::array<T, static_cast<std::size_t>(N)> {
    T& operator[](int lane) { return this->at(static_cast<std::size_t>(lane)); }
    const T& operator[](int lane) const { return this->at(static_cast<std::size_t>(lane)); }
};

/// Any numbers; or ordinary ones, and any in one lane.
template <int N>
PerLane<float, N> any_numbers(Dice& dice) {
    PerLane<float, N> numbers;
    const bool are_ordinary = dice.one_in(2);
    for (float& x : numbers) x = are_ordinary ? dice.between(-3, 3) : any_float(dice);
    if (are_ordinary) numbers.at(dice.below(N)) = any_float(dice);
    return numbers;
}

template <int N>
Floats<N> in_lanes(const PerLane<float, N>& numbers) {
    return load<Floats<N>>(numbers.data());
}
template <int N, glm::length_t n>
glm::vec<n, Floats<N>> in_lanes(const PerLane<glm::vec<n, float>, N>& vectors) {
    glm::vec<n, Floats<N>> v;
    for (int i = 0; i < N; ++i)
        for (int c = 0; c < n; ++c) v[c].lanes[i] = vectors[i][c];
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
template <typename Number>
testing::AssertionResult have_the_same(std::span<const Number> actual,
                                       std::span<const Number> expected, const char* note) {
    for (std::size_t i = 0; i < actual.size(); ++i)
        if (!agree(actual[i], expected[i]))
            return testing::AssertionFailure()
                   << "lane " << i << " of " << actual.size() << " has " << in_words(actual[i])
                   << ", expected " << in_words(expected[i]) << note;
    return testing::AssertionSuccess();
}

/// For EXPECT_TRUE: a wide result (Floats, Ints or a Mask) has in each lane what the plain
/// computation gives for this lane.
///
/// @param expected  Called as expected(lane).
template <template <int> typename Wide, int N, typename Expected>
testing::AssertionResult has_in_lanes(const Wide<N>& actual, const Expected& expected) {
    constexpr bool is_mask = std::is_same_v<Wide<N>, Mask<N>>;
    using Number = std::decay_t<decltype(actual.lanes[0])>;
    PerLane<Number, N> lanes, lanes_expected;
    for (int i = 0; i < N; ++i) {
        lanes[i] = actual.lanes[i];
        if constexpr (is_mask)
            lanes_expected[i] = expected(i) ? -1 : 0;
        else
            lanes_expected[i] = expected(i);
    }
    return have_the_same<Number>(lanes, lanes_expected, is_mask ? " (-1: the mask holds)" : "");
}

/// "(2.5, -0)"
template <typename Numbers>
std::string list_of(const Numbers& numbers) {
    std::string text;
    for (const auto x : numbers) text += (text.empty() ? "(" : ", ") + in_words(x);
    return text + ")";
}

}  // namespace rasterbook::test
