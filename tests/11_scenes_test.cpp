// SPDX-License-Identifier: MIT
// Lights of files, shader permutations, toon materials and outlines, alpha test and blending,
// cameras.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "11_scenes/blending.hpp"
#include "11_scenes/permutation.hpp"
#include "11_scenes/scene_assets.hpp"
#include "11_scenes/scene_camera.hpp"
#include "11_scenes/scene_lights.hpp"
#include "11_scenes/scene_plan.hpp"
#include "11_scenes/toon_material.hpp"
#include "support/any_scene.hpp"
#include "support/first_difference.hpp"
#include "support/look_up.hpp"
#include "support/name_of_split.hpp"
#include "support/one_triangle.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();
constexpr double pi = 3.14159265358979323846;

SceneLight file_light(SceneLight::Kind kind, vec3 color) {
    return {"light",       kind,           color,
            vec3(1, 2, 3), vec3(0, -1, 0), std::numeric_limits<float>::infinity()};
}

}  // namespace

TEST(Scenes, Eq11_1_ADirectionalLightOfPiLuxMakesAWhiteSurfaceWhite) {
    const Light sun =
        light_of(file_light(SceneLight::Kind::directional, vec3(lux_of_white, 2, 0)), 7);
    EXPECT_EQ(sun.kind, LightKind::directional);
    EXPECT_EQ(sun.direction_world, vec3(0, 1, 0)) << "towards the light; the file has it from it";
    const Incoming incoming = incoming_light(sun, vec3(50, -4, 9));
    EXPECT_EQ(incoming.color.r, 1) << "a directional light of pi lux of red: so much of it arrives";
    EXPECT_NEAR(incoming.color.g, 2 / pi, 2e-7)  // an ulp of a quotient, and of pi in float
        << "a directional light of 2 lux of green: so much of it arrives";
    EXPECT_EQ(incoming.color.b, 0);
}

TEST(Scenes, Eq11_2_APointLightFallsOffWithTheSquareOfTheDistance) {
    constexpr float radius = 4;
    const Light point_light = light_of(file_light(SceneLight::Kind::point, vec3(60)), radius);
    // 5 away: within a hundredth, since the light has a size.
    EXPECT_NEAR(incoming_light(point_light, vec3(1, 2, 8)).color.r, 60 / (25 * pi), 1e-3)
        << "of a point light of 60 candela, 5 away, 60 / (25 pi) arrive: the worked example";
    EXPECT_EQ(point_light.position_world, vec3(1, 2, 3));
    const double size = double{point_light_size} * radius;
    for (const double distance : {0.0, 0.25, 0.5, 1.0, 3.0, 40.0}) {
        const vec3 point = point_light.position_world + vec3(0, -distance, 0);
        const double arriving = incoming_light(point_light, point).color.r;
        // A dozen roundings on the way.
        const double exact = 60 / pi / (distance * distance + size * size);
        ASSERT_NEAR(arriving, exact, 1e-6 * exact) << "of a point light of 60 candela and the size "
                                                   << size << ", " << distance << " away";
    }
}

TEST(Scenes, HardCase_PointLightsAreFiniteInScenesOfAnySize) {
    look_up("Eq. 11.2");
    for (const float radius : {1e-37f, 1e-10f, 1.0f, 1e10f, 3e38f})
        for (const SceneLight::Kind kind : {SceneLight::Kind::point, SceneLight::Kind::spot}) {
            const Light point_light = light_of(file_light(kind, vec3(1e30f, 1, 0)), radius);
            ASSERT_GE(point_light.half_distance, std::numeric_limits<float>::min())
                << "in a scene of radius " << radius;
            for (const vec3 point : {vec3(1, 2, 3), vec3(0), vec3(1e30f), vec3(-5, 1, 2)}) {
                const vec3 color = incoming_light(point_light, point).color;
                ASSERT_TRUE(std::isfinite(color.r) && std::isfinite(color.g))
                    << testing::PrintToString(color) << " at " << testing::PrintToString(point)
                    << ", in a scene of radius " << radius;
                ASSERT_EQ(color.b, 0);
            }
        }
}

