// SPDX-License-Identifier: MIT
// The methods of lessons/lab: each keeps what its comment says. And the program that compares them.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/image/image_io.hpp"
#include "lab/depth_formats.hpp"
#include "lab/fill_methods.hpp"
#include "lab/line_methods.hpp"
#include "support/first_difference.hpp"
#include "support/lesson_process.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr LineMethod all_methods[] = {LineMethod::bresenham, LineMethod::dda_float,
                                      LineMethod::dda_fixed, LineMethod::wu};

constexpr EdgeNumber all_numbers[] = {EdgeNumber::int64, EdgeNumber::int32, EdgeNumber::float32,
                                      EdgeNumber::float64};

std::string name(LineMethod method, ivec2 a, ivec2 b) {
    constexpr const char* names[] = {"bresenham", "dda-float", "dda-fixed", "wu"};
    return names[static_cast<std::size_t>(method)] + (", the line " + testing::PrintToString(a)) +
           " -> " + testing::PrintToString(b);
}

Image<float> drawn_line(LineMethod method, ivec2 a, ivec2 b, ivec2 size,
                        LineEnd end = LineEnd::included) {
    Image<float> coverage(size, 0.0f);
    draw_line_as(method, a, b, size, end,
                 [&](ivec2 pixel, float share) { coverage[pixel] += share; });
    return coverage;
}

/// The barycentrics in each pixel that is visited; of those visited twice, the sum.
Image<vec3> filled(const FillMethod& variant, const std::array<dvec2, 3>& vertices, ivec2 size) {
    Image<vec3> shares(size, vec3(0));
    fill_bounding_box_as(variant, vertices, size,
                         [&](ivec2 at, vec3 of_at) { shares[at] += of_at; });
    return shares;
}

/// For EXPECT_TRUE: the same pixels, with nearly the same barycentrics.
testing::AssertionResult are_filled_alike(const Image<vec3>& actual, const Image<vec3>& expected) {
    return agree_everywhere(actual, expected, [](vec3 a, vec3 b) {
        return glm::all(glm::lessThan(glm::abs(a - b), vec3(1e-3f)));
    });
}

}  // namespace

TEST(Lab, EveryStepOfALineHasACoverageOfOneAroundTheLine) {
    constexpr ivec2 size(64);
    // Of 61 steps at most: dda-fixed drifts most, by half of 2^-16 rows a step; Wu's two shares are
    // floats, and its row drifts by less than they are rounded.
    constexpr double nearest_row = 0.5 + 61 * 0x1p-17, shares = 0x1p-23;
    std::mt19937 random(1);
    std::uniform_int_distribution<int> inside(1, 62);
    for (int i = 0; i < 500; ++i) {
        const ivec2 a(inside(random), inside(random));
        const ivec2 b = i == 0 ? a : ivec2(inside(random), inside(random));  // also of one pixel
        const bool steep = std::abs(b.x - a.x) < std::abs(b.y - a.y);
        const ivec2 from = steep ? ivec2(a.y, a.x) : a, to = steep ? ivec2(b.y, b.x) : b;
        const auto [low, high] = std::minmax(from.x, to.x);
        const double slope = from.x == to.x ? 0 : 1.0 * (to.y - from.y) / (to.x - from.x);
        for (const LineMethod method : all_methods) {
            const std::string line = name(method, a, b);
            const Image<float> coverage = drawn_line(method, a, b, size);
            for (int major = 0; major < 64; ++major) {
                const double ideal = from.y + slope * (major - from.x);
                double sum = 0, beside = 0;
                for (int minor = 0; minor < 64; ++minor) {
                    const float share = coverage[steep ? ivec2(minor, major) : ivec2(major, minor)];
                    sum += share, beside += share * (minor - ideal);
                }
                ASSERT_NEAR(sum, major >= low && major <= high ? 1 : 0, shares)
                    << "the coverage of step " << major - low << "; " << line;
                ASSERT_LE(std::abs(beside), method == LineMethod::wu ? shares : nearest_row)
                    << "from the line to the middle of what covers step " << major - low << ", "
                    << "in pixels; " << line;
            }
            const Image<float> open = drawn_line(method, a, b, size, LineEnd::excluded);
            ASSERT_EQ(open[b], 0.0f) << "the coverage of the excluded end; " << line;
        }
    }
}

