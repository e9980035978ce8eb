// SPDX-License-Identifier: MIT
// The variants of lesson 06 that docs/accuracy/06_phong.md measures: each keeps what its comment
// says.
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <span>
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
constexpr long double half_ulp = 0x1p-24L;  ///< Of a float, relative.

/// Few triangles, so that each kind of shading has its own light.
const LitSphere& sphere() {
    static const LitSphere sphere(8, 16);
    return sphere;
}

std::vector<vec3> barycentrics_in_triangles(int count) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(0, 1);
    std::vector<vec3> barycentrics;
    for (int i = 0; i < count; ++i) {
        float u = any(random), v = any(random);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        barycentrics.emplace_back(1 - u - v, u, v);
    }
    return barycentrics;
}

std::array<long double, 3> wide(dvec3 v) { return {v.x, v.y, v.z}; }

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

int differing_pixels(const Image<u8vec4>& a, const Image<u8vec4>& b) {
    int differing = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) differing += a.pixels()[i] != b.pixels()[i];
    return differing;
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

TEST(LabPhong, OfALightArrivesWhatIsVisible) {
    const std::array lights{Light{LightKind::point, vec3(1, 2, 3), vec3(0), vec3(0, 2, 0)},
                            Light{LightKind::directional, vec3(4), vec3(0, 1, 0)}};
    for (int x = 0; x < 3; ++x) {
        const vec3 position = ivec3(x, 0, 0);
        const SurfacePoint<float> point{position, vec3(0, 1, 0),
                                        unit_or(vec3(1) - position, vec3(0))};
        const PhongHighlight square{true, 2};
        const auto light = [&](vec2 visibility) {
            return reflected_light(std::span<const Light>(lights), point, square,
                                   [&](std::size_t l) { return visibility[static_cast<int>(l)]; });
        };
        const ReflectedLight first = light({1, 0}), second = light({0, 1}),
                             both = light({0.5f, 0.25f}), whole = light({1, 1});
        EXPECT_GT(first.diffuse.x, 0);
        EXPECT_GT(second.specular.x, 0);
        EXPECT_EQ(both.diffuse, 0.5f * first.diffuse + 0.25f * second.diffuse);
        EXPECT_EQ(both.specular, 0.5f * first.specular + 0.25f * second.specular);
        EXPECT_EQ(light({0, 0}).diffuse, vec3(0));
        EXPECT_EQ(light({0, 0}).specular, vec3(0));
        const ReflectedLight unshadowed =
            reflected_light(std::span<const Light>(lights), point, square);
        EXPECT_EQ(whole.diffuse, unshadowed.diffuse);
        EXPECT_EQ(whole.specular, unshadowed.specular);
    }
}

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
    const std::array<vec3, 3> vertices = {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)};
    for (const Triangle& triangle : sphere().mesh().triangles) {
        const LitTriangle flat = sphere().lit(triangle, {.shading = Shading::flat});
        const LitTriangle gouraud = sphere().lit(triangle, {.shading = Shading::gouraud});
        const LitTriangle phong = sphere().lit(triangle, {});
        std::array<dvec3, 3> at;
        for (std::size_t i = 0; i < 3; ++i) {
            at[i] = sphere().mesh().positions[triangle.vertices[i].position];
            const auto expected =
                static_cast<double>(exact.light_at(wide(at[i] / glm::length(at[i])), wide(at[i])));
            ASSERT_NEAR(grey(gouraud.at(vertices[i])), expected, tolerance);
            ASSERT_NEAR(grey(phong.at(vertices[i])), expected, tolerance);
        }
        const dvec3 across = glm::cross(at[1] - at[0], at[2] - at[0]);
        const auto expected = static_cast<double>(exact.light_at(
            wide(across / glm::length(across)), wide((at[0] + at[1] + at[2]) / 3.0)));
        for (const vec3 barycentrics : vertices)
            ASSERT_NEAR(grey(flat.at(barycentrics)), expected, tolerance);
    }
}

