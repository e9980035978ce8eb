// SPDX-License-Identifier: MIT
// How often a pixel is shaded, ids that run out, glass, what --show shows; the pictures, beside
// lesson 12's bits and counts.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "09_shadow_maps/shadows.hpp"
#include "10_threading/thread_pool.hpp"
#include "12_effects/planned_scene.hpp"
#include "13_visibility_buffer/shadow_parts.hpp"
#include "13_visibility_buffer/views.hpp"
#include "common/image/backdrop.hpp"
#include "support/any_scene.hpp"
#include "support/first_difference.hpp"
#include "support/golden.hpp"
#include "support/lesson_process.hpp"
#include "support/lessons_12_and_13.hpp"
#include "support/look_up.hpp"
#include "support/name_of_split.hpp"
#include "support/one_triangle.hpp"
#include "support/pictures.hpp"
#include "support/printers.hpp"
#include "support/random_casters.hpp"
#include "support/squares.hpp"
#include "support/visible_pictures.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// Squares that cover the picture, and triangles in its middle.
class Surfaces : public Squares {
  public:
    Material& add_triangle(float z) {
        return add(mesh_of({{-0.5f, -0.5f, z}, {0.5f, -0.5f, z}, {0, 0.6f, z}}, {{0, 1, 2}}),
                   vec3(1 - 0.01f * z));
    }

    PlannedScene assets(const lesson_13::Options& options) const {
        return load_planned_scene(scene, options);
    }
};

/// Squares that cover the picture, in an order: the greater, the nearer.
Surfaces squares_in(std::span<const int> order) {
    Surfaces squares;
    for (const int nearness : order)
        squares.add(0.01f * static_cast<float>(nearness), vec3(0.1f, 0.5f, 0.3f));
    return squares;
}

/// How many are nearer than all before them: so often lesson 12 shades a pixel.
std::uint64_t nearer_than_all_before(std::span<const int> order) {
    std::uint64_t count = 0;
    int nearest = -1;
    for (const int nearness : order)
        count += nearness > std::exchange(nearest, std::max(nearest, nearness));
    return count;
}

/// Lesson 12's and lesson 13's picture, compared.
std::array<Drawn, 2> compared(const lesson_13::Options& options, const PlannedScene& assets,
                              ThreadPool& pool, const std::string& where) {
    std::array both = {drawn_by_12(options, assets, pool), drawn_by_13(options, assets, pool)};
    const auto compare = [&] {
        const auto& [forward, visible] = both;
        ASSERT_TRUE(have_the_same_bits(visible.picture, forward.picture))
            << "beside lesson 12's picture; " << where;
        ASSERT_TRUE(counts_agree(forward, visible, options.visibility.max_ids,
                                 opaque_pixels(options, assets, pool)))
            << where;
    };
    compare();
    return both;
}

}  // namespace

TEST(VisibilityBuffer, Eq13_4_AllOrdersOfAFewSurfacesHaveTheMeanExactly) {
    const lesson_13::Options options = small_picture<lesson_13::Options>({4, 4});
    lesson_13::Options one_id = options;
    one_id.visibility.max_ids = 1;
    ThreadPool pool(1);
    double harmonic = 0;  // H_k
    for (int k = 1; k <= 5; ++k) {
        std::vector<int> order(static_cast<std::size_t>(k));
        std::iota(order.begin(), order.end(), 0);
        std::uint64_t sum = 0, orders = 0;
        do {
            const PlannedScene assets = squares_in(order).assets(options);
            const std::string where = testing::PrintToString(order) +
                                      ", squares over all 16 pixels in drawing order, the "
                                      "greater the nearer";
            const std::uint64_t forward = nearer_than_all_before(order);
            ASSERT_EQ(drawn_by_12(options, assets, pool).count(Counter::fragments_shaded),
                      16 * forward)
                << "fragments that lesson 12 shades of " << where;
            ASSERT_EQ(drawn_by_13(one_id, assets, pool).count(Counter::fragments_shaded),
                      16 * forward)
                << "fragments shaded with --max-ids 1 of " << where;
            ASSERT_EQ(drawn_by_13(options, assets, pool).count(Counter::fragments_shaded), 16u)
                << "fragments shaded of " << where;
            sum += forward, ++orders;
        } while (std::ranges::next_permutation(order).found);
        harmonic += 1.0 / k;
        // 5 surfaces: 274 times in 120 orders.
        ASSERT_EQ(static_cast<double>(sum), std::round(harmonic * static_cast<double>(orders)))
            << "times that a pixel is shaded in all " << orders << " orders of " << k
            << " surfaces, and H_k times as many";
    }
}

