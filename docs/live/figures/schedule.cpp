// SPDX-License-Identifier: MIT
/// @file
/// Lesson 10's schedule of measured tiles, for the figure schedule.js.
#include <algorithm>
#include <vector>

#include "10_threading/schedule.hpp"
#include "10_threading/split.hpp"

namespace rasterbook {
namespace {

struct Measured {
    Split split;
    int tile;
    std::size_t workers;  ///< Tiles are the same for any number.
    std::vector<int> microseconds;
};
const Measured measurements[] = {
#include "schedule_costs.inc"
};

const Measured& measured(Split split, int tile, std::size_t workers) {
    return *std::find_if(std::begin(measurements), std::end(measurements), [&](const Measured& m) {
        return m.split == split && (split == Split::tiles ? m.tile == tile : m.workers == workers);
    });
}

/// What a worker does from one time to another, ms.
struct Task {
    double worker, begin, end;
    double left, top, right, bottom;  ///< Of the tile, in pixels of the picture.
    double row_step;
};
std::vector<Task> tasks;

struct Summary {
    double work, finish, least, most, idle_share;
};
Summary summary;

}  // namespace

/// Shares out the tiles of lesson 10's picture.
///
/// @param split   As in Split.
/// @param tile    Pixels along a tile's side: 32, 64, 128 or 256.
/// @param workers A power of two up to 128.
extern "C" int share_out(int split, int tile, int workers) {
    const auto& costs = measured(Split(split), tile, workers).microseconds;
    const std::vector<double> times_us(costs.begin(), costs.end());
    const Schedule schedule = schedule_of(times_us, workers);
    summary = {schedule.work, schedule.finish, schedule.least(), schedule.most(),
               schedule.idle_share()};

    // schedule_of does not say who does what: the same once more.
    const Tiling tiling(Split(split), {1920, 1080}, workers, tile);
    std::vector<double> free_at(workers, 0.0);
    tasks.clear();
    for (std::size_t i = 0; i < times_us.size(); ++i) {
        const auto worker = std::min_element(free_at.begin(), free_at.end());
        const auto [box, row_step] = tiling[i];
        tasks.push_back({double(worker - free_at.begin()), *worker, *worker + times_us[i],
                         double(box.first.x), double(box.first.y), box.last.x + 1.0,
                         box.last.y + 1.0, double(row_step)});
        *worker += times_us[i];
    }
    return int(tasks.size());
}

/// Of the last call of share_out().
extern "C" const Task* shared_out() { return tasks.data(); }
extern "C" const Summary* summed_up() { return &summary; }

}  // namespace rasterbook
