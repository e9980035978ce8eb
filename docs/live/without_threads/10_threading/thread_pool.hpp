// SPDX-License-Identifier: MIT
/// @file
/// Takes the place of lesson 10's pool where there are no threads: the caller does all tasks.
#pragma once

#include <cstddef>

namespace rasterbook {

class ThreadPool {
  public:
    explicit ThreadPool(int) {}

    std::size_t size() const { return 1; }

    template <typename Task>
    void run(std::size_t tasks, const Task& task) {
        for (std::size_t i = 0; i < tasks; ++i) task(i, std::size_t{0});
    }
};

template <typename CounterPolicy>
class WorkerCounters {
  public:
    explicit WorkerCounters(std::size_t) {}

    CounterPolicy& operator[](std::size_t) { return counters_; }
    void add_to(CounterPolicy& sum) const { sum.add(counters_); }

  private:
    CounterPolicy counters_;
};

}  // namespace rasterbook
