// SPDX-License-Identifier: MIT
#include "01_bresenham_lines/line.hpp"

#include <climits>
#include <numeric>
#include <random>
#include <sstream>
#include <vector>

#include "common/image/bmp.hpp"
#include "common/image/image.hpp"
#include "support/ascii_picture.hpp"
#include "support/golden.hpp"
#include "support/look_up.hpp"

using namespace rasterbook;
using rasterbook::test::look_up, rasterbook::test::Pixels, rasterbook::test::same_pixels;

namespace {

/// The visited pixels in their order; also that each is inside and new.
std::vector<ivec2> walk(ivec2 a, ivec2 b, ivec2 size, LineEnd end = LineEnd::included) {
    std::vector<ivec2> pixels;
    bool all_inside = true;
    draw_line(a, b, size, end, [&](ivec2 pixel) {
        all_inside &= pixel.x >= 0 && pixel.y >= 0 && pixel.x < size.x && pixel.y < size.y;
        pixels.push_back(pixel);
    });
    EXPECT_TRUE(all_inside) << "visits pixels outside the picture";
    return pixels;
}

Pixels set_of(const std::vector<ivec2>& walked) {
    Pixels pixels;
    for (const ivec2 p : walked) EXPECT_TRUE(pixels.insert({p.x, p.y}).second) << "visited twice";
    return pixels;
}

/// The oracle shares nothing with the stage: for every column of the picture one exact rounding
/// (Eq. 1.2) of the ideal line. A tie stays on the side of the smaller end.
std::vector<ivec2> ideal(ivec2 a, ivec2 b, ivec2 size) {
    const bool steep = std::llabs(std::int64_t{b.x} - a.x) < std::llabs(std::int64_t{b.y} - a.y);
    std::int64_t u0 = steep ? a.y : a.x, v0 = steep ? a.x : a.y;
    std::int64_t u1 = steep ? b.y : b.x, v1 = steep ? b.x : b.y;
    if (u0 > u1) std::swap(u0, u1), std::swap(v0, v1);
    std::vector<ivec2> pixels;
    for (std::int64_t u = std::max<std::int64_t>(u0, 0);
         u <= std::min<std::int64_t>(u1, (steep ? size.y : size.x) - 1); ++u) {
        const int128 run = std::max<std::int64_t>(u1 - u0, 1), rise = int128{u - u0} * (v1 - v0);
        const int128 whole = rise / run, rest = rise % run;
        const int128 v = v0 + whole + (2 * rest > run) - (2 * rest < -run);
        if (v < 0 || v >= (steep ? size.x : size.y)) continue;
        const auto row = static_cast<int>(v), column = static_cast<int>(u);
        pixels.push_back(steep ? ivec2(row, column) : ivec2(column, row));
    }
    return pixels;
}

std::string name(ivec2 a, ivec2 b) {
    std::ostringstream text;
    text << '(' << a.x << ", " << a.y << ") -> (" << b.x << ", " << b.y << ')';
    return text.str();
}

/// The line's ends, and the pixels visited beside the ideal ones as a picture.
std::string compared(ivec2 a, ivec2 b, ivec2 size) {
    return name(a, b) + "; " +
           test::ascii_difference(set_of(walk(a, b, size)), set_of(ideal(a, b, size)));
}

void expect_ideal(ivec2 a, ivec2 b, ivec2 size) {
    const auto expected = ideal(a, b, size);
    EXPECT_EQ(walk(a, b, size), expected) << compared(a, b, size);
    EXPECT_EQ(walk(b, a, size), expected) << compared(b, a, size);  // Eq. 1.6
}

}  // namespace

TEST(Lines, Eq1_1_IdealRiseOfTheWorkedExample) {
    // Rows 0, 0.4, 0.8, 1.2, 1.6, 2: within half a row of the rows drawn.
    const auto pixels = walk({0, 0}, {5, 2}, {8, 8});
    ASSERT_EQ(pixels.size(), 6u);
    for (int k = 0; k <= 5; ++k)
        EXPECT_LE(std::abs(k * 2.0 / 5.0 - pixels[static_cast<std::size_t>(k)].y), 0.5);
}

