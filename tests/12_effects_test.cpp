// SPDX-License-Identifier: MIT
// The plan of a scene, shader permutations, and that nothing else would change a bit.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "10_threading/thread_pool.hpp"
#include "12_effects/explain.hpp"
#include "12_effects/permutation.hpp"
#include "12_effects/planned_scene.hpp"
#include "common/image/backdrop.hpp"
#include "common/image/bmp.hpp"
#include "support/any_scene.hpp"
#include "support/first_difference.hpp"
#include "support/golden.hpp"
#include "support/lesson_11.hpp"
#include "support/lesson_12.hpp"
#include "support/lesson_process.hpp"
#include "support/look_up.hpp"
#include "support/pictures.hpp"
#include "support/printers.hpp"
#include "support/squares.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr std::array scenes = {"unlit.glb", "textured.gltf", "bumpy.glb", "toon.glb"};

EffectsOptions small_picture(ivec2 size = {160, 90}) {
    EffectsOptions options;
    options.size = size;
    options.shadow.size = 128;
    options.threads.tile = 16;
    return options;
}

Drawn drawn(Scene scene, const EffectsOptions& options) {
    return test::drawn(options, load_planned_scene(std::move(scene), options),
                       [](const auto& of, const auto& assets) {
                           ThreadPool pool(2);
                           StepClock clock;
                           return lesson_12::render(of, assets, pool, clock);
                       });
}

/// Work of effects.
const std::map<Effect, std::vector<Counter>> work_of = {
    {Effect::light, {Counter::fragments_lit}},
    {Effect::highlight, {Counter::highlights}},
    {Effect::texture, {Counter::texture_samples}},
    {Effect::vertex_colors, {Counter::colored_fragments}},
    {Effect::normal_map, {Counter::normal_map_samples, Counter::meshes_with_tangents}},
    {Effect::shadow, {Counter::shadow_passes, Counter::shadow_fragments, Counter::shadow_tests}},
    {Effect::toon, {Counter::toon_fragments}},
    {Effect::mask, {Counter::alpha_tested_fragments}},
    {Effect::blend, {Counter::blended_fragments}}};

/// For EXPECT_TRUE: a picture of a scene keeps its bits with --all-effects.
testing::AssertionResult keeps_its_bits_with_all_effects(const Scene& scene,
                                                         EffectsOptions options) {
    const Image<vec3> plain = drawn(scene, options).picture;
    options.shading.all_effects = true;
    return have_the_same_bits(drawn(scene, options).picture, plain)
           << ", with --all-effects, beside without";
}

}  // namespace

TEST(Effects, Eq12_1_APaintedWallCallsForLightAlone) {
    Material wall;
    wall.diffuse = vec3(1), wall.illumination = 1;
    const MaterialPlan plan = plan_material(wall, {});
    for (std::size_t e = 0; e < effect_count; ++e)
        EXPECT_EQ(plan[static_cast<Effect>(e)], e == static_cast<std::size_t>(Effect::light))
            << effect_names[e] << ": " << plan.why_not[e];
    EXPECT_EQ(plan.why_not[static_cast<std::size_t>(Effect::highlight)], "illum 1");
    EXPECT_EQ(plan.why_not[static_cast<std::size_t>(Effect::light)], "");
}

