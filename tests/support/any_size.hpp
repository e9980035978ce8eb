// SPDX-License-Identifier: MIT
/// @file
/// Random numbers of all sizes, for tests that compare a stage with a reference.
#pragma once

#include <cmath>
#include <random>

#include "common/math/types.hpp"
#include "support/cases.hpp"

namespace rasterbook::test {

/// What most of these tests take, and how often.
inline constexpr float decades = 8;
inline constexpr int cases = cases_of(100'000);

/// Sizes from 10^-power to 10^power, each order of magnitude as often as the others, with
/// either sign.
class AnySize {
  public:
    AnySize(unsigned seed, float power) : random_(seed), exponent_(-power, power) {}

    float positive() { return std::pow(10.0f, exponent_(random_)); }
    float number() { return random_() & 1 ? positive() : -positive(); }
    vec3 vector() {
        const float x = number(), y = number(), z = number();
        return {x, y, z};
    }
    vec4 homogeneous() {
        const vec3 v = vector();
        return {v, number()};
    }
    int whole(int least, int most) {
        return std::uniform_int_distribution<int>(least, most)(random_);
    }

  private:
    std::mt19937 random_;
    std::uniform_real_distribution<float> exponent_;
};

}  // namespace rasterbook::test
