// SPDX-License-Identifier: MIT
// Lesson 07's render(), compiled once for all tests.
#include "support/lesson_07.hpp"

namespace lesson_07 {

Image<vec3> render(const Options& options, const ToonAssets& assets) {
    return render_here(options, assets);
}

}  // namespace lesson_07
