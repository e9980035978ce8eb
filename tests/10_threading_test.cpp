// SPDX-License-Identifier: MIT
// The pool of threads.
#include "10_threading/thread_pool.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <iostream>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/app/counters.hpp"
#include "support/look_up.hpp"
#include "support/name_of_split.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// What a task throws: all of it has to arrive.
struct Trouble : std::runtime_error {
    Trouble(std::size_t of, std::vector<int> with)
        : std::runtime_error("task " + std::to_string(of)), task(of), numbers(std::move(with)) {}

    std::size_t task;
    std::vector<int> numbers;
};

}  // namespace

TEST(Threading, Eq10_8_ThePoolDoesEachTaskOnce) {
    for (const int threads : {1, 2, 3}) {
        constexpr std::size_t tasks = 10;
        std::vector<std::atomic<int>> times(tasks);
        std::vector<std::atomic<bool>> has_worked(static_cast<std::size_t>(threads));
        std::atomic<int> begun = 0;
        ThreadPool pool(threads);
        ASSERT_EQ(pool.size(), static_cast<std::size_t>(threads))
            << "workers of a pool of " << threads << " threads: the caller is one of them";
        pool.run(tasks, [&](std::size_t task, std::size_t worker) {
            ASSERT_LT(task, tasks) << "task numbers are 0 to 9";
            ASSERT_LT(worker, has_worked.size()) << "of " << threads << " threads";
            has_worked[worker] = true;
            // Until all have a task, at most for two seconds: so nobody does all of them.
            const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
            for (++begun; begun < threads && std::chrono::steady_clock::now() < end;)
                std::this_thread::yield();
            // The caller is done first, and has to wait for the others.
            if (worker != 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
            ++times[task];
        });
        // Said at once: workers that go on in a job that is gone may crash.
        if (const auto left = std::ranges::count_if(times, [](const auto& n) { return n == 0; });
            left > 0)
            std::cerr << "run() came back before " << left << " of 10 tasks were done, with "
                      << threads << " threads\n";
        for (std::size_t task = 0; task < tasks; ++task)
            ASSERT_EQ(times[task], 1) << "so often task " << task << " of 10 has been done by "
                                      << threads << " threads when run() comes back";
        for (std::size_t worker = 0; worker < has_worked.size(); ++worker)
            ASSERT_TRUE(has_worked[worker])
                << "no task is given to worker " << worker << " of " << threads;
    }
    // Short tasks: whoever reads the counter and writes it in two steps takes some twice.
    ThreadPool pool(2);
    constexpr std::size_t tasks = 5'000'000;
    struct alignas(cache_line) Count {
        std::size_t tasks = 0;
    };
    std::array<Count, 2> done;
    pool.run(tasks, [&](std::size_t, std::size_t worker) { ++done.at(worker).tasks; });
    EXPECT_EQ(done[0].tasks + done[1].tasks, tasks)
        << "short tasks done by 2 threads; if there are more, both took the same one: to read the "
           "counter and to write it has to be one step";
}

TEST(Threading, HardCase_EachTaskIsDoneOnceByOneWorkerAndSeesWhatTheJobBeforeWrote) {
    look_up("The pool");
    // Plain numbers, written by any thread: each job adds to what the last one left.
    for (const int threads : thread_counts) {
        ThreadPool pool(threads);
        std::vector<int> times(1000);
        std::vector<std::atomic<int>> in_work(pool.size());
        for (int repeat = 0; repeat < 100; ++repeat)
            for (const std::size_t tasks : {0u, 1u, 2u, 60u, 61u, 62u, 1000u}) {
                std::vector<int> expected = times;
                for (std::size_t i = 0; i < tasks; ++i) ++expected[i];
                pool.run(tasks, [&](std::size_t task, std::size_t worker) {
                    ASSERT_LT(task, tasks);
                    ASSERT_LT(worker, pool.size());
                    EXPECT_EQ(in_work[worker]++, 0) << "worker " << worker << " does two at a time";
                    ++times[task];
                    --in_work[worker];
                });
                ASSERT_EQ(times, expected)
                    << "times that each task was done in all jobs, the last one of " << tasks
                    << " tasks, " << threads << " threads";
            }
    }
}

TEST(Threading, HardCase_ThreadsAreStartedOnce) {
    look_up("The pool");
    for (const int threads : thread_counts) {
        ThreadPool pool(threads);
        std::vector<std::set<std::thread::id>> ids(pool.size());
        for (int job = 0; job < 200; ++job)
            pool.run(2 * pool.size(), [&](std::size_t, std::size_t worker) {
                ids[worker].insert(std::this_thread::get_id());
            });
        std::set<std::thread::id> all = {std::this_thread::get_id()};
        all.merge(ids[0]);  // the caller is worker 0, which may be too late for each task
        EXPECT_EQ(all.size(), 1u) << "threads that were worker 0";
        for (const auto& of_worker : std::span(ids).subspan(1)) {
            EXPECT_LE(of_worker.size(), 1u) << "a worker is one thread";
            for (const std::thread::id id : of_worker)
                EXPECT_TRUE(all.insert(id).second) << "a thread is one worker";
        }
    }
}

TEST(Threading, HardCase_WhatATaskThrowsArrivesWholeAndNothingHangs) {
    look_up("The pool");
    for (const int threads : thread_counts) {
        ThreadPool pool(threads);
        for (const std::size_t thrower : {0u, 1u, 40u, 99u}) {
            try {
                pool.run(100, [&](std::size_t task, std::size_t) {
                    if (task == thrower) throw Trouble(task, {1, 2, 3});
                });
                FAIL() << "task " << thrower << " of 100 throws, with " << threads
                       << " threads, and run() does not";
            } catch (const Trouble& trouble) {
                EXPECT_EQ(trouble.task, thrower);
                EXPECT_EQ(trouble.numbers, (std::vector{1, 2, 3}));
                EXPECT_EQ(trouble.what(), "task " + std::to_string(thrower));
            }
            std::atomic<int> done = 0;  // and the pool can be used as before
            pool.run(100, [&](std::size_t, std::size_t) { ++done; });
            EXPECT_EQ(done, 100);
        }
    }
}

TEST(Threading, HardCase_OfTwoThatThrowTheFirstArrives) {
    look_up("The pool");
    ThreadPool pool(2);
    for (const std::size_t first : {0u, 1u}) {
        std::atomic<int> begun = 0;
        std::atomic<bool> is_thrown = false;
        try {
            pool.run(2, [&](std::size_t task, std::size_t) {
                ++begun;
                while (begun < 2 || (task != first && !is_thrown)) std::this_thread::yield();
                // Enough for the other one to have its error kept, if it is not held up for long.
                if (is_thrown.exchange(true))
                    std::this_thread::sleep_for(std::chrono::milliseconds(200));
                throw Trouble(task, {});
            });
            ADD_FAILURE() << "both tasks throw, and run() does not";
        } catch (const Trouble& trouble) {
            EXPECT_EQ(trouble.task, first) << "the task that threw first is kept";
        }
    }
}

TEST(Threading, HardCase_AfterATaskHasThrownNoOtherIsBegun) {
    look_up("The pool");
    for (const int threads : {2, 16}) {
        ThreadPool pool(threads);
        std::atomic<bool> is_thrown = false;
        std::atomic<int> begun = 0;
        const auto throws = [&](std::size_t task, std::size_t) {
            ++begun;
            if (task == 0) {
                is_thrown = true;
                throw Trouble(task, {});
            }
            while (!is_thrown) std::this_thread::yield();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        };
        EXPECT_THROW(pool.run(100000, throws), Trouble);
        EXPECT_LT(begun, 100000) << threads << " threads";
    }
}

TEST(Threading, WhatWorkersCountIsTheCallers) {
    look_up("Why no locks?");
    for (const int threads : {1, 2, 5})
        for (const bool throws : {false, true}) {
            ThreadPool pool(threads);
            const std::size_t n = pool.size();
            count(Counter::fragments_lit, 3);
            const Counters before = thread_counters;
            std::atomic<std::size_t> begun = 0;
            const auto task = [&](std::size_t i, std::size_t) {  // each worker has one
                for (++begun; begun < n;) std::this_thread::yield();
                count(Counter::fragments_lit, 10 * (i + 1));
                if (throws) throw std::runtime_error("no memory");
            };
            if (throws)
                EXPECT_THROW(pool.run(n, task), std::runtime_error);
            else
                pool.run(n, task);
            EXPECT_EQ(thread_counters[Counter::fragments_lit],
                      before[Counter::fragments_lit] + (throws ? 0 : 5 * n * (n + 1)))
                << threads << " threads" << (throws ? ", after a job whose tasks have thrown" : "");
        }
}
