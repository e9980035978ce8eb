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
std::string repeated(int times, const std::string& text) {
    return repeated(times, [&](int) { return text; });
}

/// The same between commas.
std::string list_of(int times, const std::function<std::string(int)>& write) {
    return repeated(times, [&](int i) { return (i == 0 ? "" : ",") + write(i); });
}

fs::path written(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    return file;
}

std::string big_endian(std::uint32_t number) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift);
    return bytes;
}

std::string little_endian(std::uint32_t number) {
    const std::string bytes = big_endian(number);
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

/// Of a triangle: its positions, then its uvs.
std::string triangle_bytes() {
    const float numbers[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0, 0, 0, 1, 0, 0.5f, 1};
    return {reinterpret_cast<const char*>(numbers), sizeof numbers};
}

/// A scene of that triangle, with more members of the document.
///
/// @param nodes,meshes  Lists.
std::string scene_of(const std::string& more, const std::string& nodes = R"({"mesh":0})",
                     const std::string& meshes = "") {
    const std::string triangle = R"({"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1}}]})";
    return R"({"asset":{"version":"2.0"},"buffers":[{"uri":"triangle.bin","byteLength":60}],)"
           R"("bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24}],)"
           R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
           R"({"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}],)"
           R"("meshes":[)" +
           (meshes.empty() ? triangle : meshes) + R"(],"nodes":[)" + nodes + "]" +
           (more.empty() ? "" : "," + more) + "}";
}

struct GreedyFile {
    const char* name;
    std::function<fs::path(const fs::path&)> write;  ///< Into a folder; gives the model.
    const char* error = "";                          ///< A part of it; empty: it is drawn.
    std::vector<std::string> options{};
};
void PrintTo(const GreedyFile& file, std::ostream* out) { *out << file.name; }

/// A triangle, and a small one: what is drawn takes its time, and that is not what is tried here.
const std::string corners =
    "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nv -.01 -.01 .1\nv .01 -.01 .1\nv 0 .01 .1\nf 1 2 3\n";

fs::path obj(const fs::path& folder, const std::string& text) {
    return written(folder / "model.obj", text);
}

fs::path gltf(const fs::path& folder, const std::string& text) {
    written(folder / "triangle.bin", triangle_bytes());
    return written(folder / "model.gltf", text);
}

/// A .glb whose block of so many bytes is each buffer's.
fs::path glb(const fs::path& folder, std::string text, std::size_t bytes) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::string block(bytes, '\0');
    const std::string chunks = little_endian(std::uint32_t(text.size())) + "JSON" + text +
                               little_endian(std::uint32_t(bytes)) + std::string("BIN\0", 4) +
                               block;
    return written(
        folder / "model.glb",
        "glTF" + little_endian(2) + little_endian(std::uint32_t(12 + chunks.size())) + chunks);
}

/// Two nodes of one mesh, so that each is small in the picture.
const std::string far_apart = R"({"mesh":0},{"mesh":0,"translation":[200,0,0]})";

/// Materials with a texture each, of an image each.
std::string textured(int count, const std::function<std::string(int)>& image,
                     const std::string& which = R"("baseColorTexture")") {
    const auto number = [](const std::string& before, const std::string& after) {
        return [=](int i) { return before + std::to_string(i) + after; };
    };
    return R"("images":[)" + list_of(count, image) + R"(],"textures":[)" +
           list_of(count, number(R"({"source":)", "}")) + R"(],"materials":[)" +
           list_of(count, number(R"({"pbrMetallicRoughness":{)" + which + R"(:{"index":)", "}}}")) +
           "]";
}

/// One mesh whose primitives have a material each.
std::string mesh_of_materials(int count) {
    return R"({"primitives":[)" +
           list_of(count,
                   [](int i) {
                       return R"({"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":)" +
                              std::to_string(i) + "}";
                   }) +
           "]}";
}

void write_materials(const fs::path& folder, int count) {
    written(folder / "many.mtl",
            repeated(count, [](int i) { return "newmtl m" + std::to_string(i) + "\n"; }));
}

