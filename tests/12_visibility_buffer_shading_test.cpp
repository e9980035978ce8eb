// SPDX-License-Identifier: MIT
// How often a pixel is shaded, ids that run out, holes and glass, what --show shows, and the
// pictures.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "04_mvp/transform.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "10_threading/thread_options.hpp"
#include "10_threading/thread_pool.hpp"
#include "11_scenes/scene_assets.hpp"
#include "12_visibility_buffer/shadow_parts.hpp"
#include "12_visibility_buffer/views.hpp"
#include "support/any_scene.hpp"
#include "support/first_difference.hpp"
#include "support/golden.hpp"
#include "support/lesson_process.hpp"
#include "support/lessons_11_and_12.hpp"
#include "support/look_up.hpp"
#include "support/one_triangle.hpp"
#include "support/pictures.hpp"
#include "support/printers.hpp"
#include "support/squares.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

lesson_12::Options plain_picture(ivec2 size) {
    lesson_12::Options options;
    options.size = size;
    options.shadow.size = 64;
    return options;
}

/// Squares that cover the picture, and triangles in its middle.
class Surfaces : public Squares {
  public:
    Material& add_triangle(float z) {
        return add(mesh_of({{-0.5f, -0.5f, z}, {0.5f, -0.5f, z}, {0, 0.6f, z}}, {{0, 1, 2}}),
                   vec3(1 - 0.01f * z));
    }

    SceneAssets assets(const lesson_12::Options& options) const {
        return make_scene_assets(scene, options);
    }
};

/// Squares that cover the picture, in an order: the greater, the nearer.
Surfaces squares_in(std::span<const int> order) {
    Surfaces squares;
    for (const int nearness : order)
        squares.add(0.01f * static_cast<float>(nearness), vec3(0.1f, 0.5f, 0.3f));
    return squares;
}

/// How many are nearer than all before them: so often lesson 11 shades a pixel.
std::uint64_t nearer_than_all_before(std::span<const int> order) {
    std::uint64_t count = 0;
    int nearest = -1;
    for (const int nearness : order)
        count += nearness > std::exchange(nearest, std::max(nearest, nearness));
    return count;
}

double harmonic(int k) {
    double sum = 0;
    for (int i = 1; i <= k; ++i) sum += 1.0 / i;
    return sum;
}

/// How often a pixel of a heat map was shaded, by its colour; -1: that of no number up to 8.
int times_of(vec3 color) {
    for (int times = 0; times <= 8; ++times) {
        HeatMap heat(Show::shading, {1, 1});
        for (int i = 0; i < times; ++i) heat.add({0, 0});
        if (heat.picture()[{0, 0}] == color) return times;
    }
    return -1;
}

}  // namespace

TEST(VisibilityBuffer, Eq12_4_AllOrdersOfAFewSurfacesHaveTheMeanExactly) {
    const lesson_12::Options options = plain_picture({4, 4});
    ThreadPool pool(1);
    for (int k = 1; k <= 5; ++k) {
        std::vector<int> order(static_cast<std::size_t>(k));
        std::iota(order.begin(), order.end(), 0);
        std::uint64_t sum = 0, orders = 0;
        do {
            const SceneAssets assets = squares_in(order).assets(options);
            lesson_12::Options one_id = options;
            one_id.visibility.max_ids = 1;
            const std::string where = testing::PrintToString(order) +
                                      ", squares over all 16 pixels in drawing order, the "
                                      "greater the nearer";
            const std::uint64_t forward = nearer_than_all_before(order);
            ASSERT_EQ(drawn_by_11(options, assets, pool).count(Counter::fragments_shaded),
                      16 * forward)
                << "fragments that lesson 11 shades of " << where;
            ASSERT_EQ(drawn_by_12(one_id, assets, pool).count(Counter::fragments_shaded),
                      16 * forward)
                << "fragments shaded with --max-ids 1 of " << where;
            ASSERT_EQ(drawn_by_12(options, assets, pool).count(Counter::fragments_shaded), 16u)
                << "fragments shaded of " << where;
            sum += forward, ++orders;
        } while (std::ranges::next_permutation(order).found);
        // 5 surfaces: 274 times in 120 orders.
        ASSERT_EQ(static_cast<double>(sum), std::round(harmonic(k) * static_cast<double>(orders)))
            << "times that a pixel is shaded in all " << orders << " orders of " << k
            << " surfaces, and H_k times as many";
    }
}

