// SPDX-License-Identifier: MIT
// Small files that ask for much: each is drawn, or is refused in one line, in little time and
// memory.
#include <sys/resource.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/lesson_process.hpp"
#include "support/sanitizer.hpp"

using namespace rasterbook::test;

namespace {

namespace fs = std::filesystem;

/// Texts that repeat what write(i) gives.
std::string repeated(int times, const std::function<std::string(int)>& write) {
    std::string all;
    for (int i = 0; i < times; ++i) all += write(i);
    return all;
}

/// A text many times; in each, `@` stands for its number, from 0, and `@+2` for two more.
std::string repeated(int times, const std::string& text) {
    return repeated(times, [&](int i) {
        std::string one = text;
        for (std::size_t at = 0; (at = one.find('@', at)) != one.npos;) {
            const bool is_more = one.size() > at + 2 && one[at + 1] == '+';
            const int more = is_more ? one[at + 2] - '0' : 0;
            one.replace(at, is_more ? 3 : 1, std::to_string(i + more));
        }
        return one;
    });
}

/// The same between commas.
std::string list_of(int times, const std::string& text) {
    std::string all = repeated(times, text + ",");
    all.pop_back();
    return all;
}

std::string big_endian(std::uint32_t number) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift);
    return bytes;
}

std::string little_endian(std::size_t number) {
    const std::string bytes = big_endian(std::uint32_t(number));
    return {bytes.rbegin(), bytes.rend()};
}

std::string png_chunk(const std::string& name, const std::string& content) {
    const std::string both = name + content;
    const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(both.data()), uInt(both.size()));
    return big_endian(std::uint32_t(content.size())) + both + big_endian(std::uint32_t(sum));
}

/// A black picture with one bit a pixel: about a thousand times as large unpacked.
std::string black_png(std::uint32_t side) {
    const std::string rows(std::size_t{side} * (1 + (side + 7) / 8), '\0');
    std::string packed(compressBound(rows.size()), '\0');
    uLongf length = packed.size();
    compress2(reinterpret_cast<Bytef*>(packed.data()), &length,
              reinterpret_cast<const Bytef*>(rows.data()), rows.size(), 9);
    packed.resize(length);
    return "\x89PNG\r\n\x1a\n" +
           png_chunk("IHDR", big_endian(side) + big_endian(side) + std::string("\1\0\0\0\0", 5)) +
           png_chunk("IDAT", packed) + png_chunk("IEND", "");
}

/// A triangle, and a small one: what is drawn takes its time, and that is not what is tried here.
const std::string corners =
    "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nv -.01 -.01 .1\nv .01 -.01 .1\nv 0 .01 .1\nf 1 2 3\n";
const std::string small = "f 4 5 6\n";

/// An OBJ file of such points and faces, and other files.
Files obj(const std::string& faces, Files others = {}) {
    others["model.obj"] = corners + faces;
    return others;
}

/// The same, whose faces have the material m.
Files obj_with(const std::string& material, const std::string& faces, Files others = {}) {
    others["one.mtl"] = "newmtl m\n" + material + "\n";
    others["model.obj"] = "mtllib one.mtl\nusemtl m\n" + corners + faces;
    return others;
}

/// Points around (0, 0), written as vertices of OBJ.
std::string around(int count, const std::function<double(int)>& turns,
                   const std::function<double(int)>& radius) {
    return repeated(count, [&](int i) {
        const double angle = 6.2831853 * turns(i);
        return "v " + std::to_string(radius(i) * std::cos(angle)) + " " +
               std::to_string(radius(i) * std::sin(angle)) + " 0\n";
    });
}

/// A triangle's positions, then its uvs.
std::string triangle_bytes() {
    const float numbers[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0, 0, 0, 1, 0, 0.5f, 1};
    return {reinterpret_cast<const char*>(numbers), sizeof numbers};
}

const std::string one_node = R"({"mesh":0})";
const std::string attributes = R"("attributes":{"POSITION":0,"TEXCOORD_0":1})";
/// Two nodes of one mesh, so that each is small in the picture.
const std::string far_apart = R"({"mesh":0},{"mesh":0,"translation":[200,0,0]})";

