// SPDX-License-Identifier: MIT
// Normals in textures: UNORM values, heights, channels, and the surface normals they perturb.
#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>

#include "08_normal_maps/normal_map.hpp"
#include "common/image/image_io.hpp"
#include "support/first_difference.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/printers.hpp"
#include "support/texture_names.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr vec3 out_of_the_surface(0, 0, 1);

/// One rounding, and a few, of numbers up to 1.
constexpr float one_rounding = FLT_EPSILON, roundings = 4 * FLT_EPSILON;

/// Not parallel to the axes, so that nothing is right by chance.
TangentFrame some_frame(float handedness = 1) {
    return {vec3(2, 2, 1) / 3.0f, handedness / 3.0f * vec3(-2, 1, 2), vec3(1, -2, 2) / 3.0f};
}

/// A height map, from a function of the texels' centres; x right and y up, 0 to 1.
template <typename Height>
Image<u8vec4> heights(ivec2 size, Height&& height) {
    Image<u8vec4> picture(size);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const double code = height((x + 0.5) / size.x, 1 - (y + 0.5) / size.y);
            picture[{x, y}] = u8vec4(u8vec3(static_cast<std::uint8_t>(code)), 255);
        }
    return picture;
}

}  // namespace

TEST(NormalMaps, Eq8_1_AWorkedExample) {
    EXPECT_NEAR(component_from_unorm(64), -0.498f, 0.0005f) << "the value 64 of 255";
    EXPECT_NEAR(component_from_unorm(128), 0.0039f, 0.00005f)
        << "the value 128 of 255; exactly 0 would be (c - 128) / 127, for which normal maps are "
           "not made";
    EXPECT_NEAR(component_from_unorm(127), -0.0039f, 0.00005f) << "the value 127 of 255";
    EXPECT_NEAR(component_from_unorm(192), 129 / 255.0f, one_rounding) << "the value 192 of 255";
}

TEST(NormalMaps, Eq8_1_ValuesAtTheEndsAndOnEitherSideOfTheMiddle) {
    for (int bits = 2; bits <= 16; ++bits) {
        const std::uint32_t greatest = (1u << bits) - 1;
        ASSERT_EQ(component_from_unorm(0, bits), -1.0f) << "the least of " << bits << " bits";
        ASSERT_EQ(component_from_unorm(greatest, bits), 1.0f) << "the greatest of " << bits;
        const float step = 2 / static_cast<float>(greatest);
        for (std::uint32_t k = 0; k <= greatest; k += 1 + greatest / 500) {
            ASSERT_NEAR(component_from_unorm(k, bits), static_cast<float>(k) * step - 1,
                        2 * one_rounding)
                << "the value " << k << " of " << bits << " bits";
            // The same on either side, so that no direction is preferred.
            ASSERT_NEAR(component_from_unorm(greatest - k, bits), -component_from_unorm(k, bits),
                        one_rounding)
                << bits << " bits, the values " << greatest - k << " and " << k;
        }
    }
}

TEST(NormalMaps, Eq8_1_WhatAnEncoderRoundsIsDecodedWithinHalfAStep) {
    // As tools store a normal: 255 (n + 1) / 2, rounded.
    std::mt19937 random(4);
    std::normal_distribution<double> any;
    double greatest_degrees = 0, sum_of_squares = 0;
    dvec3 sum(0);
    constexpr int count = 100'000;
    for (int i = 0; i < count; ++i) {
        const dvec3 n = glm::normalize(dvec3(any(random), any(random), any(random)));
        vec3 decoded;
        for (int axis = 0; axis < 3; ++axis) {
            const auto value = static_cast<std::uint32_t>(255 * (n[axis] + 1) / 2 + 0.5);
            decoded[axis] = component_from_unorm(value);
            ASSERT_NEAR(decoded[axis], n[axis], 1 / 255.0 + one_rounding)
                << "the value " << value << ", which a tool stores for " << n[axis]
                << " (seed 4, case " << i << ")";
        }
        const double degrees = degrees_between(decoded, vec3(n));
        greatest_degrees = std::max(greatest_degrees, degrees);
        sum_of_squares += degrees * degrees;
        sum += dvec3(decoded) - n;
    }
    // Half a step in each of three components: sqrt(3)/2 times 2/255, as an angle.
    EXPECT_LT(greatest_degrees, 0.3892);
    EXPECT_NEAR(std::sqrt(sum_of_squares / count), 0.184, 0.001) << "degrees, RMS";
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(sum[axis] / count, 0, 0.0001)
            << "the mean error; (c - 128) / 127 has -0.0039, half a step";
}

