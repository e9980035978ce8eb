// SPDX-License-Identifier: MIT
/// @file
/// glTF files that are malformed, or need more than is read.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <limits>

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

/// What GltfBuilder::set() changes, and what an error or a warning then says among other words.
struct Case {
    std::string changes, message;
};

void expect_errors(const GltfBuilder& valid, const std::vector<Case>& cases) {
    EXPECT_EQ(error_of(valid.write(fresh_folder("gltf_case") / "scene.gltf")), "") << "unchanged";
    for (const auto& [changes, message] : cases) {
        SCOPED_TRACE(changes);
        GltfBuilder made = valid;
        made.set(changes);
        for (const GltfForm form : {GltfForm::embedded, GltfForm::binary}) {
            const std::string error =
                error_of(made.write(fresh_folder("gltf_case") / "scene.gltf", form));
            EXPECT_NE(error, "") << "it is read";
            EXPECT_NE(error.find(message), error.npos) << error;
        }
    }
}

}  // namespace

TEST(GltfErrors, FilesThatAreNoGltf) {
    const std::string begin = "{\"asset\": {\"version\": \"2.0\"}, \"extras\": ";
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"", "is not JSON"},
        {"{\n \"asset\": }", "is not JSON: parse error at line 2, column"},
        {std::string("\xff\xfe{\0", 4), "is not JSON"},
        {begin + "1e999}", "is not JSON"},
        {begin + std::string(1000000, '['), "is nested deeper than 64"},
        {"[1, 2]", "is JSON, but not glTF: no object"},
        {"{\"v\": 1}", "is JSON, but not glTF: there is no asset.version"},
        {"{\"asset\": {\"version\": \"1.0\"}}", "is glTF 1.0, not 2"}};
    for (const auto& [text, message] : cases) {
        const std::string error = error_of(file_of(text));
        EXPECT_TRUE(error.starts_with(message)) << error << " instead of " << message;
    }
}

TEST(GltfErrors, FilesThatAreMissingOrNoRegularFiles) {
    const fs::path folder = fresh_folder("gltf_special");
    ASSERT_EQ(mkfifo((folder / "fifo.glb").c_str(), 0600), 0);
    EXPECT_EQ(error_of(folder / "missing.glb"), "there is no such file");
    EXPECT_EQ(error_of(folder / "fifo.glb"), "not a regular file");
    GltfBuilder made = one_triangle();
    made.write(folder / "b.gltf", GltfForm::separate);
    EXPECT_EQ(error_of(folder / "b.gltf"), "");
    fs::resize_file(folder / "b.bin", 20);
    EXPECT_EQ(error_of(folder / "b.gltf"),
              (folder / "b.bin").string() + ": truncated: 20 of 104 bytes are there");
    made.set(R"("/buffers/0/uri": "fifo.glb")");
    EXPECT_EQ(error_of(made.write(folder / "a.gltf")),
              (folder / "fifo.glb").string() + ": not a regular file");
    made.set(R"("/buffers/0/uri": "none.bin")");
    EXPECT_EQ(error_of(made.write(folder / "a.gltf")),
              (folder / "none.bin").string() + ": there is no such file");
}

TEST(GltfErrors, ABinaryFileTruncatedAnywhere) {
    const std::string bytes =
        read_text(one_triangle().write(fresh_folder("gltf_whole") / "whole.glb", GltfForm::binary));
    for (std::size_t length = 0; length < bytes.size(); ++length)
        ASSERT_NE(error_of(file_of(bytes.substr(0, length), "cut.glb")), "") << length;
    EXPECT_EQ(error_of(file_of(bytes.substr(0, 500), "cut.glb")),
              "truncated: 500 of " + std::to_string(bytes.size()) + " bytes are there");
    const auto error_with = [&](std::size_t at, char now) {
        std::string wrong = bytes;
        wrong[at] = now;
        return error_of(file_of(wrong, "wrong.glb"));
    };
    EXPECT_EQ(error_with(4, 1), "is glTF 1, not 2");
    EXPECT_EQ(error_with(16, 'B'), "damaged: its first chunk is not JSON");
    EXPECT_EQ(error_with(15, 127), "damaged: a chunk reaches beyond the end of the file");
}

