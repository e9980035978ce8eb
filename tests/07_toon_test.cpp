// SPDX-License-Identifier: MIT
// Tones: their thresholds to the last bit, the colours that are painted, and pixels with several
// tones. The inverted hull: 07_toon_hull_test.cpp; edge detection: 07_toon_edges_test.cpp; whole
// pictures: 07_toon_scene_test.cpp.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "07_toon/toon.hpp"
#include "common/math/numerics.hpp"
#include "lab/toon_methods.hpp"
#include "support/cases.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/printers.hpp"
#include "support/special_numbers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// The least float at or above k / n.
float threshold(int k, int n) {
    // Exact: 24 binary digits times 8.
    const auto is_below = [&](float x) { return double{x} * n < k; };
    auto x = static_cast<float>(static_cast<double>(k) / n);
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
    EXPECT_EQ(brightness(vec3(0.7f, 0.68f, 0.6f)), 0.7f);
    EXPECT_EQ(brightness(vec3(0.2f, 0.7f, 0.1f)), 0.7f);
    EXPECT_EQ(brightness(vec3(0, 0, 0.25f)), 0.25f);
    EXPECT_EQ(brightness(vec3(2, 0.7f, 0.1f)), 2);
    EXPECT_EQ(brightness(vec3(-1, -2, -0.5f)), 0);
    EXPECT_EQ(brightness(vec3(not_a_number)), 0);
    for (int i = 0; i < 3; ++i) {
        vec3 light(0.5f);
        light[i] = not_a_number;
        EXPECT_EQ(brightness(light), 0.5f) << "of " << shown(light);
        light[i] = infinity;
        EXPECT_EQ(brightness(light), infinity) << "of " << shown(light);
    }
}

TEST(Toon, Eq7_2_FourTones) {
    for (const auto& [x, tone] : {std::pair{0.0f, 0},
                                  {0.1f, 0},
                                  {0.25f, 1},
                                  {0.49f, 1},
                                  {0.5f, 2},
                                  {0.7f, 2},
                                  {0.75f, 3},
                                  {1.0f, 3},
                                  {2.4f, 3}})
        ASSERT_EQ(tone_of(x, 4), tone) << "the tone of the brightness " << x << ", of 4";
}

TEST(Toon, Eq7_2_ThresholdsToTheLastBit) {
    EXPECT_EQ(tone_of(0.7f, 10), 6)
        << "the float 0.7 is 0.699999988, below 7/10; in float, ten times that is rounded to 7";
    for (int n = 1; n <= max_tones; ++n)
        for (int k = 1; k < n; ++k) {
            const float at = threshold(k, n), below = std::nextafter(at, 0.0f);
            const std::string what = ", of " + std::to_string(n) + " tones; the threshold is " +
                                     std::to_string(k) + "/" + std::to_string(n) +
                                     ", and the least float there is " + shown(at);
            ASSERT_EQ(tone_of(below, n), k - 1) << "the tone of " << shown(below) << what;
            ASSERT_EQ(tone_of(at, n), k) << "the tone of " << shown(at) << what;
        }
}

TEST(Toon, Eq7_3_Levels) {
    EXPECT_EQ(level_of(1, 4), 1.0f / 3);
    EXPECT_EQ(level_of(3, 4), 1) << "the brightest of 4 tones is full light";
    EXPECT_EQ(level_of(0, 1), 1) << "a single tone is full light";
    for (int n = 2; n <= max_tones; ++n)
        for (int k = 0; k < n; ++k)
            ASSERT_FLOAT_EQ(level_of(k, n) * static_cast<float>(n - 1), static_cast<float>(k))
                << "the level of the tone " << k << " of " << n << ", times " << n - 1;
}

TEST(Toon, HardCase_OneToneIsOneColor) {
    look_up("Eq. 7.3");
    for (const float x : {0.0f, 0.5f, 1.0f, -1.0f, 1e30f, infinity, -infinity, not_a_number}) {
        ASSERT_EQ(quantised(x, 1), 1) << "brightness " << x;
        ASSERT_EQ(smoothly_quantised(x, 0.1f, 1), 1) << "brightness " << x;
    }
}