TEST(Lab, LinesThatLeaveThePictureAreDrawnInsideAsTheWholeLineIs) {
    constexpr ivec2 size(40, 30), beyond(60);
    std::mt19937 random(1);
    std::uniform_int_distribution<int> x(-beyond.x, size.x + beyond.x - 1),
        y(-beyond.y, size.y + beyond.y - 1);
    for (int i = 0; i < 500; ++i) {
        const ivec2 a(x(random), y(random)), b(x(random), y(random));
        for (const LineMethod method : all_methods) {
            Image<float> inside(size, 0.0f);
            draw_line_as(method, a, b, size, LineEnd::included, [&](ivec2 pixel, float share) {
                ASSERT_EQ(glm::clamp(pixel, ivec2(0), size - 1), pixel)
                    << "a pixel that lies outside; " << name(method, a, b);
                ASSERT_GT(share, 0)
                    << "the coverage of a pixel that is drawn; " << name(method, a, b);
                inside[pixel] += share;
            });
            // In float, where a line begins changes how its rows are rounded.
            if (method == LineMethod::dda_float) continue;
            const Image<float> whole =
                drawn_line(method, a + beyond, b + beyond, size + 2 * beyond);
            Image<float> expected(size);
            for (int row = 0; row < size.y; ++row)
                for (int column = 0; column < size.x; ++column)
                    expected[{column, row}] = whole[ivec2(column, row) + beyond];
            ASSERT_TRUE(are_equal(inside, expected)) << "the coverage; " << name(method, a, b);
        }
    }
}

TEST(Lab, WholeBoundingBoxesVisitWhatFillTriangleVisits) {
    constexpr ivec2 size(40);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(-20, 60);
    for (int i = 0; i < 300; ++i) {
        std::array<dvec2, 3> t, snapped;
        for (std::size_t k = 0; k < 3; ++k) {
            t[k] = vec2(any(random), any(random));
            if (i % 2 == 0)  // sides through centres, some of them level
                t[k] = glm::floor(t[k] / 8.0) * 8.0 + 0.5;
            snapped[k] = glm::round(t[k] * 256.0) / 256.0;
        }
        Image<vec3> expected(size, vec3(0));
        fill({}, snap_triangle(t[0], t[1], t[2]), t, size,
             [&](ivec2 at, vec3 shares) { expected[at] += shares; });
        EXPECT_TRUE(are_filled_alike(filled({}, t, size), expected)) << "by int64";
        for (const EdgeNumber number : all_numbers)
            EXPECT_TRUE(are_filled_alike(filled({.edges = number}, snapped, size), expected))
                << "with vertices that need no rounding, smaller than 128 pixels; by number "
                << static_cast<int>(number);
    }
}

TEST(Lab, FewerBitsSnapToCoarserPlaces) {
    // From (0.6, 0.6), snapped to whole pixels: the square from 1 to 4 without its lower half.
    const std::array<dvec2, 3> t = {dvec2(0.6, 0.6), dvec2(0.6, 4.4), dvec2(4.4, 0.6)};
    const Image<vec3> whole = filled({}, {dvec2(1, 1), dvec2(1, 4), dvec2(4, 1)}, ivec2(8));
    EXPECT_TRUE(are_filled_alike(filled({.subpixel_bits = 0}, t, ivec2(8)), whole));
    EXPECT_FALSE(are_filled_alike(filled({.subpixel_bits = 2}, t, ivec2(8)), whole));
}

TEST(Lab, VerticesOutOfRangeVisitNothing) {
    for (const EdgeNumber number : all_numbers)
        for (const double bad : {std::numeric_limits<double>::quiet_NaN(), 1e300, -0x1p22})
            fill_bounding_box_as({.edges = number}, {dvec2(0, 0), dvec2(0, 9), dvec2(bad, 0)},
                                 ivec2(8), [bad](ivec2 pixel, vec3) {
                                     ADD_FAILURE() << testing::PrintToString(pixel)
                                                   << " is visited, with a vertex at " << bad;
                                 });
}

TEST(Lab, AveragingKeepsTheMeanOfEachSquare) {
    Image<vec3> picture({4, 2}, vec3(0));
    picture[{0, 0}] = vec3(1, 0, 0);
    picture[{3, 1}] = vec3(0, 2, 4);
    const Image<vec3> half = averaged(picture, 2);
    ASSERT_EQ(half.size(), ivec2(2, 1));
    EXPECT_EQ((half[{0, 0}]), vec3(0.25f, 0, 0));
    EXPECT_EQ((half[{1, 0}]), vec3(0, 0.5f, 1));
}

