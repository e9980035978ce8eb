// SPDX-License-Identifier: MIT
#include "support/look_up.hpp"

#include <filesystem>
#include <iostream>

#include <gtest/gtest.h>

namespace rasterbook::test {

namespace {

std::string place_of_this_test;

/// "Eq. 2.4" for a test named "Eq2_4_WeightsOfTheWorkedExample", else nothing.
std::string equation_in(const std::string& name) {
    if (name.rfind("Eq", 0) != 0) return "";
    const auto end = name.find('_', name.find('_') + 1);
    std::string number = name.substr(2, end - 2);
    number[number.find('_')] = '.';
    return "Eq. " + number;
}

class PlacePrinter : public testing::EmptyTestEventListener {
    void OnTestStart(const testing::TestInfo& test) override {
        place_of_this_test = equation_in(test.name());
    }
    void OnTestEnd(const testing::TestInfo& test) override {
        if (test.result()->Passed() || place_of_this_test.empty()) return;
        std::string lesson = std::filesystem::path(test.file()).stem().string();
        lesson.erase(lesson.rfind("_test"));
        std::cout << "To read: docs/derivations/" << lesson << ".md, " << place_of_this_test
                  << '\n';
    }
};

const bool listens = [] {
    testing::UnitTest::GetInstance()->listeners().Append(new PlacePrinter);
    return true;
}();

}  // namespace

void look_up(const std::string& place) { place_of_this_test = place; }

}  // namespace rasterbook::test
