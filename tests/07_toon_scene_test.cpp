// SPDX-License-Identifier: MIT
// Work only for what a scene and its options call for, special numbers as inputs (zeros, subnormal
// numbers, infinities and NaN), and the lesson's pictures.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "support/golden.hpp"
#include "support/lab_07.hpp"
#include "support/look_up.hpp"
#include "support/printers.hpp"
#include "support/special_numbers.hpp"
#include "support/toon_pictures.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

const Scene& figure() {
    static const Scene scene = loaded("figure.obj");
    return scene;
}

/// Three triangles of any vertices and normals, of a material of any numbers.
Scene any_scene(SpecialNumbers& mix, bool is_ordinary_position) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < 9; ++i) {
        mesh.positions.push_back(is_ordinary_position
                                     ? vec3(mix.ordinary(), mix.ordinary(), mix.ordinary())
                                     : mix.place());
        mesh.normals.push_back(mix.any_three());
        mesh.bounds.add(mesh.positions.back());
    }
    for (std::uint32_t i = 0; i < 9; i += 3)
        mesh.triangles.push_back({{Vertex{i, no_index, mix.below(4) == 0 ? no_index : i},
                                   Vertex{i + 1, no_index, i + 1}, Vertex{i + 2, no_index, i + 2}},
                                  0});
    Scene scene = scene_of_one(mesh);
    Material& material = scene.materials[0];
    for (vec3* color :
         {&material.ambient, &material.diffuse, &material.specular, &material.emission})
        *color = glm::clamp(mix.place(), -1e37f, 1e37f);
    material.shininess = std::abs(mix.place().x);
    material.illumination = static_cast<int>(mix.below(3));
    return scene;
}

// Of the 518,400 pixels of a golden picture, so many may lie on the other side of a threshold with
// another C library's sines: a pixel's light is within 1e-7 of one of three thresholds with a
// chance of about 1e-6, and with 16 samples a pixel sixteen times as often.
constexpr std::size_t on_a_threshold = 40;

}  // namespace

TEST(Toon, HardCase_WithoutOutlineThereIsNoWorkForIt) {
    look_up("Eq. 7.14");
    lesson_07::Options options = small_toon();
    const auto with = [&](Outline outline) {
        options.shading.outline = outline;
        return drawn_toon(figure(), options);
    };
    const Drawn none = with(Outline::none), facing = with(Outline::facing),
                hull = with(Outline::hull), edges = with(Outline::edges);
    EXPECT_EQ(none.count(Counter::toon_fragments), none.count(Counter::fragments_lit));
    EXPECT_GT(none.count(Counter::toon_fragments), 5000u);
    EXPECT_EQ(none.count(Counter::outline_tests), 0u);
    EXPECT_EQ(none.count(Counter::outline_pixels), 0u);
    EXPECT_EQ(facing.count(Counter::outline_tests), none.count(Counter::fragments_shaded));
    EXPECT_GT(hull.count(Counter::outline_tests), hull.count(Counter::outline_pixels));
    EXPECT_EQ(edges.count(Counter::outline_tests), 320u * 180);
    // Everything else is done as without an outline.
    for (const Drawn& drawn : {facing, hull, edges}) {
        EXPECT_GT(drawn.count(Counter::outline_pixels), 100u);
        for (const Counter counter :
             {Counter::fragments_tested, Counter::fragments_shaded, Counter::texture_samples,
              Counter::fragments_lit, Counter::highlights, Counter::toon_fragments})
            EXPECT_EQ(drawn.count(counter), none.count(counter));
    }
}

TEST(Toon, HardCase_OutlinesOfNoWidthChangeNothing) {
    look_up("Eq. 7.14");
    lesson_07::Options options = small_toon();
    options.shading.outline = Outline::none;
    const Image<vec3> without = toon_picture(figure(), options);
    options.shading.outline_width_px = 0;
    options.shading.min_facing = 0;
    for (const auto& [outline, name] : {std::pair{Outline::facing, "the facing ratio"},
                                        {Outline::hull, "a hull"},
                                        {Outline::edges, "edges"}}) {
        options.shading.outline = outline;
        const Drawn with = drawn_toon(figure(), options);
        EXPECT_TRUE(are_the_same_bits(with.picture, without))
            << "an outline of no width, by " << name << ", and none";
        EXPECT_GT(with.count(Counter::outline_tests), 2500u);
        EXPECT_EQ(with.count(Counter::outline_pixels), 0u);
    }
}

TEST(Toon, HardCase_EffectsThatAreNotCalledForWouldChangeNothing) {
    look_up("Eq. 7.4");
    for (const char* model : {"figure.obj", "scene.obj", "crate.obj"}) {
        const Scene scene = loaded(model);
        lesson_07::Options options = small_toon();
        const Image<vec3> picture = toon_picture(scene, options);
        options.shading.all_effects = true;
        EXPECT_TRUE(are_the_same_bits(toon_picture(scene, options), picture)) << model;
        EXPECT_FALSE(is_backdrop(picture)) << model;
    }
}

