// SPDX-License-Identifier: MIT
// Which texels a point of a surface sees: wrapping, filters, levels, sRGB.
#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "05_textures/interpolation.hpp"
#include "05_textures/texture.hpp"
#include "support/cases.hpp"
#include "support/first_difference.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/printers.hpp"
#include "support/reference.hpp"
#include "support/special_numbers.hpp"
#include "support/texture_names.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr float feps = FLT_EPSILON;

std::string described(const FragmentUv& uv) {
    return "uv " + shown(uv.here) + ", which changes by " + shown(uv.ddx) +
           " to the right and by " + shown(uv.ddy) + " down";
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
ivec2 texel_at(const TextureLevel& level, vec2 uv, WrapModes wrap) {
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

/// The column in which a u lies, or the row in which a v does. A border belongs to what follows it;
/// beyond the last one is the last one.
int exact_texel(float coordinate, int side, Wrap wrap, bool is_v) {
    const real wrapped = exactly_wrapped(coordinate, side, wrap);
    const real place = is_v ? side - wrapped : wrapped;
    return std::min(static_cast<int>(std::floor(place)), side - 1);
}

/// Any whole number as the texel that it stands for beyond the picture.
int wrapped_texel(int texel, int side, Wrap wrap) {
    if (wrap == Wrap::clamp) return std::clamp(texel, 0, side - 1);
    const int period = wrap == Wrap::repeat ? side : 2 * side;
    const int rest = (texel % period + period) % period;
    return std::min(rest, period - 1 - rest + (wrap == Wrap::repeat ? period : 0));
}

/// The oracle for Eq. 5.6: wraps each of the four texels, not the place.
glm::vec<4, real> exact_bilinear(const Image<vec4>& picture, vec2 uv, WrapModes wrap) {
    const real x = real{uv.x} * picture.size().x - 0.5L;
    const real y = (1 - real{uv.y}) * picture.size().y - 0.5L;
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    glm::vec<4, real> sum(0);
    for (int dy = 0; dy < 2; ++dy)
        for (int dx = 0; dx < 2; ++dx) {
            const ivec2 texel(wrapped_texel(column + dx, picture.size().x, wrap.u),
                              wrapped_texel(row + dy, picture.size().y, wrap.v));
            const real share = (dx ? x - column : column + 1 - x) * (dy ? y - row : row + 1 - y);
            sum += share * glm::vec<4, real>(picture[texel]);
        }
    return sum;
}

std::vector<WrapModes> pairs_of_wraps() {
    std::vector<WrapModes> pairs;
    for (const Wrap u : all_wraps)
        for (const Wrap v : all_wraps) pairs.push_back({u, v});
    return pairs;
}

std::string in_words(WrapModes wrap) {
    return name_of(wrap.u) + std::string(" across and ") + name_of(wrap.v) + " up";
}

class Mix : public SpecialNumbers {
  public:
    using SpecialNumbers::SpecialNumbers;

    /// From 0 to 1.
    float share() { return 0.5f * std::abs(ordinary()); }
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
    constexpr float tiny = FLT_TRUE_MIN;
    for (const ivec2 size : {ivec2(512), ivec2(1), ivec2(1, 9), ivec2(9, 1), ivec2(3, 5)})
        for (const Wrap wrap : all_wraps) {
            const TextureLevel level = with_border(columns_and_rows(size), wrap);
            for (const float size_of_it :
                 {0.0f, tiny, FLT_MIN, feps, 0.5f, 1 - feps / 2, 1.0f, 1 + feps, 2 - feps, 2.0f,
                  3.0f, 0x1p23f, 0x1p24f, 1e9f, FLT_MAX, infinity, not_a_number})
                for (const float special : {size_of_it, -size_of_it})
                    for (const vec2 uv : {vec2(special, 0.25f), vec2(0.25f, special)}) {
                        const ivec2 expected(exact_texel(uv.x, size.x, wrap, false),
                                             exact_texel(uv.y, size.y, wrap, true));
                        ASSERT_EQ(texel_at(level, uv, wrap), expected)
                            << "the texel that uv " << shown(uv) << " sees, " << name_of(wrap)
                            << ", in " << testing::PrintToString(size)
                            << " texels; (-1, -1): texture_position() is not in the picture";
                    }
        }
}

TEST(Textures, Eq5_5_AnyTexelIsSeenInsideOfIt) {
    Mix mix(1);
    for (const ivec2 size : {ivec2(512, 3), ivec2(1, 1000), ivec2(5, 7)})
        for (const WrapModes wrap : pairs_of_wraps()) {
            const TextureLevel level = with_border(columns_and_rows(size), wrap);
            for (int i = 0; i < cases_of(2000); ++i) {
                // Coordinates are rounded by less than 1/100 of a texel.
                const int reach = i % 2 ? 100'000 : 2000;
                const auto any = [&] {
                    return static_cast<int>(mix.below(2u * static_cast<unsigned>(reach))) - reach;
                };
                const ivec2 texel(any(), any());
                const vec2 inside = 0.02f + 0.96f * vec2(mix.share(), mix.share());
                const vec2 uv = (vec2(texel) + inside) / vec2(size);
                const ivec2 expected(wrapped_texel(texel.x, size.x, wrap.u),
                                     size.y - 1 - wrapped_texel(texel.y, size.y, wrap.v));
                ASSERT_EQ(texel_at(level, uv, wrap), expected)
                    << "the texel that uv " << shown(uv) << " sees, " << in_words(wrap) << ", in "
                    << testing::PrintToString(size) << " texels; seed 1, case " << i;
            }
        }
}

TEST(Textures, Eq5_5_AnExampleInWhichVPointsUpAndRowsDown) {
    EXPECT_EQ(texture_position({0.25f, 0.75f}, Wrap::repeat), vec2(0.25f, 0.25f));
    EXPECT_EQ(texture_position({0, 0}, Wrap::clamp), vec2(0, 1)) << "the lower left corner";
    EXPECT_EQ(texture_position({1, 1}, Wrap::clamp), vec2(1, 0)) << "the upper right corner";
    const TextureLevel level = with_border(columns_and_rows({4, 2}), Wrap::repeat);
    const auto texel = [&](vec2 uv, Wrap wrap) { return texel_at(level, uv, wrap); };
    const char* what = "column and row of 4 x 2 texels";
    EXPECT_EQ(texel({0.25f, 0.75f}, Wrap::repeat), ivec2(1, 0)) << what << ", the upper row";
    EXPECT_EQ(texel({0.9f, 0.1f}, Wrap::repeat), ivec2(3, 1)) << what << ", the lower one";
    EXPECT_EQ(texel({0, 0}, Wrap::clamp), ivec2(0, 1)) << what;
    EXPECT_EQ(texel({1, 0}, Wrap::clamp), ivec2(3, 1)) << what << ": the last texel";
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
        for (const WrapModes wrap : pairs_of_wraps()) {
            const TextureLevel level = with_border(picture, wrap);
            for (int i = 0; i < 3'000; ++i) {
                vec2 uv(any(random), any(random));
                // Every other one within a texel of a seam.
                const vec2 near_seam =
                    glm::round(uv) + vec2(little(random), little(random)) / vec2(size);
                if (i % 2) uv.x = near_seam.x;
                if (i % 4 > 1) uv.y = near_seam.y;
                const auto exact = exact_bilinear(picture, uv, wrap);
                // A place is off by less than 2 eps of the side; texels are 0 to 1, so the colour
                // is off by as much. A difference, a product and a sum make eps/2 each, twice.
                const real tolerance = 2 * eps * (size.x + size.y) + 3 * eps;
                const vec4 actual = sample_bilinear(level, texture_position(uv, wrap));
                for (int channel = 0; channel < 4; ++channel)
                    ASSERT_TRUE(is_near(actual[channel], exact[channel], tolerance))
                        << "channel " << channel << " of " << testing::PrintToString(size)
                        << " texels, " << in_words(wrap) << ", at uv " << shown(uv)
                        << "; seed 3, case " << i;
            }
        }
    }
}

TEST(Textures, Eq5_6_HardCase_CentresOfTexelsKeepTheirColours) {
    for (const ivec2 size : {ivec2(8, 4), ivec2(64, 1), ivec2(1)}) {
        const Image<vec4> picture = noise(size, 4);
        const vec2 texel = 1.0f / vec2(size);  // as long as a pixel
        for (const Wrap wrap : all_wraps) {
            const Texture texture = make_texture(picture, wrap);
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x)
                    for (const Filter filter : all_filters) {
                        const vec2 uv = (vec2(x, size.y - 1 - y) + 0.5f) / vec2(size);
                        const vec4 color =
                            sample(texture, filter, {uv, {texel.x, 0}, {0, texel.y}});
                        ASSERT_EQ(color, (picture[{x, y}]))
                            << "at the centre of texel (" << x << ", " << y << ") of "
                            << testing::PrintToString(size) << ", " << name_of(wrap) << ", filter "
                            << name_of(filter);
                    }
        }
    }
}