TEST(VisibilityBuffer, Eq12_4_TenSurfacesInRandomOrderAreShadedThreeTimes) {
    constexpr int surfaces = 10, orders = 300;
    EXPECT_EQ(harmonic(2), 1.5) << "H_2 of the worked example";
    EXPECT_NEAR(harmonic(surfaces), 2.929, 0.0005) << "H_10 of the worked example";
    const lesson_12::Options options = plain_picture({1, 1});
    ThreadPool pool(1);
    Dice dice(7);
    std::uint64_t forward = 0;
    for (int i = 0; i < orders; ++i) {
        std::vector<int> order(surfaces);
        std::iota(order.begin(), order.end(), 0);
        for (std::uint32_t n = surfaces; n > 1; --n) std::swap(order[n - 1], order[dice.below(n)]);
        const SceneAssets assets = squares_in(order).assets(options);
        forward += drawn_by_11(options, assets, pool).count(Counter::fragments_shaded);
        ASSERT_EQ(drawn_by_12(options, assets, pool).count(Counter::fragments_shaded), 1u)
            << "times that the pixel is shaded, of squares in the order "
            << testing::PrintToString(order);
    }
    // The i-th is nearer than all before it with a chance of 1/i, whatever the others do.
    double variance = 0;
    for (int i = 1; i <= surfaces; ++i) variance += (1.0 - 1.0 / i) / i;
    const double four_deviations_of_the_mean = 4 * std::sqrt(variance / orders);
    EXPECT_NEAR(static_cast<double>(forward) / orders, harmonic(surfaces),
                four_deviations_of_the_mean)
        << "how often lesson 11 shades a pixel of ten surfaces in random order, and H_10";
    std::vector<int> order(surfaces);
    std::iota(order.begin(), order.end(), 0);
    EXPECT_EQ(drawn_by_11(options, squares_in(order).assets(options), pool)
                  .count(Counter::fragments_shaded),
              10u)
        << "drawn back to front";
    std::ranges::reverse(order);
    EXPECT_EQ(drawn_by_11(options, squares_in(order).assets(options), pool)
                  .count(Counter::fragments_shaded),
              1u)
        << "drawn front to back";
}

TEST(VisibilityBuffer, Eq12_5_AllIsSavedButTheLastShading) {
    // Of k t_d + s t_s, lesson 12 keeps k t_d and one t_s: the tests are the same, and of the
    // shading (s - 1) t_s are saved.
    const lesson_12::Options options = plain_picture({6, 6});
    ThreadPool pool(2);
    Dice dice(12);
    for (int i = 0; i < 40; ++i) {
        std::vector<int> order(1 + dice.below(7));
        for (int& nearness : order) nearness = static_cast<int>(dice.below(5));  // some are equal
        const SceneAssets assets = squares_in(order).assets(options);
        const Drawn forward = drawn_by_11(options, assets, pool);
        const Drawn visible = drawn_by_12(options, assets, pool);
        const std::string where =
            testing::PrintToString(order) + ", squares in drawing order, the greater the nearer";
        ASSERT_EQ(visible.count(Counter::fragments_tested), 36 * order.size())
            << "fragments tested of " << where;
        ASSERT_EQ(forward.count(Counter::fragments_tested), 36 * order.size())
            << "fragments that lesson 11 tests of " << where;
        ASSERT_EQ(
            forward.count(Counter::fragments_shaded) - visible.count(Counter::fragments_shaded),
            36 * (nearer_than_all_before(order) - 1))
            << "fragments that lesson 11 shades and lesson 12 does not, of " << where;
    }
}

