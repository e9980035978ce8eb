// SPDX-License-Identifier: MIT
// Ids of visible triangles, their pixels as spans, barycentric coordinates found again, and the
// parts of shadow maps.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "10_threading/thread_pool.hpp"
#include "12_effects/effects_options.hpp"
#include "12_effects/planned_scene.hpp"
#include "13_visibility_buffer/shadow_parts.hpp"
#include "13_visibility_buffer/visibility_buffer.hpp"
#include "13_visibility_buffer/visible_shading.hpp"
#include "support/any_scene.hpp"
#include "support/first_difference.hpp"
#include "support/look_up.hpp"
#include "support/name_of_split.hpp"
#include "support/names.hpp"
#include "support/pictures.hpp"
#include "support/printers.hpp"
#include "support/projected.hpp"
#include "support/random_casters.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr std::size_t no_limit = no_triangle;

/// x, y and length.
using SpanInNumbers = std::array<int, 3>;

/// A triangle's number, and its pixels.
using TakenTriangle = std::pair<std::size_t, std::vector<SpanInNumbers>>;

/// Triangles that lie nowhere: only which is which counts.
std::vector<ProjectedTriangle> stand_ins(std::size_t count) {
    return std::vector<ProjectedTriangle>(count, projected({}, ivec2(8)));
}

std::vector<TakenTriangle> taken(VisibilityBuffer& visible,
                                 const std::vector<ProjectedTriangle>& triangles) {
    std::vector<TakenTriangle> all;
    visible.take_visible([&](const ProjectedTriangle& triangle, std::span<const PixelSpan> spans) {
        all.emplace_back(&triangle - triangles.data(), std::vector<SpanInNumbers>());
        for (const PixelSpan& span : spans)
            all.back().second.push_back({span.first.x, span.first.y, span.length});
    });
    return all;
}

/// The number of the triangle that is visible in each pixel, -1 where none is.
Image<int> ids_drawn(const std::vector<ProjectedTriangle>& triangles, const Tiling& tiling) {
    Scene scene;
    scene.materials.resize(1);
    const PlannedScene assets = load_planned_scene(std::move(scene), EffectsOptions());
    const ShadowMaps no_maps{};
    Image<vec3> color(tiling.size());
    DepthBuffer depth(tiling.size());
    const Frame<ShadowMaps> frame{assets, Filter::nearest, vec3(0), no_maps, color, depth};
    Image<int> numbers(tiling.size(), -1);
    VisibilityBuffer visible(no_limit);
    for (std::size_t i = 0; i < tiling.count(); ++i) {
        visible.begin(tiling[i]);
        for (const ProjectedTriangle& triangle : triangles)
            draw_id(frame, triangle, tiling[i], visible);
        for (const auto& [number, spans] : taken(visible, triangles))
            for (const auto& [x, y, length] : spans)
                for (int k = 0; k < length; ++k) numbers[{x + k, y}] = static_cast<int>(number);
    }
    return numbers;
}

/// As lessons 02 and 03 have it: of all triangles the first whose depth is the greatest, if that is
/// above 0.
Image<int> nearest_of(const std::vector<ProjectedTriangle>& triangles, ivec2 size) {
    Image<int> numbers(size, -1);
    DepthBuffer depth(size);
    for (std::size_t i = 0; i < triangles.size(); ++i)
        fill_triangle(triangles[i].on_screen, size, [&](ivec2 pixel, Barycentrics at) {
            if (depth.test_and_write(pixel, triangles[i].depth.at(at)))
                numbers[pixel] = static_cast<int>(i);
        });
    return numbers;
}

