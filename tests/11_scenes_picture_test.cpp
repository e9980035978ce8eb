// SPDX-License-Identifier: MIT
// Pictures of scenes: only what is called for, the same bits with all of it, files and cameras.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "10_threading/thread_pool.hpp"
#include "11_scenes/explain.hpp"
#include "11_scenes/scene_assets.hpp"
#include "11_scenes/scene_camera.hpp"
#include "common/image/backdrop.hpp"
#include "common/image/bmp.hpp"
#include "common/image/input_error.hpp"
#include "common/model/obj.hpp"
#include "support/first_difference.hpp"
#include "support/golden.hpp"
#include "support/lesson_10.hpp"
#include "support/lesson_11.hpp"
#include "support/lesson_process.hpp"
#include "support/look_up.hpp"
#include "support/name_of_split.hpp"
#include "support/pictures.hpp"
#include "support/pretend_pool.hpp"
#include "support/printers.hpp"
#include "support/squares.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr std::array scenes = {"unlit.glb", "textured.gltf", "bumpy.glb", "toon.glb"};

lesson_11::Options small_picture(ivec2 size = {160, 90}) {
    lesson_11::Options options;
    options.size = size;
    options.shadow.size = 128;
    options.threads.tile = 16;
    return options;
}

Drawn drawn(Scene scene, const lesson_11::Options& options) {
    return test::drawn(options, make_scene_assets(std::move(scene), options),
                       [](const auto& of, const auto& assets) {
                           ThreadPool pool(2);
                           StepClock clock;
                           return lesson_11::render(of, assets, pool, clock);
                       });
}

/// Work of effects.
const std::map<Effect, std::vector<Counter>> work_of = {
    {Effect::light, {Counter::fragments_lit}},
    {Effect::highlight, {Counter::highlights}},
    {Effect::texture, {Counter::texture_samples}},
    {Effect::vertex_colors, {Counter::colored_fragments}},
    {Effect::normal_map, {Counter::normal_map_samples, Counter::meshes_with_tangents}},
    {Effect::shadow, {Counter::shadow_passes, Counter::shadow_fragments, Counter::shadow_tests}},
    {Effect::toon, {Counter::toon_fragments}},
    {Effect::mask, {Counter::alpha_tested_fragments}},
    {Effect::blend, {Counter::blended_fragments}}};

vec3 middle_of(const Squares& squares) {
    return drawn(squares.scene, small_picture({8, 8})).picture[{5, 3}];
}

}  // namespace

TEST(SceneFiles, HardCase_LightsWithoutRoomForTheirShadowMapsAreNamed) {
    look_up("Too many lights");
    Scene scene = loaded("scene_bumpy.obj");
    const vec3 middle = scene.bounds().center();  // where a point light has maps on all sides
    for (const char* const name : {"red", "green", "blue", "sun"})
        scene.lights.push_back({name, SceneLight::Kind::point, vec3(1), middle, {0, -1, 0}, 100});
    scene.lights.back().kind = SceneLight::Kind::directional;
    lesson_11::Options options;
    options.shadow.size = 64;
    const SceneAssets assets = make_scene_assets(scene, options);
    const std::vector casts(assets.lit_by.casts.begin(), assets.lit_by.casts.begin() + 4);
    EXPECT_EQ(casts, (std::vector{true, true, false, false})) << "two times six maps are there";
    const auto named = [&](const std::string& name) {
        return std::ranges::count(
            assets.scene.warnings,
            "light \"" + name + "\" casts no shadows: no more than 12 shadow maps are drawn");
    };
    EXPECT_EQ(named("red") + named("green"), 0);
    EXPECT_EQ(named("blue"), 1);
    EXPECT_EQ(named("sun"), 1);
}

TEST(SceneFiles, HardCase_PanesAreBlendedAlikeInPartsOfATile) {
    look_up("Memory");
    Squares squares;
    for (int i = 0; i < 300; ++i) {  // they cut through each other
        const float share = static_cast<float>(i * 37 % 300) / 300;
        squares.add_glass(share, vec3(share, 1 - share, 0.5f), 0.3f, 0.5f - share);
    }
    lesson_11::Options options = small_picture({160, 90});
    const Image<vec3> in_tiles = drawn(squares.scene, options).picture;
    options.threads.split = Split::rows;
    std::size_t parts = 0;
    for_each_part(Tile{{{0, 0}, {159, 44}}}, 600, [&](const Tile&) { ++parts; });
    ASSERT_GT(parts, 1u) << "what two threads draw of the picture is too much at once";
    EXPECT_TRUE(have_the_same_bits(drawn(squares.scene, options).picture, in_tiles));
}

