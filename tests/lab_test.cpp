// SPDX-License-Identifier: MIT
// The methods of lessons/lab: each keeps what its comment says. And the program that compares them.
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/image/image_io.hpp"
#include "lab/depth_formats.hpp"
#include "lab/fill_methods.hpp"
#include "lab/line_methods.hpp"
#include "support/exact_area.hpp"
#include "support/lesson_process.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr LineMethod all_methods[] = {LineMethod::bresenham, LineMethod::dda_float,
                                      LineMethod::dda_fixed, LineMethod::wu};

std::string name(LineMethod method) {
    constexpr const char* names[] = {"bresenham", "dda-float", "dda-fixed", "wu"};
    return names[static_cast<std::size_t>(method)];
}

Image<float> drawn_line(LineMethod method, ivec2 a, ivec2 b, ivec2 size,
                        LineEnd end = LineEnd::included) {
    Image<float> coverage(size, 0.0f);
    draw_line_as(method, a, b, size, end,
                 [&](ivec2 pixel, float share) { coverage[pixel] += share; });
    return coverage;
}

/// How often each pixel is visited, row by row.
std::vector<int> hits_of(const FillMethod& variant, const std::array<dvec2, 3>& vertices,
                         ivec2 size) {
    Image<int> hits(size, 0);
    fill_bounding_box_as(variant, vertices, size, [&](ivec2 pixel, vec3) { ++hits[pixel]; });
    return {hits.pixels().begin(), hits.pixels().end()};
}

std::array<dvec2, 3> random_vertices(std::mt19937& random, double low, double high) {
    std::uniform_real_distribution<double> any(low, high);
    std::array<dvec2, 3> vertices;
    for (dvec2& vertex : vertices) vertex = {any(random), any(random)};
    return vertices;
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
            const std::string line = name(method) + ", the line " + testing::PrintToString(a) +
                                     " -> " + testing::PrintToString(b);
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
            const std::string line = name(method) + ", the line " + testing::PrintToString(a) +
                                     " -> " + testing::PrintToString(b);
            Image<float> inside(size, 0.0f);
            draw_line_as(method, a, b, size, LineEnd::included, [&](ivec2 pixel, float share) {
                ASSERT_TRUE(pixel.x >= 0 && pixel.x < size.x && pixel.y >= 0 && pixel.y < size.y)
                    << testing::PrintToString(pixel) << " lies outside; " << line;
                ASSERT_GT(share, 0) << "the coverage of a pixel that is drawn; " << line;
                inside[pixel] += share;
            });
            // In float, where a line begins changes how its rows are rounded.
            if (method == LineMethod::dda_float) continue;
            const Image<float> whole =
                drawn_line(method, a + beyond, b + beyond, size + 2 * beyond);
            for (int row = 0; row < size.y; ++row)
                for (int column = 0; column < size.x; ++column)
                    ASSERT_EQ((inside[{column, row}]), (whole[ivec2(column, row) + beyond]))
                        << "the coverage of (" << column << ", " << row << "); " << line;
        }
    }
}

