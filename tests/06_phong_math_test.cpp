// SPDX-License-Identifier: MIT
// Numbers from 10^-8 to 10^8 against long double, or against exact values. Rounding is off by at
// most u = 2^-24 of the result; bounds count how often, to the first order, and `of_higher_order`
// is for u times u.
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "06_phong/light.hpp"
#include "06_phong/normals.hpp"
#include "06_phong/phong.hpp"
#include "lab/shading_methods.hpp"
#include "support/any_size.hpp"
#include "support/light_in_words.hpp"
#include "support/near.hpp"
#include "support/one_triangle.hpp"
#include "support/printers.hpp"
#include "support/reference.hpp"

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

Light any_light(AnySize& any) {
    const vec3 color = glm::abs(any.vector()), shines = any_direction(any), place = any.vector();
    const float half_distance = any.positive();
    const float full = 0.001f * static_cast<float>(any.whole(-900, 1000));
    return {static_cast<LightKind>(any.whole(0, 2)),
            color,
            shines,
            place,
            half_distance,
            full,
            full - 0.001f * static_cast<float>(any.whole(1, 100))};
}

}  // namespace

TEST(Phong, Eq6_8_DirectionsOfVectorsOfAllSizes) {
    for (const float size : {decades, 37.0f}) {
        AnySize any(1, size);
        for (int i = 0; i < cases; ++i) {
            const vec3 v = any.vector();
            const lvec3 exact = unit(lvec3(v));
            ASSERT_TRUE(are_near(unit_or(v, vec3(0)), exact, of_unit(lvec3(v)) * u * sizes(exact)))
                << "unit_or(" << shown(v) << "), which is given; seed 1, case " << i;
        }
    }
}

TEST(Phong, Eq6_6_AttenuationOverDistancesOfAllSizes) {
    AnySize any(2, decades);
    for (int i = 0; i < cases; ++i) {
        const vec3 to_light = any.vector();
        const real square = glm::dot(lvec3(to_light), lvec3(to_light)), exact = 1 / (1 + square);
        // 3 u of the square's part, a sum and a quotient.
        ASSERT_TRUE(is_near(distance_attenuation(to_light), exact,
                            u * exact * (2 + 3 * square * exact) * of_higher_order))
            << "distance_attenuation(" << shown(to_light) << "); seed 2, case " << i;
    }
}

TEST(Phong, Eq6_7_SpotAttenuationBetweenNumbersOfAllSizes) {
    AnySize any(3, decades);
    for (int i = 0; i < cases; ++i) {
        const float none = any.number(), full = none + any.positive();
        if (!(full > none)) continue;
        const float t = 0.001f * static_cast<float>(any.whole(-200, 1200));
        const float cosine = none + t * (full - none);
        const real exact_t = (real{cosine} - none) / (real{full} - none);
        // Two differences and a quotient.
        const auto [exact, tolerance] =
            exact_spot_attenuation(exact_t, 3 * u * std::min(std::abs(exact_t), real{2}));
        ASSERT_TRUE(
            is_near(spot_attenuation(cosine, full, none), exact, tolerance * of_higher_order))
            << "spot_attenuation(" << shown(cosine) << ", " << shown(full) << ", " << shown(none)
            << "); seed 3, case " << i;
    }
}

TEST(Phong, Eq6_7_LightOfPointLightsAndSpotlightsOfAllSizes) {
    AnySize any(4, decades);
    std::array<int, 3> seen{};
    for (int i = 0; i < 3 * cases; ++i) {
        Light light = any_light(any);
        const vec3 position = any.vector();
        // Every other spotlight shines at the point, more or less; else hardly one would.
        if (light.kind == LightKind::spot && i % 2)
            light.direction_world = vec3(unit(unit(lvec3(position) - lvec3(light.position_world)) +
                                              0.1L * lvec3(light.direction_world)));
        const Incoming<float> actual = incoming_light(light, position);
        const ExactIncoming exact = exact_incoming(light, position);
        ASSERT_TRUE(are_near(actual.toward, exact.toward, exact.of_toward))
            << "toward, at " << shown(position) << ", a " << described(light) << "; seed 4, case "
            << i;
        const lvec3 color = light.color;
        const real of_product = light.kind == LightKind::directional ? 0 : u * exact.share;
        // The share may be below the normal numbers, before a colour of up to 10^8 multiplies it.
        ASSERT_TRUE(are_near(actual.color, exact.share * color,
                             (exact.of_share + of_product + least) * color))
            << "color, at " << shown(position) << ", a " << described(light) << "; seed 4, case "
            << i;
        seen[static_cast<std::size_t>(light.kind)] += actual.color.x > 0;
    }
    for (const int count : seen) EXPECT_GT(count, cases / 10);
}

