// SPDX-License-Identifier: MIT
/// @file
/// A reference in long double, and how near to it a float has to be.
#pragma once

#include <cfloat>
#include <cmath>

#include <gtest/gtest.h>

#include "common/math/types.hpp"

namespace rasterbook::test {

using real = long double;
using lvec3 = glm::vec<3, real>;
using lvec4 = glm::vec<4, real>;

/// From 1 to the next float. Rounding is off by at most half of it, times the result.
constexpr real eps = FLT_EPSILON;

/// A sum, and the sum of its terms' sizes: however they are added up, the error is in proportion to
/// that.
struct Sum {
    real value = 0, of_sizes = 0;
    void add(real term) { value += term, of_sizes += std::abs(term); }
};

/// For EXPECT_TRUE: within `tolerance`; the reference itself rounds by 2^-64, a few times over.
inline testing::AssertionResult is_near(real actual, real exact, real tolerance) {
    if (std::abs(actual - exact) <= tolerance * (1 + 1e-9L)) return testing::AssertionSuccess();
    return testing::AssertionFailure() << actual << " instead of " << exact << ", off by "
                                       << std::abs(actual - exact) / tolerance << " tolerances";
}

}  // namespace rasterbook::test
