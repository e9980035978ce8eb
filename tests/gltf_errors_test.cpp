// SPDX-License-Identifier: MIT
/// @file
/// glTF files that are malformed, or need more than is read.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <functional>

#include "common/model/gltf.hpp"
#include "support/gltf_builder.hpp"
#include "support/lesson_process.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

namespace fs = std::filesystem;

/// What an error says behind the file's name; "" when the file is read.
std::string error_of(const fs::path& file, const LoadBudget& budget = {}) {
    try {
        load_gltf(file, budget);
        return "";
    } catch (const InputError& error) {
        const std::string text = error.what(), begin = file.string() + ": ";
        EXPECT_TRUE(text.starts_with(begin)) << text;
        EXPECT_EQ(text.find('\n'), text.npos) << text;
        EXPECT_LT(text.size(), begin.size() + 400) << text;
        return text.substr(std::min(begin.size(), text.size()));
    }
}

fs::path file_of(const std::string& bytes, const std::string& name = "scene.gltf") {
    const fs::path file = fresh_folder("gltf_error") / name;
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
}

struct Case {
    const char* what;
    std::function<void(GltfBuilder&)> spoil;
    std::string error;  ///< Stands somewhere in the message.
};

json& accessor(GltfBuilder& made, std::size_t index) { return made.document["accessors"][index]; }
json& view(GltfBuilder& made, std::size_t index) { return made.document["bufferViews"][index]; }

constexpr std::size_t positions = 0, normals = 1, indices = 3;  // of one_triangle()

void expect_errors(const std::vector<Case>& cases) {
    for (const Case& one : cases) {
        SCOPED_TRACE(one.what);
        for (const GltfForm form : {GltfForm::embedded, GltfForm::binary}) {
            GltfBuilder made = one_triangle();
            one.spoil(made);
            const std::string error =
                error_of(made.write(fresh_folder("gltf_case") / "scene.gltf", form));
            EXPECT_NE(error, "") << "it is read";
            EXPECT_NE(error.find(one.error), error.npos) << error;
        }
    }
}

}  // namespace

TEST(GltfErrors, FilesThatAreNoGltf) {
    EXPECT_EQ(error_of(file_of("")).substr(0, 11), "is not JSON");
    EXPECT_EQ(error_of(file_of("{\n \"asset\": }")).substr(0, 42),
              "is not JSON: parse error at line 2, column");
    EXPECT_EQ(error_of(file_of("[1, 2]")), "is JSON, but not glTF: no object");
    EXPECT_EQ(error_of(file_of("{\"v\": 1}")), "is JSON, but not glTF: there is no asset.version");
    EXPECT_EQ(error_of(file_of("{\"asset\": {\"version\": \"1.0\"}}")), "is glTF 1.0, not 2");
    EXPECT_EQ(error_of(file_of(std::string("\xff\xfe{\0", 4))).substr(0, 11), "is not JSON");
    const std::string deep(1000000, '[');
    EXPECT_EQ(error_of(file_of("{\"asset\": {\"version\": \"2.0\"}, \"extras\": " + deep)),
              "is nested deeper than 64");
    EXPECT_EQ(
        error_of(file_of("{\"asset\": {\"version\": \"2.0\"}, \"extras\": 1e999}")).substr(0, 11),
        "is not JSON");
}

TEST(GltfErrors, FilesThatAreMissingOrNoRegularFiles) {
    const fs::path folder = fresh_folder("gltf_special");
    ASSERT_EQ(mkfifo((folder / "fifo.glb").c_str(), 0600), 0);
    EXPECT_EQ(error_of(folder / "missing.glb"), "there is no such file");
    EXPECT_EQ(error_of(folder / "fifo.glb"), "not a regular file");
    GltfBuilder made = one_triangle();
    made.document["buffers"][0]["uri"] = "fifo.glb";
    EXPECT_EQ(error_of(made.write(folder / "a.gltf")),
              (folder / "fifo.glb").string() + ": not a regular file");
    made.document["buffers"][0]["uri"] = "none.bin";
    EXPECT_EQ(error_of(made.write(folder / "a.gltf")),
              (folder / "none.bin").string() + ": there is no such file");
    made.write(folder / "b.gltf", GltfForm::separate);
    EXPECT_EQ(error_of(folder / "b.gltf"), "");
    fs::resize_file(folder / "b.bin", 20);
    EXPECT_EQ(error_of(folder / "b.gltf"),
              (folder / "b.bin").string() + ": truncated: 20 of 104 bytes are there");
}

