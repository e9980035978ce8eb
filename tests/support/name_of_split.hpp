// SPDX-License-Identifier: MIT
/// @file
/// The ways to split a picture and numbers of threads that tests go through, and what failing tests
/// call them.
#pragma once

#include <array>

#include "10_threading/split.hpp"

namespace rasterbook::test {

inline constexpr std::array thread_counts = {1, 2, 3, 4, 7, 8, 16, 61};
inline constexpr std::array splits = {Split::rows, Split::interleaved, Split::tiles};

inline const char* name_of(Split split) {
    return split == Split::rows          ? "even rows"
           : split == Split::interleaved ? "interleaved rows"
                                         : "tiles";
}

}  // namespace rasterbook::test
