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
#include <string>
#include <vector>

#include "14_simd/simd.hpp"
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
    for (std::size_t bytes = 1 << 13; bytes <= 1 << 27; bytes *= 4)
        measure_reads(bytes, repetitions);
    measure_arithmetic<float>(repetitions);
    measure_arithmetic<Floats<4>>(repetitions);
    measure_arithmetic<Floats<8>>(repetitions);
    measure_arithmetic<Floats<16>>(repetitions);
}

}  // namespace rasterbook
