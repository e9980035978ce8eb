// SPDX-License-Identifier: MIT
/// @file
/// Functions of numbers in lanes: every float of two binades against double, and time per number.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "13_simd/simd.hpp"
#include "accuracy/accuracy.hpp"

namespace rasterbook::test {

/// How far results are from exact values. An ulp is the distance of two floats that are as large
/// as the exact value.
class UlpErrors {
  public:
    void add(float computed, double exact) {
        const double error = std::abs(static_cast<double>(computed) - exact) / ulp(exact);
        greatest_ = std::max(greatest_, error);
        sum_of_squares_ += error * error;
        differing_ += computed != static_cast<float>(exact);
        ++count_;
    }

    Errors errors() const {
        const auto count = static_cast<double>(count_);
        return {{"greatest error, ulp", greatest_},
                {"RMS error, ulp", std::sqrt(sum_of_squares_ / count)},
                {"not the nearest float, %", 100 * static_cast<double>(differing_) / count}};
    }

  private:
    static double ulp(double exact) {
        constexpr std::uint64_t exponent_bits = 0x7ffull << 52;
        const double power =
            std::bit_cast<double>(std::bit_cast<std::uint64_t>(exact) & exponent_bits);
        return std::max(power, 0x1p-126) * 0x1p-23;
    }

    double greatest_ = 0, sum_of_squares_ = 0;
    std::uint64_t differing_ = 0, count_ = 0;
};

/// Every float from `first` up to `last`, which is not among them.
///
/// @param function  Called as function(Floats<N>).
/// @param exact     Called as exact(double).
template <int N, typename Function, typename Exact>
Errors errors_of_all(float first, float last, Function&& function, Exact&& exact) {
    UlpErrors errors;
    for (auto bits = std::bit_cast<std::uint32_t>(first); bits < std::bit_cast<std::uint32_t>(last);
         bits += N) {
        std::array<float, N> x, y;
        for (std::uint32_t i = 0; i < N; ++i) x[i] = std::bit_cast<float>(bits + i);
        store(y.data(), function(load<Floats<N>>(x.data())));
        for (std::size_t i = 0; i < N; ++i) errors.add(y[i], exact(static_cast<double>(x[i])));
    }
    return errors.errors();
}

/// Times a function of numbers from `first` to `last`, which stay in the first-level cache.
template <int N, typename Function>
void add_function(const std::string& comparison, const std::string& variant, float first,
                  float last, Errors errors, Function function) {
    constexpr std::size_t count = 4096;
    struct Numbers {
        alignas(64) std::array<float, count> x, y;
    };
    const auto numbers = std::make_shared<Numbers>();
    std::mt19937 random(13);
    std::uniform_real_distribution<float> any(first, last);
    for (float& x : numbers->x) x = any(random);
    add_variant(comparison, variant, count, std::move(errors), [=] {
        for (std::size_t i = 0; i < count; i += N)
            store(&numbers->y[i], function(load<Floats<N>>(&numbers->x[i])));
    });
}

}  // namespace rasterbook::test