TEST(Effects, Eq12_1_EachEffectIsPlannedWhereItIsCalledFor) {
    const auto plan_of = [](auto&& change) {
        Material material;
        material.illumination = 2, material.specular = vec3(1);
        PlanInputs inputs{.has_colors = true, .has_shadows = true, .has_normal_maps = true};
        for (const Effect effect : {Effect::highlight, Effect::texture, Effect::specular_map,
                                    Effect::emission_map, Effect::normal_map})
            inputs.has.set(effect);
        change(material, inputs);
        std::string words;
        const MaterialPlan plan = plan_material(material, inputs);
        for (std::size_t e = 0; e < effect_count; ++e)
            if (plan[static_cast<Effect>(e)]) words += std::string(effect_names[e]) + ", ";
        return words;
    };
    EXPECT_EQ(plan_of([](Material&, PlanInputs&) {}),
              "light, highlight, texture, specular map, emission map, vertex colours, normal map, "
              "shadow, ");
    EXPECT_EQ(plan_of([](Material& material, PlanInputs&) { material.illumination = 0; }),
              "texture, emission map, vertex colours, ")
        << "an unlit material";
    EXPECT_EQ(plan_of([](Material& material, PlanInputs&) {
                  material.toon =
                      ToonMaterial{.outline = ToonMaterial::Outline::world, .outline_width = 1};
              }),
              "texture, emission map, vertex colours, normal map, shadow, toon, outline, ")
        << "a toon material";
    EXPECT_EQ(plan_of([](Material& material, PlanInputs& inputs) {
                  material.alpha = AlphaMode::mask, material.opacity = 0.5f;
                  inputs.has_shadows = inputs.has_colors = false;
              }),
              "light, highlight, texture, specular map, emission map, normal map, mask, ")
        << "a material with holes";
    EXPECT_EQ(plan_of([](Material& material, PlanInputs& inputs) {
                  material.opacity = 0.5f, inputs.has = {};
              }),
              "light, vertex colours, shadow, blend, ")
        << "glass";
}