TEST(GltfErrors, ABinaryFileTruncatedAnywhere) {
    const fs::path whole =
        one_triangle().write(fresh_folder("gltf_whole") / "whole.glb", GltfForm::binary);
    const std::string bytes = read_text(whole);
    for (std::size_t length = 0; length < bytes.size(); ++length)
        ASSERT_NE(error_of(file_of(bytes.substr(0, length), "cut.glb")), "") << length;
    const std::size_t half = bytes.size() / 2;
    EXPECT_EQ(error_of(file_of(bytes.substr(0, half), "cut.glb")),
              "truncated: " + std::to_string(half) + " of " + std::to_string(bytes.size()) +
                  " bytes are there");
    std::string wrong = bytes;
    wrong[4] = 1;
    EXPECT_EQ(error_of(file_of(wrong, "old.glb")), "is glTF 1, not 2");
    wrong = bytes, wrong[16] = 'B';
    EXPECT_EQ(error_of(file_of(wrong, "bin.glb")), "damaged: its first chunk is not JSON");
    wrong = bytes, wrong[15] = 127;
    EXPECT_EQ(error_of(file_of(wrong, "long.glb")),
              "damaged: a chunk reaches beyond the end of the file");
}

TEST(GltfErrors, AccessorsOutOfRange) {
    const auto is = [](std::size_t which, const char* key, json value) {
        return [=](GltfBuilder& made) { accessor(made, which)[key] = value; };
    };
    expect_errors({
        {"no such view", is(positions, "bufferView", 99), "there is no buffer view 99"},
        {"negative view", is(positions, "bufferView", -7), "has no buffer view"},
        {"no view", [](GltfBuilder& made) { accessor(made, positions).erase("bufferView"); },
         "has no buffer view"},
        {"one element more", is(positions, "count", 4), "more than its buffer view can hold"},
        {"huge count", is(positions, "count", 4000000000), "more than its buffer view can hold"},
        {"greatest count", is(positions, "count", 18446744073709551615u),
         "more than its buffer view can hold"},
        {"huge count of indices", is(indices, "count", 9223372036854775807),
         "more than its buffer view can hold"},
        {"begins late", is(positions, "byteOffset", 37), "begins beyond its buffer view"},
        {"begins too late to be true", is(positions, "byteOffset", 18446744073709551615u),
         "begins beyond its buffer view"},
        {"begins one number late", is(positions, "byteOffset", 4),
         "more than its buffer view can hold"},
        {"whole numbers of 4 bytes with sign", is(positions, "componentType", 5124),
         "unknown type, 5124"},
        {"double", is(positions, "componentType", 5130), "unknown type, 5130"},
        {"no such component type", is(positions, "componentType", 1), "componentType"},
        {"two numbers a position", is(positions, "type", "VEC2"), "has 2 numbers an element"},
        {"no such type", is(positions, "type", "VEC5"), "VEC5"},
        {"indices in threes",
         [](GltfBuilder& made) {
             accessor(made, indices)["type"] = "VEC3", accessor(made, indices)["count"] = 1;
         },
         "no whole numbers, one by one"},
        {"normalised indices", is(indices, "normalized", true), "which indices must not be"},
        {"indices with fractions",
         [](GltfBuilder& made) {
             made.primitive()["indices"] = made.add({0, 1, 2}, "SCALAR", gl_float);
         },
         "no whole numbers, one by one"},
        {"fewer normals", is(normals, "count", 2), "has 2 elements for 3 positions"},
        {"sparse",
         is(positions, "sparse",
            {{"count", 1},
             {"indices", {{"bufferView", 3}, {"componentType", 5123}}},
             {"values", {{"bufferView", 0}}}}),
         "is sparse, which is not read"},
        {"no such accessor",
         [](GltfBuilder& made) { made.primitive()["attributes"]["NORMAL"] = 99; },
         "NORMAL there is no accessor 99"},
        {"negative accessor",
         [](GltfBuilder& made) { made.primitive()["attributes"]["NORMAL"] = -1; },
         "there is no accessor -1"},
        {"no such indices", [](GltfBuilder& made) { made.primitive()["indices"] = 99; },
         "indices accessor out of bounds"},
    });
}

