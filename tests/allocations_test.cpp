// SPDX-License-Identifier: MIT
// Drawing allocates memory for pictures and meshes, never for a triangle or a pixel.
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

#include "13_visibility_buffer/visibility_buffer.hpp"
#include "support/lesson_04.hpp"
#include "support/lesson_05.hpp"
#include "support/lesson_06.hpp"
#include "support/lesson_07.hpp"
#include "support/lesson_08.hpp"
#include "support/lesson_09.hpp"
#include "support/lesson_10.hpp"
#include "support/lesson_13.hpp"
#include "support/lesson_14.hpp"
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

/// How many allocations `work` makes. It has to count more than 1000 of each of some counters.
template <typename Work>
std::size_t allocations_of(const Work& work, const std::vector<Counter>& many = {}) {
    const test::CountedSince counters;
    const std::size_t before = allocations;
    work();
    const std::size_t count = allocations - before;
    for (const Counter counter : many)
        EXPECT_GT(counters[counter], 1000u) << counter_names[static_cast<std::size_t>(counter)];
    return count;
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
        const auto add = [&](ivec2 a, ivec2 b, ivec2 c) {
            const auto vertex = [&](ivec2 at) {
                const auto index = static_cast<std::uint32_t>(at.y * (side + 1) + at.x);
                return Vertex{index, index};
            };
            mesh.triangles.push_back({{vertex(a), vertex(b), vertex(c)}, 1});
        };
        for (ivec2 p(0); p.y < side; ++p.y)
            for (p.x = 0; p.x < side; ++p.x)
                add(p, p + ivec2(1, 0), p + 1), add(p, p + 1, p + ivec2(0, 1));
    }
    return scene;
}

std::shared_ptr<const Texture> texture_of(vec4 texel) {
    return std::make_shared<const Texture>(
        make_texture(Image<vec4>({16, 16}, texel), Wrap::repeat));
}

/// For EXPECT_TRUE: a picture of n triangles and one of 16 n make as many allocations, seen from
/// outside, and from so near that many triangles are clipped.
template <typename Options, typename Draw>
testing::AssertionResult does_not_depend_on_triangles(Options options, const Draw& draw) {
    options.size = {96, 64};
    for (const float distance : {1.4f, 0.2f}) {
        options.orbit.distance = distance;
        const std::size_t few = draw(options, waves(8)), many = draw(options, waves(32));
        Options large = options;
        large.size *= 2;
        const std::size_t of_large = draw(large, waves(8));
        if (few == 0 || few != many || few != of_large)
            return testing::AssertionFailure()
                   << few << " allocations; " << many << " with 16 times as many triangles, "
                   << of_large << " with four times as many pixels";
    }
    return testing::AssertionSuccess();
}

std::ptrdiff_t fails = 0;  // of the allocations of watched(): this one, or none
std::ptrdiff_t watched_allocations = 0;

template <typename Draw>
Image<vec3> watched(const Draw& draw) {
    const std::size_t before = allocations;
    until_one_fails = fails;
    Image<vec3> picture = draw();
    until_one_fails = 0;
    watched_allocations = static_cast<std::ptrdiff_t>(allocations - before);
    return picture;
}

/// Runs a lesson's program on three threads, once as it is, and then so that one of the allocations
/// of its picture fails: the program has to end in one line and leave no file.
///
/// @param run  Called as run(argc, argv): runs the program, whose render() is watched().
template <typename Run>
void expect_one_line_for_each_failure(const char* lesson, const Run& run) {
    SCOPED_TRACE(lesson);
    const std::filesystem::path folder = test::fresh_folder("allocations");
    std::vector<std::string> words = {
        lesson,      "--model", "crate.obj", "--size", "96x54", "--shadow-size",       "128",
        "--threads", "3",       "--tile",    "16",     "--out", folder / "picture.png"};
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    const auto argc = static_cast<int>(argv.size());
    fails = 0;
    ASSERT_EQ(run(argc, argv.data()), 0);
    const std::ptrdiff_t all = watched_allocations;
    ASSERT_GT(all, 20);
    failures = 0;
    for (fails = 1; fails < all; fails += all / 16) {
        std::filesystem::remove(folder / "picture.png");
        const int failures_before = failures;
        testing::internal::CaptureStderr();
        const int status = run(argc, argv.data());
        const std::string said = testing::internal::GetCapturedStderr();
        until_one_fails = 0;
        const bool has_failed = failures > failures_before;  // a worker may sleep through it all
        ASSERT_EQ(status, has_failed ? 1 : 0) << "allocation " << fails << " of about " << all;
        ASSERT_EQ(said, has_failed ? "error: not enough memory for this model at this size\n" : "");
        ASSERT_EQ(std::filesystem::is_empty(folder), has_failed);
    }
    EXPECT_GT(failures, 8);
}

}  // namespace

TEST(Allocations, OfLesson04DoNotDependOnTriangles) {
    EXPECT_TRUE(does_not_depend_on_triangles(PotOptions(), [](const auto& options, Scene scene) {
        return allocations_of([&] { lesson_04::render(options, scene); },
                              {Counter::fragments_shaded});
    }));
}

