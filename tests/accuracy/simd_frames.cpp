// SPDX-License-Identifier: MIT
// Lesson 14's render(), compiled once, with all arithmetic that it may be given.
#include "accuracy/simd_frames.hpp"

rasterbook::WideDrawing rasterbook::test::drawing_of_arithmetic(int width_or_arithmetic) {
    switch (width_or_arithmetic) {
        case hardware_0:
            return drawing_hardware_0();
        case hardware_1:
            return drawing_hardware_1();
        case contracted:
            return drawing_contracted();
        default:
            return drawing_of_width(width_or_arithmetic);
    }
}

namespace lesson_14 {

Image<vec3> render(const Options& options, const PlannedScene& assets, Workers& pool,
                   StepClock& clock) {
    return render_here(options, assets, pool, clock);
}

}  // namespace lesson_14