TEST(GltfErrors, BuffersAndViewsOutOfRange) {
    expect_errors({
        {"view beyond its buffer",
         [](GltfBuilder& made) { view(made, positions)["byteLength"] = 100000; },
         "buffer view 0 reaches beyond its buffer"},
        {"view far beyond",
         [](GltfBuilder& made) { view(made, positions)["byteOffset"] = 18446744073709551615u; },
         "buffer view 0 reaches beyond its buffer"},
        {"no such buffer", [](GltfBuilder& made) { view(made, positions)["buffer"] = 5; },
         "there is no buffer 5"},
        {"negative buffer", [](GltfBuilder& made) { view(made, positions)["buffer"] = -5; },
         "there is no buffer -5"},
        {"step below an element",
         [](GltfBuilder& made) { view(made, positions)["byteStride"] = 4; },
         "has elements of 12 bytes, one every 4"},
        {"odd step", [](GltfBuilder& made) { view(made, positions)["byteStride"] = 13; },
         "byteStride"},
        {"buffer longer than its bytes",
         [](GltfBuilder& made) { made.document["buffers"][0]["byteLength"] = 4000000000; }, "n"},
        {"no buffers", [](GltfBuilder& made) { made.document["buffers"] = json::array(); },
         "there is no buffer 0"},
        {"not a number in base64",
         [](GltfBuilder& made) {
             made.document["buffers"][0]["uri"] = "data:application/octet-stream;base64,!!!";
         },
         "buffer 0: its data URI is not base64"},
        {"picture beyond its buffer",
         [](GltfBuilder& made) {
             made.document["buffers"][0]["byteLength"] = made.bytes.size();
             view(made, positions)["byteOffset"] = 1000000;
             made.document["images"] = json::array({{{"bufferView", 0}}});
         },
         "image 0: buffer view 0 reaches beyond its buffer"},
        {"picture in no view",
         [](GltfBuilder& made) { made.document["images"] = json::array({{{"bufferView", 77}}}); },
         "image 0: there is no buffer view 77"},
    });
}