TEST(VisibilityBuffer, Eq13_5_AllIsSavedButTheLastShading) {
    // Of k t_d + s t_s, lesson 13 keeps k t_d and one t_s: the tests are the same, and of the
    // shading (s - 1) t_s are saved.
    const lesson_13::Options options = small_picture<lesson_13::Options>({6, 6});
    ThreadPool pool(2);
    Dice dice(12);
    for (int i = 0; i < 40; ++i) {
        std::vector<int> order(1 + dice.below(7));
        for (int& nearness : order) nearness = static_cast<int>(dice.below(5));  // some are equal
        const PlannedScene assets = squares_in(order).assets(options);
        const Drawn forward = drawn_by_12(options, assets, pool);
        const Drawn visible = drawn_by_13(options, assets, pool);
        const std::string where = ", of " + testing::PrintToString(order) +
                                  ", squares in drawing order, the greater the nearer";
        for (const Drawn& drawn : {forward, visible})
            ASSERT_EQ(drawn.count(Counter::fragments_tested), 36 * order.size())
                << "fragments tested" << where;
        ASSERT_EQ(
            forward.count(Counter::fragments_shaded) - visible.count(Counter::fragments_shaded),
            36 * (nearer_than_all_before(order) - 1))
            << "fragments that lesson 12 shades and lesson 13 does not" << where;
    }
}

TEST(VisibilityBuffer, HardCase_ManyTrianglesInOnePixel) {
    look_up("Eq. 13.1");
    // Each is nearer than the ones before it, but for those of every hundred that have one depth.
    constexpr std::uint32_t count = 5 << 16;  // more than 16 bits tell apart
    Surfaces surfaces;
    surfaces.add_triangle(0);
    Mesh& mesh = surfaces.scene.meshes[0];
    const Mesh one = mesh;
    mesh.positions.clear(), mesh.triangles.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
        const float z = static_cast<float>(i / 100) * 0x1p-11f;
        for (const vec3 vertex : one.positions) mesh.positions.push_back(vertex + vec3(0, 0, z));
        Triangle& next = mesh.triangles.emplace_back(one.triangles[0]);
        for (std::uint32_t v = 0; v < 3; ++v) next.vertices[v].position = 3 * i + v;
    }
    mesh.bounds.add(mesh.positions.back());
    ThreadPool pool(2);
    lesson_13::Options options = small_picture<lesson_13::Options>({1, 1});
    const PlannedScene assets = surfaces.assets(options);
    const Drawn forward = drawn_by_12(options, assets, pool);
    for (const int max_ids : {1, 2, 7, 100, 65535, unlimited_ids}) {
        options.visibility.max_ids = max_ids;
        const Drawn visible = drawn_by_13(options, assets, pool);
        ASSERT_TRUE(have_the_same_bits(visible.picture, forward.picture))
            << count << " triangles over a pixel with --max-ids " << max_ids;
        ASSERT_EQ(visible.count(Counter::fragments_tested), count);
        // One for each round in which something was nearer than before.
        const auto n = static_cast<std::uint64_t>(max_ids);
        std::uint64_t expected = 0;
        for (std::uint64_t first = 0; first < count; first += n) {
            const std::uint64_t last = std::min<std::uint64_t>(first + n, count) - 1;
            expected += first == 0 || last / 100 > (first - 1) / 100;
        }
        ASSERT_EQ(visible.count(Counter::fragments_shaded), expected)
            << "times that a pixel is shaded with --max-ids " << max_ids << ", of " << count
            << " triangles back to front, a hundred at each depth";
    }
}

