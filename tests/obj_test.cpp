// SPDX-License-Identifier: MIT
/// @file
/// Model files. tests/data/obj/good and bad hold a small file for each way in which OBJ files
/// differ or go wrong; each begins with comments that say what is expected of it.
#include "common/model/obj.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <tiny_obj_loader.h>
#include <unistd.h>

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

namespace rasterbook {
namespace {

namespace fs = std::filesystem;

const fs::path data = fs::path(RASTERBOOK_TEST_DATA) / "obj";
constexpr unsigned seed = 1;

using Lines = std::vector<std::string>;

std::string bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// A folder for the files of this process; it goes with it.
const fs::path& temporary_folder() {
    static const struct Folder {
        fs::path path =
            fs::path(testing::TempDir()) / ("rasterbook_obj_" + std::to_string(getpid()));
        Folder() { fs::create_directories(path); }
        ~Folder() { fs::remove_all(path); }
    } folder;
    return folder.path;
}

fs::path write_file(const std::string& name, const std::string& bytes) {
    const fs::path file = temporary_folder() / name;
    fs::remove(file);  // Some file systems write through to the disk when a file is replaced.
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
}

/// The texts of the comments "# expect KIND: TEXT" in a file.
Lines expected(const fs::path& file, const std::string& kind) {
    std::string text = bytes_of(file);
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
std::string with_commas(const Vector& vector, int digits) {
    std::ostringstream out;
    out.precision(digits);
    for (int i = 0; i < vector.length(); ++i)
        out << (i > 0 ? "," : "") << float(vector[i]) + 0.0f;  // no -0
    return out.str();
}

/// A vertex as OBJ has it, but with values in place of indices.
template <typename Uv>
std::string vertex_text(const vec3& position, const Uv* uv, const vec3* normal, int digits) {
    std::string text = with_commas(position, digits);
    if (uv || normal) text += "/";
    if (uv) text += with_commas(*uv, digits);
    if (normal) text += "/" + with_commas(*normal, digits);
    return text;
}

std::string face_start(const std::string& group, const std::string& material) {
    return "group \"" + group + "\" material \"" + material + "\"";
}

/// All faces, with the values that their vertices refer to.
Lines faces_of(const Scene& scene, int digits = 9) {
    Lines faces;
    for (const Mesh& mesh : scene.meshes)
        for (const Face& face : mesh.faces) {
            faces.push_back(face_start(mesh.name, scene.materials.at(face.material).name));
            for (const auto& [position, uv, normal] : mesh.vertices_of(face))
                faces.back() +=
                    " " + vertex_text(mesh.positions.at(position),
                                      uv == no_index ? nullptr : &mesh.uvs.at(uv),
                                      normal == no_index ? nullptr : &mesh.normals.at(normal),
                                      digits);
        }
    return faces;
}

/// The same, as tinyobjloader reads them.
Lines faces_of_tinyobj(const fs::path& file, int digits) {
    tinyobj::attrib_t all;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warnings, errors;
    const std::string folder = file.parent_path().string() + "/";
    if (!tinyobj::LoadObj(&all, &shapes, &materials, &warnings, &errors, file.c_str(),
                          folder.c_str(), false))
        return {errors};

    const auto vec3_at = [](const auto& values, std::size_t i) {
        return vec3(values.at(3 * i), values.at(3 * i + 1), values.at(3 * i + 2));
    };
    const auto vec2_at = [](const auto& values, std::size_t i) {
        return vec2(values.at(2 * i), values.at(2 * i + 1));
    };
    Lines faces;
    for (const auto& [name, mesh, lines, points] : shapes)
        for (std::size_t face = 0, first = 0; face < mesh.num_face_vertices.size(); ++face) {
            const int material = mesh.material_ids[face];
            faces.push_back(
                face_start(name, material < 0 ? "" : materials[std::size_t(material)].name));
            for (std::size_t i = 0; i < mesh.num_face_vertices[face]; ++i) {
                const auto [position, normal, uv] = mesh.indices[first + i];
                vec2 uv_value;
                vec3 normal_value;
                if (uv >= 0) uv_value = vec2_at(all.texcoords, std::size_t(uv));
                if (normal >= 0) normal_value = vec3_at(all.normals, std::size_t(normal));
                faces.back() += " " + vertex_text(vec3_at(all.vertices, std::size_t(position)),
                                                  uv < 0 ? nullptr : &uv_value,
                                                  normal < 0 ? nullptr : &normal_value, digits);
            }
            first += mesh.num_face_vertices[face];
        }
    return faces;
}

/// For EXPECT_TRUE: what every scene keeps to.
testing::AssertionResult is_sound(const Scene& scene) {
    for (const Mesh& mesh : scene.meshes) {
        const auto is_in_range = [&](const Vertex& vertex) {
            return vertex.position < mesh.positions.size() &&
                   (vertex.uv == no_index || vertex.uv < mesh.uvs.size()) &&
                   (vertex.normal == no_index || vertex.normal < mesh.normals.size());
        };
        Bounds bounds;
        std::size_t triangle_count = 0, vertex_count = 0;
        for (const Face& face : mesh.faces) {
            if (face.material >= scene.materials.size() || face.first_vertex != vertex_count ||
                face.vertex_count < 3)
                return testing::AssertionFailure() << "wrong face in " << mesh.name;
            vertex_count += face.vertex_count, triangle_count += face.vertex_count - 2;
        }
        if (vertex_count != mesh.vertices.size() ||
            !std::ranges::all_of(mesh.vertices, is_in_range))
            return testing::AssertionFailure() << "wrong vertices in " << mesh.name;
        for (const Vertex& vertex : mesh.vertices) bounds.add(mesh.positions[vertex.position]);
        if (mesh.faces.empty() || bounds.min != mesh.bounds.min || bounds.max != mesh.bounds.max)
            return testing::AssertionFailure() << "wrong bounds of " << mesh.name;
        if (mesh.triangles.size() != triangle_count)
            return testing::AssertionFailure()
                   << mesh.triangles.size() << " triangles in " << mesh.name;
        for (const auto& [vertices, material] : mesh.triangles)
            if (material >= scene.materials.size() || !std::ranges::all_of(vertices, is_in_range))
                return testing::AssertionFailure() << "wrong triangle in " << mesh.name;
    }
    return testing::AssertionSuccess();
}

TEST(Obj, GoodFilesGiveTheFacesAndWarningsThatTheyState) {
    const auto files = models_in(data / "good");
    EXPECT_GE(files.size(), 70u);
    for (const fs::path& file : files) {
        SCOPED_TRACE(file);
        const Scene scene = load_obj(file);
        EXPECT_TRUE(is_sound(scene));
        EXPECT_EQ(faces_of(scene), expected(file, "face"));
        Lines warnings;
        for (const std::string& warning : scene.warnings)
            warnings.push_back(without_folder(warning, file.parent_path()));
        EXPECT_EQ(warnings, expected(file, "warning"));
    }
}

enum class Deviation { of_names, of_vertices };

/// Where tinyobjloader reads something else, and what it does.
const std::map<std::string, std::pair<Deviation, std::string>> tinyobj_deviations = {
    {"comment_at_end_of_line", {Deviation::of_vertices, "takes the comment for vertices"}},
    {"continuation_crlf", {Deviation::of_vertices, "does not continue lines"}},
    {"continuation_lines", {Deviation::of_vertices, "does not continue lines"}},
    {"group_name_with_blanks", {Deviation::of_names, "writes one blank for several"}},
    {"group_without_name", {Deviation::of_names, "keeps the name of the group before"}},
    {"material_name_with_blanks", {Deviation::of_names, "takes the first word after usemtl"}},
    {"mtllib_in_quotes", {Deviation::of_names, "takes quotes for a part of the name"}},
    {"mtllib_with_backslash", {Deviation::of_names, "takes a backslash for an escape"}},
    {"mtllib_with_blanks", {Deviation::of_names, "takes each word for a name"}},
    {"polygon_of_300_vertices", {Deviation::of_vertices, "counts modulo 256 in some versions"}},
    {"several_mtllibs_on_one_line", {Deviation::of_names, "stops at the first that it finds"}},
    {"slashes_at_the_end", {Deviation::of_vertices, "takes a missing index for 0"}},
    {"usemtl_before_mtllib", {Deviation::of_names, "knows only the materials read so far"}},
    {"utf8_byte_order_mark",
     {Deviation::of_vertices, "takes the mark for a part of the first word in some versions"}},
};

/// The faces' vertices alone.
Lines without_names(Lines faces) {
    const std::string start_of_vertices = "\" ";  // behind the material's name
    for (std::string& face : faces)
        if (const auto end = face.rfind(start_of_vertices); end != face.npos)
            face.erase(0, end + 2);
    return faces;
}

TEST(Obj, FacesEqualThoseOfTinyobjloader) {
    // Six digits: tinyobjloader adds up the digits in double with rounding errors.
    constexpr int digits = 6;
    std::size_t compared = 0;
    const auto files = models_in(data / "good");
    for (const fs::path& file : files) {
        const auto deviation = tinyobj_deviations.find(file.stem());
        const bool deviates = deviation != tinyobj_deviations.end();
        if (deviates && deviation->second.first == Deviation::of_vertices) continue;
        SCOPED_TRACE(file);
        Lines ours = faces_of(load_obj(file), digits), theirs = faces_of_tinyobj(file, digits);
        if (deviates) ours = without_names(ours), theirs = without_names(theirs);
        // A group that comes again is two shapes there.
        std::ranges::sort(ours), std::ranges::sort(theirs);
        EXPECT_EQ(ours, theirs);
        ++compared;
    }
    const auto skipped = std::ranges::count(tinyobj_deviations, Deviation::of_vertices,
                                            [](const auto& entry) { return entry.second.first; });
    EXPECT_EQ(compared + static_cast<std::size_t>(skipped), files.size());
}

TEST(Obj, BadFilesAreErrorsWithFileAndLine) {
    const std::map<std::string, std::string> unmarked = {
        // These cannot hold a comment.
        {"empty", "empty.obj: holds no faces"},
        {"one_nul_byte", "one_nul_byte.obj:1: not text: control character 0"},
        {"utf16_be", "utf16_be.obj:1: the text is UTF-16, not UTF-8"},
        {"utf16_be_without_mark", "utf16_be_without_mark.obj:1: the text is UTF-16, not UTF-8"},
        {"utf16_le", "utf16_le.obj:1: the text is UTF-16, not UTF-8"},
        {"utf16_le_without_mark", "utf16_le_without_mark.obj:1: the text is UTF-16, not UTF-8"},
    };
    const auto files = models_in(data / "bad");
    EXPECT_GE(files.size(), 70u);
    for (const fs::path& file : files) {
        SCOPED_TRACE(file);
        if (unmarked.contains(file.stem())) {
            EXPECT_EQ(error_of(file), unmarked.at(file.stem()));
            continue;
        }
        const Lines messages = expected(file, "error");
        ASSERT_EQ(messages.size(), 1u);
        EXPECT_EQ(error_of(file), messages[0]);
    }
}

TEST(Obj, MaterialsAreReadWithAllThatTheCourseUses) {
    const fs::path folder = data / "good";
    const Scene scene = load_obj(folder / "everything.obj");
    ASSERT_EQ(scene.materials.size(), 6u);

    const Material &fallback = scene.materials[0], &plain = scene.materials[1];
    EXPECT_EQ(fallback.name, "");
    EXPECT_EQ(fallback.diffuse, vec3(0.8f));  // untouched by what stands before the first newmtl
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

TEST(Obj, MaterialsNamesMayHoldAHash) {
    const Lines names = {"Paint #1", "Paint #2", "#1", "a # b", "a # c", "x#y #z", "\"q #1\"", "p"};
    std::string library;
    for (std::size_t i = 0; i < names.size(); ++i)
        library += "newmtl " + names[i] + "\nKd " + std::to_string(i) + " 0 0 # red\n";
    const Scene scene = model_with(library, names);
    ASSERT_EQ(scene.meshes.at(0).triangles.size(), names.size());
    for (std::size_t i = 0; i < names.size(); ++i)
        EXPECT_EQ(scene.materials[scene.meshes[0].triangles[i].material].diffuse.r,
                  static_cast<float>(i))
            << "of " << names[i];
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(Obj, BehindANameMayStandAComment) {
    const Lines used = {"p # as a whole", "b", "b # twice", "b #3", "p#1"};
    const Scene scene =
        model_with("newmtl p\nKd 1 0 0\nnewmtl b # as its library says\nKd 2 0 0\n", used);
    const std::array red = {1.0f, 2.0f, 2.0f, 0.8f, 0.8f};
    ASSERT_EQ(scene.meshes.at(0).triangles.size(), used.size());
    for (std::size_t i = 0; i < used.size(); ++i)
        EXPECT_EQ(scene.materials[scene.meshes[0].triangles[i].material].diffuse.r, red[i])
            << "of " << used[i];
    const Lines expected = {"of_names.obj:11: there is no material \"b #3\"",
                            "of_names.obj:13: there is no material \"p#1\""};
    Lines warnings;
    for (const std::string& warning : scene.warnings)
        warnings.push_back(without_folder(warning, temporary_folder()));
    EXPECT_EQ(warnings, expected);
}

TEST(Obj, FilesNamesMayHoldAHashWhereThereIsSuchAFile) {
    const fs::path library = write_file("library #1.mtl", "newmtl a\nKd 0.5 0 0\n");
    const std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    EXPECT_EQ(load_obj(write_file("hash.obj", "mtllib library #1.mtl\n" + faces))
                  .materials.at(1)
                  .diffuse.r,
              0.5f);
    for (const std::string name : {"wood #2.png", "#2.png", "wood#.png", "a # b.png"}) {
        const auto file_of_map = [&](const std::string& statement) {
            return model_with("newmtl a\n" + statement + "\n", {"a"})
                .materials.at(1)
                .diffuse_map.file;
        };
        const std::string options = "map_Kd -s 2 2 1 -clamp on ";
        write_file(name, "");
        EXPECT_EQ(file_of_map(options + name), temporary_folder() / name);
        EXPECT_EQ(file_of_map(options + "\"" + name + "\""), temporary_folder() / name);
        fs::remove(temporary_folder() / name);
        const std::string cut = name.substr(0, name.find(" #"));
        EXPECT_EQ(file_of_map(options + name),
                  name[0] == '#' ? fs::path() : temporary_folder() / cut);
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

/// Linear light of an sRGB-encoded value.
double decoded(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

TEST(Obj, PositionsColorsAreDecodedFromSrgb) {
    // Faces of positions in any order, in groups; with r g b, with a w or nothing (white), with
    // r g b and opacity, or with numbers up to 255.
    std::mt19937 random(seed);
    for (const int most : {1, 255})
        for (const std::size_t groups : {1u, 4u}) {
            std::ostringstream text;
            std::vector<vec3> linear;
            for (std::size_t i = 0; i < 90; ++i) {
                const std::size_t kind = i % 5;
                text << "v " << i << " 0 " << i * i;
                linear.emplace_back(1);
                if (kind == 1) text << " 0.5";
                for (int c = 0; c < 3 && kind > 1; ++c) {
                    const auto value = random() % 256;
                    text << ' ' << double(value) / (most == 1 ? 255 : 1);
                    linear.back()[c] = float(decoded(double(value) / 255));
                }
                text << (kind == 4 ? " 0.25\n" : "\n");
            }
            for (std::size_t i = 0; i < 30; ++i)
                text << "g " << i % groups << "\nf " << 1 + i << ' ' << 31 + i << ' ' << 90 - i
                     << '\n';
            const fs::path file = write_file("colors.obj", text.str());
            const Scene scene = load_obj(file);
            EXPECT_EQ(scene.warnings.size(), most == 1 ? 0u : 1u);
            EXPECT_EQ(scene.meshes.size(), groups);
            for (const Mesh& mesh : scene.meshes) {
                ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
                for (std::size_t i = 0; i < mesh.colors.size(); ++i) {
                    const vec3 right = linear[std::size_t(mesh.positions[i].x)];
                    for (int c = 0; c < 3; ++c) ASSERT_NEAR(mesh.colors[i][c], right[c], 2e-5);
                    ASSERT_EQ(mesh.colors[i].a, 1);
                }
            }
        }
    const std::string face = "v 1 0 0\nv 0 1 0\nf 1 2 3\n";
    EXPECT_TRUE(load_obj(write_file("w.obj", "v 0 0 0 1\n" + face)).meshes[0].colors.empty());
    const Scene bright = load_obj(write_file("above.obj", "v 0 0 0 -1 255 300\n" + face));
    EXPECT_EQ(bright.meshes[0].colors[0], vec4(0, 1, 1, 1));
    EXPECT_TRUE(
        bright.warnings.at(0).ends_with("above.obj:1: colours above 1: all are taken as 0 to 255"));
}

TEST(Obj, SmoothingGroupsAreReadAndGroupsDoNotCount) {
    std::mt19937 random(seed);
    const std::map<std::string, std::uint32_t> groups = {
        {"off", 0}, {"0", 0}, {"1", 1}, {"on", 1}, {"7", 7}, {"4294967295", no_index - 1}};
    const std::array corners = {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1)};
    for (const std::string between : {"", "g", "o"}) {
        std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\n";
        std::vector<std::uint32_t> right = {smooth_by_angle};  // of the triangles with vertex 1
        for (int i = 0; i < 40; ++i) {
            if (!between.empty()) text += between + " " + std::to_string(random() % 3) + "\n";
            const auto group = std::next(groups.begin(), long(random() % groups.size()));
            text += "s " + group->first + " # note\nf 1 2 3\nf 1 2 3 4\n";
            right.insert(right.end(), 3, group->second);
        }
        const Scene scene = load_obj(write_file("smooth.obj", text));
        std::vector<std::uint32_t> found;
        for (const Mesh& mesh : scene.meshes) {
            auto own = mesh.smoothing_groups;
            if (own.empty()) own.assign(mesh.triangles.size(), smooth_by_angle);
            EXPECT_EQ(own.size(), mesh.triangles.size());
            found.insert(found.end(), own.begin(), own.end());
            for (std::size_t i = 0; i < mesh.shared_positions.size(); ++i)
                EXPECT_EQ(vec2(mesh.positions[i]), corners[mesh.shared_positions[i]]);
            EXPECT_EQ(mesh.shared_positions.empty(), between.empty());
        }
        if (!between.empty()) std::ranges::sort(found), std::ranges::sort(right);
        EXPECT_EQ(found, right) << "with " << between;
    }
    EXPECT_TRUE(load_obj(write_file("normals.obj",
                                    "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\ns 1\nf 1//1 2//1 3//1\n"))
                    .meshes[0]
                    .smoothing_groups.empty());
    EXPECT_TRUE(load_obj(write_file("bad.obj", "s x\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"))
                    .warnings.at(0)
                    .ends_with("bad.obj:1: \"x\" is not a smoothing group"));
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
    float doubled_area = 0;
    for (const auto& [vertices, material] : scene.meshes.at(0).triangles) {
        const auto position = [&](int i) {
            return scene.meshes[0].positions[vertices[std::size_t(i)].position];
        };
        const float doubled = glm::cross(position(1) - position(0), position(2) - position(0)).z;
        EXPECT_GT(doubled, 0);
        doubled_area += doubled;
    }
    EXPECT_EQ(doubled_area, 20);  // 32 less the notch, 12
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
    fs::create_directories(folder / "folder.obj");
    ASSERT_EQ(mkfifo((folder / "fifo.obj").c_str(), 0600), 0);
    fs::create_symlink("nowhere", folder / "broken.obj");
    fs::create_symlink("/dev/zero", folder / "zero.obj");
    EXPECT_EQ(error_of(folder / "missing.obj"), "missing.obj: there is no such file");
    EXPECT_EQ(error_of(folder / "broken.obj"), "broken.obj: there is no such file");
    EXPECT_EQ(error_of(folder / "folder.obj"), "folder.obj: not a regular file");
    EXPECT_EQ(error_of(folder / "fifo.obj"), "fifo.obj: not a regular file");
    EXPECT_EQ(error_of(folder / "zero.obj"), "zero.obj: not a regular file");

    for (const std::string name :
         {"folder.obj", "fifo.obj", "zero.obj"}) {  // In place of a library.
        const fs::path file = write_file("special_files/model.obj", "mtllib " + name + "\n");
        EXPECT_EQ(error_of(file), name + ": not a regular file");
    }
    const Scene scene = load_obj(write_file(
        "special_files/model.obj", "mtllib broken.obj\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_EQ(without_folder(scene.warnings[0], folder),
              "model.obj:1: there is no material library \"broken.obj\"");
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

TEST(Obj, AFaceMayHaveAHundredThousandVertices) {
    constexpr int vertex_count = 100'000;
    std::string text, face = "f";
    for (int i = 0; i < vertex_count;
         ++i) {  // Teeth of a comb, along a parabola that opens upwards.
        const long x = i - vertex_count / 2;
        text += "v " + std::to_string(x) + " " + std::to_string(x * x / 1000 + i % 2) + " 0\n";
        face += " " + std::to_string(i + 1);
    }
    const Scene scene = load_obj(write_file("large.obj", text + face));
    EXPECT_TRUE(is_sound(scene));
    EXPECT_EQ(scene.meshes.at(0).triangles.size(), vertex_count - 2u);
}

/// Writes the statements of a model in a random style.
class RandomWriter {
  public:
    explicit RandomWriter(std::mt19937& random)
        : random_(random), line_end_(pick({"\n", "\r\n", "\r"})) {}

    std::string pick(const std::vector<std::string>& choices) {
        return choices[random_() % choices.size()];
    }
    std::string gap() { return pick({" ", " ", " ", "  ", "\t", " \\" + line_end_ + " "}); }
    std::string line(const std::vector<std::string>& words) {
        std::string text = pick({"", "", "", "\t", "  "});
        for (std::size_t i = 0; i < words.size(); ++i) text += (i > 0 ? gap() : "") + words[i];
        return text + pick({"", "", " ", " # 1 2 3", "\t#"}) + line_end_ +
               pick({"", "", "", line_end_, "# f 1" + line_end_});
    }
    std::string number(float x) {
        std::ostringstream out;
        out.precision(9);
        if (random_() % 4 == 0) out << std::scientific;
        if (random_() % 4 == 0) out << std::showpos;
        out << x;
        return out.str();
    }

  private:
    std::mt19937& random_;
    std::string line_end_;
};

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
    std::string digits;
    for (std::size_t i = 0, count = 1 + random() % 20; i < count; ++i)
        digits += char('0' + random() % 10);
    std::string number = (random() % 2 ? "-0." : "0.") + digits;
    if (random() % 3 == 0) number += "e" + std::to_string(int(random() % 60) - 55);
    return number;
}

TEST(Obj, NumbersAreTheNearestFloats) {
    std::mt19937 random(seed);
    for (int i = 0; i < 20; ++i) {
        std::vector<std::string> numbers{"-0", "0.5", "0.000000000000001", "00001.5"};
        for (int k = 0; k < 146; ++k) numbers.push_back(any_number(random));
        for (int k = 0; k < 150; ++k) numbers.push_back(beside_a_middle(random));
        std::string text = "v 1 1 -1\nv -1 0 0\nv 0 -1 1\nf 1 2 3\n";
        for (std::size_t k = 0; k < numbers.size(); k += 3)
            text += "v " + numbers[k] + ' ' + numbers[k + 1] + ' ' + numbers[k + 2] + '\n';
        const Scene scene = load_obj(write_file("numbers.obj", text));
        ASSERT_EQ(scene.origin, dvec3(0));
        for (std::size_t k = 0; k < numbers.size(); ++k) {
            const float nearest = std::strtof(numbers[k].c_str(), nullptr);
            ASSERT_EQ(
                std::bit_cast<std::uint32_t>(scene.meshes[0].positions[3 + k / 3][int(k % 3)]),
                std::bit_cast<std::uint32_t>(nearest))
                << numbers[k] << " is not read as " << nearest;
        }
    }
}

TEST(Obj, RandomModelsAreReadBackEqual) {
    for (unsigned i = 0; i < 300; ++i) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", model " + std::to_string(i));
        std::mt19937 random(seed + i);
        RandomWriter writer(random);
        const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
        std::normal_distribution<float> any_float(0, 100);
        const auto random_vec3 = [&] {
            return vec3(any_float(random), any_float(random), any_float(random));
        };
        std::vector<vec3> positions(3 + below(20)), normals(below(5));
        std::vector<vec2> uvs(below(5));
        for (vec3& position : positions) position = random_vec3();
        for (vec3& normal : normals) normal = random_vec3();
        for (vec2& uv : uvs) uv = vec2(random_vec3());

        std::string elements, faces;
        for (const vec3& v : positions)
            elements +=
                writer.line({"v", writer.number(v.x), writer.number(v.y), writer.number(v.z)});
        for (const vec3& v : normals)
            elements +=
                writer.line({"vn", writer.number(v.x), writer.number(v.y), writer.number(v.z)});
        for (const vec2& v : uvs)
            elements += writer.line({"vt", writer.number(v.x), writer.number(v.y)});

        const bool faces_first = below(4) == 0;  // Then all indices are positive.
        const auto index_text = [&](std::size_t index, std::size_t count) {
            if (!faces_first && below(3) == 0) return std::to_string(long(index) - long(count));
            return std::to_string(index + 1);
        };
        Lines expected_faces;
        for (std::size_t face = 0, face_count = 1 + below(12); face < face_count; ++face) {
            const std::string group = writer.pick({"a", "b", "c d"});
            faces += writer.line({writer.pick({"g", "o"}) + " " + group});
            std::vector<std::string> words{"f"};
            std::string text = face_start(group, "");
            for (std::size_t vertex = 0, count = 3 + below(6); vertex < count; ++vertex) {
                const std::size_t position = below(positions.size());
                const std::size_t uv = below(uvs.size() + 1),
                                  normal = below(normals.size() + 1);  // the last: none
                const bool has_uv = uv < uvs.size(), has_normal = normal < normals.size();
                words.push_back(index_text(position, positions.size()));
                if (has_uv || has_normal) words.back() += "/";
                if (has_uv) words.back() += index_text(uv, uvs.size());
                if (has_normal) words.back() += "/" + index_text(normal, normals.size());
                text += " " + vertex_text(positions[position], has_uv ? &uvs[uv] : nullptr,
                                          has_normal ? &normals[normal] : nullptr, 9);
            }
            faces += writer.line(words);
            expected_faces.push_back(text);
        }
        const Scene scene =
            load_obj(write_file("random.obj", faces_first ? faces + elements : elements + faces));
        EXPECT_TRUE(is_sound(scene));
        Lines read_faces = faces_of(scene);
        // Meshes come in the order of their first faces; within a mesh the order of the file holds.
        const auto by_group = [](const std::string& s, const std::string& t) {
            return s.substr(0, s.find("material")) < t.substr(0, t.find("material"));
        };
        std::ranges::stable_sort(read_faces, by_group),
            std::ranges::stable_sort(expected_faces, by_group);
        ASSERT_EQ(read_faces, expected_faces);
    }
}

TEST(Obj, DamagedFilesGiveASoundSceneOrAnError) {
    std::vector<std::string> models, libraries;
    for (const auto& entry : fs::recursive_directory_iterator(data / "good")) {
        if (entry.path().extension() == ".obj" && entry.file_size() < 2000)
            models.push_back(bytes_of(entry.path()));
        if (entry.path().extension() == ".mtl") libraries.push_back(bytes_of(entry.path()));
    }
    std::ranges::sort(models), std::ranges::sort(libraries);
    std::mt19937 random(seed);
    const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
    const auto damage = [&](std::string text) {
        const std::string signs = "0123456789 \t\n\r\\/#.-+e\"vfgtn\xff";
        for (std::size_t i = 0, count = 1 + below(4); i < count && !text.empty(); ++i) {
            const std::size_t at = below(text.size());
            const std::size_t kind = below(5);
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
        std::string model = damage(models[below(models.size())]);
        if (i % 4 == 0) {
            write_file("damaged.mtl", damage(libraries[below(libraries.size())]));
            model = "mtllib damaged.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
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
