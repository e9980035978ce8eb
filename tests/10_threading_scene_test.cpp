// SPDX-License-Identifier: MIT
// Bins of triangles, the same bits whichever thread draws, counters, and the pictures.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "04_mvp/camera.hpp"
#include "04_mvp/projection.hpp"
#include "09_shadow_maps/light_view.hpp"
#include "09_shadow_maps/shadow_map.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "10_threading/binned_triangles.hpp"
#include "10_threading/thread_options.hpp"
#include "10_threading/thread_pool.hpp"
#include "10_threading/threaded_shadows.hpp"
#include "support/any_scene.hpp"
#include "support/first_difference.hpp"
#include "support/golden.hpp"
#include "support/lesson_09.hpp"
#include "support/lesson_10.hpp"
#include "support/lesson_process.hpp"
#include "support/look_up.hpp"
#include "support/name_of_split.hpp"
#include "support/names.hpp"
#include "support/one_triangle.hpp"
#include "support/pictures.hpp"
#include "support/pretend_pool.hpp"
#include "support/printers.hpp"
#include "support/sanitizer.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr int repeats = is_sanitized ? 2 : 100;
constexpr ivec2 middling_size = is_sanitized ? ivec2(96, 54) : ivec2(160, 90);

lesson_10::Options small_picture(ivec2 size = {64, 36}) {
    lesson_10::Options options;
    options.size = size;
    options.shadow.size = 64;
    options.threads.tile = 8;
    return options;
}

/// The picture that lesson 09 draws of the same options.
Image<vec3> expected_of(const lesson_10::Options& options, const ShadowAssets& assets) {
    lesson_09::Options same;
    static_cast<LessonOptions&>(same) = options;
    same.orbit = options.orbit, same.show_depth = options.show_depth;
    same.texture = options.texture, same.shading = options.shading;
    same.normal_map = options.normal_map, same.shadow = options.shadow;
    return lesson_09::render(same, assets);
}

/// Throws instead of doing one of the tasks of all jobs.
class TiredWorkers : public Workers {
  public:
    /// @param tasks_left  The task that is not done, counted from 1 through all jobs.
    TiredWorkers(ThreadPool& pool, long tasks_left) : pool_(pool), tasks_left_(tasks_left) {}

    std::size_t size() const override { return pool_.size(); }
    void run_tasks(std::size_t tasks, const Task& task) override {
        pool_.run_tasks(tasks, [&](std::size_t i, std::size_t worker) {
            if (--tasks_left_ == 0) throw std::runtime_error("a worker is tired");
            task(i, worker);
        });
    }

    long tasks_left() const { return tasks_left_; }

  private:
    ThreadPool& pool_;
    std::atomic<long> tasks_left_;
};

/// Which of a scene's triangles this is, counted through all meshes.
std::size_t number_of(const ProjectedTriangle& projected, const Scene& scene) {
    auto number = static_cast<std::size_t>(&projected.triangle - projected.mesh.triangles.data());
    for (const Mesh& mesh : scene.meshes) {
        if (&mesh == &projected.mesh) break;
        number += mesh.triangles.size();
    }
    return number;
}

/// The numbers of a tile's triangles, in the order in which it draws them.
std::vector<std::size_t> listed(const BinnedTriangles& triangles, std::size_t tile,
                                const Scene& scene) {
    std::vector<std::size_t> numbers;
    triangles.for_each_in(tile, [&](const ProjectedTriangle& projected) {
        numbers.push_back(number_of(projected, scene));
    });
    return numbers;
}

std::vector<const Mesh*> pointers_to(const std::vector<Mesh>& meshes) {
    std::vector<const Mesh*> pointers;
    for (const Mesh& mesh : meshes) pointers.push_back(&mesh);
    return pointers;
}

}  // namespace

TEST(Threading, HardCase_TilesGrowWhereThereWouldBeTooMany) {
    look_up("Large triangles and slivers");
    ThreadOptions options;
    options.tile = 8;
    EXPECT_EQ(options.tiling_of({2048, 2048}, 2).count(), 65536u);
    EXPECT_EQ(options.tiling_of({2049, 2048}, 2).count(), 129u * 128u);
    EXPECT_EQ(options.tiling_of({16384, 16384}, 2).count(), 65536u);
}

