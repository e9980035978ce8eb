// SPDX-License-Identifier: MIT
// The model: the worked numbers of the derivation, its properties and its hard cases. Numbers of
// all sizes: 06_phong_math_test.cpp; materials and pictures: 06_phong_scene_test.cpp.
#include <array>
#include <cfloat>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "06_phong/light.hpp"
#include "06_phong/normals.hpp"
#include "06_phong/phong.hpp"
#include "common/math/color.hpp"
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
    Light light() {
        const auto kind = static_cast<LightKind>(random_() % 3);
        const vec3 color = glm::abs(vector());
        const vec3 toward = direction();
        return {kind, color, toward, 2.0f * vector(), between(0.5f, 2), 0.8f, -0.5f};
    }

  private:
    std::mt19937 random_;
};

/// The light of several lights with an exponent of 8 for highlights.
ReflectedLight light_on(const SurfacePoint<float>& point, std::span<const Light> lights,
                        Highlight highlight) {
    return reflected_light(lights, point, HighlightBy{true, 8, highlight, Power::squarings});
}

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

/// The greatest difference of a colour's three numbers.
float difference(vec3 a, vec3 b) {
    const vec3 d = glm::abs(a - b);
    return std::max({d.x, d.y, d.z});
}

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
    EXPECT_EQ(arriving(-up), vec3(0)) << what << ", L = (0, -1, 0): from behind";
}

TEST(Phong, Eq6_1_LooksEquallyBrightFromAllSides) {
    Directions any(1);
    for (int i = 0; i < 1000; ++i) {
        const Light light = any.light();
        SurfacePoint<float> point{any.vector(), any.direction(), any.direction()};
        const vec3 diffuse = light_on(point, light, 1).diffuse;
        point.toward_eye = any.direction();
        ASSERT_EQ(light_on(point, light, 1).diffuse, diffuse)
            << "the same point seen from elsewhere, in a " << described(light) << ", "
            << described(point) << "; seed 1, case " << i;
    }
}

TEST(Phong, Eq6_2_ExampleOfAMirror) {
    EXPECT_EQ(reflected(up, slanted), vec3(-0.6f, 0.8f, 0))
        << "R for N = (0, 1, 0) and L = (0.6, 0.8, 0)";
}

TEST(Phong, Eq6_2_IsTheLightMirroredAtTheNormal) {
    Directions any(2);
    // Normal and light are off length 1 by 2^-24 each time they are rounded; a dozen of such.
    constexpr float tolerance = 6 * FLT_EPSILON;
    for (int i = 0; i < 100'000; ++i) {
        const vec3 normal = any.direction(), toward_light = any.direction();
        const vec3 r = reflected(normal, toward_light);
        const std::string what = "R = " + shown(r) + " for N = " + shown(normal) +
                                 " and L = " + shown(toward_light) + "; seed 2, case " +
                                 std::to_string(i);
        ASSERT_NEAR(glm::length(r), 1, tolerance) << "the length of " << what;
        ASSERT_NEAR(glm::dot(r, normal), glm::dot(toward_light, normal), tolerance)
            << "R.N and L.N; " << what;
        // In the plane of both, on the other side: what is across the normal changes its sign.
        ASSERT_TRUE(are_near(r - glm::dot(r, normal) * normal,
                             dvec3(glm::dot(toward_light, normal) * normal - toward_light),
                             tolerance))
            << "what of R is across N is that of L with the other sign; " << what;
    }
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
    const float cosine = blinn_cosine(up, slanted, up);
    EXPECT_NEAR(cosine, 1.8 / std::sqrt(3.6), FLT_EPSILON)
        << "N = V = (0, 1, 0), L = (0.6, 0.8, 0)";
    EXPECT_NEAR(std::pow(cosine, 4.0f), 0.81f, 4 * FLT_EPSILON);  // four times the cosine's error
    EXPECT_NEAR(std::pow(std::cos(glm::radians(5.0f)), 360.0f), 0.253f, in_three_digits);
}

