// SPDX-License-Identifier: MIT
/// @file
/// What failing tests call biases, beside lights (support/light_in_words.hpp).
#pragma once

#include "09_shadow_maps/shadow_map.hpp"
#include "support/light_in_words.hpp"

namespace rasterbook::test {

inline const char* name_of(Bias bias) {
    switch (bias) {
        case Bias::none:
            return "no bias";
        case Bias::constant:
            return "constant bias";
        case Bias::slope:
            return "slope-scaled bias";
        case Bias::plane:
            return "bias by the receiver's plane";
        default:
            return "offset along the normal";
    }
}

}  // namespace rasterbook::test
