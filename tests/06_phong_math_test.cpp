// SPDX-License-Identifier: MIT
// Numbers from 10^-8 to 10^8 against long double. Rounding is off by at most u = 2^-24 of the
// result; bounds count how often, to the first order, and `of_higher_order` is for u times u. And
// zeros, denormals, infinities and NaN at the entries: no light that is none.
#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "06_phong/light.hpp"
#include "06_phong/normals.hpp"
#include "06_phong/phong.hpp"
#include "06_phong/studio_lights.hpp"
#include "lab/shading_methods.hpp"
#include "support/any_size.hpp"
#include "support/light_in_words.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/one_triangle.hpp"
#include "support/printers.hpp"
#include "support/reference.hpp"
#include "support/special_numbers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr real u = eps / 2;
constexpr real u_of_double = 0x1p-53L;
constexpr real least = 0x1p-149L;  // below the normal numbers, rounding is off by half of that
constexpr real of_higher_order = 1 + 1e-5L;

real length_of(lvec3 v) { return std::sqrt(glm::dot(v, v)); }
lvec3 unit(lvec3 v) { return v / length_of(v); }
lvec3 sizes(lvec3 v) { return glm::abs(v); }

/// A direction with components of very different sizes.
vec3 any_direction(AnySize& any) { return vec3(unit(lvec3(any.vector()))); }

/// For ASSERT_TRUE: each component within its tolerance.
testing::AssertionResult are_near(vec3 actual, lvec3 exact, lvec3 tolerance) {
    for (int i = 0; i < 3; ++i)
        if (const auto result =
                is_near(actual[i], exact[i], tolerance[i] * of_higher_order + least);
            !result)
            return testing::AssertionFailure()
                   << shown(actual) << " instead of " << shown(vec3(exact)) << "; component " << i
                   << ": " << result.message();
    return testing::AssertionSuccess();
}

/// How far unit_or(v) is off, in u. In the usual case the square is off by 3 u (a product, two
/// sums), its root by half of that and one more, the quotient by one more, the product by one more:
/// 4.5. Very short or long vectors are scaled first, which rounds twice more.
real of_unit(lvec3 v) {
    const real squared = glm::dot(v, v);
    return squared > 1.001e-30L && squared < 0.999e30L ? 4.5L : 2.9L * 2;
}

/// What should arrive of a light, and how far it may be off.
struct ExactIncoming {
    lvec3 toward, of_toward;
    real share, of_share;
};

/// t^2 (3 - 2t), and how far it is off where t is off by of_t. The curve rises by at most 3/2 of
/// what t does; then 2 products and a difference.
std::pair<real, real> exact_spot_attenuation(real t, real of_t) {
    t = std::min(std::max(real{0}, t), real{1});
    const real share = t * t * (3 - 2 * t);
    return {share, 1.5L * of_t + 3 * u * share};
}

ExactIncoming exact_incoming(const Light& light, vec3 position) {
    if (light.kind == LightKind::directional) return {lvec3(light.direction_world), lvec3(0), 1, 0};
    // A difference and a product; scaling adds the length's 2 u, then unit_or's own. What the
    // factor itself is off turns nothing.
    const lvec3 to_light =
        (lvec3(light.position_world) - lvec3(position)) / real{light.half_distance};
    const lvec3 toward = unit(to_light),
                of_toward = (2 + 2 + of_unit(to_light)) * u * sizes(toward);
    // The square: twice 3 u, and 3 of its sum. Then the sum with 1, and the quotient.
    const real square = glm::dot(to_light, to_light), share = 1 / (1 + square);
    const real of_share = u * share * (2 + 9 * square * share);
    if (light.kind == LightKind::point) return {toward, of_toward, share, of_share};
    const lvec3 shines = light.direction_world;
    const real width = real{light.cos_inner} - light.cos_outer;
    const real t = (-glm::dot(toward, shines) - light.cos_outer) / width;
    // The cosine's products, each as far off as `toward`, and 3 u of their sum; two differences, a
    // quotient.
    const real of_cosine =
        glm::dot(of_toward, sizes(shines)) + 3 * u * glm::dot(sizes(toward), sizes(shines));
    const auto [spot, of_spot] = exact_spot_attenuation(t, of_cosine / width + 3 * u * std::abs(t));
    return {toward, of_toward, share * spot, of_share * spot + of_spot * share + u * share * spot};
}

/// @param kinds  0: a directional light; 2: one of any kind.
Light any_light(AnySize& any, int kinds, vec3 position) {
    Light light;
    light.kind = static_cast<LightKind>(any.whole(0, kinds));
    light.color = glm::abs(any.vector());
    light.direction_world = any_direction(any);
    light.position_world = any.vector();
    light.half_distance = any.positive();
    light.cos_inner = 0.001f * static_cast<float>(any.whole(-900, 1000));
    light.cos_outer = light.cos_inner - 0.001f * static_cast<float>(any.whole(1, 100));
    // Every other spotlight shines at the point, more or less; else hardly one would.
    if (light.kind == LightKind::spot && any.whole(0, 1))
        light.direction_world = vec3(unit(unit(lvec3(position) - lvec3(light.position_world)) +
                                          0.1L * lvec3(light.direction_world)));
    return light;
}

