// SPDX-License-Identifier: MIT
// How lights see the scene, and what a shadow test finds.
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "09_shadow_maps/light_view.hpp"
#include "09_shadow_maps/shadow_map.hpp"
#include "support/light_maps.hpp"
#include "support/look_up.hpp"
#include "support/names.hpp"
#include "support/one_triangle.hpp"
#include "support/printers.hpp"
#include "support/reference.hpp"
#include "support/special_numbers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

Bounds box(vec3 low, vec3 high) { return {low, high}; }

Light directional_light(vec3 toward) {
    return {LightKind::directional, vec3(1), unit_or(toward, vec3(0, 1, 0))};
}

Light spotlight(vec3 position, vec3 target, float half_angle_degrees) {
    Light light{LightKind::spot, vec3(1), unit_or(target - position, vec3(0, -1, 0)), position};
    light.cos_outer = std::cos(glm::radians(half_angle_degrees));
    light.cos_inner = 1;
    return light;
}

dvec3 ndc(const mat4& clip_from_world, dvec3 point) {
    const dvec4 clip = dmat4(clip_from_world) * dvec4(point, 1);
    return dvec3(clip) / clip.w;
}

/// Of matrices in float; places in the tests' boxes are up to 10.
constexpr double float_tolerance = 1e-5;

class Anywhere {
  public:
    explicit Anywhere(unsigned seed) : random_(seed) {}
    float one(float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random_);
    }
    vec3 in(const Bounds& b) {
        const float x = one(b.min.x, b.max.x), y = one(b.min.y, b.max.y), z = one(b.min.z, b.max.z);
        return {x, y, z};
    }
    vec3 direction() { return unit_or(in(box(vec3(-1), vec3(1))), vec3(0, 1, 0)); }

  private:
    std::mt19937 random_;
};

/// A map of 4 x 4 texels whose clip space is the world: x = 2 (x_world + 1), y = 2 (1 - y_world),
/// depth = z_world.
ShadowMap small_map() { return {mat4(1), false, 4, box({-1, -1, 0}, vec3(1))}; }

/// Where the texel's centre is, at a depth.
vec3 at_texel(float column, float row, float depth) {
    return {(column + 0.5f) / 2 - 1, 1 - (row + 0.5f) / 2, depth};
}

void put(ShadowMap& map, ivec2 texel, float depth) {
    map.depths.depths()[texel + max_pcf_radius] = depth;
}

/// The share of a floor's points in the shadow of a roof far larger than it that are lit, as they
/// should not be: for EXPECT_TRUE.
template <int radius>
testing::AssertionResult is_dark_under_a_large_roof(const Light& light, int size) {
    // The map ends where the floor does; the roof goes on, and every shadow test there has to find
    // it.
    const Mesh roof =
        mesh_of({{-30, 1, -30}, {-30, 1, 30}, {30, 1, 30}, {30, 1, -30}}, {{0, 1, 2}, {0, 2, 3}});
    const Bounds floor = box({-1, 0, -1}, {1, 0, 1});
    const LightViews views = light_views(light, roof.bounds, floor, size);
    if (views.count != 1)
        return testing::AssertionFailure()
               << "light_views() has " << views.count << " maps, expected 1: the roof is above";
    ShadowMap map(views.clip_from_world[0], views.is_perspective, size, roof.bounds);
    draw_casters(map, roof, [](std::size_t) { return true; });
    for (int y = -20; y <= 20; ++y)
        for (int x = -20; x <= 20; ++x) {
            const vec3 point = vec3(x, 0, y) / 20.0f;
            const vec3 from_light = glm::normalize(point - light.position_world);
            if (light.kind == LightKind::spot &&
                glm::dot(from_light, light.direction_world) <= light.cos_outer)
                continue;  // beyond its cone
            if (const float lit = pcf_visibility<radius>(map, {}, point); lit != 0)
                return testing::AssertionFailure()
                       << "a " << name_of(light.kind)
                       << " shines down on a roof of 60 x 60 at y = 1 "
                       << "above a floor of 2 x 2 at y = 0, with a map of " << size
                       << " texels: at " << testing::PrintToString(point) << " on the floor " << lit
                       << " of its light arrives, expected 0";
        }
    return testing::AssertionSuccess();
}

}  // namespace

TEST(ShadowMaps, Eq9_1_ALightFromTheRight) {
    // It shines along -x: so z of NDC, which grows towards the light, grows with x.
    const Bounds all = box(vec3(-1), vec3(1));
    const LightViews views = light_views(directional_light({1, 0, 0}), all, all, 256);
    ASSERT_EQ(views.count, 1u) << "maps";
    const dvec3 near = ndc(views.clip_from_world[0], {0.5, 0.25, -0.5});
    const dvec3 far = ndc(views.clip_from_world[0], {-0.5, 0.25, -0.5});
    EXPECT_GT(near.z, far.z) << "NDC of (0.5, 0.25, -0.5), which is nearer to the light, has to "
                                "have more z than that of (-0.5, 0.25, -0.5)";
    EXPECT_NEAR(near.x, far.x, float_tolerance) << "both lie on one ray: in the same texel";
    EXPECT_NEAR(near.y, far.y, float_tolerance) << "both lie on one ray: in the same texel";
    const dvec3 higher = ndc(views.clip_from_world[0], {0.5, 0.75, -0.5});
    EXPECT_GT(higher.y, near.y) << "what is higher is higher in the map";
    EXPECT_NEAR(higher.x, near.x, float_tolerance);
}

