// SPDX-License-Identifier: MIT
/// @file
/// The resolution of depth maps and how they are tested: `--shadow-size`, `--bias` and `--pcf`;
/// measured in docs/accuracy/09_shadow_maps.md.
#pragma once

#include "09_shadow_maps/shadow_map.hpp"
#include "common/app/lesson_app.hpp"

namespace rasterbook {

struct ShadowOptions {
    int size = 2048;  ///< Texels a side.
    Bias bias = Bias::slope;
    int pcf = 3;  ///< A shadow test has pcf * pcf taps: 1, 3, 5 or 7.

    int radius() const { return pcf / 2; }

    void declare(OptionParser& parser) {
        parser.number("--shadow-size", size, 16, 8192, "Texels along each side of a depth map");
        parser.choice("--bias", bias,
                      {{"none", Bias::none},
                       {"constant", Bias::constant},
                       {"slope", Bias::slope},
                       {"plane", Bias::plane},
                       {"normal", Bias::normal}},
                      "What keeps lit surfaces from shadowing themselves");
        parser.choice(
            "--pcf", pcf, {{"1", 1}, {"3", 3}, {"5", 5}, {"7", 7}},
            "Taps along each side of a shadow test's square: a shadow's edge is their mean");
    }
};

}  // namespace rasterbook