TEST(LabPhong, BetweenTheVerticesFlatStaysAndGouraudIsStraight) {
    constexpr float tolerance = 1e-6f;  // 3 products and 2 sums of numbers below 2
    for (const Triangle& triangle : sphere().mesh().triangles) {
        const LitTriangle flat = sphere().lit(triangle, {.shading = Shading::flat});
        const LitTriangle gouraud = sphere().lit(triangle, {.shading = Shading::gouraud});
        const ReflectedLight of_face = flat.at(vec3(1, 0, 0));
        const ReflectedLight a = gouraud.at(vec3(1, 0, 0));
        const ReflectedLight b = gouraud.at(vec3(0, 1, 0));
        const ReflectedLight c = gouraud.at(vec3(0, 0, 1));
        for (const vec3 w : barycentrics_in_triangles(10)) {
            EXPECT_EQ(flat.at(w).diffuse, of_face.diffuse);
            EXPECT_EQ(flat.at(w).specular, of_face.specular);
            EXPECT_NEAR(gouraud.at(w).diffuse.x,
                        w.x * a.diffuse.x + w.y * b.diffuse.x + w.z * c.diffuse.x, tolerance);
            EXPECT_NEAR(gouraud.at(w).specular.y,
                        w.x * a.specular.y + w.y * b.specular.y + w.z * c.specular.y, tolerance);
        }
    }
}

TEST(LabPhong, BacksAreLitOnlyWhereFrontsAreDark) {
    for (const Shading shading : {Shading::flat, Shading::gouraud, Shading::phong})
        for (const Triangle& triangle : sphere().mesh().triangles) {
            const LitTriangle front = sphere().lit(triangle, {.shading = shading}, false);
            const LitTriangle back = sphere().lit(triangle, {.shading = shading}, true);
            const vec3 middle(1.0f / 3);
            const vec3 vertex(1, 0, 0);
            const vec3 at = shading == Shading::gouraud ? vertex : middle;
            const bool front_is_lit = front.at(at).diffuse.x > 0;
            ASSERT_NE(front_is_lit, back.at(at).diffuse.x > 0);
        }
}

