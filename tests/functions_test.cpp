// SPDX-License-Identifier: MIT
// Functions of a number type, beside those of the standard library in double and long double: how
// near they are, and what they make of special numbers. That many floats side by side get the bits
// of each alone is tested with lesson 14's.
#include "common/math/functions.hpp"

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "support/printers.hpp"
#include "support/reference.hpp"
#include "support/special_numbers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

float from_bits(std::uint32_t bits) { return std::bit_cast<float>(bits); }
std::uint32_t bits_of(float x) { return std::bit_cast<std::uint32_t>(x); }

/// From a float of the size of `exact` to the next one; of the least normal number below that.
double ulp(double exact) {
    const auto exponent =
        static_cast<int>(std::bit_cast<std::uint64_t>(exact) >> 52 & 0x7ff) - 1023;
    const int of_ulp = std::max(exponent, -126) - 23;
    return std::bit_cast<double>(static_cast<std::uint64_t>(of_ulp + 1023) << 52);
}

/// The greatest error so far, in ulp, and where it was.
struct Worst {
    double error = 0;
    float at = 0;

    void add(float x, float actual, double exact) {
        const double here = std::abs(actual - exact) / ulp(exact);
        if (!(here <= error)) error = here, at = x;  // also for NaN
    }
};

testing::AssertionResult is_within(double ulps, const Worst& worst) {
    if (worst.error <= ulps) return testing::AssertionSuccess();
    return testing::AssertionFailure() << worst.error << " ulp at " << worst.at;
}

bool is_subnormal(float x) { return std::fpclassify(x) == FP_SUBNORMAL; }

}  // namespace

TEST(Functions, MinAndMaxAreTheSecondWhereEitherIsNotANumber) {
    for (const float low : {-infinity, -FLT_MAX, -2.0f, -FLT_TRUE_MIN, 0.0f})
        for (const float high : {FLT_TRUE_MIN, 1.0f, FLT_MAX, infinity}) {
            EXPECT_EQ(min(low, high), low);
            EXPECT_EQ(min(high, low), low);
            EXPECT_EQ(max(low, high), high);
            EXPECT_EQ(max(high, low), high);
        }
    for (const float x : {-infinity, -2.0f, 0.0f, 3.0f, infinity}) {
        EXPECT_EQ(min(not_a_number, x), x);
        EXPECT_EQ(max(not_a_number, x), x);
        EXPECT_TRUE(std::isnan(min(x, not_a_number)));
        EXPECT_TRUE(std::isnan(max(x, not_a_number)));
    }
}

TEST(Functions, ClampIsTheNearestNumberInTheRangeAndLowForNaN) {
    for (const float x : {-infinity, -3.5f, -2.0f, not_a_number, -not_a_number})
        EXPECT_EQ(clamp(x, -2.0f, 5.0f), -2) << x;
    for (const float x : {-1.5f, 0.0f, FLT_TRUE_MIN, 4.75f, 5.0f})
        EXPECT_EQ(clamp(x, -2.0f, 5.0f), x);
    for (const float x : {5.5f, FLT_MAX, infinity}) EXPECT_EQ(clamp(x, -2.0f, 5.0f), 5) << x;
}

TEST(Functions, FloatPartsAreExact) {
    for (int exponent = -126; exponent <= 127; ++exponent)
        for (const float mantissa : {1.0f, 0x1.000002p0f, 1.5f, 0x1.fffffep0f}) {
            const auto parts = float_parts(std::ldexp(mantissa, exponent));
            EXPECT_EQ(parts.mantissa, mantissa) << exponent;
            EXPECT_EQ(parts.exponent, static_cast<float>(exponent)) << mantissa;
            EXPECT_EQ(two_to_the(static_cast<float>(exponent)), std::ldexp(1.0f, exponent));
        }
}

TEST(Functions, Eq6_12_Exp2IsWithinTwoUlp) {
    Worst worst;
    const auto check = [&](float x) { worst.add(x, exp2(x), std::exp2(double{x})); };
    // Sizes from 2^-30, where 2^x is 1 but for rounding, to 2^7, and those at which it ends.
    for (std::uint32_t bits = bits_of(0x1p-30f); bits < bits_of(128.0f); bits += 307) {
        check(from_bits(bits));
        if (from_bits(bits) <= 126) check(-from_bits(bits));
    }
    for (std::uint32_t i = 1; i <= 100'000; ++i) {
        check(from_bits(bits_of(128.0f) - i));
        check(-from_bits(bits_of(126.0f) - i));
        check(from_bits(bits_of(1.0f) - i));  // where the fraction ends, and begins anew
        check(-from_bits(bits_of(1.0f) - i));
        check(from_bits(bits_of(1.0f) + i));
    }
    EXPECT_TRUE(is_within(2, worst));
}

TEST(Functions, Exp2AndLog2AreExactForWholeNumbersAndPowersOfTwo) {
    for (int n = -126; n <= 127; ++n) {
        EXPECT_EQ(exp2(static_cast<float>(n)), std::ldexp(1.0f, n)) << n;
        EXPECT_EQ(log2(std::ldexp(1.0f, n)), static_cast<float>(n)) << n;
    }
    EXPECT_EQ(exp2(-0.0f), 1);
}

