// SPDX-License-Identifier: MIT
// The pool, the tiles of a picture, and what a schedule predicts.
#include "10_threading/thread_pool.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "10_threading/schedule.hpp"
#include "10_threading/split.hpp"
#include "common/app/counters.hpp"
#include "common/image/image.hpp"
#include "support/look_up.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr std::array thread_counts = {1, 2, 3, 4, 7, 8, 16, 61};
constexpr std::array splits = {Split::rows, Split::interleaved, Split::tiles};

/// What a task throws: all of it has to arrive.
struct Trouble : std::runtime_error {
    Trouble(std::size_t of, std::vector<int> with)
        : std::runtime_error("task " + std::to_string(of)), task(of), numbers(std::move(with)) {}

    std::size_t task;
    std::vector<int> numbers;
};

/// How many tiles each pixel of a picture is in.
Image<int> hits_of(const Tiling& tiling) {
    Image<int> hits(tiling.size(), 0);
    for (std::size_t i = 0; i < tiling.count(); ++i)
        for_each_strip(tiling[i], [&](const PixelBox& strip) {
            for (int y = strip.first.y; y <= strip.last.y; ++y)
                for (int x = strip.first.x; x <= strip.last.x; ++x)
                    if (hits.contains({x, y}))
                        ++hits[{x, y}];
                    else
                        ADD_FAILURE() << "(" << x << ", " << y << ") is outside";
        });
    return hits;
}

/// By definition, pixel by pixel: which tile a pixel is in.
std::size_t tile_of(ivec2 pixel, Split split, ivec2 size, int workers, int side) {
    const int n = std::min(workers, size.y);
    if (split == Split::interleaved) return static_cast<std::size_t>(pixel.y % n);
    if (split == Split::tiles)
        return static_cast<std::size_t>((pixel.y / side) * ((size.x + side - 1) / side) +
                                        pixel.x / side);
    int tile = 0;
    for (int y = 0, in_tile = 0; y < pixel.y; ++y)
        if (++in_tile == size.y / n && tile < n - 1) ++tile, in_tile = 0;
    return static_cast<std::size_t>(tile);
}

/// Any triangle around a picture: from a fraction of a pixel to far larger than it.
ScreenTriangle any_triangle(std::mt19937& random, ivec2 size) {
    std::uniform_real_distribution<float> any(-1, 1), power(-2, 3);
    const float extent = std::pow(10.0f, power(random));
    const auto coordinate = [&](int side) {
        return 0.5f * static_cast<float>(side) * (1 + 1.2f * any(random));
    };
    const float x = coordinate(size.x), y = coordinate(size.y);
    const auto vertex = [&] {
        const float dx = any(random), dy = any(random);
        return vec2(x, y) + extent * vec2(dx, dy);
    };
    const vec2 a = vertex(), b = vertex(), c = vertex();
    return snap_triangle(a, b, c);
}

}  // namespace