/// What clipping leaves of random triangles: coarse coordinates, so that many have equal depths,
/// share edges, or go through the frustum's sides.
std::vector<ProjectedTriangle> coarse_triangles(Dice& dice, ivec2 size) {
    std::vector<ProjectedTriangle> triangles;
    std::array<vec4, 3> vertices{};
    for (int k = 0; k < 12; ++k) {
        const bool faces_the_camera = dice.one_in(3), is_the_last_again = dice.one_in(3);
        for (vec4& vertex : vertices) {
            if (is_the_last_again) break;
            const auto coarse = [&] { return 0.25f * static_cast<float>(dice.below(13)) - 1.5f; };
            const float x = coarse(), y = coarse(), w = dice.one_in(4) ? 2.0f : 1.0f;
            const float z =
                0.25f * static_cast<float>(faces_the_camera ? static_cast<std::uint32_t>(k % 5)
                                                            : dice.below(5));
            vertex = {x, y, z * (faces_the_camera ? w : 1), w};
        }
        for (const ClippedTriangle& clipped : clip_triangle(vertices))
            triangles.push_back(projected(clipped, size));
    }
    return triangles;
}

/// Tap by tap: the parts that a kernel lies in.
std::set<std::size_t> parts_asked(ivec2 middle, int radius, int size, int side) {
    std::set<std::size_t> parts;
    for (int y = middle.y - radius; y <= middle.y + radius; ++y)
        for (int x = middle.x - radius; x <= middle.x + radius; ++x)
            if (x >= 0 && y >= 0 && x < size && y < size)
                parts.insert(
                    static_cast<std::size_t>(y / side * ((size + side - 1) / side) + x / side));
    return parts;
}

std::set<std::size_t> parts_drawn(const ShadowMapParts& parts) {
    std::set<std::size_t> all;
    for (std::size_t i = 0; i < parts.tiling().count(); ++i)
        if (parts.is_drawn(i)) all.insert(i);
    return all;
}

}  // namespace

TEST(VisibilityBuffer, Eq13_1_TheFirstOfTheNearestStays) {
    // A pixel, and triangles over all of it, in drawing order: the one that is seen is marked.
    struct Case {
        std::vector<float> depths;
        int visible;
    };
    for (const auto& [depths, visible] :
         {Case{{0.25f, 0.75f, 0.5f, 0.75f}, 1}, Case{{0.5f, 0.75f, 0.75f}, 1},
          Case{{0.25f, 0.25f, 0.25f}, 0}, Case{{0.0f, 0.5f}, 1}, Case{{0.0f, 0.0f}, -1},
          Case{{}, -1}}) {
        std::vector<ProjectedTriangle> triangles;
        for (const float z : depths)
            triangles.push_back(projected(
                {{{{-1, -1, z, 1}, {1, 0, 0}}, {{3, -1, z, 1}, {0, 1, 0}}, {{-1, 3, z, 1}, {}}}},
                ivec2(1)));
        ASSERT_EQ((ids_drawn(triangles, Tiling(Split::tiles, {1, 1}, 1, 8))[{0, 0}]), visible)
            << "the triangle that is visible (-1: none), of triangles at the depths "
            << testing::PrintToString(depths) << "; a pixel is cleared to depth 0";
    }
}

TEST(VisibilityBuffer, Eq13_1_EachPixelHasTheTriangleThatTheDefinitionGives) {
    const ivec2 size(41, 27);
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        Dice dice(seed);
        const std::vector<ProjectedTriangle> triangles = coarse_triangles(dice, size);
        const Split split = splits[seed % 3];
        const std::size_t workers = 1 + seed % 5;
        const int side = 1 + static_cast<int>(dice.below(30));
        ASSERT_TRUE(are_equal(ids_drawn(triangles, Tiling(split, size, workers, side)),
                              nearest_of(triangles, size)))
            << "the triangle that is visible in a pixel (-1: none, or take_visible() has lost it: "
            << "Eq. 13.3), by its number in drawing order, and the first of the nearest; "
            << name_of(split) << " of 41 x 27 pixels, " << workers << " workers, tile side " << side
            << " (seed " << seed << ")";
    }
}

