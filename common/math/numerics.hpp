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

/// v times a power of two, which is exact, so that squares neither overflow nor underflow where
/// they count: unless v has an ordinary size, its largest component becomes 1 to 2. Zero, and what
/// is not finite, stays.
inline dvec3 with_ordinary_size(dvec3 v) {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    const bool is_ordinary = largest > 1e-140 && largest < 1e140;
    if (is_ordinary || !(largest > 0 && largest <= std::numeric_limits<double>::max())) return v;
    const int exponent = std::ilogb(largest);
    return {std::scalbn(v.x, -exponent), std::scalbn(v.y, -exponent), std::scalbn(v.z, -exponent)};
}

/// v scaled to length 1, or `fallback` when v has no direction.
///
/// The square of the length is taken in double, which holds that of any float; for doubles, after
/// with_ordinary_size(). So 1e-40 and 1e30 are ordinary lengths, and so is 1e300 in double.
/// (v / length(v) in float gives NaN for 0 and 0 for 1e30.)
///
/// @param v         Any values; zero, NaN and infinity have no direction.
/// @param fallback  Returned as it is.
/// @return          Each component within 1 ulp; within 3 for double.
template <std::floating_point T>
glm::vec<3, T> normalize_or(glm::vec<3, T> v, glm::vec<3, T> fallback) {
    dvec3 wide(v);
    if constexpr (std::is_same_v<T, double>) wide = with_ordinary_size(v);
    const double x = wide.x, y = wide.y, z = wide.z;
    const double length = std::sqrt(x * x + y * y + z * z);
    if (!(length > 0 && length <= std::numeric_limits<double>::max())) return fallback;
    return {static_cast<T>(x / length), static_cast<T>(y / length), static_cast<T>(z / length)};
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
