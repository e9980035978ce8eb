// SPDX-License-Identifier: MIT
/// @file
/// Model files. tests/data/obj/good and bad hold a small file for each way in which OBJ files
/// differ or go wrong; each begins with comments that say what is expected of it.
#include "common/model/obj.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <string_view>

#include "common/image/input_error.hpp"
#include "support/lesson_process.hpp"
#include "support/sound_scene.hpp"

namespace rasterbook {
namespace {

namespace fs = std::filesystem;
using test::is_sound;

const fs::path data = fs::path(RASTERBOOK_TEST_DATA) / "obj";
constexpr unsigned seed = 1;

using Lines = std::vector<std::string>;

/// A folder for the files of this process.
const fs::path& temporary_folder() {
    static const fs::path folder = test::fresh_folder("obj");
    return folder;
}

fs::path write_file(const std::string& name, const std::string& bytes) {
    const fs::path file = temporary_folder() / name;
    fs::remove(file);  // Some file systems write through to the disk when a file is replaced.
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
}

/// The texts of the comments "# expect KIND: TEXT" in a file.
Lines expected(const fs::path& file, const std::string& kind) {
    std::string text = test::read_text(file);
    std::ranges::replace(text, '\r', '\n');
    std::istringstream in(text);
    const std::string start = "# expect " + kind + ": ";
    Lines lines;
    for (std::string line; std::getline(in, line);)
        if (const auto at = line.find(start); at != line.npos)
            lines.push_back(line.substr(at + start.size()));
    return lines;
}

/// The files of a folder, by name; those that are read as OBJ.
std::vector<fs::path> models_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".obj") files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

/// Messages without the folder that the files are in.
std::string without_folder(std::string text, const fs::path& folder) {
    const std::string start = folder.string() + "/";
    for (auto at = text.find(start); at != text.npos; at = text.find(start))
        text.erase(at, start.size());
    return text;
}

/// The message of the InputError that reading a file ends with; "" when it is read.
std::string error_of(const fs::path& file, std::uint32_t max_elements = no_index) {
    try {
        load_obj(file, {}, max_elements);
    } catch (const InputError& error) { return without_folder(error.what(), file.parent_path()); }
    return "";
}

/// A vector as "1,2.5".
template <typename Vector>
std::string with_commas(const Vector& vector) {
    std::ostringstream out;
    out.precision(9);
    for (int i = 0; i < vector.length(); ++i)
        out << (i > 0 ? "," : "") << float(vector[i]) + 0.0f;  // no -0
    return out.str();
}

/// All faces, with the values that their vertices refer to in place of indices.
Lines faces_of(const Scene& scene) {
    Lines faces;
    for (const Mesh& mesh : scene.meshes)
        for (const Face& face : mesh.faces) {
            std::string text = "group \"" + mesh.name + "\" material \"" +
                               scene.materials.at(face.material).name + "\"";
            for (const auto& [position, uv, normal] : mesh.vertices_of(face)) {
                text += " " + with_commas(mesh.positions.at(position));
                if (uv != no_index || normal != no_index) text += "/";
                if (uv != no_index) text += with_commas(mesh.uvs.at(uv));
                if (normal != no_index) text += "/" + with_commas(mesh.normals.at(normal));
            }
            faces.push_back(text);
        }
    return faces;
}

/// The scene's warnings, of files in this folder.
Lines warnings_of(const Scene& scene, const fs::path& folder) {
    Lines warnings;
    for (const std::string& warning : scene.warnings)
        warnings.push_back(without_folder(warning, folder));
    return warnings;
}

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST(Obj, GoodFilesGiveTheFacesAndWarningsThatTheyState) {
    const auto files = models_in(data / "good");
    EXPECT_GE(files.size(), 70u);
    for (const fs::path& file : files) {
        SCOPED_TRACE(file);
        const Scene scene = load_obj(file);
        EXPECT_TRUE(is_sound(scene));
        EXPECT_EQ(faces_of(scene), expected(file, "face"));
        EXPECT_EQ(warnings_of(scene, file.parent_path()), expected(file, "warning"));
    }
}

TEST(Obj, BadFilesAreErrorsWithFileAndLine) {
    const std::string utf_16 = ".obj:1: the text is UTF-16, not UTF-8";
    const std::map<std::string, std::string> unmarked = {
        // these cannot hold a comment
        {"empty", "empty.obj: holds no faces"},
        {"one_nul_byte", "one_nul_byte.obj:1: not text: control character 0"},
        {"utf16_be", "utf16_be" + utf_16},
        {"utf16_be_without_mark", "utf16_be_without_mark" + utf_16},
        {"utf16_le", "utf16_le" + utf_16},
        {"utf16_le_without_mark", "utf16_le_without_mark" + utf_16}};
    const auto files = models_in(data / "bad");
    EXPECT_GE(files.size(), 70u);
    for (const fs::path& file : files) {
        SCOPED_TRACE(file);
        const auto found = unmarked.find(file.stem());
        const Lines messages =
            found != unmarked.end() ? Lines{found->second} : expected(file, "error");
        EXPECT_EQ(Lines{error_of(file)}, messages);
    }
}

TEST(Obj, MaterialsAreReadWithAllThatTheCourseUses) {
    const fs::path folder = data / "good";
    const Scene scene = load_obj(folder / "everything.obj");
    ASSERT_EQ(scene.materials.size(), 6u);

    EXPECT_EQ(scene.materials[0].name, "");
    EXPECT_EQ(scene.materials[0].diffuse, vec3(0.8f));  // not what precedes the first newmtl
    const Material& plain = scene.materials[1];
    EXPECT_EQ(plain.name, "plain");
    EXPECT_EQ(plain.diffuse, vec3(0.8f));
    EXPECT_EQ(plain.opacity, 1.0f);
    EXPECT_TRUE(plain.diffuse_map.file.empty());

    const Material& all = scene.materials[2];
    EXPECT_EQ(all.ambient, vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(all.diffuse, vec3(0.4f, 0.5f, 0.6f));
    EXPECT_EQ(all.specular, vec3(0.7f));
    EXPECT_EQ(all.emission, vec3(1, 2, 3));
    EXPECT_EQ(all.shininess, 96.5f);
    EXPECT_EQ(all.opacity, 0.25f);  // d counts more than Tr
    EXPECT_EQ(all.illumination, 1);
    EXPECT_EQ(all.diffuse_map.file, folder / "wood.png");
    EXPECT_EQ(all.specular_map.file, folder / "shine map.png");
    EXPECT_EQ(all.specular_map.offset, dvec3(1, 2, 3));
    EXPECT_EQ(all.specular_map.scale, dvec3(4, 5, 6));
    EXPECT_EQ(all.specular_map.clamp, bvec2(true));
    EXPECT_EQ(all.opacity_map.file, folder / "./masks/leaf.png");
    EXPECT_EQ(all.bump_map.file, folder / "height map.png");
    EXPECT_EQ(all.bump_map.bump_multiplier, 0.5f);
    EXPECT_EQ(all.normal_map.file, folder / "normal.png");
    EXPECT_EQ(all.normal_map.scale, dvec3(2, 1, 1));

    const Material& clear = scene.materials[3];
    EXPECT_EQ(clear.opacity, 0.25f);
    EXPECT_EQ(clear.diffuse_map.file, "/textures/absolute.png");
    EXPECT_EQ(clear.bump_map.offset, dvec3(0.5, 0.25, 0));
    EXPECT_EQ(clear.bump_map.clamp, bvec2(false));

    const Material& limits = scene.materials[4];
    EXPECT_EQ(limits.opacity, 1.0f);
    EXPECT_EQ(limits.shininess, 0.0f);
    EXPECT_EQ(limits.illumination, 10);
    EXPECT_EQ(limits.diffuse, vec3(0.8f));
    EXPECT_EQ(limits.ambient, vec3(1.0f));

    const Material& halo = scene.materials[5];
    EXPECT_EQ(halo.opacity, 1.0f);
    EXPECT_EQ(halo.diffuse_map.file, folder / "2 planks.png");
}

TEST(Obj, ColoursAreBroughtIntoTheirRange) {
    const Scene scene = load_obj(data / "good/bright.obj");
    const Material& bright = scene.materials.at(1);
    EXPECT_EQ(bright.diffuse, vec3(max_color, -max_color, 0.5f));
    EXPECT_EQ(bright.emission, vec3(max_color));
}

TEST(Obj, AMaterialMayHaveNoName) {
    const Scene scene = load_obj(data / "good/material_without_name.obj");
    const Face& face = scene.meshes.at(0).faces.at(0);
    EXPECT_EQ(scene.materials.at(face.material).diffuse, vec3(0.0f));  // not that of the default
}

TEST(Obj, PathsAreRelativeToTheFileThatNamesThem) {
    const Scene scene = load_obj(data / "good/mtllib_with_backslash.obj");
    EXPECT_EQ(scene.materials.at(1).diffuse_map.file, data / "good/./folder/wood.png");
}

TEST(Obj, OfTwoMaterialsWithOneNameTheFirstCounts) {
    const Scene scene = load_obj(data / "good/material_defined_twice.obj");
    ASSERT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(scene.materials[1].diffuse, vec3(1, 0, 0));
    EXPECT_EQ(scene.materials[1].opacity, 1.0f);
}

/// Reads a model of one triangle for each name that usemtl is given; the materials of a library.
Scene model_with(const std::string& library, const Lines& used) {
    write_file("of_names.mtl", library);
    std::string text = "mtllib of_names.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (const std::string& name : used) text += "usemtl " + name + "\nf 1 2 3 # note\n";
    return load_obj(write_file("of_names.obj", text));
}

/// The red parts of the triangles' materials.
std::vector<float> reds_of(const Scene& scene) {
    std::vector<float> reds;
    for (const Triangle& t : scene.meshes.at(0).triangles)
        reds.push_back(scene.materials.at(t.material).diffuse.r);
    return reds;
}

TEST(Obj, MaterialsNamesMayHoldAHash) {
    const Lines names = {"Paint #1", "Paint #2", "#1", "a # b", "a # c", "x#y #z", "\"q #1\"", "p"};
    std::string library;
    for (std::size_t i = 0; i < names.size(); ++i)
        library += "newmtl " + names[i] + "\nKd " + std::to_string(i) + " 0 0 # red\n";
    const Scene scene = model_with(library, names);
    EXPECT_EQ(reds_of(scene), (std::vector<float>{0, 1, 2, 3, 4, 5, 6, 7}));
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(Obj, BehindANameMayStandAComment) {
    const Scene scene = model_with("newmtl p\nKd 1 0 0\nnewmtl b # as its library says\nKd 2 0 0\n",
                                   {"p # as a whole", "b", "b # twice", "b #3", "p#1"});
    EXPECT_EQ(reds_of(scene), (std::vector<float>{1, 2, 2, 0.8f, 0.8f}));
    EXPECT_EQ(warnings_of(scene, temporary_folder()),
              (Lines{"of_names.obj:11: there is no material \"b #3\"",
                     "of_names.obj:13: there is no material \"p#1\""}));
}

TEST(Obj, FilesNamesMayHoldAHashWhereThereIsSuchAFile) {
    write_file("library #1.mtl", "newmtl a\nKd 0.5 0 0\n");
    const Scene scene =
        load_obj(write_file("hash.obj", "mtllib library #1.mtl\nusemtl a\n" + triangle));
    EXPECT_EQ(reds_of(scene), std::vector<float>{0.5f});
    for (const std::string name : {"wood #2.png", "#2.png", "wood#.png", "a # b.png"}) {
        const auto file_of_map = [&](const std::string& words) {
            const std::string statement = "map_Kd -s 2 2 1 -clamp on " + words;
            return model_with("newmtl a\n" + statement + "\n", {"a"})
                .materials.at(1)
                .diffuse_map.file;
        };
        const fs::path file = write_file(name, ""), folder = temporary_folder();
        EXPECT_EQ(file_of_map(name), file);
        EXPECT_EQ(file_of_map("\"" + name + "\""), file);
        fs::remove(file);
        const std::string cut = name.substr(0, name.find(" #"));
        EXPECT_EQ(file_of_map(name), name[0] == '#' ? fs::path() : folder / cut);
    }
}

TEST(Obj, WhatIsNotReadIsSaidOnceAKind) {
    std::string library = "newmtl a\nNi 1.5\nTf 1 1 1\nrefl \n";
    Lines kinds = {"map_Ns", "map_Pr", "Pr", "Pm", "disp", "decal", "refl", "map_Ka"};
    for (int i = 0; i < 40; ++i) kinds.push_back("own_" + std::to_string(i));
    for (const std::string& kind : kinds) library += kind + " 1\n" + kind + " 2\n";
    const Lines warnings = model_with(library, {"a"}).warnings;
    ASSERT_EQ(warnings.size(), 33u);
    for (std::size_t i = 0; i < 32; ++i)
        EXPECT_EQ(
            without_folder(warnings[i], temporary_folder()),
            "of_names.mtl:" + std::to_string(5 + 2 * i) + ": \"" + kinds[i] + "\" is not read");
    EXPECT_TRUE(warnings.back().ends_with(":69: further kinds of statements are not read"));
}

TEST(Obj, PositionsColorsAreDecodedFromSrgb) {
    constexpr float of_half = 0.2140411f, of_0_02 = 0.02f / 12.92f;
    const std::vector<vec4> of_a = {{0, of_0_02, of_half, 1}, {of_half, 1, 0, 1}, vec4(1)},
                            of_b = {{of_half, 1, 0, 1}, vec4(1), vec4(1)};
    // With r g b; with r g b and opacity; with a w; with nothing.
    const std::string up_to_1 = "v 0 0 0 0 0.02 0.5\nv 1 0 0 0.5 1 0 0.25\nv 0 1 0 0.5\nv 1 1 0\n",
                      up_to_255 = "v 0 0 0 0 5.1 127.5\nv 1 0 0 127.5 255 0 64\nv 0 1 0\nv 1 1 0\n",
                      faces = "g a\nf 1 2 3\ng b\nf 2 4 3\n";
    for (const std::string& positions : {up_to_1, up_to_255}) {
        const Scene scene = load_obj(write_file("colors.obj", positions + faces));
        EXPECT_EQ(scene.warnings.size(), positions == up_to_1 ? 0u : 1u);
        ASSERT_EQ(scene.meshes.size(), 2u);
        for (std::size_t i = 0; i < 3; ++i)
            for (int c = 0; c < 4; ++c) {
                EXPECT_NEAR(scene.meshes[0].colors.at(i)[c], of_a[i][c], 2e-5) << positions;
                EXPECT_NEAR(scene.meshes[1].colors.at(i)[c], of_b[i][c], 2e-5) << positions;
            }
    }
    const std::string face = "v 1 0 0\nv 0 1 0\nf 1 2 3\n";
    EXPECT_TRUE(load_obj(write_file("w.obj", "v 0 0 0 1\n" + face)).meshes[0].colors.empty());
    const Scene bright = load_obj(write_file("above.obj", "v 0 0 0 -1 255 300\n" + face));
    EXPECT_EQ(bright.meshes[0].colors[0], vec4(0, 1, 1, 1));
    EXPECT_EQ(warnings_of(bright, temporary_folder()),
              Lines{"above.obj:1: colours above 1: all are taken as 0 to 255"});
}

TEST(Obj, SmoothingGroupsAreReadAndGroupsDoNotCount) {
    using Groups = std::vector<std::uint32_t>;
    const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    const Scene one = load_obj(write_file(
        "smooth.obj", points + "f 1 2 3\ns off\nf 1 2 3 4\ns 1 # note\nf 1 2 3\ns 0\nf 1 2 3\n"
                               "s on\nf 1 2 3\ns 7\nf 1 2 3\ns 4294967295\nf 1 2 3\n"));
    EXPECT_EQ(one.meshes.at(0).smoothing_groups,
              (Groups{smooth_by_angle, 0, 0, 1, 0, 1, 7, no_index - 1}));
    EXPECT_TRUE(one.meshes[0].shared_positions.empty());

    const std::array corners = {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1)};
    for (const std::string g : {"g", "o"}) {
        const Scene two = load_obj(write_file("smooth.obj", points + "s 7\n" + g + " a\nf 1 2 3\n" +
                                                                g + " b\nf 1 3 4\ns off\n" +
                                                                "f 2 3 4\n" + g + " a\nf 2 3 4\n"));
        ASSERT_EQ(two.meshes.size(), 2u);
        for (const Mesh& mesh : two.meshes) {
            EXPECT_EQ(mesh.smoothing_groups, (Groups{7, 0})) << g << ' ' << mesh.name;
            ASSERT_EQ(mesh.shared_positions.size(), mesh.positions.size());
            for (std::size_t i = 0; i < mesh.positions.size(); ++i)
                EXPECT_EQ(vec2(mesh.positions[i]), corners[mesh.shared_positions[i]]);
        }
    }
    const std::string with_normals = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\ns 1\nf 1//1 2//1 3//1\n";
    EXPECT_TRUE(
        load_obj(write_file("normals.obj", with_normals)).meshes.at(0).smoothing_groups.empty());
    EXPECT_EQ(warnings_of(load_obj(write_file("bad.obj", "s x\n" + triangle)), temporary_folder()),
              Lines{"bad.obj:1: \"x\" is not a smoothing group"});
}

TEST(Obj, ASingleMeshKeepsAllElements) {
    const Scene scene = load_obj(data / "good/elements_that_no_face_uses.obj");
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].positions.size(), 5u);
    EXPECT_EQ(scene.meshes[0].bounds.max, vec3(1, 1, 0));  // but its bounds are of those used
}

