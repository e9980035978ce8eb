// SPDX-License-Identifier: MIT
// Lesson 10's program with a pool that shares out the work in the same way each time: for the
// golden pictures of which thread drew what.
#include "support/lesson_10.hpp"
#include "support/pretend_pool.hpp"

namespace {

/// Four workers: tiles go to any of them, strips to each in turn.
class FixedPool : public rasterbook::Workers {
  public:
    explicit FixedPool(bool in_turn) : in_turn_(in_turn) {}

    std::size_t size() const override { return 4; }
    void run_tasks(std::size_t tasks, const Task& task) override {
        if (in_turn_)
            for (std::size_t i = 0; i < tasks; ++i) task(i, i % size());
        else
            shuffled_.run_tasks(tasks, task);
    }

  private:
    bool in_turn_;
    rasterbook::test::ShuffledPool shuffled_{4, 1};
};

}  // namespace

int main(int argc, char** argv) {
    return rasterbook::run_lesson<lesson_10::Options>(
        argc, argv, "who_drew_what", "Lesson 10, the same each time.", lesson_10::make_assets,
        [](const auto& options, const auto& assets) {
            FixedPool pool{options.threads.split != rasterbook::Split::tiles};
            return lesson_10::render(options, assets, pool);
        });
}