TEST(ShadowMaps, Eq9_1_PointsOnOneRayOfADirectionalLightShareATexel) {
    Anywhere anywhere(1);
    const Bounds casters = box({-1, 0, -2}, {2, 3, 1}), receivers = box({-6, -1, -6}, {6, 0.5f, 6});
    for (int i = 0; i < 300; ++i) {
        vec3 toward = anywhere.direction();
        toward.y = std::abs(toward.y) + 0.1f;
        const Light light = directional_light(toward);
        const LightViews views = light_views(light, casters, receivers, 256);
        ASSERT_EQ(views.count, 1u) << "seed 1, case " << i;
        ASSERT_FALSE(views.is_perspective);
        const dvec3 point = anywhere.in(casters);
        const dvec3 here = ndc(views.clip_from_world[0], point);
        const dvec3 nearer = ndc(views.clip_from_world[0], point + dvec3(light.direction_world));
        const std::string where = "NDC of " + testing::PrintToString(vec3(point)) +
                                  " and of what lies 1 nearer to a light from " +
                                  testing::PrintToString(light.direction_world) +
                                  " (seed 1, case " + std::to_string(i) + ")";
        ASSERT_NEAR(here.x, nearer.x, float_tolerance) << where;
        ASSERT_NEAR(here.y, nearer.y, float_tolerance) << where;
        ASSERT_GT(nearer.z, here.z) << where;
        // Right-handed, up is up: as a camera would see it.
        const dvec3 higher = ndc(views.clip_from_world[0], point + dvec3(0, 1, 0));
        ASSERT_GT(higher.y, here.y - float_tolerance) << "seed 1, case " << i;
        ASSERT_NEAR(higher.x, here.x, float_tolerance) << "seed 1, case " << i;
    }
}

TEST(ShadowMaps, Eq9_2_TheBoxFillsNdc) {
    const dmat4 m = crop({2, -1, 10}, {6, 1, 30});
    const auto cropped = [&](dvec3 p) { return dvec3(m * dvec4(p, 1)); };
    const char* const of_box = "the box from (2, -1, 10) to (6, 1, 30)";
    EXPECT_EQ(cropped({2, -1, 10}), dvec3(-1, -1, 0)) << of_box;
    EXPECT_EQ(cropped({6, 1, 30}), dvec3(1)) << of_box;
    EXPECT_EQ(cropped({5, 0, 20}), dvec3(0.5, 0, 0.5)) << of_box;  // the worked example
    // Clip space: what is cropped is the quotient, and w stays.
    const dvec4 clip = m * dvec4(3.0 * dvec3(5, 0, 20), 3);
    EXPECT_EQ(clip, dvec4(1.5, 0, 1.5, 3)) << of_box << ": the same point with w = 3";
}

TEST(ShadowMaps, Eq9_3_TheMapHoldsWhatCastsOnWhatReceives) {
    const LightBox casters{{0, 0, -5}, {4, 3, -1}}, receivers{{2, -9, -8}, {10, 2, -2}};
    const LightBox region = shadow_region(casters, receivers);
    const char* const what =
        "the worked example: casters from (0, 0, -5) to (4, 3, -1), receivers from (2, -9, -8) to "
        "(10, 2, -2); z is larger towards the light, and the region begins at the nearest caster";
    ASSERT_EQ(region.low, dvec3(2, 0, -5)) << what;
    ASSERT_EQ(region.high, dvec3(4, 2, -1)) << what;

    // All of the casters is in the map, from the nearest, where receivers are all around.
    constexpr int size = 256;
    constexpr double end = 1 - 2.0 * margin_texels / size;
    Anywhere anywhere(2);
    const Bounds some = box({-1, 0, -2}, {2, 3, 1}), all_around = box(vec3(-50), vec3(50));
    for (int i = 0; i < 100; ++i) {
        const LightViews views =
            light_views(directional_light(anywhere.direction()), some, all_around, size);
        dvec3 low(infinity), high(-infinity);
        for (int corner = 0; corner < 8; ++corner) {
            const dvec3 in_ndc =
                ndc(views.clip_from_world[0],
                    {corner & 1 ? 2 : -1, corner & 2 ? 3 : 0, corner & 4 ? 1 : -2});
            low = glm::min(low, in_ndc), high = glm::max(high, in_ndc);
        }
        // Inside, and no more than the half percent beside it that rounding is allowed.
        for (int axis = 0; axis < 3; ++axis) {
            const double most = axis == 2 ? 1 : end, least = axis == 2 ? 0 : -end;
            const std::string where = std::string("the casters' ") + "xyz"[axis] +
                                      " in NDC is from " + std::to_string(low[axis]) + " to " +
                                      std::to_string(high[axis]) + ", expected just inside of " +
                                      std::to_string(least) + " to " + std::to_string(most) +
                                      (axis == 2 ? "" : " (a margin of 4 texels of 256)") +
                                      "; seed 2, case " + std::to_string(i);
            ASSERT_TRUE(low[axis] >= least && low[axis] < least + 0.01) << where;
            ASSERT_TRUE(high[axis] <= most && high[axis] > most - 0.01) << where;
        }
    }
}