fs::path with_a_huge_picture(const fs::path& folder) {
    written(folder / "black.png", black_png(23'170));
    written(folder / "one.mtl", "newmtl m\nmap_Kd black.png\n");
    return obj(folder, "mtllib one.mtl\nusemtl m\n" + corners + "f 4 5 6\n");
}

fs::path with_many_cameras(const fs::path& folder) {
    const std::string camera = R"({"type":"perspective","perspective":{"yfov":1,"znear":0.1}})";
    return gltf(folder, scene_of(R"("cameras":[)" + camera + "]",
                                 R"({"mesh":0},)" + list_of(100'000, [](int) {
                                     return R"({"camera":0,"translation":[0,0,3]})";
                                 })));
}

const std::vector<GreedyFile> files = {
    {"TheSameFaceWithoutNormals",
     [](const fs::path& folder) { return obj(folder, corners + repeated(300'000, "f 4 5 6\n")); }},
    {"AConeWithoutNormals",
     [](const fs::path& folder) {
         constexpr int sides = 100'000;
         return obj(folder, "v 0 1 0\n" + repeated(sides, [](int i) {
                                const double angle = 6.2831853 * i / sides;
                                return "v " + std::to_string(std::cos(angle)) + " 0 " +
                                       std::to_string(-std::sin(angle)) + "\n";
                            }) + repeated(sides, [](int i) {
                                return "f 1 " + std::to_string(2 + i) + " " +
                                       std::to_string(2 + (i + 1) % sides) + "\n";
                            }));
     }},
    {"APolygonReturnsToAPoint",
     [](const fs::path& folder) {
         constexpr int petals = 33'000;  // in clockwise order, each counter-clockwise
         return obj(folder, "v 0 0 0\n" +
                                repeated(2 * petals,
                                         [](int i) {
                                             const double angle =
                                                 -6.2831853 * (i / 2 - 0.4 * (i % 2)) / petals;
                                             return "v " + std::to_string(std::cos(angle)) + " " +
                                                    std::to_string(std::sin(angle)) + " 0\n";
                                         }) +
                                "f" +
                                repeated(petals,
                                         [](int i) {
                                             return " 1 " + std::to_string(2 + 2 * i) + " " +
                                                    std::to_string(3 + 2 * i);
                                         }) +
                                "\n");
     },
     "returns to one point"},
    {"APolygonOfManyCorners",
     [](const fs::path& folder) {
         constexpr int count = 200'000;
         return obj(folder,
                    repeated(count,
                             [](int i) {
                                 const double angle = 6.2831853 * i / count;
                                 const double radius = i % 2 == 0 ? 1 : 0.9;
                                 return "v " + std::to_string(radius * std::cos(angle)) + " " +
                                        std::to_string(radius * std::sin(angle)) + " 0\n";
                             }) +
                        "f" + repeated(count, [](int i) { return " " + std::to_string(i + 1); }) +
                        "\n");
     }},
    {"MaterialsThatAreUsed",
     [](const fs::path& folder) {
         write_materials(folder, 199'000);
         return obj(folder, "mtllib many.mtl\n" + corners + repeated(199'000, [](int i) {
                                return "usemtl m" + std::to_string(i) + "\nf 4 5 6\n";
                            }));
     }},
    {"MaterialsThatNobodyUses",
     [](const fs::path& folder) {
         write_materials(folder, 100'000);
         return obj(folder, "mtllib many.mtl\n" + corners + "f 4 5 6\n");
     }},
    {"MaterialsWithoutEnd",
     [](const fs::path& folder) {
         write_materials(folder, 1'000'000);
         return obj(folder, "mtllib many.mtl\n" + corners + "f 4 5 6\n");
     },
     "--limit materials="},
    {"MaterialsThatAreNotThere",
     [](const fs::path& folder) {
         return obj(folder, corners + repeated(200'000, [](int i) {
                                return "usemtl m" + std::to_string(i) + "\nf 4 5 6\n";
                            }));
     }},
    {"Groups",
     [](const fs::path& folder) {
         return obj(folder, corners + repeated(100'000, [](int i) {
                                return "g g" + std::to_string(i) + "\nf 4 5 6\n";
                            }));
     }},
    {"LibrariesThatAreNotThere",
     [](const fs::path& folder) {
         return obj(folder, "mtllib" +
                                repeated(50'000, [](int i) { return " m" + std::to_string(i); }) +
                                "\n" + corners + "f 4 5 6\n");
     }},
    {"OneLibraryManyTimes",
     [](const fs::path& folder) {
         written(folder / "one.mtl", repeated(1'000, "newmtl a\nKd 1 0 0\n"));
         return obj(folder, repeated(50'000, "mtllib one.mtl\n") + corners + "f 4 5 6\n");
     }},
    {"PicturesOfOneFile",
     [](const fs::path& folder) {
         written(folder / "black.png", black_png(4'096));
         written(folder / "many.mtl", repeated(2'000, [](int i) {
                     return "newmtl m" + std::to_string(i) + "\nmap_Kd black.png\n";
                 }));
         return obj(folder, "mtllib many.mtl\n" + corners + repeated(2'000, [](int i) {
                                return "usemtl m" + std::to_string(i) + "\nf 4 5 6\n";
                            }));
     }},
    {"AHugePicture", with_a_huge_picture, "--limit pixels="},
    {"AHugePictureIsPassedOver", with_a_huge_picture, "", {"--keep-going"}},
    {"ManyLargePictures",
     [](const fs::path& folder) {
         const std::string png = black_png(4'096);
         for (int i = 0; i < 10; ++i) written(folder / ("black" + std::to_string(i) + ".png"), png);
         return gltf(folder, scene_of(textured(10,
                                               [](int i) {
                                                   return R"({"uri":"black)" + std::to_string(i) +
                                                          R"(.png"})";
                                               }),
                                      R"({"mesh":0})", mesh_of_materials(10)));
     },
     "--limit pixels="},
    {"AHugePictureOfRoughness",
     [](const fs::path& folder) {
         written(folder / "black.png", black_png(23'170));
         return gltf(folder, scene_of(textured(
                                          1, [](int) { return R"({"uri":"black.png"})"; },
                                          R"("metallicRoughnessTexture")"),
                                      R"({"mesh":0})", mesh_of_materials(1)));
     }},
    {"ImagesThatShareAFile",
     [](const fs::path& folder) {
         written(folder / "black.png", black_png(2'048));
         return gltf(folder, scene_of(textured(2'000, [](int) { return R"({"uri":"black.png"})"; }),
                                      far_apart, mesh_of_materials(2'000)));
     }},
    {"ImagesThatShareAView",
     [](const fs::path& folder) {
         const std::string png = black_png(2'048);
         std::string scene = scene_of(
             textured(2'000, [](int) { return R"({"bufferView":2,"mimeType":"image/png"})"; }),
             far_apart, mesh_of_materials(2'000));
         scene.insert(scene.find(R"(],"accessors")"),
                      R"(,{"buffer":1,"byteLength":)" + std::to_string(png.size()) + "}");
         scene.insert(scene.find(R"(],"bufferViews")"),
                      R"(,{"uri":"black.png","byteLength":)" + std::to_string(png.size()) + "}");
         written(folder / "black.png", png);
         return gltf(folder, scene);
     }},
    {"BuffersOfOneFile",
     [](const fs::path& folder) {
         written(folder / "zeros.bin", std::string(1'500'000, '\0'));
         std::string scene = scene_of("");
         scene.insert(scene.find(R"(],"bufferViews")"), "," + list_of(10'000, [](int) {
                                                            return R"({"uri":"zeros.bin",)"
                                                                   R"("byteLength":1500000})";
                                                        }));
         return gltf(folder, scene);
     },
     "--limit bytes="},
    {"BuffersOfOneBlock",
     [](const fs::path& folder) {
         std::string scene = scene_of("");
         const std::string uri = R"("uri":"triangle.bin",)";
         scene.erase(scene.find(uri), uri.size());
         scene.insert(scene.find(R"(],"bufferViews")"),
                      "," + list_of(20'000, [](int) { return R"({"byteLength":1000000})"; }));
         return glb(folder, scene, 1'000'000);
     },
     "--limit bytes="},
    {"NodesTimesPrimitives",
     [](const fs::path& folder) {
         return gltf(folder, scene_of("", list_of(20'000, [](int) { return R"({"mesh":0})"; }),
                                      R"({"primitives":[)" + list_of(20'000, [](int) {
                                          return R"({"attributes":{"POSITION":0},"mode":0})";
                                      }) + "]}"));
     },
     "--limit primitives="},
    {"NodesTimesVertices",
     [](const fs::path& folder) {
         return gltf(folder, scene_of("", list_of(20'000, [](int) { return R"({"mesh":0})"; }),
                                      R"({"primitives":[)" + list_of(400, [](int) {
                                          return R"({"attributes":{"POSITION":0}})";
                                      }) + "]}"));
     },
     "--limit primitives="},
    {"VerticesOfManyNodes",
     [](const fs::path& folder) {
         std::string scene = scene_of("", list_of(20'000, [](int) { return R"({"mesh":0})"; }));
         const std::string count = R"("count":3)";
         for (std::size_t at = 0; (at = scene.find(count, at)) != std::string::npos; at += 9)
             scene.replace(at, count.size(), R"("count":3000)");
         const auto length = [&](const std::string& from, const std::string& to) {
             scene.replace(scene.find(from), from.size(), to);
         };
         length(R"("byteLength":60)", R"("byteLength":60000)");
         length(R"("byteLength":36)", R"("byteLength":36000)");
         length(R"("byteOffset":36,"byteLength":24)", R"("byteOffset":36000,"byteLength":24000)");
         const fs::path file = gltf(folder, scene);
         written(folder / "triangle.bin", repeated(1'000, triangle_bytes()));
         return file;
     },
     "--limit vertices="},
    {"AChainOfNodes",
     [](const fs::path& folder) {
         constexpr int nodes = 200'000;
         return gltf(folder, scene_of(R"("scenes":[{"nodes":[0]}])", list_of(nodes, [](int i) {
                                          return i + 1 < nodes ? R"({"children":[)" +
                                                                     std::to_string(i + 1) + "]}"
                                                               : R"({"mesh":0})";
                                      })));
     }},
    {"NodesWithoutEnd",
     [](const fs::path& folder) {
         return gltf(folder, scene_of("", list_of(1'500'000, [](int) { return "{}"; })));
     },
     "--limit objects="},
    {"MaterialsOfAFewLetters",
     [](const fs::path& folder) {
         return gltf(folder, scene_of(R"("materials":[)" +
                                      list_of(1'000'000, [](int) { return "{}"; }) + "]"));
     },
     "--limit materials="},
    {"PrimitivesOfAFewLetters",
     [](const fs::path& folder) {
         return gltf(folder, scene_of("", R"({"mesh":0})",
                                      R"({"primitives":[)" +
                                          list_of(2'000'000, [](int) { return "{}"; }) + "]}"));
     },
     "--limit objects="},
    {"ExtensionsThatNobodyKnows",
     [](const fs::path& folder) {
         return gltf(
             folder,
             scene_of(R"("extensionsUsed":[)" +
                      list_of(200'000, [](int i) { return "\"EXT_" + std::to_string(i) + "\""; }) +
                      "]"));
     }},
    {"Lights",
     [](const fs::path& folder) {
         const std::string nodes = R"({"mesh":0},)" + list_of(100'000, [](int i) {
                                       return R"({"name":"l)" + std::to_string(i) +
                                              R"(","extensions":{"KHR_lights_punctual":)"
                                              R"({"light":0}}})";
                                   });
         return gltf(folder, scene_of(R"("extensionsUsed":["KHR_lights_punctual"],)"
                                      R"("extensions":{"KHR_lights_punctual":{"lights":[)"
                                      R"({"type":"directional"}]}})",
                                      nodes));
     }},
    {"Cameras", with_many_cameras},
    {"CamerasOfWhichNoneIsAskedFor", with_many_cameras, "there is no camera", {"--camera", "none"}},
    {"TilesOfAFewPixels",
     [](const fs::path& folder) { return obj(folder, corners + repeated(20, "f 1 2 3\n")); },
     "",
     {"--size", "4096x4096", "--tile", "8", "--shadow-size", "8192"}},
    {"GlassBehindGlass",
     [](const fs::path& folder) {
         written(folder / "one.mtl", "newmtl m\nd 0.5\n");
         return obj(folder, "mtllib one.mtl\nusemtl m\n" + corners + repeated(300, "f 1 2 3\n"));
     }},
    {"PanesWithoutEnd",
     [](const fs::path& folder) {
         written(folder / "one.mtl", "newmtl m\nd 0.5\n");
         return obj(folder,
                    "mtllib one.mtl\nusemtl m\n" + corners + repeated(300'000, "f 1 2 3\n"));
     },
     "--limit overdraw="},
    {"ManyPanesInAFewPixels",
     [](const fs::path& folder) {
         written(folder / "one.mtl", "newmtl m\nd 0.5\n");
         return obj(folder,
                    "mtllib one.mtl\nusemtl m\n" + corners + repeated(300'000, "f 4 5 6\n"));
     }},
    {"ShadowsOfWhatIsNotSeen",  // the faces are seen from behind
     [](const fs::path& folder) { return obj(folder, corners + repeated(300'000, "f 3 2 1\n")); },
     "--limit overdraw="},
    {"SliversThroughAllTiles",
     [](const fs::path& folder) {
         return obj(folder, corners + "v 1 1 0\nv 1 .9999 0\n" + repeated(300'000, "f 1 8 7\n"));
     },
     "--limit overdraw=",
     {"--size", "2048x2048", "--tile", "8", "--shadow-size", "8192"}},
    {"LargeTrianglesInSmallTiles",
     [](const fs::path& folder) { return obj(folder, corners + repeated(100, "f 1 2 3\n")); },
     "",
     {"--size", "2048x2048", "--tile", "8"}},
    {"NamesOfAMillionLetters",
     [](const fs::path& folder) {
         const std::string name(1'000'000, 'x');
         written(folder / "one.mtl", "newmtl " + name + "\nmap_d " + name + "\n");
         return obj(folder, "mtllib one.mtl\nmtllib " + name + "\n" + corners + "usemtl " + name +
                                "\nf 4 5 6\n" + repeated(20, [&](int i) {
                                    return "usemtl " + std::to_string(i) + name + "\nf 4 5 6\n";
                                }));
     }},
    {"NamesOfAMillionLettersInGltf",
     [](const fs::path& folder) {
         const std::string name(1'000'000, 'x');
         return gltf(folder,
                     scene_of(R"("extensionsUsed":[")" + name + R"("],"images":[{"uri":")" + name +
                                  R"("}],"textures":[{"source":0}],"materials":[{"name":")" + name +
                                  R"(","normalTexture":{"index":0}}])",
                              R"({"mesh":0,"name":")" + name + R"("})",
                              R"({"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},)"
                              R"("material":0}]})"));
     },
     "xxx"},
    {"ALineOfAMillionLines",
     [](const fs::path& folder) {
         return obj(folder, corners + "f" + repeated(1'000'000, "\\\n") + " 4 5 6\n");
     }},
    {"ALineOfHashes",
     [](const fs::path& folder) {
         return obj(folder, corners + "o " + repeated(3'000'000, "a#") + "\nf 4 5 6\n");
     }},
    {"APictureOfOnePixelThatUnpacksToGigabytes",
     [](const fs::path& folder) {
         std::string png = black_png(46'000);
         const std::string small = black_png(1);
         const std::size_t header = 8 + 25;  // the signature and IHDR
         written(folder / "black.png", small.substr(0, header) + png.substr(header));
         written(folder / "one.mtl", "newmtl m\nmap_Kd black.png\n");
         return obj(folder, "mtllib one.mtl\nusemtl m\n" + corners + "f 4 5 6\n");
     }},
    {"AHugePictureInRuns",
     [](const fs::path& folder) {
         constexpr int side = 23'040;  // grey, in runs of 128 pixels
         std::string tga("\0\0\x0b\0\0\0\0\0\0\0\0\0", 12);
         for (int i = 0; i < 2; ++i) tga += {static_cast<char>(side & 255), char(side >> 8)};
         tga += std::string("\x08\0", 2) + repeated(side / 128 * side,
                                                    "\xff"
                                                    "g");
         written(folder / "grey.tga", tga);
         written(folder / "one.mtl", "newmtl m\nmap_Kd grey.tga\n");
         return obj(folder, "mtllib one.mtl\nusemtl m\n" + corners + "f 4 5 6\n");
     },
     "--limit pixels="},
    {"MorphTargetsThatNobodyUses",
     [](const fs::path& folder) {
         return gltf(
             folder,
             scene_of("", R"({"mesh":0})",
                      R"({"primitives":[{"attributes":{"POSITION":0},"targets":[)" +
                          list_of(200'000, [](int) { return R"({"POSITION":0})"; }) + "]}]}"));
     }},
    {"AChildOfAllNodes",
     [](const fs::path& folder) {
         return gltf(folder, scene_of("", R"({"mesh":0},)" + list_of(50'000, [](int) {
                                              return R"({"children":[0]})";
                                          })));
     },
     "has two parents"},
    {"ChildrenOfOneNode",
     [](const fs::path& folder) {
         const auto child = [](int i) { return std::to_string(i + 1); };
         const auto leaf = [](int i) {
             return R"({"mesh":0,"translation":[)" + std::to_string(2 * (i % 300)) + "," +
                    std::to_string(2 * (i / 300)) + ",0]}";
         };
         return gltf(folder, scene_of("", R"({"children":[)" + list_of(100'000, child) + "]}," +
                                              list_of(100'000, leaf)));
     }},
    {"OutlinesOfManyMaterials",
     [](const fs::path& folder) {
         return gltf(folder,
                     scene_of(R"("extensionsUsed":["VRMC_materials_mtoon"],"materials":[)" +
                                  list_of(50'000,
                                          [](int) {
                                              return R"({"extensions":{"VRMC_materials_mtoon":)"
                                                     R"({"outlineWidthMode":"worldCoordinates",)"
                                                     R"("outlineWidthFactor":0.01}}})";
                                          }) +
                                  "]",
                              far_apart, mesh_of_materials(50'000)));
     }},
};

class GreedyFiles : public testing::TestWithParam<GreedyFile> {};

}  // namespace

TEST_P(GreedyFiles, HardCase_AreDrawnOrRefusedWithinBounds) {
    const GreedyFile& file = GetParam();
    const fs::path folder = fresh_folder("greedy"), model = file.write(folder);
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