TEST(SceneFiles, HardCase_TooMuchOverdrawIsAnError) {
    look_up("lesson 10: Large triangles and slivers");
    Squares squares;
    for (int i = 0; i < 10; ++i) squares.add(0, vec3(1));
    squares.scene.file = "ten.obj";
    lesson_11::Options options = small_picture({1024, 1024});
    squares.scene.budget.set(Resource::overdraw, 11);  // ten, and something for their borders
    EXPECT_NO_THROW(drawn(squares.scene, options));
    options.size = {512, 256};
    squares.scene.budget.set(Resource::overdraw, 2);  // a small picture may have more
    EXPECT_NO_THROW(drawn(squares.scene, options));
    options.size = {1024, 1024};
    squares.scene.budget.set(Resource::overdraw, 10);
    try {
        drawn(squares.scene, options);
        FAIL() << "no error";
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "ten.obj: covers a picture 11 times, more than the 10 that are "
                     "accepted; see --limit overdraw=N");
    }
}

TEST(SceneFiles, HardCase_UnusedEffectsTakeNoWork) {
    look_up("Eq. 11.3");
    std::map<Effect, int> off, on;
    for (const char* name : scenes) {
        SCOPED_TRACE(name);
        const lesson_11::Options options = small_picture();
        const SceneAssets assets = make_scene_assets(loaded(name), options);
        const Drawn picture = drawn(loaded(name), options);
        EXPECT_GT(picture.count(Counter::fragments_shaded), 2000u);
        for (const auto& [effect, counters] : work_of) {
            SCOPED_TRACE(effect_names[static_cast<std::size_t>(effect)]);
            // Those of toon materials are counted among the lit ones.
            const bool runs = assets.plan.any(effect) ||
                              (effect == Effect::light && assets.plan.any(Effect::toon));
            ++(runs ? on : off)[effect];
            for (const Counter counter : counters) {
                SCOPED_TRACE(counter_names[static_cast<std::size_t>(counter)]);
                EXPECT_EQ(picture.count(counter) > 0, runs);
            }
        }
        EXPECT_EQ(picture.count(Counter::outline_tests), 0u) << "an outline is a mesh here";
        std::uint64_t own_triangles = 0;
        for (const Mesh& mesh : assets.scene.meshes) own_triangles += mesh.triangles.size();
        EXPECT_EQ(picture.count(Counter::triangles_in) > own_triangles,
                  assets.plan.any(Effect::outline));
        // Counted together with other textures; no scene has one.
        for (const Effect effect : {Effect::specular_map, Effect::emission_map})
            EXPECT_FALSE(assets.plan.any(effect));
        for (const auto* textures : {&assets.textures.specular, &assets.textures.emission})
            for (const auto& texture : *textures) EXPECT_EQ(texture, nullptr);
    }
    EXPECT_EQ(work_of.size() + 3, effect_count) << "and of outlines, specular and emission maps";
    for (const auto& [effect, counters] : work_of)
        EXPECT_GT(off[effect], 0) << effect_names[static_cast<std::size_t>(effect)];
    for (const Effect effect : {Effect::light, Effect::highlight, Effect::texture, Effect::toon,
                                Effect::vertex_colors, Effect::normal_map, Effect::shadow})
        EXPECT_GT(on[effect], 0) << effect_names[static_cast<std::size_t>(effect)];
}

TEST(SceneFiles, HardCase_AllEffectsForcedGiveTheSameBits) {
    look_up("Eq. 11.3");
    for (const char* name : {"unlit.glb", "textured.gltf", "bumpy.glb", "toon.glb", "crate.obj",
                             "scene_bumpy.obj", "figure.obj"}) {
        SCOPED_TRACE(name);
        lesson_11::Options options = small_picture();
        const Drawn plain = drawn(loaded(name), options);
        options.shading.all_effects = true;
        const Drawn forced = drawn(loaded(name), options);
        ASSERT_TRUE(have_the_same_bits(forced.picture, plain.picture))
            << "with --all-effects, beside without";
        EXPECT_GT(forced.count(Counter::colored_fragments), 1000u);
        EXPECT_GT(forced.count(Counter::blended_fragments), 1000u);
        EXPECT_GT(forced.count(Counter::texture_samples), 1000u);
        EXPECT_GT(forced.count(Counter::toon_fragments) + forced.count(Counter::highlights), 1000u);
    }
}

