// SPDX-License-Identifier: MIT
// Vertex attributes inside a triangle, in perspective; textures:
// 05_textures_sampling_test.cpp and 05_textures_files_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "02_triangle_fill/triangle.hpp"
#include "04_mvp/clip.hpp"
#include "05_textures/interpolation.hpp"
#include "support/any_size.hpp"
#include "support/cases.hpp"
#include "support/exact.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/printers.hpp"
#include "support/projected.hpp"
#include "support/reference.hpp"
#include "support/special_numbers.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr ivec2 small(64, 48);

/// The vertices of a triangle that is not clipped. Of their positions only w counts.
ClippedTriangle whole(vec3 w) {
    return {
        {{{0, 0, 0, w.x}, {1, 0, 0}}, {{0, 0, 0, w.y}, {0, 1, 0}}, {{0, 0, 0, w.z}, {0, 0, 1}}}};
}

/// A right angle in the picture's upper left corner, with sides of 8 pixels: the second vertex's
/// barycentric coordinate is y / 8, the third one's x / 8.
const ScreenTriangle eighths = snap_triangle({0, 0}, {0, 8}, {8, 0});

/// Twice the areas on the screen that belong to the vertices.
std::array<int128, 3> areas(const ScreenTriangle& triangle, ivec2 pixel) {
    const auto [a, b, c] = triangle.vertices;
    const ivec2 p = exact_center(pixel);
    return {exact_twice_area(b, c, p), exact_twice_area(c, a, p), exact_twice_area(a, b, p)};
}

struct ExactBarycentrics {
    lvec3 here;
    std::array<lvec3, 2> step;      ///< Per pixel to the right, and down.
    std::array<lvec3, 2> of_sizes;  ///< What the steps would be if nothing in them cancelled.
};

real sum_of(lvec3 v) { return v.x + v.y + v.z; }

/// The oracle for Eq. 5.2, 5.3 and 5.7: of the triangle and the piece as they are given.
ExactBarycentrics exact_barycentrics(const ScreenTriangle& on_screen, const ClippedTriangle& piece,
                                     ivec2 pixel) {
    const auto here = areas(on_screen, pixel);
    const auto area = static_cast<real>(on_screen.twice_area);
    lvec3 numerators(0);
    std::array<lvec3, 2> steps{}, sizes{};
    for (std::size_t k = 0; k < 3; ++k) {
        const lvec3 over_w = lvec3(piece[k].barycentrics) / real{piece[k].position_clip.w};
        numerators += static_cast<real>(here[k]) / area * over_w;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const auto next = areas(on_screen, pixel + ivec2(axis == 0, axis == 1));
            const real step = static_cast<real>(next[k] - here[k]) / area;
            steps[axis] += step * over_w, sizes[axis] += std::abs(step) * over_w;
        }
    }
    const real sum = sum_of(numerators);
    ExactBarycentrics exact{numerators / sum, {}, {}};
    for (std::size_t axis = 0; axis < 2; ++axis) {
        exact.step[axis] = (steps[axis] - exact.here * sum_of(steps[axis])) / sum;
        exact.of_sizes[axis] = (sizes[axis] + exact.here * sum_of(sizes[axis])) / sum;
    }
    return exact;
}

/// How many eps a coordinate may be off, and a derivative in proportion to its terms' sizes.
struct Tolerance {
    real coordinate, step;
};

/// fill_triangle's barycentrics are within 2 ulp, which is up to 2 eps of them; a quotient and a
/// product make 3 eps of a share, two sums 4 of all, a quotient and a product 8 of a coordinate.
/// What shares change by has 1.5, their sum 2.5; times a coordinate 11, and the difference 11.5.
/// The sum that divides it, the quotient and the product make that less than 17.
constexpr Tolerance of_whole = {8, 17};

/// A piece's share has another product and two sums: 4.5 eps, 5.5 all of them, 11 a coordinate.
/// What its shares change by has 3, their sum 4; times a coordinate 15.5, the difference 16;
/// and 6.5.
constexpr Tolerance of_piece = {11, 23};

/// Whether derivatives are compared, too, of Eq. 5.7.
enum class Compared { coordinates, derivatives_too };

/// For EXPECT_TRUE: each component within its tolerance.
testing::AssertionResult are_near(const char* name, vec3 actual, lvec3 exact, lvec3 tolerance) {
    for (int i = 0; i < 3; ++i)
        if (const auto result = is_near(actual[i], exact[i], tolerance[i]); !result)
            return testing::AssertionFailure()
                   << name << " = " << shown(actual) << " instead of " << shown(vec3(exact)) << "; "
                   << name << "[" << i << "] is " << result.message();
    return testing::AssertionSuccess();
}

