// SPDX-License-Identifier: MIT
// Bins of triangles, the same bits whoever draws, counters, and the pictures.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

// All that the lessons' main.cpp include, so that they can be included within namespaces.
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "05_textures/bands.hpp"
#include "05_textures/textured_scene.hpp"
#include "06_phong/fragments.hpp"
#include "06_phong/many_samples.hpp"
#include "06_phong/shading_variants.hpp"
#include "08_normal_maps/bumpy_scene.hpp"
#include "08_normal_maps/normal_map_variants.hpp"
#include "09_shadow_maps/shadow_variants.hpp"
#include "09_shadow_maps/shadowed_scene.hpp"
#include "10_threading/binned_triangles.hpp"
#include "10_threading/thread_options.hpp"
#include "10_threading/thread_pool.hpp"
#include "10_threading/threaded_shadows.hpp"
#include "common/backdrop.hpp"
#include "common/lesson_app.hpp"
#include "common/obj.hpp"
#include "support/golden.hpp"
#include "support/lesson_process.hpp"
#include "support/look_up.hpp"
#include "support/pretend_pool.hpp"
#include "support/printers.hpp"

#define main main_of_lesson
namespace lesson_09 {
#include "09_shadow_maps/main.cpp"
}
namespace lesson {
#include "10_threading/main.cpp"
}
#undef main

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr std::array thread_counts = {1, 2, 3, 4, 7, 8, 16, 61};
constexpr std::array splits = {Split::rows, Split::interleaved, Split::tiles};
constexpr std::array kinds = {LightKind::directional, LightKind::point, LightKind::spot};

#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
constexpr int repeats = 2;  // each is looked at closely, and takes far longer
constexpr ivec2 middling_size(96, 54);
#else
constexpr int repeats = 100;
constexpr ivec2 middling_size(160, 90);
#endif

Scene loaded(const char* name) {
    return load_obj(std::filesystem::path(RASTERBOOK_ASSETS) / "models" / name);
}

lesson::Options small_picture(ivec2 size = {64, 36}) {
    lesson::Options options;
    options.size = size;
    options.shadow.size = 64;
    options.threads.tile = 8;
    return options;
}

/// What lesson 09 has of the same options.
lesson_09::Options without_threads(const lesson::Options& options) {
    lesson_09::Options same;
    static_cast<LessonOptions&>(same) = options;
    same.orbit = options.orbit, same.show_depth = options.show_depth;
    same.texture = options.texture, same.shading = options.shading;
    same.normal_map = options.normal_map, same.shadow = options.shadow;
    return same;
}

bool are_the_same_bits(const Image<vec3>& a, const Image<vec3>& b) {
    return a.size() == b.size() &&
           std::memcmp(a.pixels().data(), b.pixels().data(), a.pixels().size_bytes()) == 0;
}

/// Of all bits of a picture (FNV-1a).
std::uint64_t hash_of(const Image<vec3>& picture) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const std::byte byte : std::as_bytes(picture.pixels()))
        hash = (hash ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3u;
    return hash;
}

/// Counts as Counters does, until it has counted so many fragments: then it throws.
struct ThrowingCounters {
    static inline std::atomic<long> fragments_left = 0;

    void add(Counter counter) {
        if (counter == Counter::fragments_shaded && --fragments_left == 0)
            throw std::runtime_error("a worker is tired");
    }
    void add(const ThrowingCounters&) {}
};

/// Hands out tasks in order, each to a worker that is known beforehand.
struct OneByOnePool {
    static std::size_t worker_of(std::size_t task) { return (task * task + 3) % 5; }

    std::size_t size() const { return 5; }
    void run(std::size_t tasks, const auto& task) const {
        for (std::size_t i = 0; i < tasks; ++i) task(i, worker_of(i));
    }
};

/// The chunks' triangles of a part, in order, as their numbers in the meshes.
std::vector<std::size_t> listed(const BinnedTriangles& triangles, std::size_t part,
                                const Scene& scene) {
    std::vector<std::size_t> numbers;
    for (const Chunk& chunk : triangles.chunks)
        for (const std::size_t i : chunk.of(part)) {
            const ReadyTriangle& ready = chunk.triangles[i];
            std::size_t number =
                static_cast<std::size_t>(&ready.triangle - ready.mesh.triangles.data());
            for (const Mesh& mesh : scene.meshes) {
                if (&mesh == &ready.mesh) break;
                number += mesh.triangles.size();
            }
            numbers.push_back(number);
        }
    return numbers;
}

std::vector<const Mesh*> pointers_to(const std::vector<Mesh>& meshes) {
    std::vector<const Mesh*> pointers;
    for (const Mesh& mesh : meshes) pointers.push_back(&mesh);
    return pointers;
}

}  // namespace

