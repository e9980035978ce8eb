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

#include "04_mvp/clip.hpp"
#include "06_phong/fragments.hpp"
#include "06_phong/many_samples.hpp"
#include "06_phong/shading_variants.hpp"
#include "common/image_io.hpp"
#include "support/lesson_process.hpp"
#include "support/lit_sphere.hpp"
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

ReflectedLight light_at(const TriangleLight& light, vec3 weights) {
    NoCounters counters;
    return light.at(weights, counters);
}

std::vector<vec3> weights_in_triangles(int count) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(0, 1);
    std::vector<vec3> weights;
    for (int i = 0; i < count; ++i) {
        float u = any(random), v = any(random);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        weights.emplace_back(1 - u - v, u, v);
    }
    return weights;
}

std::array<long double, 3> wide(dvec3 v) { return {v.x, v.y, v.z}; }

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
    const std::string out = (fresh_folder("shading_knobs") / "picture.bmp").string();
    arguments.insert(arguments.end(), {"--size", "640x360", "--out", out});
    const ProcessResult run = run_program("06_phong", arguments);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_EQ(run.err, "");
    return read_image(out);
}

/// Lights `count` fragments together, and says whether each got the very bits that it gets alone.
void expect_the_same_light(const TriangleLight& light, std::size_t count) {
    NoCounters counters;
    const std::vector<vec3> weights = weights_in_triangles(static_cast<int>(count));
    ManyWeights many;
    for (const vec3 w : weights) many.set(many.count++, {w, vec3(0), vec3(0)});
    LitPoints points;
    light.add(many, points, counters);
    light.compute(points);
    ASSERT_EQ(points.count, count);
    for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(points.light(i).diffuse, light_at(light, weights[i]).diffuse) << i;
        ASSERT_EQ(points.light(i).specular, light_at(light, weights[i]).specular) << i;
    }
}

}  // namespace

TEST(ShadingVariants, ManyFragmentsAreLitAsEachAlone) {
    LitSphere lit = sphere();
    Light& light = lit.lights[0];
    light.direction_world = unit_or(-light.position_world, vec3(0));
    light.cos_full = 0.95f, light.cos_none = 0.9f;
    bool is_lit = false, is_dark = false;
    // A power of 0 is 1 even where the mirrored light leads away from the eye.
    for (const auto& [has_highlight, shininess] :
         {std::pair(true, 90.0f), std::pair(true, 0.0f), std::pair(false, 90.0f)}) {
        lit.scene.effects[0].highlight = has_highlight;
        lit.scene.materials[0].shininess = shininess;
        for (const LightKind kind : {LightKind::directional, LightKind::point, LightKind::spot}) {
            light.kind = kind;
            for (const Shading shading : {Shading::flat, Shading::gouraud, Shading::phong})
                for (const Highlight highlight : {Highlight::phong, Highlight::blinn})
                    for (std::size_t i = 0; i < lit.mesh().triangles.size(); ++i) {
                        const ShadingVariant variant{.shading = shading, .highlight = highlight};
                        const TriangleLight on = lit.light_on(lit.mesh().triangles[i], variant);
                        expect_the_same_light(on, 1 + 7 * i % most_points);
                        (light_at(on, vec3(1.0f / 3)).diffuse.x > 0 ? is_lit : is_dark) = true;
                    }
        }
    }
    EXPECT_TRUE(is_lit && is_dark);
}

TEST(ShadingVariants, ManyFragmentsAreLitAsEachAloneWhereSquaresAreOfNoUse) {
    const LitSphere usual = sphere();
    const Triangle triangle = usual.mesh().triangles[50];
    const std::size_t b = triangle.corners[1].normal, c = triangle.corners[2].position;
    for (const float size : {0.0f, 1e-20f, 1e20f, std::numeric_limits<float>::max()}) {
        LitSphere lit = usual;
        for (vec3& normal : lit.scene.meshes[0].normals) normal *= size;
        expect_the_same_light(lit.light_on(triangle, {}), most_points);
        lit = usual;
        lit.scene.meshes[0].normals[b] *= -1;  // somewhere between, there is none
        lit.scene.meshes[0].positions[c] *= size;
        expect_the_same_light(lit.light_on(triangle, {}), most_points);
        lit = usual;
        lit.lights[0].position_world *= size;
        expect_the_same_light(lit.light_on(triangle, {}), most_points);
        lit = usual;
        for (vec3& position : lit.scene.meshes[0].positions)
            position = lit.lights[0].position_world;  // the lamp stands on the surface
        expect_the_same_light(lit.light_on(triangle, {}), most_points);
        for (vec3& position : lit.scene.meshes[0].positions) position = lit.camera.position_world;
        expect_the_same_light(lit.light_on(triangle, {}), most_points);
    }
}

