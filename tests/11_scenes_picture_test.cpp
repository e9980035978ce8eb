// SPDX-License-Identifier: MIT
// Pictures of scenes: cameras, lights, holes and glass.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "10_threading/thread_pool.hpp"
#include "11_scenes/camera_choice.hpp"
#include "11_scenes/scene_assets.hpp"
#include "11_scenes/scene_camera.hpp"
#include "common/image/backdrop.hpp"
#include "common/image/bmp.hpp"
#include "common/image/input_error.hpp"
#include "support/any_scene.hpp"
#include "support/first_difference.hpp"
#include "support/golden.hpp"
#include "support/lesson_10.hpp"
#include "support/lesson_11.hpp"
#include "support/lesson_process.hpp"
#include "support/look_up.hpp"
#include "support/name_of_split.hpp"
#include "support/one_triangle.hpp"
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
    return test::drawn(options, load_scene_assets(std::move(scene), options),
                       [](const auto& of, const auto& assets) {
                           ThreadPool pool(2);
                           return lesson_11::render(of, assets, pool);
                       });
}

vec3 middle_of(const Squares& squares) {
    return drawn(squares.scene, small_picture({8, 8})).picture[{5, 3}];
}

SceneLight sun_along(vec3 direction, float lux) {
    return {"sun",     SceneLight::Kind::directional,         vec3(lux), vec3(0),
            direction, std::numeric_limits<float>::infinity()};
}

/// A leaf of side 2 at z = 1 before a wall, and a light. Its texture has holes in squares.
struct Leaf {
    int texels;                ///< A side of the texture.
    std::vector<float> alpha;  ///< Of each texel, row by row from the top.
    vec2 uv_first, uv_step;    ///< At the lower left corner, and what they grow by to the other.
    float opacity, vertex_alpha, cutoff;
    SceneLight light;

    /// Whether it is there at a point of its plane.
    bool is_there(vec2 at) const {
        if (glm::any(glm::greaterThanEqual(glm::abs(at), vec2(1)))) return false;
        const vec2 uv = glm::fract(uv_first + uv_step * (at + 1.0f) / 2.0f);
        const ivec2 texel = glm::min(ivec2(uv * static_cast<float>(texels)), texels - 1);
        const auto number = static_cast<std::size_t>((texels - 1 - texel.y) * texels + texel.x);
        return opacity * vertex_alpha * alpha[number] >= cutoff;
    }
};

Leaf any_leaf(Dice& dice) {
    Leaf leaf{.texels = 2 + static_cast<int>(dice.below(4))};
    for (int i = 0; i < leaf.texels * leaf.texels; ++i)
        leaf.alpha.push_back(dice.one_in(2) ? 1 : dice.between(0, 0.6f));
    leaf.uv_first = {dice.between(-3, 3), dice.between(-3, 3)};
    leaf.uv_step = {dice.between(0.5f, 1.6f) * (dice.one_in(2) ? 1 : -1), dice.between(0.5f, 1.6f)};
    leaf.opacity = dice.one_in(2) ? 1 : dice.between(0.7f, 1);
    leaf.vertex_alpha = dice.one_in(2) ? 1 : dice.between(0.7f, 1);
    leaf.cutoff = dice.between(0.2f, 0.8f);
    constexpr std::array kinds = {SceneLight::Kind::directional, SceneLight::Kind::point,
                                  SceneLight::Kind::spot};
    const vec3 position(dice.between(-1, 1), dice.between(-1, 1), dice.between(3, 5));
    leaf.light = {"light",  kinds.at(dice.below(3)),   vec3(9),
                  position, -glm::normalize(position), 100};
    return leaf;
}

constexpr float camera_height = 0.95f;  // of a camera between leaf and wall

