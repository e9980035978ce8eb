// SPDX-License-Identifier: MIT
// Stages that take several lanes at a time beside those of earlier lessons, bit by bit: projecting
// triangles, sampling textures, asking shadow maps.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "04_mvp/transform.hpp"
#include "05_textures/texture.hpp"
#include "10_threading/binned_triangles.hpp"
#include "14_simd/simd.hpp"
#include "14_simd/wide_setup.hpp"
#include "14_simd/wide_shadows.hpp"
#include "14_simd/wide_textures.hpp"
#include "support/any_scene.hpp"
#include "support/lanes.hpp"
#include "support/look_up.hpp"
#include "support/near.hpp"
#include "support/printers.hpp"
#include "support/texture_names.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// Triangles of a mesh, and its positions in clip space.
struct TrianglesInClipSpace {
    Mesh mesh{};
    std::vector<vec4> positions{};

    void add(const std::array<vec4, 3>& vertices) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), vertices.begin(), vertices.end());
        mesh.triangles.push_back({{{{first}, {first + 1}, {first + 2}}}, 0});
    }
};

vec4 inside(Dice& dice) {
    const float w = dice.between(0.1f, 10);
    return {w * dice.in_cube(1), w};
}

std::string in_words(const ProjectedTriangle& projected) {
    std::string words;
    for (std::size_t v = 0; v < 3; ++v)
        words += "vertex " + shown(projected.clipped.at(v).position_clip) + ", barycentrics " +
                 shown(projected.clipped.at(v).barycentrics) + ", on the screen at " +
                 testing::PrintToString(projected.on_screen.vertices.at(v)) + "; ";
    return words + "twice the area " + std::to_string(projected.on_screen.twice_area) +
           "; least depth " + shown(projected.depth.farthest()) + ", above it " +
           shown(projected.depth.above_farthest()) +
           (projected.is_back_facing ? "; faces away" : "; faces the camera");
}

/// How many triangles are culled, and those that are left: each number of them to the bit.
std::vector<std::string> projected_by(ProjectTriangles* project,
                                      const TrianglesInClipSpace& triangles, ivec2 size,
                                      Culling culling) {
    std::vector<ProjectedTriangle> projected;
    const std::size_t culled = project(triangles.mesh, triangles.mesh.triangles,
                                       triangles.positions.data(), size, culling, projected);
    std::vector<std::string> all = {std::to_string(culled) + " are culled"};
    for (const ProjectedTriangle& one : projected)
        all.push_back("triangle " +
                      std::to_string(&one.triangle - triangles.mesh.triangles.data()) + ": " +
                      in_words(one));
    all.emplace_back("no other triangle");
    return all;
}

void compare(const TrianglesInClipSpace& triangles, ivec2 size) {
    for (const Culling culling : {Culling::none, Culling::back_faces}) {
        const auto expected = projected_by(&project_triangles, triangles, size, culling);
        for_each_width([&]<int N>() {
            const auto actual =
                projected_by(&project_triangles<Floats<N>>, triangles, size, culling);
            const auto first = std::ranges::mismatch(actual, expected);
            ASSERT_TRUE(actual == expected)
                << N << " at a time, on a picture of " << testing::PrintToString(size) << ":\n"
                << *first.in1 << "\nexpected:\n"
                << *first.in2;
        });
    }
}

Texture any_texture(Dice& dice, WrapModes wrap) {
    constexpr std::array sizes = {1, 2, 3, 5, 8, 16, 37, 64};
    Image<vec4> picture({sizes.at(dice.below(8)), sizes.at(dice.below(8))});
    for (vec4& texel : picture.pixels()) texel = vec4(dice.color(), dice.between(0, 1));
    Texture texture = make_texture(std::move(picture), wrap);
    if (dice.one_in(3)) texture.magnified = all_filters[dice.below(3)];
    if (dice.one_in(3)) texture.minified = all_filters[dice.below(3)];
    return texture;
}

/// Around 0 to 1, or any number.
vec2 any_uv(Dice& dice, bool is_special) {
    const vec2 uv(dice.in_cube(2.5f));
    if (!is_special) return uv;
    return {any_float(dice), any_float(dice)};
}

/// A change of uv that a level of 1 to 64 texels may have, or one far beyond.
vec2 any_change(Dice& dice, bool is_special) {
    const vec2 change(dice.in_cube(std::exp2(dice.between(-8, 2))));
    if (!is_special) return change;
    return {any_float(dice), dice.one_in(2) ? any_float(dice) : change.y};
}

