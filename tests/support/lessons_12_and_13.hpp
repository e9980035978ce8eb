// SPDX-License-Identifier: MIT
/// @file
/// The same scene as lessons 12 and 13 draw it, and what their counters have to agree on.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "10_threading/thread_pool.hpp"
#include "12_effects/planned_scene.hpp"
#include "common/app/counters.hpp"
#include "common/math/functions.hpp"
#include "support/lesson_12.hpp"
#include "support/lesson_13.hpp"
#include "support/pictures.hpp"
#include "support/visible_pictures.hpp"

namespace rasterbook::test {

inline Drawn drawn_by_12(const lesson_13::Options& options, const PlannedScene& assets,
                         ThreadPool& pool) {
    return drawn(options, assets, [&](const auto& of, const auto& with) {
        StepClock clock;
        return lesson_12::render(of, with, pool, clock);
    });
}

inline Drawn drawn_by_13(const lesson_13::Options& options, const PlannedScene& assets,
                         ThreadPool& pool) {
    return drawn(options, assets, [&](const auto& of, const auto& with) {
        StepClock clock;
        return lesson_13::render(of, with, pool, clock);
    });
}

/// In how many pixels an opaque surface is visible, as lesson 12's depth buffer has it.
inline std::uint64_t opaque_pixels(lesson_13::Options options, const PlannedScene& assets,
                                   ThreadPool& pool) {
    options.show_depth = true;
    const Image<vec3> depths = drawn_by_12(options, assets, pool).picture;
    // The farthest surface is dark grey; black is what nothing covers.
    return static_cast<std::uint64_t>(
        std::ranges::count_if(depths.pixels(), [](vec3 shade) { return shade != vec3(0); }));
}

/// What is done once for each pixel that is shaded: less of it in lesson 13.
constexpr std::array counters_of_shading = {Counter::fragments_shaded,  Counter::texture_samples,
                                            Counter::fragments_lit,     Counter::highlights,
                                            Counter::toon_fragments,    Counter::normal_map_samples,
                                            Counter::colored_fragments, Counter::shadow_tests};

/// For ASSERT_TRUE: lesson 13 counts what lesson 12 counts, but for what it saves.
///
/// @param max_ids        1: it shades as often as lesson 12; unlimited_ids: each pixel once.
/// @param opaque_pixels  In which an opaque surface is visible.
inline testing::AssertionResult counts_agree(const Drawn& forward, const Drawn& visible,
                                             int max_ids, std::uint64_t opaque_pixels) {
    const auto fails = [&](Counter counter, const std::string& expected) {
        return testing::AssertionFailure()
               << counter_names[static_cast<std::size_t>(counter)] << ": " << visible.count(counter)
               << ", lesson 12 counts " << forward.count(counter) << "; expected " << expected;
    };
    for (std::size_t i = 0; i < counter_names.size(); ++i) {
        const auto counter = static_cast<Counter>(i);
        const std::uint64_t now = visible.count(counter), before = forward.count(counter);
        if (counter == Counter::shadow_parts) continue;
        const bool is_saved = counter == Counter::shadow_fragments ||
                              counter == Counter::alpha_tested_texels ||
                              (max_ids > 1 && std::ranges::find(counters_of_shading, counter) !=
                                                  counters_of_shading.end());
        if (is_saved && now > before) return fails(counter, "no more");
        if (!is_saved && now != before) return fails(counter, "the same");
    }
    const std::uint64_t once = opaque_pixels + visible.count(Counter::blended_fragments);
    const std::uint64_t shaded = visible.count(Counter::fragments_shaded);
    if (shaded < once || (max_ids == unlimited_ids && shaded > once))
        return fails(Counter::fragments_shaded,
                     std::to_string(once) + " visible surfaces and transparent fragments");
    return testing::AssertionSuccess();
}

}  // namespace rasterbook::test
