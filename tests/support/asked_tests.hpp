// SPDX-License-Identifier: MIT
/// @file
/// GoogleTest's TEST where only some of a file's tests are compiled: those whose name is_asked().
/// The others stay templates that nobody instantiates.
#pragma once

#include <gtest/gtest.h>

namespace rasterbook::test {

template <bool is_asked, template <bool> class Test>
bool added(const char* suite, const char* name, const char* file, int line) {
    if constexpr (is_asked)
        testing::RegisterTest(suite, name, nullptr, nullptr, file, line,
                              []() -> testing::Test* { return new Test<true>; });
    return is_asked;
}

}  // namespace rasterbook::test

#undef TEST
#define TEST(suite, name)                                                                        \
    template <bool>                                                                              \
    class suite##_##name##_Test : public testing::Test {                                         \
        void TestBody() override;                                                                \
    };                                                                                           \
    [[maybe_unused]] const bool suite##_##name##_is_there =                                      \
        rasterbook::test::added<IS_ASKED(#name), suite##_##name##_Test>(#suite, #name, __FILE__, \
                                                                        __LINE__);               \
    template <bool is_compiled>                                                                  \
    void suite##_##name##_Test<is_compiled>::TestBody()