TEST(Scenes, HardCase_LightsBeyondTheLimitAreNamed) {
    look_up("Eq. 11.1");
    Scene scene;
    for (std::size_t i = 0; i < max_lights + 2; ++i) {
        scene.lights.push_back(file_light(SceneLight::Kind::point, vec3(1)));
        scene.lights.back().name = "light " + std::to_string(i);
    }
    std::vector<std::string> warnings;
    const SceneLights lights = lights_of(scene, LightKind::directional, warnings);
    EXPECT_EQ(lights.lights.size(), max_lights);
    EXPECT_TRUE(lights.are_of_file);
    EXPECT_TRUE(std::ranges::all_of(lights.casts, [](bool casts) { return casts; }));
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_NE(warnings[0].find("\"light 16\""), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[1].find("\"light 17\""), std::string::npos) << warnings[1];
    scene.lights.clear();
    const SceneLights own = lights_of(scene, LightKind::spot, warnings);
    ASSERT_EQ(own.lights.size(), 2u) << "those of lesson 09";
    EXPECT_EQ(own.lights[0].kind, LightKind::spot);
    EXPECT_TRUE(own.casts[0] && !own.casts[1] && !own.are_of_file);
}

TEST(Scenes, HardCase_ATileOfTooMuchGlassIsDrawnInParts) {
    look_up("Memory");
    for (const Split split : splits)
        for (const std::size_t triangles : {std::size_t{0}, std::size_t{1}, max_transparent / 1000,
                                            max_transparent / 7, 2 * max_transparent}) {
            SCOPED_TRACE(std::to_string(triangles) + " triangles, " + name_of(split));
            Image<int> visits({61, 37}, 0);
            const Tiling tiling(split, visits.size(), 3, 40);
            for (std::size_t i = 0; i < tiling.count(); ++i)
                for_each_part(tiling[i], triangles, [&](const Tile& part) {
                    std::size_t pixels = 0;
                    for_each_strip(part, [&](const PixelBox& strip) {
                        for (int y = strip.first.y; y <= strip.last.y; ++y)
                            for (int x = strip.first.x; x <= strip.last.x; ++x)
                                ++visits[{x, y}], ++pixels;
                    });
                    ASSERT_TRUE(pixels == 1 || pixels * triangles <= max_transparent)
                        << pixels << " pixels of a part";
                });
            ASSERT_TRUE(are_equal(visits, Image<int>(visits.size(), 1)))
                << "in how many parts pixels are";
        }
}

TEST(Scenes, Eq11_12_LightsOfAnyUnitAreScaledDownTogether) {
    Bounds bounds;
    bounds.add(vec3(-1, 2, 3)), bounds.add(vec3(3, 2, 3));  // middle (1, 2, 3), radius 2
    ASSERT_EQ(bounds.radius(), 2);
    SceneLight sun = file_light(SceneLight::Kind::directional, vec3(1, 2049, 0));
    EXPECT_NEAR(exposure_of({&sun, 1}, bounds), pi / 2049, 1e-9) << "Blender's sun, as worked";
    sun.color = vec3(lux_of_white * 2);
    EXPECT_EQ(exposure_of({&sun, 1}, bounds), 1) << "twice white is kept";
    sun.color *= 1.0001f;
    EXPECT_NEAR(exposure_of({&sun, 1}, bounds), 0.5, 1e-4);
    EXPECT_EQ(exposure_of({}, bounds), 1);

    for (const SceneLight::Kind kind : {SceneLight::Kind::point, SceneLight::Kind::spot})
        for (const double distance : {0.0, 1.0, 2.0, 8.0}) {
            std::array lights = {sun, file_light(kind, vec3(0, 9000, 4))};
            lights[1].position_world = vec3(1, 2, 3 + distance);
            const double far_away = std::max(distance, 2.0);  // one radius at least
            ASSERT_NEAR(exposure_of(lights, bounds), pi * far_away * far_away / 9000, 1e-7)
                << "a point light of 9000 candela, " << distance
                << " from the middle of a scene of radius "
                << "2: it counts as " << far_away << " away";
        }

    Scene scene;
    scene.meshes.resize(1);
    scene.meshes[0].positions = {{-1, 2, 3}, {3, 2, 3}};
    for (const vec3 p : scene.meshes[0].positions) scene.meshes[0].bounds.add(p);
    scene.lights = {file_light(SceneLight::Kind::directional, vec3(2049)),
                    file_light(SceneLight::Kind::point, vec3(100))};
    std::vector<std::string> warnings;
    const SceneLights lights = lights_of(scene, LightKind::directional, warnings);
    EXPECT_NEAR(lights.lights[0].color.r, 1, 1e-6);
    const Light alone = light_of(scene.lights[1], 2);
    EXPECT_NEAR(lights.lights[1].color.r, alone.color.r * pi / 2049, 1e-6 * alone.color.r)
        << "all by the same number";
}

