// SPDX-License-Identifier: MIT
/// @file
/// A sheet of graph paper on which somebody has worked out lessons 01 and 02 by hand.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <vector>

#include "assets/generate/shield.hpp"
#include "assets/generate/texture.hpp"
#include "common/image/image.hpp"

namespace rasterbook::assets {

constexpr int paper_cells = 16;  ///< Along each side; one cell is a pixel.
constexpr double cell_texels = double(texture_side) / paper_cells;

/// The triangle that is filled, in cells, y down, and the crayons at its corners.
constexpr std::array<dvec2, 3> paper_triangle{dvec2(1.3, 14.4), dvec2(11.6, 11.3), dvec2(5.2, 1.4)};
constexpr std::array crayons{rgb(0xF03020), rgb(0x20B848), rgb(0x2060F0)};

/// The cells of the line, from end to end.
constexpr ivec2 paper_line_from(9, 2), paper_line_to(14, 9);

/// Twice the area of the triangle a, b, p; its sign says on which side of the edge p lies (lesson
/// 02).
constexpr double edge_function(dvec2 a, dvec2 b, dvec2 p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// The barycentric coordinates of a point; outside, one of them is negative (lesson 02).
constexpr dvec3 barycentrics_on_paper(dvec2 p) {
    const auto& [a, b, c] = paper_triangle;
    return dvec3(edge_function(b, c, p), edge_function(c, a, p), edge_function(a, b, p)) /
           edge_function(a, b, c);
}

/// Bresenham's line in whole numbers (lesson 01): it goes down by more than it goes right.
inline std::vector<ivec2> line_on_paper() {
    const ivec2 d = paper_line_to - paper_line_from;
    std::vector<ivec2> cells;
    int error = 2 * d.x - d.y, x = paper_line_from.x;
    for (int y = paper_line_from.y; y <= paper_line_to.y; ++y) {
        cells.emplace_back(x, y);
        if (error > 0) ++x, error -= 2 * d.y;
        error += 2 * d.x;
    }
    return cells;
}

/// How much a crayon leaves of itself: strokes from the lower left to the upper right.
///
/// @param p  In texels.
inline double crayon_cover(dvec2 p, ivec2 cell) {
    const dvec2 along(0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y);
    const auto seed = std::uint32_t(431 + cell.x + paper_cells * cell.y);
    const double strokes = noise(along / dvec2(40, 3.2) + 500.0, ivec2(without_end), seed);
    const dvec2 in_cell = glm::abs(p - (dvec2(cell) + 0.5) * cell_texels);
    const double to_edge = cell_texels / 2 - glm::max(in_cell.x, in_cell.y);
    return (0.8 + 0.2 * smooth_step(-0.12, 0.12, strokes)) * smooth_step(0.5, 2.0, to_edge);
}

inline dvec3 paper_color(dvec2 p) {
    const dvec2 in_cells = p / cell_texels;
    const ivec2 cell(in_cells);
    const dvec2 middle = dvec2(cell) + 0.5;
    dvec3 color = rgb(0xF4EEDF);
    const dvec2 to_line = cell_texels * (0.5 - glm::abs(in_cells - middle));
    color = glm::mix(rgb(0x93AAC2), color, smooth_step(0.4, 1.5, glm::min(to_line.x, to_line.y)));

    const dvec3 at = barycentrics_on_paper(middle);
    if (glm::min(glm::min(at.x, at.y), at.z) >= 0) {
        // Of the squares: nearer to a mixture of light than that of sRGB-encoded values.
        const dvec3 mixed =
            glm::sqrt(at.x * crayons[0] * crayons[0] + at.y * crayons[1] * crayons[1] +
                      at.z * crayons[2] * crayons[2]);
        color = glm::mix(color, mixed, crayon_cover(p, cell));
    }
    static const std::vector<ivec2> line = line_on_paper();
    for (const ivec2 of_line : line)
        if (of_line == cell) color = glm::mix(color, rgb(0x3C4048), crayon_cover(p, cell));

    double to_outline =
        distance_to_segment(in_cells, dvec2(paper_line_from) + 0.5, dvec2(paper_line_to) + 0.5);
    for (std::size_t i = 0; i < 3; ++i)
        to_outline = glm::min(to_outline, distance_to_segment(in_cells, paper_triangle[i],
                                                              paper_triangle[(i + 1) % 3]));
    return glm::mix(rgb(0x1E2026), color, smooth_step(0.7, 2.0, cell_texels * to_outline));
}

inline Image<u8vec3> graph_paper_image() {
    return paint([](dvec2 p) { return encode(paper_color(p)); });
}

}  // namespace rasterbook::assets
