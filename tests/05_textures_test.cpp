// SPDX-License-Identifier: MIT
// Vertex attributes inside a triangle, in perspective; textures:
// 05_textures_sampling_test.cpp and 05_textures_files_test.cpp.
#include <algorithm>
#include <array>
#include <bit>
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

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

using lvec2 = glm::vec<2, real>;

constexpr ivec2 small(64, 48);

/// The vertices of a triangle that is not clipped. Of their positions only w counts.
ClippedTriangle whole(vec3 w) {
    return {
        {{{0, 0, 0, w.x}, {1, 0, 0}}, {{0, 0, 0, w.y}, {0, 1, 0}}, {{0, 0, 0, w.z}, {0, 0, 1}}}};
}

/// A right angle in the picture's upper left corner, with sides of 8 pixels: the second vertex's
/// barycentric coordinate is y / 8, the third one's x / 8.
const ScreenTriangle eighths = snap_triangle({0, 0}, {0, 8}, {8, 0});

/// A number and how fast it changes: the sum, product and quotient of two keep that exact.
struct Changing {
    real value = 0, change = 0;
    Changing operator+(Changing b) const { return {value + b.value, change + b.change}; }
    Changing operator*(Changing b) const {
        return {value * b.value, change * b.value + value * b.change};
    }
    Changing operator/(Changing b) const {
        return {value / b.value, (change - value / b.value * b.change) / b.value};
    }
};

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

/// The oracle for Eq. 5.2, 5.3 and 5.7: of the triangle and the piece as they are given.
ExactBarycentrics exact_barycentrics(const ScreenTriangle& on_screen, const ClippedTriangle& piece,
                                     ivec2 pixel) {
    ExactBarycentrics exact;
    const auto here = areas(on_screen, pixel);
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const auto next = areas(on_screen, pixel + (axis == 0 ? ivec2(1, 0) : ivec2(0, 1)));
        std::array<Changing, 3> shares;
        lvec3 sizes(0);
        Changing sum;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto area = static_cast<real>(on_screen.twice_area);
            const Changing on_screen_share = {static_cast<real>(here[k]) / area,
                                              static_cast<real>(next[k] - here[k]) / area};
            for (int i = 0; i < 3; ++i) {
                const Changing share =
                    on_screen_share *
                    Changing{piece[k].barycentrics[i] / static_cast<real>(piece[k].position_clip.w),
                             0};
                shares[static_cast<std::size_t>(i)] = shares[static_cast<std::size_t>(i)] + share;
                sum = sum + share;
                sizes[i] += std::abs(share.change);
            }
        }
        for (int i = 0; i < 3; ++i) {
            const Changing coordinate = shares[static_cast<std::size_t>(i)] / sum;
            exact.here[i] = coordinate.value;
            exact.step[axis][i] = coordinate.change;
            exact.of_sizes[axis][i] =
                (sizes[i] + coordinate.value * (sizes.x + sizes.y + sizes.z)) / sum.value;
        }
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

/// For EXPECT_TRUE: barycentrics that are those of the oracle, and whose sum is 1.
testing::AssertionResult are_near(const FragmentBarycentrics& barycentrics,
                                  const ExactBarycentrics& exact, Tolerance tolerance,
                                  Compared compared) {
    const auto failure = [] { return testing::AssertionFailure(); };
    const auto in_full = [](const char* name, vec3 actual, lvec3 expected) {
        return std::string("; ") + name + " = " + shown(actual) + " instead of " +
               shown(vec3(expected));
    };
    for (int i = 0; i < 3; ++i) {
        const auto here = is_near(barycentrics.here[i], exact.here[i],
                                  tolerance.coordinate * eps * exact.here[i]);
        if (!here)
            return failure() << "here[" << i << "] is " << here.message()
                             << in_full("here", barycentrics.here, exact.here);
        if (compared == Compared::coordinates) continue;
        const vec3 steps[] = {barycentrics.ddx, barycentrics.ddy};
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const auto step = is_near(steps[axis][i], exact.step[axis][i],
                                      tolerance.step * eps * exact.of_sizes[axis][i]);
            if (!step)
                return failure() << "dd" << "xy"[axis] << "[" << i << "] is " << step.message()
                                 << in_full(axis == 0 ? "ddx" : "ddy", steps[axis],
                                            exact.step[axis])
                                 << in_full("here", barycentrics.here, exact.here);
        }
    }
    return is_near(real{barycentrics.here.x} + barycentrics.here.y + barycentrics.here.z, 1,
                   2 * eps)
           << " is the sum";  // two sums, a quotient and a product, half an eps each
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

