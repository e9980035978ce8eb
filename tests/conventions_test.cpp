// SPDX-License-Identifier: MIT
// One test for each line of docs/conventions.md, by its number.
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/clip.hpp"
#include "04_mvp/transform.hpp"
#include "common/app/orthographic_view.hpp"
#include "common/image/image_io.hpp"
#include "common/math/color.hpp"
#include "common/math/error_metrics.hpp"
#include "common/math/numerics.hpp"
#include "common/model/obj.hpp"
#include "support/texts.hpp"

using namespace rasterbook;
using rasterbook::test::read_text, rasterbook::test::root;

namespace {

constexpr float tolerance = 1e-6f;  // some ulp near 1, for GLM's sines and square roots

void expect_near(vec3 actual, vec3 expected) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(actual[i], expected[i], tolerance);
}

/// C6 as the table has it, to hold the lessons' viewport against.
vec2 screen_from_ndc(vec2 ndc, vec2 size) {
    return {(ndc.x + 1) * size.x / 2, (1 - ndc.y) * size.y / 2};
}

}  // namespace

TEST(Conventions, EachLineHasItsTest) {
    const auto numbers_after = [](const std::filesystem::path& file, const std::string& start) {
        std::set<std::string> numbers;
        std::ifstream in(file);
        for (std::string line; std::getline(in, line);)
            if (line.starts_with(start + 'C'))
                numbers.insert(line.substr(start.size(),
                                           line.find_first_of(" _", start.size()) - start.size()));
        return numbers;
    };
    const auto lines = numbers_after(root / "docs/conventions.md", "| ");
    EXPECT_EQ(lines, numbers_after(root / "tests/conventions_test.cpp", "TEST(Conventions, "));
    EXPECT_GE(lines.size(), 14u);
}

TEST(Conventions, C1_VectorsAreColumns) {
    const mat4 move = matrix_from_rows({1, 0, 0, 5}, {0, 1, 0, 6}, {0, 0, 1, 7}, {0, 0, 0, 1});
    EXPECT_EQ(move * vec4(1, 2, 3, 1), vec4(6, 8, 10, 1));
    EXPECT_EQ(move, glm::translate(mat4(1.0f), vec3(5, 6, 7))) << "GLM sees the same matrix";
    EXPECT_EQ(move[3], vec4(5, 6, 7, 1)) << "GLM's index counts columns";
}

TEST(Conventions, C2_TheRightmostMatrixActsFirst) {
    const mat4 world_from_model = glm::translate(mat4(1.0f), vec3(1, 0, 0));
    const mat4 view_from_world = glm::scale(mat4(1.0f), vec3(2));
    const mat4 view_from_model = view_from_world * world_from_model;
    EXPECT_EQ(view_from_model * vec4(0, 0, 0, 1), vec4(2, 0, 0, 1));
    EXPECT_EQ(scaling(vec3(2)) * translation(vec3(1, 0, 0)), view_from_model);
}

TEST(Conventions, C3_RightHandedAndTheCameraLooksAlongMinusZ) {
    EXPECT_EQ(glm::cross(vec3(1, 0, 0), vec3(0, 1, 0)), vec3(0, 0, 1));
    const mat4 view_from_world = glm::lookAt(vec3(0, 0, 5), vec3(0), vec3(0, 1, 0));
    expect_near(vec3(view_from_world * vec4(0, 0, 0, 1)), {0, 0, -5});
    expect_near(vec3(view_from_world * vec4(1, 2, 0, 1)), {1, 2, -5});
    EXPECT_EQ(look_at(vec3(0, 0, 5), vec3(0), vec3(0, 1, 0)), view_from_world);
}

