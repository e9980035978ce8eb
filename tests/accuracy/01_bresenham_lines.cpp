// SPDX-License-Identifier: MIT
/// @file
/// Lines: which pixels they visit, how smooth they look, and what a step costs.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "accuracy/accuracy.hpp"
#include "common/image/image.hpp"
#include "lab/line_methods.hpp"
#include "support/exact_area.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

struct Line {
    ivec2 a, b;

    ivec2 extent() const { return glm::abs(b - a); }
    int steps() const { return std::max(extent().x, extent().y) + 1; }
};

std::vector<Line> random_lines(int count, int side) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> any(0, side - 1);
    std::vector<Line> lines;
    while (std::ssize(lines) < count) {
        const Line line{{any(random), any(random)}, {any(random), any(random)}};
        if (line.a != line.b) lines.push_back(line);
    }
    return lines;
}

/// Twice the distance of p from the line along its shorter axis, times its longer extent: whole.
std::int64_t doubled_distance(const Line& line, ivec2 p) {
    const std::int64_t dx = line.b.x - line.a.x, dy = line.b.y - line.a.y;
    return 2 * std::abs(dy * (p.x - line.a.x) - dx * (p.y - line.a.y));
}

/// How far the rows are from the ideal line. Where two pixels share a step, their middle counts.
Errors distance_errors(LineMethod method, const std::vector<Line>& lines, int side) {
    double greatest = 0, steps = 0, not_nearest = 0;
    for (const Line& line : lines) {
        const bool steep = line.extent().x < line.extent().y;
        const auto major_extent = static_cast<double>(line.steps() - 1);
        const double slope = (steep ? line.b.x - line.a.x : line.b.y - line.a.y) /
                             static_cast<double>(steep ? line.b.y - line.a.y : line.b.x - line.a.x);
        std::vector<double> middle(static_cast<std::size_t>(side), 0.0);
        draw_line_as(method, line.a, line.b, ivec2(side), LineEnd::included,
                     [&](ivec2 pixel, float coverage) {
                         const auto major = static_cast<std::size_t>(steep ? pixel.y : pixel.x);
                         middle[major] += double{coverage} * (steep ? pixel.x : pixel.y);
                         not_nearest +=
                             coverage == 1 && doubled_distance(line, pixel) >
                                                  static_cast<std::int64_t>(major_extent);
                     });
        const ivec2 start = steep ? ivec2(line.a.y, line.a.x) : line.a;
        const int first = std::min(start.x, steep ? line.b.y : line.b.x);
        for (int major = first; major < first + line.steps(); ++major) {
            const double ideal = start.y + slope * (major - start.x);
            const double distance = std::abs(middle[static_cast<std::size_t>(major)] - ideal);
            greatest = std::max(greatest, distance);
            ++steps;
        }
    }
    const std::string lines_to = ", lines to " + std::to_string(side) + " px";
    return {{"wrong pixels of a million" + lines_to, 1e6 * not_nearest / steps},
            {"greatest distance" + lines_to, greatest}};
}

/// How far the coverages are from the areas that a line one pixel wide covers, in all pixels that
/// either of them touches. The line reaches half a pixel beyond the centres of its ends.
Errors coverage_errors(LineMethod method, const std::vector<Line>& lines, int side) {
    ErrorSum errors;
    Image<float> drawn(ivec2(side), 0.0f);
    for (const Line& line : lines) {
        draw_line_as(method, line.a, line.b, ivec2(side), LineEnd::included,
                     [&](ivec2 pixel, float coverage) { drawn[pixel] += coverage; });
        const dvec2 along = 0.5 * glm::normalize(dvec2(line.b - line.a));
        const dvec2 across(along.y, -along.x);
        const dvec2 from = dvec2(line.a) + 0.5 - along, to = dvec2(line.b) + 0.5 + along;
        const std::vector<dvec2> strip = {from - across, from + across, to + across, to - across};
        const ivec2 low = glm::max(glm::min(line.a, line.b) - 1, ivec2(0));
        const ivec2 high = glm::min(glm::max(line.a, line.b) + 1, ivec2(side - 1));
        const double reach = 2 * std::max(line.extent().x, line.extent().y) + 1.0;
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x) {
                if (static_cast<double>(doubled_distance(line, {x, y})) > 2 * reach) continue;
                float& coverage = drawn[{x, y}];
                const double area = area_in_pixel(strip, {x, y});
                if (area > 0 || coverage > 0) errors.add(double{coverage} - area);
                coverage = 0;
            }
    }
    return {{"RMS error of coverage", errors.rms()},
            {"greatest error of coverage", errors.greatest()}};
}

}  // namespace

int main(int argc, char** argv) {
    constexpr int side = 192;  // with one byte a pixel the picture stays in the nearest cache
    static const std::vector<Line> lines = random_lines(500, side);
    static Image<std::uint8_t> picture(ivec2(side), 0);
    double steps = 0;
    for (const Line& line : lines) steps += line.steps();

    struct Variant {
        const char* name;
        LineMethod method;
    };
    for (const auto& [name, method] :
         {Variant{"Bresenham", LineMethod::bresenham}, Variant{"DDA, float", LineMethod::dda_float},
          Variant{"DDA, 16.16", LineMethod::dda_fixed}, Variant{"Wu", LineMethod::wu}}) {
        const auto draw = [how = method] {
            for (const Line& line : lines)
                draw_line_as(how, line.a, line.b, ivec2(side), LineEnd::included,
                             [&](ivec2 pixel, float coverage) {
                                 picture[pixel] = static_cast<std::uint8_t>(255 * coverage);
                             });
        };
        Errors rows;
        for (const int longest : {1024, 16384})
            rows.merge(distance_errors(method, random_lines(2000, longest), longest));
        if (method != LineMethod::wu) add_variant("rows", name, steps, rows, draw);
        add_variant("coverage", name, steps, coverage_errors(method, lines, side), draw);
    }
    return measure_variants(argc, argv);
}
