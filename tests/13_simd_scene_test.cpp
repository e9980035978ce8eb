// SPDX-License-Identifier: MIT
// Lesson 12's pictures and counters at each width, bit by bit, of models and of random scenes; and
// the pictures.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "10_threading/thread_pool.hpp"
#include "11_scenes/scene_assets.hpp"
#include "13_simd/simd.hpp"
#include "common/image/backdrop.hpp"
#include "support/any_scene.hpp"
#include "support/first_difference.hpp"
#include "support/golden.hpp"
#include "support/lesson_process.hpp"
#include "support/lessons_12_and_13.hpp"
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
constexpr std::array widths = {1, 4, 8, 16};
constexpr std::uint32_t random_scenes = is_sanitized ? 40 : 400;
constexpr int unlimited_ids = std::numeric_limits<int>::max();

lesson_13::Options small_wide_picture(ivec2 size = {96, 54}) {
    lesson_13::Options options;
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

/// As a command line, but for the number of threads.
std::string in_words(const lesson_13::Options& options) {
    const auto number = [](const char* name, int value) {
        return std::string(" ") + name + " " + std::to_string(value);
    };
    constexpr std::array filters = {"nearest", "bilinear", "trilinear"};
    std::string words = "a picture of " + std::to_string(options.size.x) + " x " +
                        std::to_string(options.size.y) + ",";
    words += number("--width", options.wide.width);
    words += number("--max-ids", options.visibility.max_ids);
    words += number("--shadow-part", options.visibility.shadow_part);
    words += number("--shadow-size", options.shadow.size) + number("--pcf", options.shadow.pcf);
    words += number("--tile", options.threads.tile);
    words += std::string(", ") + name_of(options.shadow.bias) + ", " +
             name_of(options.threads.split) + ", filter " +
             filters.at(static_cast<std::size_t>(options.texture.filter)) + ", key light " +
             name_of(options.shading.key_light);
    if (options.shading.two_sided) words += ", back faces";
    if (options.shading.all_effects) words += ", --all-effects";
    if (options.normal_map.space == MapSpace::none) words += ", no normal maps";
    if (options.show_depth) words += ", --depth";
    if (options.threads.show) words += ", --show-threads";
    if (options.visibility.show != Show::picture) words += ", --show";
    return words;
}

lesson_13::Options any_options(Dice& dice) {
    constexpr std::array filters = {Filter::nearest, Filter::bilinear, Filter::trilinear};
    constexpr std::array biases = {Bias::none, Bias::constant, Bias::slope, Bias::plane,
                                   Bias::normal};
    constexpr std::array ids = {1, 2, 3, 7, unlimited_ids, unlimited_ids};
    constexpr std::array parts = {5, 16, 32, 64, 512};
    constexpr std::array shows = {Show::ids, Show::shading, Show::shadow_map};
    lesson_13::Options options;
    // Some triangles are wider than 100 pixels.
    options.size = dice.one_in(4) ? ivec2(100 + dice.below(80), 1 + dice.below(20))
                                  : ivec2(1 + dice.below(60), 1 + dice.below(40));
    options.texture.filter = filters.at(dice.below(3));
    options.shadow.size = 16 + static_cast<int>(dice.below(100));
    options.shadow.pcf = 1 + 2 * static_cast<int>(dice.below(4));
    options.shadow.bias = biases.at(dice.below(5));
    options.shading.two_sided = dice.one_in(4);
    options.shading.all_effects = dice.one_in(4);
    if (dice.one_in(5)) options.normal_map.space = MapSpace::none;
    options.show_depth = dice.one_in(8);
    if (dice.one_in(8)) options.visibility.show = shows.at(dice.below(3));
    options.threads.split = splits.at(dice.below(3));
    options.threads.tile = 1 + static_cast<int>(dice.below(dice.one_in(3) ? 100 : 40));
    options.visibility.max_ids = ids.at(dice.below(6));
    options.visibility.shadow_part = parts.at(dice.below(5));
    return options;
}

/// The file that a lesson's program writes.
std::string bytes_of_picture(const std::string& lesson, std::vector<std::string> arguments) {
    const auto folder = fresh_folder("simd");
    const std::string file = (folder / "a.png").string();
    arguments.insert(arguments.end(), {"--out", file});
    const ProcessResult run = run_program(lesson, arguments);
    EXPECT_EQ(run.exit_status, 0) << lesson << ": " << run.err;
    return read_text(file);
}

}  // namespace