TEST(Toon, HardCase_AFaceInDirectionalLightHasOneTone) {
    look_up("Eq. 7.3");
    Scene scene = scene_of_one(cube_mesh(true));
    scene.materials[0].diffuse = scene.materials[0].ambient = vec3(0.5f);
    const auto colors = [&](int tones, LightKind light) {
        lesson_07::Options options = small_toon();
        options.orbit = {-30, 27, 3, 36};
        options.shading.tones = tones;
        options.shading.key_light = light;
        options.shading.outline = Outline::none;
        const Image<vec3> picture = toon_picture(scene, options);
        std::set<float> reds;
        for (const vec3 color : picture.pixels())
            if (color != paper_color) reds.insert(color.r);
        return reds.size();
    };
    // Three faces in directional light, each of one colour; with a single tone all have the same.
    EXPECT_LE(colors(255, LightKind::directional), 3u);
    EXPECT_GE(colors(255, LightKind::directional), 2u);
    EXPECT_EQ(colors(1, LightKind::point), 1u);
    EXPECT_LE(colors(4, LightKind::point), 4u);
    EXPECT_GT(colors(255, LightKind::point), 20u);
}

TEST(Toon, Eq7_5_HardCase_SmoothBordersAreNearerToManySamples) {
    lesson_07::Options options = small_toon();
    options.shading.outline = Outline::none;
    const Image<vec3> hard = toon_picture(figure(), options);
    lab_07::Options smoothed;
    static_cast<ToonOptions&>(smoothed) = options;
    smoothed.smooth = true;
    const Image<vec3> smooth = lab_07::render(smoothed, load_toon_scene(figure(), options));
    options.size *= 8;
    const Image<vec3> exact = averaged(toon_picture(figure(), options), 8);
    // Where the bodies end nothing is smoothed, so compare inside.
    double off_hard = 0, off_smooth = 0;
    for (ivec2 p(1); p.y + 1 < hard.size().y; ++p.y)
        for (p.x = 1; p.x + 1 < hard.size().x; ++p.x) {
            bool is_inside = true;
            for (int i = 0; i < 9; ++i)
                is_inside &= hard[p + ivec2(i % 3 - 1, i / 3 - 1)] != paper_color;
            if (!is_inside) continue;
            off_hard += glm::dot(hard[p] - exact[p], hard[p] - exact[p]);
            off_smooth += glm::dot(smooth[p] - exact[p], smooth[p] - exact[p]);
        }
    EXPECT_LT(off_smooth, 0.7 * off_hard);
}

TEST(Toon, HardCase_SpecialNumbersOfHulls) {
    look_up("Eq. 7.9");
    SpecialNumbers mix(2);
    for (int i = 0; i < 300'000; ++i) {
        const vec4 position(mix.place(), mix.place().x);
        const vec4 at = pushed(position, vec4(mix.any_three(), mix.any()), 3, {640, 360});
        ASSERT_EQ(at.z, position.z) << "seed 2, case " << i;
        ASSERT_EQ(at.w, position.w) << "seed 2, case " << i;
        if (std::abs(position.w) < 1e37f) { ASSERT_TRUE(is_finite(at)) << "seed 2, case " << i; }
        if (i % 10 != 0) continue;
        Mesh mesh = any_scene(mix, false).meshes[0];
        mesh.positions[mix.below(9)] = mix.any_three();
        mesh.positions[mix.below(9)] = mesh.positions[mix.below(9)];
        for (const vec3 direction : hull_normals(mesh)) {
            const float length = glm::length(direction);
            ASSERT_TRUE(length == 0 || std::abs(length - 1) < 1e-6f) << "seed 2, case " << i;
        }
    }
}

TEST(Toon, HardCase_SpecialNumbersInPictures) {
    look_up("Eq. 7.6");
    SpecialNumbers mix(3);
    int drawn = 0, inked = 0;
    for (int i = 0; i < 3000; ++i) {
        const Scene scene = any_scene(mix, i % 2 == 0);
        lesson_07::Options options;
        options.size = {48, 27};
        options.shading.outline = static_cast<Outline>(mix.below(4));
        options.shading.key_light = static_cast<LightKind>(mix.below(3));
        options.shading.two_sided = mix.below(2) == 0;
        options.shading.tones = 1 + static_cast<int>(mix.below(max_tones));
        options.shading.outline_width_px = mix.below(2) == 0 ? 2.0f : 64.0f;
        const Image<vec3> picture = toon_picture(scene, options);
        for (const vec3 color : picture.pixels())
            ASSERT_TRUE(is_finite(color)) << "seed 3, case " << i;
        const Image<Seen> seen = seen_in(picture);
        drawn += count_of(seen, Seen::body) > 0;
        inked += count_of(seen, Seen::ink) > 0;
    }
    EXPECT_GT(drawn, 1000);
    EXPECT_GT(inked, 500);
}

TEST(Toon, PictureOfTheFigure) {
    EXPECT_TRUE(equals_golden("07_toon", "07_toon", {"--samples", "16"}, on_a_threshold));
}

TEST(Toon, PictureOfTheFacingOutline) {
    EXPECT_TRUE(equals_golden("07_toon", "07_toon_facing",
                              {"--outline", "facing", "--samples", "16"}, on_a_threshold));
}

TEST(Toon, PictureOfTheHull) {
    EXPECT_TRUE(equals_golden("07_toon", "07_toon_hull", {"--outline", "hull", "--samples", "16"},
                              on_a_threshold));
}

TEST(Toon, Eq7_14_HardCase_PictureOfTheTeapot) {
    EXPECT_TRUE(equals_golden(
        "07_toon", "07_toon_scene",
        {"--model", "scene.obj", "--distance", "1.4", "--pitch", "27", "--samples", "16"},
        on_a_threshold));
}
