// SPDX-License-Identifier: MIT
// Edge detection in depth and normals: on pictures made by hand, and on planes of any slope.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <tuple>
#include <utility>

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
constexpr vec3 toward_eye(0, 0, 1), to_the_right(1, 0, 0);
constexpr ivec2 along_x(1, 0), along_y(0, 1);
constexpr float nowhere = std::numeric_limits<float>::infinity();

/// A direction that is turned from the eye's to the right.
vec3 turned(float degrees) {
    return {std::sin(glm::radians(degrees)), 0, std::cos(glm::radians(degrees))};
}

/// A picture made by hand: distances and normals.
struct ByHand {
    DepthBuffer depth;
    Image<vec3> normals, color;

    explicit ByHand(ivec2 size) : depth(size), normals(size, toward_eye), color(size, vec3(1)) {}

    /// @param distance_at  Called as distance_at(pixel); infinite: nothing is there.
    template <typename DistanceAt>
    static ByHand of(ivec2 size, DistanceAt&& distance_at) {
        ByHand picture(size);
        picture.each([&](ivec2 p) {
            const float distance = distance_at(p);
            if (std::isinf(distance))
                picture.normals[p] = vec3(0);
            else
                picture.depth.test_and_write(p, camera.near / distance);
        });
        return picture;
    }

    /// All at a distance of 10, with one normal up to an edge and another one beyond it.
    ///
    /// @param is_beyond  Called as is_beyond(pixel).
    template <typename IsBeyond>
    static ByHand fold(ivec2 size, vec3 beyond, IsBeyond&& is_beyond) {
        ByHand picture = of(size, [](ivec2) { return 10.0f; });
        picture.each([&](ivec2 p) {
            if (is_beyond(p)) picture.normals[p] = beyond;
        });
        return picture;
    }