TEST(Threading, HardCase_EachTaskIsDoneOnceByOneWorker) {
    look_up("The pool");
    for (const int threads : thread_counts) {
        ThreadPool pool(threads);
        EXPECT_EQ(pool.size(), static_cast<std::size_t>(threads));
        for (const std::size_t tasks : {0u, 1u, 2u, 60u, 61u, 62u, 1000u}) {
            std::vector<std::atomic<int>> times(tasks), in_work(pool.size());
            pool.run(tasks, [&](std::size_t task, std::size_t worker) {
                ASSERT_LT(task, tasks);
                ASSERT_LT(worker, pool.size());
                EXPECT_EQ(in_work[worker]++, 0) << "worker " << worker << " does two at a time";
                ++times[task];
                --in_work[worker];
            });
            for (std::size_t i = 0; i < tasks; ++i)
                ASSERT_EQ(times[i], 1)
                    << "task " << i << " of " << tasks << ", " << threads << " threads";
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
        for (const std::thread::id id : ids[0])  // it may be too late for each task
            EXPECT_EQ(id, std::this_thread::get_id()) << "the caller is worker 0";
        std::set<std::thread::id> all;
        for (const auto& of_worker : ids) {
            EXPECT_LE(of_worker.size(), 1u) << "a worker is one thread";
            for (const std::thread::id id : of_worker)
                EXPECT_TRUE(all.insert(id).second) << "a thread is one worker";
        }
    }
}

TEST(Threading, HardCase_AllThreadsTakePart) {
    look_up("The pool");
    // Each task waits until all have begun: whoever takes no part keeps the others waiting for
    // ten seconds.
    for (const int threads : thread_counts) {
        ThreadPool pool(threads);
        std::atomic<int> begun = 0;
        std::vector<std::atomic<int>> tasks_of(pool.size());
        pool.run(pool.size(), [&](std::size_t, std::size_t worker) {
            ++begun;
            ++tasks_of[worker];
            const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
            while (begun < threads && std::chrono::steady_clock::now() < end)
                std::this_thread::yield();
            EXPECT_EQ(begun, threads);
        });
        for (std::size_t worker = 0; worker < pool.size(); ++worker)
            EXPECT_EQ(tasks_of[worker], 1) << "worker " << worker << " of " << threads;
    }
}

TEST(Threading, HardCase_TenMillionShortTasks) {
    look_up("The pool");
    // Whoever takes a task in two steps takes some that another one takes, too.
    struct alignas(cache_line) Sum {
        std::size_t tasks = 0, numbers = 0;
    };
    constexpr std::size_t tasks = 10000000;
    for (const int threads : {2, 4}) {
        ThreadPool pool(threads);
        std::vector<Sum> sums(pool.size());
        pool.run(tasks, [&](std::size_t task, std::size_t worker) {
            ++sums[worker].tasks;
            sums[worker].numbers += task;
        });
        Sum all;
        for (const Sum& sum : sums) all.tasks += sum.tasks, all.numbers += sum.numbers;
        EXPECT_EQ(all.tasks, tasks) << threads << " threads";
        EXPECT_EQ(all.numbers, tasks * (tasks - 1) / 2) << threads << " threads";
    }
}

TEST(Threading, HardCase_JobsSeeWhatTheOnesBeforeWrote) {
    look_up("The pool");
    // Plain numbers, written by any thread: each job adds to what the last one left.
    for (const int threads : thread_counts) {
        ThreadPool pool(threads);
        std::vector<long> numbers(97, 0);
        constexpr int jobs = 300;
        for (int job = 0; job < jobs; ++job) {
            numbers[static_cast<std::size_t>(job) % numbers.size()] += 1000;
            pool.run(numbers.size(), [&](std::size_t task, std::size_t) { ++numbers[task]; });
        }
        long sum = 0;
        for (const long number : numbers) sum += number;
        EXPECT_EQ(sum, jobs * (1000 + 97)) << threads << " threads";
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
                ADD_FAILURE() << "nothing arrived";
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

TEST(Threading, HardCase_WhenAllTasksThrowTheFirstArrives) {
    look_up("The pool");
    for (const int threads : thread_counts) {
        ThreadPool pool(threads);
        for (int job = 0; job < 20; ++job) {
            std::atomic<int> begun = 0;
            EXPECT_THROW(pool.run(1000,
                                  [&](std::size_t task, std::size_t) {
                                      ++begun;
                                      throw Trouble(task, {});
                                  }),
                         Trouble);
            EXPECT_LE(begun, threads) << "who has thrown begins no other";
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
                while (begun < 2) std::this_thread::yield();
                if (task == first) {
                    is_thrown = true;
                    throw Trouble(task, {});
                }
                while (!is_thrown) std::this_thread::yield();
                // Enough for the other one to have its error kept, if it is not held up for long.
                std::this_thread::sleep_for(std::chrono::milliseconds(200));
                throw Trouble(task, {});
            });
            ADD_FAILURE() << "nothing arrived";
        } catch (const Trouble& trouble) { EXPECT_EQ(trouble.task, first); }
    }
}

TEST(Threading, HardCase_AfterATaskHasThrownNoOtherIsBegun) {
    look_up("The pool");
    for (const int threads : {2, 4, 16}) {
        ThreadPool pool(threads);
        std::atomic<bool> is_thrown = false;
        std::atomic<int> begun = 0;
        EXPECT_THROW(pool.run(100000,
                              [&](std::size_t task, std::size_t) {
                                  ++begun;
                                  if (task == 0) {
                                      is_thrown = true;
                                      throw Trouble(task, {});
                                  }
                                  while (!is_thrown) std::this_thread::yield();
                                  std::this_thread::sleep_for(std::chrono::milliseconds(1));
                              }),
                     Trouble);
        EXPECT_LT(begun, 100000) << threads << " threads";
    }
}

TEST(Threading, HardCase_CountersOfTwoWorkersAreFarApart) {
    look_up("Why no locks?");
    WorkerCounters<Counters> counters(3);
    for (std::size_t worker = 0; worker < 3; ++worker)
        for (std::size_t i = 0; i <= worker; ++i) counters[worker].add(Counter::fragments_lit);
    const auto at = [&](std::size_t worker) {
        return reinterpret_cast<std::uintptr_t>(&counters[worker]);
    };
    EXPECT_GE(at(1) - at(0), sizeof(Counters));
    EXPECT_EQ(at(0) % cache_line, 0u) << "none begins where another ends";
    EXPECT_EQ(at(1) % cache_line, 0u);
    Counters sum;
    sum.add(Counter::fragments_lit);
    counters.add_to(sum);
    EXPECT_EQ(sum.values[static_cast<std::size_t>(Counter::fragments_lit)], 7u);
}

TEST(Threading, Eq10_3_EvenRowsLeaveTheRestToTheLast) {
    // The worked example: 1080 rows, 7 workers.
    const Tiling tiling(Split::rows, {1920, 1080}, 7, 64);
    ASSERT_EQ(tiling.count(), 7u);
    for (std::size_t i = 0; i < 7; ++i) {
        EXPECT_EQ(tiling[i].box.first, ivec2(0, 154 * i));
        EXPECT_EQ(tiling[i].box.last, ivec2(1919, i < 6 ? 154 * i + 153 : 1079));
        EXPECT_EQ(tiling[i].row_step, 1);
    }
    // The largest rest: 61 workers, 121 rows; one row for each, and 61 for the last.
    const Tiling uneven(Split::rows, {10, 121}, 61, 64);
    EXPECT_EQ(uneven[59].box.last.y, 59);
    EXPECT_EQ(uneven[60].box.first.y, 60);
    EXPECT_EQ(uneven[60].box.last.y, 120);
}

TEST(Threading, Eq10_4_InterleavedRowsGoRound) {
    const Tiling tiling(Split::interleaved, {5, 10}, 4, 64);
    ASSERT_EQ(tiling.count(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        std::vector<int> rows;
        for_each_strip(tiling[i], [&](const PixelBox& strip) {
            EXPECT_EQ(strip.first.x, 0);
            EXPECT_EQ(strip.last, ivec2(4, strip.first.y));
            rows.push_back(strip.first.y);
        });
        const int first = static_cast<int>(i);
        EXPECT_EQ(rows, i < 2 ? (std::vector{first, first + 4, first + 8})
                              : (std::vector{first, first + 4}));
    }
}

TEST(Threading, Eq10_5_TilesOfTheWorkedExample) {
    const Tiling tiling(Split::tiles, {1920, 1080}, 7, 64);
    EXPECT_EQ(tiling.count(), 30u * 17u);
    EXPECT_EQ(tiling[31].box.first, ivec2(64, 64));
    EXPECT_EQ(tiling[31].box.last, ivec2(127, 127));
    EXPECT_EQ(tiling[509].box.first, ivec2(1856, 1024));
    EXPECT_EQ(tiling[509].box.last, ivec2(1919, 1079)) << "the last row of tiles is 56 pixels high";
}

TEST(Threading, HardCase_EachPixelIsInOneTile) {
    look_up("Eq. 10.5");
    for (const ivec2 size : {ivec2(1, 1), {1, 9}, {9, 1}, {64, 64}, {65, 63}, {33, 130}, {3, 60}})
        for (const int workers : thread_counts)
            for (const Split split : splits)
                for (const int side : {1, 2, 8, 63, 64, 1000}) {
                    const Tiling tiling(split, size, static_cast<std::size_t>(workers), side);
                    const Image<int> hits = hits_of(tiling);
                    ASSERT_TRUE(std::ranges::all_of(hits.pixels(), [](int n) { return n == 1; }))
                        << size.x << "x" << size.y << ", split " << int(split) << ", " << workers
                        << " workers, tile side " << side;
                    for (std::size_t i = 0; i < tiling.count(); ++i)
                        for_each_strip(tiling[i], [&](const PixelBox& strip) {
                            ASSERT_EQ(tile_of(strip.first, split, size, workers, side), i);
                            ASSERT_EQ(tile_of(strip.last, split, size, workers, side), i);
                        });
                }
}

TEST(Threading, HardCase_MoreWorkersThanRowsOrTiles) {
    look_up("Eq. 10.3");
    for (const Split split : {Split::rows, Split::interleaved}) {
        EXPECT_EQ(Tiling(split, {100, 3}, 61, 64).count(), 3u);
        EXPECT_EQ(Tiling(split, {100, 1}, 61, 64).count(), 1u);
    }
    EXPECT_EQ(Tiling(Split::tiles, {100, 3}, 61, 64).count(), 2u);
    for (const Split split : splits)
        for (const ivec2 size : {ivec2(0), ivec2(0, 5), ivec2(5, 0)}) {
            const Tiling none(split, size, 4, 64);
            EXPECT_EQ(none.count(), 0u) << "no pixels, no tiles";
            none.for_each_in({{0, 0}, {5, 5}}, [](std::size_t) { ADD_FAILURE(); });
        }
}

TEST(Threading, Eq10_6_ATriangleIsListedInJustTheTilesThatItsBoxMeets) {
    // The worked example: a box of pixels from (100, 50) to (130, 70) meets four tiles.
    std::vector<std::size_t> met;
    Tiling(Split::tiles, {1920, 1080}, 4, 64)
        .for_each_in({{100, 50}, {130, 70}}, [&](std::size_t i) { met.push_back(i); });
    EXPECT_EQ(met, (std::vector<std::size_t>{1, 2, 31, 32}));

    std::mt19937 random(1);
    const ivec2 size(70, 50);
    for (int k = 0; k < 2000; ++k) {
        const ScreenTriangle triangle = any_triangle(random, size);
        const PixelBox box = box_around(triangle);
        fill_triangle(triangle, size, [&](ivec2 pixel, vec3) {
            ASSERT_TRUE(glm::all(glm::greaterThanEqual(pixel, box.first)) &&
                        glm::all(glm::lessThanEqual(pixel, box.last)))
                << "seed 1, triangle " << k;
        });
        const Split split = splits[random() % 3];
        const int workers = thread_counts[random() % thread_counts.size()];
        const int side = 1 + static_cast<int>(random() % 40);
        std::set<std::size_t> expected;
        for (int y = std::max(box.first.y, 0); y <= std::min(box.last.y, size.y - 1); ++y)
            for (int x = std::max(box.first.x, 0); x <= std::min(box.last.x, size.x - 1); ++x)
                expected.insert(tile_of({x, y}, split, size, workers, side));
        std::set<std::size_t> actual;
        Tiling(split, size, static_cast<std::size_t>(workers), side)
            .for_each_in(box, [&](std::size_t tile) {
                ASSERT_TRUE(actual.insert(tile).second) << "seed 1, triangle " << k << ": twice";
            });
        ASSERT_EQ(actual, expected) << "seed 1, triangle " << k << ", split " << int(split);
    }
}

TEST(Threading, Eq10_7_TilesTogetherAreTheWholeTriangleBitForBit) {
    std::mt19937 random(2);
    const ivec2 size(150, 90);
    long pixels = 0;
    for (int k = 0; k < 3000; ++k) {
        const ScreenTriangle triangle = any_triangle(random, size);
        std::map<std::tuple<int, int>, vec3> whole;
        fill_triangle(triangle, size, [&](ivec2 pixel, vec3 barycentrics) {
            whole[{pixel.y, pixel.x}] = barycentrics;
        });
        const Split split = splits[static_cast<std::size_t>(k) % 3];
        const int workers = thread_counts[random() % thread_counts.size()];
        const int side = 1 + static_cast<int>(random() % 80);
        const Tiling tiling(split, size, static_cast<std::size_t>(workers), side);
        for (std::size_t i = 0; i < tiling.count(); ++i)
            fill_tile(triangle, tiling[i], [&](ivec2 pixel, vec3 barycentrics) {
                ASSERT_EQ(tile_of(pixel, split, size, workers, side), i) << "seed 2, " << k;
                const auto found = whole.find({pixel.y, pixel.x});
                ASSERT_TRUE(found != whole.end()) << "seed 2, triangle " << k << ": twice";
                ASSERT_EQ(found->second, barycentrics) << "seed 2, triangle " << k;
                whole.erase(found);
                ++pixels;
            });
        ASSERT_TRUE(whole.empty()) << "seed 2, triangle " << k << ": pixels are missing";
    }
    EXPECT_GT(pixels, 100000);
}

TEST(Threading, Eq10_1_NoScheduleIsShorterThanItsWorkOrItsLongestTask) {
    // The worked example: tasks of 4, 3, 2, 2 and 1.
    const std::array times = {4.0, 3.0, 2.0, 2.0, 1.0};
    EXPECT_EQ(schedule_of(times, 1).least(), 12);
    EXPECT_EQ(schedule_of(times, 2).least(), 6);
    EXPECT_EQ(schedule_of(times, 3).least(), 4);
    EXPECT_EQ(schedule_of(times, 5).least(), 4) << "the longest task";
}

TEST(Threading, Eq10_2_WhatIsLeftToOneWorkerBoundsAll) {
    // The worked examples; in double, so within a few ulp of a rounded sum.
    EXPECT_NEAR(amdahl_speedup(0.1, 2), 1 / 0.55, 1e-15);
    EXPECT_NEAR(amdahl_speedup(0.1, 16), 6.4, 1e-14);
    EXPECT_EQ(amdahl_speedup(0, 16), 16);
    EXPECT_EQ(amdahl_speedup(1, 16), 1);
    EXPECT_LT(amdahl_speedup(0.1, 1000000), 10);
}

TEST(Threading, Eq10_8_EachTaskGoesToWhoeverIsFreeFirst) {
    // The worked example, and the same tasks with the shortest first.
    EXPECT_EQ(schedule_of(std::array{4.0, 3.0, 2.0, 2.0, 1.0}, 2).finish, 6);
    EXPECT_EQ(schedule_of(std::array{1.0, 2.0, 2.0, 3.0, 4.0}, 2).finish, 7);
    EXPECT_EQ(schedule_of({}, 3).finish, 0);

    // Another way to the same: go through time in small steps; who is free takes the next task.
    std::mt19937 random(3);
    for (int k = 0; k < 300; ++k) {
        std::vector<double> times(random() % 40);
        for (double& t : times) t = static_cast<double>(random() % 9);
        const std::size_t workers = 1 + random() % 9;
        std::vector<double> busy_until(workers, 0);
        std::size_t next = 0;
        double finish = 0;
        for (double now = 0; next < times.size(); ++now)
            for (bool took = true; took;) {
                took = false;
                for (double& until : busy_until)
                    if (until <= now && next < times.size()) {
                        until = now + times[next++];
                        finish = std::max(finish, until);
                        took = true;
                    }
            }
        ASSERT_EQ(schedule_of(times, workers).finish, finish) << "seed 3, case " << k;
    }
}

TEST(Threading, Eq10_9_TheBoundHoldsInAnyOrderAndIsMet) {
    std::mt19937 random(4);
    for (int k = 0; k < 3000; ++k) {
        std::vector<double> times(1 + random() % 60);
        for (double& t : times) t = static_cast<double>(random() % 1000) / 8;  // exact sums
        const std::size_t workers = 1 + random() % 20;
        const Schedule schedule = schedule_of(times, workers);
        // 1e-9: a quotient by p and its product are rounded.
        ASSERT_LE(schedule.finish, schedule.most() * (1 + 1e-9)) << "seed 4, case " << k;
        ASSERT_GE(schedule.finish * (1 + 1e-9), schedule.least()) << "seed 4, case " << k;
    }
    // The worked example: 12 tasks of 1, and one of 4 that comes last.
    std::vector<double> worst(12, 1);
    worst.push_back(4);
    const Schedule met = schedule_of(worst, 4);
    EXPECT_EQ(met.finish, 7);
    EXPECT_EQ(met.most(), 7) << "no less would hold";
}

TEST(Threading, Eq10_10_IdleShares) {
    // The worked examples.
    EXPECT_EQ(schedule_of(std::array{4.0, 3.0, 2.0, 2.0, 1.0}, 2).idle_share(), 0);
    EXPECT_NEAR(schedule_of(std::array{1.0, 2.0, 2.0, 3.0, 4.0}, 2).idle_share(), 1.0 / 7, 1e-15);
    EXPECT_EQ(schedule_of(std::array{5.0}, 4).idle_share(), 0.75) << "three have nothing to do";
    EXPECT_EQ(schedule_of({}, 4).idle_share(), 0);
    EXPECT_EQ(schedule_of(std::array{0.0, 0.0}, 4).idle_share(), 0);
}