TEST(ShadingVariants, OfALightArrivesTheShareOfEachPoint) {
    std::array lights{Light{LightKind::point, vec3(1, 2, 3), vec3(0), vec3(0, 2, 0)},
                      Light{LightKind::directional, vec3(4), vec3(0, 1, 0)}};
    LitPoints points;
    points.count = 3;
    for (std::size_t i = 0; i < points.count; ++i)
        points.position_world.set(i, vec3(ivec3(int(i), 0, 0))),
            points.normal_world.set(i, vec3(0, 1, 0));
    const auto square = [](float cosine) { return cosine * cosine; };
    const auto light = [&](std::size_t i, vec2 shares) {
        EXPECT_TRUE(reflect_light(lights, vec3(1, 1, 1), true, points, square,
                                  [&](std::size_t l, std::size_t point) {
                                      return point == i ? shares[static_cast<int>(l)] : 1.0f;
                                  }));
        return points.light(i);
    };
    for (std::size_t i = 0; i < points.count; ++i) {
        const ReflectedLight lamp = light(i, {1, 0}), sun = light(i, {0, 1}),
                             both = light(i, {0.5f, 0.25f});
        EXPECT_GT(lamp.diffuse.x, 0);
        EXPECT_GT(sun.specular.x, 0);
        EXPECT_EQ(both.diffuse, 0.5f * lamp.diffuse + 0.25f * sun.diffuse);
        EXPECT_EQ(both.specular, 0.5f * lamp.specular + 0.25f * sun.specular);
        EXPECT_EQ(light(i, {0, 0}).diffuse, vec3(0));
    }
}

TEST(ShadingVariants, FragmentsAreHandedOverInTheirOrder) {
    for (const int count : {0, 1, 63, 64, 65, 128, 200}) {
        std::vector<int> seen;
        const auto shade = [&](const ManyFragments& fragments) {
            ASSERT_GT(fragments.count, 0u);
            ASSERT_LE(fragments.count, most_points);
            for (std::size_t i = 0; i < fragments.count; ++i) {
                seen.push_back(fragments.pixels[i].x);
                EXPECT_EQ(ivec3(fragments.screen_weights[i]), ivec3(fragments.pixels[i].x));
            }
        };
        Fragments fragments(shade);
        for (int i = 0; i < count; ++i) fragments.add(ivec2(i, 0), vec3(ivec3(i)));
        fragments.finish();
        fragments.finish();
        ASSERT_EQ(seen.size(), static_cast<std::size_t>(count));
        for (int i = 0; i < count; ++i) EXPECT_EQ(seen[static_cast<std::size_t>(i)], i);
    }
}

TEST(ShadingVariants, ManyFragmentsWeighWhatEachWeighsAlone) {
    const std::array<vec4, 3> corners = {vec4(-3, -2, 0, 1), vec4(4, -1, 1, 3),
                                         vec4(0, 9, 0.5f, 7)};
    int pieces = 0;
    for (const float nearer : {1.0f, 0.1f}) {  // the second is cut
        std::array<vec4, 3> clip = corners;
        clip[0].w *= nearer;
        for (const ClippedTriangle& clipped : clip_triangle(clip)) {
            constexpr ivec2 size(40, 30);
            const ScreenTriangle on_screen =
                snap_triangle(screen_from_clip(clipped[0].position_clip, size),
                              screen_from_clip(clipped[1].position_clip, size),
                              screen_from_clip(clipped[2].position_clip, size));
            const PerspectiveWeights perspective(on_screen, clipped);
            const auto compare = [&](const ManyFragments& fragments) {
                const ManyWeights weights = weights_of(fragments, perspective);
                ASSERT_EQ(weights.count, fragments.count);
                for (std::size_t i = 0; i < fragments.count; ++i) {
                    const FragmentWeights alone = perspective.at(fragments.screen_weights[i]);
                    ASSERT_EQ(weights[i].here, alone.here);
                    ASSERT_EQ(weights[i].step_x, alone.step_x);
                    ASSERT_EQ(weights[i].step_y, alone.step_y);
                }
            };
            Fragments fragments(compare);
            fill_triangle(on_screen, size,
                          [&](ivec2 p, vec3 weights) { fragments.add(p, weights); });
            fragments.finish();
            ++pieces;
        }
    }
    EXPECT_GT(pieces, 3);
}

