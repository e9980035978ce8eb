// SPDX-License-Identifier: MIT
// The outline by edges in depth and normals: on pictures made by hand, and on planes however steep.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "07_toon/outline.hpp"
#include "common/obj.hpp"
#include "support/look_up.hpp"
#include "support/printers.hpp"
#include "support/toon_pictures.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

const Camera camera{vec3(0), mat4(1), 1, 1, 100};
constexpr vec3 toward_eye(0, 0, 1);
constexpr vec3 white(1);

/// What is stored for a point at this distance: Eq. 4.8 and 4.9 in long double.
float depth_at(long double distance, const Camera& from) {
    const long double near = from.near, far = from.far;
    const long double ndc = (far + near - 2 * far * near / distance) / (far - near);
    return static_cast<float>((ndc + 1) / 2);
}

/// A picture by hand: distances, and normals.
struct ByHand {
    DepthBuffer depth;
    Image<vec3> normals, color;

    explicit ByHand(ivec2 size) : depth(size), normals(size, toward_eye), color(size, white) {}

    /// @param distance_at  Called as distance_at(pixel); infinite: nothing is there.
    template <typename DistanceAt>
    static ByHand of(ivec2 size, DistanceAt&& distance_at) {
        ByHand picture(size);
        for (ivec2 p(0); p.y < size.y; ++p.y)
            for (p.x = 0; p.x < size.x; ++p.x) {
                const float distance = distance_at(p);
                if (std::isinf(distance))
                    picture.normals[p] = vec3(0);
                else
                    picture.depth.test_and_write(p, depth_at(distance, camera));
            }
        return picture;
    }

    /// Whether each pixel is inked.
    Image<char> edges(float width_px, const EdgeThresholds& thresholds = {}) {
        NoCounters none;
        draw_edges(depth, normals, camera, width_px, thresholds, color, none);
        Image<char> inked(color.size());
        for (std::size_t i = 0; i < color.pixels().size(); ++i)
            inked.pixels()[i] = color.pixels()[i] == ink;
        return inked;
    }
};

int ones(const Image<char>& image) {
    return static_cast<int>(std::ranges::count(image.pixels(), char{1}));
}

/// Whether there is paper, or the picture's end, within so many pixels.
bool is_near_paper(const Image<Seen>& bare, ivec2 pixel, int reach) {
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
            const ivec2 p = pixel + ivec2(x, y);
            if (!bare.contains(p) || bare[p] == Seen::paper) return true;
        }
    return false;
}

}  // namespace

TEST(Toon, Eq7_11_IsOneOverTheDistance) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> octave(-10, 10), share(0, 1);
    for (int i = 0; i < 100'000; ++i) {
        Camera some = camera;
        some.near = static_cast<float>(std::exp2(octave(random)));
        some.far = some.near * static_cast<float>(std::exp2(0.1 + std::abs(octave(random))));
        const double distance = some.near + share(random) * (some.far - some.near);
        const float depth = depth_at(distance, some);
        if (depth == DepthBuffer::cleared) continue;
        // The depth's rounding, half an ulp of 1, and three of 1 / near.
        ASSERT_NEAR(nearness(depth, some) * some.near, some.near / distance, 3 * FLT_EPSILON)
            << "seed 1, case " << i;
    }
    EXPECT_EQ(nearness(0, camera), 1);
    EXPECT_EQ(nearness(DepthBuffer::cleared, camera), 0);
}

TEST(Toon, Eq7_12_IsZeroForPlanesAndMeasuresBends) {
    const ivec2 x(1, 0), y(0, 1);
    const auto plane = [](ivec2 p) { return static_cast<float>(100 + 7 * p.x - 3 * p.y); };
    EXPECT_EQ(second_difference(plane, x), 0);
    EXPECT_EQ(second_difference(plane, y), 0);
    const auto bowl = [](ivec2 p) { return static_cast<float>(5 * p.x * p.x + p.y); };
    EXPECT_EQ(second_difference(bowl, x), 10);
    EXPECT_EQ(second_difference(bowl, y), 0);
    // The rows beside count half as much.
    const auto one = [](ivec2 at) { return [=](ivec2 p) { return p == at ? 1.0f : 0.0f; }; };
    EXPECT_EQ(second_difference(one({0, 0}), x), -1);
    EXPECT_EQ(second_difference(one({1, 0}), x), 0.5f);
    EXPECT_EQ(second_difference(one({1, 1}), x), 0.25f);
    EXPECT_EQ(second_difference(one({0, 1}), x), -0.5f);
    EXPECT_EQ(second_difference(one({0, 1}), y), 0.5f);
}

