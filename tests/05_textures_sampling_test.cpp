// SPDX-License-Identifier: MIT
// Which texels a point of a surface sees: wrapping, filters, levels, sRGB.
#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "05_textures/interpolation.hpp"
#include "05_textures/texture.hpp"
#include "support/any_size.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/printers.hpp"
#include "support/reference.hpp"
#include "support/special_numbers.hpp"
#include "support/texture_names.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr float tiny = std::numeric_limits<float>::denorm_min();
constexpr float feps = FLT_EPSILON;

std::string described(const FragmentUv& uv) {
    return "uv " + shown(uv.here) + ", which changes by " + shown(uv.ddx) +
           " to the right and by " + shown(uv.ddy) + " down";
}

/// Both with all digits.
std::string in_full(vec4 actual, vec4 expected) {
    return "in full: " + shown(actual) + " instead of " + shown(expected) + "; ";
}

/// Each texel's colour is its column and row.
Image<vec4> columns_and_rows(ivec2 size) {
    Image<vec4> picture(size);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) picture[{x, y}] = {x, y, 0, 1};
    return picture;
}

Image<vec4> noise(ivec2 size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> any(0, 1);
    Image<vec4> picture(size);
    for (vec4& texel : picture.pixels())
        for (int channel = 0; channel < 4; ++channel) texel[channel] = any(random);
    return picture;
}

/// The texel's column and row; (-1, -1) when the place is not in the picture.
ivec2 texel_at(const TextureLevel& level, vec2 uv, Wrap wrap) {
    const vec2 place = texture_position(uv, wrap);
    const bool is_inside = place.x >= 0 && place.x <= 1 && place.y >= 0 && place.y <= 1;
    return is_inside ? ivec2(vec2(sample_nearest(level, place))) : ivec2(-1);
}

/// The oracle for Eq. 5.4, in texels from the border where the coordinate is 0. Every step is
/// exact: a float times a side has no more than 48 digits, long double 64, and remainders round
/// nothing.
real exactly_wrapped(float coordinate, int side, Wrap wrap) {
    if (std::isnan(coordinate)) return 0;
    if (wrap == Wrap::clamp)
        return std::isinf(coordinate) ? (coordinate > 0 ? side : 0)
                                      : std::clamp(real{coordinate} * side, real{0}, real(side));
    if (std::isinf(coordinate)) return 0;
    const real texels = real{coordinate} * side;
    if (wrap == Wrap::repeat) {
        const real rest = std::fmod(texels, real(side));
        return rest < 0 ? rest + side : rest;
    }
    const real rest = std::fmod(std::abs(texels), 2 * real(side));
    return rest > side ? 2 * side - rest : rest;
}

/// The column in which a u lies, or the row in which a v does: rows are counted from v = 1, where a
/// border belongs to the row below it. Beyond the last one is the last one.
int exact_texel(float coordinate, int side, Wrap wrap, bool is_v) {
    real place = exactly_wrapped(coordinate, side, wrap);
    if (is_v) place = side - place;
    return std::min(static_cast<int>(std::floor(place)), side - 1);
}

/// How far rounding may move a place, in texels: a negative coordinate is brought into the picture
/// with an error of up to eps/4 (mirrored, eps/2), 1 - v makes eps/4 more, and the product eps/2 of
/// itself.
real of_place(float coordinate, int side, bool is_v, real place) {
    return side * ((coordinate < 0 ? eps / 2 : 0) + (is_v ? eps / 4 : 0)) + eps / 2 * place;
}

/// Whether rounding may move the place from texel to texel. It never leaves the picture, so only
/// borders inside count; and whole coordinates are wrapped exactly.
bool is_near_a_border(float coordinate, int side, Wrap wrap, bool is_v) {
    real place = exactly_wrapped(coordinate, side, wrap);
    if (is_v) place = side - place;
    const real border = std::round(place);
    return border > 0 && border < side && coordinate != std::floor(coordinate) &&
           std::abs(place - border) < of_place(coordinate, side, is_v, place);
}

/// Any whole number as the texel that it stands for beyond the picture.
int wrapped_texel(int texel, int side, Wrap wrap) {
    if (wrap == Wrap::clamp) return std::clamp(texel, 0, side - 1);
    const int period = wrap == Wrap::repeat ? side : 2 * side;
    const int rest = (texel % period + period) % period;
    return std::min(rest, period - 1 - rest + (wrap == Wrap::repeat ? period : 0));
}

/// The oracle for Eq. 5.6: wraps each of the four texels, not the place.
glm::vec<4, real> exact_bilinear(const Image<vec4>& picture, vec2 uv, Wrap wrap) {
    const real x = real{uv.x} * picture.size().x - 0.5L;
    const real y = (1 - real{uv.y}) * picture.size().y - 0.5L;
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    glm::vec<4, real> sum(0);
    for (int dy = 0; dy < 2; ++dy)
        for (int dx = 0; dx < 2; ++dx) {
            const ivec2 texel(wrapped_texel(column + dx, picture.size().x, wrap),
                              wrapped_texel(row + dy, picture.size().y, wrap));
            const real share = (dx ? x - column : column + 1 - x) * (dy ? y - row : row + 1 - y);
            sum += share * glm::vec<4, real>(picture[texel]);
        }
    return sum;
}

/// Numbers of all kinds, special ones every so often.
class Mix {
  public:
    explicit Mix(unsigned seed) : random_(seed) {}
    std::size_t below(std::size_t most) { return random_() % most; }
    /// From 0 to 1.
    float share() { return static_cast<float>(random_() >> 8) * 0x1p-24f; }
    float number() {
        static constexpr float special[] = {
            0,           tiny,     3 * tiny, 1e-40f,   FLT_MIN,     1e-30f,         feps,
            0.5f,        1 - feps, 1,        1 + feps, 1e9f,        0x1.fffffep23f, 1e30f,
            FLT_MAX / 2, FLT_MAX,  1e38f,    infinity, not_a_number};
        const float sign = random_() & 1 ? 1.0f : -1.0f;
        return sign * (random_() % 3 == 0 ? special[random_() % std::size(special)] : 3 * share());
    }
    vec2 pair() {
        const float x = number();
        return {x, number()};
    }
    /// One that clip_triangle can give as a w.
    float w() {
        for (;;)
            if (const float w = std::abs(number()); w > 0 && w <= 2 * clip_limit) return w;
    }