TEST(SceneFiles, HardCase_TheNearerOfTwoWallsIsSeenHoweverNearTheNearPlane) {
    look_up("The camera of a file, and lesson 04, Eq. 4.8");
    // A file's camera without zfar; the farther wall is drawn first.
    for (const float near : {1e-30f, 1e-5f, 0.01f, 1.0f})
        for (const float distance : {2.0f, 49.9f, 1990.0f, 1e6f})
            for (const float farther_by : {1.002f, 1.00001f}) {
                Squares walls;
                walls.scene.cameras = {
                    {"c", mat4(1), 0.5f, near, std::numeric_limits<float>::infinity()}};
                for (const auto& [z, color] : {std::pair{-farther_by * distance, vec3(1, 0, 0)},
                                               {-distance, vec3(0, 1, 0)}}) {
                    walls.add(0, color);
                    Mesh& wall = walls.scene.meshes.back();
                    wall.bounds = {};
                    for (vec3& p : wall.positions) {
                        p = {distance * vec2(p), z};
                        wall.bounds.add(p);
                    }
                }
                const Drawn picture = drawn(walls.scene, small_picture({8, 6}));
                for (const vec3 seen : picture.picture.pixels())
                    ASSERT_EQ(seen, vec3(0, 1, 0))
                        << "a green wall at " << distance << ", a red one " << farther_by
                        << " times as far away, near plane at " << near;
            }
}

TEST(SceneFiles, HardCase_NothingIsDrawnBeyondTheFarPlaneOfAFilesCamera) {
    look_up("The camera of a file, and lesson 04, Eq. 4.8");
    // The camera is 10 in front of z = 0.
    for (const float far : {6.0f, 9.99f, 10.01f, 11.99f, 12.01f}) {
        Squares squares;
        squares.add(0, vec3(0, 1, 0));
        squares.add(-2, vec3(1, 0, 0));
        squares.add_glass(1, vec3(0, 0, 1), 0.5f);
        squares.scene.cameras[0].far = far;
        lesson_11::Options options = small_picture({8, 6});
        const Drawn scene = drawn(squares.scene, options);
        vec3 behind = backdrop_color(3, 6);
        if (far > 10) behind = vec3(0, 1, 0);
        const vec3 expected = far > 9 ? over(vec3(0, 0, 1), 0.5f, behind) : behind;
        EXPECT_EQ((scene.picture[{4, 3}]), expected)
            << "blue glass at a distance of 9, a green wall at 10, a red one at 12; zfar " << far;
        options.show_depth = true;
        EXPECT_EQ((drawn(squares.scene, options).picture[{4, 3}]), vec3(far > 10 ? 1.0f : 0.0f))
            << "the depth buffer: black where nothing is, white at the nearest; zfar " << far;
    }
}

TEST(SceneFiles, HardCase_AllEffectsForcedKeepHolesTransparencyAndPaper) {
    look_up("Eq. 11.9");
    // All at the same depth, in each order: the first opaque one stays, and glass is not seen.
    const auto holes = [](Squares& squares) {
        squares.add(0, vec3(0, 1, 0)).alpha = AlphaMode::mask;
        squares.scene.meshes.back().colors = {vec4(1, 1, 1, 0), vec4(1), vec4(1), vec4(1, 1, 1, 0)};
    };
    const auto wall = [](Squares& squares) {
        squares.add(0, vec3(1, 0, 0));
        squares.scene.meshes.back().colors.assign(4, vec4(1, 1, 1, 0.5f));  // of which none counts
    };
    const auto back = [](Squares& squares) {  // seen from behind
        squares.add(0, vec3(0, 0, 1)).two_sided = true;
        for (Triangle& triangle : squares.scene.meshes.back().triangles)
            std::swap(triangle.vertices[1], triangle.vertices[2]);
    };
    const auto glass = [](Squares& squares) { squares.add_glass(0, vec3(1, 1, 0), 0.5f); };
    const auto near_glass = [](Squares& squares) { squares.add_glass(1, vec3(0, 1, 1), 0.25f, 1); };
    const auto comic = [](Squares& squares) {
        squares.add(0.5f, vec3(1), 2).toon =
            ToonMaterial{.outline = ToonMaterial::Outline::world, .outline_width = 0.1f};
    };
    std::vector<void (*)(Squares&)> order = {holes, wall, back, glass, near_glass, comic};
    std::vector<std::size_t> index = {0, 1, 2, 3, 4, 5};
    int cases = 0;
    do {
        Squares squares;
        for (const std::size_t i : index) order[i](squares);
        lesson_11::Options options = small_picture({16, 16});
        const Drawn plain = drawn(squares.scene, options);
        options.shading.all_effects = true;
        const auto in_order = [&] {
            constexpr std::array names = {"holes", "wall",       "back of a wall",
                                          "glass", "near glass", "comic"};
            std::string list;
            for (const std::size_t i : index)
                list += (list.empty() ? "" : ", ") + std::string(names[i]);
            return list;
        };
        ASSERT_TRUE(have_the_same_bits(drawn(squares.scene, options).picture, plain.picture))
            << "with --all-effects, beside without; squares in the order " << in_order();
        ++cases;
    } while (std::next_permutation(index.begin(), index.end()) && cases < 720);
    EXPECT_EQ(cases, 720);
}