/// The piece's w, and what it has of the whole triangle, if it was cut.
std::string described(const ClippedTriangle& piece) {
    std::string text = "w = ", cut;
    for (const ClippedVertex& vertex : piece) {
        text += (&vertex == &piece[0] ? "" : ", ") + shown(vertex.position_clip.w);
        cut += (&vertex == &piece[0] ? "" : ", ") + shown(vertex.barycentrics);
    }
    const bool is_whole = piece[0].barycentrics == vec3(1, 0, 0) &&
                          piece[1].barycentrics == vec3(0, 1, 0) &&
                          piece[2].barycentrics == vec3(0, 0, 1);
    return text + (is_whole ? " (not cut)" : "; a piece whose vertices have " + cut);
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
    const std::array vertices = {vec3(1, 2, 3), vec3(4, 5, 6), vec3(7, 8, 10)};
    for (int i = 0; i < 3; ++i) {
        vec3 only(0);
        only[i] = 1;
        EXPECT_EQ(interpolate(vertices, only), vertices[static_cast<std::size_t>(i)])
            << "with the barycentric coordinates " << shown(only);
    }
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

TEST(Textures, Eq5_2_VerticesKeepTheirOwn) {
    AnyTriangle any(2);
    for (int i = 0; i < 1000; ++i) {
        const vec3 w(any.of_sizes(1e-6f, 1e6f), any.of_sizes(1e-6f, 1e6f),
                     any.of_sizes(1e-6f, 1e6f));
        const PerspectiveSetup setup = perspective_setup(any.on_screen(), whole(w));
        for (int vertex = 0; vertex < 3; ++vertex) {
            vec3 only(0);
            only[vertex] = 1;
            ASSERT_TRUE(are_near(perspective_correct(setup, only).here, dvec3(only),
                                 static_cast<double>(eps)))
                << "seed 2, case " << i << ": s = " << shown(only) << ", w = " << shown(w);
        }
    }
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
        const float w = any.of_sizes(1e-38f, 1e38f);
        const ScreenTriangle on_screen = any.on_screen();
        const PerspectiveSetup setup = perspective_setup(on_screen, whole(vec3(w)));
        fill_triangle(on_screen, small, [&](ivec2, vec3 screen_barycentrics) {
            const vec3 here = perspective_correct(setup, screen_barycentrics).here;
            // The sum of fill_triangle's barycentrics is 1 within 2 eps; two sums, a quotient, a
            // product.
            for (int k = 0; k < 3; ++k)
                ASSERT_NEAR(here[k], screen_barycentrics[k],
                            static_cast<float>(4 * eps) * screen_barycentrics[k])
                    << "here[" << k << "]; seed 4, case " << i
                    << ": s = " << shown(screen_barycentrics) << ", all w = " << shown(w);
        });
    }
}