  private:
    std::mt19937 random_;
};

/// For EXPECT_TRUE: what a mean of colours from 0 to 1 can be, with a rounding.
testing::AssertionResult is_color(vec4 color) {
    for (int channel = 0; channel < 4; ++channel)
        if (!(color[channel] >= -4 * feps && color[channel] <= 1 + 4 * feps))  // also for NaN
            return testing::AssertionFailure()
                   << testing::PrintToString(color) << " is not a colour from 0 to 1";
    return testing::AssertionSuccess();
}

}  // namespace

TEST(Textures, Eq5_4_AllWrapsOfTheWorkedExample) {
    struct Case {
        float coordinate, repeated, mirrored, clamped;
    };
    for (const auto& [coordinate, repeated, mirrored, clamped] :
         {Case{0.25f, 0.25f, 0.25f, 0.25f}, Case{1.25f, 0.25f, 0.75f, 1},
          Case{2.25f, 0.25f, 0.25f, 1}, Case{-0.25f, 0.75f, 0.25f, 0},
          Case{-1.25f, 0.75f, 0.75f, 0}, Case{0, 0, 0, 0}, Case{1, 0, 1, 1}, Case{2, 0, 0, 1},
          Case{-1, 0, 1, 0}}) {
        EXPECT_EQ(wrapped(coordinate, Wrap::repeat), repeated) << "coordinate " << coordinate;
        EXPECT_EQ(wrapped(coordinate, Wrap::mirror), mirrored) << "coordinate " << coordinate;
        EXPECT_EQ(wrapped(coordinate, Wrap::clamp), clamped) << "coordinate " << coordinate;
    }
}

TEST(Textures, Eq5_4_HardCase_SpecialCoordinatesSeeTheTexelsOfTheOracle) {
    for (const ivec2 size : {ivec2(512), ivec2(1), ivec2(1, 9), ivec2(9, 1), ivec2(3, 5), ivec2(7)})
        for (const Wrap wrap : all_wraps) {
            const TextureLevel level = with_border(columns_and_rows(size), wrap);
            for (const float size_of_it :
                 {0.0f, tiny, FLT_MIN, feps, 0.5f, 1 - feps / 2, 1.0f, 1 + feps, 2 - feps, 2.0f,
                  3.0f, 0x1p23f, 0x1p24f, 1e9f, FLT_MAX, infinity, not_a_number})
                for (const float special : {size_of_it, -size_of_it})
                    for (const float other : {0.25f, special}) {
                        const ivec2 expected(exact_texel(special, size.x, wrap, false),
                                             exact_texel(other, size.y, wrap, true));
                        const auto where = [&](vec2 uv) {
                            return "the texel that uv " + shown(uv) + " sees, " + name_of(wrap) +
                                   ", in " + testing::PrintToString(size) +
                                   " texels; (-1, -1): texture_position() is not in the picture";
                        };
                        ASSERT_EQ(texel_at(level, {special, other}, wrap), expected)
                            << where({special, other});
                        const ivec2 turned(exact_texel(other, size.x, wrap, false),
                                           exact_texel(special, size.y, wrap, true));
                        ASSERT_EQ(texel_at(level, {other, special}, wrap), turned)
                            << where({other, special});
                    }
        }
}

TEST(Textures, HardCase_NotANumberSeesTheTexelAtZero) {
    look_up("Eq. 5.4, and what its comparisons do with NaN");
    for (const Wrap wrap : all_wraps) {
        const TextureLevel level = with_border(columns_and_rows({3, 5}), wrap);
        EXPECT_EQ(wrapped(not_a_number, wrap), 0.0f) << name_of(wrap);
        EXPECT_EQ(texel_at(level, vec2(not_a_number), wrap), ivec2(0, 4))
            << name_of(wrap) << ": the lower left texel of 3 x 5";
        EXPECT_EQ(wrapped(infinity, wrap), wrap == Wrap::clamp ? 1.0f : 0.0f) << name_of(wrap);
        EXPECT_EQ(wrapped(-infinity, wrap), 0.0f) << name_of(wrap);
    }
}

TEST(Textures, Eq5_5_EqualsTheExactOracleForAllSizes) {
    AnySize any(1, 9), any_little(1, 3);
    int left_out = 0;
    for (const int side : {512, 1, 3, 5, 7, 1000}) {
        for (const Wrap wrap : all_wraps) {
            const TextureLevel columns = with_border(columns_and_rows({side, 1}), wrap);
            const TextureLevel rows = with_border(columns_and_rows({1, side}), wrap);
            for (int i = 0; i < cases / 18; ++i) {
                float coordinate = any.number();
                if (i % 2)  // near whole texels
                    coordinate = (std::round(coordinate) + 1e-4f * any_little.number()) /
                                 static_cast<float>(side);
                const auto where = [&](const char* what) {
                    return std::string("the texel, ") + name_of(wrap) + ", of " +
                           std::to_string(side) + " in a row, that is seen at " + what + " = " +
                           shown(coordinate) + "; seed 1, case " + std::to_string(i);
                };
                if (is_near_a_border(coordinate, side, wrap, false))
                    ++left_out;
                else
                    ASSERT_EQ(texel_at(columns, {coordinate, 0.5f}, wrap).x,
                              exact_texel(coordinate, side, wrap, false))
                        << where("u");
                if (is_near_a_border(coordinate, side, wrap, true))
                    ++left_out;
                else
                    ASSERT_EQ(texel_at(rows, {0.5f, coordinate}, wrap).y,
                              exact_texel(coordinate, side, wrap, true))
                        << where("v");
            }
        }
    }
    EXPECT_LT(left_out, cases / 10);
}