TEST(ShadowMaps, HardCase_WithoutACasterOrAReceiverBehindItThereIsNoMap) {
    look_up("Eq. 9.3");
    const Bounds none, some = box(vec3(-1), vec3(1)), above = box({-1, 5, -1}, {1, 6, 1}),
                       beside = box({5, -1, 5}, {6, 1, 6}),
                       endless = box(vec3(-infinity), vec3(infinity)),
                       no_numbers = box(vec3(not_a_number), vec3(not_a_number));
    const Light lights[] = {directional_light({0, 1, 0}), spotlight({0, 3, 0}, {0, 0, 0}, 30),
                            point_light({0, 3, 0})};
    for (const Light& light : lights) {
        const auto maps = [&](const Bounds& casters, const Bounds& receivers) {
            return light_views(light, casters, receivers, 256).count;
        };
        EXPECT_GT(maps(some, some), 0u);
        for (const Bounds& unusable : {none, endless, no_numbers}) {
            EXPECT_EQ(maps(unusable, some), 0u);
            EXPECT_EQ(maps(some, unusable), 0u);
        }
        EXPECT_EQ(maps(none, none), 0u);
    }
    EXPECT_GT(light_views(lights[0], above, some, 256).count, 0u);
    EXPECT_EQ(light_views(lights[0], some, above, 256).count, 0u) << "the caster is below";
    EXPECT_EQ(light_views(lights[0], some, beside, 256).count, 0u);
    EXPECT_EQ(light_views(lights[1], some, beside, 256).count, 0u) << "beside its cone";
    EXPECT_EQ(light_views(lights[1], above, some, 256).count, 0u) << "behind the spotlight";
    EXPECT_EQ(light_views(lights[1], some, above, 256).count, 0u) << "behind the spotlight";
    EXPECT_EQ(light_views(lights[2], box(vec3(50), vec3(51)), some, 256).count, 0u)
        << "all casters are farther from the point light than what receives";
}

TEST(ShadowMaps, HardCase_AFlatCasterEdgeOnHasAMap) {
    look_up("Eq. 9.3");
    // What casters and receivers have in common is a line, which the widened box takes in.
    const Bounds sheet = box({0, 1, -1}, {0, 2, 1}), floor = box({-3, 0, -3}, {3, 0, 3});
    for (const Light& light : {directional_light({0, 1, 0}), spotlight({0, 5, 0}, {0, 0, 0}, 40)}) {
        const LightViews views = light_views(light, sheet, floor, 64);
        ASSERT_EQ(views.count, 1u);
        const dvec3 in_ndc = ndc(views.clip_from_world[0], {0, 1.5, 0.5});
        EXPECT_TRUE(std::abs(in_ndc.x) < 1 && std::abs(in_ndc.y) < 1 && in_ndc.z > 0 &&
                    in_ndc.z < 1)
            << testing::PrintToString(vec3(in_ndc));
    }
}

TEST(ShadowMaps, HardCase_ASceneOfOnePointHasAMap) {
    look_up("Eq. 9.3");
    const Bounds point = box(vec3(2, 1, -3), vec3(2, 1, -3));
    const LightViews views = light_views(directional_light({0, 1, 0}), point, point, 64);
    ASSERT_EQ(views.count, 1u);
    const dvec3 in_ndc = ndc(views.clip_from_world[0], dvec3(point.min));
    // Not a number where the map's box has no size.
    EXPECT_LT(glm::distance(in_ndc, dvec3(0, 0, 0.5)), float_tolerance)
        << "the point is the box's centre";
}