TEST(Simd, HardCase_RandomScenesHaveLesson12sBitsAndCounts) {
    look_up("Eq. 13.1");
    const auto pool_of = pools();
    Counters all;
    for (std::uint32_t seed = 0; seed < random_scenes; ++seed) {
        Dice dice(seed + 2'000'000);
        lesson_13::Options options = any_options(dice);
        const std::size_t p = seed % pool_of.size();
        ThreadPool& pool = *pool_of[p];
        options.threads.show = pool.size() == 1 && dice.one_in(4);
        SceneAssets assets = make_scene_assets(any_scene(seed + 5000), options);
        add_holes(assets);
        const Drawn expected = drawn_by_12(options, assets, pool);
        for (const int width : widths) {
            options.wide.width = width;
            const Drawn actual = drawn_by_13(options, assets, pool);
            const std::string where = in_words(options) +
                                      ", threads: " + std::to_string(numbers_of_threads.at(p)) +
                                      " (seed " + std::to_string(seed) + ")";
            ASSERT_TRUE(have_the_same_bits(actual.picture, expected.picture))
                << "beside lesson 12's picture; " << where;
            ASSERT_TRUE(counts_are_equal(actual, expected)) << where;
        }
        all.add(expected.counters);
    }
    const Drawn drawn{{}, all};
    for (const Counter counter :
         {Counter::fragments_shaded, Counter::texture_samples, Counter::fragments_lit,
          Counter::highlights, Counter::toon_fragments, Counter::normal_map_samples,
          Counter::colored_fragments, Counter::alpha_tested_fragments, Counter::blended_fragments,
          Counter::shadow_tests, Counter::shadow_fragments})
        EXPECT_GT(drawn.count(counter), 20u * random_scenes)
            << counter_names[static_cast<std::size_t>(counter)] << " of all scenes";
    EXPECT_GT(drawn.count(Counter::shadow_parts), random_scenes);
}