TEST(Textures, Eq5_4_WithSidesThatArePowersOfTwoNoCaseIsLeftOut) {
    AnySize any(2, 9);
    for (const int side : {1, 2, 64, 512})
        for (const Wrap wrap : all_wraps) {
            const TextureLevel columns = with_border(columns_and_rows({side, 1}), wrap);
            for (int i = 0; i < 5'000; ++i) {
                // What is not negative is wrapped exactly, and products with powers of two are
                // exact.
                const float u =
                    i % 2 ? any.positive() : std::round(any.positive()) / static_cast<float>(side);
                ASSERT_EQ(texel_at(columns, {u, 0.5f}, wrap).x, exact_texel(u, side, wrap, false))
                    << "the texel, " << name_of(wrap) << ", of " << side
                    << " in a row, that is seen at u = " << shown(u) << "; seed 2";
            }
        }
}

TEST(Textures, Eq5_5_AnExampleInWhichVPointsUpAndRowsDown) {
    const TextureLevel level = with_border(columns_and_rows({4, 2}), Wrap::repeat);
    EXPECT_EQ(texture_position({0.25f, 0.75f}, Wrap::repeat), vec2(0.25f, 0.25f));
    EXPECT_EQ(texture_position({0.25f, 0.25f}, Wrap::repeat), vec2(0.25f, 0.75f));
    EXPECT_EQ(texture_position({0, 0}, Wrap::clamp), vec2(0, 1)) << "the lower left corner";
    EXPECT_EQ(texture_position({1, 1}, Wrap::clamp), vec2(1, 0)) << "the upper right corner";
    EXPECT_EQ(texture_position({1, 0}, Wrap::clamp), vec2(1, 1)) << "the lower right corner";
    const auto texel = [&](vec2 uv, Wrap wrap) { return texel_at(level, uv, wrap); };
    const char* what = "column and row of 4 x 2 texels";
    EXPECT_EQ(texel({0.25f, 0.75f}, Wrap::repeat), ivec2(1, 0)) << what << ", the upper row";
    EXPECT_EQ(texel({0.25f, 0.25f}, Wrap::repeat), ivec2(1, 1)) << what << ", the lower one";
    EXPECT_EQ(texel({0.9f, 0.1f}, Wrap::repeat), ivec2(3, 1)) << what << ", the lower one";
    EXPECT_EQ(texel({0.1f, 0.9f}, Wrap::repeat), ivec2(0, 0)) << what;
    EXPECT_EQ(texel({1, 1}, Wrap::clamp), ivec2(3, 0)) << what;
    EXPECT_EQ(texel({0, 0}, Wrap::clamp), ivec2(0, 1)) << what;
    EXPECT_EQ(texel({1, 0}, Wrap::clamp), ivec2(3, 1)) << what << ": the last texel";
}

TEST(Textures, Eq5_5_CentresOfTexels) {
    for (const ivec2 size : {ivec2(3, 5), ivec2(7), ivec2(1, 9), ivec2(256, 100)}) {
        const TextureLevel level = with_border(columns_and_rows(size), Wrap::repeat);
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const vec2 uv = (vec2(x, size.y - 1 - y) + 0.5f) / vec2(size);
                ASSERT_EQ(texel_at(level, uv, Wrap::repeat), ivec2(x, y))
                    << "the texel of " << testing::PrintToString(size) << " whose centre is at uv "
                    << shown(uv);
            }
    }
}

TEST(Textures, Eq5_6_MeansOfTheWorkedExample) {
    Image<vec4> picture({2, 2});
    picture[{0, 0}] = vec4(0), picture[{1, 0}] = vec4(4);
    picture[{0, 1}] = vec4(8), picture[{1, 1}] = vec4(20);
    const TextureLevel level = with_border(picture, Wrap::clamp);
    ASSERT_EQ(level.texels.size(), ivec2(4, 4)) << "2 x 2 texels and a border of one";
    EXPECT_EQ((level.texels[{1, 2}]), vec4(8)) << "with_border(): texel (0, 1)";
    EXPECT_EQ((level.texels[{3, 2}]), vec4(20)) << "with_border(), clamp: right of texel (1, 1)";
    EXPECT_EQ((with_border(picture, Wrap::mirror).texels[{0, 0}]), vec4(0))
        << "with_border(), mirror: above and left of texel (0, 0) it is once more";
    EXPECT_EQ((with_border(picture, Wrap::repeat).texels[{0, 0}]), vec4(20))
        << "with_border(), repeat: above and left of texel (0, 0) is the last one";
    EXPECT_EQ(sample_bilinear(level, {0.5f, 0.5f}), vec4(8)) << "the mean of all four";
    EXPECT_EQ(sample_bilinear(level, {0.25f, 0.25f}), vec4(0)) << "a centre";
    EXPECT_EQ(sample_bilinear(level, {0.375f, 0.25f}), vec4(1)) << "a quarter of the way";
    // A quarter of the way to the right, half of the way down: 1 and 11.
    EXPECT_EQ(sample_bilinear(level, {0.375f, 0.5f}), vec4(6));
    EXPECT_EQ(sample_bilinear(level, {0, 0}), vec4(0)) << "the border goes on";
    EXPECT_EQ(sample_bilinear(with_border(picture, Wrap::repeat), {0, 0}), vec4(8))
        << "half of the last column and row";
}