TEST(GltfErrors, NodesScenesAndMeshesOutOfRange) {
    const auto nodes = [](json list) {
        return [=](GltfBuilder& made) { made.document["nodes"] = list; };
    };
    expect_errors({
        {"no such node", nodes({{{"children", {9}}, {"mesh", 0}}}), "node 9 is not there"},
        {"negative node", nodes({{{"children", {-1}}, {"mesh", 0}}}), "node -1 is not there"},
        {"its own child", nodes({{{"children", {0}}, {"mesh", 0}}}), "below itself"},
        {"a circle", nodes({{{"children", {1}}}, {{"children", {0}}, {"mesh", 0}}}),
         "below itself"},
        {"two parents",
         nodes({{{"children", {1, 2}}}, {{"children", {2}}}, {{"mesh", 0}, {"name", "both"}}}),
         "node 2 \"both\" has two parents, or is below itself"},
        {"no such mesh", nodes({{{"mesh", 3}}}), "node 0: mesh 3 is not there"},
        {"short matrix", nodes({{{"mesh", 0}, {"matrix", {1, 2, 3}}}}),
         "node 0: matrix has 3 numbers, not 16"},
        {"short rotation", nodes({{{"mesh", 0}, {"rotation", {1, 2, 3}}}}),
         "rotation has 3 numbers, not 4"},
        {"no rotation", nodes({{{"mesh", 0}, {"rotation", {0, 0, 0, 0}}}}),
         "rotation has no length"},
        {"long scale", nodes({{{"mesh", 0}, {"scale", {1, 1, 1, 1}}}}),
         "scale has 4 numbers, not 3"},
        {"too far", nodes({{{"mesh", 0}, {"translation", {1e300, 0, 0}}}}),
         "a position is too large"},
        {"too large", nodes({{{"mesh", 0}, {"scale", {1e39, 1, 1}}}}), "a position is too large"},
        {"no such scene", [](GltfBuilder& made) { made.document["scene"] = 4; },
         "scene 4 is not there"},
        {"empty scene",
         [](GltfBuilder& made) { made.document["scenes"] = json::array({json::object()}); },
         "holds no faces"},
        {"no meshes", [](GltfBuilder& made) { made.document["nodes"] = json::array(); },
         "node 0 is not there"},
        {"no triangles",
         [](GltfBuilder& made) { made.document["meshes"][0]["primitives"] = json::array(); },
         "holds no faces"},
        {"no such mode", [](GltfBuilder& made) { made.primitive()["mode"] = 7; },
         "there is no mode 7"},
        {"no such material", [](GltfBuilder& made) { made.primitive()["material"] = 5; },
         "primitive 0: material 5 is not there"},
        {"negative material", [](GltfBuilder& made) { made.primitive()["material"] = -5; },
         "primitive 0: material -5 is not there"},
        {"index out of range",
         [](GltfBuilder& made) {
             made.primitive()["indices"] = made.add({0, 1, 3}, "SCALAR", gl_unsigned_byte);
         },
         "mesh 0 \"triangle\", primitive 0: index 3 is out of range: there are 3 positions"},
        {"no such camera", nodes({{{"mesh", 0}, {"camera", 0}}}), "node 0: camera 0 is not there"},
        {"no such light",
         nodes({{{"mesh", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 2}}}}}}}),
         "node 0: light 2 is not there"},
        {"a light beyond all",
         nodes({{{"mesh", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 1e300}}}}}}}),
         "is not there"},
    });
}

TEST(GltfErrors, SkinsThatCannotBePosed) {
    const auto skinned = [](json skin, std::vector<double> joints, std::vector<double> weights) {
        return [=](GltfBuilder& made) {
            made.document["nodes"] =
                json::array({{{"mesh", 0}, {"skin", 0}}, json::object(), json::object()});
            made.document["scenes"][0]["nodes"] = {0, 1};
            made.document["skins"] = json::array({skin});
            json& attributes = made.primitive()["attributes"];
            if (!joints.empty())
                attributes["JOINTS_0"] = made.add(joints, "VEC4", gl_unsigned_byte);
            if (!weights.empty()) attributes["WEIGHTS_0"] = made.add(weights, "VEC4", gl_float);
        };
    };
    const json good = {{"joints", {1}}};
    const std::vector<double> joints(12, 0), weights(12, 0.25);
    std::vector<double> second_joint = joints, below_0 = weights;
    second_joint[5] = 1, below_0[6] = -1;
    expect_errors({
        {"no such skin", [](GltfBuilder& made) { made.document["nodes"][0]["skin"] = 3; },
         "node 0: skin 3 is not there"},
        {"no such joint", skinned({{"joints", {9}}}, joints, weights),
         "skin 0: its joint, node 9 is not there"},
        {"a joint elsewhere", skinned({{"joints", {1, 2}}}, joints, weights),
         "skin 0: its joint, node 2, is not in the scene"},
        {"no joints", skinned({{"joints", json::array()}}, joints, weights),
         "skin 0 has no joints"},
        {"not all matrices",
         skinned({{"joints", {1}}, {"inverseBindMatrices", 0}}, joints, weights),
         "has no matrix for each of 1 joints"},
        {"no JOINTS_0", skinned(good, {}, weights), "has a skin, but no JOINTS_0"},
        {"no WEIGHTS_0", skinned(good, joints, {}), "has a skin, but no WEIGHTS_0"},
        {"few weights", skinned(good, joints, std::vector<double>(8, 0.25)),
         "WEIGHTS_0: accessor 5 has no four numbers for each of 3 positions"},
        {"a joint beyond all", skinned(good, second_joint, weights),
         "JOINTS_0: accessor 4 element 1 names joint 1 of 1"},
        {"a weight below 0", skinned(good, joints, below_0),
         "WEIGHTS_0: accessor 5 element 1 has a weight below 0"},
        {"joints as floats",
         [&](GltfBuilder& made) {
             skinned(good, joints, weights)(made);
             made.primitive()["attributes"]["JOINTS_0"] = made.add(joints, "VEC4", gl_float);
         },
         "has no whole numbers"},
    });
}