TEST(Lab, WhatIsKeptOfADepthIsThatDepthInTheFarthestPartOfAll) {
    // What is kept of 0, and the tolerance: a whole number is off by half a step.
    for (const auto& [name, format, farthest, tolerance] :
         {std::tuple("float", DepthFormat::float32, 0, 0.0f),
          {"from-near", DepthFormat::from_near, -1, 0.0f},
          {"ndc", DepthFormat::ndc, 0, 0.0f},
          {"unorm16", DepthFormat::unorm16, 0, 0x1p-17f},
          {"unorm24", DepthFormat::unorm24, 0, 0x1p-24f}})
        for (const float range : {1.0f, 4.0f})
            for (const float depth : {0.0f, 0.5f, 1.0f})
                EXPECT_NEAR((DepthMethod{format, range}.kept(depth)),
                            static_cast<float>(farthest) + depth / range, tolerance)
                    << name << " of the depth " << depth << " in the farthest 1/" << range;
}

TEST(Lab, EveryOptionDrawsAndShowsADifference) {
    struct Case {
        const char *lesson, *option;
        std::vector<std::string> values, rest;
    };
    for (const auto& [lesson, option, values, rest] :
         {Case{"lab_01_bresenham_lines", "--line=", {"dda-float", "dda-fixed", "wu"}, {}},
          Case{"lab_02_triangle_fill", "--edges=", {"int32"}, {"--model=triangle.obj"}},
          Case{"lab_02_triangle_fill", "--edges=", {"float", "double"}, {}},
          Case{"lab_02_triangle_fill", "--subpixel-bits=", {"0", "2", "4", "12", "16"}, {}},
          Case{"lab_02_triangle_fill", "--samples=", {"4", "16", "64"}, {}},
          Case{"lab_03_z_buffer", "--format=", {"unorm16"}, {"--range=100"}},
          Case{"lab_03_z_buffer", "--format=", {"unorm24"}, {"--range=10000"}},
          Case{"lab_03_z_buffer", "--format=", {"from-near", "ndc"}, {"--range=1000000"}}}) {
        std::vector<std::string> arguments = rest;
        arguments.insert(arguments.end(), {"--size", "640x360"});
        const std::string usual = bytes_of_picture(lesson, arguments);
        for (const std::string& value : values) {
            std::vector<std::string> other = arguments;
            other.push_back(option + value);
            EXPECT_NE(bytes_of_picture(lesson, other), usual) << lesson << ' ' << other.back();
        }
    }
}

TEST(Lab, WithTheLessonsMethodsItDrawsTheLessonsPicture) {
    for (const auto& [lesson, method] :
         std::map<std::string, std::string>{{"01_bresenham_lines", "--line=bresenham"},
                                            {"02_triangle_fill", "--edges=int64"},
                                            {"03_z_buffer", "--format=float"}})
        EXPECT_EQ(bytes_of_picture("lab_" + lesson, {method, "--size", "97x61"}),
                  bytes_of_picture(lesson, {"--size", "97x61"}))
            << lesson;
}

TEST(Lab, WithoutOptionsItSaysWhatThereIsToChoose) {
    const ProcessResult run = run_program("lab_03_z_buffer", {});
    EXPECT_EQ(run.exit_status, 0);
    EXPECT_EQ(run.err, "");
    for (const char* text : {"\n--format float,from-near,ndc,unorm16,unorm24   [float]\n",
                             "\n--range 1,100,10000,1000000   [1]\n", "Other formats for depths"})
        EXPECT_NE(run.out.find(text), std::string::npos) << text << "in\n" << run.out;
}