TEST(Phong, Eq6_4_IsHalfOfPhongsAngleInOnePlane) {
    Directions any(3);
    for (int i = 0; i < 10'000; ++i) {
        const double light = any.between(0, 89), eye = any.between(0, 89);
        const vec3 toward_light = from_up(light), toward_eye = from_up(-eye);
        const double apart = glm::radians(std::abs(light - eye));
        // Light and eye are rounded to float, then half a dozen operations.
        constexpr double tolerance = 4 * FLT_EPSILON;
        ASSERT_NEAR(phong_cosine(up, toward_light, toward_eye), std::max(0.0, std::cos(apart)),
                    tolerance)
            << "N up, L " << light << " and V " << eye
            << " degrees from it on the other side; seed 3, case " << i;
        ASSERT_NEAR(blinn_cosine(up, toward_light, toward_eye), std::cos(apart / 2), tolerance)
            << "N up, L " << light << " and V " << eye
            << " degrees from it on the other side; seed 3, case " << i;
    }
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
    EXPECT_EQ(phong(color, vec3(0), {{1, 2, 3}, vec3(0)}), vec3(14, 21, 30))
        << what << ": emission and diffuse";
    EXPECT_EQ(phong(color, vec3(0), {vec3(0), {1, 2, 3}}), vec3(17, 27, 39))
        << what << ": emission and specular";
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
    material.ambient = {1, 0.1f, 0.5f};
    material.diffuse = {0.2f, 0.3f, 0.5f};
    material.specular = {0.4f, 0.5f, 0.6f};
    material.emission = {0.7f, 0.8f, 0.9f};
    const SurfaceColor color = surface_color(material);
    EXPECT_EQ(color.ambient, vec3(0.2f, 0.1f, 0.5f))
        << "of Ka = (1, 0.1, 0.5) and Kd = (0.2, 0.3, 0.5), the smaller of each";
    EXPECT_EQ(color.diffuse, material.diffuse);
    EXPECT_EQ(color.specular, material.specular);
    EXPECT_EQ(color.emission, material.emission);
}

TEST(Phong, Eq6_5_LightsInAnyOrder) {
    Directions any(4);
    for (int i = 0; i < 10'000; ++i) {
        const SurfacePoint<float> point{any.vector(), any.direction(), any.direction()};
        std::vector<Light> lights;
        for (int k = 0; k < 5; ++k) lights.push_back(any.light());
        const ReflectedLight in_order = light_on(point, lights, Highlight::blinn);
        std::swap(lights[0], lights[3]), std::swap(lights[1], lights[4]);
        const ReflectedLight otherwise = light_on(point, lights, Highlight::blinn);
        // Four sums of positive numbers on either side, half an ulp each.
        constexpr float tolerance = 4 * FLT_EPSILON;
        for (int c = 0; c < 3; ++c) {
            ASSERT_NEAR(in_order.diffuse[c], otherwise.diffuse[c], tolerance * in_order.diffuse[c])
                << "diffuse light of five lights in two orders; seed 4, case " << i;
            ASSERT_NEAR(in_order.specular[c], otherwise.specular[c],
                        tolerance * in_order.specular[c])
                << "specular light of five lights in two orders; seed 4, case " << i;
        }
    }
}

