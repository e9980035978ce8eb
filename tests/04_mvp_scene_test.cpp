// SPDX-License-Identifier: MIT
// The coffee pot on the crate: a mesh that a model matrix puts into the world, and its normals.
#include <algorithm>
#include <cfloat>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "02_triangle_fill/flat_color.hpp"
#include "04_mvp/instance.hpp"
#include "04_mvp/transform.hpp"
#include "common/image/image_io.hpp"
#include "common/math/color.hpp"
#include "support/coffee_pot.hpp"
#include "support/golden.hpp"
#include "support/image_doctor.hpp"
#include "support/lesson_process.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/picture_difference.hpp"
#include "support/pictures.hpp"
#include "support/printers.hpp"
#include "support/visibility.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// How the lesson is asked to draw: as its first step can, without camera and clipping; or wholly.
enum class By { orthographic, camera };

Image<u8vec4> picture(By by, double turn_degrees, ivec2 size, std::vector<std::string> arguments) {
    const std::string out = (fresh_folder("coffee_pot") / "picture.bmp").string();
    arguments.insert(arguments.end(),
                     {"--turn", std::to_string(turn_degrees), "--out", out, "--size",
                      std::to_string(size.x) + "x" + std::to_string(size.y)});
    if (by == By::orthographic) arguments.insert(arguments.end(), {"--view", "orthographic"});
    const auto run = run_program(by == By::orthographic ? "lab_04_mvp" : "04_mvp", arguments);
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

/// For EXPECT_TRUE: the pot covers the pixels that it should.
testing::AssertionResult is_in_its_place(By by, double turn_degrees) {
    constexpr ivec2 size(320, 180);
    constexpr int most_different = 6;  // of 57600: at borders, as snapping is not the same
    const Scene scene = loaded("scene.obj");
    const Image<u8vec4> depths = picture(by, turn_degrees, size, {"--depth"});
    // How many pixels are covered in one picture and not in the other.
    const auto wrong_with = [&](const dmat4& world_from_pot) {
        const Image<int> ids = seen(by, scene, world_from_pot, size);
        int count = 0;
        for (std::size_t i = 0; i < ids.pixels().size(); ++i)
            count += (depths.pixels()[i].r > 0) != (ids.pixels()[i] != Visibility::nothing);
        return count;
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
    const Image<u8vec4> colors = picture(by, turn_degrees, size, {});
    const Image<int> ids = seen(by, scene, world_from_pot(turn_degrees), size);
    const dmat3 m(world_from_pot(turn_degrees)), inverse = glm::inverse(m);
    const auto wrong_with = [&](const dmat3& world_from_normal) {
        int wrong = 0;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const int id = ids[{x, y}] - of_scene;
                if (id < 0 || !is_inside_of_triangle(ids, {x, y})) continue;
                const Triangle& triangle = mesh.triangles[static_cast<std::size_t>(id)];
                const auto at = [&](std::size_t i) {
                    return dvec3(mesh.positions[triangle.vertices[i].position]);
                };
                const dvec3 normal = world_from_normal * glm::cross(at(1) - at(0), at(2) - at(0));
                const vec3 linear =
                    flat_color(vec3(glm::normalize(normal)), scene.materials[triangle.material]);
                const u8vec4 expected(srgb8_from_linear(linear.r), srgb8_from_linear(linear.g),
                                      srgb8_from_linear(linear.b), 255);
                wrong += !looks_the_same(colors[{x, y}], expected);
            }
        return wrong;
    };
    const int wrong = wrong_with(glm::transpose(inverse));
    if (wrong == 0) return testing::AssertionSuccess();
    const std::pair<const char*, dmat3> mistakes[] = {
        {"multiplied by the model matrix itself", m},
        {"not transformed", dmat3(1)},
        {"only rotated, as if nothing were scaled", dmat3(pot_turned(turn_degrees))},
        {"multiplied by the inverse of the model matrix, not its transpose", inverse},
        {"multiplied by the transpose of the model matrix, not of its inverse", glm::transpose(m)}};
    std::string looks = "wrong";
    for (const auto& [words, matrix] : mistakes)
        if (wrong_with(matrix) == 0) looks = words;
    return testing::AssertionFailure()
           << "the pot's normals are " << looks << " (Eq. 4.15): " << wrong
           << " of its pixels have another color";
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
    // Of numbers below 4, a handful of roundings.
    EXPECT_TRUE(are_near(positions[0], dvec3(-3.4, 3.15, -3), 8 * FLT_EPSILON))
        << "of (1, 1, 1): scaled (0.4, 0.75, 0.3), rotated (0.3, 0.75, -0.4), moved (-3.4, 3.15, "
        << "-3)";
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
