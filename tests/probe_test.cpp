// SPDX-License-Identifier: MIT
// "Why this pixel?": what --probe says is what the picture has.
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "10_threading/thread_pool.hpp"
#include "common/image/image_io.hpp"
#include "common/probe/pixel_report.hpp"
#include "support/lesson_02.hpp"
#include "support/lesson_03.hpp"
#include "support/lesson_04.hpp"
#include "support/lesson_05.hpp"
#include "support/lesson_06.hpp"
#include "support/lesson_07.hpp"
#include "support/lesson_08.hpp"
#include "support/lesson_09.hpp"
#include "support/lesson_10.hpp"
#include "support/lesson_process.hpp"
#include "support/pictures.hpp"
#include "support/probed_pixels.hpp"
#include "support/texts.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// The last line of a text.
std::string last_line(const std::string& text) {
    return text.substr(text.rfind('\n', text.size() - 2) + 1);
}

}  // namespace

TEST(Probe, Lesson02SaysWhatThePictureHas) {
    PaintOptions exact, barycentric, smooth;
    barycentric.paint = Paint::barycentric;
    smooth.samples_per_side = 2;
    const Scene teapot = loaded("teapot.obj"), scene = loaded("scene.obj");
    const auto expect = [](const auto& options, const Scene& of, int pixels) {
        expect_the_pictures_pixels(
            options, of, pixels, [](auto&... with) { return lesson_02::render(with...); },
            [](const auto&... with) { return fill_probe(with...); });
    };
    expect(exact, teapot, 400);
    expect(exact, scene, 300);
    expect(barycentric, teapot, 200);
    expect(smooth, teapot, 100);
}

TEST(Probe, Lesson03SaysWhatThePictureHas) {
    lesson_03::Options exact, barycentric, smooth;
    barycentric.paint = Paint::barycentric;
    smooth.samples_per_side = 2;
    const Scene teapot = loaded("teapot.obj"), scene = loaded("scene.obj");
    const auto expect = [](const auto& options, const Scene& of, int pixels) {
        expect_the_pictures_pixels(
            options, of, pixels, [](auto&... with) { return lesson_03::render(with...); },
            [](const auto&... with) { return depth_probe(with...); });
    };
    expect(exact, teapot, 300);
    expect(exact, scene, 200);
    expect(barycentric, teapot, 100);
    expect(smooth, teapot, 100);
}

TEST(Probe, Lesson04SaysWhatThePictureHas) {
    PotOptions exact, smooth;
    exact.turn_degrees = 70;
    smooth.samples_per_side = 2, smooth.orbit.distance = 0.3f;
    const Scene scene = loaded("scene.obj");
    const auto expect = [&](const auto& options, int pixels) {
        expect_the_pictures_pixels(
            options, scene, pixels, [](auto&... with) { return lesson_04::render(with...); },
            [](const auto& with, const Scene& of) {
                return mvp_probe(with, of,
                                 instances_of(of, lesson_04::world_from_pot(with.turn_degrees)));
            });
    };
    expect(exact, 400);
    expect(smooth, 150);
}

TEST(Probe, Lesson05SaysWhatThePictureHas) {
    TexturedSceneOptions exact, nearest, bilinear, smooth;
    nearest.texture.filter = Filter::nearest, nearest.texture.wrap = Wrap::mirror;
    bilinear.texture.filter = Filter::bilinear, bilinear.texture.wrap = Wrap::clamp;
    smooth.samples_per_side = 2;
    const auto expect = [&](const auto& options, const char* model, int pixels) {
        const auto assets = load_textured_scene(loaded(model), options);
        expect_the_pictures_pixels(
            options, assets, pixels, [](auto&... with) { return lesson_05::render(with...); },
            [](const auto&... with) { return texture_probe(with...); });
    };
    expect(exact, "scene.obj", 300);
    expect(exact, "horizon.obj", 100);
    expect(nearest, "scene.obj", 150);
    expect(bilinear, "floor_checker.obj", 150);
    expect(smooth, "scene.obj", 100);
}

TEST(Probe, Lesson06SaysWhatThePictureHas) {
    PhongOptions exact, spot, everything, smooth;
    spot.shading.key_light = LightKind::spot;
    everything.shading.all_effects = everything.shading.two_sided = true;
    everything.orbit.distance = 0.4f;
    smooth.samples_per_side = 2;
    const auto expect = [&](const auto& options, const char* model, int pixels) {
        const auto assets = lesson_06::make_assets(loaded(model), options);
        expect_the_pictures_pixels(
            options, assets, pixels, [](auto&... with) { return lesson_06::render(with...); },
            [](const auto&... with) { return phong_probe(with...); });
    };
    expect(exact, "scene.obj", 300);
    expect(exact, "figure.obj", 100);
    for (const auto& options : {spot, everything}) expect(options, "scene.obj", 100);
    expect(smooth, "scene.obj", 100);
}