float highlight_cosine(Highlight highlight, const SurfacePoint<float>& point, vec3 toward_light) {
    return highlight == Highlight::phong ? phong_cosine(point, toward_light)
                                         : blinn_cosine(point, toward_light);
}

/// A highlight that is a single product.
struct SquaredCosine {
    Highlight highlight;
    bool is_on = true;

    float operator()(const SurfacePoint<float>& point, vec3 toward_light) const {
        const float cosine = highlight_cosine(highlight, point, toward_light);
        return cosine * cosine;
    }
};

/// The highlight's cosine, and how far it may be off.
/// @param of_l  How far l may be off.
std::pair<real, real> exact_highlight_cosine(Highlight highlight, lvec3 n, lvec3 l, lvec3 of_l,
                                             lvec3 v) {
    if (highlight == Highlight::phong) {
        const lvec3 r = 2 * glm::dot(n, l) * n - l;
        const lvec3 of_r =
            2 * glm::dot(sizes(n), 5 * u * sizes(l) + of_l) * sizes(n) + u * sizes(l) + of_l;
        return {std::max(real{0}, glm::dot(r, v)),
                glm::dot(of_r, sizes(v)) + 3 * u * glm::dot(sizes(r), sizes(v))};
    }
    // A sum of two; scaled, which may turn it by what it is off, by its length; a dot product.
    const lvec3 sum = l + v, of_sum = u * sizes(sum) + of_l, h = unit(sum);
    const lvec3 of_h =
        (of_sum + length_of(of_sum) * sizes(h)) / length_of(sum) + of_unit(sum) * u * sizes(h);
    return {std::max(real{0}, glm::dot(n, h)),
            glm::dot(sizes(n), of_h) + 3 * u * glm::dot(sizes(n), sizes(h))};
}

/// Compares the light of three lights with the sum in long double.
///
/// @param kinds  As any_light() has it.
void compare_reflected_light(unsigned seed, int kinds) {
    AnySize any(seed, decades);
    int lit = 0;
    for (int i = 0; i < cases; ++i) {
        const SurfacePoint<float> point{any.vector(), any_direction(any), any_direction(any)};
        std::vector<Light> lights;
        for (int k = 0; k < 3; ++k) lights.push_back(any_light(any, kinds, point.position_world));
        const auto highlight = static_cast<Highlight>(i % 2);
        const ReflectedLight actual =
            reflected_light(std::span<const Light>(lights), point, SquaredCosine{highlight});
        lvec3 diffuse(0), specular(0), of_diffuse(0), of_specular(0);
        bool is_sure = true;
        const lvec3 n = point.normal_world;
        for (const Light& light : lights) {
            const auto [toward, of_toward, share, of_share] =
                exact_incoming(light, point.position_world);
            const real cosine = glm::dot(n, toward);
            const real of_cosine =
                glm::dot(sizes(n), of_toward) + 3 * u * glm::dot(sizes(n), sizes(toward));
            is_sure = is_sure && std::abs(cosine) > 1.01L * of_cosine;
            if (!(cosine > 0)) continue;
            // The light's colour is a product; one more with the cosine, and three sums.
            const lvec3 color = share * lvec3(light.color);
            const lvec3 of_color = (of_share + 5 * u * share + 2 * least) * lvec3(light.color);
            diffuse += cosine * color;
            of_diffuse += of_cosine * color + cosine * of_color + least;
            const auto [c, of_c] =
                exact_highlight_cosine(highlight, n, toward, of_toward, lvec3(point.toward_eye));
            const real shine = std::min(c, real{1}) * std::min(c, real{1});
            specular += shine * color;
            // A square: twice what its root is off, and a product.
            of_specular +=
                (2 * c * of_c + of_c * of_c + u * shine + least) * color + shine * of_color + least;
        }
        if (!is_sure) continue;  // along the surface, and so lit or not
        ++lit;
        const auto what = [&] {
            return " light, " + described(point) + ", of: " + described(lights[0]) + "; " +
                   described(lights[1]) + "; " + described(lights[2]) + "; " + name_of(highlight) +
                   ", squared; seed " + std::to_string(seed) + ", case " + std::to_string(i);
        };
        ASSERT_TRUE(are_near(actual.diffuse, diffuse, of_diffuse)) << "diffuse" << what();
        ASSERT_TRUE(are_near(actual.specular, specular, of_specular)) << "specular" << what();
    }
    EXPECT_GT(lit, cases / 2);
}

}  // namespace

TEST(Phong, Eq6_5_ReflectedLightOfDirectionalLightsOfAllSizes) { compare_reflected_light(12, 0); }

TEST(Phong, Eq6_7_ReflectedLightOfLightsOfAllSizes) { compare_reflected_light(7, 2); }