TEST(Textures, Eq5_6_HardCase_EqualsTheOracleAlsoAcrossTheSeams) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> any(-3, 3), little(-1, 1);
    for (const ivec2 size : {ivec2(16, 8), ivec2(3, 5), ivec2(1), ivec2(1, 6), ivec2(7, 2)}) {
        const Image<vec4> picture = noise(size, 3);
        for (const Wrap wrap : all_wraps) {
            const TextureLevel level = with_border(picture, wrap);
            for (int i = 0; i < 7'000; ++i) {
                vec2 uv(any(random), any(random));
                if (i % 2)  // within a texel of a seam
                    uv.x = std::round(uv.x) + little(random) / static_cast<float>(size.x);
                if (i % 4 > 1)
                    uv.y = std::round(uv.y) + little(random) / static_cast<float>(size.y);
                const auto exact = exact_bilinear(picture, uv, wrap);
                // The place is off as above, another eps/2 of a side for the half texel that is
                // added. Texels are 0 to 1, so the colour is off by as much; a difference, a
                // product and a sum, each of numbers up to 1, make eps/2 each, twice.
                const real tolerance = of_place(uv.x, size.x, false, size.x) +
                                       of_place(uv.y, size.y, true, size.y) +
                                       eps / 2 * (size.x + size.y + 1) + 6 * eps / 2;
                const vec4 actual = sample_bilinear(level, texture_position(uv, wrap));
                for (int channel = 0; channel < 4; ++channel)
                    ASSERT_TRUE(is_near(actual[channel], exact[channel], tolerance))
                        << "channel " << channel << " of " << testing::PrintToString(size)
                        << " texels, " << name_of(wrap) << ", at uv " << shown(uv)
                        << "; seed 3, case " << i;
            }
        }
    }
}

TEST(Textures, Eq5_6_HardCase_CentresOfTexelsKeepTheirColours) {
    for (const ivec2 size : {ivec2(8, 4), ivec2(64, 1), ivec2(1), ivec2(3, 5), ivec2(7, 100)}) {
        const Image<vec4> picture = noise(size, 4);
        const bool is_exact =
            (size.x & (size.x - 1)) == 0 && (size.y & (size.y - 1)) == 0;  // powers of two
        for (const Wrap wrap : all_wraps) {
            const Texture texture = make_texture(picture, wrap);
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x) {
                    const vec2 uv = (vec2(x, size.y - 1 - y) + 0.5f) / vec2(size);
                    const vec2 texel = 1.0f / vec2(size);
                    // A texel a pixel. The quotient makes eps/2, 1 - v, the product and the half
                    // that is added as much.
                    const float rounding =
                        is_exact ? 0 : 4 * feps / 2 * static_cast<float>(size.x + size.y);
                    for (const Filter filter : all_filters) {
                        const vec4 color =
                            sample(texture, filter, {uv, {texel.x, 0}, {0, texel.y}});
                        for (int channel = 0; channel < 4; ++channel)
                            ASSERT_NEAR(color[channel], (picture[{x, y}][channel]), rounding)
                                << "channel " << channel << " at the centre of texel (" << x << ", "
                                << y << ") of " << testing::PrintToString(size) << ", "
                                << name_of(wrap) << ", filter " << name_of(filter);
                    }
                }
        }
    }
}

TEST(Textures, HardCase_ConstantTextureStaysConstantBitForBit) {
    look_up("Eq. 5.6, 5.9 and 5.10: a + t (b - a) is a where b is a");
    Mix mix(5);
    for (const ivec2 size : {ivec2(1), ivec2(1, 7), ivec2(7, 1), ivec2(3, 5), ivec2(8),
                             ivec2(6, 10), ivec2(31, 2), ivec2(512, 1), ivec2(33, 65)})
        for (const Wrap wrap : all_wraps) {
            const vec4 color(mix.share(), mix.share(), 1.0f / 3, 1);
            const Texture texture = make_texture(Image<vec4>(size, color), wrap);
            for (const TextureLevel& level : texture.levels)
                for (const vec4 texel : level.texels.pixels())
                    ASSERT_EQ(texel, color) << in_full(texel, color) << "a texel of the level of "
                                            << testing::PrintToString(level.size)
                                            << " of a picture of " << testing::PrintToString(size);
            for (int i = 0; i < 3'000; ++i) {
                const FragmentUv uv{mix.pair(), mix.share() * mix.pair(),
                                    vec2(mix.share(), mix.share())};
                for (const Filter filter : all_filters) {
                    const vec4 sampled = sample(texture, filter, uv);
                    ASSERT_EQ(sampled, color)
                        << in_full(sampled, color) << "filter " << name_of(filter) << ", "
                        << name_of(wrap) << ", of " << testing::PrintToString(size) << " texels at "
                        << described(uv) << "; seed 5, case " << i;
                }
            }
        }
}

TEST(Textures, Eq5_8_ExamplesOfLevels) {
    const auto level = [](vec2 across_texels, vec2 down_texels) {
        constexpr ivec2 size(256, 64);
        return level_of_detail(across_texels / vec2(size), down_texels / vec2(size), size);
    };
    const char* what = "of a footprint whose two sides are given in texels";
    EXPECT_EQ(level({1, 0}, {0, 1}), 0) << what;
    EXPECT_EQ(level({0.25f, 0}, {0, 0.25f}), 0) << what << "; a texel over many pixels";
    EXPECT_EQ(level({2, 0}, {0, 1}), 1) << what;
    EXPECT_EQ(level({0, 1}, {4, 0}), 2) << what << "; the second is the longer one";
    EXPECT_EQ(level({0, 8}, {0, 0}), 3) << what;
    EXPECT_NEAR(level({3, 4}, {1, 0}), 2.321928f, 2 * feps) << what << "; log2(5)";
    EXPECT_EQ(level({0, 0}, {0, 0}), 0) << what;
}

