// SPDX-License-Identifier: MIT
/// @file
/// GoogleTest's TEST for a page: only tests of the equations that are asked for are compiled. The
/// others stay templates that nobody instantiates.
#pragma once

#include <string_view>

#include <gtest/gtest.h>

namespace rasterbook::test {

/// They take many seconds in a page, or read the course's models.
constexpr std::string_view not_in_a_page[] = {
    "Eq4_13_WhatIsLeftOfTrianglesOfAllSizes", "Eq4_14_RandomBoxesOfAllSizes",
    "Eq7_5_SmoothBordersAreNearerToManySamples", "Eq8_9_HeightMapsAndNormalMapsAgree"};

/// Whether a test's name begins with one of the equations in ASKED_EQUATIONS, as "Eq5_1_ Eq5_4_";
/// with all of them where that is "*".
constexpr bool is_asked(std::string_view name) {
    if (!name.starts_with("Eq") || name.find("HardCase") != std::string_view::npos) return false;
    for (const std::string_view other : not_in_a_page)
        if (name == other) return false;
    constexpr std::string_view asked = ASKED_EQUATIONS;
    const std::size_t end = name.find('_', name.find('_') + 1) + 1;
    return asked == "*" || asked.find(name.substr(0, end)) != std::string_view::npos;
}

template <bool is_asked, template <bool> class Test>
bool added(const char* suite, const char* name, const char* file, int line) {
    if constexpr (is_asked)
        testing::RegisterTest(suite, name, nullptr, nullptr, file, line,
                              []() -> testing::Test* { return new Test<true>; });
    return is_asked;
}

}  // namespace rasterbook::test

#undef TEST
#define TEST(suite, name)                                                                  \
    template <bool>                                                                        \
    class suite##_##name##_Test : public testing::Test {                                   \
        void TestBody() override;                                                          \
    };                                                                                     \
    [[maybe_unused]] const bool suite##_##name##_is_there =                                \
        rasterbook::test::added<rasterbook::test::is_asked(#name), suite##_##name##_Test>( \
            #suite, #name, __FILE__, __LINE__);                                            \
    template <bool is_asked>                                                               \
    void suite##_##name##_Test<is_asked>::TestBody()