TEST(LabPhong, ThePlaceDecidesHowNearThePictureComes) {
    // What the page says: each place is worse than the next, and the finer mesh is better.
    static const LitSphere coarse(16, 32), fine(64, 128);
    double coarser = 1;
    for (const Shading shading : {Shading::flat, Shading::gouraud, Shading::phong}) {
        const double rms = light_errors(coarse, {.shading = shading}).rms;
        EXPECT_LT(rms, 0.8 * coarser);
        EXPECT_LT(light_errors(fine, {.shading = shading}).rms, 0.3 * rms);
        coarser = rms;
    }
    const LightErrors phong = light_errors(fine, {});
    // The mesh lies up to 1 - cos(1.4 degrees)^2 = .0006 inside of the sphere.
    EXPECT_LT(phong.rms, 0.0006);
    EXPECT_GT(phong.fragments, 100'000);
    EXPECT_GT(phong.brightest, 0.8);
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
    float greatest = 0;
    for (const float exponent : {1.0f, 2.0f, 7.0f, 32.0f, 90.0f, 1000.0f, 1e4f}) {
        float before = 0;
        for (int i = 0; i <= inputs; ++i) {
            const float x = static_cast<float>(i) / inputs;
            const float curve = power_by_schlick(x, exponent), power = std::pow(x, exponent);
            ASSERT_GE(curve, power * (1 - 1e-5f)) << x << '^' << exponent;
            ASSERT_LE(curve, power + 0.204f) << x << '^' << exponent;
            ASSERT_GE(curve, before) << x << '^' << exponent;
            before = curve;
            greatest = std::max(greatest, curve - power);
        }
        EXPECT_EQ(power_by_schlick(0, exponent), 0.0f);
        EXPECT_EQ(power_by_schlick(1, exponent), 1.0f);
    }
    EXPECT_GT(greatest, 0.2f) << "the bound is no wider than it has to be";
}

TEST(LabPhong, NoHighlightIsLeftOutThatCanBeSeen) {
    constexpr float least_seen = 1.0f / 255 / 13 / 2;  // half of the first code of sRGB
    for (const Power how : {Power::polynomial, Power::in_double, Power::squarings, Power::schlick})
        for (const float exponent : {0.0f, 1.0f, 7.0f, 32.0f, 90.0f, 1000.0f})
            for (int i = 0; i <= inputs; ++i) {
                const float cosine = static_cast<float>(i) / inputs;
                const HighlightBy highlight{true, exponent, Highlight::phong, how};
                const float result = highlight(seen_at_cosine(cosine), straight_up);
                const float power = power_as(how, cosine, exponent);
                if (result == power) continue;
                ASSERT_EQ(result, 0) << static_cast<int>(how) << ": " << cosine << '^' << exponent;
                ASSERT_LT(power, least_seen / 1000)
                    << static_cast<int>(how) << ": " << cosine << '^' << exponent;
                ASSERT_NE(how, Power::schlick) << cosine << '^' << exponent;
            }
}

TEST(LabPhong, PowersTakeWhatMaterialsAndRoundingBring) {
    const float above_one = std::nextafter(1.0f, 2.0f);
    for (const Power how :
         {Power::polynomial, Power::in_double, Power::squarings, Power::schlick}) {
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
    EXPECT_LT(shortest, 1 - 0.9 * documented) << "the bound is no wider than it has to be";
    EXPECT_LT(longest, 1 + 1e-6) << "Newton's step comes from below";
    EXPECT_EQ(unit_approximate(vec3(0)), vec3(0));
}

TEST(LabPhong, NormalsAreScaledAsTheVariantSays) {
    // Light that is evenly reflected is proportional to the normal's length.
    const Triangle& triangle = sphere().mesh().triangles[50];
    for (const vec3 barycentrics : barycentrics_in_triangles(100)) {
        vec3 normal(0), position(0);
        for (int k = 0; k < 3; ++k) {
            const Vertex vertex = triangle.vertices[static_cast<std::size_t>(k)];
            normal += barycentrics[k] * sphere().mesh().normals[vertex.normal];
            position += barycentrics[k] * sphere().mesh().positions[vertex.position];
        }
        ASSERT_GT(glm::dot(normal, sphere().lights[0].position_world - position), 0) << "dark";
        const auto diffuse = [&](NormalScaling normals) {
            return sphere().lit(triangle, {.normals = normals}).at(barycentrics).diffuse.x;
        };
        const float exact = diffuse(NormalScaling::exact);
        EXPECT_NEAR(diffuse(NormalScaling::none) / exact, glm::length(normal), 1e-5f);
        EXPECT_NEAR(diffuse(NormalScaling::approximate) / exact, 1, 0.0018f);
    }
}

TEST(LabPhong, EveryOptionDraws) {
    const Image<u8vec4> usual = picture({});
    const auto changed = [&](const std::vector<std::string>& arguments) {
        return differing_pixels(usual, picture(arguments));
    };
    EXPECT_EQ(changed({"--shading", "phong", "--highlight", "phong", "--power", "polynomial",
                       "--normals", "exact", "--light", "point"}),
              0);
    for (const char* shading : {"flat", "gouraud"})
        EXPECT_GT(changed({"--shading", shading}), 1000) << shading;
    EXPECT_GT(differing_pixels(picture({"--shading", "flat"}), picture({"--shading", "gouraud"})),
              1000);
    EXPECT_GT(changed({"--highlight", "blinn"}), 1000);
    EXPECT_GT(changed({"--power", "schlick"}), 1000);
    for (const char* normals : {"approximate", "none"})
        EXPECT_GT(changed({"--normals", normals}), 100) << normals;
    EXPECT_GT(
        differing_pixels(picture({"--normals", "none"}), picture({"--normals", "approximate"})),
        100);
    for (const char* light : {"directional", "spot"})
        EXPECT_GT(changed({"--light", light}), 1000) << light;
    // These compute the same but for rounding, which an 8-bit code may show here and there.
    constexpr int rounded_pixels = 100;
    for (const char* power : {"double", "squarings"})
        EXPECT_LE(changed({"--power", power}), rounded_pixels) << power;
    EXPECT_EQ(changed({"--all-effects"}), 0);
}