TEST(VisibilityBuffer, Eq13_2_PlanesOfTheWorkedExample) {
    // Half of 8 * 4 pixels, as seen counter-clockwise and as seen clockwise: twice its area is 32.
    for (const bool is_front : {true, false}) {
        const vec2 a(0, 0), b(0, 4), c(8, 0);
        const BarycentricPlanes planes(is_front ? snap_triangle(a, b, c) : snap_triangle(a, c, b));
        int count = 0;
        planes.for_each_in({{2, 1}, 2}, [&](ivec2 pixel, Barycentrics at) {
            if (!is_front) std::swap(at.y, at.z);
            ASSERT_EQ(pixel, ivec2(2 + count, 1)) << "pixel " << count << " of the span";
            ASSERT_EQ(at, (count == 0 ? vec3(10, 12, 10) : vec3(6, 12, 14)) / 32.0f)
                << "barycentric coordinates of the centre of the pixel "
                << testing::PrintToString(pixel) << " in (0, 0), (0, 4), (8, 0), seen "
                << (is_front ? "counter-clockwise" : "clockwise");
            ++count;
        });
        ASSERT_EQ(count, 2) << "pixels of a span of two";
    }
}

TEST(VisibilityBuffer, Eq13_2_HardCase_TheBitsOfFillTriangleUpToTheCoordinateLimit) {
    Dice dice(1);
    for (int k = 0; k < 30'000; ++k) {
        // Of any size from a pixel to the limit, anywhere up to it.
        const float limit = coordinate_limit - 1;
        const float extent = std::exp2(dice.between(0, 22)), reach = std::exp2(dice.between(3, 22));
        const vec2 middle(dice.between(0, reach), dice.between(0, reach));
        std::array<vec2, 3> v;
        for (vec2& vertex : v)
            vertex = glm::clamp(middle + extent * vec2(dice.in_cube(1)), -limit, limit);
        const ScreenTriangle triangle = snap_triangle(v[0], v[1], v[2]);
        if (triangle.twice_area == 0) continue;
        // Pixels around a point of it, and one or some that follow them.
        const float s = dice.between(0, 1), t = dice.between(0, 1 - s);
        const ivec2 first =
            glm::max(ivec2(v[0] + s * (v[1] - v[0]) + t * (v[2] - v[0])) - 2, ivec2(0));
        Image<Barycentrics> filled(ivec2(6), vec3(-1));
        fill_triangle(triangle, first, first + 5,
                      [&](ivec2 pixel, Barycentrics at) { filled[pixel - first] = at; });
        const BarycentricPlanes planes(triangle);
        for (int y = 0; y < 6; ++y)
            for (int x = 0; x < 6; ++x)
                planes.for_each_in({first + ivec2(x, y), 6 - x}, [&](ivec2 pixel, Barycentrics at) {
                    const Barycentrics expected = filled[pixel - first];
                    if (expected == vec3(-1)) return;  // not the triangle's
                    ASSERT_EQ(at, expected)
                        << "barycentric coordinates as found again and as fill_triangle() has "
                        << "them, at the pixel " << testing::PrintToString(pixel)
                        << " of the triangle " << testing::PrintToString(v) << " (seed 1, " << k
                        << ")";
                });
        ASSERT_FALSE(HasFatalFailure());
    }
}

TEST(VisibilityBuffer, Eq13_3_SpansAreGroupedByTriangleInDrawingOrder) {
    // The tile of the derivation's figure, and the same elsewhere in a picture. Triangle 1 is
    // visible nowhere, and in one pixel there is none.
    const std::vector<ProjectedTriangle> triangles = stand_ins(4);
    VisibilityBuffer visible(no_limit);
    for (const ivec2 at : {ivec2(0), ivec2(18, 9)}) {
        visible.begin({{at, at + ivec2(5, 2)}});
        for (TriangleId id = 0; id < 4; ++id)
            ASSERT_EQ(visible.add(triangles[id]), id) << "ids count from 0, in drawing order";
        constexpr std::array<std::string_view, 3> rows = {"00222.", "022233", "222333"};
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 6; ++x)
                if (const char digit = rows.at(std::size_t(y)).at(std::size_t(x)); digit != '.')
                    visible.write(at + ivec2(x, y), static_cast<TriangleId>(digit - '0'));
        const auto span = [&](int x, int y, int length) {
            return SpanInNumbers{at.x + x, at.y + y, length};
        };
        const std::vector<TakenTriangle> expected = {
            {0, {span(0, 0, 2), span(0, 1, 1)}},
            {2, {span(2, 0, 3), span(1, 1, 3), span(0, 2, 3)}},
            {3, {span(4, 1, 2), span(3, 2, 3)}}};
        EXPECT_EQ(taken(visible, triangles), expected)
            << "triangles with their spans (x, y, length) in a tile from "
            << testing::PrintToString(at) << " with the ids 00222. in the first row, 022233 in the "
            << "second and 222333 in the third";
        EXPECT_TRUE(taken(visible, triangles).empty()) << "what has been taken is gone";
        EXPECT_EQ(visible.add(triangles[0]), 0u) << "then ids begin with 0 again";
    }
}

