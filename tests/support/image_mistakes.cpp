// SPDX-License-Identifier: MIT
#include "support/image_mistakes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "common/math/color.hpp"
#include "support/picture_difference.hpp"

namespace rasterbook::test {

namespace {

/// A mistake of pixels explains a picture when no more than this share of its wrong pixels is left:
/// those on the edges of triangles, where a flipped or shifted triangle may own another pixel.
constexpr double share_left_by_pixel_mistakes = 0.05;

/// Whether the mistake accounts for the actual colour of a pixel.
using Agrees = std::function<bool(ivec2)>;

std::size_t count_disagreeing(const Case& c, std::size_t limit, const Agrees& agrees) {
    std::size_t count = 0;
    for (int y = 0; y < c.actual.size().y && count <= limit; ++y)
        for (int x = 0; x < c.actual.size().x; ++x) count += !agrees({x, y});
    return count;
}

/// Keeps those of a list of mistakes that explain the picture.
class Findings {
  public:
    explicit Findings(const Case& c)
        : case_(c), wrong_(count_disagreeing(c, c.actual.pixels().size(), [&](ivec2 p) {
              return looks_the_same(c.actual[p], c.expected[p]);
          })) {}

    void consider(const std::string& words, const Agrees& agrees) {
        const auto limit =
            static_cast<std::size_t>(share_left_by_pixel_mistakes * static_cast<double>(wrong_));
        if (wrong_ == 0) return;  // by a level each: of that nothing can be said
        const std::size_t left = count_disagreeing(case_, limit, agrees);
        if (left <= limit)
            findings_.push_back(
                {1 - static_cast<double>(left) / static_cast<double>(wrong_), words});
    }

    std::vector<Finding> take() { return std::move(findings_); }

