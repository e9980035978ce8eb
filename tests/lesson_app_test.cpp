// SPDX-License-Identifier: MIT
// The programs as a reader meets them: what they write, what they say, how they end.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/app/counters.hpp"
#include "common/image/image_io.hpp"
#include "common/math/color.hpp"
#include "support/gltf_builder.hpp"
#include "support/lesson_process.hpp"

using namespace rasterbook;
using rasterbook::test::ProcessResult, rasterbook::test::run_program,
    rasterbook::test::fresh_folder, rasterbook::test::expect_error;

static const char* const lesson = "03_z_buffer";

TEST(LessonApp, WritesThePictureInEachFormat) {
    const auto folder = fresh_folder("app");
    for (const char* name : {"a.png", "a.bmp", "a.tga"}) {
        const auto file = folder / name;
        const ProcessResult result =
            run_program(lesson, {"--size", "64x48", "--out", file.string()});
        EXPECT_EQ(result.exit_status, 0) << result.err;
        EXPECT_EQ(result.out, "wrote " + file.string() + "\n");
        EXPECT_EQ(read_image(file), read_image(folder / "a.png"));
        EXPECT_EQ(read_image(file).size(), ivec2(64, 48));
    }
}

TEST(LessonApp, StatsAreJsonAndCountWhatWasDone) {
    const auto file = fresh_folder("app") / "a.png";
    const ProcessResult result =
        run_program(lesson, {"--size", "64x48", "--stats", "--out", file.string()});
    const auto stats = nlohmann::json::parse(result.out);
    EXPECT_EQ(stats.at("lesson"), lesson);
    EXPECT_EQ(stats.at("width"), 64);
    for (const auto name : counter_names) EXPECT_TRUE(stats.contains(std::string(name))) << name;
    EXPECT_GT(stats.at("triangles_in"), 1000);
    EXPECT_GT(stats.at("triangles_culled_by_facing"), 100);
    EXPECT_GE(stats.at("fragments_tested"), stats.at("fragments_shaded"));
    EXPECT_GT(stats.at("fragments_shaded"), 300);
    EXPECT_EQ(stats.at("lines"), 0) << "this lesson draws no lines";
    for (const char* time : {"load_ms", "render_ms", "write_ms"}) EXPECT_GE(stats.at(time), 0);
}

TEST(LessonApp, SamplesAreAveragedIntoAPictureOfTheSizeAskedFor) {
    const auto folder = fresh_folder("samples");
    const auto draw = [&](const std::string& size, const std::string& samples) {
        const auto file = folder / (samples + ".png");
        const ProcessResult result = run_program(
            lesson, {"--size", size, "--samples", samples, "--stats", "--out", file.string()});
        EXPECT_EQ(result.exit_status, 0) << result.err;
        EXPECT_EQ(nlohmann::json::parse(result.out).at("width"), read_image(file).size().x);
        return read_image(file);
    };
    const Image<u8vec4> smooth = draw("64x36", "16"), large = draw("256x144", "1");
    ASSERT_EQ(smooth.size(), ivec2(64, 36));
    constexpr double rounding = 2;  // levels: half a bright one is more where the mean is dark
    for (int y = 0; y < 36; ++y)
        for (int x = 0; x < 64; ++x) {
            double sum = 0;
            for (int i = 0; i < 16; ++i)
                sum += linear_from_srgb(large[{4 * x + i % 4, 4 * y + i / 4}].g / 255.0);
            ASSERT_NEAR((smooth[{x, y}].g), 255 * srgb_from_linear(sum / 16), rounding);
        }
}

TEST(LessonApp, HelpNamesEveryOptionAndEndsWell) {
    const ProcessResult result = run_program(lesson, {"--help"});
    EXPECT_EQ(result.exit_status, 0);
    for (const char* option : {"--model", "--out", "--size", "--stats", "--depth"})
        EXPECT_NE(result.out.find(option), std::string::npos) << option;
}