TEST(VisibilityBuffer, HardCase_IdsThatRunOutBeginAnew) {
    look_up("Eq. 12.1");
    // Triangles over one pixel, back to front: of each n, the last one is shaded.
    ThreadPool pool(1);
    for (const int triangles : {1, 2, 3, 6, 7, 12})
        for (const int max_ids : {1, 2, 3, 6, 7, unlimited_ids}) {
            Surfaces surfaces;
            for (int i = 0; i < triangles; ++i)
                surfaces.add_triangle(0.01f * static_cast<float>(i));
            lesson_12::Options options = plain_picture({1, 1});
            options.visibility.max_ids = max_ids;
            const SceneAssets assets = surfaces.assets(options);
            const Drawn visible = drawn_by_12(options, assets, pool);
            ASSERT_EQ(visible.count(Counter::fragments_shaded),
                      static_cast<std::uint64_t>((triangles - 1) / max_ids + 1))
                << "times that a pixel is shaded, of " << triangles
                << " triangles back to front with --max-ids " << max_ids;
            ASSERT_EQ((visible.picture[{0, 0}]),
                      vec3(1 - 0.01f * (0.01f * static_cast<float>(triangles - 1))))
                << "the nearest of " << triangles << " triangles, with --max-ids " << max_ids;
        }
}

TEST(VisibilityBuffer, HardCase_ManyTrianglesInOnePixel) {
    look_up("Eq. 12.1");
    // Each is nearer than the ones before it, but for those of every hundred that have one depth.
    constexpr std::uint32_t count = 5 << 16;  // more than 16 bits tell apart
    Surfaces surfaces;
    surfaces.add_triangle(0);
    Mesh& mesh = surfaces.scene.meshes[0];
    const std::vector<vec3> vertices = mesh.positions;
    const Triangle triangle = mesh.triangles[0];
    mesh.positions.clear(), mesh.triangles.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
        const float z = static_cast<float>(i / 100) * 0x1p-11f;
        for (const vec3 vertex : vertices) mesh.positions.push_back(vertex + vec3(0, 0, z));
        Triangle& next = mesh.triangles.emplace_back(triangle);
        for (std::uint32_t v = 0; v < 3; ++v) next.vertices[v].position = 3 * i + v;
    }
    mesh.bounds.add(mesh.positions.back());
    ThreadPool pool(2);
    lesson_12::Options options = plain_picture({1, 1});
    const SceneAssets assets = surfaces.assets(options);
    const Drawn forward = drawn_by_11(options, assets, pool);
    const std::uint64_t levels = (count + 99) / 100;
    ASSERT_EQ(forward.count(Counter::fragments_shaded), levels) << "depths that lesson 11 shades";
    for (const int max_ids : {1, 2, 100, 255, 65535, unlimited_ids}) {
        options.visibility.max_ids = max_ids;
        const Drawn visible = drawn_by_12(options, assets, pool);
        ASSERT_TRUE(have_the_same_bits(visible.picture, forward.picture))
            << count << " triangles over a pixel with --max-ids " << max_ids;
        ASSERT_EQ(visible.count(Counter::fragments_tested), count);
        // One for each round in which something was nearer than before.
        const auto n = static_cast<std::uint64_t>(max_ids);
        std::uint64_t expected = 0;
        for (std::uint64_t first = 0; first < count; first += n) {
            const std::uint64_t last = std::min<std::uint64_t>(first + n, count) - 1;
            expected += first == 0 || last / 100 > (first - 1) / 100;
        }
        ASSERT_EQ(visible.count(Counter::fragments_shaded), expected)
            << "times that a pixel is shaded with --max-ids " << max_ids << ", of " << count
            << " triangles back to front, a hundred at each depth";
    }
}

