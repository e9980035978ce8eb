// SPDX-License-Identifier: MIT
/// @file
/// How many random cases a test runs.
#pragma once

#include <algorithm>

namespace rasterbook::test {

/// Of n random cases, those that run: in a page, where tests are not optimised, one in fifty, but
/// at least three, so that of three kinds by turns each is there.
constexpr int cases_of(int n) {
#ifdef RASTERBOOK_IN_A_PAGE
    return std::max(n / 50, 3);
#else
    return n;
#endif
}

}  // namespace rasterbook::test