TEST(Phong, Eq6_5_VisibilityIsAskedOnlyWhereTheLightCounts) {
    Directions directions(8);
    int asked_at = 0, turned_away = 0, beside_cone = 0;
    for (int i = 0; i < 3000; ++i) {
        const Light light = directions.light();
        const SurfacePoint<float> point{directions.vector(), directions.direction(), up};
        const dvec3 to_light = dvec3(light.position_world) - dvec3(point.position_world);
        const bool is_sun = light.kind == LightKind::directional;
        const dvec3 toward = is_sun ? dvec3(light.direction_world) : glm::normalize(to_light);
        const double cosine = glm::dot(toward, dvec3(point.normal_world));
        const double from_axis = -glm::dot(toward, dvec3(light.direction_world));
        const bool is_spot = light.kind == LightKind::spot;
        if (std::abs(cosine) < 1e-5 || std::abs(from_axis - light.cos_outer) < 1e-4) continue;
        int times = 0;
        reflected_light(std::span(&light, 1), point, PhongHighlight{true, 8}, [&](std::size_t) {
            ++times;
            return 1.0f;
        });
        const bool is_in_cone = !is_spot || from_axis > light.cos_outer;
        ASSERT_EQ(times, cosine > 0 && is_in_cone ? 1 : 0)
            << "times that the light's visibility is asked for; N.L = " << cosine
            << (is_in_cone ? "" : ", outside of the cone") << "; seed 8, case " << i;
        asked_at += times, turned_away += cosine < 0, beside_cone += cosine > 0 && !is_in_cone;
    }
    EXPECT_GT(asked_at, 500);
    EXPECT_GT(turned_away, 500);
    EXPECT_GT(beside_cone, 50);
    const Light black{LightKind::directional, vec3(0), up};
    reflected_light(std::span(&black, 1), SurfacePoint<float>{vec3(0), up, up},
                    PhongHighlight{true, 8}, [](std::size_t) {
                        ADD_FAILURE() << "a black light's visibility";
                        return 1.0f;
                    });
}

TEST(Phong, Eq6_5_TwoLightsAddUp) {
    Directions any(5);
    for (int i = 0; i < 10'000; ++i) {
        const SurfacePoint<float> point{any.vector(), any.direction(), any.direction()};
        const std::array lights = {any.light(), any.light()};
        const ReflectedLight both = light_on(point, lights, Highlight::phong);
        const ReflectedLight first = light_on(point, std::span(lights).first(1), Highlight::phong);
        const ReflectedLight second = light_on(point, std::span(lights).last(1), Highlight::phong);
        ASSERT_EQ(both.diffuse, first.diffuse + second.diffuse)
            << "of a " << described(lights[0]) << ", and a " << described(lights[1]) << "; "
            << described(point) << "; seed 5, case " << i;
        ASSERT_EQ(both.specular, first.specular + second.specular)
            << "of a " << described(lights[0]) << ", and a " << described(lights[1]) << "; "
            << described(point) << "; seed 5, case " << i;
    }
}

TEST(Phong, Eq6_7_TurningEverythingChangesNothing) {
    Directions any(6);
    int lit = 0;
    for (int i = 0; i < 10'000; ++i) {
        const SurfacePoint<float> point{any.vector(), any.direction(), any.direction()};
        Light light = any.light();
        const dvec3 z = glm::normalize(dvec3(any.direction()));
        const dvec3 x = glm::normalize(glm::cross(dvec3(any.direction()), z));
        const dmat3 turn(x, glm::cross(z, x), z);
        const auto turned = [&](vec3 v) { return vec3(turn * dvec3(v)); };
        for (const Highlight highlight : {Highlight::phong, Highlight::blinn}) {
            const ReflectedLight before = light_on(point, std::span(&light, 1), highlight);
            Light other = light;
            other.direction_world = turned(light.direction_world);
            other.position_world = turned(light.position_world);
            const SurfacePoint<float> there{turned(point.position_world),
                                            turned(point.normal_world), turned(point.toward_eye)};
            const ReflectedLight after = light_on(there, std::span(&other, 1), highlight);
            // Positions up to 3.5 are rounded by 2^-23, seen from 0.02 or more; a direction is
            // then off by 6e-6, and the power of 8 by eight times that.
            if (glm::length(light.position_world - point.position_world) < 0.02f) continue;
            const std::string what = std::string(name_of(highlight)) + ", " + described(light) +
                                     ", " + described(point) +
                                     ", and the same with everything turned; seed 6, case " +
                                     std::to_string(i);
            ASSERT_TRUE(are_near(after.diffuse, dvec3(before.diffuse), 2e-5f))
                << "diffuse light of a " << what;
            // Where light comes in along the surface, its highlight ends at once.
            if (before.diffuse.x + before.diffuse.y + before.diffuse.z < 1e-4f) continue;
            ASSERT_TRUE(are_near(after.specular, dvec3(before.specular), 1e-4f)) << what;
            ++lit;
        }
    }
    EXPECT_GT(lit, 4000);
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
    const Light plain{LightKind::point, vec3(1), up};
    EXPECT_EQ(incoming_light(plain, vec3{0, -1, 0}).color, vec3(0.5f))
        << "at a distance of 1, if no half distance is given, below a " << described(plain);
}

