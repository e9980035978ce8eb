// SPDX-License-Identifier: MIT
/// @file
/// What failing tests call lights and biases.
#pragma once

#include "06_phong/light.hpp"
#include "09_shadow_maps/shadow_map.hpp"

namespace rasterbook::test {

inline const char* name_of(LightKind kind) {
    return kind == LightKind::directional ? "directional light"
           : kind == LightKind::point     ? "point light"
                                          : "spotlight";
}

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
