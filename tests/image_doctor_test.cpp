// SPDX-License-Identifier: MIT
// Pictures made wrong on purpose, by mistakes in the renderer or in what becomes of its picture.
#include "support/image_doctor.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "common/app/orthographic_view.hpp"
#include "common/image/backdrop.hpp"
#include "common/image/image_io.hpp"
#include "common/math/color.hpp"
#include "support/lesson_process.hpp"
#include "support/picture_difference.hpp"
#include "support/pictures.hpp"
#include "support/texts.hpp"

using namespace rasterbook;
using rasterbook::test::diagnose, rasterbook::test::fresh_folder, rasterbook::test::ProcessResult,
    rasterbook::test::run_program;

namespace {

const std::string lesson_02 = "02_triangle_fill", lesson_03 = "03_z_buffer",
                  program = "tests/diagnose";

constexpr ivec2 size{320, 180};

/// What a lesson is asked to draw.
struct Shot {
    std::string lesson;
    std::vector<std::string> options;
    std::string model = "teapot.obj";

    bool has(const std::string& option) const {
        return std::find(options.begin(), options.end(), option) != options.end();
    }
};

const Shot filled{lesson_02, {}}, filled_barycentrics{lesson_02, {"--paint", "barycentric"}},
    nearest{lesson_03, {}}, nearest_barycentrics{lesson_03, {"--paint", "barycentric"}},
    depths{lesson_03, {"--depth"}}, crate{lesson_03, {"--model", "crate.obj"}, "crate.obj"},
    one_triangle{lesson_02, {"--model", "triangle.obj", "--paint", "barycentric"}, "triangle.obj"};
const std::vector<Shot> all_shots{
    filled, filled_barycentrics, nearest, nearest_barycentrics, depths, crate, one_triangle};

/// The places of the lessons' pipeline in which a mistake can be made; right as they stand.
struct Pipeline {
    std::function<vec3(vec3)> place = [](vec3 vertex) { return vertex; };
    std::function<bool(const ScreenTriangle&)> is_drawn = is_front_facing;
    std::function<bool(int)> is_skipped = [](int) { return false; };
    std::function<bool(float, float)> is_nearer = std::greater<float>();
    float cleared = 0;
    std::function<vec3(vec3)> barycentrics_for = [](vec3 barycentrics) { return barycentrics; };
    std::function<vec3(vec3)> shade = [](vec3 color) { return color; };
    std::function<float(float)> encode = [](float linear) { return srgb_from_linear(linear); };
};

/// The pictures of lessons 02 and 03.
Image<u8vec4> render(const Shot& shot, const Pipeline& pipeline = {}) {
    const Scene scene = test::loaded(shot.model);
    const OrthographicView view(scene, size);
    Image<vec3> color = backdrop(size);
    Image<float> buffer(size, pipeline.cleared);
    int number = 0;
    for (const Mesh& mesh : scene.meshes) {
        const std::vector<vec3> positions_screen = view.screen_from_model(mesh.positions);
        for (const Triangle& triangle : mesh.triangles) {
            const vec3 a = pipeline.place(positions_screen[triangle.vertices[0].position]);
            const vec3 b = pipeline.place(positions_screen[triangle.vertices[1].position]);
            const vec3 c = pipeline.place(positions_screen[triangle.vertices[2].position]);
            const ScreenTriangle on_screen = snap_triangle(a, b, c);
            if (pipeline.is_skipped(number++) || !pipeline.is_drawn(on_screen)) continue;
            const vec3 face_color = flat_color(mesh, triangle, scene.materials[triangle.material]);
            const TriangleDepth depth(vec3(a.z, b.z, c.z));
            fill_triangle(on_screen, size, [&](ivec2 pixel, vec3 true_barycentrics) {
                const vec3 barycentrics = pipeline.barycentrics_for(true_barycentrics);
                if (shot.lesson == lesson_03 &&
                    !pipeline.is_nearer(depth.at(barycentrics), buffer[pixel]))
                    return;
                buffer[pixel] = depth.at(barycentrics);
                color[pixel] = pipeline.shade(shot.has("barycentric") ? barycentrics : face_color);
            });
        }
    }
    if (shot.has("--depth")) {
        DepthBuffer shown(size);
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) shown.test_and_write({x, y}, buffer[{x, y}]);
        color = depth_picture(shown);
    }
    Image<u8vec4> picture(size);
    for (std::size_t i = 0; i < picture.pixels().size(); ++i)
        for (int channel = 0; channel < 4; ++channel) {
            const float linear = channel < 3 ? color.pixels()[i][channel] : 1.0f;
            picture.pixels()[i][channel] = static_cast<std::uint8_t>(
                255 * std::clamp(pipeline.encode(std::clamp(linear, 0.0f, 1.0f)), 0.0f, 1.0f) +
                0.5f);
        }
    return picture;
}