TEST(Probe, Lesson07SaysWhatThePictureHas) {
    ToonOptions edges, hull, facing, none, wide, smooth;
    hull.shading.outline = Outline::hull;
    facing.shading.outline = Outline::facing;
    none.shading.outline = Outline::none;
    wide.shading.outline_width_px = 40;
    smooth.samples_per_side = 2, smooth.shading.outline = Outline::hull;
    const auto expect = [&](const auto& options, const char* model, int pixels) {
        const auto assets = lesson_07::make_assets(loaded(model), options);
        expect_the_pictures_pixels(
            options, assets, pixels, [](auto&... with) { return lesson_07::render(with...); },
            [](const auto&... with) { return toon_probe(with...); });
    };
    expect(edges, "figure.obj", 300);
    expect(edges, "scene.obj", 100);
    for (const auto& options : {hull, facing, none, wide, smooth})
        expect(options, "figure.obj", 100);
    edges.samples_per_side = 2;
    expect(edges, "figure.obj", 100);
}

TEST(Probe, Lesson08SaysWhatThePictureHas) {
    NormalMapSceneOptions exact, behind, object, green, smooth;
    behind.shading.two_sided = true;
    object.normal_map.space = MapSpace::object;
    green.normal_map.green = Green::down;
    smooth.samples_per_side = 2;
    const auto expect = [&](const auto& options, const char* model, int pixels) {
        const auto assets = lesson_08::make_assets(loaded(model), options);
        expect_the_pictures_pixels(
            options, assets, pixels, [](auto&... with) { return lesson_08::render(with...); },
            [](const auto&... with) { return normal_map_probe(with...); });
    };
    expect(exact, "scene_bumpy.obj", 200);
    expect(exact, "shield_mirrored_uvs.obj", 100);
    expect(exact, "crate_bump.obj", 100);
    for (const auto& options : {behind, object, green, smooth})
        expect(options, "scene_bumpy.obj", 80);
}

TEST(Probe, Lessons09And10SayWhatThePictureHas) {
    lesson_09::Options exact, spot, point, plane, moved_points, smooth;
    spot.shading.key_light = LightKind::spot, spot.shadow.pcf = 7;
    point.shading.key_light = LightKind::point, point.shadow.pcf = 1;
    plane.shadow.bias = Bias::plane, plane.shadow.size = 256;
    moved_points.shadow.bias = Bias::normal, moved_points.shading.all_effects = true;
    smooth.samples_per_side = 2;
    ThreadPool pool(2);
    const auto expect = [&](auto options, const char* model, int pixels) {
        const auto assets = lesson_09::make_assets(loaded(model), options);
        expect_the_pictures_pixels(
            options, assets, pixels, [](auto&... with) { return lesson_09::render(with...); },
            [](const auto&... with) { return shadow_probe(with...); });
        lesson_10::Options threaded;
        threaded.shading = options.shading, threaded.shadow = options.shadow;
        threaded.samples_per_side = options.samples_per_side;
        expect_the_pictures_pixels(
            threaded, assets, pixels,
            [&](const auto& of, const auto& with) { return lesson_10::render(of, with, pool); },
            [](const auto&... with) { return shadow_probe(with...); });
    };
    expect(exact, "scene_bumpy.obj", 200);
    expect(exact, "scene.obj", 100);
    for (const auto& options : {spot, point, plane, moved_points, smooth})
        expect(options, "scene_bumpy.obj", 80);
}