TEST(VisibilityBuffer, HardCase_ATileBeginsWithoutWhatAnotherLeft) {
    look_up("Eq. 13.3");
    const std::vector<ProjectedTriangle> triangles = stand_ins(3);
    VisibilityBuffer visible(3);
    for (const Tile& tile : {Tile{{{0, 0}, {3, 3}}}, Tile{{{4, 0}, {13, 8}}},
                             Tile{{{0, 9}, {1, 9}}}, Tile{{{0, 1}, {9, 8}}, 3}}) {
        visible.begin(tile);
        EXPECT_TRUE(taken(visible, triangles).empty())
            << "a tile begins without triangles, whatever the one before has left";
        for (TriangleId id = 0; id < 3; ++id) {
            ASSERT_FALSE(visible.is_full()) << id << " triangles of at most 3";
            ASSERT_EQ(visible.add(triangles[id]), id) << "its id, in drawing order";
        }
        ASSERT_TRUE(visible.is_full()) << "3 triangles of at most 3";
        for_each_strip(tile, [&](const PixelBox& strip) { visible.write(strip.first, 2); });
    }
}

TEST(VisibilityBuffer, Eq13_6_PartsOfTheWorkedExample) {
    // Parts of 64 texels, a kernel of 3 * 3 texels around (127, 40): columns 1 and 2 of row 0.
    ShadowMap map = map_of_minus_one(256);
    const ShadowMapParts parts(map, Tiling(Split::tiles, ivec2(256), 1, 64), BinnedTriangles());
    const CountedSince counters;
    struct Kernel {
        ivec2 middle;
        int radius;
        std::set<std::size_t> drawn;
    };
    for (const auto& [middle, radius, drawn] :
         {Kernel{{127, 40}, 1, {1, 2}}, Kernel{{128, 41}, 1, {1, 2}},
          Kernel{{128, 63}, 0, {1, 2}},  // one texel, of part 2
          Kernel{{128, 63}, 1, {1, 2, 5, 6}},
          Kernel{{0, 0}, 1, {0, 1, 2, 5, 6}}}) {  // there is no column -1
        parts.draw_around(middle, radius);
        EXPECT_EQ(parts_drawn(parts), drawn)
            << "parts of 64 texels, 4 a row, that are drawn after a kernel of radius " << radius
            << " around " << testing::PrintToString(middle) << " and those before it";
        EXPECT_EQ(counters[Counter::shadow_parts], drawn.size()) << "none is drawn twice";
    }
}