  private:
    const Case& case_;
    std::size_t wrong_;
    std::vector<Finding> findings_;
};

void consider_flips(const Case& c, Findings& findings) {
    const ivec2 last = c.actual.size() - ivec2(1);
    const auto consider = [&](const char* words, auto source) {
        findings.consider(
            words, [&](ivec2 p) { return looks_the_same(c.actual[p], c.expected[source(p)]); });
    };
    consider(
        "flipped left to right: x runs to the right on the screen; compare docs/conventions.md, C6",
        [=](ivec2 p) { return ivec2(last.x - p.x, p.y); });
    consider(
        "flipped top to bottom, the background too: the top row comes first in a picture; compare "
        "docs/conventions.md, C7",
        [=](ivec2 p) { return ivec2(p.x, last.y - p.y); });
    consider(
        "turned by 180 degrees, the background too: the pixels are in reversed order; compare "
        "docs/conventions.md, C7",
        [=](ivec2 p) { return last - p; });
}

/// "2 pixels to the left and 1 pixel down"; "half a pixel down" for halves.
std::string shift_in_words(dvec2 shift) {
    const auto amount = [](double pixels) -> std::string {
        return pixels < 0.75 ? "half a pixel" : pixels < 1.5 ? "1 pixel" : "2 pixels";
    };
    std::string words;
    if (shift.x != 0)
        words = amount(std::abs(shift.x)) + (shift.x > 0 ? " to the right" : " to the left");
    if (shift.x != 0 && shift.y != 0) words += " and ";
    if (shift.y != 0) words += amount(std::abs(shift.y)) + (shift.y > 0 ? " down" : " up");
    return words;
}

void consider_whole_shifts(const Case& c, Findings& findings) {
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x) {
            if (x == 0 && y == 0) continue;
            const ivec2 shift(x, y);
            findings.consider(
                "shifted by " + shift_in_words(shift) +
                    ": rounded the wrong way, or a row or column counted from 1; compare "
                    "docs/conventions.md, C7",
                [&](ivec2 p) {
                    const ivec2 source =
                        glm::clamp(p - shift, ivec2(0), c.expected.size() - ivec2(1));
                    return looks_the_same(c.actual[p], c.expected[source]);
                });
        }
}

/// Whether the mistake changes what the whole picture would look like and not the triangles alone.
bool is_of_the_whole_picture(const Case& c, const std::function<u8vec4(u8vec4)>& change) {
    std::size_t to_change = 0, unchanged = 0;
    for (std::size_t i = 0; i < c.actual.pixels().size(); ++i) {
        const u8vec4 expected = c.expected.pixels()[i];
        if (looks_the_same(change(expected), expected)) continue;
        ++to_change;
        unchanged += looks_the_same(c.actual.pixels()[i], expected);
    }
    return static_cast<double>(unchanged) <=
           share_left_by_pixel_mistakes * static_cast<double>(to_change);
}

void consider_exchanged_channels(const Case& c, Findings& findings) {
    struct Exchange {
        ivec3 source;  ///< The channels from which red, green and blue come.
        const char *colors, *vertices;
    };
    for (const Exchange& e : {
             Exchange{{2, 1, 0}, "red and blue exchanged", "those of a and c exchanged"},
             Exchange{{1, 0, 2}, "red and green exchanged", "those of a and b exchanged"},
             Exchange{{0, 2, 1}, "green and blue exchanged", "those of b and c exchanged"},
             Exchange{{1, 2, 0},
                      "red holds green, green holds blue, blue holds red",
                      "a has b's, b has c's, c has a's"},
             Exchange{{2, 0, 1},
                      "red holds blue, green holds red, blue holds green",
                      "a has c's, b has a's, c has b's"},
         }) {
        const auto change = [&](u8vec4 color) {
            return u8vec4(color[e.source.x], color[e.source.y], color[e.source.z], color.a);
        };
        const bool are_barycentrics =
            c.facts.shows_barycentrics && !is_of_the_whole_picture(c, change);
        findings.consider(
            are_barycentrics
                ? std::string("the barycentric coordinates belong to the wrong vertices, ") +
                      e.vertices +
                      ": a vertex's coordinate is that of the side opposite to it; compare lesson "
                      "02"
                : std::string(e.colors) +
                      ": files and libraries differ in which of the three comes first",
            [&](ivec2 p) {
                return looks_the_same(c.actual[p], c.expected[p]) ||
                       looks_the_same(c.actual[p], change(c.expected[p]));
            });
    }
}

/// Considers that each level of the expected picture has become another.
///
/// @param curve  0 to 1, rising.
void consider_curve(const Case& c, Findings& findings, const char* words, double (*curve)(double)) {
    // A level stands for all values that are rounded to it; the result is rounded once more.
    std::array<ivec2, 256> range;
    for (int level = 0; level < 256; ++level) {
        const auto at = [&](double value) {
            return 255 * curve(std::clamp(value / 255, 0.0, 1.0));
        };
        range[static_cast<std::size_t>(level)] = {std::floor(at(level - 0.5)),
                                                  std::ceil(at(level + 0.5))};
    }
    findings.consider(words, [&](ivec2 p) {
        for (int channel = 0; channel < 3; ++channel) {
            const ivec2 allowed = range[c.expected[p][channel]];
            const int level = c.actual[p][channel];
            if (level < allowed.x || level > allowed.y) return false;
        }
        return true;
    });
}

/// Red, green and blue, 0 to 255, smoothed over some 4 pixels.
Image<dvec3> smoothed(const Image<u8vec4>& picture) {
    Image<dvec3> image(picture.size());
    for (std::size_t i = 0; i < image.pixels().size(); ++i)
        image.pixels()[i] = dvec3(picture.pixels()[i]);
    for (const ivec2 step : {ivec2(1, 0), ivec2(0, 1), ivec2(1, 0), ivec2(0, 1)}) {
        Image<dvec3> next = image;
        for (int y = 0; y < image.size().y; ++y)
            for (int x = 0; x < image.size().x; ++x) {
                const ivec2 p(x, y);
                const ivec2 before = glm::max(p - step, ivec2(0)),
                            after = glm::min(p + step, image.size() - ivec2(1));
                next[p] = (image[before] + 2.0 * image[p] + image[after]) / 4.0;
            }
        image = std::move(next);
    }
    return image;
}

/// Between four pixels; `at` lies a pixel or more inside.
dvec3 interpolated(const Image<dvec3>& image, dvec2 at) {
    const ivec2 p(glm::floor(at));
    const dvec2 share = at - dvec2(p);
    return glm::mix(glm::mix(image[p], image[p + ivec2(1, 0)], share.x),
                    glm::mix(image[p + ivec2(0, 1)], image[p + ivec2(1, 1)], share.x), share.y);
}

/// What a shift of the expected picture leaves, and the step that would make it less.
struct ShiftFit {
    double squared_error = 0;
    dvec2 step{0};
};

/// @see Lucas and Kanade, "An iterative image registration technique", 1981
ShiftFit fit_shift(const Image<dvec3>& actual, const Image<dvec3>& expected, dvec2 shift) {
    constexpr int margin = 4;      // more than the shift and the smoothing reach
    constexpr double gentle = 2;   // slope in levels a pixel
    constexpr double level = 0.6;  // slope of what need not move: the background
    double xx = 0, xy = 0, yy = 0, x_error = 0, y_error = 0;
    ShiftFit fit;
    for (int y = margin; y < actual.size().y - margin; ++y)
        for (int x = margin; x < actual.size().x - margin; ++x) {
            const dvec2 at = dvec2(x, y) - shift;
            const auto value = [&](dvec2 offset) { return interpolated(expected, at + offset); };
            const dvec3 error = actual[{x, y}] - value({0, 0});
            const dvec3 slope_x = (value({1, 0}) - value({-1, 0})) / 2.0;
            const dvec3 slope_y = (value({0, 1}) - value({0, -1})) / 2.0;
            const double brightness_error = error.r + error.g + error.b;
            fit.squared_error += brightness_error * brightness_error;
            // Steep places are edges, which move in whole pixels: they count less.
            const double squared_slope = glm::dot(slope_x, slope_x) + glm::dot(slope_y, slope_y);
            if (squared_slope < level * level) continue;
            const double weight = 1 / (gentle * gentle + squared_slope);
            xx += weight * glm::dot(slope_x, slope_x);
            xy += weight * glm::dot(slope_x, slope_y);
            yy += weight * glm::dot(slope_y, slope_y);
            x_error += weight * glm::dot(slope_x, error);
            y_error += weight * glm::dot(slope_y, error);
        }
    const double determinant = xx * yy - xy * xy;
    if (determinant > 1e-6 * xx * yy)  // else the picture says nothing of one of the directions
        fit.step = -dvec2(yy * x_error - xy * y_error, xx * y_error - xy * x_error) / determinant;
    return fit;
}

}  // namespace