TEST(Lab, FixedPointDriftsByAtMostHalfAStepOfItsFraction) {
    for (int rise = 19'990; rise < 20'000; ++rise) {
        FixedRow<16> row(LineSteps({3, 5}, {30'003, 5 + rise}), 0);
        for (int step = 0; step <= 30'000; ++step) {
            const double ideal = 5 + 1.0 * rise * step / 30'000;
            const double actual = static_cast<double>(row.row) / 65536;
            ASSERT_NEAR(actual, ideal, 0x1p-17 * step + 1e-9) << "the row of step " << step;
            ASSERT_EQ(static_cast<double>(row.above()) + row.beyond_above(), actual)
                << "the whole row above and what lies beyond it, of step " << step;
            row.step();
        }
    }
}

TEST(Lab, WholeBoundingBoxesVisitWhatFillTriangleVisits) {
    std::mt19937 random(1);
    for (int i = 0; i < 300; ++i) {
        std::array<dvec2, 3> t = random_vertices(random, -20, 60);
        if (i % 2 == 0)  // sides through centres, some of them level
            for (dvec2& vertex : t) vertex = glm::floor(vertex / 8.0) * 8.0 + 0.5;
        std::vector<int> expected(40 * 40);
        const ScreenTriangle on_screen = snap_triangle(t[0], t[1], t[2]);
        const std::array<dvec2, 3> as_float = {vec2(t[0]), vec2(t[1]), vec2(t[2])};
        fill({}, on_screen, as_float, ivec2(40), [&](ivec2 pixel, vec3) {
            ++expected[static_cast<std::size_t>(pixel.y * 40 + pixel.x)];
        });
        EXPECT_EQ(hits_of({}, as_float, ivec2(40)), expected);
        EXPECT_EQ(hits_of({.edges = EdgeNumber::int32}, as_float, ivec2(40)), expected)
            << "smaller than 128 pixels";
        std::array<dvec2, 3> snapped;
        for (std::size_t k = 0; k < 3; ++k) snapped[k] = glm::round(as_float[k] * 256.0) / 256.0;
        for (const EdgeNumber number : {EdgeNumber::float32, EdgeNumber::float64})
            EXPECT_EQ(hits_of({.edges = number}, snapped, ivec2(40)), expected)
                << "vertices that need no rounding";
    }
}

TEST(Lab, BarycentricsOfABoundingBoxAddUpToOne) {
    for (const EdgeNumber number :
         {EdgeNumber::int64, EdgeNumber::int32, EdgeNumber::float32, EdgeNumber::float64}) {
        vec3 first(0);
        int visited = 0;
        fill_bounding_box_as({.edges = number}, {dvec2(1, 1), dvec2(1, 9), dvec2(9, 1)}, ivec2(20),
                             [&](ivec2 pixel, vec3 barycentrics) {
                                 EXPECT_NEAR(barycentrics.x + barycentrics.y + barycentrics.z, 1,
                                             1e-6f);
                                 if (pixel == ivec2(2, 2)) first = barycentrics;
                                 ++visited;
                             });
        EXPECT_EQ(visited, 28) << "half of the square; the diagonal is a right side, not its own";
        EXPECT_NEAR(first.x, 1 - 2 * 1.5f / 8, 1e-6f);
        EXPECT_NEAR(first.y, 1.5f / 8, 1e-6f);
    }
}

TEST(Lab, FewerBitsSnapToCoarserPlaces) {
    // From (0.6, 0.6), snapped to whole pixels: the square from 1 to 4 without its lower half.
    const std::array<dvec2, 3> t = {dvec2(0.6, 0.6), dvec2(0.6, 4.4), dvec2(4.4, 0.6)};
    const std::vector<int> coarse = hits_of({.subpixel_bits = 0}, t, ivec2(8));
    const std::vector<int> whole = hits_of({}, {dvec2(1, 1), dvec2(1, 4), dvec2(4, 1)}, ivec2(8));
    EXPECT_EQ(coarse, whole);
    EXPECT_NE(hits_of({.subpixel_bits = 2}, t, ivec2(8)), whole);
}

TEST(Lab, VerticesOutOfRangeVisitNothing) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const EdgeNumber number :
         {EdgeNumber::int64, EdgeNumber::int32, EdgeNumber::float32, EdgeNumber::float64})
        for (const double bad : {nan, 1e300, -0x1p22}) {
            const std::vector<int> hits =
                hits_of({.edges = number}, {dvec2(0, 0), dvec2(0, 9), dvec2(bad, 0)}, ivec2(8));
            for (const int count : hits) EXPECT_EQ(count, 0) << bad;
        }
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

TEST(Lab, WhatIsKeptOfDepthsStaysInOrder) {
    for (const DepthFormat format : {DepthFormat::float32, DepthFormat::from_near, DepthFormat::ndc,
                                     DepthFormat::unorm16, DepthFormat::unorm24})
        for (const float range : {1.0f, 100.0f, 1e6f}) {
            const DepthMethod variant{format, range};
            std::map<float, int> kept;
            float before = variant.farthest();
            for (int i = 0; i <= 1000; ++i) {
                const float now = variant.kept(static_cast<float>(i) / 1000);
                ASSERT_LE(before, now) << "farther than before, or than an empty pixel";
                before = now;
                ++kept[now];
            }
            const bool fine = format == DepthFormat::float32 || range == 1.0f ||
                              (range == 100.0f && format != DepthFormat::unorm16);
            EXPECT_EQ(kept.size() == 1001, fine) << static_cast<int>(format) << ", " << range;
        }
}

TEST(Lab, WhatIsKeptOfADepthIsThatDepthInTheFarthestPartOfAll) {
    EXPECT_EQ(DepthMethod{}.kept(0.3f), 0.3f) << "unasked, a depth is kept as it is";
    struct Case {
        const char* name;
        DepthFormat format;
        float farthest;   ///< What is kept of 0.
        float tolerance;  ///< A whole number is off by half a step.
    };
    for (const auto& [name, format, farthest, tolerance] :
         {Case{"float", DepthFormat::float32, 0, 0},
          Case{"from-near", DepthFormat::from_near, -1, 0}, Case{"ndc", DepthFormat::ndc, 0, 0},
          Case{"unorm16", DepthFormat::unorm16, 0, 0x1p-17f},
          Case{"unorm24", DepthFormat::unorm24, 0, 0x1p-24f}})
        for (const float range : {1.0f, 4.0f})
            for (const float depth : {0.0f, 0.5f, 1.0f}) {
                const DepthMethod variant{format, range};
                EXPECT_NEAR(variant.kept(depth), farthest + depth / range, tolerance)
                    << name << " of the depth " << depth << " in the farthest 1/" << range;
                EXPECT_EQ(variant.farthest(), farthest) << name << " of an empty pixel";
            }
}

TEST(Lab, RangeOfDepthsIsTheNumberOnTheCommandLine) {
    for (const std::string number : {"1", "100", "10000", "1000000"}) {
        DepthMethod variant{.range = 7};
        LessonOptions options;
        std::string words[] = {"03_z_buffer", "--range", number};
        char* arguments[] = {words[0].data(), words[1].data(), words[2].data()};
        const auto declare = [&](OptionParser& parser) { variant.declare(parser); };
        EXPECT_FALSE(read_command_line(
            {words[0], "", options, nullptr, nullptr, nullptr, declare, {}, {}}, 3, arguments))
            << "--range " << number << " is no choice";
        EXPECT_EQ(variant.range, std::stof(number)) << "of --range " << number;
    }
}

TEST(Lab, DepthsAreRoundedToTheNearestOfTheirBits) {
    EXPECT_EQ(unorm<16>(0.0f), 0u);
    EXPECT_EQ(unorm<16>(1.0f), 65535u);
    EXPECT_EQ(unorm<16>(1.4f / 65535), 1u);
    EXPECT_EQ(unorm<24>(1.0f), 16777215u);
    EXPECT_EQ(unorm<24>(0.5f), 8388608u);
}

TEST(Lab, AreasInPixelsAddUpToThePolygon) {
    std::mt19937 random(1);
    for (int i = 0; i < 100; ++i) {
        const auto t = random_vertices(random, 0, 12);
        const dvec2 u = t[1] - t[0], v = t[2] - t[0];
        double sum = 0;
        for (int y = 0; y < 12; ++y)
            for (int x = 0; x < 12; ++x) sum += area_in_pixel({t[0], t[1], t[2]}, {x, y});
        EXPECT_NEAR(sum, 0.5 * std::abs(u.x * v.y - u.y * v.x), 1e-12 * 144);
    }
    EXPECT_EQ(area_in_pixel({dvec2(0, 0), dvec2(2, 0), dvec2(0, 2)}, {0, 0}), 1.0);
    EXPECT_EQ(area_in_pixel({dvec2(0, 0), dvec2(1, 0), dvec2(0, 1)}, {0, 0}), 0.5);
    EXPECT_EQ(area_in_pixel({dvec2(0, 0), dvec2(1, 0), dvec2(0, 1)}, {1, 0}), 0.0);
}

TEST(Lab, EveryOptionDrawsAndShowsADifference) {
    const std::map<std::string, std::vector<std::vector<std::string>>> options = {
        {"lab_01_bresenham_lines",
         {{"--line", "dda-float"}, {"--line", "dda-fixed"}, {"--line", "wu"}}},
        {"lab_02_triangle_fill",
         {{"--edges", "int32", "--model", "triangle.obj"},
          {"--edges", "float"},
          {"--edges", "double"},
          {"--subpixel-bits", "0"},
          {"--subpixel-bits", "2"},
          {"--subpixel-bits", "4"},
          {"--subpixel-bits", "12"},
          {"--subpixel-bits", "16"},
          {"--samples", "4"},
          {"--samples", "16"},
          {"--samples", "64"}}},
        {"lab_03_z_buffer",
         {{"--format", "unorm16", "--range", "100"},
          {"--format", "unorm24", "--range", "10000"},
          {"--format", "from-near", "--range", "1000000"},
          {"--format", "ndc", "--range", "1000000"}}}};
    const std::filesystem::path folder = fresh_folder("drawn");
    const auto draw = [&](const std::string& lesson, std::vector<std::string> arguments) {
        const std::string out = (folder / "picture.bmp").string();
        arguments.insert(arguments.end(), {"--size", "640x360", "--out", out});
        const ProcessResult run = run_program(lesson, arguments);
        EXPECT_EQ(run.exit_status, 0) << run.err;
        EXPECT_EQ(run.err, "");
        return read_image(out);
    };
    for (const auto& [lesson, variants] : options)
        for (const std::vector<std::string>& option : variants) {
            const std::vector<std::string> rest(option.begin() + 2, option.end());
            const bool is_depth = option[0] == "--format";
            const Image<u8vec4> usual = draw(lesson, is_depth ? std::vector<std::string>{} : rest);
            const Image<u8vec4> other = draw(lesson, option);
            std::size_t differing = 0;
            for (std::size_t i = 0; i < usual.pixels().size(); ++i)
                differing += usual.pixels()[i] != other.pixels()[i];
            EXPECT_GT(differing, 0u) << lesson << ' ' << option[0] << ' ' << option[1];
        }
}

TEST(Lab, WithTheLessonsMethodsItDrawsTheLessonsPicture) {
    for (const auto& [lesson, method] :
         std::map<std::string, std::string>{{"01_bresenham_lines", "--line=bresenham"},
                                            {"02_triangle_fill", "--edges=int64"},
                                            {"03_z_buffer", "--format=float"}})
        for (const std::string size : {"320x180", "97x61"})
            EXPECT_EQ(bytes_of_picture("lab_" + lesson, {method, "--size", size}),
                      bytes_of_picture(lesson, {"--size", size}))
                << lesson << ", " << size;
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
    const auto drawn = [&](const std::string& format, const std::string& range) {
        return bytes_of_picture("lab_03_z_buffer", {"--depth", "--size", "80x50", "--format",
                                                    format, "--range", range});
    };
    const Image<u8vec4> sheet = read_image(folder / "lab.png");
    ASSERT_EQ(sheet.size(), ivec2(4 * 80, 2 * 50));
    const Image<u8vec4> reference = read_image(folder / "lab_float_1.png");
    ASSERT_EQ(files.size(), 5u);
    std::vector<Image<u8vec4>> pictures;
    std::vector<std::string> names;
    for (const std::string format : {"unorm16", "float"})
        for (const std::string range : {"1", "10000"}) {
            const std::string file = "lab_" + format + '_' + range + ".png";
            ASSERT_TRUE(files.contains(file));
            EXPECT_EQ(files.at(file), drawn(format, range)) << file;
            pictures.push_back(read_image(folder / file));
            names.push_back(format + ' ' + range);
        }
    int greatest = 0;
    const auto apart = [&](const Image<u8vec4>& picture, ivec2 at) {
        return glm::abs(ivec3(picture[at]) - ivec3(reference[at]));
    };
    for (std::size_t i = 0; i < 4; ++i) {
        int pixels = 0, most = 0;
        double squares = 0;
        for (int y = 0; y < 50; ++y)
            for (int x = 0; x < 80; ++x) {
                const ivec3 d = apart(pictures[i], {x, y});
                pixels += d != ivec3(0);
                most = std::max({most, d.x, d.y, d.z});
                squares += d.x * d.x + d.y * d.y + d.z * d.z;
            }
        greatest = std::max(greatest, most);
        std::istringstream line(run.out.substr(run.out.find('\n' + names[i]) + 1));
        std::string format, range;
        double said_pixels = 0, said_most = 0, root_mean_square = 0, median = 0;
        line >> format >> range >> said_pixels >> said_most >> root_mean_square >> median;
        EXPECT_EQ(format + ' ' + range, names[i]) << run.out;
        EXPECT_EQ(said_pixels, pixels) << names[i];
        EXPECT_EQ(said_most, most) << names[i];
        EXPECT_NEAR(root_mean_square, std::sqrt(squares / (3 * 80 * 50)), 0.0005) << names[i];
        EXPECT_GT(median, 0) << names[i];
    }
    EXPECT_GT(greatest, 0) << "16 bits at range 10000 are not told from floats";
    for (std::size_t i = 0; i < 4; ++i)
        for (int y = 0; y < 50; ++y)
            for (int x = 0; x < 80; ++x) {
                const ivec2 at(80 * static_cast<int>(i) + x, y);
                ASSERT_EQ(sheet[at], (pictures[i][{x, y}])) << names[i];
                ASSERT_EQ(ivec3(sheet[at + ivec2(0, 50)]),
                          255 / greatest * apart(pictures[i], {x, y}))
                    << "the difference of " << names[i];
            }
}

TEST(Lab, WhatCannotBeComparedIsSaidAndNothingIsWritten) {
    const std::filesystem::path folder = fresh_folder("not_compared");
    for (const auto& [words, message] :
         std::vector<std::pair<std::vector<std::string>, std::string>>{
             {{"--line", "bresenham,wo"}, "'wo' is not one of bresenham|dda-float|dda-fixed|wu"},
             {{"--line", "wu,"}, "'' is not one of"},
             {{"--line", "blue"}, "'blue' is not one of"},
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
