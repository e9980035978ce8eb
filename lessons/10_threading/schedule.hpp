// SPDX-License-Identifier: MIT
/// @file
/// How long tasks take when several workers share them out: predicted from what each takes alone.
/// Introduced in lesson 10; derivation: docs/derivations/10_threading.md.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <functional>
#include <queue>
#include <span>
#include <vector>

namespace rasterbook {

/// How many times as fast p workers are when a share of the work is left to one of them (Eq. 10.2).
///
/// @param serial_share  0 to 1.
/// @param workers       At least 1.
constexpr double amdahl_speedup(double serial_share, std::size_t workers) {
    return 1 / (serial_share + (1 - serial_share) / static_cast<double>(workers));
}

/// How a job goes. Any unit of time.
struct Schedule {
    double work = 0;     ///< What all tasks take, one after the other (Eq. 10.1).
    double longest = 0;  ///< What the longest takes.
    double finish = 0;   ///< When the last one ends (Eq. 10.8).
    std::size_t workers = 1;

    /// No schedule ends sooner (Eq. 10.1).
    double least() const { return std::max(work / static_cast<double>(workers), longest); }

    /// Tasks taken from a counter end by then, in whatever order they stand there (Eq. 10.9).
    double most() const {
        const auto p = static_cast<double>(workers);
        return work / p + (1 - 1 / p) * longest;
    }

    /// The share of all workers' time in which they wait for the last one, 0 to 1 (Eq. 10.10). A
    /// job that takes no time has none.
    double idle_share() const {
        return finish > 0 ? std::max(0.0, 1 - work / (static_cast<double>(workers) * finish)) : 0;
    }
};

/// Shares out tasks in order: each goes to the worker that is free first (Eq. 10.8).
///
/// @param times    What each task takes, >= 0.
/// @param workers  At least 1.
inline Schedule schedule_of(std::span<const double> times, std::size_t workers) {
    assert(workers >= 1);
    Schedule schedule;
    schedule.workers = workers;
    std::priority_queue<double, std::vector<double>, std::greater<>> free_at(
        std::greater<>(), std::vector<double>(workers, 0.0));
    for (const double time_taken : times) {
        const double end = free_at.top() + time_taken;
        free_at.pop();
        free_at.push(end);
        schedule.work += time_taken;
        schedule.longest = std::max(schedule.longest, time_taken);
        schedule.finish = std::max(schedule.finish, end);
    }
    return schedule;
}

}  // namespace rasterbook