TEST(Scenes, HardCase_LightsOfAnyStrengthAreNeitherBlackNorInfinite) {
    look_up("Eq. 11.12");
    for (const float size : {0.0f, 1e-30f, 1.0f, 1e30f})
        for (const float strength : {0.0f, 1e-38f, 1.0f, 3e38f})
            for (const SceneLight::Kind kind :
                 {SceneLight::Kind::directional, SceneLight::Kind::point}) {
                Bounds bounds;
                bounds.add(vec3(1, 2, 3) - size), bounds.add(vec3(1, 2, 3) + size);
                const SceneLight light = file_light(kind, vec3(strength));
                const float exposure = exposure_of({&light, 1}, bounds);
                ASSERT_TRUE(exposure > 0 && exposure <= 1)
                    << exposure << ", expected above 0 and at most 1; a scene of half size " << size
                    << ", a light of " << strength;
            }
}

TEST(Scenes, Eq11_3_EachSetOfEffectsHasAPermutationWithAllOfThem) {
    std::set<std::size_t> used;
    for (unsigned bits = 0; bits < 1u << effect_count; ++bits) {
        MaterialPlan plan;
        for (std::size_t e = 0; e < effect_count; ++e)
            plan.effects.set(static_cast<Effect>(e), bits >> e & 1);
        const std::size_t permutation = permutation_of(plan);
        ASSERT_LT(permutation, all_permutations.size());
        used.insert(permutation);
        const Permutation effects = all_permutations[permutation];
        const bool toon = plan[Effect::toon], light = plan[Effect::light];
        SCOPED_TRACE("called for: those with the bits " + std::to_string(bits));
        ASSERT_EQ(static_cast<int>(effects.model), static_cast<int>(toon    ? ShadingModel::toon
                                                                    : light ? ShadingModel::phong
                                                                            : ShadingModel::unlit))
            << "the shading model: toon before Phong's, and neither without light";
        if (!toon && !light) {
            ASSERT_FALSE(effects.normal_map || effects.shadow) << "no light: nothing to perturb";
            continue;
        }
        ASSERT_TRUE(effects.normal_map || !plan[Effect::normal_map]) << "no normal map";
        ASSERT_TRUE(effects.shadow || !plan[Effect::shadow]) << "no shadow";
        if (light && !toon) {  // the common ones have no more than is called for
            ASSERT_EQ(effects.normal_map, plan[Effect::normal_map]);
            ASSERT_EQ(effects.shadow, plan[Effect::shadow]);
        }
    }
    EXPECT_EQ(used.size(), all_permutations.size()) << "none is compiled for nothing";
}

TEST(Scenes, HardCase_MaterialsThatNoTriangleHasDoNotCount) {
    look_up("Eq. 11.3");
    for (const bool is_seen : {false, true})
        for (const bool is_toon : {false, true}) {
            ScenePlan plan{std::vector<MaterialPlan>(3)};  // the first is seen, the last a toon's
            plan.materials[0].is_seen = true, plan.materials[1].is_seen = is_seen;
            plan.materials[1].effects.set(Effect::toon, is_toon);
            plan.materials[2].effects.set(Effect::toon);
            EXPECT_EQ(plan.any(Effect::toon), is_seen && is_toon);
        }
}

