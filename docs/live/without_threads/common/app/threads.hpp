// SPDX-License-Identifier: MIT
/// @file
/// Takes the place of common/app/threads.hpp where there are no threads.
#pragma once

#include <functional>

namespace rasterbook {

constexpr int max_threads = 1;

inline int threads_of_the_machine() { return 1; }

inline void for_each_at_once(int, int first, int last, const std::function<void(int)>& task) {
    for (int i = first; i <= last; ++i) task(i);
}

}  // namespace rasterbook
