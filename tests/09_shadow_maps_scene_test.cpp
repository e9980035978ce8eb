// SPDX-License-Identifier: MIT
// Which materials call for shadows, shadows of scenes against rays, special numbers, and the
// pictures.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "06_phong/effects.hpp"
#include "09_shadow_maps/light_view.hpp"
#include "09_shadow_maps/shadow_map.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "support/first_difference.hpp"
#include "support/golden.hpp"
#include "support/lesson_09.hpp"
#include "support/lesson_process.hpp"
#include "support/light_maps.hpp"
#include "support/look_up.hpp"
#include "support/names.hpp"
#include "support/one_triangle.hpp"
#include "support/pictures.hpp"
#include "support/printers.hpp"
#include "support/shadow_points.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

lesson_09::Options small_picture() {
    lesson_09::Options options;
    options.size = {320, 180};
    options.shadow.size = 256;
    return options;
}

/// A picture of the lesson.
Drawn drawn(const Scene& scene, const lesson_09::Options& options) {
    return test::drawn(options, lesson_09::make_assets(scene, options),
                       [](auto&... arguments) { return lesson_09::render(arguments...); });
}

bool is_finite(const Image<vec3>& picture) {
    return std::ranges::all_of(picture.pixels(), [](vec3 c) {
        return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
    });
}

/// The scene with a change of all of its materials.
template <typename Change>
Scene with_materials(Scene scene, Change&& change) {
    for (Material& material : scene.materials) change(material);
    return scene;
}

Mesh quad(vec3 a, vec3 b, vec3 c, vec3 d) { return mesh_of({a, b, c, d}, {{0, 1, 2}, {0, 2, 3}}); }

/// The six sides of a box, seen from inside and outside.
Mesh closed_box(vec3 low, vec3 high) {
    std::vector<vec3> positions;
    for (int i = 0; i < 8; ++i)
        positions.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y,
                               i & 4 ? high.z : low.z);
    return mesh_of(positions, {{0, 1, 3},
                               {0, 3, 2},
                               {4, 5, 7},
                               {4, 7, 6},
                               {0, 1, 5},
                               {0, 5, 4},
                               {2, 3, 7},
                               {2, 7, 6},
                               {0, 2, 6},
                               {0, 6, 4},
                               {1, 3, 7},
                               {1, 7, 5}});
}

/// The shadow maps of two lights, of which the first casts shadows, and what they say of points of
/// a scene's first triangle.
class FirstTriangle {
  public:
    FirstTriangle(const Scene& scene, const Light& light, const ShadowOptions& variant)
        : shadow_maps_(draw_shadow_maps(
              variant, {scene, shadow_bounds(scene), std::array{light, sun({0, 1, 0})}})),
          receiver_(ShadowBiasCache(vertices_in(scene.meshes[0], scene.meshes[0].triangles[0]))) {}

    float visibility(std::size_t light, vec3 position, vec3 normal) {
        return light_visibility(shadow_maps_, light, receiver_, position, normal);
    }
    std::uint64_t count(Counter counter) const {
        return counters_.values()[static_cast<std::size_t>(counter)];
    }

  private:
    const CountedSince counters_;
    ShadowMaps shadow_maps_;
    ShadowBiasCache receiver_;
};

}  // namespace

TEST(ShadowMaps, Eq9_16_LightFadesOutWhereASurfaceTurnsAway) {
    // A floor in light from above; the normals of its points say how they are turned to it.
    Scene scene;
    scene.meshes.push_back(quad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}));
    scene.materials.resize(1);
    FirstTriangle floor(scene, sun({0, 1, 0}), small_picture().shadow);
    for (const float cosine : {1.0f, 0.5f, 0.1f, 0.05f, 0.01f, 0.0f, -0.01f, -1.0f}) {
        const vec3 position(-0.5f, 0, 0.3f);
        const vec3 normal =
            3.0f * vec3(std::sqrt(1 - cosine * cosine), cosine, 0);  // of any length
        ASSERT_NEAR(floor.visibility(0, position, normal), std::clamp(cosine / 0.1f, 0.0f, 1.0f),
                    1e-6f)
            << "the cosine between normal and light is " << cosine;
        EXPECT_EQ(floor.visibility(1, position, normal), 1) << "the sky casts no shadows";
    }
    EXPECT_EQ(floor.count(Counter::shadow_tests), 5u) << "only of those that face the light";
}

