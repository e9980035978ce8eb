// SPDX-License-Identifier: MIT
// Lesson 10's program with a pool that shares out the work in the same way each time: for the
// golden pictures of which thread drew what.
#include "support/lesson_10.hpp"
#include "support/pretend_pool.hpp"

namespace {

/// Four workers: tiles go to any of them, strips to each in turn.
struct FixedPool {
    std::size_t size() const { return 4; }

    template <typename Task>
    void run(std::size_t tasks, const Task& task) {
        if (in_turn)
            for (std::size_t i = 0; i < tasks; ++i) task(i, i % size());
        else
            shuffled.run(tasks, task);
    }

    bool in_turn;
    rasterbook::test::ShuffledPool shuffled{4, 1};
};

}  // namespace

int main(int argc, char** argv) {
    return rasterbook::run_lesson<lesson_10::Options>(
        argc, argv, "who_drew_what", "Lesson 10, the same each time.", lesson_10::make_assets,
        [](const auto& options, const auto& assets, auto& counters) {
            FixedPool pool{options.threads.split != rasterbook::Split::tiles};
            return lesson_10::render(options, assets, pool, counters);
        });
}
