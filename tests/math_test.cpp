// SPDX-License-Identifier: MIT
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/math/color.hpp"
#include "common/math/error_metrics.hpp"
#include "common/math/numerics.hpp"
#include "common/math/types.hpp"
#include "support/special_numbers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// Any size from the smallest denormal to the greatest float, with any sign.
float any_size(std::mt19937& random) {
    std::uniform_real_distribution<float> fraction(1, 2);
    std::uniform_int_distribution<int> exponent(-149, 127), sign(0, 1);
    return std::ldexp(sign(random) ? fraction(random) : -fraction(random), exponent(random));
}

}  // namespace

TEST(Matrix, RowsStandAsOnPaper) {
    const mat4 m = matrix_from_rows({1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}, {13, 14, 15, 16});
    EXPECT_EQ(m * vec4(1, 0, 0, 0), vec4(1, 5, 9, 13)) << "the first column";
    EXPECT_EQ(m * vec4(0, 0, 0, 1), vec4(4, 8, 12, 16)) << "the last column";
    const mat3 n = matrix_from_rows({1, 2, 3}, {4, 5, 6}, {7, 8, 9});
    EXPECT_EQ(n * vec3(1, 10, 100), vec3(321, 654, 987));
}

TEST(NormalizeOr, HasLengthOneWithinOneUlpForEverySize) {
    std::mt19937 random(1);
    for (int i = 0; i < 100'000; ++i) {
        const vec3 v(any_size(random), any_size(random), any_size(random));
        const vec3 unit = normalize_or(v, vec3(0.0f));
        const long double x = v.x, y = v.y, z = v.z, length = std::sqrt(x * x + y * y + z * z);
        for (int k = 0; k < 3; ++k)
            ASSERT_LE(ulp_distance(unit[k], static_cast<float>(v[k] / length)), 1u)
                << "seed 1, case " << i;
    }
}

TEST(NormalizeOr, HardCase_WithoutDirectionGivesTheFallback) {
    const vec3 fallback(0, 1, 0);
    for (const vec3 v : {vec3(0), vec3(-0.0f), vec3(not_a_number, 1, 1), vec3(infinity, 0, 0),
                         vec3(1, -infinity, not_a_number)})
        EXPECT_EQ(normalize_or(v, fallback), fallback);
}

TEST(NormalizeOr, HardCase_SmallestAndGreatest) {
    EXPECT_EQ(normalize_or(vec3(0, -FLT_TRUE_MIN, 0), vec3(1)), vec3(0, -1, 0));
    EXPECT_EQ(normalize_or(vec3(FLT_MAX, 0, 0), vec3(1)), vec3(1, 0, 0));
    EXPECT_NEAR(normalize_or(vec3(FLT_MAX), vec3(0)).x, std::sqrt(1.0f / 3), FLT_EPSILON);
    EXPECT_EQ(normalize_or(dvec3(0, 0, 1e-320), dvec3(1)), dvec3(0, 0, 1)) << "in double too";
    EXPECT_EQ(normalize_or(dvec3(1e300, 0, 0), dvec3(1)), dvec3(1, 0, 0));
}

TEST(NormalizeOr, DoublesOfAnySizeNeedNoWiderType) {
    const dvec3 fallback(9);
    const double nan = not_a_number, endless = HUGE_VAL;
    for (const dvec3 v : {dvec3(0), dvec3(nan, 1, 1), dvec3(1, nan, 1), dvec3(1, 1, endless)})
        EXPECT_EQ(normalize_in<double>(v, fallback), fallback);
    EXPECT_EQ(normalize_in<double>(dvec3(0, 0, 1e-320), fallback), dvec3(0, 0, 1));
    for (const double size : {1e-300, 1.0, 1e300})
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(normalize_in<double>(size * dvec3(2, -3, 6), fallback)[k],
                        (dvec3(2, -3, 6) / 7.0)[k], 4 * DBL_EPSILON);
}

TEST(DifferenceOfProducts, IsWithinTwoUlpWherePlainFloatLosesAllDigits) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> any(1, 2);
    std::uniform_int_distribution<int> neighbour(-3, 3);
    std::uint32_t worst_plain = 0;
    for (int i = 0; i < 100'000; ++i) {
        const float a = any(random), b = any(random),
                    c = a + static_cast<float>(neighbour(random)) * FLT_EPSILON;
        const float d = a * b / c;
        const auto exact =
            static_cast<float>(double{a} * b - double{c} * d);  // 48 bits each: one rounding
        ASSERT_LE(ulp_distance(difference_of_products(a, b, c, d), exact), 2u)
            << "seed 2, case " << i;
        worst_plain = std::max(worst_plain, ulp_distance(a * b - c * d, exact));
    }
    EXPECT_GT(worst_plain, 1'000'000u) << "the cases are not hard";
}

