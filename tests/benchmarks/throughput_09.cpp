// SPDX-License-Identifier: MIT
/// @file
/// How fast lesson 09 draws whole frames, one thread: both passes, and all that is cleared before.
/// In a file of its own, so that the compiler has just what it has in the lesson.
#include <benchmark/benchmark.h>

#include "support/lesson_09.hpp"
#include "support/pictures.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// Normal maps, textures, highlights, and shadow maps of 2048 x 2048 texels with 3 x 3 PCF.
/// Argument: the filter.
void shadowed_frames(benchmark::State& state) {
    lesson_09::Options options;
    options.size = {1920, 1080};
    options.texture.filter = state.range(0) ? Filter::trilinear : Filter::bilinear;
    const ShadowAssets assets = lesson_09::make_assets(loaded(options.model), options);
    const auto fragments =
        drawn(options, assets, lesson_09::render).count(Counter::fragments_shaded);
    for (auto _ : state) benchmark::DoNotOptimize(lesson_09::render(options, assets));
    state.counters["fragments"] = {static_cast<double>(fragments),
                                   benchmark::Counter::kIsIterationInvariantRate};
    state.counters["fragments_per_picture"] = static_cast<double>(fragments);
}

}  // namespace

BENCHMARK(shadowed_frames)->ArgName("trilinear")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