/// For EXPECT_TRUE: barycentrics that are those of the oracle, and whose sum is 1.
testing::AssertionResult are_near(const FragmentBarycentrics& at, const ExactBarycentrics& exact,
                                  Tolerance tolerance, Compared compared) {
    // The sum: two sums, a quotient and a product, half an eps each.
    auto result = is_near(sum_of(lvec3(at.here)), 1, 2 * eps) << " is the sum";
    if (result)
        result = are_near("here", at.here, exact.here, tolerance.coordinate * eps * exact.here);
    if (!result || compared == Compared::coordinates) return result;
    const auto of_step = [&](std::size_t axis) {
        return tolerance.step * eps * exact.of_sizes[axis];
    };
    result = are_near("ddx", at.ddx, exact.step[0], of_step(0));
    return result ? are_near("ddy", at.ddy, exact.step[1], of_step(1)) : result;
}

/// Seeded triangles on the screen, seen from the front.
class AnyTriangle {
  public:
    explicit AnyTriangle(unsigned seed) : random_(seed) {}
    float between(float least, float most) {
        return std::uniform_real_distribution<float>(least, most)(random_);
    }
    /// Each order of magnitude as often as the others.
    float of_sizes(float least, float most) {
        return std::exp(between(std::log(least), std::log(most)));
    }
    ScreenTriangle on_screen() {
        for (;;) {
            const auto point = [this] {
                const float x = between(-8, small.x + 8.0f);
                return vec2(x, between(-8, small.y + 8.0f));
            };
            const vec2 a = point(), b = point();
            const ScreenTriangle triangle = snap_triangle(a, b, point());
            if (is_front_facing(triangle)) return triangle;
        }
    }
    /// Three numbers, positive, whose sum is 1 but for rounding.
    vec3 shares() {
        const float x = between(0, 1), y = between(0, 1), z = between(0.01f, 1);
        return vec3(x, y, z) / (x + y + z);
    }

  private:
    std::mt19937 random_;
};

std::string described(const ClippedTriangle& piece) {
    std::string text = "a piece of";
    for (const auto& [position_clip, barycentrics] : piece)
        text += " w = " + shown(position_clip.w) + " at " + shown(barycentrics);
    return text;
}

/// Compares every pixel of a triangle with the oracle.
///
/// @return  How many pixels there were; -1 after a failure.
int compare(const ScreenTriangle& on_screen, const ClippedTriangle& piece, Tolerance tolerance,
            Compared compared = Compared::derivatives_too) {
    const PerspectiveSetup setup = perspective_setup(on_screen, piece);
    int pixels = 0;
    fill_triangle(on_screen, small, [&](ivec2 pixel, vec3 screen_barycentrics) {
        if (pixels < 0) return;
        ++pixels;
        const auto result =
            are_near(perspective_correct(setup, screen_barycentrics),
                     exact_barycentrics(on_screen, piece, pixel), tolerance, compared);
        EXPECT_TRUE(result) << "perspective_correct() in pixel " << testing::PrintToString(pixel)
                            << ", where the barycentric coordinates on the screen are "
                            << shown(screen_barycentrics) << "; " << described(piece);
        if (!result) pixels = -1;
    });
    return pixels;
}

