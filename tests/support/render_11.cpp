// SPDX-License-Identifier: MIT
// Lesson 11's render(), compiled once for all tests.
#include "support/lesson_11.hpp"

namespace lesson_11 {

Image<vec3> render(const Options& options, const SceneAssets& assets, Workers& pool) {
    return render_here(options, assets, pool);
}

}  // namespace lesson_11
