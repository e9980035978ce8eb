// SPDX-License-Identifier: MIT
// The variants of lesson 06 that docs/accuracy/06_phong.md measures: each keeps what its comment
// says.
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "06_phong/phong.hpp"
#include "common/image/image_io.hpp"
#include "lab/shading_methods.hpp"
#include "support/lesson_process.hpp"
#include "support/lit_sphere.hpp"
#include "support/one_triangle.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr int inputs = 100'000;
constexpr Power all_powers[] = {Power::polynomial, Power::in_double, Power::squarings,
                                Power::schlick};
constexpr long double half_ulp = 0x1p-24L;  ///< Of a float, relative.

/// Few triangles, so that each kind of shading has its own light.
const LitSphere& sphere() {
    static const LitSphere sphere(8, 16);
    return sphere;
}

/// How far power() may be off where the result is x: 2 + 2.2 y |log2 x| ulp.
long double of_power(long double x) {
    const long double ulp = std::exp2(std::floor(std::log2(x)) - 23);
    return (2 + 2.2L * std::abs(std::log2(x))) * ulp;
}

constexpr vec3 straight_up(0, 1, 0);

/// A point in light from straight above whose highlight is a power of exactly this cosine.
SurfacePoint<float> seen_at_cosine(float cosine) {
    return {vec3(0), straight_up, vec3(std::sqrt(1 - cosine * cosine), cosine, 0)};
}

/// As what the material of LitSphere makes of it.
float grey(const ReflectedLight& light) {
    return LitSphere::diffuse * light.diffuse.x + LitSphere::specular * light.specular.x;
}

Image<u8vec4> picture(std::vector<std::string> arguments) {
    const std::string out = (fresh_folder("shading_options") / "picture.bmp").string();
    arguments.insert(arguments.end(), {"--size", "640x360", "--out", out});
    const ProcessResult run = run_program("lab_06_phong", arguments);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_EQ(run.err, "");
    return read_image(out);
}

}  // namespace

TEST(LabPhong, TheDefaultIsPhongsHighlight) {
    constexpr ShadingMethod variant;
    for (const float shininess : {0.0f, 1.0f, 7.5f, 90.0f, 1000.0f}) {
        const PhongHighlight usual{true, shininess};
        const HighlightBy highlight{true, shininess, variant.highlight, variant.power};
        for (int i = 0; i <= inputs; ++i) {
            const SurfacePoint<float> point =
                seen_at_cosine(static_cast<float>(i) / static_cast<float>(inputs));
            ASSERT_EQ(highlight(point, straight_up), usual(point, straight_up)) << i;
        }
    }
}

TEST(LabPhong, EveryShadingIsThatOfTheSurfaceWhereItIsComputed) {
    // A highlight of 90 makes 90 of each half ulp that its cosine is off, and that has a dozen.
    constexpr double tolerance = 1e-4;
    const ExactSphere exact(sphere());
    for (const Triangle& triangle : sphere().mesh().triangles) {
        const LitTriangle flat = sphere().lit(triangle, {.shading = Shading::flat});
        const LitTriangle gouraud = sphere().lit(triangle, {.shading = Shading::gouraud});
        const LitTriangle phong = sphere().lit(triangle, {});
        std::array<dvec3, 3> at;
        vec3 of_vertices(0);
        for (int i = 0; i < 3; ++i) {
            const auto v = static_cast<std::size_t>(i);
            at[v] = sphere().mesh().positions[triangle.vertices[v].position];
            const auto expected =
                static_cast<double>(exact.light_at(at[v] / glm::length(at[v]), at[v]));
            ASSERT_NEAR(grey(gouraud.at(mat3(1)[i])), expected, tolerance);
            ASSERT_NEAR(grey(phong.at(mat3(1)[i])), expected, tolerance);
            of_vertices[i] = grey(gouraud.at(mat3(1)[i]));
        }
        const dvec3 across = glm::cross(at[1] - at[0], at[2] - at[0]);
        const auto of_face = static_cast<double>(
            exact.light_at(across / glm::length(across), (at[0] + at[1] + at[2]) / 3.0));
        for (const vec3 w :
             {vec3(0.25f, 0.5f, 0.25f), vec3(0.125f, 0.25f, 0.625f), vec3(0, 0.75f, 0.25f)}) {
            ASSERT_NEAR(grey(flat.at(w)), of_face, tolerance) << "the same all over a face";
            // 3 products and 2 sums of numbers below 2, twice.
            ASSERT_NEAR(grey(gouraud.at(w)), glm::dot(w, of_vertices), 2e-6)
                << "straight between the vertices";
        }
    }
}

TEST(LabPhong, BacksAreLitOnlyWhereFrontsAreDark) {
    for (const Shading shading : {Shading::flat, Shading::gouraud, Shading::phong})
        for (const Triangle& triangle : sphere().mesh().triangles) {
            const LitTriangle front = sphere().lit(triangle, {.shading = shading}, false);
            const LitTriangle back = sphere().lit(triangle, {.shading = shading}, true);
            const vec3 at = shading == Shading::gouraud ? vec3(1, 0, 0) : vec3(1.0f / 3);
            ASSERT_NE(front.at(at).diffuse.x > 0, back.at(at).diffuse.x > 0) << int(shading);
        }
}