TEST(VisibilityBuffer, HardCase_HolesAreFoundBeforeAnIdIsWritten) {
    look_up("Eq. 12.1");
    const vec3 red(1, 0, 0), green(0, 1, 0);
    ThreadPool pool(1);
    for (const bool is_leaf_first : {true, false})
        for (const float opacity : {0.5f, 0.4999f}) {
            const bool is_hole = opacity < 0.5f;
            Surfaces squares;
            const auto add_leaf = [&](float z) {
                Material& leaf = squares.add(z, green);
                leaf.alpha = AlphaMode::mask, leaf.opacity = opacity;
            };
            if (is_leaf_first) add_leaf(0.5f);
            squares.add(0, red);
            if (!is_leaf_first) add_leaf(0.5f);
            add_leaf(-1);  // behind the wall that is there: not asked whether it is a hole
            lesson_12::Options options = plain_picture({8, 8});
            const std::string where = "a green leaf of opacity " + std::to_string(opacity) +
                                      " and cutoff 0.5 before a red wall; the " +
                                      (is_leaf_first ? "leaf" : "wall") + " is drawn first";
            const Drawn visible = drawn_by_12(options, squares.assets(options), pool);
            ASSERT_EQ((visible.picture[{5, 3}]), is_hole ? red : green) << where;
            ASSERT_EQ(visible.count(Counter::alpha_tested_fragments), 64u) << where;
            ASSERT_EQ(visible.count(Counter::fragments_shaded), 64u) << where;
            options.shading.all_effects = true;
            ASSERT_EQ((drawn_by_12(options, squares.assets(options), pool).picture[{5, 3}]),
                      is_hole ? red : green)
                << where << "; with --all-effects, what is no hole is opaque all the same";
        }
}

TEST(VisibilityBuffer, HardCase_GlassIsShadedAfterAllThatIsOpaque) {
    look_up("Eq. 12.3");
    Surfaces squares;
    squares.add_glass(1, vec3(0, 0, 1), 0.5f);
    squares.add_glass(0.5f, vec3(1, 0, 0), 0.5f);
    squares.add(-1, vec3(0));
    squares.add(0, vec3(0, 1, 0));            // hides the one before
    squares.add_glass(-0.5f, vec3(1), 0.5f);  // behind the wall: neither shaded nor blended
    squares.add_glass(0, vec3(1), 0.5f);      // as far as the wall, which is there first: neither
    ThreadPool pool(2);
    for (const int max_ids : {1, unlimited_ids}) {
        lesson_12::Options options = plain_picture({16, 16});
        options.visibility.max_ids = max_ids;
        const Drawn visible = drawn_by_12(options, squares.assets(options), pool);
        EXPECT_EQ((visible.picture[{3, 9}]), vec3(0.25f, 0.25f, 0.5f))
            << "blue glass before red glass before a green wall, each of opacity 0.5";
        EXPECT_EQ(visible.count(Counter::blended_fragments), 512u);
        EXPECT_EQ(visible.count(Counter::fragments_shaded), max_ids == 1 ? 1024u : 768u)
            << "fragments shaded with --max-ids " << max_ids
            << ", of two panes before the nearer of two walls";
    }
}

TEST(VisibilityBuffer, HardCase_APixelOfAnyClippedPieceIsShadedOnce) {
    look_up("Eq. 12.1");
    // A triangle through the camera's near plane and all sides of the picture: clipping leaves
    // pieces with an id each, which share their inner edges.
    Surfaces surfaces;
    surfaces.add_triangle(0);
    surfaces.scene.meshes[0].positions = {{-40, -1, -60}, {50, -1, -30}, {-3, 0.2f, 14}};
    surfaces.scene.meshes[0].bounds = {};
    for (const vec3 p : surfaces.scene.meshes[0].positions) surfaces.scene.meshes[0].bounds.add(p);
    surfaces.scene.materials[1].two_sided = true;
    ThreadPool pool(2);
    for (const int max_ids : {1, 2, unlimited_ids}) {
        lesson_12::Options options = plain_picture({64, 64});
        options.visibility.max_ids = max_ids, options.threads.tile = 16;
        const SceneAssets assets = surfaces.assets(options);
        const Drawn visible = drawn_by_12(options, assets, pool);
        const std::uint64_t covered = opaque_pixels(options, assets, pool);
        ASSERT_GT(covered, 500u);
        EXPECT_EQ(visible.count(Counter::fragments_tested), covered) << "pieces do not overlap";
        EXPECT_EQ(visible.count(Counter::fragments_shaded), covered)
            << "each of the triangle's pixels once, with --max-ids " << max_ids;
        EXPECT_TRUE(
            have_the_same_bits(visible.picture, drawn_by_11(options, assets, pool).picture));
    }
}