TEST(Phong, Eq6_7_AnExampleOfSpots) {
    EXPECT_EQ(spot_attenuation(0.25f, 1, 0), 0.15625f);
    EXPECT_EQ(spot_attenuation(0.5f, 1, 0), 0.5f);
    EXPECT_EQ(spot_attenuation(0.75f, 1, 0), 0.84375f);
    for (const float cosine : {1.0f, 0.96f, 0.95f})
        EXPECT_EQ(spot_attenuation(cosine, 0.95f, 0.85f), 1)
            << "full light from the cosine 0.95 on; the cosine is " << cosine;
    for (const float cosine : {-1.0f, 0.0f, 0.85f})
        EXPECT_EQ(spot_attenuation(cosine, 0.95f, 0.85f), 0)
            << "no light up to the cosine 0.85; the cosine is " << cosine;
    const auto cosine_of = [](float degrees) { return std::cos(glm::radians(degrees)); };
    EXPECT_NEAR(spot_attenuation(cosine_of(25), cosine_of(18), cosine_of(32)), 0.598f,
                in_three_digits)
        << "at 25 degrees, between 18 and 32";
}

TEST(Phong, Eq6_7_RisesAndItsEndsAreTheSameUpsideDown) {
    float last = 0;
    for (int i = 0; i <= 1000; ++i) {
        const float t = 0.001f * static_cast<float>(i), share = spot_attenuation(t, 1, 0);
        // Half an ulp of 3 - 2t, of each product and of 1 - t.
        ASSERT_NEAR(share, 1 - spot_attenuation(1 - t, 1, 0), 4 * FLT_EPSILON)
            << "the share at t = " << t << ", and one minus that at 1 - t";
        ASSERT_GE(share, last) << "the share at t = " << t << ", and just before it";
        last = share;
    }
    EXPECT_EQ(last, 1);
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
    EXPECT_GT(at_middle(10, NormalScaling::approximate).specular.x, 0.5f)
        << "the same where it is scaled with an approximate root";
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

TEST(Phong, Eq6_8_LightAtTheVerticesOrAtEachPixel) {
    // Each vertex sees 10 degrees between mirror direction and eye, the middle none; the eye and
    // the light are very far.
    ShadingMethod variant;
    std::array<vec3, 3> normals;
    for (std::size_t i = 0; i < 3; ++i) {
        const double turn = glm::radians(120.0) * static_cast<double>(i);
        normals[i] =
            vec3(dvec3(std::sin(glm::radians(5.0)) * std::cos(turn), std::cos(glm::radians(5.0)),
                       std::sin(glm::radians(5.0)) * std::sin(turn)));
    }
    const std::array light = {sun(up)};
    const auto at_middle = [&](Shading shading) {
        variant.shading = shading;
        return OneTriangle(vertices_of_floor, normals, shining(90), variant)
            .light_at(vec3(1.0f / 3), light, {0, 1e9f, 0});
    };
    EXPECT_NEAR(at_middle(Shading::phong).specular.x, 1, 90 * 4 * FLT_EPSILON)
        << "the highlight in the middle, at each pixel";
    EXPECT_NEAR(at_middle(Shading::gouraud).specular.x, 0.252f, in_three_digits)
        << "the highlight in the middle, of that at the vertices";
    EXPECT_NEAR(at_middle(Shading::gouraud).diffuse.x, 0.996f, in_three_digits)
        << "diffuse light in the middle, of that at the vertices";
}

TEST(Phong, Eq6_9_FlatShadingTakesTheNormalOfTheFace) {
    ShadingMethod variant;
    variant.shading = Shading::flat;
    const std::array light = {sun(up)};
    const auto shaded =
        OneTriangle(vertices_of_floor, {slanted, slanted, slanted}, shining(90), variant)
            .light_at(vec3(1.0f / 3), light, {0, 1e9f, 0});
    EXPECT_EQ(shaded.diffuse.x, 1)
        << "of a floor in light from above, whatever the normals at its vertices";
    EXPECT_NEAR(shaded.specular.x, 1, 90 * 4 * FLT_EPSILON) << "seen from above";
}

TEST(Phong, Eq6_8_GouraudMixesTheLightOfTheVertices) {
    Directions any(10);
    for (int i = 0; i < 1000; ++i) {
        const std::array<vec3, 3> normals = {any.direction(), any.direction(), any.direction()};
        ShadingMethod gouraud;
        gouraud.shading = Shading::gouraud;
        const OneTriangle mixed(vertices_of_floor, normals, shining(5), gouraud);
        const OneTriangle exact(vertices_of_floor, normals, shining(5));
        const std::array lights = {any.light(), any.light()};
        const vec3 eye = 3.0f * any.vector(), barycentrics(0.5f, 0.375f, 0.125f);
        ReflectedLight sum;
        for (int k = 0; k < 3; ++k) {
            const ReflectedLight at_vertex = exact.light_at(mat3(1)[k], lights, eye);
            sum.diffuse += barycentrics[k] * at_vertex.diffuse;
            sum.specular += barycentrics[k] * at_vertex.specular;
        }
        // Normals are scaled once more at each pixel, which may round; to the power of 5. The eye
        // sees the vertex from the same place.
        constexpr float tolerance = 2 * 5 * 4 * FLT_EPSILON;
        const ReflectedLight actual = mixed.light_at(barycentrics, lights, eye);
        ASSERT_TRUE(are_near(actual.diffuse, dvec3(sum.diffuse), tolerance))
            << "of what the vertices have; seed 10, case " << i;
        ASSERT_TRUE(are_near(actual.specular, dvec3(sum.specular), tolerance))
            << "of what the vertices have; seed 10, case " << i;
    }
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
        // The cosine of the doubled angle, on the other side; two products of what rounds a dot.
        const double cosine = glm::dot(dvec3(normal), dvec3(toward));
        ASSERT_NEAR(phong_cosine(normal, toward, -toward), std::max(0.0, 1 - 2 * cosine * cosine),
                    8 * FLT_EPSILON)
            << "N = " << shown(normal) << ", L = " << shown(toward) << ", V = -L; seed 7, case "
            << i;
    }
}

