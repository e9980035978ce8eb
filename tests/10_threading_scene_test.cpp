// SPDX-License-Identifier: MIT
// Bins of triangles, the same bits whichever thread draws, counters, and the pictures.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
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

/// What lesson 09 has of the same options.
lesson_09::Options without_threads(const lesson_10::Options& options) {
    lesson_09::Options same;
    static_cast<LessonOptions&>(same) = options;
    same.orbit = options.orbit, same.show_depth = options.show_depth;
    same.texture = options.texture, same.shading = options.shading;
    same.normal_map = options.normal_map, same.shadow = options.shadow;
    return same;
}

/// The picture that lesson 09 draws.
Image<vec3> expected_of(const lesson_10::Options& options, const ShadowAssets& assets) {
    return lesson_09::render(without_threads(options), assets);
}

/// Of all bits of a picture (FNV-1a).
std::uint64_t hash_of(const Image<vec3>& picture) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const std::byte byte : std::as_bytes(picture.pixels()))
        hash = (hash ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3u;
    return hash;
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

/// Hands out tasks in order, each to a worker that is known beforehand.
struct OneByOnePool : Workers {
    static std::size_t worker_of(std::size_t task) { return (task * task + 3) % 5; }

    std::size_t size() const override { return 5; }
    void run_tasks(std::size_t tasks, const Task& task) override {
        for (std::size_t i = 0; i < tasks; ++i) task(i, worker_of(i));
    }
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
    Mesh mesh = mesh_of({{-0.9f, -0.5f, 0},
                         {-0.1f, -0.5f, 0},
                         {-0.5f, 0.5f, 0},
                         {0.9f, -0.5f, 0},
                         {0.1f, -0.5f, 0},
                         {0.5f, 0.5f, 0}},
                        {{0, 1, 2}, {0, 3, 2}, {4, 3, 5}});
    const std::vector<const Mesh*> meshes = {&mesh};
    const Tiling tiling(Split::tiles, {32, 16}, 1, 16);
    ThreadPool pool(1);
    const BinnedTriangles binned(pool, Scene(), meshes, mat4(1), tiling, Culling::none);
    ASSERT_EQ(binned.batches.size(), 1u);
    ASSERT_EQ(binned.batches[0].triangles.size(), 3u);
    for (std::size_t tile = 0; tile < 2; ++tile) {
        const auto of = binned.batches[0].of(tile);
        const std::vector<std::uint32_t> expected = {static_cast<std::uint32_t>(tile),
                                                     static_cast<std::uint32_t>(tile) + 1};
        ASSERT_EQ(std::vector(of.begin(), of.end()), expected)
            << "triangles listed for the tile on the " << (tile == 0 ? "left" : "right")
            << ", in the scene's order: 0 lies on the left, 1 on both sides, 2 on the right";
    }
}

TEST(Threading, HardCase_LargeTrianglesAreInNoTilesList) {
    look_up("Large triangles and slivers");
    // In 4,096 tiles; triangles 1 and 3 reach over half of the picture.
    const Mesh mesh = mesh_of({{-0.95f, -0.95f, 0},
                               {-0.9f, -0.95f, 0},
                               {-0.95f, -0.9f, 0},
                               {-1, -1, 0},
                               {1, -1, 0},
                               {-1, 1, 0}},
                              {{0, 1, 2}, {3, 4, 5}, {0, 1, 2}, {3, 4, 5}, {0, 1, 2}});
    const std::vector<const Mesh*> meshes = {&mesh};
    const Tiling tiling(Split::tiles, {512, 512}, 1, 8);
    ThreadPool pool(1);
    const BinnedTriangles binned(pool, Scene(), meshes, mat4(1), tiling, Culling::none);
    const TriangleBatch& batch = binned.batches.at(0);
    std::size_t with_small = 0;
    for (std::size_t tile = 0; tile < tiling.count(); ++tile) {
        std::vector<std::size_t> expected = {1, 3};
        if (!batch.of(tile).empty()) expected = {0, 1, 2, 3, 4}, ++with_small;
        std::vector<std::size_t> numbers;
        binned.for_each_in(tile, [&](const ProjectedTriangle& projected) {
            numbers.push_back(
                static_cast<std::size_t>(&projected.triangle - mesh.triangles.data()));
        });
        ASSERT_EQ(numbers, expected) << "in the scene's order, in tile " << tile;
        ASSERT_EQ(binned.count_in(tile), expected.size()) << "triangles in tile " << tile;
        ASSERT_LE(batch.of(tile).size(), 3u) << "the large ones are in no list, tile " << tile;
    }
    EXPECT_EQ(with_small, 9u) << "tiles that list the small triangles";
    double work = 0;
    for (const ProjectedTriangle& projected : batch.triangles)
        work += drawing_work(projected.on_screen);
    const double area = 2 * 512 * 512 / 2 + 3 * 12.8 * 12.8 / 2;
    const double borders = 4 * (2 * 2 * 512 + 3 * 2 * 13);
    EXPECT_NEAR(work, area + borders, 4 * 6) << "pixels that are looked at";
}

TEST(Threading, HardCase_ASliverIsListedWhereItIs) {
    look_up("Large triangles and slivers");
    std::mt19937 random(6);
    std::uniform_real_distribution<float> anywhere(-3, 303);
    const Tiling tiling(Split::tiles, {300, 200}, 1, 8);
    std::size_t listed = 0, in_boxes = 0;
    for (int i = 0; i < 500; ++i) {
        const vec2 a(anywhere(random), anywhere(random)), b(anywhere(random), anywhere(random));
        const bool is_sliver = i % 2 == 0;
        const vec2 c = is_sliver ? b + vec2(1, -1) : vec2(anywhere(random), anywhere(random));
        const ScreenTriangle triangle = snap_triangle(a, b, c);
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
    const std::vector<const Mesh*> meshes = pointers_to(scene.meshes);
    const ivec2 size(160, 90);
    const mat4 clip_from_world = orbit_camera(Orbit(), scene.bounds()).clip_from_world(size);
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
            std::size_t count = 0;
            for (const Mesh& mesh : scene.meshes) count += mesh.triangles.size();
            ASSERT_GT(count, 2 * batch_size) << "several batches";
            for (const std::size_t workers : {1u, 2u, 7u, 61u}) {
                ShuffledPool pool(workers, 5);
                const CountedSince sum;
                const BinnedTriangles triangles(pool, scene, meshes, clip_from_world, tiling,
                                                culling);
                const std::size_t batches = triangles.batches.size();
                ASSERT_EQ(batches, batches_of(count));
                for (std::size_t b = 0; b < batches; ++b)
                    for (const ProjectedTriangle& projected : triangles.batches[b].triangles) {
                        const std::size_t number = number_of(projected, scene);
                        ASSERT_TRUE(b * count / batches <= number &&
                                    number < (b + 1) * count / batches)
                            << "batch " << b << " of " << batches << " has the scene's triangle "
                            << number << " of " << count
                            << ": each has as many as the others, the first ones in the first";
                    }
                for (std::size_t tile = 0; tile < tiling.count(); ++tile)
                    ASSERT_EQ(listed(triangles, tile, scene), expected[tile])
                        << "the scene's triangles by number, in the order in which they are drawn, "
                        << "in tile " << tile << " of " << tiling.count() << ", " << name_of(split)
                        << ", " << workers << " workers";
                EXPECT_EQ(sum.values()[std::size_t(Counter::triangles_in)], count);
            }
        }
}

TEST(Threading, HardCase_NothingToDraw) {
    look_up("Eq. 10.7");
    const Tiling tiling(Split::tiles, {64, 64}, 3, 16);
    MeasuredPool idle(3);
    const BinnedTriangles none(idle, Scene(), {}, mat4(1), tiling, Culling::none);
    EXPECT_TRUE(none.batches.empty());
    for (const std::vector<double>& tasks_ms : idle.jobs_ms)
        EXPECT_TRUE(tasks_ms.empty()) << "without positions and triangles there is no task";
    ThreadPool pool(3);
    // A mesh without triangles, one that is not taken, and one that nothing is left of.
    std::vector<Mesh> meshes(3);
    meshes[1].positions = {vec3(0), vec3(0.5f, 0, 0), vec3(0, 0.5f, 0)};
    meshes[1].triangles = {{{Vertex{0}, Vertex{1}, Vertex{2}}, 1}};
    meshes[2].positions = {vec3(NAN), vec3(5, 5, 0), vec3(0.1f, 0.1f, 0)};
    meshes[2].triangles = {{{Vertex{0}, Vertex{1}, Vertex{2}}, 0},
                           {{Vertex{1}, Vertex{1}, Vertex{1}}, 0},
                           {{Vertex{2}, Vertex{2}, Vertex{2}}, 0}};
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
    const std::uint64_t hash = hash_of(expected);
    for (const int threads : thread_counts) {
        ThreadPool pool(threads);
        for (const Split split : splits) {
            options.threads.split = split;
            for (int i = 0; i < repeats; ++i)
                if (const Image<vec3> picture = lesson_10::render(options, assets, pool);
                    hash_of(picture) != hash) {
                    FAIL() << "not the bits of lesson 09's picture, " << threads << " threads, "
                           << name_of(split) << ", run " << i + 1 << " of " << repeats << ": "
                           << have_the_same_bits(picture, expected).message();
                }
        }
    }
}

TEST(Threading, Eq10_7_HardCase_AnyOrderOfTheTasksGivesTheSameBits) {
    lesson_10::Options options = small_picture(middling_size);
    for (const LightKind kind : light_kinds) {
        options.shading.key_light = kind;
        const ShadowAssets assets = lesson_10::make_assets(loaded("scene_bumpy.obj"), options);
        const Image<vec3> expected = expected_of(options, assets);
        for (std::uint32_t seed = 0; seed < 12; ++seed) {
            ShuffledPool pool(1 + seed % 5 * 3, seed);
            options.threads.split = splits[seed % 3];
            options.threads.tile = seed % 2 ? 32 : 5;
            ASSERT_TRUE(have_the_same_bits(lesson_10::render(options, assets, pool), expected))
                << "beside lesson 09's picture; " << name_of(kind) << ", "
                << name_of(options.threads.split) << ", tasks in any order (seed " << seed << ")";
        }
    }
}

TEST(Threading, HardCase_AllOptionsGiveTheSameBitsAndCountsAsLesson09) {
    look_up("Eq. 10.7");
    std::vector<lesson_10::Options> all_options(12, small_picture(middling_size));
    all_options[1].shading.two_sided = true;
    all_options[2].shading.all_effects = true;
    all_options[3].show_depth = true;
    all_options[4].texture.filter = Filter::nearest;
    all_options[5].shading.key_light = LightKind::point;
    all_options[6].shading.key_light = LightKind::spot;
    all_options[7].shadow.bias = Bias::plane, all_options[7].shadow.pcf = 7;
    all_options[8].orbit.distance = 0.15f;  // much is clipped
    all_options[9].orbit.distance = 1e6f;   // next to nothing is seen
    all_options[10].normal_map.space = MapSpace::none, all_options[10].shadow.bias = Bias::normal;
    all_options[11].orbit.pitch_degrees = -90;  // from below
    constexpr std::array names_of_options = {"no option",
                                             "back faces",
                                             "--all-effects",
                                             "--depth",
                                             "--filter nearest",
                                             "--light point",
                                             "--light spot",
                                             "--bias plane --pcf 7",
                                             "much clipped",
                                             "next to nothing seen",
                                             "--normal-map none --bias normal",
                                             "the eye below the floor"};
    ThreadPool pool(3);
    for (std::size_t k = 0; k < all_options.size(); ++k) {
        lesson_10::Options& options = all_options[k];
        const ShadowAssets assets = lesson_10::make_assets(loaded("scene_bumpy.obj"), options);
        const CountedSince begin;
        const Image<vec3> expected = expected_of(options, assets);
        const Counters expected_counts = begin;
        for (const Split split : splits)
            for (const int tile : {7, 64}) {
                if (tile == 64 && repeats < 100) continue;
                options.threads.split = split, options.threads.tile = tile;
                const CountedSince counts;
                const Image<vec3> picture = lesson_10::render(options, assets, pool);
                const std::string where = std::string("with ") + names_of_options[k] + ", " +
                                          name_of(split) + ", tile side " + std::to_string(tile) +
                                          ", beside lesson 09";
                ASSERT_TRUE(have_the_same_bits(picture, expected)) << where;
                for (std::size_t i = 0; i < counter_names.size(); ++i)
                    ASSERT_EQ(counts.values()[i], expected_counts.values[i])
                        << "the counter " << counter_names[i] << ' ' << where;
            }
    }
}

TEST(Threading, HardCase_PicturesOfAFewPixels) {
    look_up("Eq. 10.3");
    for (const ivec2 size : {ivec2(1, 1), {1, 7}, {7, 1}, {2, 2}, {3, 61}}) {
        lesson_10::Options options = small_picture(size);
        options.shadow.size = 16;
        const ShadowAssets assets = lesson_10::make_assets(loaded("scene_bumpy.obj"), options);
        const Image<vec3> expected = expected_of(options, assets);
        for (const int threads : thread_counts) {
            ThreadPool pool(threads);
            for (const Split split : splits)
                for (const int tile : {1, 64}) {
                    options.threads.split = split, options.threads.tile = tile;
                    ASSERT_TRUE(
                        have_the_same_bits(lesson_10::render(options, assets, pool), expected))
                        << "a picture of " << size.x << " x " << size.y << ", " << threads
                        << " threads, " << name_of(split) << ", tile side " << tile;
                }
        }
    }
}

TEST(Threading, HardCase_AWorkerThatThrowsInAnyTask) {
    look_up("The pool");
    lesson_10::Options options = small_picture();
    const ShadowAssets assets = lesson_10::make_assets(loaded("scene_bumpy.obj"), options);
    const Image<vec3> expected = expected_of(options, assets);
    for (const int threads : thread_counts) {
        ThreadPool pool(threads);
        for (const Split split : splits) {
            options.threads.split = split;
            constexpr long many = 1'000'000;
            TiredWorkers counting(pool, many);
            lesson_10::render(options, assets, counting);
            const long tasks = many - counting.tasks_left();
            ASSERT_GT(tasks, 3);
            for (long task = 1; task <= tasks; task += std::max(1L, tasks / 7)) {
                TiredWorkers tired(pool, task);
                try {
                    lesson_10::render(options, assets, tired);
                    FAIL() << "task " << task << " of " << tasks << " throws, with " << threads
                           << " threads, " << name_of(split) << ", and render() does not";
                } catch (const std::runtime_error& error) {
                    EXPECT_STREQ(error.what(), "a worker is tired");
                }
                ASSERT_TRUE(have_the_same_bits(lesson_10::render(options, assets, pool), expected))
                    << "the picture after one in which a worker threw, " << threads << " threads";
            }
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
    for (const LightKind kind : light_kinds)
        for (const int size : {16, 61}) {
            const Light light = raking_lights(kind, scene.bounds())[0];
            const LightViews views = light_views(light, bounds.casters, bounds.receivers, size);
            const auto map_of = [&](std::size_t i) {
                return ShadowMap(views.clip_from_world[i], views.is_perspective, size,
                                 scene.bounds());
            };
            for (std::size_t i = 0; i < views.count; ++i)
                for (const bool is_drawn : {true, false}) {
                    ShadowMap expected = map_of(i);
                    const CountedSince begin;
                    if (is_drawn)
                        for (const Mesh& mesh : scene.meshes) draw_casters(expected, mesh, casts);
                    const Counters serial = begin;
                    for (const Split split : splits) {
                        ShadowMap map = map_of(i);
                        const ivec2 all = map.depths.depths().size();
                        for (int y = 0; y < all.y; ++y)
                            for (int x = 0; x < all.x; ++x) map.depths.depths()[{x, y}] = 2;
                        ShuffledPool pool(5, 9);
                        const CountedSince sum;
                        draw_map(pool, map, scene, Tiling(split, ivec2(size), 5, 13), is_drawn);
                        ASSERT_TRUE(are_equal(map.depths.depths(), expected.depths.depths()))
                            << "a map of " << size << " texels, which begins " << max_pcf_radius
                            << " texels from its memory's corner; " << name_of(kind) << ", "
                            << name_of(split);
                        ASSERT_EQ(sum.values(), serial.values) << "counters";
                    }
                }
        }
}

TEST(Threading, HardCase_WhoDrewWhatIsShownAsItWas) {
    look_up("Eq. 10.5");
    // Each tile by a worker that is known: it is tinted in that worker's colour.
    lesson_10::Options options = small_picture(middling_size);
    const ShadowAssets assets = lesson_10::make_assets(loaded("scene_bumpy.obj"), options);
    OneByOnePool pool;
    for (const Split split : splits) {
        options.threads.split = split, options.threads.show = false;
        Image<vec3> expected = lesson_10::render(options, assets, pool);
        const Tiling tiling = options.threads.tiling_of(options.size, pool.size());
        for (std::size_t i = 0; i < tiling.count(); ++i)
            tint(expected, tiling[i], pool.worker_of(i));
        options.threads.show = true;
        EXPECT_TRUE(have_the_same_bits(lesson_10::render(options, assets, pool), expected))
            << "with --show-threads, " << name_of(split);
    }
    // What was brighter is brighter still, in each colour, and none is black.
    for (std::size_t worker = 0; worker < 8; ++worker) {
        float before = 0;
        for (const float light : {0.0f, 0.01f, 0.1f, 0.3f, 1.0f, 3.0f}) {
            Image<vec3> pixels({3, 3}, vec3(light));
            tint(pixels, Tiling(Split::tiles, {3, 3}, 1, 8)[0], worker);
            const float now = glm::dot(pixels[{1, 1}], vec3(0.2126f, 0.7152f, 0.0722f));
            EXPECT_GT(now, before) << "worker " << worker << ", light " << light;
            before = now;
        }
    }
}

TEST(Threading, PictureOfTheSceneIsLesson09sByteForByte) {
    const auto folder = fresh_folder("threading");
    const auto file_of = [&](const std::string& lesson, std::vector<std::string> arguments) {
        const std::string file = (folder / (lesson + ".png")).string();
        arguments.insert(arguments.end(), {"--size", golden_size, "--out", file});
        const ProcessResult run = run_program(lesson, arguments);
        EXPECT_EQ(run.exit_status, 0) << lesson << ": " << run.err;
        return read_text(file);
    };
    const std::string expected = file_of("09_shadow_maps", {});
    ASSERT_GT(expected.size(), 100000u);
    EXPECT_TRUE(file_of("10_threading", {}) == expected)
        << "10_threading.png is not 09_shadow_maps.png; ./tests/run --diagnose says where";
    for (const char* split : {"rows", "interleaved", "tiles"})
        EXPECT_TRUE(file_of("10_threading", {"--threads", "3", "--split", split}) == expected)
            << "with --threads 3 --split " << split << " the picture is not lesson 09's";
}

TEST(Threading, PictureOfWhoDrewWhat) {
    // Threads would share out the tiles anew each time; this program's pool does not.
    EXPECT_TRUE(equals_golden("who_drew_what", "10_threading", {"--show-threads", "--tile", "64"}));
    EXPECT_TRUE(equals_golden("who_drew_what", "10_threading_rows",
                              {"--show-threads", "--tile", "64", "--split", "rows"}));
}