TEST(ShadingVariants, ManySamplesAreThatOfEachAlone) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> any(-3, 3);
    Image<vec4> picture({16, 8});
    for (vec4& texel : picture.pixels()) texel = {any(random), any(random), any(random), 1};
    const float infinity = std::numeric_limits<float>::infinity();
    for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp})
        for (const Filter filter : {Filter::nearest, Filter::bilinear, Filter::trilinear}) {
            const Texture texture = make_texture(picture, wrap);
            for (const float strange : {0.5f, 1e30f, -1e-30f, infinity, std::nanf("")}) {
                const std::array<vec2, 3> uvs = {vec2(any(random), strange),
                                                 vec2(any(random), any(random)),
                                                 vec2(any(random), any(random))};
                ManyWeights weights;
                const auto three = [&] { return vec3(any(random), any(random), any(random)); };
                while (weights.count < most_points - 1)
                    weights.set(weights.count++, {three(), 0.1f * three(), 0.1f * three()});
                std::size_t taken = 0;
                sample_many(texture, filter, uvs, weights, [&](std::size_t i, vec4 color) {
                    ASSERT_EQ(i, taken++);
                    ASSERT_EQ(color, sample(texture, filter, fragment_uv(uvs, weights[i])));
                });
                EXPECT_EQ(taken, weights.count);
            }
        }
}

TEST(ShadingVariants, EveryShadingIsThatOfTheSurfaceWhereItIsComputed) {
    // A highlight of 90 makes 90 of each half ulp that its cosine is off, and that has a dozen.
    constexpr double tolerance = 1e-4;
    const ExactSphere exact(sphere());
    const std::array<vec3, 3> corners = {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)};
    for (const Triangle& triangle : sphere().mesh().triangles) {
        const TriangleLight flat = sphere().light_on(triangle, {.shading = Shading::flat});
        const TriangleLight gouraud = sphere().light_on(triangle, {.shading = Shading::gouraud});
        const TriangleLight phong = sphere().light_on(triangle, {});
        std::array<dvec3, 3> at;
        for (std::size_t i = 0; i < 3; ++i) {
            at[i] = sphere().mesh().positions[triangle.corners[i].position];
            const auto expected =
                static_cast<double>(exact.light_at(wide(at[i] / glm::length(at[i])), wide(at[i])));
            ASSERT_NEAR(grey(light_at(gouraud, corners[i])), expected, tolerance);
            ASSERT_NEAR(grey(light_at(phong, corners[i])), expected, tolerance);
        }
        const dvec3 across = glm::cross(at[1] - at[0], at[2] - at[0]);
        const auto expected = static_cast<double>(exact.light_at(
            wide(across / glm::length(across)), wide((at[0] + at[1] + at[2]) / 3.0)));
        for (const vec3 weights : corners)
            ASSERT_NEAR(grey(light_at(flat, weights)), expected, tolerance);
    }
}

TEST(ShadingVariants, BetweenTheCornersFlatStaysAndGouraudIsStraight) {
    constexpr float tolerance = 1e-6f;  // 3 products and 2 sums of numbers below 2
    for (const Triangle& triangle : sphere().mesh().triangles) {
        const TriangleLight flat = sphere().light_on(triangle, {.shading = Shading::flat});
        const TriangleLight gouraud = sphere().light_on(triangle, {.shading = Shading::gouraud});
        const ReflectedLight of_face = light_at(flat, vec3(1, 0, 0));
        const ReflectedLight a = light_at(gouraud, vec3(1, 0, 0));
        const ReflectedLight b = light_at(gouraud, vec3(0, 1, 0));
        const ReflectedLight c = light_at(gouraud, vec3(0, 0, 1));
        for (const vec3 w : weights_in_triangles(10)) {
            EXPECT_EQ(light_at(flat, w).diffuse, of_face.diffuse);
            EXPECT_EQ(light_at(flat, w).specular, of_face.specular);
            EXPECT_NEAR(light_at(gouraud, w).diffuse.x,
                        w.x * a.diffuse.x + w.y * b.diffuse.x + w.z * c.diffuse.x, tolerance);
            EXPECT_NEAR(light_at(gouraud, w).specular.y,
                        w.x * a.specular.y + w.y * b.specular.y + w.z * c.specular.y, tolerance);
        }
    }
}

TEST(ShadingVariants, BacksAreLitOnlyWhereFrontsAreDark) {
    for (const Shading shading : {Shading::flat, Shading::gouraud, Shading::phong})
        for (const Triangle& triangle : sphere().mesh().triangles) {
            const TriangleLight front = sphere().light_on(triangle, {.shading = shading}, false);
            const TriangleLight back = sphere().light_on(triangle, {.shading = shading}, true);
            const vec3 middle(1.0f / 3);
            const vec3 corner(1, 0, 0);
            const vec3 at = shading == Shading::gouraud ? corner : middle;
            const bool front_is_lit = light_at(front, at).diffuse.x > 0;
            ASSERT_NE(front_is_lit, light_at(back, at).diffuse.x > 0);
        }
}

