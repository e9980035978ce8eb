// SPDX-License-Identifier: MIT
// Ids of visible triangles, their pixels as spans, barycentric coordinates found again, and the
// parts of shadow maps.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <random>
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
#include "11_scenes/scene_assets.hpp"
#include "11_scenes/scene_options.hpp"
#include "12_visibility_buffer/shadow_parts.hpp"
#include "12_visibility_buffer/visibility_buffer.hpp"
#include "12_visibility_buffer/visible_shading.hpp"
#include "support/any_scene.hpp"
#include "support/exact.hpp"
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

/// "interleaved rows of 30 x 20 pixels, 3 workers, tile side 8 (seed 5)"
std::string in_words(Split split, ivec2 size, std::size_t workers, int side, std::uint32_t seed) {
    return std::string(name_of(split)) + " of " + std::to_string(size.x) + " x " +
           std::to_string(size.y) + " pixels, " + std::to_string(workers) + " workers, tile side " +
           std::to_string(side) + " (seed " + std::to_string(seed) + ")";
}

/// An unlit opaque material for all triangles.
SceneAssets plain_assets() {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].illumination = 0;
    return make_scene_assets(std::move(scene), SceneRendererOptions());
}

/// The number of the triangle that is visible in each pixel, -1 where none is.
Image<int> ids_drawn(const std::vector<ProjectedTriangle>& triangles, const Tiling& tiling) {
    static const SceneAssets assets = plain_assets();
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

/// By definition: of all triangles the first whose depth is the greatest, if that is above 0.
int nearest_in(ivec2 pixel, const std::vector<ProjectedTriangle>& triangles) {
    int nearest = -1;
    float greatest = DepthBuffer::cleared;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        auto [a, b, c] = triangles[i].on_screen.vertices;
        const ivec2 p = exact_center(pixel);
        const int128 area = exact_twice_area(a, b, c);
        if (area == 0) continue;
        const int winding = area > 0 ? 1 : -1;
        const auto share = [&](ivec2 u, ivec2 v) { return winding * exact_twice_area(u, v, p); };
        const auto is_own = [&](ivec2 u, ivec2 v) {  // left and top edges: Eq. 2.7
            const int down = winding * (v.y - u.y), left = winding * (u.x - v.x);
            return share(u, v) > 0 || (share(u, v) == 0 && (down > 0 || (down == 0 && left > 0)));
        };
        if (!is_own(b, c) || !is_own(c, a) || !is_own(a, b)) continue;
        const auto inv_area = static_cast<float>(1.0 / static_cast<double>(winding * area));
        const Barycentrics at(static_cast<float>(share(b, c)), static_cast<float>(share(c, a)),
                              static_cast<float>(share(a, b)));
        const float depth = triangles[i].depth.at(at * inv_area);
        if (depth > greatest) greatest = depth, nearest = static_cast<int>(i);
    }
    return nearest;
}

/// What clipping leaves of random triangles: coarse coordinates, so that many have equal depths,
/// share edges, or go through the frustum's sides.
std::vector<ProjectedTriangle> coarse_triangles(Dice& dice, ivec2 size) {
    static const Mesh no_mesh;
    static const Triangle of_material_0{};
    std::vector<ProjectedTriangle> triangles;
    std::vector<std::array<vec4, 3>> before;
    for (int k = 0; k < 12; ++k) {
        std::array<vec4, 3> vertices;
        for (vec4& vertex : vertices) {
            const auto coarse = [&] { return 0.25f * static_cast<float>(dice.below(13)) - 1.5f; };
            const float x = coarse(), y = coarse(), w = dice.one_in(4) ? 2.0f : 1.0f;
            vertex = {x, y, 0.25f * static_cast<float>(dice.below(5)), w};
        }
        if (dice.one_in(3))  // facing the camera
            for (vec4& vertex : vertices) vertex.z = vertices[0].z / vertices[0].w * vertex.w;
        if (!before.empty() && dice.one_in(3))
            vertices = before[dice.below(static_cast<std::uint32_t>(before.size()))];
        before.push_back(vertices);
        for (const ClippedTriangle& clipped : clip_triangle(vertices))
            triangles.push_back(project(no_mesh, of_material_0, clipped, size));
    }
    return triangles;
}

BinnedTriangles binned(const ShadowMap& map, const Scene& scene, const Tiling& tiling) {
    ThreadPool pool(1);
    return casters_of(pool, map, scene, tiling);
}

