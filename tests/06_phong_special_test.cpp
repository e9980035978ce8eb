// SPDX-License-Identifier: MIT
// Zeros, denormals, infinities and NaN at the entries: no light that is none.
#include <array>
#include <cfloat>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "06_phong/phong.hpp"
#include "06_phong/studio_lights.hpp"
#include "lab/shading_methods.hpp"
#include "support/light_in_words.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/one_triangle.hpp"
#include "support/printers.hpp"
#include "support/special_numbers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr int many_cases = 1'000'000;

/// Special numbers, and lights of such.
class Mix : public SpecialNumbers {
  public:
    using SpecialNumbers::SpecialNumbers;

    /// Any finite number >= 0.
    float amount() { return std::abs(finite()); }
    float up_to(float most) { return std::min(amount(), most); }
    vec3 direction() { return unit_or(place(), vec3(0, 1, 0)); }
    /// A light as the lesson makes them: any place, any size.
    Light light() {
        const vec3 color(up_to(10), up_to(10), up_to(10)), toward = direction(), where = place();
        const float cos_inner = std::clamp(finite(), -1 + FLT_EPSILON, 1.0f);
        return {static_cast<LightKind>(below(3)),
                color,
                toward,
                where,
                std::max(amount(), FLT_MIN),
                cos_inner,
                std::max(-1.0f, cos_inner - std::max(up_to(1), FLT_EPSILON))};
    }
};

/// A thousand lights, made beforehand: each takes as long as a test of it.
class Lights {
  public:
    explicit Lights(Mix& mix) {
        for (int i = 0; i < 1000; ++i) lights_.push_back(mix.light());
    }
    std::span<const Light> two(Mix& mix) const {
        return std::span(lights_).subspan(mix.below(999), 2);
    }

  private:
    std::vector<Light> lights_;
};

/// For EXPECT_TRUE: no number but those from `least` to `most`.
testing::AssertionResult are_within(const char* what, vec3 v, float least, float most) {
    for (int i = 0; i < 3; ++i)
        if (!(v[i] >= least && v[i] <= most))  // also for NaN
            return testing::AssertionFailure()
                   << what << " " << shown(v) << ", which is not from " << least << " to " << most;
    return testing::AssertionSuccess();
}

/// Of length 1, but for a few roundings, and for components below the least normal number.
testing::AssertionResult is_direction(vec3 v) {
    if (std::abs(glm::length(dvec3(v)) - 1) <= 4 * FLT_EPSILON) return testing::AssertionSuccess();
    return testing::AssertionFailure() << testing::PrintToString(v) << " is not of length 1";
}

}  // namespace

TEST(Phong, HardCase_SpecialNumbersHaveADirectionOrNone) {
    look_up("Eq. 6.8");
    Mix mix(1);
    const vec3 fallback(0, 0, 1);
    for (int i = 0; i < many_cases; ++i) {
        const vec3 v = mix.any_three();
        ASSERT_TRUE(is_direction(unit_or(v, fallback))) << "seed 1, case " << i;
        const bool has_direction = std::isfinite(v.x + 0.0) && std::isfinite(v.y + 0.0) &&
                                   std::isfinite(v.z + 0.0) && v != vec3(0);
        if (!has_direction) { ASSERT_EQ(unit_or(v, fallback), fallback) << "seed 1, case " << i; }
    }
}

TEST(Phong, HardCase_SpecialNumbersOfLights) {
    look_up("Eq. 6.6");
    Mix mix(2);
    for (int i = 0; i < many_cases; ++i) {
        const Light light = mix.light();
        vec3 position = mix.any_three();  // infinite ones, too
        for (int axis = 0; axis < 3; ++axis)
            if (std::isnan(position[axis])) position[axis] = 0;
        const Incoming<float> incoming = incoming_light(light, position);
        ASSERT_TRUE(is_direction(incoming.toward)) << "toward, at " << shown(position) << ": "
                                                   << described(light) << "; seed 2, case " << i;
        ASSERT_TRUE(are_within("color", incoming.color, 0, 10))
            << "at " << shown(position) << ": " << described(light) << "; seed 2, case " << i;
    }
}

TEST(Phong, HardCase_SpecialNumbersOfHighlights) {
    look_up("Eq. 6.3");
    Mix mix(3);
    for (int i = 0; i < many_cases; ++i) {
        // Not even of length 1.
        const SurfacePoint<float> point{vec3(0), mix.any_three(), mix.any_three()};
        const vec3 toward_light = mix.any_three();
        const auto highlight = static_cast<Highlight>(mix.below(2));
        const float cosine = highlight == Highlight::phong ? phong_cosine(point, toward_light)
                                                           : blinn_cosine(point, toward_light);
        ASSERT_TRUE(cosine >= 0 && cosine <= 1)
            << "the cosine of " << name_of(highlight) << " is " << cosine
            << ", N = " << shown(point.normal_world) << ", V = " << shown(point.toward_eye)
            << ", L = " << shown(toward_light) << "; seed 3, case " << i;
        const auto power = static_cast<Power>(mix.below(4));
        const float shininess = mix.amount();
        const float share = power_as(power, cosine, shininess);
        ASSERT_TRUE(share >= 0 && share <= 1)
            << "seed 3, case " << i << ": " << cosine << " to the power of " << shininess;
    }
}