TEST(ShadowMaps, Eq9_16_LightFadesAlikeInAllFacesOfAPointLight) {
    // The one caster is seen through the light's +x; the glass floor below has no map.
    Scene scene;
    scene.meshes.push_back(quad({-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}));
    scene.meshes.push_back(quad({2, 0.6f, 0}, {2, 0.6f, 1}, {2, 0.8f, 1}, {2, 0.8f, 0}));
    scene.materials.resize(2);
    scene.materials[0].opacity = 0.5f;
    for (Triangle& triangle : scene.meshes[1].triangles) triangle.material = 1;
    const Light light = point_light({0, 1, 0});
    FirstTriangle floor(scene, light, small_picture().shadow);
    EXPECT_EQ(floor.count(Counter::shadow_passes), 1u);
    for (const vec3 position : {vec3(0.9f, 0, -0.1f), vec3(1.1f, 0, -0.1f)}) {
        const vec3 toward = glm::normalize(light.position_world - position);
        const vec3 across = glm::normalize(glm::cross(toward, vec3(0, 0, 1)));
        const auto visibility = [&](float cosine) {
            return floor.visibility(0, position,
                                    cosine * toward + std::sqrt(1 - cosine * cosine) * across);
        };
        EXPECT_EQ(visibility(0.5f), 1);
        EXPECT_NEAR(visibility(0.05f), 0.5f, 1e-5f);  // a cosine of float in twentieths
    }
    EXPECT_EQ(floor.count(Counter::shadow_tests), 2u);
}

TEST(ShadowMaps, HardCase_ATestIsMadeOnlyWhereTheLightCounts) {
    look_up("Eq. 9.16");
    // The surface's own normal has to face the light, and so has the normal map's: on the pot's
    // bright side, some bumps lean away from it. And light has to arrive, within a spotlight's
    // cone.
    for (const LightKind kind : light_kinds) {
        lesson_09::Options options = small_picture();
        options.shading.key_light = kind;
        const Scene scene = loaded("scene_bumpy.obj");
        const std::uint64_t bumpy = drawn(scene, options).count(Counter::shadow_tests);
        options.normal_map.space = MapSpace::none;
        const std::uint64_t flat = drawn(scene, options).count(Counter::shadow_tests);
        EXPECT_LT(bumpy, flat) << name_of(kind);
        EXPECT_GT(bumpy, flat * 98 / 100) << name_of(kind) << ": few bumps are so steep";
        options.shading.key_light = LightKind::point;  // where the spotlight is
        const std::uint64_t all_around = drawn(scene, options).count(Counter::shadow_tests);
        if (kind == LightKind::spot) { EXPECT_LT(flat, all_around * 8 / 10); }
    }
}