TEST(GltfErrors, AccessorsOutOfRange) {
    const std::string too_many = "more than its buffer view can hold";
    expect_errors(
        one_triangle(),
        {
            {R"("/accessors/0/bufferView": 99)", "there is no buffer view 99"},
            {R"("/accessors/0/bufferView": -7)", "has no buffer view"},
            {R"("/accessors/0/bufferView": null)", "has no buffer view"},
            {R"("/accessors/0/count": 4)", too_many},
            {R"("/accessors/0/count": 4000000000)", too_many},
            {R"("/accessors/0/count": 18446744073709551615)", too_many},
            {R"("/accessors/3/count": 9223372036854775807)", too_many},
            {R"("/accessors/0/byteOffset": 4)", too_many},
            {R"("/accessors/0/byteOffset": 37)", "begins beyond its buffer view"},
            {R"("/accessors/0/byteOffset": 18446744073709551615)", "begins beyond its buffer view"},
            {R"("/accessors/0/componentType": 5124)", "unknown type, 5124"},
            {R"("/accessors/0/componentType": 5130)", "unknown type, 5130"},
            {R"("/accessors/0/componentType": 1)", "componentType"},
            {R"("/accessors/0/type": "VEC2")", "has 2 numbers an element"},
            {R"("/accessors/0/type": "VEC5")", "VEC5"},
            {R"("/accessors/1/count": 2)", "has 2 elements for 3 positions"},
            {R"("/accessors/0/sparse": {"count": 1, "values": {"bufferView": 0},
                "indices": {"bufferView": 3, "componentType": 5123}})",
             "is sparse, which is not read"},
            {R"("/accessors/3/type": "VEC3", "/accessors/3/count": 1)",
             "no whole numbers, one by one"},
            {R"("/accessors/3/componentType": 5126, "/accessors/3/count": 1)",
             "no whole numbers, one by one"},
            {R"("/accessors/3/normalized": true)", "which indices must not be"},
            // The bytes of the positions: 12 of 0, then 00 00 80 3f of 1.0f.
            {R"("/accessors/3": {"bufferView": 0, "componentType": 5121, "count": 36,
                "type": "SCALAR"})",
             "mesh 0 \"triangle\", primitive 0: index 128 is out of range: there are 3 positions"},
            {R"("/meshes/0/primitives/0/attributes/NORMAL": 99)", "NORMAL there is no accessor 99"},
            {R"("/meshes/0/primitives/0/attributes/NORMAL": -1)", "there is no accessor -1"},
            {R"("/meshes/0/primitives/0/indices": 99)", "indices accessor out of bounds"},
        });
}

TEST(GltfErrors, BuffersAndViewsOutOfRange) {
    expect_errors(
        one_triangle(),
        {
            {R"("/bufferViews/0/byteLength": 100000)", "buffer view 0 reaches beyond its buffer"},
            {R"("/bufferViews/0/byteOffset": 18446744073709551615)",
             "buffer view 0 reaches beyond its buffer"},
            {R"("/bufferViews/0/buffer": 5)", "there is no buffer 5"},
            {R"("/bufferViews/0/buffer": -5)", "there is no buffer -5"},
            {R"("/bufferViews/0/byteStride": 4)", "has elements of 12 bytes, one every 4"},
            {R"("/bufferViews/0/byteStride": 13)", "byteStride"},
            {R"("/buffers/0/byteLength": 4000000000)", ""},
            {R"("/buffers": [])", "there is no buffer 0"},
            {R"("/buffers/0/uri": "data:application/octet-stream;base64,!!!")",
             "buffer 0: its data URI is not base64"},
            {R"("/images/0/bufferView": 4, "/bufferViews/4":
                          {"buffer": 0, "byteOffset": 1000000, "byteLength": 36})",
             "image 0: buffer view 4 reaches beyond its buffer"},
            {R"("/images/0/bufferView": 77)", "image 0: there is no buffer view 77"},
        });
}