TEST(Phong, HardCase_SpecialNumbersOfReflectedLight) {
    look_up("Eq. 6.5");
    Mix mix(4);
    const Lights some_lights(mix);
    for (int i = 0; i < many_cases; ++i) {
        const std::span lights = some_lights.two(mix);
        const float shininess = mix.amount();
        const SurfacePoint<float> point{mix.place(), mix.direction(), mix.direction()};
        const auto highlight = static_cast<Highlight>(mix.below(2));
        const ReflectedLight light = reflected_light(
            lights, point, HighlightBy{true, shininess, highlight, Power::polynomial});
        if (highlight == Highlight::phong) {
            ASSERT_EQ(reflected_light(lights, point, PhongHighlight{true, shininess}).specular,
                      light.specular)
                << "PhongHighlight with n = " << shown(shininess) << ", " << described(point)
                << ", of: " << described(lights[0]) << "; " << described(lights[1])
                << "; seed 4, case " << i;
        }
        constexpr float most = 2 * 10 * (1 + 4 * FLT_EPSILON);  // directions may be a bit long
        ASSERT_TRUE(are_within("diffuse", light.diffuse, 0, most))
            << described(point) << ", of: " << described(lights[0]) << "; " << described(lights[1])
            << "; seed 4, case " << i;
        ASSERT_TRUE(are_within("specular", light.specular, 0, most))
            << "n = " << shown(shininess) << ", " << described(point)
            << ", of: " << described(lights[0]) << "; " << described(lights[1]) << "; seed 4, case "
            << i;

        // Colours as MTL may have them, also negative ones.
        const auto color = [&] { return glm::clamp(mix.place(), -1e37f, 1e37f); };
        const SurfaceColor surface{color(), color(), color(), color()};
        const ReflectedLight some{0.5f * light.diffuse, 0.5f * light.specular};
        ASSERT_TRUE(
            are_within("sum", phong(surface, glm::abs(mix.direction()), some), -FLT_MAX, FLT_MAX))
            << "seed 4, case " << i;
    }
}

TEST(Phong, HardCase_SpecialNumbersOfTriangles) {
    look_up("Eq. 6.8");
    Mix mix(5);
    const Lights some_lights(mix);
    Material material;
    material.specular = vec3(1);
    OneTriangle triangle({vec3(0), vec3(1), vec3(2)}, {vec3(0), vec3(1), vec3(2)}, material);
    int lit = 0;
    for (int i = 0; i < many_cases; ++i) {
        Mesh& mesh = triangle.mesh();
        mesh.positions = {mix.place(), mix.place(), mix.place()};
        mesh.normals = {mix.any_three(), mix.any_three(), mix.any_three()};
        for (std::uint32_t k = 0; k < 3; ++k)
            mesh.triangles[0].vertices[k].normal = mix.below(16) == 0 ? no_index : k;
        complete_normals(mesh);
        for (const vec3 normal : mesh.normals)
            ASSERT_TRUE(is_direction(normal)) << "seed 5, case " << i;

        ShadingMethod& variant = triangle.variant();
        variant.shading = static_cast<Shading>(mix.below(3));
        variant.highlight = static_cast<Highlight>(mix.below(2));
        variant.power = static_cast<Power>(mix.below(4));
        variant.normals = static_cast<NormalScaling>(mix.below(3));
        triangle.material().shininess = mix.amount();
        // In the triangle; a pixel's centre, its border, a vertex.
        const float x = mix.up_to(1), y = mix.up_to(1 - x);
        const std::span lights = some_lights.two(mix);
        const ReflectedLight light =
            triangle.light_at({x, y, 1 - x - y}, lights, mix.place(), mix.below(2) == 0);
        constexpr float most = 2 * 10 * 1.002f;  // approximate normals are .18% too long at most
        ASSERT_TRUE(are_within("diffuse", light.diffuse, 0, most)) << "seed 5, case " << i;
        ASSERT_TRUE(are_within("specular", light.specular, 0, most)) << "seed 5, case " << i;
        lit += light.diffuse.x > 0;
    }
    EXPECT_GT(lit, many_cases / 20);
}

TEST(Phong, HardCase_StudioLightsOfAnySizeAreLights) {
    look_up("Robust: A light at the surface, and scenes of all sizes");
    for (const LightKind kind : light_kinds)
        for (const float size : {0.0f, 1e-45f, 1e-30f, 1.0f, 1e30f})
            for (const float length : {0.0f, 1e-45f, 1e-30f, 1.0f, 1e30f}) {
                Bounds bounds;
                bounds.add(vec3(-size));
                bounds.add(vec3(size));
                for (const Light& light :
                     studio_lights(kind, bounds, length * vec3(-0.6f, 0.8f, 0))) {
                    const std::string what = described(light) + "; of a scene of size " +
                                             shown(size) + ", key light " + shown(length) + " away";
                    ASSERT_TRUE(is_direction(light.direction_world)) << what;
                    ASSERT_TRUE(
                        are_within("place", light.position_world, -2 * size - 1, 2 * size + 1))
                        << what;
                    ASSERT_GE(light.half_distance, FLT_MIN) << what;
                    ASSERT_LT(light.cos_outer, light.cos_inner) << what;
                }
            }
}