TEST(Conventions, C4_ClipSpaceIsThatOfReversedZ) {
    // GLM's matrix for z from 0 to 1, with near and far exchanged: near / distance, but for what a
    // far plane at 10^9 changes.
    const float near = 0.5f, far = 1e9f;
    const mat4 clip_from_view = glm::perspectiveRH_ZO(glm::radians(60.0f), 1.0f, far, near);
    const mat4 ours = perspective(glm::radians(60.0f), 1.0f, near);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            EXPECT_NEAR(ours[column][row], clip_from_view[column][row], tolerance);
    const vec4 on_near = ours * vec4(0, 0, -near, 1), far_away = ours * vec4(0, 0, -far, 1);
    EXPECT_EQ(on_near.z / on_near.w, 1);
    EXPECT_EQ(far_away.z / far_away.w, near / far);
    EXPECT_EQ(far_away.w, far) << "w is the distance along the line of sight";
    const vec4 upper_right = ours * vec4(vec2(std::tan(glm::radians(30.0f))), -1, 1);
    expect_near(vec3(upper_right) / upper_right.w, {1, 1, upper_right.z / upper_right.w});
}

TEST(Conventions, C5_DepthIsOneNearestAndZeroFarthest) {
    DepthBuffer depth({1, 1});
    EXPECT_EQ((depth.depths()[{0, 0}]), 0.0f);
    EXPECT_TRUE(depth.test_and_write({0, 0}, 0.25f)) << "0.25 is nearer than nothing";
    EXPECT_TRUE(depth.test_and_write({0, 0}, 0.75f)) << "0.75 is nearer than 0.25";
    EXPECT_FALSE(depth.test_and_write({0, 0}, 0.5f));
    for (const float z_ndc : {0.0f, 0.25f, 1.0f})
        EXPECT_EQ(screen_from_clip({0, 0, 2 * z_ndc, 2}, {4, 2}).z, z_ndc);
}

TEST(Conventions, C6_ScreenStartsAtTheTopLeftCorner) {
    EXPECT_EQ(screen_from_ndc({-1, 1}, {640, 480}), vec2(0, 0));
    EXPECT_EQ(screen_from_ndc({1, -1}, {640, 480}), vec2(640, 480));
    EXPECT_EQ(screen_from_ndc({0, 0}, {640, 480}), vec2(320, 240));
    for (const vec2 ndc : {vec2(-1, 1), vec2(1, -1), vec2(0), vec2(0.5f, -0.25f)}) {
        const vec2 expected = screen_from_ndc(ndc, {640, 480});
        EXPECT_EQ(vec2(viewport<float>({640, 480}) * vec4(ndc, 0, 1)), expected);
        EXPECT_EQ(vec2(screen_from_clip(vec4(2.0f * ndc, 0, 2), {640, 480})), expected);
    }
    // The view of the first lessons puts what is higher in the model higher in the picture.
    const Scene scene = load_obj(root / "assets/models/teapot.obj");
    const auto screen =
        OrthographicView(scene, {640, 480}).screen_from_model({{0, 0, 0}, {0, 1, 0}});
    EXPECT_LT(screen[1].y, screen[0].y);
    EXPECT_EQ(screen[1].x, screen[0].x);
}

TEST(Conventions, C7_PixelCentresLieAtHalves) {
    EXPECT_EQ(pixel_of({3.0f, 4.999f}), ivec2(3, 4));
    EXPECT_EQ(pixel_of({-0.25f, 0.0f}), ivec2(-1, 0));
    int covered = 0;
    const vec2 center(3.5f, 4.5f), little(0.01f, 0.0f), low(0.0f, 0.01f);
    fill_triangle(snap_triangle(center - little - low, center + 2.0f * low, center + little - low),
                  {9, 9}, [&](ivec2 pixel, vec3) {
                      EXPECT_EQ(pixel, ivec2(3, 4));
                      ++covered;
                  });
    EXPECT_EQ(covered, 1);
    Image<int> image({2, 2});
    image[{0, 1}] = 7;
    EXPECT_EQ(image.pixels()[2], 7) << "the second row follows the top one";
}