TEST(Toon, HardCase_SpecialBrightnesses) {
    look_up("Eq. 7.2");
    for (int n = 1; n <= max_tones; ++n) {
        for (const float x : {-0.0f, -1.0f, -FLT_MAX, -infinity, not_a_number, FLT_MIN,
                              std::numeric_limits<float>::denorm_min()})
            ASSERT_EQ(tone_of(x, n), 0) << "brightness " << x << ", of " << n << " tones";
        for (const float x : {1.0f, std::nextafter(1.0f, 2.0f), 1e10f, FLT_MAX, infinity})
            ASSERT_EQ(tone_of(x, n), n - 1) << "brightness " << x << ", of " << n << " tones";
    }
}

TEST(Toon, Eq7_4_ExampleOfACoat) {
    const SurfaceColor coat{{0.8f, 0.13f, 0.06f}, {0.8f, 0.13f, 0.06f}, vec3(0.7f), vec3(0)};
    const vec3 painted = toon(coat, toon_ambient_light, {{0.7f, 0.68f, 0.6f}, vec3(0)}, 4);
    EXPECT_TRUE(are_near(painted, {0.6533, 0.1062, 0.0532}, 0.00005))
        << "toon() of the robot's coat in the diffuse light (0.7, 0.68, 0.6), of 4 tones: Ka = Kd "
           "= (0.8, 0.13, 0.06), Ia = (0.15, 0.15, 0.22)";
    for (const auto& [degrees, is_seen] : {std::pair{7.35, true}, {7.45, false}}) {
        const double specular = std::pow(std::cos(glm::radians(degrees)), 40);
        EXPECT_EQ(is_highlight(coat, {vec3(0), vec3(dvec3(specular))}), is_seen)
            << "Ks = 0.7, specular light " << specular << ": together about 1/2";
    }
}

TEST(Toon, Eq7_4_PaintOfALevel) {
    const vec3 around(0.1f, 0.2f, 0.5f);
    const vec3 painted = toon(some_color, around, {{0.3f, 0.6f, 0.1f}, vec3(0)}, 4);
    const dvec3 expected(0.01 + 0.01 + 0.4 * 2 / 3, 0.04 + 0.5 * 2 / 3, 0.15 + 0.6 * 2 / 3);
    // Products and sums of three numbers below 1.
    EXPECT_TRUE(are_near(painted, expected, 2 * FLT_EPSILON))
        << "toon() in the diffuse light (0.3, 0.6, 0.1), tone 2 of 4, level 2/3: Ke + Ka Ia + Kd "
           "2/3 of Ka = (0.1, 0.2, 0.3), Kd = (0.4, 0.5, 0.6), Ke = (0.01, 0, 0), Ia = (0.1, 0.2, "
           "0.5)";
    EXPECT_EQ(toon(some_color, around, {{0.5f, 0.5f, 0.7f}, vec3(0)}, 4), painted)
        << "a tone has one color in any light: both lights are in tone 2 of 4";
    EXPECT_EQ(paint(some_color, around, 0, true), vec3(1)) << "white in a highlight";
}

TEST(Toon, Eq7_4_HighlightsAreWhiteFromOneHalfOn) {
    SurfaceColor color = some_color;
    const auto painted = [&](float specular) {
        return toon(color, vec3(0.1f), {vec3(0.6f), vec3(specular, 0, 0)}, 4);
    };
    color.specular = vec3(1);
    EXPECT_EQ(painted(min_tone_highlight), vec3(1)) << "Ks = 1, specular light 1/2";
    EXPECT_NE(painted(std::nextafter(min_tone_highlight, 0.0f)), vec3(1))
        << "Ks = 1, specular light just below 1/2";
    color.specular = vec3(0.25f);  // the material counts
    EXPECT_EQ(painted(2), vec3(1)) << "Ks = 1/4, specular light 2: together 1/2";
    EXPECT_NE(painted(std::nextafter(2.0f, 0.0f)), vec3(1))
        << "Ks = 1/4, specular light just below 2: together below 1/2";
    color.specular = vec3(0);
    EXPECT_EQ(painted(1e30f), painted(0)) << "Ks = 0: no highlight in any light";
}

