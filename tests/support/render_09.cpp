// SPDX-License-Identifier: MIT
// Lesson 09's render(), compiled once for all tests.
#include "support/lesson_09.hpp"

namespace lesson_09 {

Image<vec3> render(const Options& options, const ShadowAssets& assets) {
    return render_here(options, assets);
}

}  // namespace lesson_09