TEST(Threading, Eq10_7_EachPartListsItsTrianglesInTheScenesOrder) {
    const Scene scene = loaded("scene_bumpy.obj");
    const std::vector<const Mesh*> meshes = pointers_to(scene.meshes);
    const ivec2 size(160, 90);
    const mat4 clip_from_world = orbit_camera(Orbit(), scene.bounds()).clip_from_world(size);
    for (const Split split : splits)
        for (const bool two_sided : {false, true}) {
            const Parts parts(split, size, 7, 16);
            // One after the other, as earlier lessons do it.
            std::vector<std::vector<std::size_t>> expected(parts.count());
            std::size_t number = 0;
            for (const Mesh& mesh : scene.meshes) {
                const std::vector<vec4> positions = transform(clip_from_world, mesh.positions);
                for (const Triangle& triangle : mesh.triangles) {
                    for (const ClippedTriangle& clipped :
                         clip_triangle(corners_of(triangle, positions))) {
                        const ScreenTriangle on_screen =
                            snap_triangle(screen_from_clip(clipped[0].position_clip, size),
                                          screen_from_clip(clipped[1].position_clip, size),
                                          screen_from_clip(clipped[2].position_clip, size));
                        if (two_sided ? on_screen.twice_area == 0 : on_screen.twice_area <= 0)
                            continue;
                        parts.for_each_in(box_around(on_screen), [&](std::size_t part) {
                            expected[part].push_back(number);
                        });
                    }
                    ++number;
                }
            }
            ASSERT_GT(number, 2 * least_in_chunk) << "several chunks";
            for (const std::size_t workers : {1u, 2u, 7u, 61u}) {
                ShuffledPool pool(workers, 5);
                WorkerCounters<Counters> counters(workers);
                const BinnedTriangles triangles(
                    pool, meshes, clip_from_world, parts, two_sided,
                    [](std::size_t) { return true; }, counters);
                EXPECT_EQ(triangles.chunks.size(), chunks_of(number));
                for (std::size_t part = 0; part < parts.count(); ++part)
                    ASSERT_EQ(listed(triangles, part, scene), expected[part])
                        << "split " << int(split) << ", part " << part;
                Counters sum;
                counters.add_to(sum);
                EXPECT_EQ(sum.values[std::size_t(Counter::triangles_in)], number);
            }
        }
}

TEST(Threading, HardCase_NothingToDraw) {
    look_up("Eq. 10.7");
    const Parts parts(Split::tiles, {64, 64}, 3, 16);
    ThreadPool pool(3);
    WorkerCounters<NoCounters> counters(3);
    const auto all = [](std::size_t) { return true; };
    const BinnedTriangles none(pool, {}, mat4(1), parts, true, all, counters);
    EXPECT_TRUE(none.chunks.empty());
    // A mesh without triangles, one that is not taken, and one that nothing is left of.
    std::vector<Mesh> meshes(3);
    meshes[1].positions = {vec3(0), vec3(0.5f, 0, 0), vec3(0, 0.5f, 0)};
    meshes[1].triangles = {{{Corner{0}, Corner{1}, Corner{2}}, 1}};
    meshes[2].positions = {vec3(NAN), vec3(5, 5, 0), vec3(0.1f, 0.1f, 0)};
    meshes[2].triangles = {{{Corner{0}, Corner{1}, Corner{2}}, 0},
                           {{Corner{1}, Corner{1}, Corner{1}}, 0},
                           {{Corner{2}, Corner{2}, Corner{2}}, 0}};
    const std::vector<const Mesh*> pointers = pointers_to(meshes);
    const BinnedTriangles empty(
        pool, pointers, mat4(1), parts, true, [](std::size_t material) { return material == 0; },
        counters);
    ASSERT_EQ(empty.chunks.size(), 1u);
    EXPECT_TRUE(empty.chunks[0].triangles.empty());
    for (std::size_t part = 0; part < parts.count(); ++part)
        EXPECT_TRUE(empty.chunks[0].of(part).empty());
}

TEST(Threading, Eq10_7_HardCase_AnyThreadsAndSplitGiveTheSameBitsAHundredTimes) {
    lesson::Options options = small_picture();
    const ShadowedScene scene(loaded("scene_bumpy.obj"), options);
    NoCounters none;
    const Image<vec3> expected = lesson_09::render(without_threads(options), scene, none);
    const std::uint64_t hash = hash_of(expected);
    for (const int threads : thread_counts) {
        ThreadPool pool(threads);
        for (const Split split : splits) {
            options.threads.split = split;
            for (int i = 0; i < repeats; ++i)
                ASSERT_EQ(hash_of(lesson::render(options, scene, pool, none)), hash)
                    << threads << " threads, split " << int(split) << ", the " << i + 1
                    << "th time";
        }
    }
}