/// A scene of that triangle.
///
/// @param more                Further members of the document, each with a comma before it.
/// @param nodes,primitives    Lists.
/// @param buffers,views       What their lists hold beside the triangle's.
std::string scene_of(const std::string& more, const std::string& nodes = one_node,
                     const std::string& primitives = "{" + attributes + "}",
                     const std::string& buffers = "", const std::string& views = "") {
    return R"({"asset":{"version":"2.0"},"buffers":[{"uri":"triangle.bin","byteLength":60})" +
           buffers +
           R"(],"bufferViews":[{"buffer":0,"byteLength":36},)"
           R"({"buffer":0,"byteOffset":36,"byteLength":24})" +
           views +
           R"(],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
           R"({"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}],)"
           R"("meshes":[{"primitives":[)" +
           primitives + R"(]}],"nodes":[)" + nodes + "]" + more + "}";
}

Files gltf(const std::string& scene, Files others = {}) {
    others.insert({"triangle.bin", triangle_bytes()});
    others["model.gltf"] = scene;
    return others;
}

/// Materials with a texture each, of an image each.
std::string textured(int count, const std::string& image,
                     const std::string& which = "baseColorTexture") {
    return R"(,"images":[)" + list_of(count, image) + R"(],"textures":[)" +
           list_of(count, R"({"source":@})") + R"(],"materials":[)" +
           list_of(count, R"({"pbrMetallicRoughness":{")" + which + R"(":{"index":@}}})") + "]";
}

/// Primitives with a material each.
std::string primitives_of_materials(int count) {
    return list_of(count, "{" + attributes + R"(,"material":@})");
}

struct GreedyFile {
    const char* name;
    std::function<Files()> make;  ///< Among them the model.
    const char* error = "";       ///< A part of it; empty: it is drawn.
    std::vector<std::string> options{};
};
void PrintTo(const GreedyFile& file, std::ostream* out) { *out << file.name; }

