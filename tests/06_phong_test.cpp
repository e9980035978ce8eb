// SPDX-License-Identifier: MIT
// The model: the worked numbers of the derivation, its properties and its hard cases. Numbers of
// all sizes: 06_phong_math_test.cpp; materials and pictures: 06_phong_scene_test.cpp.
#include <array>
#include <cfloat>
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "06_phong/light.hpp"
#include "06_phong/normals.hpp"
#include "06_phong/phong.hpp"
#include "lab/shading_methods.hpp"
#include "support/light_in_words.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/one_triangle.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr float in_three_digits = 0.0005f;  // the derivation's numbers are written so
constexpr vec3 up(0, 1, 0);
constexpr vec3 slanted(0.6f, 0.8f, 0);  // the derivation's L

/// In the plane of x and y, so many degrees from up.
vec3 from_up(double degrees) {
    return vec3(dvec3(std::sin(glm::radians(degrees)), std::cos(glm::radians(degrees)), 0));
}

class Directions {
  public:
    explicit Directions(unsigned seed) : random_(seed) {}

    float between(float least, float most) {
        return std::uniform_real_distribution<float>(least, most)(random_);
    }
    vec3 vector() {
        const float x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);
        return {x, y, z};
    }
    vec3 direction() {
        for (;;)
            if (const vec3 v = vector(); glm::dot(v, v) > 0.01f) return normalize_or(v, up);
    }

  private:
    std::mt19937 random_;
};

ReflectedLight light_on(const SurfacePoint<float>& point, const Light& light, float shininess) {
    return reflected_light(std::span(&light, 1), point, PhongHighlight{true, shininess});
}

float phong_cosine(vec3 normal, vec3 toward_light, vec3 toward_eye) {
    return rasterbook::phong_cosine<float>({vec3(0), normal, toward_eye}, toward_light);
}

float blinn_cosine(vec3 normal, vec3 toward_light, vec3 toward_eye) {
    return rasterbook::blinn_cosine({vec3(0), normal, toward_eye}, toward_light);
}

/// How far power() may be off where the result is x: what log2 is off counts y |log2 x| times.
double of_power(double x) { return (2 + 2 * std::abs(std::log2(x))) * FLT_EPSILON * x; }

Material shining(float shininess) {
    Material material;
    material.specular = vec3(1);
    material.shininess = shininess;
    return material;
}

constexpr std::array<vec3, 3> vertices_of_floor = {vec3(0, 0, 0), vec3(0, 0, 1), vec3(1, 0, 0)};

}  // namespace

TEST(Phong, Eq6_1_ExampleOfSlantedLight) {
    const SurfacePoint<float> point{vec3(0), up, up};
    const auto arriving = [&](vec3 toward) {
        return light_on(point, sun(toward, {1, 0.5f, 0}), 1).diffuse;
    };
    const char* what = "diffuse light of a directional light of color (1, 0.5, 0), N = (0, 1, 0)";
    EXPECT_EQ(arriving(slanted), vec3(0.8f, 0.4f, 0)) << what << ", L = (0.6, 0.8, 0)";
    EXPECT_TRUE(are_near(arriving(from_up(60)), {0.5, 0.25, 0}, FLT_EPSILON))
        << what << ", L 60 degrees from N";
    EXPECT_EQ(arriving({1, 0, 0}), vec3(0)) << what << ", L = (1, 0, 0), along the surface";
    EXPECT_EQ(arriving(from_up(120)), vec3(0)) << what << ", L 120 degrees from N: from behind";
}

TEST(Phong, Eq6_2_ExampleOfAMirror) {
    EXPECT_EQ(reflected(up, slanted), vec3(-0.6f, 0.8f, 0))
        << "R for N = (0, 1, 0) and L = (0.6, 0.8, 0)";
}

TEST(Phong, Eq6_3_ExamplesOfTheTable) {
    struct Row {
        double degrees;
        float powers[3];
    };
    for (const auto& [degrees, powers] :
         {Row{0, {1, 1, 1}}, Row{5, {0.963f, 0.710f, 0.022f}}, Row{10, {0.858f, 0.252f, 0}},
          Row{20, {0.537f, 0.004f, 0}}})
        for (int i = 0; i < 3; ++i) {
            constexpr float shininess[] = {10, 90, 1000};
            // The mirror direction of slanted, turned away.
            const SurfacePoint<float> point{vec3(0), up, from_up(degrees - 36.8698976458440)};
            ASSERT_NEAR(light_on(point, sun(slanted), shininess[i]).specular.x, powers[i],
                        in_three_digits)
                << "the highlight, " << degrees << " degrees between R and V, n = " << shininess[i]
                << ": L = (0.6, 0.8, 0), " << described(point);
        }
}

