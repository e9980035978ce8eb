// SPDX-License-Identifier: MIT
/// @file
/// How many random cases a test runs.
#pragma once

namespace rasterbook::test {

/// Of n random cases, those that run: in a page, where tests are not optimised, one in fifty.
constexpr int cases_of(int n) {
#ifdef RASTERBOOK_IN_A_PAGE
    return n / 50;
#else
    return n;
#endif
}

}  // namespace rasterbook::test