TEST(GltfErrors, EachFurtherSetOfJointsCountsAsVertices) {
    GltfBuilder made = one_triangle();
    made.document["nodes"] = json::array({{{"mesh", 0}, {"skin", 0}}});
    made.document["skins"] = json::array({{{"joints", {0}}}});
    json& attributes = made.primitive()["attributes"];
    const int joints = made.add(std::vector<double>(12, 0), "VEC4", gl_unsigned_byte);
    const int weights = made.add(std::vector<double>(12, 0.25), "VEC4", gl_float);
    for (int set = 0; set < 5; ++set) {
        attributes["JOINTS_" + std::to_string(set)] = joints;
        attributes["WEIGHTS_" + std::to_string(set)] = weights;
    }
    const fs::path file = made.write(fresh_folder("gltf_sets") / "scene.gltf");
    LoadBudget budget;
    budget.set(Resource::vertices, 3 * 5);
    EXPECT_EQ(error_of(file, budget), "");
    budget.set(Resource::vertices, 3 * 5 - 1);
    EXPECT_NE(error_of(file, budget).find("more than 14 vertices"), std::string::npos);
}

TEST(GltfErrors, NumbersThatAreNotFinite) {
    const auto spoiled = [](std::size_t which, std::uint32_t bits) {
        return [=](GltfBuilder& made) {
            const auto at = view(made, which)["byteOffset"].get<std::size_t>() + 4;
            made.bytes.replace(at, 4, little_endian(bits, 4));
        };
    };
    constexpr std::uint32_t nan = 0x7fc00000, infinity = 0xff800000;
    expect_errors({
        {"position NaN", spoiled(positions, nan), "POSITION: accessor 0 element 0 is not a finite"},
        {"position infinite", spoiled(positions, infinity), "is not a finite number"},
        {"normal NaN", spoiled(normals, nan), "NORMAL: accessor 1 element 0 is not a finite"},
        {"colour beyond float",
         [](GltfBuilder& made) { made.material()["emissiveFactor"] = {1e200, 0, 0}; },
         "material 0 \"paint\": emissiveFactor is out of range"},
    });
}

TEST(GltfErrors, ImpossibleCamerasAndLights) {
    const auto with_camera = [](json lens) {
        return [=](GltfBuilder& made) {
            made.document["nodes"][0]["camera"] = 0;
            made.document["cameras"] =
                json::array({{{"type", "perspective"}, {"perspective", lens}}});
        };
    };
    const auto with_light = [](json light) {
        return [=](GltfBuilder& made) {
            made.document["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
            made.document["extensions"]["KHR_lights_punctual"]["lights"] = json::array({light});
        };
    };
    const std::string lens = "no possible yfov, znear and zfar";
    expect_errors({
        {"no angle", with_camera({{"yfov", 0}, {"znear", 1}}), lens},
        {"angle of 180 degrees", with_camera({{"yfov", 3.1415927}, {"znear", 1}}), lens},
        {"near plane at the eye", with_camera({{"yfov", 1}, {"znear", 0}}), lens},
        {"near plane nearly there", with_camera({{"yfov", 1}, {"znear", 1e-60}}), lens},
        {"far before near", with_camera({{"yfov", 1}, {"znear", 2}, {"zfar", 1}}), lens},
        {"no such light", with_light({{"type", "moon"}}), "no kind of light \"moon\""},
        {"two colours", with_light({{"type", "point"}, {"color", {1, 1}}}), "no 3 numbers"},
        {"too bright", with_light({{"type", "point"}, {"intensity", 1e60}}), "too large"},
        {"wide cone",
         with_light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0}, {"outerConeAngle", 1.6}}}}),
         "no possible angles"},
        {"inner cone outside",
         with_light({{"type", "spot"}, {"spot", {{"innerConeAngle", 1}, {"outerConeAngle", 0.5}}}}),
         "no possible angles"},
    });
}