TEST(Scenes, Eq11_4_TheShadingBorderOfAToonMaterial) {
    const auto look = [](float toony, float shift) {
        return ToonMaterial{.toony = toony, .shift = shift};
    };
    // The worked example: toony 0.95, shift -0.1.
    const char* const worked = "look(toony, shift): the border goes from cosine 0.05 to 0.15";
    EXPECT_EQ(toon_step(0.0f, look(0.95f, -0.1f)), 0) << worked;
    EXPECT_NEAR(toon_step(0.1f, look(0.95f, -0.1f)), 0.5, 1e-6)  // 1 - 0.95 has 1e-6 of error
        << worked;
    EXPECT_NEAR(toon_step(0.075f, look(0.95f, -0.1f)), 0.25, 1e-5) << worked;
    EXPECT_EQ(toon_step(0.2f, look(0.95f, -0.1f)), 1) << worked;
    // Sharp: light from the threshold on.
    EXPECT_EQ(toon_step(0.0f, look(1, 0)), 1);
    EXPECT_EQ(toon_step(std::nextafter(0.0f, -1.0f), look(1, 0)), 0);
    EXPECT_EQ(toon_step(-0.25f, look(1, 0.25f)), 1) << "a positive shift makes the lit side larger";
    EXPECT_EQ(toon_step(-0.251f, look(1, 0.25f)), 0);
    // As wide as the sphere: half of Lambert's way from one side to the other.
    for (const float cosine : {-1.0f, -0.5f, 0.0f, 0.25f, 1.0f})
        ASSERT_EQ(toon_step(cosine, look(0, 0)), 0.5f + 0.5f * cosine)
            << "cosine " << cosine << ", toony 0: the border is all of the sphere";
    for (const float toony : {0.0f, 0.3f, 1.0f})
        ASSERT_EQ(toon_step(nan_value, look(toony, 0)), 0)
            << "a cosine that is no number, toony " << toony;
    for (const float toony : {0.0f, 0.5f, 0.9f, 1.0f})
        for (const float shift : {-1.0f, -0.2f, 0.0f, 1.0f}) {
            float last = 0;
            for (int i = -100; i <= 100; ++i) {
                const float step = toon_step(static_cast<float>(i) / 100, look(toony, shift));
                ASSERT_TRUE(step >= last && step <= 1)
                    << step << " at the cosine " << i / 100.0 << ", after " << last
                    << " at 0.01 less; toony " << toony << ", shift " << shift;
                last = step;
            }
        }
}

TEST(Scenes, Eq11_5_OnlyTheRelativeBrightnessOfLightsCounts) {
    const ToonMaterial sharp{.toony = 1};
    const vec3 up(0, 1, 0);
    const auto all = [](std::size_t) { return 1.0f; };
    for (const float bright : {1e-6f, 0.3f, 1.0f, 1e6f}) {
        const std::array sun = {Light{LightKind::directional, vec3(bright, 0, 0), up}};
        SCOPED_TRACE("a sun above, of brightness " + std::to_string(bright));
        ASSERT_EQ(toon_level(sun, vec3(0), 5.0f * up, sharp, all), 1)
            << "the normal points up, and is 5 long";
        ASSERT_EQ(toon_level(sun, vec3(0), -up, sharp, all), 0) << "the normal points down";
        ASSERT_EQ(toon_level(sun, vec3(0), up, sharp, [](std::size_t) { return 0.5f; }), 1)
            << "half of the light is in shadow: that is none";
        ASSERT_EQ(toon_level(sun, vec3(0), up, sharp, [](std::size_t) { return 0.49f; }), 0)
            << "more than half of the light is in shadow: that is all";
    }
    // The worked example: the sun is behind, and the sky of a quarter of its brightness is not.
    const std::array lights = {Light{LightKind::directional, vec3(2, 1, 1), -up},
                               Light{LightKind::directional, vec3(0.1f, 0.5f, 0.2f), up}};
    EXPECT_EQ(toon_level(lights, vec3(0), up, sharp, all), 0.25f)
        << "only the sky shines on it, of a quarter of the sun's brightness";
    EXPECT_EQ(toon_level(lights, vec3(0), -up, sharp, all), 1) << "only the sun shines on it";
    const std::array both = {lights[0], Light{LightKind::directional, vec3(2), -up}};
    EXPECT_EQ(toon_level(both, vec3(0), -up, sharp, all), 1) << "not more than lit";
    // No light, no normal, no number.
    EXPECT_EQ(toon_level({}, vec3(0), up, sharp, all), 0);
    EXPECT_EQ(
        toon_level(std::array{Light{LightKind::directional, vec3(0), up}}, vec3(0), up, sharp, all),
        0);
    EXPECT_EQ(toon_level(lights, vec3(0), vec3(nan_value), {.toony = 0.5f}, all), 0.625f)
        << "without a normal as if all lights grazed it";
    for (const float level : {0.0f, 0.3f, 1.0f})
        EXPECT_EQ(toon_paint(vec3(0.1f, 0.7f, 3), vec3(0.1f, 0.7f, 3), level), vec3(0.1f, 0.7f, 3));
    EXPECT_EQ(toon_paint(vec3(0.25f), vec3(0.75f), 0.5f), vec3(0.5f));
}

