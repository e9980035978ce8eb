// SPDX-License-Identifier: MIT
// Lesson 08's render(), compiled once for all tests.
#include "support/lesson_08.hpp"

namespace lesson_08 {

Image<vec3> render(const Options& options, const NormalMapAssets& assets) {
    return render_here(options, assets);
}

}  // namespace lesson_08