TEST(Effects, Eq12_2_EachSetOfEffectsHasAPermutationWithAllOfThem) {
    std::set<std::size_t> used;
    for (unsigned bits = 0; bits < 1u << effect_count; ++bits) {
        EffectMask plan;
        for (std::size_t e = 0; e < effect_count; ++e)
            plan.set(static_cast<Effect>(e), bits >> e & 1);
        const std::size_t permutation = permutation_of(plan);
        ASSERT_LT(permutation, all_permutations.size());
        used.insert(permutation);
        const Permutation effects = all_permutations[permutation];
        const bool toon = plan[Effect::toon], light = plan[Effect::light];
        SCOPED_TRACE("called for: those with the bits " + std::to_string(bits));
        ASSERT_EQ(static_cast<int>(effects.model), static_cast<int>(toon    ? ShadingModel::toon
                                                                    : light ? ShadingModel::phong
                                                                            : ShadingModel::unlit))
            << "the shading model: that of toon materials before Phong's";
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

TEST(Effects, HardCase_MaterialsThatNoTriangleHasDoNotCount) {
    look_up("Eq. 12.2");
    for (const bool is_seen : {false, true})
        for (const bool is_toon : {false, true}) {
            ScenePlan plan{std::vector<MaterialPlan>(3)};  // the first is seen, the last a toon's
            plan.materials[0].is_seen = true, plan.materials[1].is_seen = is_seen;
            plan.materials[1].effects.set(Effect::toon, is_toon);
            plan.materials[2].effects.set(Effect::toon);
            EXPECT_EQ(plan.any(Effect::toon), is_seen && is_toon);
        }
}

TEST(Effects, HardCase_UnusedEffectsTakeNoWork) {
    look_up("Eq. 12.2");
    std::map<Effect, int> off, on;
    for (const char* name : scenes) {
        SCOPED_TRACE(name);
        const EffectsOptions options = small_picture();
        const PlannedScene assets = load_planned_scene(loaded(name), options);
        const Drawn picture = drawn(loaded(name), options);
        EXPECT_GT(picture.count(Counter::fragments_shaded), 2000u);
        for (const auto& [effect, counters] : work_of) {
            SCOPED_TRACE(effect_names[static_cast<std::size_t>(effect)]);
            // Those of toon materials are counted among the lit ones.
            const bool runs = assets.plan.any(effect) ||
                              (effect == Effect::light && assets.plan.any(Effect::toon));
            ++(runs ? on : off)[effect];
            for (const Counter counter : counters) {
                SCOPED_TRACE(counter_names[static_cast<std::size_t>(counter)]);
                EXPECT_EQ(picture.count(counter) > 0, runs);
            }
        }
        EXPECT_EQ(picture.count(Counter::outline_tests), 0u) << "an outline is a mesh here";
        std::uint64_t own_triangles = 0;
        for (const Mesh& mesh : assets.scene.meshes) own_triangles += mesh.triangles.size();
        EXPECT_EQ(picture.count(Counter::triangles_in) > own_triangles,
                  assets.plan.any(Effect::outline));
    }
    EXPECT_EQ(work_of.size() + 3, effect_count) << "and of outlines, specular and emission maps";
    for (const auto& [effect, counters] : work_of)
        EXPECT_GT(off[effect], 0) << effect_names[static_cast<std::size_t>(effect)];
    for (const Effect effect : {Effect::light, Effect::highlight, Effect::texture, Effect::toon,
                                Effect::vertex_colors, Effect::normal_map, Effect::shadow})
        EXPECT_GT(on[effect], 0) << effect_names[static_cast<std::size_t>(effect)];
}

TEST(Effects, HardCase_AllEffectsForcedGiveTheSameBits) {
    look_up("Eq. 12.2");
    for (const char* name : {"unlit.glb", "textured.gltf", "bumpy.glb", "toon.glb", "crate.obj",
                             "scene_bumpy.obj", "figure.obj"}) {
        ASSERT_TRUE(keeps_its_bits_with_all_effects(loaded(name), small_picture())) << name;
        EffectsOptions options = small_picture();
        options.shading.all_effects = true;
        const Drawn forced = drawn(loaded(name), options);
        for (const Counter counter :
             {Counter::colored_fragments, Counter::blended_fragments, Counter::texture_samples})
            EXPECT_GT(forced.count(counter), 1000u) << name;
    }
}

TEST(Effects, HardCase_AllEffectsForcedKeepHolesTransparencyAndPaper) {
    look_up("The same bits with all effects");
    // All at the same depth, in each order: the first opaque one stays, and glass is not seen.
    const std::map<std::string, void (*)(Squares&)> add = {
        {"holes",
         [](Squares& to) {
             to.add(0, vec3(0, 1, 0)).alpha = AlphaMode::mask;
             to.scene.meshes.back().colors = {vec4(1, 1, 1, 0), vec4(1), vec4(1), vec4(1, 1, 1, 0)};
         }},
        {"wall, of whose alphas none counts",
         [](Squares& to) {
             to.add(0, vec3(1, 0, 0));
             to.scene.meshes.back().colors.assign(4, vec4(1, 1, 1, 0.5f));
         }},
        {"wall seen from behind",
         [](Squares& to) {
             to.add(0, vec3(0, 0, 1)).two_sided = true;
             for (Triangle& triangle : to.scene.meshes.back().triangles)
                 std::swap(triangle.vertices[1], triangle.vertices[2]);
         }},
        {"glass", [](Squares& to) { to.add_glass(0, vec3(1, 1, 0), 0.5f); }},
        {"near glass", [](Squares& to) { to.add_glass(1, vec3(0, 1, 1), 0.25f, 1); }},
        {"comic", [](Squares& to) {
             to.add(0.5f, vec3(1), 2).toon =
                 ToonMaterial{.outline = ToonMaterial::Outline::world, .outline_width = 0.1f};
         }}};
    std::vector<std::string> order;
    for (const auto& [name, function] : add) order.push_back(name);
    int orders = 0;
    do {
        Squares squares;
        for (const std::string& name : order) add.at(name)(squares);
        ASSERT_TRUE(keeps_its_bits_with_all_effects(squares.scene, small_picture({16, 16})))
            << "; squares in the order " << testing::PrintToString(order);
        ++orders;
    } while (std::ranges::next_permutation(order).found);
    EXPECT_EQ(orders, 720);
}

TEST(Effects, HardCase_EmissionMapsGlowInAllShadingModels) {
    look_up("Eq. 12.2");
    // White on the left and black on the right, over colours that reflect nothing.
    Image<u8vec3> halves({2, 1}, {255, 255, 255});
    halves[{1, 0}] = {0, 0, 0};
    for (const ShadingModel model :
         {ShadingModel::unlit, ShadingModel::phong, ShadingModel::toon}) {
        Squares squares;
        squares.add(0, vec3(0));
        Material& material = squares.scene.materials.back();
        material.illumination = model == ShadingModel::unlit ? 0 : 1;
        if (model == ShadingModel::toon) material.toon = ToonMaterial{.shade = vec3(0)};
        material.emission = {0.5f, 2, 1};
        material.emission_map.file = "halves";
        material.emission_map.embedded =
            std::make_shared<const Bytes>(encode_bmp(halves, "halves"));
        EffectsOptions options = small_picture({16, 16});
        options.texture.filter = Filter::nearest;
        const Drawn picture = drawn(squares.scene, options);
        EXPECT_EQ((picture.picture[{4, 8}]), material.emission) << static_cast<int>(model);
        EXPECT_EQ((picture.picture[{11, 8}]), vec3(0)) << static_cast<int>(model);
        EXPECT_EQ(picture.count(Counter::texture_samples), 256u);
    }
}

TEST(Effects, HardCase_EmptyScenesAreTheBackdrop) {
    look_up("Eq. 12.2");
    Scene empty;
    empty.materials.resize(1);
    for (const bool all_effects : {false, true}) {
        EffectsOptions options = small_picture();
        options.shading.all_effects = all_effects;
        EXPECT_TRUE(is_backdrop(drawn(empty, options).picture));
        EXPECT_EQ(drawn({}, options).count(Counter::shadow_passes), 0u);
    }
}

TEST(Effects, HardCase_ThePlanIsExplained) {
    look_up("Eq. 12.2");
    const auto explained = [](const char* model) {
        return run_program("12_effects",
                           {"--model", model, "--explain", "--size", "64x36", "--shadow-size", "64",
                            "--out", (fresh_folder("explained") / "a.png").string()})
            .out;
    };
    const std::string plan = explained("bumpy.glb");
    for (const char* line :
         {"camera: 0 \"front\" of the file\n", "light: sun, a directional light\n",
          "light: lamp, a spotlight\n", "  copper: light, highlight, texture, normal map, shadow\n",
          "  tea: light, highlight, shadow\n", "normal map (names none)", "mask, blend (opaque)",
          "  toon_fragments: 0\n", "  shadow_passes: 2\n",
          "  shadow maps: ", "  triangles: ", "  picture: "})
        EXPECT_NE(plan.find(line), std::string::npos) << line << "\n" << plan;
    EXPECT_NE(explained("workshop.glb").find("mask (no holes)"), std::string::npos);
}

TEST(Effects, HardCase_ExplainNamesLightsWhereTheyAreCalledFor) {
    look_up("Eq. 12.1");
    SceneLights lit_by;
    lit_by.lights = {Light{LightKind::directional}, Light{LightKind::spot}};
    lit_by.names = {"sun", ""}, lit_by.casts = {true, false}, lit_by.exposure = 0.125f;
    ScenePlan plan{std::vector<MaterialPlan>(1)};
    plan.materials[0].is_seen = true;
    EXPECT_EQ(lights_in_words(lit_by, plan), std::vector<std::string>{"none is called for"});
    plan.materials[0].set(Effect::toon, true, "");
    EXPECT_EQ(lights_in_words(lit_by, plan),
              (std::vector<std::string>{"sun, a directional light",
                                        "unnamed, a spotlight, casts no shadow",
                                        "taken down by 8, so that the brightest is white"}));
}

TEST(Effects, PictureOfTheSceneIsLesson11sByteForByte) {
    EXPECT_TRUE(equals_golden("12_effects", "12_effects"));
}

TEST(Effects, HardCase_AnySceneIsLesson11sBitForBit) {
    look_up("Eq. 12.1 and 12.2");
    ThreadPool pool(2);
    StepClock clock;
    for (std::uint32_t seed = 0; seed < 100; ++seed) {
        const EffectsOptions options = small_picture({48, 27});
        const Image<vec3> all =
            lesson_11::render(options, load_scene_assets(any_scene(seed), options), pool);
        ASSERT_TRUE(have_the_same_bits(
            lesson_12::render(options, load_planned_scene(any_scene(seed), options), pool, clock),
            all))
            << ", beside lesson 11; seed " << seed;
    }
    for (const char* name : scenes) {
        const EffectsOptions options = small_picture();
        ASSERT_TRUE(have_the_same_bits(
            drawn(loaded(name), options).picture,
            lesson_11::render(options, load_scene_assets(loaded(name), options), pool)))
            << ", beside lesson 11; " << name;
    }
}
