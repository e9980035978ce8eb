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
        // TODO: one less than `threads`, numbered from 1: each is a std::jthread, whose function
        // takes a std::stop_token and calls work() with it and its number.
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
        // TODO: make the job known to all, wake them up, take tasks as worker 0, and wait until
        // nobody is in the job any more. A worker that wakes up after that must not find it. Throw
        // what was kept, if anything was.
    }

  private:
    void take_tasks(Job& job, std::size_t worker) {
        // TODO: take tasks from job.next and call job.task(i, worker), as long as there
        // are any. If one throws, keep it if it is the first, and let nobody begin another.
    }

    void work(const std::stop_token& stop, std::size_t worker) {
        // TODO: wait for a job that this worker has not been in, take tasks, and again, until
        // `stop`. has_job_.wait(lock, stop, condition) gives false once the pool is to end and
        // there is no job. While it is in the job, busy_ counts it; the last one to leave notifies
        // is_done_.
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