/// As lesson 09 draws it.
Image<float> depths_of_whole(int size, const Scene& scene) {
    Bounds bounds;
    bounds.add(vec3(-1)), bounds.add(vec3(1));
    ShadowMap map(mat4(1), false, size, bounds);
    for (const Mesh& mesh : scene.meshes) draw_casters(map, mesh, [](std::size_t) { return true; });
    return map.depths.depths();
}

/// Which part a texel of the map's memory belongs to; the border around the map to those beside it.
std::size_t part_of(ivec2 in_memory, int size, int side) {
    const ivec2 texel = glm::clamp(in_memory - max_pcf_radius, ivec2(0), ivec2(size - 1));
    return static_cast<std::size_t>((texel.y / side) * ((size + side - 1) / side) + texel.x / side);
}

/// Tap by tap: the parts that a kernel lies in.
std::set<std::size_t> parts_asked(ivec2 middle, int radius, int size, int side) {
    std::set<std::size_t> parts;
    for (int y = middle.y - radius; y <= middle.y + radius; ++y)
        for (int x = middle.x - radius; x <= middle.x + radius; ++x)
            if (x >= 0 && y >= 0 && x < size && y < size)
                parts.insert(part_of(ivec2(x, y) + max_pcf_radius, size, side));
    return parts;
}

std::set<std::size_t> parts_drawn(const ShadowMapParts& parts) {
    std::set<std::size_t> all;
    for (std::size_t i = 0; i < parts.tiling().count(); ++i)
        if (parts.is_drawn(i)) all.insert(i);
    return all;
}

/// Whoever draws a part waits until all threads have begun, and then a while.
struct Holding {
    std::size_t threads;
    std::atomic<std::size_t> begun = 0, parts = 0;

    void wait() {
        ++parts;
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
        while (begun < threads && std::chrono::steady_clock::now() < end) std::this_thread::yield();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
};

}  // namespace

TEST(VisibilityBuffer, Eq12_1_TheFirstOfTheNearestStays) {
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
        for (const float z : depths) {
            triangles.push_back(projected(
                {{{{-1, -1, z, 1}, {1, 0, 0}}, {{3, -1, z, 1}, {0, 1, 0}}, {{-1, 3, z, 1}, {}}}},
                ivec2(1)));
        }
        ASSERT_EQ((ids_drawn(triangles, Tiling(Split::tiles, {1, 1}, 1, 8))[{0, 0}]), visible)
            << "the triangle that is visible (-1: none), of triangles at the depths "
            << testing::PrintToString(depths) << "; a pixel is cleared to depth 0";
    }
}

TEST(VisibilityBuffer, Eq12_1_EachPixelHasTheTriangleThatTheDefinitionGives) {
    const ivec2 size(41, 27);
    int visible = 0;
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        Dice dice(seed);
        const std::vector<ProjectedTriangle> triangles = coarse_triangles(dice, size);
        const Split split = splits[seed % 3];
        const std::size_t workers = 1 + seed % 5;
        const int side = 1 + static_cast<int>(dice.below(30));
        const Image<int> numbers = ids_drawn(triangles, Tiling(split, size, workers, side));
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const int expected = nearest_in({x, y}, triangles);
                visible += expected >= 0;
                ASSERT_EQ((numbers[{x, y}]), expected)
                    << "the triangle that is visible in the pixel (" << x << ", " << y
                    << ") (-1: none), by its number in drawing order, and the first of the nearest "
                    << "by exact coverage"
                    << (numbers[{x, y}] < 0 ? "; take_visible() may have lost it: Eq. 12.3" : "")
                    << "; " << in_words(split, size, workers, side, seed);
            }
    }
    EXPECT_GT(visible, 20'000) << "pixels in which a triangle is visible";
}