std::vector<Finding> pixel_mistakes(const Case& c) {
    Findings findings(c);
    consider_flips(c, findings);
    consider_exchanged_channels(c, findings);
    consider_curve(c, findings,
                   "too bright and pale, sRGB encoded twice: colour is linear until the picture is "
                   "written; compare docs/conventions.md, C11",
                   srgb_from_linear<double>);
    consider_curve(c, findings,
                   "too dark, not sRGB encoded: linear colour has to be encoded when the picture "
                   "is written; compare docs/conventions.md, C11",
                   linear_from_srgb<double>);
    consider_whole_shifts(c, findings);
    return findings.take();
}

std::vector<Finding> half_pixel_mistakes(const Case& c) {
    // What is left of the squared difference is due to edges, which are drawn in whole pixels.
    constexpr double greatest_share_left = 0.5;
    constexpr double half_tolerance = 0.1;  // of the estimate, in pixels
    const Image<dvec3> actual = smoothed(c.actual), expected = smoothed(c.expected);
    const double before = fit_shift(actual, expected, {0, 0}).squared_error;
    dvec2 shift(0);
    for (int i = 0; i < 3; ++i) {
        shift += fit_shift(actual, expected, shift).step;
        if (!(glm::length(shift) < 2)) return {};
    }
    const double left = fit_shift(actual, expected, shift).squared_error / before;
    const dvec2 halves = glm::round(2.0 * shift) / 2.0;
    const bool is_half = glm::length(shift - halves) < half_tolerance && halves != dvec2(0) &&
                         glm::length(halves) < 1;
    if (!is_half || !(left <= greatest_share_left)) return {};
    return {{1 - left, "shifted by " + shift_in_words(halves) +
                           ": a pixel's centre lies at (x + 1/2, y + 1/2), and the half is missing "
                           "or added twice; compare docs/conventions.md, C7"}};
}

}  // namespace rasterbook::test