TEST(ShadowMaps, Eq9_4_ASpotlightsMapReachesToTheBorderOfItsCone) {
    const Bounds all_around = box(vec3(-20), vec3(20));
    constexpr double end = 1 - 2.0 * margin_texels / 256;
    Anywhere anywhere(3);
    for (const float half_angle : {5.0f, 30.0f, 60.0f, 74.0f})
        for (int i = 0; i < 50; ++i) {
            const vec3 position = anywhere.in(box(vec3(-5), vec3(5)));
            const Light light = spotlight(position, position + anywhere.direction(), half_angle);
            const LightViews views = light_views(light, all_around, all_around, 256);
            ASSERT_EQ(views.count, 1u);
            ASSERT_TRUE(views.is_perspective);
            // A circle around the axis, a bit inside of the cone, and a bit outside.
            const dvec3 axis = light.direction_world;
            const dvec3 across = glm::normalize(glm::cross(axis, dvec3(anywhere.direction())));
            const auto from_middle = [&](double degrees) {
                const double way_out = std::tan(glm::radians(degrees));
                const dvec3 in_ndc = ndc(views.clip_from_world[0],
                                         dvec3(position) + 3.0 * (axis + way_out * across));
                return std::hypot(in_ndc.x, in_ndc.y);
            };
            ASSERT_LT(from_middle(half_angle - 0.1), end)
                << "in NDC, of a point a little inside of a cone of " << half_angle
                << " degrees from its axis (seed 3, case " << i << ")";
            ASSERT_GT(from_middle(half_angle + 0.3), end)
                << "in NDC, of a point a little outside of a cone of " << half_angle
                << " degrees from its axis (seed 3, case " << i << ")";
        }
}

TEST(ShadowMaps, Eq9_4_TheNearPlaneLiesALittleBeforeTheNearestCaster) {
    const double near = near_plane(2, 10);
    EXPECT_TRUE(near < 2 && near > 1.98) << near << " for a caster at 2";
    EXPECT_NEAR(near_plane(0, 10), 0.01, 1e-6) << "a thousandth of 10: the light is in a caster";
}

TEST(ShadowMaps, Eq9_4_ASpotlightsDepthsAreNearOverDistance) {
    const Bounds around = box({-1, -2, -1}, {1, 1, 1});
    const LightViews views = light_views(spotlight({0, 5, 0}, {0, 0, 0}, 40), around, around, 64);
    ASSERT_EQ(views.count, 1u);
    const double near = near_plane(4, 7);
    const auto depth_at = [&](double distance) {
        return ndc(views.clip_from_world[0], {0, 5 - distance, 0}).z;
    };
    EXPECT_NEAR(depth_at(near), 1, float_tolerance) << "the near plane, as fitted";
    EXPECT_NEAR(depth_at(4 * near), 0.25, float_tolerance) << "four times as far away";
}

TEST(ShadowMaps, Eq9_4_ASpotlightsMapIsCutDownToCastersAndReceivers) {
    // Straight down from 10 high; the caster is a plate from 4 to 5, the floor is at 0.
    const Light light = spotlight({0, 10, 0}, {0, 0, 0}, 45);
    const LightViews views =
        light_views(light, box({-1, 4, -1}, {1, 5, 1}), box({-9, 0, -9}, {9, 0, 9}), 256);
    ASSERT_EQ(views.count, 1u);
    const mat4& clip = views.clip_from_world[0];
    const dvec3 corner = glm::abs(ndc(clip, {1, 5, 1}));  // the plate's top fills the map
    constexpr double end = 1 - 2.0 * margin_texels / 256;
    const char* const what =
        "a spotlight 10 above a floor, a plate of 2 x 2 from 4 to 5: the corner of its top in NDC, "
        "without signs, and the map's end less a margin of 4 texels of 256";
    EXPECT_NEAR(corner.x, end, 0.005) << what;
    EXPECT_NEAR(corner.y, end, 0.005) << what;
    const double nearest = ndc(clip, {0, 5, 0}).z, farthest = ndc(clip, {0, 4, 0}).z;
    EXPECT_TRUE(nearest <= 1 && nearest > 0.99)
        << nearest << ": z in NDC of the plate's top, expected just below 1";
    EXPECT_NEAR(farthest, nearest * 5 / 6, float_tolerance)
        << "z in NDC of the plate's underside, 6 below the light; its top is 5 below";
}

TEST(ShadowMaps, Eq9_4_ASpotlightsMapIsNoWiderThanItsCone) {
    // Plate and floor lie in front of the light, and reach far beyond its cone on all sides.
    const Light light = spotlight({0, 10, 0}, {0, 0, 0}, 45);
    const LightViews views =
        light_views(light, box({-40, 4, -40}, {40, 5, 40}), box({-40, 0, -40}, {40, 0, 40}), 256);
    ASSERT_EQ(views.count, 1u);
    constexpr double end = 1 - 2.0 * margin_texels / 256;
    for (const dvec3 border :
         {dvec3(10, 0, 0), dvec3(-10, 0, 0), dvec3(0, 0, 10), dvec3(0, 0, -10)}) {
        const dvec3 in_ndc = glm::abs(ndc(views.clip_from_world[0], border));
        ASSERT_NEAR(std::max(in_ndc.x, in_ndc.y), end, 0.005)
            << "a spotlight at (0, 10, 0) shines down, its light ends 45 degrees from the axis: at "
            << testing::PrintToString(vec3(border)) << " in the world, which is at "
            << testing::PrintToString(vec3(in_ndc)) << " in NDC, without signs";
    }
}

