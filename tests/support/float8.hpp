// SPDX-License-Identifier: MIT
/// @file
/// Eight floats that take each step together: a number type of the kind that
/// common/math/functions.hpp describes.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "common/math/functions.hpp"

namespace rasterbook::test {

/// Whether something holds, for each of eight lanes.
struct Mask8 {
    typedef std::int32_t Lanes __attribute__((vector_size(32), aligned(16)));

    Lanes lanes_that_hold;  ///< -1 where it holds, else 0.

    friend Mask8 operator&(Mask8 a, Mask8 b) { return {a.lanes_that_hold & b.lanes_that_hold}; }
    friend Mask8 operator|(Mask8 a, Mask8 b) { return {a.lanes_that_hold | b.lanes_that_hold}; }
};

inline bool any_of(Mask8 mask) {
    for (std::size_t i = 0; i < 8; ++i)
        if (mask.lanes_that_hold[i]) return true;
    return false;
}
inline bool all_of(Mask8 mask) { return !any_of(Mask8{~mask.lanes_that_hold}); }

struct Float8 {
    static constexpr std::size_t lanes = 8;
    typedef float Lanes __attribute__((vector_size(32), aligned(16)));

    Lanes numbers;

    Float8() = default;
    Float8(const Lanes& of_lanes) : numbers(of_lanes) {}
    explicit Float8(float x) : numbers{x, x, x, x, x, x, x, x} {}

    float operator[](std::size_t lane) const { return numbers[lane]; }
    void set(std::size_t lane, float x) { numbers[lane] = x; }

    friend Float8 operator+(Float8 a, Float8 b) { return a.numbers + b.numbers; }
    friend Float8 operator-(Float8 a, Float8 b) { return a.numbers - b.numbers; }
    friend Float8 operator*(Float8 a, Float8 b) { return a.numbers * b.numbers; }
    friend Float8 operator/(Float8 a, Float8 b) { return a.numbers / b.numbers; }
    Float8 operator-() const { return -numbers; }
    Float8& operator+=(Float8 b) { return *this = *this + b; }
    Float8& operator*=(Float8 b) { return *this = *this * b; }

    friend Mask8 operator<(Float8 a, Float8 b) { return {a.numbers < b.numbers}; }
    friend Mask8 operator>(Float8 a, Float8 b) { return {a.numbers > b.numbers}; }
    friend Mask8 operator<=(Float8 a, Float8 b) { return {a.numbers <= b.numbers}; }
    friend Mask8 operator>=(Float8 a, Float8 b) { return {a.numbers >= b.numbers}; }
    friend Mask8 operator==(Float8 a, Float8 b) { return {a.numbers == b.numbers}; }
};

inline Float8 select(Mask8 mask, Float8 yes, Float8 no) {
    return mask.lanes_that_hold ? yes.numbers : no.numbers;
}

inline Float8 sqrt(Float8 x) {
    for (std::size_t i = 0; i < Float8::lanes; ++i) x.set(i, std::sqrt(x[i]));
    return x;
}

inline Float8 floor(Float8 x) {
    for (std::size_t i = 0; i < Float8::lanes; ++i) x.set(i, std::floor(x[i]));
    return x;
}

inline FloatParts<Float8> float_parts(Float8 x) {
    const auto bits = reinterpret_cast<Mask8::Lanes>(x.numbers);
    return {reinterpret_cast<Float8::Lanes>((bits & 0x007fffff) | 0x3f800000),
            __builtin_convertvector((bits >> 23) - 127, Float8::Lanes)};
}

inline Float8 two_to_the(Float8 n) {
    const auto exponents = __builtin_convertvector(n.numbers, Mask8::Lanes);
    return reinterpret_cast<Float8::Lanes>((exponents + 127) << 23);
}

}  // namespace rasterbook::test

/// GLM's functions take only types that say that they are floating-point numbers.
template <>
struct std::numeric_limits<rasterbook::test::Float8> : std::numeric_limits<float> {};
