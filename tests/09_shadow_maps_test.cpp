// SPDX-License-Identifier: MIT
// How lights see the scene, what a shadow test finds, and what keeps a lit surface from shadowing
// itself.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "09_shadow_maps/light_view.hpp"
#include "09_shadow_maps/shadow_map.hpp"
#include "support/cases.hpp"
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

/// The matrix of the one map that a light has.
mat4 one_view(const Light& light, const Bounds& casters, const Bounds& receivers, int size) {
    const LightViews views = light_views(light, casters, receivers, size);
    EXPECT_EQ(views.count, 1u) << "maps of a " << name_of(light.kind);
    EXPECT_EQ(views.is_perspective, light.kind != LightKind::directional);
    return views.clip_from_world[0];
}

bool is_in_map(dvec3 in_ndc) {
    return std::abs(in_ndc.x) <= 1 && std::abs(in_ndc.y) <= 1 && in_ndc.z >= 0 && in_ndc.z <= 1;
}

/// In NDC, where a map of 256 texels ends but for its margin.
constexpr double end_of_256 = 1 - 2.0 * margin_texels / 256;

/// Of matrices in float; places in the tests' boxes are up to 10.
constexpr double float_tolerance = 1e-5;

float any_in(std::mt19937& random, float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
}

vec3 any_in(std::mt19937& random, const Bounds& b) {
    const float x = any_in(random, b.min.x, b.max.x), y = any_in(random, b.min.y, b.max.y);
    return {x, y, any_in(random, b.min.z, b.max.z)};
}

/// Each coordinate from -1 to 1.
vec3 any_vector(std::mt19937& random) { return any_in(random, box(vec3(-1), vec3(1))); }

vec3 any_direction(std::mt19937& random) { return unit_or(any_vector(random), vec3(0, 1, 0)); }

/// A map of 4 x 4 texels whose clip space is the world: x = 2 (x_world + 1), y = 2 (1 - y_world),
/// depth = z_world.
ShadowMap small_map() { return {mat4(1), false, 4, box({-1, -1, 0}, vec3(1))}; }

/// A map of 4 x 4 texels of a spotlight at 0, which looks along -z, 45 degrees to each side.
ShadowMap map_of_spotlight() {
    return {mat4(perspective(glm::radians(90.0), 1.0, 1.0)), true, 4, box(vec3(-9), {9, 9, -1})};
}

/// Where the texel's centre is, at a depth.
vec3 at_texel(float column, float row, float depth) {
    return {(column + 0.5f) / 2 - 1, 1 - (row + 0.5f) / 2, depth};
}

void put(ShadowMap& map, ivec2 texel, float depth) {
    map.depths.depths()[texel + max_pcf_radius] = depth;
}

/// The map ends where the floor does; the roof goes on, and every shadow test there has to find it.
template <int radius>
void expect_dark_under_a_large_roof(const Light& light, int size) {
    const Mesh roof =
        mesh_of({{-30, 1, -30}, {-30, 1, 30}, {30, 1, 30}, {30, 1, -30}}, {{0, 1, 2}, {0, 2, 3}});
    const mat4 clip = one_view(light, roof.bounds, box({-1, 0, -1}, {1, 0, 1}), size);
    ShadowMap map(clip, light.kind != LightKind::directional, size, roof.bounds);
    draw_casters(map, roof, [](std::size_t) { return true; });
    for (int y = -20; y <= 20; ++y)
        for (int x = -20; x <= 20; ++x) {
            const vec3 point = vec3(x, 0, y) / 20.0f;
            const vec3 from_light = glm::normalize(point - light.position_world);
            if (light.kind == LightKind::spot &&
                glm::dot(from_light, light.direction_world) <= light.cos_outer)
                continue;  // beyond its cone
            ASSERT_EQ(pcf_visibility<radius>(map, {}, point), 0)
                << "how much of a " << name_of(light.kind) << " arrives at "
                << testing::PrintToString(point) << " on a floor of 2 x 2 at y = 0, below a roof "
                << "of 60 x 60 at y = 1, by a map of " << size << " texels, " << 2 * radius + 1
                << " a side of a test";
        }
}

constexpr std::array tilts = {0.0f, 0.1f, 1.0f, 3.0f, 10.0f, 50.0f};

using lmat4 = glm::mat<4, 4, real>;

/// A square of 2 x 2 around a point, cut into triangles of different sizes, and a light on it.
struct TiltedPlane {
    Mesh mesh;
    Light light;

    /// @param tilt  Tangent of the angle between the plane's normal and the light.
    TiltedPlane(std::mt19937& random, LightKind kind, float tilt, vec3 middle) {
        const vec3 normal = any_direction(random);
        const vec3 along = unit_or(glm::cross(normal, any_direction(random)), vec3(1, 0, 0));
        const vec3 across = glm::cross(normal, along);
        std::vector<vec3> positions;
        std::vector<std::array<std::uint32_t, 3>> triangles;
        constexpr std::uint32_t side = 5;
        for (std::uint32_t y = 0; y <= side; ++y)
            for (std::uint32_t x = 0; x <= side; ++x) {
                const vec2 at = 2.0f * vec2(x * x, y) / vec2(side * side, side) - 1.0f;
                positions.push_back(middle + at.x * along + at.y * across);
                const std::uint32_t a = y * (side + 1) + x, b = a + side + 1;
                if (x == side || y == side) continue;
                triangles.push_back({a, a + 1, b + 1});
                triangles.push_back({a, b + 1, b});
            }
        mesh = mesh_of(positions, triangles);
        const vec3 toward = glm::normalize(normal + tilt * along);
        light = {kind, vec3(1), toward};
        if (kind == LightKind::directional) return;
        light.position_world = middle + 2.5f * toward;
        light.direction_world = -toward;
        light.cos_outer = std::cos(0.9f), light.cos_inner = 1;
    }
};

/// Points of a mesh with the triangles on which they lie, as fragments have them.
struct PointOn {
    Vertices vertices;
    vec3 point;
};

