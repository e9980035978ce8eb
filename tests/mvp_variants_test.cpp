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

#include "04_mvp/mvp_variants.hpp"
#include "common/image/image_io.hpp"
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

/// As in the lesson; what lies beyond the far plane is not kept.
void draw(const MvpVariant& variant, const ClipVertices& vertices, Drawn& drawn) {
    const auto keep = [&](ivec2 pixel, float z) {
        if (!(z < DepthBuffer::cleared)) return;
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
    const std::string out = (fresh_folder("mvp_knobs") / "picture.bmp").string();
    arguments.insert(arguments.end(), {"--size", "640x360", "--out", out});
    const ProcessResult run = run_program("04_mvp", arguments);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_EQ(run.err, "");
    return read_image(out);
}

}  // namespace

TEST(MvpVariants, EveryClippingDrawsWhatRaysSee) {
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

TEST(MvpVariants, EveryClippingGivesTheSameDepths) {
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

TEST(MvpVariants, TrianglesInsideAreLeftAsTheyAre) {
    for (const ClipVertices& vertices : small_triangles(400)) {
        bool is_inside = true;
        for (const vec4 vertex : vertices)
            for (int plane = 0; plane < frustum_planes; ++plane)
                is_inside &= plane_distance(plane, vertex) >= 0;
        if (!is_inside) continue;
        const ClippedTriangles near = clip({.clipping = Clipping::near_plane}, vertices, size);
        ASSERT_EQ(near.end() - near.begin(), 1);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_EQ((*near.begin())[i].position_clip, vertices[i]);
    }
}

TEST(MvpVariants, NearCuttingLeavesNothingThatFillTriangleRefuses) {
    // Inside the guard band of 4 million pixels, and beyond it: there cut by six planes.
    for (const float reach : {1e4f, 8e4f}) {
        const ClipVertices vertices = {vec4(-reach, -1.1f, 0, 1), vec4(reach, -1.1f, 0, 1),
                                       vec4(0, reach, 0, 1)};
        const ClippedTriangles parts = clip({.clipping = Clipping::near_plane}, vertices, size);
        EXPECT_EQ(parts.end() - parts.begin() == 1, reach == 1e4f);
        const Drawn result = drawn(Clipping::near_plane, vertices);
        for (const int hits : result.hits.pixels()) ASSERT_EQ(hits, 1) << reach;
    }
}

TEST(MvpVariants, TrianglesThatShareSidesVisitEachPixelOnce) {
    // A fan around a pixel's centre, with vertices behind the camera and sides through centres.
    for (const float tilt : {0.0f, 0.3f, 0.6f}) {
        Drawn result;
        const vec4 middle(1.0f / 128, -1.0f / 64, 0, 1);
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

TEST(MvpVariants, CentresOnSidesBelongToTheSameTriangleWithEveryClipping) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> column(0, 15), row(0, 7), power(0, 2);
    for (int i = 0; i < 300; ++i) {
        ClipVertices vertices;
        for (vec4& vertex : vertices) {
            const vec2 center = 8.0f * vec2(column(random), row(random)) + 0.5f;
            const auto w = static_cast<float>(1 << power(random));
            vertex = vec4(2.0f * center.x / 128 - 1, 1 - 2.0f * center.y / 64, 0, 1) * w;
        }
        const Drawn six = drawn(Clipping::six_planes, vertices);
        const auto hits = six.hits.pixels();
        for (const Clipping clipping : {Clipping::near_plane, Clipping::pixels}) {
            const Drawn other = drawn(clipping, vertices);
            ASSERT_TRUE(std::equal(hits.begin(), hits.end(), other.hits.pixels().begin())) << i;
        }
    }
}

TEST(MvpVariants, BackFacesAndDegenerateTrianglesAreNotDrawn) {
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

TEST(MvpVariants, OnlyFloatDependsOnWhereTheWorldIs) {
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

TEST(MvpVariants, EveryKnobDraws) {
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