ShadowBias any_bias(Dice& dice) {
    ShadowBias bias;
    if (dice.one_in(2)) bias.slope = vec2(dice.in_cube(0.05f));
    if (dice.one_in(2)) bias.bias = dice.one_in(5) ? 2 : dice.between(0, 0.1f);
    if (dice.one_in(2)) bias.bias_per_w = dice.between(0, 0.1f);
    if (dice.one_in(2)) bias.offset = dice.in_cube(0.1f);
    if (dice.one_in(2)) bias.offset_times_w = dice.in_cube(0.1f);
    return bias;
}

/// A map whose depths are any; of a directional light or of one in perspective.
ShadowMap any_map(Dice& dice, bool is_perspective) {
    Bounds bounds;
    bounds.add(vec3(-1)), bounds.add(vec3(1));
    mat4 clip(1);
    if (is_perspective)  // looks down z from (0, 0, 2)
        clip = perspective(1.2f, 1.0f, 0.2f) * translation(vec3(0, 0, -2));
    ShadowMap map(clip, is_perspective, 8 + static_cast<int>(dice.below(40)), bounds);
    const ivec2 all = map.depths.depths().size();
    for (int y = 0; y < all.y; ++y)
        for (int x = 0; x < all.x; ++x)
            map.depths.test_and_write({x, y}, dice.one_in(5) ? 0 : dice.between(0, 1));
    return map;
}

vec3 any_point(Dice& dice, bool is_special) {
    vec3 p = dice.in_cube(1.1f);
    if (is_special && dice.one_in(3)) p[static_cast<int>(dice.below(3))] = any_float(dice);
    if (is_special && dice.one_in(3)) p = dice.in_cube(5);
    return p;
}

}  // namespace

TEST(Simd, HardCase_RoundedNumbersAreThoseOfLrint) {
    look_up("Eq. 2.8");
    for_each_width([]<int N>() {
        Dice dice(1);
        for (int k = 0; k < 20'000; ++k) {
            PerLane<float, N> x;
            for (float& number : x) {
                number = std::ldexp(dice.between(0, 1), static_cast<int>(dice.below(32)) - 1);
                if (dice.one_in(4)) number = std::floor(number) + 0.5f;
            }
            ASSERT_TRUE(has_in_lanes(rounded(in_lanes<N>(x)),
                                     [&](int i) { return static_cast<float>(std::lrint(x[i])); }))
                << list_of(x) << " rounded";
        }
    });
}

TEST(Simd, HardCase_TrianglesOnTheFrustumsBorderAreNotClipped) {
    look_up("Eq. 4.10");
    TrianglesInClipSpace on_border;
    for (int i = 0; i < 4; ++i)
        on_border.add({vec4(-2, -2, 2, 2), vec4(1, -1, 0, 1), vec4(-0.5f, 0.5f, 0.25f, 0.5f)});
    for_each_width([&]<int N>() {
        const std::vector some(std::size_t{N}, on_border.mesh.triangles[0]);
        const auto on_screen = project_plain<N>(some, on_border.positions.data(), {64, 64});
        EXPECT_TRUE(all_of(on_screen.is_plain)) << "its corners are three of the frustum's";
    });
    for (const auto& [vertex, outside, where] :
         {std::tuple(0, vec4(std::nextafter(-2.0f, -3.0f), -2, 2, 2), "to the left of"),
          std::tuple(0, vec4(-2, -2, std::nextafter(2.0f, 3.0f), 2), "before"),
          std::tuple(1, vec4(1, -1, -0x1p-149f, 1), "beyond")}) {
        TrianglesInClipSpace across = on_border;
        across.positions[static_cast<std::size_t>(vertex)] = outside;
        for_each_width([&]<int N>() {
            const std::vector some(std::size_t{N}, across.mesh.triangles[0]);
            const auto on_screen = project_plain<N>(some, across.positions.data(), {64, 64});
            EXPECT_FALSE(any_of(on_screen.is_plain))
                << "a vertex is an ulp " << where << " the frustum";
        });
        compare(across, {64, 64});
    }
}