/// What the diagnosis says before the colon, "LOOK" or "LOOK or LOOK".
std::string look(const Shot& shot, const Image<u8vec4>& actual, const Image<u8vec4>& expected) {
    std::istringstream lines(
        diagnose(actual, expected, test::picture_facts(shot.lesson, shot.options, actual.size())));
    std::string looks;
    for (std::string line; std::getline(lines, line);)
        looks += (looks.empty() ? "" : " ") + line.substr(0, line.find(": "));
    return looks;
}

std::string look(const Shot& shot, const Image<u8vec4>& actual) {
    return look(shot, actual, render(shot));
}

std::string look(const Shot& shot, const Pipeline& pipeline) {
    return look(shot, render(shot, pipeline));
}

bool is_back_facing(const ScreenTriangle& triangle) { return triangle.twice_area < 0; }

/// A lesson's picture as its program draws it.
Image<u8vec4> drawn(const Shot& shot) {
    const auto file = fresh_folder("doctor") / "a.png";
    std::vector<std::string> arguments = {"--size", "320x180", "--out", file.string()};
    arguments.insert(arguments.end(), shot.options.begin(), shot.options.end());
    EXPECT_EQ(run_program(shot.lesson, arguments).exit_status, 0);
    return read_image(file);
}

const char* const nothing_usual = "none of the usual mistakes explains it";

}  // namespace

TEST(ImageDoctor, RightPicturesAreNotAccused) {
    for (const Shot& shot : all_shots) {
        EXPECT_EQ(look(shot, render(shot)), "") << testing::PrintToString(shot.options);
        EXPECT_EQ(render(shot), drawn(shot)) << "this test's pipeline is not the lesson's";
    }
    Image<u8vec4> noisy = render(nearest);
    for (std::size_t i = 0; i < noisy.pixels().size(); i += 250) noisy.pixels()[i].g ^= 1;
    EXPECT_EQ(look(nearest, noisy), "") << "a level in some pixels";
}

TEST(ImageDoctor, TheModelIsWhereTheLessonDrawsIt) {
    constexpr int most_different = 6;  // of 57600: at borders the two cameras may round otherwise
    int lessons = 0;
    for (const std::string& lesson : test::lessons()) {
        if (lesson < "04" || lesson >= "11") continue;
        ++lessons;
        std::vector<std::vector<std::string>> all_options = {
            {"--depth"}, {"--depth", "--model", "textured.gltf", "--yaw", "10"}};
        if (lesson.starts_with("04"))
            all_options.push_back({"lab", "--depth", "--turn", "100", "--view", "orthographic"});
        for (const std::vector<std::string>& options : all_options) {
            const Image<u8vec4> picture = drawn({lesson, options});
            Image<int> covered(size, 0);
            for (const auto& [a, b, c] : test::picture_facts(lesson, options, size).patches)
                if (const ScreenTriangle on_screen = snap_triangle(a, b, c);
                    is_front_facing(on_screen))
                    fill_triangle(on_screen, size, [&](ivec2 p, vec3) { covered[p] = 1; });
            int different = 0;
            for (std::size_t i = 0; i < covered.pixels().size(); ++i)
                different += (picture.pixels()[i].r > 0) != (covered.pixels()[i] == 1);
            EXPECT_LE(different, most_different) << lesson << ' ' << options.size();
        }
    }
    EXPECT_EQ(lessons, 7);
}

TEST(ImageDoctor, FlippedFiles) {
    const ivec2 last = size - ivec2(1);
    for (const Shot& shot : {Shot{"01_bresenham_lines", {}}, nearest_barycentrics}) {
        const Image<u8vec4> right = drawn(shot);
        const auto flipped = [&](auto source) {
            Image<u8vec4> picture(size);
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x) picture[{x, y}] = right[source(ivec2(x, y))];
            return look(shot, picture, right);
        };
        EXPECT_EQ(flipped([&](ivec2 p) { return ivec2(last.x - p.x, p.y); }),
                  "flipped left to right");
        EXPECT_EQ(flipped([&](ivec2 p) { return ivec2(p.x, last.y - p.y); }),
                  "flipped top to bottom, the background too");
        EXPECT_EQ(flipped([&](ivec2 p) { return last - p; }),
                  "turned by 180 degrees, the background too");
    }
}

