// SPDX-License-Identifier: MIT
#include "01_bresenham_lines/line.hpp"

#include <algorithm>
#include <climits>
#include <numeric>
#include <random>
#include <sstream>
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
    std::ostringstream text;
    text << "the line (" << a.x << ", " << a.y << ") -> (" << b.x << ", " << b.y << ')';
    return text.str();
}

std::string name(ivec2 a, ivec2 b, ivec2 size) {
    std::ostringstream text;
    text << name(a, b) << " in a picture of " << size.x << " x " << size.y << " pixels";
    return text.str();
}

/// The visited pixels in their order; also that each is inside.
std::vector<ivec2> walk(ivec2 a, ivec2 b, ivec2 size, LineEnd end = LineEnd::included) {
    std::vector<ivec2> pixels;
    std::size_t outside = 0;
    ivec2 first_outside(0);
    // No line has more pixels in a picture; of one that does not end, no more have to be seen.
    const auto most = static_cast<std::size_t>(4 * std::max({size.x, size.y, 1}));
    draw_line(a, b, size, end, [&](ivec2 pixel) {
        const bool is_inside = pixel.x >= 0 && pixel.y >= 0 && pixel.x < size.x && pixel.y < size.y;
        if (!is_inside && outside++ == 0) first_outside = pixel;
        pixels.push_back(pixel);
        if (pixels.size() + outside > most)
            throw std::runtime_error(name(a, b, size) + " visits more than " +
                                     std::to_string(pixels.size() - 1) + " pixels; the last is " +
                                     testing::PrintToString(pixel));
    });
    if (outside > 0)
        ADD_FAILURE() << name(a, b, size) << " visits pixels outside of it, " << outside << " of "
                      << pixels.size() << "; the first is "
                      << testing::PrintToString(first_outside);
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
    result << name(a, b, size) << ": " << actual.size() << " pixels, expected " << expected.size();
    const auto [yours, other] = std::ranges::mismatch(actual, expected);
    if (yours != actual.end() && other != expected.end())
        result << "; number " << yours - actual.begin() + 1 << " of them is "
               << testing::PrintToString(*yours) << ", expected " << testing::PrintToString(*other);
    return result << "\n" << test::ascii_difference(set_of(actual), set_of(expected));
}

/// For EXPECT_TRUE: the same pixels from b to a as from a to b (Eq. 1.6).
testing::AssertionResult is_the_same_backwards(ivec2 a, ivec2 b, ivec2 size) {
    const std::vector<ivec2> there = walk(a, b, size), back = walk(b, a, size);
    if (there == back) return testing::AssertionSuccess();
    return testing::AssertionFailure()
           << name(b, a, size) << " visits other pixels than from (" << a.x << ", " << a.y
           << "), or in another order (always towards larger major coordinates)\n"
           << test::ascii_difference(set_of(back), set_of(there));
}

/// For EXPECT_TRUE: the row of each step of the line from (0, 0) to b, as rows_after() has it.
testing::AssertionResult has_rows(ivec2 b, const std::vector<std::int64_t>& rows) {
    const LineSteps line({0, 0}, b);
    for (std::size_t k = 0; k < rows.size(); ++k)
        if (const std::int64_t row = line.rows_after(static_cast<std::int64_t>(k)); row != rows[k])
            return testing::AssertionFailure() << "rows_after(" << k << ") of " << name({0, 0}, b)
                                               << " is " << row << ", expected " << rows[k];
    return testing::AssertionSuccess();
}

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
    const LineSteps line({0, 0}, {5, 2});
    EXPECT_EQ(line.major_length, 5) << "of the line (0, 0) -> (5, 2)";
    EXPECT_EQ(line.minor_length, 2) << "of the line (0, 0) -> (5, 2)";
    EXPECT_TRUE(has_rows({5, 2}, {0, 0, 1, 1, 2, 2}));
    EXPECT_TRUE(has_rows({2, 1}, {0, 0, 1})) << "step 1 is a tie, which stays: mind the -1";
}

TEST(Lines, Eq1_4_ContinuesInsideThePictureAsTheWholeLine) {
    // The picture starts at step 3 of the worked example, in the middle of a row.
    EXPECT_EQ(walk({-3, 0}, {2, 2}, {8, 8}), (std::vector<ivec2>{{0, 1}, {1, 2}, {2, 2}}));
}

TEST(Lines, Eq1_5_WorkedExampleOfTheText) {
    EXPECT_EQ(walk({0, 0}, {5, 2}, {8, 8}),
              (std::vector<ivec2>{{0, 0}, {1, 0}, {2, 1}, {3, 1}, {4, 2}, {5, 2}}));
}

