// SPDX-License-Identifier: MIT
#include "common/app/threads.hpp"

#include <atomic>
#include <exception>
#include <limits>
#include <mutex>
#include <system_error>
#include <vector>

namespace rasterbook {

void for_each_at_once(int at_once, int first, int last, const std::function<void(int)>& task) {
    std::atomic<int> next = first;
    std::mutex mutex;
    int failed = std::numeric_limits<int>::max();
    std::exception_ptr error;
    const auto take_tasks = [&] {
        for (int i; (i = next.fetch_add(1)) <= last;) try {
                task(i);
            } catch (...) {
                next = last + 1;
                const std::lock_guard lock(mutex);
                if (i < failed) failed = i, error = std::current_exception();
            }
    };
    {
        std::vector<std::jthread> others;
        try {
            for (int i = 1; i < std::min(at_once, last - first + 1); ++i)
                others.emplace_back(take_tasks);
        } catch (const std::system_error&) {}  // those that there are do the rest
        take_tasks();
    }
    if (error) std::rethrow_exception(error);
}

}  // namespace rasterbook
