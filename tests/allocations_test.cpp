// SPDX-License-Identifier: MIT
// Drawing allocates memory for pictures and meshes, never for a triangle or a pixel.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "12_visibility_buffer/visibility_buffer.hpp"
#include "support/lesson_04.hpp"
#include "support/lesson_05.hpp"
#include "support/lesson_06.hpp"
#include "support/lesson_07.hpp"
#include "support/lesson_08.hpp"
#include "support/lesson_09.hpp"
#include "support/lesson_10.hpp"
#include "support/lesson_12.hpp"
#include "support/lesson_13.hpp"
#include "support/lesson_process.hpp"
#include "support/pictures.hpp"
#include "support/projected.hpp"

using namespace rasterbook;

namespace {

std::atomic<std::size_t> allocations, bytes_allocated;  // operator new has nowhere else to count
std::atomic<std::ptrdiff_t> until_one_fails = 0;        // 0: none does
std::atomic<int> failures = 0;

}  // namespace

// Not inlined: g++ would complain of free() after what it takes for another operator new.
[[gnu::noinline]] void* operator new(std::size_t bytes) {
    ++allocations, bytes_allocated += bytes;
    if (until_one_fails > 0 && --until_one_fails == 0) {
        ++failures;
        throw std::bad_alloc();
    }
    if (void* const memory = std::malloc(bytes == 0 ? 1 : bytes)) return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace {

/// How many allocations `work` makes.
template <typename Work>
std::size_t allocations_of(const Work& work) {
    const std::size_t before = allocations;
    work();
    return allocations - before;
}

/// Two waves of side * side squares, in two meshes, with uv.
Scene waves(int side) {
    Scene scene;
    scene.materials.resize(2);
    for (int wave = 0; wave < 2; ++wave) {
        Mesh& mesh = scene.meshes.emplace_back();
        for (int y = 0; y <= side; ++y)
            for (int x = 0; x <= side; ++x) {
                const vec2 at = vec2(x, y) / static_cast<float>(side);
                mesh.positions.emplace_back(2 * at.x - 1,
                                            0.2f * std::sin(9 * at.x) + static_cast<float>(wave),
                                            1 - 2 * at.y);
                mesh.uvs.push_back(4.0f * at);
                mesh.bounds.add(mesh.positions.back());
            }
        const auto vertex = [&](int x, int y) {
            const auto index = static_cast<std::uint32_t>(y * (side + 1) + x);
            return Vertex{index, index};
        };
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                mesh.triangles.push_back(
                    {{vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1)}, 1});
                mesh.triangles.push_back(
                    {{vertex(x, y), vertex(x + 1, y + 1), vertex(x, y + 1)}, 1});
            }
    }
    return scene;
}

std::shared_ptr<const Texture> texture_of(vec4 texel) {
    return std::make_shared<const Texture>(
        make_texture(Image<vec4>({16, 16}, texel), Wrap::repeat));
}

void expect_many(const Counters& counters, Counter counter) {
    const auto i = static_cast<std::size_t>(counter);
    EXPECT_GT(counters.values[i], 1000u) << counter_names[i];
}

/// For EXPECT_TRUE: a picture of n triangles and one of 16 n make as many allocations, seen from
/// outside, and from so near that many triangles are clipped.
template <typename Options, typename Draw>
testing::AssertionResult does_not_depend_on_triangles(Options options, const Draw& draw) {
    options.size = {96, 64};
    for (const float distance : {1.4f, 0.2f}) {
        options.orbit.distance = distance;
        const std::size_t few = draw(options, waves(8)), many = draw(options, waves(32));
        if (few != many || few == 0)
            return testing::AssertionFailure() << few << " and " << many << " allocations";
        options.size = 2 * options.size;
        if (const std::size_t large = draw(options, waves(8)); large != few)
            return testing::AssertionFailure()
                   << few << " and, for four times as many pixels, " << large << " allocations";
        options.size = options.size / 2;
    }
    return testing::AssertionSuccess();
}