TEST(ImageDoctor, MirroredViews) {
    const auto mirrored_x = [](vec3 p) { return vec3(static_cast<float>(size.x) - p.x, p.y, p.z); };
    const auto mirrored_y = [](vec3 p) { return vec3(p.x, static_cast<float>(size.y) - p.y, p.z); };
    const auto turned = [&](vec3 p) { return mirrored_x(mirrored_y(p)); };
    for (const Shot& shot : {filled, nearest_barycentrics}) {
        EXPECT_EQ(look(shot, {.place = mirrored_x}),
                  "the model is flipped left to right, and its backs are seen");
        EXPECT_EQ(look(shot, {.place = mirrored_y}),
                  "the model is flipped top to bottom, and its backs are seen");
        EXPECT_EQ(look(shot, {.place = mirrored_y, .is_drawn = is_back_facing}),
                  "the model is flipped top to bottom");
        EXPECT_EQ(look(shot, {.place = turned}),
                  "the model is flipped left to right and top to bottom");
    }
}

TEST(ImageDoctor, ExchangedChannels) {
    for (const Shot& shot :
         {Shot{"01_bresenham_lines", {}}, filled, nearest, filled_barycentrics}) {
        const Image<u8vec4> right = drawn(shot);
        Image<u8vec4> blue_first = right, round = right;
        for (u8vec4& color : blue_first.pixels()) std::swap(color.r, color.b);
        for (u8vec4& color : round.pixels()) color = {color.g, color.b, color.r, color.a};
        EXPECT_EQ(look(shot, blue_first, right), "red and blue exchanged");
        EXPECT_EQ(look(shot, round, right), "red holds green, green holds blue, blue holds red");
    }
}

TEST(ImageDoctor, WrongBarycentrics) {
    const auto exchanged = [](vec3 right) { return vec3(right.y, right.x, right.z); };
    const auto round = [](vec3 right) { return vec3(right.z, right.x, right.y); };
    const std::string wrong = "the barycentric coordinates belong to the wrong vertices, ";
    for (const Shot& shot : {filled_barycentrics, nearest_barycentrics})
        EXPECT_EQ(look(shot, {.barycentrics_for = exchanged}),
                  wrong + "those of a and b exchanged");
    for (const Shot& shot : {nearest_barycentrics, one_triangle})
        EXPECT_EQ(look(shot, {.barycentrics_for = round}),
                  wrong + "a has c's, b has a's, c has b's");
    // Where no barycentrics are painted, depth alone shows them.
    for (const Shot& shot : {nearest, depths})
        EXPECT_EQ(look(shot, {.barycentrics_for = exchanged}),
                  "depths belong to the wrong vertices");
}

TEST(ImageDoctor, Gamma) {
    const auto twice = [](float linear) { return srgb_from_linear(srgb_from_linear(linear)); };
    for (const Shot& shot : all_shots) {
        EXPECT_EQ(look(shot, {.encode = twice}), "too bright and pale, sRGB encoded twice");
        EXPECT_EQ(look(shot, {.encode = std::identity()}), "too dark, not sRGB encoded");
    }
}

TEST(ImageDoctor, ShiftedPictures) {
    const auto moved = [](const Shot& shot, float x, float y) {
        return look(shot, {.place = [=](vec3 p) { return p + vec3(x, y, 0); }});
    };
    for (const Shot& shot : all_shots) {
        EXPECT_EQ(moved(shot, 1, 0), "shifted by 1 pixel to the right");
        EXPECT_EQ(moved(shot, -1, 2), "shifted by 1 pixel to the left and 2 pixels down");
    }
    for (const Shot& shot : {filled, nearest_barycentrics, depths}) {
        EXPECT_EQ(moved(shot, 0.5f, 0.5f),
                  "shifted by half a pixel to the right and half a pixel down");
        EXPECT_EQ(moved(shot, -0.5f, 0), "shifted by half a pixel to the left");
        EXPECT_NE(moved(shot, 0.25f, 0).find(nothing_usual), std::string::npos);
    }
}

TEST(ImageDoctor, WrongSurfaceInFront) {
    const auto always = [](float, float) { return true; };
    const auto reversed = [](vec3 p) { return vec3(p.x, p.y, 1 - p.z); };
    const std::string farthest = "the farthest surface is seen in place of the nearest";
    for (const Shot& shot : {nearest, nearest_barycentrics, depths}) {
        EXPECT_EQ(look(shot, {.is_nearer = std::less<float>(), .cleared = 1}), farthest);
        EXPECT_EQ(look(shot, {.is_nearer = always}), "each triangle covers those before it");
        EXPECT_EQ(look(shot, {.is_nearer = std::less<float>()}), "nothing of the model is seen");
        EXPECT_EQ(look(shot, {.place = reversed}),
                  shot.has("--depth") ? "near is dark and far is bright" : farthest);
    }
}

