// SPDX-License-Identifier: MIT
/// @file
/// What lessons 13 and 14 are asked to draw, each beside the lesson before it: models, options and
/// numbers of threads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "10_threading/thread_pool.hpp"
#include "12_effects/effects_options.hpp"
#include "12_effects/planned_scene.hpp"
#include "13_visibility_buffer/visibility_options.hpp"
#include "common/app/counters.hpp"
#include "support/any_scene.hpp"
#include "support/name_of_split.hpp"
#include "support/names.hpp"
#include "support/pictures.hpp"
#include "support/texture_names.hpp"

namespace rasterbook::test {

inline constexpr std::array models = {"unlit.glb", "textured.gltf", "bumpy.glb",
                                      "toon.glb",  "floor.obj",     "figure.obj"};
inline constexpr std::array numbers_of_threads = {1, 2, 3, 7, 16};
constexpr int unlimited_ids = std::numeric_limits<int>::max();

/// A pool for each of numbers_of_threads.
inline std::vector<std::unique_ptr<ThreadPool>> pools() {
    std::vector<std::unique_ptr<ThreadPool>> all;
    for (const int threads : numbers_of_threads)
        all.push_back(std::make_unique<ThreadPool>(threads));
    return all;
}

/// @tparam Options  Those of lesson 13 or 14.
template <typename Options>
Options small_picture(ivec2 size = {96, 54}) {
    Options options;
    options.size = size;
    options.shadow.size = 128;
    options.threads.tile = 16;
    options.visibility.shadow_part = 32;
    return options;
}

/// For random scenes.
template <typename Options>
Options any_options(Dice& dice) {
    constexpr std::array ids = {1, 2, 3, 7, unlimited_ids, unlimited_ids};
    constexpr std::array parts = {5, 16, 32, 64, 512};
    Options options;
    // Some triangles are wider than 100 pixels.
    options.size = dice.one_in(4) ? ivec2(100 + dice.below(80), 1 + dice.below(20))
                                  : ivec2(1 + dice.below(60), 1 + dice.below(40));
    options.texture.filter = all_filters[dice.below(3)];
    options.shadow.size = 16 + static_cast<int>(dice.below(100));
    options.shadow.pcf = 1 + 2 * static_cast<int>(dice.below(4));
    options.shadow.bias = all_biases[dice.below(5)];
    options.shading.two_sided = dice.one_in(4);
    options.shading.all_effects = dice.one_in(4);
    if (dice.one_in(5)) options.normal_map.space = MapSpace::none;
    options.show_depth = dice.one_in(8);
    options.threads.split = splits[dice.below(3)];
    options.threads.tile = 1 + static_cast<int>(dice.below(dice.one_in(3) ? 100 : 40));
    options.visibility.max_ids = ids[dice.below(6)];
    options.visibility.shadow_part = parts[dice.below(5)];
    return options;
}

/// The least that tells what a picture of random options is; the seed tells the rest.
inline std::string in_words(const EffectsOptions& options, const VisibilityOptions& visibility) {
    return "a picture of " + std::to_string(options.size.x) + " x " +
           std::to_string(options.size.y) + ", --max-ids " + std::to_string(visibility.max_ids) +
           " --shadow-part " + std::to_string(visibility.shadow_part) + " --shadow-size " +
           std::to_string(options.shadow.size) + " --tile " + std::to_string(options.threads.tile) +
           ", " + name_of(options.threads.split) +
           (options.shading.all_effects ? ", --all-effects" : "") +
           (options.show_depth ? ", --depth" : "");
}

/// So many random scenes ask for all kinds of work, and often.
inline void expect_all_work(const Counters& counters, std::uint64_t scenes) {
    for (const Counter counter :
         {Counter::fragments_shaded, Counter::texture_samples, Counter::fragments_lit,
          Counter::highlights, Counter::toon_fragments, Counter::normal_map_samples,
          Counter::colored_fragments, Counter::alpha_tested_fragments, Counter::blended_fragments,
          Counter::shadow_tests, Counter::shadow_fragments, Counter::alpha_tested_texels})
        EXPECT_GT(counters[counter], 20 * scenes)
            << counter_names[static_cast<std::size_t>(counter)] << " of all scenes";
    EXPECT_GT(counters[Counter::shadow_parts], scenes);
}

/// For ASSERT_TRUE: the same work was counted.
inline testing::AssertionResult counts_are_equal(const Drawn& actual, const Drawn& expected) {
    for (std::size_t i = 0; i < counter_names.size(); ++i)
        if (actual.counters.values[i] != expected.counters.values[i])
            return testing::AssertionFailure()
                   << "the counter " << counter_names[i] << " says " << actual.counters.values[i]
                   << ", expected " << expected.counters.values[i];
    return testing::AssertionSuccess();
}

/// A change of options.
template <typename Options>
struct OptionCase {
    const char* name;
    void (*turn)(Options&);
    bool changes_assets = false;
};

template <typename Options>
constexpr auto option_cases = std::to_array<OptionCase<Options>>({
    {"no option", [](auto&) {}},
    {"--max-ids 7", [](auto& o) { o.visibility.max_ids = 7; }},
    {"--max-ids 1 --shadow-part 128 --split rows",
     [](auto& o) {
         o.visibility.max_ids = 1, o.visibility.shadow_part = 128;
         o.threads.split = Split::rows;
     }},
    {"--shadow-part 512 --tile 64",
     [](auto& o) { o.visibility.shadow_part = 512, o.threads.tile = 64; }},
    {"--shadow-size 97 --pcf 7 --bias plane",
     [](auto& o) { o.shadow.size = 97, o.shadow.pcf = 7, o.shadow.bias = Bias::plane; }, true},
    {"--pcf 5 --bias normal", [](auto& o) { o.shadow.pcf = 5, o.shadow.bias = Bias::normal; }},
    {"--filter nearest --split interleaved",
     [](auto& o) { o.texture.filter = Filter::nearest, o.threads.split = Split::interleaved; }},
    {"--filter bilinear --split rows",
     [](auto& o) { o.texture.filter = Filter::bilinear, o.threads.split = Split::rows; }},
    {"--normal-map none", [](auto& o) { o.normal_map.space = MapSpace::none; }, true},
    {"--light point", [](auto& o) { o.shading.key_light = LightKind::point; }, true},
    {"--light spot", [](auto& o) { o.shading.key_light = LightKind::spot; }, true},
    {"back faces", [](auto& o) { o.shading.two_sided = true; }, true},
    {"--all-effects --max-ids 1",
     [](auto& o) { o.shading.all_effects = true, o.visibility.max_ids = 1; }, true},
    {"--depth", [](auto& o) { o.show_depth = true; }},
    {"a camera so near that much is clipped",
     [](auto& o) { o.camera = "orbit", o.orbit.distance = 0.15f; }},
    {"a camera below the floor", [](auto& o) { o.camera = "orbit", o.orbit.pitch_degrees = -60; }},
});

/// Calls compare(options, assets, where) for a small picture of a model with each of the options.
template <typename Options, typename Compare>
void for_each_option(const std::string& model, Compare&& compare) {
    const Scene scene = loaded(model);
    const PlannedScene usual_assets = load_planned_scene(scene, small_picture<Options>());
    for (const OptionCase<Options>& one : option_cases<Options>) {
        auto options = small_picture<Options>();
        one.turn(options);
        std::optional<PlannedScene> own_assets;
        if (one.changes_assets) own_assets.emplace(load_planned_scene(scene, options));
        compare(options, own_assets ? *own_assets : usual_assets, model + " with " + one.name);
        if (testing::Test::HasFatalFailure()) return;
    }
}

}  // namespace rasterbook::test