std::vector<PointOn> points_on(const Mesh& mesh, std::mt19937& random, int of_each) {
    std::vector<PointOn> points;
    for (const Triangle& triangle : mesh.triangles)
        for (int i = 0; i < of_each; ++i) {
            const Vertices vertices = vertices_in(mesh, triangle);
            float b = any_in(random, 0, 1), c = any_in(random, 0, 1);
            if (b + c > 1) b = 1 - b, c = 1 - c;
            points.push_back(
                {vertices, (1 - b - c) * vertices[0] + b * vertices[1] + c * vertices[2]});
        }
    return points;
}

/// Of a plane z_ndc = 1/2 + (a x_ndc + b y_ndc) / 4 in a map whose clip space is the world.
Vertices plane_in_cube(float a, float b) {
    const auto vertex = [&](float x, float y) {
        return vec3(x, y, 0.5f + 0.25f * (a * x + b * y));
    };
    return {vertex(-1, -1), vertex(1, -1), vertex(0, 1)};
}

ShadowMap map_of_cube(int size) { return {mat4(1), false, size, {vec3(-1), vec3(1)}}; }

constexpr vec3 to_the_light(0, 0, 1);  ///< As map_of_cube() is seen.

/// Roundings, snapping: what a bias has above the ideal formula, in the tests' maps.
constexpr double beyond_ideal = 0.02;

}  // namespace

