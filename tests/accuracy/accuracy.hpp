// SPDX-License-Identifier: MIT
/// @file
/// Measures the variants of a lesson's stage against each other: error and time side by side.
///
/// `./tests/run --accuracy` runs the programs made with this and puts what they measure into
/// docs/accuracy/.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>

namespace rasterbook::test {

/// By name, such as "greatest distance, px"; each becomes a user counter of the benchmark.
using Errors = std::map<std::string, double>;

/// The greatest of some errors, and the root of the mean of their squares.
class ErrorSum {
  public:
    void add(long double error) {
        greatest_ = std::max(greatest_, std::abs(error));
        squares_ += error * error;
        ++count_;
    }
    double greatest() const { return static_cast<double>(greatest_); }
    double rms() const { return static_cast<double>(std::sqrt(squares_ / count_)); }

  private:
    long double greatest_ = 0, squares_ = 0, count_ = 0;
};

/// Adds a variant to be measured.
///
/// @param comparison  The variants of one comparison solve the same task.
/// @param variant     What to call it in table and plot.
/// @param units       How many units of work `work` does: pixels, fragments, ...
/// @param errors      Found beforehand, against a reference that shares no code with the variant.
/// @param work        Timed, many times over.
void add_variant(const std::string& comparison, const std::string& variant, double units,
                 Errors errors, std::function<void()> work);

/// Measures all variants. The main function of a benchmark, with Google Benchmark's command line;
/// progress goes to stderr.
int measure_variants(int argc, char** argv);

}  // namespace rasterbook::test
