// SPDX-License-Identifier: MIT
// An effect that a scene does not call for costs no work, and would change nothing.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/image/bmp.hpp"
#include "support/first_difference.hpp"
#include "support/lesson_06.hpp"
#include "support/lesson_07.hpp"
#include "support/lesson_08.hpp"
#include "support/lesson_09.hpp"
#include "support/lesson_12.hpp"
#include "support/lessons_13_and_14.hpp"
#include "support/pictures.hpp"
#include "support/squares.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// The scene with a change of all of its materials.
template <typename Change>
Scene with_materials(Scene scene, const Change& change) {
    for (Material& material : scene.materials) change(material);
    return scene;
}

template <typename Options>
Options small(Options options) {
    options.size = {320, 180};
    return options;
}

Drawn drawn_scene(const Scene& scene, const lesson_06::Options& options) {
    return drawn(options, lesson_06::make_assets(scene, options),
                 [](auto&... arguments) { return lesson_06::render(arguments...); });
}

Drawn drawn_scene(const Scene& scene, const lesson_07::Options& options) {
    return drawn(options, lesson_07::make_assets(scene, options),
                 [](auto&... arguments) { return lesson_07::render(arguments...); });
}

Drawn drawn_scene(const Scene& scene, const lesson_08::Options& options) {
    return drawn(options, lesson_08::make_assets(scene, options),
                 [](auto&... arguments) { return lesson_08::render(arguments...); });
}

Drawn drawn_scene(const Scene& scene, const lesson_09::Options& options) {
    return drawn(options, lesson_09::make_assets(scene, options),
                 [](auto&... arguments) { return lesson_09::render(arguments...); });
}

/// Lesson 14, of which lessons 12 and 13 take what they know.
lesson_14::Options small_scene() {
    lesson_14::Options options = small(lesson_14::Options());
    options.size = {240, 240}, options.shadow.size = 256, options.threads.tile = 32;
    return options;
}

Drawn drawn_scene(const Scene& scene, const lesson_12::Options& options) {
    ThreadPool pool(2);
    StepClock clock;
    return drawn(
        options, load_planned_scene(scene, options),
        [&](const auto& of, const auto& with) { return lesson_12::render(of, with, pool, clock); });
}

/// Calls check(drawn) for a scene as lessons 12 and 13 draw it, and lesson 14 in each width.
template <typename Check>
void for_each_lesson(const Scene& scene, const Check& check) {
    lesson_14::Options options = small_scene();
    const PlannedScene assets = load_planned_scene(scene, options);
    ThreadPool pool(2);
    const Drawn by_11 = drawn_scene(scene, lesson_12::Options(options));
    const auto checked = [&](const std::string& lesson, const Drawn& one) {
        SCOPED_TRACE("lesson " + lesson);
        check(one);
        EXPECT_TRUE(have_the_same_bits(one.picture, by_11.picture)) << "as lesson 12 draws it";
    };
    checked("11", by_11);
    checked("12", drawn_by_13(options, assets, pool));
    for (const int width : {1, 4, 8, 16}) {
        options.wide.width = width;
        checked("13 of width " + std::to_string(width), drawn_by_14(options, assets, pool));
    }
}

/// A texture of two texels.
TextureMap texture_of(u8vec3 left, u8vec3 right) {
    Image<u8vec3> image({2, 1});
    image[{0, 0}] = left, image[{1, 0}] = right;
    TextureMap map;
    map.file = "two texels";
    map.embedded = std::make_shared<const Bytes>(encode_bmp(image, map.file));
    return map;
}

/// A white square that is black without light.
Squares lit_square(const SceneLight& light) {
    Squares squares;
    Material& white = squares.add(0, vec3(1));
    white.illumination = 1, white.ambient = vec3(0);
    squares.scene.lights = {light};
    squares.scene.is_gltf = true;
    return squares;
}

SceneLight spotlight(vec3 position, vec3 direction, float angle_degrees) {
    const float outer = std::cos(glm::radians(angle_degrees));
    SceneLight light{"spot", SceneLight::Kind::spot, vec3(3), position, direction, 100};
    light.cos_outer = outer, light.cos_inner = 0.5f * (1 + outer);
    return light;
}