TEST(LabPhong, PowersAreWithinTheirBounds) {
    for (const float exponent : {1.0f, 2.0f, 7.0f, 32.0f, 90.0f, 1000.0f}) {
        for (int i = 0; i <= inputs; ++i) {
            const float x = static_cast<float>(i) / inputs;
            const long double power = std::pow(static_cast<long double>(x), exponent);
            const auto error = [&](Power how) {
                return std::abs(power_as(how, x, exponent) - power);
            };
            if (power < std::numeric_limits<float>::min()) {
                for (const Power how : {Power::polynomial, Power::squarings})
                    EXPECT_LE(power_as(how, x, exponent), 2e-38f) << x << '^' << exponent;
                continue;
            }
            // A power rounded twice, and one as power() promises it.
            ASSERT_LE(error(Power::in_double), 1.0001L * half_ulp * power) << x << '^' << exponent;
            ASSERT_LE(error(Power::polynomial), of_power(power)) << x << '^' << exponent;
            ASSERT_LE(error(Power::squarings), 1.01L * exponent * half_ulp * power)
                << x << '^' << exponent;
        }
    }
}

TEST(LabPhong, SchlicksCurveLiesAboveThePower) {
    for (const float exponent : {1.0f, 2.0f, 7.0f, 32.0f, 90.0f, 1000.0f, 1e4f}) {
        float before = 0;
        for (int i = 0; i <= inputs; ++i) {
            const float x = static_cast<float>(i) / inputs;
            const float curve = power_by_schlick(x, exponent), power = std::pow(x, exponent);
            ASSERT_GE(curve, power * (1 - 1e-5f)) << x << '^' << exponent;
            ASSERT_LE(curve, power + 0.204f) << x << '^' << exponent;
            ASSERT_GE(curve, before) << x << '^' << exponent;
            before = curve;
        }
        EXPECT_EQ(power_by_schlick(0, exponent), 0.0f);
        EXPECT_EQ(power_by_schlick(1, exponent), 1.0f);
    }
}

TEST(LabPhong, PowersTakeWhatMaterialsAndRoundingBring) {
    const float above_one = std::nextafter(1.0f, 2.0f);
    for (const Power how : all_powers) {
        for (const float x : {0.0f, 0.5f, 1.0f}) EXPECT_EQ(power_as(how, x, 0), 1.0f);
        for (const float x : {0.0f, 0.25f, 1.0f}) EXPECT_EQ(power_as(how, x, 1), x);
        for (const float exponent : {1.0f, 1000.0f, 1e4f}) {
            EXPECT_EQ(power_as(how, 0, exponent), 0.0f);
            EXPECT_NEAR(power_as(how, above_one, exponent), 1.0f, 2e-3f);  // 1e4 ulp
        }
    }
    EXPECT_EQ(power_by_schlick(above_one, 0x1p23f), 1.0f) << "divided by 0";
    EXPECT_EQ(power_by_squarings(0.5f, 2.6f), 0.125f) << "rounded to 3";
    EXPECT_EQ(power_by_squarings(0.5f, 2.4f), 0.25f) << "rounded to 2";
    EXPECT_EQ(power_by_squarings(0.5f, 1e30f), 0.0f);
}

TEST(LabPhong, ApproximateNormalsHaveNearlyLength1AndTheirDirection) {
    constexpr double documented = 0.0018;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(-1, 1), power(-12, 12);
    double shortest = 1, longest = 1;
    for (int i = 0; i < inputs; ++i) {
        const vec3 v = std::pow(10.0f, power(random)) * vec3(any(random), any(random), any(random));
        if (v == vec3(0)) continue;
        const dvec3 unit = dvec3(unit_approximate(v));
        shortest = std::min(shortest, glm::length(unit));
        longest = std::max(longest, glm::length(unit));
        const dvec3 direction = glm::normalize(dvec3(v));
        ASSERT_LT(glm::length(glm::cross(unit, direction)), 1e-7);
        ASSERT_GT(glm::dot(unit, direction), 0);
    }
    EXPECT_GT(shortest, 1 - documented);
    EXPECT_LT(longest, 1 + 1e-6) << "Newton's step comes from below";
    EXPECT_EQ(unit_approximate(vec3(0)), vec3(0));
}

TEST(LabPhong, EveryOptionDraws) {
    const Image<u8vec4> usual = picture({});
    const auto changed = [&](const std::vector<std::string>& arguments) {
        const Image<u8vec4> other = picture(arguments);
        int pixels = 0;
        for (std::size_t i = 0; i < usual.pixels().size(); ++i)
            pixels += usual.pixels()[i] != other.pixels()[i];
        return pixels;
    };
    EXPECT_EQ(changed({"--shading", "phong", "--highlight", "phong", "--power", "polynomial",
                       "--normals", "exact", "--light", "point", "--all-effects"}),
              0);
    for (const auto& [option, word] : {std::pair{"--shading", "flat"},
                                       {"--shading", "gouraud"},
                                       {"--highlight", "blinn"},
                                       {"--power", "schlick"},
                                       {"--normals", "none"},
                                       {"--light", "directional"},
                                       {"--light", "spot"}})
        EXPECT_GT(changed({option, word}), 1000) << option << " " << word;
    for (const char* normals : {"approximate", "none"})
        EXPECT_GT(changed({"--normals", normals}), 100) << normals;
    // These compute the same but for rounding, which an 8-bit code may show here and there.
    for (const char* power : {"double", "squarings"})
        EXPECT_LE(changed({"--power", power}), 100) << power;
}
