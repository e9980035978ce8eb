// SPDX-License-Identifier: MIT
/// @file
/// Other ways to draw the line of lesson 01; measured in docs/accuracy/01_bresenham_lines.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>

#include "01_bresenham_lines/line.hpp"

namespace rasterbook {

enum class LineMethod { bresenham, dda_float, dda_fixed, wu };

/// The row of a digital differential analyser (DDA) in float: every sum is rounded.
struct FloatRow {
    float row, rows_a_step;

    FloatRow(const LineSteps& line, std::int64_t first_step) {
        const auto length = static_cast<float>(std::max<std::int64_t>(line.major_length, 1));
        rows_a_step = static_cast<float>(line.minor_direction * line.minor_length) / length;
        row = static_cast<float>(line.minor_start) + rows_a_step * static_cast<float>(first_step);
    }
    std::int64_t nearest() const { return std::lrint(row); }
    void step() { row += rows_a_step; }
};

/// The row in fixed point: whole numbers of 2^-fraction_bits rows. Only the slope is rounded, so
/// the row drifts by at most half a unit in each step.
template <int fraction_bits>
struct FixedRow {
    std::int64_t row, rows_a_step;

    FixedRow(const LineSteps& line, std::int64_t first_step) {
        const auto length = std::max<std::int64_t>(line.major_length, 1);
        const std::int64_t rise = line.minor_length << fraction_bits;
        rows_a_step = line.minor_direction * ((2 * rise + length) / (2 * length));
        row = (line.minor_start << fraction_bits) + rows_a_step * first_step;
    }
    std::int64_t above() const { return row >> fraction_bits; }  // rounds down
    float beyond_above() const {
        constexpr float per_row = 1.0f / static_cast<float>(std::int64_t{1} << fraction_bits);
        return static_cast<float>(row & ((std::int64_t{1} << fraction_bits) - 1)) * per_row;
    }
    std::int64_t nearest() const { return (row + (1 << (fraction_bits - 1))) >> fraction_bits; }
    void step() { row += rows_a_step; }
};

/// Walks the steps of draw_line, with the row that Row computes. Since rows are not exact here,
/// each pixel is asked whether it is inside.
///
/// @param visit  Called as visit(row, plot_inside), where plot_inside(minor, coverage) plots.
template <typename Row, typename Visit, std::invocable<ivec2, float> Plot>
void walk_line(ivec2 a, ivec2 b, ivec2 size, LineEnd end, Visit&& visit, Plot&& plot) {
    const LineSteps line(a, b);
    // As if there were another row on each side: Wu's second pixel may be inside where the line is
    // not yet.
    LineSteps line_in_more = line;
    ++line_in_more.minor_start;
    const ivec2 two_rows = line.steep ? ivec2(2, 0) : ivec2(0, 2);
    const StepRange steps = steps_inside(line_in_more, size + two_rows, end);
    if (steps.first > steps.last) return;
    Row row(line, steps.first);
    const int minor_size = line.steep ? size.x : size.y;
    auto major = static_cast<int>(line.major_start + steps.first);
    const auto last = static_cast<int>(line.major_start + steps.last);
    for (; major <= last; ++major) {
        visit(row, [&](std::int64_t minor64, float coverage) {
            const auto minor = static_cast<int>(minor64);
            if (minor < 0 || minor >= minor_size) return;
            plot(line.steep ? ivec2(minor, major) : ivec2(major, minor), coverage);
        });
        row.step();
    }
}

/// draw_line in one of several ways.
///
/// @param a,b   Screen space, whole pixels; for methods other than Bresenham's, smaller than 2^24
/// in size.
/// @param plot  Called as plot(ivec2 pixel, float coverage) for each pixel inside the image.
///              The coverage is 1 but for Wu's lines, where two neighbours share it.
/// @see Wu, "An efficient antialiasing technique", SIGGRAPH 1991
template <std::invocable<ivec2, float> Plot>
void draw_line_as(LineMethod method, ivec2 a, ivec2 b, ivec2 size, LineEnd end, Plot&& plot) {
    const auto nearest = [](const auto& row, auto&& plot_inside) {
        plot_inside(row.nearest(), 1.0f);
    };
    const auto both_neighbours = [](const FixedRow<32>& row, auto&& plot_inside) {
        const float share = row.beyond_above();
        if (share < 1) plot_inside(row.above(), 1.0f - share);
        if (share > 0) plot_inside(row.above() + 1, share);
    };
    switch (method) {
        case LineMethod::bresenham:
            return draw_line(a, b, size, end, [&](ivec2 pixel) { plot(pixel, 1.0f); });
        case LineMethod::dda_float:
            return walk_line<FloatRow>(a, b, size, end, nearest, plot);
        case LineMethod::dda_fixed:
            return walk_line<FixedRow<16>>(a, b, size, end, nearest, plot);
        case LineMethod::wu:
            return walk_line<FixedRow<32>>(a, b, size, end, both_neighbours, plot);
    }
}

}  // namespace rasterbook