TEST(VisibilityBuffer, HardCase_HowOftenAPixelIsShadedIsShownAsItWas) {
    look_up("Eq. 12.4");
    // The colours: brighter each time, up to eight times.
    HeatMap heat(Show::shading, {12, 2}), off(Show::picture, {12, 2});
    for (int x = 0; x < 12; ++x)
        for (int i = 0; i < x; ++i) heat.add({x, 0}), off.add({x, 0});
    heat.add(PixelSpan{{2, 1}, 3});
    const Image<vec3> ramp = heat.picture();
    const auto brightness_of = [&](int x) {
        return glm::dot(ramp[{x, 0}], vec3(0.2126f, 0.7152f, 0.0722f));
    };
    for (int x = 1; x <= 8; ++x)
        ASSERT_GT(brightness_of(x), brightness_of(x - 1) + 0.004f)
            << "a pixel shaded " << x << " times is clearly brighter than one shaded " << x - 1
            << " times";
    for (int x = 9; x < 12; ++x)
        EXPECT_EQ((ramp[{x, 0}]), (ramp[{8, 0}])) << x << " times, and eight times";
    for (int x = 0; x < 12; ++x)
        EXPECT_EQ((ramp[{x, 1}]), (ramp[{x >= 2 && x < 5 ? 1 : 0, 0}]))
            << "pixel " << x << " of a row with a span of three from 2 on";
    for (int i = 0; i < 1 << 16; ++i) heat.add({0, 0});
    EXPECT_EQ((heat.picture()[{0, 0}]), (ramp[{8, 0}])) << "65,536 times, and eight times";
    EXPECT_EQ(off.picture().size(), ivec2(0)) << "nothing is counted unless it is to be shown";

    // Four squares that cut through each other in the middle: from the left of the picture, each
    // is nearer than the one before it; from its right, none is. In front of them there is glass.
    Surfaces squares;
    for (const float tilt : {-0.2f, 0.1f, 0.3f, 0.4f}) squares.add(0, vec3(0.5f), tilt);
    squares.add_glass(1, vec3(1), 0.5f);
    ThreadPool pool(2);
    for (const int max_ids : {1, unlimited_ids}) {
        lesson_12::Options options = plain_picture({16, 16});
        options.visibility.show = Show::shading, options.visibility.max_ids = max_ids;
        const Image<vec3> picture = drawn_by_12(options, squares.assets(options), pool).picture;
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x)
                ASSERT_EQ(times_of(picture[{x, y}]), max_ids == 1 && x < 8 ? 5 : 2)
                    << "times that the pixel (" << x << ", " << y << ") is shaded, with --max-ids "
                    << max_ids;
    }
}

TEST(VisibilityBuffer, HardCase_TrianglesAreShownInColorsOfTheirOwn) {
    look_up("Eq. 12.1");
    // The same picture, as lesson 11 draws it, of triangles that are painted in these colours.
    ThreadPool pool(2);
    for (const char* const name : {"unlit.glb", "textured.gltf", "floor.obj"})
        for (const int max_ids : {1, 3, unlimited_ids}) {
            lesson_12::Options options = plain_picture({160, 90});
            options.visibility.max_ids = max_ids, options.threads.tile = 32;
            Scene painted = loaded(name);
            const std::vector<Material> materials = std::exchange(painted.materials, {});
            for (Mesh& mesh : painted.meshes) {
                mesh.colors.clear();
                for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
                    Material paint;
                    paint.two_sided = materials[mesh.triangles[i].material].two_sided;
                    paint.illumination = 0, paint.diffuse = paint.ambient = color_of(i);
                    mesh.triangles[i].material =
                        static_cast<std::uint32_t>(painted.materials.size());
                    painted.materials.push_back(paint);
                }
            }
            const Image<vec3> expected =
                drawn_by_11(options, make_scene_assets(painted, options), pool).picture;
            options.visibility.show = Show::ids;
            const Drawn ids = drawn_by_12(options, make_scene_assets(loaded(name), options), pool);
            ASSERT_TRUE(have_the_same_bits(ids.picture, expected))
                << "--show ids of " << name << " with --max-ids " << max_ids
                << ", beside lesson 11's picture of triangles in these colours";
        }
}

