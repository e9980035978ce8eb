// SPDX-License-Identifier: MIT
// Lesson 13's render(), compiled once for all tests.
#include "support/lesson_13.hpp"

namespace lesson_13 {

Image<vec3> render(const Options& options, const SceneAssets& assets, ThreadPool& pool,
                   Counters& counters, StepClock& clock) {
    return render<>(options, assets, pool, counters, clock);
}

}  // namespace lesson_13