TEST(ShadowMaps, HardCase_OnlyWhatCallsForShadowsGetsThem) {
    look_up("Eq. 9.3");
    const auto unlit = [](Material& m) { m.illumination = 0; };
    const auto glass = [](Material& m) { m.opacity = 0.5f; };
    struct Row {
        const char* name;
        Scene scene;
        bool has_shadows, has_light;
    };
    for (const auto& [name, scene, has_shadows, has_light] :
         {Row{"scene_bumpy", loaded("scene_bumpy.obj"), true, true},
          Row{"scene", loaded("scene.obj"), true, true},
          Row{"floor", loaded("floor.obj"), true, true},
          Row{"unlit", with_materials(loaded("scene.obj"), unlit), false, false},
          Row{"glass", with_materials(loaded("scene.obj"), glass), false, true}})
        for (const LightKind kind : light_kinds) {
            lesson_09::Options options = small_picture();
            options.shading.key_light = kind;
            const Drawn planned = drawn(scene, options);
            EXPECT_EQ(planned.count(Counter::shadow_passes) > 0, has_shadows) << name;
            EXPECT_EQ(planned.count(Counter::shadow_fragments) > 0, has_shadows) << name;
            EXPECT_EQ(planned.count(Counter::shadow_tests) > 0, has_shadows) << name;
            EXPECT_LE(planned.count(Counter::shadow_passes), kind == LightKind::point ? 6u : 1u);
            EXPECT_LE(planned.count(Counter::shadow_tests), planned.count(Counter::fragments_lit));

            options.shading.all_effects = true;
            const Drawn all = drawn(scene, options);
            EXPECT_GE(all.count(Counter::shadow_passes), 2u) << name;
            EXPECT_EQ(all.count(Counter::shadow_fragments),
                      planned.count(Counter::shadow_fragments))
                << name << ": nothing is drawn into a map that nothing calls for";
            EXPECT_EQ(all.count(Counter::shadow_tests) > planned.count(Counter::shadow_tests),
                      has_light)
                << name;
        }
}

TEST(ShadowMaps, HardCase_EffectsThatAreNotCalledForWouldChangeNothing) {
    look_up("Eq. 9.3");
    const auto glass = [](Material& m) { m.opacity = 0.5f; };
    const auto some_unlit = [](Material& m) { m.illumination = m.name == "brick" ? 0 : 2; };
    for (const Scene& scene : {loaded("scene_bumpy.obj"), loaded("scene.obj"), loaded("crate.obj"),
                               with_materials(loaded("scene.obj"), glass),
                               with_materials(loaded("scene_bumpy.obj"), some_unlit)})
        for (const LightKind kind : light_kinds) {
            lesson_09::Options options = small_picture();
            options.shading.key_light = kind;
            const Drawn planned = drawn(scene, options);
            options.shading.all_effects = true;
            const Drawn all = drawn(scene, options);
            ASSERT_TRUE(have_the_same_bits(all.picture, planned.picture))
                << "with --all-effects, beside without; " << name_of(kind);
        }
}

TEST(ShadowMaps, HardCase_UnlitAndTransparentMaterialsCastNoShadow) {
    look_up("Eq. 9.3");
    // A plate above a floor, and a shadow test below it. The map reaches up to the plate in any
    // case, as there are opaque plates above two corners.
    for (const auto& [illumination, opacity, is_dark] :
         {std::tuple{2, 1.0f, true}, {1, 1.0f, true}, {0, 1.0f, false}, {2, 0.5f, false}}) {
        Scene scene;
        scene.meshes.push_back(quad({-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}));
        scene.meshes.push_back(quad({-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}, {1, 1, -1}));
        scene.materials.resize(2);
        for (Triangle& triangle : scene.meshes[1].triangles) triangle.material = 1;
        scene.materials[1].illumination = illumination, scene.materials[1].opacity = opacity;
        const ShadowBounds bounds = shadow_bounds(scene);
        EXPECT_EQ(bounds.casters.max.y, is_dark ? 1 : 0) << illumination << ", " << opacity;
        EXPECT_EQ(bounds.receivers.max.y, illumination > 0 ? 1 : 0) << "glass gets shadows";
        for (const float x : {-3.0f, 2.8f})
            scene.meshes.push_back(
                quad({x, 2, x}, {x, 2, x + 0.2f}, {x + 0.2f, 2, x + 0.2f}, {x + 0.2f, 2, x}));
        FirstTriangle floor(scene, sun({0, 1, 0}), small_picture().shadow);
        EXPECT_EQ(floor.visibility(0, {-0.3f, 0, 0.2f}, {0, 1, 0}), is_dark ? 0 : 1)
            << illumination << ", " << opacity;
        EXPECT_EQ(floor.visibility(0, {-2, 0, 2}, {0, 1, 0}), 1);
    }
}

