// SPDX-License-Identifier: MIT
// "Why this pixel?": what --probe says is what the picture has.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "02_triangle_fill/count_triangle.hpp"
#include "common/image/image_io.hpp"
#include "support/gltf_builder.hpp"
#include "support/lesson_process.hpp"
#include "support/texts.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// The last line of a text.
std::string last_line(const std::string& text) {
    return text.substr(text.rfind('\n', text.size() - 2) + 1);
}

/// What --probe says of a pixel of a lesson's picture.
std::string probed(const std::string& lesson, ivec2 pixel, std::vector<std::string> options) {
    options.insert(options.end(),
                   {"--probe", std::to_string(pixel.x) + ',' + std::to_string(pixel.y)});
    const ProcessResult result = run_program(lesson + "_complete", options);
    EXPECT_EQ(result.exit_status, 0) << lesson << result.err;
    return result.out;
}

/// The numbers of the first line of a name; none if there is no such line.
std::optional<vec3> numbers_of(const std::string& text, const std::string& name) {
    const std::size_t line = text.find("\n  " + name + "  ");
    if (line == text.npos) return {};
    std::istringstream words(text.substr(line + 3 + name.size()));
    vec3 numbers(0);
    words >> numbers.x >> numbers.y >> numbers.z;
    return numbers;
}

bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != text.npos;
}

bool are_near(vec3 a, vec3 b, float distance) {
    return glm::all(glm::lessThanEqual(glm::abs(a - b), vec3(distance)));
}

/// Pixels of a picture, some at its border.
std::vector<ivec2> some_pixels(ivec2 size, int count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<ivec2> pixels{ivec2(0), size - 1};
    while (static_cast<int>(pixels.size()) < count)
        pixels.emplace_back(random() % static_cast<std::uint32_t>(size.x),
                            random() % static_cast<std::uint32_t>(size.y));
    return pixels;
}

const std::vector<std::pair<std::string, std::vector<std::string>>> probed_lessons = {
    {"02_triangle_fill", {}},
    {"02_triangle_fill", {"--samples", "4"}},
    {"03_z_buffer", {"--depth"}},
    {"04_mvp", {"--turn", "70"}},
    {"05_textures", {"--filter", "nearest", "--wrap", "mirror"}},
    {"05_textures", {"--model", "floor_checker.obj", "--filter", "bilinear"}},
    {"06_phong", {"--light", "spot", "--distance", "0.4"}},
    {"07_toon", {"--outline", "hull", "--samples", "4"}},
    {"07_toon", {"--outline", "edges", "--outline-width", "20"}},
    {"07_toon", {"--outline", "facing"}},
    {"08_normal_maps", {"--normal-map", "object", "--two-sided"}},
    {"09_shadow_maps", {"--light", "point"}},
    {"10_threading", {"--threads", "3", "--model", "scene.obj"}},
    {"11_scenes", {"--model", "bumpy.glb", "--shadow-size", "256"}},
    {"12_effects", {"--all-effects", "--shadow-size", "256"}},
    {"13_visibility_buffer", {"--shadow-size", "256"}},
    {"14_simd", {"--width", "4", "--shadow-size", "256"}}};

}  // namespace

TEST(Probe, TheLastLineIsThePicturesPixel) {
    const auto file = fresh_folder("probe") / "a.png";
    for (const auto& [program, given] : probed_lessons) {
        std::vector<std::string> options = given;
        options.insert(options.end(), {"--size", "97x61", "--out", file.string()});
        ASSERT_EQ(run_program(program, options).exit_status, 0) << program;
        const Image<u8vec4> picture = read_image(file);
        for (const ivec2 pixel : some_pixels({97, 61}, 6, 1)) {
            const u8vec4 color = picture[pixel];
            char hex[16];
            std::snprintf(hex, sizeof hex, "#%02x%02x%02x\n", color.r, color.g, color.b);
            EXPECT_EQ(last_line(probed(program, pixel, options)), hex) << program;
        }
    }
}

