// SPDX-License-Identifier: MIT
// Drawing sets aside memory for pictures and meshes, never for a triangle or a pixel.
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

// All that the lessons' main.cpp include, so that what is left of those are their own lines.
#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "04_mvp/mvp_variants.hpp"
#include "05_textures/bands.hpp"
#include "05_textures/textured_scene.hpp"
#include "06_phong/fragments.hpp"
#include "06_phong/lit_scene.hpp"
#include "06_phong/many_samples.hpp"
#include "06_phong/shading_variants.hpp"
#include "07_toon/toon_variants.hpp"
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

// Each lesson's Options and render() in a namespace of its own.
#define main lesson_main
namespace lesson_04 {
#include "04_mvp/main.cpp"
}
namespace lesson_05 {
#include "05_textures/main.cpp"
}
namespace lesson_06 {
#include "06_phong/main.cpp"
}
namespace lesson_07 {
#include "07_toon/main.cpp"
}
namespace lesson_08 {
#include "08_normal_maps/main.cpp"
}
namespace lesson_09 {
#include "09_shadow_maps/main.cpp"
}
namespace lesson_10 {
#include "10_threading/main.cpp"
}
#undef main

using namespace rasterbook;

namespace {

std::atomic<std::size_t> allocations;  // operator new has nothing else to count in

}  // namespace

// Not inlined: g++ would complain of free() after what it takes for another operator new.
[[gnu::noinline]] void* operator new(std::size_t bytes) {
    ++allocations;
    if (void* const memory = std::malloc(bytes == 0 ? 1 : bytes)) return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace {

/// How often memory is asked for while `work` is done.
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
        const auto corner = [&](int x, int y) {
            const auto index = static_cast<std::uint32_t>(y * (side + 1) + x);
            return Corner{index, index};
        };
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                mesh.triangles.push_back(
                    {{corner(x, y), corner(x + 1, y), corner(x + 1, y + 1)}, 1});
                mesh.triangles.push_back(
                    {{corner(x, y), corner(x + 1, y + 1), corner(x, y + 1)}, 1});
            }
    }
    return scene;
}

/// For EXPECT_TRUE: a picture of n and one of 16 n triangles ask for memory equally often, seen
/// from outside, and from so near that many triangles are clipped.
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

}  // namespace

TEST(Allocations, AreCounted) {
    EXPECT_EQ(allocations_of([] {}), 0u);
    std::vector<std::vector<int>> kept;
    EXPECT_EQ(allocations_of([&] { kept.emplace_back(3); }), 2u);
    EXPECT_EQ(kept.at(0).size(), 3u);
}

TEST(Allocations, OfLesson04DoNotDependOnTriangles) {
    EXPECT_TRUE(does_not_depend_on_triangles(
        lesson_04::Options(), [](const auto& options, const Scene& scene) {
            Counters counters;
            const std::size_t count =
                allocations_of([&] { lesson_04::render(options, scene, counters); });
            EXPECT_GT(counters.values[std::size_t(Counter::fragments_shaded)], 1000u);
            return count;
        }));
}

TEST(Allocations, OfLesson05DoNotDependOnTriangles) {
    for (const Filter filter : {Filter::nearest, Filter::bilinear, Filter::trilinear})
        for (const int mapping : {affine, 1, 16}) {
            lesson_05::Options knobs;
            knobs.texture.filter = filter, knobs.texture.mapping = mapping;
            EXPECT_TRUE(
                does_not_depend_on_triangles(knobs, [](const auto& options, const Scene& scene) {
                    TexturedScene textured(scene, options);
                    textured.diffuse_textures[1] = std::make_shared<const Texture>(
                        make_texture(Image<vec4>({16, 16}, vec4(0.5f)), Wrap::repeat));
                    Counters counters;
                    const std::size_t count =
                        allocations_of([&] { lesson_05::render(options, textured, counters); });
                    EXPECT_GT(counters.values[std::size_t(Counter::texture_samples)], 1000u);
                    return count;
                }));
        }
}

TEST(Allocations, OfLesson06DoNotDependOnTriangles) {
    for (const Shading shading : {Shading::flat, Shading::gouraud, Shading::phong}) {
        lesson_06::Options knobs;
        knobs.shading.shading = shading;
        EXPECT_TRUE(
            does_not_depend_on_triangles(knobs, [](const auto& options, const Scene& scene) {
                Scene shiny = scene;
                shiny.materials[1].specular = vec3(0.5f), shiny.materials[1].shininess = 10;
                LitScene lit(shiny, options);
                lit.diffuse_textures[1] = std::make_shared<const Texture>(
                    make_texture(Image<vec4>({16, 16}, vec4(0.5f)), Wrap::repeat));
                lit.effects[1].diffuse_map = true;
                Counters counters;
                const std::size_t count =
                    allocations_of([&] { lesson_06::render(options, lit, counters); });
                EXPECT_GT(counters.values[std::size_t(Counter::highlights)], 1000u);
                EXPECT_GT(counters.values[std::size_t(Counter::texture_samples)], 1000u);
                return count;
            }));
    }
}

