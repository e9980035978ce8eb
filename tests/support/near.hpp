// SPDX-License-Identifier: MIT
/// @file
/// Comparisons whose failures show both values whole, the reader's first, and how they differ.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "common/math/types.hpp"
#include "support/printers.hpp"

namespace rasterbook::test {

inline std::string shown(float x) { return text_of(x); }

template <glm::length_t n>
std::string shown(const glm::vec<n, float>& v) {
    std::string text;
    for (glm::length_t i = 0; i < n; ++i) text += (i == 0 ? "(" : ", ") + shown(v[i]);
    return text + ')';
}

/// How many floats `a` is above `b`; of finite numbers.
inline std::int64_t ulps_above(float a, float b) {
    const auto rank = [](float x) {
        const auto bits = std::bit_cast<std::int32_t>(x);
        return std::int64_t{bits < 0 ? std::numeric_limits<std::int32_t>::min() - bits : bits};
    };
    return rank(a) - rank(b);
}

/// ", 3 ulps more" where two numbers are neighbours or nearly so; else nothing.
inline std::string apart(float actual, float expected) {
    if (!std::isfinite(actual) || !std::isfinite(expected)) return "";
    const std::int64_t ulps = ulps_above(actual, expected), size = ulps < 0 ? -ulps : ulps;
    if (size == 0 || size > 64) return "";
    return ", " + std::to_string(size) + (size == 1 ? " ulp " : " ulps ") +
           (ulps > 0 ? "more" : "less");
}

inline double degrees_between(vec3 a, vec3 b) {
    const dvec3 u = a, v = b;
    return glm::degrees(std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)));
}

/// For EXPECT_TRUE: each component within the tolerance.
template <glm::length_t n>
testing::AssertionResult are_near(const glm::vec<n, float>& actual,
                                  const glm::vec<n, double>& expected, double tolerance) {
    for (glm::length_t i = 0; i < n; ++i)
        if (!(std::abs(actual[i] - expected[i]) <= tolerance)) {
            std::ostringstream message;
            message << shown(actual) << " instead of " << shown(glm::vec<n, float>(expected))
                    << "; component " << i << " is off by " << std::abs(actual[i] - expected[i])
                    << ", and may be by " << tolerance
                    << apart(actual[i], static_cast<float>(expected[i]));
            return testing::AssertionFailure() << message.str();
        }
    return testing::AssertionSuccess();
}

}  // namespace rasterbook::test
