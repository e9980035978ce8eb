// SPDX-License-Identifier: MIT
#include "01_bresenham_lines/line.hpp"

#include <algorithm>
#include <climits>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/image/bmp.hpp"
#include "common/image/image.hpp"
#include "support/ascii_picture.hpp"
#include "support/golden.hpp"
#include "support/look_up.hpp"

using namespace rasterbook;
using rasterbook::test::look_up, rasterbook::test::Pixels, rasterbook::test::same_pixels;

namespace {

std::string name(ivec2 a, ivec2 b) {
    return "the line " + testing::PrintToString(a) + " -> " + testing::PrintToString(b);
}

/// The visited pixels in their order.
std::vector<ivec2> walk(ivec2 a, ivec2 b, ivec2 size, LineEnd end = LineEnd::included) {
    std::vector<ivec2> pixels;
    // No line has more pixels in a picture; of one that does not end, no more have to be seen.
    const auto most = static_cast<std::size_t>(4 * std::max({size.x, size.y, 1}));
    draw_line(a, b, size, end, [&](ivec2 pixel) {
        pixels.push_back(pixel);
        if (pixels.size() > most)
            throw std::runtime_error(name(a, b) + " visits more than " + std::to_string(most) +
                                     " pixels; the last is " + testing::PrintToString(pixel));
    });
    return pixels;
}

Pixels set_of(const std::vector<ivec2>& walked) {
    Pixels pixels;
    for (const ivec2 p : walked) pixels.insert({p.x, p.y});
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

/// For EXPECT_TRUE: visits the ideal pixels, each once and in their order.
testing::AssertionResult is_ideal(ivec2 a, ivec2 b, ivec2 size) {
    const std::vector<ivec2> actual = walk(a, b, size), expected = ideal(a, b, size);
    if (actual == expected) return testing::AssertionSuccess();
    testing::AssertionResult result = testing::AssertionFailure();
    result << name(a, b) << " in a picture of " << size.x << " x " << size.y << " pixels visits "
           << actual.size() << ", expected " << expected.size();
    const auto [yours, other] = std::ranges::mismatch(actual, expected);
    if (yours != actual.end() && other != expected.end())
        result << "; number " << yours - actual.begin() + 1 << " of them is "
               << testing::PrintToString(*yours) << ", expected " << testing::PrintToString(*other);
    return result << "\n" << test::ascii_difference(set_of(actual), set_of(expected));
}

constexpr ivec2 size(21), middle(10);
/// One in each octant, and those on their borders.
constexpr ivec2 ways[] = {{9, 4}, {4, 9},  {-4, 9}, {-9, 4},  {-9, -4}, {-4, -9}, {4, -9}, {9, -4},
                          {7, 7}, {-7, 7}, {7, -7}, {-7, -7}, {7, 0},   {-7, 0},  {0, 7},  {0, -7}};

}  // namespace

TEST(Lines, Eq1_1_IdealRiseOfTheWorkedExample) {
    // Rows 0, 0.4, 0.8, 1.2, 1.6, 2: within half a row of the rows drawn.
    const auto pixels = walk({0, 0}, {5, 2}, {8, 8});
    ASSERT_EQ(pixels.size(), 6u) << "pixels of the line (0, 0) -> (5, 2), one in each column: "
                                 << testing::PrintToString(pixels);
    for (int k = 0; k <= 5; ++k)
        ASSERT_NEAR(pixels[static_cast<std::size_t>(k)].y, k * 2.0 / 5.0, 0.5)
            << "the row of step " << k << " of the line (0, 0) -> (5, 2), and the ideal rise; "
            << "visited: " << testing::PrintToString(pixels);
}

TEST(Lines, Eq1_2_TieStaysInTheRowOfTheWalk) {
    EXPECT_EQ(walk({0, 0}, {2, 1}, {8, 8}), (std::vector<ivec2>{{0, 0}, {1, 0}, {2, 1}}));
    EXPECT_EQ(walk({0, 1}, {2, 0}, {8, 8}), (std::vector<ivec2>{{0, 1}, {1, 1}, {2, 0}}))
        << "a line that rises: the tie stays in the row of the end with the smaller x";
}

TEST(Lines, Eq1_3_RowsOfTheWorkedExample) {
    const LineSteps line({0, 0}, {5, 2}), with_tie({0, 0}, {2, 1});
    EXPECT_EQ(line.major_length, 5) << "of the line (0, 0) -> (5, 2)";
    EXPECT_EQ(line.minor_length, 2) << "of the line (0, 0) -> (5, 2)";
    constexpr std::int64_t rows[] = {0, 0, 1, 1, 2, 2};
    for (int step = 0; step <= 5; ++step)
        EXPECT_EQ(line.rows_after(step), rows[step])
            << "rows_after(" << step << ") of the line (0, 0) -> (5, 2)";
    EXPECT_EQ(with_tie.rows_after(1), 0)
        << "rows_after(1) of the line (0, 0) -> (2, 1): a tie, which stays; mind the -1";
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
    for (const ivec2 way : ways) {
        const auto there = walk(middle, middle + way, size),
                   back = walk(middle + way, middle, size);
        EXPECT_TRUE(is_ideal(middle, middle + way, size));
        EXPECT_EQ(back, there) << name(middle + way, middle)
                               << " visits other pixels than the other way, or in another order "
                                  "(always towards larger major coordinates)\n"
                               << test::ascii_difference(set_of(back), set_of(there));
    }
}

TEST(Lines, Eq1_7_FirstStepOfEachRowOfTheWorkedExample) {
    const LineSteps line({0, 0}, {5, 2});
    EXPECT_EQ(line.first_step_with(0), 0) << "of the line (0, 0) -> (5, 2)";
    EXPECT_EQ(line.first_step_with(1), 2) << "of the line (0, 0) -> (5, 2)";
    EXPECT_EQ(line.first_step_with(2), 4) << "of the line (0, 0) -> (5, 2)";
    EXPECT_EQ(line.first_step_with(3), 6) << "past the last step: the line never gets there";
}

TEST(Lines, Eq1_8_StepsInsideOfALineThatCrossesThePicture) {
    // From (-4, -2) to (16, 8): row 0 from step 4 on, row 5 (outside) from step 14 on.
    const auto inside = [](ivec2 a, ivec2 b) {
        const StepRange steps = steps_inside(LineSteps(a, b), {100, 5}, LineEnd::included);
        return std::pair(steps.first, steps.last);
    };
    using Steps = std::pair<std::int64_t, std::int64_t>;  // the first and the last
    EXPECT_EQ(inside({2, 1}, {7, 3}), Steps(0, 5)) << "a line all inside of 100 x 5 pixels";
    EXPECT_EQ(inside({-4, -2}, {16, 8}), Steps(4, 13))
        << name({-4, -2}, {16, 8}) << " in 100 x 5 pixels, which sinks";
    EXPECT_EQ(inside({-4, 6}, {16, -4}), Steps(4, 13))
        << name({-4, 6}, {16, -4}) << " in 100 x 5 pixels, which rises";
}

TEST(Lines, Eq1_9_BmpRowsAreFilledToAMultipleOfFour) {
    EXPECT_EQ(bmp_row_padding(1), 1);
    EXPECT_EQ(bmp_row_padding(2), 2);
    EXPECT_EQ(bmp_row_padding(3), 3);
    EXPECT_EQ(bmp_row_padding(4), 0);
    EXPECT_EQ(bmp_row_padding(1280), 0);
}

TEST(Lines, ExhaustiveAllLinesOfASmallGridAreIdeal) {
    look_up("Eq. 1.6 and the table before it; Eq. 1.2 for which row it is");
    constexpr int side = 33;
    for (int i = 0; i < side * side; ++i)
        for (int j = 0; j < side * side; ++j)
            ASSERT_TRUE(is_ideal({i % side, i / side}, {j % side, j / side}, ivec2(side)));
}

TEST(Lines, ExhaustiveAllLinesAroundASmallPictureAreTheWholeLinesPixels) {
    look_up("Eq. 1.8 for which steps are inside, Eq. 1.7 for where rows begin");
    // Ends on a 13 x 13 grid, the picture its middle 5 x 4 pixels: every way in and out.
    constexpr int side = 13;
    for (int i = 0; i < side * side; ++i)
        for (int j = 0; j < side * side; ++j)
            ASSERT_TRUE(
                is_ideal({i % side - 4, i / side - 4}, {j % side - 4, j / side - 4}, {5, 4}));
}

TEST(Lines, HardCase_ZeroLengthIsOnePixel) {
    look_up("Eq. 1.8: a line of no length is step 0 alone");
    EXPECT_EQ(walk({3, 2}, {3, 2}, {8, 8}), (std::vector<ivec2>{{3, 2}}));
    EXPECT_TRUE(walk({-1, 2}, {-1, 2}, {8, 8}).empty());
}

TEST(Lines, HardCase_AllOctantsAndTheirBorders) {
    look_up("Eq. 1.6 and the table of the three changes before it");
    for (const ivec2 way : ways) {
        ASSERT_TRUE(is_ideal(middle, middle + way, size));
        ASSERT_TRUE(is_ideal(middle + way, middle, size));
    }
}

TEST(Lines, HardCase_EndsFarOutsideMatchTheWholeLine) {
    look_up("Eq. 1.7, 1.8, and how large the numbers get");
    std::vector<std::pair<ivec2, ivec2>> lines = {
        {{262, 23}, {91618510, -54756195}},       {{263, 214}, {80120779, 11846827}},
        {{1, 1}, {2000000000, 1000000000}},       {{INT_MIN, INT_MIN}, {INT_MAX, INT_MAX}},
        {{INT_MIN, INT_MAX}, {INT_MAX, INT_MIN}}, {{INT_MIN, 100}, {INT_MAX, 101}},
        {{100, INT_MAX}, {101, INT_MIN}},         {{INT_MIN, INT_MIN}, {INT_MIN, INT_MAX}},
        {{INT_MAX, INT_MAX}, {INT_MAX, INT_MAX}}, {{INT_MIN, 0}, {479, 359}}};
    std::mt19937 random(3);
    std::uniform_int_distribution<int> bits(1, 31);
    const auto coordinate = [&] { return static_cast<int>(random()) >> bits(random); };
    for (int i = 0; i < 5'000; ++i) {
        const ivec2 a(coordinate(), coordinate()), b(coordinate(), coordinate());
        lines.push_back({a, b});
    }
    for (const auto& [a, b] : lines) {
        ASSERT_TRUE(is_ideal(a, b, {480, 360}));
        ASSERT_TRUE(is_ideal(b, a, {480, 360}));
    }
}

TEST(Lines, HardCase_EmptyPictureVisitsNothing) {
    look_up("Eq. 1.8: no step is inside");
    for (const ivec2 empty : {ivec2(0, 0), {0, 4}, {4, 0}})
        EXPECT_TRUE(walk({-5, -5}, {5, 5}, empty).empty()) << testing::PrintToString(empty);
}

TEST(Lines, ExcludedEndLeavesOutThatPixelAndNoOther) {
    look_up("Eq. 1.8 and Chains of lines");
    for (const ivec2 way : ways) {
        const ivec2 end = middle + way;
        Pixels expected = set_of(walk(middle, end, size));
        ASSERT_EQ(expected.erase({end.x, end.y}), 1u)
            << name(middle, end) << " with its end does not visit its end";
        ASSERT_TRUE(same_pixels(set_of(walk(middle, end, size, LineEnd::excluded)), expected))
            << name(middle, end) << " without its end, " << testing::PrintToString(end);
    }
    EXPECT_TRUE(walk(middle, middle, size, LineEnd::excluded).empty()) << "its end is all it has";
}

TEST(Lines, HardCase_ExcludedEndOutsideThePictureTakesNoPixelAway) {
    look_up("Eq. 1.8 and Chains of lines");
    EXPECT_EQ(walk({0, 0}, {9, 3}, {5, 5}, LineEnd::excluded), walk({0, 0}, {9, 3}, {5, 5}))
        << "(9, 3) is outside";
    EXPECT_EQ(walk({2, 2}, {-9, -3}, {5, 5}, LineEnd::excluded), walk({2, 2}, {-9, -3}, {5, 5}))
        << "(-9, -3) is outside";
}

TEST(Lines, HardCase_PolylineDrawnAdditivelyCountsEachJointOnce) {
    look_up("Eq. 1.8 and Chains of lines");
    // A closed zigzag without crossings: every pixel of it is counted exactly once.
    const std::vector<ivec2> vertices = {{2, 2},   {20, 5},  {38, 2}, {35, 20},
                                         {38, 38}, {20, 35}, {2, 38}, {5, 20}};
    Image<int> hits({41, 41});
    for (std::size_t i = 0; i < vertices.size(); ++i)
        draw_line(vertices[i], vertices[(i + 1) % vertices.size()], hits.size(), LineEnd::excluded,
                  [&](ivec2 p) { ++hits[p]; });
    for (const ivec2 vertex : vertices)
        ASSERT_EQ(hits[vertex], 1) << "hits of the joint " << testing::PrintToString(vertex);
    for (const int count : hits.pixels()) ASSERT_LE(count, 1) << "hits of one pixel";
}

TEST(Lines, PictureOfTheLesson) {
    EXPECT_TRUE(test::equals_golden("01_bresenham_lines", "01_bresenham_lines"));
}