    /// Calls visit(pixel) for each pixel.
    template <typename Visit>
    void each(Visit&& visit) const {
        for (ivec2 p(0); p.y < color.size().y; ++p.y)
            for (p.x = 0; p.x < color.size().x; ++p.x) visit(p);
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

TEST(Toon, Eq7_11_ExampleOfADepth) {
    const Camera near_2{vec3(0), mat4(1), 1, 2};
    EXPECT_EQ(inverse_w(0.5f, near_2), 0.25f) << "near 2, at a distance of 4";
    EXPECT_EQ(inverse_w(1, camera), 1) << "at the nearest distance, 1";
    EXPECT_EQ(inverse_w(DepthBuffer::cleared, near_2), 0) << "where nothing is seen";
}

TEST(Toon, Eq7_12_ExampleOfAFloorAndAStep) {
    const auto bend_of = [&](auto&& of_column, int column) {
        return second_difference([&](ivec2 p) { return of_column(column + p.x); }, along_x);
    };
    // Eight pixels of a floor, from w = 1 to w = 3.
    const auto inverse_w_at = [](int i) { return 1 - static_cast<float>(i) / 12; };
    for (int i = 1; i < 8; ++i)
        ASSERT_NEAR(bend_of(inverse_w_at, i), 0, 4 * FLT_EPSILON)
            << "second_difference() of 1/w, which falls evenly by 1/12 a pixel; pixel " << i;
    const auto distance_at = [&](int i) { return 1 / inverse_w_at(i); };
    EXPECT_NEAR(bend_of(distance_at, 3), 0.033, 0.0005) << "of w itself";
    // A step from w = 10 to w = 10.5.
    const auto step = [](int i) { return i < 4 ? 0.1f : 1 / 10.5f; };
    EXPECT_NEAR(bend_of(step, 3), -0.00476, 0.000005) << "of 0.1, 0.1, 0.09524";
    EXPECT_NEAR(bend_of(step, 4), 0.00476, 0.000005) << "of 0.1, 0.09524, 0.09524";
}

TEST(Toon, Eq7_12_IsZeroForPlanesAndMeasuresBends) {
    const auto plane = [](ivec2 p) { return static_cast<float>(100 + 7 * p.x - 3 * p.y); };
    EXPECT_EQ(second_difference(plane, along_x), 0) << "of the plane 100 + 7 x - 3 y";
    EXPECT_EQ(second_difference(plane, along_y), 0) << "of the plane 100 + 7 x - 3 y";
    // The rows beside count half as much.
    const auto one = [](ivec2 at) { return [=](ivec2 p) { return p == at ? 1.0f : 0.0f; }; };
    const char* what = ", where one pixel is 1 and all others are 0";
    EXPECT_EQ(second_difference(one({0, 0}), along_x), -1) << "along x" << what;
    EXPECT_EQ(second_difference(one({1, 0}), along_x), 0.5f) << "along x" << what;
    EXPECT_EQ(second_difference(one({1, 1}), along_x), 0.25f) << "along x" << what;
    EXPECT_EQ(second_difference(one({0, 1}), along_x), -0.5f) << "along x" << what;
    EXPECT_EQ(second_difference(one({0, 1}), along_y), 0.5f) << "along y" << what;
}

TEST(Toon, Eq7_13_IsTheDifferenceAtAnEdge) {
    const auto edge = [&](ivec2 p) { return p.x <= 0 ? toward_eye : to_the_right; };
    EXPECT_EQ(sobel(edge, along_x), vec3(1, 0, -1))
        << "along x; left of an upright edge is (0, 0, 1), right of it (1, 0, 0)";
    EXPECT_EQ(sobel(edge, along_y), vec3(0)) << "along y, of an upright edge";
    const auto row = [&](ivec2 p) { return p.y < 0 ? toward_eye : to_the_right; };
    EXPECT_EQ(sobel(row, along_y), vec3(1, 0, -1))
        << "along y; above a level edge is (0, 0, 1), below it (1, 0, 0)";
    const auto one = [](ivec2 p) { return vec3(p == ivec2(1, -1) ? 1.0f : 0.0f); };
    EXPECT_EQ(sobel(one, along_x), vec3(0.25f)) << "along x; only the upper right neighbour is 1";
    EXPECT_EQ(sobel(one, along_y), vec3(-0.25f)) << "along y; only the upper right neighbour is 1";
}

TEST(Toon, Eq7_14_LinesAreAsWideAsAsked) {
    const ivec2 size(40, 30);
    for (const auto& [width, expected] :
         {std::pair{0.0f, 0}, {0.5f, 2}, {1.0f, 2}, {2.0f, 2}, {3.0f, 4}, {4.0f, 4}, {7.5f, 8}}) {
        ByHand step = ByHand::of(size, [](ivec2 p) { return p.x < 17 ? 5.0f : 6.0f; });
        ByHand border = ByHand::of(size, [](ivec2 p) { return p.x < 17 ? 5.0f : nowhere; });
        ByHand fold = ByHand::fold(size, to_the_right, [](ivec2 p) { return p.x >= 17; });
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
    const auto ink_at_step_to = [&](float farther, const EdgeThresholds& thresholds = {}) {
        ByHand step = ByHand::of(size, [=](ivec2 p) { return p.x < 6 ? 10.0f : farther; });
        return ones(step.edges(2, thresholds));
    };
    const char* what = "pixels inked in 12 x 9, at a step from w = 10 to a greater one, ";
    EXPECT_EQ(ink_at_step_to(10.3f, {0.02f, 9}), 2 * size.y)
        << what << "10.3: 3% on either side; threshold 2%";
    EXPECT_EQ(ink_at_step_to(10.3f, {0.04f, 9}), 0)
        << what << "10.3: 3% on either side; threshold 4%";
    // The worked examples; and between them a step that is above 2% only as seen from behind it.
    EXPECT_EQ(ink_at_step_to(10.5f), 2 * size.y) << what << "10.5; threshold 2%";
    EXPECT_EQ(ink_at_step_to(10.202f), size.y) << what << "10.202: above 2% of 10, not of 10.202";
    EXPECT_EQ(ink_at_step_to(10.1f), 0) << what << "10.1; threshold 2%";
    EXPECT_EQ(ink_at_step_to(10, {0, 0}), 0) << "pixels inked on a wall, thresholds 0";
    ByHand rows = ByHand::of(size, [](ivec2 p) { return p.y < 4 ? 10.0f : 10.5f; });
    EXPECT_EQ(ones(rows.edges(2)), 2 * size.x) << what << "10.5, below it; threshold 2%";
    // Normals 20 and 40 degrees apart: 0.35 and 0.68. For 90 degrees it is the root of 2, which has
    // to be more than the threshold, not just as much.
    const float root = std::sqrt(2.0f), at_least = EdgeThresholds().normals;
    for (const auto& [normal, threshold, is_edge] :
         {std::tuple{turned(20), at_least, false},
          {turned(40), at_least, true},
          {to_the_right, root, false},
          {to_the_right, std::nextafter(root, 0.0f), true}}) {
        ByHand fold = ByHand::fold(size, normal, [](ivec2 p) { return p.x >= 6; });
        EXPECT_EQ(ones(fold.edges(2, {9, threshold})), is_edge ? 2 * size.y : 0)
            << "pixels inked in 12 x 9, at a fold from (0, 0, 1) to " << shown(normal)
            << "; threshold " << shown(threshold);
    }
}

TEST(Toon, Eq7_14_RoundingDecidesNothingAtBoxes) {
    // Pixels of a box's three sides, or of nothing, in any order. Differences are quarters of the
    // normals, which stand at right angles: 16 times the square of a strength is a whole number.
    const ivec2 size(16, 12);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(-1, 1);
    for (int i = 0; i < cases_of(1000); ++i) {
        const vec3 first = glm::normalize(vec3(any(random), any(random), any(random) + 1.01f));
        const vec3 second =
            glm::normalize(glm::cross(first, vec3(any(random), any(random) + 1.01f, any(random))));
        const vec3 sides[] = {first, second, glm::cross(first, second), vec3(0)};
        ByHand box(size);
        Image<int> side_of(size);
        box.each([&](ivec2 p) {
            side_of[p] = random() % 8 == 0 ? static_cast<int>(random() % 4) : i % 4;
            box.normals[p] = sides[side_of[p]];
        });
        const int reach = 1 + i % 3;
        const Image<char> found =
            box.edges(static_cast<float>(2 * reach), {9, EdgeThresholds().normals});
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
                ASSERT_EQ((found[p]) != 0, squares >= 4)
                    << "ink in pixel " << testing::PrintToString(p) << ", width " << 2 * reach
                    << ": 16 times the square of the change in normals is " << squares
                    << ", the threshold 16 * 0.45 * 0.45 = 3.24; seed 1, case " << i;
            }
    }
}

TEST(Toon, Eq7_14_SlantedLines) {
    const ivec2 size(60, 40);
    // An edge at 45 degrees: nothing or all of it; above 5.7% of the own distance.
    for (const auto& [distance, per_row] :
         {std::pair{10.5f, 0}, {10.58f, 2}, {10.65f, 4}, {nowhere, 4}}) {
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
    for (const float unit : {1e-22f, 1e22f})
        for (const auto& [farther, expected] : {std::pair{10.1f, 0}, {10.5f, 2}}) {
            const float beyond = farther;
            ByHand step = ByHand::of({12, 9}, [=](ivec2 p) { return p.x < 6 ? 10.0f : beyond; });
            Camera of_unit = camera;
            of_unit.near *= unit, of_unit.far *= unit;
            const CountedSince counters;
            draw_edges(step.depth, step.normals, of_unit, 2, {}, step.color);
            EXPECT_EQ(counters[Counter::outline_pixels], static_cast<std::uint64_t>(expected * 9))
                << "pixels inked at a step from w = 10 to " << farther << " units of " << unit;
        }
}

TEST(Toon, Eq7_14_PicturesThatAreTooSmall) {
    const auto striped = [](ivec2 p) { return (p.x + p.y) % 2 ? 5.0f : 50.0f; };
    for (const ivec2 size : {ivec2(1, 1), ivec2(2, 40), ivec2(40, 2), ivec2(0, 0), ivec2(4, 4)}) {
        ByHand picture = ByHand::of(size, striped);
        const CountedSince counters;
        ASSERT_EQ(ones(picture.edges(4)), 0)
            << "pixels inked in " << testing::PrintToString(size)
            << ", width 4: no pixel has neighbours 2 away on all sides";
        ASSERT_EQ(counters[Counter::outline_tests], 0u)
            << "none of " << testing::PrintToString(size) << " pixels is asked";
    }
    ByHand least = ByHand::of({5, 5}, [](ivec2 p) { return p.x < 2 ? 5.0f : 50.0f; });
    EXPECT_GT(ones(least.edges(4)), 0) << "pixels inked in 5 x 5, width 4";
}

TEST(Toon, HardCase_SteepPlanesHaveNoEdges) {
    look_up("Eq. 7.12");
    const Scene floor = loaded("floor_checker.obj");
    int on_floor = 0;
    for (const float pitch : {0.5f, 1.0f, 2.0f, 5.0f, 20.0f, 90.0f}) {
        lesson_07::Options options = small_toon();
        options.size = {640, 360};
        options.orbit = {-30, pitch, 0.3f, 36};
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
        ASSERT_EQ(inked, 0) << "pixels inked on a floor, with --pitch " << pitch;
    }
    EXPECT_GT(on_floor, 250'000);
}

TEST(Toon, HardCase_SmallBallsAreInkAllOver) {
    look_up("Eq. 7.14, small round bodies");
    // Balls in orthographic projection, of radius R pixels, with lines of 2 r pixels.
    for (const float r : {1.0f, 2.0f, 3.0f})
        for (const auto& [radius_over_r, is_all_ink] : {std::pair{6.2f, true}, {6.35f, false}}) {
            const float radius = radius_over_r * r;
            const ivec2 middle(30);
            ByHand ball(ivec2(61));
            ball.each([&](ivec2 p) {
                const vec2 n = vec2(p - middle) / radius;
                const float rest = 1 - glm::dot(n, n);
                ball.normals[p] = rest < 0 ? vec3(0) : vec3(n, std::sqrt(rest));
                if (rest >= 0) ball.depth.test_and_write(p, 0.5f);
            });
            const Image<char> inked = ball.edges(2 * r);
            int bare = 0;
            ball.each([&](ivec2 p) { bare += ball.normals[p] != vec3(0) && !inked[p]; });
            ASSERT_EQ(bare == 0, is_all_ink)
                << "whether a ball of radius " << radius << " is all ink, lines of " << 2 * r
                << " pixels; without ink: " << bare;
            ASSERT_EQ(inked[middle] != 0, is_all_ink)
                << "whether the middle of a ball of radius " << radius << " is ink, lines of "
                << 2 * r << " pixels";
        }
}