TEST(Lab, SeveralMethodsAreDrawnComparedAndTimed) {
    const std::filesystem::path folder = fresh_folder("compared");
    const ProcessResult run =
        run_program("lab_03_z_buffer", {"--format", "unorm16,float", "--depth", "--range=1,10000",
                                        "--size", "80x50", "--out", (folder / "lab.png").string()});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_EQ(run.err, "");
    const Files files = files_in(folder);
    ASSERT_EQ(files.size(), 5u);
    const Image<u8vec4> sheet = read_image(folder / "lab.png");
    ASSERT_EQ(sheet.size(), ivec2(4 * 80, 2 * 50));
    const Image<u8vec4> reference = read_image(folder / "lab_float_1.png");
    const auto apart = [&](const Image<u8vec4>& picture, ivec2 at) {
        return glm::abs(ivec3(picture[at]) - ivec3(reference[at]));
    };
    std::vector<Image<u8vec4>> pictures;
    int greatest = 0;
    for (const std::string format : {"unorm16", "float"})
        for (const std::string range : {"1", "10000"}) {
            const std::string file = "lab_" + format + '_' + range + ".png";
            SCOPED_TRACE(file);
            ASSERT_TRUE(files.contains(file));
            EXPECT_EQ(files.at(file),
                      bytes_of_picture("lab_03_z_buffer", {"--depth", "--size", "80x50", "--format",
                                                           format, "--range", range}));
            const Image<u8vec4>& picture = pictures.emplace_back(read_image(folder / file));
            int pixels = 0, most = 0;
            double squares = 0;
            for (int y = 0; y < 50; ++y)
                for (int x = 0; x < 80; ++x) {
                    const ivec3 d = apart(picture, {x, y});
                    pixels += d != ivec3(0);
                    most = std::max({most, d.x, d.y, d.z});
                    squares += d.x * d.x + d.y * d.y + d.z * d.z;
                }
            greatest = std::max(greatest, most);
            const std::string row = '\n' + format + ' ' + range + ' ';
            ASSERT_NE(run.out.find(row), std::string::npos) << run.out;
            std::istringstream line(run.out.substr(run.out.find(row) + row.size()));
            double said_pixels = 0, said_most = 0, root_mean_square = 0, median = 0;
            line >> said_pixels >> said_most >> root_mean_square >> median;
            EXPECT_EQ(said_pixels, pixels);
            EXPECT_EQ(said_most, most);
            EXPECT_NEAR(root_mean_square, std::sqrt(squares / (3 * 80 * 50)), 0.0005);
            EXPECT_GT(median, 0);
        }
    ASSERT_GT(greatest, 0) << "16 bits at range 10000 are not told from floats";
    for (std::size_t i = 0; i < 4; ++i)
        for (int y = 0; y < 50; ++y)
            for (int x = 0; x < 80; ++x) {
                const ivec2 at(80 * static_cast<int>(i) + x, y);
                ASSERT_EQ(sheet[at], (pictures[i][{x, y}])) << "picture " << i;
                ASSERT_EQ(ivec3(sheet[at + ivec2(0, 50)]),
                          255 / greatest * apart(pictures[i], {x, y}))
                    << "the difference of picture " << i;
            }
}

TEST(Lab, WhatCannotBeComparedIsSaidAndNothingIsWritten) {
    const std::filesystem::path folder = fresh_folder("not_compared");
    for (const auto& [words, message] :
         std::vector<std::pair<std::vector<std::string>, std::string>>{
             {{"--line", "bresenham,wo"}, "'wo' is not one of bresenham|dda-float|dda-fixed|wu"},
             {{"--line", "wu,"}, "'' is not one of"},
             {{"--filter", "nearest,bilinear"}, "--filter"},
             {{"--line", "wu,wu,wu,wu,wu,wu,wu,wu,wu,wu,wu,wu,wu"},
              "--line: these are 13 pictures, and no more than 12 are compared"},
             {{"--line", "wu,bresenham", "--stats"}, "--stats is for one picture"},
             {{"--line"}, "--line"}}) {
        std::vector<std::string> arguments = words;
        arguments.insert(arguments.begin(), {"--out", (folder / "lab.png").string()});
        expect_error(run_program("lab_01_bresenham_lines", arguments), 2, message);
    }
    expect_error(
        run_program("lab_01_bresenham_lines", {"--out", (folder / "lab.png").string(), "--line",
                                               "wu,bresenham", "--model", "nothing.obj"}),
        1, "there is no such file");
    EXPECT_EQ(files_in(folder).size(), 0u);
}

TEST(Lab, LessonsWithoutOtherMethodsCompareTheirOptions) {
    const std::filesystem::path folder = fresh_folder("options");
    const ProcessResult run =
        run_program("lab_09_shadow_maps", {"--shadow-size", "16,2048", "--size", "96x54", "--pcf",
                                           "3", "--out", (folder / "lab.png").string()});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_NE(run.out.find("differs from the lesson's own\n"), std::string::npos) << run.out;
    const auto row_of = [&](const std::string& method) {
        std::istringstream row(run.out.substr(run.out.find('\n' + method + ' ') + 1));
        std::string name;
        int pixels = -1;
        row >> name >> pixels;
        return std::pair(name, pixels);
    };
    EXPECT_EQ(row_of("2048"), std::pair(std::string("2048"), 0)) << "what is drawn unasked";
    EXPECT_GT(row_of("16").second, 100) << run.out;
    EXPECT_EQ(files_in(folder).at("lab_2048.png"),
              bytes_of_picture("09_shadow_maps", {"--size", "96x54"}));
    expect_error(run_program("lab_09_shadow_maps", {"--shadow-size", "16,15"}), 2,
                 "'15' is not a number from 16 to 8192");
}
