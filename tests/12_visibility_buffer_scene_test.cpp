// SPDX-License-Identifier: MIT
// Lesson 11's pictures, bit by bit, of models and of random scenes, and what is counted.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "10_threading/thread_pool.hpp"
#include "11_scenes/scene_assets.hpp"
#include "common/image/backdrop.hpp"
#include "support/any_scene.hpp"
#include "support/first_difference.hpp"
#include "support/lessons_11_and_12.hpp"
#include "support/light_in_words.hpp"
#include "support/look_up.hpp"
#include "support/name_of_split.hpp"
#include "support/names.hpp"
#include "support/pictures.hpp"
#include "support/printers.hpp"
#include "support/sanitizer.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr std::array models = {"unlit.glb", "textured.gltf", "bumpy.glb",
                               "toon.glb",  "floor.obj",     "figure.obj"};
constexpr std::array numbers_of_threads = {1, 2, 3, 7, 16};
constexpr std::uint32_t random_scenes = is_sanitized ? 40 : 300;

lesson_12::Options small_visible_picture(ivec2 size = {96, 54}) {
    lesson_12::Options options;
    options.size = size;
    options.shadow.size = 128;
    options.threads.tile = 16;
    options.visibility.shadow_part = 32;
    return options;
}

/// A pool for each of numbers_of_threads.
std::vector<std::unique_ptr<ThreadPool>> pools() {
    std::vector<std::unique_ptr<ThreadPool>> all;
    for (const int threads : numbers_of_threads)
        all.push_back(std::make_unique<ThreadPool>(threads));
    return all;
}

const char* filter_name(Filter filter) {
    return filter == Filter::nearest    ? "nearest"
           : filter == Filter::bilinear ? "bilinear"
                                        : "trilinear";
}

/// As a command line, but for the number of threads.
std::string in_words(const lesson_12::Options& options) {
    const auto number = [](const char* name, int value) {
        return std::string(" ") + name + " " + std::to_string(value);
    };
    std::string words = "a picture of " + std::to_string(options.size.x) + " x " +
                        std::to_string(options.size.y) + ",";
    words += number("--max-ids", options.visibility.max_ids);
    words += number("--shadow-part", options.visibility.shadow_part);
    words += number("--shadow-size", options.shadow.size) + number("--pcf", options.shadow.pcf);
    words += number("--tile", options.threads.tile);
    words += std::string(", ") + name_of(options.shadow.bias) + ", " +
             name_of(options.threads.split) + ", filter " + filter_name(options.texture.filter) +
             ", key light " + name_of(options.shading.key_light);
    if (options.shading.two_sided) words += ", back faces";
    if (options.shading.all_effects) words += ", --all-effects";
    if (options.normal_map.space == MapSpace::none) words += ", no normal maps";
    if (options.show_depth) words += ", --depth";
    if (options.threads.show) words += ", --show-threads";
    return words;
}

lesson_12::Options any_options(Dice& dice) {
    constexpr std::array filters = {Filter::nearest, Filter::bilinear, Filter::trilinear};
    constexpr std::array biases = {Bias::none, Bias::constant, Bias::slope, Bias::plane,
                                   Bias::normal};
    constexpr std::array ids = {1, 2, 3, 7, unlimited_ids, unlimited_ids};
    constexpr std::array parts = {5, 16, 32, 64, 512};
    lesson_12::Options options;
    options.size = {1 + dice.below(60), 1 + dice.below(40)};
    options.texture.filter = filters[dice.below(3)];
    options.shadow.size = 16 + static_cast<int>(dice.below(100));
    options.shadow.pcf = 1 + 2 * static_cast<int>(dice.below(4));
    options.shadow.bias = biases[dice.below(5)];
    options.shading.two_sided = dice.one_in(4);
    options.shading.all_effects = dice.one_in(4);
    if (dice.one_in(5)) options.normal_map.space = MapSpace::none;
    options.show_depth = dice.one_in(8);
    options.threads.split = splits[dice.below(3)];
    options.threads.tile = 1 + static_cast<int>(dice.below(40));
    options.visibility.max_ids = ids[dice.below(6)];
    options.visibility.shadow_part = parts[dice.below(5)];
    return options;
}

}  // namespace