TEST(LessonApp, HardCase_BadUsageIsExitStatus2) {
    for (const char* size : {"0x5", "5x0", "-4x4", "64", "64x", "x48", "64x48x3", "64 x 48",
                             "99999x1", "4294967297x1", "axb", ""})
        expect_error(run_program(lesson, {"--size", size}), 2,
                     "'" + std::string(size) + "' is not WIDTHxHEIGHT");
    expect_error(run_program(lesson, {"--no-such-option"}), 2, "--no-such-option");
    expect_error(run_program(lesson, {"--out", "picture.gif"}), 2, "picture.gif");
    expect_error(run_program(lesson, {"--model"}), 2, "--model");
    expect_error(run_program("02_triangle_fill", {"--paint", "blue"}), 2,
                 "'blue' is not one of flat|barycentric");
}

TEST(LessonApp, HardCase_PercentSignsThatAreNoFrameNumberStayInTheName) {
    const auto folder = fresh_folder("percent");
    for (const auto& [program, name] : std::vector<std::pair<std::string, std::string>>{
             {"03_z_buffer", "100%d.png"}, {"04_mvp", "100%done.png"}, {"04_mvp", "50% red.png"}}) {
        const ProcessResult result =
            run_program(program, {"--size", "8x8", "--out", (folder / name).string()});
        EXPECT_EQ(result.exit_status, 0) << result.err;
        EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
    }
}

TEST(LessonApp, HardCase_MissingModelNamesEveryPathTried) {
    const ProcessResult result = run_program(lesson, {"--model", "no_such.obj"});
    expect_error(result, 1, "no_such.obj: there is no such file; tried ");
    EXPECT_NE(result.err.find(std::filesystem::absolute("no_such.obj").string()),
              std::string::npos);
    EXPECT_NE(result.err.find(std::string(RASTERBOOK_ASSETS) + "/models/no_such.obj"),
              std::string::npos);
}

TEST(LessonApp, HardCase_BrokenModelNamesFileAndLineAndWritesNothing) {
    const auto folder = fresh_folder("app");
    std::ofstream(folder / "broken.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n";
    std::ofstream(folder / "picture.png") << "old";
    const ProcessResult result = run_program(lesson, {"--model", (folder / "broken.obj").string(),
                                                      "--out", (folder / "picture.png").string()});
    expect_error(result, 1, (folder / "broken.obj").string() + ":4: ");
    EXPECT_EQ(test::read_text(folder / "picture.png"), "old");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 2)
        << "something was left behind";
}

TEST(LessonApp, LimitsSayWhatAModelMayAskFor) {
    const auto file = fresh_folder("limits") / "a.png";
    const auto draw = [&](const std::string& limit) {
        return run_program(lesson, {"--size", "8x8", "--limit", "vertices=100", "--limit", limit,
                                    "--out", file.string()});
    };
    for (const char* wrong : {"pixels", "pixels=", "pixels=-1", "pixels=1x", "wishes=3", "=3"})
        EXPECT_EQ(draw(wrong).exit_status, 2) << wrong;
    EXPECT_EQ(draw("vertices=1000000").exit_status, 0) << "the last one counts";
    expect_error(draw("pixels=0"), 1, "teapot.obj: more than 100 vertices in all");
}

