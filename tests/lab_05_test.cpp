// SPDX-License-Identifier: MIT
// The variants of lesson 05 that docs/accuracy/05_textures.md measures: each keeps what its comment
// says.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "05_textures/texture_options.hpp"
#include "common/image/image_io.hpp"
#include "lab/texture_methods.hpp"
#include "support/lesson_process.hpp"
#include "support/printers.hpp"
#include "support/projected.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr ivec2 size(256, 128);
constexpr float ulp = 0x1p-24f;  // of a number between 1/2 and 1
/// Begin, step and sum are rounded, and the step's rounding counts once for each of 64 pixels.
constexpr float in_span_tolerance = 64 * ulp;

/// A triangle in clip space and on the screen.
struct Case {
    ClippedTriangle clipped;
    ScreenTriangle on_screen;
};

ClippedTriangle whole(const std::array<vec4, 3>& vertices) {
    return {{{vertices[0], {1, 0, 0}}, {vertices[1], {0, 1, 0}}, {vertices[2], {0, 0, 1}}}};
}

/// Triangles of both windings, with w from 1 to `greatest_w`; every second one a piece of another.
std::vector<Case> random_cases(int count, float greatest_w) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> ndc(-1, 1), share(0, 1), log_w(0, std::log(greatest_w));
    std::vector<Case> cases;
    while (static_cast<int>(cases.size()) < count) {
        ClippedTriangle triangle = whole({});
        for (ClippedVertex& vertex : triangle) {
            vertex.position_clip = vec4(ndc(random), ndc(random), 0, 1) * std::exp(log_w(random));
            if (cases.size() % 2 == 0) continue;
            vertex.barycentrics = {share(random), share(random), share(random)};
            vertex.barycentrics /=
                vertex.barycentrics.x + vertex.barycentrics.y + vertex.barycentrics.z;
        }
        cases.push_back({triangle, projected(triangle, size).on_screen});
    }
    return cases;
}

/// A fragment as fill_triangle gives it.
struct Fragment {
    ivec2 pixel;
    vec3 screen_barycentrics;
};

/// Row by row.
std::vector<std::vector<Fragment>> rows_of(const ScreenTriangle& triangle) {
    std::vector<std::vector<Fragment>> rows;
    fill_triangle(triangle, size, [&](ivec2 pixel, vec3 screen_barycentrics) {
        if (rows.empty() || rows.back().front().pixel.y != pixel.y) rows.emplace_back();
        rows.back().push_back({pixel, screen_barycentrics});
    });
    return rows;
}

void expect_same(const FragmentBarycentrics& a, const FragmentBarycentrics& b) {
    EXPECT_EQ(a.here, b.here);
    EXPECT_EQ(a.ddx, b.ddx);
    EXPECT_EQ(a.ddy, b.ddy);
}

float greatest(vec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

constexpr int spans[] = {64, 32, 16, 8, 4, 2};  // those of --mapping, and the shortest

/// Draws a case's rows with a division every so many pixels, and checks each fragment: spans begin
/// with the exact barycentrics and are straight from there to the exact ones at their end.
///
/// @param is_left_out  Called as is_left_out() for each pixel: whether something hides it.
/// @return             How many pixels lay within spans.
template <typename IsLeftOut>
int expect_straight_spans(const Case& c, int every, IsLeftOut&& is_left_out) {
    const PerspectiveSetup setup = perspective_setup(c.on_screen, c.clipped);
    MappedBarycentrics mapped({every}, c.on_screen, c.clipped);
    const auto length = static_cast<std::size_t>(every);
    int within = 0;
    for (const std::vector<Fragment>& row : rows_of(c.on_screen)) {
        const auto exact = [&](std::size_t i) {
            return perspective_correct(setup, row[i].screen_barycentrics);
        };
        std::size_t begin = 0, end = 0;  // of a span, the first pixel and the one behind it
        for (std::size_t i = 0; i < row.size(); ++i) {
            if (is_left_out()) continue;
            const FragmentBarycentrics here = mapped.at(row[i].pixel, row[i].screen_barycentrics);
            if (i >= end) {
                begin = i, end = std::max(std::min(i + length, row.size() - 1), i + 1);
                expect_same(here, exact(i));
                continue;
            }
            const float share = static_cast<float>(i - begin) / static_cast<float>(end - begin);
            const vec3 between = exact(begin).here + share * (exact(end).here - exact(begin).here);
            EXPECT_LT(greatest(here.here - between), in_span_tolerance)
                << every << ": pixel " << i << " of " << row.size();
            ++within;
        }
    }
    return within;
}

/// Codes without order, as hard for a filter as can be.
Image<u8vec4> random_picture(ivec2 picture_size) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> code(0, 255);
    Image<u8vec4> picture(picture_size);
    for (u8vec4& texel : picture.pixels())
        texel = {code(random), code(random), code(random), code(random)};
    return picture;
}

