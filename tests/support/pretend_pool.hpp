// SPDX-License-Identifier: MIT
/// @file
/// Stand-ins for a ThreadPool, in which one thread does all the work.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "common/app/workers.hpp"

namespace rasterbook::test {

/// Does the tasks in any order and gives each to any worker; the same ones each time.
class ShuffledPool : public Workers {
  public:
    ShuffledPool(std::size_t workers, std::uint32_t seed) : workers_(workers), random_(seed) {}

    std::size_t size() const override { return workers_; }

    void run_tasks(std::size_t tasks, const Task& task) override {
        std::vector<std::size_t> order(tasks);
        std::iota(order.begin(), order.end(), std::size_t{0});
        for (std::size_t i = tasks; i > 1; --i) std::swap(order[i - 1], order[random_() % i]);
        for (const std::size_t i : order) task(i, random_() % workers_);
    }

  private:
    std::size_t workers_;
    std::mt19937 random_;
};

/// Does the tasks in order and writes down how long each takes.
class MeasuredPool : public Workers {
  public:
    /// @param workers  As many as it pretends to have: parts are made for them.
    explicit MeasuredPool(std::size_t workers) : workers_(workers) {}

    std::size_t size() const override { return workers_; }

    void run_tasks(std::size_t tasks, const Task& task) override {
        const auto begin = Clock::now();
        std::vector<double>& job_ms = jobs_ms.emplace_back();
        job_ms.reserve(tasks);
        for (std::size_t i = 0; i < tasks; ++i) {
            const auto start = Clock::now();
            task(i, 0);
            job_ms.push_back(ms_from(start));
        }
        in_jobs_ms += ms_from(begin);
    }

    std::vector<std::vector<double>> jobs_ms;  ///< Of each job so far, each task's time.
    double in_jobs_ms = 0;                     ///< All jobs', and the measuring itself.

  private:
    using Clock = std::chrono::steady_clock;

    static double ms_from(Clock::time_point start) {
        return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    }

    std::size_t workers_;
};

}  // namespace rasterbook::test