TEST(LessonApp, HardCase_ASandboxedModelReadsNoFileOutsideOfItsFolder) {
    namespace fs = std::filesystem;
    const fs::path folder = fresh_folder("sandbox"), inside = folder / "inside";
    fs::create_directories(inside / "deeper");
    const auto write = [](const fs::path& file, const std::string& text) {
        std::ofstream(file, std::ios::binary) << text;
    };
    test::GltfBuilder made = test::one_triangle();
    made.document["textures"][0]["source"] = 0;
    made.material()["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    made.document["buffers"][0]["byteLength"] = made.bytes.size();
    for (const fs::path& place : {folder, inside, inside / "deeper"}) {
        write(place / "m.mtl", "newmtl m\n");
        write(place / "triangle.bin", made.bytes);
        write_image(place / "black.bmp", Image<u8vec3>({1, 1}, u8vec3(0)));
    }
    write(inside / "up.mtl", "newmtl m\nmap_Kd ../black.bmp\n");
    write(inside / "deep.mtl", "newmtl m\nmap_Kd deeper/../deeper/black.bmp\n");
    fs::create_symlink(folder / "m.mtl", inside / "link.mtl");
    fs::create_symlink(folder, inside / "link");
    const auto obj_with = [&](const std::string& library) {
        return "mtllib " + library +
               "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";
    };
    const auto gltf_with = [&](const std::string& buffer, const std::string& image) {
        made.document["buffers"][0]["uri"] = buffer;
        made.document["images"][0]["uri"] = image;
        return made.document.dump();
    };
    const auto draw = [&](const std::string& name, const std::string& text,
                          std::vector<std::string> options = {"--sandbox"}) {
        write(inside / name, text);
        options.insert(options.end(), {"--size", "8x8", "--out", (folder / "a.png").string(),
                                       "--model", (inside / name).string()});
        return run_program("11_scenes", options);
    };
    for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
             {"dots.obj", obj_with("deeper/../../m.mtl")},
             {"backslashes.obj", obj_with("..\\m.mtl")},
             {"whole_path.obj", obj_with((folder / "m.mtl").string())},
             {"link_to_a_file.obj", obj_with("link.mtl")},
             {"link_to_a_folder.obj", obj_with("link/m.mtl")},
             {"map.obj", obj_with("up.mtl")},
             {"buffer.gltf", gltf_with("../triangle.bin", "black.bmp")},
             {"image_in_code.gltf", gltf_with("triangle.bin", "%2e%2e%2Fblack.bmp")}}) {
        EXPECT_EQ(draw(name, text, {}).exit_status, 0) << name << " is sound without --sandbox";
        expect_error(draw(name, text), 1, "lies outside of the model's folder");
    }
    expect_error(draw("missing.obj", obj_with("../none.mtl")), 1, "outside");
    EXPECT_EQ(draw("below.obj", obj_with("deep.mtl")).exit_status, 0);
    EXPECT_EQ(draw("below.gltf", gltf_with("deeper/triangle.bin", "deeper/black.bmp")).exit_status,
              0);
}

TEST(LessonApp, HardCase_OutputIntoAMissingFolderIsAnError) {
    const std::string file = (fresh_folder("app") / "no" / "picture.png").string();
    expect_error(run_program(lesson, {"--size", "8x8", "--out", file}), 1, file);
}

TEST(LessonApp, HardCase_ModelOfExtremeSizeIsDrawnAllTheSame) {
    const auto folder = fresh_folder("app");
    for (const char* program : {lesson, "04_mvp"})
        for (const char* scale : {"e-41", "e-38", "", "e37"}) {
            std::ofstream(folder / "a.obj") << "v -1" << scale << " 0 0\nv 1" << scale
                                            << " 0 0\nv 0 1" << scale << " 0\nf 1 2 3\n";
            const ProcessResult result = run_program(
                program, {"--size", "64x48", "--stats", "--model", (folder / "a.obj").string(),
                          "--out", (folder / "a.png").string()});
            ASSERT_EQ(result.exit_status, 0) << result.err;
            EXPECT_GT(nlohmann::json::parse(result.out).at("fragments_shaded"), 500)
                << program << ' ' << scale;
        }
}

