// SPDX-License-Identifier: MIT
#include "support/look_up.hpp"

#include <filesystem>
#include <iostream>

#include <gtest/gtest.h>

namespace rasterbook::test {

namespace {

std::string place_of_this_test;

/// "Eq. 2.4" for a test named "Eq2_4_BarycentricsOfTheWorkedExample", else nothing.
std::string equation_in(const std::string& name) {
    if (name.rfind("Eq", 0) != 0) return "";
    const auto end = name.find('_', name.find('_') + 1);
    std::string number = name.substr(2, end - 2);
    number[number.find('_')] = '.';
    return "Eq. " + number;
}

/// "04_mvp" for 04_mvp_clip_test.cpp: the lesson whose name begins the file's.
std::string lesson_of(const std::filesystem::path& file) {
    const std::string stem = file.stem().string();
    const auto lessons = std::filesystem::path(RASTERBOOK_ASSETS).parent_path() / "lessons";
    for (const auto& lesson : std::filesystem::directory_iterator(lessons))
        if (const std::string name = lesson.path().filename().string();
            stem.starts_with(name + '_'))
            return name;
    return stem;
}

class PlacePrinter : public testing::EmptyTestEventListener {
    void OnTestStart(const testing::TestInfo& test) override {
        place_of_this_test = equation_in(test.name());
    }
    void OnTestEnd(const testing::TestInfo& test) override {
        if (test.result()->Passed() || place_of_this_test.empty()) return;
        std::cout << "To read: docs/derivations/" << lesson_of(test.file()) << ".md, "
                  << place_of_this_test << '\n';
    }
};

const bool listens = [] {
    testing::UnitTest::GetInstance()->listeners().Append(new PlacePrinter);
    return true;
}();

}  // namespace

void look_up(const std::string& place) { place_of_this_test = place; }

}  // namespace rasterbook::test
