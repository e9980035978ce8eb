// SPDX-License-Identifier: MIT
// "Why this pixel?" in the lessons that draw scenes of any file.
#include <cstdint>
#include <utility>

#include <gtest/gtest.h>

#include "10_threading/thread_pool.hpp"
#include "11_scenes/probe.hpp"
#include "support/any_scene.hpp"
#include "support/lesson_11.hpp"
#include "support/lesson_12.hpp"
#include "support/lesson_13.hpp"
#include "support/pictures.hpp"
#include "support/probed_pixels.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

/// All three lessons' pictures of a scene.
void expect_the_three_pictures_pixels(const lesson_13::Options& options, Scene scene, int pixels) {
    ThreadPool pool(2);
    const SceneAssets assets = make_scene_assets(std::move(scene), options);
    const auto expect = [&](const auto& of, const auto& render, int count) {
        expect_the_pictures_pixels(of, assets, count, render, scene_probe);
    };
    lesson_11::Options before;
    static_cast<SceneRendererOptions&>(before) = options;
    lesson_12::Options visibility;
    static_cast<SceneRendererOptions&>(visibility) = options;
    expect(
        before,
        [&](const auto& of, const auto& with) {
            StepClock clock;
            return lesson_11::render(of, with, pool, clock);
        },
        pixels);
    expect(
        visibility,
        [&](const auto& of, const auto& with) {
            StepClock clock;
            return lesson_12::render(of, with, pool, clock);
        },
        pixels / 2);
    expect(
        options,
        [&](const auto& of, const auto& with) {
            StepClock clock;
            return lesson_13::render(of, with, pool, clock);
        },
        pixels / 2);
}

}  // namespace

TEST(Probe, Lessons11To13SayWhatThePicturesHave) {
    lesson_13::Options options;
    for (const char* model :
         {"bumpy.glb", "textured.gltf", "unlit.glb", "toon.glb", "workshop.glb", "scene_bumpy.obj"})
        expect_the_three_pictures_pixels(options, loaded(model), 100);
    options.shading.all_effects = true;
    expect_the_three_pictures_pixels(options, loaded("bumpy.glb"), 60);
    options = {};
    options.samples_per_side = 2, options.shading.two_sided = true, options.shadow.pcf = 7;
    options.texture.filter = Filter::bilinear;
    expect_the_three_pictures_pixels(options, loaded("workshop.glb"), 60);
}

TEST(Probe, Lessons11To13SayWhatRandomScenesHave) {
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        lesson_13::Options options;
        options.shadow.size = 64;
        options.shading.two_sided = seed % 3 == 0;
        expect_the_three_pictures_pixels(options, any_scene(seed), 60);
    }
}