TEST(LessonApp, HardCase_ModelBeyondWhatCanBeDrawnIsAnError) {
    const auto folder = fresh_folder("app");
    struct Extreme {
        const char *positions, *says;
    };
    for (const auto& [positions, says] :
         {Extreme{"v -3e38 0 0\nv 3e38 0 0\nv 0 3e38 0\n", "measures 6.7082e+38"},
          {"v -3e38 -3e38 -3e38\nv 3e38 3e38 3e38\nv 0 3e38 0\n", "measures 1.03923e+39"},
          {"v 2e38 2e38 2e38\nv 3e38 2e38 2e38\nv 2e38 3e38 2e38\n", "measures 1.41421e+38"},
          {"v 0 0 0\nv 1e-44 0 0\nv 0 1e-44 0\n", "measures 1.38"}}) {
        std::ofstream(folder / "a.obj") << positions << "f 1 2 3\n";
        for (const char* program : {lesson, "04_mvp", "11_scenes"})
            expect_error(run_program(program, {"--model", (folder / "a.obj").string(), "--out",
                                               (folder / "a.png").string()}),
                         1, says);
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
}

TEST(LessonApp, WarningsOfTheModelAreShown) {
    const auto folder = fresh_folder("app");
    std::ofstream(folder / "a.obj") << "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const ProcessResult result =
        run_program(lesson, {"--size", "8x8", "--model", (folder / "a.obj").string(), "--out",
                             (folder / "a.png").string()});
    EXPECT_EQ(result.exit_status, 0);
    EXPECT_EQ(result.err.rfind("warning: " + (folder / "a.obj").string() + ":1: ", 0), 0u)
        << result.err;
}

TEST(LessonApp, FramesAreThePicturesOfTheirYaw) {
    const auto folder = fresh_folder("app");
    ASSERT_EQ(run_program("04_mvp", {"--size", "64x48", "--yaw", "-28", "--frames", "4", "--out",
                                     (folder / "turn_%d.png").string()})
                  .exit_status,
              0);
    for (int frame = 0; frame < 4; ++frame) {
        const auto alone = folder / "alone.png";
        run_program("04_mvp", {"--size", "64x48", "--yaw", std::to_string(-28 + 90 * frame),
                               "--out", alone.string()});
        EXPECT_EQ(read_image(folder / ("turn_" + std::to_string(frame) + ".png")),
                  read_image(alone))
            << frame;
    }
}

TEST(LessonApp, HardCase_BadOptionsOfTheCameraAreExitStatus2) {
    const std::string out = (fresh_folder("app") / "a.png").string();
    const auto status_2 = [&](const std::string& option, const std::string& word) {
        expect_error(run_program("04_mvp", {"--size", "8x8", "--out", out, option, word}), 2,
                     option);
    };
    for (const char* word : {"200", "0", "171", "nan", "-35", ""}) status_2("--fov", word);
    for (const char* word : {"x", "91", "-90.5", "inf", "20x"}) status_2("--pitch", word);
    for (const char* word : {"x", "1e9", "nan"}) status_2("--yaw", word);
    for (const char* word : {"0", "-1", "1e7", "x"}) status_2("--distance", word);
    for (const char* word : {"x", "1e9", "nan", ""}) status_2("--turn", word);
    for (const char* word : {"0", "10000", "2.5", "x"}) status_2("--frames", word);
    expect_error(run_program("04_mvp", {"--frames", "2", "--size", "8x8", "--out", out}), 2,
                 "--out");
    EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(LessonApp, HardCase_CameraAndPictureAtTheirLimits) {
    const std::string out = (fresh_folder("app") / "a.png").string();
    for (const auto& [option, word] :
         std::vector<std::pair<std::string, std::string>>{{"--pitch", "90"},
                                                          {"--pitch", "-90"},
                                                          {"--fov", "170"},
                                                          {"--fov", "1"},
                                                          {"--distance", "0.01"},
                                                          {"--distance", "1"},
                                                          {"--yaw", "36000"},
                                                          {"--size", "1x1"},
                                                          {"--size", "1x40"},
                                                          {"--size", "40x1"}}) {
        const ProcessResult result = run_program("04_mvp", {"--stats", "--out", out, option, word});
        ASSERT_EQ(result.exit_status, 0) << result.err;
        EXPECT_GT(nlohmann::json::parse(result.out).at("fragments_shaded"), 0)
            << option << ' ' << word;
    }
}