TEST(Simd, HardCase_ProjectedTrianglesAreLesson10s) {
    look_up("Eq. 2.8");
    Dice dice(3);
    constexpr std::array sides = {1, 480, 16384, (1 << 17) - 1, 1 << 17, 1 << 20, 1 << 22};
    for (int k = 0; k < 1000; ++k) {
        // All inside of the frustum, or some of them clipped, or with unusual numbers: these must
        // change no other triangle.
        TrianglesInClipSpace triangles;
        for (std::uint32_t i = dice.below(70); i > 0; --i) {
            std::array vertices = {inside(dice), inside(dice), inside(dice)};
            for (vec4& vertex : vertices)
                if (k % 3 == 1 && dice.one_in(4)) vertex = {dice.in_cube(4), dice.between(-1, 3)};
            if (k % 3 == 2 && dice.one_in(8))
                vertices.at(dice.below(3))[static_cast<int>(dice.below(4))] = any_float(dice);
            if (k % 3 == 2 && dice.one_in(64)) vertices[2] = vec4(any_float(dice));
            if (dice.one_in(8)) vertices[1] = vertices[0];  // no area
            triangles.add(vertices);
        }
        // On huge pictures, too, no area is rounded.
        compare(triangles, k % 4 ? ivec2(1 + dice.below(2000), 1 + dice.below(2000))
                                 : ivec2(sides.at(dice.below(sides.size()))));
    }
}

TEST(Simd, HardCase_SamplesHaveLesson05sBits) {
    look_up("Eq. 14.3");
    for_each_width([]<int N>() {
        Dice dice(N);
        int divergent = 0;
        for (int k = 0; k < 36'000 / N; ++k) {
            const WrapModes wrap(all_wraps[dice.below(3)], all_wraps[dice.below(3)]);
            const Texture texture = any_texture(dice, wrap);
            const ivec2 size = texture.levels[0].size;
            PerLane<vec2, N> here, ddx, ddy;
            // All special, some, or none; neighbours, or anywhere.
            const bool are_any = dice.one_in(3);
            const vec2 middle = any_uv(dice, false), change = any_change(dice, false);
            for (int i = 0; i < N; ++i) {
                const bool is_special = are_any && dice.one_in(3);
                const auto number = static_cast<float>(i);
                here[i] = are_any ? any_uv(dice, is_special) : middle + change * number;
                ddx[i] = are_any ? any_change(dice, is_special) : change * (1 + 0.1f * number);
                ddy[i] = are_any ? any_change(dice, is_special) : vec2(-change.y, change.x);
            }
            for (const Filter filter : all_filters) {
                const glm::vec<4, Floats<N>> actual =
                    sample(texture, filter,
                           TextureCoordinates<Floats<N>>{in_lanes<N>(here), in_lanes<N>(ddx),
                                                         in_lanes<N>(ddy)});
                for (int c = 0; c < 4; ++c)
                    ASSERT_TRUE(has_in_lanes(
                        actual[c],
                        [&](int i) {
                            return sample(texture, filter, FragmentUv{here[i], ddx[i], ddy[i]})[c];
                        }))
                        << "channel " << c << "; " << name_of(filter)
                        << " (its own: " << name_of(texture.magnified) << " and "
                        << name_of(texture.minified) << "), " << name_of(wrap.u) << " and "
                        << name_of(wrap.v) << ", a texture of " << testing::PrintToString(size)
                        << " texels, uv " << testing::PrintToString(here) << ", ddx "
                        << testing::PrintToString(ddx) << ", ddy " << testing::PrintToString(ddy);
            }
            const auto level = [&](int i) {
                return std::min(level_of_detail(ddx[i], ddy[i], size),
                                static_cast<float>(texture.levels.size() - 1));
            };
            divergent += std::floor(level(0)) != std::floor(level(N - 1));
        }
        EXPECT_GT(divergent, 1000 / N) << "batches whose lanes want different mip levels";
    });
}

TEST(Simd, Eq14_6_TimesOfTheWorkedExample) {
    // 36 operations and 64 bytes a sample, 100 operations and 10 bytes a nanosecond.
    constexpr std::size_t bytes = 4 * sizeof(vec4), operations = 4 * (3 + 3 + 3);
    EXPECT_EQ(bytes, 64u);
    EXPECT_EQ(operations, 36u);
    const auto milliseconds = [](double lanes_used) {
        return 1e6 * std::max(operations / (100 * lanes_used), bytes / 10.0) / 1e6;
    };
    EXPECT_NEAR(milliseconds(1), 6.4, 1e-12) << "a million samples with all 16 lanes";
    EXPECT_NEAR(milliseconds(1.0 / 16), 6.4, 1e-12) << "a million samples with one lane of 16";
    EXPECT_NEAR(1e6 * operations / 100 / 1e6, 0.36, 1e-12) << "their arithmetic, 16 lanes";
    EXPECT_NEAR(1e6 * operations / 6.25 / 1e6, 5.76, 1e-12) << "their arithmetic, one lane";
}