TEST(GltfErrors, NodesScenesAndMeshesOutOfRange) {
    expect_errors(
        one_triangle(),
        {
            {R"("/nodes/0/children": [9])", "node 9 is not there"},
            {R"("/nodes/0/children": [-1])", "node -1 is not there"},
            {R"("/nodes/0/children": [0])", "below itself"},
            {R"("/nodes": [{"children": [1]}, {"children": [0], "mesh": 0}])", "below itself"},
            {R"("/nodes": [{"children": [1, 2]}, {"children": [2]}, {"mesh": 0, "name": "both"}])",
             "node 2 \"both\" has two parents, or is below itself"},
            {R"("/nodes/0/mesh": 3)", "node 0: mesh 3 is not there"},
            {R"("/nodes/0/matrix": [1, 2, 3])", "node 0: matrix has 3 numbers, not 16"},
            {R"("/nodes/0/rotation": [1, 2, 3])", "rotation has 3 numbers, not 4"},
            {R"("/nodes/0/rotation": [0, 0, 0, 0])", "rotation has no length"},
            {R"("/nodes/0/scale": [1, 1, 1, 1])", "scale has 4 numbers, not 3"},
            {R"("/nodes/0/translation": [1e300, 0, 0])", "a position is too large"},
            {R"("/nodes/0/scale": [1e39, 1, 1])", "a position is too large"},
            {R"("/nodes": [])", "node 0 is not there"},
            {R"("/scene": 4)", "scene 4 is not there"},
            {R"("/scenes": [{}])", "holds no faces"},
            {R"("/meshes/0/primitives": [])", "holds no faces"},
            {R"("/meshes/0/primitives/0/mode": 7)", "there is no mode 7"},
            {R"("/meshes/0/primitives/0/material": 5)", "primitive 0: material 5 is not there"},
            {R"("/meshes/0/primitives/0/material": -5)", "primitive 0: material -5 is not there"},
            {R"("/nodes/0/camera": 0)", "node 0: camera 0 is not there"},
            {R"("/nodes/0/extensions/KHR_lights_punctual/light": 2)",
             "node 0: light 2 is not there"},
            {R"("/nodes/0/extensions/KHR_lights_punctual/light": 1e300)", "is not there"},
        });
}

TEST(GltfErrors, SkinsThatCannotBePosed) {
    GltfBuilder skinned = one_triangle();
    std::vector<double> second_joint(12, 0), below_0(12, 0.25);
    second_joint[5] = 1, below_0[6] = -1;
    skinned.add(second_joint, "VEC4", gl_unsigned_byte);
    skinned.add(std::vector<double>(12, 0.25), "VEC4", gl_float);
    skinned.add(below_0, "VEC4", gl_float);
    skinned.set(R"("/nodes": [{"mesh": 0, "skin": 0}, {}, {}], "/scenes/0/nodes": [0, 1],
                   "/skins": [{"joints": [1, 1]}],
                   "/meshes/0/primitives/0/attributes/JOINTS_0": 4,
                   "/meshes/0/primitives/0/attributes/WEIGHTS_0": 5)");
    expect_errors(
        skinned,
        {
            {R"("/nodes/0/skin": 3)", "node 0: skin 3 is not there"},
            {R"("/skins/0/joints": [9])", "skin 0: its joint, node 9 is not there"},
            {R"("/skins/0/joints": [1, 2])", "skin 0: its joint, node 2, is not in the scene"},
            {R"("/skins/0/joints": [])", "skin 0 has no joints"},
            {R"("/skins/0/joints": [1])", "JOINTS_0: accessor 4 element 1 names joint 1 of 1"},
            {R"("/skins/0/inverseBindMatrices": 0)", "has no matrix for each of 2 joints"},
            {R"("/meshes/0/primitives/0/attributes/JOINTS_0": null)",
             "has a skin, but no JOINTS_0"},
            {R"("/meshes/0/primitives/0/attributes/WEIGHTS_0": null)",
             "has a skin, but no WEIGHTS_0"},
            {R"("/meshes/0/primitives/0/attributes/JOINTS_0": 5)", "has no whole numbers"},
            {R"("/accessors/5/count": 2)",
             "WEIGHTS_0: accessor 5 has no four numbers for each of 3 positions"},
            {R"("/meshes/0/primitives/0/attributes/WEIGHTS_0": 6)",
             "WEIGHTS_0: accessor 6 element 1 has a weight below 0"},
        });
}