Files with_a_huge_picture() {
    return obj_with("map_Kd black.png", small, {{"black.png", black_png(23'170)}});
}

Files with_many_cameras() {
    return gltf(
        scene_of(R"(,"cameras":[{"type":"perspective","perspective":)"
                 R"({"yfov":1,"znear":0.1}}])",
                 one_node + "," + list_of(100'000, R"({"camera":0,"translation":[0,0,3]})")));
}

Files with_materials(int count, const std::string& faces) {
    return obj("mtllib many.mtl\n" + faces, {{"many.mtl", repeated(count, "newmtl m@\n")}});
}

const std::vector<GreedyFile> files = {
    {"TheSameFaceWithoutNormals", [] { return obj(repeated(300'000, small)); }},
    {"AConeWithoutNormals",
     [] {
         constexpr int sides = 100'000;
         const std::string circle =
             around(sides + 1, [](int i) { return double(i) / sides; }, [](int) { return 1; });
         return Files{{"model.obj", "v 0 0 1\n" + circle + repeated(sides, "f 1 @+2 @+3\n")}};
     }},
    {"APolygonReturnsToAPoint",
     [] {
         constexpr int petals = 33'000;  // in clockwise order, each counter-clockwise
         const std::string points = around(
             2 * petals, [](int i) { return -(i / 2 - 0.4 * (i % 2)) / petals; },
             [](int) { return 1; });
         return Files{{"model.obj", "v 0 0 0\n" + points + "f" + repeated(petals, [](int i) {
                                        return " 1 " + std::to_string(2 + 2 * i) + " " +
                                               std::to_string(3 + 2 * i);
                                    }) + "\n"}};
     },
     "returns to one point"},
    {"APolygonOfManyCorners",
     [] {
         constexpr int count = 200'000;
         const std::string points = around(
             count, [](int i) { return double(i) / count; },
             [](int i) { return i % 2 == 0 ? 1 : 0.9; });
         return Files{{"model.obj", points + "f" + repeated(count, " @+1") + "\n"}};
     }},
    {"MaterialsThatAreUsed",
     [] { return with_materials(199'000, repeated(199'000, "usemtl m@\n" + small)); }},
    {"MaterialsThatNobodyUses", [] { return with_materials(100'000, small); }},
    {"MaterialsWithoutEnd", [] { return with_materials(1'000'000, small); }, "--limit materials="},
    {"MaterialsThatAreNotThere", [] { return obj(repeated(200'000, "usemtl m@\n" + small)); }},
    {"Groups", [] { return obj(repeated(100'000, "g g@\n" + small)); }},
    {"LibrariesThatAreNotThere",
     [] { return obj("mtllib" + repeated(50'000, " m@") + "\n" + small); }},
    {"OneLibraryManyTimes",
     [] {
         return obj(repeated(50'000, "mtllib one.mtl\n") + small,
                    {{"one.mtl", repeated(1'000, "newmtl a\nKd 1 0 0\n")}});
     }},
    {"PicturesOfOneFile",
     [] {
         return obj("mtllib many.mtl\n" + repeated(2'000, "usemtl m@\n" + small),
                    {{"black.png", black_png(4'096)},
                     {"many.mtl", repeated(2'000, "newmtl m@\nmap_Kd black.png\n")}});
     }},
    {"AHugePicture", with_a_huge_picture, "--limit pixels="},
    {"AHugePictureIsPassedOver", with_a_huge_picture, "", {"--keep-going"}},
    {"ManyLargePictures",
     [] {
         Files made = gltf(scene_of(textured(10, R"({"uri":"black@.png"})"), one_node,
                                    primitives_of_materials(10)));
         const std::string png = black_png(4'096);
         for (int i = 0; i < 10; ++i) made["black" + std::to_string(i) + ".png"] = png;
         return made;
     },
     "--limit pixels="},
    {"AHugePictureOfRoughness",
     [] {
         return gltf(scene_of(textured(1, R"({"uri":"black.png"})", "metallicRoughnessTexture"),
                              one_node, primitives_of_materials(1)),
                     {{"black.png", black_png(23'170)}});
     }},
    {"ImagesThatShareAFile",
     [] {
         return gltf(scene_of(textured(2'000, R"({"uri":"black.png"})"), far_apart,
                              primitives_of_materials(2'000)),
                     {{"black.png", black_png(2'048)}});
     }},
    {"ImagesThatShareAView",
     [] {
         const std::string png = black_png(2'048), size = std::to_string(png.size());
         return gltf(scene_of(textured(2'000, R"({"bufferView":2,"mimeType":"image/png"})"),
                              far_apart, primitives_of_materials(2'000),
                              R"(,{"uri":"black.png","byteLength":)" + size + "}",
                              R"(,{"buffer":1,"byteLength":)" + size + "}"),
                     {{"black.png", png}});
     }},
    {"BuffersOfOneFile",
     [] {
         return gltf(scene_of("", one_node, "{" + attributes + "}",
                              repeated(10'000, R"(,{"uri":"zeros.bin","byteLength":1500000})")),
                     {{"zeros.bin", std::string(1'500'000, '\0')}});
     },
     "--limit bytes="},
    {"BuffersOfOneBlock",
     [] {
         std::string text = scene_of("", one_node, "{" + attributes + "}",
                                     repeated(20'000, R"(,{"byteLength":1000000})"));
         const std::string uri = R"("uri":"triangle.bin",)", block(1'000'000, '\0');
         text.erase(text.find(uri), uri.size());
         text.resize((text.size() + 3) / 4 * 4, ' ');
         return Files{{"model.glb",
                       "glTF" + little_endian(2) + little_endian(28 + text.size() + block.size()) +
                           little_endian(text.size()) + "JSON" + text +
                           little_endian(block.size()) + std::string("BIN\0", 4) + block}};
     },
     "--limit bytes="},
    {"NodesTimesPrimitives",
     [] {
         return gltf(scene_of("", list_of(20'000, one_node),
                              list_of(20'000, R"({"attributes":{"POSITION":0},"mode":0})")));
     },
     "--limit primitives="},
    {"NodesTimesVertices",
     [] {
         return gltf(scene_of("", list_of(20'000, one_node), list_of(400, "{" + attributes + "}")));
     },
     "--limit primitives="},
    {"VerticesOfManyNodes",
     [] {
         std::string scene = scene_of("", list_of(20'000, one_node));
         for (const std::string number :
              {R"("count":3)", R"("byteLength":60)", R"("byteLength":36)", R"("byteOffset":36)",
               R"("byteLength":24)"})
             for (std::size_t at = 0; (at = scene.find(number, at)) != scene.npos;)
                 scene.insert(at += number.size(), "000");
         return gltf(scene, {{"triangle.bin", repeated(1'000, triangle_bytes())}});
     },
     "--limit vertices="},
    {"AChainOfNodes",
     [] {
         return gltf(scene_of(R"(,"scenes":[{"nodes":[0]}])",
                              repeated(200'000, R"({"children":[@+1]},)") + one_node));
     }},
    {"NodesWithoutEnd", [] { return gltf(scene_of("", list_of(1'500'000, "{}"))); },
     "--limit objects="},
    {"MaterialsOfAFewLetters",
     [] { return gltf(scene_of(R"(,"materials":[)" + list_of(1'000'000, "{}") + "]")); },
     "--limit materials="},
    {"PrimitivesOfAFewLetters",
     [] { return gltf(scene_of("", one_node, list_of(2'000'000, "{}"))); }, "--limit objects="},
    {"ExtensionsThatNobodyKnows",
     [] {
         return gltf(scene_of(R"(,"extensionsUsed":[)" + list_of(200'000, R"("EXT_@")") + "]"));
     }},
    {"Lights",
     [] {
         const std::string light =
             R"(,{"name":"l@","extensions":{"KHR_lights_punctual":{"light":0}}})";
         return gltf(scene_of(R"(,"extensionsUsed":["KHR_lights_punctual"],"extensions":)"
                              R"({"KHR_lights_punctual":{"lights":[{"type":"directional"}]}})",
                              one_node + repeated(100'000, light)));
     }},
    {"Cameras", with_many_cameras},
    {"CamerasOfWhichNoneIsAskedFor", with_many_cameras, "there is no camera", {"--camera", "none"}},
    {"TilesOfAFewPixels",
     [] { return obj(repeated(20, "f 1 2 3\n")); },
     "",
     {"--size", "4096x4096", "--tile", "8", "--shadow-size", "8192"}},
    {"GlassBehindGlass", [] { return obj_with("d 0.5", repeated(300, "f 1 2 3\n")); }},
    {"PanesWithoutEnd", [] { return obj_with("d 0.5", repeated(300'000, "f 1 2 3\n")); },
     "--limit overdraw="},
    {"ManyPanesInAFewPixels", [] { return obj_with("d 0.5", repeated(300'000, small)); }},
    {"ShadowsOfWhatIsNotSeen",  // the faces are seen from behind
     [] { return obj(repeated(300'000, "f 3 2 1\n")); }, "--limit overdraw="},
    {"SliversThroughAllTiles",
     [] { return obj("v 1 1 0\nv 1 .9999 0\n" + repeated(300'000, "f 1 8 7\n")); },
     "--limit overdraw=",
     {"--size", "2048x2048", "--tile", "8", "--shadow-size", "8192"}},
    {"LargeTrianglesInSmallTiles",
     [] { return obj(repeated(100, "f 1 2 3\n")); },
     "",
     {"--size", "2048x2048", "--tile", "8"}},
    {"NamesOfAMillionLetters",
     [] {
         const std::string name(1'000'000, 'x');
         return obj("mtllib one.mtl\nmtllib " + name + "\nusemtl " + name + "\n" + small +
                        repeated(20, "usemtl @" + name + "\n" + small),
                    {{"one.mtl", "newmtl " + name + "\nmap_d " + name + "\n"}});
     }},
    {"NamesOfAMillionLettersInGltf",
     [] {
         const std::string name = '"' + std::string(1'000'000, 'x') + '"';
         return gltf(scene_of(R"(,"extensionsUsed":[)" + name + R"(],"images":[{"uri":)" + name +
                                  R"(}],"textures":[{"source":0}],"materials":[{"name":)" + name +
                                  R"(,"normalTexture":{"index":0}}])",
                              R"({"mesh":0,"name":)" + name + "}", primitives_of_materials(1)));
     },
     "xxx"},
    {"ALineOfAMillionLines", [] { return obj("f" + repeated(1'000'000, "\\\n") + " 4 5 6\n"); }},
    {"ALineOfHashes", [] { return obj("o " + repeated(3'000'000, "a#") + "\n" + small); }},
    {"APictureOfOnePixelThatUnpacksToGigabytes",
     [] {
         const std::size_t header = 8 + 25;  // the signature and IHDR
         return obj_with(
             "map_Kd black.png", small,
             {{"black.png", black_png(1).substr(0, header) + black_png(46'000).substr(header)}});
     }},
    {"AHugePictureInRuns",
     [] {
         constexpr int side = 23'040;  // grey, in runs of 128 pixels
         const std::string sides = {char(side & 255), char(side >> 8)};
         return obj_with(
             "map_Kd grey.tga", small,
             {{"grey.tga", std::string("\0\0\x0b\0\0\0\0\0\0\0\0\0", 12) + sides + sides +
                               std::string("\x08\0", 2) + repeated(side / 128 * side, "\xffg")}});
     },
     "--limit pixels="},
    {"MorphTargetsThatNobodyUses",
     [] {
         return gltf(scene_of("", one_node,
                              R"({"attributes":{"POSITION":0},"targets":[)" +
                                  list_of(200'000, R"({"POSITION":0})") + "]}"));
     }},
    {"AChildOfAllNodes",
     [] { return gltf(scene_of("", one_node + repeated(50'000, R"(,{"children":[0]})"))); },
     "has two parents"},
    {"ChildrenOfOneNode",
     [] {
         const auto leaf = [](int i) {
             return R"(,{"mesh":0,"translation":[)" + std::to_string(2 * (i % 300)) + "," +
                    std::to_string(2 * (i / 300)) + ",0]}";
         };
         return gltf(scene_of(
             "", R"({"children":[)" + list_of(100'000, "@+1") + "]}" + repeated(100'000, leaf)));
     }},
    {"OutlinesOfManyMaterials",
     [] {
         const std::string material =
             R"({"extensions":{"VRMC_materials_mtoon":)"
             R"({"outlineWidthMode":"worldCoordinates","outlineWidthFactor":0.01}}})";
         return gltf(scene_of(R"(,"extensionsUsed":["VRMC_materials_mtoon"],"materials":[)" +
                                  list_of(50'000, material) + "]",
                              far_apart, primitives_of_materials(50'000)));
     }},
};

class GreedyFiles : public testing::TestWithParam<GreedyFile> {};

}  // namespace

TEST_P(GreedyFiles, HardCase_AreDrawnOrRefusedWithinBounds) {
    const GreedyFile& file = GetParam();
    const fs::path folder = fresh_folder("greedy");
    fs::path model;
    for (const auto& [name, bytes] : file.make()) {
        std::ofstream(folder / name, std::ios::binary) << bytes;
        if (name.starts_with("model.")) model = folder / name;
    }
    // They take up to 10 s on the course's machine; without an end, none of them should go on.
    std::vector<std::string> arguments = {"60",      std::string(RASTERBOOK_LESSONS) + "/11_scenes",
                                          "--model", model,
                                          "--out",   folder / "picture.png"};
    if (file.options.size() < 3) arguments.insert(arguments.end(), {"--size", "320x180"});
    arguments.insert(arguments.end(), file.options.begin(), file.options.end());
    const ProcessResult result = run_program("/usr/bin/timeout", arguments);
    if (*file.error == '\0') {
        ASSERT_EQ(result.exit_status, 0) << result.err.substr(0, 2000);
        EXPECT_TRUE(fs::exists(folder / "picture.png"));
    } else {
        ASSERT_EQ(result.exit_status, 1) << result.err.substr(0, 2000);
        const std::string last = result.err.substr(result.err.rfind("error: "));
        EXPECT_NE(last.find(file.error), std::string::npos) << last.substr(0, 2000);
        EXPECT_LT(last.size(), 1100u) << "an error is a line";
    }
    EXPECT_LE(std::ranges::count(result.err, '\n'), 202) << "warnings, and that there are more";
    if (!is_sanitized) {
        rusage children{};
        getrusage(RUSAGE_CHILDREN, &children);
        EXPECT_LT(children.ru_maxrss, 2'000'000) << "KiB of memory";
    }
    fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(All, GreedyFiles, testing::ValuesIn(files),
                         [](const auto& test) { return test.param.name; });
