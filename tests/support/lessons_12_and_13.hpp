// SPDX-License-Identifier: MIT
/// @file
/// The same scene as lessons 12 and 13 draw it.
#pragma once

#include "10_threading/thread_pool.hpp"
#include "11_scenes/scene_assets.hpp"
#include "support/lesson_12.hpp"
#include "support/lesson_13.hpp"
#include "support/pictures.hpp"

namespace rasterbook::test {

inline Drawn drawn_by_12(const lesson_13::Options& options, const SceneAssets& assets,
                         ThreadPool& pool) {
    lesson_12::Options without_width;
    static_cast<SceneRendererOptions&>(without_width) = options;
    without_width.visibility = options.visibility;
    Drawn result;
    StepClock clock;
    result.picture = lesson_12::render(without_width, assets, pool, result.counters, clock);
    return result;
}

inline Drawn drawn_by_13(const lesson_13::Options& options, const SceneAssets& assets,
                         ThreadPool& pool) {
    Drawn result;
    StepClock clock;
    result.picture = lesson_13::render(options, assets, pool, result.counters, clock);
    return result;
}

}  // namespace rasterbook::test
