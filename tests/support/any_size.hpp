// SPDX-License-Identifier: MIT
/// @file
/// Random numbers of all sizes, for tests that compare a stage with a reference.
#pragma once

#include <cmath>
#include <random>

#include "common/math/types.hpp"

namespace rasterbook::test {

/// Sizes from 10^-decades to 10^decades, each order of magnitude as often as the others, with
/// either sign.
class AnySize {
  public:
    AnySize(unsigned seed, float decades) : random_(seed), exponent_(-decades, decades) {}

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