TEST(Textures, Eq5_8_FootprintsOfAllSizes) {
    AnySize any(6, 8);
    for (int i = 0; i < 100'000; ++i) {
        const vec2 across(any.number(), any.number()), down(any.number(), any.number());
        const ivec2 size(any.whole(1, 4096), any.whole(1, 4096));
        const auto length = [&](vec2 step) {
            return std::hypot(real{step.x} * size.x, real{step.y} * size.y);
        };
        const real exact = std::max(real{0}, std::log2(std::max(length(across), length(down))));
        // The square is off by 2 eps: two products and a sum, the first product twice. Its
        // logarithm by as much over ln 2 = 0.69, halved; the logarithm itself by less than eps of
        // itself.
        ASSERT_TRUE(is_near(level_of_detail(across, down, size), exact, 1.5L * eps + eps * exact))
            << "level_of_detail() of " << shown(across) << " to the right and " << shown(down)
            << " down, of " << testing::PrintToString(size) << " texels; seed 6, case " << i;
    }
}

TEST(Textures, HardCase_FootprintsThatAreNotNumbers) {
    look_up("Eq. 5.8: what log2 is never asked for");
    const vec2 nan(not_a_number), step(0.5f), none(0);
    constexpr ivec2 size(8, 8);
    EXPECT_EQ(level_of_detail(nan, nan, size), 0);
    EXPECT_EQ(level_of_detail(nan, none, size), 0);
    EXPECT_EQ(level_of_detail(none, nan, size), 0);
    EXPECT_EQ(level_of_detail({not_a_number, 0}, none, size), 0);
    EXPECT_EQ(level_of_detail({0, not_a_number}, none, size), 0);
    for (const vec2 across : {nan, step, none})
        for (const vec2 down : {nan, step, none})
            EXPECT_GE(level_of_detail(across, down, size), 0) << "NaN is not";
    // One of four is not a number, in turn, and the others have levels of their own.
    for (const float other : {0.0f, 0.625f, infinity})
        for (int special = 0; special < 4; ++special) {
            vec4 steps(other);
            steps[special] = not_a_number;
            EXPECT_EQ(level_of_detail({steps.x, steps.y}, {steps.z, steps.w}, size), 0)
                << testing::PrintToString(steps);
            steps = vec4(0.625f);
            for (const float infinite : {infinity, -infinity}) {
                steps[special] = infinite;
                EXPECT_EQ(level_of_detail({steps.x, steps.y}, {steps.z, steps.w}, size), infinity)
                    << testing::PrintToString(steps);
            }
        }
    EXPECT_EQ(level_of_detail(vec2(infinity), none, size), infinity);
    const Texture texture = make_texture(noise(size, 7), Wrap::repeat);
    const vec4 last = texture.levels.back().texels[ivec2(1)];
    for (const float beyond : {3.0f, 3.5f, 100.0f, FLT_MAX, infinity})
        EXPECT_EQ(sample_trilinear(texture, {0.3f, 0.8f}, beyond), last) << beyond;
    EXPECT_EQ(sample(texture, Filter::trilinear, {vec2(0.2f), vec2(1e30f), vec2(0)}), last);
    EXPECT_EQ(sample(texture, Filter::trilinear, {vec2(0.2f), {infinity, 0}, none}), last);
    EXPECT_EQ(sample(texture, Filter::trilinear, {vec2(0.2f), none, {0, -infinity}}), last);
    for (const vec2 across : {nan, vec2(5)})
        EXPECT_EQ(sample(texture, Filter::trilinear, {vec2(0.2f), across, nan}),
                  sample(texture, Filter::bilinear, {vec2(0.2f), none, none}));
}

TEST(Textures, Eq5_9_AllMeansOfTheWorkedExample) {
    Image<vec4> two_by_two({2, 2});
    for (int i = 0; i < 4; ++i) two_by_two[{i % 2, i / 2}] = vec4(static_cast<float>(i * i));
    EXPECT_EQ(downsampled(two_by_two).size(), ivec2(1));
    EXPECT_EQ((downsampled(two_by_two)[{0, 0}]), vec4(3.5f)) << "(0 + 1 + 4 + 9) / 4";
    // Of five texels each of two covers two and a half.
    Image<vec4> five({5, 1});
    for (int x = 0; x < 5; ++x) five[{x, 0}] = vec4(static_cast<float>(10 * x));
    const Image<vec4> two = downsampled(five);
    ASSERT_EQ(two.size(), ivec2(2, 1)) << "half of 5 x 1";
    EXPECT_EQ((two[{0, 0}]), vec4(8)) << "(2 * 0 + 2 * 10 + 20) / 5";
    EXPECT_EQ((two[{1, 0}]), vec4(32)) << "(20 + 2 * 30 + 2 * 40) / 5";
}

TEST(Textures, Eq5_9_LevelsHaveHalvedSizes) {
    const auto sizes = [](ivec2 size) {
        std::vector<ivec2> all;
        for (const TextureLevel& level : make_texture(Image<vec4>(size), Wrap::repeat).levels) {
            all.push_back(level.size);
            EXPECT_EQ(level.texels.size(), level.size + 2) << "each level has a border of one";
        }
        return all;
    };
    EXPECT_EQ(sizes({8, 2}), (std::vector{ivec2(8, 2), ivec2(4, 1), ivec2(2, 1), ivec2(1)}));
    EXPECT_EQ(sizes({3, 5}), (std::vector{ivec2(3, 5), ivec2(1, 2), ivec2(1)}));
    EXPECT_EQ(sizes({1, 7}), (std::vector{ivec2(1, 7), ivec2(1, 3), ivec2(1)}));
    EXPECT_EQ(sizes({1, 1}), (std::vector{ivec2(1)}));
}

