// SPDX-License-Identifier: MIT
/// @file
/// The same scene as lessons 13 and 14 draw it.
#pragma once

#include "10_threading/thread_pool.hpp"
#include "12_effects/planned_scene.hpp"
#include "support/lesson_13.hpp"
#include "support/lesson_14.hpp"
#include "support/pictures.hpp"

namespace rasterbook::test {

inline Drawn drawn_by_13(const lesson_14::Options& options, const PlannedScene& assets,
                         ThreadPool& pool) {
    lesson_13::Options without_width;
    static_cast<EffectsOptions&>(without_width) = options;
    without_width.visibility = options.visibility;
    return drawn(without_width, assets, [&](const auto& of, const auto& with) {
        StepClock clock;
        return lesson_13::render(of, with, pool, clock);
    });
}

inline Drawn drawn_by_14(const lesson_14::Options& options, const PlannedScene& assets,
                         ThreadPool& pool) {
    return drawn(options, assets, [&](const auto& of, const auto& with) {
        StepClock clock;
        return lesson_14::render(of, with, pool, clock);
    });
}

}  // namespace rasterbook::test