TEST(Lines, Eq1_2_TieStaysInTheRowOfTheWalk) {
    EXPECT_EQ(walk({0, 0}, {2, 1}, {8, 8}), (std::vector<ivec2>{{0, 0}, {1, 0}, {2, 1}}));
    EXPECT_EQ(walk({0, 1}, {2, 0}, {8, 8}), (std::vector<ivec2>{{0, 1}, {1, 1}, {2, 0}}));
}

TEST(Lines, Eq1_3_RowsOfTheWorkedExample) {
    const LineSteps line({0, 0}, {5, 2});
    const std::vector<std::int64_t> rows = {0, 0, 1, 1, 2, 2};
    for (int k = 0; k <= 5; ++k)
        EXPECT_EQ(line.rows_after(k), rows[static_cast<std::size_t>(k)]) << "step " << k;
}

TEST(Lines, Eq1_4_ContinuesInsideThePictureAsTheWholeLine) {
    // The picture starts at step 3 of the worked example, in the middle of a row.
    EXPECT_EQ(walk({-3, 0}, {2, 2}, {8, 8}), (std::vector<ivec2>{{0, 1}, {1, 2}, {2, 2}}));
}

TEST(Lines, Eq1_5_WorkedExampleOfTheText) {
    EXPECT_EQ(walk({0, 0}, {5, 2}, {8, 8}),
              (std::vector<ivec2>{{0, 0}, {1, 0}, {2, 1}, {3, 1}, {4, 2}, {5, 2}}));
}

TEST(Lines, Eq1_6_BothDirectionsVisitTheSamePixels) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> coordinate(-300, 300);
    std::size_t visited = 0;
    for (int i = 0; i < 10'000; ++i) {
        const ivec2 a(coordinate(random), coordinate(random)),
            b(coordinate(random), coordinate(random));
        ASSERT_EQ(walk(a, b, {200, 100}), walk(b, a, {200, 100})) << name(a, b);
        visited += walk(a, b, {200, 100}).size();
    }
    EXPECT_GT(visited, 100'000u);
}

TEST(Lines, Eq1_7_FirstStepOfEachRowOfTheWorkedExample) {
    const LineSteps line({0, 0}, {5, 2});
    EXPECT_EQ(line.first_step_with(0), 0);
    EXPECT_EQ(line.first_step_with(1), 2);
    EXPECT_EQ(line.first_step_with(2), 4);
    EXPECT_EQ(line.first_step_with(3), 6) << "past the last step: the line never gets there";
}

TEST(Lines, Eq1_8_StepsInsideOfALineThatCrossesThePicture) {
    // From (-4, -2) to (16, 8): row 0 from step 4 on, row 5 (outside) from step 14 on.
    const StepRange steps = steps_inside(LineSteps({-4, -2}, {16, 8}), {100, 5}, LineEnd::included);
    EXPECT_EQ(steps.first, 4);
    EXPECT_EQ(steps.last, 13);
    const StepRange falling =
        steps_inside(LineSteps({-4, 6}, {16, -4}), {100, 5}, LineEnd::included);
    EXPECT_EQ(falling.first, 4);
    EXPECT_EQ(falling.last, 13);
}

TEST(Lines, Eq1_9_BmpRowsAreFilledToAMultipleOfFour) {
    EXPECT_EQ(bmp_row_padding(1), 1u);
    EXPECT_EQ(bmp_row_padding(2), 2u);
    EXPECT_EQ(bmp_row_padding(3), 3u);
    EXPECT_EQ(bmp_row_padding(4), 0u);
    EXPECT_EQ(bmp_row_padding(1280), 0u);
}

TEST(Lines, ExhaustiveAllLinesOfASmallGridAreIdeal) {
    look_up("Eq. 1.2 for which row it is, Eq. 1.5 for how to get there");
    constexpr int side = 33;
    int lines = 0;
    for (int i = 0; i < side * side; ++i)
        for (int j = 0; j < side * side; ++j, ++lines) {
            const ivec2 a(i % side, i / side), b(j % side, j / side);
            const auto pixels = walk(a, b, {side, side});
            ASSERT_EQ(pixels, ideal(a, b, {side, side})) << compared(a, b, {side, side});
            ASSERT_EQ(pixels.size(), static_cast<std::size_t>(
                                         std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)) + 1));
        }
    EXPECT_EQ(lines, 1'185'921);
}

