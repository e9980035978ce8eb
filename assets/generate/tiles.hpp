// SPDX-License-Identifier: MIT
/// @file
/// A floor of cream octagons with small dark squares between: 4 by 4 in a texture.
#pragma once

#include <cmath>

#include "assets/generate/texture.hpp"

namespace rasterbook::assets {

constexpr double tile_relief = 0.012;  ///< Of the grout, in sides of the texture.

/// Which tile a point is on, and how far outside of it.
struct TilePlace {
    ivec2 index;
    dvec2 from_middle;  ///< In texels.
    double edge;        ///< Negative inside, in texels.
    bool is_square;     ///< One of the small dark ones.
};

inline TilePlace tile_place(dvec2 p) {
    const double pitch = 128, root_half = 0.70710678;
    const double gap = 2.6, square_side = 23;  // half the grout, half the small square
    const dvec2 cell(std::floor(p.x / pitch), std::floor(p.y / pitch));
    const dvec2 corner(std::floor(p.x / pitch + 0.5), std::floor(p.y / pitch + 0.5));
    const dvec2 from_middle = p - (cell + 0.5) * pitch;
    const dvec2 from_corner = p - corner * pitch;

    // The squares stand on their corners: turned by 45 degrees.
    const dvec2 turned =
        root_half * dvec2(from_corner.x + from_corner.y, from_corner.x - from_corner.y);
    const double to_square = distance_to_box(turned, dvec2(square_side), 2);
    const double to_side = distance_to_box(from_middle, dvec2(pitch / 2 - gap), 3);
    const double to_cut = square_side + 2 * gap - glm::max(glm::abs(turned.x), glm::abs(turned.y));
    const double to_octagon = glm::max(to_side, to_cut);
    if (to_square < to_octagon)
        return {{wrap(int(corner.x), 4), wrap(int(corner.y), 4)}, from_corner, to_square, true};
    return {ivec2(cell), from_middle, to_octagon, false};
}

inline dvec3 tile_color(const TilePlace& place, dvec2 uv) {
    const double tint = random(place.index.x, place.index.y, place.is_square ? 101 : 102);
    const double clouds = layered_noise(uv, ivec2(8), 5, 111);
    const double speck = smooth_step(0.40, 0.60, noise(uv * 128.0, ivec2(128), 131));
    // Thin veins where a warped noise crosses zero, fading in and out.
    const dvec2 warp(layered_noise(uv, ivec2(6), 3, 141), layered_noise(uv, ivec2(6), 3, 151));
    const double crossing = noise(uv * 5.0 + 0.5 * warp, ivec2(5), 161);
    const double fade = smooth_step(-0.25, 0.35, noise(uv * 6.0, ivec2(6), 165));
    const double vein = fade * smooth_step(0.026, 0.0, glm::abs(crossing));
    if (place.is_square)
        return glm::mix(rgb(0x4A5054), rgb(0x5B5F60), tint) * (1 + 0.14 * clouds + 0.10 * vein);
    const dvec3 cream = glm::mix(rgb(0xDACFBB), rgb(0xE7DECD), tint);
    return cream * (1 + 0.05 * clouds - 0.06 * vein - 0.05 * speck);
}

inline Texel tile_texel(dvec2 p) {
    const dvec2 uv = p / double(texture_side);
    const TilePlace place = tile_place(p);
    const double grit = layered_noise(uv, ivec2(64), 3, 171);
    const double waves = layered_noise(uv, ivec2(6), 2, 181);
    const double inside = smooth_step(0.8, -0.8, place.edge);
    const double rounding = smooth_step(1.0, -5.0, place.edge);

    const dvec3 grout = rgb(0x8C8273) * (1 + 0.16 * grit);
    const dvec3 glaze = tile_color(place, uv) * (0.90 + 0.10 * rounding);
    // No tile lies quite level: in raking light each shines a little differently.
    const dvec2 slope = dvec2(random(place.index.x, place.index.y, 191),
                              random(place.index.x, place.index.y, 192)) -
                        0.5;
    const double tilt = (slope.x * place.from_middle.x + slope.y * place.from_middle.y) / 170;
    const double tile_height = 0.34 + 0.32 * rounding + tilt + 0.03 * waves;
    return {glm::mix(grout, glaze, inside), glm::mix(0.04, 0.55 + 0.12 * waves, inside),
            glm::mix(0.22 + 0.05 * grit, tile_height, inside)};
}

}  // namespace rasterbook::assets
