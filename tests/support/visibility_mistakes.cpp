// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "common/math/color.hpp"
#include "support/image_mistakes.hpp"
#include "support/picture_difference.hpp"

namespace rasterbook::test {

namespace {

/// A wrong way to draw the patches.
struct Mistake {
    std::string words;
    VisibilityRule rule;
    std::function<ScreenPatch(std::size_t, ScreenPatch)> change;  ///< Null for none.
    bool moves_patches = false;  ///< Then the same patch may show another place of it.
};

Visibility visible_after(const Mistake& mistake, std::vector<ScreenPatch> patches, ivec2 size) {
    if (mistake.change)
        for (std::size_t i = 0; i < patches.size(); ++i) patches[i] = mistake.change(i, patches[i]);
    return visible(patches, size, mistake.rule);
}

VisibilityRule right_rule(const PictureFacts& facts) {
    return {Facing::front, facts.has_depth_buffer ? Winner::nearest : Winner::last};
}

void add_wrong_order_and_facing(std::vector<Mistake>& mistakes, VisibilityRule right) {
    if (right.winner == Winner::nearest) {
        mistakes.push_back(
            {"the farthest surface is seen in place of the nearest: \"less\" for "
             "\"greater\", or depth counted the other way; compare lesson 03",
             {right.drawn, Winner::farthest},
             {}});
        mistakes.push_back(
            {"each triangle covers those before it: depth is not tested, or not "
             "written; compare lesson 03",
             {right.drawn, Winner::last},
             {}});
    }
    mistakes.push_back(
        {"inside out, backs are seen in place of fronts: the sign of the area, or "
         "the order of the vertices; compare docs/conventions.md, C9",
         {Facing::back, right.winner},
         {}});
    mistakes.push_back(
        {"backs are drawn as well as fronts: triangles seen clockwise are to be "
         "skipped; compare docs/conventions.md, C9",
         {Facing::both, right.winner},
         {}});
}

void add_missing_patches(std::vector<Mistake>& mistakes, VisibilityRule right) {
    const auto without = [](auto is_missing) {
        return
            [=](std::size_t i, ScreenPatch patch) { return is_missing(i) ? ScreenPatch{} : patch; };
    };
    mistakes.push_back({right.winner == Winner::nearest
                            ? "nothing of the model is seen: nothing is filled, no triangle counts "
                              "as a front, no depth is nearer than what the buffer is cleared to, "
                              "or none is kept; compare lesson 03"
                            : "nothing of the model is seen: nothing is filled, or no triangle "
                              "counts as a front (the sign of the area, y up?); compare lesson 02",
                        right, without([](std::size_t) { return true; })});
    mistakes.push_back(
        {"every second triangle is missing (the 2nd, 4th ...): a polygon of n "
         "vertices is n - 2 triangles; compare lesson 02",
         right, without([](std::size_t i) { return i % 2 == 1; })});
    mistakes.push_back(
        {"every second triangle is missing (the 1st, 3rd ...): a polygon of n "
         "vertices is n - 2 triangles; compare lesson 02",
         right, without([](std::size_t i) { return i % 2 == 0; })});
}

void add_mirrored(std::vector<Mistake>& mistakes, VisibilityRule right, ivec2 size) {
    struct Axes {
        glm::bvec2 are_mirrored;
        const char *look, *cause;
    };
    for (const auto& [are_mirrored, look, cause] :
         {Axes{{true, false}, "left to right", "x runs to the right on the screen"},
          Axes{{false, true}, "top to bottom", "y runs down on the screen and up in the model"},
          Axes{{true, true}, "left to right and top to bottom", "both axes have the wrong sign"}}) {
        const auto mirror = [=](std::size_t, ScreenPatch patch) {
            for (vec3& vertex : patch) {
                if (are_mirrored.x) vertex.x = static_cast<float>(size.x) - vertex.x;
                if (are_mirrored.y) vertex.y = static_cast<float>(size.y) - vertex.y;
            }
            return patch;
        };
        const std::string flipped = std::string("the model is flipped ") + look;
        const std::string why = std::string(": ") + cause + "; compare docs/conventions.md, C6";
        const bool turns_inside_out = are_mirrored.x != are_mirrored.y;
        const Facing same_side = turns_inside_out ? Facing::back : Facing::front;
        mistakes.push_back({flipped + why, {same_side, right.winner}, mirror, true});
        if (turns_inside_out)
            mistakes.push_back({flipped + ", and its backs are seen" + why, right, mirror, true});
    }
}

void add_barycentrics_of_depth(std::vector<Mistake>& mistakes, VisibilityRule right) {
    for (const ivec3 source :
         {ivec3(2, 1, 0), ivec3(1, 0, 2), ivec3(0, 2, 1), ivec3(1, 2, 0), ivec3(2, 0, 1)})
        mistakes.push_back(
            {"depths belong to the wrong vertices: a vertex's coordinate is that of the "
             "side opposite to it; compare lessons 02 and 03",
             right, [=](std::size_t, ScreenPatch patch) {
                 const vec3 depths(patch[0].z, patch[1].z, patch[2].z);
                 for (int i = 0; i < 3; ++i)
                     patch[static_cast<std::size_t>(i)].z = depths[source[i]];
                 return patch;
             }});
}

std::vector<Mistake> all_mistakes(const PictureFacts& facts, ivec2 size) {
    const VisibilityRule right = right_rule(facts);
    std::vector<Mistake> mistakes;
    add_missing_patches(mistakes, right);
    add_wrong_order_and_facing(mistakes, right);
    add_mirrored(mistakes, right, size);
    if (facts.has_depth_buffer) add_barycentrics_of_depth(mistakes, right);
    return mistakes;
}

/// Of the pixels where the mistake shows and those where the pictures differ: how many are in both,
/// among those in either; 0 when there are none.
double intersection_over_union(const Case& c, const Mistake& mistake, const Visibility& wrong,
                               const Visibility& right) {
    // A patch that has moved looks different where it still covers a pixel, unless it is flat.
    std::size_t differing = 0, of_other = 0, of_other_differing = 0, of_same = 0,
                of_same_differing = 0;
    for (std::size_t i = 0; i < right.ids.pixels().size(); ++i) {
        const int id = wrong.ids.pixels()[i];
        const bool is_other = id != right.ids.pixels()[i];
        const bool is_same = !is_other && id != Visibility::nothing && mistake.moves_patches;
        const bool is_different = !looks_the_same(c.actual.pixels()[i], c.expected.pixels()[i]);
        differing += is_different;
        of_other += is_other, of_other_differing += is_other && is_different;
        of_same += is_same, of_same_differing += is_same && is_different;
    }
    const auto ratio = [&](std::size_t predicted, std::size_t both) {
        const std::size_t either = predicted + differing - both;
        return either == 0 ? 0.0 : static_cast<double>(both) / static_cast<double>(either);
    };
    return std::max(ratio(of_other, of_other_differing),
                    ratio(of_other + of_same, of_other_differing + of_same_differing));
}

/// How much neighbouring pixels differ on the average, 0 to 255.
struct Steps {
    double sum = 0;
    std::size_t count = 0;

