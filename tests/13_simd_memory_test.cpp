// SPDX-License-Identifier: MIT
// Where lanes want different memory: textures and shadow maps, beside lessons 05, 09 and 12.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "04_mvp/transform.hpp"
#include "05_textures/interpolation.hpp"
#include "05_textures/texture.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "10_threading/thread_pool.hpp"
#include "12_visibility_buffer/shadow_parts.hpp"
#include "13_simd/simd.hpp"
#include "13_simd/wide_shadows.hpp"
#include "13_simd/wide_textures.hpp"
#include "support/any_scene.hpp"
#include "support/first_difference.hpp"
#include "support/lanes.hpp"
#include "support/look_up.hpp"
#include "support/names.hpp"
#include "support/pictures.hpp"
#include "support/printers.hpp"
#include "support/random_casters.hpp"
#include "support/texture_names.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

Texture any_texture(Dice& dice, WrapModes wrap) {
    constexpr std::array sizes = {1, 2, 3, 5, 8, 16, 37, 64};
    Image<vec4> picture({sizes.at(dice.below(8)), sizes.at(dice.below(8))});
    for (vec4& texel : picture.pixels()) texel = vec4(dice.color(), dice.between(0, 1));
    Texture texture = make_texture(std::move(picture), wrap);
    if (dice.one_in(3)) texture.magnified = all_filters[dice.below(3)];
    if (dice.one_in(3)) texture.minified = all_filters[dice.below(3)];
    return texture;
}

template <int N>
glm::vec<2, Floats<N>> two(const std::array<vec2, std::size_t(N)>& of_lanes) {
    glm::vec<2, Floats<N>> v;
    for (int i = 0; i < N; ++i)
        for (int c = 0; c < 2; ++c) v[c].lanes[i] = of_lanes.at(std::size_t(i))[c];
    return v;
}

/// Around 0 to 1, or any number.
vec2 any_uv(Dice& dice, bool is_special) {
    const auto number = [&] { return is_special ? any_float(dice) : dice.between(-2.5f, 2.5f); };
    const float u = number(), v = number();
    return {u, v};
}