TEST(VisibilityBuffer, HardCase_RandomScenesHaveLesson11sBitsAndCounts) {
    look_up("Eq. 12.1");
    const auto pool_of = pools();
    Counters forward_counters, visible_counters;
    for (std::uint32_t seed = 0; seed < random_scenes; ++seed) {
        Dice dice(seed + 1'000'000);
        lesson_12::Options options = any_options(dice);
        const std::size_t p = seed % pool_of.size();
        ThreadPool& pool = *pool_of[p];
        options.threads.show = pool.size() == 1 && dice.one_in(4);
        SceneAssets assets = make_scene_assets(any_scene(seed), options);
        add_holes(assets);
        const Drawn forward = drawn_by_11(options, assets, pool);
        const Drawn visible = drawn_by_12(options, assets, pool);
        const std::string where = in_words(options) +
                                  ", threads: " + std::to_string(numbers_of_threads[p]) +
                                  " (seed " + std::to_string(seed) + ")";
        ASSERT_TRUE(have_the_same_bits(visible.picture, forward.picture))
            << "beside lesson 11's picture; " << where;
        ASSERT_TRUE(counts_agree(forward, visible, options.visibility.max_ids,
                                 opaque_pixels(options, assets, pool)))
            << where;
        forward_counters.add(forward.counters), visible_counters.add(visible.counters);
    }
    const Drawn forward{{}, forward_counters}, visible{{}, visible_counters};
    for (const Counter counter :
         {Counter::fragments_shaded, Counter::texture_samples, Counter::fragments_lit,
          Counter::highlights, Counter::toon_fragments, Counter::normal_map_samples,
          Counter::colored_fragments, Counter::alpha_tested_fragments, Counter::blended_fragments,
          Counter::shadow_tests, Counter::shadow_fragments})
        EXPECT_GT(visible.count(counter), 20u * random_scenes)
            << counter_names[static_cast<std::size_t>(counter)] << " of all scenes";
    EXPECT_GT(visible.count(Counter::shadow_parts), random_scenes);
    EXPECT_GT(forward.count(Counter::fragments_shaded) - visible.count(Counter::fragments_shaded),
              10u * random_scenes)
        << "the scenes have overdraw, and some of it is saved";
}

