// SPDX-License-Identifier: MIT
// What keeps a lit surface from shadowing itself, and what that costs.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
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

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr std::array fitted = {Bias::slope, Bias::plane, Bias::normal};
constexpr std::array tilts = {0.0f, 0.1f, 1.0f, 3.0f, 10.0f, 50.0f};

/// A square of 2 x 2 around a point, cut into triangles of different sizes, and a light on it.
struct TiltedPlane {
    Mesh mesh;
    Light light;

    /// @param tilt  Tangent of the angle between the plane's normal and the light.
    TiltedPlane(std::mt19937& random, LightKind kind, float tilt, vec3 middle) {
        std::uniform_real_distribution<float> any(-1, 1);
        const auto direction = [&] {
            const float x = any(random), y = any(random), z = any(random);
            return unit_or(vec3(x, y, z), vec3(0, 1, 0));
        };
        const vec3 normal = direction();
        const vec3 along = unit_or(glm::cross(normal, direction()), vec3(1, 0, 0));
        const vec3 across = glm::cross(normal, along);
        std::vector<vec3> positions;
        constexpr std::uint32_t side = 5;
        for (std::uint32_t y = 0; y <= side; ++y)
            for (std::uint32_t x = 0; x <= side; ++x) {
                const vec2 at = 2.0f * vec2(x * x, y) / vec2(side * side, side) - 1.0f;
                positions.push_back(middle + at.x * along + at.y * across);
            }
        std::vector<std::array<std::uint32_t, 3>> triangles;
        for (std::uint32_t y = 0; y < side; ++y)
            for (std::uint32_t x = 0; x < side; ++x) {
                const std::uint32_t a = y * (side + 1) + x, b = a + side + 1;
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
    std::uniform_real_distribution<float> any(0, 1);
    std::vector<PointOn> points;
    for (const Triangle& triangle : mesh.triangles)
        for (int i = 0; i < of_each; ++i) {
            const Vertices vertices = vertices_in(mesh, triangle);
            float b = any(random), c = any(random);
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

TEST(ShadowMaps, Eq9_8_SlopesOfAKnownPlane) {
    // 512 texels over 2: the depth rises by 1/4 of x and falls by 1/2 of y; rows run down.
    const vec2 slope =
        shadow_bias(map_of_cube(512), Bias::plane, 0, plane_in_cube(1, -2), to_the_light).slope;
    const char* const where =
        "a plane with z = 1/2 + x / 4 - y / 2 in NDC, seen by a map of 512 texels: depth from a "
        "texel to the "
        "next one";
    EXPECT_NEAR(slope.x, 0.5 / 512, 1e-9) << where << " on its right";
    EXPECT_NEAR(slope.y, 1.0 / 512, 1e-9) << where << " below";
}

TEST(ShadowMaps, Eq9_4_SlopesOfAPlaneInAPerspective) {
    std::mt19937 random(1);
    for (int i = 0; i < 200; ++i) {
        const TiltedPlane plane(random, i % 2 == 0 ? LightKind::spot : LightKind::directional,
                                tilts[static_cast<std::size_t>(i) % 5], vec3(0));
        const LightMaps maps(plane.light, std::span(&plane.mesh, 1), 64);
        ASSERT_EQ(maps.maps.size(), 1u);
        const ShadowMap& map = maps.maps[0];
        const Vertices vertices = vertices_in(plane.mesh, plane.mesh.triangles[7]);
        const ShadowBias at = shadow_bias(map, Bias::plane, 0, vertices, maps.toward(vertices[0]));
        // In long double: the positions of the three vertices in the map, and the plane through
        // them.
        std::array<lvec3, 3> in_map;
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::mat<4, 4, real> m(map.texels_from_world);
            const lvec4 homogeneous = m * lvec4(lvec3(vertices[k]), 1);
            in_map[k] = lvec3(homogeneous) / homogeneous.w;
        }
        const lvec3 normal = glm::cross(in_map[1] - in_map[0], in_map[2] - in_map[0]);
        const real x = -normal.x / normal.z, y = -normal.y / normal.z;
        // 3e-6: steep planes are found from vertices in float.
        const auto where = [&](const char* axis) {
            return std::string("the slope along ") + axis + " of a plane in the map of a " +
                   name_of(plane.light.kind) + " (seed 1, case " + std::to_string(i) + ")";
        };
        ASSERT_TRUE(is_near(at.slope.x, x, 3e-6L * (std::abs(x) + std::abs(y)))) << where("x");
        ASSERT_TRUE(is_near(at.slope.y, y, 3e-6L * (std::abs(x) + std::abs(y)))) << where("y");
    }
}

TEST(ShadowMaps, Eq9_9_TheBiasIsHalfATexelTimesTheSlopes) {
    // The worked example: 512 texels over 2, and the depth rises by 1/4 of x.
    constexpr int size = 512;
    const ShadowMap map = map_of_cube(size);
    for (const auto& [a, b] : {std::pair{1.0f, 0.0f}, {1.0f, 2.0f}, {-1.0f, 0.5f}}) {
        const double of_a_texel = (std::abs(a) + std::abs(b)) / 2 / size;
        for (const int radius : {0, 1, 2, 3}) {
            const ShadowBias at =
                shadow_bias(map, Bias::slope, radius, plane_in_cube(a, b), to_the_light);
            const double bias = at.bias + at.bias_per_w;
            const std::string where =
                "the bias of a plane with |dz/dx| + |dz/dy| = " + std::to_string(of_a_texel) +
                " a texel (along x " + std::to_string(std::abs(a) / 2 / size) + ", along y " +
                std::to_string(std::abs(b) / 2 / size) + "), PCF with radius " +
                std::to_string(radius) + ", and " + std::to_string(radius) +
                " + 1/2 texels of it; a little more is for rounding";
            ASSERT_GE(bias, (radius + 0.5) * of_a_texel) << where;
            ASSERT_LE(bias, (radius + 0.5 + beyond_ideal) * of_a_texel) << where;
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
    std::uniform_real_distribution<float> any(-20, 20);
    long asked = 0;
    for (const int size : {256, 512, 1024, 2048, 4096})
        for (const LightKind kind : light_kinds)
            for (const float tilt : tilts) {
                const float x = any(random), y = any(random), z = any(random);
                const TiltedPlane plane(random, kind, tilt, size == 512 ? vec3(x, y, z) : vec3(0));
                const LightMaps maps(plane.light, std::span(&plane.mesh, 1), size);
                ASSERT_FALSE(maps.maps.empty());
                for (const PointOn& p : points_on(plane.mesh, random, 8))
                    for (const Bias bias : fitted)
                        for (const int radius : {0, 1, 2, 3}) {
                            ASSERT_EQ(maps.visibility(bias, radius, p.vertices, p.point), 1)
                                << "a lit plane shadows itself: map of " << size << " texels, "
                                << name_of(kind) << ", tilted by arctan " << tilt << ", "
                                << name_of(bias) << ", PCF with radius " << radius << ", at "
                                << testing::PrintToString(p.point) << " (seed 2)";
                            ++asked;
                        }
            }
    EXPECT_EQ(asked, 5L * 3 * 6 * 50 * 8 * 3 * 4);
}

namespace {

/// In the worst case, a plane needs nearly all of the derived bias: none of it is wasted.
void less_than_the_derived_bias_is_too_little(LightKind kind, int radius) {
    std::mt19937 random(3);
    const TiltedPlane plane(random, kind, 3, vec3(0));
    const LightMaps maps(plane.light, std::span(&plane.mesh, 1), 128);
    const std::string where = std::string(name_of(kind)) +
                              ", a map of 128 texels, a plane tilted " +
                              "by arctan 3, PCF with radius " + std::to_string(radius);
    int dark_with_less = 0, dark_without = 0;
    for (const PointOn& p : points_on(plane.mesh, random, 400)) {
        const ShadowMap& map = maps.map_for(p.point);
        ShadowBias at = shadow_bias(map, Bias::slope, radius, p.vertices, maps.toward(p.point));
        ASSERT_EQ(pcf_visibility(map, radius, pcf_kernel(map, at, p.point)), 1)
            << "at " << testing::PrintToString(p.point) << " with a bias of "
            << at.bias + at.bias_per_w << ": " << where;
        at.bias *= 0.9f, at.bias_per_w = 0;
        dark_with_less += pcf_visibility(map, radius, pcf_kernel(map, at, p.point)) < 1;
        at.bias = 0;
        dark_without += pcf_visibility(map, radius, pcf_kernel(map, at, p.point)) < 1;
    }
    EXPECT_GT(dark_with_less, 20)
        << "of 20000 points, with 9/10 of the bias: it is more than Eq. 9.10 has; " << where;
    EXPECT_GT(dark_without, 9000) << "of 20000 points, without bias; " << where;
}

}  // namespace

TEST(ShadowMaps, Eq9_10_LessThanTheDerivedBiasIsTooLittle) {
    for (const LightKind kind : {LightKind::directional, LightKind::spot})
        less_than_the_derived_bias_is_too_little(kind, 0);
}

TEST(ShadowMaps, Eq9_10_LessThanTheDerivedBiasIsTooLittleForPcf) {
    for (const LightKind kind : {LightKind::directional, LightKind::spot})
        for (const int radius : {1, 3}) less_than_the_derived_bias_is_too_little(kind, radius);
}

TEST(ShadowMaps, Eq9_11_ThePlaneIsComparedAtEachTexelsCentre) {
    constexpr int size = 512;
    const ShadowMap map = map_of_cube(size);
    const ShadowBias at = shadow_bias(map, Bias::plane, 3, plane_in_cube(1, -2), to_the_light);
    EXPECT_NEAR(at.slope.x, 0.5 / size, 1e-9)
        << "of z = 1/2 + x / 4 - y / 2 in NDC, a texel to the right";
    EXPECT_NEAR(at.slope.y, 1.0 / size, 1e-9) << "a texel down; down is -y";
    // Snapping and roundings are left, whatever the radius.
    EXPECT_LT(at.bias + at.bias_per_w, (1.0 / 512 + beyond_ideal) * 1.5 / size);
    EXPECT_EQ(shadow_bias(map, Bias::plane, 0, plane_in_cube(1, -2), to_the_light).bias, at.bias);

    // A plate this little in front of a tilted plane shadows it; half a texel's slope would not.
    ShadowMap with_plate = map_of_cube(size);
    const auto depth_of_plane = [&](ivec2 texel) {
        const vec2 center = (vec2(texel) + 0.5f) * (2.0f / size) - 1.0f;
        return 0.5f + 0.25f * (center.x + 2 * center.y);
    };
    constexpr float gap = 0.1f * 1.5f / size;
    for (int y = 200; y < 300; ++y)
        for (int x = 200; x < 300; ++x)
            with_plate.depths.test_and_write(ivec2(x, y) + max_pcf_radius,
                                             depth_of_plane({x, y}) + gap);
    for (const float side : {-0.45f, 0.0f, 0.45f}) {
        const vec2 in_map = vec2(250.5f + side, 250.5f - side) * (2.0f / size) - 1.0f;
        const vec3 point(in_map.x, -in_map.y, 0.5f + 0.25f * (in_map.x + 2 * in_map.y));
        EXPECT_EQ(pcf_visibility<3>(with_plate, at, point), 0)
            << "a plate a tenth of a texel's slope in front of a tilted plane shadows it: at "
            << testing::PrintToString(point);
        const ShadowBias sloped =
            shadow_bias(map, Bias::slope, 0, plane_in_cube(1, -2), to_the_light);
        EXPECT_EQ(pcf_visibility<0>(with_plate, sloped, point), 1)
            << "a plate a tenth of a texel's slope in front of a tilted plane is lost in the bias "
               "of half a texel's: at "
            << testing::PrintToString(point);
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
        const ShadowMap& map = maps.maps[0];
        const PointOn p = points_on(plane.mesh, random, 1)[7];
        const vec3 toward = maps.toward(p.point);
        const ShadowBias moved = shadow_bias(map, Bias::normal, 1, p.vertices, toward);
        const ShadowBias sloped = shadow_bias(map, Bias::slope, 1, p.vertices, toward);
        if (sloped.bias > 1) continue;  // edge-on
        const ShadowBias at = shadow_bias(map, Bias::plane, 1, p.vertices, toward);
        const dmat4 m(map.texels_from_world);
        const dvec4 here = m * dvec4(p.point, 1);
        const dvec3 offset = dvec3(moved.offset) + here.w * dvec3(moved.offset_times_w);
        const dvec4 there = m * dvec4(dvec3(p.point) + offset, 1);
        const dvec2 shift = dvec2(there) / there.w - dvec2(here) / here.w;
        const double of_plane = here.z / here.w + glm::dot(dvec2(at.slope), shift);
        const double bias = sloped.bias + sloped.bias_per_w / there.w;
        // 1e-3: points in float lie beside their plane; the term that stands in 1 - K g is more.
        ASSERT_NEAR((there.z / there.w - of_plane) / bias, 1, 1e-3)
            << "the moved point's depth in front of the plane, in biases of Eq. 9.10; the point "
            << testing::PrintToString(p.point) << " is moved by "
            << testing::PrintToString(vec3(offset)) << " (seed 5, case " << i << ")";
    }
}

TEST(ShadowMaps, Eq9_12_HardCase_LitPlanesHaveNoShadowInSmallMapsEither) {
    // In a small map of a wide view, an offset needs to grow along its own direction by as much as
    // its length or more: K g of 1 and above.
    std::mt19937 random(6);
    std::uniform_real_distribution<float> any(-1, 1);
    const auto any_vector = [&] {
        const float x = any(random), y = any(random), z = any(random);
        return vec3(x, y, z);
    };
    long asked = 0;
    int beyond = 0, close = 0;
    for (const int size : {16, 24, 32, 64})
        for (const LightKind kind : {LightKind::spot, LightKind::point})
            for (int i = 0; i < 250; ++i) {
                vec3 middle = 3.0f * any_vector();
                middle.z = -std::abs(middle.z) - 0.2f;  // in front of the spotlight
                vec3 normal = unit_or(any_vector(), vec3(0, 1, 0));
                if (glm::dot(normal, middle) > 0) normal = -normal;  // the light is at 0
                const vec3 along = unit_or(glm::cross(normal, any_vector()), vec3(1, 0, 0));
                const vec3 across = glm::cross(normal, along);
                const Mesh mesh = mesh_of({middle - along - across, middle + along - across,
                                           middle + along + across, middle - along + across},
                                          {{0, 1, 2}, {0, 2, 3}});
                Light light{kind, vec3(1), vec3(0, 0, -1)};
                light.cos_inner = 1,
                light.cos_outer = std::cos(glm::radians(59.5f + 14.5f * any(random)));
                // Other things around widen the map to all of the light's view.
                const LightMaps maps(light, std::span(&mesh, 1), size, {vec3(-4), vec3(4)});
                for (const PointOn& p : points_on(mesh, random, 15)) {
                    const vec3 from_light = glm::normalize(p.point);
                    if (kind == LightKind::spot &&
                        glm::dot(from_light, light.direction_world) <= light.cos_outer)
                        continue;
                    if (!(glm::dot(normal, from_light) < 0)) continue;
                    for (const Bias bias : fitted)
                        for (const int radius : {0, 1, 2, 3}) {
                            ASSERT_EQ(maps.visibility(bias, radius, p.vertices, p.point), 1)
                                << "a lit plane shadows itself: map of " << size << " texels, "
                                << name_of(kind) << ", " << name_of(bias) << ", PCF with radius "
                                << radius << ", at " << testing::PrintToString(p.point)
                                << " (seed 6, plane " << i << ")";
                            ++asked;
                        }
                    // K g in long double: with the plane's distances from T's inverse's columns.
                    const ShadowMap& map = maps.map_for(p.point);
                    const glm::mat<4, 4, real> m(map.texels_from_world);
                    const glm::mat<4, 4, real> inverse = glm::inverse(m);
                    const lvec4 to_plane(lvec3(normal), -glm::dot(lvec3(normal), lvec3(middle)));
                    const auto size_along = [&](int c) {
                        return std::abs(glm::dot(to_plane, inverse[c]));
                    };
                    const real kg = ((3.5L + 1 / 512.0L) * (size_along(0) + size_along(1)) +
                                     0x8p-24L * size_along(2)) *
                                    (normal.x * real(m[0].w) + normal.y * real(m[1].w) +
                                     normal.z * real(m[2].w));
                    if (std::abs(kg - 1) < 1e-4L) continue;  // normals in float
                    const ShadowBias at =
                        shadow_bias(map, Bias::normal, 3, p.vertices, maps.toward(p.point));
                    ASSERT_EQ(at.bias > 1, kg > 1) << "seed 6: size " << size << ", K g " << kg;
                    beyond += kg > 1, close += kg > 0.8L && kg < 1;
                }
            }
    EXPECT_GT(asked, 400000);
    EXPECT_GT(beyond, 100) << "points from which no offset is long enough";
    EXPECT_GT(close, 100) << "points from which a long one is";
}

TEST(ShadowMaps, HardCase_EdgeOnSlopesStayFinite) {
    look_up("Eq. 9.8");
    struct Row {
        Vertices vertices;
        bool is_edge_on;
    };
    std::vector<Row> triangles = {
        {{vec3(0), vec3(1, 0, 0), vec3(0, 0, 1)}, true},     // 0/0 across y, infinite along it
        {{vec3(0), vec3(0, 1, 0), vec3(0, 0, 1)}, true},     // the same along x
        {{vec3(0.25f), vec3(0.25f), vec3(0.25f)}, true},     // no area
        {{vec3(0), vec3(0, 0, 0.5f), vec3(0, 0, 1)}, true},  // a line along the light
        {{vec3(0), vec3(1, 0, 1e-30f), vec3(0, 0, 1)}, true},
        {{vec3(-1e30f), vec3(1e30f, 0, 0), vec3(0, 1, 1)}, false},
        {{vec3(0), vec3(1e-38f, 0, 0), vec3(0, 1e-38f, 0)}, false},
        {{vec3(NAN), vec3(1, 0, 0), vec3(0, 1, 0)}, true}};
    for (const float lean : {1e-3f, 1e-6f, 1e-9f, 1e-20f, 1e-38f})
        for (const float side : {1.0f, -1.0f})
            triangles.push_back({{vec3(0), vec3(1, 0, 0), vec3(0, lean * side, 1)}, true});
    ShadowMap map = map_of_cube(64);
    for (int i = 0; i < 64; ++i) map.depths.test_and_write(ivec2(i) + max_pcf_radius, 0.3f);
    for (const auto& [vertices, is_edge_on] : triangles)
        for (const Bias bias : {Bias::none, Bias::constant, Bias::slope, Bias::plane, Bias::normal})
            for (const vec3 outward : {to_the_light, vec3(0, 1, 1), vec3(0)}) {
                const ShadowBias at = shadow_bias(map, bias, 3, vertices, outward);
                for (const float number :
                     {at.slope.x, at.slope.y, at.bias, at.bias_per_w, at.offset.x, at.offset.y,
                      at.offset.z, at.offset_times_w.x, at.offset_times_w.y, at.offset_times_w.z})
                    ASSERT_TRUE(std::abs(number) <= 3)
                        << name_of(bias) << ": " << number << ", expected at most 3";
                for (const float depth : {0.0f, 0.3f, 1.0f}) {
                    const float visibility = pcf_visibility<3>(map, at, {0, 0, depth});
                    ASSERT_TRUE(visibility >= 0 && visibility <= 1)
                        << name_of(bias) << ": visibility " << visibility;
                }
                if (is_edge_on && (bias == Bias::slope || bias == Bias::plane)) {
                    ASSERT_EQ(pcf_visibility<3>(map, at, {0, 0, 0}), 1)
                        << "a triangle that the light sees edge-on is lit: "
                        << testing::PrintToString(vertices[0]) << ", "
                        << testing::PrintToString(vertices[1]) << ", "
                        << testing::PrintToString(vertices[2]) << ", " << name_of(bias);
                }
            }
}

TEST(ShadowMaps, HardCase_ATriangleTurnedAwayIsLeftToItsNormals) {
    look_up("Eq. 9.8");
    ShadowMap map = map_of_cube(8);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) map.depths.test_and_write(ivec2(x, y) + max_pcf_radius, 1.0f);
    const vec3 point(0.1f, 0.1f, 0.5f);
    for (const Bias bias : fitted) {
        const auto visibility = [&](vec3 outward) {
            return pcf_visibility<1>(map, shadow_bias(map, bias, 1, plane_in_cube(1, 1), outward),
                                     point);
        };
        ASSERT_EQ(visibility(to_the_light), 0) << name_of(bias) << ", turned to the light";
        ASSERT_EQ(visibility(-to_the_light), 1) << name_of(bias) << ", turned away from the light";
    }
}

TEST(ShadowMaps, Eq9_14_AThinWallLeaksAtItsFootNoMoreThanTheBias) {
    // A wall of height 1 across x = 0 on a floor at 0; the light comes from -x.
    const Mesh floor =
        mesh_of({{-4, 0, -4}, {4, 0, -4}, {4, 0, 4}, {-4, 0, 4}}, {{0, 2, 1}, {0, 3, 2}});
    const Mesh wall =
        mesh_of({{0, 0, -2}, {0, 0, 2}, {0, 1, 2}, {0, 1, -2}}, {{0, 1, 2}, {0, 2, 3}});
    const std::array meshes = {floor, wall};
    for (const double elevation_degrees : {15.0, 30.0, 45.0, 60.0})
        for (const int size : {256, 1024})
            for (const int radius : {0, 1, 3}) {
                const double e = glm::radians(elevation_degrees);
                const Light light = sun(vec3(-std::cos(e), std::sin(e), 0));
                const LightMaps maps(light, meshes, size);
                const ShadowMap& map = maps.maps[0];
                const Vertices vertices = vertices_in(floor, floor.triangles[0]);
                const dmat4 rows = glm::transpose(dmat4(map.texels_from_world));
                const double depth_a_unit = glm::length(dvec3(rows[2]));
                const double texel =
                    1 / std::min(glm::length(dvec3(rows[0])), glm::length(dvec3(rows[1])));
                for (const Bias bias : fitted) {
                    const ShadowBias at = shadow_bias(map, bias, radius, vertices, {0, 1, 0});
                    // In world: what is taken off along the ray; a shift along the floor's normal
                    // lifts the point by as much as it is.
                    const double along_ray =
                        (at.bias + at.bias_per_w) / depth_a_unit +
                        glm::length(dvec3(at.offset + at.offset_times_w)) / std::sin(e);
                    const double height = along_ray * std::sin(e);
                    const double blur = (radius + 1) * texel * std::sqrt(2) / std::sin(e);
                    const double end_of_shadow = 1 / std::tan(e) - 2 * blur - height;
                    const double bound = height / std::tan(e) + blur;
                    double leak = 0;
                    for (double x = 1e-4; x < end_of_shadow; x += texel / 7)
                        for (const float z : {-0.73f, 0.11f, 1.01f})
                            if (maps.visibility(bias, radius, vertices, vec3(x, 0, z)) > 0)
                                leak = x;
                    ASSERT_LE(leak, bound)
                        << "the widest strip of light at the foot of a wall; a light "
                        << elevation_degrees << " degrees high, a map of " << size
                        << " texels, PCF with radius " << radius << ", " << name_of(bias);
                    if (bias == Bias::slope && radius > 0) {
                        EXPECT_GT(leak, 0.2 * height / std::tan(e)) << "the bound is not idle";
                    }
                }
            }
}

TEST(ShadowMaps, HardCase_AThinSlabOnTheFloorHasItsShadowFromTwiceTheBiasOn) {
    look_up("Eq. 9.14");
    const Mesh floor =
        mesh_of({{-4, 0, -4}, {4, 0, -4}, {4, 0, 4}, {-4, 0, 4}}, {{0, 2, 1}, {0, 3, 2}});
    const double e = glm::radians(40.0);
    constexpr int size = 512, radius = 1;
    for (const Bias bias : fitted)
        for (const double heights : {0.05, bias == Bias::plane ? 1.1 : 2.1}) {
            const auto with_slab = [&](float h) {
                return std::array{floor, mesh_of({{-2, h, -2}, {1, h, -2}, {1, h, 2}, {-2, h, 2}},
                                                 {{0, 2, 1}, {0, 3, 2}})};
            };
            const Light light = sun(vec3(-std::cos(e), std::sin(e), 0));
            const Vertices vertices = vertices_in(floor, floor.triangles[0]);
            const LightMaps low(light, with_slab(0.01f), size);  // its map is much the same
            const ShadowBias at = shadow_bias(low.maps[0], bias, radius, vertices, {0, 1, 0});
            const dmat4 rows = glm::transpose(dmat4(low.maps[0].texels_from_world));
            const double height =
                (at.bias + at.bias_per_w) / glm::length(dvec3(rows[2])) * std::sin(e) +
                glm::length(dvec3(at.offset + at.offset_times_w));
            const auto h = static_cast<float>(heights * height);
            const LightMaps maps(light, with_slab(h), size);
            // Under the slab. Its own depth changes within the PCF kernel, too, by as much as the
            // bias allows for; compared at the texels' centres, it does not.
            const float visibility = maps.visibility(bias, radius, vertices, {-0.513f, 0, 0.271f});
            if (heights > 1) {
                EXPECT_EQ(visibility, 0) << "under a slab " << h
                                         << " above the floor, twice the bias; " << name_of(bias);
            } else if (bias == Bias::slope) {
                EXPECT_GT(visibility, 0.3f)
                    << "under a slab " << h << " above the floor; " << name_of(bias);
            }
        }
}

TEST(ShadowMaps, Eq9_15_RoundingsStayBelowWhatIsAllowedForThem) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> any(-1, 1);
    double greatest = 0;
    for (int i = 0; i < cases_of(60); ++i) {
        const LightKind kind = light_kinds[static_cast<std::size_t>(i) % 3];
        const float x = any(random), y = any(random), z = any(random);
        const TiltedPlane plane(random, kind, 1, 50.0f * vec3(x, y, z));
        const LightViews views =
            light_views(plane.light, plane.mesh.bounds, plane.mesh.bounds, 512);
        std::map<std::size_t, ShadowMap> maps;  // of the faces that are asked for
        for (const PointOn& p : points_on(plane.mesh, random, 2)) {
            const std::size_t face =
                views.count == 6 ? cube_face(p.point - plane.light.position_world) : 0;
            const ShadowMap& map = maps.try_emplace(face, views.clip_from_world[face],
                                                    views.is_perspective, 512, plane.mesh.bounds)
                                       .first->second;
            const vec4 computed = map.texels_from_world * vec4(p.point, 1);
            const glm::mat<4, 4, real> exact_m =
                glm::mat<4, 4, real>(viewport<double>(ivec2(512))) *
                glm::mat<4, 4, real>(map.clip_from_world);
            const lvec4 exact = exact_m * lvec4(lvec3(p.point), 1);
            const real w = exact.w;
            for (int axis = 0; axis < 2; ++axis)
                greatest = std::max(
                    greatest, double(std::abs(computed[axis] / computed.w - exact[axis] / w) * w /
                                     real(map.rounding_texels)));
            greatest = std::max(greatest, double(std::abs(computed.z / computed.w - exact.z / w) *
                                                 w / real(map.rounding_depth)));
        }
    }
    const char* const what = "the greatest rounding, in rounding_texels or rounding_depth";
    EXPECT_LE(greatest, 0.5) << what << "; the other half is for the map's side";
    EXPECT_GT(greatest, 0.005) << what << "; the bound is out of proportion";
}
