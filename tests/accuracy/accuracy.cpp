// SPDX-License-Identifier: MIT
#include "accuracy/accuracy.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

namespace rasterbook::test {

namespace {

constexpr double seconds_a_repetition = 0.05;
int variants = 0;
int repetitions_of_each = 1;
int repetitions_done = 0;

/// How often to do the work in one repetition.
benchmark::IterationCount iterations_of(const std::function<void()>& work) {
    work();  // fills the caches
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> once = std::chrono::steady_clock::now() - start;
    return static_cast<benchmark::IterationCount>(
        std::ceil(seconds_a_repetition / std::max(once.count(), 1e-6)));
}

}  // namespace

void add_variant(const std::string& comparison, const std::string& variant, double units,
                 Errors errors, std::function<void()> work) {
    const auto iterations = iterations_of(work);
    const auto run = [=](benchmark::State& state) {
        for (auto _ : state) {
            work();
            benchmark::ClobberMemory();
        }
        using benchmark::Counter;
        const double nanounits = 1e-9 * units * static_cast<double>(iterations);
        state.counters["ns"] = Counter(nanounits, Counter::kIsRate | Counter::kInvert);
        for (const auto& [name, error] : errors) state.counters[name] = error;
        std::cerr << "\r  " << ++repetitions_done << " of " << variants * repetitions_of_each
                  << " repetitions" << std::flush;
    };
    ++variants;
    benchmark::RegisterBenchmark((comparison + "/" + variant).c_str(), run)->Iterations(iterations);
}

int measure_variants(int argc, char** argv) {
#ifdef __clang__
    benchmark::AddCustomContext("compiler", "clang " __clang_version__);
#else
    benchmark::AddCustomContext("compiler", "g++ " __VERSION__);
#endif
    const std::string repetitions = "--benchmark_repetitions=";
    for (const std::string& option : std::vector<std::string>(argv, argv + argc))
        if (option.starts_with(repetitions))
            repetitions_of_each = std::atoi(option.substr(repetitions.size()).c_str());
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    std::cerr << '\n';
    return 0;
}

}  // namespace rasterbook::test