TEST(Scenes, Eq11_7_TheAlphaTestPassesAtTheCutoff) {
    EXPECT_TRUE(passes_alpha_test(0.5f, 0.5f));
    EXPECT_FALSE(passes_alpha_test(std::nextafter(0.5f, 0.0f), 0.5f));
    EXPECT_TRUE(passes_alpha_test(0.0f, 0.0f));
    EXPECT_FALSE(passes_alpha_test(1.0f, 1.01f)) << "a cutoff above 1: all of it is a hole";
    EXPECT_FALSE(passes_alpha_test(nan_value, 0.5f));
}

TEST(Scenes, Eq11_8_OverIsExactAtBothEnds) {
    EXPECT_EQ(over(vec3(1, 0, 0), 0.5f, vec3(0, 0, 1)), vec3(0.5f, 0, 0.5f)) << "as worked";
    EXPECT_EQ(over(vec3(1, 0, 0), 0.25f, vec3(0, 0, 1)), vec3(0.25f, 0, 0.75f))
        << "a quarter of red over blue";
    Dice dice(11);
    for (int k = 0; k < 1000; ++k) {
        const vec3 color = 4.0f * dice.color(), behind = 4.0f * dice.color();
        ASSERT_EQ(over(color, 1, behind), color) << "with an opacity of 1 it is the colour itself";
        ASSERT_EQ(over(color, 0, behind), behind) << "with an opacity of 0 it is what lies behind";
    }
}

TEST(Scenes, Eq11_9_FragmentsAreBlendedBackToFrontInWhateverOrderTheyCome) {
    // The worked example: glass of red at 0.6, of blue at 0.3, both of a half, over white.
    for (const bool red_first : {true, false}) {
        TransparentFragments panes;
        const TransparentFragment red{{0, 0}, 0.6f, 0.5f, {1, 0, 0}},
            blue{{0, 0}, 0.3f, 0.5f, {0, 0, 1}};
        panes.add(red_first ? red : blue), panes.add(red_first ? blue : red);
        Image<vec3> white({1, 1}, vec3(1));
        panes.blend_over(white);
        ASSERT_EQ((white[{0, 0}]), vec3(0.75f, 0.25f, 0.5f))
            << "over white, blue glass at depth 0.3 and red glass at 0.6, both of opacity 0.5; "
            << (red_first ? "red" : "blue") << " is added first";
    }
    // Of equal depths, the first one lies on top.
    TransparentFragments panes;
    panes.add({{0, 0}, 0.5f, 1, {1, 0, 0}}), panes.add({{0, 0}, 0.5f, 1, {0, 0, 1}});
    Image<vec3> white({1, 1}, vec3(1));
    panes.blend_over(white);
    EXPECT_EQ((white[{0, 0}]), vec3(1, 0, 0))
        << "red is added first, then blue at the same depth; both have opacity 1";
    Dice dice(12);
    for (int k = 0; k < 300; ++k) {
        // Steps of an eighth, so that many fragments have the same depth.
        std::vector<TransparentFragment> transparent(dice.below(60));
        for (TransparentFragment& fragment : transparent)
            fragment = {ivec2(dice.below(5), dice.below(4)), float(dice.below(9)) / 8,
                        float(dice.below(5)) / 4,
                        vec3(dice.below(8), dice.below(8), dice.below(8)) / 8.0f};
        TransparentFragments gathered;
        for (const TransparentFragment& fragment : transparent) gathered.add(fragment);
        Image<vec3> actual({5, 4}, vec3(0.25f)), expected = actual;
        gathered.blend_over(actual);
        // The farthest first, and of equals the last.
        std::ranges::reverse(transparent);
        std::ranges::stable_sort(transparent, {}, &TransparentFragment::depth);
        for (const TransparentFragment& fragment : transparent) {
            vec3& pixel = expected[fragment.pixel];
            pixel = fragment.opacity * fragment.color + (1 - fragment.opacity) * pixel;
        }
        ASSERT_TRUE(are_equal(actual, expected))
            << transparent.size() << " fragments, some of equal depth (seed 12, case " << k << ")";
        ASSERT_TRUE(gathered.empty()) << "after blending none is left";
    }
}

