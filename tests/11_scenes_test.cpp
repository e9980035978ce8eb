// SPDX-License-Identifier: MIT
// Lights of files, alpha test and blending, cameras.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "11_scenes/blending.hpp"
#include "11_scenes/camera_choice.hpp"
#include "11_scenes/scene_assets.hpp"
#include "11_scenes/scene_camera.hpp"
#include "11_scenes/scene_lights.hpp"
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

TEST(Scenes, Eq11_3_ADirectionalLightOfPiLuxMakesAWhiteSurfaceWhite) {
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

TEST(Scenes, Eq11_4_APointLightFallsOffWithTheSquareOfTheDistance) {
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
    look_up("Eq. 11.4");
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
    look_up("Eq. 11.3");
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

TEST(Scenes, Eq11_5_LightsOfAnyUnitAreScaledDownTogether) {
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
    look_up("Eq. 11.5");
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

TEST(Scenes, Eq11_6_TheAlphaTestPassesAtTheCutoff) {
    EXPECT_TRUE(passes_alpha_test(0.5f, 0.5f));
    EXPECT_FALSE(passes_alpha_test(std::nextafter(0.5f, 0.0f), 0.5f));
    EXPECT_TRUE(passes_alpha_test(0.0f, 0.0f));
    EXPECT_FALSE(passes_alpha_test(1.0f, 1.01f)) << "a cutoff above 1: all of it is a hole";
    EXPECT_FALSE(passes_alpha_test(nan_value, 0.5f));
}

TEST(Scenes, Eq11_7_OverIsExactAtBothEnds) {
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

TEST(Scenes, Eq11_8_FragmentsAreBlendedBackToFrontInWhateverOrderTheyCome) {
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
        std::vector<std::pair<float, std::size_t>> order;
        for (std::size_t i = 0; i < transparent.size(); ++i)
            order.emplace_back(transparent[i].depth, transparent.size() - i);
        std::ranges::sort(order);
        for (const auto& [depth, from_end] : order) {
            const TransparentFragment& fragment = transparent[transparent.size() - from_end];
            vec3& pixel = expected[fragment.pixel];
            pixel = fragment.opacity * fragment.color + (1 - fragment.opacity) * pixel;
        }
        ASSERT_TRUE(are_equal(actual, expected))
            << transparent.size() << " fragments, some of equal depth (seed 12, case " << k << ")";
        ASSERT_TRUE(gathered.empty()) << "after blending none is left";
    }
}

TEST(Scenes, HardCase_CamerasByNameAndNumber) {
    look_up("Eq. 11.3");
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

TEST(Scenes, Eq11_1_AFittedSceneTakesNineTenthsOfThePicture) {
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