TEST(Functions, Exp2OfSpecialNumbers) {
    for (const float x :
         {std::nextafter(-126.0f, -infinity), -127.0f, -149.0f, -FLT_MAX, -infinity})
        EXPECT_EQ(exp2(x), 0) << x;
    for (const float x : {128.0f, 1000.0f, FLT_MAX, infinity}) EXPECT_EQ(exp2(x), infinity) << x;
    EXPECT_LT(exp2(std::nextafter(128.0f, 0.0f)), infinity);
    EXPECT_TRUE(std::isnan(exp2(not_a_number)));
    for (const float x : {FLT_TRUE_MIN, 1e-40f, FLT_MIN}) {
        EXPECT_EQ(exp2(x), 1);
        EXPECT_NEAR(exp2(-x), 1, FLT_EPSILON);
    }
}

TEST(Functions, Exp2IsNeverSubnormal) {
    for (std::uint32_t bits = bits_of(125.0f); bits < bits_of(152.0f); bits += 5)
        ASSERT_FALSE(is_subnormal(exp2(-from_bits(bits)))) << -from_bits(bits);
}

TEST(Functions, Eq6_11_Log2IsWithinTwoUlp) {
    Worst worst;
    const auto check = [&](std::uint32_t bits) {
        const float x = from_bits(bits), actual = log2(x);
        worst.add(x, actual, std::log2(double{x}));
        ASSERT_FALSE(is_subnormal(actual)) << x;
    };
    for (std::uint32_t bits = bits_of(0.5f); bits <= bits_of(2.0f); ++bits) check(bits);
    for (std::uint32_t bits = bits_of(FLT_MIN); bits < bits_of(infinity); bits += 1009) check(bits);
    for (std::uint32_t i = 0; i < 1000; ++i)
        check(bits_of(FLT_MIN) + i), check(bits_of(FLT_MAX) - i);
    EXPECT_TRUE(is_within(2, worst));
}

TEST(Functions, Log2OfSpecialNumbers) {
    for (const float x : {0.0f, -0.0f, FLT_TRUE_MIN, 1e-44f, 1e-40f, std::nextafter(FLT_MIN, 0.0f)})
        EXPECT_EQ(log2(x), -infinity) << x;
    EXPECT_EQ(log2(infinity), infinity);
    EXPECT_LT(log2(FLT_MAX), infinity);
    for (const float x : {-FLT_TRUE_MIN, -1e-40f, -FLT_MIN, -0.5f, -1.0f, -FLT_MAX, -infinity,
                          not_a_number, -not_a_number})
        EXPECT_TRUE(std::isnan(log2(x))) << x;
}

namespace {

/// For EXPECT_TRUE: as power() documents it.
testing::AssertionResult is_power(float x, float y) {
    const float actual = power(x, y);
    const double exact = std::pow(double{x}, double{y});
    const auto failure = [&] {
        return testing::AssertionFailure()
               << x << " to the power of " << y << " is " << actual << ", exactly " << exact;
    };
    if (!(actual >= 0 && actual <= 1)) return failure();
    if (is_subnormal(actual)) return failure() << ": subnormal";
    if (exact < FLT_MIN && actual == 0) return testing::AssertionSuccess();
    const double bound = (2 + 2.2 * y * std::abs(std::log2(double{x}))) * ulp(exact);
    if (std::abs(actual - exact) <= bound) return testing::AssertionSuccess();
    if (actual == 0 && exact - bound < FLT_MIN) return testing::AssertionSuccess();
    return failure() << ", off by " << std::abs(actual - exact) / bound << " bounds";
}

}  // namespace

TEST(Functions, Eq6_10_PowerIsWithinItsBound) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> share(0, 1), octaves(-30, 30), size(-126, 0);
    for (int i = 0; i < 300'000; ++i) {
        const float y = std::exp2(octaves(random)), inside = share(random);
        ASSERT_TRUE(is_power(inside, y)) << "seed 1, case " << i;
        ASSERT_TRUE(is_power(std::exp2(size(random)), y)) << "seed 1, case " << i;
        // Just below 1, where only large powers are not 1; and the powers of materials.
        const auto below_one = std::min(inside * inside * 0x1p24f, 0x1p23f);
        const float near_one = from_bits(bits_of(1.0f) - static_cast<std::uint32_t>(below_one));
        ASSERT_TRUE(is_power(near_one, y)) << "seed 1, case " << i;
        ASSERT_TRUE(is_power(near_one, 1000 * share(random))) << "seed 1, case " << i;
    }
    EXPECT_TRUE(is_power(0x1.67ae22p-1f, 0x1.f6866p+6f)) << "where it is least exact: 137 ulp";
}