TEST(Probe, OfTwoTrianglesItSaysWhichLostAndWhy) {
    // Two squares, each of two triangles, the second one behind the first.
    const auto folder = fresh_folder("probe");
    std::ofstream(folder / "two.obj") << "o front\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
                                         "f 1 2 3\nf 1 3 4\n"
                                         "o back\nv -2 -2 0\nv 2 -2 0\nv 2 2 0\nf 5 6 7\n"
                                         "o away\nf 7 6 5\n";
    const auto probed = [&](const std::string& program, const std::string& pixel) {
        const ProcessResult result = run_program(
            program, {"--size", "64x64", "--model", (folder / "two.obj").string(), "--yaw", "0",
                      "--pitch", "0", "--distance", "4", "--probe", pixel});
        EXPECT_EQ(result.exit_status, 0) << result.err;
        return result.out;
    };
    const std::string text = probed("04_mvp_complete", "34,34");
    EXPECT_TRUE(holds(text, "front #0 "));
    EXPECT_TRUE(holds(text, "written, and seen"));
    EXPECT_TRUE(holds(text, "behind: not nearer than "));
    EXPECT_TRUE(holds(text, "faces away"));
    EXPECT_TRUE(holds(text, "front #1  "));
    EXPECT_TRUE(holds(text, "outside of edge ab by ")) << "of the first square's other triangle";
    EXPECT_TRUE(holds(text, "seen: front #0"));
    const std::string background = probed("04_mvp_complete", "0,0");
    EXPECT_TRUE(holds(background, "none"));
    EXPECT_TRUE(holds(background, "seen: the backdrop, since no triangle is written here"));
}

TEST(Probe, OnASharedEdgeItSaysWhichTriangleOwnsThePixel) {
    const ScreenTriangle lower = snap_triangle({0, 8}, {8, 8}, {8, 0});
    const ScreenTriangle upper = snap_triangle({0, 8}, {8, 0}, {0, 0});
    const ivec2 on_edge(3, 4);
    EXPECT_EQ(why_not_covered(upper, on_edge),
              "on edge ab, neither a left nor a top one (Eq. 2.7)");
    EXPECT_EQ(why_not_covered(lower, on_edge), "") << "it owns the edge";
    EXPECT_TRUE(covered(lower, on_edge) && !covered(upper, on_edge));
    EXPECT_EQ(why_not_covered(lower, {0, 4}), "outside of edge ca by 2.12 px (Eq. 2.2)")
        << "3 / sqrt(2)";
}

TEST(Probe, InAShadowItSaysWhichDepthsAreCompared) {
    const auto probed = [](const std::string& pixel) {
        return run_program("09_shadow_maps_complete", {"--probe", pixel, "--pcf", "5"}).out;
    };
    const std::string shadowed = probed("840,420");
    EXPECT_TRUE(holds(shadowed, " is behind "));
    EXPECT_TRUE(holds(shadowed, "taps that say lit    0 of 25 "));
    EXPECT_TRUE(holds(probed("760,620"), " is not behind "));
}

TEST(Probe, TheLastLineIsThePicturesPixel) {
    const auto file = fresh_folder("probe") / "a.png";
    const std::vector<std::vector<std::string>> lines = {{"06_phong_complete"},
                                                         {"04_mvp_complete", "--depth"},
                                                         {"07_toon_complete", "--samples", "4"}};
    for (std::vector<std::string> options : lines) {
        const std::string program = options[0];
        options.insert(options.end(), {"--size", "160x90"});
        const auto with = [&](const std::string& option, const std::string& value) {
            auto all = options;
            all.erase(all.begin());
            all.insert(all.end(), {option, value});
            return run_program(program, all);
        };
        EXPECT_EQ(with("--out", file.string()).exit_status, 0);
        const Image<u8vec4> picture = read_image(file);
        for (const ivec2 pixel : {ivec2(80, 40), ivec2(70, 50), ivec2(159, 89)}) {
            const u8vec4 color = picture[pixel];
            char hex[16];
            std::snprintf(hex, sizeof hex, "#%02x%02x%02x\n", color.r, color.g, color.b);
            const ProcessResult result =
                with("--probe", std::to_string(pixel.x) + ',' + std::to_string(pixel.y));
            EXPECT_EQ(last_line(result.out), hex) << program;
        }
    }
    EXPECT_TRUE(holds(run_program("04_mvp_complete", {"--depth", "--probe", "640,360"}).out,
                      "The picture has another colour"));
}

TEST(Probe, TheTextQuotesWhatIsPrinted) {
    const std::string page = read_text(root / "docs/troubleshooting.md");
    EXPECT_TRUE(holds(page, "\n./lessons/run 03 --probe 640,300\n"));
    const std::string printed = run_program("03_z_buffer_complete", {"--probe", "640,300"}).out;
    EXPECT_TRUE(holds(page, "```\n" + printed + "```"));
    std::vector<std::string> lines =
        parts_after(page.substr(page.find("  light 1  ")), "\n  ");  // all but the first one
    lines.resize(4);
    const std::string shadowed = run_program("09_shadow_maps_complete", {"--probe", "840,420"}).out;
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
