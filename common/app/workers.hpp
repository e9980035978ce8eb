// SPDX-License-Identifier: MIT
/// @file
/// Who does the tasks of a job: lesson 10's pool of threads, or whoever takes its place.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "common/app/counters.hpp"

namespace rasterbook {

/// Bytes that cores exchange at once, at most. Two threads that write within them wait for each
/// other: false sharing.
constexpr std::size_t cache_line = 128;

/// Workers that share out the tasks of a job.
class Workers {
  public:
    /// Called with the number of a task, and with that of the worker who does it.
    using Task = std::function<void(std::size_t i, std::size_t worker)>;

    virtual ~Workers() = default;

    /// How many there are. At least 1: the caller is one of them.
    virtual std::size_t size() const = 0;

    /// Does all tasks, and comes back when all are done. What the workers count is added to the
    /// caller's counters.
    ///
    /// @param tasks  May be 0.
    /// @throws       What the first task to throw has thrown; then nothing is added.
    void run(std::size_t tasks, const Task& task) {
        struct alignas(cache_line) Apart {
            Counters counters;
        };
        std::vector<Apart> counted(size());
        run_tasks(tasks, [&](std::size_t i, std::size_t worker) {
            const Uncounted in_its_own_thread;  // also where the task throws
            thread_counters = {};
            task(i, worker);
            counted[worker].counters += thread_counters;
        });
        for (const Apart& one : counted) thread_counters += one.counters;
    }

    /// What run() shares out. Calls task(i, worker) for i from 0 to tasks - 1, each once, in any
    /// order. Of the calls by one worker, numbered from 0 to size() - 1, only one runs at a time.
    virtual void run_tasks(std::size_t tasks, const Task& task) = 0;
};

}  // namespace rasterbook