TEST(VisibilityBuffer, HardCase_PartsOfAMapAreShownAsTheyWereDrawn) {
    look_up("Eq. 12.6");
    Dice dice(5);
    Scene scene;
    scene.materials.resize(1);
    std::vector<vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t i = 0; i < 60; i += 3) {
        for (int v = 0; v < 3; ++v) positions.push_back(dice.in_cube(1));
        triangles.push_back({i, i + 1, i + 2});
    }
    scene.meshes.push_back(mesh_of(positions, triangles));
    const ShadowBounds bounds = shadow_bounds(scene);
    const std::array<Light, 1> lights = {sun(glm::normalize(vec3(0.3f, 1, 0.2f)))};
    const std::array casts = {true};
    ThreadPool pool(2);
    for (const auto& [texels, part_side] : {std::pair(100, 32), {40, 3}, {61, 2}, {257, 32}})
        for (const ivec2 size : {ivec2(120, 90), {64, 200}, {257, 257}}) {
            const ShadowOptions variant{.size = texels};
            const ShadowMapsOnDemand on_demand(pool, part_side, variant,
                                               {scene, bounds, lights, false, casts});
            ASSERT_EQ(on_demand.parts().size(), 1u) << "one map of a directional light";
            const ShadowMapParts& parts = on_demand.parts()[0];
            const int columns = (texels + part_side - 1) / part_side;
            std::vector<bool> asked(static_cast<std::size_t>(columns * columns));
            for (std::size_t i = 0; i < asked.size(); ++i) {
                asked[i] = i == 0 || dice.one_in(2);
                const ivec2 part(static_cast<int>(i) % columns, static_cast<int>(i) / columns);
                if (asked[i]) parts.draw_around(part_side * part, 0);
            }
            const Image<vec3> picture = picture_of(on_demand, size);
            ASSERT_EQ(picture.size(), size);
            // All of the map, as lesson 09 draws it.
            const ShadowMap& map = parts.map();
            ShadowMap whole(map.clip_from_world, false, texels, scene.bounds());
            draw_casters(whole, scene.meshes[0], [](std::size_t) { return true; });
            const auto depth_of = [&](ivec2 texel) {
                return whole.depths.depths()[texel + max_pcf_radius];
            };
            const auto part_at = [side_of_part = part_side](ivec2 texel) {
                return texel / side_of_part;
            };
            const auto is_asked = [&](ivec2 part) {
                return asked[static_cast<std::size_t>(part.y * columns + part.x)];
            };
            float nearest = 0, farthest = 1;
            for (int y = 0; y < texels; ++y)
                for (int x = 0; x < texels; ++x)
                    if (const float depth = depth_of({x, y});
                        is_asked(part_at({x, y})) && depth > 0)
                        nearest = std::max(nearest, depth), farthest = std::min(farthest, depth);
            const int side = std::min(size.x, size.y);
            const ivec2 corner = (size - side) / 2;
            int blue = 0, black = 0, gray = 0;
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x) {
                    const ivec2 in_square = ivec2(x, y) - corner;
                    vec3 expected(0);
                    if (in_square.x >= 0 && in_square.y >= 0 && in_square.x < side &&
                        in_square.y < side) {
                        const ivec2 texel = in_square * texels / side, part = part_at(texel);
                        const float depth = depth_of(texel);
                        if (!is_asked(part)) {
                            expected = vec3(0.05f, 0.12f, 0.35f), ++blue;
                        } else if (depth > 0) {
                            const float shade = 1 - 0.9f * (nearest - depth) / (nearest - farthest);
                            expected = vec3(shade * shade), ++gray;
                        } else {
                            ++black;
                        }
                        // The first pixels of a part, from the left and from above.
                        const bool is_border =
                            in_square.x == 0 || in_square.y == 0 ||
                            part_at((in_square - ivec2(1, 0)) * texels / side) != part ||
                            part_at((in_square - ivec2(0, 1)) * texels / side) != part;
                        if (is_border) expected = 0.5f * expected + 0.02f;
                    }
                    ASSERT_LT(glm::distance(picture[{x, y}], expected), 1e-6f)
                        << "pixel (" << x << ", " << y << ") of a picture of " << size.x << " x "
                        << size.y << ": " << testing::PrintToString(picture[{x, y}])
                        << ", expected " << testing::PrintToString(expected) << "; a map of "
                        << texels << " texels in parts of " << part_side
                        << ", of which some are not drawn";
                }
            EXPECT_GT(std::min({blue, black, gray}), 100)
                << "pixels that are blue, black, grey: all three are there";
        }
    const ShadowOptions variant{.size = 64};
    const ShadowMapsOnDemand no_maps(pool, 32, variant, {Scene(), ShadowBounds(), {}});
    EXPECT_TRUE(are_equal(picture_of(no_maps, {9, 5}), Image<vec3>({9, 5}, vec3(0))))
        << "without a map all is black";
}