TEST(Textures, Eq5_9_HardCase_OddSizesAreMeansOfWhatTexelsCover) {
    // In double, 13 times 27/13 is more than 27.
    for (const ivec2 from : {ivec2(3, 5), ivec2(1, 7), ivec2(9, 1), ivec2(2, 3), ivec2(31, 17),
                             ivec2(27, 1), ivec2(1, 27)}) {
        const Image<vec4> picture = noise(from, 8), half = downsampled(picture);
        const ivec2 to = half.size();
        // In whole numbers: a texel of the picture is to.x wide and one of its half from.x.
        const auto common = [](int a, int a_side, int b, int b_side) {
            return std::max(
                0, std::min((a + 1) * a_side, (b + 1) * b_side) - std::max(a * a_side, b * b_side));
        };
        for (int y = 0; y < to.y; ++y)
            for (int x = 0; x < to.x; ++x) {
                dvec4 sum(0);
                for (int row = 0; row < from.y; ++row)
                    for (int column = 0; column < from.x; ++column)
                        sum += double(common(x, from.x, column, to.x)) *
                               common(y, from.y, row, to.y) * dvec4(picture[{column, row}]);
                sum /= double(from.x) * from.y;
                for (int channel = 0; channel < 4;
                     ++channel)  // one rounding; double's do not count
                    ASSERT_NEAR((half[{x, y}][channel]), sum[channel], 0.5001 * feps * sum[channel])
                        << "channel " << channel << " of texel (" << x << ", " << y << ") of "
                        << testing::PrintToString(to) << ", half of "
                        << testing::PrintToString(from);
            }
    }
}

TEST(Textures, Eq5_9_EveryLevelHasTheMeanOfTheTexture) {
    for (const ivec2 size : {ivec2(64), ivec2(32, 4), ivec2(1, 128), ivec2(2, 1)}) {
        const auto mean = [](const TextureLevel& level) {
            dvec4 sum(0);
            for (int y = 0; y < level.size.y; ++y)
                for (int x = 0; x < level.size.x; ++x) sum += dvec4(level.texels[ivec2(x, y) + 1]);
            return sum / (double(level.size.x) * level.size.y);
        };
        const Texture texture = make_texture(noise(size, 9), Wrap::repeat);
        const dvec4 exact = mean(texture.levels[0]);
        for (std::size_t i = 0; i < texture.levels.size(); ++i)
            for (int channel = 0; channel < 4; ++channel)  // a rounding a level
                ASSERT_NEAR(mean(texture.levels[i])[channel], exact[channel],
                            0.5001 * feps * static_cast<double>(i))
                    << "the mean of channel " << channel << " in level " << i << " of a picture of "
                    << testing::PrintToString(size) << " texels, and in level 0";
        EXPECT_EQ(texture.levels.back().size, ivec2(1)) << "the last level of all";
    }
}

TEST(Textures, Eq5_4_EachDirectionIsWrappedOnItsOwn) {
    // Red tells columns apart and green rows, so that neither knows of the other.
    Mix mix(13);
    for (const ivec2 size : {ivec2(4, 2), ivec2(1, 7), ivec2(5, 16)}) {
        Image<vec4> picture(size);
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) picture[{x, y}] = {x * x, y * y, 0, 1};
        for (const Wrap u : all_wraps)
            for (const Wrap v : all_wraps) {
                const Texture apart = make_texture(picture, {u, v}),
                              like_u = make_texture(picture, u), like_v = make_texture(picture, v);
                for (int i = 0; i < 500; ++i) {
                    const FragmentUv uv{6.0f * vec2(mix.share(), mix.share()) - 3.0f, vec2(0),
                                        vec2(0)};
                    for (const Filter filter : all_filters) {
                        const vec4 color = sample(apart, filter, uv);
                        ASSERT_EQ(color.r, sample(like_u, filter, uv).r)
                            << name_of(u) << " across, " << name_of(v) << " up, u " << uv.here.x;
                        ASSERT_EQ(color.g, sample(like_v, filter, uv).g)
                            << name_of(u) << " across, " << name_of(v) << " up, v " << uv.here.y;
                    }
                }
            }
    }
}

TEST(Textures, ATexturesOwnFilterMayBeSimplerThanTheProgramsButNotBetter) {
    look_up("Eq. 5.8, and samplers of glTF files");
    Mix mix(14);
    const Texture plain = make_texture(noise({16, 16}, 14), Wrap::repeat);
    for (const Filter magnified : all_filters)
        for (const Filter minified : all_filters) {
            Texture texture = plain;
            texture.magnified = magnified, texture.minified = minified;
            for (int i = 0; i < 500; ++i) {
                // The footprint is half a texel to three texels wide, and one high.
                const float texels = 0.5f + 2.5f * mix.share();
                const FragmentUv uv{
                    vec2(mix.share(), mix.share()), {texels / 16, 0}, {0, 1 / 16.0f}};
                for (const Filter filter : all_filters) {
                    const Filter own = texels > 1 ? minified : magnified;
                    const Filter used = own < filter ? own : filter;
                    ASSERT_EQ(sample(texture, filter, uv), sample(plain, used, uv))
                        << "asked for " << name_of(filter) << ", the texture's own "
                        << name_of(magnified) << " and " << name_of(minified) << ", " << texels
                        << " texels a pixel";
                }
            }
        }
}

TEST(Textures, Eq5_10_AllMeansOfTheWorkedExample) {
    Image<vec4> picture({2, 1});
    picture[{0, 0}] = vec4(0), picture[{1, 0}] = vec4(8);
    const Texture texture = make_texture(picture, Wrap::clamp);
    const vec2 left(0.25f, 0.5f);
    ASSERT_EQ(texture.levels.size(), 2u) << "of 2 x 1 texels and of one";
    EXPECT_EQ(sample_trilinear(texture, left, 0), vec4(0)) << "the finer level alone";
    EXPECT_EQ(sample_trilinear(texture, left, 0.25f), vec4(1)) << "a quarter of the way to 4";
    EXPECT_EQ(sample_trilinear(texture, left, 1), vec4(4)) << "the coarser level alone";
    const auto color = [&](Filter filter, float step) {
        return sample(texture, filter, {left, {step, 0}, {0, 0}});
    };
    EXPECT_EQ(color(Filter::trilinear, 0.5f), vec4(0)) << "u changes by 1/2, a texel: level 0";
    EXPECT_EQ(color(Filter::trilinear, 1), vec4(4)) << "u changes by 1, two texels: level 1";
    EXPECT_EQ(color(Filter::bilinear, 1), vec4(0)) << "always level 0";
    EXPECT_EQ(color(Filter::nearest, 1), vec4(0)) << "always level 0";
}