TEST(ShadingVariants, ThePlaceDecidesHowNearThePictureComes) {
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

TEST(ShadingVariants, PowersAreWithinTheirBounds) {
    for (const float exponent : {1.0f, 2.0f, 7.0f, 32.0f, 90.0f, 1000.0f}) {
        for (int i = 0; i <= inputs; ++i) {
            const float x = static_cast<float>(i) / inputs;
            const long double power = std::pow(static_cast<long double>(x), exponent);
            const auto error = [&](Power how) {
                return std::abs(power_as(how, x, exponent) - power);
            };
            if (power < std::numeric_limits<float>::min()) {
                EXPECT_LE(power_as(Power::squarings, x, exponent), 2e-38f);
                continue;
            }
            // A power rounded twice, and one within an ulp.
            ASSERT_LE(error(Power::in_double), 1.0001L * half_ulp * power) << x << '^' << exponent;
            ASSERT_LE(error(Power::in_float), 2 * half_ulp * power) << x << '^' << exponent;
            ASSERT_LE(error(Power::squarings), 1.01L * exponent * half_ulp * power)
                << x << '^' << exponent;
        }
    }
}

TEST(ShadingVariants, SchlicksCurveLiesAboveThePower) {
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

TEST(ShadingVariants, NoHighlightIsLeftOutThatCanBeSeen) {
    constexpr float least_seen = 1.0f / 255 / 13 / 2;  // half of the first code of sRGB
    for (const Power how : {Power::in_float, Power::in_double, Power::squarings, Power::schlick})
        for (const float exponent : {0.0f, 1.0f, 7.0f, 32.0f, 90.0f, 1000.0f}) {
            const float least = least_seen_cosine(how, exponent);
            if (least == 0) continue;
            EXPECT_LT(power_as(how, least, exponent), least_seen / 1000)
                << static_cast<int>(how) << ": " << exponent;
        }
}

TEST(ShadingVariants, PowersTakeWhatMaterialsAndRoundingBring) {
    const float above_one = std::nextafter(1.0f, 2.0f);
    for (const Power how : {Power::in_float, Power::in_double, Power::squarings, Power::schlick}) {
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

TEST(ShadingVariants, ApproximateNormalsHaveNearlyLength1AndTheirDirection) {
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

TEST(ShadingVariants, NormalsAreScaledAsTheVariantSays) {
    // Light that is evenly reflected is proportional to the normal's length.
    const Triangle& triangle = sphere().mesh().triangles[50];
    for (const vec3 weights : weights_in_triangles(100)) {
        vec3 normal(0), position(0);
        for (int k = 0; k < 3; ++k) {
            const Corner corner = triangle.corners[static_cast<std::size_t>(k)];
            normal += weights[k] * sphere().mesh().normals[corner.normal];
            position += weights[k] * sphere().mesh().positions[corner.position];
        }
        ASSERT_GT(glm::dot(normal, sphere().lights[0].position_world - position), 0) << "dark";
        const auto diffuse = [&](NormalScaling normals) {
            return light_at(sphere().light_on(triangle, {.normals = normals}), weights).diffuse.x;
        };
        const float exact = diffuse(NormalScaling::exact);
        EXPECT_NEAR(diffuse(NormalScaling::none) / exact, glm::length(normal), 1e-5f);
        EXPECT_NEAR(diffuse(NormalScaling::approximate) / exact, 1, 0.0018f);
    }
}

TEST(ShadingVariants, EveryKnobDraws) {
    const Image<u8vec4> usual = picture({});
    const auto changed = [&](const std::vector<std::string>& arguments) {
        return differing_pixels(usual, picture(arguments));
    };
    EXPECT_EQ(changed({"--shading", "phong", "--highlight", "phong", "--power", "float",
                       "--normals", "exact", "--light", "lamp"}),
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
    for (const char* light : {"sun", "spot"}) EXPECT_GT(changed({"--light", light}), 1000) << light;
    // These compute the same but for rounding, which an 8-bit code may show here and there.
    constexpr int rounded_pixels = 100;
    for (const char* power : {"double", "squarings"})
        EXPECT_LE(changed({"--power", power}), rounded_pixels) << power;
    EXPECT_EQ(changed({"--all-effects"}), 0);
}