/// The same for pieces with any w.
void compare_pieces(Compared what) {
    AnyTriangle any(6);
    int pixels = 0;
    for (int i = 0; i < cases_of(400); ++i) {
        const float reach = i % 2 ? 1e6f : 10;
        ClippedTriangle piece;
        for (ClippedVertex& vertex : piece)
            vertex = {{0, 0, 0, any.of_sizes(1 / reach, reach)}, any.shares()};
        const int compared = compare(any.on_screen(), piece, of_piece, what);
        ASSERT_GE(compared, 0) << "seed 6, case " << i;
        pixels += compared;
    }
    EXPECT_GT(pixels, cases_of(100'000));
}

}  // namespace

TEST(Textures, Eq5_1_ExampleOfASum) {
    const vec3 barycentrics(0.5f, 0.25f, 0.25f);
    EXPECT_EQ(interpolate(std::array{10.0f, 20.0f, 40.0f}, barycentrics), 20.0f)
        << "with the barycentric coordinates 1/2, 1/4 and 1/4";
    EXPECT_EQ(interpolate(std::array{vec2(0, 0), vec2(1, 0), vec2(1, 1)}, barycentrics),
              vec2(0.5f, 0.25f))
        << "with the barycentric coordinates 1/2, 1/4 and 1/4";
}

TEST(Textures, Eq5_1_SumsOfAllSizes) {
    AnySize any(1, 8);
    for (int i = 0; i < 100'000; ++i) {
        const vec3 vertices = any.vector(), barycentrics = any.vector();
        Sum exact;
        for (int k = 0; k < 3; ++k) exact.add(real{vertices[k]} * barycentrics[k]);
        ASSERT_TRUE(
            is_near(interpolate(std::array{vertices.x, vertices.y, vertices.z}, barycentrics),
                    exact.value, 1.5L * eps * exact.of_sizes))  // a product and two sums
            << "seed 1, case " << i << ": interpolate() of " << shown(vertices.x) << ", "
            << shown(vertices.y) << " and " << shown(vertices.z) << " with " << shown(barycentrics);
    }
}

TEST(Textures, Eq5_2_HalfwayOnTheScreenIsNotHalfwayOnTheSurface) {
    // The middle of a side whose far end is three times as far: a quarter of the way.
    const PerspectiveSetup side = perspective_setup(eighths, whole({1, 1, 3}));
    const vec3 middle = perspective_correct(side, vec3(0.5f, 0, 0.5f)).here;
    constexpr float tolerance = static_cast<float>(of_whole.coordinate * eps);
    EXPECT_TRUE(are_near(middle, {0.75, 0, 0.25}, tolerance)) << "s = (1/2, 0, 1/2), w = 1, 1, 3";
    EXPECT_EQ(middle.y, 0.0f) << "s = (1/2, 0, 1/2), w = 1, 1, 3";
    const PerspectiveSetup setup = perspective_setup(eighths, whole({1, 3, 3}));
    const vec3 inside = perspective_correct(setup, vec3(0.25f, 0.5f, 0.25f)).here;
    EXPECT_TRUE(are_near(inside, {1.0 / 2, 1.0 / 3, 1.0 / 6}, tolerance))
        << "s = (1/4, 1/2, 1/4), w = 1, 3, 3";
}

TEST(Textures, Eq5_2_HardCase_WOfAllOrdersInOneTriangle) {
    AnyTriangle any(3);
    int pixels = 0;
    for (int i = 0; i < 500; ++i) {
        const float reach = i % 2 ? 1e6f : 10;
        const vec3 w(any.of_sizes(1 / reach, reach), any.of_sizes(1 / reach, reach),
                     any.of_sizes(1 / reach, reach));
        const int compared = compare(any.on_screen(), whole(w), of_whole);
        ASSERT_GE(compared, 0) << "seed 3, case " << i << ", w " << testing::PrintToString(w);
        pixels += compared;
    }
    EXPECT_GT(pixels, 100'000);
}

TEST(Textures, HardCase_EqualWLeavesTheBarycentricsOnTheScreen) {
    look_up("Eq. 5.2: what is the same in all shares can be cancelled");
    AnyTriangle any(4);
    for (int i = 0; i < 300; ++i) {
        const vec3 w(any.of_sizes(1e-38f, 1e38f));
        ASSERT_GE(compare(any.on_screen(), whole(w), of_whole), 0) << "seed 4, case " << i;
    }
}

TEST(Textures, HardCase_SubnormalWBesideAHugeOne) {
    look_up("Eq. 5.2: only the proportions of the w count, and those have limits");
    AnyTriangle any(5);
    for (int i = 0; i < 3000; ++i) {
        const int near_vertex = i % 3;
        vec3 w(1e30f);
        w[near_vertex] = i % 2 ? std::numeric_limits<float>::denorm_min() : 1e-40f;
        if (i % 4 < 2) w[(i + 1) % 3] = 1e-30f;
        ClippedTriangle piece = whole(w);
        for (std::size_t k = 0; k < 3 && i % 5 == 0; ++k) piece[k].barycentrics = any.shares();
        ScreenTriangle on_screen = any.on_screen();
        if (i % 16 == 0) on_screen = snap_triangle({-4e6f, -4e6f}, {-4e6f, 4e6f}, {4e6f, 0});
        if (i % 16 == 1) on_screen = snap_triangle({1, 1}, {1, 1 + 1 / 64.0f}, {4, 1 + 1 / 64.0f});
        const PerspectiveSetup setup = perspective_setup(on_screen, piece);
        // On the far side the near vertex's coordinate is 0; else it may be tiny.
        for (const float share : {0.0f, 0x1p-36f, 0x1p-20f, 0.25f}) {
            vec3 s;
            s[near_vertex] = share;
            s[(i + 1) % 3] = any.between(0, 1 - share);
            s[(i + 2) % 3] = 1 - share - s[(i + 1) % 3];
            const FragmentBarycentrics at = perspective_correct(setup, s);
            const auto what = [&] {
                return "; s = " + shown(s) + ", " + described(piece) + "; seed 5";
            };
            ASSERT_TRUE(is_near(sum_of(lvec3(at.here)), 1, 2 * eps)) << "the sum of here" << what();
            ASSERT_GE(std::min({at.here.x, at.here.y, at.here.z}), 0) << "least of here" << what();
            ASSERT_TRUE(is_finite(at.ddx) && is_finite(at.ddy))
                << "ddx = " << shown(at.ddx) << ", ddy = " << shown(at.ddy) << what();
            if (share == 0) continue;
            lvec3 shares(0);
            for (int k = 0; k < 3; ++k)
                shares +=
                    real{s[k]} / w[k] * lvec3(piece[static_cast<std::size_t>(k)].barycentrics);
            const lvec3 exact = shares / sum_of(shares);
            // A w counts as 2^80 times the least one at most.
            ASSERT_TRUE(are_near("here", at.here, exact,
                                 of_piece.coordinate * eps * exact + 0x1p-80L / share))
                << what();
        }
    }
}

TEST(Textures, Eq5_3_PieceOfTheWorkedExample) {
    ClippedTriangle piece = whole({1, 2, 2});
    piece[1].barycentrics = {0.5f, 0.5f, 0};
    piece[2].barycentrics = {0.5f, 0, 0.5f};
    const PerspectiveSetup setup = perspective_setup(eighths, piece);
    const vec3 here = perspective_correct(setup, vec3(0.5f, 0.25f, 0.25f)).here;
    constexpr float tolerance = static_cast<float>(of_piece.coordinate * eps);
    EXPECT_TRUE(are_near(here, {5.0 / 6, 1.0 / 12, 1.0 / 12}, tolerance))
        << "s = (1/2, 1/4, 1/4), " << described(piece);
}

TEST(Textures, Eq5_3_PiecesWithWOfAllSizes) { compare_pieces(Compared::coordinates); }

TEST(Textures, Eq5_3_HardCase_PiecesHaveTheBarycentricsOfTheWholeTriangle) {
    AnyTriangle any(7);
    int pixels = 0;
    for (int i = 0; i < 3000; ++i) {
        std::array<vec4, 3> vertices;
        for (vec4& vertex : vertices) {
            const float x = any.between(-3, 3), y = any.between(-3, 3), z = any.between(-2, 2);
            vertex = {x, y, z, any.between(-1, 3)};
        }
        for (const ClippedTriangle& piece : clip_triangle(vertices)) {
            const ProjectedTriangle on_screen = projected(piece, small);
            if (on_screen.is_back_facing) continue;
            const PerspectiveSetup setup = perspective_setup(on_screen);
            fill_triangle(on_screen.on_screen, small, [&](ivec2 pixel, vec3 screen_barycentrics) {
                // The point of the whole triangle that they stand for lies behind this pixel.
                const vec3 here = perspective_correct(setup, screen_barycentrics).here;
                const vec4 p = interpolate(vertices, here);
                if (p.w < 0.05f) return;  // where clipping's roundings count more
                const vec2 place = (vec2(p.x, -p.y) / p.w + 1.0f) * 0.5f * vec2(small);
                // Pieces are snapped to 1/256 pixel; the rest is rounding.
                ASSERT_TRUE(are_near(place - 0.5f, dvec2(pixel), 0.02))
                    << "where the point of here = " << shown(here)
                    << " is seen, in pixels; seed 7, "
                    << "case " << i << ", " << described(piece);
                ++pixels;
            });
        }
        ASSERT_FALSE(HasFatalFailure());
    }
    EXPECT_GT(pixels, 100'000);
}

TEST(Textures, Eq5_7_DerivativesInTheWorkedExample) {
    const PerspectiveSetup setup = perspective_setup(eighths, whole({1, 1, 3}));
    const FragmentBarycentrics middle = perspective_correct(setup, vec3(0.5f, 0, 0.5f));
    // Shares of 1/2, 0 and 1/6 that change by -1/8, 0 and 1/24 to the right: their sum, 2/3, by
    // -1/12. Downwards by -1/8, 1/8 and 0: their sum not at all.
    constexpr float tolerance = static_cast<float>(of_whole.step * eps * 0.5L);
    EXPECT_TRUE(are_near(middle.ddx, {-3.0 / 32, 0, 3.0 / 32}, tolerance))
        << "ddx at s = (1/2, 0, 1/2), w = 1, 1, 3; a pixel to the right, s changes by (-1/8, 0, "
           "1/8)";
    EXPECT_TRUE(are_near(middle.ddy, {-3.0 / 16, 3.0 / 16, 0}, tolerance))
        << "ddy at s = (1/2, 0, 1/2), w = 1, 1, 3; a pixel down, s changes by (-1/8, 1/8, 0)";
}

TEST(Textures, Eq5_7_DerivativesOfPiecesWithWOfAllSizes) {
    compare_pieces(Compared::derivatives_too);
}