TEST(Simd, Eq14_7_ChannelsOfTexels) {
    for_each_width([]<int N>() {
        std::array<Vector<float, N>, 4> texels;  // pixel p's channel c is 4 p + c
        for (int k = 0; k < 4; ++k)
            for (int j = 0; j < N / 4; ++j)
                for (int c = 0; c < 4; ++c)
                    texels[std::size_t(k)][4 * j + c] = static_cast<float>(4 * (k + 4 * j) + c);
        const auto channels = channels_of<N>(texels);
        for (int c = 0; c < 4; ++c)
            EXPECT_TRUE(
                has_in_lanes(channels[c], [&](int p) { return 4.0f * float(p) + float(c); }))
                << "channel " << c << " of " << N << " pixels";
    });
}

TEST(Simd, HardCase_ShadowTestsHaveLesson09sTexelsDepthsAndBits) {
    look_up("Shadow tests");
    for_each_width([]<int N>() {
        Dice dice(N);
        int outside = 0, inside = 0, partly_lit = 0;
        for (int k = 0; k < 6000 / N; ++k) {
            const ShadowMap map = any_map(dice, k % 2);
            PerLane<ShadowBias, N> receivers;
            WideShadowBias<N> of_lanes{};
            PerLane<vec3, N> points;
            const bool are_special = dice.one_in(3);
            for (int i = 0; i < N; ++i) {
                receivers[i] = i == 0 || dice.one_in(3) ? any_bias(dice) : receivers[i - 1];
                of_lanes.set(lane_numbers<N>() == Ints<N>(i), receivers[i]);
                points[i] = any_point(dice, are_special);
            }
            // At the map's very corners.
            if (k % 2 == 0 && dice.one_in(3))
                points.at(dice.below(N)) = {dice.one_in(2) ? -1.0f : 0x1.fffffep-1f,
                                            dice.one_in(2) ? 1.0f : -0x1.fffffep-1f, 0};
            const std::uint32_t asked = dice.one_in(2) ? (1u << N) - 1 : dice.below(1u << N);
            const WidePcfKernel<N> actual =
                pcf_kernel(map, of_lanes, in_lanes<N>(points), mask_of_bits<N>(asked));
            PerLane<PcfKernel, N> expected;
            for (int i = 0; i < N; ++i) {
                if (asked >> i & 1) expected[i] = pcf_kernel(map, receivers[i], points[i]);
                ++(expected[i].is_in_map ? inside : outside);
            }
            SCOPED_TRACE("points " + testing::PrintToString(points) +
                         ", of which those with the bits " + std::to_string(asked) +
                         " are asked for; a map of " + std::to_string(map.size) + " texels" +
                         (map.is_perspective ? " in perspective" : ""));
            ASSERT_TRUE(has_in_lanes(actual.is_in_map, [&](int i) {
                return expected[i].is_in_map;
            })) << "whether points are in the map";
            ASSERT_TRUE(has_in_lanes(actual.column, [&](int i) { return expected[i].middle.x; }))
                << "columns of texels";
            ASSERT_TRUE(has_in_lanes(actual.row, [&](int i) { return expected[i].middle.y; }))
                << "rows of texels";
            ASSERT_TRUE(has_in_lanes(actual.depth, [&](int i) {
                return expected[i].is_in_map ? expected[i].depth : actual.depth[i];
            })) << "depths that are compared";
            for (int radius = 0; radius <= max_pcf_radius; ++radius)
                ASSERT_TRUE(has_in_lanes(pcf_visibility(map, radius, actual),
                                         [&](int i) {
                                             const float lit =
                                                 pcf_visibility(map, radius, expected[i]);
                                             partly_lit += lit > 0 && lit < 1;
                                             return lit;
                                         }))
                    << "visibilities, radius " << radius;
        }
        EXPECT_GT(std::min(inside, outside), 300);
        EXPECT_GT(partly_lit, 1000);
    });
}