TEST(Probe, WhatIsNotedAddsUpToThePixelsColour) {
    const auto of_color = [](const std::string& text) {
        return *numbers_of(text, "colour, linear");
    };
    int flat = 0, textured = 0, lit = 0, painted = 0;
    for (const char* lesson : {"02_triangle_fill", "03_z_buffer", "04_mvp", "05_textures"})
        for (const ivec2 pixel : some_pixels({320, 180}, 16, 2)) {
            const std::string text = probed(lesson, pixel, {"--size", "320x180"});
            std::optional<vec3> color = numbers_of(text, "flat colour");
            if (!color) continue;
            if (const auto sample = numbers_of(text, "  sample")) *color *= *sample, ++textured;
            EXPECT_TRUE(are_near(*color, of_color(text), 0.0015f)) << lesson << text;
            ++flat;
        }
    for (const char* lesson : {"06_phong", "08_normal_maps", "09_shadow_maps", "10_threading"})
        for (const ivec2 pixel : some_pixels({320, 180}, 16, 3)) {
            const std::string text = probed(lesson, pixel, {"--size", "320x180"});
            const auto diffuse = numbers_of(text, "diffuse light");
            if (!diffuse) continue;
            vec3 sum(0);  // of the lights
            for (const std::string& light : parts_after(text, "\n    adds diffuse"))
                sum += *numbers_of("\n  x  " + light, "x");
            EXPECT_TRUE(are_near(sum, *diffuse, 0.0015f)) << lesson << text;
            const vec3 of_lights = *numbers_of(text, "diffuse colour") * *diffuse +
                                   numbers_of(text, "specular colour").value_or(vec3(0)) *
                                       *numbers_of(text, "specular light");
            const vec3 ambient = of_color(text) - of_lights;
            const vec3 most =
                *numbers_of(text, "diffuse colour") * *numbers_of(text, "ambient light");
            EXPECT_TRUE(glm::all(glm::greaterThan(ambient, vec3(-0.003f))) &&
                        glm::all(glm::lessThan(ambient, most + 0.003f)))
                << lesson << text;
            ++lit;
        }
    for (const ivec2 pixel : some_pixels({320, 180}, 60, 4)) {
        const std::string text =
            probed("07_toon", pixel, {"--size", "320x180", "--outline", "none"});
        const auto paint = numbers_of(text, "paint");
        if (!paint) continue;
        EXPECT_EQ(*paint, of_color(text)) << text;
        ++painted;
    }
    EXPECT_TRUE(flat > 15 && textured > 2 && lit > 15 && painted > 2)
        << flat << ' ' << textured << ' ' << lit << ' ' << painted;
}

TEST(Probe, Lessons11To14SayTheSame) {
    int shadowed = 0, blended = 0;
    for (const char* model : {"bumpy.glb", "toon.glb", "workshop.glb", "textured.gltf"})
        for (const ivec2 pixel : some_pixels({240, 135}, 8, 5)) {
            std::vector<std::string> options = {"--size", "240x135",       "--model",
                                                model,    "--shadow-size", "256"};
            const auto sorted = [](const std::string& text) {  // they find things in other orders
                std::vector<std::string> lines = parts_after("\n" + text, "\n");
                std::ranges::sort(lines);
                return lines;
            };
            const std::string text = probed("11_scenes", pixel, options);
            shadowed += holds(text, "depths compared");
            blended += holds(text, "blended over what lies behind");
            for (const char* lesson : {"12_effects", "13_visibility_buffer"})
                EXPECT_EQ(sorted(probed(lesson, pixel, options)), sorted(text))
                    << lesson << ' ' << model << pixel.x << ' ' << pixel.y;
            options.insert(options.end(), {"--width", "8"});
            EXPECT_EQ(sorted(probed("14_simd", pixel, options)), sorted(text))
                << model << pixel.x << ' ' << pixel.y;
        }
    EXPECT_TRUE(shadowed > 3 && blended > 0) << shadowed << ' ' << blended;
}

TEST(Probe, OfTwoTrianglesItSaysWhichLostAndWhy) {
    // Two squares, each of two triangles, the second one behind the first.
    const auto folder = fresh_folder("probe");
    std::ofstream(folder / "two.obj") << "o front\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
                                         "f 1 2 3\nf 1 3 4\n"
                                         "o back\nv -2 -2 0\nv 2 -2 0\nv 2 2 0\nf 5 6 7\n"
                                         "o away\nf 7 6 5\n";
    const std::vector<std::string> options = {
        "--size", "64x64",      "--model", (folder / "two.obj").string(), "--yaw", "0", "--pitch",
        "0",      "--distance", "4"};
    const std::string text = probed("04_mvp", {34, 34}, options);
    EXPECT_TRUE(holds(text, "front #0 "));
    EXPECT_TRUE(holds(text, "written, and seen"));
    EXPECT_TRUE(holds(text, "behind: not nearer than "));
    EXPECT_TRUE(holds(text, "faces away"));
    EXPECT_TRUE(holds(text, "front #1  "));
    EXPECT_TRUE(holds(text, "outside of edge ab by ")) << "of the first square's other triangle";
    EXPECT_TRUE(holds(text, "seen: front #0"));
    const std::string background = probed("04_mvp", {0, 0}, options);
    EXPECT_TRUE(holds(background, "none"));
    EXPECT_TRUE(holds(background, "seen: the background, since no triangle is written here"));
}

