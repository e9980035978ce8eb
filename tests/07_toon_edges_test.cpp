// SPDX-License-Identifier: MIT
// Edge detection in depth and normals: on pictures made by hand, and on planes of any slope.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "07_toon/outline.hpp"
#include "support/cases.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/printers.hpp"
#include "support/toon_pictures.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

const Camera camera{vec3(0), mat4(1), 1, 1};
constexpr vec3 toward_eye(0, 0, 1);
constexpr vec3 white(1);

/// The depth of a point at this distance: Eq. 4.8 in long double.
float depth_at(long double distance, const Camera& from) {
    return static_cast<float>(from.near / distance);
}

/// A picture made by hand: distances and normals.
struct ByHand {
    DepthBuffer depth;
    Image<vec3> normals, color;

    explicit ByHand(ivec2 size) : depth(size), normals(size, toward_eye), color(size, white) {}

    /// @param distance_at  Called as distance_at(pixel); infinite: nothing is there.
    template <typename DistanceAt>
    static ByHand of(ivec2 size, DistanceAt&& distance_at) {
        ByHand picture(size);
        for (ivec2 p(0); p.y < size.y; ++p.y)
            for (p.x = 0; p.x < size.x; ++p.x) {
                const float distance = distance_at(p);
                if (std::isinf(distance))
                    picture.normals[p] = vec3(0);
                else
                    picture.depth.test_and_write(p, depth_at(distance, camera));
            }
        return picture;
    }

    /// Whether each pixel is inked.
    Image<char> edges(float width_px, const EdgeThresholds& thresholds = {}) {
        draw_edges(depth, normals, camera, width_px, thresholds, color);
        Image<char> inked(color.size());
        for (std::size_t i = 0; i < color.pixels().size(); ++i)
            inked.pixels()[i] = color.pixels()[i] == ink;
        return inked;
    }
};

int ones(const Image<char>& image) {
    return static_cast<int>(std::ranges::count(image.pixels(), char{1}));
}

/// Whether there is paper, or the picture's end, within so many pixels.
bool is_near_paper(const Image<Seen>& bare, ivec2 pixel, int reach) {
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
            const ivec2 p = pixel + ivec2(x, y);
            if (!bare.contains(p) || bare[p] == Seen::paper) return true;
        }
    return false;
}

}  // namespace

TEST(Toon, Eq7_11_IsOneOverTheDistance) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> octave(-10, 10), share(0, 1);
    for (int i = 0; i < 100'000; ++i) {
        Camera some = camera;
        some.near = static_cast<float>(std::exp2(octave(random)));
        const double distance = some.near * std::exp2(10 * share(random));
        const float depth = depth_at(distance, some);
        // Rounded are the depth and the quotient, by half an eps each.
        ASSERT_NEAR(inverse_w(depth, some) * distance, 1, 1.01 * double{FLT_EPSILON})
            << "distance / w at the depth " << shown(depth) << ", near " << shown(some.near)
            << "; seed 1, case " << i;
    }
    EXPECT_EQ(inverse_w(1, camera), 1) << "at the nearest distance, 1";
    EXPECT_EQ(inverse_w(DepthBuffer::cleared, camera), 0) << "where nothing is seen";
}

TEST(Toon, Eq7_12_IsZeroForPlanesAndMeasuresBends) {
    const ivec2 x(1, 0), y(0, 1);
    const auto plane = [](ivec2 p) { return static_cast<float>(100 + 7 * p.x - 3 * p.y); };
    EXPECT_EQ(second_difference(plane, x), 0) << "of the plane 100 + 7 x - 3 y";
    EXPECT_EQ(second_difference(plane, y), 0) << "of the plane 100 + 7 x - 3 y";
    const auto bowl = [](ivec2 p) { return static_cast<float>(5 * p.x * p.x + p.y); };
    EXPECT_EQ(second_difference(bowl, x), 10) << "of 5 x x + y, along x";
    EXPECT_EQ(second_difference(bowl, y), 0) << "of 5 x x + y, along y";
    // The rows beside count half as much.
    const auto one = [](ivec2 at) { return [=](ivec2 p) { return p == at ? 1.0f : 0.0f; }; };
    const char* what = ", where one pixel is 1 and all others are 0";
    EXPECT_EQ(second_difference(one({0, 0}), x), -1) << "along x" << what;
    EXPECT_EQ(second_difference(one({1, 0}), x), 0.5f) << "along x" << what;
    EXPECT_EQ(second_difference(one({1, 1}), x), 0.25f) << "along x" << what;
    EXPECT_EQ(second_difference(one({0, 1}), x), -0.5f) << "along x" << what;
    EXPECT_EQ(second_difference(one({0, 1}), y), 0.5f) << "along y" << what;
}

