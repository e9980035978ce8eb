// SPDX-License-Identifier: MIT
// Our pictures beside those of a rasteriser that others wrote: OpenGL's on Mesa's llvmpipe. Where
// its rules are not ours, the test says so.
#include "support/opengl_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/clip.hpp"
#include "04_mvp/transform.hpp"
#include "support/printers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// What the stages make of one triangle that no plane cuts.
struct Drawn {
    Image<int> times;
    Image<float> depth;
    ScreenTriangle triangle;
};

Drawn drawn(const Vertices& vertices, const OpenGlView& view) {
    std::array<vec3, 3> p;
    for (std::size_t i = 0; i < 3; ++i)
        p[i] = screen_from_clip(vertices[i], view.viewport_size) + vec3(view.viewport_low, 0);
    Drawn result = {Image<int>(view.size), Image<float>(view.size),
                    snap_triangle(p[0], p[1], p[2])};
    if (!is_front_facing(result.triangle)) return result;
    const TriangleDepth depth(vec3(p[0].z, p[1].z, p[2].z));
    fill_triangle(result.triangle, view.size, [&](ivec2 pixel, vec3 barycentrics) {
        ++result.times[pixel];
        result.depth[pixel] = depth.at(barycentrics);
    });
    return result;
}

/// For EXPECT_TRUE.
///
/// @param ours  How often each pixel is drawn.
testing::AssertionResult covers_the_same(const Image<int>& ours, const OpenGlPicture& theirs) {
    auto result = testing::AssertionSuccess();
    for_each_pixel(ours.size(), [&](ivec2 pixel) {
        const int of_theirs = static_cast<int>(theirs.color[pixel].x);
        if (result && ours[pixel] != of_theirs)
            result = testing::AssertionFailure()
                     << "pixel " << testing::PrintToString(pixel) << " is drawn " << ours[pixel]
                     << " times by us, " << of_theirs << " times by OpenGL";
    });
    return result;
}

void expect_same_coverage(OpenGl& gl, const std::vector<OpenGlTriangle>& triangles,
                          const OpenGlView& view) {
    const std::vector<OpenGlPicture> theirs = gl.draw_each(triangles, view);
    for (std::size_t i = 0; i < triangles.size(); ++i)
        ASSERT_TRUE(covers_the_same(drawn(triangles[i].vertices_clip, view).times, theirs[i]))
            << "seed 1, case " << i;
}

/// Calls visit(kind, corners, steps, picture) for 2,000 triangles of each kind.
void for_each_exact_triangle(OpenGl& gl, auto&& visit) {
    for (const Kind& kind : kinds()) {
        Random random(1);
        std::vector<Steps> steps;
        std::vector<OpenGlTriangle> triangles;
        for (int i = 0; i < 2000; ++i) {
            Steps chosen = kind.choose(random);
            const bool is_back = edge_function(chosen[0], chosen[1], chosen[2]) < 0;
            if (is_back && any(random, 0, 15) != 0) std::swap(chosen[0], chosen[1]);
            steps.push_back(chosen);
            triangles.push_back({clip_from_steps(chosen, kind.view, random)});
        }
        const std::vector<OpenGlPicture> theirs = gl.draw_each(triangles, kind.view);
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            SCOPED_TRACE(kind.name + ", seed 1, case " + std::to_string(i));
            visit(kind, triangles[i].vertices_clip, steps[i], theirs[i]);
            if (testing::Test::HasFailure()) return;
        }
    }
}