/// Runs a lesson's program on three threads, once as it is, and then so that one of the allocations
/// of its picture fails: the program has to end in one line and leave no file.
///
/// @param run_with  Called as run_with(argc, argv, begin, end): runs the program, whose render()
///                  calls begin() and end().
template <typename RunWith>
void expect_one_line_for_each_failure(const char* lesson, const RunWith& run_with) {
    const std::filesystem::path folder = test::fresh_folder("allocations");
    std::vector<std::string> words = {
        lesson,      "--model", "crate.obj", "--size", "96x54", "--shadow-size",       "128",
        "--threads", "3",       "--tile",    "16",     "--out", folder / "picture.png"};
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    std::size_t before = 0, count = 0;
    const auto status_when = [&](std::ptrdiff_t fails) {
        return run_with(
            static_cast<int>(argv.size()), argv.data(),
            [&] { before = allocations, until_one_fails = fails; },
            [&] { until_one_fails = 0, count = allocations - before; });
    };
    ASSERT_EQ(status_when(0), 0);
    const auto all = static_cast<std::ptrdiff_t>(count);
    ASSERT_GT(all, 20);
    failures = 0;
    for (std::ptrdiff_t fails = 1; fails < all; fails += all / 16) {
        std::filesystem::remove(folder / "picture.png");
        const int failures_before = failures;
        testing::internal::CaptureStderr();
        const int status = status_when(fails);
        const std::string said = testing::internal::GetCapturedStderr();
        until_one_fails = 0;
        const bool has_failed = failures > failures_before;  // a worker may sleep through it all
        ASSERT_EQ(status, has_failed ? 1 : 0)
            << "allocation " << fails << " of about " << all << " of " << lesson;
        ASSERT_EQ(said, has_failed ? "error: not enough memory for this model at this size\n" : "");
        ASSERT_EQ(std::filesystem::is_empty(folder), has_failed);
    }
    EXPECT_GT(failures, 8);
}

}  // namespace

TEST(Allocations, AreCounted) {
    EXPECT_EQ(allocations_of([] {}), 0u);
    std::vector<std::vector<int>> kept;
    EXPECT_EQ(allocations_of([&] { kept.emplace_back(3); }), 2u);
    EXPECT_EQ(kept.at(0).size(), 3u);
}

TEST(Allocations, OfLesson04DoNotDependOnTriangles) {
    EXPECT_TRUE(
        does_not_depend_on_triangles(PotOptions(), [](const auto& options, const Scene& scene) {
            const test::CountedSince counters;
            const std::size_t count = allocations_of([&] { lesson_04::render(options, scene); });
            expect_many(counters, Counter::fragments_shaded);
            return count;
        }));
}

TEST(Allocations, OfLesson05DoNotDependOnTriangles) {
    for (const Filter filter : {Filter::nearest, Filter::bilinear, Filter::trilinear}) {
        TexturedSceneOptions knobs;
        knobs.texture.filter = filter;
        EXPECT_TRUE(does_not_depend_on_triangles(knobs, [](const auto& options,
                                                           const Scene& scene) {
            TexturedScene assets = load_textured_scene(scene, options);
            assets.textures[1] = texture_of(vec4(0.5f));
            const test::CountedSince counters;
            const std::size_t count = allocations_of([&] { lesson_05::render(options, assets); });
            expect_many(counters, Counter::texture_samples);
            return count;
        }));
    }
}

TEST(Allocations, OfLesson06DoNotDependOnTriangles) {
    lesson_06::Options knobs;
    EXPECT_TRUE(does_not_depend_on_triangles(knobs, [](const auto& options, const Scene& scene) {
        Scene shiny = scene;
        shiny.materials[1].specular = vec3(0.5f), shiny.materials[1].shininess = 10;
        PhongAssets assets = lesson_06::make_assets(shiny, options);
        assets.textures.diffuse[1] = texture_of(vec4(0.5f));
        assets.effects[1].set(Effect::texture);
        const test::CountedSince counters;
        const std::size_t count = allocations_of([&] { lesson_06::render(options, assets); });
        expect_many(counters, Counter::highlights);
        expect_many(counters, Counter::texture_samples);
        return count;
    }));
}

TEST(Allocations, OfLesson07DoNotDependOnTriangles) {
    for (const Outline outline : {Outline::none, Outline::facing, Outline::hull, Outline::edges}) {
        ToonOptions knobs;
        knobs.orbit = {}, knobs.shading.outline = outline;
        EXPECT_TRUE(does_not_depend_on_triangles(knobs, [](const auto& options,
                                                           const Scene& scene) {
            const ToonAssets assets = lesson_07::make_assets(scene, options);
            const test::CountedSince counters;
            const std::size_t count = allocations_of([&] { lesson_07::render(options, assets); });
            expect_many(counters, Counter::toon_fragments);
            return count;
        }));
    }
}

TEST(Allocations, OfLesson08DoNotDependOnTriangles) {
    lesson_08::Options knobs;
    knobs.shading.all_effects = true;  // a map for each mesh
    EXPECT_TRUE(does_not_depend_on_triangles(knobs, [](const auto& options, const Scene& scene) {
        NormalMapAssets assets = lesson_08::make_assets(scene, options);
        assets.normal_maps.textures[1] = texture_of(vec4(0.6f, 0, 0.8f, 1));
        const test::CountedSince counters;
        const std::size_t count = allocations_of([&] { lesson_08::render(options, assets); });
        expect_many(counters, Counter::normal_map_samples);
        return count;
    }));
}

