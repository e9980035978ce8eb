// SPDX-License-Identifier: MIT
// The warning that nothing of a model is to be seen names what became of it.
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/gltf_builder.hpp"
#include "support/lesson_process.hpp"

using namespace rasterbook::test;

TEST(EmptyPicture, TheWarningSaysWhyNothingIsToBeSeen) {
    const auto folder = fresh_folder("empty");
    const std::string triangle = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\n";
    std::ofstream(folder / "clear.mtl") << "newmtl a\nKd 1 0 0\nTr 1\n";
    struct Empty {
        const char* programs;
        std::string obj, options, why;
    };
    for (const auto& [programs, obj, options, why] :
         {Empty{"02_triangle_fill 03_z_buffer", triangle + "f 3 2 1\n", "",
                "1 triangle seen from behind (named clockwise?) or without area"},
          {"04_mvp 06_phong 10_threading 14_simd", triangle + "f 3 2 1\nf 1 3 2\n", "",
           "2 triangles seen from behind (named clockwise?)"},
          {"04_mvp 10_threading 14_simd", triangle + "f 1 2 1\nf 3 2 1\n", "",
           "1 triangle seen from behind (named clockwise?), 1 triangle without area on the screen"},
          {"06_phong 11_scenes 14_simd", "v -1 0 1\nv 1 0 1\nv 0 0 -1\nf 1 2 3\n",
           "--pitch 0 --two-sided", "1 triangle without area on the screen"},
          {"04_mvp 13_visibility_buffer", "v -1 0 0\nv 1 0 0\nv 1 .001 0\nf 1 2 3\n", "--pitch 0",
           "its triangles cover no pixel's centre"},
          {"04_mvp 11_scenes 14_simd", "v -8e36 -8e36 0\nv 8e36 -8e36 0\nv 0 8e36 0\nf 1 2 3\n",
           "--distance 90", "1 triangle too large or too far away for single precision"},
          {"11_scenes 13_visibility_buffer 14_simd",
           "mtllib clear.mtl\nusemtl a\n" + triangle + "f 1 2 3\n", "",
           "wholly transparent (material \"a\": opacity 0)"},
          // Its corners lie on the triangles' side: they leave pieces without area, which are
          // culled.
          {"11_scenes 13_visibility_buffer 14_simd",
           "mtllib clear.mtl\nusemtl a\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n",
           "--yaw 0 --pitch 0 --distance 2",
           "seen: 4096 fragments wholly transparent (material \"a\": opacity 0)"}}) {
        std::ofstream(folder / "a.obj") << obj;
        std::istringstream words(options), names(programs);
        std::vector<std::string> arguments{"--size",  "64x64",
                                           "--model", (folder / "a.obj").string(),
                                           "--out",   (folder / "a.png").string()};
        for (std::string word; words >> word;) arguments.push_back(word);
        for (std::string program; names >> program;) {
            const ProcessResult result = run_program(program, arguments);
            EXPECT_EQ(result.exit_status, 0) << program << result.err;
            EXPECT_NE(result.err.find("a.obj: nothing of it is to be seen: "), std::string::npos);
            EXPECT_NE(result.err.find(why + "\n"), std::string::npos)
                << program << " says: " << result.err << "instead of: " << why;
        }
    }
}

TEST(EmptyPicture, TheWarningSaysWhyNothingOfAGltfFileIsToBeSeen) {
    const auto folder = fresh_folder("empty");
    struct Empty {
        json material, camera;
        const char* why;
        double zfar = 30;
    };
    const json plain = {{"name", "leaf"}}, facing = {{"translation", {0.3, 0.3, 2}}};
    const json masked = {{"name", "leaf"}, {"alphaMode", "MASK"}, {"alphaCutoff", 1.1}};
    const json clear = {{"name", "leaf"},
                        {"alphaMode", "BLEND"},
                        {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0}}}}};
    for (const auto& [material, camera, why, zfar] :
         {Empty{masked, facing, " fragments failed by the alpha test"},
          {clear, facing, " fragments wholly transparent (material \"leaf\": opacity 0)"},
          {plain, {{"translation", {0, 0, -2}}}, ": 1 triangle behind the camera"},
          {plain, facing, " fragments beyond the camera's far plane", 1.5},
          {plain, {{"translation", {9, 0, 2}}}, ": 1 triangle outside of the camera's view"}}) {
        GltfBuilder made = one_triangle();
        made.material() = material;
        made.document["cameras"] = {
            {{"type", "perspective"},
             {"perspective", {{"yfov", 0.9}, {"znear", 0.01}, {"zfar", zfar}}}}};
        made.document["nodes"].push_back(camera);
        made.document["nodes"][1]["camera"] = 0;
        made.document["scenes"][0]["nodes"] = {0, 1};
        made.write(folder / "a.gltf");
        for (const char* program : {"11_scenes", "13_visibility_buffer", "14_simd"}) {
            const ProcessResult result =
                run_program(program, {"--size", "64x48", "--model", (folder / "a.gltf").string(),
                                      "--out", (folder / "a.png").string()});
            EXPECT_NE(result.err.find(std::string(why) + "\n"), std::string::npos)
                << program << " says: " << result.err << "instead of: " << why;
        }
    }
}
