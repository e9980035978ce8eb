// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "common/image/image_io.hpp"
#include "common/model/obj.hpp"
#include "support/lesson_process.hpp"

using namespace rasterbook;
using std::filesystem::path;

namespace {

const path assets = RASTERBOOK_ASSETS;

std::vector<path> files_in(const path& folder, const std::string& extension = "") {
    std::vector<path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (extension.empty() || entry.path().extension() == extension)
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

/// Relative names, with folders.
std::map<path, std::string> generated_part_of(const path& folder) {
    std::map<path, std::string> contents;
    for (const char* kind : {"models", "textures"})
        for (const path& file : files_in(folder / kind))
            contents[kind / file.filename()] = test::read_text(file);
    return contents;
}

/// Twice the area times the unit normal, by the polygon's outline (Newell's formula).
dvec3 area_vector(const Mesh& mesh, const Face& face) {
    dvec3 sum(0);
    const auto vertices = mesh.vertices_of(face);
    const dvec3 origin = mesh.positions[vertices[0].position];  // near: keeps the products small
    for (std::size_t i = 0; i < vertices.size(); ++i)
        sum += glm::cross(
            dvec3(mesh.positions[vertices[i].position]) - origin,
            dvec3(mesh.positions[vertices[(i + 1) % vertices.size()].position]) - origin);
    return sum;
}

double uv_area(const Mesh& mesh, const Face& face) {
    double sum = 0;
    const auto vertices = mesh.vertices_of(face);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const dvec2 a = mesh.uvs.at(vertices[i].uv);
        const dvec2 b = mesh.uvs.at(vertices[(i + 1) % vertices.size()].uv);
        sum += a.x * b.y - a.y * b.x;
    }
    return sum;
}

using Place = std::tuple<float, float, float>;

/// Edges that a face goes along with no other face going back. Places, not indices: a crack shows.
std::size_t border_edges(const std::vector<const Mesh*>& meshes) {
    std::set<std::pair<Place, Place>> edges;
    const auto place = [](vec3 p) { return Place(p.x, p.y, p.z); };
    for (const Mesh* mesh : meshes)
        for (const Face& face : mesh->faces) {
            const auto vertices = mesh->vertices_of(face);
            for (std::size_t i = 0; i < vertices.size(); ++i) {
                const vec3 from = mesh->positions[vertices[i].position];
                const vec3 to = mesh->positions[vertices[(i + 1) % vertices.size()].position];
                EXPECT_TRUE(edges.emplace(place(from), place(to)).second)
                    << mesh->name << ": three faces meet, or two of them disagree on the outside";
            }
        }
    return std::size_t(std::count_if(edges.begin(), edges.end(), [&](const auto& edge) {
        return !edges.contains({edge.second, edge.first});
    }));
}

const Mesh& group(const Scene& scene, std::string_view name) {
    const auto found = std::find_if(scene.meshes.begin(), scene.meshes.end(),
                                    [&](const Mesh& mesh) { return mesh.name == name; });
    if (found == scene.meshes.end()) throw std::runtime_error("no group " + std::string(name));
    return *found;
}

}  // namespace

TEST(Assets, GeneratingGivesTheCommittedFiles) {
    const path folder = test::fresh_folder("generated_assets");
    const auto result = test::run_program("generate_assets", {folder.string()});
    ASSERT_EQ(result.exit_status, 0) << result.err;

    const auto generated = generated_part_of(folder), committed = generated_part_of(assets);
    for (const auto& [name, content] : generated) {
        ASSERT_TRUE(committed.contains(name)) << name << " is generated but not committed";
        if (name.extension() == ".png")  // encoders compress differently
            EXPECT_EQ(read_image(folder / name), read_image(assets / name)) << name;
        else
            EXPECT_TRUE(committed.at(name) == content) << name << " differs";
    }
    for (const auto& [name, content] : committed)
        EXPECT_TRUE(generated.contains(name)) << name << " is committed but not generated";
    EXPECT_GE(generated.size(), 39u);
}

TEST(Assets, AFolderThatCannotBeMadeIsOneLineAndExit1) {
    const path file = test::fresh_folder("generated_nowhere") / "file";
    std::ofstream(file) << "in the way";
    const auto result = test::run_program("generate_assets", {(file / "below").string()});
    test::expect_error(result, 1, file.string());
}

TEST(AssetModels, FacesHaveAnAreaAndAgreeWithTheirNormalsAndUvs) {
    // Five decimals: each coordinate of a normal is off by at most 0.5e-5; float adds 1e-7.
    constexpr double text_rounding = 0.5e-5 * 1.7321 + 1e-7;
    for (const path& file : files_in(assets / "models", ".obj")) {
        const Scene scene = load_obj(file);
        EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
        for (const Mesh& mesh : scene.meshes)
            for (const Face& face : mesh.faces) {
                const dvec3 area = area_vector(mesh, face);
                ASSERT_GT(glm::length(area), 1e-4) << file << ' ' << mesh.name;
                if (mesh.name != "shield") {
                    ASSERT_GT(uv_area(mesh, face), 0) << file << ' ' << mesh.name << ": mirrored";
                }
                for (const Vertex& vertex : mesh.vertices_of(face)) {
                    const dvec3 normal = mesh.normals.at(vertex.normal);
                    ASSERT_NEAR(glm::length(normal), 1, text_rounding) << file << ' ' << mesh.name;
                    ASSERT_GT(glm::dot(normal, area), 0) << file << ' ' << mesh.name;
                }
            }
    }
}

TEST(AssetModels, HaveNoCracks) {
    struct Border {
        const char *file, *group;
        std::size_t edges;
    };
    for (const auto& [file, name, edges] : {
             Border{"teapot", "body", 40},  // the inner edge of the rim: 4 patches of 10 columns
             {"teapot", "lid", 40},         // its lower edge
             {"teapot", "handle", 24},      // two ends of 2 patches of 6 columns
             {"teapot", "spout", 32},       // root and mouth of 2 patches of 8 columns
             {"teapot", "ledge", 80},       // meets rim and lid
             {"teapot", "tea", 16},         // meets the mouth
             {"scene", "teapot", 24 + 16},  // where handle and spout enter the body
             {"figure", "figure", 0},
             {"figure", "crate", 0},
             {"figure", "platform", 0},
             {"shield_mirrored_uvs", "shield", 64},  // its rim: the halves meet
         }) {
        const Scene scene = load_obj(assets / "models" / (std::string(file) + ".obj"));
        EXPECT_EQ(border_edges({&group(scene, name)}), edges) << file << ' ' << name;
        EXPECT_EQ(scene.bounds().min.y, 0) << file << " does not stand on the floor";
    }
}

TEST(AssetModels, BodyLidAndLedgeEncloseAVolume) {
    const Scene scene = load_obj(assets / "models/teapot.obj");
    const std::vector<const Mesh*> pot{&group(scene, "body"), &group(scene, "lid"),
                                       &group(scene, "ledge")};
    EXPECT_EQ(border_edges(pot), 0u);
    double six_volumes = 0;
    for (const Mesh* mesh : pot)
        for (const Triangle& triangle : mesh->triangles) {
            const auto at = [&](std::size_t i) {
                return dvec3(mesh->positions[triangle.vertices[i].position]);
            };
            six_volumes += glm::dot(at(0), glm::cross(at(1), at(2)));
        }
    EXPECT_GT(six_volumes / 6,
              20);  // positive: all faces look outwards; a cylinder of its size: 30
}