TEST(Allocations, OfLesson07DoNotDependOnTriangles) {
    for (const Outline outline : {Outline::none, Outline::facing, Outline::hull, Outline::edges})
        for (const bool smooth : {false, true}) {
            lesson_07::Options knobs;
            knobs.orbit = {}, knobs.shading.outline = outline, knobs.shading.smooth = smooth;
            EXPECT_TRUE(
                does_not_depend_on_triangles(knobs, [](const auto& options, const Scene& scene) {
                    const ToonScene toon(scene, options);
                    Counters counters;
                    const std::size_t count =
                        allocations_of([&] { lesson_07::render(options, toon, counters); });
                    EXPECT_GT(counters.values[std::size_t(Counter::toon_fragments)], 1000u);
                    return count;
                }));
        }
}

TEST(Allocations, OfLesson08DoNotDependOnTriangles) {
    for (const FrameOf frame : {FrameOf::face, FrameOf::vertex, FrameOf::pixel}) {
        lesson_08::Options knobs;
        knobs.normal_map.frame = frame;
        knobs.shading.all_effects = true;  // a map for each mesh
        EXPECT_TRUE(
            does_not_depend_on_triangles(knobs, [](const auto& options, const Scene& scene) {
                BumpyScene bumpy(scene, options);
                bumpy.normal_textures[1] = std::make_shared<const Texture>(
                    make_texture(Image<vec4>({16, 16}, vec4(0.6f, 0, 0.8f, 1)), Wrap::repeat));
                Counters counters;
                const std::size_t count =
                    allocations_of([&] { lesson_08::render(options, bumpy, counters); });
                EXPECT_GT(counters.values[std::size_t(Counter::normal_map_samples)], 1000u);
                return count;
            }));
    }
}

TEST(Allocations, OfLesson09DoNotDependOnTriangles) {
    for (const LightKind light : {LightKind::directional, LightKind::spot, LightKind::point}) {
        lesson_09::Options knobs;
        knobs.shading.key_light = light, knobs.shadow.size = 64;
        knobs.shading.all_effects = true;  // maps for each mesh and light
        EXPECT_TRUE(
            does_not_depend_on_triangles(knobs, [](const auto& options, const Scene& scene) {
                ShadowedScene shadowed(scene, options);
                shadowed.normal_textures[1] = std::make_shared<const Texture>(
                    make_texture(Image<vec4>({16, 16}, vec4(0.6f, 0, 0.8f, 1)), Wrap::repeat));
                Counters counters;
                const std::size_t count =
                    allocations_of([&] { lesson_09::render(options, shadowed, counters); });
                EXPECT_GT(counters.values[std::size_t(Counter::shadow_fragments)], 1000u);
                EXPECT_GT(counters.values[std::size_t(Counter::shadow_lookups)], 1000u);
                return count;
            }));
    }
}

TEST(Allocations, OfLesson10DependOnChunksAndNotOnTriangles) {
    for (const Split split : {Split::rows, Split::interleaved, Split::tiles})
        for (const float distance : {1.4f, 0.2f}) {
            lesson_10::Options options;
            options.size = {96, 64}, options.shadow.size = 64, options.orbit.distance = distance;
            options.threads.split = split, options.threads.tile = 8;
            const auto count_for = [&](int side) {
                const ShadowedScene scene(waves(side), options);
                ThreadPool pool(3);
                Counters counters;
                const std::size_t count =
                    allocations_of([&] { lesson_10::render(options, scene, pool, counters); });
                EXPECT_GT(counters.values[std::size_t(Counter::shadow_fragments)], 1000u);
                return count;
            };
            const std::size_t triangles = 2 * 32 * 32 * 2, few = count_for(8);
            // The picture and the map have chunks; each of these has three lists, and asks once
            // more where clipping makes many triangles of few.
            EXPECT_LE(count_for(32), few + 2 * 4 * chunks_of(triangles));
            options.size = 2 * options.size, options.threads.tile = 16;
            EXPECT_EQ(count_for(8), few) << "four times as many pixels";
        }
}
