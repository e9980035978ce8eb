// SPDX-License-Identifier: MIT
// The variants of lesson 04 that docs/accuracy/04_mvp.md measures: each keeps what its comment
// says.
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/image/image_io.hpp"
#include "lab/mvp_methods.hpp"
#include "support/ascii_picture.hpp"
#include "support/first_difference.hpp"
#include "support/lesson_process.hpp"
#include "support/printers.hpp"
#include "support/projected.hpp"
#include "support/seen_by_rays.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr ivec2 size(128, 64);  // powers of two: pixel centres are exact in NDC
constexpr Clipping every_clipping[] = {Clipping::six_planes, Clipping::near_plane,
                                       Clipping::pixels};

std::string name(Clipping clipping) {
    constexpr const char* names[] = {"six", "near", "pixel"};
    return std::string("--clip ") + names[static_cast<std::size_t>(clipping)];
}

/// How often each pixel is visited, and the depth that it was visited with last: the cleared one
/// where there is none.
struct Drawn {
    Image<int> hits{size, 0};
    Image<float> depth{size, DepthBuffer::cleared};
};

/// As in the lesson; what is infinitely far away is not kept.
void draw(const MvpMethod& variant, const ClipVertices& vertices, Drawn& drawn) {
    const auto keep = [&](ivec2 pixel, float z) {
        if (!(z > DepthBuffer::cleared)) return;
        ++drawn.hits[pixel];
        drawn.depth[pixel] = z;
    };
    if (variant.clipping == Clipping::pixels) {
        fill_homogeneous(whole_triangle(vertices), size, keep);
        return;
    }
    for (const ClippedTriangle& clipped : clip(variant, vertices, size)) {
        const ProjectedTriangle triangle = projected(clipped, size);
        if (triangle.is_back_facing) continue;
        fill_triangle(triangle.on_screen, size, [&](ivec2 pixel, Barycentrics barycentrics) {
            keep(pixel, triangle.depth.at(barycentrics));
        });
    }
}

Drawn drawn(Clipping clipping, const ClipVertices& vertices) {
    Drawn result;
    draw({.clipping = clipping}, vertices, result);
    return result;
}

int differing_pixels(const Image<u8vec4>& a, const Image<u8vec4>& b) {
    int differing = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) differing += a.pixels()[i] != b.pixels()[i];
    return differing;
}

Image<u8vec4> picture(std::vector<std::string> arguments) {
    const std::string out = (fresh_folder("mvp_options") / "picture.bmp").string();
    arguments.insert(arguments.end(), {"--size", "640x360", "--out", out});
    const ProcessResult run = run_program("lab_04_mvp", arguments);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_EQ(run.err, "");
    return read_image(out);
}

}  // namespace

TEST(LabMvp, EveryClippingDrawsWhatRaysSeeAtTheSameDepths) {
    std::vector<ClipVertices> all = small_triangles(400), large = large_triangles(200);
    all.insert(all.end(), large.begin(), large.end());
    int compared = 0;
    for (const ClipVertices& vertices : all) {
        const RaySeen rays(vertices);
        const Drawn six = drawn(Clipping::six_planes, vertices);
        for (const Clipping clipping : every_clipping) {
            const Drawn other = drawn(clipping, vertices);
            // Vertices are snapped by up to 1/512 pixel in x and in y, and so are those that
            // cutting adds. Those of `pixels` are not: what is left is the rounding of double.
            const long double band_px = clipping == Clipping::pixels ? 1e-9L : 1.0L / 256;
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x) {
                    const bool is_seen = rays.is_seen({x, y}, size);
                    const bool is_right = other.hits[{x, y}] == is_seen;
                    ASSERT_TRUE(is_right || rays.is_near_border({x, y}, size, band_px))
                        << "pixel (" << x << ", " << y << ") is drawn, or not, by "
                        << name(clipping) << ", and its ray sees otherwise; "
                        << testing::PrintToString(vertices);
                    if (!is_seen || rays.is_near_border({x, y}, size, 1)) continue;
                    // A pixel or more from the border depths change by less than 1 in a pixel, and
                    // snapping moves by less than 1/256 of it. Slivers may be steeper.
                    ASSERT_NEAR((other.depth[{x, y}]), (six.depth[{x, y}]), 1.0f / 256)
                        << "by " << name(clipping) << ", and by six planes";
                    ++compared;
                }
        }
    }
    EXPECT_GT(compared, 30'000);
}

