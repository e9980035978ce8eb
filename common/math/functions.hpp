// SPDX-License-Identifier: MIT
/// @file
/// Functions of a number type F: float, or a struct of several floats, each of which takes the same
/// steps and so gets the same bits. What F has to bring: arithmetic, comparisons that give a mask,
/// and for that mask `select`, `all_of`, `any_of`, `&` and `|`; sqrt, floor, float_parts and
/// two_to_the. What is called for each pixel is `inline`: else g++ calls it, and that takes longer.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>

#include <glm/geometric.hpp>

#include "common/math/types.hpp"

namespace rasterbook {

/// `yes` where the mask holds, else `no`. Both are computed: a branch without a jump.
template <typename F>
constexpr F select(bool mask, F yes, F no) {
    return mask ? yes : no;
}

/// Selects each component of a vector.
template <typename Mask, typename F>
constexpr Vec3<F> select(Mask mask, Vec3<F> yes, Vec3<F> no) {
    return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}
constexpr vec3 select(bool mask, vec3 yes, vec3 no) { return mask ? yes : no; }

/// Whether a mask holds for every number; for any.
constexpr bool all_of(bool mask) { return mask; }
constexpr bool any_of(bool mask) { return mask; }

/// The lesser number; b where either is NaN.
template <typename F>
constexpr F min(F a, F b) {
    return select(a < b, a, b);
}

/// The greater number; b where either is NaN.
template <typename F>
constexpr F max(F a, F b) {
    return select(a > b, a, b);
}

/// The nearest number in [low, high]; low for NaN.
template <typename F>
constexpr F clamp(F x, F low, F high) {
    return min(max(x, low), high);
}

/// What a function gives for one point. Of several points, it is told by a mask for which of them:
/// what it gives for the others is of no meaning.
template <typename Function, typename... Arguments>
constexpr auto call_where(bool, const Function& function, const Arguments&... arguments) {
    return function(arguments...);
}
template <typename Mask, typename Function, typename... Arguments>
constexpr auto call_where(Mask mask, const Function& function, const Arguments&... arguments) {
    return function(arguments..., mask);
}

inline float sqrt(float x) { return std::sqrt(x); }
inline float floor(float x) { return std::floor(x); }

/// A number as mantissa * 2^exponent.
template <typename F>
struct FloatParts {
    F mantissa;  ///< 1 <= mantissa < 2.
    F exponent;  ///< A whole number.
};

/// @param x  Finite, at least FLT_MIN.
inline FloatParts<float> float_parts(float x) {
    const auto bits = std::bit_cast<std::uint32_t>(x);
    return {std::bit_cast<float>((bits & 0x007fffffu) | 0x3f800000u),
            static_cast<float>(static_cast<int>(bits >> 23) - 127)};
}

/// 2^n, exactly.
///
/// @param n  A whole number from -126 to 127.
inline float two_to_the(float n) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(static_cast<int>(n) + 127) << 23);
}

/// 2^x: the whole part of x is the result's exponent, the fraction goes through a polynomial
/// (Eq. 6.12).
///
/// @return  Within 2 ulp; exact for whole numbers. 0 for x < -126, so that no result is subnormal;
///          infinity for x >= 128; NaN for NaN.
template <typename F>
inline F exp2(F x) {
    const F inside = clamp(x, F(-126.0f), F(0x1.fffffep6f)), whole = floor(inside);
    const F t = inside - whole;
    // 2^t on [0, 1], within 2^-28 of itself: the coefficients that Remez's algorithm finds.
    F fraction = F(0x1.c5416ep-13f);
    for (const float coefficient :
         {0x1.46d650p-10f, 0x1.3d0b92p-7f, 0x1.c68912p-5f, 0x1.ebfd58p-3f, 0x1.62e42cp-1f, 1.0f})
        fraction = fraction * t + F(coefficient);
    const F infinity(std::numeric_limits<float>::infinity());
    const F result = select(x < F(-126.0f), F(0.0f), fraction * two_to_the(whole));
    return select(x == x, select(x >= F(128.0f), infinity, result), x);
}

/// The logarithm to base 2: exponent plus logarithm of the mantissa, by a polynomial (Eq. 6.11).
///
/// @return  Within 2 ulp; exact for powers of two. -infinity for 0 and for subnormal numbers,
///          infinity for infinity; NaN for NaN and for negative numbers.
template <typename F>
inline F log2(F x) {
    const F infinity(std::numeric_limits<float>::infinity());
    const auto is_tiny = x < F(std::numeric_limits<float>::min());
    const auto is_usable = (x < infinity) & (x >= F(std::numeric_limits<float>::min()));
    const FloatParts<F> parts = float_parts(select(is_usable, x, F(1.0f)));
    // Between sqrt(1/2) and sqrt(2), so that a number just below 1 has no exponent to cancel.
    const auto is_large = parts.mantissa > F(0x1.6a09e6p0f);
    const F t = select(is_large, F(0.5f) * parts.mantissa, parts.mantissa) - F(1.0f);
    const F exponent = select(is_large, parts.exponent + F(1.0f), parts.exponent);
    // log2(1 + t) = t + t (log2(e) - 1) + t^2 p(t): the first and largest term has no rounding.
    F p = F(-0x1.c26462p-4f);
    for (const float coefficient :
         {0x1.7d478cp-3f, -0x1.874854p-3f, 0x1.a30594p-3f, -0x1.eabd0ep-3f, 0x1.277e3cp-2f,
          -0x1.715a72p-2f, 0x1.ec7096p-2f, -0x1.715470p-1f})
        p = p * t + F(coefficient);
    const F result = ((t * t * p + F(0x1.c551dap-2f) * t) + t) + exponent;
    const F special =
        select(is_tiny & (x >= F(0.0f)), -infinity,
               select(x == infinity, infinity, F(std::numeric_limits<float>::quiet_NaN())));
    return select(is_usable, result, special);
}

/// x to the power of y.
///
/// @param x,y  x from 0 to 1; y >= 0 and finite. A subnormal x counts as 0.
/// @return     Within 2 + 2.2 y |log2 x| ulp (Eq. 6.10), or 0 where that is about 2^-126
///             or less; at most 1; exactly 1 for y = 0 and for x = 1.
template <typename F>
inline F power(F x, F y) {
    return select(y == F(0.0f), F(1.0f), exp2(y * log2(x)));
}

/// v scaled to length 1; `fallback` where v is zero or has a number that is not finite.
///
/// @return  Each component within 2.9 * 2^-23 of its size of its exact value, or within 2^-149.
template <typename F>
inline Vec3<F> unit_or(Vec3<F> v, Vec3<F> fallback) {
    const F squared = glm::dot(v, v);
    const Vec3<F> unit = v * (F(1.0f) / sqrt(squared));
    // Robust: squares lose digits or overflow where v is very short or long. Then its largest
    // component becomes 1 first.
    const auto is_usable = (squared > F(1e-30f)) & (squared < F(1e30f));
    if (all_of(is_usable)) return unit;
    const F largest = max(max(max(v.x, -v.x), max(v.y, -v.y)), max(v.z, -v.z));
    const Vec3<F> scaled = v / largest;
    const F scaled_squared = glm::dot(scaled, scaled);
    const auto has_direction = scaled_squared >= F(1.0f);  // not for 0/0, nor infinity/infinity
    const Vec3<F> robust = scaled * (F(1.0f) / sqrt(scaled_squared));
    return select(is_usable, unit, select(has_direction, robust, fallback));
}

}  // namespace rasterbook
