// SPDX-License-Identifier: MIT
/// @file
/// How fast lesson 09 draws whole frames, one thread: both passes, and all that is cleared before.
/// In a file of its own, so that the compiler has just what it has in the lesson.
#include <array>
#include <cstddef>
#include <filesystem>
#include <vector>

#include <benchmark/benchmark.h>

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
#include "common/backdrop.hpp"
#include "common/lesson_app.hpp"
#include "common/obj.hpp"

// The lesson's Options and render().
#define main lesson_main
namespace lesson_09 {
#include "09_shadow_maps/main.cpp"
}
#undef main

using namespace rasterbook;

namespace {

/// Normal maps, textures, highlights, and shadows of 2048 x 2048 texels by nine. Argument: the
/// filter.
void shadowed_frames(benchmark::State& state) {
    lesson_09::Options options;
    options.size = {1920, 1080};
    options.texture.filter = state.range(0) ? Filter::trilinear : Filter::bilinear;
    const ShadowedScene scene(
        load_obj(std::filesystem::path(RASTERBOOK_ASSETS) / "models" / options.model), options);
    Counters once;
    lesson_09::render(options, scene, once);
    NoCounters nothing;
    for (auto _ : state) benchmark::DoNotOptimize(lesson_09::render(options, scene, nothing));
    const auto fragments = once.values[static_cast<std::size_t>(Counter::fragments_shaded)];
    state.counters["fragments"] = {static_cast<double>(fragments),
                                   benchmark::Counter::kIsIterationInvariantRate};
    state.counters["fragments_per_picture"] = static_cast<double>(fragments);
}

}  // namespace

BENCHMARK(shadowed_frames)->ArgName("trilinear")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