TEST(GltfErrors, MaterialsWhoseImagesAreMissing) {
    const auto textured = [](json textures, json images) {
        return [=](GltfBuilder& made) {
            made.material()["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
            made.document["textures"] = textures, made.document["images"] = images;
        };
    };
    const json none = json::array();
    expect_errors({
        {"no texture", textured(none, none), "\"paint\": baseColorTexture names texture 0"},
        {"no image", textured({{{"source", 1}}}, {{{"uri", "a.png"}}}), "names image 1"},
        {"no sampler", textured({{{"source", 0}, {"sampler", 3}}}, {{{"uri", "a.png"}}}),
         "names sampler 3"},
        {"an image that is no base64",
         textured({{{"source", 0}}}, {{{"uri", "data:image/png;base64,A*AA"}}}),
         "image 0: its data URI is not base64"},
        {"an image without data", textured({{{"source", 0}}}, {{{"uri", "data:image/png"}}}),
         "image 0: its data URI has no data"},
    });
}

TEST(GltfErrors, UnsupportedRequiredExtensionsAreNamed) {
    expect_errors({
        {"Draco",
         [](GltfBuilder& made) {
             made.document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
             accessor(made, positions).erase("bufferView");
             accessor(made, indices).erase("bufferView");
         },
         "needs the extension KHR_draco_mesh_compression, which is not read"},
        {"after a known one",
         [](GltfBuilder& made) {
             made.document["extensionsRequired"] = {"KHR_texture_transform", "KHR_texture_basisu"};
         },
         "needs the extension KHR_texture_basisu"},
    });
}

TEST(GltfErrors, WhatIsIgnoredIsAWarning) {
    struct Row {
        const char* what;
        std::function<void(GltfBuilder&)> change;
        std::string warning;
    };
    const auto add_texture = [](GltfBuilder& made) -> json& {
        made.document["images"] = json::array({{{"uri", "a.png"}}});
        made.document["samplers"] = json::array({json::object()});
        made.document["textures"] = json::array({{{"source", 0}, {"sampler", 0}}});
        json& texture = made.material()["pbrMetallicRoughness"]["baseColorTexture"];
        texture["index"] = 0;
        return texture;
    };
    for (const Row& row : std::vector<Row>{
             {"morph target",
              [](GltfBuilder& made) {
                  made.primitive()["targets"] = json::array({{{"POSITION", 0}}});
              },
              "morph targets are passed over"},
             {"points",
              [](GltfBuilder& made) {
                  json points = made.primitive();
                  points["mode"] = 0;
                  made.document["meshes"][0]["primitives"].push_back(points);
              },
              "mesh 0 \"triangle\", primitive 1: points are not drawn"},
             {"lines",
              [](GltfBuilder& made) {
                  json lines = made.primitive();
                  lines["mode"] = 3;
                  made.document["meshes"][0]["primitives"].push_back(lines);
              },
              "primitive 1: lines are not drawn"},
             {"unknown extension",
              [](GltfBuilder& made) { made.document["extensionsUsed"] = {"KHR_materials_sheen"}; },
              "the extension KHR_materials_sheen is passed over"},
             {"animation",
              [](GltfBuilder& made) {
                  made.document["animations"] = json::array({json::object()});
              },
              "animations are passed over"},
             {"parallel camera",
              [](GltfBuilder& made) {
                  made.document["nodes"][0]["camera"] = 0;
                  made.document["cameras"] = json::array(
                      {{{"type", "orthographic"},
                        {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 2}, {"znear", 1}}}}});
              },
              "a camera without perspective is passed over"},
             {"occlusion",
              [](GltfBuilder& made) { made.material()["occlusionTexture"]["index"] = 0; },
              "material 0 \"paint\": occlusionTexture is passed over"},
             {"turned texture",
              [&](GltfBuilder& made) {
                  add_texture(made)["extensions"]["KHR_texture_transform"]["rotation"] = 0.5;
              },
              "baseColorTexture is turned"},
             {"another set of uvs",
              [&](GltfBuilder& made) {
                  add_texture(made)["extensions"]["KHR_texture_transform"]["texCoord"] = 1;
              },
              "own set of texture coordinates is passed over"},
             {"no file for the mean",
              [&](GltfBuilder& made) {
                  const json texture = add_texture(made);
                  made.material()["pbrMetallicRoughness"] = {{"metallicRoughnessTexture", texture}};
              },
              "metallicRoughnessTexture: "},
             {"two sets of uvs",
              [&](GltfBuilder& made) {
                  add_texture(made);
                  made.material()["normalTexture"] = {{"index", 0}, {"texCoord", 1}};
              },
              "several sets of texture coordinates; set 0 is taken"},
             {"primitive without attributes",
              [](GltfBuilder& made) {
                  made.document["meshes"][0]["primitives"].push_back(json::object());
              },
              "'attributes' property is missing"},
         }) {
        SCOPED_TRACE(row.what);
        GltfBuilder made = one_triangle();
        row.change(made);
        const fs::path file = made.write(fresh_folder("gltf_warning") / "scene.gltf");
        const Scene scene = load_gltf(file);
        EXPECT_EQ(scene.meshes.at(0).triangles.size(), 1u);
        EXPECT_EQ(scene.bounds().max, vec3(1, 1, 0));  // a skinned mesh does not move with its node
        ASSERT_EQ(scene.warnings.size(), 1u);
        EXPECT_TRUE(scene.warnings[0].starts_with(file.string() + ": ")) << scene.warnings[0];
        EXPECT_NE(scene.warnings[0].find(row.warning), std::string::npos) << scene.warnings[0];
        EXPECT_EQ(scene.warnings[0].find('\n'), std::string::npos) << scene.warnings[0];
    }
}