TEST(Toon, Eq7_13_IsTheDifferenceAtAnEdge) {
    const ivec2 x(1, 0), y(0, 1);
    const vec3 left(1, 0, 0), right(0, 0, 1);
    const auto edge = [&](ivec2 p) { return p.x <= 0 ? left : right; };
    EXPECT_EQ(sobel(edge, x), right - left);
    EXPECT_EQ(sobel(edge, y), vec3(0));
    EXPECT_FLOAT_EQ(glm::length(sobel(edge, x)), std::sqrt(2.0f));  // 2 sin(90 / 2)
    EXPECT_EQ(sobel([](ivec2) { return vec3(1, 2, 3); }, x), vec3(0));
    const auto row = [&](ivec2 p) { return p.y < 0 ? left : right; };
    EXPECT_EQ(sobel(row, y), right - left);
    const auto one = [](ivec2 p) { return vec3(p == ivec2(1, -1) ? 1.0f : 0.0f); };
    EXPECT_EQ(sobel(one, x), vec3(0.25f));
    EXPECT_EQ(sobel(one, y), vec3(-0.25f));
}

TEST(Toon, Eq7_14_LinesAreAsWideAsAsked) {
    const ivec2 size(40, 30);
    for (const auto& [width, expected] :
         {std::pair{0.0f, 0}, {0.5f, 2}, {1.0f, 2}, {2.0f, 2}, {3.0f, 4}, {4.0f, 4}, {7.5f, 8}}) {
        // A step in depth; paper beside a body; a sharp edge.
        ByHand step = ByHand::of(size, [](ivec2 p) { return p.x < 17 ? 5.0f : 6.0f; });
        ByHand border = ByHand::of(
            size, [](ivec2 p) { return p.x < 17 ? 5.0f : std::numeric_limits<float>::infinity(); });
        ByHand fold = ByHand::of(size, [](ivec2) { return 5.0f; });
        for (ivec2 p(0); p.y < size.y; ++p.y)
            for (p.x = 17; p.x < size.x; ++p.x) fold.normals[p] = vec3(1, 0, 0);
        for (ByHand* picture : {&step, &border, &fold}) {
            const Image<char> inked = picture->edges(width);
            EXPECT_EQ(ones(inked), expected * size.y) << width;
            for (int y = 0; y < size.y; ++y)
                for (int x = 17 - expected / 2; x < 17 + expected / 2; ++x)
                    ASSERT_TRUE((inked[{x, y}])) << width << ": " << x << ", " << y;
        }
    }
}

TEST(Toon, Eq7_14_Thresholds) {
    const ivec2 size(12, 9);
    const auto step_of = [&](float farther) {
        return ByHand::of(size, [=](ivec2 p) { return p.x < 6 ? 10.0f : farther; });
    };
    // From 10 to 10.3: 3% nearer and farther.
    EXPECT_EQ(ones(step_of(10.3f).edges(2, {0.02f, 9})), 2 * size.y);
    EXPECT_EQ(ones(step_of(10.3f).edges(2, {0.04f, 9})), 0);
    // The worked examples; and between them a step that is above 2% only as seen from behind it.
    EXPECT_EQ(ones(step_of(10.5f).edges(2)), 2 * size.y);
    EXPECT_EQ(ones(step_of(10.202f).edges(2)), size.y);
    EXPECT_EQ(ones(step_of(10.1f).edges(2)), 0);
    ByHand rows = ByHand::of(size, [](ivec2 p) { return p.y < 4 ? 10.0f : 10.5f; });
    EXPECT_EQ(ones(rows.edges(2)), 2 * size.x);
    // Normals 20 and 40 degrees apart: 0.35 and 0.68.
    for (const auto& [degrees, expected] : {std::pair{20.0f, 0}, {40.0f, 2 * size.y}}) {
        ByHand fold = step_of(10);
        for (ivec2 p(0); p.y < size.y; ++p.y)
            for (p.x = 6; p.x < size.x; ++p.x)
                fold.normals[p] = {std::sin(glm::radians(degrees)), 0,
                                   std::cos(glm::radians(degrees))};
        EXPECT_EQ(ones(fold.edges(2)), expected) << degrees;
    }
}