    void add(u8vec4 a, u8vec4 b) { sum += greatest_difference(a, b), ++count; }
    double mean() const { return count == 0 ? 0 : sum / static_cast<double>(count); }
};

/// How much more the picture's edges are those of the wrong triangles than those of the right ones,
/// up to 1.
///
/// Without this, whatever changes the colour of the whole model would pass for whatever shows other
/// triangles everywhere.
double clarity_of_edges(const Case& c, const Visibility& wrong, const Visibility& right) {
    constexpr int step_of_background = 2;     // levels between neighbours: it is smooth
    constexpr double share_of_outline = 0.5;  // of the right one; of another model it is more
    constexpr double least_contrast = 0.1;    // of the right edges; inside out it is 0.5
    Steps added, removed, removed_of_expected;
    std::size_t edges_in_background = 0, removed_outline = 0;
    for (const ivec2 step : {ivec2(1, 0), ivec2(0, 1)})
        for (int y = 0; y + step.y < c.actual.size().y; ++y)
            for (int x = 0; x + step.x < c.actual.size().x; ++x) {
                const ivec2 p(x, y), q = p + step;
                const bool is_edge = wrong.ids[p] != wrong.ids[q];
                const bool is_right_edge = right.ids[p] != right.ids[q];
                if (!is_edge && wrong.ids[p] == Visibility::nothing) {
                    edges_in_background +=
                        greatest_difference(c.actual[p], c.actual[q]) > step_of_background;
                    removed_outline += is_right_edge && (right.ids[p] == Visibility::nothing ||
                                                         right.ids[q] == Visibility::nothing);
                }
                if (is_edge == is_right_edge) continue;
                (is_edge ? added : removed).add(c.actual[p], c.actual[q]);
                if (!is_edge) removed_of_expected.add(c.expected[p], c.expected[q]);
            }
    // Where the mistake shows the background there is no edge.
    if (static_cast<double>(edges_in_background) >
        share_of_outline * static_cast<double>(removed_outline))
        return 0;
    if (added.count > 0 && added.mean() < least_contrast * removed_of_expected.mean()) return 0;
    const double edge = added.count > 0 ? added.mean() : removed_of_expected.mean();
    return edge > 0 ? 1 - removed.mean() / edge : 0;
}

/// How a picture of depths fits to the depths of a way to draw the patches.
struct DepthFit {
    double correlation;    ///< Of brightness and nearness over the covered pixels, -1 to 1.
    double share_outside;  ///< Of the picture: pixels that should be empty and do not look so.
};

DepthFit fit_depth(const Image<u8vec4>& actual, const Visibility& visibility) {
    double n = 0, a = 0, b = 0, aa = 0, ab = 0, bb = 0;
    std::array<std::size_t, 256> empty_pixels{};
    for (std::size_t i = 0; i < actual.pixels().size(); ++i) {
        const std::uint8_t level = actual.pixels()[i].r;
        if (visibility.ids.pixels()[i] == Visibility::nothing) {
            ++empty_pixels[level];
            continue;
        }
        const double shade = std::sqrt(linear_from_srgb(level / 255.0));  // as depth_picture has it
        const double nearness = visibility.depths.pixels()[i];
        n += 1, a += shade, b += nearness;
        aa += shade * shade, ab += shade * nearness, bb += nearness * nearness;
    }
    // Black when the buffer is cleared to what it should be, but of one colour anyway.
    const auto pixels = static_cast<double>(actual.pixels().size());
    const auto empty =
        static_cast<double>(*std::max_element(empty_pixels.begin(), empty_pixels.end()));
    const double spread = (n * aa - a * a) * (n * bb - b * b);
    const double correlation = n == 0 ? 1 : spread > 0 ? (n * ab - a * b) / std::sqrt(spread) : 0;
    return {correlation, (pixels - n - empty) / pixels};
}

std::vector<Finding> depth_mistakes(const Case& c, const Visibility& right) {
    constexpr double good_correlation = 0.99;   // 1 but for the rounding to 256 levels
    constexpr double greatest_outside = 0.001;  // edges
    constexpr double better = 0.3;              // of what the right depths do not explain
    const std::string exchanged =
        "near is dark and far is bright: depth is 1 nearest and 0 farthest; compare "
        "docs/conventions.md, C5";

    const double right_correlation = fit_depth(c.actual, right).correlation;
    if (right_correlation < -good_correlation) return {{-right_correlation, exchanged}};
    std::vector<Finding> findings;
    for (const Mistake& mistake : all_mistakes(c.facts, c.actual.size())) {
        const DepthFit fit =
            fit_depth(c.actual, visible_after(mistake, c.facts.patches, c.actual.size()));
        if (fit.share_outside > greatest_outside) continue;
        if (mistake.rule.winner == Winner::farthest && fit.correlation < -good_correlation)
            findings.push_back({-fit.correlation, exchanged});
        if (fit.correlation > good_correlation &&
            1 - fit.correlation < better * (1 - right_correlation))
            findings.push_back({fit.correlation, mistake.words});
    }
    return findings;
}

}  // namespace

std::vector<Finding> visibility_mistakes(const Case& c) {
    // Neighbours may have one colour, and then another triangle is seen and nothing is different.
    constexpr double least_overlap = 0.7;
    constexpr double least_clarity = 0.3;  // 0 when both edges are alike; 0.45 in small pictures

    if (c.facts.patches.empty()) return {};
    const ivec2 size = c.actual.size();
    const Visibility right = visible(c.facts.patches, size, right_rule(c.facts));
    if (c.facts.shows_depth) return depth_mistakes(c, right);
    std::vector<Finding> findings;
    std::vector<Image<int>> found;
    for (const Mistake& mistake : all_mistakes(c.facts, size)) {
        const Visibility wrong = visible_after(mistake, c.facts.patches, size);
        const double overlap = intersection_over_union(c, mistake, wrong, right);
        if (overlap < least_overlap) continue;
        const double clarity = clarity_of_edges(c, wrong, right);
        if (clarity < least_clarity) continue;
        // All triangles of one are no other picture than every second.
        if (std::find(found.begin(), found.end(), wrong.ids) != found.end()) continue;
        findings.push_back({overlap * clarity, mistake.words});
        found.push_back(wrong.ids);
    }
    return findings;
}

}  // namespace rasterbook::test
