// SPDX-License-Identifier: MIT
// Lesson 11's pictures, bit by bit, of models and of random scenes, and what is counted.
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "10_threading/thread_pool.hpp"
#include "11_scenes/scene_assets.hpp"
#include "common/image/backdrop.hpp"
#include "support/any_scene.hpp"
#include "support/first_difference.hpp"
#include "support/lessons_11_and_12.hpp"
#include "support/look_up.hpp"
#include "support/name_of_split.hpp"
#include "support/names.hpp"
#include "support/pictures.hpp"
#include "support/printers.hpp"
#include "support/sanitizer.hpp"
#include "support/visible_pictures.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr std::uint32_t random_scenes = 300;

}  // namespace

TEST(VisibilityBuffer, HardCase_RandomScenesHaveLesson11sBitsAndCounts) {
    look_up("Eq. 12.1");
    const auto pool_of = pools();
    Counters forward_counters, visible_counters;
    for (std::uint32_t seed = 0; seed < random_scenes; ++seed) {
        Dice dice(seed + 1'000'000);
        auto options = any_options<lesson_12::Options>(dice);
        const std::size_t p = seed % pool_of.size();
        ThreadPool& pool = *pool_of[p];
        options.threads.show = pool.size() == 1 && dice.one_in(4);
        SceneAssets assets = make_scene_assets(any_scene(seed), options);
        add_holes(assets);
        const Drawn forward = drawn_by_11(options, assets, pool);
        const Drawn visible = drawn_by_12(options, assets, pool);
        const std::string where = in_words(options, options.visibility) +
                                  ", threads: " + std::to_string(numbers_of_threads[p]) +
                                  " (seed " + std::to_string(seed) + ")";
        ASSERT_TRUE(have_the_same_bits(visible.picture, forward.picture))
            << "beside lesson 11's picture; " << where;
        ASSERT_TRUE(counts_agree(forward, visible, options.visibility.max_ids,
                                 opaque_pixels(options, assets, pool)))
            << where;
        forward_counters += forward.counters, visible_counters += visible.counters;
    }
    const Drawn forward{{}, forward_counters}, visible{{}, visible_counters};
    expect_all_work(visible_counters, random_scenes);
    EXPECT_GT(forward.count(Counter::fragments_shaded) - visible.count(Counter::fragments_shaded),
              10u * random_scenes)
        << "the scenes have overdraw, and some of it is saved";
}