TEST(ShadowMaps, HardCase_ATriangleSeenInSeveralMapsHasABiasInEach) {
    look_up("Eq. 9.5");
    Scene scene;
    scene.meshes.push_back(quad({-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}));
    scene.materials.resize(1);
    FirstTriangle floor(scene, point_light({0.3f, 1, 0.2f}), small_picture().shadow);
    for (int i = 0; i < 60; ++i)  // from the first map across two more
        EXPECT_EQ(floor.visibility(0, {3.9f - 0.13f * static_cast<float>(i), 0, 0.1f}, {0, 1, 0}),
                  1)
            << i;
}

TEST(ShadowMaps, HardCase_TheOrderOfShadowTestsChangesNothing) {
    look_up("Eq. 9.8");
    // A floor in the shadow of a plate, with normals on both sides of it: one points to the side
    // that lies in shadow, the other to the back, which is turned away from the light.
    Scene scene;
    scene.meshes.push_back(quad({-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}));
    scene.meshes.push_back(quad({-2, 1, -2}, {-2, 1, 2}, {2, 1, 2}, {2, 1, -2}));
    scene.materials.resize(1);
    for (const Bias bias : {Bias::slope, Bias::plane, Bias::normal}) {
        ShadowOptions variant = small_picture().shadow;
        variant.bias = bias;
        const auto in_order = [&](vec3 first, vec3 second) {
            FirstTriangle floor(scene, sun(glm::normalize(vec3(1, 1, 0))), variant);
            const vec3 position(-1.2f, 0, 0.1f);
            const float of_first = floor.visibility(0, position, first);
            return std::pair(of_first, floor.visibility(0, position, second));
        };
        const vec3 up(0.8f, 0.6f, 0), down(0.8f, -0.6f, 0);
        EXPECT_EQ(in_order(up, down), std::pair(0.0f, 1.0f)) << name_of(bias);
        EXPECT_EQ(in_order(down, up), std::pair(1.0f, 0.0f)) << name_of(bias);
    }
}

TEST(ShadowMaps, HardCase_ShadowsOfTheSceneAgreeWithRaysAwayFromTheirEdges) {
    look_up("Eq. 9.7");
    lesson_09::Options options;
    const Scene scene = lesson_09::make_assets(loaded("scene_bumpy.obj"), options).scene;
    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    const std::vector<SeenPoint> points = seen_points(scene, camera, {160, 90});
    ASSERT_GT(points.size(), 5000u);
    const double size = scene.bounds().radius();
    constexpr int texels = 1024, radius = 1;
    for (const LightKind kind : light_kinds) {
        const Light light = raking_lights(kind, scene.bounds())[0];
        const LightMaps maps(light, scene.meshes, texels);
        const LightRays rays(light, RayCaster::of(scene.meshes, [](std::size_t) { return true; }),
                             size);
        int judged = 0, dark = 0;
        std::array<int, 5> wrong{};
        for (const SeenPoint& p : points) {
            const vec3 toward = glm::normalize(maps.toward(p.position));
            const float cosine = glm::dot(p.normal, toward);
            // Where light grazes, triangles shadow each other as a smooth surface would not.
            if (cosine < 0.25f) continue;
            // Three texels on the surface; a point light's are up to 2/1024 of the distance wide.
            const double texel = 2.5 * size / texels;
            if (!rays.is_far_from_edges(p.position, p.normal, 3 * texel / cosine)) continue;
            const auto distance = rays.distance_to_caster(p.position);
            if (distance && *distance < 10 * texel / cosine) continue;  // it may leak there
            ++judged, dark += distance.has_value();
            for (const Bias bias : {Bias::slope, Bias::plane, Bias::normal})
                wrong[static_cast<std::size_t>(bias)] +=
                    maps.visibility(bias, radius, p.vertices, p.position) != (distance ? 0 : 1);
        }
        // Where a surface is hollow, as between the body and the spout, a triangle's plane lies
        // behind its neighbours: of a thousand shadow tests one or two are a ninth too dark.
        for (const Bias bias : {Bias::slope, Bias::plane, Bias::normal})
            EXPECT_LE(wrong[static_cast<std::size_t>(bias)], judged / 500)
                << "shadow tests that are not what a ray finds, of " << judged << "; "
                << name_of(kind) << ", " << name_of(bias);
        EXPECT_GT(judged, 2000) << name_of(kind);
        EXPECT_GT(dark, 200) << name_of(kind);
    }
}