TEST(Scenes, Eq11_6_OutlinesHaveTheWidthThatIsAskedFor) {
    Scene scene;
    scene.materials.resize(3);
    scene.materials[0].toon =
        ToonMaterial{.outline = ToonMaterial::Outline::world, .outline_width = 0.25f};
    scene.materials[2].toon = ToonMaterial{.outline = ToonMaterial::Outline::screen,
                                           .outline_width = 0.01f,
                                           .outline_color = vec3(0.5f)};
    for (const std::uint32_t material : {0u, 1u, 2u}) {  // a tetrahedron of each
        Mesh mesh = mesh_of({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                            {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}});
        for (Triangle& triangle : mesh.triangles) triangle.material = material;
        scene.meshes.push_back(mesh);
    }
    const Scene inked = with_outline_materials(scene);
    ASSERT_EQ(inked.materials.size(), 5u);
    EXPECT_EQ(inked.materials[4].diffuse, vec3(0.5f));
    EXPECT_EQ(inked.materials[4].illumination, 0);
    const std::vector<OutlineHull> hulls = outline_hulls(inked);
    ASSERT_EQ(hulls.size(), 2u) << "the second has none";
    const Camera camera = orbit_camera({.distance = 6, .fov_degrees = 50}, scene.bounds());
    for (std::size_t h = 0; h < 2; ++h) {
        const Mesh hull = pushed(hulls[h], camera);
        ASSERT_EQ(hull.triangles.size(), 4u);
        EXPECT_EQ(hull.triangles[0].material, h + 3);
        const auto& [a, b, c] = hull.triangles[0].vertices;
        EXPECT_EQ(a.position, 0u);
        EXPECT_EQ(b.position, 2u) << "turned inside out";
        EXPECT_EQ(c.position, 1u);
        for (std::size_t i = 0; i < 4; ++i) {
            const dvec3 place(scene.meshes[0].positions[i]), way(dvec3(hull.positions[i]) - place);
            ASSERT_GT(glm::dot(way, place), 0)
                << "a tetrahedron's vertex " << testing::PrintToString(vec3(place))
                << " is pushed by " << testing::PrintToString(vec3(way)) << ", expected outwards";
            // A tetrahedron's vertex is pushed straight away from its middle.
            ASSERT_NEAR(glm::length(glm::cross(way, place)), 0, 1e-6);
            const double distance = -(camera.view_from_world * vec4(place, 1)).z;
            const double height = 2 * distance * std::tan(25 * pi / 180);
            ASSERT_NEAR(glm::length(way), h == 0 ? 0.25 : 0.01 * height, 2e-6)
                << (h == 0 ? "an outline of 0.25 in the world"
                           : "an outline of 0.01 heights of the picture, by a camera of 50 degrees")
                << ": so far is a vertex pushed that is " << distance << " in front of the camera";
            Bounds with = hull.bounds;
            with.add(hull.positions[i]);
            ASSERT_TRUE(with.min == hull.bounds.min && with.max == hull.bounds.max)
                << "the bounds hold all positions";
        }
    }
    OutlineHull behind = hulls[1];
    for (vec3& place : behind.places) place += 2.0f * camera.position_world;
    EXPECT_EQ(pushed(behind, camera).positions, behind.places) << "not inwards, behind the eye";
}

TEST(Scenes, HardCase_AMeshOfSeveralMaterialsHasTheOutlineOfEach) {
    look_up("Eq. 11.6");
    Scene scene;
    scene.materials.resize(3);
    for (const auto& [material, width] : {std::pair(1, 0.0f), {2, 0.5f}})
        scene.materials.at(std::size_t(material)).toon =
            ToonMaterial{.outline = ToonMaterial::Outline::world, .outline_width = width};
    Mesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}},
                        {{0, 1, 2}, {3, 4, 5}});
    mesh.triangles[0].material = 1, mesh.triangles[1].material = 2;
    scene.meshes = {mesh};
    const std::vector<OutlineHull> hulls = outline_hulls(with_outline_materials(scene));
    ASSERT_EQ(hulls.size(), 1u);
    ASSERT_EQ(hulls[0].mesh.triangles.size(), 1u) << "a width of 0 is none";
    const Mesh hull = pushed(hulls[0], orbit_camera(Orbit(), {}));
    EXPECT_EQ(hull.positions[0], vec3(0)) << "what has no outline stays";
    EXPECT_EQ(hull.positions[3], vec3(5, 0, 0.5f));
}

