// SPDX-License-Identifier: MIT
// One library for each ARITHMETIC: functions for 16 numbers that the stages of all lessons find in
// place of their own templates.
#include "accuracy/simd_arithmetic.hpp"

#include <cstdint>

#include "05_textures/interpolation.hpp"
#include "13_simd/simd.hpp"
#include "13_simd/wide_shadows.hpp"
#include "accuracy/simd_estimates.hpp"
#include "common/math/functions.hpp"

#define ESTIMATES 1
#define POWERS 2
#define COUNTED 3
#define EXPORTED __attribute__((visibility("default")))

namespace rasterbook {

#if ARITHMETIC == ESTIMATES
using Wide = Floats<16>;

/// As the course has it, but for the division.
inline PerspectiveBarycentrics<Wide> perspective_correct(const PerspectiveSetup& setup,
                                                         Vec3<Wide> on_screen) {
    const auto sum = [](Vec3<Wide> v) { return v.x + v.y + v.z; };
    const Vec3<Wide> numerators = setup.is_whole
                                      ? Vec3<Wide>(setup.inverse_w) * on_screen
                                      : on_screen.x * Vec3<Wide>(setup.numerators[0]) +
                                            on_screen.y * Vec3<Wide>(setup.numerators[1]) +
                                            on_screen.z * Vec3<Wide>(setup.numerators[2]);
    const Wide inverse_sum = test::reciprocal_by<test::ESTIMATE, STEPS>(sum(numerators));
    const Vec3<Wide> here = numerators * inverse_sum;
    const Vec3<Wide> ddx(setup.numerators_ddx), ddy(setup.numerators_ddy);
    return {here, (ddx - here * sum(ddx)) * inverse_sum, (ddy - here * sum(ddy)) * inverse_sum};
}

/// As the course has it where a vector is neither very short nor very long.
inline Vec3<Wide> unit_or(Vec3<Wide> v, Vec3<Wide> fallback) {
    const Wide squared = glm::dot(v, v);
    if (!all_of((squared > Wide(1e-30f)) & (squared < Wide(1e30f))))
        return unit_or<Wide>(v, fallback);
    return v * test::reciprocal_sqrt_by<test::ESTIMATE, STEPS>(squared);
}
#elif ARITHMETIC == POWERS
static test::PowerInLanes power_in_use = nullptr;
inline Floats<16> power(Floats<16> x, Floats<16> y) { return power_in_use(x, y); }
#elif ARITHMETIC == COUNTED
static test::BatchesCounted batches;

static void count_in_batch(Counter counter) {
    if (counter == Counter::fragments_shaded) ++batches.count, batches.pixels += fragments_at_once;
    count(counter, fragments_at_once);
}

// As the course has them; and each batch counts its fragments once.
template <>
void count_each<Floats<4>>(Counter counter) {
    count_in_batch(counter);
}
template <>
void count_each<Floats<8>>(Counter counter) {
    count_in_batch(counter);
}
template <>
void count_each<Floats<16>>(Counter counter) {
    count_in_batch(counter);
}
#endif

}  // namespace rasterbook

// Behind the functions that it is to find.
#include "13_simd/wide_shading.hpp"

namespace rasterbook::test {

#if ARITHMETIC == POWERS
EXPORTED void set_power(PowerInLanes power) { power_in_use = power; }
#elif ARITHMETIC == COUNTED
EXPORTED BatchesCounted& batches_counted() { return batches; }
EXPORTED WideDrawing drawing_counted(int width) {
    return width == 4   ? drawing_of_width<4>()
           : width == 8 ? drawing_of_width<8>()
                        : drawing_of_width<16>();
}
#endif
#if ARITHMETIC != COUNTED
EXPORTED WideDrawing DRAWING() { return drawing_of_width<16>(); }
#endif

}  // namespace rasterbook::test