TEST(NormalMaps, Eq8_1_GreenUpAndGreenDown) {
    Image<u8vec4> image({2, 1}, {192, 160, 240, 255});
    image[{1, 0}] = {10, 20, 30, 40};
    const Image<vec4> up = normals_from_unorm(image, Green::up);
    const Image<vec4> down = normals_from_unorm(image, Green::down);
    EXPECT_EQ(up[ivec2(0)], vec4(component_from_unorm(192), component_from_unorm(160),
                                 component_from_unorm(240), 1))
        << "the texel (192, 160, 240), green up";
    for (const ivec2 texel : {ivec2(0), ivec2(1, 0)}) {
        EXPECT_EQ(down[texel], up[texel] * vec4(1, -1, 1, 1))
            << "green down, beside green up of the same texel";
        EXPECT_EQ(up[texel].w, 1);
    }
}

TEST(NormalMaps, Eq8_7_AWorkedExample) {
    for (const float handedness : {1.0f, -1.0f}) {
        const TangentFrame frame{{0.8f, -0.6f, 0}, {0, 0, -handedness}, {0.6f, 0.8f, 0}};
        const vec3 normal = perturbed(frame, {0.36f, 0.48f, 0.8f}, frame.normal);
        const vec3 expected(0.768f, 0.424f, -0.48f * handedness);
        const vec3 off = glm::abs(normal - expected);
        ASSERT_LE(std::max({off.x, off.y, off.z}), roundings)
            << "the texel (0.36, 0.48, 0.8) in the frame of tangent "
            << testing::PrintToString(frame.tangent) << ", bitangent "
            << testing::PrintToString(frame.bitangent) << ", normal "
            << testing::PrintToString(frame.normal) << ": perturbed() gives "
            << testing::PrintToString(normal) << ", expected " << testing::PrintToString(expected);
    }
}

