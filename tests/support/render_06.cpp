// SPDX-License-Identifier: MIT
// Lesson 06's render(), compiled once for all tests.
#include "support/lesson_06.hpp"

namespace lesson_06 {

Image<vec3> render(const Options& options, const PhongAssets& assets) {
    return render_here(options, assets);
}

}  // namespace lesson_06