TEST(VisibilityBuffer, Eq13_6_ALightsVisibilityIsLesson09sAndTakesThePartsOfItsKernels) {
    ThreadPool pool(2);
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        Dice dice(seed);
        const Scene scene = random_casters(8, seed);
        const LightKind kind = light_kinds[seed % light_kinds.size()];
        const std::array<Light, 2> lights = raking_lights(kind, scene.bounds());
        const ShadowBounds bounds = shadow_bounds(scene);
        const ShadowOptions variant{.size = 16 + static_cast<int>(dice.below(60)),
                                    .bias = all_biases[seed % all_biases.size()],
                                    .pcf = 1 + 2 * static_cast<int>(dice.below(4))};
        const int side = 4 + static_cast<int>(dice.below(30));
        const ShadowMapsOnDemand on_demand(pool, side, variant, {scene, bounds, lights});
        const ShadowMaps whole = draw_shadow_maps(variant, {scene, bounds, lights});
        std::vector<std::set<std::size_t>> asked(on_demand.parts().size());
        for (int i = 0; i < 24; ++i) {
            std::array<vec3, 3> vertices;
            for (std::size_t v = 0; v < 3; ++v)
                vertices[v] = scene.meshes[0].positions[3 * dice.below(8) + v];
            ShadowBiasCache biases(vertices), same = biases;
            const float b = dice.between(0, 0.5f), c = dice.between(0, 0.5f);
            const vec3 point = b * vertices[0] + c * vertices[1] + (1 - b - c) * vertices[2];
            const vec3 normal = dice.in_cube(1);
            const std::size_t light = dice.below(2);
            // Lesson 09 says which texels it reads; their parts are found tap by tap.
            const float expected = light_visibility(
                whole, light, same, point, normal, [&](std::size_t map, const PcfKernel& kernel) {
                    asked.at(map).merge(
                        parts_asked(kernel.middle, whole.radius, variant.size, side));
                });
            const std::string where = std::string(name_of(kind)) + ", " + name_of(variant.bias) +
                                      ", parts of " + std::to_string(side) +
                                      " texels a side (seed " + std::to_string(seed) + ", point " +
                                      std::to_string(i) + ")";
            ASSERT_EQ(light_visibility(on_demand, light, biases, point, normal), expected)
                << "visibility with maps on demand, and with lesson 09's; " << where;
            for (std::size_t map = 0; map < asked.size(); ++map)
                ASSERT_EQ(parts_drawn(on_demand.parts()[map]), asked[map])
                    << "parts of map " << map << " that are drawn, and that taps lie in; " << where;
        }
    }
}

TEST(VisibilityBuffer, HardCase_WhoAsksForAPartThatIsBeingDrawnWaitsAlsoIfDrawingThrows) {
    look_up("Eq. 13.6");
    const Scene scene = random_casters(40, 3);
    ShadowMap whole(mat4(1), false, 32, {vec3(-1), vec3(1)});
    draw_casters(whole, scene.meshes[0], [](std::size_t) { return true; });
    for (const int threads : {1, 2, 16})
        for (const int failures : {0, 3}) {
            ThreadPool pool(threads);
            ShadowMap map = map_of_minus_one(32);
            const Tiling tiling(Split::tiles, ivec2(32), 1, 32);
            const ShadowMapParts parts(map, tiling, casters_of(pool, map, scene, tiling));
            std::atomic<int> begun = 0, left = failures, drawn = 0, caught = 0, too_early = 0;
            const auto fill = [&](auto&... what) {
                // All others have begun to wait when the first one draws, or throws.
                const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
                while (begun < threads && std::chrono::steady_clock::now() < end)
                    std::this_thread::yield();
                std::this_thread::sleep_for(std::chrono::milliseconds(20));
                ++drawn;
                draw_tile(what...);
                if (left-- > 0) throw std::runtime_error("no memory");
            };
            pool.run(pool.size(), [&](std::size_t, std::size_t) {
                ++begun;
                try {
                    parts.draw_in({{8, 8}, {10, 10}}, fill);
                    too_early += !parts.is_drawn(0);
                } catch (const std::runtime_error&) { ++caught; }
            });
            const int expected = std::min(threads, failures);
            ASSERT_EQ(caught, expected) << "failures, of " << threads << " threads that ask";
            ASSERT_EQ(too_early, 0)
                << "of " << threads << " threads that asked for a part, so many "
                << "went on before it was drawn";
            left = 0;
            parts.draw_in({{8, 8}, {10, 10}}, fill);
            ASSERT_EQ(drawn, expected + 1) << "so often a part was drawn, with the failures";
            ASSERT_TRUE(are_equal(map.depths.depths(), whole.depths.depths()))
                << "the map, after " << expected << " failures, " << threads << " threads";
        }
}