TEST(Scenes, HardCase_CamerasByNameAndNumber) {
    look_up("Eq. 11.1");
    Scene scene;
    EXPECT_FALSE(chosen_camera(scene, "", false)) << "none: around the scene";
    scene.cameras = {{"front", mat4(1), 0.5f, 0.1f, 100}, {"7", mat4(1), 0.7f, 1, 2}};
    scene.cameras[1].world_from_view =
        translation(vec3(3, 4, 5)) * rotation_y(0.5f) * rotation_x(-0.25f);
    EXPECT_EQ(chosen_camera(scene, "", false), 0u);
    EXPECT_FALSE(chosen_camera(scene, "", true)) << "another orbit is asked for";
    EXPECT_FALSE(chosen_camera(scene, "orbit", false) || chosen_camera(scene, "fit", false));
    EXPECT_EQ(chosen_camera(scene, "front", true), 0u);
    EXPECT_EQ(chosen_camera(scene, "1", false), 1u);
    EXPECT_EQ(chosen_camera(scene, "7", false), 1u);
    for (const char* wrong : {"2", "Front", "-1", "0x0"}) {
        try {
            chosen_camera(scene, wrong, false);
            ADD_FAILURE() << wrong;
        } catch (const std::runtime_error& error) {
            EXPECT_NE(std::string(error.what()).find("0 \"front\", 1 \"7\""), std::string::npos)
                << error.what();
        }
    }
    const Camera camera = camera_of(scene.cameras[1]);
    EXPECT_EQ(camera.position_world, vec3(3, 4, 5));
    EXPECT_EQ(camera.fov_y_radians, 0.7f);
    const mat4 identity = camera.view_from_world * scene.cameras[1].world_from_view;
    for (int c = 0; c < 4; ++c)  // sums of products of 5, each rounded
        EXPECT_LT(glm::distance(identity[c], mat4(1)[c]), 4e-6) << "column " << c;
    // What it looks at lies on its -z.
    const vec4 center = camera.view_from_world * vec4(camera.center_world, 1);
    EXPECT_LT(glm::distance(center, vec4(0, 0, -1, 1)), 4e-6) << testing::PrintToString(center);
}

TEST(Scenes, Eq11_11_AFittedSceneTakesNineTenthsOfThePicture) {
    Dice dice(13);
    for (int k = 0; k < 500; ++k) {
        Bounds bounds;
        for (int i = 0; i < 2; ++i) bounds.add(dice.in_cube(9));
        Orbit orbit{dice.between(-180, 180), dice.between(-90, 90), 1, dice.between(5, 120)};
        const ivec2 size(100 + dice.below(900), 100 + dice.below(900));
        orbit.distance = fitting_distance(orbit, bounds, size);
        const mat4 clip_from_world = orbit_camera(orbit, bounds).clip_from_world(size);
        float farthest = 0;
        for (int i = 0; i < 8; ++i) {
            const vec4 corner = clip_from_world * vec4(i & 1 ? bounds.max.x : bounds.min.x,
                                                       i & 2 ? bounds.max.y : bounds.min.y,
                                                       i & 4 ? bounds.max.z : bounds.min.z, 1);
            ASSERT_GT(corner.w, 0) << "seed 13, case " << k;
            farthest =
                std::max({farthest, std::abs(corner.x / corner.w), std::abs(corner.y / corner.w)});
        }
        // In float: the eye may be a thousand times as far away as a corner of the box is beside
        // the middle.
        ASSERT_NEAR(farthest, 0.9f, 1e-3f)
            << "the corner of the scene's box that is farthest from the picture's middle, in NDC; "
            << "a picture of " << testing::PrintToString(size) << ", " << orbit.fov_degrees
            << " degrees (seed 13, case " << k << ")";
    }
    // The worked example: a cube of side 2 from the front, 90 degrees, a square picture.
    const Bounds cube{vec3(-1), vec3(1)};
    const Orbit front{.yaw_degrees = 0, .pitch_degrees = 0, .distance = 7, .fov_degrees = 90};
    for (const auto& [width, tangent] : {std::pair(64, 0.9), {128, 0.9}, {32, 0.45}})
        EXPECT_NEAR(fitting_distance(front, cube, {width, 64}) * cube.radius(), 1 + 1 / tangent,
                    1e-6)
            << "a picture of " << width << " x 64: half as wide, the cube's sides touch";
    EXPECT_EQ(fitting_distance(front, {}, {64, 64}), 7);
    EXPECT_EQ(fitting_distance(front, {vec3(3), vec3(3)}, {64, 64}), 7);
}