SceneAssets assets_of(const Leaf& leaf, const lesson_11::Options& options) {
    Squares squares;
    Material& wall = squares.add(
        mesh_of({{-6, -6, 0}, {6, -6, 0}, {6, 6, 0}, {-6, 6, 0}}, {{0, 1, 2}, {0, 2, 3}}), vec3(1));
    wall.illumination = 1, wall.ambient = vec3(0);
    Material& material = squares.add(1, vec3(1));
    material.alpha = AlphaMode::mask, material.alpha_cutoff = leaf.cutoff;
    material.opacity = leaf.opacity, material.two_sided = true, material.illumination = 1;
    material.diffuse_map.file = "takes the place of the leaf's texture";
    material.diffuse_map.embedded =
        std::make_shared<const Bytes>(encode_bmp(Image<u8vec3>({1, 1}), "a texel"));
    Mesh& mesh = squares.scene.meshes.back();
    for (auto& uv : mesh.uvs) uv = leaf.uv_first + vec2(uv) * leaf.uv_step;
    mesh.colors.assign(4, vec4(1, 1, 1, leaf.vertex_alpha));
    squares.scene.lights = {leaf.light}, squares.scene.is_gltf = true;
    squares.scene.cameras = {{"c", translation(vec3(0, 0, camera_height)), 2, 0.05f, 100}};
    SceneAssets assets = load_scene_assets(squares.scene, options);
    Image<vec4> picture(ivec2(leaf.texels));
    for (std::size_t i = 0; i < leaf.alpha.size(); ++i)
        picture.pixels()[i] = vec4(vec3(1), leaf.alpha[i]);
    assets.textures.diffuse[2] =
        std::make_shared<const Texture>(make_texture(std::move(picture), Wrap::repeat));
    return assets;
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
    const SceneAssets assets = load_scene_assets(scene, options);
    const std::vector casts(assets.lit_by.casts.begin(), assets.lit_by.casts.begin() + 4);
    EXPECT_EQ(casts, (std::vector{true, true, false, false})) << "two times six maps are there";
    for (const auto& [name, times] :
         std::map<std::string, int>{{"red", 0}, {"green", 0}, {"blue", 1}, {"sun", 1}})
        EXPECT_EQ(
            std::ranges::count(assets.scene.warnings, "light \"" + name +
                                                          "\" casts no shadows: no more than 12 "
                                                          "shadow maps are drawn"),
            times)
            << name;
}

TEST(SceneFiles, HardCase_TooMuchOverdrawIsAnError) {
    look_up("lesson 10: Large triangles and slivers");
    Squares squares;
    for (int i = 0; i < 10; ++i) squares.add(0, vec3(1));
    squares.scene.file = "ten.obj";
    // Ten, and something for their borders; a small picture may have more.
    for (const auto& [size, limit] : {std::pair(ivec2(1024), std::uint64_t{11}), {{512, 256}, 2}}) {
        squares.scene.budget.set(Resource::overdraw, limit);
        EXPECT_NO_THROW(drawn(squares.scene, small_picture(size))) << limit;
    }
    squares.scene.budget.set(Resource::overdraw, 10);
    try {
        drawn(squares.scene, small_picture({1024, 1024}));
        FAIL() << "no error";
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "ten.obj: covers a picture 11 times, more than the 10 that are "
                     "accepted; see --limit overdraw=N");
    }
}

TEST(SceneFiles, HardCase_TheNearerOfTwoWallsIsSeenHoweverNearTheNearPlane) {
    look_up("The camera of a file, and lesson 04, Eq. 4.8");
    // A file's camera without zfar; the farther wall is drawn first.
    for (const float near : {1e-30f, 1e-5f, 0.01f, 1.0f})
        for (const float behind : {0.02f, 1e-4f}) {
            Squares walls;
            walls.add(-behind, vec3(1, 0, 0));
            walls.add(0, vec3(0, 1, 0));
            walls.scene.cameras[0].near = near;
            walls.scene.cameras[0].far = std::numeric_limits<float>::infinity();
            EXPECT_EQ(middle_of(walls), vec3(0, 1, 0))
                << "a green wall at 10, a red one " << behind << " behind, near plane at " << near;
        }
}

TEST(SceneFiles, HardCase_NothingIsDrawnBeyondTheFarPlaneOfAFilesCamera) {
    look_up("The camera of a file, and lesson 04, Eq. 4.8");
    for (const float far : {6.0f, 9.99f, 10.01f, 11.99f, 12.01f}) {
        Squares squares;
        squares.add(0, vec3(0, 1, 0));
        squares.add(-2, vec3(1, 0, 0));
        squares.add_glass(1, vec3(0, 0, 1), 0.5f);
        squares.scene.cameras[0].far = far;
        SCOPED_TRACE("blue glass at a distance of 9, a green wall at 10, a red one at 12; zfar " +
                     std::to_string(far));
        const vec3 behind = far > 10 ? vec3(0, 1, 0) : backdrop_color(3, 8);
        EXPECT_EQ(middle_of(squares), far > 9 ? over(vec3(0, 0, 1), 0.5f, behind) : behind);
        lesson_11::Options options = small_picture({8, 8});
        options.show_depth = true;
        EXPECT_EQ((drawn(squares.scene, options).picture[{5, 3}]), vec3(far > 10 ? 1.0f : 0.0f))
            << "the depth buffer: black where nothing is, white at the nearest";
    }
}