TEST(Threading, Eq10_7_ABatchListsItsTrianglesByTiles) {
    // Two tiles beside each other; triangle 0 lies in the left one, 1 in both, 2 in the right one.
    const std::vector<vec3> positions = {{-0.9f, -0.5f, 0}, {-0.1f, -0.5f, 0}, {-0.5f, 0.5f, 0},
                                         {0.9f, -0.5f, 0},  {0.1f, -0.5f, 0},  {0.5f, 0.5f, 0}};
    const Mesh mesh = mesh_of(positions, {{0, 1, 2}, {0, 3, 2}, {4, 3, 5}});
    ThreadPool pool(1);
    const BinnedTriangles binned(pool, Scene(), {&mesh}, mat4(1),
                                 Tiling(Split::tiles, {32, 16}, 1, 16), Culling::none);
    ASSERT_EQ(binned.batches.size(), 1u);
    ASSERT_EQ(binned.batches[0].triangles.size(), 3u);
    for (const std::uint32_t tile : {0u, 1u}) {
        const auto of = binned.batches[0].of(tile);
        ASSERT_EQ(std::vector(of.begin(), of.end()), (std::vector{tile, tile + 1}))
            << "triangles listed for the tile on the " << (tile == 0 ? "left" : "right")
            << ", in the scene's order: 0 lies on the left, 1 on both sides, 2 on the right";
    }
}

TEST(Threading, HardCase_LargeTrianglesAreInNoTilesList) {
    look_up("Large triangles and slivers");
    // In 4,096 tiles; triangles 1 and 3 reach over half of the picture.
    const std::vector<vec3> positions = {{-0.95f, -0.95f, 0}, {-0.9f, -0.95f, 0},
                                         {-0.95f, -0.9f, 0},  {-1, -1, 0},
                                         {1, -1, 0},          {-1, 1, 0}};
    Scene scene;
    scene.meshes = {mesh_of(positions, {{0, 1, 2}, {3, 4, 5}, {0, 1, 2}, {3, 4, 5}, {0, 1, 2}})};
    const Tiling tiling(Split::tiles, {512, 512}, 1, 8);
    ThreadPool pool(1);
    const BinnedTriangles binned(pool, scene, pointers_to(scene.meshes), mat4(1), tiling,
                                 Culling::none);
    const TriangleBatch& batch = binned.batches.at(0);
    std::size_t with_small = 0;
    for (std::size_t tile = 0; tile < tiling.count(); ++tile) {
        std::vector<std::size_t> expected = {1, 3};
        if (!batch.of(tile).empty()) expected = {0, 1, 2, 3, 4}, ++with_small;
        ASSERT_EQ(listed(binned, tile, scene), expected)
            << "in the scene's order, in tile " << tile;
        ASSERT_EQ(binned.count_in(tile), expected.size()) << "triangles in tile " << tile;
        ASSERT_LE(batch.of(tile).size(), 3u) << "the large ones are in no list, tile " << tile;
    }
    EXPECT_EQ(with_small, 9u) << "tiles that list the small triangles";
    // Half of 13 x 13 pixels, and four a row and column of its box.
    EXPECT_NEAR(drawing_work(batch.triangles[0].on_screen), 12.8 * 12.8 / 2 + 4 * 2 * 13, 4 * 2)
        << "pixels that are looked at for a small triangle";
}