TEST(Lines, ExhaustiveAllLinesAroundASmallPictureAreTheWholeLinesPixels) {
    look_up("Eq. 1.8 for which steps are inside, Eq. 1.7 for where rows begin");
    // Ends on a 13 x 13 grid, the picture its middle 5 x 4 pixels: every way in and out.
    constexpr int side = 13;
    for (int i = 0; i < side * side; ++i)
        for (int j = 0; j < side * side; ++j) {
            const ivec2 a(i % side - 4, i / side - 4), b(j % side - 4, j / side - 4);
            ASSERT_EQ(walk(a, b, {5, 4}), ideal(a, b, {5, 4})) << compared(a, b, {5, 4});
        }
}

TEST(Lines, PixelsAreConnectedAndWithinHalfAPixel) {
    look_up("Eq. 1.5");
    std::mt19937 random(2);
    std::uniform_int_distribution<int> coordinate(0, 999);
    for (int i = 0; i < 2'000; ++i) {
        const ivec2 a(coordinate(random), coordinate(random)),
            b(coordinate(random), coordinate(random));
        const auto pixels = walk(a, b, {1000, 1000});
        const std::int64_t dx = b.x - a.x, dy = b.y - a.y,
                           longer = std::max(std::abs(dx), std::abs(dy));
        ASSERT_EQ(pixels.size(), static_cast<std::size_t>(longer + 1)) << name(a, b);
        for (std::size_t k = 0; k < pixels.size(); ++k) {
            // |cross product| / longer = distance along the shorter axis
            const std::int64_t cross = dx * (pixels[k].y - a.y) - dy * (pixels[k].x - a.x);
            ASSERT_LE(2 * std::abs(cross), longer) << name(a, b);
            if (k > 0) {
                const ivec2 step = glm::abs(pixels[k] - pixels[k - 1]);
                ASSERT_EQ(std::max(step.x, step.y), 1) << name(a, b);
            }
        }
    }
}

TEST(Lines, HardCase_ZeroLengthIsOnePixel) {
    look_up("Eq. 1.8: a line of no length is step 0 alone");
    EXPECT_EQ(walk({3, 2}, {3, 2}, {8, 8}), (std::vector<ivec2>{{3, 2}}));
    EXPECT_TRUE(walk({-1, 2}, {-1, 2}, {8, 8}).empty());
}

TEST(Lines, HardCase_AllOctants) {
    look_up("Eq. 1.6 and the table of the three changes before it");
    for (const ivec2 b :
         {ivec2(9, 4), {4, 9}, {-4, 9}, {-9, 4}, {-9, -4}, {-4, -9}, {4, -9}, {9, -4}})
        expect_ideal({10, 10}, ivec2(10, 10) + b, {21, 21});
}

TEST(Lines, HardCase_SlopeExactlyOne) {
    look_up("Eq. 1.5, with both lengths equal");
    for (const ivec2 b : {ivec2(7, 7), {-7, 7}, {7, -7}, {-7, -7}}) {
        const auto pixels = walk({8, 8}, ivec2(8, 8) + b, {16, 16});
        ASSERT_EQ(pixels.size(), 8u);
        for (const ivec2 p : pixels) EXPECT_EQ(std::abs(p.x - 8), std::abs(p.y - 8));
    }
}

TEST(Lines, HardCase_HorizontalAndVertical) {
    look_up("the table of the three changes before Eq. 1.6");
    for (const ivec2 b : {ivec2(7, 0), {-7, 0}, {0, 7}, {0, -7}})
        expect_ideal({8, 8}, ivec2(8, 8) + b, {16, 16});
}

