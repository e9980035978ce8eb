// SPDX-License-Identifier: MIT
/// @file
/// Measures what the figure docs/live/figures/schedule.js shares out: how long one thread takes to
/// draw each tile of lesson 10's picture, for several ways to split it.
///
///     cmake --build --preset release --target schedule_costs
///     build/release/tests/schedule_costs >docs/live/figures/schedule_costs.inc
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <limits>
#include <vector>

#include "common/app/memory.hpp"
#include "common/app/workers.hpp"
#include "support/lesson_10.hpp"
#include "support/pictures.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// Does the tasks in order and writes down how long the thread works on each of the last job's:
/// what else runs on the machine does not count.
class CpuTimedPool : public Workers {
  public:
    /// @param workers  As many as it pretends to have.
    explicit CpuTimedPool(std::size_t workers) : workers_(workers) {}

    std::size_t size() const override { return workers_; }

    void run_tasks(std::size_t tasks, const Task& task) override {
        microseconds.clear();
        for (std::size_t i = 0; i < tasks; ++i) {
            const double start = now();
            task(i, 0);
            microseconds.push_back(now() - start);
        }
    }

    std::vector<double> microseconds;

  private:
    static double now() {
        timespec time;
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return 1e6 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_nsec);
    }

    std::size_t workers_;
};

/// The least of several frames, for each task of the job that draws.
std::vector<double> drawing_us(const lesson_10::Options& options, std::size_t workers) {
    static const ShadowAssets assets =
        lesson_10::make_assets(loaded("scene_bumpy.obj"), lesson_10::Options());
    constexpr int frames = 9;
    std::vector<double> least;
    for (int i = 0; i < frames; ++i) {
        CpuTimedPool pool(workers);
        lesson_10::render(options, assets, pool);
        const std::vector<double>& us = pool.microseconds;
        least.resize(us.size(), std::numeric_limits<double>::infinity());
        std::transform(us.begin(), us.end(), least.begin(), least.begin(),
                       [](double a, double b) { return std::min(a, b); });
    }
    return least;
}

void print(const char* split_name, Split split, int tile, std::size_t workers) {
    lesson_10::Options options;
    options.size = {1920, 1080};
    options.threads.split = split, options.threads.tile = tile;
    std::cout << "{Split::" << split_name << ", " << tile << ", " << workers << ", {";
    const char* before = "";
    for (const double us : drawing_us(options, workers)) {
        std::cout << before << std::lround(us);
        before = ",";
    }
    std::cout << "}},\n";
}

}  // namespace

int main() {
    keep_freed_memory();
    std::cout << "// SPDX-License-Identifier: MIT\n"
                 "// Split, tile size, workers, and microseconds of each task. Measured by\n"
                 "// tests/benchmarks/schedule_costs.cpp, which says how.\n";
    for (const int tile : {32, 64, 128, 256}) print("tiles", Split::tiles, tile, 16);
    for (std::size_t workers = 1; workers <= 128; workers *= 2) {
        print("rows", Split::rows, 64, workers);
        print("interleaved", Split::interleaved, 64, workers);
    }
}
