// SPDX-License-Identifier: MIT
/// @file
/// What one core can do at most. Compiled without auto-vectorisation: else one lane would be many.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "13_simd/simd.hpp"
#include "benchmarks/roofline.hpp"
#include "common/math/types.hpp"

namespace rasterbook {

namespace {

volatile float sink;  ///< Whoever computes a number writes it here, so that it has to be computed.

/// The fastest of some repetitions, each of half a millisecond or more: other programs share the
/// caches and the memory, and can only make it slower.
///
/// @param work  Does so many units.
template <typename Work>
double units_per_ns(double units, int repetitions, Work&& work) {
    using Clock = std::chrono::steady_clock;
    const auto ns_of = [&](int times) {
        const auto start = Clock::now();
        for (int i = 0; i < times; ++i) work();
        return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
    };
    work();  // fills the caches
    const int times = static_cast<int>(std::ceil(5e5 / std::max(ns_of(1), 1.0)));
    double fastest = 0;
    for (int i = 0; i < repetitions; ++i) fastest = std::max(fastest, units * times / ns_of(times));
    return fastest;
}

void print(const char* limit, const std::string& name, double per_ns) {
    std::printf(R"({"limit": "%s", "name": "%s", "per ns": %.6g})"
                "\n",
                limit, name.c_str(), per_ns);
    std::fflush(stdout);
}

using Wide = Floats<16>;

/// Numbers that begin with a cache line: else each read of 64 bytes would be one of two lines.
class AlignedFloats {
  public:
    explicit AlignedFloats(std::size_t count, float number = 0) : floats_(count + line, number) {}

    float* data() {
        const auto address = reinterpret_cast<std::uintptr_t>(floats_.data());
        return floats_.data() + (line - address / sizeof(float) % line) % line;
    }

  private:
    static constexpr std::size_t line = 64 / sizeof(float);

    std::vector<float> floats_;
};

/// A color of 12 bytes and a depth of 4 for each pixel, of several pictures.
void measure_writes(std::size_t bytes, int repetitions) {
    const std::size_t pixels = bytes / 16;
    AlignedFloats all_colors(3 * pixels), all_depths(pixels);
    float *const colors = all_colors.data(), *const depths = all_depths.data();
    float number = 0;
    print("write", std::to_string(bytes),
          units_per_ns(static_cast<double>(bytes), repetitions, [&] {
              const Wide written(number += 1);
              for (std::size_t i = 0; i < pixels; i += 16) {
                  for (std::size_t c = 0; c < 3; ++c) store(&colors[3 * i + 16 * c], written);
                  store(&depths[i], written);
              }
              sink = colors[pixels / 2] + depths[pixels / 3];
          }));
}

void measure_reads(std::size_t bytes, int repetitions) {
    const std::size_t count = bytes / sizeof(float);
    AlignedFloats all_numbers(count, 1.0f);
    const float* const numbers = all_numbers.data();
    print("read", std::to_string(bytes), units_per_ns(static_cast<double>(bytes), repetitions, [&] {
              std::array<Wide, 8> sums{};
              for (std::size_t i = 0; i < count; i += 16 * sums.size())
                  for (std::size_t k = 0; k < sums.size(); ++k)
                      sums[k] += load<Wide>(&numbers[i + 16 * k]);
              for (std::size_t k = 1; k < sums.size(); ++k) sums[0] += sums[k];
              sink = sums[0][0];
          }));
}

/// Texels of four floats, none of whose places depends on another texel.
void measure_texels(int side, bool at_random, int repetitions) {
    const auto count = static_cast<std::uint32_t>(side * side);
    const std::vector<vec4> texels(count, vec4(1));
    constexpr std::uint32_t fetches = 1 << 18, streams = 4;
    std::array<std::uint32_t, streams> at{};
    for (std::uint32_t k = 0; k < streams; ++k) at[k] = k * (0xffffffffu / streams);
    // The last digits of such numbers are not random, the first ones are.
    const int shift = 32 - 2 * static_cast<int>(std::log2(side));
    const auto read = [&](std::uint32_t i) {
        Vector<float, 4> texel;
        std::memcpy(&texel, &texels[i], sizeof texel);
        return texel;
    };
    print(at_random ? "texels at random" : "texels in order", std::to_string(side),
          units_per_ns(fetches, repetitions, [&] {
              std::array<Vector<float, 4>, streams> sums{};
              if (at_random)
                  for (std::uint32_t i = 0; i < fetches; i += streams)
                      for (std::uint32_t k = 0; k < streams; ++k) {
                          at[k] = at[k] * 1664525u + 1013904223u;
                          sums[k] += read(at[k] >> shift);
                      }
              else
                  for (std::uint32_t i = 0; i < fetches; i += streams)
                      for (std::uint32_t k = 0; k < streams; ++k)
                          sums[k] += read(++at[0] & (count - 1));
              for (std::uint32_t k = 1; k < streams; ++k) sums[0] += sums[k];
              sink = sums[0][0];
          }));
}

/// Steps of chains that do not wait for each other: as many as there are registers for.
///
/// @param operations  Of a step.
template <typename F, typename Step>
void measure_arithmetic(const char* limit, int operations, int repetitions, Step&& step) {
    constexpr int chains = 12, steps = 4096;
    std::array<F, chains> x;
    for (int i = 0; i < chains; ++i)
        x[static_cast<std::size_t>(i)] = F(1.0f + 0.01f * static_cast<float>(i));
    print(limit, std::to_string(width_of<F>),
          units_per_ns(1.0 * operations * chains * steps * width_of<F>, repetitions, [&] {
              auto now = x;
              for (int s = 0; s < steps; ++s)
                  for (F& of_chain : now) of_chain = step(of_chain);
              F sum = now[0];
              for (std::size_t i = 1; i < chains; ++i) sum = sum + now[i];
              sink = lane_of(sum, 0);
          }));
}

template <typename F>
void measure_arithmetic(int repetitions) {
    const F a(0.75f), b(0.25f);  // the numbers stay close to 1
    measure_arithmetic<F>("multiply and add", 2, repetitions, [=](F x) { return x * a + b; });
    measure_arithmetic<F>("divide", 1, repetitions, [=](F x) { return a / x; });
}

}  // namespace

void measure_limits(int repetitions) {
    for (std::size_t bytes = 1 << 13; bytes <= 1 << 27; bytes *= 4) {
        measure_writes(bytes, repetitions);
        measure_reads(bytes, repetitions);
    }
    for (int side = 64; side <= 4096; side *= 2)
        for (const bool at_random : {true, false}) measure_texels(side, at_random, repetitions);
    measure_arithmetic<float>(repetitions);
    measure_arithmetic<Floats<4>>(repetitions);
    measure_arithmetic<Floats<8>>(repetitions);
    measure_arithmetic<Floats<16>>(repetitions);
}

}  // namespace rasterbook