TEST(SceneFiles, HardCase_AnyNumberOfThreadsAndAnyOrderGiveTheSameBits) {
    look_up("Eq. 11.8");
    // Panes that cut through each other, and are gathered in each tile's own order.
    Squares glass;
    for (const float tilt : {-1.0f, 0.5f, 1.0f, 0.0f, -0.25f})
        glass.add_glass(0, vec3(0.5f + 0.5f * tilt, 0.25f, 0.5f - 0.5f * tilt), 0.5f, tilt);
    std::vector<Scene> all = {glass.scene};
    for (const char* name : scenes) all.push_back(loaded(name));
    for (const Scene& model : all) {
        lesson_11::Options options = small_picture();
        const SceneAssets assets = load_scene_assets(model, options);
        ThreadPool one(1);
        const Image<vec3> expected = lesson_11::render(options, assets, one);
        for (const int threads : {1, 2, 3, 7, 16})
            for (const Split split : splits) {
                options.threads.split = split;
                options.threads.tile = 8 + threads;
                ThreadPool pool(threads);
                ShuffledPool shuffled(static_cast<std::size_t>(threads), 7);
                for (Workers* const workers : std::initializer_list<Workers*>{&pool, &shuffled})
                    ASSERT_TRUE(
                        have_the_same_bits(lesson_11::render(options, assets, *workers), expected))
                        << threads << " threads, "
                        << (workers == &pool ? "" : "tasks in another order, ") << name_of(split)
                        << ", beside one thread";
            }
    }
}

TEST(SceneFiles, Eq11_6_HardCase_WhatLiesBehindIsSeenThroughHoles) {
    // The opacity is that of material and vertices together, 0.45; and they are coloured.
    for (const bool leaf_first : {true, false})
        for (const float cutoff : {0.45f, 0.4501f}) {
            Squares squares;
            if (!leaf_first) squares.add(0, vec3(1, 0, 0));
            Material& leaf = squares.add(1, vec3(0, 1, 0));
            leaf.alpha = AlphaMode::mask, leaf.opacity = 0.9f, leaf.alpha_cutoff = cutoff;
            squares.scene.meshes.back().colors.assign(4, vec4(1, 0.5f, 1, 0.5f));
            if (leaf_first) squares.add(0, vec3(1, 0, 0));
            const Drawn picture = drawn(squares.scene, small_picture({8, 8}));
            ASSERT_EQ((picture.picture[{5, 3}]), cutoff > 0.45f ? vec3(1, 0, 0) : vec3(0, 0.5f, 0))
                << "a green leaf of opacity 0.45 and cutoff " << cutoff
                << " before a red wall; the " << (leaf_first ? "leaf" : "wall")
                << " is drawn first";
            EXPECT_EQ(picture.count(Counter::alpha_tested_fragments), 64u);
            EXPECT_EQ(picture.count(Counter::blended_fragments), 0u);
        }
}