Image<u8vec4> picture(std::vector<std::string> arguments) {
    const std::string out = (fresh_folder("texture_options") / "picture.bmp").string();
    arguments.insert(arguments.end(), {"--size", "640x360", "--out", out});
    const ProcessResult run = run_program("lab_05_textures", arguments);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_EQ(run.err, "");
    return read_image(out);
}

/// The sum of what all texels differ by.
long difference(const Image<u8vec4>& a, const Image<u8vec4>& b) {
    long sum = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i)
        for (int channel = 0; channel < 3; ++channel)
            sum += std::abs(a.pixels()[i][channel] - b.pixels()[i][channel]);
    return sum;
}

}  // namespace

TEST(LabTextures, AffineIsWhatTheScreenHas) {
    for (const Case& c : random_cases(100, 50)) {
        MappedBarycentrics mapped({affine}, c.on_screen, c.clipped);
        const mat3 whole_from_piece(c.clipped[0].barycentrics, c.clipped[1].barycentrics,
                                    c.clipped[2].barycentrics);
        for (const auto& row : rows_of(c.on_screen))
            for (std::size_t i = 0; i < row.size(); ++i) {
                const vec3 expected = whole_from_piece * row[i].screen_barycentrics;
                const FragmentBarycentrics here =
                    mapped.at(row[i].pixel, row[i].screen_barycentrics);
                ASSERT_EQ(here.here, expected);
                if (i == 0) continue;
                // Screen barycentrics are within 2 ulp each; so is their difference, twice.
                const vec3 before = whole_from_piece * row[i - 1].screen_barycentrics;
                ASSERT_LT(greatest(here.ddx - (expected - before)), 8 * ulp);
            }
    }
}

TEST(LabTextures, SpansAreExactAtTheirEndsAndStraightBetween) {
    std::mt19937 random(1);
    for (const double left_out : {0.0, 0.9})  // often more of them than a span is long
        for (const float greatest_w : {50.0f, 1e12f}) {
            std::bernoulli_distribution is_left_out(left_out);
            int within = 0;
            for (const Case& c : random_cases(200, greatest_w))
                for (const int every : spans) {
                    within += expect_straight_spans(c, every, [&] { return is_left_out(random); });
                    ASSERT_FALSE(HasFailure()) << "with a share left out of " << left_out;
                }
            EXPECT_GT(within, 5'000);
        }
}

TEST(LabTextures, AffineIsWrongByNineElevenths) {
    // Where w runs from 1 to 100, u = x / (100 - 99x), and x - u is greatest at x = 10/11.
    const ClippedTriangle far =
        whole({vec4(-1, -1, 0, 1), vec4(100, -100, 0, 100), vec4(-1, 1, 0, 1)});
    const Case c{far, projected(far, size).on_screen};
    std::vector<float> worst;
    for (const int mapping : {affine, 64, 32, 16, 8, 4, 1}) {
        MappedBarycentrics mapped({mapping}, c.on_screen, c.clipped);
        worst.push_back(0);
        fill_triangle(c.on_screen, size, [&](ivec2 pixel, vec3 screen_barycentrics) {
            const float x = (static_cast<float>(pixel.x) + 0.5f) / static_cast<float>(size.x);
            const float u = mapped.at(pixel, screen_barycentrics).here.y;
            worst.back() = std::max(worst.back(), std::abs(u - x / (100 - 99 * x)));
        });
    }
    EXPECT_NEAR(worst[0], 9.0f / 11, 1e-3f);  // no centre lies at 10/11
    for (std::size_t i = 1; i < worst.size(); ++i) EXPECT_LT(worst[i], 0.9f * worst[i - 1]);
    EXPECT_LT(worst.back(), 32 * ulp);  // of x and u
}

TEST(LabTextures, BytesDecodedWhenReadGiveWhatDecodingAtOnceGives) {
    const DecodingTable table;
    for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) {
        const Image<u8vec4> texels = random_picture({7, 5});
        const EncodedLevel encoded = make_encoded_level(texels, wrap);
        const TextureLevel decoded = with_border(linear_from_srgb8(texels), wrap);
        for (int y = 0; y <= 64; ++y)
            for (int x = 0; x <= 64; ++x) {
                const vec2 place = vec2(x, y) / 64.0f;
                const vec4 expected = sample_bilinear(decoded, place);
                ASSERT_EQ(sample_by_table(encoded, place, table), expected);
                ASSERT_EQ(sample_by_power(encoded, place), expected);
            }
    }
}

