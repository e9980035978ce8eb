// SPDX-License-Identifier: MIT
// The coffee pot on the crate: a mesh that a model matrix puts into the world, and its normals.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "04_mvp/camera.hpp"
#include "04_mvp/instance.hpp"
#include "04_mvp/projection.hpp"
#include "04_mvp/transform.hpp"
#include "common/image/image_io.hpp"
#include "common/math/color.hpp"
#include "support/coffee_pot.hpp"
#include "support/golden.hpp"
#include "support/image_doctor.hpp"
#include "support/lesson_process.hpp"
#include "support/look_up.hpp"
#include "support/picture_difference.hpp"
#include "support/pictures.hpp"
#include "support/printers.hpp"
#include "support/visibility.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// How the lesson is asked to draw: as its first step can, without camera and clipping; or wholly.
enum class By { orthographic, camera };

Image<u8vec4> picture(By by, double turn_degrees, ivec2 size, bool is_of_depths) {
    const std::string out = (fresh_folder("coffee_pot") / "picture.bmp").string();
    std::vector<std::string> arguments = {
        "--turn", std::to_string(turn_degrees),
        "--out",  out,
        "--size", std::to_string(size.x) + "x" + std::to_string(size.y)};
    if (by == By::orthographic) arguments.insert(arguments.end(), {"--view", "orthographic"});
    if (is_of_depths) arguments.push_back("--depth");
    const ProcessResult run =
        run_program(by == By::orthographic ? "lab_04_mvp" : "04_mvp", arguments);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.exit_status == 0 ? read_image(out) : Image<u8vec4>(size);
}

/// Which triangle should be seen where: first those of the scene, then those of the pot.
Image<int> seen(By by, const Scene& scene, const dmat4& world_from_pot, ivec2 size) {
    std::vector<ScreenPatch> patches;
    for (const Scene& part : {scene, pot_of(scene, world_from_pot)}) {
        const std::vector<ScreenPatch> of_part =
            by == By::orthographic ? parallel_patches(part, OrthographicView(scene, size))
                                   : perspective_patches(part, scene.bounds(), {}, size);
        patches.insert(patches.end(), of_part.begin(), of_part.end());
    }
    return visible(patches, size, {}).ids;
}

/// How many pixels are covered in one picture and not in the other.
int differently_covered(const Image<u8vec4>& depths, const Image<int>& ids) {
    int count = 0;
    for (std::size_t i = 0; i < ids.pixels().size(); ++i)
        count += (depths.pixels()[i].r > 0) != (ids.pixels()[i] != Visibility::nothing);
    return count;
}

/// For EXPECT_TRUE: the pot covers the pixels that it should.
testing::AssertionResult is_in_its_place(By by, double turn_degrees) {
    constexpr ivec2 size(320, 180);
    constexpr int most_different =
        6;  // of 57600: at borders, where one snaps as the other does not
    const Scene scene = loaded("scene.obj");
    const Image<u8vec4> depths = picture(by, turn_degrees, size, true);
    const auto wrong_with = [&](const dmat4& world_from_pot) {
        return differently_covered(depths, seen(by, scene, world_from_pot, size));
    };
    const int wrong = wrong_with(world_from_pot(turn_degrees));
    if (wrong <= most_different) return testing::AssertionSuccess();
    const dmat4 move = pot_moved(), rotate = pot_turned(turn_degrees), scale = pot_scaled();
    const std::pair<const char*, dmat4> mistakes[] = {
        {"turned the other way, clockwise as seen from above", world_from_pot(-turn_degrees)},
        {"rotated, then scaled, then moved", move * scale * rotate},
        {"scaled, then moved, then rotated", rotate * move * scale},
        {"rotated, then moved, then scaled", scale * move * rotate},
        {"moved, then scaled, then rotated", rotate * scale * move},
        {"moved, then rotated, then scaled", scale * rotate * move},
        {"not rotated", move * scale},
        {"not scaled", move * rotate},
        {"not moved", rotate * scale},
        {"turned by degrees that were taken for radians",
         world_from_pot(glm::degrees(turn_degrees))}};
    std::string looks = "not where it belongs, or something else is not";
    for (const auto& [words, matrix] : mistakes)
        if (wrong_with(matrix) <= most_different) looks = words;
    return testing::AssertionFailure()
           << "the pot is " << looks
           << "; expected: scaled, then rotated, then moved (Eq. 4.4). With --turn " << turn_degrees
           << ", " << wrong << " of " << size.x * size.y
           << " pixels are covered and should not be, or the other way round";
}

/// A color as it is written.
u8vec4 written(vec3 linear) {
    u8vec4 code(255);
    for (int i = 0; i < 3; ++i)
        code[i] = static_cast<std::uint8_t>(
            std::lround(255 * std::clamp(srgb_from_linear(double{linear[i]}), 0.0, 1.0)));
    return code;
}