TEST(Obj, EachOfSeveralMeshesHasTheElementsThatItUses) {
    const Scene scene = load_obj(data / "good/elements_between_groups.obj");
    ASSERT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(scene.meshes[0].positions.size(), 3u);
    EXPECT_EQ(scene.meshes[0].uvs, std::vector<dvec2>{dvec2(1)});
    EXPECT_EQ(scene.meshes[0].normals.size(), 0u);
    EXPECT_EQ(scene.meshes[1].uvs.size(), 0u);
    EXPECT_EQ(scene.meshes[1].normals.size(), 1u);
}

TEST(Obj, TrianglesOfAConcaveFaceAreEars) {
    const Scene scene = load_obj(data / "good/concave_polygon.obj");
    const Mesh& mesh = scene.meshes.at(0);
    for (const auto& [vertices, material] : mesh.triangles) {
        const vec3 p = mesh.positions[vertices[0].position],
                   q = mesh.positions[vertices[1].position],
                   r = mesh.positions[vertices[2].position];
        EXPECT_GT(glm::cross(q - p, r - p).z, 0) << "a triangle lies outside of the face";
    }
}

TEST(Obj, MoreElementsThanAllowedAreAnError) {
    const fs::path file =
        write_file("elements.obj",
                   "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\ng a\nf 1 2 3\ng b\n"
                   "f 1 2 3\ng a\nf 3 2 1\n");
    EXPECT_EQ(error_of(file, 6), "");
    EXPECT_EQ(error_of(file, 5), "elements.obj:11: more than 5 vertices in a group");
    EXPECT_EQ(error_of(file, 2), "elements.obj:3: more than 2 positions");
    EXPECT_EQ(error_of(write_file("uvs.obj", "vt 0 0\nvt 0 0\n"), 1), "uvs.obj:2: more than 1 uvs");
    EXPECT_EQ(error_of(write_file("normals.obj", "vn 0 0 1\nvn 0 0 1\n"), 1),
              "normals.obj:2: more than 1 normals");
}

