// SPDX-License-Identifier: MIT
/// @file
/// Ways to split a picture: what they cost on one thread, what they bring on two, and what the
/// times of their tiles predict for up to 128.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "10_threading/schedule.hpp"
#include "10_threading/thread_options.hpp"
#include "10_threading/thread_pool.hpp"
#include "accuracy/accuracy.hpp"
#include "common/app/memory.hpp"
#include "support/lesson_10.hpp"
#include "support/pictures.hpp"
#include "support/pretend_pool.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// What a time is when nothing else on the machine makes it longer.
double least_of(const std::vector<double>& times) {
    return *std::min_element(times.begin(), times.end());
}

lesson_10::Options options_of(Split split, int tile) {
    lesson_10::Options options;
    options.size = {1920, 1080};
    options.threads.split = split, options.threads.tile = tile;
    return options;
}

const ShadowAssets& assets() {
    static const ShadowAssets made =
        lesson_10::make_assets(loaded("scene_bumpy.obj"), lesson_10::Options());
    return made;
}

double frame_ms(const lesson_10::Options& options, Workers& pool) {
    const auto start = Clock::now();
    const Image<vec3> picture = lesson_10::render(options, assets(), pool);
    return ms_since(start);
}

/// What a frame is made of, measured on one thread.
struct Frame {
    double serial_ms;  ///< Between jobs.
    std::vector<std::vector<double>> jobs_ms;

    double work_ms() const {
        double sum = serial_ms;
        for (const auto& job : jobs_ms) sum = std::accumulate(job.begin(), job.end(), sum);
        return sum;
    }
    double predicted_ms(std::size_t workers) const {
        double sum = serial_ms;
        for (const auto& job : jobs_ms) sum += schedule_of(job, workers).finish;
        return sum;
    }
};

/// The least of several frames, split for so many workers.
Frame measured_frame(const lesson_10::Options& options, std::size_t workers) {
    constexpr std::size_t frames = 9;
    std::vector<MeasuredPool> pools;
    std::vector<double> serial_ms;
    frame_ms(options, pools.emplace_back(workers));  // fills the caches
    pools.clear();
    for (std::size_t i = 0; i < frames; ++i) {
        pools.emplace_back(workers);
        const double ms = frame_ms(options, pools.back());
        serial_ms.push_back(ms - pools.back().in_jobs_ms);
    }
    Frame frame{least_of(serial_ms), pools[0].jobs_ms};
    for (std::size_t job = 0; job < frame.jobs_ms.size(); ++job)
        for (std::size_t task = 0; task < frame.jobs_ms[job].size(); ++task) {
            std::vector<double> times;
            for (const MeasuredPool& pool : pools) times.push_back(pool.jobs_ms[job][task]);
            frame.jobs_ms[job][task] = least_of(times);
        }
    return frame;
}

void add_split(const std::string& name, Split split, int tile) {
    const lesson_10::Options options = options_of(split, tile);
    Errors errors;
    std::optional<Frame> tiles;  // rows are made anew for each number of workers
    for (const std::size_t workers : {2u, 4u, 8u, 16u, 32u, 64u, 128u}) {
        if (!tiles || split != Split::tiles) tiles = measured_frame(options, workers);
        const double ms = tiles->predicted_ms(workers);
        errors["on " + std::to_string(workers) + ", ms"] = ms;
        if (workers != 16) continue;
        errors["idle on 16, %"] = 100 * schedule_of(tiles->jobs_ms.back(), 16).idle_share();
        errors["idle on 16 in the whole frame, %"] = 100 * (1 - tiles->work_ms() / (16 * ms));
        errors["serial, ms"] = tiles->serial_ms;
    }
    // By the clock, one and two threads by turns.
    ThreadPool one(1), two(2);
    std::vector<double> of_one, of_two;
    for (int i = 0; i < 25; ++i) {
        of_one.push_back(frame_ms(options, one));
        of_two.push_back(frame_ms(options, two));
    }
    errors["two threads, ms"] = least_of(of_two);
    errors["two against one"] = least_of(of_one) / least_of(of_two);
    add_variant("split", name, 1e6, errors, [=] {
        MeasuredPool pool(16);
        frame_ms(options, pool);
    });
}

}  // namespace

int main(int argc, char** argv) {
    keep_freed_memory();
    add_split("rows", Split::rows, 64);
    add_split("interleaved", Split::interleaved, 64);
    for (const int tile : {8, 16, 32, 64, 128, 256})
        add_split("tiles of " + std::to_string(tile), Split::tiles, tile);
    return measure_variants(argc, argv);
}