TEST(Lines, Eq1_6_BothDirectionsInEachOctant) {
    const ivec2 a(10, 10), size(21, 21);
    for (const ivec2 b :
         {ivec2(9, 4), {-9, 4}, {9, -4}, {-9, -4}, {4, 9}, {-4, 9}, {4, -9}, {-4, -9}}) {
        ASSERT_TRUE(is_ideal(a, a + b, size));
        ASSERT_TRUE(is_the_same_backwards(a, a + b, size));
    }
}

TEST(Lines, Eq1_6_BothDirectionsVisitTheSamePixels) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> x(0, 199), y(0, 99);
    std::size_t visited = 0;
    for (int i = 0; i < 10'000; ++i) {
        const ivec2 a(x(random), y(random)), b(x(random), y(random));
        ASSERT_TRUE(is_the_same_backwards(a, b, {200, 100}));
        if (HasFailure()) return;
        visited += walk(a, b, {200, 100}).size();
    }
    EXPECT_GT(visited, 100'000u);
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
    const ivec2 size(100, 5);
    const auto inside = [size](ivec2 a, ivec2 b) {
        const StepRange steps = steps_inside(LineSteps(a, b), size, LineEnd::included);
        return std::pair(steps.first, steps.last);
    };
    using Steps = std::pair<std::int64_t, std::int64_t>;  // the first and the last
    EXPECT_EQ(inside({2, 1}, {7, 3}), Steps(0, 5)) << "a line all inside of 100 x 5 pixels";
    EXPECT_EQ(inside({-4, -2}, {16, 8}), Steps(4, 13))
        << name({-4, -2}, {16, 8}, size) << ", which sinks";
    EXPECT_EQ(inside({-4, 6}, {16, -4}), Steps(4, 13))
        << name({-4, 6}, {16, -4}, size) << ", which rises";
}

TEST(Lines, Eq1_8_TheSamePixelsFromBothEndsOutside) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> coordinate(-300, 300);
    std::size_t visited = 0;
    for (int i = 0; i < 10'000; ++i) {
        const ivec2 a(coordinate(random), coordinate(random)),
            b(coordinate(random), coordinate(random));
        ASSERT_TRUE(is_the_same_backwards(a, b, {200, 100}));
        if (HasFailure()) return;
        visited += walk(a, b, {200, 100}).size();
    }
    EXPECT_GT(visited, 100'000u);
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
    int lines = 0;
    for (int i = 0; i < side * side; ++i)
        for (int j = 0; j < side * side; ++j, ++lines) {
            const ivec2 a(i % side, i / side), b(j % side, j / side);
            ASSERT_TRUE(is_ideal(a, b, {side, side}));
            ASSERT_EQ(
                walk(a, b, {side, side}).size(),
                static_cast<std::size_t>(std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)) + 1))
                << "pixels of " << name(a, b);
            if (HasFailure()) return;
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
            ASSERT_TRUE(is_ideal(a, b, {5, 4}));
            if (HasFailure()) return;
        }
}