TEST(Toon, Eq7_13_IsTheDifferenceAtAnEdge) {
    const ivec2 x(1, 0), y(0, 1);
    const vec3 left(1, 0, 0), right(0, 0, 1);
    const auto edge = [&](ivec2 p) { return p.x <= 0 ? left : right; };
    EXPECT_EQ(sobel(edge, x), right - left)
        << "along x; left of an upright edge is (1, 0, 0), right of it (0, 0, 1)";
    EXPECT_EQ(sobel(edge, y), vec3(0)) << "along y, of an upright edge";
    EXPECT_FLOAT_EQ(glm::length(sobel(edge, x)), std::sqrt(2.0f));  // 2 sin(90 / 2)
    EXPECT_EQ(sobel([](ivec2) { return vec3(1, 2, 3); }, x), vec3(0)) << "of one color";
    const auto row = [&](ivec2 p) { return p.y < 0 ? left : right; };
    EXPECT_EQ(sobel(row, y), right - left)
        << "along y; above a level edge is (1, 0, 0), below it (0, 0, 1)";
    const auto one = [](ivec2 p) { return vec3(p == ivec2(1, -1) ? 1.0f : 0.0f); };
    EXPECT_EQ(sobel(one, x), vec3(0.25f)) << "along x; only the upper right neighbour is 1";
    EXPECT_EQ(sobel(one, y), vec3(-0.25f)) << "along y; only the upper right neighbour is 1";
}

TEST(Toon, Eq7_14_LinesAreAsWideAsAsked) {
    const ivec2 size(40, 30);
    for (const auto& [width, expected] :
         {std::pair{0.0f, 0}, {0.5f, 2}, {1.0f, 2}, {2.0f, 2}, {3.0f, 4}, {4.0f, 4}, {7.5f, 8}}) {
        // A step in depth; paper beside a body; a sharp edge.
        ByHand step = ByHand::of(size, [](ivec2 p) { return p.x < 17 ? 5.0f : 6.0f; });
        ByHand border = ByHand::of(
            size, [](ivec2 p) { return p.x < 17 ? 5.0f : std::numeric_limits<float>::infinity(); });
        ByHand fold = ByHand::of(size, [](ivec2) { return 5.0f; });
        for (ivec2 p(0); p.y < size.y; ++p.y)
            for (p.x = 17; p.x < size.x; ++p.x) fold.normals[p] = vec3(1, 0, 0);
        for (const auto& [what, picture] : {std::pair{"a step in depth from 5 to 6", &step},
                                            {"paper beside a body", &border},
                                            {"a fold of 90 degrees", &fold}}) {
            const Image<char> inked = picture->edges(width);
            ASSERT_EQ(ones(inked), expected * size.y)
                << "pixels inked in 40 x 30, " << what << " between columns 16 and 17, width "
                << width << ": a line of " << expected << " pixels";
            for (int y = 0; y < size.y; ++y)
                for (int x = 17 - expected / 2; x < 17 + expected / 2; ++x)
                    ASSERT_TRUE((inked[{x, y}])) << "ink in pixel (" << x << ", " << y << "), "
                                                 << what << ", width " << width;
        }
    }
}