TEST(SceneFiles, HardCase_AnyNumberOfThreadsAndAnyOrderGiveTheSameBits) {
    look_up("Eq. 11.9");
    Squares glass;  // panes that cut through each other, and are gathered in each tile's own order
    for (const float tilt : {-1.0f, 0.5f, 1.0f, 0.0f, -0.25f})
        glass.add_glass(0, vec3(0.5f + 0.5f * tilt, 0.25f, 0.5f - 0.5f * tilt), 0.5f, tilt);
    std::vector<Scene> all = {glass.scene};
    for (const char* name : scenes) all.push_back(loaded(name));
    for (const Scene& model : all) {
        lesson_11::Options options = small_picture();
        const SceneAssets assets = make_scene_assets(model, options);
        StepClock clock;
        std::optional<Image<vec3>> expected;
        for (const int threads : {1, 2, 3, 7, 16})
            for (const Split split : {Split::rows, Split::interleaved, Split::tiles}) {
                options.threads.split = split;
                options.threads.tile = 8 + threads;
                ThreadPool pool(threads);
                Image<vec3> picture = lesson_11::render(options, assets, pool, clock);
                if (!expected)
                    expected = std::move(picture);
                else
                    ASSERT_TRUE(have_the_same_bits(picture, *expected))
                        << threads << " threads, " << name_of(split) << ", beside one thread";
                ShuffledPool shuffled(static_cast<std::size_t>(threads), 7);
                ASSERT_TRUE(have_the_same_bits(lesson_11::render(options, assets, shuffled, clock),
                                               *expected))
                    << "tasks in another order, " << name_of(split);
            }
    }
}

TEST(SceneFiles, Eq11_7_HardCase_WhatLiesBehindIsSeenThroughHoles) {
    for (const bool leaf_first : {true, false})
        for (const float opacity : {0.5f, 0.4999f}) {
            Squares squares;
            const auto add_leaf = [&] {
                Material& leaf = squares.add(1, vec3(0, 1, 0));
                leaf.alpha = AlphaMode::mask, leaf.opacity = opacity;
            };
            if (leaf_first) add_leaf();
            squares.add(0, vec3(1, 0, 0));
            if (!leaf_first) add_leaf();
            ASSERT_EQ(middle_of(squares), opacity < 0.5f ? vec3(1, 0, 0) : vec3(0, 1, 0))
                << "a green leaf of opacity " << opacity
                << " and cutoff 0.5 before a red wall; the " << (leaf_first ? "leaf" : "wall")
                << " is drawn first";
        }
    // The opacity is that of material and vertices together.
    Squares squares;
    squares.add(0, vec3(1, 0, 0));
    Material& leaf = squares.add(1, vec3(0, 1, 0));
    leaf.alpha = AlphaMode::mask, leaf.opacity = 0.9f;
    squares.scene.meshes[1].colors.assign(4, vec4(1, 0.5f, 1, 0.5f));
    EXPECT_EQ(middle_of(squares), vec3(1, 0, 0));
    leaf.alpha_cutoff = 0.45f;
    EXPECT_EQ(middle_of(squares), vec3(0, 0.5f, 0)) << "and they are coloured";
    const Drawn picture = drawn(squares.scene, small_picture({8, 8}));
    EXPECT_EQ(picture.count(Counter::alpha_tested_fragments), 64u);
    EXPECT_EQ(picture.count(Counter::colored_fragments), 64u);
    EXPECT_EQ(picture.count(Counter::blended_fragments), 0u);
}

TEST(SceneFiles, Eq11_9_HardCase_IntersectingTransparentSurfacesAreRightInEachPixel) {
    const vec3 red(1, 0, 0), blue(0, 0, 1), white(1);
    for (const bool red_first : {true, false}) {
        Squares squares;
        if (red_first) squares.add_glass(0, red, 0.5f, 0.5f);
        squares.add_glass(0, blue, 0.5f, -0.5f);
        if (!red_first) squares.add_glass(0, red, 0.5f, 0.5f);
        squares.add(-2, white);         // after the glass in the file, and seen through it
        squares.add_glass(-3, red, 1);  // hidden
        const Drawn picture = drawn(squares.scene, small_picture({16, 16}));
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x)  // red is nearer on the left
                ASSERT_EQ((picture.picture[{x, y}]),
                          x < 8 ? vec3(0.75f, 0.25f, 0.5f) : vec3(0.5f, 0.25f, 0.75f))
                    << "pixel (" << x << ", " << y
                    << "): panes of red and blue glass, opacity 0.5, "
                    << "over white; red is nearer for x < 8; " << (red_first ? "red" : "blue")
                    << " comes first in the file";
        EXPECT_EQ(picture.count(Counter::blended_fragments), 512u) << "not what is hidden";
        EXPECT_EQ(picture.count(Counter::fragments_shaded), 768u);
    }
}

