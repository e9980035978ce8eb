// SPDX-License-Identifier: MIT
// The variants of lesson 04 that docs/accuracy/04_mvp.md measures: each keeps what its comment
// says.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/image/image_io.hpp"
#include "lab/mvp_methods.hpp"
#include "support/lesson_process.hpp"
#include "support/printers.hpp"
#include "support/projected.hpp"
#include "support/seen_by_rays.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr ivec2 size(128, 64);  // powers of two: pixel centres are exact in NDC

/// How often each pixel is visited, and the depth that it was visited with last: the cleared one
/// where there is none.
struct Drawn {
    Image<int> hits{size, 0};
    Image<float> depth{size, DepthBuffer::cleared};
    int front = 0;  ///< Parts of the triangle that were not culled.
};

/// As in the lesson; what is infinitely far away is not kept.
void draw(const MvpMethod& variant, const ClipVertices& vertices, Drawn& drawn) {
    const auto keep = [&](ivec2 pixel, float z) {
        if (!(z > DepthBuffer::cleared)) return;
        ++drawn.hits[pixel];
        drawn.depth[pixel] = z;
    };
    if (variant.clipping == Clipping::pixels) {
        drawn.front += HomogeneousTriangle(whole_triangle(vertices)).volume > 0;
        fill_homogeneous(whole_triangle(vertices), size, keep);
        return;
    }
    for (const ClippedTriangle& clipped : clip(variant, vertices, size)) {
        const ProjectedTriangle triangle = projected(clipped, size);
        if (triangle.is_back_facing) continue;
        ++drawn.front;
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

/// The pixels that differ although the triangle's border is not near.
int clearly_different(const Drawn& drawn, const RaySeen& rays, long double band_px) {
    int different = 0;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const bool expected = rays.is_seen({x, y}, size);
            if (drawn.hits[{x, y}] == expected || rays.is_near_border({x, y}, size, band_px))
                continue;
            ++different;
        }
    return different;
}

std::vector<ClipVertices> small_and_large() {
    std::vector<ClipVertices> all = small_triangles(400);
    const std::vector<ClipVertices> large = large_triangles(200);
    all.insert(all.end(), large.begin(), large.end());
    return all;
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

TEST(LabMvp, EveryClippingDrawsWhatRaysSee) {
    // Vertices are snapped by up to 1/512 pixel in x and in y, and so are those that cutting adds.
    constexpr long double snapped_px = 1.0L / 256;
    // Those of `pixel` are not: what is left is the rounding of double.
    constexpr long double exact_px = 1e-9L;
    int seen = 0;
    for (const ClipVertices& vertices : small_and_large()) {
        const RaySeen rays(vertices);
        for (const Clipping clipping : {Clipping::six_planes, Clipping::near_plane}) {
            const Drawn result = drawn(clipping, vertices);
            ASSERT_EQ(clearly_different(result, rays, snapped_px), 0) << static_cast<int>(clipping);
            for (const int hits : result.hits.pixels()) seen += hits;
        }
        ASSERT_EQ(clearly_different(drawn(Clipping::pixels, vertices), rays, exact_px), 0);
    }
    EXPECT_GT(seen, 50'000);
}

TEST(LabMvp, EveryClippingGivesTheSameDepths) {
    // A pixel or more from the border depths change by less than 1 in a pixel, and snapping moves
    // by less than 1/256 of it. Slivers may be steeper.
    constexpr float tolerance = 1.0f / 256;
    int compared = 0;
    for (const ClipVertices& vertices : small_and_large()) {
        const RaySeen rays(vertices);
        const Drawn six = drawn(Clipping::six_planes, vertices);
        const Drawn near = drawn(Clipping::near_plane, vertices);
        const Drawn pixel = drawn(Clipping::pixels, vertices);
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                if (!rays.is_seen({x, y}, size) || rays.is_near_border({x, y}, size, 1)) continue;
                ASSERT_NEAR((six.depth[{x, y}]), (near.depth[{x, y}]), tolerance);
                ASSERT_NEAR((six.depth[{x, y}]), (pixel.depth[{x, y}]), tolerance);
                ++compared;
            }
    }
    EXPECT_GT(compared, 10'000);
}

TEST(LabMvp, TrianglesInsideAreLeftAsTheyAre) {
    for (const ClipVertices& vertices : small_triangles(400)) {
        bool is_inside = true;
        for (const vec4 vertex : vertices)
            for (int plane = 0; plane < frustum_planes; ++plane)
                is_inside &= plane_distance(plane, vertex) >= 0;
        if (!is_inside) continue;
        const ClippedTriangles near = clip({.clipping = Clipping::near_plane}, vertices, size);
        ASSERT_EQ(near.end() - near.begin(), 1);
        for (std::size_t i = 0; i < 3; ++i) {
            ASSERT_EQ((*near.begin())[i].position_clip, vertices[i]) << "vertex " << "abc"[i];
            ASSERT_EQ((*near.begin())[i].barycentrics, vec3(i == 0, i == 1, i == 2))
                << "vertex " << "abc"[i];
        }
    }
}

TEST(LabMvp, NearCuttingLeavesNothingThatFillTriangleRefuses) {
    // fill_triangle takes 4 million pixels: about 65,500 times half of the picture's width, and
    // 131,000 times half of its height. What reaches farther is cut by six planes.
    struct Case {
        const char* name;
        vec2 reach;
        bool is_whole;
    };
    for (const auto& [name, reach, is_whole] :
         {Case{"within both", {1e4f, 1e4f}, true}, Case{"too wide", {8e4f, 2}, false},
          Case{"too high", {2, 16e4f}, false}, Case{"too wide and too high", vec2(16e4f), false},
          Case{"high, but within", {2, 8e4f}, true}}) {
        const ClipVertices vertices = {vec4(-reach.x, -1.1f, 0.5f, 1),
                                       vec4(reach.x, -1.1f, 0.5f, 1), vec4(0, reach.y, 0.5f, 1)};
        const ClippedTriangles parts = clip({.clipping = Clipping::near_plane}, vertices, size);
        EXPECT_EQ(parts.end() - parts.begin() == 1, is_whole) << name;
        const Drawn result = drawn(Clipping::near_plane, vertices);
        for (const int hits : result.hits.pixels()) ASSERT_EQ(hits, 1) << name;
    }
}

TEST(LabMvp, NearCuttingForgetsTheTriangleBefore) {
    // The near plane leaves four corners of the first, of which the last, a million halves of the
    // picture to the right, is too far. The second only leaves the picture.
    const ClipVertices too_far = {vec4(2e6f, -1, 0.5f, 1), vec4(1, 0, 0.5f, 1),
                                  vec4(0, 1, 1.5f, 1)};
    const ClipVertices near_enough = {vec4(-4, -4, 0.5f, 1), vec4(4, -4, 0.5f, 1),
                                      vec4(0, 4, 0.5f, 1)};
    for (const ClipVertices& vertices : {near_enough, too_far, near_enough}) {
        const ClippedTriangles parts = clip({.clipping = Clipping::near_plane}, vertices, size);
        if (vertices == too_far) continue;
        ASSERT_EQ(parts.end() - parts.begin(), 1) << "parts of what is all before the near plane";
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_EQ((*parts.begin())[i].position_clip, vertices[i]) << "vertex " << "abc"[i];
    }
}

TEST(LabMvp, TrianglesThatShareSidesVisitEachPixelOnce) {
    // A fan around a pixel's centre, with vertices behind the camera and sides through centres.
    for (const float tilt : {0.0f, 0.3f, 0.6f}) {
        Drawn result;
        const vec4 middle(1.0f / 128, -1.0f / 64, 0.01f, 1);
        std::vector<vec4> rim;
        for (int k = 0; k < 24; ++k) {
            const float angle_radians = glm::radians(15.0f * static_cast<float>(k));
            const vec2 way(std::round(256 * std::cos(angle_radians)) / 64,
                           std::round(256 * std::sin(angle_radians)) / 64);
            rim.push_back(middle + vec4(way, 0, tilt * way.x));
        }
        for (std::size_t k = 0; k < rim.size(); ++k)
            draw({.clipping = Clipping::pixels}, {middle, rim[k], rim[(k + 1) % rim.size()]},
                 result);
        int behind = 0;
        for (const vec4 vertex : rim) behind += vertex.w < 0;
        EXPECT_EQ(behind > 0, tilt >= 0.3f);
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                ASSERT_EQ((result.hits[{x, y}]), 1) << tilt << ": " << x << ", " << y;
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
        const Drawn six = drawn(Clipping::six_planes, vertices);
        const auto hits = six.hits.pixels();
        for (const Clipping clipping : {Clipping::near_plane, Clipping::pixels}) {
            const Drawn other = drawn(clipping, vertices);
            ASSERT_TRUE(std::equal(hits.begin(), hits.end(), other.hits.pixels().begin())) << i;
        }
    }
}

TEST(LabMvp, BackFacesAndDegenerateTrianglesAreNotDrawn) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Clipping clipping : {Clipping::six_planes, Clipping::near_plane, Clipping::pixels}) {
        const vec4 a(-0.5f, -0.5f, 0, 1), b(0.5f, -0.5f, 0, 1), c(0, 0.5f, 0, 1);
        EXPECT_GT(drawn(clipping, {a, b, c}).front, 0);
        EXPECT_EQ(drawn(clipping, {a, c, b}).front, 0);
        EXPECT_EQ(drawn(clipping, {a, a, c}).front, 0);
        EXPECT_EQ(drawn(clipping, {a, b, vec4(nan)}).front, 0);
        EXPECT_EQ(drawn(clipping, {vec4(0), vec4(0), vec4(0)}).front, 0);
        const Drawn behind = drawn(clipping, {-a, -b, -c});
        for (const int hits : behind.hits.pixels()) EXPECT_EQ(hits, 0) << "behind the camera";
    }
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
    const ClipVertices beside = {vec4(-0x1.bfp+4f, -0x1.62ep-3f, 0, 1),
                                 vec4(-0x1.35p+2f, -0x1.ce2p-3f, 0, 1),
                                 vec4(-0x1.a19cdp+6f, 0x1.8ecc98p-29f, 0, 1)};
    const ClipVertices far_left = {vec4(-0x1.097p+5f, 0x1.77p-5f, 0, 1),
                                   vec4(-0x1.db8p+2f, -0x1.b5p-5f, 0, 1),
                                   vec4(-0x1.549aa4p+4f, 0x1.dd3432p-33f, 0, 1)};
    const ClipVertices behind = {vec4(0x1.9cp+1f, -0x1.fp-3f, 0, 0),
                                 vec4(-0x1.2e4p+3f, 0x1.688p-1f, 0, -0.5f),
                                 vec4(-0x1.24c1ecp-2f, -0x1.ac1dd4p-30f, 0, -0x1.a1dd2ep+0f)};
    const auto visited = [](const ClipVertices& vertices) {
        std::vector<ivec2> pixels;
        fill_homogeneous(whole_triangle(vertices), size,
                         [&](ivec2 pixel, float) { pixels.push_back(pixel); });
        return pixels;
    };
    EXPECT_EQ(visited(beside), std::vector<ivec2>{})
        << "left of the picture, on a line through pixel (1, 39)";
    EXPECT_EQ(visited(far_left), std::vector<ivec2>{})
        << "left of the picture, on a line through pixel (0, 34)";
    EXPECT_EQ(visited(behind), std::vector<ivec2>{})
        << "two vertices behind the camera, one beside it, in a plane through pixel (88, 32)";
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
    const dmat4 clip_from_view = perspective(1.0, 2.0, 0.5);
    for (const double offset : {0.0, 1e3, 1e7}) {
        EXPECT_EQ(transform({Precision::relative, offset}, camera, size, positions),
                  float_around_camera)
            << "relative, moved by " << offset;
        const std::vector<vec4> by_double =
            transform({Precision::float64, offset}, camera, size, positions);
        // Before they are rounded to float: a few products with coordinates of that size.
        const double of_double = 8 * std::numeric_limits<double>::epsilon() * (offset + 10);
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const dvec4 exact = clip_from_view * dvec4(around_camera[i], 1);
            for (int axis = 0; axis < 4; ++axis) {
                const float computed = by_double[i][axis], size_of_it = std::abs(computed);
                const double ulp = double{std::nextafter(size_of_it, 100.0f)} - size_of_it;
                ASSERT_LE(std::abs(computed - exact[axis]), ulp / 2 + of_double)
                    << "xyzw"[axis] << " of " << testing::PrintToString(positions[i])
                    << " in clip space by double, moved by " << offset << "; seed 1, case " << i;
            }
        }
    }
}

