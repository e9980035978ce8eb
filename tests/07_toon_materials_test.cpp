// SPDX-License-Identifier: MIT
// Toon materials of files: their two colours, and their outlines.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "07_toon/material_outlines.hpp"
#include "07_toon/toon_material.hpp"
#include "support/first_difference.hpp"
#include "support/look_up.hpp"
#include "support/one_triangle.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();
constexpr double pi = std::numbers::pi;

}  // namespace

TEST(Toon, Eq7_15_TheShadingBorderOfAToonMaterial) {
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

TEST(Toon, Eq7_16_OnlyTheRelativeBrightnessOfLightsCounts) {
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

TEST(Toon, Eq7_17_OutlinesHaveTheWidthThatIsAskedFor) {
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

TEST(Toon, HardCase_AMeshOfSeveralMaterialsHasTheOutlineOfEach) {
    look_up("Eq. 7.17");
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