TEST(ShadowMaps, HardCase_AWideSpotlightGetsSixMaps) {
    look_up("Eq. 9.4");
    const Bounds around = box(vec3(-9), vec3(9));
    for (const float half_angle : {76.0f, 90.0f, 120.0f, 179.0f}) {
        const LightViews views =
            light_views(spotlight({0, 3, 0}, {0, 0, 0}, half_angle), around, around, 64);
        EXPECT_EQ(views.count, 6u) << half_angle;
    }
}

TEST(ShadowMaps, Eq9_5_EachDirectionLiesWellInsideOfItsFace) {
    constexpr int size = 64;
    const vec3 position(1, 2, -3);
    const Bounds around = box(vec3(-9), vec3(9));
    const LightViews views = light_views(point_light(position), around, around, size);
    ASSERT_EQ(views.count, 6u);
    EXPECT_EQ(cube_face({0.5f, -0.8f, 0.3f}), 3u) << "0 to 5 are +x, -x, +y, -y, +z, -z";  // down
    EXPECT_EQ(cube_face({2, 1, -1}), 0u);
    EXPECT_EQ(cube_face({-0.0f, 0, -0.0f}), 0u);
    EXPECT_EQ(cube_face({-1, 1, -1}), 1u);
    EXPECT_EQ(cube_face({0.5f, -1, -1}), 3u);
    EXPECT_EQ(cube_face({-2, 1, -1}), 1u);
    EXPECT_EQ(cube_face({1, 2, -1}), 2u);
    EXPECT_EQ(cube_face({1, 1, 3}), 4u);
    EXPECT_EQ(cube_face({1, 1, -3}), 5u);
    Anywhere anywhere(4);
    // Beyond a face's border there are as many texels as the largest PCF kernel takes.
    constexpr double most = 1 - 2.0 * margin_texels / size + float_tolerance;
    double greatest = 0;
    for (int i = 0; i < 20000; ++i) {
        const vec3 direction = anywhere.direction() * anywhere.one(0.5f, 6);
        const dvec3 in_ndc =
            ndc(views.clip_from_world[cube_face(direction)], dvec3(position) + dvec3(direction));
        const std::string where =
            "NDC of a point that lies " + testing::PrintToString(direction) +
            " from the light, in its face " + std::to_string(cube_face(direction)) + ", is " +
            testing::PrintToString(vec3(in_ndc)) + " (seed 4, case " + std::to_string(i) + ")";
        ASSERT_LE(std::abs(in_ndc.x), most) << where;
        ASSERT_LE(std::abs(in_ndc.y), most) << where;
        ASSERT_TRUE(in_ndc.z >= 0 && in_ndc.z <= 1) << where;
        greatest = std::max({greatest, std::abs(in_ndc.x), std::abs(in_ndc.y)});
    }
    EXPECT_GT(greatest, most - 0.01);  // and no wider than that
}

TEST(ShadowMaps, Eq9_5_WhichFacesASpotlightsConeReaches) {
    Anywhere anywhere(11);
    std::array<int, 2> faces{};  // not reached, reached
    for (int i = 0; i < 60; ++i) {
        Light light = spotlight({0, 0, 0}, anywhere.direction(), anywhere.one(50, 90));
        const auto in_cone = [&](vec3 direction) {
            return glm::dot(glm::normalize(direction), light.direction_world) > light.cos_outer;
        };
        std::array<bool, 6> is_reached{};  // by any of many directions through the faces
        constexpr int n = 200;
        for (int x = 0; x <= n; ++x)
            for (int y = 0; y <= n; ++y) {
                const float u = 2.0f * static_cast<float>(x) / n - 1,
                            v = 2.0f * static_cast<float>(y) / n - 1;
                const std::array through = {vec3(1, u, v),  vec3(-1, u, v), vec3(u, 1, v),
                                            vec3(u, -1, v), vec3(u, v, 1),  vec3(u, v, -1)};
                for (std::size_t f = 0; f < 6; ++f) is_reached[f] |= in_cone(through[f]);
            }
        for (std::size_t f = 0; f < 6; ++f) {
            const double nearest = cosine_to_face(light.direction_world, f);
            if (std::abs(nearest - light.cos_outer) < 1e-4) continue;  // between two directions
            ASSERT_EQ(reaches_face(light, f), is_reached[f])
                << "the face " << f << " of a spotlight that shines to "
                << testing::PrintToString(light.direction_world) << ", cosine " << light.cos_outer
                << " at its cone's border (seed 11, case " << i << ")";
            ++faces.at(is_reached[f]);
        }
    }
    EXPECT_GT(std::min(faces[0], faces[1]), 60);
    EXPECT_TRUE(reaches_face(point_light({0, 0, 0}), 1)) << "a point light shines everywhere";
}

