// SPDX-License-Identifier: MIT
// Normals in textures: UNORM values, heights, channels, and the surface normals they perturb.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <utility>

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

/// One rounding of numbers up to 1.
constexpr float one_rounding = FLT_EPSILON;

const std::filesystem::path textures = std::filesystem::path(RASTERBOOK_ASSETS) / "textures";

/// A picture of black, but for the texels of the leftmost column or the lowest row.
Image<u8vec4> with_edge(ivec2 size, bool is_column, std::uint8_t code) {
    Image<u8vec4> picture(size, {0, 0, 0, 255});
    for (int i = 0; i < (is_column ? size.y : size.x); ++i)
        picture[is_column ? ivec2(0, i) : ivec2(i, size.y - 1)] = {code, code, code, 255};
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
        EXPECT_TRUE(are_near(perturbed(frame, {0.36f, 0.48f, 0.8f}, frame.normal),
                             {0.768, 0.424, -0.48 * handedness}, 4 * one_rounding))
            << "the texel (0.36, 0.48, 0.8) in the frame of tangent " << shown(frame.tangent)
            << ", bitangent " << shown(frame.bitangent) << ", normal " << shown(frame.normal);
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
}

TEST(NormalMaps, HardCase_AFlatNormalPerturbsNothing) {
    look_up("Robust: A flat map changes nothing");
    const Image<vec4> flat({4, 4}, vec4(out_of_the_surface, 1));
    const TangentFrame frame{vec3(2, 2, 1) / 3.0f, vec3(-2, 1, 2) / 3.0f, vec3(1, -2, 2) / 3.0f};
    const vec3 interpolated = 0.97f * frame.normal;  // not of length 1
    for (const Wrap wrap : all_wraps)
        for (const Filter filter : all_filters) {
            const FragmentUv at{vec2(-3.3f, 7.9f), vec2(0.9f, 0.1f), vec2(0.2f, 0.3f)};
            const vec3 normal = sample_normal(make_texture(flat, wrap), filter, at);
            ASSERT_EQ(normal, out_of_the_surface) << "a map of (0, 0, 1) at uv (-3.3, 7.9)";
            ASSERT_EQ(perturbed(frame, normal, interpolated), interpolated)
                << "to the last bit: a map's (0, 0, 1) leaves the normal as it is, even if that is "
                   "not of length 1";
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
    for (int green = 0; green < 256; ++green) {
        const Image<u8vec4> up({1, 1}, u8vec4(200, green, 220, 255));
        const Image<u8vec4> down({1, 1}, u8vec4(200, 255 - green, 220, 255));
        ASSERT_TRUE(are_near(normals_from_unorm(down, Green::down)[{0, 0}],
                             dvec4(normals_from_unorm(up, Green::up)[{0, 0}]), one_rounding))
            << "of the texel (200, " << 255 - green << ", 220), green down";
    }
}

TEST(NormalMaps, Eq8_8_TheThirdComponentFromTwo) {
    EXPECT_NEAR(with_z(vec2(0.6f, 0.48f)).z, 0.64f, one_rounding);  // the worked example
    EXPECT_EQ(with_z(vec2(0, 0)), out_of_the_surface);
    EXPECT_NEAR(with_z(vec2(0.48f, -0.64f)).z, 0.6f, one_rounding);
    EXPECT_EQ(with_z(vec2(1, 0)).z, 0);
    EXPECT_EQ(with_z(vec2(0.9f, 0.9f)).z, 0) << "too long for a third";
    EXPECT_EQ(with_z(vec2(-3, 4)), vec3(-3, 4, 0));
}

TEST(NormalMaps, Eq8_9_AWorkedExample) {
    const vec4 n = normals_from_heights(with_edge({4, 3}, false, 102), Wrap::repeat)[{1, 1}];
    EXPECT_NEAR(n.y, 0.6f, one_rounding)
        << "4 x 3 texels, the lowest row 102, the others 0; the texel (1, 1): the surface falls "
           "upwards, so the normal leans up. Rows run down";
    Image<u8vec4> picture({4, 3}, {102, 102, 102, 255});
    for (int y = 0; y < 3; ++y) picture[{0, y}] = {0, 0, 0, 255};
    EXPECT_TRUE(are_near(normals_from_heights(picture, Wrap::repeat)[{1, 1}], {-0.8, 0, 1, 1},
                         one_rounding))
        << "4 x 3 texels, the column on the left 0, the others 102; the texel (1, 1)";
}

TEST(NormalMaps, Eq8_9_HeightsBeyondTheBorder) {
    const Image<u8vec4> picture = with_edge({4, 4}, true, 255), low = with_edge({4, 4}, false, 255);
    // Differences over two texels of 1/4: a step of 1 is a slope of 2.
    for (const auto& [wrap, expected] : {std::pair{Wrap::repeat, vec4(0, 2, 0, -2)},
                                         {Wrap::clamp, vec4(2, 2, 0, 0)},
                                         {Wrap::mirror, vec4(2, 2, 0, 0)}}) {
        const Image<vec4> across = normals_from_heights(picture, wrap);
        const Image<vec4> upwards = normals_from_heights(low, wrap);
        for (int i = 0; i < 4; ++i) {
            EXPECT_EQ(across[ivec2(i, 2)], vec4(expected[i], 0, 1, 1))
                << "4 x 4 texels, the column on the left 255, the others 0; texel (" << i
                << ", 2), wrap " << name_of(wrap);
            EXPECT_EQ(upwards[ivec2(1, 3 - i)], vec4(0, expected[i], 1, 1))
                << "4 x 4 texels, the lowest row 255, the others 0; texel (1, " << 3 - i
                << "), wrap " << name_of(wrap);
        }
    }
}

TEST(NormalMaps, Eq8_9_HeightMapsAndNormalMapsAgree) {
    // The generator made both maps from the same surface, the heights rounded to 255 steps.
    const Image<vec4> normals =
        normals_from_unorm(read_image(textures / "brick_normal.png"), Green::up);
    const Image<vec4> from_heights =
        normals_from_heights(read_image(textures / "brick_height.png"), Wrap::repeat);
    constexpr float bump_multiplier = 0.014f;  // as crate_bump.mtl says: -bm
    // A difference of two codes is off by at most one step in all: .8 degrees; a component of the
    // normal map by half a step.
    const double most =
        glm::degrees(std::atan(std::sqrt(2.0) * bump_multiplier * 512 / 2 / 255)) + 0.4;
    double greatest = 0;
    for (std::size_t i = 0; i < normals.pixels().size(); ++i) {
        const vec4 n = from_heights.pixels()[i];
        greatest = std::max(greatest,
                            degrees_between(vec3(normals.pixels()[i]),
                                            {bump_multiplier * n.x, bump_multiplier * n.y, n.z}));
    }
    EXPECT_LT(greatest, most)
        << "degrees between brick_normal.png and the normals of brick_height.png";
}

TEST(NormalMaps, HardCase_HeightsThatAreAllEqualAreFlat) {
    look_up("Eq. 8.9");
    for (const ivec2 size : {ivec2(1), ivec2(1, 7), ivec2(5, 1), ivec2(3, 5)})
        for (const Wrap wrap : all_wraps)
            ASSERT_TRUE(are_equal(normals_from_heights(Image<u8vec4>(size, u8vec4(128)), wrap),
                                  Image<vec4>(size, vec4(0, 0, 1, 1))))
                << "all heights are 128";
}

TEST(NormalMaps, HardCase_MirroredCopiesOfAMap) {
    look_up("Robust: Seen from behind, and in mirrored copies");
    // The normals all point to the right and up: in a mirrored copy they point to the left.
    const vec3 n(0.6f, 0.48f, 0.64f);
    Texture texture = make_texture(Image<vec4>({8, 8}, vec4(n, 1)), Wrap::mirror);
    const auto at = [&](vec2 uv) {
        return sample_normal(texture, Filter::bilinear, FragmentUv{uv, vec2(0), vec2(0)});
    };
    for (const float copy : {-4.0f, 0.0f, 100.0f}) {
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
    for (int channel = 0; channel < 3; ++channel) {
        Image<u8vec4> picture({3, 3}, {7, 7, 7, 255});
        picture[{2, 2}][channel] = 8;
        EXPECT_FALSE(is_gray(picture)) << channel;
    }
}