TEST(SceneFiles, Eq11_6_HardCase_LightFallsThroughHolesAsRaysDo) {
    constexpr int side = 64;
    int dark = 0, lit = 0;
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        Dice dice(seed);
        const Leaf leaf = any_leaf(dice);
        lesson_11::Options options = small_picture(ivec2(side));
        options.texture.filter = Filter::nearest;
        options.shadow.size = 1024, options.shadow.pcf = 1;
        ThreadPool pool(2);
        const Image<vec3> picture = lesson_11::render(options, assets_of(leaf, options), pool);
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const vec2 ndc = 2.0f * (vec2(x, y) + 0.5f) / static_cast<float>(side) - 1.0f;
                const vec2 on_wall = camera_height * std::tan(1.0f) * vec2(ndc.x, -ndc.y);
                const vec3 toward = leaf.light.kind == SceneLight::Kind::directional
                                        ? -leaf.light.direction_world
                                        : leaf.light.position_world - vec3(on_wall, 0);
                const vec2 at = on_wall + vec2(toward) / toward.z;
                int there = 0;  // of points within 0.06: several texels of any map here
                for (int i = 0; i < 121; ++i)
                    there += leaf.is_there(at + 0.012f * (vec2(i % 11, i / 11) - 5.0f));
                if (there % 121 != 0) continue;  // an edge
                ++(there ? dark : lit);
                ASSERT_EQ((picture[{x, y}] == vec3(0)), there == 121)
                    << "pixel (" << x << ", " << y << ") is black, and the leaf covers the light "
                    << "there; seed " << seed;
            }
    }
    EXPECT_GT(dark, 10'000);
    EXPECT_GT(lit, 50'000);
}

TEST(SceneFiles, Eq11_8_HardCase_IntersectingTransparentSurfacesAreRightInEachPixel) {
    const vec3 red(1, 0, 0), blue(0, 0, 1), white(1);
    for (const bool red_first : {true, false}) {
        Squares squares;
        if (red_first) squares.add_glass(0, red, 0.5f, 0.5f);
        squares.add_glass(0, blue, 0.5f, -0.5f);
        if (!red_first) squares.add_glass(0, red, 0.5f, 0.5f);
        squares.add(-2, white);         // after the glass in the file, and seen through it
        squares.add_glass(-3, red, 1);  // hidden
        const Drawn picture = drawn(squares.scene, small_picture({16, 16}));
        Image<vec3> expected({16, 16});  // red is nearer on the left
        for (ivec2 p(0); p.y < 16; ++p.y)
            for (p.x = 0; p.x < 16; ++p.x)
                expected[p] = p.x < 8 ? vec3(0.75f, 0.25f, 0.5f) : vec3(0.5f, 0.25f, 0.75f);
        EXPECT_TRUE(are_equal(picture.picture, expected))
            << "panes of red and blue glass, opacity 0.5, over white; red is nearer for x < 8; "
            << (red_first ? "red" : "blue") << " comes first in the file";
        EXPECT_EQ(picture.count(Counter::blended_fragments), 512u) << "not what is hidden";
        EXPECT_EQ(picture.count(Counter::fragments_shaded), 768u);
    }
}

TEST(SceneFiles, Eq11_2_HardCase_EqualVertexColorsAreExactEverywhere) {
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

TEST(SceneFiles, HardCase_OnlyTwoSidedMaterialsShowTheirBackFaces) {
    look_up("Eq. 11.8");
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
    look_up("Eq. 7.17");
    lesson_11::Options options = small_picture();
    const Image<vec3> one_sided = drawn(loaded("toon.glb"), options).picture;
    options.shading.two_sided = true;
    EXPECT_TRUE(have_the_same_bits(drawn(loaded("toon.glb"), options).picture, one_sided))
        << "its parts are closed, so their backs are not seen; outlines' backs would hide them";
}

TEST(SceneFiles, HardCase_TransparentMaterialsCastNoShadow) {
    look_up("Eq. 11.7");
    for (const bool is_transparent : {false, true}) {
        Squares squares;
        squares.add_glass(0, vec3(1), 0.5f).illumination = 1;
        Material& front = squares.add(1, vec3(1));
        front.illumination = 1;
        if (is_transparent) front.alpha = AlphaMode::blend, front.opacity = 0.5f;
        squares.scene.lights = {sun_along({0, 0, -1}, 3)};
        EXPECT_EQ(drawn(squares.scene, small_picture()).count(Counter::shadow_fragments) > 0,
                  !is_transparent);
    }
}

TEST(SceneFiles, HardCase_FilesWithoutCamerasAreFittedIntoThePicture) {
    look_up("Eq. 11.1");
    Scene scene = loaded("toon.glb");
    const auto camera_name = [&](const lesson_11::Options& options) {
        return camera_of_picture(options, scene).name;
    };
    lesson_11::Options options = small_picture();
    EXPECT_EQ(camera_name(options), "0 \"front\" of the file");
    scene.cameras.clear();
    EXPECT_EQ(camera_name(options), "the lesson's own, so far away that all is seen");
    Orbit fitted = options.orbit;
    fitted.distance = fitting_distance(fitted, scene.bounds(), options.size);
    EXPECT_EQ(camera_of_picture(options, scene).camera.position_world,
              orbit_camera(fitted, scene.bounds()).position_world);
    options.camera = "orbit";
    EXPECT_EQ(camera_name(options), "the lesson's own, around the scene");
    options.camera = "", options.orbit.yaw_degrees = 0;
    EXPECT_EQ(camera_name(options), "the lesson's own, around the scene");
    scene = loaded("figure.obj");
    options.orbit = Orbit();
    EXPECT_EQ(camera_name(options), "the lesson's own, around the scene")
        << "as in earlier lessons";
    options.camera = "fit";
    EXPECT_EQ(camera_name(options), "the lesson's own, so far away that all is seen");
}

TEST(SceneFiles, HardCase_UnsupportedFeaturesAreNamed) {
    look_up("Eq. 11.3");
    Squares squares;
    squares.add(0, vec3(1)).opacity_map.file = "holes.png";
    const Scene scene = load_scene_assets(squares.scene, small_picture()).scene;
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("\"square 1\": map_d"), std::string::npos);
}

TEST(SceneFiles, HardCase_TheSceneRendererDrawsLesson10sPicture) {
    look_up("Eq. 11.6");
    using Change = void (*)(lesson_11::Options&);
    const std::vector<std::pair<std::string, Change>> changes = {
        {"no option", [](auto&) {}},
        {"--light point", [](auto& o) { o.shading.key_light = LightKind::point; }},
        {"--light spot, back faces",
         [](auto& o) { o.shading.key_light = LightKind::spot, o.shading.two_sided = true; }},
        {"--filter nearest --pcf 7",
         [](auto& o) { o.texture.filter = Filter::nearest, o.shadow.pcf = 7; }},
        {"--normal-map none --distance 0.15",
         [](auto& o) { o.normal_map.space = MapSpace::none, o.orbit.distance = 0.15f; }},
        {"--depth", [](auto& o) { o.show_depth = true; }}};
    for (const char* name : {"scene_bumpy.obj", "crate_bump.obj", "teapot.obj"})
        for (const auto& [words, change] : changes) {
            lesson_11::Options options = small_picture();
            change(options);
            lesson_10::Options same;
            static_cast<LessonOptions&>(same) = options;
            same.orbit = options.orbit, same.show_depth = options.show_depth;
            same.texture = options.texture, same.shading = options.shading;
            same.normal_map = options.normal_map, same.shadow = options.shadow;
            ThreadPool pool(2);
            const Drawn expected =
                test::drawn(same, lesson_10::make_assets(loaded(name), same),
                            [&](const auto&... of) { return lesson_10::render(of..., pool); });
            const Drawn actual = drawn(loaded(name), options);
            SCOPED_TRACE(std::string(name) + " with " + words + ", beside lesson 10");
            ASSERT_TRUE(have_the_same_bits(actual.picture, expected.picture));
            for (std::size_t i = 0; i < counter_names.size(); ++i)
                ASSERT_EQ(actual.counters.values[i], expected.counters.values[i])
                    << counter_names[i];
        }
}

TEST(SceneFiles, HardCase_AToonMaterialHasTwoColors) {
    look_up("lessons/07_toon/toon_materials.md, Eq. 7.16");
    for (const float toward_eye : {1.0f, -1.0f}) {
        Squares squares;
        Material& paint = squares.add(0, vec3(0.75f, 0.5f, 0.25f));
        paint.illumination = 1, paint.emission = vec3(0.125f);
        paint.toon = ToonMaterial{.shade = vec3(0.25f, 0.125f, 0.5f)};
        squares.scene.lights = {sun_along({0, 0, -toward_eye}, 9)};
        // With a level of 0 or 1, and eighths, no step is rounded.
        ASSERT_EQ(middle_of(squares),
                  toward_eye > 0 ? vec3(0.875f, 0.625f, 0.375f) : vec3(0.375f, 0.25f, 0.625f))
            << "a square of (0.75, 0.5, 0.25), in the shade (0.25, 0.125, 0.5), that emits "
               "0.125; "
            << "the sun shines from " << (toward_eye > 0 ? "the front" : "behind");
    }
}

TEST(SceneFiles, HardCase_QualitySetsWhatNoOtherOptionSets) {
    look_up("Eq. 11.6");
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

TEST(SceneFiles, PictureOfLeavesAndGlass) { EXPECT_TRUE(equals_golden("11_scenes", "11_scenes")); }

TEST(SceneFiles, PictureOfNormalMapsInALowSun) {
    EXPECT_TRUE(equals_golden("11_scenes", "12_effects", {"--model", "bumpy.glb"}));
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
