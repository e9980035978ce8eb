// SPDX-License-Identifier: MIT
// Zeros, denormals, infinities and NaN at the entry: what of them reaches a pixel.
#include <array>
#include <cfloat>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "04_mvp/transform.hpp"
#include "support/look_up.hpp"
#include "support/printers.hpp"
#include "support/special_numbers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

using Vertices = std::array<vec4, 3>;

constexpr float tiny = std::numeric_limits<float>::denorm_min();
constexpr int many_cases = 1'000'000;

/// Ordinary numbers from -2 to 2, and so often in place of one a special one.
class Mix {
  public:
    explicit Mix(unsigned seed) : random_(seed) {}

    /// From now on one number in so many is special.
    void set_rarity(unsigned rarity) { rarity_ = rarity; }
    float number() {
        const float sign = random_() & 1 ? 1.0f : -1.0f;
        if (random_() % rarity_ == 0) return sign * special[random_() % std::size(special)];
        return 2 * sign * static_cast<float>(random_() >> 8) * 0x1p-24f;
    }
    vec3 vector() {
        const float x = number(), y = number(), z = number();
        return {x, y, z};
    }
    vec4 homogeneous() {
        const vec3 v = vector();
        return {v, number()};
    }
    mat4 matrix() {
        const vec4 x = homogeneous(), y = homogeneous(), z = homogeneous();
        return {x, y, z, homogeneous()};
    }
    /// One of the special numbers, or an ordinary one, in (least, most).
    float between(float least, float most) {
        for (;;)
            if (const float x = std::abs(number()); x > least && x < most) return x;
    }

  private:
    static constexpr float special[] = {0,
                                        tiny,
                                        3 * tiny,
                                        1e-40f,
                                        FLT_MIN,
                                        1e-30f,
                                        FLT_EPSILON,
                                        0.5f,
                                        1,
                                        1 + FLT_EPSILON,
                                        0x1p24f,
                                        1e30f,
                                        0x1.fffffep124f,  // the greatest below clip_limit
                                        0x1p125f,
                                        FLT_MAX / 16,
                                        0x1.fffffep126f,
                                        FLT_MAX,
                                        infinity,
                                        not_a_number};
    std::mt19937 random_;
    unsigned rarity_ = 1;
};

/// For EXPECT_TRUE: no number but those from `least` to `most`.
template <typename Vector>
testing::AssertionResult are_within(const char* what, const Vector& v, float least, float most) {
    for (int i = 0; i < v.length(); ++i)
        if (!(v[i] >= least && v[i] <= most))  // also for NaN
            return testing::AssertionFailure() << what << " " << testing::PrintToString(v);
    return testing::AssertionSuccess();
}

/// Draws triangles as the lesson does, and looks at everything on its way to the pixels.
class Drawing {
  public:
    /// For EXPECT_TRUE: all that came to a pixel was finite and in its range.
    testing::AssertionResult draw(const Vertices& vertices) {
        testing::AssertionResult result = testing::AssertionSuccess();
        const auto check = [&result](const testing::AssertionResult& next) {
            if (result && !next) result = next;
        };
        for (const ClippedTriangle& part : clip_triangle(vertices)) {
            ++parts;
            std::array<vec3, 3> screen;
            for (std::size_t i = 0; i < 3; ++i) {
                const vec4 p = part[i].position_clip;
                check(are_within("a vertex in clip space", p, -p.w, p.w));
                check(are_within("a vertex's z", vec2(p.z), 0, p.w));
                check(are_within("a vertex's w", vec2(p.w), 0, 2 * clip_limit));
                check(are_within("a vertex's barycentrics", part[i].barycentrics, 0,
                                 1 + of_barycentrics));
                screen[i] = screen_from_clip(p, size);
            }
            const ScreenTriangle on_screen = snap_triangle(screen[0], screen[1], screen[2]);
            if (on_screen.twice_area == 0) continue;
            for (const vec3 vertex : screen) {
                check(are_within("a depth", vec2(vertex.z), 0, 1));
                check(are_within("a place", vec2(vertex) / vec2(size), 0, 1));
            }
            const TriangleDepth depth(vec3(screen[0].z, screen[1].z, screen[2].z));
            fill_triangle(on_screen, size, [&](ivec2 pixel, vec3 barycentrics) {
                ++pixels;
                check(are_within("a pixel's barycentrics", barycentrics, 0, 1 + of_pixels));
                const float here = depth.at(barycentrics);
                check(are_within("a pixel's depth", vec2(here), 0, 1 + 2 * of_pixels));
                depths_.test_and_write(pixel, here);
            });
        }
        if (!result) result << "\nof the triangle " << testing::PrintToString(vertices);
        return result;
    }

    /// For EXPECT_TRUE: what the depth buffer keeps are depths.
    testing::AssertionResult keeps_depths() const {
        for (const float depth : depths_.depths().pixels())
            if (const auto is_one = are_within("kept: ", vec2(depth), 0, 1); !is_one) return is_one;
        return testing::AssertionSuccess();
    }

