// SPDX-License-Identifier: MIT
// Tones: their thresholds to the last bit, the colours that are painted, and pixels with several
// tones. The inverted hull: 07_toon_hull_test.cpp; edge detection: 07_toon_edges_test.cpp; whole
// pictures: 07_toon_scene_test.cpp; special numbers: 07_toon_special_test.cpp.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "07_toon/toon.hpp"
#include "07_toon/toon_variants.hpp"
#include "common/math/numerics.hpp"
#include "support/look_up.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

/// A float from 2^-31 to 1 as a whole number over 2^55.
std::int64_t over_2_to_55(float x) { return static_cast<std::int64_t>(std::ldexp(x, 55)); }

/// floor(n x) in whole numbers, where nothing is rounded; at most n - 1.
int exact_tone(float x, int n) {
    const int128 scaled = static_cast<int128>(over_2_to_55(x)) * n;
    return std::min(static_cast<int>(scaled >> 55), n - 1);
}

/// The least float at or above k / n.
float threshold(int k, int n) {
    auto x = static_cast<float>(static_cast<double>(k) / n);
    const auto is_below = [&](float y) {
        return static_cast<int128>(over_2_to_55(y)) * n < (static_cast<int128>(k) << 55);
    };
    while (is_below(x)) x = std::nextafter(x, 2.0f);
    while (!is_below(std::nextafter(x, 0.0f))) x = std::nextafter(x, 0.0f);
    return x;
}

/// The mean level over an interval of brightness, tone by tone.
long double exact_mean(long double from, long double to, int n) {
    long double sum = 0;
    for (int k = 0; k < n; ++k) {
        const long double begin = k == 0 ? -1e30L : static_cast<long double>(k) / n;
        const long double end = k == n - 1 ? 1e30L : static_cast<long double>(k + 1) / n;
        const long double overlap = std::min(end, to) - std::max(begin, from);
        if (overlap > 0) sum += overlap * k / (n - 1);
    }
    return sum / (to - from);
}

const SurfaceColor some_color{{0.1f, 0.2f, 0.3f}, {0.4f, 0.5f, 0.6f}, vec3(0.8f), {0.01f, 0, 0}};

}  // namespace

TEST(Toon, Eq7_1_BrightnessIsTheLargestComponent) {
    EXPECT_EQ(brightness({0.2f, 0.7f, 0.1f}), 0.7f);
    EXPECT_EQ(brightness({2, 0.7f, 0.1f}), 2);
    EXPECT_EQ(brightness({0, 0, 0.25f}), 0.25f);
    EXPECT_EQ(brightness(vec3(0)), 0);
    EXPECT_EQ(brightness({-1, -2, -0.5f}), 0);
    EXPECT_EQ(brightness(vec3(not_a_number)), 0);
    for (int i = 0; i < 3; ++i) {
        vec3 light(0.5f);
        light[i] = not_a_number;
        EXPECT_EQ(brightness(light), 0.5f);
        light[i] = infinity;
        EXPECT_EQ(brightness(light), infinity);
    }
}

TEST(Toon, Eq7_2_FourTones) {
    for (const auto& [x, tone] : {std::pair{0.0f, 0},
                                  {0.2f, 0},
                                  {0.25f, 1},
                                  {0.49f, 1},
                                  {0.5f, 2},
                                  {0.74f, 2},
                                  {0.75f, 3},
                                  {1.0f, 3},
                                  {2.4f, 3}})
        EXPECT_EQ(tone_of(x, 4), tone) << x;
}

TEST(Toon, Eq7_2_ThresholdsToTheLastBit) {
    for (int n = 1; n <= max_tones; ++n)
        for (int k = 1; k < n; ++k) {
            const float at = threshold(k, n);
            ASSERT_EQ(tone_of(std::nextafter(at, 0.0f), n), k - 1) << k << " of " << n;
            ASSERT_EQ(tone_of(at, n), k) << k << " of " << n;
            ASSERT_EQ(tone_of(std::nextafter(at, 2.0f), n), k) << k << " of " << n;
        }
}