TEST(Textures, HardCase_ConstantTextureStaysConstantBitForBit) {
    look_up("Eq. 5.6, 5.9 and 5.10: a + t (b - a) is a where b is a");
    Mix mix(5);
    for (const ivec2 size : {ivec2(1, 7), ivec2(7, 1), ivec2(3, 5), ivec2(8), ivec2(6, 10),
                             ivec2(512, 1), ivec2(33, 65)})
        for (const Wrap wrap : all_wraps) {
            const vec4 color(mix.share(), mix.share(), 1.0f / 3, 1);
            const Texture texture = make_texture(Image<vec4>(size, color), wrap);
            for (int i = 0; i < 3'000; ++i) {
                const FragmentUv uv{mix.any_two(), mix.share() * mix.any_two(),
                                    vec2(mix.share(), mix.share())};
                for (const Filter filter : all_filters)
                    ASSERT_EQ(sample(texture, filter, uv), color)
                        << "filter " << name_of(filter) << ", " << name_of(wrap) << ", of "
                        << testing::PrintToString(size) << " texels at " << described(uv)
                        << "; seed 5, case " << i;
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

TEST(Textures, HardCase_FootprintsThatAreNotNumbers) {
    look_up("Eq. 5.8: what log2 is never asked for");
    constexpr ivec2 size(8, 8);
    const auto level = [&](vec4 steps) {
        return level_of_detail({steps.x, steps.y}, {steps.z, steps.w}, size);
    };
    // One of four is not a number, in turn, and the others have levels of their own.
    for (int special = 0; special < 4; ++special)
        for (const float other : {0.0f, 0.625f, infinity}) {
            vec4 steps(other);
            steps[special] = not_a_number;
            EXPECT_EQ(level(steps), 0) << testing::PrintToString(steps);
            if (other == infinity) continue;
            for (const float infinite : {infinity, -infinity}) {
                steps[special] = infinite;
                EXPECT_EQ(level(steps), infinity) << testing::PrintToString(steps);
            }
        }
    EXPECT_EQ(level(vec4(not_a_number)), 0);
    const Texture texture = make_texture(noise(size, 7), Wrap::repeat);
    const vec4 last = texture.levels.back().texels[ivec2(1)];
    for (const float beyond : {3.0f, 3.5f, 100.0f, FLT_MAX, infinity})
        EXPECT_EQ(sample_trilinear(texture, {0.3f, 0.8f}, beyond), last) << beyond;
    EXPECT_EQ(sample(texture, Filter::trilinear, {vec2(0.2f), {infinity, 0}, vec2(0)}), last);
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

TEST(Textures, Eq5_9_EachLevelIsHalfOfTheOneBefore) {
    for (const auto& sizes :
         {std::vector{ivec2(8, 2), ivec2(4, 1), ivec2(2, 1), ivec2(1)},
          std::vector{ivec2(3, 5), ivec2(1, 2), ivec2(1)}, std::vector{ivec2(1)}}) {
        Image<vec4> picture = noise(sizes[0], 9);
        const Texture texture = make_texture(picture, Wrap::repeat);
        ASSERT_EQ(texture.levels.size(), sizes.size()) << testing::PrintToString(sizes);
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            EXPECT_EQ(texture.levels[i].size, sizes[i]) << "level " << i;
            EXPECT_TRUE(
                are_equal(texture.levels[i].texels, with_border(picture, Wrap::repeat).texels))
                << "level " << i << " of " << testing::PrintToString(sizes) << ", with its border";
            picture = downsampled(picture);
        }
    }
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
                // One rounding of numbers up to 1; double's do not count.
                ASSERT_TRUE(are_near(half[{x, y}], sum, 0.5001 * feps))
                    << "texel (" << x << ", " << y << ") of " << testing::PrintToString(to)
                    << ", half of " << testing::PrintToString(from);
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
                const Filter own = texels > 1 ? minified : magnified;
                for (const Filter filter : all_filters)
                    ASSERT_EQ(sample(texture, filter, uv), sample(plain, std::min(own, filter), uv))
                        << "asked for " << name_of(filter) << ", the texture's own "
                        << name_of(magnified) << " and " << name_of(minified) << ", " << texels
                        << " texels a pixel";
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
        const std::size_t coarser = std::min(finer + 1, texture.levels.size() - 1);
        const dvec4 a = sample_bilinear(texture.levels[finer], place),
                    b = sample_bilinear(texture.levels[coarser], place);
        const double share = double{level} - static_cast<double>(finer);
        // A difference, a product and a sum of numbers up to 1.
        ASSERT_TRUE(are_near(sample_trilinear(texture, place, level), (1 - share) * a + share * b,
                             1.5 * feps))
            << "at " << shown(place) << " in level " << shown(level) << " of "
            << texture.levels.size() << "; seed 10, case " << i;
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
    std::vector<Texture> textures;
    for (const ivec2 size : {ivec2(1), ivec2(3, 5), ivec2(1, 9), ivec2(64, 64), ivec2(7, 512)})
        for (const Wrap wrap : all_wraps) textures.push_back(make_texture(noise(size, 11), wrap));
    Mix mix(11);
    for (unsigned i = 0; i < 1'000'000; ++i) {
        const Texture& texture = textures[i % textures.size()];
        const FragmentUv uv{mix.any_two(), mix.any_two(), mix.any_two()};
        const vec2 place = texture_position(uv.here, texture.wrap);
        ASSERT_TRUE(place.x >= 0 && place.x <= 1 && place.y >= 0 && place.y <= 1)
            << "texture_position() of uv " << shown(uv.here) << " is " << shown(place) << ", "
            << name_of(texture.wrap.u) << "; seed 11, case " << i;
        ASSERT_GE(level_of_detail(uv.ddx, uv.ddy, texture.levels[0].size), 0)
            << "level_of_detail(); " << described(uv) << "; seed 11, case " << i;
        const Filter filter = all_filters[mix.below(3)];
        ASSERT_TRUE(is_color(sample(texture, filter, uv)))
            << "filter " << name_of(filter) << ", " << name_of(texture.wrap.u) << ", "
            << described(uv) << "; seed 11, case " << i;
    }
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
