// SPDX-License-Identifier: MIT
/// @file
/// One side of a wooden crate: upright planks, a brace across them, a frame, and bolts.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "assets/generate/texture.hpp"

namespace rasterbook::assets {

/// A board seen from above, in texels. Later boards lie on earlier ones.
struct Board {
    dvec2 middle;
    dvec2 direction;  ///< Of the grain, unit length.
    dvec2 half_size;  ///< Along and across the grain.
    int layer;        ///< Boards of a higher layer throw a soft shadow on lower ones.
    double tint;      ///< 1 is the plain colour.

    /// Along and across the grain, from the middle.
    dvec2 local(dvec2 p) const {
        const dvec2 d = p - middle;
        return {d.x * direction.x + d.y * direction.y, d.y * direction.x - d.x * direction.y};
    }
    double distance(dvec2 p) const { return distance_to_box(local(p), half_size, 2.5); }
};

inline std::vector<Board> crate_boards() {
    std::vector<Board> boards;
    const double side = texture_side, frame = 74, planks = 5;
    const double width = (side - 2 * frame + 24) / planks;
    for (int i = 0; i < int(planks); ++i)
        boards.push_back({{frame - 12 + (i + 0.5) * width, side / 2},
                          {0, 1},
                          {side / 2, width / 2},
                          0,
                          0.74 + 0.12 * random(i, 0, 301)});
    const double root_half = 0.70710678;
    boards.push_back({dvec2(side / 2), {root_half, -root_half}, {side, 33}, 1, 0.95});
    for (const double x : {frame / 2, side - frame / 2})
        boards.push_back({{x, side / 2}, {0, 1}, {side / 2, frame / 2}, 2, 1.0 + 0.0002 * x});
    for (const double y : {frame / 2, side - frame / 2})
        boards.push_back({{side / 2, y}, {1, 0}, {side / 2, frame / 2}, 2, 1.07 - 0.0001 * y});
    return boards;
}

/// Fir, sawn along the trunk: p along and across the grain.
inline dvec3 fir(dvec2 p, std::uint32_t seed) {
    const ivec2 endless(without_end);
    const auto at = [&](double along, double across, std::uint32_t salt) {
        return noise(dvec2(p.x / along, p.y / across) + 500.0, endless, seed * 16 + salt);
    };
    // Growth rings: lines along the grain that bend, and close where a hill stands, at a knot.
    const dvec2 knot((random(int(seed), 0, 321) - 0.5) * 330,
                     (random(int(seed), 1, 321) - 0.5) * 40);
    const dvec2 to_knot((p.x - knot.x) / 2.4, p.y - knot.y);
    const double knot_distance = glm::length(to_knot) * (1 + 0.25 * at(14, 14, 3));
    const double squared = knot_distance * knot_distance / (13 * 13);
    const double hill = 1 / ((1 + squared) * (1 + squared));
    const double ring = p.y / 10 + 1.9 * at(170, 42, 1) + 0.5 * at(50, 18, 2) + 4.5 * hill;
    const double phase = ring - std::floor(ring);
    const double late_wood = smooth_step(0.35, 0.85, phase) * smooth_step(1.0, 0.90, phase);

    const double fibre = at(46, 1.5, 4) + 0.6 * at(18, 0.9, 5);
    const double pore = smooth_step(0.30, 0.55, at(16, 1.3, 6));
    const double stain = at(120, 30, 7);
    dvec3 color = glm::mix(rgb(0xC79A62), rgb(0x9A6A3B), 0.75 * late_wood);
    color =
        glm::mix(color, rgb(0x5A3720), 0.85 * smooth_step(6.5, 3.5, knot_distance) + 0.30 * hill);
    return color * (1 + 0.09 * fibre - 0.22 * pore + 0.12 * stain);
}

/// How much light the higher boards leave.
inline double open_sky(const std::vector<Board>& boards, dvec2 p, int layer) {
    double light = 1;
    for (const Board& board : boards)
        if (board.layer > layer) light *= 0.50 + 0.50 * smooth_step(-3, 17, board.distance(p));
    return light;
}

/// Where the frame is held together: in pairs at the corners, one by one between.
inline std::vector<dvec2> bolt_places() {
    std::vector<dvec2> places;
    const double near = 26, mid = 50, far = texture_side;
    for (const double x : {near, far - near})
        for (const double y : {near, far - near}) places.push_back({x, y});
    for (const double x : {mid, far - mid})
        for (const double y : {mid, far - mid}) places.push_back({x, y});
    for (const double end : {37.0, far - 37.0}) {
        places.push_back({end, far / 2});
        places.push_back({far / 2, end});
    }
    return places;
}

/// A round iron head with a worn top, and its shadow in the wood around.
inline dvec3 with_bolts(dvec3 wood, dvec2 p, const std::vector<dvec2>& places) {
    for (const dvec2 place : places) {
        const dvec2 d = p - place;
        const double r = glm::length(d);
        wood *= 0.55 + 0.45 * smooth_step(6, 12, r);
        const double dome = smooth_step(7, 1, glm::length(d + dvec2(1.5, 2)));
        const dvec3 iron = glm::mix(rgb(0x2C2A29), rgb(0x8B8680), dome);
        wood = glm::mix(wood, iron, smooth_step(7.5, 6.2, r));
    }
    return wood;
}

inline dvec3 boards_color(dvec2 p, const std::vector<Board>& boards) {
    dvec3 color = rgb(0x22170E);  // the dark between two planks
    for (std::size_t i = 0; i < boards.size(); ++i) {
        const Board& board = boards[i];
        const double edge = board.distance(p);
        if (edge >= 0) continue;
        const double worn = smooth_step(-6, -2.5, edge) * smooth_step(-0.6, -2.5, edge);
        const double outline = smooth_step(0, -2.2, edge);
        const dvec3 wood =
            fir(board.local(p), std::uint32_t(i) + 1) * board.tint * (1 + 0.16 * worn);
        color = glm::mix(rgb(0x2A1B10), wood, outline) * open_sky(boards, p, board.layer);
    }
    return color;
}

inline Image<u8vec3> wood_image() {
    const std::vector<Board> boards = crate_boards();
    const std::vector<dvec2> bolts = bolt_places();
    return paint([&](dvec2 p) { return encode(with_bolts(boards_color(p, boards), p, bolts)); });
}

}  // namespace rasterbook::assets