/// A scene that does not call for an effect takes no work for it, and keeps its bits where the
/// effect is forced, with inputs that change nothing.
///
/// @param work     Of the effect; all of it is done where it is forced.
/// @param changes  What it would find to do; nothing where it is neutral.
void expect_no_work(const char* effect, const Drawn& as_called_for, const Drawn& forced,
                    const std::vector<Counter>& work, const std::vector<Counter>& changes = {}) {
    SCOPED_TRACE(effect);
    EXPECT_GT(as_called_for.count(Counter::fragments_shaded), 5000u);
    const auto expect_none = [](const Drawn& drawn, Counter counter) {
        EXPECT_EQ(drawn.count(counter), 0u) << counter_names[static_cast<std::size_t>(counter)];
    };
    for (const Counter counter : work) {
        expect_none(as_called_for, counter);
        EXPECT_GT(forced.count(counter), 0u) << "else this could not fail";
    }
    for (const Counter counter : changes)
        expect_none(as_called_for, counter), expect_none(forced, counter);
    EXPECT_TRUE(have_the_same_bits(forced.picture, as_called_for.picture));
}

/// Forced as the lessons do it themselves.
template <typename Options>
void expect_no_work(const char* effect, const Scene& scene, Options options,
                    const std::vector<Counter>& work, const std::vector<Counter>& changes = {}) {
    const Drawn as_called_for = drawn_scene(scene, options);
    options.shading.all_effects = true;
    expect_no_work(effect, as_called_for, drawn_scene(scene, options), work, changes);
}

}  // namespace

TEST(Effects, ThatAreNotCalledForTakeNoWorkAndWouldChangeNothing) {
    using enum Counter;
    // The crate is of illum 1. Forced: a highlight whose colour is black.
    expect_no_work("highlight", loaded("crate.obj"), small(lesson_06::Options()), {highlights});

    // The teapot's materials name no texture. Forced: white ones.
    expect_no_work("texture", loaded("teapot.obj"), small(lesson_06::Options()), {texture_samples});

    // No material of lesson 06's scene has a normal map. Forced: flat ones.
    expect_no_work("normal map", loaded("scene.obj"), small(lesson_08::Options()),
                   {normal_map_samples, meshes_with_tangents});

    // Every material lets light through: none casts a shadow. Forced: empty shadow maps.
    lesson_09::Options shadowed = small(lesson_09::Options());
    shadowed.shadow.size = 256;
    const Scene clear = with_materials(loaded("scene.obj"), [](Material& m) { m.opacity = 0.5f; });
    expect_no_work("shadow", clear, shadowed, {shadow_passes, shadow_tests}, {shadow_fragments});

    // Unlit materials have their colour and no tones. Forced: lit ones that reflect nothing and
    // emit that colour.
    lesson_07::Options comic = small(lesson_07::Options());
    comic.shading.outline = Outline::none;
    const Scene figure = loaded("figure.obj");
    const Scene unlit = with_materials(figure, [](Material& m) { m.illumination = 0; });
    const Scene glowing = with_materials(figure, [](Material& m) {
        m.illumination = 1, m.emission += m.diffuse, m.diffuse = m.ambient = vec3(0);
    });
    expect_no_work("toon", drawn_scene(unlit, comic), drawn_scene(glowing, comic),
                   {toon_fragments});

    // An option calls for an outline, not the scene. Forced: outlines of width 0, or below a facing
    // ratio of 0.
    for (const auto& [name, outline] : {std::pair{"outline by facing", Outline::facing},
                                        {"outline by hull", Outline::hull},
                                        {"outline by edges", Outline::edges}}) {
        lesson_07::Options inked = comic;
        inked.shading.outline = outline;
        inked.shading.outline_width_px = inked.shading.min_facing = 0;
        expect_no_work(name, drawn_scene(figure, comic), drawn_scene(figure, inked),
                       {outline_tests}, {outline_pixels});
    }

    // A material without holes takes no alpha test, neither in the picture nor in a shadow map.
    // Forced: a cutoff that all of it passes.
    const Scene solid = loaded("textured.gltf");
    const Scene masked =
        with_materials(solid, [](Material& m) { m.alpha = AlphaMode::mask, m.alpha_cutoff = 0; });
    const lesson_12::Options options(small_scene());
    expect_no_work("holes", drawn_scene(solid, options), drawn_scene(masked, options),
                   {alpha_tested_fragments, alpha_tested_texels});
}