TEST(Probe, OnASharedEdgeItSaysWhichTriangleOwnsThePixel) {
    const ScreenTriangle lower = snap_triangle({0, 8}, {8, 8}, {8, 0});
    const ScreenTriangle upper = snap_triangle({0, 8}, {8, 0}, {0, 0});
    const ivec2 on_edge(3, 4);
    EXPECT_EQ(why_not_covered(upper, on_edge),
              "on edge ab, neither a left nor a top one (Eq. 2.7)");
    EXPECT_EQ(why_not_covered(lower, on_edge), "") << "it owns the edge";
    EXPECT_EQ(why_not_covered(lower, {0, 4}), "outside of edge ca by 2.12 px (Eq. 2.2)")
        << "3 / sqrt(2)";
}

TEST(Probe, InAShadowItSaysWhichDepthsAreCompared) {
    const std::string shadowed = probed("09_shadow_maps", {840, 420}, {"--pcf", "5"});
    EXPECT_TRUE(holds(shadowed, " is behind "));
    EXPECT_TRUE(holds(shadowed, "taps that say lit    0 of 25 "));
    EXPECT_TRUE(holds(probed("09_shadow_maps", {760, 620}, {"--pcf", "5"}), " is not behind "));
}

TEST(Probe, InAHoleItSaysThatAlphaIsTooLow) {
    const auto file = fresh_folder("probe") / "a.gltf";
    GltfBuilder made = one_triangle();
    made.material() = {{"name", "leaf"}, {"alphaMode", "MASK"}, {"alphaCutoff", 1.1}};
    made.write(file);
    for (const char* lesson : {"11_scenes", "12_effects", "13_visibility_buffer", "14_simd"}) {
        const std::string text = probed(lesson, {30, 26},
                                        {"--size", "64x48", "--yaw", "0", "--pitch", "0",
                                         "--distance", "3", "--model", file.string()});
        EXPECT_TRUE(holds(text, "a hole: alpha 1 is below 1.1 (Eq. 11.6)")) << lesson << text;
        EXPECT_TRUE(holds(text, "seen: the background")) << lesson;
    }
}

TEST(Probe, TheTextQuotesWhatIsPrinted) {
    const std::string page = read_text(root / "docs/troubleshooting.md");
    EXPECT_TRUE(holds(page, "\n./lessons/run 03 --probe 640,300\n"));
    const std::string printed = probed("03_z_buffer", {640, 300}, {});
    EXPECT_TRUE(holds(page, "```\n" + printed + "```"));
    std::vector<std::string> lines =
        parts_after(page.substr(page.find("  light 1  ")), "\n  ");  // all but the first one
    lines.resize(4);
    const std::string shadowed = probed("09_shadow_maps", {840, 420}, {});
    for (const std::string& line : lines)
        EXPECT_TRUE(holds(shadowed, line.substr(0, line.find('\n'))));
}

TEST(Probe, HardCase_BadPixelsAreExitStatus2) {
    for (const char* pixel : {"", "5", "5,", ",5", "5,5,5", "5,5x", "x,5", "5 5", "99999999999,1"})
        expect_error(run_program("03_z_buffer_complete", {"--probe", pixel}), 2,
                     "'" + std::string(pixel) + "' is not X,Y");
    for (const char* pixel : {"-1,0", "0,-1", "64,0", "0,48"})
        expect_error(
            run_program("03_z_buffer_complete", {"--size", "64x48", "--probe", pixel}), 2,
            "'" + std::string(pixel) +
                "' is outside of the picture, which has X from 0 to 63 and Y from 0 to 47");
    expect_error(run_program("04_mvp_complete", {"--probe", "1,1", "--frames", "3"}), 2, "--probe");
    expect_error(run_program("01_bresenham_lines_complete", {"--probe", "1,1"}), 2, "--probe");
}

TEST(Probe, AProgramWithoutItNamesTheOneThatHasIt) {
    expect_error(run_program("09_shadow_maps", {"--probe", "1,1"}), 1,
                 "--probe: this program is built without it; 09_shadow_maps_complete has it, and "
                 "./lessons/run builds that one");
}
