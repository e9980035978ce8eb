// SPDX-License-Identifier: MIT
/// @file
/// The biases that tests go through, and what failing tests call them, beside lights
/// (support/light_in_words.hpp).
#pragma once

#include <array>

#include "09_shadow_maps/shadow_map.hpp"
#include "support/light_in_words.hpp"

namespace rasterbook::test {

inline constexpr std::array all_biases = {Bias::none, Bias::constant, Bias::slope, Bias::plane,
                                          Bias::normal};

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