TEST(Effects, AShadowTestIsMadeOnlyWhereALightCounts) {
    // The square is black in each pixel where no light counts: outside of a spotlight's cone, and
    // where a normal map turns it away from the sun.
    const SceneLight spot = spotlight({0.2f, 0.1f, 2}, {0, 0, -1}, 18);
    const SceneLight sun{"sun", SceneLight::Kind::directional, vec3(3), {}, {-0.8f, 0, -0.6f}, 100};
    for (const bool is_toon : {false, true})
        for (const SceneLight& light : {spot, sun}) {
            SCOPED_TRACE(light.name + (is_toon ? ", toon" : ", Phong"));
            Squares squares = lit_square(light);
            Material& white = squares.scene.materials.back();
            if (light.name == "sun") white.normal_map = texture_of({250, 128, 160}, {5, 128, 160});
            if (is_toon) white.toon = ToonMaterial{.shade = vec3(0), .toony = 0.9f};
            for_each_lesson(squares.scene, [&](const Drawn& drawn) {
                const auto lit = static_cast<std::uint64_t>(std::ranges::count_if(
                    drawn.picture.pixels(), [](vec3 c) { return c != vec3(0); }));
                EXPECT_EQ(drawn.count(Counter::shadow_tests), lit) << "pixels that are not black";
                EXPECT_GT(lit, 5000u);
                EXPECT_LT(lit, 50'000u) << "of 57,600: else this could not fail";
            });
        }
}

TEST(Effects, AlphaAndColorAreOneSampleOfTheTexture) {
    for (const AlphaMode alpha : {AlphaMode::opaque, AlphaMode::mask, AlphaMode::blend}) {
        SCOPED_TRACE(static_cast<int>(alpha));
        Squares squares;
        Material& square = squares.add(0, vec3(0.8f));
        square.alpha = alpha, square.opacity = alpha == AlphaMode::blend ? 0.7f : 1;
        square.diffuse_map = texture_of({200, 100, 50}, {20, 220, 90});
        squares.scene.meshes.back().colors = {vec4(1, 1, 1, 0), vec4(1), vec4(1), vec4(1, 1, 1, 0)};
        for_each_lesson(squares.scene, [&](const Drawn& drawn) {
            EXPECT_EQ(drawn.count(Counter::texture_samples), 57'600u) << "one for each pixel";
            EXPECT_EQ(drawn.count(Counter::fragments_shaded),
                      alpha == AlphaMode::mask ? 28'800u : 57'600u);
        });
    }
}

TEST(Effects, ASpotlightHasMapsOnlyInFacesThatItsConeReaches) {
    // In a room around the light, each face of the cube sees casters and receivers.
    const auto passes = [](vec3 direction, float angle_degrees) {
        Squares room;
        for (int side = 0; side < 6; ++side) {
            std::vector<vec3> corners = {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
            for (vec3& p : corners) {
                for (int turn = 0; turn < side / 2; ++turn) p = {p.z, p.x, p.y};
                if (side % 2) p = -p;
            }
            room.add(mesh_of(corners, {{0, 1, 2}, {0, 2, 3}}), vec3(1)).illumination = 1;
        }
        room.scene.lights = {spotlight(vec3(0), glm::normalize(direction), angle_degrees)};
        return drawn_scene(room.scene, lesson_12::Options(small_scene()))
            .count(Counter::shadow_passes);
    };
    EXPECT_EQ(passes({1, 0, 0}, 80), 5u) << "all but the face behind";
    EXPECT_EQ(passes({0, -1, 0}, 89), 5u);
    EXPECT_EQ(passes({1, 1, 0}, 80), 4u) << "(-1, 1, 1), of the face -x, is 90 degrees away";
    EXPECT_EQ(passes({1, 1, 1}, 80), 6u) << "(-1, 1, 1), of the face -x, is 70.5 degrees away";
}