/// How far a point of the screen is from all lines along which a triangle can end, in pixels: its
/// sides and where the near plane cuts it. (The other planes cut along the picture's borders, or,
/// the far one, nothing.)
double distance_to_ends(const Vertices& vertices, ivec2 size, dvec2 point) {
    const auto xyw = [&](std::size_t i) {
        return dvec3(vertices[i % 3].x, vertices[i % 3].y, vertices[i % 3].w);
    };
    std::array<dvec3, 4> lines = {};  // 0 = dot(line, (x_ndc, y_ndc, 1))
    for (std::size_t i = 0; i < 3; ++i) {
        lines[i] = glm::cross(xyw(i + 1), xyw(i + 2));  // the share of vertex i, divided by w
        lines[3] += lines[i] * double{plane_distance(4, vertices[i])};
    }
    const dvec2 to_ndc = dvec2(2, -2) / dvec2(size);
    const dvec3 point_ndc(point * to_ndc + dvec2(-1, 1), 1);
    double distance = std::numeric_limits<double>::infinity();
    for (const dvec3 line : lines)
        distance = std::min(
            distance, std::abs(glm::dot(line, point_ndc)) / glm::length(dvec2(line) * to_ndc));
    return distance;
}

}  // namespace

TEST_F(OpenGlTest, CoversTheSamePixels) {
    int compared = 0, covering = 0;
    for_each_exact_triangle(*gl, [&](const Kind& kind, const Vertices& vertices, const Steps& steps,
                                     const OpenGlPicture& theirs) {
        const Drawn ours = drawn(vertices, kind.view);
        ASSERT_EQ(ours.triangle.vertices, steps) << "nothing is to be rounded here";
        ASSERT_TRUE(covers_the_same(ours.times, theirs));
        ++compared;
        covering += !(ours.times == Image<int>(kind.view.size));
    });
    EXPECT_GE(compared, 10'000);
    EXPECT_GE(covering, 8'000);
}

TEST_F(OpenGlTest, CoversTheSamePixelsWhereVerticesAreSnapped) {
    // llvmpipe, too, snaps to the nearest 1/256 pixel, halves to even. But it multiplies by 1/w,
    // and takes off half a pixel before it snaps: five roundings of numbers below 128 pixels, each
    // by at most 2^-18 pixel, ours being no more. So a vertex within 5/1024 step of half a step may
    // go either way, and its triangle is left out.
    constexpr double margin = 5.0 / 1024;
    constexpr int chosen = 3000;
    const OpenGlView view(ivec2(100, 75));
    Random random(1);
    std::vector<OpenGlTriangle> triangles;
    for (int i = 0; i < chosen; ++i) {
        OpenGlTriangle triangle;
        bool is_clear = true;
        for (vec4& vertex : triangle.vertices_clip) {
            const float w = any_float(random, 0.25f, 4), x = any_float(random, -w, w);
            vertex = {x, any_float(random, -w, w), 0.5f * w, w};
            const dvec2 ndc = dvec2(vertex.x, -vertex.y) / double{w};
            const dvec2 steps = (ndc + 1.0) * 0.5 * dvec2(view.size) * double{subpixels};
            const dvec2 from_half = glm::abs(glm::fract(steps) - 0.5);
            is_clear &= from_half.x > margin && from_half.y > margin;
        }
        if (is_clear) triangles.push_back(triangle);
    }
    EXPECT_GE(triangles.size(), chosen * 9 / 10u);
    expect_same_coverage(*gl, triangles, view);
}

TEST_F(OpenGlTest, CoversTheSamePixelsWhereVerticesLieOnHalfSteps) {
    // Beside centres of pixels, so that a step more or less is seen. Nothing is rounded before.
    constexpr float step = 1.0f / subpixels;
    const OpenGlView view(ivec2(16));
    Random random(1);
    std::vector<OpenGlTriangle> triangles(1000);
    for (OpenGlTriangle& triangle : triangles)
        for (vec4& vertex : triangle.vertices_clip) {
            const vec2 center = vec2(any_point(random, 1, 14)) + 0.5f;
            const vec2 ndc = (center + vec2(any_point(random, -3, 3)) * step / 2.0f) / 8.0f - 1.0f;
            vertex = {ndc.x, -ndc.y, 0.5f, 1};
        }
    expect_same_coverage(*gl, triangles, view);
}

TEST_F(OpenGlTest, CoversTheSamePixelsWhereTheNearPlaneCuts) {
    // Where planes cut a triangle, OpenGL finds new vertices in its own way, and snaps those. By
    // that a side moves by less than a step, and so does ours: all centres that are farther than a
    // step from a side, or from where the near plane cuts, are compared.
    constexpr double near_px = 1.0 / subpixels;
    const OpenGlView view(ivec2(64, 48));
    const mat4 clip_from_view = perspective(1.2f, 4.0f / 3, 0.5f);
    Random random(1);
    std::vector<OpenGlTriangle> triangles;
    while (triangles.size() < 2000) {
        OpenGlTriangle triangle;
        float least = 0;
        for (vec4& vertex : triangle.vertices_clip) {
            const ivec2 xy = any_point(random, -6000, 6000);
            vertex = clip_from_view * vec4(vec2(xy) / 1000.0f, any_float(random, -24, 4), 1);
            least = std::min(least, plane_distance(4, vertex));
        }
        if (least < 0) triangles.push_back(triangle);
    }
    const std::vector<OpenGlPicture> theirs = gl->draw_each(triangles, view);
    int compared = 0, left_out = 0, covering = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Vertices& vertices = triangles[i].vertices_clip;
        Image<int> ours(view.size);
        for (const auto& [a, b, c] : clip_triangle(vertices)) {
            const Drawn part = drawn({a.position_clip, b.position_clip, c.position_clip}, view);
            for_each_pixel(view.size, [&](ivec2 pixel) { ours[pixel] += part.times[pixel]; });
        }
        covering += !(ours == Image<int>(view.size));
        for_each_pixel(view.size, [&](ivec2 pixel) {
            if (distance_to_ends(vertices, view.size, dvec2(pixel) + 0.5) > near_px)
                ++compared;
            else
                ++left_out, ours[pixel] = static_cast<int>(theirs[i].color[pixel].x);
        });
        ASSERT_TRUE(covers_the_same(ours, theirs[i])) << "seed 1, case " << i;
    }
    EXPECT_GE(covering, 900);
    EXPECT_LE(left_out, compared / 1000);
}

TEST_F(OpenGlTest, DepthIsTheSame) {
    // llvmpipe solves for the slopes of a triangle's depth in float, and continues the plane to the
    // picture's corner: what cancels in the slopes takes its last bits along. (Ours is within 2^-22
    // of the exact depth in every triangle.)
    constexpr double least_tolerance = 0x1p-22;
    int gentle = 0;
    for_each_exact_triangle(*gl, [&](const Kind& kind, const Vertices& vertices, const Steps& steps,
                                     const OpenGlPicture& theirs) {
        const Drawn ours = drawn(vertices, kind.view);
        double reach = kind.view.size.x;
        std::array<dvec3, 3> p;
        for (std::size_t i = 0; i < 3; ++i) {
            const double z_ndc = double{vertices[i].z} / double{vertices[i].w};
            p[i] = dvec3(dvec2(steps[i]) / double{subpixels}, z_ndc);
            reach = std::max({reach, std::abs(p[i].x), std::abs(p[i].y)});
        }
        const dvec3 u = glm::abs(p[1] - p[0]), v = glm::abs(p[2] - p[0]);
        const double twice_area = static_cast<double>(ours.triangle.twice_area) / 65536;
        const double terms = (u.z * (v.x + v.y) + v.z * (u.x + u.y)) / twice_area;  // of the slopes
        const double tolerance = least_tolerance * std::max(1.0, reach * terms);
        bool is_compared = false;
        for_each_pixel(kind.view.size, [&](ivec2 pixel) {
            if (ours.times[pixel] == 0) return;
            is_compared = true;
            EXPECT_NEAR(ours.depth[pixel], theirs.depth[pixel], tolerance)
                << "pixel " << testing::PrintToString(pixel);
        });
        gentle += is_compared && tolerance == least_tolerance;
    });
    EXPECT_GE(gentle, 3'000);
}