TEST(Simd, HardCase_ModelsHaveLesson12sBitsAndCountsWithEachOption) {
    look_up("Eq. 13.1");
    struct Knob {
        const char* name;
        void (*turn)(lesson_13::Options&);
        bool changes_assets = false;
    };
    constexpr std::array knobs = {
        Knob{"no option", [](auto&) {}},
        Knob{"--max-ids 2", [](auto& o) { o.visibility.max_ids = 2; }},
        Knob{"--shadow-part 512 --tile 64",
             [](auto& o) { o.visibility.shadow_part = 512, o.threads.tile = 64; }},
        Knob{"--shadow-size 97 --pcf 7 --bias plane",
             [](auto& o) { o.shadow.size = 97, o.shadow.pcf = 7, o.shadow.bias = Bias::plane; },
             true},
        Knob{"--pcf 1 --bias none", [](auto& o) { o.shadow.pcf = 1, o.shadow.bias = Bias::none; }},
        Knob{"--pcf 5 --bias normal",
             [](auto& o) { o.shadow.pcf = 5, o.shadow.bias = Bias::normal; }},
        Knob{"--filter nearest --split interleaved",
             [](auto& o) {
                 o.texture.filter = Filter::nearest, o.threads.split = Split::interleaved;
             }},
        Knob{"--filter bilinear --split rows",
             [](auto& o) { o.texture.filter = Filter::bilinear, o.threads.split = Split::rows; }},
        Knob{"--normal-map none", [](auto& o) { o.normal_map.space = MapSpace::none; }, true},
        Knob{"--light point", [](auto& o) { o.shading.key_light = LightKind::point; }, true},
        Knob{"--light spot", [](auto& o) { o.shading.key_light = LightKind::spot; }, true},
        Knob{"back faces", [](auto& o) { o.shading.two_sided = true; }, true},
        Knob{"--all-effects", [](auto& o) { o.shading.all_effects = true; }, true},
        Knob{"--depth", [](auto& o) { o.show_depth = true; }},
        Knob{"a camera so near that much is clipped",
             [](auto& o) { o.scene.camera = "orbit", o.orbit.distance = 0.15f; }}};
    ThreadPool pool(2);
    std::size_t next = 0;
    for (const char* const name : models) {
        const Scene model = loaded(name);
        const SceneAssets usual_assets = make_scene_assets(model, small_wide_picture());
        std::uint64_t tested = 0;
        for (const Knob& knob : knobs) {
            lesson_13::Options options = small_wide_picture();
            knob.turn(options);
            std::optional<SceneAssets> own_assets;
            if (knob.changes_assets) own_assets.emplace(make_scene_assets(model, options));
            const SceneAssets& assets = own_assets ? *own_assets : usual_assets;
            const Drawn expected = drawn_by_12(options, assets, pool);
            // Two widths of four, in turn; where a sanitizer watches, one.
            for (int i = 0; i < (is_sanitized ? 1 : 2); ++i) {
                options.wide.width = widths.at(next++ % widths.size());
                const Drawn actual = drawn_by_13(options, assets, pool);
                const std::string where = std::string(name) + " with " + knob.name +
                                          " and --width " + std::to_string(options.wide.width);
                ASSERT_TRUE(have_the_same_bits(actual.picture, expected.picture))
                    << "beside lesson 12's picture; " << where;
                ASSERT_TRUE(counts_are_equal(actual, expected)) << where;
            }
            if (!is_sanitized) ++next;
            tested += expected.count(Counter::fragments_tested);
        }
        EXPECT_GT(tested, 1000 * knobs.size()) << "fragments of all pictures of " << name;
    }
}

TEST(Simd, HardCase_AnyNumberOfThreadsGivesTheSameBitsAndCounts) {
    look_up("Eq. 13.2");
    // Vectors reach beyond a tile and beyond a map's part: nothing of that may be another thread's.
    const auto pool_of = pools();
    for (const char* const name : {"bumpy.glb", "toon.glb", "textured.gltf"}) {
        lesson_13::Options options = small_wide_picture();
        const SceneAssets assets = make_scene_assets(loaded(name), options);
        const Drawn expected = drawn_by_12(options, assets, *pool_of[0]);
        ASSERT_GT(expected.count(Counter::shadow_parts), 8u) << name;
        for (std::size_t p = 0; p < pool_of.size(); ++p)
            for (const Split split : splits)
                for (const int width : {4, 16}) {
                    options.threads.split = split;
                    options.threads.tile = width == 4 ? 5 : 17;
                    options.wide.width = width;
                    const Drawn actual = drawn_by_13(options, assets, *pool_of[p]);
                    const std::string where =
                        std::string(name) + ", " + std::to_string(numbers_of_threads.at(p)) +
                        " threads, " + name_of(split) + ", tile side " +
                        std::to_string(options.threads.tile) + ", --width " +
                        std::to_string(width) + ", beside lesson 12 and one thread";
                    ASSERT_TRUE(have_the_same_bits(actual.picture, expected.picture)) << where;
                    ASSERT_TRUE(counts_are_equal(actual, expected)) << where;
                }
    }
}

