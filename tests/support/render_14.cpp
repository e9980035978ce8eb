// SPDX-License-Identifier: MIT
// Lesson 14's render(), compiled once for all tests.
#include "support/lesson_14.hpp"

namespace lesson_14 {

Image<vec3> render(const Options& options, const PlannedScene& assets, Workers& pool,
                   StepClock& clock) {
    return render_here(options, assets, pool, clock);
}

}  // namespace lesson_14