TEST(Obj, WhatIsNotARegularFileIsAnErrorAndNotAWait) {
    const fs::path folder = temporary_folder() / "special_files";
    fs::create_directories(folder);
    ASSERT_EQ(mkfifo((folder / "fifo.obj").c_str(), 0600), 0);
    fs::create_symlink("nowhere", folder / "broken.obj");
    EXPECT_EQ(error_of(folder / "missing.obj"), "missing.obj: there is no such file");
    EXPECT_EQ(error_of(folder / "broken.obj"), "broken.obj: there is no such file");
    EXPECT_EQ(error_of(folder / "fifo.obj"), "fifo.obj: not a regular file");
    EXPECT_EQ(error_of(write_file("special_files/model.obj", "mtllib fifo.obj\n")),
              "fifo.obj: not a regular file");
    const Scene scene =
        load_obj(write_file("special_files/model.obj", "mtllib broken.obj\n" + triangle));
    EXPECT_EQ(warnings_of(scene, folder),
              Lines{"model.obj:1: there is no material library \"broken.obj\""});
}

/// The reader takes a file in parts of 2^16 bytes: each way to end a line meets the end of a part.
TEST(Obj, StatementsMayLieAcrossTheEndOfAPart) {
    for (const std::string end : {"\n", "\r\n", "\r", " \\\n\n", " \\\r\n\r\n"})
        for (std::size_t before = 0; before < 40; ++before) {
            std::string text = "v 0 0 0\nv 1 0 0\n#";
            text.resize((1 << 16) - before, '-');
            text += "\nv 0 1 7" + end + "f 1 2 3" + end + "f 3 2 1" + end + "f 1 2 x";
            const auto is_line_end = [&](std::size_t i) {
                return text[i] == '\n' || (text[i] == '\r' && text[i + 1] != '\n');
            };
            std::size_t line = 1;
            for (std::size_t i = 0; i < text.size(); ++i) line += is_line_end(i);
            const fs::path file = write_file("parts.obj", text);
            ASSERT_EQ(error_of(file),
                      "parts.obj:" + std::to_string(line) + ": \"x\" is not a vertex of a face");
            text.back() = '3';
            const Scene scene = load_obj(write_file("parts.obj", text));
            ASSERT_EQ(scene.meshes.at(0).faces.size(), 3u);
            ASSERT_EQ(scene.meshes[0].positions.at(2), vec3(0, 1, 7));
        }
}