TEST(NormalMaps, Eq8_7_TheMapsNormalInTheFrame) {
    // In the frame of the axes they are the map's own numbers.
    const TangentFrame axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    EXPECT_EQ(perturbed(axes, {0.6f, 0, 0.8f}, axes.normal), vec3(0.6f, 0, 0.8f));
    // A floor, u to the right and v away from us: right in the map is x, up is -z, out is y.
    const TangentFrame floor{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
    EXPECT_EQ(perturbed(floor, {0.6f, 0, 0.8f}, floor.normal), vec3(0.6f, 0.8f, 0));
    EXPECT_EQ(perturbed(floor, {0, 0.6f, 0.8f}, floor.normal), vec3(0, 0.8f, -0.6f));
    // Each direction counts by itself, and lengths and angles stay.
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(-1, 1);
    for (const float handedness : {1.0f, -1.0f}) {
        const TangentFrame frame = some_frame(handedness);
        for (int i = 0; i < 1000; ++i) {
            const vec3 a(any(random), any(random), any(random));
            const vec3 normal = perturbed(frame, a, frame.normal);
            ASSERT_NEAR(glm::dot(normal, frame.tangent), a.x, roundings)
                << "seed 1, case " << i << ": along the tangent, the map has "
                << testing::PrintToString(a);
            ASSERT_NEAR(glm::dot(normal, frame.bitangent), a.y, roundings)
                << "seed 1, case " << i << ": along the bitangent, the map has "
                << testing::PrintToString(a);
            ASSERT_NEAR(glm::dot(normal, frame.normal), a.z, roundings)
                << "seed 1, case " << i << ": along the normal, the map has "
                << testing::PrintToString(a);
        }
    }
}

TEST(NormalMaps, HardCase_AFlatNormalPerturbsNothing) {
    look_up("Robust: A flat map changes nothing");
    const Image<vec4> flat({4, 4}, vec4(out_of_the_surface, 1));
    const TangentFrame frame = some_frame();
    const vec3 interpolated = 0.97f * frame.normal;  // not of length 1
    for (const Wrap wrap : all_wraps) {
        const Texture texture = make_texture(flat, wrap);
        for (const Filter filter : all_filters)
            for (const vec2 uv : {vec2(0), vec2(0.3f, 0.7f), vec2(-3.3f, 7.9f)}) {
                const FragmentUv at{uv, vec2(0.9f, 0.1f), vec2(0.2f, 0.3f)};
                const vec3 normal = sample_normal(texture, filter, at);
                ASSERT_EQ(normal, out_of_the_surface)
                    << "a map of (0, 0, 1) at uv " << testing::PrintToString(uv);
                ASSERT_EQ(perturbed(frame, normal, interpolated), interpolated)
                    << "to the last bit: a map's (0, 0, 1) leaves the normal as it is, even if "
                       "that is not of length 1";
            }
    }
}

TEST(NormalMaps, HardCase_TheFlatTexelIsAThirdOfADegreeOff) {
    look_up("Robust: No byte is zero");
    const vec3 flat(
        normals_from_unorm(Image<u8vec4>({1, 1}, {128, 128, 255, 255}), Green::up)[{0, 0}]);
    EXPECT_NEAR(degrees_between(flat, out_of_the_surface), 0.318, 0.001)
        << "degrees between the texel (128, 128, 255) and (0, 0, 1)";
    EXPECT_EQ(flat.x, flat.y) << "as much to the right as up";
    EXPECT_EQ(flat.z, 1);
}

TEST(NormalMaps, HardCase_GreenUpAndGreenDownMapsLookTheSame) {
    look_up("Robust: Up or down");
    // The same surface, stored either way, and read as it is stored.
    const Image<u8vec4> up =
        read_image(std::filesystem::path(RASTERBOOK_ASSETS) / "textures/hammered_normal.png");
    Image<u8vec4> down = up;
    for (u8vec4& texel : down.pixels()) texel.g = static_cast<std::uint8_t>(255 - texel.g);
    const Image<vec4> a = normals_from_unorm(up, Green::up);
    const Image<vec4> b = normals_from_unorm(down, Green::down);
    const Image<vec4> wrong = normals_from_unorm(up, Green::down);
    double greatest = 0, greatest_of_wrong = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
        const vec3 normal(a.pixels()[i]);
        greatest = std::max(greatest, degrees_between(vec3(b.pixels()[i]), normal));
        greatest_of_wrong =
            std::max(greatest_of_wrong, degrees_between(vec3(wrong.pixels()[i]), normal));
    }
    EXPECT_LT(greatest, 1e-4) << "degrees: green down, beside the same surface with green up";
    EXPECT_GT(greatest_of_wrong, 10) << "green down makes no difference";
}

TEST(NormalMaps, Eq8_8_TheThirdComponentFromTwo) {
    EXPECT_EQ(with_z(vec2(0, 0)), out_of_the_surface);
    EXPECT_NEAR(with_z(vec2(0.6f, 0)).z, 0.8f, one_rounding);
    EXPECT_NEAR(with_z(vec2(0.6f, 0.48f)).z, 0.64f, one_rounding);  // the worked example
    EXPECT_NEAR(with_z(vec2(0.48f, -0.64f)).z, 0.6f, one_rounding);
    EXPECT_EQ(with_z(vec2(1, 0)).z, 0);
    EXPECT_EQ(with_z(vec2(0.9f, 0.9f)).z, 0) << "too long for a third";
    EXPECT_EQ(with_z(vec2(-3, 4)), vec3(-3, 4, 0));
    std::mt19937 random(2);
    std::uniform_real_distribution<float> any(-1, 1);
    for (int i = 0; i < 1000; ++i) {
        const vec3 unit = unit_or({any(random), any(random), any(random)}, vec3(1, 0, 0));
        const vec3 found = with_z(vec2(unit));
        ASSERT_EQ(vec2(found), vec2(unit)) << "x and y stay; seed 2, case " << i;
        // Where z is small, its square is what is left of 1: that rounds to some 2^-23.
        ASSERT_NEAR(found.z * found.z, unit.z * unit.z, 4 * one_rounding)
            << "with_z() of " << testing::PrintToString(vec2(unit)) << ", seed 2, case " << i;
    }
}