TEST(Phong, HardCase_PowersOfZeroAndZerothPowers) {
    look_up("Eq. 6.3");
    for (const Power power : {Power::polynomial, Power::in_double, Power::schlick}) {
        for (const float x : {0.0f, 1e-30f, 0.5f, 1.0f}) EXPECT_EQ(power_as(power, x, 0), 1) << x;
        for (const float n : {1.0f, 1e4f, FLT_MAX}) EXPECT_EQ(power_as(power, 0, n), 0) << n;
        for (const float n : {1.0f, 1e4f, FLT_MAX}) EXPECT_EQ(power_as(power, 1, n), 1) << n;
    }
    // A surface that shines evenly: in all that is lit, whatever the eye sees.
    for (const vec3 toward_eye :
         {slanted, reflected(up, slanted), vec3(0, 0, 1), vec3(0.8f, -0.6f, 0)})
        EXPECT_EQ(light_on({vec3(0), up, toward_eye}, sun(slanted), 0).specular, vec3(1))
            << "the highlight for n = 0, L = (0.6, 0.8, 0), N = (0, 1, 0), V = "
            << shown(toward_eye);
}

TEST(Phong, HardCase_GreatExponents) {
    look_up("Eq. 6.3");
    for (int i = 0; i <= 1000; ++i) {
        const float cosine = 1 - 1e-6f * static_cast<float>(i);
        const double exact = std::pow(double{cosine}, 1e4);
        EXPECT_NEAR(power_as(Power::polynomial, cosine, 1e4f), exact, of_power(exact)) << i;
        EXPECT_NEAR(power_as(Power::in_double, cosine, 1e4f), exact, 0.5 * FLT_EPSILON * exact)
            << i;
        // 19 products, of which the error of the first counts thousands of times.
        EXPECT_NEAR(power_as(Power::squarings, cosine, 1e4f), exact, 1e4 * FLT_EPSILON * exact)
            << i;
    }
}