TEST(Toon, Eq7_5_ExamplesOnAndBesideAThreshold) {
    constexpr float tolerance = 2 * FLT_EPSILON;  // 0.27f and 0.1f are rounded, too
    EXPECT_NEAR(smoothly_quantised(0.25f, 0.1f, 4), 1 / 6.0, tolerance);
    EXPECT_NEAR(smoothly_quantised(0.27f, 0.1f, 4), 0.7 / 3, tolerance);
    EXPECT_NEAR(smoothly_quantised(0.31f, 0.1f, 4), 1 / 3.0, tolerance);
    EXPECT_FLOAT_EQ(smoothly_quantised(0.525f, 0.1f, 4), 0.25f / 3 + 0.75f * 2 / 3)
        << "a quarter of a pixel in tone 1, three quarters in tone 2";
}

TEST(Toon, Eq7_5_IsTheMeanOfTheTones) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> any(-0.3f, 1.3f), octave(-18, 4);
    for (int i = 0; i < cases_of(100'000); ++i) {
        const float x = any(random), change = std::exp2(octave(random));
        const int n = 2 + static_cast<int>(random() % (max_tones - 1));
        const long double half = change / 2.0L, mean = exact_mean(x - half, x + half, n);
        // Rounded to float once; before, double loses 2^-53 of areas below 10 over the change.
        constexpr long double tolerance = 0x1p-25L + 10 * 0x1p-52L * 0x1p18L;
        const float found = smoothly_quantised(x, change, n);
        ASSERT_LE(std::abs(found - mean), tolerance)
            << "smoothly_quantised(" << shown(x) << ", " << shown(change) << ", " << n << ") is "
            << shown(found) << " instead of " << mean
            << "; it is given: see tone_of() and level_of(); seed 2, case " << i;
    }
}

TEST(Toon, Eq7_5_BeyondAllTonesTheLevelIsExact) {
    for (const float change : {0.5f, 1e-3f, 0x1p-60f}) {
        EXPECT_EQ(smoothly_quantised(1.3f, change, 7), 1) << "above 1; change " << change;
        EXPECT_EQ(smoothly_quantised(-0.3f, change, 7), 0) << "below 0; change " << change;
    }
    EXPECT_EQ(smoothly_quantised(0.3f, infinity, 7), 0.5f);
    EXPECT_NEAR(smoothly_quantised(4e14f, 2e15f, 4), 0.7, 1e-6)
        << "all of the pixel but three tenths is above 1, by far";
    EXPECT_LE(smoothly_quantised(0.854115427f, 2.4e-16f, 4), 1)
        << "a change that is lost in the brightness";
}

TEST(Toon, Eq7_5_WithoutChangeTonesAreHard) {
    for (const float change : {0.0f, -0.0f, not_a_number})
        for (const float x : {0.2f, 0.25f, 0.5f, 1.0f})
            ASSERT_EQ(smoothly_quantised(x, change, 4), quantised(x, 4))
                << "brightness " << x << ", change " << change << ", of 4 tones";
    EXPECT_EQ(highlight_share(min_tone_highlight, 0), 1);
    EXPECT_EQ(highlight_share(std::nextafter(min_tone_highlight, 0.0f), 0), 0);
    EXPECT_EQ(highlight_share(min_tone_highlight, 0.1f), 0.5f);
    EXPECT_FLOAT_EQ(highlight_share(0.525f, 0.1f), 0.75f);
    EXPECT_EQ(highlight_share(0.6f, 0.1f), 1);
    EXPECT_EQ(highlight_share(0.4f, 0.1f), 0);
}

TEST(Toon, Eq7_6_FacingRatio) {
    const vec3 normal(0, 0.6f, 0.8f);
    EXPECT_EQ(facing_ratio({0, 1, 0}, {0, 1, 0}), 1) << "N = V";
    EXPECT_EQ(facing_ratio(normal, {0, 1, 0}), 0.6f) << "N = (0, 0.6, 0.8), V = (0, 1, 0)";
    EXPECT_EQ(facing_ratio(normal, {1, 0, 0}), 0) << "N at a right angle to V";
    EXPECT_EQ(facing_ratio(normal, {0, -1, 0}), 0) << "N leads away from V";
    EXPECT_EQ(facing_ratio(vec3(not_a_number), {0, 1, 0}), 0) << "N is NaN";
    EXPECT_TRUE(is_facing_outline(0.3f, 0.35f)) << "a ratio of 0.3 is below 0.35: ink";
    EXPECT_FALSE(is_facing_outline(0.35f, 0.35f)) << "a ratio of 0.35 is not below 0.35";
    EXPECT_FALSE(is_facing_outline(0, 0)) << "no ratio is below 0: no outline";
}