TEST(SceneFiles, Eq11_10_HardCase_EqualVertexColorsAreExactEverywhere) {
    Squares squares;
    squares.add(0, vec3(0.7f, 0.3f, 0.9f), 0.8f);
    const Drawn plain = drawn(squares.scene, small_picture({64, 64}));
    squares.scene.meshes[0].colors.assign(4, vec4(1));
    const Drawn white = drawn(squares.scene, small_picture({64, 64}));
    EXPECT_TRUE(have_the_same_bits(white.picture, plain.picture))
        << "with white vertices, beside without vertex colours";
    EXPECT_GT(white.count(Counter::colored_fragments), 1000u);
    squares.scene.meshes[0].colors.assign(4, vec4(0.1f, 0.2f, 0.3f, 1));
    const Drawn tinted = drawn(squares.scene, small_picture({64, 64}));
    for (std::size_t i = 0; i < plain.picture.pixels().size(); ++i)
        ASSERT_EQ(tinted.picture.pixels()[i], plain.picture.pixels()[i] * vec3(0.1f, 0.2f, 0.3f));
    // From black on the left to white on the right, evenly: the camera is far away.
    Squares ramp;
    ramp.add(0, vec3(1));
    ramp.scene.meshes[0].colors = {vec4(0), vec4(1), vec4(1), vec4(0)};
    const Image<vec3> picture = drawn(ramp.scene, small_picture({16, 16})).picture;
    const float half_width = 10 * std::tan(0.075f);  // of what is seen of it
    for (int x = 0; x < 16; ++x) {
        const float place = (static_cast<float>(x) + 0.5f) / 8 - 1;
        // Vertices lie within half a sub-pixel of their place, and the square is 22 pixels wide.
        EXPECT_NEAR((picture[{x, 8}].r), 0.5f + 0.5f * place * half_width, 1.0f / 256 / 20) << x;
    }
}

TEST(SceneFiles, HardCase_EmissionMapsGlowInAllShadingModels) {
    look_up("Eq. 11.3");
    // White on the left and black on the right, over colours that reflect nothing.
    Image<u8vec3> halves({2, 1}, {255, 255, 255});
    halves[{1, 0}] = {0, 0, 0};
    for (const ShadingModel model :
         {ShadingModel::unlit, ShadingModel::phong, ShadingModel::toon}) {
        Squares squares;
        squares.add(0, vec3(0));
        Material& material = squares.scene.materials.back();
        material.illumination = model == ShadingModel::unlit ? 0 : 1;
        if (model == ShadingModel::toon) material.toon = ToonMaterial{.shade = vec3(0)};
        material.emission = {0.5f, 2, 1};
        material.emission_map.file = "halves";
        material.emission_map.embedded =
            std::make_shared<const Bytes>(encode_bmp(halves, "halves"));
        Mesh& mesh = squares.scene.meshes[0];
        mesh.uvs = {{0.25f, 0}, {0.75f, 0}, {0.75f, 1}, {0.25f, 1}};
        for (Triangle& triangle : mesh.triangles)
            for (Vertex& vertex : triangle.vertices) vertex.uv = vertex.position % 4;
        lesson_11::Options options = small_picture({16, 16});
        options.texture.filter = Filter::nearest;
        const Drawn picture = drawn(squares.scene, options);
        EXPECT_EQ((picture.picture[{2, 8}]), material.emission) << static_cast<int>(model);
        EXPECT_EQ((picture.picture[{13, 8}]), vec3(0)) << static_cast<int>(model);
        EXPECT_EQ(picture.count(Counter::texture_samples), 256u);
    }
}

TEST(SceneFiles, Eq11_10_HardCase_ColorsOfAnObjFileAreInterpolatedInLinearLight) {
    const std::filesystem::path folder = fresh_folder("colors"), file = folder / "m.obj";
    std::ofstream(folder / "m.mtl") << "newmtl m\nKd 1 1 1\nillum 0\n";
    // A triangle from red to blue, and to green, of which the file has 188 of 255.
    std::ofstream(file) << "mtllib m.mtl\nusemtl m\nv -1 -1 0 1 0 0\nv 1 -1 0 0 0.7372549 0\n"
                           "v 1 1 0 0 0 1\nv -1 1 0 1 1 1\nf 1 2 3\nf 1 3 4\n";
    lesson_11::Options options = small_picture({65, 65});
    options.orbit.yaw_degrees = options.orbit.pitch_degrees = 0;
    const Image<vec3> picture = drawn(load_obj(file), options).picture;
    const double green = std::pow((188 / 255.0 + 0.055) / 1.055, 2.4);
    const double half_side = std::sqrt(2.0) * double{options.orbit.distance} *
                             std::tan(double{options.orbit.fov_degrees} / 360 * std::acos(-1.0));
    constexpr double tolerance = 1e-3;  // vertices lie within half a sub-pixel of their place
    for (int row = 0; row < 65; ++row)
        for (int column = 0; column < 65; ++column) {
            const double x = half_side * ((column + 0.5) / 32.5 - 1);
            const double y = half_side * (1 - (row + 0.5) / 32.5);
            if (y > x || x > 1 || y < -1) continue;
            const dvec3 right((1 - x) / 2, green * (x - y) / 2, (1 + y) / 2);
            ASSERT_LT(glm::distance(dvec3(picture[{column, row}]), right), tolerance)
                << "in column " << column << ", row " << row;
        }
}