TEST(VisibilityBuffer, HardCase_ModelsHaveLesson11sBitsAndCountsWithEachOption) {
    look_up("Eq. 12.1");
    ThreadPool pool(2);
    for (const char* const name : models) {
        std::uint64_t tested = 0;
        const auto compare = [&](const lesson_12::Options& options, const SceneAssets& assets,
                                 const std::string& where) {
            const Drawn forward = drawn_by_11(options, assets, pool);
            const Drawn visible = drawn_by_12(options, assets, pool);
            ASSERT_TRUE(have_the_same_bits(visible.picture, forward.picture))
                << "beside lesson 11's picture; " << where;
            ASSERT_TRUE(counts_agree(forward, visible, options.visibility.max_ids,
                                     opaque_pixels(options, assets, pool)))
                << where;
            tested += visible.count(Counter::fragments_tested);
        };
        for_each_option<lesson_12::Options>(name, compare);
        if (HasFatalFailure()) return;
        EXPECT_GT(tested, 20'000u) << "fragments of all pictures of " << name;
    }
}

TEST(VisibilityBuffer, HardCase_AnyNumberOfThreadsGivesTheSameBitsAndCounts) {
    look_up("Eq. 12.6");
    // Which parts are drawn depends on what is asked, never on who asks first.
    const auto pool_of = pools();
    for (const char* const name : {"bumpy.glb", "toon.glb", "textured.gltf"}) {
        const Scene model = loaded(name);
        auto options = small_picture<lesson_12::Options>();
        const SceneAssets assets = make_scene_assets(model, options);
        const Drawn expected = drawn_by_12(options, assets, *pool_of[0]);
        ASSERT_GT(expected.count(Counter::shadow_parts), 8u) << name;
        for (std::size_t p = 0; p < pool_of.size(); ++p)
            for (const Split split : splits)
                for (int repeat = 0; repeat < (is_sanitized ? 1 : 2); ++repeat) {
                    options.threads.split = split;
                    options.threads.tile = 8 + 9 * repeat;
                    const Drawn actual = drawn_by_12(options, assets, *pool_of[p]);
                    const std::string where =
                        std::string(name) + ", " + std::to_string(numbers_of_threads[p]) +
                        " threads, " + name_of(split) + ", tile side " +
                        std::to_string(options.threads.tile) + ", beside one thread";
                    ASSERT_TRUE(have_the_same_bits(actual.picture, expected.picture)) << where;
                    ASSERT_TRUE(counts_are_equal(actual, expected)) << where;
                }
    }
}

TEST(VisibilityBuffer, Eq12_6_SmallerPartsHaveFewerShadowFragments) {
    // A part of 2 P texels a side is asked for if one of its four parts of P is.
    ThreadPool pool(2);
    for (const char* const name : {"bumpy.glb", "toon.glb"}) {
        auto options = small_picture<lesson_12::Options>();
        options.shadow.size = 256;
        const SceneAssets assets = make_scene_assets(loaded(name), options);
        const Drawn forward = drawn_by_11(options, assets, pool);
        std::uint64_t before = 0, parts_before = 0;
        for (const int side : {32, 64, 128, 256, 512}) {
            options.visibility.shadow_part = side;
            const Drawn visible = drawn_by_12(options, assets, pool);
            const std::uint64_t fragments = visible.count(Counter::shadow_fragments),
                                parts = visible.count(Counter::shadow_parts);
            ASSERT_GE(fragments, before) << "shadow fragments of " << name << " with parts of "
                                         << side << " texels a side, and with parts half as long";
            if (side > 32) {
                ASSERT_LE(parts, parts_before) << "parts drawn of " << name << ", " << side
                                               << " texels a side, and half as long";
                ASSERT_GE(4 * parts, parts_before) << "parts drawn of " << name << ", " << side
                                                   << " texels a side, and half as long";
            }
            if (side >= 256) {  // whole maps
                ASSERT_EQ(parts, forward.count(Counter::shadow_passes))
                    << "all maps of " << name << " are asked for something";
                ASSERT_EQ(fragments, forward.count(Counter::shadow_fragments))
                    << "shadow fragments of " << name << " with whole maps, and in lesson 11";
            }
            before = fragments, parts_before = parts;
        }
        options.visibility.shadow_part = 32;
        const Drawn visible = drawn_by_12(options, assets, pool);
        EXPECT_LT(visible.count(Counter::shadow_fragments),
                  forward.count(Counter::shadow_fragments))
            << "of " << name << ", with parts of 32 texels, something is never asked for";
        EXPECT_LT(visible.count(Counter::shadow_parts), 64 * forward.count(Counter::shadow_passes))
            << "of " << name;
    }
}

TEST(VisibilityBuffer, HardCase_WhatNobodySeesIsAskedForNothing) {
    look_up("Eq. 12.6");
    ThreadPool pool(2);
    const auto expect_no_part = [&](const Scene& scene, const lesson_12::Options& options,
                                    std::uint64_t maps, const char* what) {
        const SceneAssets assets = make_scene_assets(scene, options);
        const Drawn visible = drawn_by_12(options, assets, pool);
        EXPECT_EQ(visible.count(Counter::shadow_passes), maps) << "maps of " << what;
        EXPECT_EQ(visible.count(Counter::shadow_parts), 0u) << "parts drawn for " << what;
        EXPECT_EQ(visible.count(Counter::shadow_fragments), 0u) << what;
    };
    expect_no_part(loaded("unlit.glb"), small_picture<lesson_12::Options>(), 0, "an unlit scene");
    for (const auto& [name, maps] : {std::pair("bumpy.glb", 2u), {"toon.glb", 1u}}) {
        Scene scene = loaded(name);
        for (SceneCamera& camera : scene.cameras)
            camera.world_from_view = camera.world_from_view * rotation_y(std::numbers::pi_v<float>);
        expect_no_part(scene, small_picture<lesson_12::Options>(), maps,
                       "a camera that looks away");
    }
}

TEST(VisibilityBuffer, HardCase_EmptyMapsAreClearedWhereTheyAreAskedFor) {
    look_up("Eq. 12.6");
    // With --all-effects a lit scene without casters has maps, too: all of it is lit.
    Scene scene;
    scene.materials.resize(2);
    scene.materials[1].alpha = AlphaMode::blend, scene.materials[1].opacity = 0.5f;
    Mesh mesh;
    mesh.positions = {{-1, 0, -1}, {1, 0, -1}, {0, 0, 1}};
    mesh.triangles = {{{Vertex{0}, Vertex{2}, Vertex{1}}, 1}};
    for (const vec3 p : mesh.positions) mesh.bounds.add(p);
    scene.meshes.push_back(mesh);
    ThreadPool pool(3);
    for (const bool all_effects : {false, true}) {
        auto options = small_picture<lesson_12::Options>({32, 32});
        options.shading.all_effects = all_effects;
        const SceneAssets assets = make_scene_assets(scene, options);
        const Drawn forward = drawn_by_11(options, assets, pool);
        const Drawn visible = drawn_by_12(options, assets, pool);
        const char* const how = all_effects ? "with --all-effects" : "without --all-effects";
        EXPECT_TRUE(have_the_same_bits(visible.picture, forward.picture)) << how;
        EXPECT_GT(visible.count(Counter::fragments_lit), 50u) << how;
        EXPECT_EQ(visible.count(Counter::shadow_parts) > 0, all_effects)
            << "whether parts are drawn of maps without casters, " << how;
        EXPECT_EQ(visible.count(Counter::shadow_fragments), 0u) << how;
    }
}

TEST(VisibilityBuffer, HardCase_EmptyScenesAndPicturesOfAFewPixels) {
    look_up("Eq. 12.1");
    ThreadPool pool(3);
    Scene empty;
    empty.materials.resize(1);
    for (const bool all_effects : {false, true}) {
        auto options = small_picture<lesson_12::Options>();
        options.shading.all_effects = all_effects;
        EXPECT_TRUE(
            is_backdrop(drawn_by_12(options, make_scene_assets(empty, options), pool).picture))
            << "a scene without triangles is the backdrop";
    }
    for (const char* const name : models) {
        auto options = small_picture<lesson_12::Options>();
        options.shadow.size = 16;
        const SceneAssets assets = make_scene_assets(loaded(name), options);
        for (const ivec2 size : {ivec2(1, 1), {1, 7}, {7, 1}, {2, 2}, {3, 61}})
            for (const Split split : splits)
                for (const int tile : {1, 64}) {
                    options.size = size;
                    options.threads.split = split, options.threads.tile = tile;
                    ASSERT_TRUE(have_the_same_bits(drawn_by_12(options, assets, pool).picture,
                                                   drawn_by_11(options, assets, pool).picture))
                        << "beside lesson 11's picture; " << name << ", " << size.x << " x "
                        << size.y << ", " << name_of(split) << ", tile side " << tile;
                }
    }
}