TEST(Lines, HardCase_EndsFarOutsideMatchTheWholeLine) {
    look_up("Eq. 1.7, 1.8, and how large the numbers get");
    for (const auto& [a, b] :
         std::vector<std::pair<ivec2, ivec2>>{{{262, 23}, {91618510, -54756195}},
                                              {{263, 214}, {80120779, 11846827}},
                                              {{1, 1}, {2000000000, 1000000000}},
                                              {{INT_MIN, INT_MIN}, {INT_MAX, INT_MAX}},
                                              {{INT_MIN, INT_MAX}, {INT_MAX, INT_MIN}},
                                              {{INT_MIN, 100}, {INT_MAX, 101}},
                                              {{100, INT_MAX}, {101, INT_MIN}},
                                              {{INT_MIN, INT_MIN}, {INT_MIN, INT_MAX}},
                                              {{INT_MAX, INT_MAX}, {INT_MAX, INT_MAX}},
                                              {{INT_MIN, 0}, {479, 359}},
                                              {{-5, -5}, {-1, -9}},
                                              {{-1, 360}, {480, -1}}})
        expect_ideal(a, b, {480, 360});
}

TEST(Lines, HardCase_RandomEndsOfAnySizeMatchTheWholeLine) {
    look_up("Eq. 1.7, 1.8, and how large the numbers get");
    std::mt19937 random(3);
    std::uniform_int_distribution<int> bits(1, 31);
    const auto coordinate = [&] { return static_cast<int>(random()) >> bits(random); };
    for (int i = 0; i < 5'000; ++i)
        expect_ideal({coordinate(), coordinate()}, {coordinate(), coordinate()}, {48, 36});
}

TEST(Lines, HardCase_EmptyPictureVisitsNothing) {
    look_up("Eq. 1.8: no step is inside");
    EXPECT_TRUE(walk({-5, -5}, {5, 5}, {0, 0}).empty());
    EXPECT_TRUE(walk({-5, -5}, {5, 5}, {0, 4}).empty());
    EXPECT_TRUE(walk({-5, -5}, {5, 5}, {4, 0}).empty());
}

TEST(Lines, ExcludedEndLeavesOutThatPixelAndNoOther) {
    look_up("Chains of lines");
    for (const ivec2 b :
         {ivec2(9, 4), {4, 9}, {-4, 9}, {-9, 4}, {-9, -4}, {-4, -9}, {4, -9}, {9, -4}, {0, 0}}) {
        const ivec2 a(10, 10), end = a + b;
        Pixels expected = set_of(walk(a, end, {21, 21}));
        EXPECT_EQ(expected.erase({end.x, end.y}), 1u) << name(a, end);
        EXPECT_TRUE(same_pixels(set_of(walk(a, end, {21, 21}, LineEnd::excluded)), expected))
            << name(a, end);
    }
}

TEST(Lines, HardCase_ExcludedEndOutsideThePictureTakesNoPixelAway) {
    look_up("Chains of lines");
    EXPECT_EQ(walk({0, 0}, {9, 3}, {5, 5}, LineEnd::excluded), walk({0, 0}, {9, 3}, {5, 5}));
    EXPECT_EQ(walk({9, 3}, {0, 0}, {5, 5}, LineEnd::excluded).size(),
              walk({9, 3}, {0, 0}, {5, 5}).size() - 1);
    EXPECT_EQ(walk({2, 2}, {-9, -3}, {5, 5}, LineEnd::excluded), walk({2, 2}, {-9, -3}, {5, 5}));
}

TEST(Lines, HardCase_PolylineDrawnAdditivelyCountsEachJointOnce) {
    look_up("Chains of lines");
    // A closed zigzag without crossings: every pixel of it is counted exactly once.
    const std::vector<ivec2> vertices = {{2, 2},   {20, 5},  {38, 2}, {35, 20},
                                         {38, 38}, {20, 35}, {2, 38}, {5, 20}};
    Image<int> hits({41, 41});
    for (std::size_t i = 0; i < vertices.size(); ++i)
        draw_line(vertices[i], vertices[(i + 1) % vertices.size()], hits.size(), LineEnd::excluded,
                  [&](ivec2 p) { ++hits[p]; });
    for (const ivec2 vertex : vertices) EXPECT_EQ(hits[vertex], 1);
    for (const int count : hits.pixels()) EXPECT_LE(count, 1);
}

TEST(Lines, PictureOfTheLesson) {
    EXPECT_TRUE(test::equals_golden("01_bresenham_lines", "01_bresenham_lines"));
}
