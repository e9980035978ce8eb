// SPDX-License-Identifier: MIT
/// @file
/// Takes the place of lesson 10's pool where there are no threads: the caller does all tasks.
#pragma once

#include <cstddef>

#include "common/app/workers.hpp"

namespace rasterbook {

class ThreadPool : public Workers {
  public:
    explicit ThreadPool(int) {}

    std::size_t size() const override { return 1; }

    void run_tasks(std::size_t tasks, const Task& task) override {
        for (std::size_t i = 0; i < tasks; ++i) task(i, std::size_t{0});
    }
};

}  // namespace rasterbook