TEST(Conventions, C8_VerticesSnapTo256thsOfAPixel) {
    EXPECT_EQ(subpixels, 256);
    EXPECT_EQ(snap_triangle({1.25f, 2}, {0, 0}, {0, 0}).vertices[0], ivec2(320, 512));
}

TEST(Conventions, C9_FrontFacesAreSeenCounterClockwise) {
    const vec2 size(640, 480);
    const vec2 a = screen_from_ndc({0, 0}, size), b = screen_from_ndc({1, 0}, size),
               c = screen_from_ndc({0, 1}, size);
    EXPECT_TRUE(is_front_facing(snap_triangle(a, b, c)));
    EXPECT_FALSE(is_front_facing(snap_triangle(a, c, b)));
}

TEST(Conventions, C10_TextureCoordinateVPointsUp) {
    // The crate's front: the vertex that stands higher has the greater v.
    const Scene scene = load_obj(root / "assets/models/crate.obj");
    const Mesh& crate = scene.meshes.at(0);
    int sides = 0;
    for (const Face& face : crate.faces)
        for (const Vertex& p : crate.vertices_of(face))
            for (const Vertex& q : crate.vertices_of(face)) {
                const vec3 from = crate.positions[p.position], to = crate.positions[q.position];
                if (from.x != to.x || from.z != to.z || from.y >= to.y) continue;
                EXPECT_LT(crate.uvs[p.uv].y, crate.uvs[q.uv].y);
                ++sides;
            }
    EXPECT_EQ(sides, 8) << "two upright sides on each of four walls";
}

TEST(Conventions, C11_FilesHoldSrgb) {
    Image<vec3> linear({1, 1}, vec3(0.2158605f, 0, 1));
    const auto file = test::fresh_folder("conventions") / "color.png";
    write_image(file, srgb8_from_linear(linear));
    EXPECT_EQ((read_image(file)[{0, 0}]), u8vec4(128, 0, 255, 255))
        << "half the code is a fifth of the light";
}

TEST(Conventions, C12_AnglesAreRadiansCounterClockwise) {
    const mat4 turn = glm::rotate(mat4(1.0f), std::numbers::pi_v<float> / 2, vec3(0, 0, 1));
    expect_near(vec3(turn * vec4(1, 0, 0, 1)), {0, 1, 0});
    EXPECT_NEAR(angle_radians(vec3(1, 0, 0), vec3(0, 1, 0)), std::numbers::pi / 2, tolerance);
}

TEST(Conventions, C13_NamesOfAnglesAndTimesEndInTheirUnit) {
    const std::set<std::string> bare = {"angle",   "fov",      "yaw", "pitch",
                                        "elapsed", "duration", "time"};
    int declarations = 0;
    for (const char* folder : {"common", "lessons"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
            if (!entry.is_regular_file()) continue;
            std::string text = read_text(entry.path());
            for (char& c : text)
                if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_') c = ' ';
            std::istringstream words(text);
            for (std::string type, name; words >> type;) {
                if ((type != "float" && type != "double" && type != "T") || !(words >> name))
                    continue;
                ++declarations;
                const bool is_ratio = name.starts_with("cos_") || name.starts_with("sin_");
                const std::string last = name.substr(name.rfind('_') + 1);
                EXPECT_TRUE(is_ratio || !bare.contains(last))
                    << entry.path() << ": " << type << ' ' << name;
            }
        }
    EXPECT_GT(declarations, 50);
}

TEST(Conventions, C14_FloatingPointIsAsWritten) {
    // (1 + 2^-12)^2 needs 25 bits: rounded once it equals itself; fused, the lost bit comes back.
    volatile float a = 1.0f + 0x1p-12f, square = a * a;
    const float product_minus_square = a * a - square;
    EXPECT_EQ(product_minus_square, 0.0f);
    EXPECT_NE(std::fma(a, a, -square), 0.0f) << "the case sees no fusion";
    volatile float nan = std::nanf("");
    EXPECT_TRUE(nan != nan);
}
