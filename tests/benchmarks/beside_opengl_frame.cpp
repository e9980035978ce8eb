// SPDX-License-Identifier: MIT
/// @file
/// One frame by the render() of LESSON, in namespace LESSON_NAMESPACE. Each lesson's is compiled
/// alone, as its program is.
#include <memory>

#include "benchmarks/beside_opengl.hpp"

#include LESSON_HEADER

using namespace rasterbook;
using namespace LESSON_NAMESPACE;

namespace {

/// Compiles to nothing, as in the lesson's program. One for each lesson: the lessons' templates are
/// then other ones, too.
#if LESSON == 13
using Uncounted = NoCounters;
#else
struct Uncounted : NoCounters {};
#endif

}  // namespace

template <>
DrawFrame rasterbook::frame_of<LESSON>(const SceneRendererOptions& asked,
                                       const SceneAssets& assets) {
    Options options;
    const int tile = options.threads.tile;  // the lesson's own
    static_cast<SceneRendererOptions&>(options) = asked;
    options.threads.tile = tile;
    return [options, &assets, pool = std::make_shared<ThreadPool>(options.threads.threads)] {
        Uncounted uncounted;
        StepClock clock;
        return render(options, assets, *pool, uncounted, clock);
    };
}