TEST(SceneFiles, HardCase_OnlyTwoSidedMaterialsShowTheirBackFaces) {
    look_up("Eq. 11.9");
    for (const bool is_transparent : {false, true})
        for (const bool two_sided : {false, true}) {
            Squares squares;
            Material& square = squares.add(0, vec3(1, 0, 0));
            square.two_sided = two_sided;
            if (is_transparent) square.alpha = AlphaMode::blend;
            for (Triangle& triangle : squares.scene.meshes[0].triangles)
                std::swap(triangle.vertices[1], triangle.vertices[2]);
            EXPECT_EQ(middle_of(squares) == vec3(1, 0, 0), two_sided);
        }
}

TEST(SceneFiles, HardCase_OutlinesAreOneSidedWhateverIsForced) {
    look_up("Eq. 11.6");
    lesson_11::Options options = small_picture();
    const Image<vec3> one_sided = drawn(loaded("toon.glb"), options).picture;
    options.shading.two_sided = true;
    EXPECT_TRUE(have_the_same_bits(drawn(loaded("toon.glb"), options).picture, one_sided))
        << "its parts are closed, so their backs are not seen; outlines' backs would hide them";
}

TEST(SceneFiles, HardCase_EmptyScenesAreTheBackdrop) {
    look_up("Eq. 11.3");
    Scene empty;
    empty.materials.resize(1);
    for (const bool all_effects : {false, true}) {
        lesson_11::Options options = small_picture();
        options.shading.all_effects = all_effects;
        EXPECT_TRUE(is_backdrop(drawn(empty, options).picture));
        EXPECT_EQ(drawn({}, options).count(Counter::shadow_passes), 0u);
    }
}

TEST(SceneFiles, HardCase_TransparentMaterialsCastNoShadow) {
    look_up("Eq. 11.8");
    for (const bool is_transparent : {false, true}) {
        Squares squares;
        squares.add(0, vec3(1)).illumination = 1;
        Material& above = squares.add(1, vec3(1));
        above.illumination = 1;
        if (is_transparent) above.alpha = AlphaMode::blend, above.opacity = 0.5f;
        squares.scene.lights = {{"sun", SceneLight::Kind::directional, vec3(3), vec3(0),
                                 vec3(0, 0, -1), std::numeric_limits<float>::infinity()}};
        EXPECT_EQ(drawn(squares.scene, small_picture()).count(Counter::shadow_fragments) > 0, true);
        EXPECT_EQ(casts_shadows(squares.scene.materials[2]), !is_transparent);
        EXPECT_TRUE(casts_shadows(squares.scene.materials[1]));
    }
}

TEST(SceneFiles, HardCase_FilesWithoutCamerasAreFittedIntoThePicture) {
    look_up("Eq. 11.11");
    Scene scene = loaded("toon.glb");
    const auto name_of = [&](const lesson_11::Options& options) {
        return camera_of_picture(options, scene).name;
    };
    lesson_11::Options options = small_picture();
    EXPECT_EQ(name_of(options), "0 \"front\" of the file");
    scene.cameras.clear();
    EXPECT_EQ(name_of(options), "the lesson's own, so far away that all is seen");
    // Nothing of it touches the picture's border, and it is large enough.
    const Image<vec3> picture = drawn(scene, options).picture;
    const ivec2 size = picture.size();
    int inked = 0;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const bool is_paper = picture[{x, y}] == paper_color;
            inked += !is_paper;
            if (x == 0 || y == 0 || x == size.x - 1 || y == size.y - 1) {
                EXPECT_TRUE(is_paper) << x << " " << y;
            }
        }
    EXPECT_GT(inked, size.x * size.y / 10);
    options.scene.camera = "orbit";
    EXPECT_EQ(name_of(options), "the lesson's own, around the scene");
    options.scene.camera = "", options.orbit.yaw_degrees = 0;
    EXPECT_EQ(name_of(options), "the lesson's own, around the scene");
    scene = loaded("figure.obj");
    options.orbit = Orbit();
    EXPECT_EQ(name_of(options), "the lesson's own, around the scene") << "as in earlier lessons";
    options.scene.camera = "fit";
    EXPECT_EQ(name_of(options), "the lesson's own, so far away that all is seen");
}