TEST(GltfErrors, EachFurtherSetOfJointsCountsAsVertices) {
    GltfBuilder made = one_triangle();
    made.set(R"("/nodes/0/skin": 0, "/skins/0/joints": [0])");
    json& attributes = made.primitive()["attributes"];
    const int joints = made.add(std::vector<double>(12, 0), "VEC4", gl_unsigned_byte);
    const int weights = made.add(std::vector<double>(12, 0.25), "VEC4", gl_float);
    for (const std::string set : {"0", "1", "2", "3", "4"})
        attributes["JOINTS_" + set] = joints, attributes["WEIGHTS_" + set] = weights;
    const fs::path file = made.write(fresh_folder("gltf_sets") / "scene.gltf");
    LoadBudget budget;
    budget.set(Resource::vertices, 3 * 5);
    EXPECT_EQ(error_of(file, budget), "");
    budget.set(Resource::vertices, 3 * 5 - 1);
    EXPECT_NE(error_of(file, budget).find("more than 14 vertices"), std::string::npos);
}

TEST(GltfErrors, NumbersThatAreNotFinite) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                     infinity = std::numeric_limits<double>::infinity();
    GltfBuilder made = one_triangle();
    made.add({0, nan, 0, 1, 0, 0, 0, 1, 0}, "VEC3", gl_float);
    made.add({0, 0, 0, 1, 0, -infinity, 0, 1, 0}, "VEC3", gl_float);
    expect_errors(made, {
                            {R"("/meshes/0/primitives/0/attributes/POSITION": 4)",
                             "POSITION: accessor 4 element 0 is not a finite number"},
                            {R"("/meshes/0/primitives/0/attributes/POSITION": 5)",
                             "POSITION: accessor 5 element 1 is not a finite number"},
                            {R"("/meshes/0/primitives/0/attributes/NORMAL": 4)",
                             "NORMAL: accessor 4 element 0 is not a finite number"},
                            {R"("/materials/0/emissiveFactor": [1e200, 0, 0])",
                             "material 0 \"paint\": emissiveFactor is out of range"},
                        });
}

TEST(GltfErrors, ImpossibleCamerasAndLights) {
    GltfBuilder made = one_triangle();
    made.set(R"("/nodes/0/camera": 0, "/nodes/0/extensions/KHR_lights_punctual/light": 0,
                "/cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}],
                "/extensions/KHR_lights_punctual/lights": [{"type": "spot", "spot": {}}])");
    const std::string lens = "no possible yfov, znear and zfar",
                      light = "/extensions/KHR_lights_punctual/lights/0";
    expect_errors(made,
                  {
                      {R"("/cameras/0/perspective/yfov": 0)", lens},
                      {R"("/cameras/0/perspective/yfov": 3.1415927)", lens},
                      {R"("/cameras/0/perspective/znear": 0)", lens},
                      {R"("/cameras/0/perspective/znear": 1e-60)", lens},
                      {R"("/cameras/0/perspective/zfar": 0.5)", lens},
                      {'"' + light + R"(/type": "moon")", "no kind of light \"moon\""},
                      {'"' + light + R"(/color": [1, 1])", "no 3 numbers"},
                      {'"' + light + R"(/intensity": 1e60)", "too large"},
                      {'"' + light + R"(/spot": {"innerConeAngle": 0, "outerConeAngle": 1.6})",
                       "no possible angles"},
                      {'"' + light + R"(/spot": {"innerConeAngle": 1, "outerConeAngle": 0.5})",
                       "no possible angles"},
                  });
}

