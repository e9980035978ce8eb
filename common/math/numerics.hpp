// SPDX-License-Identifier: MIT
/// @file
/// Arithmetic that stays right where the plain formula does not.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "common/math/types.hpp"

namespace rasterbook {

/// 128-bit integer, for products of two 64-bit ones.
__extension__ typedef __int128 int128;

/// normalize_or() with the square of the length in a type Wide, T itself or a wider one. Where
/// squares may overflow or underflow in Wide, a power of two, which is exact, first brings v's
/// largest component to between 1 and 2.
template <std::floating_point Wide, std::floating_point T>
glm::vec<3, T> normalize_in(glm::vec<3, T> v, glm::vec<3, T> fallback) {
    constexpr Wide greatest = std::numeric_limits<Wide>::max();
    Wide x = v.x, y = v.y, z = v.z;
    if constexpr (std::numeric_limits<Wide>::max_exponent <
                  2 * std::numeric_limits<T>::max_exponent) {
        const Wide largest = std::max({std::abs(x), std::abs(y), std::abs(z)});
        if (!(largest > 0 && largest <= greatest)) return fallback;
        const int exponent = -std::ilogb(largest);
        x = std::scalbn(x, exponent), y = std::scalbn(y, exponent), z = std::scalbn(z, exponent);
    }
    const Wide length = std::sqrt(x * x + y * y + z * z);
    if (!(length > 0 && length <= greatest)) return fallback;
    return {static_cast<T>(x / length), static_cast<T>(y / length), static_cast<T>(z / length)};
}

/// v scaled to length 1, or `fallback` when v has no direction.
///
/// The square of the length is taken in a wider type, where there is one: for some compilers, as
/// MSVC, long double is double. It neither overflows nor underflows, so that 1e-40 and 1e30 are
/// ordinary lengths. (v / length(v) in float gives NaN for 0 and 0 for 1e30.)
///
/// @param v         Any values; zero, NaN and infinity have no direction.
/// @param fallback  Returned as it is.
/// @return          Each component within 1 ulp; within 3 where there is no wider type.
template <std::floating_point T>
glm::vec<3, T> normalize_or(glm::vec<3, T> v, glm::vec<3, T> fallback) {
    return normalize_in<std::conditional_t<std::is_same_v<T, float>, double, long double>>(
        v, fallback);
}

/// a b - c d within 1.5 ulp, even where the two products nearly cancel.
///
/// @param a,b,c,d  Finite, with products that neither overflow nor underflow.
/// @see Jeannerod, Louvet, Muller, "Further analysis of Kahan's algorithm for the accurate
///      computation of 2 x 2 determinants", 2013
template <std::floating_point T>
T difference_of_products(T a, T b, T c, T d) {
    const T cd = c * d;
    const T error_of_cd = std::fma(-c, d, cd);
    return std::fma(a, b, -cd) + error_of_cd;
}

/// a x b, each component within 1.5 ulp, also for nearly parallel vectors.
///
/// @param a,b  As for difference_of_products.
template <std::floating_point T>
glm::vec<3, T> cross_product(glm::vec<3, T> a, glm::vec<3, T> b) {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}

/// How many floats one has to step over from a to b: 0 when equal (-0 equals 0), 1 for neighbours.
///
/// @return  The greatest value there is when a or b is NaN.
inline std::uint32_t ulp_distance(float a, float b) {
    if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<std::uint32_t>::max();
    const auto place = [](float x) {  // on a line where neighbours differ by 1
        const auto bits = std::bit_cast<std::uint32_t>(x);
        const auto magnitude = static_cast<std::int64_t>(bits & 0x7fffffffu);
        return bits >> 31 ? -magnitude : magnitude;
    };
    const std::int64_t steps = place(a) - place(b);
    return static_cast<std::uint32_t>(steps < 0 ? -steps : steps);
}

}  // namespace rasterbook