TEST(GltfErrors, ASmallFileOfManyInstancesIsRejectedBeforeItFillsTheMemory) {
    GltfBuilder made = one_triangle();
    made.document["nodes"] = json::array();
    made.document["scenes"][0]["nodes"] = json::array();
    for (int i = 0; i < 10; ++i) {
        made.document["nodes"].push_back({{"mesh", 0}});
        made.document["scenes"][0]["nodes"].push_back(i);
    }
    const fs::path file = made.write(fresh_folder("gltf_many") / "scene.gltf");
    LoadBudget budget;
    budget.set(Resource::vertices, 30);
    EXPECT_EQ(error_of(file, budget), "");
    budget.set(Resource::vertices, 29);
    EXPECT_EQ(error_of(file, budget),
              "more than 29 vertices in all, the most that are accepted; see --limit vertices=N");
}

TEST(GltfErrors, AChainOfAHundredThousandNodesIsRead) {
    GltfBuilder made = one_triangle();
    constexpr int length = 100'000;
    json& nodes = made.document["nodes"] = json::array();
    for (int i = 0; i + 1 < length; ++i) nodes.push_back({{"children", {i + 1}}});
    nodes.push_back({{"mesh", 0}});
    EXPECT_EQ(error_of(made.write(fresh_folder("gltf_chain") / "scene.gltf")), "");
}