TEST(LabMvp, NearCuttingLeavesNothingThatFillTriangleRefuses) {
    // fill_triangle takes 4 million pixels: about 65,500 times half of the picture's width, and
    // 131,000 times half of its height. What reaches farther is cut by six planes.
    for (const auto& [name, reach, is_whole] : {std::tuple("within both", vec2(1e4f), true),
                                                {"too wide", vec2(8e4f, 2), false},
                                                {"too high", vec2(2, 16e4f), false},
                                                {"too wide and too high", vec2(16e4f), false},
                                                {"high, but within", vec2(2, 8e4f), true}}) {
        const ClipVertices vertices = {vec4(-reach.x, -1.1f, 0.5f, 1),
                                       vec4(reach.x, -1.1f, 0.5f, 1), vec4(0, reach.y, 0.5f, 1)};
        const ClippedTriangles parts = clip({.clipping = Clipping::near_plane}, vertices, size);
        EXPECT_EQ(parts.end() - parts.begin() == 1, is_whole) << name;
        EXPECT_TRUE(each_pixel_once(drawn(Clipping::near_plane, vertices).hits)) << name;
    }
}

TEST(LabMvp, NearCuttingForgetsTheTriangleBefore) {
    // The near plane leaves four corners of the first, of which the last, a million halves of the
    // picture to the right, is too far. The second only leaves the picture.
    const ClipVertices too_far = {vec4(2e6f, -1, 0.5f, 1), vec4(1, 0, 0.5f, 1),
                                  vec4(0, 1, 1.5f, 1)};
    const ClipVertices near_enough = {vec4(-4, -4, 0.5f, 1), vec4(4, -4, 0.5f, 1),
                                      vec4(0, 4, 0.5f, 1)};
    clip({.clipping = Clipping::near_plane}, too_far, size);
    const ClippedTriangles parts = clip({.clipping = Clipping::near_plane}, near_enough, size);
    ASSERT_EQ(parts.end() - parts.begin(), 1) << "parts of what is all before the near plane";
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ((*parts.begin())[i].position_clip, near_enough[i]) << "vertex " << "abc"[i];
}

TEST(LabMvp, TrianglesThatShareSidesVisitEachPixelOnce) {
    // A fan around a pixel's centre, with vertices behind the camera and sides through centres.
    for (const float tilt : {0.0f, 0.3f, 0.6f}) {
        Drawn result;
        const vec4 middle(1.0f / 128, -1.0f / 64, 0.01f, 1);
        const auto rim = [&](int k) {
            const float angle_radians = glm::radians(15.0f * static_cast<float>(k % 24));
            const vec2 way(std::round(256 * std::cos(angle_radians)) / 64,
                           std::round(256 * std::sin(angle_radians)) / 64);
            return middle + vec4(way, 0, tilt * way.x);
        };
        for (int k = 0; k < 24; ++k)
            draw({.clipping = Clipping::pixels}, {middle, rim(k), rim(k + 1)}, result);
        EXPECT_EQ(rim(12).w < 0, tilt >= 0.3f) << "whether one of them is behind";
        ASSERT_TRUE(each_pixel_once(result.hits)) << "tilted by " << tilt;
    }
}

TEST(LabMvp, CentresOnSidesBelongToTheSameTriangleWithEveryClipping) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> column(0, 15), row(0, 7), power(0, 2);
    for (int i = 0; i < 300; ++i) {
        ClipVertices vertices;
        for (vec4& vertex : vertices) {
            const vec2 center = 8.0f * vec2(column(random), row(random)) + 0.5f;
            const auto w = static_cast<float>(1 << power(random));
            vertex = vec4(2.0f * center.x / 128 - 1, 1 - 2.0f * center.y / 64, 0.5f, 1) * w;
        }
        const Image<int> expected = drawn(Clipping::six_planes, vertices).hits;
        for (const Clipping clipping : {Clipping::near_plane, Clipping::pixels})
            ASSERT_TRUE(are_equal(drawn(clipping, vertices).hits, expected))
                << "hits by " << name(clipping) << ", and by six planes; seed 1, case " << i;
    }
}

