// SPDX-License-Identifier: MIT
/// @file
/// Several threads for what takes long and does not hang together.
#pragma once

#include <algorithm>
#include <functional>
#include <thread>

namespace rasterbook {

constexpr int max_threads = 256;

/// As many as the machine runs at once; 1 where it does not say.
inline int threads_of_the_machine() {
    return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, max_threads);
}

/// Calls task(i) for each i from first to last, by several threads, the caller among them: who has
/// nothing to do takes the next one.
///
/// When tasks throw, no other is begun; when all that run have ended, throws what the one with the
/// least i threw. That is the same one as without threads, if a task's error depends on i alone.
///
/// @param at_once  So many threads at most, at least 1. Where the system gives fewer, fewer do it.
void for_each_at_once(int at_once, int first, int last, const std::function<void(int)>& task);

}  // namespace rasterbook