TEST(ImageDoctor, WrongFacing) {
    const auto both = [](const ScreenTriangle&) { return true; };
    for (const Shot& shot : {filled, filled_barycentrics, nearest, nearest_barycentrics, depths})
        EXPECT_EQ(look(shot, {.is_drawn = is_back_facing}),
                  "inside out, backs are seen in place of fronts");
    for (const Shot& shot : {filled, filled_barycentrics})
        EXPECT_EQ(look(shot, {.is_drawn = both}), "backs are drawn as well as fronts");
    for (const Shot& shot : {nearest, crate})
        EXPECT_EQ(look(shot, {.is_drawn = both}), "") << "fronts hide the backs of a closed model";
    EXPECT_EQ(look(one_triangle, {.is_drawn = is_back_facing}), "nothing of the model is seen");
}

TEST(ImageDoctor, HardCase_AFewStrayPixelsAreNotTheModel) {
    std::mt19937 random(7);
    for (const Shot& shot : {filled, nearest}) {
        Image<u8vec4> strays = render(shot, {.is_skipped = [](int) { return true; }});
        for (int i = 0; i < 50; ++i)
            strays[{random() % 320, random() % 180}] = render(shot)[{120, 100}];
        EXPECT_EQ(look(shot, strays), "nothing of the model is seen");
    }
}

TEST(ImageDoctor, EverySecondTriangleMissing) {
    for (const Shot& shot :
         {filled, filled_barycentrics, nearest, nearest_barycentrics, depths, crate}) {
        EXPECT_EQ(look(shot, {.is_skipped = [](int i) { return i % 2 == 0; }}),
                  "every second triangle is missing (the 1st, 3rd ...)");
        EXPECT_EQ(look(shot, {.is_skipped = [](int i) { return i % 2 == 1; }}),
                  "every second triangle is missing (the 2nd, 4th ...)");
    }
}

TEST(ImageDoctor, OtherMistakesAreNotExplained) {
    const std::vector<Pipeline> others = {
        {.shade = [](vec3) { return vec3(0.5f); }},
        {.shade = [](vec3 color) { return 0.5f * color; }},
        {.shade = [](vec3 color) { return 0.7f - 0.7f * color; }},
        {.place = [](vec3 p) { return vec3(160 + 0.9f * (p.x - 160), p.y, p.z); }},
        {.is_skipped = [](int i) { return i % 3 == 0; }},
        {.encode = [](float linear) { return 0.5f * srgb_from_linear(linear); }}};
    for (const Shot& shot : {filled, filled_barycentrics, nearest, nearest_barycentrics})
        for (std::size_t i = 0; i < others.size(); ++i)
            EXPECT_NE(look(shot, others[i]).find(nothing_usual), std::string::npos)
                << i << ' ' << shot.lesson << testing::PrintToString(shot.options);
    for (const Shot& shot : all_shots) {
        Image<u8vec4> painted_over = render(shot);
        for (int y = 60; y < 100; ++y)
            for (int x = 100; x < 180; ++x) painted_over[{x, y}] = {200, 0, 90, 255};
        EXPECT_EQ(
            look(shot, painted_over),
            "differs in 3200 pixels, the most by " +
                std::to_string(test::picture_difference(painted_over, render(shot)).greatest) +
                " of 255, most of them between (104, 62) and (175, 97); " + nothing_usual);
    }
    EXPECT_NE(look(nearest, render(crate)).find(nothing_usual), std::string::npos);
    EXPECT_NE(look(crate, render(nearest)).find(nothing_usual), std::string::npos);
}

TEST(ImageDoctor, HardCase_SmallestPictures) {
    for (const ivec2 small : {ivec2(1, 1), ivec2(1, 9), ivec2(9, 1), ivec2(3, 3)}) {
        const Image<u8vec4> expected(small, {10, 20, 30, 255}), actual(small, {90, 20, 0, 255});
        for (const Shot& shot : all_shots)
            EXPECT_NE(look(shot, actual, expected), "") << small.x << ' ' << small.y;
    }
}

TEST(ImageDoctor, TheCommandSaysWhatItSees) {
    const std::string right = (fresh_folder("doctor") / "right.png").string();
    run_program(lesson_03, {"--depth", "--size", "320x180", "--out", right});
    ProcessResult result = run_program(program, {right, lesson_03, "--depth"});
    EXPECT_EQ(result.exit_status, 0) << result.err;
    EXPECT_EQ(result.out, right + " looks the same as the course's; the tests see more\n");
    result = run_program(program, {right, lesson_03});
    EXPECT_EQ(result.exit_status, 1);
    EXPECT_NE(result.out.find("It is the lesson's picture with --depth\n"), std::string::npos)
        << result.out;
}