TEST(ShadowMaps, Eq9_5_APointLightsMapsReachToTheFarthestCorner) {
    const Bounds around = box(vec3(-1, -2, -3), vec3(3, 2, 1));
    for (const vec3 position : {vec3(-10, 0, 0), vec3(10, 0, 0), vec3(0, -10, 0), vec3(0, 10, 0),
                                vec3(0, 0, -10), vec3(0, 0, 10), vec3(0)}) {
        const LightViews views = light_views(point_light(position), around, around, 64);
        ASSERT_EQ(views.count, 6u);
        for (int i = 0; i < 8; ++i) {
            const vec3 corner(i & 1 ? 3 : -1, i & 2 ? 2 : -2, i & 4 ? 1 : -3);
            const dvec3 in_ndc =
                ndc(views.clip_from_world[cube_face(corner - position)], dvec3(corner));
            EXPECT_TRUE(in_ndc.z > 0 && in_ndc.z <= 1)
                << "depth of the box's corner " << testing::PrintToString(corner)
                << " as a point light at " << testing::PrintToString(position) << " sees it";
        }
    }
}

TEST(ShadowMaps, HardCase_ASmallMapSeesTheNearestCasterInItsCorners) {
    look_up("Eq. 9.5");
    // In the smallest map, half of the texels are margin. A plate across the line to a corner has
    // to be in the map, however short the line's part along the axis is.
    for (const float corner : {1.99f, 1.0f, 0.5f}) {
        const vec3 direction = glm::normalize(vec3(corner, corner, -1));
        const vec3 u = 0.02f * glm::normalize(glm::cross(direction, vec3(0, 1, 0)));
        const vec3 v = glm::cross(direction, u);
        const Bounds around = box(vec3(-9), vec3(9));
        const Bounds plate = {
            glm::min(glm::min(direction - u - v, direction + u - v), direction - u + v),
            glm::max(glm::max(direction + u + v, direction + u - v), direction - u + v)};
        const LightViews views = light_views(point_light({0, 0, 0}), plate, around, 16);
        ASSERT_EQ(views.count, 6u);
        const double depth = ndc(views.clip_from_world[5], direction).z;
        EXPECT_TRUE(depth >= 0 && depth <= 1) << corner << ": " << depth;
        if (corner > 1.9f) {
            EXPECT_GT(depth, 0.925) << "nor is it any farther from the border than need be";
        }
    }
}

TEST(ShadowMaps, HardCase_LightParallelToUp) {
    look_up("Eq. 9.1");
    const Bounds casters = box({-1, 0, -2}, {2, 3, 1}), around = box(vec3(-9), vec3(9));
    std::vector<Light> lights;
    for (const float tilt : {0.0f, 1e-30f, 1e-8f, 1e-6f, 1e-4f})
        for (const float side : {1.0f, -1.0f}) {
            lights.push_back(directional_light({tilt, side, 0}));
            lights.push_back(directional_light({0, side, -tilt}));
            lights.push_back(spotlight({0.5f, 5 * side, 0}, {0.5f, 5 * side - side, tilt}, 60));
        }
    for (const Light& light : lights) {
        const LightViews views = light_views(light, casters, around, 256);
        ASSERT_EQ(views.count, 1u);
        const mat4& clip = views.clip_from_world[0];
        // The map sees the casters from inside of it, with an area.
        const dvec3 o = ndc(clip, {0, 1, 0}), x = ndc(clip, {1, 1, 0}), z = ndc(clip, {0, 1, -1});
        for (const dvec3 in_ndc : {o, x, z})
            EXPECT_TRUE(std::abs(in_ndc.x) <= 1 && std::abs(in_ndc.y) <= 1 && in_ndc.z >= 0 &&
                        in_ndc.z <= 1)
                << testing::PrintToString(vec3(in_ndc));
        const double area = (x.x - o.x) * (z.y - o.y) - (x.y - o.y) * (z.x - o.x);
        EXPECT_GT(std::abs(area), 0.1);
    }
}

TEST(ShadowMaps, Eq9_6_PositionsAndDepthsInTheMap) {
    const ShadowMap map = small_map();
    const vec4 in_map = map.texels_from_world * vec4(0.25f, -0.5f, 0.5f, 1);
    EXPECT_EQ(in_map, vec4(2.5f, 3, 0.5f, 1))  // the worked example
        << "texels_from_world of (0.25, -0.5, 0.5), in a map of 4 x 4 texels whose clip space is "
           "the world: column, row (down), depth, w";
    EXPECT_EQ(map.depths.depths().size(), ivec2(4 + 2 * max_pcf_radius));
    for (const float depth : map.depths.depths().pixels()) ASSERT_EQ(depth, 0) << "before drawing";
}

