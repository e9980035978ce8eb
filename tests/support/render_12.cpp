// SPDX-License-Identifier: MIT
// Lesson 12's render(), compiled once for all tests.
#include "support/lesson_12.hpp"

namespace lesson_12 {

Image<vec3> render(const Options& options, const PlannedScene& assets, Workers& pool,
                   StepClock& clock) {
    return render_here(options, assets, pool, clock);
}

}  // namespace lesson_12