/// The colors of lesson 02, by a normal of any length.
vec3 color_by(dvec3 normal, const Material& material) {
    const dvec3 n = glm::normalize(normal), to_sun = glm::normalize(dvec3(-0.75, 0.85, 0.3));
    const dvec3 light = std::max(glm::dot(n, to_sun), 0.0) * dvec3(1.05, 0.97, 0.86) +
                        (0.5 + 0.5 * n.y) * dvec3(0.17, 0.22, 0.3);
    return vec3(dvec3(material.diffuse) * light);
}

/// Twice a triangle's area in length, out of its front.
dvec3 area_vector(const Mesh& mesh, const Triangle& triangle) {
    const auto at = [&](std::size_t i) {
        return dvec3(mesh.positions[triangle.vertices[i].position]);
    };
    return glm::cross(at(1) - at(0), at(2) - at(0));
}

/// Whether the pixels around one show the same triangle.
bool is_inside_of_triangle(const Image<int>& ids, ivec2 pixel) {
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            const ivec2 beside = glm::clamp(pixel + ivec2(x, y), ivec2(0), ids.size() - ivec2(1));
            if (ids[beside] != ids[pixel]) return false;
        }
    return true;
}

/// For EXPECT_TRUE: the pot's triangles have the colors of their normals in the world.
testing::AssertionResult has_the_colors_of_its_normals(By by, double turn_degrees) {
    constexpr ivec2 size(1280, 720);
    const Scene scene = loaded("scene.obj"), model = pot_of(scene, dmat4(1));
    const Mesh& mesh = model.meshes.at(0);
    int of_scene = 0;
    for (const Mesh& other : scene.meshes) of_scene += static_cast<int>(other.triangles.size());
    const Image<u8vec4> colors = picture(by, turn_degrees, size, false);
    const Image<int> ids = seen(by, scene, world_from_pot(turn_degrees), size);
    const dmat3 m(world_from_pot(turn_degrees)), inverse = glm::inverse(m);
    const std::pair<const char*, dmat3> ways[] = {
        {"right", glm::transpose(inverse)},
        {"multiplied by the model matrix itself", m},
        {"not transformed", dmat3(1)},
        {"only rotated, as if nothing were scaled", dmat3(pot_turned(turn_degrees))},
        {"multiplied by the inverse of the model matrix, not its transpose", inverse},
        {"multiplied by the transpose of the model matrix, not of its inverse", glm::transpose(m)}};
    std::vector<int> agreeing(std::size(ways));
    int compared = 0;
    std::ostringstream first;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const int id = ids[{x, y}] - of_scene;
            if (id < 0 || !is_inside_of_triangle(ids, {x, y})) continue;
            const Triangle& triangle = mesh.triangles[static_cast<std::size_t>(id)];
            const Material& material = scene.materials[triangle.material];
            const u8vec4 color = colors[{x, y}];
            ++compared;
            for (std::size_t i = 0; i < std::size(ways); ++i) {
                const u8vec4 expected =
                    written(color_by(ways[i].second * area_vector(mesh, triangle), material));
                const bool agrees = looks_the_same(color, expected);
                agreeing[i] += agrees;
                if (i == 0 && !agrees && first.str().empty())
                    first << "pixel " << testing::PrintToString(ivec2(x, y)) << ", triangle " << id
                          << " of the pot, is " << testing::PrintToString(color) << ", expected "
                          << testing::PrintToString(expected);
            }
        }
    if (compared < 500) return testing::AssertionFailure() << compared << " pixels were compared";
    if (agreeing[0] == compared) return testing::AssertionSuccess();
    std::string looks = "wrong";
    for (std::size_t i = 1; i < std::size(ways); ++i)
        if (agreeing[i] == compared) looks = ways[i].first;
    return testing::AssertionFailure()
           << "the pot's normals are " << looks << " (Eq. 4.15): of " << compared << " pixels, "
           << compared - agreeing[0] << " have another color; " << first.str();
}

}  // namespace

TEST(Mvp, Eq4_4_AnInstanceIsScaledThenRotatedThenMoved) {
    Mesh mesh;
    mesh.positions = {{1, 1, 1}, {0, 0, 0}};
    const Instance instance = {mesh, translation(vec3(-3.7f, 2.4f, -2.6f)) *
                                         rotation_y(glm::radians(90.0f)) *
                                         scaling(vec3(0.4f, 0.75f, 0.3f))};
    const std::vector<vec3> positions = positions_world(instance);
    ASSERT_EQ(positions.size(), 2u);
    const vec3 expected(-3.4f, 3.15f, -3.0f);
    for (int axis = 0; axis < 3; ++axis)  // of numbers below 4, a handful of roundings
        EXPECT_NEAR(positions[0][axis], expected[axis], 8 * FLT_EPSILON)
            << "xyz"[axis] << " of (1, 1, 1): scaled (0.4, 0.75, 0.3), rotated (0.3, 0.75, -0.4), "
            << "moved (-3.4, 3.15, -3)";
    EXPECT_EQ(positions[1], vec3(-3.7f, 2.4f, -2.6f)) << "the model's origin is moved alone";
}