TEST(Textures, HardCase_SubnormalWBesideAHugeOne) {
    look_up("Eq. 5.2: only the proportions of the w count, and those have limits");
    constexpr float tiny = std::numeric_limits<float>::denorm_min();
    AnyTriangle any(5);
    int on_far_side = 0;
    for (int i = 0; i < 300; ++i) {
        vec3 w(1e30f);
        w[i % 3] = i % 2 ? tiny : 1e-40f;
        if (i % 4 < 2) w[(i + 1) % 3] = 1e-30f;
        // The far side through the centres of pixels: there the near vertex's coordinate is 0.
        const float row = std::floor(any.between(0, 47)) + 0.5f;
        std::array<vec2, 3> vertices = {vec2(1, row), vec2(60, row),
                                        vec2(any.between(0, 64), row - 8)};
        std::rotate(vertices.begin(), vertices.begin() + (5 - i % 3) % 3, vertices.end());
        const ScreenTriangle on_screen = snap_triangle(vertices[0], vertices[1], vertices[2]);
        ASSERT_TRUE(is_front_facing(on_screen));
        const PerspectiveSetup setup = perspective_setup(on_screen, whole(w));
        const auto check = [&](ivec2 pixel, vec3 screen_barycentrics) {
            const std::string what = "case " + std::to_string(i) +
                                     ": s = " + shown(screen_barycentrics) + ", w = " + shown(w);
            const FragmentBarycentrics barycentrics =
                perspective_correct(setup, screen_barycentrics);
            ASSERT_TRUE(is_near(
                real{barycentrics.here.x} + barycentrics.here.y + barycentrics.here.z, 1, 2 * eps))
                << "the sum of here; " << what;
            for (int k = 0; k < 3; ++k) {
                ASSERT_GE(barycentrics.here[k], 0) << "here[" << k << "]; " << what;
                ASSERT_TRUE(std::isfinite(barycentrics.ddx[k]) &&
                            std::isfinite(barycentrics.ddy[k]))
                    << "ddx = " << shown(barycentrics.ddx) << ", ddy = " << shown(barycentrics.ddy)
                    << "; " << what;
            }
            const real near_coordinate = screen_barycentrics[i % 3];
            if (near_coordinate == 0) {
                ++on_far_side;
                return;
            }
            const ExactBarycentrics exact = exact_barycentrics(on_screen, whole(w), pixel);
            for (int k = 0; k < 3; ++k)  // a w counts as 2^80 times the least one at most
                ASSERT_TRUE(
                    is_near(barycentrics.here[k], exact.here[k],
                            of_whole.coordinate * eps * exact.here[k] + 0x1p-80L / near_coordinate))
                    << "here[" << k << "]; " << what;
        };
        fill_triangle(on_screen, small, check);
        ASSERT_FALSE(HasFatalFailure());
        // Centres on a lower side belong to the triangle below; here they are asked for.
        for (int x = 1; x < 60 && !HasFatalFailure(); ++x) {
            const auto here = areas(on_screen, {x, static_cast<int>(row)});
            vec3 screen_barycentrics;
            for (int k = 0; k < 3; ++k)
                screen_barycentrics[k] =
                    static_cast<float>(static_cast<double>(here[static_cast<std::size_t>(k)]) /
                                       static_cast<double>(on_screen.twice_area));
            check({x, static_cast<int>(row)}, screen_barycentrics);
        }
    }
    EXPECT_GT(on_far_side, 10'000);
}

TEST(Textures, HardCase_FloorFromOneToAHundredIsRightToA256thOfATexel) {
    look_up("Eq. 5.2");
    constexpr int texels = 1024, width = 512;
    const ScreenTriangle on_screen = snap_triangle({0, 0}, {0, width}, {width, 0});
    const PerspectiveSetup setup = perspective_setup(on_screen, whole({1, 1, 100}));
    double greatest = 0, greatest_affine = 0;
    int pixels = 0;
    fill_triangle(on_screen, {width, 1}, [&](ivec2 pixel, vec3 screen_barycentrics) {
        const std::array us = {0.0f, 0.0f, 1.0f};
        const double along = (pixel.x + 0.5) / width;
        const double exact = along / 100 / (1 - along + along / 100);
        const auto error = [&](vec3 barycentrics) {
            return texels * std::abs(double{interpolate(us, barycentrics)} - exact);
        };
        greatest = std::max(greatest, error(perspective_correct(setup, screen_barycentrics).here));
        greatest_affine = std::max(greatest_affine, error(screen_barycentrics));
        ++pixels;
    });
    EXPECT_LE(greatest, 1.0 / 256);
    EXPECT_GT(greatest_affine, 830) << "barycentrics on the screen alone are far off";
    EXPECT_GE(pixels, width - 1);
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

namespace {

/// The barycentrics of a triangle's vertices where the ray through a place in NDC meets its plane:
/// no clipping, no division by a vertex's w.
lvec3 barycentrics_of_whole(const std::array<vec4, 3>& vertices, lvec2 place_ndc) {
    std::array<lvec3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = {vertices[i].x, vertices[i].y, vertices[i].w};
    const lvec3 ray(place_ndc, 1);
    const lvec3 shares(glm::dot(ray, glm::cross(p[1], p[2])), glm::dot(ray, glm::cross(p[2], p[0])),
                       glm::dot(ray, glm::cross(p[0], p[1])));
    return shares / (shares.x + shares.y + shares.z);
}

/// How far a piece may be from where its vertices' barycentrics say, in pixels: it is snapped to
/// 1/256 pixel, coming to the screen rounds four times, and clipping is off by up to 39 eps of the
/// greatest coordinate, over w (04_mvp_clip_math_test.cpp), in x or y and in w.
real displacement_px(const std::array<vec4, 3>& vertices, const ClippedTriangle& piece) {
    real greatest = 0, least_w = piece[0].position_clip.w;
    for (const vec4 vertex : vertices)
        for (int axis = 0; axis < 4; ++axis)
            greatest = std::max(greatest, std::abs(real{vertex[axis]}));
    for (const ClippedVertex& vertex : piece)
        least_w = std::min(least_w, real{vertex.position_clip.w});
    return 1.0L / 512 + small.x * (2 * eps + 39 * eps * greatest / least_w);
}

}  // namespace

TEST(Textures, Eq5_3_HardCase_PiecesHaveTheBarycentricsOfTheWholeTriangle) {
    AnyTriangle any(7);
    int pixels = 0, sharp = 0, across_near = 0, across_many = 0;
    for (int i = 0; i < 3000; ++i) {
        std::array<vec4, 3> vertices;
        unsigned outside = 0;
        for (vec4& vertex : vertices) {
            const float x = any.between(-3, 3), y = any.between(-3, 3), z = any.between(-2, 2);
            vertex = {x, y, z, any.between(-1, 3)};
            for (int plane = 0; plane < frustum_planes; ++plane)
                outside |= static_cast<unsigned>(plane_distance(plane, vertex) < 0) << plane;
        }
        int visited = 0;
        for (const ClippedTriangle& piece : clip_triangle(vertices)) {
            const auto [mesh, triangle, clipped, on_screen, depth, is_back_facing] =
                projected(piece, small);
            if (is_back_facing) continue;
            const PerspectiveSetup setup = perspective_setup(on_screen, piece);
            const real reach_px = displacement_px(vertices, piece);
            fill_triangle(on_screen, small, [&](ivec2 pixel, vec3 screen_barycentrics) {
                const vec3 here = perspective_correct(setup, screen_barycentrics).here;
                // A quotient of linear functions is greatest and least in the corners of a square.
                lvec3 least(2), most(-2);
                for (int corner = 0; corner < 4; ++corner) {
                    const lvec2 way(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1);
                    const lvec2 place = (lvec2(pixel) + 0.5L + reach_px * way) / lvec2(small);
                    const lvec3 there =
                        barycentrics_of_whole(vertices, {2 * place.x - 1, 1 - 2 * place.y});
                    least = glm::min(least, there), most = glm::max(most, there);
                }
                for (int k = 0; k < 3; ++k) {
                    const real rounding = of_piece.coordinate * eps * std::abs(real{here[k]});
                    ASSERT_TRUE(here[k] >= least[k] - rounding && here[k] <= most[k] + rounding)
                        << "seed 7, case " << i << ", pixel " << testing::PrintToString(pixel)
                        << ": here[" << k << "] is " << here[k] << " instead of from " << least[k]
                        << " to " << most[k] << "; " << described(piece);
                    sharp += most[k] - least[k] < 0.001L;
                }
                ++visited;
            });
        }
        ASSERT_FALSE(HasFatalFailure());
        pixels += visited;
        if (outside >> 4 & 1) across_near += visited;
        if (std::popcount(outside) > 3) across_many += visited;
    }
    EXPECT_GT(pixels, 100'000);
    EXPECT_GT(across_near, 50'000);
    EXPECT_GT(across_many, 50'000);
    EXPECT_GT(sharp, 3 * pixels / 2) << "the tolerance of most barycentrics is below 1/1000";
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

TEST(Textures, Eq5_7_DerivativesLeadToTheNextPixelWhereThereIsNoPerspective) {
    AnyTriangle any(8);
    for (int i = 0; i < 200; ++i) {
        const ScreenTriangle on_screen = any.on_screen();
        const PerspectiveSetup setup = perspective_setup(on_screen, whole(vec3(2)));
        FragmentBarycentrics last{};
        ivec2 last_pixel(-2);
        fill_triangle(on_screen, small, [&](ivec2 pixel, vec3 screen_barycentrics) {
            const FragmentBarycentrics barycentrics =
                perspective_correct(setup, screen_barycentrics);
            const bool is_next = pixel == last_pixel + ivec2(1, 0);
            // Both barycentrics, and the derivative, which is not above 1.
            for (int k = 0; k < 3 && is_next; ++k)
                ASSERT_NEAR(barycentrics.here[k] - last.here[k], last.ddx[k],
                            static_cast<float>((2 * of_whole.coordinate + of_whole.step) * eps) *
                                std::max(1.0f, 2 * std::abs(last.ddx[k])))
                    << "seed 8, case " << i << ", pixel " << testing::PrintToString(pixel)
                    << ": by how much here[" << k << "] grew from the pixel to the left, and ddx["
                    << k << "] there";
            last = barycentrics, last_pixel = pixel;
        });
    }
}
