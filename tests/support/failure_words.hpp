// SPDX-License-Identifier: MIT
/// @file
/// What is said of a failing test: by the test programs, and in a page.
#pragma once

#include <string>

namespace rasterbook::test {

/// "Eq. 2.4" for a test named "Eq2_4_BarycentricsOfTheWorkedExample", else nothing.
inline std::string equation_in(const std::string& name) {
    if (name.rfind("Eq", 0) != 0) return "";
    const auto end = name.find('_', name.find('_') + 1);
    std::string number = name.substr(2, end - 2);
    number[number.find('_')] = '.';
    return "Eq. " + number;
}

/// Of a failing test, so many lines are shown of the first failure: what fails first explains most,
/// and thousands of lines explain nothing.
constexpr int most_failure_lines = 32;

inline std::string first_lines(const std::string& text) {
    std::size_t end = 0;
    for (int line = 0; line < most_failure_lines && end != std::string::npos; ++line)
        end = text.find('\n', end + (line > 0));
    return end == std::string::npos ? text : text.substr(0, end) + "\n...";
}

/// What is said of a test's failures but for the first, which is shown.
///
/// @param failures  All of them.
inline std::string further_failures(int failures) {
    if (failures <= 1) return "";
    return "(further failures in this test: " + std::to_string(failures - 1) + ")\n";
}

}  // namespace rasterbook::test