TEST(LabTextures, DecodingTheMeanIsTooDarkBetweenCentres) {
    const Image<u8vec4> texels = random_picture({7, 5});
    const EncodedLevel encoded = make_encoded_level(texels, Wrap::repeat);
    const TextureLevel decoded = with_border(linear_from_srgb8(texels), Wrap::repeat);
    for (int y = 0; y <= 64; ++y)
        for (int x = 0; x <= 64; ++x) {
            const vec2 place = vec2(x, y) / 64.0f;
            const vec4 mean = sample_bilinear(decoded, place);
            const vec4 dark = sample_then_decode(encoded, place);
            for (int channel = 0; channel < 3; ++channel)
                ASSERT_LE(dark[channel], mean[channel] + 8 * ulp);  // of a power of 2.4
            ASSERT_EQ(dark.a, mean.a);  // opacity is light's share in either case
        }
    // Black and white: the mean code 0.5 stands for ((0.5 + 0.055) / 1.055)^2.4.
    Image<u8vec4> two({2, 1}, u8vec4(255));
    two[{0, 0}] = {0, 0, 0, 255};
    const EncodedLevel level = make_encoded_level(two, Wrap::clamp);
    EXPECT_NEAR(sample_then_decode(level, {0.5f, 0.5f}).r, 0.21404f, 1e-5f);
    EXPECT_EQ(sample_then_decode(level, {0.25f, 0.5f}), vec4(0, 0, 0, 1)) << "a centre";
    EXPECT_EQ(sample_then_decode(level, {0.75f, 0.5f}), vec4(1)) << "a centre";
}

TEST(LabTextures, EveryOptionDraws) {
    const Image<u8vec4> usual = picture({});
    EXPECT_EQ(difference(usual, picture({"--mapping", "perspective", "--filter", "trilinear",
                                         "--wrap", "repeat", "--srgb", "decoded"})),
              0);
    for (const auto& [option, word] : {std::pair{"--filter", "nearest"},
                                       {"--filter", "bilinear"},
                                       {"--wrap", "mirror"},
                                       {"--wrap", "clamp"},
                                       {"--srgb", "ignored"}})
        EXPECT_GT(difference(usual, picture({option, word})), 10'000) << option << " " << word;

    // The fewer divisions, the farther from the exact picture.
    const std::string model = std::string(RASTERBOOK_ASSETS) + "/models/horizon.obj";
    const Image<u8vec4> exact = picture({"--model", model});
    std::vector<long> differences;
    for (const std::string mapping : {"affine", "64", "32", "16", "8", "4", "perspective"})
        differences.push_back(difference(exact, picture({"--model", model, "--mapping", mapping})));
    EXPECT_TRUE(std::is_sorted(differences.rbegin(), differences.rend()))
        << testing::PrintToString(differences);
    EXPECT_EQ(std::adjacent_find(differences.begin(), differences.end()), differences.end());
    EXPECT_EQ(differences.back(), 0);
}