TEST(Textures, Eq5_10_GoesEvenlyFromLevelToLevel) {
    Mix mix(10);
    const Texture texture = make_texture(noise({16, 9}, 10), Wrap::repeat);
    const auto last = static_cast<float>(texture.levels.size() - 1);
    for (int i = 0; i < 50'000; ++i) {
        const vec2 place(mix.share(), mix.share());
        const float level = i % 8 ? last * mix.share() : std::floor(last * mix.share());
        const auto finer = static_cast<std::size_t>(level);
        const vec4 a = sample_bilinear(texture.levels[finer], place),
                   b = sample_bilinear(texture.levels[std::min(finer + 1, std::size_t(last))],
                                       place);
        const real share = real{level} - static_cast<real>(finer);
        for (int channel = 0; channel < 4;
             ++channel)  // difference, product, sum of numbers up to 1
            ASSERT_TRUE(is_near(sample_trilinear(texture, place, level)[channel],
                                (1 - share) * a[channel] + share * b[channel], 1.5L * eps))
                << "channel " << channel << " at " << shown(place) << " in level " << shown(level)
                << " of " << texture.levels.size() << "; seed 10, case " << i;
    }
}

TEST(Textures, Eq5_1_UvOfAFragmentAndItsDerivatives) {
    const std::array uvs = {vec2(0, 0), vec2(1, 0), vec2(1, 2)};
    const FragmentUv uv = fragment_uv(
        uvs, FragmentBarycentrics{{0.5f, 0.25f, 0.25f}, {-0.5f, 0.25f, 0.25f}, {0, -1, 1}});
    EXPECT_EQ(uv.here, vec2(0.5f, 0.5f)) << "(0, 0) / 2 + (1, 0) / 4 + (1, 2) / 4";
    EXPECT_EQ(uv.ddx, vec2(0.5f, 0.5f)) << "(0, 0) (-1/2) + (1, 0) / 4 + (1, 2) / 4";
    EXPECT_EQ(uv.ddy, vec2(0, 2)) << "(0, 0) 0 + (1, 0) (-1) + (1, 2)";
}

TEST(Textures, Eq5_11_ValuesAndAlphaOfTheTable) {
    Image<u8vec4> codes({4, 1});
    codes[{0, 0}] = {0, 255, 10, 51};
    codes[{1, 0}] = {188, 128, 11, 255};
    const Image<vec4> linear = linear_from_srgb8(codes);
    ASSERT_EQ(linear.size(), codes.size());
    const vec4 first = linear[{0, 0}], second = linear[{1, 0}];
    EXPECT_EQ(first.r, 0.0f) << "of code 0";
    EXPECT_EQ(first.g, 1.0f) << "of code 255";
    EXPECT_NEAR(first.b, 10 / 255.0 / 12.92, 1e-9) << "of code 10: on the straight line";
    EXPECT_NEAR(second.r, 0.5, 0.003) << "of code 188: half of the light";
    EXPECT_NEAR(second.g, 0.2159, 0.0001) << "of code 128: less than a quarter";
    EXPECT_EQ(first.a, 0.2f) << "of code 51: opacity is not encoded";
}

TEST(Textures, Eq5_11_EveryValueIsWithinRoundingAndComesBack) {
    Image<u8vec4> codes({256, 1});
    for (int code = 0; code < 256; ++code)
        codes[{code, 0}] = {code, 255 - code, code / 2, 255 - code};
    const Image<vec4> linear = linear_from_srgb8(codes);
    const auto exact = [](int code) {
        const real srgb = code / 255.0L;
        return srgb <= 0.04045L ? srgb / 12.92L : std::pow((srgb + 0.055L) / 1.055L, 2.4L);
    };
    // code / 255, the sum, 1.055 and the quotient make 2 eps, 2.4 of it in the power, whose
    // exponent is off by eps/4 of itself, times a logarithm of up to 3; and the power is within 1
    // ulp.
    constexpr real tolerance = 2.4L * (2 + 3.0L / 4) * eps + eps;
    for (int code = 0; code < 256; ++code) {
        const vec4 light = linear[{code, 0}];
        const auto is_light_of = [&](float actual, int of) {
            return is_near(actual, exact(of), tolerance * exact(of));
        };
        ASSERT_TRUE(is_light_of(light.r, code)) << "red of code " << code;
        ASSERT_TRUE(is_light_of(light.g, 255 - code)) << "green of code " << 255 - code;
        ASSERT_TRUE(is_light_of(light.b, code / 2)) << "blue of code " << code / 2;
        ASSERT_EQ(light.a, static_cast<float>(255 - code) / 255) << "opacity " << 255 - code;
        ASSERT_EQ(srgb8_from_linear(light.r), code) << "there and back again";
    }
}

TEST(Textures, Eq5_11_FromAfarAChessboardIsHalfOfTheLight) {
    Image<u8vec4> board({8, 8}, {255, 255, 255, 255});
    for (int i = 0; i < 64; ++i)
        if ((i / 8 + i) % 2) board[{i % 8, i / 8}] = {0, 0, 0, 255};
    const Texture texture = make_texture(linear_from_srgb8(board), Wrap::repeat);
    const vec4 color = sample(texture, Filter::trilinear, {vec2(0.3f), vec2(1), vec2(1)});
    EXPECT_EQ(color, vec4(vec3(0.5f), 1));
    EXPECT_EQ(srgb8_from_linear(color.r), 188) << "128 would be the mean of the codes";
}