TEST(Mvp, InstancesAreTheSceneAndThePotOnItsCrate) {
    look_up("Eq. 4.4: the model matrix");
    const mat4 world_from_pot = translation(vec3(1, 2, 3));
    Scene scene;
    const auto add = [&](const char* name) {
        scene.meshes.emplace_back();
        scene.meshes.back().name = name;
    };
    for (const char* name : {"crate", "floor"}) add(name);
    EXPECT_EQ(instances_of(scene, world_from_pot).size(), 2u) << "no teapot, no pot";
    add("teapot");
    const std::vector<Instance> instances = instances_of(scene, world_from_pot);
    ASSERT_EQ(instances.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_TRUE(&instances[i].mesh == &scene.meshes[std::min<std::size_t>(i, 2)]) << i;
        EXPECT_EQ(instances[i].world_from_model, i < 3 ? mat4(1) : world_from_pot) << i;
    }
    scene.meshes[0].name = "box";
    EXPECT_EQ(instances_of(scene, world_from_pot).size(), 3u) << "no crate, no pot";
}

TEST(Mvp, Eq4_14_AnInstanceIsCulledByWhereItStands) {
    Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    mesh.triangles = {{{Vertex{0}, Vertex{1}, Vertex{2}}, 0}};
    for (const vec3 position : mesh.positions) mesh.bounds.add(position);
    const vec3 eye(100, 0, 5), center(100, 0, 0);
    const Camera camera = {eye, look_at(eye, center, vec3(0, 1, 0)), 1, 1, center};
    const auto visited = [&](const mat4& world_from_model) {
        int count = 0;
        for_each_visible_triangle(mesh, camera.clip_from_world(ivec2(64)) * world_from_model,
                                  ivec2(64), Culling::back_faces,
                                  [&](const ProjectedTriangle&) { ++count; });
        return count;
    };
    EXPECT_EQ(visited(translation(vec3(100, 0, 0))), 1)
        << "triangles of a mesh that is moved in front of the camera: its box is moved, too";
    EXPECT_EQ(visited(mat4(1)), 0) << "of the mesh at the origin, which the camera does not see";
}

TEST(Mvp, Eq4_15_ASlopeOfThePotIsSteeperThanTheModelMatrixHasIt) {
    const mat3 m(scaling(vec3(0.4f, 0.75f, 0.3f)));
    const auto degrees_up = [](vec3 v) { return glm::degrees(std::atan2(v.y, v.x)); };
    constexpr float tolerance = 0.05f;  // half of the last digit in the text
    EXPECT_NEAR(degrees_up(normal_matrix(m) * vec3(1, 1, 0)), 28.1f, tolerance)
        << "degrees upwards, of the normal (1, 1, 0) when x is scaled by 0.4 and y by 0.75";
    EXPECT_NEAR(degrees_up(m * vec3(1, 1, 0)), 61.9f, tolerance) << "of the same by M itself";
}

// What is drawn pixel by pixel is not snapped: where a compiler rounds otherwise, a centre on an
// edge may belong to the other side.
constexpr std::size_t on_edges = 4;

TEST(Mvp, PictureOfTheModelMatrix) {
    for (const double turn_degrees : {pot_turn_degrees, 60.0, 160.0, 0.0})
        ASSERT_TRUE(is_in_its_place(By::orthographic, turn_degrees));
    for (const double turn_degrees : {pot_turn_degrees, 160.0})
        ASSERT_TRUE(has_the_colors_of_its_normals(By::orthographic, turn_degrees));
    EXPECT_TRUE(equals_golden("lab_04_mvp", "04_mvp_model", {"--view", "orthographic"}, on_edges));
}

TEST(Mvp, PictureOfTheSceneFromAbove) {
    EXPECT_TRUE(equals_golden(
        "lab_04_mvp", "04_mvp_above",
        {"--clip", "pixel", "--yaw", "-20", "--pitch", "60", "--distance", "1.5"}, on_edges));
}

TEST(Mvp, PictureOfTheLesson) {
    for (const double turn_degrees : {pot_turn_degrees, 160.0}) {
        ASSERT_TRUE(is_in_its_place(By::camera, turn_degrees));
        ASSERT_TRUE(has_the_colors_of_its_normals(By::camera, turn_degrees));
    }
    EXPECT_TRUE(equals_golden("04_mvp", "04_mvp"));
}

TEST(Mvp, PictureOfTheDepth) { EXPECT_TRUE(equals_golden("04_mvp", "04_mvp_depth", {"--depth"})); }