/// A number just beside the middle between two floats, exactly, so that to round it to double first
/// gives that middle.
std::string beside_a_middle(std::mt19937& random) {
    const float low = std::ldexp(1.0f + float(random() >> 9) * 0x1p-23f, -int(random() % 8));
    char middle[80];
    std::snprintf(middle, sizeof middle, "%.60g", (double{low} + std::nextafter(low, 2.0f)) / 2);
    std::string digits = middle;  // all of them; the last is 5
    if (random() % 2 == 0) return digits + "00000000000000001";
    digits.back() = '4';
    return digits + "99999999999999999";
}

/// As files may have it: up to 20 digits, perhaps an exponent.
std::string any_number(std::mt19937& random) {
    std::string number = random() % 2 ? "-0." : "0.";
    for (std::size_t count = 1 + random() % 20; count > 0; --count)
        number += char('0' + random() % 10);
    return random() % 3 ? number : number + "e" + std::to_string(int(random() % 60) - 55);
}

TEST(Obj, NumbersAreTheNearestFloats) {
    std::mt19937 random(seed);
    std::vector<std::string> numbers{"-0",      "0.5",    "0.000000000000001",
                                     "00001.5", "-1e-44", "+.7e+2"};
    for (int k = 0; k < 3000; ++k)
        numbers.push_back(k % 2 ? any_number(random) : beside_a_middle(random));
    std::string text = "v 1 1 -1\nv -1 0 0\nv 0 -1 1\nf 1 2 3\n";
    for (std::size_t k = 0; k < numbers.size(); k += 3)
        text += "v " + numbers[k] + ' ' + numbers[k + 1] + ' ' + numbers[k + 2] + '\n';
    const Scene scene = load_obj(write_file("numbers.obj", text));
    ASSERT_EQ(scene.origin, dvec3(0));
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        const float nearest = std::strtof(numbers[k].c_str(), nullptr),
                    read = scene.meshes.at(0).positions.at(3 + k / 3)[int(k % 3)];
        ASSERT_EQ(std::bit_cast<std::uint32_t>(read), std::bit_cast<std::uint32_t>(nearest))
            << numbers[k] << " is read as " << read << ", not as " << nearest;
    }
}