TEST(Threading, HardCase_ASliverIsListedWhereItIs) {
    look_up("Large triangles and slivers");
    Dice dice(6);
    const Tiling tiling(Split::tiles, {300, 200}, 1, 8);
    std::size_t listed = 0, in_boxes = 0;
    for (int i = 0; i < 500; ++i) {
        const auto anywhere = [&] { return 150.0f + vec2(dice.in_cube(153)); };
        const vec2 a = anywhere(), b = anywhere();
        const bool is_sliver = i % 2 == 0;
        const ScreenTriangle triangle =
            snap_triangle(a, b, is_sliver ? b + vec2(1, -1) : anywhere());
        std::set<std::size_t> tiles;
        tiling.for_each_in(triangle, [&](std::size_t tile) {
            ASSERT_TRUE(tiles.insert(tile).second) << "tile " << tile << " is taken twice";
        });
        fill_triangle(triangle, ivec2(0), tiling.size() - 1, [&](ivec2 pixel, Barycentrics) {
            const auto tile = static_cast<std::size_t>(pixel.y / 8 * 38 + pixel.x / 8);
            ASSERT_TRUE(tiles.contains(tile))
                << "tile " << tile << " lacks triangle " << i << ", which covers its pixel "
                << testing::PrintToString(pixel);
        });
        if (!is_sliver) continue;
        listed += tiles.size();
        tiling.for_each_in(box_around(triangle), [&](std::size_t) { ++in_boxes; });
    }
    EXPECT_LT(4 * listed, in_boxes) << "tiles that list a sliver, and those in the boxes";
}

TEST(Threading, Eq10_7_EachTileListsItsTrianglesInTheScenesOrder) {
    const Scene scene = loaded("scene_bumpy.obj");
    const ivec2 size(160, 90);
    const mat4 clip_from_world = orbit_camera(Orbit(), scene.bounds()).clip_from_world(size);
    std::size_t count = 0;
    for (const Mesh& mesh : scene.meshes) count += mesh.triangles.size();
    for (const Split split : splits)
        for (const Culling culling : {Culling::back_faces, Culling::none}) {
            const Tiling tiling(split, size, 7, 16);
            // One after the other, as earlier lessons do it.
            std::vector<std::vector<std::size_t>> expected(tiling.count());
            for_each_visible_triangle(
                scene, clip_from_world, size, culling, [&](const ProjectedTriangle& projected) {
                    if (projected.on_screen.twice_area == 0) return;
                    tiling.for_each_in(projected.on_screen, [&](std::size_t tile) {
                        expected[tile].push_back(number_of(projected, scene));
                    });
                });
            ShuffledPool pool(7, 5);
            const CountedSince sum;
            const BinnedTriangles triangles(pool, scene, pointers_to(scene.meshes), clip_from_world,
                                            tiling, culling);
            const std::size_t batches = triangles.batches.size();
            ASSERT_EQ(batches, batches_of(count));
            for (std::size_t b = 0; b < batches; ++b)
                for (const ProjectedTriangle& projected : triangles.batches[b].triangles) {
                    const std::size_t number = number_of(projected, scene);
                    ASSERT_TRUE(b * count / batches <= number && number < (b + 1) * count / batches)
                        << "batch " << b << " of " << batches << " has the scene's triangle "
                        << number << " of " << count
                        << ": each has as many as the others, the first ones in the first";
                }
            for (std::size_t tile = 0; tile < tiling.count(); ++tile)
                ASSERT_EQ(listed(triangles, tile, scene), expected[tile])
                    << "the scene's triangles by number, in the order in which they are drawn, in "
                    << "tile " << tile << " of " << tiling.count() << ", " << name_of(split);
            EXPECT_EQ(sum[Counter::triangles_in], count);
        }
}

TEST(Threading, HardCase_NothingToDraw) {
    look_up("Eq. 10.7");
    const Tiling tiling(Split::tiles, {64, 64}, 3, 16);
    ThreadPool pool(3);
    EXPECT_TRUE(BinnedTriangles(pool, Scene(), {}, mat4(1), tiling, Culling::none).batches.empty());
    // A mesh without triangles, one that is not taken, and one that nothing is left of.
    std::vector<Mesh> meshes(1);
    meshes.push_back(mesh_of({vec3(0), vec3(0.5f, 0, 0), vec3(0, 0.5f, 0)}, {{0, 1, 2}}));
    meshes[1].triangles[0].material = 1;
    meshes.push_back(mesh_of({vec3(NAN), vec3(5, 5, 0), vec3(0.1f, 0.1f, 0)},
                             {{0, 1, 2}, {1, 1, 1}, {2, 2, 2}}));
    const BinnedTriangles empty(pool, Scene(), pointers_to(meshes), mat4(1), tiling, Culling::none,
                                [](std::size_t material) { return material == 0; });
    ASSERT_EQ(empty.batches.size(), 1u);
    EXPECT_TRUE(empty.batches[0].triangles.empty());
    for (std::size_t tile = 0; tile < tiling.count(); ++tile)
        EXPECT_TRUE(empty.batches[0].of(tile).empty());
}