TEST(VisibilityBuffer, HardCase_HowOftenAPixelIsShadedIsShownUpToEightTimes) {
    look_up("Eq. 13.4");
    HeatMap heat(Show::shading, {12, 2});
    for (int x = 0; x < 12; ++x)
        for (int i = 0; i < x; ++i) heat.add({x, 0});
    heat.add(PixelSpan{{2, 1}, 3});
    const Image<vec3> ramp = heat.picture();
    for (int x = 0; x < 12; ++x) {
        EXPECT_EQ((ramp[{x, 1}]), (ramp[{x >= 2 && x < 5 ? 1 : 0, 0}]))
            << "pixel " << x << " of a row with a span of three from 2 on";
        EXPECT_EQ((ramp[{x, 0}] == ramp[{8, 0}]), x >= 8) << x << " times, and eight times";
    }
}

TEST(VisibilityBuffer, HardCase_PartsOfAMapAreShownInTheMiddleOfATallPicture) {
    look_up("Eq. 13.6");
    const Scene scene = random_casters(20, 5);
    const ShadowBounds bounds = shadow_bounds(scene);
    const std::array<Light, 1> lights = {sun(glm::normalize(vec3(0.3f, 1, 0.2f)))};
    ThreadPool pool(2);
    const ShadowMapsOnDemand on_demand(pool, 3, {.size = 40}, {scene, bounds, lights});
    for (int i = 0; i < 40; i += 5) on_demand.parts()[0].draw_around(ivec2(i, 20), 3);
    const Image<vec3> square = picture_of(on_demand, ivec2(64)),
                      tall = picture_of(on_demand, {64, 200});
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 64; ++x)
            ASSERT_EQ((tall[{x, y}]), (y >= 68 && y < 132 ? square[{x, y - 68}] : vec3(0)))
                << "the pixel (" << x << ", " << y << ") of a picture of 64 x 200";
    const ShadowMapsOnDemand no_maps(pool, 32, {.size = 64}, {Scene(), ShadowBounds(), {}});
    EXPECT_TRUE(are_equal(picture_of(no_maps, {9, 5}), Image<vec3>({9, 5}, vec3(0))))
        << "without a map all is black";
}

TEST(VisibilityBuffer, HardCase_InvalidOptionsAreAnErrorInOneLine) {
    look_up("Eq. 13.6");
    const auto run = [](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(),
                         {"--size", "32x18", "--shadow-size", "64", "--out",
                          (fresh_folder("visibility_options") / "a.png").string()});
        return run_program("13_visibility_buffer", arguments);
    };
    expect_error(run({"--max-ids", "0"}), 2, "--max-ids");
    expect_error(run({"--shadow-part", "31"}), 2, "--shadow-part");
    expect_error(run({"--show", "all"}), 2, "--show");
    const ProcessResult explained = run({"--max-ids", "1", "--shadow-part", "32", "--explain"});
    ASSERT_EQ(explained.exit_status, 0) << explained.err;
    for (const char* line : {"  casters: ", "  triangles: ", "  picture: ", "  shadow_parts: "})
        EXPECT_NE(explained.out.find(line), std::string::npos)
            << "--explain has no line \"" << line << "\":\n"
            << explained.out;
}

TEST(VisibilityBuffer, HardCase_RandomScenesHaveLesson12sBitsAndCounts) {
    look_up("Eq. 13.1");
    constexpr std::uint32_t random_scenes = 300;
    const auto pool_of = pools();
    Counters forward_counters, visible_counters;
    for (std::uint32_t seed = 0; seed < random_scenes; ++seed) {
        Dice dice(seed + 1'000'000);
        auto options = any_options<lesson_13::Options>(dice);
        const std::size_t p = seed % pool_of.size();
        ThreadPool& pool = *pool_of[p];
        options.threads.show = pool.size() == 1 && dice.one_in(4);
        PlannedScene assets = load_planned_scene(any_scene(seed), options);
        add_holes(assets);
        const std::string where = in_words(options, options.visibility) +
                                  ", threads: " + std::to_string(numbers_of_threads[p]) +
                                  " (seed " + std::to_string(seed) + ")";
        const auto [forward, visible] = compared(options, assets, pool, where);
        if (HasFatalFailure()) return;
        forward_counters += forward.counters, visible_counters += visible.counters;
    }
    expect_all_work(visible_counters, random_scenes);
    EXPECT_GT(
        forward_counters[Counter::fragments_shaded] - visible_counters[Counter::fragments_shaded],
        10u * random_scenes)
        << "the scenes have overdraw, and some of it is saved";
}