TEST(VisibilityBuffer, HardCase_ModelsHaveLesson11sBitsAndCountsWithEachOption) {
    look_up("Eq. 12.1");
    struct Knob {
        const char* name;
        void (*turn)(lesson_12::Options&);
        bool changes_assets = false;
    };
    constexpr std::array knobs = {
        Knob{"no option", [](auto&) {}},
        Knob{"--max-ids 1", [](auto& o) { o.visibility.max_ids = 1; }},
        Knob{"--max-ids 2", [](auto& o) { o.visibility.max_ids = 2; }},
        Knob{"--max-ids 7", [](auto& o) { o.visibility.max_ids = 7; }},
        Knob{"--max-ids 1 --shadow-part 128 --split rows",
             [](auto& o) {
                 o.visibility.max_ids = 1, o.visibility.shadow_part = 128;
                 o.threads.split = Split::rows;
             }},
        Knob{"--shadow-part 512", [](auto& o) { o.visibility.shadow_part = 512; }},
        Knob{"--shadow-size 97 --pcf 7 --bias plane",
             [](auto& o) { o.shadow.size = 97, o.shadow.pcf = 7, o.shadow.bias = Bias::plane; },
             true},
        Knob{"--pcf 1 --bias none", [](auto& o) { o.shadow.pcf = 1, o.shadow.bias = Bias::none; }},
        Knob{"--bias normal", [](auto& o) { o.shadow.bias = Bias::normal; }},
        Knob{"--filter nearest", [](auto& o) { o.texture.filter = Filter::nearest; }},
        Knob{"--normal-map none", [](auto& o) { o.normal_map.space = MapSpace::none; }, true},
        Knob{"--light point", [](auto& o) { o.shading.key_light = LightKind::point; }, true},
        Knob{"--light spot", [](auto& o) { o.shading.key_light = LightKind::spot; }, true},
        Knob{"back faces", [](auto& o) { o.shading.two_sided = true; }, true},
        Knob{"--all-effects", [](auto& o) { o.shading.all_effects = true; }, true},
        Knob{"--all-effects --max-ids 1",
             [](auto& o) { o.shading.all_effects = true, o.visibility.max_ids = 1; }, true},
        Knob{"--split interleaved", [](auto& o) { o.threads.split = Split::interleaved; }},
        Knob{"--tile 64", [](auto& o) { o.threads.tile = 64; }},
        Knob{"--depth", [](auto& o) { o.show_depth = true; }},
        Knob{"a camera so near that much is clipped",
             [](auto& o) { o.scene.camera = "orbit", o.orbit.distance = 0.15f; }},
        Knob{"a camera below the floor",
             [](auto& o) { o.scene.camera = "orbit", o.orbit.pitch_degrees = -60; }}};
    ThreadPool pool(2);
    for (const char* const name : models) {
        const Scene model = loaded(name);
        const SceneAssets usual_assets = make_scene_assets(model, small_visible_picture());
        std::uint64_t tested = 0;
        for (const Knob& knob : knobs) {
            lesson_12::Options options = small_visible_picture();
            knob.turn(options);
            std::optional<SceneAssets> own_assets;
            if (knob.changes_assets) own_assets.emplace(make_scene_assets(model, options));
            const SceneAssets& assets = own_assets ? *own_assets : usual_assets;
            const Drawn forward = drawn_by_11(options, assets, pool);
            const Drawn visible = drawn_by_12(options, assets, pool);
            ASSERT_TRUE(have_the_same_bits(visible.picture, forward.picture))
                << "beside lesson 11's picture; " << name << " with " << knob.name;
            ASSERT_TRUE(counts_agree(forward, visible, options.visibility.max_ids,
                                     opaque_pixels(options, assets, pool)))
                << name << " with " << knob.name;
            tested += visible.count(Counter::fragments_tested);
        }
        EXPECT_GT(tested, 1000 * knobs.size()) << "fragments of all pictures of " << name;
    }
}

TEST(VisibilityBuffer, HardCase_AnyNumberOfThreadsGivesTheSameBitsAndCounts) {
    look_up("Eq. 12.6");
    // Which parts are drawn depends on what is asked, never on who asks first.
    const auto pool_of = pools();
    for (const char* const name : {"bumpy.glb", "toon.glb", "textured.gltf"}) {
        const Scene model = loaded(name);
        lesson_12::Options options = small_visible_picture();
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
                    for (std::size_t i = 0; i < counter_names.size(); ++i)
                        ASSERT_EQ(actual.counters.values[i], expected.counters.values[i])
                            << "the counter " << counter_names[i] << "; " << where;
                }
    }
}

TEST(VisibilityBuffer, Eq12_6_SmallerPartsHaveFewerShadowFragments) {
    // A part of 2 P texels a side is asked for if one of its four parts of P is.
    ThreadPool pool(2);
    for (const char* const name : {"bumpy.glb", "toon.glb"}) {
        lesson_12::Options options = small_visible_picture();
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
    expect_no_part(loaded("unlit.glb"), small_visible_picture(), 0, "an unlit scene");
    for (const auto& [name, maps] : {std::pair("bumpy.glb", 2u), {"toon.glb", 1u}}) {
        Scene scene = loaded(name);
        for (SceneCamera& camera : scene.cameras)
            camera.world_from_view = camera.world_from_view * rotation_y(std::numbers::pi_v<float>);
        expect_no_part(scene, small_visible_picture(), maps, "a camera that looks away");
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
        lesson_12::Options options = small_visible_picture({32, 32});
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
        lesson_12::Options options = small_visible_picture();
        options.shading.all_effects = all_effects;
        EXPECT_TRUE(
            is_backdrop(drawn_by_12(options, make_scene_assets(empty, options), pool).picture))
            << "a scene without triangles is the backdrop";
    }
    for (const char* const name : models) {
        lesson_12::Options options = small_visible_picture();
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