TEST(Allocations, OfLesson09DoNotDependOnTriangles) {
    for (const LightKind light : {LightKind::directional, LightKind::spot, LightKind::point}) {
        lesson_09::Options knobs;
        knobs.shading.key_light = light, knobs.shadow.size = 64;
        knobs.shading.all_effects = true;  // maps for each mesh and light
        EXPECT_TRUE(does_not_depend_on_triangles(knobs, [](const auto& options,
                                                           const Scene& scene) {
            ShadowAssets assets = lesson_09::make_assets(scene, options);
            assets.normal_maps.textures[1] = texture_of(vec4(0.6f, 0, 0.8f, 1));
            const test::CountedSince counters;
            const std::size_t count = allocations_of([&] { lesson_09::render(options, assets); });
            expect_many(counters, Counter::shadow_fragments);
            expect_many(counters, Counter::shadow_tests);
            return count;
        }));
    }
}

TEST(Allocations, OfLesson10DependOnBatchesAndNotOnTriangles) {
    for (const Split split : {Split::rows, Split::interleaved, Split::tiles})
        for (const float distance : {1.4f, 0.2f}) {
            lesson_10::Options options;
            options.size = {96, 64}, options.shadow.size = 64, options.orbit.distance = distance;
            options.threads.split = split, options.threads.tile = 8;
            const auto count_for = [&](int side) {
                const ShadowAssets assets = lesson_10::make_assets(waves(side), options);
                ThreadPool pool(3);
                const test::CountedSince counters;
                const std::size_t count =
                    allocations_of([&] { lesson_10::render(options, assets, pool); });
                expect_many(counters, Counter::shadow_fragments);
                return count;
            };
            const std::size_t triangles = 2 * 32 * 32 * 2, few = count_for(8);
            // The picture and the map have batches. Each batch has three lists, and one of them may
            // grow where clipping makes many triangles of few.
            EXPECT_LE(count_for(32), few + 2 * 4 * batches_of(triangles));
            options.size = 2 * options.size, options.threads.tile = 16;
            EXPECT_EQ(count_for(8), few) << "four times as many pixels";
        }
}

TEST(Allocations, OfLesson12sIdsAreMadeForTheLargestTileAlone) {
    const std::vector<ProjectedTriangle> triangles(50, test::projected({}, ivec2(8)));
    // One row of sixteen, and a square tile of as many pixels.
    for (const Tile& tile : {Tile{{{0, 3}, {1023, 1023}}, 16}, Tile{{{256, 0}, {511, 255}}}}) {
        VisibilityBuffer visible(no_triangle);
        const auto draw_tile = [&] {
            visible.begin(tile);
            for (const ProjectedTriangle& triangle : triangles) visible.add(triangle);
            for_each_strip(tile, [&](const PixelBox& strip) {
                for (int y = strip.first.y; y <= strip.last.y; ++y)
                    for (int x = strip.first.x; x <= strip.last.x; ++x)
                        visible.write({x, y}, static_cast<TriangleId>(x / 64 % 50));
            });
            std::size_t spans = 0;
            visible.take_visible([&](const ProjectedTriangle&, std::span<const PixelSpan> of_one) {
                spans += of_one.size();
            });
            EXPECT_GT(spans, 100u);
        };
        const std::size_t bytes_before = bytes_allocated;
        EXPECT_GT(allocations_of(draw_tile), 3u);
        // 256 KiB of ids; and spans, which are few here, and lists that grew.
        EXPECT_LT(bytes_allocated - bytes_before, (64 * 1024 + 32 * 1024) * sizeof(TriangleId))
            << "bytes for a tile of 65,536 pixels, of which each has an id of 4";
        EXPECT_EQ(allocations_of(draw_tile), 0u) << "allocations for another tile of this size";
    }
}

TEST(Allocations, ThatFailInAnyThreadEndTheProgramInOneLine) {
    expect_one_line_for_each_failure(
        "10_threading", [](int argc, char** argv, const auto& begin, const auto& end) {
            using Options = lesson_10::Options;
            return rasterbook::run_lesson<Options>(
                argc, argv, "10_threading", "", load_shadow_scene,
                [&](const auto& options, const auto& assets) {
                    ThreadPool pool(options.threads.threads);
                    begin();
                    Image<vec3> picture = lesson_10::render(options, assets, pool);
                    end();
                    return picture;
                });
        });
    const auto scene_lesson = [](const char* name, auto options, const auto& render) {
        expect_one_line_for_each_failure(
            name, [&](int argc, char** argv, const auto& begin, const auto& end) {
                return rasterbook::run_scene_lesson<decltype(options)>(
                    argc, argv, name, "", [&](auto&... of) {
                        begin();
                        Image<vec3> picture = render(of...);
                        end();
                        return picture;
                    });
            });
    };
    scene_lesson("12_visibility_buffer", lesson_12::Options(),
                 [](auto&... of) { return lesson_12::render(of...); });
    scene_lesson("13_simd", lesson_13::Options(),
                 [](auto&... of) { return lesson_13::render(of...); });
}