TEST(Textures, HardCase_SpecialNumbersSeeAColour) {
    look_up("Eq. 5.4 and 5.8: how the comparisons are written");
    const std::array sizes = {ivec2(1), ivec2(3, 5), ivec2(1, 9), ivec2(64, 64), ivec2(7, 512)};
    std::vector<Texture> textures;
    for (const ivec2 size : sizes)
        for (const Wrap wrap : all_wraps) textures.push_back(make_texture(noise(size, 11), wrap));
    Mix mix(11);
    for (int i = 0; i < 1'000'000; ++i) {
        const Texture& texture = textures[mix.below(textures.size())];
        const FragmentUv uv{mix.pair(), mix.pair(), mix.pair()};
        for (const float coordinate : {uv.here.x, uv.here.y}) {
            const float inside = wrapped(coordinate, texture.wrap.u);
            ASSERT_TRUE(inside >= 0 && inside <= 1)
                << "wrapped(" << shown(coordinate) << "), " << name_of(texture.wrap.u) << ", is "
                << inside << "; seed 11, case " << i;
        }
        const vec2 place = texture_position(uv.here, texture.wrap);
        ASSERT_TRUE(place.x >= 0 && place.x <= 1 && place.y >= 0 && place.y <= 1)
            << "texture_position() of uv " << shown(uv.here) << " is " << shown(place)
            << "; seed 11, case " << i;
        ASSERT_GE(level_of_detail(uv.ddx, uv.ddy, texture.levels[0].size), 0)
            << "level_of_detail(); " << described(uv) << "; seed 11, case " << i;
        const Filter filter = all_filters[mix.below(3)];
        ASSERT_TRUE(is_color(sample(texture, filter, uv)))
            << "filter " << name_of(filter) << ", " << name_of(texture.wrap.u) << ", "
            << described(uv) << "; seed 11, case " << i;
    }
}

TEST(Textures, HardCase_SpecialNumbersAtTheVerticesSeeAColour) {
    look_up("Eq. 5.2, and where the proportions of the w end");
    const Texture texture = make_texture(noise({7, 12}, 12), Wrap::repeat);
    Mix mix(12);
    int pixels = 0;
    for (int i = 0; i < 200'000; ++i) {
        constexpr ivec2 size(4, 3);
        const auto vertex = [&] { return vec2(mix.share() * 4, mix.share() * 3); };
        const vec2 a = vertex(), b = vertex();
        ScreenTriangle on_screen = snap_triangle(a, b, vertex());
        if (i % 16 == 0) on_screen = snap_triangle({-4e6f, -4e6f}, {-4e6f, 4e6f}, {4e6f, 0});
        if (i % 16 == 1) on_screen = snap_triangle({1, 1}, {1, 1 + 1 / 64.0f}, {4, 1 + 1 / 64.0f});
        if (!is_front_facing(on_screen)) continue;
        ClippedTriangle piece;
        for (std::size_t k = 0; k < 3; ++k) {
            vec3 barycentrics(0);
            barycentrics[static_cast<int>(k)] = 1;
            if (i % 3 == 0) barycentrics = vec3(mix.share(), mix.share(), 1 - mix.share());
            piece[k] = {{0, 0, 0, mix.w()}, barycentrics};
        }
        const std::array uvs = {mix.pair(), mix.pair(), mix.pair()};
        const PerspectiveSetup setup = perspective_setup(on_screen, piece);
        const auto check = [&](vec3 screen_barycentrics) {
            ++pixels;
            const FragmentBarycentrics barycentrics =
                perspective_correct(setup, screen_barycentrics);
            for (int k = 0; k < 3; ++k) {
                ASSERT_TRUE(barycentrics.here[k] >= 0 && barycentrics.here[k] <= 1 + 2 * feps)
                    << "here = " << shown(barycentrics.here)
                    << " at s = " << shown(screen_barycentrics) << "; seed 12, case " << i;
                ASSERT_TRUE(std::isfinite(barycentrics.ddx[k]) &&
                            std::isfinite(barycentrics.ddy[k]))
                    << "ddx = " << shown(barycentrics.ddx) << ", ddy = " << shown(barycentrics.ddy)
                    << " at s = " << shown(screen_barycentrics) << "; seed 12, case " << i;
            }
            ASSERT_TRUE(is_color(
                sample(texture, all_filters[mix.below(3)], fragment_uv(uvs, barycentrics))))
                << "seed 12, case " << i;
        };
        fill_triangle(on_screen, size,
                      [&](ivec2, vec3 screen_barycentrics) { check(screen_barycentrics); });
        for (const vec3 on_a_side : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1),
                                     vec3(0, 0.5f, 0.5f), vec3(0.25f, 0, 0.75f)})
            check(on_a_side);
        ASSERT_FALSE(HasFatalFailure());
    }
    EXPECT_GT(pixels, 500'000);
}

TEST(Textures, HardCase_TextureOfMillionsOfColumns) {
    look_up("Eq. 5.6: beyond 2^23 a float has no half texel");
    constexpr int columns = (1 << 23) + 1;
    TextureLevel level{{columns, 1}, Image<vec4>({columns + 2, 2}, vec4(0.5f))};
    level.texels[{0, 1}] = vec4(not_a_number);  // what one would read beyond the upper row
    for (const float x : {0.5f, 1 - feps / 2, 1.0f}) {
        EXPECT_EQ(sample_bilinear(level, {x, 0}), vec4(0.5f)) << x;
        EXPECT_EQ(sample_nearest(level, {x, 0}), vec4(0.5f)) << x;
    }
}
