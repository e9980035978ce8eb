// SPDX-License-Identifier: MIT
// One library for each ARITHMETIC: functions for 16 numbers that the stages of all lessons find in
// place of their own templates.
#include "accuracy/simd_arithmetic.hpp"

#include <bit>

#ifdef __AVX512F__
#include <immintrin.h>
#endif

#include "05_textures/interpolation.hpp"
#include "14_simd/simd.hpp"
#include "14_simd/wide_shadows.hpp"
#include "common/math/functions.hpp"

#define ESTIMATES 1

namespace rasterbook {

#if ARITHMETIC == ESTIMATES
using Wide = Floats<16>;

/// Within 2^-14, where AVX-512 has an instruction for it; else as exact as a division.
static Wide estimated_reciprocal(Wide x) {
#ifdef __AVX512F__
    constexpr __mmask16 all = 0xffff;  // without a mask, g++ 12 warns of its own header
    return {std::bit_cast<Vector<float, 16>>(
        _mm512_maskz_rcp14_ps(all, std::bit_cast<__m512>(x.lanes)))};
#else
    return Wide(1.0f) / x;
#endif
}
static Wide estimated_reciprocal_sqrt(Wide x) {
#ifdef __AVX512F__
    constexpr __mmask16 all = 0xffff;
    return {std::bit_cast<Vector<float, 16>>(
        _mm512_maskz_rsqrt14_ps(all, std::bit_cast<__m512>(x.lanes)))};
#else
    return Wide(1.0f) / sqrt(x);
#endif
}

/// As the course has it, but for the division. Each step of Newton's method doubles the correct
/// bits, until rounding sets in.
inline PerspectiveBarycentrics<Wide> perspective_correct(const PerspectiveSetup& setup,
                                                         Vec3<Wide> on_screen) {
    const auto sum = [](Vec3<Wide> v) { return v.x + v.y + v.z; };
    const Vec3<Wide> numerators = setup.is_whole
                                      ? Vec3<Wide>(setup.inverse_w) * on_screen
                                      : on_screen.x * Vec3<Wide>(setup.numerators[0]) +
                                            on_screen.y * Vec3<Wide>(setup.numerators[1]) +
                                            on_screen.z * Vec3<Wide>(setup.numerators[2]);
    const Wide x = sum(numerators);
    Wide inverse_sum = estimated_reciprocal(x);
    for (int i = 0; i < STEPS; ++i) inverse_sum = inverse_sum * (Wide(2.0f) - x * inverse_sum);
    const Vec3<Wide> here = numerators * inverse_sum;
    const Vec3<Wide> ddx(setup.numerators_ddx), ddy(setup.numerators_ddy);
    return {here, (ddx - here * sum(ddx)) * inverse_sum, (ddy - here * sum(ddy)) * inverse_sum};
}

/// As the course has it where a vector is neither very short nor very long.
inline Vec3<Wide> unit_or(Vec3<Wide> v, Vec3<Wide> fallback) {
    const Wide squared = glm::dot(v, v);
    if (!all_of((squared > Wide(1e-30f)) & (squared < Wide(1e30f))))
        return unit_or<Wide>(v, fallback);
    Wide inverse = estimated_reciprocal_sqrt(squared);
    for (int i = 0; i < STEPS; ++i)
        inverse = inverse * (Wide(1.5f) - Wide(0.5f) * squared * inverse * inverse);
    return v * inverse;
}
#endif

}  // namespace rasterbook

// Behind the functions that it is to find.
#include "14_simd/wide_shading.hpp"

namespace rasterbook::test {

__attribute__((visibility("default"))) WideDrawing DRAWING() { return drawing_of_width<16>(); }

}  // namespace rasterbook::test
