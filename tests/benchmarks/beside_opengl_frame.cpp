// SPDX-License-Identifier: MIT
/// @file
/// One frame by the render() of LESSON, in namespace LESSON_NAMESPACE. Each lesson's is compiled
/// alone, and counts, as its program does.
#include <memory>

#include "benchmarks/beside_opengl.hpp"

#include LESSON_HEADER

using namespace rasterbook;
using namespace LESSON_NAMESPACE;

template <>
DrawFrame rasterbook::frame_of<LESSON>(const EffectsOptions& asked, const PlannedScene& assets) {
    Options options;
    const int tile = options.threads.tile;  // the lesson's own
    static_cast<EffectsOptions&>(options) = asked;
    options.threads.tile = tile;
    return [options, &assets, pool = std::make_shared<ThreadPool>(options.threads.threads)] {
        StepClock clock;
        return render(options, assets, *pool, clock);
    };
}