TEST(Threading, Eq10_7_HardCase_AnyThreadsAndSplitGiveTheSameBitsAHundredTimes) {
    lesson_10::Options options = small_picture();
    const ShadowAssets assets = lesson_10::make_assets(loaded("scene_bumpy.obj"), options);
    const Image<vec3> expected = expected_of(options, assets);
    for (const int threads : thread_counts) {
        ThreadPool pool(threads);
        for (const Split split : splits) {
            options.threads.split = split;
            for (int i = 0; i < repeats; ++i)
                ASSERT_TRUE(have_the_same_bits(lesson_10::render(options, assets, pool), expected))
                    << "beside lesson 09's picture, " << threads << " threads, " << name_of(split)
                    << ", run " << i + 1 << " of " << repeats;
        }
    }
}

TEST(Threading, Eq10_7_HardCase_AnyOrderOfTheTasksGivesTheSameBits) {
    for (const LightKind kind : light_kinds)
        for (const ivec2 size : {middling_size, {1, 1}, {1, 7}, {3, 61}}) {
            lesson_10::Options options = small_picture(size);
            options.shading.key_light = kind;
            const ShadowAssets assets = lesson_10::make_assets(loaded("scene_bumpy.obj"), options);
            const Image<vec3> expected = expected_of(options, assets);
            for (std::uint32_t seed = 0; seed < 12; ++seed) {
                ShuffledPool pool(1 + seed % 5 * 3, seed);
                options.threads.split = splits[seed % 3];
                options.threads.tile = seed % 2 ? 32 : 5;
                ASSERT_TRUE(have_the_same_bits(lesson_10::render(options, assets, pool), expected))
                    << "beside lesson 09's picture of " << size.x << " x " << size.y << "; "
                    << name_of(kind) << ", " << name_of(options.threads.split)
                    << ", tasks in any order (seed " << seed << ")";
            }
        }
}

TEST(Threading, HardCase_AllOptionsGiveTheSameBitsAndCountsAsLesson09) {
    look_up("Eq. 10.7");
    struct Case {
        const char* name;
        void (*turn)(lesson_10::Options&);
    };
    constexpr Case cases[] = {
        {"back faces", [](auto& o) { o.shading.two_sided = true; }},
        {"--all-effects", [](auto& o) { o.shading.all_effects = true; }},
        {"--depth", [](auto& o) { o.show_depth = true; }},
        {"--light point", [](auto& o) { o.shading.key_light = LightKind::point; }},
        {"--light spot", [](auto& o) { o.shading.key_light = LightKind::spot; }},
        {"--bias plane --pcf 7", [](auto& o) { o.shadow.bias = Bias::plane, o.shadow.pcf = 7; }},
        {"--normal-map none --bias normal",
         [](auto& o) { o.normal_map.space = MapSpace::none, o.shadow.bias = Bias::normal; }},
        {"much clipped", [](auto& o) { o.orbit.distance = 0.15f; }},
        {"next to nothing seen", [](auto& o) { o.orbit.distance = 1e6f; }},
        {"the eye below the floor", [](auto& o) { o.orbit.pitch_degrees = -90; }},
    };
    ThreadPool pool(3);
    for (const auto& [name, turn] : cases) {
        lesson_10::Options options = small_picture(middling_size);
        turn(options);
        const ShadowAssets assets = lesson_10::make_assets(loaded("scene_bumpy.obj"), options);
        const Drawn expected = drawn(options, assets, expected_of);
        for (const Split split : splits) {
            options.threads.split = split, options.threads.tile = split == Split::tiles ? 7 : 64;
            const Drawn actual = drawn(options, assets, [&](const auto& of, const auto& with) {
                return lesson_10::render(of, with, pool);
            });
            const std::string where =
                std::string("with ") + name + ", " + name_of(split) + ", beside lesson 09";
            ASSERT_TRUE(have_the_same_bits(actual.picture, expected.picture)) << where;
            ASSERT_EQ(actual.counters.values, expected.counters.values)
                << "counters, in the order of counter_names, " << where;
        }
    }
}

