// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
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

std::string bytes_of(const path& file) {
    EXPECT_TRUE(std::filesystem::exists(file)) << file;
    return test::read_text(file);
}

/// Relative names, with folders.
std::map<path, std::string> generated_part_of(const path& folder) {
    std::map<path, std::string> contents;
    for (const char* kind : {"models", "textures"})
        for (const path& file : files_in(folder / kind))
            contents[kind / file.filename()] = bytes_of(file);
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

/// How much two neighbouring columns (or rows) of a picture differ.
struct Seam {
    int greatest = 0;  ///< Of one channel of one pixel.
    long sum = 0;      ///< Over all of them.
};

/// The seam before column (or row) i; before 0 lies the last one.
Seam seam_before(const Image<u8vec4>& image, int i, bool columns) {
    const int count = columns ? image.size().x : image.size().y;
    const int length = columns ? image.size().y : image.size().x;
    const auto pixel = [&](int across, int along) {
        return image[columns ? ivec2(across, along) : ivec2(along, across)];
    };
    Seam seam;
    for (int along = 0; along < length; ++along)
        for (int channel = 0; channel < 3; ++channel) {
            const int difference =
                std::abs(pixel(i, along)[channel] - pixel((i + count - 1) % count, along)[channel]);
            seam.greatest = std::max(seam.greatest, difference);
            seam.sum += difference;
        }
    return seam;
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
    EXPECT_EQ(result.exit_status, 1);
    EXPECT_TRUE(result.err.starts_with("error: ")) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

TEST(Assets, TextFilesHaveUnixLinesAndNoNegativeZero) {
    for (const path& file : files_in(assets / "models")) {
        if (file.extension() == ".glb" || file.extension() == ".bin") continue;
        const std::string text = bytes_of(file);
        EXPECT_EQ(text.find('\r'), text.npos) << file;
        for (const char* zero : {"-0 ", "-0\n", "-0.0,", "-0.0\n"})
            EXPECT_EQ(text.find(zero), text.npos) << file;
        EXPECT_TRUE(text.ends_with('\n')) << file;
    }
}

TEST(AssetTextures, SidesArePowersOfTwo) {
    for (const path& file : files_in(assets / "textures")) {
        const ivec2 size = read_image(file).size();
        EXPECT_TRUE(std::has_single_bit(unsigned(size.x)) && std::has_single_bit(unsigned(size.y)))
            << file;
    }
}

TEST(AssetTextures, TheSeamBetweenTwoCopiesIsNoWorseThanTheWorstInside) {
    for (const path& file : files_in(assets / "textures")) {
        const Image<u8vec4> image = read_image(file);
        for (const bool columns : {true, false}) {
            Seam worst;
            for (int i = 1; i < (columns ? image.size().x : image.size().y); ++i) {
                const Seam seam = seam_before(image, i, columns);
                worst.greatest = std::max(worst.greatest, seam.greatest);
                worst.sum = std::max(worst.sum, seam.sum);
            }
            const Seam outer = seam_before(image, 0, columns);
            EXPECT_LE(outer.greatest, worst.greatest) << file << (columns ? " columns" : " rows");
            EXPECT_LE(outer.sum, worst.sum) << file << (columns ? " columns" : " rows");
        }
    }
}

TEST(AssetTextures, NormalsAreOfUnitLengthAndPointOutwards) {
    // Each coordinate is off by at most half a step of 2/255; in length sqrt(3) times as much.
    constexpr double quantisation = 1.0 / 255 * 1.7321;
    for (const char* name : {"brick", "tiles", "hammered", "shield"}) {
        const Image<u8vec4> image =
            read_image(assets / "textures" / (std::string(name) + "_normal.png"));
        double error = 0, lowest_z = 1;
        for (const u8vec4 pixel : image.pixels()) {
            const dvec3 normal = dvec3(pixel) * (2 / 255.0) - 1.0;
            error = std::max(error, std::abs(glm::length(normal) - 1));
            lowest_z = std::min(lowest_z, normal.z);
        }
        EXPECT_LE(error, quantisation) << name;
        EXPECT_GT(lowest_z, 0) << name;
    }
}

TEST(AssetTextures, NormalsLeanAwayFromTheHeightsWithGreenUp) {
    const Image<u8vec4> height = read_image(assets / "textures/brick_height.png");
    const Image<u8vec4> normal = read_image(assets / "textures/brick_normal.png");
    int agree = 0, differ = 0;
    for (int y = 1; y + 1 < height.size().y; ++y)
        for (int x = 1; x + 1 < height.size().x; ++x) {
            const ivec2 slope(height[{x + 1, y}].r - height[{x - 1, y}].r,
                              height[{x, y - 1}].r - height[{x, y + 1}].r);
            const ivec2 lean = 2 * ivec2(normal[{x, y}]) - 255;
            for (int axis = 0; axis < 2; ++axis)
                if (std::abs(slope[axis]) > 2) ++(slope[axis] * lean[axis] < 0 ? agree : differ);
        }
    EXPECT_GT(agree, 10000);
    EXPECT_EQ(differ, 0);
}

TEST(AssetModels, LoadWithoutWarningsAndNameOnlyMapsThatExist) {
    for (const path& file : files_in(assets / "models", ".obj")) {
        const Scene scene = load_obj(file);
        EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
        for (const Material& material : scene.materials)
            for (const TextureMap* map : {&material.diffuse_map, &material.specular_map,
                                          &material.bump_map, &material.normal_map})
                EXPECT_TRUE(map->file.empty() || std::filesystem::is_regular_file(map->file))
                    << material.name << ": " << map->file;
    }
}

TEST(AssetModels, FacesHaveAnAreaAndAgreeWithTheirNormalsAndUvs) {
    // Five decimals: each coordinate of a normal is off by at most 0.5e-5; float adds 1e-7.
    constexpr double text_rounding = 0.5e-5 * 1.7321 + 1e-7;
    for (const path& file : files_in(assets / "models", ".obj"))
        for (const Mesh& mesh : load_obj(file).meshes)
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

TEST(AssetModels, TheCrateHas8Positions6FacesAnd12Triangles) {
    const Scene scene = load_obj(assets / "models/crate.obj");
    ASSERT_EQ(scene.meshes.size(), 1u);
    const Mesh& crate = scene.meshes[0];
    EXPECT_EQ(crate.positions.size(), 8u);
    EXPECT_EQ(crate.normals.size(), 6u);
    EXPECT_EQ(crate.faces.size(), 6u);
    EXPECT_EQ(crate.triangles.size(), 12u);
    EXPECT_EQ(crate.bounds.min.y, 0);
    EXPECT_EQ(border_edges({&crate}), 0u);
}

TEST(AssetModels, TheShieldsHalvesShowOneHalfOfTheTextureMirrored) {
    const Scene scene = load_obj(assets / "models/shield_mirrored_uvs.obj");
    const Mesh& shield = group(scene, "shield");
    int mirrored = 0;
    for (const Face& face : shield.faces) {
        ASSERT_GT(std::abs(uv_area(shield, face)), 1e-4);
        mirrored += uv_area(shield, face) < 0;
    }
    EXPECT_EQ(shield.faces.size(), 512u);
    EXPECT_EQ(mirrored, 256);
    for (const vec2 uv : shield.uvs) EXPECT_LE(uv.y, 0.5f);
    EXPECT_EQ(scene.bounds().min.y, 0);
    EXPECT_EQ(border_edges({&shield}), 64u);  // its rim: the halves meet
}

TEST(AssetModels, TheTeapotStandsOnTheFloorAroundItsAxis) {
    const Scene scene = load_obj(assets / "models/teapot.obj");
    EXPECT_EQ(scene.bounds().min.y, 0);
    EXPECT_EQ(scene.bounds().max.y, 3.15f);
    EXPECT_EQ(group(scene, "body").bounds.center().x, 0);
    EXPECT_EQ(group(scene, "body").bounds.center().z, 0);
}

TEST(AssetModels, TheTeapotHasNoCracks) {
    const Scene scene = load_obj(assets / "models/teapot.obj");
    const auto borders = [&](const char* name) { return border_edges({&group(scene, name)}); };
    EXPECT_EQ(borders("body"), 40u);    // the inner edge of the rim: 4 patches of 10 columns
    EXPECT_EQ(borders("lid"), 40u);     // its lower edge
    EXPECT_EQ(borders("handle"), 24u);  // two ends of 2 patches of 6 columns
    EXPECT_EQ(borders("spout"), 32u);   // root and mouth of 2 patches of 8 columns
    EXPECT_EQ(borders("ledge"), 80u);   // meets rim and lid
    EXPECT_EQ(borders("tea"), 16u);     // meets the mouth
}

TEST(AssetModels, TheTeapotIsOpenOnlyWhereHandleAndSpoutEnterTheBody) {
    const Scene scene = load_obj(assets / "models/scene.obj");
    EXPECT_EQ(border_edges({&group(scene, "teapot")}), 24u + 16u);
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

TEST(AssetModels, TheFigureIsClosedAndStandsOnTheFloor) {
    const Scene scene = load_obj(assets / "models/figure.obj");
    ASSERT_EQ(scene.meshes.size(), 3u);
    for (const char* name : {"figure", "crate", "platform"})
        EXPECT_EQ(border_edges({&group(scene, name)}), 0u) << name;
    EXPECT_EQ(scene.bounds().min.y, 0);
    EXPECT_EQ(group(scene, "platform").bounds.min.y, 0);
    EXPECT_LT(std::filesystem::file_size(assets / "models/figure.obj"), 400'000u);
}