TEST(Phong, Eq6_9_NormalsAndAnglesOfFacesOfAllSizes) {
    AnySize any(9, decades);
    for (int i = 0; i < cases; ++i) {
        std::vector<vec3> positions = {any.vector(), any.vector(), any.vector()};
        if (i % 3 == 0)  // a small face, far out
            for (std::size_t k = 1; k < 3; ++k)
                positions[k] = positions[0] + 0.01f * positions[0].x * any_direction(any);
        const Mesh mesh = mesh_of(positions, {{0, 1, 2}});
        const auto side = [&](std::size_t from, std::size_t to) {
            return lvec3(positions[to % 3]) - lvec3(positions[from]);
        };
        const lvec3 across = glm::cross(side(0, 1), side(0, 2));
        if (length_of(across) == 0) continue;
        const auto what = [&] {
            return shown(positions[0]) + ", " + shown(positions[1]) + ", " + shown(positions[2]) +
                   "; seed 9, case " + std::to_string(i);
        };
        // In double: two differences and a product, 3 roundings, and one of what is left, in
        // proportion to the sides; scaling may turn the normal by that once more.
        const real of_double =
            15 * u_of_double * length_of(side(0, 1)) * length_of(side(0, 2)) / length_of(across);
        ASSERT_TRUE(are_near(face_normal(mesh, mesh.triangles[0]), unit(across),
                             of_double + u * sizes(unit(across))))
            << "face_normal() of " << what();
        for (std::size_t k = 0; k < 3; ++k) {
            const lvec3 v = side(k, k + 1), w = side(k, k + 2);
            const real angle = std::atan2(length_of(glm::cross(v, w)), glm::dot(v, w));
            // In double: what the products are off by, in proportion to the sides, a length and the
            // arc. Then one rounding to float.
            ASSERT_TRUE(is_near(vertex_angle_radians(mesh, mesh.triangles[0], k), angle,
                                20 * u_of_double + u * angle))
                << "the angle at vertex " << k << " of " << what();
        }
    }
}

namespace {

constexpr int many_cases = 300'000;

/// Special numbers, and lights of such.
class Mix : public SpecialNumbers {
  public:
    using SpecialNumbers::SpecialNumbers;

    float finite() { return place().x; }
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

/// For EXPECT_TRUE: no number but those from `low` to `high`.
testing::AssertionResult are_within(const char* what, vec3 v, float low, float high) {
    for (int i = 0; i < 3; ++i)
        if (!(v[i] >= low && v[i] <= high))  // also for NaN
            return testing::AssertionFailure()
                   << what << " " << shown(v) << ", which is not from " << low << " to " << high;
    return testing::AssertionSuccess();
}

/// Of length 1, but for a few roundings, and for components below the least normal number.
testing::AssertionResult is_direction(vec3 v) {
    if (std::abs(glm::length(dvec3(v)) - 1) <= 4 * FLT_EPSILON) return testing::AssertionSuccess();
    return testing::AssertionFailure() << testing::PrintToString(v) << " is not of length 1";
}

}  // namespace

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
        const float cosine = highlight_cosine(highlight, point, toward_light);
        ASSERT_TRUE(cosine >= 0 && cosine <= 1)
            << "the cosine of " << name_of(highlight) << " is " << cosine << ", "
            << described(point) << ", L = " << shown(toward_light) << "; seed 3, case " << i;
    }
}

TEST(Phong, HardCase_SpecialNumbersOfReflectedLight) {
    look_up("Eq. 6.5");
    Mix mix(4);
    for (int i = 0; i < many_cases; ++i) {
        const std::array lights = {mix.light(), mix.light()};
        const float shininess = mix.amount();
        const SurfacePoint<float> point{mix.place(), mix.direction(), mix.direction()};
        const ReflectedLight light =
            reflected_light(std::span<const Light>(lights), point, PhongHighlight{true, shininess});
        const auto what = [&] {
            return "n = " + shown(shininess) + ", " + described(point) +
                   ", of: " + described(lights[0]) + "; " + described(lights[1]) +
                   "; seed 4, case " + std::to_string(i);
        };
        constexpr float most = 2 * 10 * (1 + 4 * FLT_EPSILON);  // directions may be a bit long
        ASSERT_TRUE(are_within("diffuse", light.diffuse, 0, most)) << what();
        ASSERT_TRUE(are_within("specular", light.specular, 0, most)) << what();

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
        const std::array lights = {mix.light(), mix.light()};
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
    constexpr std::array sizes = {0.0f, 1e-45f, 1e-30f, 1.0f, 1e30f};
    for (const LightKind kind : light_kinds)
        for (const float size : sizes)
            for (const float length : sizes) {
                Bounds bounds;
                bounds.add(vec3(-size));
                bounds.add(vec3(size));
                for (const Light& light :
                     studio_lights(kind, bounds, length * vec3(-0.6f, 0.8f, 0))) {
                    const std::string what = described(light) + "; of a scene of size " +
                                             shown(size) + ", key light " + shown(length) + " away";
                    ASSERT_TRUE(is_direction(light.direction_world)) << what;
                    const float most = 2 * size + 1;
                    ASSERT_TRUE(are_within("place", light.position_world, -most, most)) << what;
                    ASSERT_GE(light.half_distance, FLT_MIN) << what;
                    ASSERT_LT(light.cos_outer, light.cos_inner) << what;
                }
            }
}