TEST(NormalMaps, Eq8_9_AWorkedExample) {
    Image<u8vec4> picture({4, 3}, {102, 102, 102, 255});
    for (int y = 0; y < 3; ++y) picture[{0, y}] = {0, 0, 0, 255};
    const vec4 n = normals_from_heights(picture, Wrap::repeat)[{1, 1}];
    const char* const where =
        "4 x 3 texels, the column on the left 0, the others 102; the texel (1, 1)";
    EXPECT_NEAR(n.x, -0.8f, one_rounding) << where;
    EXPECT_EQ(n.y, 0) << where;
    EXPECT_EQ(n.z, 1) << where;
    EXPECT_NEAR(degrees_between(vec3(n), out_of_the_surface), 38.7, 0.05);
    EXPECT_NEAR(degrees_between({0.5f * n.x, n.y, n.z}, out_of_the_surface), 21.8, 0.05);
    // The same from below.
    Image<u8vec4> low({4, 3}, {0, 0, 0, 255});
    for (int x = 0; x < 4; ++x) low[{x, 2}] = {102, 102, 102, 255};
    EXPECT_NEAR((normals_from_heights(low, Wrap::repeat)[{1, 1}].y), 0.6f, one_rounding)
        << "4 x 3 texels, the lowest row 102, the others 0; the texel (1, 1): the surface falls "
           "upwards, so the normal leans up. Rows run down";
}

TEST(NormalMaps, Eq8_9_SlopesOfHeights) {
    // A ramp: one code higher with each texel to the right, two with each one upwards. So from side
    // to side it rises by 16/255 and 2 * 8/255 sides.
    const ivec2 size(16, 8);
    const Image<u8vec4> ramp = heights(size, [&](double x, double y) {
        return 50 + std::floor(x * size.x) + 2 * std::floor(y * size.y);
    });
    const Image<vec4> normals = normals_from_heights(ramp, Wrap::clamp);
    for (int y = 1; y + 1 < size.y; ++y)
        for (int x = 1; x + 1 < size.x; ++x) {
            const vec4 n = normals[{x, y}];
            ASSERT_NEAR(n.x, -16 / 255.0f, 16 * one_rounding)
                << "16 x 8 texels, each one code higher than that on its left; texel (" << x << ", "
                << y << ")";
            ASSERT_NEAR(n.y, -16 / 255.0f, 16 * one_rounding)
                << "16 x 8 texels, each two codes higher than that below it; texel (" << x << ", "
                << y << ")";
            ASSERT_EQ(n.z, 1);
            ASSERT_EQ(n.w, 1);
        }
    // A step up to the right has a normal that points to the left, one upwards points down.
    EXPECT_LT((normals[{5, 5}].x), 0) << "higher to the right: the normal leans to the left";
    EXPECT_LT((normals[{5, 5}].y), 0) << "higher upwards: the normal leans down";
}

TEST(NormalMaps, Eq8_9_HeightsBeyondTheBorder) {
    // One high column at the left border.
    Image<u8vec4> picture({4, 4}, {0, 0, 0, 255});
    for (int y = 0; y < 4; ++y) picture[{0, y}] = {255, 255, 255, 255};
    const auto row = [&](Wrap wrap) {
        const Image<vec4> normals = normals_from_heights(picture, wrap);
        for (int y = 0; y < 4; ++y) EXPECT_EQ((normals[{1, y}].y), 0);
        return std::array{normals[{0, 2}].x, normals[{1, 2}].x, normals[{2, 2}].x,
                          normals[{3, 2}].x};
    };
    // Differences over two texels of 1/4: a step of 1 is a slope of 2.
    const char* const what =
        "x of a row's normals; 4 x 4 texels, the column on the left 255, the others 0";
    EXPECT_EQ(row(Wrap::repeat), (std::array{0.0f, 2.0f, 0.0f, -2.0f})) << what;
    EXPECT_EQ(row(Wrap::clamp), (std::array{2.0f, 2.0f, 0.0f, 0.0f})) << what;
    EXPECT_EQ(row(Wrap::mirror), (std::array{2.0f, 2.0f, 0.0f, 0.0f})) << what;
    // The same from bottom to top; rows run down.
    Image<u8vec4> low({4, 4}, {0, 0, 0, 255});
    for (int x = 0; x < 4; ++x) low[{x, 3}] = {255, 255, 255, 255};
    const Image<vec4> normals = normals_from_heights(low, Wrap::clamp);
    for (int y = 0; y < 4; ++y)
        EXPECT_EQ((normals[{1, y}].y), y >= 2 ? 2 : 0)
            << "4 x 4 texels, the lowest row 255, the others 0, Wrap::clamp; texel (1, " << y
            << ")";
}