TEST(Toon, Eq7_14_AThresholdIsAShareOfTheDistance) {
    const ivec2 size(12, 9);
    const auto step_of = [&](float farther) {
        return ByHand::of(size, [=](ivec2 p) { return p.x < 6 ? 10.0f : farther; });
    };
    // From 10 to 10.3: 3% nearer and farther.
    const char* what = "pixels inked in 12 x 9, at a step from w = 10 to a greater one, ";
    EXPECT_EQ(ones(step_of(10.3f).edges(2, {0.02f, 9})), 2 * size.y)
        << what << "10.3: 3% on either side; threshold 2%";
    EXPECT_EQ(ones(step_of(10.3f).edges(2, {0.04f, 9})), 0)
        << what << "10.3: 3% on either side; threshold 4%";
    // The worked examples; and between them a step that is above 2% only as seen from behind it.
    EXPECT_EQ(ones(step_of(10.5f).edges(2)), 2 * size.y) << what << "10.5; threshold 2%";
    EXPECT_EQ(ones(step_of(10.202f).edges(2)), size.y)
        << what << "10.202: above 2% of 10, not of 10.202";
    EXPECT_EQ(ones(step_of(10.1f).edges(2)), 0) << what << "10.1; threshold 2%";
    ByHand rows = ByHand::of(size, [](ivec2 p) { return p.y < 4 ? 10.0f : 10.5f; });
    EXPECT_EQ(ones(rows.edges(2)), 2 * size.x) << what << "10.5, below it; threshold 2%";
    // More than a threshold, not just as much: on a wall straight ahead nothing changes, and a fold
    // of 90 degrees changes by the root of 2.
    EXPECT_EQ(ones(step_of(10).edges(2, {0, 0})), 0) << "pixels inked on a wall, thresholds 0";
    const float root = std::sqrt(2.0f);
    for (const auto& [threshold, expected] :
         {std::pair{root, 0}, {std::nextafter(root, 0.0f), 2 * size.y}}) {
        ByHand fold = step_of(10);
        for (ivec2 p(0); p.y < size.y; ++p.y)
            for (p.x = 6; p.x < size.x; ++p.x) fold.normals[p] = vec3(1, 0, 0);
        EXPECT_EQ(ones(fold.edges(2, {9, threshold})), expected)
            << "pixels inked in 12 x 9, at a fold of 90 degrees; threshold " << shown(threshold);
    }
    // Normals 20 and 40 degrees apart: 0.35 and 0.68.
    for (const auto& [degrees, expected] : {std::pair{20.0f, 0}, {40.0f, 2 * size.y}}) {
        ByHand fold = step_of(10);
        for (ivec2 p(0); p.y < size.y; ++p.y)
            for (p.x = 6; p.x < size.x; ++p.x)
                fold.normals[p] = {std::sin(glm::radians(degrees)), 0,
                                   std::cos(glm::radians(degrees))};
        EXPECT_EQ(ones(fold.edges(2)), expected)
            << "pixels inked in 12 x 9, at a fold of " << degrees << " degrees";
    }
}

TEST(Toon, Eq7_14_NoEdgeOfACommonSolidIsOnTheThreshold) {
    // What a straight edge can leave of the difference of its normals: by which of the eight
    // neighbours lie beyond it, from one corner to four.
    const float parts[] = {std::sqrt(2.0f) / 4, std::sqrt(10.0f) / 4, 1, 3 * std::sqrt(2.0f) / 4,
                           std::sqrt(5.0f) / 2};
    std::vector<double> turns_degrees = {109.4712, 70.5288, 63.4349, 41.8103};  // regular solids
    for (const int sides : {3, 4, 5, 6, 7, 8, 9, 10, 12, 16, 18, 20, 24, 32, 48, 64})
        turns_degrees.push_back(360.0 / sides);  // prisms
    for (const double turn : turns_degrees)
        for (const float part : parts) {
            const double strength = part * 2 * std::sin(glm::radians(turn) / 2);
            EXPECT_GT(std::abs(strength - EdgeThresholds().normals), 0.01)
                << "a turn of " << turn << " degrees, of which there is " << part;
        }
}

