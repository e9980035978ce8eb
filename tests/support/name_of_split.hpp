// SPDX-License-Identifier: MIT
/// @file
/// What failing tests call the ways to split a picture.
#pragma once

#include "10_threading/split.hpp"

namespace rasterbook::test {

inline const char* name_of(Split split) {
    return split == Split::rows          ? "even rows"
           : split == Split::interleaved ? "interleaved rows"
                                         : "tiles";
}

}  // namespace rasterbook::test