TEST(VisibilityBuffer, HardCase_InvalidOptionsAreAnErrorInOneLine) {
    look_up("Eq. 12.6");
    const auto run = [](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(),
                         {"--size", "32x18", "--shadow-size", "64", "--out",
                          (fresh_folder("visibility_options") / "a.png").string()});
        return run_program("12_visibility_buffer", arguments);
    };
    expect_error(run({"--max-ids", "0"}), 2, "--max-ids");
    expect_error(run({"--shadow-part", "31"}), 2, "--shadow-part");
    expect_error(run({"--shadow-part", "8193"}), 2, "--shadow-part");
    expect_error(run({"--show", "all"}), 2, "--show");
    const ProcessResult explained = run({"--max-ids", "1", "--shadow-part", "32", "--explain"});
    ASSERT_EQ(explained.exit_status, 0) << explained.err;
    for (const char* line : {"  casters: ", "  triangles: ", "  picture: ", "  shadow_parts: "})
        EXPECT_NE(explained.out.find(line), std::string::npos)
            << "--explain has no line \"" << line << "\":\n"
            << explained.out;
}

TEST(VisibilityBuffer, PictureOfIds) {
    // Where the tangent of the camera's angle has another last bit, some vertices are snapped to
    // the next 1/256 pixel. An edge there passes a pixel's centre, and the colour jumps: with an
    // angle that is an ulp off, in up to 3 pixels.
    constexpr std::size_t may_jump = 20;
    EXPECT_TRUE(equals_golden("12_visibility_buffer", "12_visibility_buffer_ids", {"--show", "ids"},
                              may_jump));
}

constexpr const char* returned =
    "is it the scene itself? Then main.cpp does not return what --show asks for";

TEST(VisibilityBuffer, PictureOfEachPixelOnce) {
    EXPECT_TRUE(equals_golden("12_visibility_buffer", "11_scenes_unlit", {"--model", "unlit.glb"}))
        << "this is lesson 11's picture";
    EXPECT_TRUE(equals_golden("12_visibility_buffer", "12_visibility_buffer_overdraw",
                              {"--model", "textured.gltf", "--show", "shading", "--max-ids", "1"}));
    EXPECT_TRUE(equals_golden("12_visibility_buffer", "12_visibility_buffer_shading",
                              {"--model", "textured.gltf", "--show", "shading"}))
        << returned;
}

TEST(VisibilityBuffer, PictureOfShadowMapParts) {
    EXPECT_TRUE(equals_golden("12_visibility_buffer", "12_visibility_buffer"));
    EXPECT_TRUE(equals_golden("12_visibility_buffer", "12_visibility_buffer_shadow_map",
                              {"--show", "shadow-map"}))
        << returned;
}

TEST(VisibilityBuffer, PictureOfTheSceneIsLesson11sByteForByte) {
    const std::string expected = bytes_of_picture("11_scenes", {"--size", golden_size});
    ASSERT_GT(expected.size(), 100000u);
    EXPECT_TRUE(bytes_of_picture("12_visibility_buffer", {"--size", golden_size}) == expected)
        << "12_visibility_buffer.png is not 11_scenes.png; ./tests/run --diagnose says where";
    EXPECT_TRUE(bytes_of_picture("12_visibility_buffer", {"--size", golden_size, "--threads", "3",
                                                          "--max-ids", "100"}) == expected)
        << "with --threads 3 --max-ids 100 the picture is not lesson 11's";
}