TEST(SceneFiles, HardCase_UnsupportedFeaturesAreNamed) {
    look_up("Eq. 11.1");
    Squares squares;
    squares.add(0, vec3(1)).opacity_map.file = "holes.png";
    const Scene scene = make_scene_assets(squares.scene, small_picture()).scene;
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("\"square 1\": map_d"), std::string::npos);
    const ProcessResult wrong =
        run_program("11_scenes", {"--model", "toon.glb", "--camera", "side", "--size", "32x18",
                                  "--out", (fresh_folder("no_camera") / "a.png").string()});
    EXPECT_EQ(wrong.exit_status, 1);
    EXPECT_EQ(
        wrong.err,
        "error: there is no camera 'side'; the file has 0 \"front\"; or --camera orbit|fit\n");
}

TEST(SceneFiles, HardCase_InvalidNumbersAreAnErrorInOneLine) {
    look_up("Eq. 11.1");
    const auto folder = fresh_folder("not_numbers");
    std::ofstream(folder / "bad.obj") << "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n";
    const auto run = [&](const char* file) {
        return run_program("11_scenes", {"--model", (folder / file).string(), "--size", "32x18",
                                         "--out", (folder / "a.png").string()});
    };
    const ProcessResult obj = run("bad.obj");
    EXPECT_EQ(obj.exit_status, 1);
    EXPECT_EQ(std::ranges::count(obj.err, '\n'), 1) << obj.err;
    EXPECT_NE(obj.err.find("bad.obj:2: "), std::string::npos) << obj.err;
    std::ofstream(folder / "bad.gltf")
        << R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": [1e300, 0, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3"}]})";
    const ProcessResult gltf = run("bad.gltf");
    EXPECT_EQ(gltf.exit_status, 1);
    EXPECT_EQ(std::ranges::count(gltf.err, '\n'), 1) << gltf.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
}

TEST(SceneFiles, HardCase_TheFinalRendererDrawsLesson10sPicture) {
    look_up("Eq. 11.3");
    std::vector<lesson_11::Options> all_options(6, small_picture());
    all_options[1].shading.key_light = LightKind::point;
    all_options[2].shading.key_light = LightKind::spot, all_options[2].shading.two_sided = true;
    all_options[3].texture.filter = Filter::nearest, all_options[3].shadow.pcf = 7;
    all_options[4].normal_map.space = MapSpace::none, all_options[4].orbit.distance = 0.15f;
    all_options[5].show_depth = true;
    for (const char* name : {"scene_bumpy.obj", "crate_bump.obj", "teapot.obj"})
        for (std::size_t k = 0; k < all_options.size(); ++k) {
            const lesson_11::Options& options = all_options[k];
            lesson_10::Options same;
            static_cast<LessonOptions&>(same) = options;
            same.orbit = options.orbit, same.show_depth = options.show_depth;
            same.texture = options.texture, same.shading = options.shading;
            same.normal_map = options.normal_map, same.shadow = options.shadow;
            ThreadPool pool(2);
            const CountedSince begin;
            const Image<vec3> expected =
                lesson_10::render(same, lesson_10::make_assets(loaded(name), same), pool);
            const Counters counters = begin;
            const Drawn actual = drawn(loaded(name), options);
            constexpr std::array names_of_options = {"no option",
                                                     "--light point",
                                                     "--light spot, back faces",
                                                     "--filter nearest --pcf 7",
                                                     "--normal-map none --distance 0.15",
                                                     "--depth"};
            ASSERT_TRUE(have_the_same_bits(actual.picture, expected))
                << name << " with " << names_of_options[k] << ", beside lesson 10";
            ASSERT_EQ(actual.counters.values, counters.values)
                << "counters of " << name << " with " << names_of_options[k]
                << ", beside lesson 10";
        }
}

TEST(SceneFiles, Eq11_5_HardCase_AToonMaterialHasTwoColors) {
    for (const float toward_eye : {1.0f, -1.0f}) {
        Squares squares;
        Material& paint = squares.add(0, vec3(0.75f, 0.5f, 0.25f));
        paint.illumination = 1, paint.emission = vec3(0.125f);
        paint.toon = ToonMaterial{.shade = vec3(0.25f, 0.125f, 0.5f)};
        squares.scene.lights = {{"sun", SceneLight::Kind::directional, vec3(9), vec3(0),
                                 vec3(0, 0, -toward_eye), std::numeric_limits<float>::infinity()}};
        // With a level of 0 or 1, and eighths, no step is rounded.
        ASSERT_EQ(middle_of(squares),
                  toward_eye > 0 ? vec3(0.875f, 0.625f, 0.375f) : vec3(0.375f, 0.25f, 0.625f))
            << "a square of (0.75, 0.5, 0.25), in the shade (0.25, 0.125, 0.5), that emits 0.125; "
            << "the sun shines from " << (toward_eye > 0 ? "the front" : "behind");
    }
}