TEST(Toon, Eq7_14_RoundingDecidesNothingAtBoxes) {
    // The three sides of a box around its corner, or two of them and nothing, however it is turned
    // and its edges run, a quarter of them at 45 degrees. Differences are quarters of the normals,
    // which stand at right angles: 16 times the square of a strength is a whole number.
    const ivec2 size(32, 24);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(-1, 1), degrees(0, 360);
    int inked = 0, on_quarter = 0;
    for (int i = 0; i < cases_of(2000); ++i) {
        const vec3 first = glm::normalize(vec3(any(random), any(random), any(random) + 1.01f));
        const vec3 second =
            glm::normalize(glm::cross(first, vec3(any(random), any(random) + 1.01f, any(random))));
        const vec3 sides[] = {first, second, glm::cross(first, second), vec3(0)};
        float angles[3];
        for (float& angle : angles) angle = glm::radians(degrees(random));
        if (i % 4 == 0)
            angles[1] = angles[0] = glm::radians(45.0f), angles[2] = glm::radians(225.0f);
        std::ranges::sort(angles);
        const vec2 middle = vec2(size) * 0.5f + 4.0f * vec2(any(random), any(random));
        const auto side_at = [&](ivec2 p) {
            const vec2 from_middle = vec2(p) + 0.5f - middle;
            float angle = std::atan2(from_middle.y, from_middle.x);
            if (angle < 0) angle += glm::radians(360.0f);
            const auto sector = std::ranges::upper_bound(angles, angle) - angles;
            return sector % 3 == 2 && i % 2 ? 3 : static_cast<int>(sector % 3);
        };
        ByHand box(size);
        Image<int> side_of(size);
        for (ivec2 p(0); p.y < size.y; ++p.y)
            for (p.x = 0; p.x < size.x; ++p.x) {
                side_of[p] = side_at(p);
                box.normals[p] = sides[side_of[p]];
            }
        EdgeThresholds of_normals;
        of_normals.depth = 9;
        const int reach = 1 + i % 3;
        const Image<char> found = box.edges(static_cast<float>(2 * reach), of_normals);
        for (ivec2 p(reach); p.y + reach < size.y; ++p.y)
            for (p.x = reach; p.x + reach < size.x; ++p.x) {
                int quarters[2][4] = {};  // of each side's normal, along x and along y
                for (int j = -1; j <= 1; ++j)
                    for (const int to : {-1, 1}) {
                        const int weight = to * (j == 0 ? 2 : 1);
                        quarters[0][side_of[p + reach * ivec2(to, j)]] += weight;
                        quarters[1][side_of[p + reach * ivec2(j, to)]] += weight;
                    }
                int squares = 0;
                for (const auto& along : quarters)
                    for (int side = 0; side < 3; ++side) squares += along[side] * along[side];
                // 16 * 0.45 * 0.45 is 3.24.
                ASSERT_EQ((found[p]) != 0, squares >= 4)
                    << "ink in pixel " << testing::PrintToString(p) << ", width " << 2 * reach
                    << ": 16 times the square of the change in normals is " << squares
                    << ", the threshold 3.24; a corner of a box in " << shown(middle)
                    << "; seed 1, case " << i;
                inked += squares >= 4;
                on_quarter += squares == 4;  // on a threshold of 0.5
            }
    }
    EXPECT_GT(inked, cases_of(100'000));
    EXPECT_GT(on_quarter, cases_of(1000));
}

TEST(Toon, Eq7_14_SlantedLines) {
    // An edge at 45 degrees: how many pixels of a row are inked, for each of `reach`.
    const ivec2 size(60, 40);
    for (const int reach : {1, 2, 3})
        for (const auto& [turn_degrees, per_row] :
             {std::pair{24.0f, 0}, {25.0f, 2}, {45.0f, 2}, {78.0f, 2}, {80.0f, 4}, {90.0f, 4}}) {
            ByHand fold(size);
            const vec3 turned(std::sin(glm::radians(turn_degrees)), 0,
                              std::cos(glm::radians(turn_degrees)));
            for (ivec2 p(0); p.y < size.y; ++p.y)
                for (p.x = 0; p.x < size.x; ++p.x)
                    if (p.x + p.y >= 50) fold.normals[p] = turned;
            const Image<char> inked = fold.edges(static_cast<float>(2 * reach));
            for (int y = reach; y < size.y - reach; ++y)
                for (int x = reach; x < size.x - reach; ++x)
                    ASSERT_EQ((inked[{x, y}]) != 0, std::abs(2 * (x + y) - 99) < per_row * reach)
                        << "ink in pixel (" << x << ", " << y << "), width " << 2 * reach
                        << ": a fold of " << turn_degrees
                        << " degrees along x + y = 49.5, inked for " << per_row * reach
                        << " pixels of a row";
        }
    // Depth: nothing or all of it; above 5.7% of the own distance.
    for (const auto& [distance, per_row] : {std::pair{10.5f, 0},
                                            {10.58f, 2},
                                            {10.65f, 4},
                                            {std::numeric_limits<float>::infinity(), 4}}) {
        const float farther = distance;
        ByHand step = ByHand::of(size, [=](ivec2 p) { return p.x + p.y < 50 ? 10.0f : farther; });
        std::ranges::fill(step.normals.pixels(), toward_eye);
        const Image<char> inked = step.edges(4);
        int in_row = 0;
        for (int x = 0; x < size.x; ++x) in_row += inked[{x, 22}];
        EXPECT_EQ(in_row, per_row * 2)
            << "pixels inked in a row, width 4, at a step from w = 10 to " << farther
            << " along x + y = 49.5";
    }
}

TEST(Toon, Eq7_14_TheUnitsOfTheSceneDoNotMatter) {
    // Where a square would be infinite or 0: the length is by std::hypot.
    for (const float unit : {1e-22f, 1e-18f, 1.0f, 1e18f, 1e22f})
        for (const auto& [farther, expected] : {std::pair{10.1f, 0}, {10.5f, 2}}) {
            ByHand step({12, 9});
            Camera of_unit = camera;
            of_unit.near *= unit, of_unit.far *= unit;
            for (ivec2 p(0); p.y < 9; ++p.y)
                for (p.x = 0; p.x < 12; ++p.x)
                    step.depth.test_and_write(
                        p, depth_at((p.x < 6 ? 10.0L : farther) * unit, of_unit));
            const CountedSince counters;
            draw_edges(step.depth, step.normals, of_unit, 2, {}, step.color);
            EXPECT_EQ(counters[Counter::outline_pixels], static_cast<std::uint64_t>(expected * 9))
                << "pixels inked at a step from w = 10 to " << farther << " units of " << unit;
        }
}

TEST(Toon, Eq7_14_PicturesThatAreTooSmall) {
    for (const ivec2 size : {ivec2(1, 1), ivec2(2, 40), ivec2(40, 2), ivec2(0, 0), ivec2(4, 4)}) {
        ByHand picture = ByHand::of(size, [](ivec2 p) { return (p.x + p.y) % 2 ? 5.0f : 50.0f; });
        ASSERT_EQ(ones(picture.edges(4)), 0)
            << "pixels inked in " << testing::PrintToString(size)
            << ", width 4: no pixel has neighbours 2 away on all sides";
        const CountedSince counters;
        draw_edges(picture.depth, picture.normals, camera, 4, {}, picture.color);
        ASSERT_EQ(counters[Counter::outline_tests], 0u)
            << "none of " << testing::PrintToString(size) << " pixels is asked";
    }
    ByHand least = ByHand::of({5, 5}, [](ivec2 p) { return p.x < 2 ? 5.0f : 50.0f; });
    EXPECT_GT(ones(least.edges(4)), 0);
}

TEST(Toon, HardCase_SteepPlanesHaveNoEdges) {
    look_up("Eq. 7.12");
    Scene floor = loaded("floor_checker.obj");
    int steep = 0, on_floor = 0;
    for (const float pitch : {0.5f, 1.0f, 2.0f, 5.0f, 20.0f, 90.0f})
        for (const float yaw : {0.0f, -30.0f}) {
            lesson_07::Options options = small_toon();
            options.size = {640, 360};
            options.orbit = {yaw, pitch, 0.3f, 36};
            options.shading.outline = Outline::none;
            const Image<Seen> bare = seen_in(toon_picture(floor, options));
            options.shading.outline = Outline::edges;
            options.shading.outline_width_px = 2;
            const Image<vec3> picture = toon_picture(floor, options);
            int inked = 0;
            for (ivec2 p(0); p.y < picture.size().y; ++p.y)
                for (p.x = 0; p.x < picture.size().x; ++p.x)
                    if (bare[p] == Seen::body && !is_near_paper(bare, p, 2)) {
                        ++on_floor;
                        inked += picture[p] == ink;
                    }
            ASSERT_EQ(inked, 0) << "pixels inked on a floor, with --pitch " << pitch << " --yaw "
                                << yaw;
        }
    EXPECT_GT(on_floor, 500'000);
    // The first difference would ink them: at such a grazing angle the next pixel is more than 2%
    // farther away.
    const auto inverse_w_at = [](ivec2 p) { return 1.0f / 50 + 0.001f * static_cast<float>(p.y); };
    const auto as_vector = [&](ivec2 p) { return vec3(inverse_w_at(p), 0, 0); };
    steep += sobel(as_vector, {0, 1}).x > 0.02f * inverse_w_at(ivec2(0));
    steep += second_difference(inverse_w_at, {0, 1}) > 0.02f * inverse_w_at(ivec2(0));
    EXPECT_EQ(steep, 1);
}

TEST(Toon, HardCase_EdgesAreAsWideAtAnyDistanceAndSize) {
    look_up("Eq. 7.14");
    const Scene cube = scene_of_one(cube_mesh(true));
    for (const ivec2 size : {ivec2(320, 180), ivec2(640, 360)})
        for (const float distance : {2.5f, 5.0f})
            for (const float width : {2.0f, 6.0f}) {
                lesson_07::Options options;
                options.size = size;
                options.orbit = {0, 0, distance, 36};  // one face, straight ahead
                options.shading.outline = Outline::none;
                const Image<Seen> bare = seen_in(toon_picture(cube, options));
                options.shading.outline = Outline::edges;
                options.shading.outline_width_px = width;
                const Image<Seen> seen = seen_in(toon_picture(cube, options));
                const double side = std::sqrt(count_of(bare, Seen::body));
                // A frame, half of it on either side; its outer corners may be cut off.
                const double frame =
                    (side + width) * (side + width) - (side - width) * (side - width);
                const std::string what = " of a square, width " + shown(width) + ", distance " +
                                         shown(distance) + ", " + testing::PrintToString(size) +
                                         " pixels";
                ASSERT_NEAR(count_of(seen, Seen::ink), frame, width * width + side / 20)
                    << "pixels inked around" << what;
                ASSERT_EQ(gaps_in_outline(seen), 0) << "gaps in the outline" << what;
            }
}
