// SPDX-License-Identifier: MIT
// Which materials call for shadows, shadows of scenes against rays, special numbers, and the
// pictures.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
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
#include "support/special_numbers.hpp"

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
                       [](auto&... of) { return lesson_09::render(of...); });
}

/// The scene with a change of all of its materials.
template <typename Change>
Scene with_materials(Scene scene, Change&& change) {
    for (Material& material : scene.materials) change(material);
    return scene;
}

Mesh quad(vec3 a, vec3 b, vec3 c, vec3 d) { return mesh_of({a, b, c, d}, {{0, 1, 2}, {0, 2, 3}}); }

/// Seen from above.
Mesh plate(vec3 corner, float side) {
    const vec3 x(side, 0, 0), z(0, 0, side);
    return quad(corner, corner + z, corner + x + z, corner + x);
}

Mesh floor_of(float half_side) { return plate(vec3(-half_side, 0, -half_side), 2 * half_side); }

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
    std::uint64_t count(Counter counter) const { return counters_[counter]; }

  private:
    const CountedSince counters_;
    ShadowMaps shadow_maps_;
    ShadowBiasCache receiver_;
};

}  // namespace

TEST(ShadowMaps, Eq9_16_LightFadesOutWhereASurfaceTurnsAway) {
    // A floor in light from above; the normals of its points say how they are turned to it.
    Scene scene;
    scene.meshes.push_back(floor_of(1));
    scene.materials.resize(1);
    FirstTriangle floor(scene, sun({0, 1, 0}), small_picture().shadow);
    for (const float cosine : {1.0f, 0.1f, 0.05f, 0.01f, 0.0f, -0.01f, -1.0f}) {
        const vec3 position(-0.5f, 0, 0.3f);
        const vec3 normal =
            3.0f * vec3(std::sqrt(1 - cosine * cosine), cosine, 0);  // of any length
        ASSERT_NEAR(floor.visibility(0, position, normal), std::clamp(cosine / 0.1f, 0.0f, 1.0f),
                    1e-6f)
            << "the cosine between normal and light is " << cosine;
        EXPECT_EQ(floor.visibility(1, position, normal), 1) << "the sky casts no shadows";
    }
    EXPECT_EQ(floor.count(Counter::shadow_tests), 4u) << "only of those that face the light";
}

TEST(ShadowMaps, Eq9_16_LightFadesAlikeInAllFacesOfAPointLight) {
    // The one caster is seen through the light's +x; the glass floor below has no map.
    Scene scene;
    scene.meshes.push_back(floor_of(3));
    scene.meshes.push_back(quad({2, 0.6f, 0}, {2, 0.6f, 1}, {2, 0.8f, 1}, {2, 0.8f, 0}));
    scene.materials.resize(2);
    scene.materials[0].opacity = 0.5f;
    for (Triangle& triangle : scene.meshes[1].triangles) triangle.material = 1;
    const Light light = point_light({0, 1, 0});
    FirstTriangle floor(scene, light, small_picture().shadow);
    EXPECT_EQ(floor.count(Counter::shadow_passes), 1u);
    for (const vec3 position : {vec3(0.9f, 0, -0.1f), vec3(1.1f, 0, -0.1f)})
        for (const float cosine : {0.5f, 0.05f}) {
            const vec3 toward = glm::normalize(light.position_world - position);
            const vec3 across = glm::normalize(glm::cross(toward, vec3(0, 0, 1)));
            const vec3 normal = cosine * toward + std::sqrt(1 - cosine * cosine) * across;
            EXPECT_NEAR(floor.visibility(0, position, normal), cosine == 0.5f ? 1 : 0.5f, 1e-5f)
                << "at " << testing::PrintToString(position) << ", cosine " << cosine;
        }
    EXPECT_EQ(floor.count(Counter::shadow_tests), 2u);
}