TEST(Lines, PixelsAreConnectedAndWithinHalfAPixel) {
    look_up("Eq. 1.6 and the table before it; Eq. 1.5");
    std::mt19937 random(2);
    std::uniform_int_distribution<int> coordinate(0, 999);
    for (int i = 0; i < 2'000; ++i) {
        const ivec2 a(coordinate(random), coordinate(random)),
            b(coordinate(random), coordinate(random));
        const auto pixels = walk(a, b, {1000, 1000});
        const std::int64_t dx = b.x - a.x, dy = b.y - a.y,
                           longer = std::max(std::abs(dx), std::abs(dy));
        ASSERT_EQ(pixels.size(), static_cast<std::size_t>(longer + 1))
            << "pixels of " << name(a, b);
        for (std::size_t k = 0; k < pixels.size(); ++k) {
            // |cross product| / longer = distance along the shorter axis
            const std::int64_t cross = dx * (pixels[k].y - a.y) - dy * (pixels[k].x - a.x);
            ASSERT_LE(2 * std::abs(cross), longer)
                << testing::PrintToString(pixels[k]) << " lies more than half a pixel beside "
                << name(a, b);
            if (k > 0) {
                const ivec2 step = glm::abs(pixels[k] - pixels[k - 1]);
                ASSERT_EQ(std::max(step.x, step.y), 1)
                    << name(a, b) << " goes from " << testing::PrintToString(pixels[k - 1])
                    << " to " << testing::PrintToString(pixels[k]);
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
         {ivec2(9, 4), {4, 9}, {-4, 9}, {-9, 4}, {-9, -4}, {-4, -9}, {4, -9}, {9, -4}}) {
        ASSERT_TRUE(is_ideal({10, 10}, ivec2(10, 10) + b, {21, 21}));
        ASSERT_TRUE(is_ideal(ivec2(10, 10) + b, {10, 10}, {21, 21}));
    }
}

TEST(Lines, HardCase_SlopeExactlyOne) {
    look_up("Eq. 1.5, with both lengths equal");
    for (const ivec2 b : {ivec2(7, 7), {-7, 7}, {7, -7}, {-7, -7}}) {
        const auto pixels = walk({8, 8}, ivec2(8, 8) + b, {16, 16});
        ASSERT_EQ(pixels.size(), 8u) << "pixels of " << name({8, 8}, ivec2(8, 8) + b);
        for (const ivec2 p : pixels)
            ASSERT_EQ(std::abs(p.x - 8), std::abs(p.y - 8))
                << name({8, 8}, ivec2(8, 8) + b) << " visits " << testing::PrintToString(p)
                << ", which lies beside the diagonal";
    }
}

TEST(Lines, HardCase_HorizontalAndVertical) {
    look_up("the table of the three changes before Eq. 1.6");
    for (const ivec2 b : {ivec2(7, 0), {-7, 0}, {0, 7}, {0, -7}}) {
        ASSERT_TRUE(is_ideal({8, 8}, ivec2(8, 8) + b, {16, 16}));
        ASSERT_TRUE(is_ideal(ivec2(8, 8) + b, {8, 8}, {16, 16}));
    }
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
                                              {{-1, 360}, {480, -1}}}) {
        ASSERT_TRUE(is_ideal(a, b, {480, 360}));
        ASSERT_TRUE(is_ideal(b, a, {480, 360}));
    }
}

TEST(Lines, HardCase_RandomEndsOfAnySizeMatchTheWholeLine) {
    look_up("Eq. 1.7, 1.8, and how large the numbers get");
    std::mt19937 random(3);
    std::uniform_int_distribution<int> bits(1, 31);
    const auto coordinate = [&] { return static_cast<int>(random()) >> bits(random); };
    for (int i = 0; i < 5'000; ++i) {
        const ivec2 a(coordinate(), coordinate()), b(coordinate(), coordinate());
        ASSERT_TRUE(is_ideal(a, b, {48, 36}));
        ASSERT_TRUE(is_ideal(b, a, {48, 36}));
    }
}

TEST(Lines, HardCase_EmptyPictureVisitsNothing) {
    look_up("Eq. 1.8: no step is inside");
    EXPECT_TRUE(walk({-5, -5}, {5, 5}, {0, 0}).empty());
    EXPECT_TRUE(walk({-5, -5}, {5, 5}, {0, 4}).empty());
    EXPECT_TRUE(walk({-5, -5}, {5, 5}, {4, 0}).empty());
}

TEST(Lines, ExcludedEndLeavesOutThatPixelAndNoOther) {
    look_up("Eq. 1.8 and Chains of lines");
    for (const ivec2 b :
         {ivec2(9, 4), {4, 9}, {-4, 9}, {-9, 4}, {-9, -4}, {-4, -9}, {4, -9}, {9, -4}, {0, 0}}) {
        const ivec2 a(10, 10), end = a + b;
        Pixels expected = set_of(walk(a, end, {21, 21}));
        ASSERT_EQ(expected.erase({end.x, end.y}), 1u)
            << name(a, end) << " with its end does not visit its end";
        ASSERT_TRUE(same_pixels(set_of(walk(a, end, {21, 21}, LineEnd::excluded)), expected))
            << name(a, end) << " without its end, " << testing::PrintToString(end);
    }
}

TEST(Lines, HardCase_ExcludedEndOutsideThePictureTakesNoPixelAway) {
    look_up("Eq. 1.8 and Chains of lines");
    EXPECT_EQ(walk({0, 0}, {9, 3}, {5, 5}, LineEnd::excluded), walk({0, 0}, {9, 3}, {5, 5}))
        << "(9, 3) is outside";
    EXPECT_EQ(walk({9, 3}, {0, 0}, {5, 5}, LineEnd::excluded).size(),
              walk({9, 3}, {0, 0}, {5, 5}).size() - 1)
        << "(0, 0) is inside";
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
    for (int y = 0; y < hits.size().y; ++y)
        for (int x = 0; x < hits.size().x; ++x)
            ASSERT_LE((hits[{x, y}]), 1) << "hits of pixel (" << x << ", " << y << ')';
}

TEST(Lines, PictureOfTheLesson) {
    EXPECT_TRUE(test::equals_golden("01_bresenham_lines", "01_bresenham_lines"));
}