TEST(ShadowMaps, HardCase_SixMapsHaveNoSeams) {
    look_up("Eq. 9.5");
    // A point light in a room, and a plate beside it: where the plate's shadow crosses from one map
    // into another, it goes on.
    const Mesh room = closed_box({-4, -3, -5}, {5, 4, 3});
    const Mesh plate = quad({0.5f, 0.5f, -1}, {0.5f, 0.7f, 1}, {0.7f, 0.5f, 1}, {0.7f, 0.5f, -1});
    const Light light = point_light({0.1f, 0.2f, -0.3f});
    const std::array with_plate = {room, plate};
    const LightMaps empty(light, std::span(&room, 1), 256), maps(light, with_plate, 256);
    const LightRays rays(light, RayCaster::of(with_plate, [](std::size_t) { return true; }), 8);
    const RayCaster walls = RayCaster::of(std::span(&room, 1), [](std::size_t) { return true; });
    std::mt19937 random(5);
    std::uniform_real_distribution<float> any(-1, 1);
    int judged = 0, dark = 0;
    for (int i = 0; i < 40000; ++i) {
        // Near the border of two faces: two components of the direction are nearly as large.
        vec3 direction(any(random), any(random), any(random));
        const int a = i % 3, b = (a + 1) % 3, c = (a + 2) % 3;
        direction[a] = i & 4 ? 1.0f : -1.0f;
        direction[b] = (i & 8 ? 1.0f : -1.0f) * (1 + 0.03f * direction[b]);
        direction[c] *= 0.9f;
        for (const RayTriangle& t : walls.triangles()) {
            const auto distance = distance_to({dvec3(light.position_world), dvec3(direction)}, t);
            if (!distance) continue;
            const Vertices vertices = {vec3(t[0]), vec3(t[1]), vec3(t[2])};
            const vec3 point = light.position_world + static_cast<float>(*distance) * direction;
            const dvec3 normal = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
            // Where walls meet, the other one stands in front of this one's plane.
            const vec3 to_walls =
                glm::min(glm::abs(point - room.bounds.min), glm::abs(point - room.bounds.max));
            if (to_walls.x + to_walls.y + to_walls.z -
                    std::max({to_walls.x, to_walls.y, to_walls.z}) <
                0.4f)
                break;
            for (const Bias bias : {Bias::slope, Bias::plane, Bias::normal})
                for (const int radius : {0, 3})
                    ASSERT_EQ(empty.visibility(bias, radius, vertices, point), 1)
                        << "seed 5, ray " << i;
            if (!rays.is_far_from_edges(point, normal, 0.35)) break;
            const bool is_lit = rays.is_lit(point);
            ++judged, dark += !is_lit;
            ASSERT_EQ(maps.visibility(Bias::plane, 1, vertices, point), is_lit ? 1 : 0)
                << "seed 5, ray " << i;
            break;
        }
    }
    EXPECT_GT(judged, 10000);
    EXPECT_GT(dark, 100);
}