TEST(Phong, Eq6_2_MirrorDirectionsOfVectorsOfAllSizes) {
    AnySize any(5, decades);
    for (int i = 0; i < cases; ++i) {
        // Of length 1, or any vectors: the bound is in proportion to the terms.
        const vec3 n = i % 2 ? any_direction(any) : any.vector();
        const vec3 l = i % 2 ? any_direction(any) : any.vector();
        const lvec3 exact = 2 * glm::dot(lvec3(n), lvec3(l)) * lvec3(n) - lvec3(l);
        // 3 u of the dot product's terms, one more for the product, one for the difference.
        const lvec3 of_product = 2 * glm::dot(sizes(n), sizes(l)) * sizes(n);
        ASSERT_TRUE(are_near(reflected(n, l), exact, u * (5.0L * of_product + sizes(l))))
            << "reflected(" << shown(n) << ", " << shown(l) << "); seed 5, case " << i;
    }
}

namespace {

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

}  // namespace

TEST(Phong, Eq6_3_HighlightsOfDirectionsOfAllSizes) {
    AnySize any(6, decades);
    for (int i = 0; i < 2 * cases; ++i) {
        const auto highlight = static_cast<Highlight>(i % 2);
        const vec3 n = any_direction(any), l = any_direction(any);
        vec3 v = any_direction(any);
        if (i % 3 == 0) v = vec3(unit(lvec3(reflected(n, l)) + 1e-3L * lvec3(v)));  // near mirror
        if (i % 3 == 1) v = vec3(unit(1e-3L * lvec3(v) - lvec3(l)));  // nearly opposite
        const auto [exact, tolerance] = exact_highlight_cosine(highlight, n, l, lvec3(0), v);
        // Directions are rounded, so the exact cosine may exceed 1, which the stage does not.
        ASSERT_TRUE(is_near(highlight_cosine(highlight, {vec3(0), n, v}, l),
                            std::min(exact, real{1}), tolerance * of_higher_order))
            << "the cosine of " << name_of(highlight) << ", N = " << shown(n)
            << ", L = " << shown(l) << ", V = " << shown(v) << "; seed 6, case " << i;
    }
}