TEST(LabMvp, OnlyFloatDependsOnWhereTheWorldIs) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(-4, 4);
    std::vector<vec3> positions;
    Bounds bounds;
    for (int i = 0; i < 1000; ++i) {
        positions.emplace_back(any(random), any(random), any(random));
        bounds.add(positions.back());
    }
    const Camera camera = orbit_camera({}, bounds);
    const auto greatest_error_px = [&](Precision precision, double offset) {
        const ReferenceCamera reference(camera, bounds.center(), size, offset);
        const std::vector<vec4> positions_clip =
            transform({precision, offset}, camera, size, positions);
        long double greatest = 0;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const Place place = reference.on_screen(positions[i]);
            const vec3 computed = screen_from_clip(positions_clip[i], size);
            greatest = std::max(greatest, std::hypot(computed.x - place.x, computed.y - place.y));
        }
        return static_cast<double>(greatest);
    };
    constexpr double float_px = 1e-4;  // about 13 ulp at 64 to 128
    for (const double offset : {0.0, 1e3, 1e5, 1e6, 1e7}) {
        EXPECT_LT(greatest_error_px(Precision::relative, offset), float_px) << offset;
        EXPECT_LT(greatest_error_px(Precision::float64, offset), float_px) << offset;
        EXPECT_EQ(greatest_error_px(Precision::float32, offset) < float_px, offset == 0) << offset;
    }
    EXPECT_EQ(transform({}, camera, size, positions),
              transform(camera.clip_from_world(size), positions));
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
    ASSERT_EQ(flat_normal(mesh, mesh.triangles[0]), vec3(0, 0, 1)) << "before it is flattened";

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
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            if (picture[{x, y}] == nothing[{x, y}]) continue;
            ++seen;
            ASSERT_EQ((picture[{x, y}]), expected) << "pixel " << x << ", " << y;
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