TEST(ShadowMaps, HardCase_ALightInsideAMesh) {
    look_up("Eq. 9.5");
    // A point light and a spotlight in a closed box, in a room: the box is lit inside, the room is
    // dark.
    const Mesh room = closed_box(vec3(-4), vec3(4)), chest = closed_box(vec3(-1), vec3(1));
    const std::array meshes = {room, chest};
    Light spot = point_light({0.2f, 0.1f, -0.3f});
    spot.kind = LightKind::spot, spot.direction_world = {0, -1, 0}, spot.cos_outer = 0.6f;
    std::mt19937 random(6);
    std::uniform_real_distribution<float> any(-0.95f, 0.95f);
    for (const Light& light : {point_light({0.2f, 0.1f, -0.3f}), spot}) {
        const LightMaps maps(light, meshes, 256);
        for (int i = 0; i < 1000; ++i) {
            const vec3 under(any(random), -1, any(random));
            const Vertices floor_of_chest = {vec3(-1, -1, -1), vec3(1, -1, -1), vec3(1, -1, 1)};
            const Vertices floor_of_room = {vec3(-4, -4, -4), vec3(4, -4, -4), vec3(4, -4, 4)};
            for (const Bias bias : {Bias::slope, Bias::plane, Bias::normal}) {
                ASSERT_EQ(maps.visibility(bias, 1, floor_of_chest, under), 1)
                    << "in the chest, with the light, at " << testing::PrintToString(under) << "; "
                    << name_of(light.kind) << ", " << name_of(bias);
                // Farther along the same ray, through the chest's floor.
                const vec3 beyond = light.position_world + (4 + light.position_world.y) /
                                                               (1 + light.position_world.y) *
                                                               (under - light.position_world);
                if (std::max(std::abs(beyond.x), std::abs(beyond.z)) > 3.9f) continue;
                ASSERT_EQ(maps.visibility(bias, 1, floor_of_room, beyond), 0)
                    << "in the room, outside of the chest with the light, at "
                    << testing::PrintToString(beyond) << "; " << name_of(light.kind) << ", "
                    << name_of(bias);
            }
        }
    }
}

TEST(ShadowMaps, HardCase_SpecialNumbersAtTheEntry) {
    look_up("Eq. 9.7");
    constexpr float tiny = std::numeric_limits<float>::denorm_min(),
                    infinity = std::numeric_limits<float>::infinity();
    constexpr float special[] = {0, tiny, -tiny,  1e-38f, 1e-20f, -1e-6f, 1,        -1,        0.5f,
                                 3, 1e6f, -1e15f, 1e30f,  3e38f,  -3e38f, infinity, -infinity, NAN};
    std::mt19937 random(7);
    const auto any = [&](std::size_t of) { return special[random() % of]; };
    const auto any_vector = [&](std::size_t of) {
        const float x = any(of), y = any(of), z = any(of);
        return vec3(x, y, z);
    };
    constexpr std::size_t finite = std::size(special) - 3, all = std::size(special);
    int with_maps = 0;
    for (int i = 0; i < 20000; ++i) {
        Light light{light_kinds[random() % 3], vec3(1), unit_or(any_vector(finite), vec3(0, 1, 0)),
                    any_vector(finite)};
        light.cos_inner = std::clamp(any(finite), -0.9f, 1.0f);
        light.cos_outer =
            std::clamp(light.cos_inner - std::abs(any(finite)), -1.0f, light.cos_inner - 1e-6f);
        Mesh mesh = mesh_of({any_vector(all), any_vector(all), any_vector(all)}, {{0, 1, 2}});
        const LightMaps maps(light, std::span(&mesh, 1), 16);
        with_maps += !maps.maps.empty();
        for (const ShadowMap& map : maps.maps)
            for (const float depth : map.depths.depths().pixels())
                ASSERT_TRUE(depth >= 0 && depth <= 1) << "seed 7, case " << i << ": " << depth;
        if (maps.maps.empty()) continue;
        for (const Bias bias :
             {Bias::none, Bias::constant, Bias::slope, Bias::plane, Bias::normal}) {
            const float visibility =
                maps.visibility(bias, static_cast<int>(random() % 4),
                                vertices_in(mesh, mesh.triangles[0]), any_vector(all));
            ASSERT_TRUE(visibility >= 0 && visibility <= 1)
                << "seed 7, case " << i << ": " << visibility;
        }
    }
    EXPECT_GT(with_maps, 1000);
}