TEST(UlpDistance, CountsTheFloatsInBetween) {
    EXPECT_EQ(ulp_distance(1.0f, std::nextafter(1.0f, 2.0f)), 1u);
    EXPECT_EQ(ulp_distance(-1.0f, std::nextafter(-1.0f, 2.0f)), 1u);
    EXPECT_EQ(ulp_distance(0.0f, -0.0f), 0u);
    EXPECT_EQ(ulp_distance(FLT_TRUE_MIN, -FLT_TRUE_MIN), 2u);
    EXPECT_EQ(ulp_distance(1.0f, 2.0f), 1u << 23);
    EXPECT_EQ(ulp_distance(not_a_number, not_a_number), std::numeric_limits<std::uint32_t>::max());
}

TEST(Color, SrgbKnownValues) {
    constexpr double tolerance = 5e-7;  // the standard's constants have six digits
    EXPECT_NEAR(srgb_from_linear(0.5), 0.7353570, tolerance);
    EXPECT_NEAR(linear_from_srgb(0.5), 0.2140411, tolerance);
    EXPECT_NEAR(srgb_from_linear(0.0031308), 12.92 * 0.0031308, tolerance);
    EXPECT_EQ(srgb_from_linear(0.0), 0.0);
    EXPECT_NEAR(srgb_from_linear(1.0), 1.0, tolerance);
}

TEST(Color, AllBytesSurviveTheWayThroughLinearLight) {
    for (int byte = 0; byte < 256; ++byte)
        EXPECT_EQ(srgb8_from_linear(linear_from_srgb(static_cast<float>(byte) / 255.0f)), byte);
}

TEST(Color, HardCase_OutOfRangeAndNotANumberAreClamped) {
    EXPECT_EQ(srgb8_from_linear(-0.5f), 0);
    EXPECT_EQ(srgb8_from_linear(-infinity), 0);
    EXPECT_EQ(srgb8_from_linear(not_a_number), 0);
    EXPECT_EQ(srgb8_from_linear(1.0f), 255);
    EXPECT_EQ(srgb8_from_linear(17.0f), 255);
    EXPECT_EQ(srgb8_from_linear(infinity), 255);
}

TEST(Color, TheTableHasTheCodeOfEachFloat) {
    const SrgbTable codes;
    // Each 6100th of all floats, and around each code's least one the nearest ones.
    const auto expect_same = [&](std::uint32_t bits) {
        const auto linear = std::bit_cast<float>(bits);
        ASSERT_EQ(codes[linear], srgb8_from_linear(linear)) << "of " << linear;
    };
    for (std::uint64_t bits = 0; bits < (1ull << 32); bits += 6100)
        expect_same(static_cast<std::uint32_t>(bits));
    for (int code = 1; code < 256; ++code) {
        const float about = linear_from_srgb((static_cast<float>(code) - 0.5f) / 255.0f);
        const auto middle = std::bit_cast<std::uint32_t>(about);
        for (std::uint32_t bits = middle - 100; bits < middle + 100; ++bits) expect_same(bits);
    }
}

TEST(Color, BytesAreTheNearestValues) {
    for (float linear = 0; linear < 1; linear += 0.00013f) {
        const double code = 255 * srgb_from_linear(double{linear});
        EXPECT_NEAR(srgb8_from_linear(linear), code, 0.5 + 1e-4)
            << linear;  // float's pow errs by 1e-5
    }
}

TEST(ErrorMetrics, WorkedExample) {
    const std::vector<float> actual = {1, 2, 3, 4}, reference = {1, 2, 3, 2};
    EXPECT_EQ(greatest_error(actual, reference), 2);
    EXPECT_EQ(root_mean_square_error(actual, reference), 1);
    EXPECT_NEAR(peak_signal_to_noise_decibels(0.1), 20, 1e-12);
    EXPECT_EQ(peak_signal_to_noise_decibels(0), std::numeric_limits<double>::infinity());
    EXPECT_EQ(root_mean_square_error({}, {}), 0);
}

TEST(ErrorMetrics, HardCase_NotANumberIsNotOverlooked) {
    const std::vector<float> actual = {1, not_a_number, 3}, reference = {1, 2, 3};
    EXPECT_TRUE(std::isnan(greatest_error(actual, reference)));
    EXPECT_TRUE(std::isnan(root_mean_square_error(actual, reference)));
}

TEST(ErrorMetrics, HardCase_SmallAnglesAreAccurate) {
    constexpr double relative_tolerance = 1e-6;  // the direction is stored in float
    for (const float angle : {1e-7f, 1e-4f, 0.1f})
        EXPECT_NEAR(angle_radians(vec3(1, 0, 0), vec3(1, angle, 0)), std::atan(double{angle}),
                    relative_tolerance * angle);
    EXPECT_EQ(angle_radians(vec3(2, 0, 0), vec3(7, 0, 0)), 0);
    EXPECT_DOUBLE_EQ(angle_radians(vec3(1, 0, 0), vec3(-1, 0, 0)), std::acos(-1.0));
}