TEST(Phong, Eq6_3_LightFromBehindHasNoHighlight) {
    const SurfacePoint<float> point{vec3(0), up, {-1, 0, 0}};
    const ReflectedLight light = light_on(point, sun({0.995f, -0.1f, 0}), 90);
    EXPECT_EQ(light.specular, vec3(0))
        << "N = (0, 1, 0), L = (0.995, -0.1, 0), V = (-1, 0, 0): R.V is 0.995, but N.L < 0";
}

TEST(Phong, Eq6_4_ExampleOfHalfway) {
    EXPECT_EQ(phong_cosine(up, slanted, up), 0.8f) << "N = V = (0, 1, 0), L = (0.6, 0.8, 0)";
    EXPECT_NEAR(blinn_cosine(up, slanted, up), 1.8 / std::sqrt(3.6), FLT_EPSILON)
        << "N = V = (0, 1, 0), L = (0.6, 0.8, 0)";
}

TEST(Phong, Eq6_5_GlazeOfTheTeapot) {
    const SurfaceColor glaze{{0.03f, 0.25f, 0.3f}, {0.03f, 0.25f, 0.3f}, vec3(0.45f), vec3(0)};
    const SurfacePoint<float> point{vec3(0), up, from_up(10 - 36.8698976458440)};
    const vec3 sent = phong(glaze, {0.04f, 0.05f, 0.07f}, light_on(point, sun(slanted), 90));
    EXPECT_TRUE(are_near(sent, {0.139, 0.326, 0.374}, in_three_digits))
        << "phong() of the glaze in the example: N.L = 0.8, 10 degrees between R and V, n = 90";
}

TEST(Phong, Eq6_5_EachColorCountsWhereItShould) {
    const SurfaceColor color{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}};
    const char* what =
        "of ambient (1, 2, 3), diffuse (4, 5, 6), specular (7, 8, 9), emission (10, 11, 12)";
    EXPECT_EQ(phong(color, vec3(1), {}), vec3(11, 13, 15)) << what << ": emission and ambient";
    EXPECT_EQ(phong(color, {1, 2, 3}, {{4, 5, 6}, {7, 8, 9}}),
              vec3(10 + 1 + 16 + 49, 11 + 4 + 25 + 64, 12 + 9 + 36 + 81))
        << what << ": all";
    EXPECT_EQ(unlit(color), vec3(14, 16, 18)) << what << ": emission and diffuse color";
}

TEST(Phong, Eq6_5_ATextureTintsDiffuseAndAmbientLight) {
    SurfaceColor color{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}};
    color.tint({0.5f, 2, 0});
    EXPECT_EQ(color.ambient, vec3(0.5f, 4, 0));
    EXPECT_EQ(color.diffuse, vec3(2, 10, 0));
    EXPECT_EQ(color.specular, vec3(7, 8, 9));
    EXPECT_EQ(color.emission, vec3(10, 11, 12));
}

TEST(Phong, Eq6_5_AmbientIsAtMostDiffuse) {
    Material material;
    material.ambient = {1, 0.1f, 0.5f}, material.diffuse = {0.2f, 0.3f, 0.5f};
    material.specular = {0.4f, 0.5f, 0.6f}, material.emission = {0.7f, 0.8f, 0.9f};
    const SurfaceColor color = surface_color(material);
    EXPECT_EQ(color.ambient, vec3(0.2f, 0.1f, 0.5f))
        << "of Ka = (1, 0.1, 0.5) and Kd = (0.2, 0.3, 0.5), the smaller of each";
    EXPECT_EQ(color.diffuse, material.diffuse);
    EXPECT_EQ(color.specular, material.specular);
    EXPECT_EQ(color.emission, material.emission);
}