TEST(ShadowMaps, HardCase_ModelsOfAllSizes) {
    look_up("Eq. 9.6");
    for (const LightKind kind : light_kinds) {
        lesson_09::Options options = small_picture();
        options.shading.key_light = kind;
        const auto picture_of = [&](float scale) {
            Scene scene = loaded("scene.obj");
            for (Mesh& mesh : scene.meshes) {
                mesh.bounds = {};
                for (vec3& position : mesh.positions) mesh.bounds.add(position *= scale);
            }
            return drawn(scene, options).picture;
        };
        const Image<vec3> picture = picture_of(1);
        ASSERT_TRUE(is_finite(picture));
        // A power of two loses no digits; near the ends of the range of float, some are lost.
        EXPECT_TRUE(have_the_same_bits(picture_of(0x1p20f), picture))
            << name_of(kind) << ", scale 0x1p20";
        EXPECT_TRUE(have_the_same_bits(picture_of(0x1p-20f), picture))
            << name_of(kind) << ", scale 0x1p-20";
        for (const float scale : {1e-30f, 1e-20f, 1e15f}) {
            const Image<vec3> other = picture_of(scale);
            ASSERT_TRUE(is_finite(other)) << scale;
            int differing = 0;
            for (std::size_t i = 0; i < picture.pixels().size(); ++i) {
                const vec3 by = glm::abs(picture.pixels()[i] - other.pixels()[i]);
                differing += std::max({by.x, by.y, by.z}) > 0.05f;
            }
            EXPECT_LT(differing, 60) << name_of(kind) << ", scale " << scale;  // at edges
        }
    }
}

TEST(ShadowMaps, HardCase_TheSmallestAndTheLargestShadowMap) {
    look_up("Eq. 9.5");
    const std::string out = (fresh_folder("shadow_size") / "picture.bmp").string();
    const auto exit_status = [&](const char* texels) {
        return run_program("09_shadow_maps",
                           {"--size", "32x18", "--shadow-size", texels, "--out", out})
            .exit_status;
    };
    EXPECT_EQ(exit_status("16"), 0);
    EXPECT_NE(exit_status("15"), 0) << "smaller maps are refused";
    EXPECT_NE(exit_status("8193"), 0) << "larger maps are refused";
}

TEST(ShadowMaps, PictureOfADirectionalLight) {
    EXPECT_TRUE(equals_golden("09_shadow_maps", "09_shadow_maps"));
}

TEST(ShadowMaps, PictureOfASpotlight) {
    EXPECT_TRUE(equals_golden("09_shadow_maps", "09_shadow_maps_spot", {"--light", "spot"}));
}

TEST(ShadowMaps, PictureOfAPointLight) {
    EXPECT_TRUE(equals_golden("09_shadow_maps", "09_shadow_maps_point", {"--light", "point"}));
}

TEST(ShadowMaps, PictureOfAcne) {
    // At the borders of the stripes a depth's last digit decides, and with it the order in which
    // the products of (9.6) are added up. Another order than the lesson's changed 6 pixels.
    constexpr std::size_t may_jump = 60;
    EXPECT_TRUE(equals_golden("09_shadow_maps", "09_shadow_maps_none",
                              {"--bias", "none", "--shadow-size", "512"}, may_jump));
}

TEST(ShadowMaps, PictureOfDetachedShadows) {
    EXPECT_TRUE(equals_golden("09_shadow_maps", "09_shadow_maps_constant",
                              {"--bias", "constant", "--shadow-size", "256"}));
}

TEST(ShadowMaps, PictureOfHardEdges) {
    EXPECT_TRUE(equals_golden("09_shadow_maps", "09_shadow_maps_hard",
                              {"--shadow-size", "256", "--pcf", "1"}));
}

TEST(ShadowMaps, PictureOfSoftEdges) {
    EXPECT_TRUE(equals_golden("09_shadow_maps", "09_shadow_maps_soft",
                              {"--shadow-size", "256", "--pcf", "7"}));
}