TEST(VisibilityBuffer, HardCase_ModelsHaveLesson12sBitsAndCountsWithEachOption) {
    look_up("Eq. 13.1");
    ThreadPool pool(2);
    for (const char* const name : models) {
        std::uint64_t tested = 0;
        const auto compare = [&](const lesson_13::Options& options, const PlannedScene& assets,
                                 const std::string& where) {
            tested += compared(options, assets, pool, where)[1].count(Counter::fragments_tested);
        };
        for_each_option<lesson_13::Options>(name, compare);
        if (HasFatalFailure()) return;
        EXPECT_GT(tested, 20'000u) << "fragments of all pictures of " << name;
    }
}

TEST(VisibilityBuffer, HardCase_AnyNumberOfThreadsGivesTheSameBitsAndCounts) {
    look_up("Eq. 13.6");
    // Which parts are drawn depends on what is asked, never on who asks first.
    const auto pool_of = pools();
    for (const char* const name : {"bumpy.glb", "toon.glb", "textured.gltf"}) {
        auto options = small_picture<lesson_13::Options>();
        const PlannedScene assets = load_planned_scene(loaded(name), options);
        const Drawn expected = drawn_by_13(options, assets, *pool_of[0]);
        ASSERT_GT(expected.count(Counter::shadow_parts), 8u) << name;
        for (std::size_t p = 0; p < pool_of.size(); ++p)
            for (const Split split : splits) {
                options.threads.split = split;
                options.threads.tile = p % 2 == 0 ? 8 : 17;
                const Drawn actual = drawn_by_13(options, assets, *pool_of[p]);
                const std::string where = std::string(name) + ", " +
                                          std::to_string(numbers_of_threads[p]) + " threads, " +
                                          name_of(split) + ", beside one thread";
                ASSERT_TRUE(have_the_same_bits(actual.picture, expected.picture)) << where;
                ASSERT_TRUE(counts_are_equal(actual, expected)) << where;
            }
    }
}

TEST(VisibilityBuffer, Eq13_6_SmallerPartsHaveFewerShadowFragments) {
    ThreadPool pool(2);
    for (const char* const name : {"bumpy.glb", "toon.glb"}) {
        auto options = small_picture<lesson_13::Options>();
        options.shadow.size = 256;
        const PlannedScene assets = load_planned_scene(loaded(name), options);
        const Drawn forward = drawn_by_12(options, assets, pool);
        std::uint64_t before = 0;
        for (const int side : {32, 64, 128, 256}) {
            options.visibility.shadow_part = side;
            const Drawn visible = drawn_by_13(options, assets, pool);
            const std::uint64_t fragments = visible.count(Counter::shadow_fragments),
                                all = forward.count(Counter::shadow_fragments);
            ASSERT_GE(fragments, before) << "shadow fragments of " << name << " with parts of "
                                         << side << " texels a side, and with parts half as long";
            if (side == 32) {
                EXPECT_LT(fragments, all) << "of " << name << ", with parts of 32 texels";
            }
            if (side == 256) { EXPECT_EQ(fragments, all) << "of " << name << ", with whole maps"; }
            before = fragments;
        }
    }
}

TEST(VisibilityBuffer, HardCase_WhatNobodySeesIsAskedForNothing) {
    look_up("Eq. 13.6");
    ThreadPool pool(2);
    const auto expect_no_part = [&](const Scene& scene, const lesson_13::Options& options,
                                    std::uint64_t maps, const char* what) {
        const PlannedScene assets = load_planned_scene(scene, options);
        const Drawn visible = drawn_by_13(options, assets, pool);
        EXPECT_EQ(visible.count(Counter::shadow_passes), maps) << "maps of " << what;
        EXPECT_EQ(visible.count(Counter::shadow_parts), 0u) << "parts drawn for " << what;
        EXPECT_EQ(visible.count(Counter::shadow_fragments), 0u) << what;
    };
    expect_no_part(loaded("unlit.glb"), small_picture<lesson_13::Options>(), 0, "an unlit scene");
    for (const auto& [name, maps] : {std::pair("bumpy.glb", 2u), {"toon.glb", 1u}}) {
        Scene scene = loaded(name);
        for (SceneCamera& camera : scene.cameras)
            camera.world_from_view = camera.world_from_view * rotation_y(std::numbers::pi_v<float>);
        expect_no_part(scene, small_picture<lesson_13::Options>(), maps,
                       "a camera that looks away");
    }
}

TEST(VisibilityBuffer, HardCase_EmptyMapsAreClearedWhereTheyAreAskedFor) {
    look_up("Eq. 13.6");
    // With --all-effects a lit scene without casters has maps, too: all of it is lit.
    Surfaces squares;
    squares.add_glass(0, vec3(1), 0.5f).illumination = 2;
    ThreadPool pool(3);
    for (const bool all_effects : {false, true}) {
        auto options = small_picture<lesson_13::Options>({32, 32});
        options.shading.all_effects = all_effects;
        const std::string how = all_effects ? "with --all-effects" : "without --all-effects";
        const Drawn visible = compared(options, squares.assets(options), pool, how)[1];
        EXPECT_GT(visible.count(Counter::fragments_lit), 50u) << how;
        EXPECT_EQ(visible.count(Counter::shadow_parts) > 0, all_effects)
            << "whether parts are drawn of maps without casters, " << how;
        EXPECT_EQ(visible.count(Counter::shadow_fragments), 0u) << how;
        EXPECT_TRUE(is_backdrop(drawn_by_13(options, Surfaces().assets(options), pool).picture))
            << "a scene without triangles is the backdrop, " << how;
    }
}

TEST(VisibilityBuffer, PictureOfIds) {
    // Where the tangent of the camera's angle has another last bit, some vertices are snapped to
    // the next 1/256 pixel. An edge there passes a pixel's centre, and the colour jumps: with an
    // angle that is an ulp off, in up to 3 pixels.
    constexpr std::size_t may_jump = 20;
    EXPECT_TRUE(equals_golden("13_visibility_buffer", "13_visibility_buffer_ids", {"--show", "ids"},
                              may_jump));
}

constexpr const char* returned =
    "is it the scene itself? Then main.cpp does not return what --show asks for";

TEST(VisibilityBuffer, PictureOfEachPixelOnce) {
    EXPECT_TRUE(equals_golden("13_visibility_buffer", "11_scenes_unlit", {"--model", "unlit.glb"}))
        << "this is lesson 12's picture";
    EXPECT_TRUE(equals_golden("13_visibility_buffer", "13_visibility_buffer_overdraw",
                              {"--model", "textured.gltf", "--show", "shading", "--max-ids", "1"}));
    EXPECT_TRUE(equals_golden("13_visibility_buffer", "13_visibility_buffer_shading",
                              {"--model", "textured.gltf", "--show", "shading"}))
        << returned;
}

TEST(VisibilityBuffer, PictureOfShadowMapParts) {
    EXPECT_TRUE(equals_golden("13_visibility_buffer", "13_visibility_buffer"));
    EXPECT_TRUE(equals_golden("13_visibility_buffer", "13_visibility_buffer_shadow_map",
                              {"--show", "shadow-map"}))
        << returned;
}

TEST(VisibilityBuffer, PictureOfTheSceneIsLesson12sByteForByte) {
    const std::string expected = bytes_of_picture("12_effects", {"--size", golden_size});
    ASSERT_GT(expected.size(), 100000u);
    EXPECT_TRUE(bytes_of_picture("13_visibility_buffer", {"--size", golden_size}) == expected)
        << "13_visibility_buffer.png is not 12_effects.png; ./tests/run --diagnose says where";
    EXPECT_TRUE(bytes_of_picture("13_visibility_buffer", {"--size", golden_size, "--threads", "3",
                                                          "--max-ids", "100"}) == expected)
        << "with --threads 3 --max-ids 100 the picture is not lesson 12's";
}