TEST(Simd, HardCase_EmptyScenesAndPicturesOfAFewPixels) {
    look_up("Eq. 13.2");
    ThreadPool pool(3);
    Scene empty;
    empty.materials.resize(1);
    for (const bool all_effects : {false, true})
        for (const int width : widths) {
            lesson_13::Options options = small_wide_picture();
            options.shading.all_effects = all_effects;
            options.wide.width = width;
            EXPECT_TRUE(
                is_backdrop(drawn_by_13(options, make_scene_assets(empty, options), pool).picture))
                << "a scene without triangles is the backdrop, --width " << width;
        }
    std::size_t combinations = 0;
    for (const char* const name : models) {
        lesson_13::Options options = small_wide_picture();
        options.shadow.size = 16;
        const SceneAssets assets = make_scene_assets(loaded(name), options);
        for (const ivec2 size : {ivec2(1, 1), {1, 7}, {7, 1}, {17, 2}, {3, 61}})
            for (const Split split : splits)
                for (const int tile : {1, 64}) {
                    // Every fifth has each split with each tile.
                    if (is_sanitized && combinations++ % 5 != 0) continue;
                    options.size = size;
                    options.threads.split = split, options.threads.tile = tile;
                    const Drawn expected = drawn_by_12(options, assets, pool);
                    for (const int width : {4, 8, 16}) {
                        options.wide.width = width;
                        const Drawn actual = drawn_by_13(options, assets, pool);
                        const std::string where = std::string(name) + ", " + in_words(options);
                        ASSERT_TRUE(have_the_same_bits(actual.picture, expected.picture))
                            << "beside lesson 12's picture; " << where;
                        ASSERT_TRUE(counts_are_equal(actual, expected)) << where;
                    }
                }
    }
}

TEST(Simd, HardCase_EachWidthHasFunctionsOfItsOwn) {
    look_up("Eq. 13.4");
    for (const int width : widths)
        for (const int other : widths) {
            const auto a = drawing_of_width(width), b = drawing_of_width(other);
            EXPECT_EQ(a.draw_id == b.draw_id, width == other)
                << "whether --width " << width << " and --width " << other
                << " draw ids by the same function";
            EXPECT_EQ(a.draw_transparent == b.draw_transparent, width == other);
            EXPECT_EQ(a.shade_visible == b.shade_visible, width == other);
        }
    EXPECT_EQ(lesson_13::Options().wide.width, native_width);
    EXPECT_TRUE(native_width == 4 || native_width == 8 || native_width == 16);
}

TEST(Simd, HardCase_InvalidWidthsAreAnErrorInOneLine) {
    look_up("Eq. 13.4");
    const auto run = [](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"--size", "32x18", "--shadow-size", "64", "--out",
                                           (fresh_folder("simd_options") / "a.png").string()});
        return run_program("13_simd", arguments);
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

TEST(Simd, PictureOfToon) {
    EXPECT_TRUE(equals_golden("13_simd", "11_scenes_toon",
                              {"--model", "toon.glb", "--samples", "4", "--width", "8"}))
        << "this is lesson 11's picture";
}

TEST(Simd, PictureOfIds) {
    // Where the tangent of the camera's angle has another last bit, some vertices are snapped to
    // the next 1/256 pixel: see lesson 12's test.
    constexpr std::size_t may_jump = 20;
    EXPECT_TRUE(equals_golden("13_simd", "12_visibility_buffer_ids", {"--show", "ids"}, may_jump))
        << "this is lesson 12's picture";
}

TEST(Simd, PictureOfTheSceneIsLesson11sByteForByte) {
    EXPECT_TRUE(equals_golden("13_simd", "13_simd"));
    const std::string expected = bytes_of_picture("11_scenes", {"--size", golden_size});
    ASSERT_GT(expected.size(), 100000u);
    for (const char* const width : {"1", "4", "8", "16"})
        EXPECT_TRUE(bytes_of_picture("13_simd", {"--size", golden_size, "--width", width}) ==
                    expected)
            << "13_simd.png is not 11_scenes.png with --width " << width
            << "; ./tests/run --diagnose says where";
    EXPECT_TRUE(bytes_of_picture("13_simd", {"--size", golden_size, "--threads", "3", "--max-ids",
                                             "100"}) == expected)
        << "with --threads 3 --max-ids 100 the picture is not lesson 11's";
}
