// SPDX-License-Identifier: MIT
// Lesson 13's pictures and counters at each width, bit by bit, of models and of random scenes; and
// the pictures.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "10_threading/thread_pool.hpp"
#include "12_effects/planned_scene.hpp"
#include "14_simd/simd.hpp"
#include "common/image/backdrop.hpp"
#include "support/any_scene.hpp"
#include "support/first_difference.hpp"
#include "support/golden.hpp"
#include "support/lesson_process.hpp"
#include "support/lessons_13_and_14.hpp"
#include "support/look_up.hpp"
#include "support/name_of_split.hpp"
#include "support/pictures.hpp"
#include "support/printers.hpp"
#include "support/sanitizer.hpp"
#include "support/visible_pictures.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr std::array widths = {1, 4, 8, 16};
#ifdef RASTERBOOK_MINE
const std::string with_each_width = "14_simd_complete";
#else
const std::string with_each_width = "14_simd";
#endif
constexpr std::uint32_t random_scenes = is_sanitized ? 40 : 400;

std::string in_words(const lesson_14::Options& options) {
    return rasterbook::test::in_words(options, options.visibility) + ", --width " +
           std::to_string(options.wide.width);
}

/// For ASSERT_TRUE: with some widths, lesson 14's picture and counters are those of lesson 13.
///
/// @param expected  As lesson 13 draws it.
testing::AssertionResult is_lesson_12s(const Drawn& expected, lesson_14::Options options,
                                       const PlannedScene& assets, ThreadPool& pool,
                                       std::span<const int> some_widths) {
    for (const int width : some_widths) {
        options.wide.width = width;
        const Drawn actual = drawn_by_14(options, assets, pool);
        testing::AssertionResult agree = have_the_same_bits(actual.picture, expected.picture);
        if (agree) agree = counts_are_equal(actual, expected);
        if (!agree)
            return agree << "; beside lesson 13's picture; " << in_words(options)
                         << ", threads: " << pool.size();
    }
    return testing::AssertionSuccess();
}

}  // namespace

TEST(Simd, HardCase_RandomScenesHaveLesson13sBitsAndCounts) {
    look_up("Eq. 14.1");
    const auto pool_of = pools();
    Counters all;
    for (std::uint32_t seed = 0; seed < random_scenes; ++seed) {
        Dice dice(seed + 2'000'000);
        auto options = any_options<lesson_14::Options>(dice);
        constexpr std::array shows = {Show::ids, Show::shading, Show::shadow_map};
        if (dice.one_in(8)) options.visibility.show = shows[dice.below(3)];
        ThreadPool& pool = *pool_of[seed % pool_of.size()];
        options.threads.show = pool.size() == 1 && dice.one_in(4);
        PlannedScene assets = load_planned_scene(any_scene(seed + 5000), options);
        add_holes(assets);
        const Drawn expected = drawn_by_13(options, assets, pool);
        ASSERT_TRUE(is_lesson_12s(expected, options, assets, pool, widths)) << "seed " << seed;
        all += expected.counters;
    }
    expect_all_work(all, random_scenes);
}

TEST(Simd, HardCase_FlatMaterialsHaveLesson13sBitsAndCounts) {
    look_up("Several triangles in a batch");
    ThreadPool pool(2);
    std::uint64_t shaded = 0;
    for (std::uint32_t seed = 0; seed < random_scenes; ++seed) {
        Dice dice(seed + 3'000'000);
        auto options = any_options<lesson_14::Options>(dice);
        Scene scene = any_scene(seed + 7000);
        for (Mesh& mesh : scene.meshes)
            if (!dice.one_in(4)) mesh.colors.clear();
        // All materials, or all but one.
        const std::size_t own = dice.below(2 * static_cast<std::uint32_t>(scene.materials.size()));
        for (std::size_t i = 0; i < scene.materials.size(); ++i)
            if (i != own) {
                Material& flat = scene.materials[i] = Material();
                flat.illumination = 0, flat.diffuse = dice.color(), flat.two_sided = true;
            }
        const PlannedScene assets = load_planned_scene(std::move(scene), options);
        const Drawn expected = drawn_by_13(options, assets, pool);
        ASSERT_TRUE(is_lesson_12s(expected, options, assets, pool, widths)) << "seed " << seed;
        shaded += expected.count(Counter::fragments_shaded);
    }
    EXPECT_GT(shaded, 100u * random_scenes) << "pixels of all pictures";
}

TEST(Simd, HardCase_ModelsHaveLesson13sBitsAndCountsWithEachOption) {
    look_up("Eq. 14.1");
    ThreadPool pool(2);
    std::size_t next = 0;
    for (const char* const name : models)
        for_each_option<lesson_14::Options>(
            name,
            [&](lesson_14::Options options, const PlannedScene& assets, const std::string& where) {
                // Two widths of four, in turn; where a sanitizer watches, one.
                const std::array some = {widths[next % 4], widths[(next + 1) % 4]};
                next += is_sanitized ? 1 : 3;
                ASSERT_TRUE(is_lesson_12s(drawn_by_13(options, assets, pool), options, assets, pool,
                                          std::span(some).first(is_sanitized ? 1 : 2)))
                    << where;
            });
}