TEST(Obj, DamagedFilesGiveASoundSceneOrAnError) {
    std::vector<std::string> models, libraries;
    for (const auto& entry : fs::recursive_directory_iterator(data / "good")) {
        if (entry.path().extension() == ".obj" && entry.file_size() < 2000)
            models.push_back(test::read_text(entry.path()));
        if (entry.path().extension() == ".mtl") libraries.push_back(test::read_text(entry.path()));
    }
    std::ranges::sort(models), std::ranges::sort(libraries);
    std::mt19937 random(seed);
    const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
    const auto damaged = [&](std::string text) {
        const std::string signs = "0123456789 \t\n\r\\/#.-+e\"vfgtn\xff";
        for (std::size_t i = 0, count = 1 + below(4); i < count && !text.empty(); ++i) {
            const std::size_t at = below(text.size()), kind = below(5);
            if (kind == 0) text[at] = char(below(256));
            if (kind == 1) text[at] = signs[below(signs.size())];
            if (kind == 2) text.insert(at, 1, signs[below(signs.size())]);
            if (kind == 3) text.erase(at, 1 + below(8));
            if (kind == 4) text.insert(at, text.substr(below(text.size()), below(30)));
        }
        return text;
    };
    int read = 0, refused = 0;
    for (int i = 0; i < 20'000; ++i) {
        std::string model = damaged(models[below(models.size())]);
        if (i % 4 == 0) {
            write_file("damaged.mtl", damaged(libraries[below(libraries.size())]));
            model = "mtllib damaged.mtl\nusemtl red\n" + triangle;
        }
        const fs::path file = write_file("damaged.obj", model);
        try {
            ASSERT_TRUE(is_sound(load_obj(file))) << "seed " << seed << ", file " << i << ":\n"
                                                  << model;
            ++read;
        } catch (const InputError&) { ++refused; }
    }
    EXPECT_GT(read, 2000);  // Else the damage is too great to find anything.
    EXPECT_GT(refused, 2000);
}

}  // namespace
}  // namespace rasterbook
