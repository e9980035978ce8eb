// SPDX-License-Identifier: MIT
/// @file
/// 1/x and 1/sqrt(x) from estimates of a few bits, made better by Newton's steps.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#if defined(__SSE__)
#include <immintrin.h>
#endif

#include "13_simd/simd.hpp"

namespace rasterbook::test {

/// A float's bits are roughly its logarithm: a difference of bits is a quotient, and half of the
/// bits a square root.
///
/// @see Lomont, "Fast Inverse Square Root", 2003, on 0x5f3759df.
struct ByBits {
    static constexpr int width = native_width;

    template <int N>
    static Floats<N> reciprocal(Floats<N> x) {
        return from(0x7ef311c3 - std::bit_cast<Vector<std::int32_t, N>>(x.lanes));
    }
    template <int N>
    static Floats<N> reciprocal_sqrt(Floats<N> x) {
        return from(0x5f3759df - (std::bit_cast<Vector<std::int32_t, N>>(x.lanes) >> 1));
    }

  private:
    template <typename Bits>
    static auto from(Bits bits) {
        constexpr int N = sizeof(Bits) / sizeof(float);
        return Floats<N>(std::bit_cast<Vector<float, N>>(bits));
    }
};

#if defined(__SSE__)
/// The estimates of the first SSE: within 1.5 * 2^-12, and different bits from each maker.
struct Rcpps {
#if defined(__AVX__)
    using Register = __m256;
    static Register estimate(Register x) { return _mm256_rcp_ps(x); }
    static Register estimate_sqrt(Register x) { return _mm256_rsqrt_ps(x); }
#else
    using Register = __m128;
    static Register estimate(Register x) { return _mm_rcp_ps(x); }
    static Register estimate_sqrt(Register x) { return _mm_rsqrt_ps(x); }
#endif
    static constexpr int width = sizeof(Register) / sizeof(float);

    template <int N>
    static Floats<N> reciprocal(Floats<N> x) {
        return by_registers(x, estimate);
    }
    template <int N>
    static Floats<N> reciprocal_sqrt(Floats<N> x) {
        return by_registers(x, estimate_sqrt);
    }

  private:
    template <int N, typename Estimate>
    static Floats<N> by_registers(Floats<N> x, Estimate&& estimate) {
        for (std::size_t i = 0; i < N; i += width) {
            Register some;
            std::memcpy(&some, reinterpret_cast<const char*>(&x) + i * sizeof(float), sizeof some);
            some = estimate(some);
            std::memcpy(reinterpret_cast<char*>(&x) + i * sizeof(float), &some, sizeof some);
        }
        return x;
    }
};
#endif

#if defined(__AVX512F__)
/// The estimates of AVX-512: within 2^-14.
struct Rcp14 {
    static constexpr int width = 16;
    static constexpr __mmask16 all = 0xffff;  // without a mask, g++ 12 warns of its own header

    static Floats<16> reciprocal(Floats<16> x) {
        return {std::bit_cast<Vector<float, 16>>(
            _mm512_maskz_rcp14_ps(all, std::bit_cast<__m512>(x.lanes)))};
    }
    static Floats<16> reciprocal_sqrt(Floats<16> x) {
        return {std::bit_cast<Vector<float, 16>>(
            _mm512_maskz_rsqrt14_ps(all, std::bit_cast<__m512>(x.lanes)))};
    }
};
using BestEstimate = Rcp14;
#elif defined(__SSE__)
using BestEstimate = Rcpps;
#else
using BestEstimate = ByBits;
#endif

/// Each step doubles the correct bits, until rounding sets in.
template <typename Estimate, int steps, int N>
inline Floats<N> reciprocal_by(Floats<N> x) {
    Floats<N> y = Estimate::reciprocal(x);
    for (int i = 0; i < steps; ++i) y = y * (Floats<N>(2.0f) - x * y);
    return y;
}
template <typename Estimate, int steps, int N>
inline Floats<N> reciprocal_sqrt_by(Floats<N> x) {
    Floats<N> y = Estimate::reciprocal_sqrt(x);
    for (int i = 0; i < steps; ++i) y = y * (Floats<N>(1.5f) - Floats<N>(0.5f) * x * y * y);
    return y;
}

}  // namespace rasterbook::test
