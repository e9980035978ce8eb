// SPDX-License-Identifier: MIT
// Lesson 06's render(), compiled once for all tests.
#include "support/lesson_06.hpp"

namespace lesson_06 {

Image<vec3> render(const Options& options, const PhongAssets& assets, Counters& counters) {
    return render<>(options, assets, counters);
}

}  // namespace lesson_06