TEST(ShadowMaps, HardCase_ATestIsMadeOnlyWhereTheLightCounts) {
    look_up("Eq. 9.16");
    // The surface's own normal has to face the light, and so has the normal map's: on the pot's
    // bright side, some bumps lean away from it. And light has to arrive, within a spotlight's
    // cone.
    const Scene scene = loaded("scene_bumpy.obj");
    const auto tests = [&](LightKind kind, MapSpace space) {
        lesson_09::Options options = small_picture();
        options.shading.key_light = kind, options.normal_map.space = space;
        return drawn(scene, options).count(Counter::shadow_tests);
    };
    for (const LightKind kind : light_kinds) {
        const std::uint64_t bumpy = tests(kind, small_picture().normal_map.space),
                            flat = tests(kind, MapSpace::none);
        EXPECT_LT(bumpy, flat) << name_of(kind);
        EXPECT_GT(bumpy, flat * 98 / 100) << name_of(kind) << ": few bumps are so steep";
        if (kind == LightKind::spot) {  // the point light is where the spotlight is
            EXPECT_LT(flat, tests(LightKind::point, MapSpace::none) * 8 / 10);
        }
    }
}

TEST(ShadowMaps, HardCase_OnlyWhatCallsForShadowsGetsThem) {
    look_up("Eq. 9.3");
    const auto unlit = [](Material& m) { m.illumination = 0; };
    const auto some_unlit = [](Material& m) { m.illumination = m.name == "brick" ? 0 : 2; };
    const auto glass = [](Material& m) { m.opacity = 0.5f; };
    struct Row {
        const char* name;
        Scene scene;
        bool has_shadows, has_light;
    };
    for (const auto& [name, scene, has_shadows, has_light] :
         {Row{"scene_bumpy", loaded("scene_bumpy.obj"), true, true},
          Row{"floor", loaded("floor.obj"), true, true},
          Row{"unlit", with_materials(loaded("scene.obj"), unlit), false, false},
          Row{"unlit bricks", with_materials(loaded("scene.obj"), some_unlit), true, true},
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
            ASSERT_TRUE(have_the_same_bits(all.picture, planned.picture))
                << name << " with --all-effects, beside without; " << name_of(kind);
        }
}

TEST(ShadowMaps, HardCase_UnlitAndTransparentMaterialsCastNoShadow) {
    look_up("Eq. 9.3");
    // A plate above a floor, and a shadow test below it. The map reaches up to the plate in any
    // case, as there are opaque plates above two corners.
    for (const auto& [illumination, opacity, is_dark] :
         {std::tuple{2, 1.0f, true}, {1, 1.0f, true}, {0, 1.0f, false}, {2, 0.5f, false}}) {
        Scene scene;
        scene.meshes = {floor_of(3), plate(vec3(-1, 1, -1), 2)};
        scene.materials.resize(2);
        for (Triangle& triangle : scene.meshes[1].triangles) triangle.material = 1;
        scene.materials[1].illumination = illumination, scene.materials[1].opacity = opacity;
        const ShadowBounds bounds = shadow_bounds(scene);
        EXPECT_EQ(bounds.casters.max.y, is_dark ? 1 : 0) << illumination << ", " << opacity;
        EXPECT_EQ(bounds.receivers.max.y, illumination > 0 ? 1 : 0) << "glass gets shadows";
        for (const float x : {-3.0f, 2.8f}) scene.meshes.push_back(plate({x, 2, x}, 0.2f));
        FirstTriangle floor(scene, sun({0, 1, 0}), small_picture().shadow);
        EXPECT_EQ(floor.visibility(0, {-0.3f, 0, 0.2f}, {0, 1, 0}), is_dark ? 0 : 1)
            << illumination << ", " << opacity;
        EXPECT_EQ(floor.visibility(0, {-2, 0, 2}, {0, 1, 0}), 1);
    }
}

TEST(ShadowMaps, HardCase_ATriangleSeenInSeveralMapsHasABiasInEach) {
    look_up("Eq. 9.5");
    Scene scene;
    scene.meshes.push_back(floor_of(4));
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
    scene.meshes = {floor_of(3), plate(vec3(-2, 1, -2), 4)};
    scene.materials.resize(1);
    const vec3 up(0.8f, 0.6f, 0), down(0.8f, -0.6f, 0), position(-1.2f, 0, 0.1f);
    for (const Bias bias : fitted_biases)
        for (const bool is_up_first : {true, false}) {
            ShadowOptions variant = small_picture().shadow;
            variant.bias = bias;
            FirstTriangle floor(scene, sun(glm::normalize(vec3(1, 1, 0))), variant);
            for (const bool is_up : {is_up_first, !is_up_first})
                EXPECT_EQ(floor.visibility(0, position, is_up ? up : down), is_up ? 0 : 1)
                    << name_of(bias);
        }
}

TEST(ShadowMaps, HardCase_ShadowsOfTheSceneAgreeWithRaysAwayFromTheirEdges) {
    look_up("Eq. 9.7");
    lesson_09::Options options;
    const Scene scene = lesson_09::make_assets(loaded("scene_bumpy.obj"), options).scene;
    const Camera camera = orbit_camera(options.orbit, scene.bounds());
    const std::vector<SeenPoint> points = seen_points(scene, camera, {160, 90});
    const double size = scene.bounds().radius();
    constexpr int texels = 1024;
    for (const LightKind kind : light_kinds) {
        const Light light = raking_lights(kind, scene.bounds())[0];
        const LightMaps maps(light, scene.meshes, texels);
        const LightRays rays(light, RayCaster::of(scene.meshes, [](std::size_t) { return true; }),
                             size);
        int judged = 0, dark = 0;
        std::array<int, fitted_biases.size()> wrong{};
        for (const SeenPoint& p : points) {
            const float cosine = glm::dot(p.normal, glm::normalize(maps.toward(p.position)));
            // Where light grazes, triangles shadow each other as a smooth surface would not.
            if (cosine < 0.25f) continue;
            // Three texels on the surface; a point light's are up to 2/1024 of the distance wide.
            const double texel = 2.5 * size / texels;
            if (!rays.is_far_from_edges(p.position, p.normal, 3 * texel / cosine)) continue;
            const auto distance = rays.distance_to_caster(p.position);
            if (distance && *distance < 10 * texel / cosine) continue;  // it may leak there
            ++judged, dark += distance.has_value();
            for (std::size_t b = 0; b < fitted_biases.size(); ++b)
                wrong[b] += maps.visibility(fitted_biases[b], 1, p.vertices, p.position) !=
                            (distance ? 0 : 1);
        }
        // Where a surface is hollow, as between the body and the spout, a triangle's plane lies
        // behind its neighbours: of a thousand shadow tests one or two are a ninth too dark.
        for (std::size_t b = 0; b < fitted_biases.size(); ++b)
            EXPECT_LE(wrong[b], judged / 500)
                << "shadow tests that are not what a ray finds, of " << judged << "; "
                << name_of(kind) << ", " << name_of(fitted_biases[b]);
        EXPECT_GT(judged, 2000) << name_of(kind);
        EXPECT_GT(dark, 200) << name_of(kind);
    }
}

TEST(ShadowMaps, HardCase_ALightInsideAMesh) {
    look_up("Eq. 9.5");
    // A point light and a spotlight in a chest in a room, or of these the floors: that of the chest
    // is lit, that of the room is dark.
    const std::array floors = {plate(vec3(-1), 2), plate(vec3(-4), 8)};
    const Vertices chest = vertices_in(floors[0], floors[0].triangles[0]),
                   room = vertices_in(floors[1], floors[1].triangles[0]);
    Light spot = point_light({0.2f, 0.1f, -0.3f});
    spot.kind = LightKind::spot, spot.direction_world = {0, -1, 0}, spot.cos_outer = 0.6f;
    for (const Light& light : {point_light({0.2f, 0.1f, -0.3f}), spot}) {
        const LightMaps maps(light, floors, 256, {vec3(-4), vec3(4)});
        for (int i = 0; i < 20 * 20; ++i) {
            const vec3 eye = light.position_world;
            const vec3 in_chest(0.095f * vec3(i % 20 - 10, 0, i / 20 - 10) - vec3(0, 1, 0));
            // Farther along the same ray, through the chest's floor.
            const vec3 in_room = eye + (4 + eye.y) / (1 + eye.y) * (in_chest - eye);
            if (std::max(std::abs(in_room.x), std::abs(in_room.z)) > 3.9f) continue;
            for (const Bias bias : fitted_biases) {
                const std::string where = std::string(name_of(light.kind)) + ", " + name_of(bias);
                ASSERT_EQ(maps.visibility(bias, 1, chest, in_chest), 1)
                    << "in the chest, at " << testing::PrintToString(in_chest) << "; " << where;
                ASSERT_EQ(maps.visibility(bias, 1, room, in_room), 0)
                    << "below it, at " << testing::PrintToString(in_room) << "; " << where;
            }
        }
    }
}

TEST(ShadowMaps, HardCase_SpecialNumbersAtTheEntry) {
    look_up("Eq. 9.7");
    SpecialNumbers special(7);
    int with_maps = 0;
    for (int i = 0; i < 20000; ++i) {
        Light light{light_kinds[special.below(3)], vec3(1), unit_or(special.place(), vec3(0, 1, 0)),
                    special.place()};
        const vec3 cosines = special.place();
        light.cos_inner = std::clamp(cosines.x, -0.9f, 1.0f);
        light.cos_outer =
            std::clamp(light.cos_inner - std::abs(cosines.y), -1.0f, light.cos_inner - 1e-6f);
        const vec3 a = special.any_three(), b = special.any_three(), c = special.any_three();
        const Mesh mesh = mesh_of({a, b, c}, {{0, 1, 2}});
        const LightMaps maps(light, std::span(&mesh, 1), 16);
        if (maps.maps.empty()) continue;
        ++with_maps;
        for (const ShadowMap& map : maps.maps)
            for (const float depth : map.depths.depths().pixels())
                ASSERT_TRUE(depth >= 0 && depth <= 1) << "seed 7, case " << i << ": " << depth;
        for (const Bias bias : all_biases) {
            const float visibility = maps.visibility(bias, static_cast<int>(special.below(4)),
                                                     {a, b, c}, special.any_three());
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
        // A power of two loses no digits; near the ends of the range of float, some are lost.
        for (const float scale : {0x1p20f, 0x1p-20f})
            EXPECT_TRUE(have_the_same_bits(picture_of(scale), picture))
                << name_of(kind) << ", scale " << scale;
        for (const float scale : {1e-30f, 1e15f}) {
            const Image<vec3> other = picture_of(scale);
            int differing = 0;
            for (std::size_t i = 0; i < picture.pixels().size(); ++i) {
                const vec3 by = glm::abs(picture.pixels()[i] - other.pixels()[i]);
                differing += !glm::all(glm::lessThanEqual(by, vec3(0.05f)));  // also not a number
            }
            EXPECT_LT(differing, 60) << name_of(kind) << ", scale " << scale;  // at edges
        }
    }
}

TEST(ShadowMaps, HardCase_TheSmallestAndTheLargestShadowMap) {
    look_up("Eq. 9.5");
    const std::string out = (fresh_folder("shadow_size") / "picture.bmp").string();
    for (const char* const texels : {"16", "15", "8193"}) {
        const ProcessResult run = run_program(
            "09_shadow_maps", {"--size", "32x18", "--shadow-size", texels, "--out", out});
        EXPECT_EQ(run.exit_status == 0, std::string_view(texels) == "16")
            << "--shadow-size " << texels << ": 16 to 8192 texels a side are right";
    }
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