TEST(ShadowMaps, Eq9_1_PointsOnOneRayOfADirectionalLightShareATexel) {
    std::mt19937 random(1);
    const Bounds casters = box({-1, 0, -2}, {2, 3, 1}), receivers = box({-6, -1, -6}, {6, 0.5f, 6});
    for (int i = 0; i < 100; ++i) {
        vec3 toward = any_direction(random);
        toward.y = std::abs(toward.y) + 0.1f;
        if (i == 0) toward = {1, 0, 0};  // it shines along -x: z of NDC grows with x
        const Light light = directional_light(toward);
        const mat4 clip = one_view(light, casters, receivers, 256);
        const dvec3 point = any_in(random, casters);
        const auto beside = [&](dvec3 step) { return ndc(clip, point + step); };
        const dvec3 here = beside(dvec3(0)), nearer = beside(light.direction_world),
                    higher = beside({0, 1, 0});
        const std::string where = "NDC of " + testing::PrintToString(vec3(point)) +
                                  " and of what lies 1 nearer to a light from " +
                                  testing::PrintToString(light.direction_world) +
                                  ", or 1 higher (seed 1, case " + std::to_string(i) + ")";
        ASSERT_NEAR(nearer.x, here.x, float_tolerance) << where;
        ASSERT_NEAR(nearer.y, here.y, float_tolerance) << where;
        ASSERT_GT(nearer.z, here.z) << where;
        // Right-handed, up is up: as a camera would see it.
        ASSERT_GT(higher.y, here.y - float_tolerance) << where;
        ASSERT_NEAR(higher.x, here.x, float_tolerance) << where;
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
    std::mt19937 random(2);
    const Bounds some = box({-1, 0, -2}, {2, 3, 1}), all_around = box(vec3(-50), vec3(50));
    for (int i = 0; i < 50; ++i) {
        const mat4 clip = one_view(directional_light(any_direction(random)), some, all_around, 256);
        const auto& [low, high] = box_in(dmat4(clip), some);
        // Inside, and no more than the half percent beside it that rounding is allowed.
        for (int axis = 0; axis < 3; ++axis) {
            const double most = axis == 2 ? 1 : end_of_256, least = axis == 2 ? 0 : -end_of_256;
            ASSERT_TRUE(low[axis] >= least && low[axis] < least + 0.01 && high[axis] <= most &&
                        high[axis] > most - 0.01)
                << "the casters' " << "xyz"[axis] << " in NDC is from " << low[axis] << " to "
                << high[axis] << ", expected just inside of " << least << " to " << most
                << (axis == 2 ? "" : " (a margin of 4 texels of 256)") << "; seed 2, case " << i;
        }
    }
}

TEST(ShadowMaps, HardCase_WithoutACasterOrAReceiverBehindItThereIsNoMap) {
    look_up("Eq. 9.3");
    const Bounds none, some = box(vec3(-1), vec3(1)), above = box({-1, 5, -1}, {1, 6, 1}),
                       beside = box({5, -1, 5}, {6, 1, 6}), far = box(vec3(50), vec3(51)),
                       endless = box(vec3(-infinity), vec3(infinity)),
                       no_numbers = box(vec3(not_a_number), vec3(not_a_number));
    const Light day = directional_light({0, 1, 0}), spot = spotlight({0, 3, 0}, {0, 0, 0}, 30),
                bulb = point_light({0, 3, 0});
    const auto maps = [](const Light& light, const Bounds& casters, const Bounds& receivers) {
        return light_views(light, casters, receivers, 256).count;
    };
    for (const Light& light : {day, spot, bulb}) {
        EXPECT_GT(maps(light, some, some), 0u);
        for (const Bounds& unusable : {none, endless, no_numbers}) {
            EXPECT_EQ(maps(light, unusable, some), 0u);
            EXPECT_EQ(maps(light, some, unusable), 0u);
        }
    }
    EXPECT_GT(maps(day, above, some), 0u);
    EXPECT_EQ(maps(day, some, above), 0u) << "the caster is below";
    EXPECT_EQ(maps(day, some, beside), 0u);
    EXPECT_EQ(maps(spot, some, beside), 0u) << "beside its cone";
    EXPECT_EQ(maps(spot, above, some), 0u) << "behind the spotlight";
    EXPECT_EQ(maps(spot, some, above), 0u) << "behind the spotlight";
    EXPECT_EQ(maps(bulb, far, some), 0u) << "casters are farther away than what receives";
}

TEST(ShadowMaps, HardCase_AFlatCasterEdgeOnAndASceneOfOnePointHaveAMap) {
    look_up("Eq. 9.3");
    // What casters and receivers have in common is a line, which the widened box takes in.
    const Bounds sheet = box({0, 1, -1}, {0, 2, 1}), floor = box({-3, 0, -3}, {3, 0, 3});
    for (const Light& light : {directional_light({0, 1, 0}), spotlight({0, 5, 0}, {0, 0, 0}, 40)}) {
        const dvec3 in_ndc = ndc(one_view(light, sheet, floor, 64), {0, 1.5, 0.5});
        EXPECT_TRUE(is_in_map(in_ndc)) << testing::PrintToString(vec3(in_ndc));
    }
    const Bounds point = box(vec3(2, 1, -3), vec3(2, 1, -3));
    const mat4 clip = one_view(directional_light({0, 1, 0}), point, point, 64);
    // Not a number where the map's box has no size.
    EXPECT_LT(glm::distance(ndc(clip, dvec3(point.min)), dvec3(0, 0, 0.5)), float_tolerance)
        << "the point is the box's centre";
}

TEST(ShadowMaps, Eq9_4_ASpotlightsMapIsCutDownToCastersAndReceivers) {
    // Straight down from 10 high; the caster is a plate from 4 to 5, the floor is at 0.
    const Light light = spotlight({0, 10, 0}, {0, 0, 0}, 45);
    const mat4 clip =
        one_view(light, box({-1, 4, -1}, {1, 5, 1}), box({-9, 0, -9}, {9, 0, 9}), 256);
    const dvec3 corner = glm::abs(ndc(clip, {1, 5, 1}));  // the plate's top fills the map
    const char* const what =
        "a spotlight 10 above a floor, a plate of 2 x 2 from 4 to 5: the corner of its top in NDC, "
        "without signs, and the map's end less a margin of 4 texels of 256";
    EXPECT_NEAR(corner.x, end_of_256, 0.005) << what;
    EXPECT_NEAR(corner.y, end_of_256, 0.005) << what;
    const double nearest = ndc(clip, {0, 5, 0}).z, farthest = ndc(clip, {0, 4, 0}).z;
    EXPECT_TRUE(nearest <= 1 && nearest > 0.99)
        << nearest << ": z in NDC of the plate's top, expected just below 1";
    EXPECT_NEAR(farthest, nearest * 5 / 6, float_tolerance)
        << "z in NDC of the plate's underside, 6 below the light; its top is 5 below";
    EXPECT_NEAR(near_plane(0, 10), 0.01, 1e-6) << "a thousandth of 10: the light is in a caster";

    // Where casters reach far beyond the cone, or behind the light, the map is as wide as the cone.
    for (const Bounds& casters :
         {box({-40, 4, -40}, {40, 5, 40}), box({-20, -40, -20}, {20, 90, 20})})
        for (const dvec3 border : {dvec3(10, 0, 0), {-10, 0, 0}, {0, 0, 10}, {0, 0, -10}}) {
            const mat4 wide = one_view(light, casters, box({-40, 0, -40}, {40, 0, 40}), 256);
            const dvec3 in_ndc = glm::abs(ndc(wide, border));
            ASSERT_NEAR(std::max(in_ndc.x, in_ndc.y), end_of_256, 0.005)
                << "NDC, without signs, of " << testing::PrintToString(vec3(border))
                << ": there ends the cone, 45 degrees around straight down from (0, 10, 0)";
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
    EXPECT_EQ(cube_face({0.5f, -0.8f, 0.3f}), 3u) << "0 to 5 are +x, -x, +y, -y, +z, -z";  // down
    EXPECT_EQ(cube_face({-0.0f, 0, -0.0f}), 0u);
    EXPECT_EQ(cube_face({-1, 1, -1}), 1u);
    EXPECT_EQ(cube_face({0.5f, -1, -1}), 3u);
    EXPECT_EQ(cube_face({1, 2, -1}), 2u);
    EXPECT_EQ(cube_face({1, 1, 3}), 4u);
    EXPECT_EQ(cube_face({1, 1, -3}), 5u);
    constexpr int size = 64;
    const vec3 position(1, 2, -3);
    const Bounds around = box(vec3(-9), vec3(9));
    const LightViews views = light_views(point_light(position), around, around, size);
    ASSERT_EQ(views.count, 6u);
    std::mt19937 random(4);
    // Beyond a face's border there are as many texels as the largest PCF kernel takes.
    constexpr double most = 1 - 2.0 * margin_texels / size + float_tolerance;
    double greatest = 0;
    for (int i = 0; i < 20000; ++i) {
        const vec3 direction = any_direction(random) * any_in(random, 0.5f, 6);
        const dvec3 in_ndc =
            ndc(views.clip_from_world[cube_face(direction)], dvec3(position) + dvec3(direction));
        const double aside = std::max(std::abs(in_ndc.x), std::abs(in_ndc.y));
        ASSERT_TRUE(is_in_map(in_ndc) && aside <= most)
            << testing::PrintToString(vec3(in_ndc)) << ": NDC of a point that lies "
            << testing::PrintToString(direction) << " from the light, in its face "
            << cube_face(direction) << "; x and y are at most " << most << " there (seed 4, case "
            << i << ")";
        greatest = std::max(greatest, aside);
    }
    EXPECT_GT(greatest, most - 0.01);  // and no wider than that
}

TEST(ShadowMaps, Eq9_5_WhichFacesASpotlightsConeReaches) {
    std::mt19937 random(11);
    std::array<int, 2> faces{};  // not reached, reached
    for (int i = 0; i < 60; ++i) {
        const Light light = spotlight({0, 0, 0}, any_direction(random), any_in(random, 50, 90));
        for (std::size_t f = 0; f < 6; ++f) {
            bool is_reached = false;  // by any of many directions through the face
            for (int k = 0; k < 201 * 201; ++k) {
                const auto axis = static_cast<int>(f / 2);
                vec3 through;
                through[axis] = f % 2 == 0 ? 1 : -1;
                through[(axis + 1) % 3] = static_cast<float>(k % 201 - 100) / 100;
                through[(axis + 2) % 3] = static_cast<float>(k / 201 - 100) / 100;
                is_reached |=
                    glm::dot(glm::normalize(through), light.direction_world) > light.cos_outer;
            }
            const double nearest = cosine_to_face(light.direction_world, f);
            if (std::abs(nearest - light.cos_outer) < 1e-4) continue;  // between two directions
            ASSERT_EQ(reaches_face(light, f), is_reached)
                << "the face " << f << " of a spotlight that shines to "
                << testing::PrintToString(light.direction_world) << ", cosine " << light.cos_outer
                << " at its cone's border (seed 11, case " << i << ")";
            ++faces.at(is_reached);
        }
    }
    EXPECT_GT(std::min(faces[0], faces[1]), 60);
    EXPECT_TRUE(reaches_face(point_light({0, 0, 0}), 1)) << "a point light shines everywhere";
}

TEST(ShadowMaps, HardCase_ASmallMapSeesTheNearestCasterInItsCorners) {
    look_up("Eq. 9.5");
    // In the smallest map, half of the texels are margin. A plate across the line to a corner has
    // to be in the map, however short the line's part along the axis is.
    for (const float corner : {1.99f, 1.0f, 0.5f}) {
        const vec3 direction = glm::normalize(vec3(corner, corner, -1));
        const vec3 u = 0.02f * glm::normalize(glm::cross(direction, vec3(0, 1, 0)));
        const vec3 v = glm::cross(direction, u);
        Bounds plate;
        for (const vec3 side : {u + v, u - v, v - u, -u - v}) plate.add(direction + side);
        const LightViews views =
            light_views(point_light({0, 0, 0}), plate, box(vec3(-9), vec3(9)), 16);
        ASSERT_EQ(views.count, 6u);
        const double depth = ndc(views.clip_from_world[5], direction).z;
        EXPECT_TRUE(depth >= (corner > 1.9f ? 0.925 : 0) && depth <= 1)
            << depth << ": in the map; in its corner, no farther from its border than need be; "
            << corner;
    }
}

TEST(ShadowMaps, HardCase_LightParallelToUp) {
    look_up("Eq. 9.1");
    const Bounds casters = box({-1, 0, -2}, {2, 3, 1}), around = box(vec3(-9), vec3(9));
    for (const float tilt : {0.0f, 1e-30f, 1e-8f, 1e-6f, 1e-4f})
        for (const float side : {1.0f, -1.0f})
            for (const Light& light :
                 {directional_light({tilt, side, 0}), directional_light({0, side, -tilt}),
                  spotlight({0.5f, 5 * side, 0}, {0.5f, 4 * side, tilt}, 60)}) {
                // The map sees the casters from inside of it, with an area.
                const mat4 clip = one_view(light, casters, around, 256);
                const dvec3 o = ndc(clip, {0, 1, 0}), x = ndc(clip, {1, 1, 0}) - o,
                            z = ndc(clip, {0, 1, -1}) - o;
                for (const dvec3 in_ndc : {o, o + x, o + z})
                    EXPECT_TRUE(is_in_map(in_ndc)) << testing::PrintToString(vec3(in_ndc));
                EXPECT_GT(std::abs(x.x * z.y - x.y * z.x), 0.1);
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
    // Plates at depths 0.25 and 0.75, both on the left half of the map, the nearer one first, and
    // one at 0.9 of a material that casts no shadow.
    ShadowMap map = small_map();
    for (const float z : {0.75f, 0.25f, 0.9f})
        draw_casters(
            map, mesh_of({{-1, -1, z}, {0, -1, z}, {0, 1, z}, {-1, 1, z}}, {{0, 1, 2}, {0, 2, 3}}),
            [&](std::size_t) { return z != 0.9f; });
    for (int y = -max_pcf_radius; y < 4 + max_pcf_radius; ++y)
        for (int x = -max_pcf_radius; x < 4 + max_pcf_radius; ++x) {
            const bool is_covered = x >= 0 && x < 2 && y >= 0 && y < 4;
            ASSERT_EQ((map.depths.depths()[ivec2(x, y) + max_pcf_radius]),
                      is_covered ? 0.75f : 0.0f)
                << "texel (" << x << ", " << y << ") of a map of 4 x 4 texels, which begins "
                << max_pcf_radius << " texels from its memory's corner; casters at depths 0.25 and "
                << "0.75 cover the columns 0 and 1; one at 0.9 casts no shadow";
        }
}

TEST(ShadowMaps, Eq9_7_LitIsWhatIsNotBehindTheMap) {
    ShadowMap map = small_map();
    put(map, {1, 2}, 0.5f);
    ShadowBias none;
    // A point 0 or some of a texel's side from the centre of a texel.
    const auto expect_visibility = [&](float column, float row, float depth, float expected) {
        EXPECT_EQ(pcf_visibility<0>(map, none, at_texel(column, row, depth)), expected)
            << "the map has depth 0.5 in column 1, row 2 and 0 elsewhere; of a point in column "
            << column << ", row " << row << ", at depth " << depth << " with bias " << none.bias;
    };
    expect_visibility(1, 2, 0.5f, 1);  // equal depths: it is lit
    expect_visibility(1, 2, 0.4999f, 0);
    expect_visibility(1, 2, -7.0f, 0);
    expect_visibility(1, 2, 7.0f, 1);
    // All of the texel, and none of its neighbours.
    for (const float side : {-0.49f, 0.49f}) {
        expect_visibility(1 + side, 2 - side, 0.25f, 0);
        expect_visibility(1 + 1.1f * side, 2, 0.25f, 1);
        expect_visibility(1, 2 + 1.1f * side, 0.25f, 1);
    }
    for (const float depth : {0.0f, -1e30f}) expect_visibility(2, 2, depth, 1);  // nothing is there
    none.bias = 0.01f;
    expect_visibility(1, 2, 0.495f, 1);
    expect_visibility(1, 2, 0.485f, 0);
    put(map, {1, 2}, 0.005f);
    EXPECT_EQ(pcf_visibility<0>(map, none, at_texel(1, 2, -7)), 0)
        << "at depth -7, behind a caster at 0.005, with bias 0.01: the maximum with 0 comes after "
           "the bias";
}

TEST(ShadowMaps, Eq9_7_InPerspectiveThePositionIsDividedByW) {
    ShadowMap map = map_of_spotlight();
    put(map, {2, 1}, 1);
    const char* const what =
        "a spotlight at 0 looks along -z, 45 degrees to each side; its map of 4 x 4 texels has "
        "depth 1 in column 2, row 1, and 0 elsewhere. The points have w = 2: ";
    EXPECT_EQ(pcf_visibility<0>(map, {}, {0.5f, 0.5f, -2}), 0)
        << what << "(0.5, 0.5, -2) lies at (0.25, 0.25) in NDC, in column 2, row 1";
    EXPECT_EQ(pcf_visibility<0>(map, {}, {-0.5f, 0.5f, -2}), 1)
        << what << "(-0.5, 0.5, -2) lies in column 1, row 1";
}

TEST(ShadowMaps, Eq9_7_UnderALargeRoofAllOfASmallFloorIsDark) {
    for (const vec3 toward : {vec3(0, 1, 0), vec3(0.3f, 1, -0.5f)})
        for (const int size : {16, 256})
            if (!HasFatalFailure())
                expect_dark_under_a_large_roof<0>(directional_light(toward), size);
}

TEST(ShadowMaps, Eq9_4_UnderALargeRoofAllOfASmallFloorIsDarkInAnyLight) {
    for (const Light& light :
         {directional_light({0.3f, 1, -0.5f}), spotlight({0.2f, 4, 0.1f}, {0, 0, 0}, 60),
          spotlight({0.2f, 4, 0.1f}, {0, 0, 0}, 10)})  // less than the floor
        for (const int size : {16, 64, 256})
            if (!HasFatalFailure()) expect_dark_under_a_large_roof<3>(light, size);
}

TEST(ShadowMaps, HardCase_OutsideOfTheMapAndBehindASpotlightAllIsLit) {
    look_up("Eq. 9.7");
    const auto seen_everywhere = [](ShadowMap map) {
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) put(map, {x, y}, 1);
        return map;
    };
    const ShadowMap map = seen_everywhere(small_map());
    EXPECT_EQ(pcf_visibility<3>(map, {}, at_texel(1, 1, 0.5f)), 33 / 49.0f);
    EXPECT_EQ(pcf_visibility<0>(map, {}, at_texel(0, 3, 0.5f)), 0);
    for (const float beyond : {-0.6f, -1e38f, 3.6f, 4.0f, 1e38f, infinity, not_a_number}) {
        EXPECT_EQ(pcf_visibility<3>(map, {}, at_texel(beyond, 1, 0.5f)), 1) << beyond;
        EXPECT_EQ(pcf_visibility<3>(map, {}, at_texel(1, beyond, 0.5f)), 1) << beyond;
    }
    const ShadowMap of_spotlight = seen_everywhere(map_of_spotlight());
    EXPECT_EQ(pcf_visibility<0>(of_spotlight, {}, {0, 0, -2}), 0);
    EXPECT_EQ(pcf_visibility<0>(of_spotlight, {}, {0, 0, 2}), 1);
    EXPECT_EQ(pcf_visibility<0>(of_spotlight, {}, {0, 0, 0}), 1) << "in the light itself";
    EXPECT_EQ(pcf_visibility<0>(of_spotlight, {}, {1, 1, 0}), 1) << "beside it";
}

TEST(ShadowMaps, Eq9_9_TheConstantBiasIsThatOfASlopeOf2InTheMiddle) {
    const vec3 middle(1, 0, -2);
    const Bounds around = box(middle - 1.0f, middle + 1.0f);
    for (const Light& light :
         {directional_light({0, 1, 0}), spotlight(middle + vec3(0, 5, 0), middle, 20)}) {
        const ShadowMap map(one_view(light, around, around, 64),
                            light.kind != LightKind::directional, 64, around);
        // From a point a little on one side of the middle to one on the other.
        const dvec3 step(1e-3, -2e-3, 0);
        const dvec3 way = ndc(map.texels_from_world, dvec3(middle) + step) -
                          ndc(map.texels_from_world, dvec3(middle) - step);
        const double slope = std::abs(way.z) / (std::abs(way.x) + std::abs(way.y));
        EXPECT_NEAR(shadow_bias(map, Bias::constant, 2, {}, {0, 1, 0}).bias, 2.5 * slope,
                    1e-3 * slope)
            << "two and a half texels of a surface that goes down by 2 a unit; "
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

TEST(ShadowMaps, Eq9_8_SlopesOfAKnownPlane) {
    // 512 texels over 2: the depth rises by 1/4 of x and falls by 1/2 of y; rows run down.
    const vec2 slope =
        shadow_bias(map_of_cube(512), Bias::plane, 0, plane_in_cube(1, -2), to_the_light).slope;
    const char* const where =
        "depth from a texel to the next one, of z = 1/2 + x / 4 - y / 2 in NDC, in a map of 512";
    EXPECT_NEAR(slope.x, 0.5 / 512, 1e-9) << where << ": to the right";
    EXPECT_NEAR(slope.y, 1.0 / 512, 1e-9) << where << ": down";
}

TEST(ShadowMaps, Eq9_8_APlaneHasTheSideThatIsSeenInWhateverOrderItsVerticesCome) {
    const auto [a, b, c] = plane_in_cube(1, -2);
    for (const Bias bias : {Bias::constant, Bias::slope, Bias::normal, Bias::plane}) {
        const ShadowBias one = shadow_bias(map_of_cube(512), bias, 1, {a, b, c}, to_the_light),
                         other = shadow_bias(map_of_cube(512), bias, 1, {a, c, b}, to_the_light);
        SCOPED_TRACE(name_of(bias));
        EXPECT_EQ(one.bias, other.bias);
        EXPECT_EQ(one.slope, other.slope);
        EXPECT_EQ(one.offset, other.offset);
        EXPECT_EQ(one.offset_times_w, other.offset_times_w);
    }
}

TEST(ShadowMaps, Eq9_9_TheBiasIsHalfATexelTimesTheSlopes) {
    // The worked example: 512 texels over 2, and the depth rises by 1/4 of x.
    const ShadowMap map = map_of_cube(512);
    for (const auto& [a, b] : {std::pair{1.0f, 0.0f}, {1.0f, 2.0f}, {-1.0f, 0.5f}}) {
        const double of_a_texel = (std::abs(a) + std::abs(b)) / 2 / 512;
        for (const int radius : {0, 1, 2, 3}) {
            const ShadowBias at =
                shadow_bias(map, Bias::slope, radius, plane_in_cube(a, b), to_the_light);
            const double in_texels = (at.bias + at.bias_per_w) / of_a_texel;
            ASSERT_TRUE(in_texels >= radius + 0.5 && in_texels <= radius + 0.5 + beyond_ideal)
                << "the bias is " << in_texels << " times |dz/dx| + |dz/dy| of a plane with "
                << std::abs(a) / 2 / 512 << " + " << std::abs(b) / 2 / 512
                << " a texel, expected 1/2 and " << radius << ", the radius of PCF; up to "
                << beyond_ideal << " more is for rounding";
            ASSERT_EQ(at.slope, vec2(0)) << "of " << name_of(Bias::slope);
            ASSERT_EQ(at.offset, vec3(0)) << "of " << name_of(Bias::slope);
        }
    }
    const ShadowBias flat = shadow_bias(map, Bias::slope, 3, plane_in_cube(0, 0), to_the_light);
    EXPECT_LE(flat.bias + flat.bias_per_w, 3e-5f);  // roundings are left
    EXPECT_GT(flat.bias + flat.bias_per_w, 0);
}

TEST(ShadowMaps, Eq9_10_HardCase_LitPlanesAtSlopesFrom0To50HaveNoShadow) {
    std::mt19937 random(2);
    int close = 0;
    for (const int size : {16, 20, 24, 32, 256, 512, 1024, 4096})
        for (const LightKind kind : light_kinds)
            for (const float tilt : tilts) {
                const vec3 middle = size == 512 ? 20.0f * any_vector(random) : vec3(0);
                TiltedPlane plane(random, kind, tilt, middle);
                Bounds around = plane.mesh.bounds;
                if (size < 256) {  // things around widen the map to all of a wide view
                    Light& light = plane.light;
                    light.cos_outer = std::cos(glm::radians(74.0f));
                    if (kind == LightKind::spot)  // the plane is seen from the side
                        light.direction_world =
                            unit_or(light.direction_world + 4.0f * any_direction(random), vec3(1));
                    around = {vec3(-4), vec3(4)};
                }
                const LightMaps maps(plane.light, std::span(&plane.mesh, 1), size, around);
                for (const PointOn& p : points_on(plane.mesh, random, 8)) {
                    for (const Bias bias : fitted_biases)
                        for (const int radius : {0, 1, 2, 3})
                            ASSERT_EQ(maps.visibility(bias, radius, p.vertices, p.point), 1)
                                << "a lit plane shadows itself: map of " << size << " texels, "
                                << name_of(kind) << ", tilted by arctan " << tilt << ", "
                                << name_of(bias) << ", PCF with radius " << radius << ", at "
                                << testing::PrintToString(p.point) << " (seed 2)";
                    const ShadowMap& map = maps.map_for(p.point);
                    const ShadowBias at =
                        shadow_bias(map, Bias::normal, 3, p.vertices, maps.toward(p.point));
                    const mat4& m = map.texels_from_world;
                    const float w_gained =  // K g / (1 - K g) of Eq. 9.12
                        glm::dot(at.offset_times_w, vec3(m[0].w, m[1].w, m[2].w));
                    close += w_gained > 4;
                }
            }
    EXPECT_GT(close, 0) << "points with a long offset along the normal: K g of 0.8 to 1";
}

TEST(ShadowMaps, Eq9_10_LessThanTheDerivedBiasIsTooLittle) {
    // In the worst case, a plane needs nearly all of the derived bias: none of it is wasted.
    for (const LightKind kind : {LightKind::directional, LightKind::spot})
        for (const int radius : {0, 1, 3}) {
            std::mt19937 random(3);
            const TiltedPlane plane(random, kind, 3, vec3(0));
            const LightMaps maps(plane.light, std::span(&plane.mesh, 1), 128);
            int dark_with_less = 0;
            for (const PointOn& p : points_on(plane.mesh, random, 400)) {
                const ShadowMap& map = maps.map_for(p.point);
                ShadowBias at =
                    shadow_bias(map, Bias::slope, radius, p.vertices, maps.toward(p.point));
                at.bias *= 0.9f, at.bias_per_w = 0;
                dark_with_less += pcf_visibility(map, radius, pcf_kernel(map, at, p.point)) < 1;
            }
            EXPECT_GT(dark_with_less, 20)
                << "of 20000 points, with 9/10 of the bias: it is more than Eq. 9.10 has; "
                << name_of(kind) << ", a map of 128 texels, a plane tilted by arctan 3, PCF with "
                << "radius " << radius;
        }
}

TEST(ShadowMaps, Eq9_11_ThePlaneIsComparedAtEachTexelsCentre) {
    constexpr int size = 512;
    ShadowMap map = map_of_cube(size);
    const auto biased = [&](Bias bias, int radius) {
        return shadow_bias(map, bias, radius, plane_in_cube(1, -2), to_the_light);
    };
    const ShadowBias at = biased(Bias::plane, 3);
    // Snapping and roundings are left, whatever the radius.
    EXPECT_LT(at.bias + at.bias_per_w, (1.0 / 512 + beyond_ideal) * 1.5 / size);
    EXPECT_EQ(biased(Bias::plane, 0).bias, at.bias);

    // A plate this little in front of a tilted plane shadows it; half a texel's slope would not.
    constexpr float gap = 0.1f * 1.5f / size;
    for (int y = 200; y < 300; ++y)
        for (int x = 200; x < 300; ++x) {
            const vec2 center = (vec2(x, y) + 0.5f) * (2.0f / size) - 1.0f;
            map.depths.test_and_write(ivec2(x, y) + max_pcf_radius,
                                      0.5f + 0.25f * (center.x + 2 * center.y) + gap);
        }
    for (const float side : {-0.45f, 0.0f, 0.45f}) {
        const vec2 in_map = vec2(250.5f + side, 250.5f - side) * (2.0f / size) - 1.0f;
        const vec3 point(in_map.x, -in_map.y, 0.5f + 0.25f * (in_map.x + 2 * in_map.y));
        const std::string where =
            "a plate a tenth of a texel's slope in front of a tilted plane, at " +
            testing::PrintToString(point);
        EXPECT_EQ(pcf_visibility<3>(map, at, point), 0) << where << ", shadows it";
        EXPECT_EQ(pcf_visibility<0>(map, biased(Bias::slope, 0), point), 1)
            << where << ", is lost in the bias of half a texel's";
    }
}

TEST(ShadowMaps, Eq9_12_TheOffsetAlongTheNormal) {
    // The map's texels are 2/512 wide: a point of a plane that is tilted by 3 : 4 along x moves by
    // (r + 1/2) 2/512 3/5, and nothing is added to its depth.
    constexpr int size = 512;
    const ShadowMap map = map_of_cube(size);
    const ShadowBias at = shadow_bias(map, Bias::normal, 1, plane_in_cube(3, 0), to_the_light);
    EXPECT_EQ(at.bias, 0);
    const dvec3 offset = dvec3(at.offset) + dvec3(at.offset_times_w);
    const std::string where = "the offset is " + testing::PrintToString(vec3(offset)) +
                              "; texels of 2/512, radius 1, a plane tilted by 3 : 4 along x";
    EXPECT_NEAR(glm::dot(glm::normalize(offset), dvec3(-0.6, 0, 0.8)), 1, 1e-6)
        << "its direction and the normal on the light's side, (-0.6, 0, 0.8); " << where;
    EXPECT_GE(glm::length(offset), 1.5 * 2 / size * 0.6) << where;
    EXPECT_LE(glm::length(offset), (1.5 + beyond_ideal) * 2 / size * 0.6) << where;
    // Even edge-on it is no longer than that of two sides of a texel.
    const Vertices edge_on = {vec3(0), vec3(1, 1, 0), vec3(0, 0, 1)};
    const ShadowBias steep = shadow_bias(map, Bias::normal, 1, edge_on, {1, -1, 1e-3f});
    EXPECT_LE(glm::length(steep.offset + steep.offset_times_w), 1.51 * std::sqrt(2) * 2 / size);
}

TEST(ShadowMaps, Eq9_12_ThePointMovedInAPerspectiveIsNearerByTheBias) {
    std::mt19937 random(5);
    for (int i = 0; i < 200; ++i) {
        const TiltedPlane plane(random, LightKind::spot, static_cast<float>(i % 4), vec3(0));
        const LightMaps maps(plane.light, std::span(&plane.mesh, 1), 64);
        ASSERT_EQ(maps.maps.size(), 1u);
        const PointOn p = points_on(plane.mesh, random, 1)[7];
        const auto biased = [&](Bias bias) {
            return shadow_bias(maps.maps[0], bias, 1, p.vertices, maps.toward(p.point));
        };
        const ShadowBias moved = biased(Bias::normal), sloped = biased(Bias::slope);
        if (sloped.bias > 1) continue;  // edge-on
        const dmat4 m(maps.maps[0].texels_from_world);
        const dvec4 here = m * dvec4(p.point, 1);
        const dvec3 offset = dvec3(moved.offset) + here.w * dvec3(moved.offset_times_w);
        const dvec4 there = m * dvec4(dvec3(p.point) + offset, 1);
        const dvec2 shift = dvec2(there) / there.w - dvec2(here) / here.w;
        const double of_plane = here.z / here.w + glm::dot(dvec2(biased(Bias::plane).slope), shift);
        const double bias = sloped.bias + sloped.bias_per_w / there.w;
        // 1e-3: points in float lie beside their plane; the term that stands in 1 - K g is more.
        ASSERT_NEAR((there.z / there.w - of_plane) / bias, 1, 1e-3)
            << "the moved point's depth in front of the plane, in biases of Eq. 9.10; the point "
            << testing::PrintToString(p.point) << " is moved by "
            << testing::PrintToString(vec3(offset)) << " (seed 5, case " << i << ")";
    }
}

TEST(ShadowMaps, HardCase_EdgeOnSlopesStayFinite) {
    look_up("Eq. 9.8");
    std::vector<Vertices> triangles = {
        {vec3(-1e30f), vec3(1e30f, 0, 0), vec3(0, 1, 1)},
        {vec3(0), vec3(1e-38f, 0, 0), vec3(0, 1e-38f, 0)},
        // From here on, the light sees them edge-on.
        {vec3(0), vec3(1, 0, 0), vec3(0, 0, 1)},     // 0/0 across y, infinite along it
        {vec3(0), vec3(0, 1, 0), vec3(0, 0, 1)},     // the same along x
        {vec3(0.25f), vec3(0.25f), vec3(0.25f)},     // no area
        {vec3(0), vec3(0, 0, 0.5f), vec3(0, 0, 1)},  // a line along the light
        {vec3(0), vec3(1, 0, 1e-30f), vec3(0, 0, 1)},
        {vec3(NAN), vec3(1, 0, 0), vec3(0, 1, 0)}};
    for (const float lean : {1e-3f, -1e-6f, 1e-9f, -1e-20f, 1e-38f, -1e-38f})
        triangles.push_back({vec3(0), vec3(1, 0, 0), vec3(0, lean, 1)});
    for (std::size_t i = 0; i < triangles.size(); ++i)
        for (const Bias bias : all_biases)
            for (const vec3 outward : {to_the_light, vec3(0, 1, 1), vec3(0)}) {
                const ShadowBias at = shadow_bias(map_of_cube(64), bias, 3, triangles[i], outward);
                const std::string where = std::string(name_of(bias)) + " of the triangle " +
                                          testing::PrintToString(triangles[i]);
                for (const vec3 numbers :
                     {vec3(at.slope, at.bias), vec3(at.bias_per_w), at.offset, at.offset_times_w})
                    ASSERT_TRUE(glm::all(glm::lessThanEqual(glm::abs(numbers), vec3(3))))
                        << testing::PrintToString(numbers) << ", expected at most 3: " << where;
                if (i >= 2 && (bias == Bias::slope || bias == Bias::plane)) {
                    ASSERT_GE(at.bias, always_lit.bias)
                        << "a triangle that the light sees edge-on is lit: " << where;
                }
            }
}

TEST(ShadowMaps, HardCase_ATriangleTurnedAwayIsLeftToItsNormals) {
    look_up("Eq. 9.8");
    ShadowMap map = map_of_cube(8);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) map.depths.test_and_write(ivec2(x, y) + max_pcf_radius, 1.0f);
    for (const Bias bias : fitted_biases)
        for (const bool is_turned_away : {false, true}) {
            const vec3 outward = is_turned_away ? -to_the_light : to_the_light;
            const ShadowBias at = shadow_bias(map, bias, 1, plane_in_cube(1, 1), outward);
            ASSERT_EQ(pcf_visibility<1>(map, at, {0.1f, 0.1f, 0.5f}), is_turned_away ? 1 : 0)
                << name_of(bias) << ", turned " << (is_turned_away ? "away from" : "to")
                << " the light";
        }
}

TEST(ShadowMaps, Eq9_14_AThinWallLeaksAtItsFootNoMoreThanTheBias) {
    // A wall of height 1 across x = 0 on a floor at 0; the light comes from -x.
    const std::array meshes = {
        mesh_of({{-4, 0, -4}, {4, 0, -4}, {4, 0, 4}, {-4, 0, 4}}, {{0, 2, 1}, {0, 3, 2}}),
        mesh_of({{0, 0, -2}, {0, 0, 2}, {0, 1, 2}, {0, 1, -2}}, {{0, 1, 2}, {0, 2, 3}})};
    const Vertices floor = vertices_in(meshes[0], meshes[0].triangles[0]);
    for (const double elevation_degrees : {15.0, 45.0, 60.0})
        for (const int radius : {0, 1, 3}) {
            const double e = glm::radians(elevation_degrees);
            const LightMaps maps(sun(vec3(-std::cos(e), std::sin(e), 0)), meshes, 512);
            const dmat4 rows = glm::transpose(dmat4(maps.maps[0].texels_from_world));
            const double texel =
                1 / std::min(glm::length(dvec3(rows[0])), glm::length(dvec3(rows[1])));
            for (const Bias bias : fitted_biases) {
                const ShadowBias at = shadow_bias(maps.maps[0], bias, radius, floor, {0, 1, 0});
                // In world: what is taken off along the ray lifts the point by less; a shift along
                // the floor's normal lifts it by as much as it is.
                const double height =
                    (at.bias + at.bias_per_w) / glm::length(dvec3(rows[2])) * std::sin(e) +
                    glm::length(dvec3(at.offset + at.offset_times_w));
                const double blur = (radius + 1) * texel * std::sqrt(2) / std::sin(e);
                const double end_of_shadow = 1 / std::tan(e) - 2 * blur - height;
                double leak = 0;
                for (double x = 1e-4; x < end_of_shadow; x += texel / 7)
                    for (const float z : {-0.73f, 0.11f, 1.01f})
                        if (maps.visibility(bias, radius, floor, vec3(x, 0, z)) > 0) leak = x;
                ASSERT_LE(leak, height / std::tan(e) + blur)
                    << "the widest strip of light at the foot of a wall; a light "
                    << elevation_degrees << " degrees high, a map of 512 texels, PCF with radius "
                    << radius << ", " << name_of(bias);
            }
        }
}

TEST(ShadowMaps, Eq9_15_RoundingsStayBelowWhatIsAllowedForThem) {
    std::mt19937 random(4);
    real greatest = 0;
    for (int i = 0; i < cases_of(60); ++i) {
        const LightKind kind = light_kinds[static_cast<std::size_t>(i) % 3];
        const TiltedPlane plane(random, kind, 1, 50.0f * any_vector(random));
        const LightMaps maps(plane.light, std::span(&plane.mesh, 1), 512);
        for (const PointOn& p : points_on(plane.mesh, random, 2)) {
            const ShadowMap& map = maps.map_for(p.point);
            const vec4 computed = map.texels_from_world * vec4(p.point, 1);
            const lvec4 exact = lmat4(viewport<double>(ivec2(512))) * lmat4(map.clip_from_world) *
                                lvec4(lvec3(p.point), 1);
            const lvec3 off =
                exact.w * glm::abs(lvec3(vec3(computed) / computed.w) - lvec3(exact) / exact.w);
            greatest = std::max({greatest, std::max(off.x, off.y) / map.rounding_texels,
                                 off.z / map.rounding_depth});
        }
    }
    const char* const what = "the greatest rounding, in rounding_texels or rounding_depth";
    EXPECT_LE(greatest, 0.5) << what << "; the other half is for the map's side";
    EXPECT_GT(greatest, 0.005) << what << "; the bound is out of proportion";
}