TEST(Threading, Eq10_7_HardCase_AnyOrderOfTheTasksGivesTheSameBits) {
    lesson::Options options = small_picture(middling_size);
    NoCounters none;
    for (const LightKind kind : kinds) {
        options.shading.key_light = kind;
        const ShadowedScene scene(loaded("scene_bumpy.obj"), options);
        const Image<vec3> expected = lesson_09::render(without_threads(options), scene, none);
        for (std::uint32_t seed = 0; seed < 12; ++seed) {
            ShuffledPool pool(1 + seed % 5 * 3, seed);
            options.threads.split = splits[seed % 3];
            options.threads.tile = seed % 2 ? 32 : 5;
            ASSERT_TRUE(are_the_same_bits(lesson::render(options, scene, pool, none), expected))
                << "light " << int(kind) << ", seed " << seed;
        }
    }
}

TEST(Threading, HardCase_AllKnobsGiveTheSameBitsAndCountsAsLesson09) {
    look_up("Eq. 10.7");
    std::vector<lesson::Options> knobs(12, small_picture(middling_size));
    knobs[1].shading.two_sided = true;
    knobs[2].shading.all_effects = true;
    knobs[3].show_depth = true;
    knobs[4].texture.filter = Filter::nearest;
    knobs[5].shading.key_light = LightKind::point;
    knobs[6].shading.key_light = LightKind::spot;
    knobs[7].shadow.bias = Bias::plane, knobs[7].shadow.pcf = 7;
    knobs[8].orbit.distance = 0.15f;  // much is clipped
    knobs[9].orbit.distance = 1e6f;   // next to nothing is seen
    knobs[10].normal_map.space = MapSpace::none, knobs[10].shadow.bias = Bias::normal;
    knobs[11].orbit.pitch_degrees = -90;  // from below
    ThreadPool pool(3);
    for (std::size_t k = 0; k < knobs.size(); ++k) {
        lesson::Options& options = knobs[k];
        const ShadowedScene scene(loaded("scene_bumpy.obj"), options);
        Counters expected_counts;
        const Image<vec3> expected =
            lesson_09::render(without_threads(options), scene, expected_counts);
        for (const Split split : splits)
            for (const int tile : {7, 64}) {
                if (tile == 64 && repeats < 100) continue;
                options.threads.split = split, options.threads.tile = tile;
                Counters counts;
                const Image<vec3> picture = lesson::render(options, scene, pool, counts);
                EXPECT_TRUE(are_the_same_bits(picture, expected))
                    << "knobs " << k << ", split " << int(split) << ", tile " << tile;
                for (std::size_t i = 0; i < counter_names.size(); ++i)
                    EXPECT_EQ(counts.values[i], expected_counts.values[i])
                        << counter_names[i] << ", knobs " << k << ", split " << int(split)
                        << ", tile " << tile;
            }
    }
}

TEST(Threading, HardCase_PicturesOfAFewPixels) {
    look_up("Eq. 10.3");
    NoCounters none;
    for (const ivec2 size : {ivec2(1, 1), {1, 7}, {7, 1}, {2, 2}, {3, 61}}) {
        lesson::Options options = small_picture(size);
        options.shadow.size = 16;
        const ShadowedScene scene(loaded("scene_bumpy.obj"), options);
        const Image<vec3> expected = lesson_09::render(without_threads(options), scene, none);
        for (const int threads : thread_counts) {
            ThreadPool pool(threads);
            for (const Split split : splits)
                for (const int tile : {1, 64}) {
                    options.threads.split = split, options.threads.tile = tile;
                    EXPECT_TRUE(
                        are_the_same_bits(lesson::render(options, scene, pool, none), expected))
                        << size.x << "x" << size.y << ", " << threads << " threads, split "
                        << int(split) << ", tile " << tile;
                }
        }
    }
}

TEST(Threading, HardCase_AWorkerThatThrowsWhileItDraws) {
    look_up("The pool");
    lesson::Options options = small_picture();
    const ShadowedScene scene(loaded("scene_bumpy.obj"), options);
    NoCounters none;
    const Image<vec3> expected = lesson_09::render(without_threads(options), scene, none);
    for (const int threads : thread_counts) {
        ThreadPool pool(threads);
        for (const Split split : splits)
            for (const long fragments : {1, 500}) {
                options.threads.split = split;
                ThrowingCounters::fragments_left = fragments;
                ThrowingCounters counters;
                try {
                    lesson::render(options, scene, pool, counters);
                    ADD_FAILURE() << "nothing arrived, " << threads << " threads";
                } catch (const std::runtime_error& error) {
                    EXPECT_STREQ(error.what(), "a worker is tired");
                }
                EXPECT_TRUE(are_the_same_bits(lesson::render(options, scene, pool, none), expected))
                    << "afterwards, " << threads << " threads";
            }
    }
}