namespace {

/// Compares the light of three lights with the sum in long double.
///
/// @param kinds  Directional lights alone, or all kinds.
enum class Kinds { directional, all };
void compare_reflected_light(unsigned seed, Kinds kinds) {
    AnySize any(seed, decades);
    int lit = 0;
    for (int i = 0; i < cases; ++i) {
        std::array lights = {any_light(any), any_light(any), any_light(any)};
        if (kinds == Kinds::directional)
            for (Light& light : lights) light.kind = LightKind::directional;
        const SurfacePoint<float> point{any.vector(), any_direction(any), any_direction(any)};
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

TEST(Phong, Eq6_5_ReflectedLightOfDirectionalLightsOfAllSizes) {
    compare_reflected_light(12, Kinds::directional);
}

TEST(Phong, Eq6_7_ReflectedLightOfLightsOfAllSizes) { compare_reflected_light(7, Kinds::all); }

TEST(Phong, Eq6_5_SumsOfColorsOfAllSizes) {
    AnySize any(8, decades);
    for (int i = 0; i < cases; ++i) {
        Material material;
        material.ambient = any.vector(), material.diffuse = any.vector();
        material.specular = any.vector(), material.emission = any.vector();
        SurfaceColor color = surface_color(material);
        const vec3 tint = any.vector(), ambient_light = any.vector();
        const ReflectedLight light{any.vector(), any.vector()};
        const vec3 plain = unlit(color), sent = phong(color, ambient_light, light);
        const SurfaceColor before = color;
        color.tint(tint);
        for (int c = 0; c < 3; ++c) {
            const auto what = [&] {
                return "component " + std::to_string(c) + "; Ka = " + shown(material.ambient) +
                       ", Kd = " + shown(material.diffuse) + ", Ks = " + shown(material.specular) +
                       ", Ke = " + shown(material.emission) + "; seed 8, case " + std::to_string(i);
            };
            ASSERT_EQ(before.ambient[c], std::min(material.ambient[c], material.diffuse[c]))
                << "surface_color().ambient, " << what();
            ASSERT_EQ(before.diffuse[c], material.diffuse[c])
                << "surface_color().diffuse, " << what();
            const real kd = before.diffuse[c], ke = before.emission[c], t = tint[c];
            ASSERT_TRUE(is_near(color.ambient[c], before.ambient[c] * t,
                                u * std::abs(before.ambient[c] * t)))
                << "ambient after tint(" << shown(tint) << "), " << what();
            ASSERT_TRUE(is_near(color.diffuse[c], kd * t, u * std::abs(kd * t)))
                << "diffuse after tint(" << shown(tint) << "), " << what();
            ASSERT_TRUE(is_near(plain[c], kd + ke, u * std::abs(kd + ke))) << "unlit(), " << what();
            Sum sum;
            sum.add(ke), sum.add(real{before.ambient[c]} * ambient_light[c]);
            sum.add(kd * light.diffuse[c]), sum.add(real{before.specular[c]} * light.specular[c]);
            // A product and three sums.
            ASSERT_TRUE(is_near(sent[c], sum.value, 4 * u * sum.of_sizes * of_higher_order))
                << "phong() in ambient light " << shown(ambient_light) << ", diffuse light "
                << shown(light.diffuse) << " and specular light " << shown(light.specular) << ", "
                << what();
        }
    }
}

namespace {

struct ExactFace {
    lvec3 normal;
    real of_normal;  ///< How far each component may be off before it is rounded to float.
    std::array<real, 3> angles;
};

/// In double: two differences and a product, 3 roundings, and one of what is left: the cross
/// product is off by 4 of them, in proportion to its terms. Scaling may turn it by that once more.
ExactFace exact_face(const Mesh& mesh, const Triangle& triangle) {
    std::array<lvec3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = mesh.positions[triangle.vertices[i].position];
    const lvec3 s = p[1] - p[0], t = p[2] - p[0], normal = glm::cross(s, t);
    const lvec3 a = sizes(s), b = sizes(t);
    const lvec3 terms(a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x);
    ExactFace face;
    face.normal = unit(normal);
    face.of_normal = 2 * 4.1L * u_of_double * length_of(terms) / length_of(normal);
    for (std::size_t i = 0; i < 3; ++i) {
        const lvec3 v = p[(i + 1) % 3] - p[i], w = p[(i + 2) % 3] - p[i];
        face.angles[i] = std::atan2(length_of(glm::cross(v, w)), glm::dot(v, w));
    }
    return face;
}

/// The angle is off by what its cross and dot products are, by the sides: for the first, 4 double
/// roundings of three components that add up to less than twice the sides; for the second, 5. Then
/// a length and the arc, and one in float.
real of_angle(real angle) { return 20 * u_of_double + u * angle; }

}  // namespace

TEST(Phong, Eq6_9_NormalsAndAnglesOfFacesOfAllSizes) {
    AnySize any(9, decades);
    for (int i = 0; i < cases; ++i) {
        std::vector<vec3> positions = {any.vector(), any.vector(), any.vector()};
        if (i % 3 == 0)  // a small face, far out
            for (std::size_t k = 1; k < 3; ++k)
                positions[k] = positions[0] + 0.01f * positions[0].x * any_direction(any);
        const Mesh mesh = mesh_of(positions, {{0, 1, 2}});
        const lvec3 s = lvec3(positions[1]) - lvec3(positions[0]),
                    t = lvec3(positions[2]) - lvec3(positions[0]);
        if (length_of(glm::cross(s, t)) == 0) continue;
        const ExactFace exact = exact_face(mesh, mesh.triangles[0]);
        ASSERT_TRUE(are_near(face_normal(mesh, mesh.triangles[0]), exact.normal,
                             exact.of_normal + u * sizes(exact.normal)))
            << "face_normal() of " << shown(positions[0]) << ", " << shown(positions[1]) << ", "
            << shown(positions[2]) << "; seed 9, case " << i;
        for (std::size_t k = 0; k < 3; ++k)
            ASSERT_TRUE(is_near(vertex_angle_radians(mesh, mesh.triangles[0], k), exact.angles[k],
                                of_angle(exact.angles[k])))
                << "the angle at vertex " << k << " of " << shown(positions[0]) << ", "
                << shown(positions[1]) << ", " << shown(positions[2]) << "; seed 9, case " << i;
    }
}

TEST(Phong, Eq6_9_MeansOfNormalsAroundPositionsOfAllSizes) {
    AnySize any(10, decades);
    int sure = 0;
    for (int i = 0; i < cases; ++i) {
        // A fan around the first position: up to six faces of any shape, or a tent.
        const auto count = static_cast<std::uint32_t>(any.whole(1, 6));
        std::vector<vec3> positions = {any.vector()};
        std::vector<std::array<std::uint32_t, 3>> faces;
        const float radius = any.positive();
        for (std::uint32_t k = 1; k <= count + 1; ++k) {
            const float angle = static_cast<float>(k) * 1.04f;
            positions.push_back(i % 2 ? any.vector()
                                      : radius * vec3(std::sin(angle), -0.3f, std::cos(angle)));
            if (k <= count) faces.push_back({0, k, k + 1});
        }
        if (i % 2 == 0) positions[0] = vec3(0);
        Mesh mesh = mesh_of(positions, faces);
        const SmoothNormals smooth(mesh);
        std::vector<ExactFace> exact;
        for (const Triangle& triangle : mesh.triangles) exact.push_back(exact_face(mesh, triangle));
        const vec3 of_face = face_normal(mesh, mesh.triangles[0]);
        lvec3 sum(0), of_sum(0);
        bool is_sure = true;
        for (const ExactFace& face : exact) {
            // Two directions in float, each off by u and its own error; their dot product by 3 u.
            const real cosine = glm::dot(face.normal, lvec3(of_face));
            is_sure = is_sure && std::abs(cosine - cos_sharp) > 10 * u + 2 * face.of_normal;
            if (cosine <= cos_sharp) continue;
            sum += face.angles[0] * face.normal;
            // Normal, product and at most six sums; the angle; the normal's own error.
            of_sum += 8 * u * face.angles[0] * sizes(face.normal) +
                      of_angle(face.angles[0]) * sizes(face.normal) +
                      face.angles[0] * face.of_normal;
        }
        if (!is_sure) continue;  // an edge that is just sharp
        ++sure;
        const vec3 actual = smooth.at(0, of_face);
        ASSERT_TRUE(are_near(actual, sum, of_sum))
            << "SmoothNormals::at(0, " << shown(of_face) << "), where " << count
            << " faces meet; seed 10, case " << i;

        complete_normals(mesh);
        const vec3 completed = mesh.normals[mesh.triangles[0].vertices[0].normal];
        const lvec3 scaled = unit(lvec3(actual));  // within half an ulp and what double rounds
        ASSERT_TRUE(are_near(completed, scaled, 1.01L * u * sizes(scaled)))
            << "of length 1, by complete_normals(); seed 10, case " << i;
    }
    EXPECT_GT(sure, cases / 2);
}

TEST(Phong, Eq6_9_NormalsOfFilesOfAllSizes) {
    AnySize any(11, decades);
    for (int i = 0; i < cases; ++i) {
        Mesh mesh = mesh_of({any.vector(), any.vector(), any.vector()}, {{0, 1, 2}});
        const std::array<vec3, 3> in_file = {any.vector(), any.vector(), any.vector()};
        mesh.normals = {in_file[2], in_file[1], in_file[0]};
        for (std::uint32_t k = 0; k < 3; ++k) mesh.triangles[0].vertices[k].normal = 2 - k;
        complete_normals(mesh);
        ASSERT_EQ(mesh.normals.size(), 3u);
        for (std::size_t k = 0; k < 3; ++k) {
            const lvec3 exact = unit(lvec3(in_file[k]));
            ASSERT_TRUE(are_near(mesh.normals[mesh.triangles[0].vertices[k].normal], exact,
                                 1.01L * u * sizes(exact)))
                << "complete_normals(): vertex " << k << ", whose normal in the file is "
                << shown(in_file[k]) << "; seed 11, case " << i;
        }
    }
}