TEST(ShadowMaps, Eq9_6_TheNearestCasterIsDrawn) {
    // Plates at depths 0.25 and 0.75, both on the left half of the map, the nearer one first.
    const auto plate = [](float z) {
        return mesh_of({{-1, -1, z}, {0, -1, z}, {0, 1, z}, {-1, 1, z}}, {{0, 1, 2}, {0, 2, 3}});
    };
    ShadowMap map = small_map();
    for (const float depth : {0.75f, 0.25f})
        draw_casters(map, plate(depth), [](std::size_t) { return true; });
    for (int y = -max_pcf_radius; y < 4 + max_pcf_radius; ++y)
        for (int x = -max_pcf_radius; x < 4 + max_pcf_radius; ++x) {
            const bool is_covered = x >= 0 && x < 2 && y >= 0 && y < 4;
            ASSERT_EQ((map.depths.depths()[ivec2(x, y) + max_pcf_radius]),
                      is_covered ? 0.75f : 0.0f)
                << "texel (" << x << ", " << y << ") of a map of 4 x 4 texels, which begins "
                << max_pcf_radius << " texels from its memory's corner; casters at depths 0.25 and "
                << "0.75 cover the columns 0 and 1";
        }
    ShadowMap empty = small_map();
    draw_casters(empty, plate(0.25f), [](std::size_t) { return false; });
    for (const float depth : empty.depths.depths().pixels())
        ASSERT_EQ(depth, 0) << "of a material that casts no shadow, nothing is drawn";
}

TEST(ShadowMaps, Eq9_7_LitIsWhatIsNotBehindTheMap) {
    ShadowMap map = small_map();
    put(map, {1, 2}, 0.5f);
    ShadowBias none;
    // A point 0 or some of a texel's side from the centre of a texel.
    const auto has_light = [&](float column, float row, float depth, int expected) {
        const float found = pcf_visibility<0>(map, none, at_texel(column, row, depth));
        return (found == static_cast<float>(expected) ? testing::AssertionSuccess()
                                                      : testing::AssertionFailure())
               << "the map has depth 0.5 in column 1, row 2 and 0 elsewhere; of a point in column "
               << column << ", row " << row << ", at depth " << depth << " with bias " << none.bias
               << " the visibility is " << found << ", expected " << expected;
    };
    EXPECT_TRUE(has_light(1, 2, 0.75f, 1));
    EXPECT_TRUE(has_light(1, 2, 0.25f, 0));
    EXPECT_TRUE(has_light(1, 2, 0.5f, 1)) << "equal depths: it is lit";
    EXPECT_TRUE(has_light(1, 2, 0.4999f, 0));
    EXPECT_TRUE(has_light(1, 2, -7.0f, 0)) << "far behind";
    EXPECT_TRUE(has_light(1, 2, 7.0f, 1)) << "far in front";
    none.bias = 0.01f;
    EXPECT_TRUE(has_light(1, 2, 0.495f, 1));
    EXPECT_TRUE(has_light(1, 2, 0.485f, 0));
    put(map, {1, 2}, 0.005f);
    const float behind_the_map = pcf_visibility<0>(map, none, at_texel(1, 2, -7));
    EXPECT_EQ(behind_the_map, 0) << "at depth -7, behind a caster at 0.005, with bias 0.01: the "
                                    "maximum with 0 comes after the bias";
    put(map, {1, 2}, 0.5f);
    none.bias = 0;
    // All of the texel, and none of its neighbours.
    for (const float side : {-0.49f, 0.49f}) {
        ASSERT_TRUE(has_light(1 + side, 2 - side, 0.25f, 0));
        ASSERT_TRUE(has_light(1 + 1.1f * side, 2, 0.25f, 1));
        ASSERT_TRUE(has_light(1, 2 + 1.1f * side, 0.25f, 1));
    }
    for (const float depth : {0.25f, 0.0f, -0.5f, -1e30f})
        ASSERT_TRUE(has_light(2, 2, depth, 1)) << "nothing is in front";
}

TEST(ShadowMaps, Eq9_7_InPerspectiveThePositionIsDividedByW) {
    const mat4 clip(perspective(glm::radians(90.0), 1.0, 1.0));
    ShadowMap map(clip, true, 4, box({-9, -9, -9}, {9, 9, -1}));
    put(map, {2, 1}, 1);
    EXPECT_EQ(pcf_visibility<0>(map, {}, {0.5f, 0.5f, -2}), 0)
        << "a spotlight at 0 looks along -z, 45 degrees to each side; its map of 4 x 4 texels has "
           "depth 1 in column 2, row 1, and 0 elsewhere. The point (0.5, 0.5, -2) has w = 2, and "
           "lies at (0.25, 0.25) in NDC: in column 2, row 1";
    EXPECT_EQ(pcf_visibility<0>(map, {}, {-0.5f, 0.5f, -2}), 1)
        << "the same map: the point (-0.5, 0.5, -2) lies in column 1, row 1";
}

TEST(ShadowMaps, Eq9_7_UnderALargeRoofAllOfASmallFloorIsDark) {
    for (const vec3 toward : {vec3(0, 1, 0), vec3(0.3f, 1, -0.5f)})
        for (const int size : {16, 64, 256})
            ASSERT_TRUE(is_dark_under_a_large_roof<0>(directional_light(toward), size));
}

