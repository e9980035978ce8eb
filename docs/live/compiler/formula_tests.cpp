// SPDX-License-Identifier: MIT
// The tests of formulas in a page: its arguments are the lesson's name and GoogleTest's. Prints,
// after a byte of 1 each, "running", "passed" or "failed" and a test's name, and of a failing test,
// as support/look_up.cpp does, where to read and the first failure.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "common/image/image_io.hpp"
#include "common/model/load_budget.hpp"
#include "common/model/model_file.hpp"
#include "support/failure_words.hpp"
#include "support/look_up.hpp"

namespace rasterbook::test {

namespace {

std::string place_of_this_test;

class Printer : public testing::EmptyTestEventListener {
  public:
    explicit Printer(std::string lesson) : lesson_(std::move(lesson)) {}

  private:
    void OnTestStart(const testing::TestInfo& test) override {
        place_of_this_test = equation_in(test.name());
        failures_ = 0;
        text_.str("");
        std::printf("\1running %s\n", test.name());
        std::fflush(stdout);
    }

    void OnTestPartResult(const testing::TestPartResult& result) override {
        if (!result.failed() || ++failures_ > 1) return;
        const std::string file = result.file_name() ? result.file_name() : "";
        text_ << "To read: docs/derivations/" << lesson_ << ".md, " << place_of_this_test << '\n'
              << file.substr(file.find_first_not_of('/')) << ':' << result.line_number() << ": "
              << first_lines(result.message()) << '\n';
    }

    void OnTestEnd(const testing::TestInfo& test) override {
        text_ << further_failures(failures_);
        if (failures_ == 0)
            std::printf("\1passed %s\n", test.name());
        else
            std::printf("\1failed %s\nFAILED %s.%s\n%s", test.name(), test.test_suite_name(),
                        test.name(), text_.str().c_str());
        std::fflush(stdout);
    }

    std::string lesson_;
    int failures_ = 0;
    std::ostringstream text_;
};

}  // namespace

void look_up(const std::string& place) { place_of_this_test = place; }

}  // namespace rasterbook::test

// There are no files in a page, so no test of a formula reads one.
rasterbook::Scene rasterbook::load_model(const std::filesystem::path&, const LoadBudget&) {
    std::abort();
}
rasterbook::Image<rasterbook::u8vec4> rasterbook::read_image(const std::filesystem::path&,
                                                             std::uint64_t, std::string*) {
    std::abort();
}

// clang's library for 128-bit numbers was compiled with a guard of the stack.
extern "C" unsigned long __stack_chk_guard = 0x2a2a2a2a;
extern "C" [[noreturn]] void __stack_chk_fail() { std::abort(); }

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    testing::TestEventListeners& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new rasterbook::test::Printer(argv[1]));
    return RUN_ALL_TESTS();
}
