// SPDX-License-Identifier: MIT
/// @file
/// Hard cases alone, or all but them, as HARD_CASES says: a reader's program of tests is two, so
/// that the first answer comes sooner.
#pragma once

#include <string>
#include <string_view>

#include "support/look_up.hpp"

namespace rasterbook::test {

constexpr bool is_asked(std::string_view name) {
    return (name.find("HardCase") != std::string_view::npos) == HARD_CASES;
}

/// Links what prints failures, also if no test that is compiled calls it.
[[gnu::used]] inline void (*const links_printer)(const std::string&) = look_up;

}  // namespace rasterbook::test

#include "support/asked_tests.hpp"