TEST(LabMvp, BackFacesAndDegenerateTrianglesAreNotDrawn) {
    const vec4 nan(std::numeric_limits<float>::quiet_NaN());
    const vec4 a(-0.5f, -0.5f, 0.5f, 1), b(0.5f, -0.5f, 0.5f, 1), c(0, 0.5f, 0.5f, 1);
    for (const Clipping clipping : every_clipping)
        for (const ClipVertices& vertices : {ClipVertices{a, c, b},
                                             {a, a, c},
                                             {a, b, nan},
                                             {vec4(0), vec4(0), vec4(0)},
                                             {-a, -b, -c}})  // the last one behind the camera
            EXPECT_TRUE(are_equal(drawn(clipping, vertices).hits, Image<int>(size, 0)))
                << "hits, by " << name(clipping) << ", of " << testing::PrintToString(vertices);
}

TEST(LabMvp, TrianglesInTheNearPlaneAndInfinitelyFarAwayAreDrawn) {
    // All of its numbers are sums of a few powers of two: nothing rounds.
    const auto visited = [](float z, float expected_depth) {
        int pixels = 0;
        const ClipVertices vertices = {vec4(-0.5f, -0.5f, z, 1), vec4(0.5f, -0.5f, z, 1),
                                       vec4(0, 0.5f, z, 1)};
        fill_homogeneous(whole_triangle(vertices), size, [&](ivec2, float depth) {
            ++pixels;
            EXPECT_EQ(depth, expected_depth) << "with z = " << z << " and w = 1";
        });
        return pixels;
    };
    const int between = visited(0.5f, 0.5f);
    EXPECT_GT(between, 500);
    EXPECT_EQ(visited(1, 1), between) << "pixels of a triangle in the near plane";
    EXPECT_EQ(visited(0, 0), between) << "pixels of a triangle infinitely far away";
    EXPECT_EQ(visited(1.25f, 1), 0) << "pixels of a triangle before the near plane";
    EXPECT_EQ(visited(-0.25f, 0), 0) << "pixels of a triangle beyond infinity";
}

TEST(LabMvp, NeedlesBesideThePictureAndBehindTheCameraAreNotDrawn) {
    // Each is so thin that its volume and a pixel's shares in it are what rounding leaves; those of
    // the pixel named here come out as if it were inside.
    const std::pair<const char*, ClipVertices> needles[] = {
        {"left of the picture, on a line through pixel (1, 39)",
         {{{-0x1.bfp+4f, -0x1.62ep-3f, 0, 1},
           {-0x1.35p+2f, -0x1.ce2p-3f, 0, 1},
           {-0x1.a19cdp+6f, 0x1.8ecc98p-29f, 0, 1}}}},
        {"left of the picture, on a line through pixel (0, 34)",
         {{{-0x1.097p+5f, 0x1.77p-5f, 0, 1},
           {-0x1.db8p+2f, -0x1.b5p-5f, 0, 1},
           {-0x1.549aa4p+4f, 0x1.dd3432p-33f, 0, 1}}}},
        {"two vertices behind the camera, one beside it, in a plane through pixel (88, 32)",
         {{{0x1.9cp+1f, -0x1.fp-3f, 0, 0},
           {-0x1.2e4p+3f, 0x1.688p-1f, 0, -0.5f},
           {-0x1.24c1ecp-2f, -0x1.ac1dd4p-30f, 0, -0x1.a1dd2ep+0f}}}}};
    for (const auto& [where, vertices] : needles)
        fill_homogeneous(whole_triangle(vertices), size, [&](ivec2 pixel, float) {
            ADD_FAILURE() << testing::PrintToString(pixel) << " is visited; the needle is "
                          << where;
        });
}

TEST(LabMvp, RelativeIsFloatAroundTheCameraAndDoubleRoundsOnce) {
    // It looks at the origin, as cameras do of which nothing else is said.
    const Camera camera = {{0, 0, 5}, translation(vec3(0, 0, -5)), 1, 0.5f};
    const Camera at_origin = {vec3(0), mat4(1), 1, 0.5f, {0, 0, -5}};
    std::mt19937 random(1);
    std::uniform_int_distribution<int> any(-4096, 4096);
    std::vector<vec3> positions, around_camera;
    for (int i = 0; i < 1000; ++i) {  // multiples of 1/1024: no difference of them rounds
        positions.push_back(vec3(any(random), any(random), any(random)) / 1024.0f);
        around_camera.push_back(positions.back() - camera.position_world);
    }
    const std::vector<vec4> float_around_camera =
        transform(at_origin.clip_from_world(size), around_camera);
    EXPECT_EQ(transform({}, camera, size, positions),
              transform(camera.clip_from_world(size), positions));
    const dmat4 clip_from_view = perspective(1.0, 2.0, 0.5);
    for (const double offset : {0.0, 1e3, 1e7}) {
        SCOPED_TRACE("moved by " + text_of(offset));
        EXPECT_EQ(transform({Precision::relative, offset}, camera, size, positions),
                  float_around_camera);
        const std::vector<vec4> by_double =
            transform({Precision::float64, offset}, camera, size, positions);
        // Before they are rounded to float: a few products with coordinates of that size.
        const double of_double = 8 * std::numeric_limits<double>::epsilon() * (offset + 10);
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const dvec4 exact = clip_from_view * dvec4(around_camera[i], 1);
            for (int axis = 0; axis < 4; ++axis)
                ASSERT_NEAR(
                    by_double[i][axis], exact[axis],
                    std::numeric_limits<float>::epsilon() / 2 * std::abs(exact[axis]) + of_double)
                    << "xyzw"[axis] << " of " << testing::PrintToString(positions[i])
                    << " in clip space by double; seed 1, case " << i;
        }
    }
}