TEST(NormalMaps, Eq8_9_HeightMapsAndNormalMapsAgree) {
    // The generator made both maps from the same surface, the heights rounded to 255 steps.
    const std::filesystem::path textures = std::filesystem::path(RASTERBOOK_ASSETS) / "textures";
    const Image<vec4> normals =
        normals_from_unorm(read_image(textures / "brick_normal.png"), Green::up);
    const Image<vec4> from_heights =
        normals_from_heights(read_image(textures / "brick_height.png"), Wrap::repeat);
    constexpr float bump_multiplier = 0.014f;  // as crate_bump.mtl says: -bm
    // A difference of two codes is off by at most one step in all: .8 degrees; a component of the
    // normal map by half a step.
    const double most =
        std::atan(std::sqrt(2.0) * bump_multiplier * 512 / 2 / 255) * 180 / 3.14159 + 0.4;
    double greatest = 0, sum = 0;
    for (std::size_t i = 0; i < normals.pixels().size(); ++i) {
        const vec4 n = from_heights.pixels()[i];
        const double off = degrees_between(vec3(normals.pixels()[i]),
                                           {bump_multiplier * n.x, bump_multiplier * n.y, n.z});
        greatest = std::max(greatest, off), sum += off;
    }
    EXPECT_LT(greatest, most)
        << "degrees between brick_normal.png and the normals of brick_height.png";
    EXPECT_GT(greatest, 0.1) << "as if there were no steps";
    EXPECT_LT(sum / static_cast<double>(normals.pixels().size()), 0.5);
}

TEST(NormalMaps, HardCase_HeightsThatAreAllEqualAreFlat) {
    look_up("Eq. 8.9");
    for (const ivec2 size : {ivec2(1), ivec2(1, 7), ivec2(5, 1), ivec2(3, 5)})
        for (const int code : {0, 1, 128, 255})
            for (const Wrap wrap : all_wraps) {
                const Image<u8vec4> flat(size, u8vec4(static_cast<std::uint8_t>(code)));
                ASSERT_TRUE(are_equal(normals_from_heights(flat, wrap),
                                      Image<vec4>(size, vec4(0, 0, 1, 1))))
                    << "all heights are " << code;
            }
}

TEST(NormalMaps, HardCase_MirroredCopiesOfAMap) {
    look_up("Robust: Seen from behind, and in mirrored copies");
    // The normals all point to the right and up: in a mirrored copy they point to the left.
    Texture texture = make_texture(Image<vec4>({8, 8}, vec4(0.6f, 0.48f, 0.64f, 1)), Wrap::mirror);
    const auto at = [&](vec2 uv) {
        return sample_normal(texture, Filter::bilinear, FragmentUv{uv, vec2(0), vec2(0)});
    };
    const vec3 n(0.6f, 0.48f, 0.64f);
    for (const float copy : {-4.0f, -2.0f, 0.0f, 2.0f, 100.0f}) {
        EXPECT_EQ(at({copy + 0.3f, 0.2f}), n);
        EXPECT_EQ(at({copy + 1.3f, 0.2f}), n * vec3(-1, 1, 1));
        EXPECT_EQ(at({0.2f, copy + 1.7f}), n * vec3(1, -1, 1));
        EXPECT_EQ(at({copy - 0.7f, copy - 0.1f}), n * vec3(-1, -1, 1));
    }
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp}) {
        texture.wrap = wrap;
        EXPECT_EQ(at({1.3f, -0.2f}), n);
        texture.wrap = {Wrap::mirror, wrap};
        EXPECT_EQ(at({1.3f, -0.2f}), n * vec3(-1, 1, 1));
        texture.wrap = {wrap, Wrap::mirror};
        EXPECT_EQ(at({1.3f, -0.2f}), n * vec3(1, -1, 1));
    }
}

TEST(NormalMaps, HardCase_ColouredHeightsAreNormals) {
    look_up("Robust: Heights, or normals after all");
    EXPECT_TRUE(is_gray(Image<u8vec4>({3, 3}, {7, 7, 7, 1})));
    EXPECT_TRUE(is_gray(Image<u8vec4>()));
    EXPECT_FALSE(is_gray(Image<u8vec4>({3, 3}, {128, 128, 255, 255})));
    for (int channel = 0; channel < 3; ++channel) {
        Image<u8vec4> picture({3, 3}, {7, 7, 7, 255});
        picture[{2, 2}][channel] = 8;
        EXPECT_FALSE(is_gray(picture)) << channel;
    }
}
