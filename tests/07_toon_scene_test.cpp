// SPDX-License-Identifier: MIT
// Work only for what a scene and its options call for, and the lesson's pictures.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "support/golden.hpp"
#include "support/lab_07.hpp"
#include "support/look_up.hpp"
#include "support/printers.hpp"
#include "support/toon_pictures.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

const Scene& figure() {
    static const Scene scene = loaded("figure.obj");
    return scene;
}

/// The distance of two pictures: root of the mean square.
double distance_of(const Image<vec3>& a, const Image<vec3>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
        const vec3 d = a.pixels()[i] - b.pixels()[i];
        sum += glm::dot(d, d);
    }
    return std::sqrt(sum / static_cast<double>(a.pixels().size()));
}

// Of the 518,400 pixels of a golden picture, so many may lie on the other side of a threshold with
// another C library's sines: a pixel's light is within 1e-7 of one of three thresholds with a
// chance of about 1e-6, and with 16 samples a pixel sixteen times as often.
constexpr std::size_t on_a_threshold = 40;

}  // namespace

TEST(Toon, HardCase_WithoutOutlineThereIsNoWorkForIt) {
    look_up("Eq. 7.14");
    for (const char* model : {"figure.obj", "scene.obj"}) {
        const Scene scene = loaded(model);
        lesson_07::Options options = small_toon();
        const auto counted = [&](Outline outline, float width, float facing) {
            options.shading.outline = outline;
            options.shading.outline_width_px = width;
            options.shading.min_facing = facing;
            const Drawn toon = drawn_toon(scene, options);
            EXPECT_EQ(toon.count(Counter::toon_fragments), toon.count(Counter::fragments_lit));
            EXPECT_GT(toon.count(Counter::toon_fragments), 5000u);
            return toon;
        };
        const Drawn none = counted(Outline::none, 3, 0.35f);
        EXPECT_EQ(none.count(Counter::outline_tests), 0u);
        EXPECT_EQ(none.count(Counter::outline_pixels), 0u);
        const Drawn facing = counted(Outline::facing, 3, 0.35f);
        EXPECT_EQ(facing.count(Counter::outline_tests), none.count(Counter::fragments_shaded));
        EXPECT_GT(facing.count(Counter::outline_pixels), 100u);
        const Drawn hull = counted(Outline::hull, 3, 0.35f);
        EXPECT_GT(hull.count(Counter::outline_tests), hull.count(Counter::outline_pixels));
        EXPECT_GT(hull.count(Counter::outline_pixels), 100u);
        const Drawn edges = counted(Outline::edges, 3, 0.35f);
        EXPECT_EQ(edges.count(Counter::outline_tests), 320u * 180);
        EXPECT_GT(edges.count(Counter::outline_pixels), 100u);
        // Everything else is done as without an outline.
        for (const Drawn& with : {facing, hull, edges})
            for (const Counter counter :
                 {Counter::fragments_tested, Counter::fragments_shaded, Counter::texture_samples,
                  Counter::fragments_lit, Counter::highlights, Counter::toon_fragments})
                EXPECT_EQ(with.count(counter), none.count(counter));
    }
}

TEST(Toon, HardCase_OutlinesOfNoWidthChangeNothing) {
    look_up("Eq. 7.14");
    for (const float yaw : {-30.0f, 0.0f, 77.0f, 180.0f}) {
        lesson_07::Options options = small_toon();
        options.size = {640, 360};
        options.orbit.yaw_degrees = yaw;
        options.shading.outline = Outline::none;
        const Image<vec3> without = toon_picture(figure(), options);
        options.shading.outline_width_px = 0;
        options.shading.min_facing = 0;
        for (const Outline outline : {Outline::facing, Outline::hull, Outline::edges}) {
            options.shading.outline = outline;
            const Drawn with = drawn_toon(figure(), options);
            EXPECT_TRUE(are_the_same_bits(with.picture, without))
                << "an outline of no width, by "
                << (outline == Outline::facing ? "the facing ratio"
                    : outline == Outline::hull ? "a hull"
                                               : "edges")
                << ", and none; with --yaw " << yaw;
            EXPECT_GT(with.count(Counter::outline_tests), 10'000u);
            EXPECT_EQ(with.count(Counter::outline_pixels), 0u);
        }
    }
}

TEST(Toon, HardCase_EffectsThatAreNotCalledForWouldChangeNothing) {
    look_up("Eq. 7.4");
    for (const char* model : {"figure.obj", "scene.obj", "crate.obj", "scene_bumpy.obj"}) {
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
        std::vector<float> reds;
        const Image<vec3> picture = toon_picture(scene, options);
        for (const vec3 color : picture.pixels())
            if (color != paper_color) reds.push_back(color.r);
        std::ranges::sort(reds);
        reds.erase(std::ranges::unique(reds).begin(), reds.end());
        return reds;
    };
    // Three faces in directional light, each of one colour; with a single tone all have the same.
    EXPECT_LE(colors(255, LightKind::directional).size(), 3u);
    EXPECT_GE(colors(255, LightKind::directional).size(), 2u);
    EXPECT_EQ(colors(1, LightKind::directional).size(), 1u);
    EXPECT_EQ(colors(1, LightKind::point).size(), 1u);
    EXPECT_LE(colors(4, LightKind::point).size(), 4u);
    EXPECT_GT(colors(255, LightKind::point).size(), 20u);
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
    options.size /= 8;
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
    EXPECT_GT(distance_of(hard, smooth), 0);
}

TEST(Toon, HardCase_LinesAreAsWideWithManySamples) {
    look_up("Eq. 7.9");
    for (const Outline outline : {Outline::hull, Outline::edges}) {
        const auto darkness = [&](int samples_per_side) {
            lesson_07::Options options = small_toon();
            options.size *= samples_per_side;
            options.samples_per_side = samples_per_side;
            options.orbit = {0, 0, 4, 36};
            options.shading.outline = outline;
            options.shading.outline_width_px = 4;
            const Image<Seen> seen = seen_in(toon_picture(scene_of_one(cube_mesh(true)), options));
            return count_of(seen, Seen::ink) /
                   static_cast<double>(samples_per_side * samples_per_side);
        };
        // With one sample a slanted line has stairs, and is a bit wider.
        EXPECT_NEAR(darkness(4), darkness(1), 0.12 * darkness(1));
    }
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
