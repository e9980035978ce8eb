// SPDX-License-Identifier: MIT
/// @file
/// exp2 and log2 of lesson 06 with polynomials of other degrees.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "13_simd/simd.hpp"
#include "accuracy/simd_frames.hpp"
#include "accuracy/simd_numbers.hpp"
#include "common/math/functions.hpp"

namespace rasterbook::test {

/// The polynomial that meets a function at Chebyshev's points: nearly the best of its degree.
///
/// @return  Its coefficients, that of the highest power first.
template <std::size_t count>
std::array<float, count> fitted(long double low, long double high, long double (*f)(long double)) {
    std::array<long double, count> at, divided;
    for (std::size_t i = 0; i < count; ++i) {
        const long double angle =
            std::numbers::pi_v<long double> * (static_cast<long double>(i) + 0.5L) / count;
        at[i] = (low + high) / 2 + (high - low) / 2 * std::cos(angle);
        divided[i] = f(at[i]);
    }
    for (std::size_t k = 1; k < count; ++k)  // Newton's divided differences
        for (std::size_t i = count - 1; i >= k; --i)
            divided[i] = (divided[i] - divided[i - 1]) / (at[i] - at[i - k]);
    std::array<long double, count> powers{};  // the lowest first
    for (std::size_t k = count; k-- > 0;) {
        for (std::size_t i = count - 1; i > 0; --i) powers[i] = powers[i - 1] - at[k] * powers[i];
        powers[0] = divided[k] - at[k] * powers[0];
    }
    std::array<float, count> coefficients;
    for (std::size_t i = 0; i < count; ++i)
        coefficients[i] = static_cast<float>(powers[count - 1 - i]);
    return coefficients;
}

/// Of (2^t - 1) / t on [0, 1].
template <int degree>
inline const auto exp2_coefficients = fitted<std::size_t{degree}>(
    0, 1, [](long double t) { return std::expm1(t * std::numbers::ln2_v<long double>) / t; });

/// Of (log2(1 + t) / t - log2(e)) / t between sqrt(1/2) - 1 and sqrt(2) - 1.
template <int degree>
inline const auto log2_coefficients = fitted<std::size_t{degree - 1}>(
    std::numbers::sqrt2_v<long double> / 2 - 1, std::numbers::sqrt2_v<long double> - 1,
    [](long double t) { return (std::log1p(t) / t - 1) * std::numbers::log2e_v<long double> / t; });

/// As exp2() of the course, which has degree 6.
template <int degree, typename F>
F exp2_of_degree(F x) {
    const F inside = clamp(x, F(-126.0f), F(0x1.fffffep6f)), whole = floor(inside);
    const F t = inside - whole;
    F fraction = F(exp2_coefficients<degree>[0]);
    for (std::size_t i = 1; i < degree; ++i)
        fraction = fraction * t + F(exp2_coefficients<degree>[i]);
    fraction = fraction * t + F(1.0f);
    const F infinity(std::numeric_limits<float>::infinity());
    const F result = select(x < F(-126.0f), F(0.0f), fraction * two_to_the(whole));
    return select(x == x, select(x >= F(128.0f), infinity, result), x);
}

/// As log2() of the course, which has degree 10.
template <int degree, typename F>
F log2_of_degree(F x) {
    const F infinity(std::numeric_limits<float>::infinity());
    const auto is_tiny = x < F(std::numeric_limits<float>::min());
    const auto is_usable = (x < infinity) & (x >= F(std::numeric_limits<float>::min()));
    const FloatParts<F> parts = float_parts(select(is_usable, x, F(1.0f)));
    const auto is_large = parts.mantissa > F(0x1.6a09e6p0f);
    const F t = select(is_large, F(0.5f) * parts.mantissa, parts.mantissa) - F(1.0f);
    const F exponent = select(is_large, parts.exponent + F(1.0f), parts.exponent);
    F p = F(log2_coefficients<degree>[0]);
    for (std::size_t i = 1; i + 1 < degree; ++i) p = p * t + F(log2_coefficients<degree>[i]);
    const F result = ((t * t * p + F(0x1.c551dap-2f) * t) + t) + exponent;
    const F special =
        select(is_tiny & (x >= F(0.0f)), -infinity,
               select(x == infinity, infinity, F(std::numeric_limits<float>::quiet_NaN())));
    return select(is_usable, result, special);
}

/// A shared library calls it: not inlined, with its numbers in memory.
template <int of_exp2, int of_log2>
Floats<16> power_of_degrees(const Floats<16>& x, const Floats<16>& y) {
    using F = Floats<16>;
    return select(y == F(0.0f), F(1.0f), exp2_of_degree<of_exp2>(y * log2_of_degree<of_log2>(x)));
}
inline Floats<16> power_of_course(const Floats<16>& x, const Floats<16>& y) { return power(x, y); }

template <int... degree>
void add_exp2(std::integer_sequence<int, degree...>) {
    constexpr int N = native_width;
    const auto add = [](const std::string& name, auto function) {
        // The fraction of a number of [1, 2) is any of 2^23.
        add_function<N>("exp2", name, -8, 8,
                        errors_of_all<N>(1, 2, function, [](double x) { return std::exp2(x); }),
                        function);
    };
    (add("degree " + std::to_string(degree), [](Floats<N> x) { return exp2_of_degree<degree>(x); }),
     ...);
    add("course, degree 6", [](Floats<N> x) { return exp2(x); });
}

template <int... degree>
void add_log2(std::integer_sequence<int, degree...>) {
    constexpr int N = native_width;
    const auto add = [](const std::string& name, auto function) {
        add_function<N>("log2", name, 0, 1,
                        errors_of_all<N>(0.5f, 2, function, [](double x) { return std::log2(x); }),
                        function);
    };
    (add("degree " + std::to_string(degree), [](Floats<N> x) { return log2_of_degree<degree>(x); }),
     ...);
    add("course, degree 10", [](Floats<N> x) { return log2(x); });
}

/// A highlight as bright as white, by its cosine: 8-bit values beside those of double.
///
/// @param power  Called as power(Floats<16> x, Floats<16> exponent).
template <typename Power>
double wrong_values_percent(float exponent, const Power& power) {
    constexpr int steps = 1 << 20, N = 16;
    std::array<float, N> x, y;
    int wrong = 0;
    for (int i = 0; i < steps; i += N) {
        // The highlight's values, from nearly 0 to 1, evenly: where it is bright counts most.
        for (int lane = 0; lane < N; ++lane)
            x[static_cast<std::size_t>(lane)] = static_cast<float>(
                std::pow((i + lane + 0.5) / steps, 1 / static_cast<double>(exponent)));
        store(y.data(), power(load<Floats<N>>(x.data()), Floats<N>(exponent)));
        for (std::size_t lane = 0; lane < N; ++lane) {
            const auto exact = static_cast<float>(
                std::pow(static_cast<double>(x[lane]), static_cast<double>(exponent)));
            wrong += srgb8_from_linear(y[lane]) != srgb8_from_linear(exact);
        }
    }
    return 100.0 * wrong / steps;
}

inline void add_power(const std::string& name, PowerInLanes power) {
    Errors errors;
    for (const int exponent : {32, 90, 1000})
        errors["wrong values, % at " + std::to_string(exponent)] =
            wrong_values_percent(static_cast<float>(exponent), power);
    set_power(power);
    for (const auto& [scene_name, assets] : scenes()) {
        const Image<vec3> exact = frame(of_width(16), *assets);
        const ValueDifference values(frame(of_width(powers), *assets), exact);
        errors[scene_name + ", %"] = values.percent;
        errors[scene_name + ", greatest"] = values.greatest;
    }
    const Floats<16> exponent(90.0f);
    add_function<16>("powers", name, 0, 1, std::move(errors),
                     [=](Floats<16> x) { return power(x, exponent); });
}

inline void add_polynomials() {
    add_exp2(std::integer_sequence<int, 2, 3, 4, 5, 6, 7, 8>());
    add_log2(std::integer_sequence<int, 2, 3, 4, 5, 6, 7, 8, 9, 10>());
    add_power("2 and 3", power_of_degrees<2, 3>);
    add_power("3 and 4", power_of_degrees<3, 4>);
    add_power("4 and 6", power_of_degrees<4, 6>);
    add_power("5 and 8", power_of_degrees<5, 8>);
    add_power("course, 6 and 10", power_of_course);
}

}  // namespace rasterbook::test