TEST(Functions, PowerOfSpecialNumbers) {
    for (const float x : {0.0f, FLT_TRUE_MIN, FLT_MIN, 0.25f, 1 - FLT_EPSILON / 2, 1.0f})
        EXPECT_EQ(power(x, 0.0f), 1) << x;
    for (const float y : {0.0f, FLT_TRUE_MIN, FLT_MIN, 0.5f, 1.0f, 1000.0f, FLT_MAX})
        EXPECT_EQ(power(1.0f, y), 1) << y;
    for (const float y : {1e-30f, 0.5f, 1.0f, 1000.0f, FLT_MAX, infinity})
        EXPECT_EQ(power(0.0f, y), 0) << y;
    for (const float x : {FLT_MIN, 1e-9f, 0.5f, 0.9f}) {
        EXPECT_NEAR(power(x, 1e-9f), 1, FLT_EPSILON) << x;
        for (const float y : {1500.0f, 1e30f, FLT_MAX, infinity})
            EXPECT_EQ(power(x, y), 0) << x << ", " << y;
    }
    EXPECT_EQ(power(0.5f, 126.0f), FLT_MIN);
    EXPECT_EQ(power(0.5f, std::nextafter(126.0f, 127.0f)), 0);
}

namespace {

constexpr vec3 fallback(0.25f, -7, 3);  // no unit vector, so that it is not taken for one

/// For EXPECT_TRUE: as unit_or() documents it. Where a component is subnormal, what rounds are the
/// last digits that there are.
testing::AssertionResult is_unit(vec3 v) {
    const vec3 unit = unit_or(v, fallback);
    const real x = v.x, y = v.y, z = v.z, length = std::sqrt(x * x + y * y + z * z);
    for (int i = 0; i < 3; ++i) {
        const real exact = v[i] / length;
        const real tolerance = 2.9L * 0x1p-23L * std::abs(exact) +
                               (std::abs(exact) < FLT_MIN ? real{FLT_TRUE_MIN} : 0);
        if (!(std::abs(unit[i] - exact) <= tolerance))
            return testing::AssertionFailure()
                   << testing::PrintToString(v) << " becomes " << testing::PrintToString(unit)
                   << ": component " << i << " is off by "
                   << std::abs(unit[i] - exact) / std::abs(exact) * 0x1p23L << " times 2^-23";
    }
    return testing::AssertionSuccess();
}

}  // namespace

TEST(Functions, UnitOfVectorsOfAllLengthsAndWithComponentsOfMixedSizes) {
    std::mt19937 random(2);
    std::normal_distribution<double> any;
    std::uniform_real_distribution<double> lengths(-146, 127.8), sizes(-149, 128);
    const auto component = [&] {  // from the least float to the greatest, or 0
        const auto bits = random();
        const float size = bits % 8 == 0 ? 0 : float(std::min(std::exp2(sizes(random)), 3.4e38));
        return bits & 64 ? size : -size;
    };
    for (int i = 0; i < 400'000; ++i) {
        const dvec3 v(any(random), any(random), any(random));
        const double longest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
        ASSERT_TRUE(is_unit(vec3(v / longest * std::exp2(lengths(random)))))
            << "seed 2, case " << i;
        const vec3 mixed(component(), component(), component());
        ASSERT_TRUE(mixed == vec3(0) || is_unit(mixed)) << "seed 2, case " << i;
    }
}

TEST(Functions, UnitOfAxesIsExact) {
    for (const float size : {FLT_TRUE_MIN, 1e-44f, 1e-40f, FLT_MIN, 0x1p-100f, 0x1p-50f, 0x1p-40f,
                             1.0f, 0x1p40f, 0x1p100f, FLT_MAX})
        for (int axis = 0; axis < 3; ++axis)
            for (const float sign : {1.0f, -1.0f}) {
                vec3 expected(0);
                expected[axis] = sign;
                EXPECT_EQ(unit_or(size * expected, fallback), expected) << size;
            }
    EXPECT_TRUE(is_unit(vec3(FLT_MAX)));
    EXPECT_TRUE(is_unit(vec3(FLT_MAX, FLT_TRUE_MIN, -FLT_MAX)));
    EXPECT_TRUE(is_unit(vec3(FLT_TRUE_MIN)));
    EXPECT_TRUE(is_unit(vec3(0, -FLT_TRUE_MIN, 3 * FLT_TRUE_MIN)));
}

TEST(Functions, UnitOrTheFallbackWhereAVectorIsZeroOrNotFinite) {
    EXPECT_EQ(unit_or(vec3(0), fallback), fallback);
    EXPECT_EQ(unit_or(vec3(-0.0f), fallback), fallback);
    EXPECT_EQ(unit_or(vec3(0, -0.0f, 0), fallback), fallback);
    for (const float special : {not_a_number, -not_a_number, infinity, -infinity})
        for (const float other :
             {0.0f, FLT_TRUE_MIN, 1e-30f, -1.0f, 1e30f, FLT_MAX, infinity, -infinity, not_a_number})
            for (unsigned which = 1; which < 8; ++which) {
                const auto component = [&](int i) { return which >> i & 1 ? special : other; };
                const vec3 v(component(0), component(1), component(2));
                EXPECT_EQ(unit_or(v, fallback), fallback) << testing::PrintToString(v);
            }
}