TEST(Toon, Eq7_14_PicturesThatAreTooSmall) {
    for (const ivec2 size : {ivec2(1, 1), ivec2(2, 40), ivec2(40, 2), ivec2(0, 0), ivec2(4, 4)}) {
        ByHand picture = ByHand::of(size, [](ivec2 p) { return (p.x + p.y) % 2 ? 5.0f : 50.0f; });
        EXPECT_EQ(ones(picture.edges(4)), 0);  // reaches two pixels to each side
    }
    ByHand least = ByHand::of({5, 5}, [](ivec2 p) { return p.x < 2 ? 5.0f : 50.0f; });
    EXPECT_GT(ones(least.edges(4)), 0);
}

TEST(Toon, HardCase_SteepPlanesHaveNoEdges) {
    look_up("Eq. 7.12");
    Scene floor = load_obj(models / "floor_checker.obj");
    int steep = 0, on_floor = 0;
    for (const float pitch : {0.5f, 1.0f, 2.0f, 5.0f, 20.0f, 90.0f})
        for (const float yaw : {0.0f, -30.0f}) {
            lesson::Options options = small_toon();
            options.size = {640, 360};
            options.orbit = {yaw, pitch, 0.3f, 36};
            options.shading.outline = Outline::none;
            const Image<Seen> bare = seen_in(toon_picture(floor, options));
            options.shading.outline = Outline::edges;
            options.shading.outline_width_px = 2;
            const Image<vec3> picture = toon_picture(floor, options);
            int inked = 0;
            for (ivec2 p(0); p.y < picture.size().y; ++p.y)
                for (p.x = 0; p.x < picture.size().x; ++p.x)
                    if (bare[p] == Seen::body && !is_near_paper(bare, p, 2)) {
                        ++on_floor;
                        inked += picture[p] == ink;
                    }
            EXPECT_EQ(inked, 0) << pitch << ", " << yaw;
        }
    EXPECT_GT(on_floor, 500'000);
    // The first difference would ink them: seen so flat, a pixel farther is more than 2% farther.
    const auto near_at = [](ivec2 p) { return 1.0f / 50 + 0.001f * static_cast<float>(p.y); };
    const auto as_vector = [&](ivec2 p) { return vec3(near_at(p), 0, 0); };
    steep += sobel(as_vector, {0, 1}).x > 0.02f * near_at(ivec2(0));
    steep += second_difference(near_at, {0, 1}) > 0.02f * near_at(ivec2(0));
    EXPECT_EQ(steep, 1);
}

TEST(Toon, HardCase_EdgesAreAsWideAtAnyDistanceAndSize) {
    look_up("Eq. 7.14");
    const Scene cube = scene_of_one(cube_mesh(true));
    for (const ivec2 size : {ivec2(320, 180), ivec2(640, 360)})
        for (const float distance : {2.5f, 5.0f})
            for (const float width : {2.0f, 6.0f}) {
                lesson::Options options;
                options.size = size;
                options.orbit = {0, 0, distance, 36};  // one face, straight ahead
                options.shading.outline = Outline::none;
                const Image<Seen> bare = seen_in(toon_picture(cube, options));
                options.shading.outline = Outline::edges;
                options.shading.outline_width_px = width;
                const Image<Seen> seen = seen_in(toon_picture(cube, options));
                const double side = std::sqrt(count_of(bare, Seen::body));
                // A frame, half of it on either side; its outer corners may be cut off.
                const double frame =
                    (side + width) * (side + width) - (side - width) * (side - width);
                EXPECT_NEAR(count_of(seen, Seen::ink), frame, width * width + side / 20)
                    << size.x << ", " << distance << ", " << width;
                EXPECT_EQ(gaps_in_outline(seen), 0);
            }
}
