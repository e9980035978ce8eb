// SPDX-License-Identifier: MIT
/// @file
/// Hard cases alone, or all but them, as HARD_CASES says: a reader's program of tests is two, so
/// that the first answer comes sooner.
#pragma once

#include <string>
#include <string_view>

#include "support/look_up.hpp"

namespace rasterbook::test {

constexpr bool is_hard_case(std::string_view name) {
    return name.find("HardCase") != std::string_view::npos;
}

/// Links what prints failures, also if no test that is compiled calls it.
[[gnu::used]] inline void (*const links_printer)(const std::string&) = look_up;

}  // namespace rasterbook::test

// The name is pasted: g++ does not use a precompiled header that knows a macro of the command line.
#define PASTED(first, second) first##second
#define IS_ASKED(name) (rasterbook::test::is_hard_case(name) == PASTED(HARD_, CASES))
#include "support/asked_tests.hpp"
