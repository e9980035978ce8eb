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
    return drawn(without_width, assets, [&](const auto& of, const auto& with) {
        StepClock clock;
        return lesson_12::render(of, with, pool, clock);
    });
}

inline Drawn drawn_by_13(const lesson_13::Options& options, const SceneAssets& assets,
                         ThreadPool& pool) {
    return drawn(options, assets, [&](const auto& of, const auto& with) {
        StepClock clock;
        return lesson_13::render(of, with, pool, clock);
    });
}

}  // namespace rasterbook::test