    static constexpr ivec2 size{4, 3};
    int parts = 0, pixels = 0;

  private:
    /// Each of six crossings rounds its shares by 1 eps, a product and a sum by half of one each.
    static constexpr float of_barycentrics = 6 * 2 * FLT_EPSILON;
    /// fill_triangle promises 2 ulp; a product and three sums then make up to twice that much.
    static constexpr float of_pixels = 2 * FLT_EPSILON;

    DepthBuffer depths_{size};
};

}  // namespace

TEST(Mvp, HardCase_SpecialNumbersInVerticesReachNoPixel) {
    look_up("Eq. 4.13: what counts as outside, and what rounding leaves there");
    Mix mix(1);
    Drawing drawing;
    for (int i = 0; i < many_cases; ++i) {
        mix.set_rarity(static_cast<unsigned>(i % 8 + 1));
        Vertices vertices;
        for (vec4& vertex : vertices) vertex = mix.homogeneous();
        ASSERT_TRUE(drawing.draw(vertices)) << "seed 1, case " << i;
    }
    EXPECT_TRUE(drawing.keeps_depths());
    EXPECT_GT(drawing.parts, many_cases / 10);
    EXPECT_GT(drawing.pixels, many_cases / 10);
}

TEST(Mvp, HardCase_SpecialNumbersBeforeTheCameraReachNoPixel) {
    look_up("Eq. 4.5, 4.8 and 4.13");
    Mix mix(2);
    Drawing drawing;
    int culled = 0;
    for (int i = 0; i < many_cases; ++i) {
        mix.set_rarity(static_cast<unsigned>(i % 8 + 1));
        const vec3 eye = mix.vector(), center = mix.vector();
        const mat4 view_from_world = look_at(eye, center, mix.vector());
        constexpr float one = 1 + 4 * FLT_EPSILON;  // as look_at promises
        for (int axis = 0; axis < 3; ++axis)
            ASSERT_TRUE(are_within("an axis", mat3(view_from_world)[axis], -one, one))
                << "seed 2, case " << i;
        // What perspective() takes: a field of view in (0, pi), near > 0.
        const float fov_radians = mix.between(0, 3.1415925f), aspect = mix.between(0, infinity);
        const mat4 clip_from_view = perspective(fov_radians, aspect, mix.between(0, FLT_MAX));
        const mat4 world_from_model = i % 4 < 2 ? mat4(1) : mix.matrix();
        const mat4 clip_from_world = clip_from_view * view_from_world * world_from_model;
        const std::vector<vec4> clip =
            transform(clip_from_world, {mix.vector(), mix.vector(), mix.vector()});
        ASSERT_TRUE(drawing.draw({clip[0], clip[1], clip[2]})) << "seed 2, case " << i;
        culled += is_outside_frustum({mix.vector(), mix.vector()}, clip_from_world);
    }
    EXPECT_TRUE(drawing.keeps_depths());
    EXPECT_GT(drawing.parts, many_cases / 100);
    EXPECT_GT(drawing.pixels, many_cases / 100);
    EXPECT_GT(culled, many_cases / 100);
}

TEST(Mvp, HardCase_NotANumberInAVertexLeavesNothing) {
    look_up("Eq. 4.13, and what counts as outside");
    constexpr Vertices all_inside = {
        {{-0.5f, -0.25f, 0.5f, 1}, {0.5f, -1, 0.25f, 1.5f}, {0, 2, 3, 3}}};
    const auto parts_of = [](const Vertices& vertices) {
        const ClippedTriangles parts = clip_triangle(vertices);
        return parts.end() - parts.begin();
    };
    EXPECT_EQ(parts_of(all_inside), 1);
    for (const float bad : {not_a_number, infinity, -infinity, clip_limit, -0x1p126f})
        for (std::size_t i = 0; i < 3; ++i)
            for (int axis = 0; axis < 4; ++axis) {
                Vertices vertices = all_inside;
                vertices[i][axis] = bad;
                EXPECT_EQ(parts_of(vertices), 0) << bad << ", vertex " << i << ", axis " << axis;
            }
}

TEST(Mvp, HardCase_NormalMatrixOfSpecialNumbersIsFinite) {
    look_up("Eq. 4.15: there is no division in it");
    Mix mix(3);
    for (int i = 0; i < many_cases / 10; ++i) {
        mix.set_rarity(static_cast<unsigned>(i % 8 + 1));
        mat3 m;
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row)  // 2^63: the difference of two products is finite
                m[column][row] = mix.between(-1, 0x1p63f) * (mix.number() < 0 ? -1.0f : 1.0f);
        for (int column = 0; column < 3; ++column)
            ASSERT_TRUE(are_within("a column", normal_matrix(m)[column], -FLT_MAX, FLT_MAX))
                << "seed 3, case " << i;
    }
}