TEST(LabMvp, WhatIsFlattenedToALineHasTheColorOfWhatFacesUp) {
    // x and y become (x, 0.3 x): a line, that faces nowhere. Far from the origin floats are 2
    // apart; there rounding gives the line an area: (0, 0), (8, 2) and (4, 2).
    constexpr float far_away = 0x1p24f;
    const mat4 flatten(vec4(1, 0.3f, 0, 0), vec4(0), vec4(0, 0, 1, 0),
                       vec4(far_away, far_away, 0, 1));
    Scene scene;
    scene.materials.resize(1);
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.positions = {{0, 0, 0}, {8, 1, 0}, {4, 5, 0}};
    mesh.vertices = {Vertex{0}, Vertex{1}, Vertex{2}};
    mesh.triangles = {{{Vertex{0}, Vertex{1}, Vertex{2}}, 0}};

    struct {
        ivec2 size = ::size;
        bool show_depth = false;
        MvpMethod mvp{.precision = Precision::float64, .clipping = Clipping::pixels};
    } const options;
    const vec3 center(far_away + 4, far_away + 2, 0), eye = center + vec3(0, 0, 4);
    const Camera camera = {eye, look_at(eye, center, vec3(0, 1, 0)), 1.5f, 1, center};
    const Image<vec3> picture = render_by_pixels(options, scene, {{mesh, flatten}}, camera);
    const Image<vec3> nothing = backdrop(size);
    const vec3 expected = flat_color(vec3(0, 1, 0), scene.materials[0]);
    int seen = 0;
    for (std::size_t i = 0; i < picture.pixels().size(); ++i) {
        if (picture.pixels()[i] == nothing.pixels()[i]) continue;
        ++seen;
        ASSERT_EQ(picture.pixels()[i], expected) << "the color of pixel " << i;
    }
    EXPECT_GT(seen, 100);
}

TEST(LabMvp, EveryOptionDraws) {
    const Image<u8vec4> usual = picture({}), close = picture({"--distance", "0.3"});
    for (const std::string offset : {"1000", "100000", "1000000", "10000000"})
        EXPECT_GT(differing_pixels(usual, picture({"--offset", offset})), 0) << offset;
    // A centre within rounding of a side may change its colour.
    constexpr int rounded_pixels = 10, snapped_pixels = 100;
    for (const std::string precision : {"relative", "double"})
        for (const std::string offset : {"0", "1000", "10000000"})
            EXPECT_LE(
                differing_pixels(usual, picture({"--precision", precision, "--offset", offset})),
                rounded_pixels)
                << precision << ' ' << offset;
    for (const std::string clipping : {"near", "pixel"}) {
        EXPECT_LE(differing_pixels(usual, picture({"--clip", clipping})), snapped_pixels);
        EXPECT_LE(differing_pixels(close, picture({"--clip", clipping, "--distance", "0.3"})),
                  snapped_pixels);
    }
    EXPECT_EQ(differing_pixels(usual, picture({"--clip", "six", "--precision", "float"})), 0);
    EXPECT_GT(differing_pixels(usual, picture({"--turn", "-39"})), 100) << "by one degree";
    const Image<u8vec4> orthographic = picture({"--view", "orthographic"});
    EXPECT_GT(differing_pixels(usual, orthographic), 1000);
    EXPECT_EQ(differing_pixels(orthographic, picture({"--view", "orthographic", "--yaw", "60"})), 0)
        << "it stands still";
    EXPECT_GT(differing_pixels(usual, close), 1000);
}
