// SPDX-License-Identifier: MIT
// Lesson 10's render(), compiled once for all tests.
#include "support/lesson_10.hpp"

namespace lesson_10 {

Image<vec3> render(const Options& options, const ShadowAssets& assets, Workers& pool) {
    return render_here(options, assets, pool);
}

}  // namespace lesson_10