TEST(Threading, HardCase_MapsHaveTheSameBitsAndNothingAroundThem) {
    look_up("Eq. 10.7");
    // Memory in which ones and zeros stood before, and is not cleared but by the parts.
    lesson::Options options;
    for (const LightKind kind : kinds)
        for (const int size : {16, 61}) {
            options.shadow.size = size;
            const ShadowedScene scene(loaded("scene_bumpy.obj"), options);
            const Light light = raking_lights(kind, scene.bounds())[0];
            const LightViews views = light_views(light, scene.casters, scene.receivers, size);
            const auto map_of = [&](std::size_t i) {
                return ShadowMap(views.clip_from_world[i], views.is_perspective, size,
                                 scene.bounds());
            };
            for (std::size_t i = 0; i < views.count; ++i)
                for (const bool is_drawn : {true, false}) {
                    ShadowMap expected = map_of(i);
                    Counters serial;
                    const auto casts = [&](std::size_t material) { return scene.casts(material); };
                    if (is_drawn)
                        for (const Mesh& mesh : scene.meshes)
                            draw_casters(expected, mesh, casts, serial);
                    for (const Split split : splits) {
                        ShadowMap map = map_of(i);
                        const ivec2 all = map.depths.depths().size();
                        for (int y = 0; y < all.y; ++y)
                            for (int x = 0; x < all.x; ++x) map.depths.test_and_write({x, y}, -1);
                        ShuffledPool pool(5, 9);
                        WorkerCounters<Counters> counters(5);
                        draw_map(pool, map, scene, Parts(split, ivec2(size), 5, 13), is_drawn,
                                 counters);
                        EXPECT_TRUE(map.depths.depths() == expected.depths.depths())
                            << "light " << int(kind) << ", size " << size << ", split "
                            << int(split);
                        Counters sum;
                        counters.add_to(sum);
                        EXPECT_EQ(sum.values, serial.values);
                    }
                }
        }
}

TEST(Threading, HardCase_WhoDrewWhatIsShownAsItWas) {
    look_up("Eq. 10.5");
    // Each part alone, by a worker that is known: the tint is that of its colour.
    lesson::Options options = small_picture(middling_size);
    const ShadowedScene scene(loaded("scene_bumpy.obj"), options);
    NoCounters none;
    OneByOnePool pool;
    for (const Split split : splits) {
        options.threads.split = split, options.threads.show = false;
        Image<vec3> expected = lesson::render(options, scene, pool, none);
        const Parts parts = options.threads.parts_of(options.size, pool.size());
        for (std::size_t i = 0; i < parts.count(); ++i) tint(expected, parts[i], pool.worker_of(i));
        options.threads.show = true;
        EXPECT_TRUE(are_the_same_bits(lesson::render(options, scene, pool, none), expected));
    }
    // What was brighter is brighter still, in each colour, and none is black.
    for (std::size_t worker = 0; worker < 8; ++worker) {
        float before = 0;
        for (const float light : {0.0f, 0.01f, 0.1f, 0.3f, 1.0f, 3.0f}) {
            Image<vec3> pixels({3, 3}, vec3(light));
            tint(pixels, Parts(Split::tiles, {3, 3}, 1, 8)[0], worker);
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
    EXPECT_TRUE(file_of("10_threading", {}) == expected);
    for (const char* split : {"rows", "interleaved", "tiles"})
        EXPECT_TRUE(file_of("10_threading", {"--threads", "3", "--split", split}) == expected)
            << split;
}

TEST(Threading, PictureOfWhoDrewWhat) {
    // Threads would share it out anew each time; these do not.
    lesson::Options options;
    options.size = {960, 540};
    options.threads.show = true, options.threads.tile = 64;
    const ShadowedScene scene(loaded("scene_bumpy.obj"), options);
    NoCounters none;
    ShuffledPool by_chance(4, 1);
    EXPECT_TRUE(equals_golden(lesson::render(options, scene, by_chance, none), "10_threading"));
    struct {
        std::size_t size() const { return 4; }
        void run(std::size_t tasks, const std::function<void(std::size_t, std::size_t)>& task) {
            for (std::size_t i = 0; i < tasks; ++i) task(i, i % 4);
        }
    } in_turn;
    options.threads.split = Split::rows;
    EXPECT_TRUE(equals_golden(lesson::render(options, scene, in_turn, none), "10_threading_rows"));
}