TEST(Phong, Eq6_5_VisibilityIsAskedOnlyWhereTheLightCounts) {
    const SurfacePoint<float> point{vec3(0), up, up};
    for (const auto& [what, light, counts] : {std::tuple{"above", sun(slanted), true},
                                              {"below", sun(-slanted), false},
                                              {"above, but black", sun(slanted, vec3(0)), false}}) {
        const std::array lights = {sun(up), light};
        int times = 0;
        const auto visibility = [&](std::size_t l) {
            times += l == 1;
            return l == 1 ? 0.5f : 0.0f;
        };
        const ReflectedLight half = reflected_light(std::span<const Light>(lights), point,
                                                    PhongHighlight{true, 8}, visibility);
        EXPECT_EQ(times, counts ? 1 : 0)
            << "times that its visibility is asked for: a sun " << what;
        const ReflectedLight whole = light_on(point, light, 8);
        EXPECT_EQ(half.diffuse, 0.5f * whole.diffuse) << "half hidden: a sun " << what;
        EXPECT_EQ(half.specular, 0.5f * whole.specular) << "half hidden: a sun " << what;
    }
}

TEST(Phong, Eq6_6_AnExampleOfDistances) {
    const Light light{LightKind::point, vec3(1), up, {1, 2, 3}, 4};
    for (const auto& [half_distances, share] :
         {std::pair{1.0f, 0.5f}, {2.0f, 0.2f}, {3.0f, 0.1f}, {10.0f, 1 / 101.0f}}) {
        ASSERT_EQ(distance_attenuation<float>({0, half_distances, 0}), share)
            << half_distances << " half distances away";
        const Incoming<float> incoming = incoming_light(light, vec3{1, 2 - 4 * half_distances, 3});
        ASSERT_EQ(incoming.color, vec3(share))
            << half_distances << " half distances below a " << described(light);
        ASSERT_EQ(incoming.toward, up) << "to the light, from the surface below it";
    }
    EXPECT_EQ(distance_attenuation(vec3(0)), 1) << "at the light";
}

TEST(Phong, Eq6_7_AnExampleOfSpots) {
    EXPECT_EQ(spot_attenuation(0.25f, 1, 0), 0.15625f);
    EXPECT_EQ(spot_attenuation(0.5f, 1, 0), 0.5f);
    EXPECT_EQ(spot_attenuation(0.75f, 1, 0), 0.84375f);
    EXPECT_EQ(spot_attenuation(0.96f, 0.95f, 0.85f), 1) << "full light from the cosine 0.95 on";
    EXPECT_EQ(spot_attenuation(0.85f, 0.95f, 0.85f), 0) << "no light up to the cosine 0.85";
    EXPECT_EQ(spot_attenuation(-1.0f, 0.95f, 0.85f), 0) << "no light up to the cosine 0.85";
    const auto cosine_of = [](float degrees) { return std::cos(glm::radians(degrees)); };
    EXPECT_NEAR(spot_attenuation(cosine_of(25), cosine_of(18), cosine_of(32)), 0.598f,
                in_three_digits)
        << "at 25 degrees, between 18 and 32";
}

TEST(Phong, Eq6_7_ASpotlightIsAPointLightThatShinesOneWay) {
    Light spot{LightKind::spot, vec3(1), -up, {0, 4, 0}, 4, 0.95f, 0.85f};
    const std::string what = ": " + described(spot);
    EXPECT_EQ(incoming_light(spot, vec3(0)).color, vec3(0.5f)) << "below it" << what;
    EXPECT_EQ(incoming_light(spot, vec3{0, 8, 0}).color, vec3(0)) << "behind it" << what;
    EXPECT_EQ(incoming_light(spot, vec3{4, 4, 0}).color, vec3(0)) << "beside it" << what;
    EXPECT_EQ(incoming_light(spot, vec3{0, 8, 0}).toward, -up) << "to the light" << what;
    spot.kind = LightKind::point;
    EXPECT_EQ(incoming_light(spot, vec3{4, 4, 0}).color, vec3(0.5f))
        << "beside a " << described(spot);
    EXPECT_EQ(incoming_light(spot, vec3{4, 4, 0}).toward, vec3(-1, 0, 0))
        << "to the light, beside a " << described(spot);
}