TEST(VisibilityBuffer, Eq12_2_PlanesOfTheWorkedExample) {
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

TEST(VisibilityBuffer, Eq12_2_HardCase_TheBitsOfFillTriangleUpToTheCoordinateLimit) {
    Dice dice(1);
    std::int64_t pixels = 0, far_away = 0;
    for (int k = 0; k < 30'000; ++k) {
        // Of any size from a pixel to the limit, anywhere up to it.
        const float limit = coordinate_limit - 1;
        const float extent = std::exp2(dice.between(0, 22)), reach = std::exp2(dice.between(3, 22));
        std::array<vec2, 3> v;
        const vec2 middle(dice.between(0, reach), dice.between(0, reach));
        for (vec2& vertex : v) {
            vertex = middle + extent * vec2(dice.in_cube(1));
            vertex = glm::clamp(vertex, -limit, limit);
        }
        const ScreenTriangle triangle = snap_triangle(v[0], v[1], v[2]);
        if (triangle.twice_area == 0) continue;
        // Pixels around a point of it.
        const float s = dice.between(0, 1), t = dice.between(0, 1 - s);
        const vec2 inside = v[0] + s * (v[1] - v[0]) + t * (v[2] - v[0]);
        const ivec2 first = glm::max(ivec2(inside) - 2, ivec2(0));
        const BarycentricPlanes planes(triangle);
        std::vector<std::pair<ivec2, Barycentrics>> row;
        const auto compare = [&] {
            if (row.empty()) return;
            // The whole row, and a pixel alone.
            for (const std::size_t from : {std::size_t{0}, row.size() - 1}) {
                std::size_t i = from;
                planes.for_each_in(
                    {row[from].first, static_cast<int>(row.size() - from)},
                    [&](ivec2 pixel, Barycentrics at) {
                        ASSERT_LT(i, row.size()) << "pixels of a span, seed 1, triangle " << k;
                        ASSERT_EQ(pixel, row[i].first) << "seed 1, triangle " << k;
                        ASSERT_EQ(at, row[i].second)
                            << "barycentric coordinates as found again and as fill_triangle() has "
                            << "them, at the pixel " << testing::PrintToString(pixel)
                            << " of the triangle " << testing::PrintToString(v[0]) << ", "
                            << testing::PrintToString(v[1]) << ", " << testing::PrintToString(v[2])
                            << " (seed 1, " << k << ")";
                        ++i;
                    });
                ASSERT_EQ(i, row.size()) << "pixels of a span, seed 1, triangle " << k;
            }
            row.clear();
        };
        fill_triangle(triangle, first, first + 5, [&](ivec2 pixel, Barycentrics at) {
            if (!row.empty() && row.back().first.y != pixel.y) compare();
            row.emplace_back(pixel, at);
            ++pixels, far_away += std::max(pixel.x, pixel.y) > 1 << 21;
        });
        compare();
        ASSERT_FALSE(HasFatalFailure());
    }
    EXPECT_GT(pixels, 100'000);
    EXPECT_GT(far_away, 1'000) << "pixels more than half as far away as the limit";
}

TEST(VisibilityBuffer, Eq12_3_SpansAreGroupedByTriangleInDrawingOrder) {
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

TEST(VisibilityBuffer, Eq12_3_EachPixelIsInOneRunOfItsTriangle) {
    for (std::uint32_t seed = 0; seed < 600; ++seed) {
        Dice dice(seed);
        const ivec2 size(1 + dice.below(40), 1 + dice.below(24));
        const Split split = splits[seed % 3];
        const std::size_t workers = 1 + dice.below(5);
        const int side = 1 + static_cast<int>(dice.below(20));
        const Tiling tiling(split, size, workers, side);
        const auto triangles = stand_ins(1 + dice.below(9));
        VisibilityBuffer visible(no_limit);  // for one tile after the other, as a worker has it
        for (std::size_t i = 0; i < tiling.count(); ++i) {
            const Tile tile = tiling[i];
            visible.begin(tile);
            for (const ProjectedTriangle& triangle : triangles) visible.add(triangle);
            std::vector<std::vector<SpanInNumbers>> spans_of(triangles.size());
            for (int y = tile.box.first.y; y <= tile.box.last.y; y += tile.row_step) {
                int last = -1;
                for (int x = tile.box.first.x; x <= tile.box.last.x; ++x) {
                    const int number =
                        x > tile.box.first.x && dice.one_in(2)
                            ? last
                            : static_cast<int>(
                                  dice.below(static_cast<std::uint32_t>(triangles.size() + 1))) -
                                  1;
                    if (number >= 0) {
                        std::vector<SpanInNumbers>& spans =
                            spans_of[static_cast<std::size_t>(number)];
                        if (number == last && x > tile.box.first.x)
                            ++spans.back()[2];
                        else
                            spans.push_back({x, y, 1});
                        // Some pixels had another triangle before.
                        visible.write({x, y}, 0);
                        visible.write({x, y}, static_cast<TriangleId>(number));
                    }
                    last = number;
                }
            }
            std::vector<TakenTriangle> expected;
            for (std::size_t t = 0; t < spans_of.size(); ++t)
                if (!spans_of[t].empty()) expected.emplace_back(t, spans_of[t]);
            ASSERT_EQ(taken(visible, triangles), expected)
                << "triangles with their spans (x, y, length), in tile " << i << " of "
                << tiling.count() << ", " << in_words(split, size, workers, side, seed);
        }
    }
}

TEST(VisibilityBuffer, HardCase_ATileBeginsWithoutWhatAnotherLeft) {
    look_up("Eq. 12.3");
    const std::vector<ProjectedTriangle> triangles = stand_ins(3);
    VisibilityBuffer visible(3);
    const std::array tiles = {Tile{{{0, 0}, {3, 3}}}, Tile{{{4, 0}, {13, 8}}},
                              Tile{{{0, 9}, {1, 9}}}, Tile{{{0, 1}, {9, 8}}, 3}};
    for (const Tile& tile : tiles) {
        visible.begin(tile);
        EXPECT_TRUE(taken(visible, triangles).empty())
            << "a tile begins without triangles, whatever the one before has left";
        visible.begin(tile);
        for (TriangleId id = 0; id < 3; ++id) {
            ASSERT_FALSE(visible.is_full()) << id << " triangles of at most 3";
            ASSERT_EQ(visible.add(triangles[id]), id)
                << "the id of triangle " << id << ", in drawing order";
        }
        ASSERT_TRUE(visible.is_full()) << "3 triangles of at most 3";
        for_each_strip(tile, [&](const PixelBox& strip) {
            for (int y = strip.first.y; y <= strip.last.y; ++y)
                visible.write({strip.first.x, y}, 2);
        });
    }
}

TEST(VisibilityBuffer, Eq12_6_PartsOfTheWorkedExample) {
    // Parts of 64 texels, a kernel of 3 * 3 texels around (127, 40): columns 1 and 2 of row 0.
    ShadowMap map = map_of_minus_one(256);
    const Tiling tiling(Split::tiles, ivec2(256), 1, 64);
    const ShadowMapParts parts(map, tiling, BinnedTriangles());
    const CountedSince counters;
    parts.draw_around({127, 40}, 1);
    EXPECT_EQ(parts_drawn(parts), (std::set<std::size_t>{1, 2}))
        << "parts drawn for a kernel of radius 1 around (127, 40): parts of 64 texels, 4 a row";
    EXPECT_EQ(counters[Counter::shadow_parts], 2u);
    parts.draw_around({128, 41}, 1);
    EXPECT_EQ(counters[Counter::shadow_parts], 2u) << "what is drawn is not drawn again";
    parts.draw_around({128, 63}, 0);
    EXPECT_EQ(counters[Counter::shadow_parts], 2u) << "radius 0: one texel, of part 2";
    parts.draw_around({128, 63}, 1);
    EXPECT_EQ(parts_drawn(parts), (std::set<std::size_t>{1, 2, 5, 6}))
        << "parts drawn when a kernel of radius 1 around (128, 63) has been asked for, too";
    parts.draw_around({0, 0}, 1);
    EXPECT_EQ(parts_drawn(parts), (std::set<std::size_t>{0, 1, 2, 5, 6}))
        << "parts drawn after a kernel around (0, 0), too: there is no column -1";
}

TEST(VisibilityBuffer, Eq12_6_JustTheAskedPartsAreDrawnAndHaveLesson09sBits) {
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        Dice dice(seed);
        const int size = 16 + static_cast<int>(dice.below(60));
        constexpr std::array sides = {1, 2, 5, 16, 32, 100};
        const int side = sides[seed % sides.size()];
        // No caster at all: the map is cleared, and that is all.
        const Scene scene = random_casters(seed % 7 == 0 ? 0 : 12, seed);
        const Image<float> whole = depths_of_whole(size, scene);
        ShadowMap map = map_of_minus_one(size);
        const Tiling tiling(Split::tiles, ivec2(size), 1, side);
        const ShadowMapParts parts(map, tiling,
                                   seed % 7 == 0 ? BinnedTriangles() : binned(map, scene, tiling));
        const CountedSince counters;
        std::set<std::size_t> asked;
        for (int test = 0; test < 6; ++test) {
            const auto end = static_cast<std::uint32_t>(size);
            ivec2 middle(dice.below(end), dice.below(end));
            if (dice.one_in(3)) middle.x = dice.one_in(2) ? 0 : size - 1;
            if (dice.one_in(3)) middle.y = dice.one_in(2) ? 0 : size - 1;
            const int radius = static_cast<int>(dice.below(max_pcf_radius + 1));
            parts.draw_around(middle, radius);
            asked.merge(parts_asked(middle, radius, size, side));
            const std::string where = "after kernel " + std::to_string(test) + ", of radius " +
                                      std::to_string(radius) + " around " +
                                      testing::PrintToString(middle) + ", in a map of " +
                                      std::to_string(size) + " texels in parts of " +
                                      std::to_string(side) + " (seed " + std::to_string(seed) + ")";
            ASSERT_EQ(parts_drawn(parts), asked)
                << "parts that are drawn, and that were asked for, " << where;
            ASSERT_EQ(counters[Counter::shadow_parts], asked.size())
                << "parts counted, and asked for, " << where;
        }
        Image<float> expected(whole.size(), -1);
        for (int y = 0; y < whole.size().y; ++y)
            for (int x = 0; x < whole.size().x; ++x)
                if (asked.contains(part_of({x, y}, size, side))) expected[{x, y}] = whole[{x, y}];
        ASSERT_TRUE(are_equal(map.depths.depths(), expected))
            << "depths, -1 where nothing was asked for; the map begins " << max_pcf_radius
            << " texels from its memory's corner; a map of " << size << " texels in parts of "
            << side << " (seed " << seed << ")";
    }
}

TEST(VisibilityBuffer, Eq12_6_ALightsVisibilityIsLesson09sAndTakesThePartsOfItsKernels) {
    ThreadPool pool(2);
    std::size_t maps = 0, half_lit = 0, parts_never_asked = 0;
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
        std::uint64_t serial = 0, asking = 0;
        const ShadowMaps whole = draw_shadow_maps(variant, {scene, bounds, lights});
        std::vector<std::set<std::size_t>> asked(on_demand.parts().size());
        for (int i = 0; i < 12; ++i) {
            const Mesh& mesh = scene.meshes[0];
            std::array<vec3, 3> vertices;
            for (std::size_t v = 0; v < 3; ++v) vertices[v] = mesh.positions[3 * dice.below(8) + v];
            ShadowBiasCache biases(vertices), same = biases;
            const vec3 at(dice.between(0, 0.5f), dice.between(0, 0.5f), 0);
            const vec3 point =
                at.x * vertices[0] + at.y * vertices[1] + (1 - at.x - at.y) * vertices[2];
            const vec3 normal = dice.in_cube(1);
            for (std::size_t l = 0; l < lights.size(); ++l) {
                // Lesson 09 says which texels it reads; their parts are found tap by tap.
                const CountedSince by_09;
                const float expected = light_visibility(
                    whole, l, same, point, normal, [&](std::size_t map, const PcfKernel& kernel) {
                        asked.at(map).merge(
                            parts_asked(kernel.middle, whole.radius, variant.size, side));
                    });
                serial += by_09[Counter::shadow_tests];
                half_lit += expected > 0 && expected < 1;
                const std::string where =
                    std::string(name_of(kind)) + ", " + name_of(variant.bias) + ", a map of " +
                    std::to_string(variant.size) + " texels in parts of " + std::to_string(side) +
                    ", PCF of " + std::to_string(variant.pcf) + " (seed " + std::to_string(seed) +
                    ", point " + std::to_string(i) + ")";
                const CountedSince by_12;
                ASSERT_EQ(light_visibility(on_demand, l, biases, point, normal), expected)
                    << "visibility of light " << l << " with maps on demand, and with lesson 09's; "
                    << where;
                asking += by_12[Counter::shadow_tests];
                for (std::size_t map = 0; map < asked.size(); ++map)
                    ASSERT_EQ(parts_drawn(on_demand.parts()[map]), asked[map])
                        << "parts of map " << map << " that are drawn, and that taps lie in; "
                        << where;
            }
        }
        maps += asked.size();
        for (std::size_t map = 0; map < asked.size(); ++map)
            parts_never_asked += on_demand.parts()[map].tiling().count() - asked[map].size();
        EXPECT_EQ(asking, serial) << "shadow tests";
    }
    EXPECT_GT(maps, 80u) << "maps; a point light has up to six";
    EXPECT_GT(half_lit, 100u) << "points at a shadow's edge";
    EXPECT_GT(parts_never_asked, 100u);
}

TEST(VisibilityBuffer, HardCase_WhoAsksForAPartThatIsBeingDrawnWaits) {
    look_up("Eq. 12.6");
    const Scene scene = random_casters(40, 3);
    const Image<float> whole = depths_of_whole(32, scene);
    for (const int threads : {2, 16}) {
        ThreadPool pool(threads);
        ShadowMap map = map_of_minus_one(32);
        const Tiling tiling(Split::tiles, ivec2(32), 1, 32);
        const ShadowMapParts parts(map, tiling, binned(map, scene, tiling));
        Holding holding{pool.size()};
        std::atomic<int> too_early = 0;
        pool.run(pool.size(), [&](std::size_t, std::size_t) {
            ++holding.begun;
            parts.draw_in({{8, 8}, {10, 10}}, [&](auto&... what) {
                holding.wait();
                draw_tile(what...);
            });
            if (!parts.is_drawn(0)) ++too_early;
        });
        ASSERT_EQ(too_early, 0) << "of " << threads << " threads that asked for a part, so many "
                                << "went on before it was drawn";
        ASSERT_EQ(holding.parts, 1u) << "times that a part was drawn for " << threads << " threads";
        ASSERT_TRUE(are_equal(map.depths.depths(), whole))
            << "the map as drawn by the first of " << threads << " threads that asked for it";
    }
}

TEST(VisibilityBuffer, HardCase_APartWhoseDrawingThrowsIsDrawnByTheNextWhoAsks) {
    look_up("Eq. 12.6");
    const Scene scene = random_casters(40, 3);
    const Image<float> whole = depths_of_whole(32, scene);
    for (const int threads : {1, 2, 16}) {
        ThreadPool pool(threads);
        ShadowMap map = map_of_minus_one(32);
        const Tiling tiling(Split::tiles, ivec2(32), 1, 32);
        const ShadowMapParts parts(map, tiling, binned(map, scene, tiling));
        Holding holding{pool.size()};  // all others wait when the first one throws
        std::atomic<int> left = 3, caught = 0;
        const auto fill = [&](auto&... what) {
            holding.wait();
            draw_tile(what...);
            if (left-- > 0) throw std::runtime_error("no memory");
        };
        pool.run(pool.size(), [&](std::size_t, std::size_t) {
            ++holding.begun;
            try {
                parts.draw_in({{8, 8}, {10, 10}}, fill);
            } catch (const std::runtime_error&) { ++caught; }
        });
        ASSERT_EQ(caught, std::min(threads, 3))
            << "of three failures, with " << threads << " threads that ask once each";
        ASSERT_EQ(parts.is_drawn(0), threads > 3);
        left = 0;
        parts.draw_in({{8, 8}, {10, 10}}, fill);
        ASSERT_TRUE(are_equal(map.depths.depths(), whole)) << "the map after the failures";
    }
}

TEST(VisibilityBuffer, HardCase_SixteenThreadsAskForTheSamePartsAtOnce) {
    look_up("Eq. 12.6");
    const Scene scene = random_casters(60, 4);
    constexpr int size = 48;
    const Image<float> whole = depths_of_whole(size, scene);
    const Tiling tiling(Split::tiles, ivec2(size), 1, 16);
    ThreadPool pool(16);
    for (int repeat = 0; repeat < 150; ++repeat) {
        ShadowMap map = map_of_minus_one(size);
        const ShadowMapParts parts(map, tiling, binned(map, scene, tiling));
        const CountedSince counters;
        std::atomic<int> wrong = 0;
        // Each thread asks for all parts, in one of two orders, and reads what it asked for at
        // once.
        pool.run(64, [&](std::size_t task, std::size_t) {
            for (int k = 0; k < 9; ++k) {
                const int part = task % 2 ? k : 8 - k;
                const ivec2 first = 16 * ivec2(part % 3, part / 3);
                parts.draw_around(first + 8, 2);
                for (int y = 0; y < 16; ++y)
                    for (int x = 0; x < 16; ++x) {
                        const ivec2 texel = first + ivec2(x, y) + max_pcf_radius;
                        wrong += map.depths.depths()[texel] != whole[texel];
                    }
            }
        });
        ASSERT_EQ(wrong, 0) << "texels that a thread has read otherwise than lesson 09 draws them, "
                            << "after it asked for their part; repeat " << repeat;
        ASSERT_EQ(counters[Counter::shadow_parts], 9u)
            << "parts that were drawn, of nine; repeat " << repeat;
    }
}