TEST(GltfErrors, MaterialsWhoseImagesAreMissing) {
    GltfBuilder made = one_triangle();
    expect_errors(made.set_texture("a.png"),
                  {
                      {R"("/textures": [])", "\"paint\": baseColorTexture names texture 0"},
                      {R"("/textures/0/source": 1)", "names image 1"},
                      {R"("/textures/0/sampler": 3)", "names sampler 3"},
                      {R"("/images/0/uri": "data:image/png;base64,A*AA")",
                       "image 0: its data URI is not base64"},
                      {R"("/images/0/uri": "data:image/png")", "image 0: its data URI has no data"},
                  });
}

TEST(GltfErrors, UnsupportedRequiredExtensionsAreNamed) {
    expect_errors(one_triangle(),
                  {
                      {R"("/extensionsRequired": ["KHR_draco_mesh_compression"],
                          "/accessors/0/bufferView": null, "/accessors/3/bufferView": null)",
                       "needs the extension KHR_draco_mesh_compression, which is not read"},
                      {R"("/extensionsRequired": ["KHR_texture_transform", "KHR_texture_basisu"])",
                       "needs the extension KHR_texture_basisu"},
                  });
}

TEST(GltfErrors, WhatIsIgnoredIsAWarning) {
    GltfBuilder textured = one_triangle();
    textured.set_texture("a.png");
    const std::vector<Case> of_one_triangle = {
        {R"("/meshes/0/primitives/0/targets": [{"POSITION": 0}])", "morph targets are passed over"},
        {R"("/meshes/0/primitives/1": {"attributes": {"POSITION": 0}, "mode": 0})",
         "mesh 0 \"triangle\", primitive 1: points are not drawn"},
        {R"("/meshes/0/primitives/1": {"attributes": {"POSITION": 0}, "mode": 3})",
         "primitive 1: lines are not drawn"},
        {R"("/meshes/0/primitives/1": {})", "'attributes' property is missing"},
        {R"("/extensionsUsed": ["KHR_materials_sheen"])",
         "the extension KHR_materials_sheen is passed over"},
        {R"("/animations": [{}])", "animations are passed over"},
        {R"("/nodes/0/camera": 0, "/cameras": [{"type": "orthographic", "orthographic":
            {"xmag": 1, "ymag": 1, "zfar": 2, "znear": 1}}])",
         "a camera without perspective is passed over"},
        {R"("/materials/0/occlusionTexture/index": 0)",
         "material 0 \"paint\": occlusionTexture is passed over"},
    };
    const std::string base_color = "\"/materials/0/pbrMetallicRoughness/baseColorTexture/";
    const std::vector<Case> of_a_texture = {
        {base_color + R"(extensions/KHR_texture_transform/rotation": 0.5)",
         "baseColorTexture is turned"},
        {base_color + R"(extensions/KHR_texture_transform/texCoord": 1)",
         "own set of texture coordinates is passed over"},
        {R"("/materials/0/pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 0}})",
         "metallicRoughnessTexture: "},
        {R"("/materials/0/normalTexture": {"index": 0, "texCoord": 1})",
         "several sets of texture coordinates; set 0 is taken"},
    };
    const auto expect_warning = [](GltfBuilder made, const Case& one) {
        SCOPED_TRACE(one.changes);
        made.set(one.changes);
        const fs::path file = made.write(fresh_folder("gltf_warning") / "scene.gltf");
        const Scene scene = load_gltf(file);
        EXPECT_EQ(scene.meshes.at(0).triangles.size(), 1u);
        ASSERT_EQ(scene.warnings.size(), 1u);
        const std::string& warning = scene.warnings[0];
        EXPECT_TRUE(warning.starts_with(file.string() + ": ")) << warning;
        EXPECT_NE(warning.find(one.message), std::string::npos) << warning;
        EXPECT_EQ(warning.find('\n'), std::string::npos) << warning;
    };
    for (const Case& one : of_one_triangle) expect_warning(one_triangle(), one);
    for (const Case& one : of_a_texture) expect_warning(textured, one);
}