TEST(Phong, Eq6_8_AnExampleOfNormalsBetweenVertices) {
    const vec3 middle(0.5f, 0, 0.5f);
    const std::array light = {sun(up)};
    const auto at_middle = [&](double apart, NormalScaling scaling) {
        ShadingMethod variant;
        variant.normals = scaling;
        const OneTriangle triangle(vertices_of_floor, {from_up(-apart / 2), up, from_up(apart / 2)},
                                   shining(90), variant);
        return triangle.light_at(middle, light, {0.5f, 1, 0});  // straight above
    };
    EXPECT_NEAR(at_middle(40, NormalScaling::exact).diffuse.x, 1, 3 * FLT_EPSILON)
        << "diffuse light halfway between normals 40 degrees apart";
    EXPECT_NEAR(at_middle(40, NormalScaling::none).diffuse.x, 0.940f, in_three_digits)
        << "the same where the interpolated normal is not scaled";
    // 90 times what the cosine is off.
    EXPECT_NEAR(at_middle(10, NormalScaling::exact).specular.x, 1, 90 * 4 * FLT_EPSILON)
        << "the highlight halfway between normals 10 degrees apart";
    EXPECT_NEAR(at_middle(10, NormalScaling::none).specular.x, 0.252f, in_three_digits)
        << "the same where the interpolated normal is not scaled";
}

TEST(Phong, Eq6_8_PositionsBetweenVertices) {
    // A point light above a far vertex of the floor: light depends on where the point is.
    const Light light{LightKind::point, vec3(1), up, {1, 1, 0}, 1};
    const OneTriangle triangle(vertices_of_floor, {up, up, up}, shining(2));
    const vec3 barycentrics(0.25f, 0.25f, 0.5f), position(0.5f, 0, 0.25f), eye(3, 5, 2);
    const vec3 toward_eye = normalize_or(eye - position, up);
    const ReflectedLight expected = light_on({position, up, toward_eye}, light, 2);
    const ReflectedLight actual = triangle.light_at(barycentrics, std::span(&light, 1), eye);
    EXPECT_EQ(actual.diffuse, expected.diffuse) << "in a " << described(light);
    EXPECT_TRUE(are_near(actual.specular, dvec3(expected.specular), 4 * FLT_EPSILON))  // of V
        << "in a " << described(light);
}

TEST(Phong, HardCase_LightAlongTheSurfaceOrFromBehind) {
    look_up("Eq. 6.3");
    // The eye is where the mirror sends the light: were it not from behind, it would shine.
    for (const float degrees : {90.0f, 90.1f, 100.0f, 135.0f, 180.0f})
        for (const float shininess : {0.0f, 1.0f, 90.0f, 1e4f}) {
            const vec3 toward = degrees == 90 ? vec3(1, 0, 0) : from_up(degrees);
            const SurfacePoint<float> point{vec3(0), up, reflected(up, toward)};
            ASSERT_GT(phong_cosine(up, toward, point.toward_eye), 0.999f)
                << "L = " << shown(toward) << ", " << described(point)
                << "; phong_cosine() does not ask for N.L";
            const ReflectedLight light = light_on(point, sun(toward), shininess);
            ASSERT_EQ(light.diffuse, vec3(0)) << degrees << " degrees between N and L";
            ASSERT_EQ(light.specular, vec3(0))
                << degrees << " degrees between N and L, R = V, n = " << shininess;
        }
}

TEST(Phong, HardCase_EyeOppositeToTheLight) {
    look_up("Eq. 6.4");
    Directions any(7);
    for (int i = 0; i < 10'000; ++i) {
        const vec3 normal = any.direction(), toward = any.direction();
        ASSERT_EQ(blinn_cosine(normal, toward, -toward), 0)
            << "N = " << shown(normal) << ", L = " << shown(toward) << ", V = -L";
    }
}

TEST(Phong, HardCase_ExponentOfZeroShinesEvenly) {
    look_up("Eq. 6.3");
    // In all that is lit, whatever the eye sees.
    for (const vec3 toward_eye : {slanted, vec3(0, 0, 1), vec3(0.8f, -0.6f, 0)})
        EXPECT_EQ(light_on({vec3(0), up, toward_eye}, sun(slanted), 0).specular, vec3(1))
            << "the highlight for n = 0, L = (0.6, 0.8, 0), N = (0, 1, 0), V = "
            << shown(toward_eye);
}