/// A change of uv that a level of 1 to 64 texels may have, or one far beyond.
vec2 any_change(Dice& dice, bool is_special) {
    const float size = std::exp2(dice.between(-8, 2));
    const float u = is_special ? any_float(dice) : dice.between(-size, size);
    const float v = is_special && dice.one_in(2) ? any_float(dice) : dice.between(-size, size);
    return {u, v};
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

TEST(Simd, HardCase_CoordinatesAreWrappedInEachLane) {
    look_up("Eq. 13.3");
    for_each_width([]<int N>() {
        Dice dice(N);
        for (int k = 0; k < 50'000 / N; ++k) {
            NumbersOfLanes<N> x;
            const bool is_special = dice.one_in(2);
            for (float& of_lane : x)
                of_lane = is_special && dice.one_in(4) ? any_float(dice) : dice.between(-4, 4);
            for (const Wrap wrap : all_wraps)
                ASSERT_TRUE(
                    has_in_lanes(wrapped(in_lanes<N>(x), wrap),
                                 [&](int i) { return wrapped(x.at(std::size_t(i)), wrap); }))
                    << list_of(x) << ", " << name_of(wrap);
        }
    });
}

TEST(Simd, HardCase_LevelsOfDetailAreFoundInEachLane) {
    look_up("Eq. 13.1");
    for_each_width([]<int N>() {
        Dice dice(N);
        for (int k = 0; k < 30'000 / N; ++k) {
            std::array<vec2, std::size_t(N)> ddx, ddy;
            for (vec2& v : ddx) v = any_change(dice, dice.one_in(5));
            for (vec2& v : ddy) v = any_change(dice, dice.one_in(5));
            const ivec2 size(1 + dice.below(2000), 1 + dice.below(100));
            ASSERT_TRUE(has_in_lanes(level_of_detail<N>(two<N>(ddx), two<N>(ddy), size),
                                     [&](int i) {
                                         return level_of_detail(ddx.at(std::size_t(i)),
                                                                ddy.at(std::size_t(i)), size);
                                     }))
                << "level of detail of " << testing::PrintToString(size) << " texels, ddx "
                << testing::PrintToString(ddx) << ", ddy " << testing::PrintToString(ddy);
        }
    });
}

TEST(Simd, HardCase_SamplesHaveLesson05sBits) {
    look_up("Eq. 13.3");
    for_each_width([]<int N>() {
        Dice dice(N);
        int divergent = 0;
        for (int k = 0; k < 9000 / N; ++k) {
            const WrapModes wrap(all_wraps[dice.below(3)], all_wraps[dice.below(3)]);
            const Texture texture = any_texture(dice, wrap);
            for (int batch = 0; batch < 4; ++batch) {
                std::array<vec2, std::size_t(N)> here, ddx, ddy;
                // All special, some, or none; neighbours, or anywhere.
                const bool are_any = dice.one_in(3);
                const vec2 middle = any_uv(dice, false), change = any_change(dice, false);
                for (std::size_t i = 0; i < N; ++i) {
                    const bool is_special = are_any && dice.one_in(3);
                    here.at(i) = are_any ? any_uv(dice, is_special)
                                         : middle + change * static_cast<float>(i);
                    ddx.at(i) = are_any ? any_change(dice, is_special)
                                        : change * (1 + 0.1f * static_cast<float>(i));
                    ddy.at(i) = are_any ? any_change(dice, is_special) : vec2(-change.y, change.x);
                }
                for (const Filter filter : all_filters) {
                    const glm::vec<4, Floats<N>> actual = sample(
                        texture, filter,
                        TextureCoordinates<Floats<N>>{two<N>(here), two<N>(ddx), two<N>(ddy)});
                    for (std::size_t i = 0; i < N; ++i) {
                        const int lane = static_cast<int>(i);
                        const vec4 expected =
                            sample(texture, filter, FragmentUv{here.at(i), ddx.at(i), ddy.at(i)});
                        for (int c = 0; c < 4; ++c)
                            ASSERT_TRUE(agree(actual[c][lane], expected[c]))
                                << "channel " << c << " of lane " << i << " of " << N << ": "
                                << actual[c][lane] << ", expected " << expected[c] << "; "
                                << name_of(filter) << " (its own: " << name_of(texture.magnified)
                                << " and " << name_of(texture.minified) << "), " << name_of(wrap.u)
                                << " and " << name_of(wrap.v) << ", a texture of "
                                << testing::PrintToString(texture.levels[0].size) << " texels, uv "
                                << testing::PrintToString(here.at(i)) << ", ddx "
                                << testing::PrintToString(ddx.at(i)) << ", ddy "
                                << testing::PrintToString(ddy.at(i));
                    }
                }
                const auto level = [&](std::size_t i) {
                    return std::min(level_of_detail(ddx.at(i), ddy.at(i), texture.levels[0].size),
                                    static_cast<float>(texture.levels.size() - 1));
                };
                divergent += std::floor(level(0)) != std::floor(level(N - 1));
            }
        }
        EXPECT_GT(divergent, 1000 / N) << "batches whose lanes want different mip levels";
    });
}

TEST(Simd, HardCase_AttributesAreInterpolatedInEachLane) {
    look_up("Eq. 13.1");
    for_each_width([]<int N>() {
        Dice dice(N);
        for (int k = 0; k < 3000; ++k) {
            std::array<vec3, std::size_t(N)> at;
            for (vec3& v : at) v = dice.in_cube(1);
            if (dice.one_in(2))
                at.at(dice.below(N))[static_cast<int>(dice.below(3))] = any_float(dice);
            const std::array<vec3, 3> of_vertices = {dice.in_cube(3), dice.in_cube(3),
                                                     dice.in_cube(3)};
            const Vec3<Floats<N>> actual = interpolate(of_vertices, in_lanes<N>(at));
            for (int c = 0; c < 3; ++c)
                ASSERT_TRUE(has_in_lanes(
                    actual[c],
                    [&](int i) { return interpolate(of_vertices, at.at(std::size_t(i)))[c]; }))
                    << "component " << c << " of an attribute at " << testing::PrintToString(at);

            std::array<ClippedVertex, 3> clipped;
            for (std::size_t v = 0; v < 3; ++v) {
                Barycentrics at_vertex(0);
                at_vertex[static_cast<int>(v)] = 1;
                clipped.at(v) = {vec4(dice.in_cube(1), dice.between(0.1f, 3)), at_vertex};
            }
            if (dice.one_in(2)) clipped[1].barycentrics = {0.25f, 0.75f, 0};
            const PerspectiveSetup setup =
                perspective_setup(snap_triangle({1, 2}, {30, 50}, {40, 3}), clipped);
            const auto wide = perspective_correct(setup, in_lanes<N>(at));
            for (int c = 0; c < 3; ++c) {
                const auto expected = [&](auto which) {
                    return [&, which](int i) {
                        return which(perspective_correct(setup, at.at(std::size_t(i))))[c];
                    };
                };
                ASSERT_TRUE(has_in_lanes(wide.here[c], expected([](auto p) { return p.here; })));
                ASSERT_TRUE(has_in_lanes(wide.ddx[c], expected([](auto p) { return p.ddx; })));
                ASSERT_TRUE(has_in_lanes(wide.ddy[c], expected([](auto p) { return p.ddy; })));
            }
        }
    });
}

TEST(Simd, Eq13_6_TimesOfTheWorkedExample) {
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

TEST(Simd, Eq13_7_ChannelsOfTexels) {
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

TEST(Simd, Eq13_7_ABilinearSampleTakesFourTexelsAndNoOthers) {
    // All texels but the four around a position are NaN, and none comes through.
    for_each_width([]<int N>() {
        Dice dice(N);
        for (int k = 0; k < 200; ++k) {
            const ivec2 size(1 + dice.below(9), 1 + dice.below(9));
            TextureLevel level{size, Image<vec4>(size + 2, vec4(NAN))};
            const ivec2 first(dice.below(std::uint32_t(size.x) + 1),
                              dice.below(std::uint32_t(size.y) + 1));
            for (const ivec2 beside : {ivec2(0, 0), {1, 0}, {0, 1}, {1, 1}})
                level.texels[first + beside] = vec4(dice.color(), 1);
            // Between these four centres: the first is at `first` - 0.5 texels of the texture.
            std::array<vec2, std::size_t(N)> at;
            NumbersOfLanes<N> x, y;
            for (std::size_t i = 0; i < N; ++i) {
                const vec2 between(dice.between(0.1f, 0.9f), dice.between(0.1f, 0.9f));
                at.at(i) = glm::clamp((vec2(first) - 0.5f + between) / vec2(size), 0.0f, 1.0f);
                x.at(i) = at.at(i).x, y.at(i) = at.at(i).y;
            }
            const auto actual = sample_bilinear(level, in_lanes<N>(x), in_lanes<N>(y));
            for (int c = 0; c < 4; ++c)
                for (int i = 0; i < N; ++i)
                    ASSERT_EQ(actual[c][i], sample_bilinear(level, at.at(std::size_t(i)))[c])
                        << "channel " << c << " of lane " << i << " of " << N << " at the position "
                        << testing::PrintToString(at.at(std::size_t(i))) << " in a level of "
                        << testing::PrintToString(size)
                        << " texels, in which all but the four from "
                        << testing::PrintToString(first) << " on are NaN";
        }
    });
}

TEST(Simd, ShadowTestsFollowTheReceiversPlane) {
    look_up("Shadow tests");
    // 4 x 4 texels; the plane's depth grows by 1/8 to the right and by 1/4 down. At (1.25, 2.75) it
    // is 1/2. So at that texel's centre, (1.5, 2.5), it is 1/2 + 1/32 - 1/16 = 15/32.
    ShadowMap map(mat4(1), false, 4, {vec3(-1), vec3(1)});
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x)
            map.depths.test_and_write(ivec2(x, y) + max_pcf_radius,
                                      15.0f / 32 + 0.125f * static_cast<float>(x - 1) +
                                          0.25f * static_cast<float>(y - 2));
    for_each_width([&]<int N>() {
        const Mask<N> all = first_lanes<Floats<N>>(N);
        WideShadowBias<N> bias{};
        bias.set(all, ShadowBias{.slope = {0.125f, 0.25f}});
        for (const float below : {0.0f, 1.0f / 64}) {
            const Vec3<Floats<N>> point(vec3(-0.375f, -0.375f, 0.5f - below));
            const WidePcfKernel<N> kernel = pcf_kernel(map, bias, point, all);
            ASSERT_TRUE(has_in_lanes(kernel.column, [](int) { return 1; })) << "the texel's column";
            ASSERT_TRUE(has_in_lanes(kernel.row, [](int) { return 2; })) << "the texel's row";
            ASSERT_TRUE(has_in_lanes(kernel.depth, [&](int) { return 15.0f / 32 - below; }))
                << "the depth at the texel's centre, " << below << " below the plane";
            ASSERT_TRUE(has_in_lanes(pcf_visibility(map, 1, kernel),
                                     [&](int) { return below > 0 ? 0.0f : 1.0f; }))
                << "visibility " << below << " below a map that is the plane, 3 x 3 taps";
        }
    });
}

TEST(Simd, HardCase_ShadowTestsHaveLesson09sTexelsDepthsAndBits) {
    look_up("Shadow tests");
    for_each_width([]<int N>() {
        Dice dice(N);
        int outside = 0, inside = 0, partly_lit = 0;
        for (int k = 0; k < 6000 / N; ++k) {
            const ShadowMap map = any_map(dice, k % 2);
            std::array<ShadowBias, std::size_t(N)> receivers;
            WideShadowBias<N> of_lanes{};
            for (int i = 0; i < N; ++i) {
                receivers.at(std::size_t(i)) =
                    i == 0 || dice.one_in(3) ? any_bias(dice) : receivers.at(std::size_t(i - 1));
                of_lanes.set(lane_numbers<N>() == Ints<N>(i), receivers.at(std::size_t(i)));
            }
            std::array<vec3, std::size_t(N)> points;
            const bool are_special = dice.one_in(3);
            for (vec3& p : points) p = any_point(dice, are_special);
            // At the map's very corners.
            if (k % 2 == 0 && dice.one_in(3))
                points.at(dice.below(N)) = {dice.one_in(2) ? -1.0f : 0x1.fffffep-1f,
                                            dice.one_in(2) ? 1.0f : -0x1.fffffep-1f, 0};
            const auto asked = dice.one_in(2) ? (1u << N) - 1 : dice.below(1u << N);
            const auto mask = mask_of_bits<N>(asked);
            const WidePcfKernel<N> actual = pcf_kernel(map, of_lanes, in_lanes<N>(points), mask);
            for (int radius = 0; radius <= max_pcf_radius; ++radius) {
                const Floats<N> visibility = pcf_visibility(map, radius, actual);
                for (int i = 0; i < N; ++i) {
                    const bool is_asked = asked >> i & 1;
                    const vec3 point = points.at(std::size_t(i));
                    const PcfKernel expected =
                        is_asked ? pcf_kernel(map, receivers.at(std::size_t(i)), point)
                                 : PcfKernel();
                    const std::string where = "lane " + std::to_string(i) + " of " +
                                              std::to_string(N) + ", point " + shown(point) +
                                              (is_asked ? "" : ", which is not asked for") +
                                              ", a map of " + std::to_string(map.size) + " texels" +
                                              (map.is_perspective ? " in perspective" : "") + " (" +
                                              std::to_string(k) + ")";
                    ASSERT_EQ(actual.is_in_map[i], expected.is_in_map)
                        << "whether it is in the map; " << where;
                    ASSERT_EQ(actual.column[i], expected.middle.x) << where;
                    ASSERT_EQ(actual.row[i], expected.middle.y) << where;
                    if (expected.is_in_map) {
                        ASSERT_TRUE(agree(actual.depth[i], expected.depth))
                            << "the depth that is compared: " << actual.depth[i] << ", expected "
                            << expected.depth << "; " << where;
                    }
                    const float lit = pcf_visibility(map, radius, expected);
                    ASSERT_TRUE(agree(visibility[i], lit))
                        << "visibility, radius " << radius << ": " << visibility[i] << ", expected "
                        << lit << "; " << where;
                    ++(expected.is_in_map ? inside : outside);
                    partly_lit += lit > 0 && lit < 1;
                }
            }
        }
        EXPECT_GT(std::min(inside, outside), 1000);
        EXPECT_GT(partly_lit, 1000);
    });
}

TEST(Simd, Eq13_2_PartsOfAMapHaveLesson10sBits) {
    const auto check = []<typename F>(F, std::uint32_t first_seed) {
        for (std::uint32_t seed = first_seed; seed < first_seed + 40; ++seed) {
            Dice dice(seed);
            const int size = 16 + static_cast<int>(dice.below(60));
            const Scene scene = random_casters(seed % 7 == 0 ? 0 : 12, seed);
            constexpr std::array sides = {1, 2, 5, 16, 32, 100};
            const Tiling tiling(Split::tiles, ivec2(size), 1, sides.at(seed % sides.size()));
            ShadowMap expected = map_of_minus_one(size), actual = map_of_minus_one(size);
            ThreadPool pool(1);
            const BinnedTriangles casters =
                seed % 7 == 0 ? BinnedTriangles() : casters_of(pool, expected, scene, tiling);
            for (std::size_t i = 0; i < tiling.count(); ++i) {
                if (dice.one_in(3)) continue;
                thread_counters = {};
                draw_tile(expected, casters, tiling, i);
                const Counters before = std::exchange(thread_counters, {});
                draw_tile<F>(actual, casters, tiling, i);
                ASSERT_EQ(thread_counters[Counter::shadow_fragments],
                          before[Counter::shadow_fragments])
                    << "shadow fragments of part " << i;
                ASSERT_TRUE(have_the_same_bits(actual.depths.depths(), expected.depths.depths()))
                    << "depths of a map of " << size << " texels after part " << i << " of "
                    << tiling.count() << " was drawn in " << width_of<F> << " lanes; -1 is what "
                    << "was not drawn, and the map begins " << max_pcf_radius
                    << " texels from its memory's corner (seed " << seed << ")";
            }
        }
    };
    check(1.0f, 0), check(Floats<4>(), 100), check(Floats<8>(), 200), check(Floats<16>(), 300);
}

TEST(Simd, HardCase_ALightsVisibilityAndItsPartsAreLesson12s) {
    look_up("Eq. 13.1");
    ThreadPool pool(1);
    for_each_width([&]<int N>() {
        std::size_t half_lit = 0, both_sides = 0, several_maps = 0, not_asked = 0, asked = 0;
        for (std::uint32_t seed = 0; seed < 90; ++seed) {
            Dice dice(seed + 1000 * N);
            const Scene scene = random_casters(8, seed);
            const LightKind kind = light_kinds[seed % light_kinds.size()];
            std::array<Light, 2> lights = raking_lights(kind, scene.bounds());
            if (seed % 4 == 1)  // amid the casters
                lights[0].position_world = dice.in_cube(0.3f);
            const ShadowBounds bounds = shadow_bounds(scene);
            const ShadowOptions variant{.size = 16 + static_cast<int>(dice.below(60)),
                                        .bias = all_biases[seed % all_biases.size()],
                                        .pcf = 1 + 2 * static_cast<int>(dice.below(4))};
            const int side = 4 + static_cast<int>(dice.below(30));
            const bool all_effects = seed % 5 == 0;
            const ShadowMapsOnDemand before(pool, side, variant,
                                            {scene, bounds, lights, all_effects});
            const ShadowMapsOnDemand now(pool, side, variant, {scene, bounds, lights, all_effects});
            Counters expected_counts, counts;
            for (int batch = 0; batch < 8; ++batch) {
                const Mesh& mesh = scene.meshes[0];
                std::vector<ShadowBiasCache> receivers;
                for (int t = 0; t < 3; ++t) {
                    std::array<vec3, 3> vertices;
                    for (std::size_t v = 0; v < 3; ++v)
                        vertices.at(v) = mesh.positions[3 * dice.below(8) + v];
                    receivers.push_back(ShadowBiasCache(vertices));
                }
                std::vector<ShadowBiasCache> same = receivers;
                const std::uint32_t triangle_count = dice.one_in(2) ? 1 : 3;
                LaneBiasCaches<N> in_slots;
                std::array<std::size_t, std::size_t(N)> triangle_of;
                // Few of the lanes may be pixels; the others repeat the last one.
                const int pixels = dice.one_in(2) ? N : 1 + static_cast<int>(dice.below(N));
                const bool is_small = dice.one_in(2), are_special = dice.one_in(3),
                           have_one_side = dice.one_in(2), ask_all = dice.one_in(2);
                const vec3 one_normal = dice.in_cube(1);
                std::array<vec3, std::size_t(N)> points, normals;
                for (int i = 0; i < N; ++i) {
                    const auto lane = static_cast<std::size_t>(i);
                    const std::size_t t = triangle_of.at(lane) =
                        i < pixels ? dice.below(triangle_count) : triangle_of.at(lane - 1);
                    in_slots.set(lane_numbers<N>() == Ints<N>(i), receivers.at(t),
                                 static_cast<int>(t) + N - 2);
                    if (i >= pixels) {
                        points.at(lane) = points.at(lane - 1),
                        normals.at(lane) = normals.at(lane - 1);
                        continue;
                    }
                    const auto& vertices = receivers.at(t).vertices();
                    const float reach = is_small ? 0.05f : 0.5f;
                    const vec2 at(dice.between(0, reach), dice.between(0, reach));
                    points.at(lane) =
                        at.x * vertices[0] + at.y * vertices[1] + (1 - at.x - at.y) * vertices[2];
                    normals.at(lane) = have_one_side ? one_normal : dice.in_cube(1);
                    if (are_special && dice.one_in(4))
                        points.at(lane)[static_cast<int>(dice.below(3))] = any_float(dice);
                    if (are_special && dice.one_in(4))
                        normals.at(lane)[static_cast<int>(dice.below(3))] = any_float(dice);
                }
                for (std::size_t l = 0; l < lights.size(); ++l) {
                    Mask<N> points_asked = first_lanes<Floats<N>>(N);
                    for (int i = 0; i < pixels; ++i)
                        points_asked.lanes[i] = ask_all || dice.one_in(2) ? -1 : 0;
                    for (int i = pixels; i < N; ++i)
                        points_asked.lanes[i] = points_asked.lanes[pixels - 1];
                    fragments_at_once = static_cast<std::uint64_t>(pixels);
                    thread_counters = {};
                    const Floats<N> actual = light_visibility(now, l, in_slots, in_lanes<N>(points),
                                                              in_lanes<N>(normals), points_asked);
                    counts += std::exchange(thread_counters, {});
                    std::array<bool, 2> sides{};
                    std::array<bool, 6> faces{};
                    for (int i = 0; i < pixels; ++i) {
                        if (!points_asked[i]) continue;
                        const vec3 point = points.at(std::size_t(i)),
                                   normal = normals.at(std::size_t(i));
                        const float expected = light_visibility(
                            before, l, same.at(triangle_of.at(std::size_t(i))), point, normal);
                        expected_counts += std::exchange(thread_counters, {});
                        ASSERT_TRUE(agree(actual[i], expected))
                            << "visibility of light " << l << " in lane " << i << " of " << N
                            << ": " << actual[i] << ", expected " << expected << "; point "
                            << shown(point) << ", normal " << shown(normal) << "; " << name_of(kind)
                            << ", " << name_of(variant.bias) << ", PCF of " << variant.pcf
                            << ", a map of " << variant.size << " texels (seed " << seed
                            << ", batch " << batch << ")";
                        half_lit += expected > 0 && expected < 1;
                        sides[glm::dot(receivers.at(triangle_of.at(std::size_t(i))).front(),
                                       dvec3(normal)) < 0] = true;
                        faces.at(cube_face(point - lights[l].position_world)) = true;
                    }
                    both_sides += sides[0] && sides[1];
                    several_maps +=
                        kind == LightKind::point && l == 0 && std::ranges::count(faces, true) > 1;
                }
                for (std::size_t map = 0; map < now.parts().size(); ++map)
                    for (std::size_t i = 0; i < now.parts()[map].tiling().count(); ++i) {
                        const bool is_drawn = before.parts()[map].is_drawn(i);
                        ASSERT_EQ(now.parts()[map].is_drawn(i), is_drawn)
                            << "whether part " << i << " of map " << map << " is drawn, in " << N
                            << " lanes; " << name_of(kind) << ", PCF of " << variant.pcf
                            << ", a map of " << variant.size << " texels in parts of " << side
                            << " (seed " << seed << ", batch " << batch << ")";
                        ++(is_drawn ? asked : not_asked);
                    }
                for (const Counter counter :
                     {Counter::shadow_tests, Counter::shadow_parts, Counter::shadow_fragments})
                    ASSERT_EQ(counts[counter], expected_counts[counter])
                        << counter_names[static_cast<std::size_t>(counter)] << " after batch "
                        << batch << " of " << pixels << " pixels in " << N << " lanes, seed "
                        << seed;
            }
            for (std::size_t map = 0; map < now.parts().size(); ++map)
                for (std::size_t i = 0; i < now.parts()[map].tiling().count(); ++i)
                    if (now.parts()[map].is_drawn(i)) {
                        const PixelBox box = now.parts()[map].tiling()[i].box;
                        const auto depth_of = [&](const ShadowMapsOnDemand& maps, ivec2 texel) {
                            return maps.parts()[map].map().depths.depths()[texel + max_pcf_radius];
                        };
                        for (int y = box.first.y; y <= box.last.y; ++y)
                            for (int x = box.first.x; x <= box.last.x; ++x)
                                ASSERT_EQ(depth_of(now, {x, y}), depth_of(before, {x, y}))
                                    << "depth of the texel (" << x << ", " << y << ") of map "
                                    << map << ", part " << i << " (seed " << seed << ")";
                    }
        }
        EXPECT_GT(half_lit, 50u * N) << "points at a shadow's edge";
        EXPECT_GT(both_sides, 100u) << "batches with points on both sides of their triangle";
        EXPECT_GT(several_maps, 30u) << "batches with points in several maps of a point light";
        EXPECT_GT(std::min(asked, not_asked), 1000u);
    });
}
