// SPDX-License-Identifier: MIT
/// @file
/// For tests that include a lesson's main.cpp.
#pragma once

namespace rasterbook::test {

/// Takes the place of rasterbook::run_lesson(): nobody calls it, and no picture is compiled for it.
template <typename Options, typename... Arguments>
int run_lesson(Arguments&&...) {
    return 0;
}

template <typename Options, typename... Arguments>
int run_effects_lesson(Arguments&&...) {
    return 0;
}

}  // namespace rasterbook::test