TEST(SceneFiles, HardCase_ThePlanIsExplained) {
    look_up("Eq. 11.3");
    const std::string file = (fresh_folder("explained") / "a.png").string();
    const ProcessResult run =
        run_program("11_scenes", {"--model", "bumpy.glb", "--explain", "--size", "64x36",
                                  "--shadow-size", "64", "--out", file});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    for (const char* line :
         {"camera: 0 \"front\" of the file\n", "light: sun, a directional light\n",
          "light: lamp, a spotlight\n", "  copper: light, highlight, texture, normal map, shadow\n",
          "  tea: light, highlight, shadow\n", "normal map (names none)", "mask, blend (opaque)",
          "  toon_fragments: 0\n", "  shadow_passes: 2\n",
          "  shadow maps: ", "  triangles: ", "  picture: "})
        EXPECT_NE(run.out.find(line), std::string::npos) << line << "\n" << run.out;
    const ProcessResult of_glass =
        run_program("11_scenes", {"--model", "workshop.glb", "--explain", "--size", "64x36",
                                  "--shadow-size", "64", "--out", file});
    EXPECT_NE(of_glass.out.find("mask (no holes)"), std::string::npos) << of_glass.out;
}

TEST(SceneFiles, HardCase_ExplainNamesLightsWhereTheyAreCalledFor) {
    look_up("Eq. 11.12");
    SceneLights lit_by;
    lit_by.lights = {Light{LightKind::directional}, Light{LightKind::spot}};
    lit_by.names = {"sun", ""};
    lit_by.casts = {true, false};
    lit_by.exposure = 0.125f;
    ScenePlan plan{std::vector<MaterialPlan>(1)};
    plan.materials[0].is_seen = true;
    EXPECT_EQ(lights_in_words(lit_by, plan), std::vector<std::string>{"none is called for"});
    plan.materials[0].set(Effect::toon, true, "");
    EXPECT_EQ(lights_in_words(lit_by, plan),
              (std::vector<std::string>{"sun, a directional light",
                                        "unnamed, a spotlight, casts no shadow",
                                        "taken down by 8, so that the brightest is white"}));
}

TEST(SceneFiles, HardCase_QualitySetsWhatNoOtherOptionSets) {
    look_up("Eq. 11.3");
    const auto folder = fresh_folder("quality");
    const auto bytes_of = [&](std::vector<std::string> arguments) {
        const std::string file = (folder / "a.bmp").string();
        arguments.insert(arguments.end(),
                         {"--model", "textured.gltf", "--size", "64x36", "--out", file});
        EXPECT_EQ(run_program("11_scenes", arguments).exit_status, 0);
        return read_text(file);
    };
    const std::string balanced_bytes = bytes_of({});
    EXPECT_EQ(bytes_of({"--quality", "balanced"}), balanced_bytes);
    const std::string fast_bytes = bytes_of({"--quality", "fast"});
    EXPECT_NE(fast_bytes, balanced_bytes);
    EXPECT_EQ(fast_bytes, bytes_of({"--filter", "bilinear", "--shadow-size", "1024"}));
    EXPECT_EQ(bytes_of({"--filter", "trilinear", "--pcf", "1", "--quality", "fast"}),
              bytes_of({"--shadow-size", "1024", "--pcf", "1"}))
        << "in whatever order they are given";
    EXPECT_EQ(bytes_of({"--quality", "exact"}),
              bytes_of({"--shadow-size", "4096", "--samples", "16"}));
}

TEST(SceneFiles, PictureOfNormalMapsInALowSun) {
    EXPECT_TRUE(equals_golden("11_scenes", "11_scenes"));
}

TEST(SceneFiles, PictureOfBakedLight) {
    EXPECT_TRUE(equals_golden("11_scenes", "11_scenes_unlit", {"--model", "unlit.glb"}));
}

TEST(SceneFiles, PictureOfCrates) {
    EXPECT_TRUE(equals_golden("11_scenes", "11_scenes_textured", {"--model", "textured.gltf"}));
}

TEST(SceneFiles, PictureOfARobot) {
    EXPECT_TRUE(
        equals_golden("11_scenes", "11_scenes_toon", {"--model", "toon.glb", "--samples", "4"}));
}