TEST(ShadowMaps, Eq9_4_UnderALargeRoofAllOfASmallFloorIsDarkInAnyLight) {
    const Light lights[] = {directional_light({0, 1, 0}), directional_light({0.3f, 1, -0.5f}),
                            spotlight({0.2f, 4, 0.1f}, {0, 0, 0}, 60),
                            spotlight({0.2f, 4, 0.1f}, {0, 0, 0}, 10)};  // less than the floor
    for (const Light& light : lights)
        for (const int size : {16, 64, 256}) {
            ASSERT_TRUE(is_dark_under_a_large_roof<0>(light, size)) << "1 texel a test";
            ASSERT_TRUE(is_dark_under_a_large_roof<3>(light, size)) << "7 x 7 texels a test";
        }
}

TEST(ShadowMaps, HardCase_OutsideOfTheMapAllIsLit) {
    look_up("Eq. 9.7");
    ShadowMap map = small_map();
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) put(map, {x, y}, 1);
    EXPECT_EQ(pcf_visibility<3>(map, {}, at_texel(1, 1, 0.5f)), 33 / 49.0f);
    EXPECT_EQ(pcf_visibility<0>(map, {}, at_texel(0, 3, 0.5f)), 0);
    for (const float beyond : {-0.6f, -3.0f, -1e9f, -1e38f, 3.6f, 4.0f, 1e9f, 1e38f, infinity,
                               -infinity, not_a_number}) {
        EXPECT_EQ(pcf_visibility<3>(map, {}, at_texel(beyond, 1, 0.5f)), 1) << beyond;
        EXPECT_EQ(pcf_visibility<3>(map, {}, at_texel(1, beyond, 0.5f)), 1) << beyond;
    }
    EXPECT_EQ(pcf_visibility<3>(map, {}, vec3(not_a_number)), 1);
}

TEST(ShadowMaps, HardCase_BehindASpotlightAllIsLit) {
    look_up("Eq. 9.7");
    const Light light = spotlight({0, 0, 0}, {0, 0, -1}, 40);
    const Bounds around = box(vec3(-5), vec3(5));
    const LightViews views = light_views(light, around, around, 16);
    ASSERT_EQ(views.count, 1u);
    ShadowMap map(views.clip_from_world[0], true, 16, around);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) put(map, {x, y}, 1);
    EXPECT_EQ(pcf_visibility<0>(map, {}, {0, 0, -2}), 0);
    EXPECT_EQ(pcf_visibility<0>(map, {}, {0, 0, 2}), 1);
    EXPECT_EQ(pcf_visibility<0>(map, {}, {0, 0, 0}), 1) << "in the light itself";
    EXPECT_EQ(pcf_visibility<0>(map, {}, {1, 1, 0}), 1) << "beside it";
}

TEST(ShadowMaps, Eq9_9_TheConstantBiasIsThatOfASlopeOf2InTheMiddle) {
    const vec3 middle(1, 0, -2);
    const Bounds around = box(middle - 1.0f, middle + 1.0f);
    for (const Light& light :
         {directional_light({0, 1, 0}), spotlight(middle + vec3(0, 5, 0), middle, 20)}) {
        const LightViews views = light_views(light, around, around, 64);
        ASSERT_EQ(views.count, 1u);
        const ShadowMap map(views.clip_from_world[0], views.is_perspective, 64, around);
        // From a point a little on one side of the middle to one on the other.
        const dvec3 step(1e-3, -2e-3, 0);
        const dvec3 way = ndc(map.texels_from_world, dvec3(middle) + step) -
                          ndc(map.texels_from_world, dvec3(middle) - step);
        const double slope = std::abs(way.z) / (std::abs(way.x) + std::abs(way.y));
        for (const int radius : {0, 2})
            EXPECT_NEAR(shadow_bias(map, Bias::constant, radius, {}, {0, 1, 0}).bias,
                        (radius + 0.5) * slope, 1e-3 * slope)
                << "half a texel and " << radius << " of a surface that goes down by 2 a unit; "
                << name_of(light.kind);
    }
}

TEST(ShadowMaps, Eq9_13_AShareOfTexelsIsLit) {
    ShadowMap map = small_map();
    for (const ivec2 texel : {ivec2(0, 0), ivec2(1, 1), ivec2(2, 1), ivec2(3, 3)})
        put(map, texel, 0.5f);
    const vec3 point = at_texel(1.3f, 0.8f, 0.25f);
    const char* const where =
        "a point at depth 0.25 in texel (1, 1); the texels (0, 0), (1, 1), (2, 1) and (3, 3) have "
        "0.5, all others 0";
    EXPECT_EQ(pcf_visibility<0>(map, {}, point), 0) << where;
    EXPECT_EQ(pcf_visibility<1>(map, {}, point), 6 / 9.0f) << where;  // the worked example
    EXPECT_EQ(pcf_visibility<2>(map, {}, point), 21 / 25.0f) << where;
    EXPECT_EQ(pcf_visibility<3>(map, {}, point), 45 / 49.0f) << where;
    EXPECT_EQ(pcf_visibility<1>(map, {}, at_texel(0, 3, 0.25f)), 1) << "at the map's corner";
    // Comparisons, not depths, are averaged: the point in front is lit, however near the others.
    EXPECT_EQ(pcf_visibility<1>(map, {}, at_texel(1, 1, 0.6f)), 1);
}
