// SPDX-License-Identifier: MIT
/// @file
/// What each effect costs in each scene, and what the picture would be without it; and what it
/// would cost to compute all effects everywhere.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <syncstream>
#include <utility>
#include <vector>

// All that the lesson's main.cpp includes, so that it can be included within a namespace.
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "05_textures/textured_scene.hpp"
#include "06_phong/shading_variants.hpp"
#include "08_normal_maps/normal_map_variants.hpp"
#include "09_shadow_maps/shadow_variants.hpp"
#include "10_threading/binned_triangles.hpp"
#include "10_threading/thread_options.hpp"
#include "10_threading/thread_pool.hpp"
#include "10_threading/threaded_shadows.hpp"
#include "11_scenes/explain.hpp"
#include "11_scenes/finished_scene.hpp"
#include "11_scenes/kernels.hpp"
#include "11_scenes/scene_camera.hpp"
#include "11_scenes/scene_options.hpp"
#include "accuracy/accuracy.hpp"
#include "common/backdrop.hpp"
#include "common/lesson_app.hpp"
#include "common/math/color.hpp"
#include "common/memory.hpp"
#include "common/model_file.hpp"

#define main main_of_lesson
namespace lesson {
#include "11_scenes/main.cpp"
}
#undef main

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr ivec2 picture_size(1280, 720);
constexpr double frames_in_millions = 1e6;  // so that nanoseconds become milliseconds

Scene loaded(const std::string& name) {
    return load_model(std::filesystem::path(RASTERBOOK_ASSETS) / "models" / name);
}

Image<vec3> drawn(const lesson::Options& options, const FinishedScene& scene) {
    static ThreadPool pool(1);
    NoCounters none;
    NoClock no_clock;
    return lesson::render(options, scene, pool, none, no_clock);
}

/// Differences of codes, white being 1: as the eye weighs them.
struct Difference {
    double rms, share_percent;
};

Difference difference_of(const Image<vec3>& a, const Image<vec3>& b) {
    double sum = 0;
    std::size_t different = 0;
    const auto code = [](float light) { return srgb_from_linear(std::clamp(light, 0.0f, 1.0f)); };
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
        const vec3 p = a.pixels()[i], q = b.pixels()[i];
        different += p != q;
        for (int c = 0; c < 3; ++c) {
            const double difference = double{code(p[c])} - double{code(q[c])};
            sum += difference * difference;
        }
    }
    const auto pixels = static_cast<double>(a.pixels().size());
    return {std::sqrt(sum / (3 * pixels)), 100 * static_cast<double>(different) / pixels};
}

/// A way to take an effect out of a scene.
struct Without {
    Effect effect;
    std::function<void(Scene&)> change;
};

template <typename Change>
std::function<void(Scene&)> of_materials(Change change) {
    return [=](Scene& scene) {
        for (Material& material : scene.materials) change(material);
    };
}

const std::vector<Without>& ways() {
    static const std::vector<Without> all = {
        {Effect::highlight, of_materials([](Material& m) { m.specular = vec3(0); })},
        {Effect::texture, of_materials([](Material& m) { m.diffuse_map = {}; })},
        {Effect::vertex_colors,
         [](Scene& scene) {
             for (Mesh& mesh : scene.meshes) mesh.colors.clear();
         }},
        {Effect::normal_map, of_materials([](Material& m) { m.normal_map = {}, m.bump_map = {}; })},
        {Effect::shadow, {}},  // of the lights
        {Effect::toon, of_materials([](Material& m) {
             if (m.toon) m.toon.reset(), m.illumination = 0;
         })},
        {Effect::outline, of_materials([](Material& m) {
             if (m.toon) m.toon->outline = ToonLook::Outline::none;
         })}};
    return all;
}

void add_scene(const std::string& name) {
    lesson::Options options;
    options.size = picture_size;
    const auto whole = std::make_shared<const FinishedScene>(loaded(name), options);
    const auto picture = std::make_shared<const Image<vec3>>(drawn(options, *whole));
    const auto add = [&](const std::string& variant, const lesson::Options& own,
                         const std::shared_ptr<const FinishedScene>& scene) {
        const Difference difference = difference_of(*picture, drawn(own, *scene));
        add_variant(name, variant, frames_in_millions,
                    {{"RMS difference", difference.rms},
                     {"pixels that differ, %", difference.share_percent}},
                    [=] { drawn(own, *scene); });
    };
    add("as called for", options, whole);
    for (const auto& [effect, change] : ways()) {
        if (!whole->plan.any(effect)) continue;
        Scene model = loaded(name);
        if (change) change(model);
        const auto scene = std::make_shared<FinishedScene>(std::move(model), options);
        if (effect == Effect::shadow) scene->lit_by.casts.fill(false);
        scene->is_on_paper = whole->is_on_paper;  // what lies behind is none of the effects
        add("without " + std::string(effect_names[static_cast<std::size_t>(effect)]), options,
            scene);
    }
    if (whole->plan.any(Effect::light)) {  // the largest kernel, which asks at run time
        const auto general = std::make_shared<FinishedScene>(loaded(name), options);
        for (MaterialPlan& plan : general->plan.materials)
            if (plan[Effect::light])
                for (const Effect effect : {Effect::normal_map, Effect::shadow})
                    plan.runs[static_cast<std::size_t>(effect)] = true;
        add("one kernel for all", options, general);
    }
    lesson::Options forced = options;
    forced.shading.all_effects = true;
    add("all effects", forced, std::make_shared<const FinishedScene>(loaded(name), forced));
}

}  // namespace

int main(int argc, char** argv) {
    keep_freed_memory();
    for (const char* name : {"unlit.glb", "textured.gltf", "bumpy.glb", "toon.glb"})
        add_scene(name);
    return measure_variants(argc, argv);
}