TEST(Toon, Eq7_2_IsExactForAllNumbers) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(0x1p-31f, 1);
    for (int i = 0; i < 1'000'000; ++i) {
        const float x = any(random);
        const int n = 1 + static_cast<int>(random() % max_tones);
        ASSERT_EQ(tone_of(x, n), exact_tone(x, n)) << "seed 1, case " << i;
    }
}

TEST(Toon, Eq7_3_Levels) {
    EXPECT_EQ(level_of(0, 4), 0);
    EXPECT_EQ(level_of(1, 4), 1.0f / 3);
    EXPECT_EQ(level_of(2, 4), 2.0f / 3);
    EXPECT_EQ(level_of(3, 4), 1);
    for (int n = 2; n <= max_tones; ++n) {
        EXPECT_EQ(level_of(0, n), 0);
        EXPECT_EQ(level_of(n - 1, n), 1);
        for (int k = 1; k < n; ++k) ASSERT_GT(level_of(k, n), level_of(k - 1, n));
    }
}

TEST(Toon, HardCase_OneToneIsOneColor) {
    look_up("Eq. 7.3");
    for (const float x : {0.0f, 0.5f, 1.0f, -1.0f, 1e30f, infinity, -infinity, not_a_number}) {
        EXPECT_EQ(quantised(x, 1), 1) << x;
        EXPECT_EQ(smoothly_quantised(x, 0.1f, 1), 1) << x;
    }
}

TEST(Toon, HardCase_255TonesAreNearlySmooth) {
    look_up("Eq. 7.3");
    for (int i = 0; i <= 100'000; ++i) {
        const float x = static_cast<float>(i) / 100'000;
        // Of k / 254 and x from k / 255 to (k + 1) / 255.
        ASSERT_NEAR(quantised(x, 255), x, 1.0 / 255 + FLT_EPSILON) << x;
    }
}

TEST(Toon, HardCase_SpecialBrightnesses) {
    look_up("Eq. 7.2");
    for (int n = 1; n <= max_tones; ++n) {
        for (const float x : {-0.0f, -1.0f, -FLT_MAX, -infinity, not_a_number, FLT_MIN,
                              std::numeric_limits<float>::denorm_min()})
            ASSERT_EQ(tone_of(x, n), 0) << x << ", " << n;
        for (const float x : {1.0f, std::nextafter(1.0f, 2.0f), 1e10f, FLT_MAX, infinity})
            ASSERT_EQ(tone_of(x, n), n - 1) << x << ", " << n;
    }
}

TEST(Toon, Eq7_4_PaintOfALevel) {
    const vec3 around(0.1f, 0.2f, 0.5f);
    // Products and sums of three numbers below 1.
    constexpr float tolerance = 2 * FLT_EPSILON;
    const vec3 painted = toon(some_color, around, {{0.3f, 0.6f, 0.1f}, vec3(0)}, 4);
    const dvec3 expected(0.01 + 0.01 + 0.4 * 2 / 3, 0.04 + 0.5 * 2 / 3, 0.15 + 0.6 * 2 / 3);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(painted[i], expected[i], tolerance);
    EXPECT_EQ(paint(some_color, around, 0, true), vec3(1));
}

TEST(Toon, Eq7_4_ATonesColorDoesNotDependOnTheLights) {
    const vec3 around(0.1f);
    EXPECT_EQ(toon(some_color, around, {{0.6f, 0.1f, 0.2f}, vec3(0)}, 4),
              toon(some_color, around, {{0.5f, 0.5f, 0.7f}, vec3(0)}, 4));
}

