// SPDX-License-Identifier: MIT
// Textures beside OpenGL's.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "04_mvp/transform.hpp"
#include "05_textures/texture.hpp"
#include "support/opengl_triangles.hpp"
#include "support/printers.hpp"
#include "support/projected.hpp"
#include "support/texture_names.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr ivec2 texture_size(48, 20);

Texture random_texture(WrapModes wrap) {
    Random random(1);
    Image<vec4> picture(texture_size);
    for (vec4& texel : picture.pixels())
        for (int i = 0; i < 4; ++i) texel[i] = static_cast<float>(any(random, 0, 255)) / 255;
    return make_texture(picture, wrap);
}

/// A rectangle of the plane y = -1 in triangles, without positions; uv = (x, z) / 8.
struct Floor {
    std::array<vec3, 4> corners;

    Floor(float side, float nearest, float farthest, float side_there)
        : corners{{{-side, -1, nearest},
                   {side, -1, nearest},
                   {side_there, -1, farthest},
                   {-side_there, -1, farthest}}} {}

    std::vector<OpenGlTriangle> seen_through(const mat4& clip_from_world) const {
        std::vector<OpenGlTriangle> triangles(2);
        for (std::size_t t = 0; t < 2; ++t)
            for (std::size_t i = 0; i < 3; ++i) {
                const vec3 corner = corners[i == 0 ? 0 : t + i];
                triangles[t].vertices_clip[i] = clip_from_world * vec4(corner, 1);
                triangles[t].uv[i] = vec2(corner.x, corner.z) / 8.0f;
            }
        return triangles;
    }
};

/// Half of the picture is a floor that begins at w = 1 and runs to w = 1024, a part of a pixel
/// before the horizon. Its corners are whole steps: nothing is rounded on the way to the screen,
/// and nothing is cut.
///
/// @param turns  By 90 degrees: then it is a wall, a ceiling, a wall.
std::vector<OpenGlTriangle> exact_floor(int turns) {
    mat4 clip_from_world =
        matrix_from_rows({1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -0.5f, 0}, {0, 0, -1, 0});
    const mat4 quarter = matrix_from_rows({0, -1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1});
    for (int turn = 0; turn < turns; ++turn) clip_from_world = quarter * clip_from_world;
    constexpr float far = 1024;
    return Floor(1, -1, -far, far).seen_through(clip_from_world);
}

/// Calls emit(pixel, uv) for what our stages draw.
void for_each_fragment(const std::vector<OpenGlTriangle>& triangles, ivec2 size, auto&& emit) {
    for (const OpenGlTriangle& triangle : triangles)
        for (const ClippedTriangle& clipped : clip_triangle(triangle.vertices_clip)) {
            const ScreenTriangle on_screen = projected(clipped, size).on_screen;
            if (!is_front_facing(on_screen)) continue;
            const PerspectiveSetup setup = perspective_setup(on_screen, clipped);
            fill_triangle(on_screen, size, [&](ivec2 pixel, Barycentrics screen_barycentrics) {
                emit(pixel,
                     fragment_uv(triangle.uv, perspective_correct(setup, screen_barycentrics)));
            });
        }
}

std::array<float, 4> seen(vec4 color) { return {color.x, color.y, color.z, color.w}; }

double in_texels(vec2 uv, vec2 other) {
    return glm::length((dvec2(uv) - dvec2(other)) * dvec2(texture_size));
}

float difference(vec4 a, vec4 b) {
    const vec4 size = glm::abs(a - b);
    return std::max({size.x, size.y, size.z, size.w});
}

}  // namespace

TEST_F(OpenGlTest, UvIsTheSame) {
    constexpr double uv_tolerance = 1.0 / 256;  // texel
    constexpr float level_tolerance = 1.0f / 1024;
    const OpenGlView view(ivec2(256));
    gl->set_texture(random_texture(Wrap::repeat));
    for (int turns = 0; turns < 4; ++turns) {
        SCOPED_TRACE(turns);
        const std::vector<OpenGlTriangle> floor = exact_floor(turns);
        const OpenGlPicture theirs = gl->draw(floor, view, OpenGl::uv_and_level);
        int compared = 0;
        for_each_fragment(floor, view.size, [&](ivec2 pixel, const FragmentUv& uv) {
            const auto [covered, u, v, level] = seen(theirs.color[pixel]);
            ++compared;
            ASSERT_EQ(covered, 1);
            EXPECT_LE(in_texels(uv.here, {u, v}), uv_tolerance) << testing::PrintToString(pixel);
            EXPECT_NEAR(level_of_detail(uv.ddx, uv.ddy, texture_size), level, level_tolerance)
                << testing::PrintToString(pixel);
        });
        EXPECT_EQ(compared, view.size.x * view.size.y / 2);
    }
}

TEST_F(OpenGlTest, UvIsTheSameWherePlanesCut) {
    // We interpolate between the vertices where they are snapped, OpenGL where they were before: by
    // that the floor moves on the screen by less than a step.
    constexpr double in_pixels = 1.0 / subpixels, texels = 1.0 / 256;
    const OpenGlView view(ivec2(320, 240));
    gl->set_texture(random_texture(Wrap::repeat));
    for (const float roll : {0.0f, 0.2f, 0.75f, 2.0f}) {
        SCOPED_TRACE(roll);
        const auto floor = Floor(400, 5, -400, 400)  // from behind the camera
                               .seen_through(perspective(1.0f, 4.0f / 3, 0.5f) * rotation_z(roll));
        const OpenGlPicture theirs = gl->draw(floor, view, OpenGl::uv_and_level);
        int compared = 0;
        for_each_fragment(floor, view.size, [&](ivec2 pixel, const FragmentUv& uv) {
            const auto [covered, u, v, level] = seen(theirs.color[pixel]);
            if (covered == 0) return;
            ++compared;
            EXPECT_LE(in_texels(uv.here, {u, v}), texels + in_pixels * std::exp2(level))
                << testing::PrintToString(pixel);
        });
        EXPECT_GE(compared, 38'000);
    }
}

TEST_F(OpenGlTest, TexturesAreFilteredAlike) {
    constexpr float tolerance = 2.0f / 255;
    const OpenGlView view(ivec2(256));
    int turns = 0;
    for (const Wrap wrap_u : all_wraps)
        for (const Wrap wrap_v : all_wraps) {
            SCOPED_TRACE(testing::Message() << name_of(wrap_u) << " and " << name_of(wrap_v)
                                            << ", turned " << turns % 4 << " times");
            const Texture texture = random_texture({wrap_u, wrap_v});
            gl->set_texture(texture);
            const std::vector<OpenGlTriangle> floor = exact_floor(turns++ % 4);
            const OpenGlPicture bilinear = gl->draw(floor, view, OpenGl::bilinear);
            const OpenGlPicture trilinear = gl->draw(floor, view, OpenGl::trilinear);
            for_each_fragment(floor, view.size, [&](ivec2 pixel, const FragmentUv& uv) {
                EXPECT_LE(difference(sample(texture, Filter::bilinear, uv), bilinear.color[pixel]),
                          tolerance)
                    << testing::PrintToString(pixel);
                EXPECT_LE(
                    difference(sample(texture, Filter::trilinear, uv), trilinear.color[pixel]),
                    tolerance)
                    << testing::PrintToString(pixel);
            });
        }
}