TEST(ImageDoctor, TheCommandKnowsTheMistakesThatAnOptionShows) {
    const std::string file = (fresh_folder("doctor") / "mine.png").string();
    struct Case {
        std::string lesson;
        std::vector<std::string> option;
        std::string equation;
    };
    for (const auto& [lesson, option, equation] :
         {Case{"05_textures", {"lab", "--mapping", "affine"}, "Eq. 5.2"},
          Case{"05_textures", {"--filter", "bilinear"}, "Eq. 5.7 and 5.8"},
          Case{"06_phong", {"lab", "--normals", "none"}, "Eq. 6.8"},
          Case{"06_phong", {"lab", "--highlight", "blinn"}, "Eq. 6.3 and 6.4"},
          Case{"07_toon", {"--outline-width", "6"}, "Eq. 7.14"},
          Case{"08_normal_maps", {"--green", "down"}, "Eq. 8.1 and 8.5"},
          Case{"08_normal_maps", {"--normal-map", "object"}, "Eq. 8.7"},
          Case{"09_shadow_maps", {"--bias", "none"}, "Eq. 9.9"},
          Case{"09_shadow_maps", {"--bias", "constant"}, "Eq. 9.10"},
          Case{"09_shadow_maps", {"--pcf", "1"}, "Eq. 9.13"},
          Case{"10_threading", {"--bias", "constant"}, "Eq. 9.10"}}) {
        std::vector<std::string> arguments = option;
        arguments.insert(arguments.end(), {"--yaw", "10", "--size", "160x90", "--out", file});
        ASSERT_EQ(run_program(lesson, arguments).exit_status, 0);
        const ProcessResult result = run_program(program, {file, lesson, "--yaw", "10"});
        EXPECT_EQ(result.exit_status, 1);
        std::string begin = file + ": looks as with";
        for (const std::string& word : option) begin += ' ' + word;
        begin += ": ";
        EXPECT_EQ(result.out.rfind(begin, 0), 0u) << result.out;
        EXPECT_NE(result.out.find(equation), std::string::npos) << result.out;
    }
}

TEST(ImageDoctor, TheCommandFindsWhatTroubleshootingSaysItFinds) {
#ifndef NDEBUG
    GTEST_SKIP() << "sixteen samples a pixel take minutes with assertions and sanitizers";
#endif
    const std::filesystem::path docs = test::root / "docs";
    const std::string page = test::read_text(docs / "troubleshooting.md");
    int found = 0;
    for (const std::string& section : test::parts_after(page, "\n## ")) {
        if (section.find("`./tests/run --diagnose mine.png NN` finds it") == section.npos) continue;
        ++found;
        std::istringstream command(test::all_between(section, "`./lessons/run ", "`").at(0));
        std::string number;
        command >> number;
        std::vector<std::string> arguments = {
            (docs / "troubleshooting" / test::all_between(section, "](troubleshooting/", ")").at(1))
                .string()};
        for (const std::string& lesson : test::lessons())
            if (lesson.starts_with(number)) arguments.push_back(lesson);
        for (std::string word; command >> word;) arguments.push_back(word);
        arguments.insert(arguments.end(), {"--samples", "16"});  // as docs/pictures.py draws
        const ProcessResult result = run_program(program, arguments);
        EXPECT_EQ(result.exit_status, 1) << section;
        EXPECT_NE(result.out, "") << result.err;
        EXPECT_EQ(result.out.find(nothing_usual), std::string::npos) << result.out;
    }
    EXPECT_GE(found, 5);
}

TEST(ImageDoctor, HardCase_BadInputAndUsageOfTheCommand) {
    const auto folder = fresh_folder("doctor");
    const std::string text = (folder / "text.png").string(), picture = (folder / "a.png").string();
    std::ofstream(text) << "no picture";
    write_image(picture, Image<u8vec3>({8, 8}));
    const auto refuse = [](const std::vector<std::string>& arguments, int exit_status,
                           const std::string& words) {
        test::expect_error(run_program(program, arguments), exit_status, words);
    };
    refuse({"no_such.png", lesson_03}, 1, "no_such.png");
    refuse({text, lesson_03}, 1, text);
    refuse({picture, "99_no_such"}, 2, "'99_no_such'");
    refuse({}, 2, "lesson");
    refuse({picture, lesson_03, "--no-such-option"}, 2, "--no-such-option");
    refuse({picture, lesson_03, "--model", "no_such.obj"}, 1, "no_such.obj");
}