TEST(Allocations, OfLesson05DoNotDependOnTriangles) {
    for (const Filter filter : {Filter::nearest, Filter::bilinear, Filter::trilinear}) {
        TexturedSceneOptions knobs;
        knobs.texture.filter = filter;
        EXPECT_TRUE(does_not_depend_on_triangles(knobs, [](const auto& options, Scene scene) {
            TexturedScene assets = load_textured_scene(scene, options);
            assets.textures[1] = texture_of(vec4(0.5f));
            return allocations_of([&] { lesson_05::render(options, assets); },
                                  {Counter::texture_samples});
        }));
    }
}

TEST(Allocations, OfLesson06DoNotDependOnTriangles) {
    lesson_06::Options knobs;
    EXPECT_TRUE(does_not_depend_on_triangles(knobs, [](const auto& options, Scene scene) {
        scene.materials[1].specular = vec3(0.5f), scene.materials[1].shininess = 10;
        PhongAssets assets = lesson_06::make_assets(scene, options);
        assets.textures.diffuse[1] = texture_of(vec4(0.5f));
        assets.effects[1].set(Effect::texture);
        return allocations_of([&] { lesson_06::render(options, assets); },
                              {Counter::highlights, Counter::texture_samples});
    }));
}

TEST(Allocations, OfLesson07DoNotDependOnTriangles) {
    for (const Outline outline : {Outline::none, Outline::facing, Outline::hull, Outline::edges}) {
        ToonOptions knobs;
        knobs.orbit = {}, knobs.shading.outline = outline;
        EXPECT_TRUE(does_not_depend_on_triangles(knobs, [](const auto& options, Scene scene) {
            const ToonAssets assets = lesson_07::make_assets(scene, options);
            return allocations_of([&] { lesson_07::render(options, assets); },
                                  {Counter::toon_fragments});
        }));
    }
}

TEST(Allocations, OfLesson08DoNotDependOnTriangles) {
    lesson_08::Options knobs;
    knobs.shading.all_effects = true;  // a map for each mesh
    EXPECT_TRUE(does_not_depend_on_triangles(knobs, [](const auto& options, Scene scene) {
        NormalMapAssets assets = lesson_08::make_assets(scene, options);
        assets.normal_maps.textures[1] = texture_of(vec4(0.6f, 0, 0.8f, 1));
        return allocations_of([&] { lesson_08::render(options, assets); },
                              {Counter::normal_map_samples});
    }));
}

TEST(Allocations, OfLesson09DoNotDependOnTriangles) {
    for (const LightKind light : {LightKind::directional, LightKind::spot, LightKind::point}) {
        lesson_09::Options knobs;
        knobs.shading.key_light = light, knobs.shadow.size = 64;
        knobs.shading.all_effects = true;  // maps for each mesh and light
        EXPECT_TRUE(does_not_depend_on_triangles(knobs, [](const auto& options, Scene scene) {
            ShadowAssets assets = lesson_09::make_assets(scene, options);
            assets.normal_maps.textures[1] = texture_of(vec4(0.6f, 0, 0.8f, 1));
            return allocations_of([&] { lesson_09::render(options, assets); },
                                  {Counter::shadow_fragments, Counter::shadow_tests});
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
                return allocations_of([&] { lesson_10::render(options, assets, pool); },
                                      {Counter::shadow_fragments});
            };
            const std::size_t triangles = 2 * 32 * 32 * 2, few = count_for(8);
            // The picture and the map have batches. Each batch has three lists, and one of them may
            // grow where clipping makes many triangles of few.
            EXPECT_LE(count_for(32), few + 2 * 4 * batches_of(triangles));
            options.size = 2 * options.size, options.threads.tile = 16;
            EXPECT_EQ(count_for(8), few) << "four times as many pixels";
        }
}

TEST(Allocations, OfLesson13sIdsAreMadeForTheLargestTileAlone) {
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
    expect_one_line_for_each_failure("10_threading", [](int argc, char** argv) {
        return rasterbook::run_lesson<lesson_10::Options>(
            argc, argv, "10_threading", "", load_shadow_scene,
            [](const auto& options, const auto& assets) {
                ThreadPool pool(options.threads.threads);
                return watched([&] { return lesson_10::render(options, assets, pool); });
            });
    });
    const auto expect_of_scenes = []<typename Options>(const char* name, const Options&,
                                                       auto render) {
        expect_one_line_for_each_failure(name, [&](int argc, char** argv) {
            return rasterbook::run_effects_lesson<Options>(argc, argv, name, "", [&](auto&... of) {
                return watched([&] { return render(of...); });
            });
        });
    };
    expect_of_scenes("13_visibility_buffer", lesson_13::Options(),
                     [](auto&... of) { return lesson_13::render(of...); });
    expect_of_scenes("14_simd", lesson_14::Options(),
                     [](auto&... of) { return lesson_14::render(of...); });
}