TEST(Phong, HardCase_NoHighlightIsBrighterThanItsLight) {
    look_up("Eq. 6.3");
    Directions any(8);
    for (int i = 0; i < 100'000; ++i) {
        const vec3 normal = any.direction(), toward = any.direction();
        // The eye in the mirror direction: a cosine of 1, give or take a rounding.
        const vec3 toward_eye = unit_or(reflected(normal, toward), up);
        for (const Highlight highlight : {Highlight::phong, Highlight::blinn}) {
            const float cosine = highlight == Highlight::phong
                                     ? phong_cosine(normal, toward, toward_eye)
                                     : blinn_cosine(normal, toward, toward_eye);
            ASSERT_LE(cosine, 1) << "the cosine of " << name_of(highlight)
                                 << ", N = " << shown(normal) << ", L = " << shown(toward)
                                 << ", V = " << shown(toward_eye) << "; seed 8, case " << i;
            for (const float n : {1e4f, 1e9f, FLT_MAX})
                for (const Power how : {Power::polynomial, Power::in_double})
                    ASSERT_LE(power_as(how, cosine, n), 1) << "seed 8, case " << i;
        }
    }
}

TEST(Phong, HardCase_HighlightsEndWhereTheyCannotBeSeen) {
    look_up("Eq. 6.3");
    const std::array light = {sun(up)};
    for (const float shininess : {0.0f, 0.1f, 1.0f, 10.0f, 90.0f, 1e4f})
        for (int i = 0; i <= 10'000; ++i) {
            // From straight above down to the horizon.
            const double degrees = 90 * std::pow(0.999, i);
            const OneTriangle triangle(vertices_of_floor, {up, up, up}, shining(shininess));
            const vec3 toward_eye = from_up(degrees);
            const float share = triangle.light_at({1, 0, 0}, light, toward_eye).specular.x;
            const double exact = std::pow(std::max(0.0, double{toward_eye.y}), double{shininess});
            // What a cosine is off counts as often as the exponent says; the eye is rounded twice.
            const auto of_cosine = [&](double x) { return 2 * FLT_EPSILON * (1 + shininess) * x; };
            if (share == 0) {
                ASSERT_LE(exact, min_highlight + of_cosine(min_highlight) + of_power(min_highlight))
                    << degrees << " degrees, n = " << shininess;
            } else {
                ASSERT_NEAR(share, exact, of_cosine(exact) + of_power(exact))
                    << degrees << " degrees, n = " << shininess;
                ASSERT_GE(share, min_highlight) << degrees << " degrees, n = " << shininess;
            }
        }
}

TEST(Phong, HardCase_NormalsThatCancel) {
    look_up("Eq. 6.8");
    for (const NormalScaling scaling :
         {NormalScaling::exact, NormalScaling::approximate, NormalScaling::none}) {
        ShadingMethod variant;
        variant.normals = scaling;
        const OneTriangle triangle(vertices_of_floor, {up, up, -up}, shining(90), variant);
        const std::array light = {sun(up)};
        const ReflectedLight middle = triangle.light_at({0.25f, 0.25f, 0.5f}, light, {0, 9, 0});
        // As for the first vertex's normal; unscaled it is no normal, and dark.
        EXPECT_EQ(middle.diffuse, vec3(scaling == NormalScaling::exact ? 1 : 0))
            << (scaling == NormalScaling::exact ? "the first vertex's normal" : "no normal");
        EXPECT_GE(middle.specular.x, 0);
        EXPECT_LE(middle.specular.x, 1);
    }
}

TEST(Phong, HardCase_NormalsThatNearlyCancel) {
    look_up("Eq. 6.8");
    // What is left is 1e-7 long, and leads along x.
    const vec3 left = normalize_or(vec3(1e-7f, 1, 0), up), right(1e-7f, -1, 0);
    const OneTriangle triangle(vertices_of_floor, {left, left, right}, shining(90));
    const std::array light = {sun({1, 0, 0})};
    EXPECT_NEAR(triangle.light_at({0.25f, 0.25f, 0.5f}, light, {0, 9, 0}).diffuse.x, 1,
                3 * FLT_EPSILON);
}