TEST(Toon, Eq7_4_HighlightsAreWhiteFromOneHalfOn) {
    SurfaceColor color = some_color;
    const auto painted = [&](float specular) {
        return toon(color, vec3(0.1f), {vec3(0.6f), vec3(specular, 0, 0)}, 4);
    };
    color.specular = vec3(1);
    EXPECT_EQ(painted(min_tone_highlight), vec3(1));
    EXPECT_EQ(painted(10), vec3(1));
    EXPECT_NE(painted(std::nextafter(min_tone_highlight, 0.0f)), vec3(1));
    color.specular = vec3(0.25f);  // the material counts
    EXPECT_EQ(painted(2), vec3(1));
    EXPECT_NE(painted(std::nextafter(2.0f, 0.0f)), vec3(1));
    color.specular = vec3(0);
    EXPECT_EQ(painted(1e30f), painted(0));
}

TEST(Toon, Eq7_5_WorkedExample) {
    // A quarter of a pixel in tone 1, three quarters in tone 2.
    EXPECT_FLOAT_EQ(smoothly_quantised(0.525f, 0.1f, 4), 0.25f / 3 + 0.75f * 2 / 3);
    EXPECT_FLOAT_EQ(smoothly_quantised(0.5f, 0.1f, 4), 0.5f);
    EXPECT_EQ(smoothly_quantised(0.6f, 0.1f, 4), level_of(2, 4));
    EXPECT_FLOAT_EQ(smoothly_quantised(0.5f, 1, 4), 0.5f);
}

TEST(Toon, Eq7_5_IsTheMeanOfTheTones) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> any(-0.3f, 1.3f), octave(-18, 4);
    for (int i = 0; i < 100'000; ++i) {
        const float x = any(random), change = std::exp2(octave(random));
        const int n = 2 + static_cast<int>(random() % (max_tones - 1));
        const long double half = change / 2.0L;
        // Rounded to float once; before, double loses 2^-53 of areas below 10 over the change.
        constexpr long double tolerance = 0x1p-25L + 10 * 0x1p-52L * 0x1p18L;
        ASSERT_LE(std::abs(smoothly_quantised(x, change, n) - exact_mean(x - half, x + half, n)),
                  tolerance)
            << "seed 2, case " << i << ": " << x << ", " << change << ", " << n;
    }
}

TEST(Toon, Eq7_5_WithoutChangeTonesAreHard) {
    for (const float change : {0.0f, -0.0f, not_a_number})
        for (int i = 0; i <= 1000; ++i) {
            const float x = 0.001f * static_cast<float>(i);
            for (const int n : {1, 2, 4, 255})
                ASSERT_EQ(smoothly_quantised(x, change, n), quantised(x, n));
        }
    EXPECT_EQ(highlight_share(min_tone_highlight, 0), 1);
    EXPECT_EQ(highlight_share(std::nextafter(min_tone_highlight, 0.0f), 0), 0);
    EXPECT_EQ(highlight_share(min_tone_highlight, 0.1f), 0.5f);
    EXPECT_FLOAT_EQ(highlight_share(0.525f, 0.1f), 0.75f);
    EXPECT_EQ(highlight_share(0.6f, 0.1f), 1);
    EXPECT_EQ(highlight_share(0.4f, 0.1f), 0);
}

TEST(Toon, Eq7_6_FacingRatio) {
    const vec3 normal(0, 0.6f, 0.8f);
    EXPECT_EQ(facing_ratio({0, 1, 0}, {0, 1, 0}), 1);
    EXPECT_EQ(facing_ratio(normal, {0, 1, 0}), 0.6f);
    EXPECT_EQ(facing_ratio(normal, {1, 0, 0}), 0);
    EXPECT_EQ(facing_ratio(normal, {0, -1, 0}), 0);
    EXPECT_EQ(facing_ratio(vec3(not_a_number), {0, 1, 0}), 0);
    EXPECT_TRUE(is_facing_outline(0.3f, 0.35f));
    EXPECT_FALSE(is_facing_outline(0.35f, 0.35f));
    EXPECT_FALSE(is_facing_outline(0, 0));  // 0: no outline
}