TEST(Threading, HardCase_AWorkerThatThrowsInAnyTask) {
    look_up("The pool");
    lesson_10::Options options = small_picture();
    const ShadowAssets assets = lesson_10::make_assets(loaded("scene_bumpy.obj"), options);
    const Image<vec3> expected = expected_of(options, assets);
    for (const int threads : {1, 2, 7, 61}) {
        ThreadPool pool(threads);
        constexpr long many = 1'000'000;
        TiredWorkers counting(pool, many);
        lesson_10::render(options, assets, counting);
        const long tasks = many - counting.tasks_left();
        ASSERT_GT(tasks, 3);
        for (long task = 1; task <= tasks; task += std::max(1L, tasks / 7)) {
            TiredWorkers tired(pool, task);
            EXPECT_THROW(lesson_10::render(options, assets, tired), std::runtime_error)
                << "task " << task << " of " << tasks << ", " << threads << " threads";
            ASSERT_TRUE(have_the_same_bits(lesson_10::render(options, assets, pool), expected))
                << "the picture after one in which a worker threw, " << threads << " threads";
        }
    }
}

TEST(Threading, HardCase_MapsHaveTheSameBitsAndNothingAroundThem) {
    look_up("Eq. 10.7");
    // In memory that holds other depths before, and that only the tiles clear.
    const Scene scene = loaded("scene_bumpy.obj");
    const ShadowBounds bounds = shadow_bounds(scene);
    const auto casts = [&](std::size_t material) {
        return casts_shadows(scene.materials[material]);
    };
    for (const int size : {16, 61}) {
        const Light light = raking_lights(LightKind::spot, scene.bounds())[0];
        const LightViews views = light_views(light, bounds.casters, bounds.receivers, size);
        for (const bool is_drawn : {true, false}) {
            const ShadowMap empty(views.clip_from_world[0], true, size, scene.bounds());
            ShadowMap expected = empty;
            const CountedSince serial;
            if (is_drawn)
                for (const Mesh& mesh : scene.meshes) draw_casters(expected, mesh, casts);
            const auto expected_counts = serial.values();
            for (const Split split : splits) {
                ShadowMap map = empty;
                std::ranges::fill(map.depths.depths().pixels(), 2.0f);
                ShuffledPool pool(5, 9);
                const CountedSince sum;
                draw_map(pool, map, scene, Tiling(split, ivec2(size), 5, 13), is_drawn);
                ASSERT_TRUE(are_equal(map.depths.depths(), expected.depths.depths()))
                    << "a map of " << size << " texels, which begins " << max_pcf_radius
                    << " texels from its memory's corner; " << name_of(split);
                ASSERT_EQ(sum.values(), expected_counts) << "counters";
            }
        }
    }
}

TEST(Threading, PictureOfTheSceneIsLesson09sByteForByte) {
    const std::string expected = bytes_of_picture("09_shadow_maps", {"--size", golden_size});
    ASSERT_GT(expected.size(), 100000u);
    EXPECT_TRUE(bytes_of_picture("10_threading", {"--size", golden_size}) == expected)
        << "10_threading.png is not 09_shadow_maps.png; ./tests/run --diagnose says where";
    for (const char* split : {"rows", "interleaved", "tiles"})
        EXPECT_TRUE(bytes_of_picture("10_threading", {"--size", golden_size, "--threads", "3",
                                                      "--split", split}) == expected)
            << "with --threads 3 --split " << split << " the picture is not lesson 09's";
}

TEST(Threading, PictureOfWhoDrewWhat) {
    // Threads would share out the tiles anew each time; this program's pool does not.
    EXPECT_TRUE(equals_golden("who_drew_what", "10_threading", {"--show-threads", "--tile", "64"}));
    EXPECT_TRUE(equals_golden("who_drew_what", "10_threading_rows",
                              {"--show-threads", "--tile", "64", "--split", "rows"}));
}