TEST(Phong, HardCase_PointLightAtTheSurface) {
    look_up("Eq. 6.6");
    for (const vec3 place : {vec3(0), vec3(1, 2, 3), vec3(-1e30f), vec3(1e-40f)}) {
        Light light{LightKind::point, {1, 2, 3}, -up, place, 1, 0.9f, 0.8f};
        const std::string what = "at the place of the light: " + described(light);
        ASSERT_EQ(incoming_light(light, place).toward, up) << what;
        ASSERT_EQ(incoming_light(light, place).color, vec3(1, 2, 3)) << what;
        light.kind = LightKind::spot;  // shines down, as the light is said to come from above
        ASSERT_EQ(incoming_light(light, place).color, vec3(1, 2, 3))
            << "at the place of the light: " << described(light);
        light.direction_world = up;
        ASSERT_EQ(incoming_light(light, place).color, vec3(0))
            << "at the place of the light: " << described(light);
    }
}

TEST(Phong, HardCase_EyeAtTheSurface) {
    look_up("Eq. 6.3");
    // It looks along the normal then.
    const OneTriangle triangle(vertices_of_floor, {up, up, up}, shining(1));
    const std::array light = {sun(slanted)};
    const ReflectedLight lit = triangle.light_at({1, 0, 0}, light, vertices_of_floor[0]);
    EXPECT_LE(difference(lit.specular, vec3(0.8f)), of_power(0.8f));
}

TEST(Phong, HardCase_BacksAreLitAsFrontsWithEverythingMirrored) {
    look_up("Eq. 6.8");
    Directions any(9);
    const auto mirrored = [](vec3 v) { return vec3(v.x, -v.y, v.z); };
    int lit = 0;
    for (int i = 0; i < 10'000; ++i) {
        ShadingMethod variant;
        variant.shading = static_cast<Shading>(i % 3);
        variant.highlight = static_cast<Highlight>(i % 2);
        const auto leaning = [&] { return unit_or(up + 0.3f * any.vector(), up); };
        OneTriangle floor(vertices_of_floor, {leaning(), leaning(), leaning()}, shining(9),
                          variant);
        OneTriangle below = floor;
        for (vec3& normal : below.mesh().normals) normal = -mirrored(normal);
        Light light = any.light();
        vec3 eye = any.vector();
        eye.y = 1 + std::abs(eye.y);
        const vec3 barycentrics(0.25f, 0.5f, 0.25f);
        const ReflectedLight front = floor.light_at(barycentrics, std::span(&light, 1), eye);
        light.direction_world = mirrored(light.direction_world);
        light.position_world = mirrored(light.position_world);
        const ReflectedLight back =
            below.light_at(barycentrics, std::span(&light, 1), mirrored(eye), true);
        const std::string what = std::string(name_of(variant.shading)) + ", " +
                                 name_of(variant.highlight) + ", in a " + described(light) +
                                 " and mirrored; seed 9, case " + std::to_string(i);
        ASSERT_EQ(back.diffuse, front.diffuse) << "diffuse light: " << what;
        ASSERT_EQ(back.specular, front.specular) << "specular light: " << what;
        lit += front.specular.x > 0;
    }
    EXPECT_GT(lit, 1000);
}

TEST(Phong, HardCase_SumsOverOne) {
    look_up("Eq. 6.5");
    const SurfaceColor color{vec3(1), vec3(1), vec3(1), {0, 0, 1e37f}};
    std::vector<Light> lights(100, sun(up));
    const ReflectedLight light = light_on({vec3(0), up, up}, lights, Highlight::phong);
    EXPECT_EQ(light.diffuse, vec3(100));
    EXPECT_EQ(light.specular, vec3(100));
    EXPECT_EQ(phong(color, vec3(1), light), vec3(201, 201, 1e37f));
    EXPECT_EQ(srgb8_from_linear(201.0f), 255);
    EXPECT_EQ(srgb8_from_linear(1e37f), 255);
}
