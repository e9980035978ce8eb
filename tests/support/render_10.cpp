// SPDX-License-Identifier: MIT
// Lesson 10's render(), compiled once for all tests.
#include "support/lesson_10.hpp"

namespace lesson_10 {

Image<vec3> render(const Options& options, const ShadowAssets& assets, ThreadPool& pool,
                   Counters& counters) {
    return render<>(options, assets, pool, counters);
}

}  // namespace lesson_10
