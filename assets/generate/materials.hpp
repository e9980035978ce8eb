// SPDX-License-Identifier: MIT
/// @file
/// The material libraries. Colours are linear; maps of colours are sRGB, all other maps linear.
///
/// A material asks for no more than it needs: what has no map_Ks shines evenly, what has no norm is
/// smooth. Ka repeats Kd: ambient light meets the same surface.
#pragma once

#include <string>

#include "assets/generate/brick.hpp"
#include "assets/generate/model.hpp"

namespace rasterbook::assets {

inline const std::string porcelain = R"(
newmtl glaze
Ka 0.03 0.25 0.3
Kd 0.03 0.25 0.3
Ks 0.45 0.45 0.45
Ns 90
illum 2

newmtl gilt
Ka 0.72 0.4 0.1
Kd 0.72 0.4 0.1
Ks 0.8 0.6 0.3
Ns 60
illum 2
)";

inline const std::string tea_in_spout = R"(
newmtl tea
Ka 0.12 0.035 0.008
Kd 0.12 0.035 0.008
Ks 0.4 0.4 0.4
Ns 200
illum 2
)";

inline const std::string hammered_copper = R"(
newmtl copper
Ka 0.6 0.6 0.6
Kd 0.6 0.6 0.6
Ks 1 0.7 0.5
Ns 40
illum 2
map_Kd ../textures/hammered.png
map_Ks ../textures/hammered_specular.png
norm ../textures/hammered_normal.png
)";

inline const std::string embossed_bronze = R"(
newmtl bronze
Ka 0.5 0.3 0.12
Kd 0.5 0.3 0.12
Ks 0.8 0.6 0.35
Ns 25
illum 2
norm ../textures/shield_normal.png
)";

inline const std::string wooden_crate = R"(
newmtl crate
Ka 0.9 0.62 0.38
Kd 0.9 0.62 0.38
illum 1
map_Kd ../textures/wood.png
)";

inline const std::string brick_crate = R"(
newmtl brick
Ka 1 1 1
Kd 1 1 1
Ks 1 1 1
Ns 12
illum 2
map_Kd ../textures/brick.png
map_Ks ../textures/brick_specular.png
norm ../textures/brick_normal.png
)";

inline const std::string brick_crate_with_heights = R"(
# -bm: how far height 1 lies above height 0, in sides of the texture.
newmtl brick
Ka 1 1 1
Kd 1 1 1
Ks 1 1 1
Ns 12
illum 2
map_Kd ../textures/brick.png
map_Ks ../textures/brick_specular.png
map_Bump -bm )" + text_of(brick_relief) + " ../textures/brick_height.png\n";

/// Tiles for the light and the dark squares of a floor, which differ in their colour alone.
inline std::string light_and_dark_tiles(const std::string& all_but_colour) {
    const auto material = [&](const std::string& name, const std::string& colour) {
        return "\nnewmtl " + name + "\nKa " + colour + "\nKd " + colour + "\n" + all_but_colour;
    };
    return material("tiles", "0.58 0.55 0.5") + material("dark_tiles", "0.1 0.15 0.22");
}

inline const std::string smooth_tiles = light_and_dark_tiles(R"(Ks 0.2 0.2 0.2
Ns 60
illum 2
map_Kd ../textures/tiles.png
)");

inline const std::string bumpy_tiles = light_and_dark_tiles(R"(Ks 1 1 1
Ns 60
illum 2
map_Kd ../textures/tiles.png
map_Ks ../textures/tiles_specular.png
norm ../textures/tiles_normal.png
)");

inline const std::string checkered_floor = R"(
newmtl checker
Ka 0.8 0.8 0.8
Kd 0.8 0.8 0.8
illum 1
map_Kd ../textures/checker.png
)";

inline const std::string plain_white = R"(
newmtl white
Ka 0.8 0.8 0.8
Kd 0.8 0.8 0.8
illum 1
)";

/// Paints without pictures, for bands of one colour.
inline const std::string figure_paints = R"(
newmtl coat
Ka 0.8 0.13 0.06
Kd 0.8 0.13 0.06
Ks 0.7 0.7 0.7
Ns 40
illum 2

newmtl cream
Ka 0.87 0.72 0.42
Kd 0.87 0.72 0.42
Ks 0.7 0.7 0.7
Ns 40
illum 2

newmtl panel
Ka 0.87 0.72 0.42
Kd 0.87 0.72 0.42
Ks 0.7 0.7 0.7
Ns 40
illum 2

newmtl trim
Ka 0.03 0.36 0.38
Kd 0.03 0.36 0.38
Ks 0.7 0.7 0.7
Ns 30
illum 2

newmtl glass
Ka 0.03 0.04 0.09
Kd 0.03 0.04 0.09
Ks 0.9 0.9 0.9
Ns 60
illum 2

newmtl steel
Ka 0.22 0.25 0.32
Kd 0.22 0.25 0.32
illum 1

newmtl lamp
Ka 0.8 0.42 0.04
Kd 0.8 0.42 0.04
Ks 0.7 0.7 0.7
Ns 40
Ke 0.15 0.08 0.01
illum 2

newmtl eyes
Ka 0.1 0.1 0.1
Kd 0.1 0.1 0.1
Ke 0.55 0.85 0.8
illum 1

newmtl box
Ka 0.75 0.4 0.12
Kd 0.75 0.4 0.12
illum 1

newmtl platform
Ka 0.3 0.5 0.25
Kd 0.3 0.5 0.25
illum 1
)";

}  // namespace rasterbook::assets
