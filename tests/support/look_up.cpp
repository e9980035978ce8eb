// SPDX-License-Identifier: MIT
#include "support/look_up.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "support/failure_words.hpp"

namespace rasterbook::test {

namespace {

std::string place_of_this_test;

const std::filesystem::path root = std::filesystem::path(RASTERBOOK_ASSETS).parent_path();

/// "04_mvp" for 04_mvp_clip_test.cpp: the lesson whose name begins the file's.
std::string lesson_of(const std::filesystem::path& file) {
    const std::string stem = file.stem().string();
    for (const auto& lesson : std::filesystem::directory_iterator(root / "lessons"))
        if (const std::string name = lesson.path().filename().string();
            stem.starts_with(name + '_'))
            return name;
    return stem;
}

/// The name of the test, where to read, and the first failure.
class FailurePrinter : public testing::EmptyTestEventListener {
  public:
    /// @param report  A folder: takes a file for each test that fails, named so that equations come
    ///                in their order; `passed` with the names of those that pass; and `running`,
    ///                the one that is under way, if a crash ends it. Without, failures are printed.
    explicit FailurePrinter(const char* report) : report_(report ? report : "") {}

  private:
    void OnTestStart(const testing::TestInfo& test) override {
        place_of_this_test = equation_in(test.name());
        test_ = &test;
        failures_ = 0;
        text_.str("");
        if (!report_.empty()) std::ofstream(report_ / "running") << test.name() << '\n';
    }

    void OnTestPartResult(const testing::TestPartResult& result) override {
        if (result.skipped()) std::cout << result.message() << '\n';
        if (!result.failed() || ++failures_ > 1) return;
        const std::filesystem::path file = result.file_name() ? result.file_name() : "";
        if (test_ != nullptr) {
            text_ << "FAILED " << test_->test_suite_name() << '.' << test_->name() << '\n';
            if (!place_of_this_test.empty())
                text_ << "To read: docs/derivations/" << lesson_of(test_->file()) << ".md, "
                      << place_of_this_test << '\n';
        }
        text_ << file.lexically_relative(root).string() << ':' << result.line_number() << ": "
              << first_lines(result.message()) << '\n';
    }

    void OnTestEnd(const testing::TestInfo& test) override {
        text_ << further_failures(failures_);
        if (report_.empty()) {
            std::cout << text_.str() << std::flush;
            return;
        }
        std::filesystem::remove(report_ / "running");
        if (failures_ == 0)
            std::ofstream(report_ / "passed", std::ios::app) << test.name() << '\n';
        else
            std::ofstream(report_ / (place_of_this_test + "~" + test.name())) << text_.str();
    }

    void OnTestProgramEnd(const testing::UnitTest& all) override {
        if (report_.empty())
            std::cout << all.successful_test_count() << " of " << all.test_to_run_count()
                      << " tests passed\n";
    }

    std::filesystem::path report_;
    const testing::TestInfo* test_ = nullptr;  ///< That runs.
    int failures_ = 0;
    std::ostringstream text_;
};

const bool listens = [] {
    testing::TestEventListeners& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new FailurePrinter(std::getenv("RASTERBOOK_REPORT")));
    return true;
}();

}  // namespace

void look_up(const std::string& place) { place_of_this_test = place; }

}  // namespace rasterbook::test