TEST(Phong, HardCase_NoHighlightIsBrighterThanItsLight) {
    look_up("Eq. 6.3");
    Directions any(8);
    for (int i = 0; i < 100'000; ++i) {
        const vec3 normal = any.direction(), toward = any.direction();
        // The eye in the mirror direction: a cosine of 1, give or take a rounding.
        const vec3 toward_eye = unit_or(reflected(normal, toward), up);
        const auto what = [&] { return ": N = " + shown(normal) + ", L = " + shown(toward); };
        ASSERT_LE(phong_cosine(normal, toward, toward_eye), 1) << "Phong's highlight" << what();
        ASSERT_LE(blinn_cosine(normal, toward, toward_eye), 1) << "Blinn's highlight" << what();
    }
}

TEST(Phong, HardCase_HighlightsEndWhereTheyCannotBeSeen) {
    look_up("Eq. 6.3");
    for (const float shininess : {0.0f, 0.1f, 1.0f, 10.0f, 90.0f, 1e4f})
        for (int i = 0; i <= 10'000; ++i) {
            // From straight above down to the horizon.
            const double degrees = 90 * std::pow(0.999, i);
            const vec3 toward_eye = from_up(degrees);
            const float share = light_on({vec3(0), up, toward_eye}, sun(up), shininess).specular.x;
            const double exact = std::pow(std::max(0.0, double{toward_eye.y}), double{shininess});
            // What a cosine is off counts as often as the exponent says; the eye is rounded twice.
            const double tolerance =
                2 * FLT_EPSILON * (1 + shininess) * exact + of_power(std::max(exact, 1e-30));
            if (share == 0)
                ASSERT_LE(exact, min_highlight + tolerance) << degrees << ", n = " << shininess;
            else
                ASSERT_NEAR(share, exact, tolerance) << degrees << " degrees, n = " << shininess;
            ASSERT_TRUE(share == 0 || share >= min_highlight) << share;
        }
}

TEST(Phong, HardCase_NormalsThatCancel) {
    look_up("Eq. 6.8");
    const vec3 middle(0.25f, 0.25f, 0.5f), eye(0, 9, 0);
    const std::array light = {sun(up)};
    const OneTriangle cancel(vertices_of_floor, {up, up, -up}, shining(90));
    EXPECT_EQ(cancel.light_at(middle, light, eye).diffuse, vec3(1)) << "the first vertex's normal";
    // What is left of these is 1e-7 long, and leads along x.
    const vec3 left = normalize_or(vec3(1e-7f, 1, 0), up), right(1e-7f, -1, 0);
    const OneTriangle nearly(vertices_of_floor, {left, left, right}, shining(90));
    const std::array along_x = {sun({1, 0, 0})};
    EXPECT_NEAR(nearly.light_at(middle, along_x, eye).diffuse.x, 1, 3 * FLT_EPSILON);
}

TEST(Phong, HardCase_PointLightAtTheSurface) {
    look_up("Eq. 6.6");
    for (const vec3 place : {vec3(0), vec3(1, 2, 3), vec3(-1e30f), vec3(1e-40f)}) {
        Light light{LightKind::point, {1, 2, 3}, -up, place, 1, 0.9f, 0.8f};
        const std::string what = "at the place of the light: " + described(light);
        ASSERT_EQ(incoming_light(light, place).toward, up) << what;
        ASSERT_EQ(incoming_light(light, place).color, vec3(1, 2, 3)) << what;
        light.kind = LightKind::spot;  // shines down, as the light is said to come from above
        ASSERT_EQ(incoming_light(light, place).color, vec3(1, 2, 3)) << what << ", a spotlight";
        light.direction_world = up;
        ASSERT_EQ(incoming_light(light, place).color, vec3(0)) << what << ", turned upwards";
    }
}

TEST(Phong, HardCase_EyeAtTheSurface) {
    look_up("Eq. 6.3");
    // It looks along the normal then.
    const OneTriangle triangle(vertices_of_floor, {up, up, up}, shining(1));
    const std::array light = {sun(slanted)};
    const ReflectedLight lit = triangle.light_at({1, 0, 0}, light, vertices_of_floor[0]);
    EXPECT_NEAR(lit.specular.x, 0.8f, of_power(0.8f));
}