TEST(Simd, HardCase_EmptyScenesAndPicturesOfAFewPixels) {
    look_up("Eq. 14.2");
    ThreadPool pool(3);
    Scene empty;
    empty.materials.resize(1);
    for (const bool all_effects : {false, true})
        for (const int width : widths) {
            auto options = small_picture<lesson_14::Options>();
            options.shading.all_effects = all_effects;
            options.wide.width = width;
            EXPECT_TRUE(
                is_backdrop(drawn_by_14(options, load_planned_scene(empty, options), pool).picture))
                << "a scene without triangles is the backdrop, --width " << width;
        }
    std::size_t combinations = 0;
    for (const char* const name : models) {
        auto options = small_picture<lesson_14::Options>();
        options.shadow.size = 16;
        const PlannedScene assets = load_planned_scene(loaded(name), options);
        for (const ivec2 size : {ivec2(1, 1), {1, 7}, {7, 1}, {17, 2}, {3, 61}})
            for (const Split split : splits)
                for (const int tile : {1, 64}) {
                    // Every fifth has each split with each tile.
                    if (is_sanitized && combinations++ % 5 != 0) continue;
                    options.size = size;
                    options.threads.split = split, options.threads.tile = tile;
                    ASSERT_TRUE(is_lesson_12s(drawn_by_13(options, assets, pool), options, assets,
                                              pool, std::span(widths).subspan(1)))
                        << name;
                }
    }
}

TEST(Simd, HardCase_EachWidthHasFunctionsOfItsOwn) {
    look_up("Eq. 14.4");
    for (const int width : widths)
        for (const int other : widths)
            EXPECT_EQ(drawing_of_width(width).draw_id == drawing_of_width(other).draw_id,
                      width == other)
                << "whether --width " << width << " and --width " << other
                << " draw ids by the same function";
    EXPECT_EQ(lesson_14::Options().wide.width, native_width);
}

TEST(Simd, HardCase_InvalidWidthsAreAnErrorInOneLine) {
    look_up("Eq. 14.4");
    const auto run = [](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"--size", "32x18", "--shadow-size", "64", "--out",
                                           (fresh_folder("simd_options") / "a.png").string()});
        return run_program(with_each_width, arguments);
    };
    for (const char* const width : {"0", "2", "12", "32", "-4", "wide"})
        expect_error(run({"--width", width}), 2, "--width");
    expect_error(run({"--max-ids", "0"}), 2, "--max-ids");
    const ProcessResult explained = run({"--width", "8", "--explain"});
    ASSERT_EQ(explained.exit_status, 0) << explained.err;
    for (const char* line : {"  casters: ", "  triangles: ", "  picture: ", "  shadow_parts: "})
        EXPECT_NE(explained.out.find(line), std::string::npos)
            << "--explain has no line \"" << line << "\":\n"
            << explained.out;
}

TEST(Simd, HardCase_PicturesAreLesson12sWithEachWidth) {
    look_up("Eq. 14.1");
    const std::string expected = bytes_of_picture("12_effects", {"--size", golden_size});
    ASSERT_GT(expected.size(), 100000u);
    for (const char* const width : {"1", "4", "8", "16"})
        EXPECT_TRUE(bytes_of_picture(with_each_width, {"--size", golden_size, "--width", width}) ==
                    expected)
            << "the picture is not 12_effects.png with --width " << width;
}

TEST(Simd, PictureOfToon) {
    EXPECT_TRUE(
        equals_golden("14_simd", "11_scenes_toon", {"--model", "toon.glb", "--samples", "4"}))
        << "this is lesson 12's picture";
}

TEST(Simd, PictureOfIds) {
    // Where the tangent of the camera's angle has another last bit, some vertices are snapped to
    // the next 1/256 pixel: see lesson 13's test.
    constexpr std::size_t may_jump = 20;
    EXPECT_TRUE(equals_golden("14_simd", "13_visibility_buffer_ids", {"--show", "ids"}, may_jump))
        << "this is lesson 13's picture";
}

TEST(Simd, PictureOfTheSceneIsLesson12sByteForByte) {
    EXPECT_TRUE(equals_golden("14_simd", "14_simd"));
    const std::string expected = bytes_of_picture("12_effects", {"--size", golden_size});
    ASSERT_GT(expected.size(), 100000u);
    EXPECT_TRUE(bytes_of_picture("14_simd", {"--size", golden_size}) == expected)
        << "14_simd.png is not 12_effects.png; ./tests/run --diagnose says where";
    EXPECT_TRUE(bytes_of_picture("14_simd", {"--size", golden_size, "--threads", "3", "--max-ids",
                                             "100"}) == expected)
        << "with --threads 3 --max-ids 100 the picture is not lesson 12's";
}
