// SPDX-License-Identifier: MIT
/// @file
/// A pool of threads that are started once and then share out one job after the other. Introduced
/// in lesson 10; derivation: docs/derivations/10_threading.md.
#pragma once

#include <atomic>
#include <cassert>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "common/app/workers.hpp"

namespace rasterbook {

/// A number of tasks, and which one comes next.
struct Job {
    std::size_t tasks;
    const Workers::Task& task;
    std::atomic<std::size_t> next = 0;  ///< The first task that nobody has taken.
    std::exception_ptr error = nullptr;
};

/// Workers that wait for jobs. A job is a number of tasks, and each worker that is free takes the
/// next one.
class ThreadPool : public Workers {
  public:
    /// @param threads  The caller's among them: one less is started. At least 1.
    /// @throws std::system_error  When the system does not give that many; none is left running.
    explicit ThreadPool(int threads) {
        assert(threads >= 1 && "the caller is a worker, too");
        workers_.reserve(static_cast<std::size_t>(threads - 1));
        for (std::size_t worker = 1; worker < static_cast<std::size_t>(threads); ++worker)
            workers_.emplace_back([this, worker](std::stop_token stop) { work(stop, worker); });
    }

    /// How many work, the caller among them.
    std::size_t size() const override { return workers_.size() + 1; }

    /// Does all tasks of run(), and comes back when all are done.
    ///
    /// What is written before is seen by the tasks, and what they write is seen after.
    ///
    /// @param tasks  May be 0.
    /// @param task   Called as task(i, worker) for i from 0 to tasks - 1, each once, by several
    ///               threads at once, in no fixed order. Of the calls by one worker, numbered from
    ///               0, the caller, to size() - 1, only one runs at a time. When one throws, no
    ///               other is taken; when those taken have ended, this throws what the first one
    ///               threw, and the pool can be used as before.
    ///
    /// Not to be called by two threads at once, nor by a task.
    void run_tasks(std::size_t tasks, const Task& task) override {
        Job job{tasks, task};
        {
            const std::lock_guard lock(mutex_);
            assert(job_ == nullptr && busy_ == 0 && "one job at a time");
            job_ = &job;
            ++jobs_;
        }
        has_job_.notify_all();
        take_tasks(job, 0);
        std::unique_lock lock(mutex_);
        job_ = nullptr;  // Who wakes up late goes to sleep again, and is not waited for.
        is_done_.wait(lock, [this] { return busy_ == 0; });
        if (job.error) std::rethrow_exception(job.error);
    }

  private:
    void take_tasks(Job& job, std::size_t worker) {
        try {
            // The count alone has to be atomic: the mutex orders all other memory.
            for (std::size_t i; (i = job.next.fetch_add(1, std::memory_order_relaxed)) < job.tasks;)
                job.task(i, worker);
        } catch (...) {
            job.next.store(job.tasks, std::memory_order_relaxed);
            const std::lock_guard lock(mutex_);
            if (!job.error) job.error = std::current_exception();
        }
    }

    void work(const std::stop_token& stop, std::size_t worker) {
        std::size_t seen = 0;
        std::unique_lock lock(mutex_);
        const auto is_new = [&] { return job_ != nullptr && jobs_ != seen; };
        while (has_job_.wait(lock, stop, is_new)) {
            Job& job = *job_;
            seen = jobs_;
            ++busy_;
            lock.unlock();
            take_tasks(job, worker);
            lock.lock();
            if (--busy_ == 0) is_done_.notify_one();
        }
    }

    std::mutex mutex_;
    std::condition_variable_any has_job_;
    std::condition_variable is_done_;
    Job* job_ = nullptr;
    std::size_t jobs_ = 0;               ///< So many there have been: nobody joins one twice.
    std::size_t busy_ = 0;               ///< Workers in the job, but for the caller.
    std::vector<std::jthread> workers_;  ///< Last: they end before what they use.
};

}  // namespace rasterbook
