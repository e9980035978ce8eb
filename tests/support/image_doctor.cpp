// SPDX-License-Identifier: MIT
#include "support/image_doctor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "support/image_mistakes.hpp"
#include "support/picture_difference.hpp"

namespace rasterbook::test {

namespace {

/// Findings closer together than this explain a picture equally well: both counts have a few pixels
/// of chance in them.
constexpr double equally_well = 0.01;

/// Takes out the finding that explains most, and what says the same.
Finding take_best(std::vector<Finding>& findings) {
    const Finding best = *std::max_element(
        findings.begin(), findings.end(),
        [](const Finding& a, const Finding& b) { return a.explained < b.explained; });
    std::erase_if(findings, [&](const Finding& other) { return other.words == best.words; });
    return best;
}

/// Where the middle nine tenths of the coordinates lie.
std::pair<int, int> most_of(std::vector<int> coordinates) {
    std::sort(coordinates.begin(), coordinates.end());
    const std::size_t tail = coordinates.size() / 20;
    return {coordinates[tail], coordinates[coordinates.size() - 1 - tail]};
}

std::string unexplained(const Image<u8vec4>& actual, const Image<u8vec4>& expected) {
    std::vector<int> x_differing, y_differing;
    for (int y = 0; y < actual.size().y; ++y)
        for (int x = 0; x < actual.size().x; ++x)
            if (greatest_difference(actual[{x, y}], expected[{x, y}]) > 0)
                x_differing.push_back(x), y_differing.push_back(y);
    const auto [left, right] = most_of(x_differing);
    const auto [top, bottom] = most_of(y_differing);
    const auto point = [](int x, int y) {
        return "(" + std::to_string(x) + ", " + std::to_string(y) + ")";
    };
    return "differs in " + std::to_string(x_differing.size()) + " pixels, the most by " +
           std::to_string(picture_difference(actual, expected).greatest) +
           " of 255, most of them between " + point(left, top) + " and " + point(right, bottom) +
           "; none of the usual mistakes explains it";
}

}  // namespace

std::string diagnose(const Image<u8vec4>& actual, const Image<u8vec4>& expected,
                     const PictureFacts& facts) {
    if (picture_difference(actual, expected).is_tolerable()) return "";
    // Most certain first: a mistake that predicts every pixel before one that predicts places.
    for (const auto find : {pixel_mistakes, half_pixel_mistakes, visibility_mistakes}) {
        std::vector<Finding> findings = find({actual, expected, facts});
        if (findings.empty()) continue;
        const Finding best = take_best(findings);
        if (findings.empty()) return best.words;
        const Finding next = take_best(findings);
        return next.explained > best.explained - equally_well ? best.words + "\nor " + next.words
                                                              : best.words;
    }
    return unexplained(actual, expected);
}

}  // namespace rasterbook::test
