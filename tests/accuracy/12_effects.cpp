// SPDX-License-Identifier: MIT
/// @file
/// What each effect costs in each scene, and what the picture would be without it; and what it
/// would cost to compute all effects everywhere.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "10_threading/thread_pool.hpp"
#include "12_effects/explain.hpp"
#include "12_effects/planned_scene.hpp"
#include "accuracy/accuracy.hpp"
#include "common/app/memory.hpp"
#include "common/math/color.hpp"
#include "support/lesson_12.hpp"
#include "support/pictures.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr ivec2 picture_size(1280, 720);
constexpr double frames_in_millions = 1e6;  // so that nanoseconds become milliseconds

Image<vec3> drawn(const lesson_12::Options& options, const PlannedScene& assets) {
    static ThreadPool pool(1);
    StepClock clock;
    return lesson_12::render(options, assets, pool, clock);
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
             if (m.toon) m.toon->outline = ToonMaterial::Outline::none;
         })}};
    return all;
}

void add_scene(const std::string& name) {
    lesson_12::Options options;
    options.size = picture_size;
    const auto whole =
        std::make_shared<const PlannedScene>(load_planned_scene(loaded(name), options));
    const auto picture = std::make_shared<const Image<vec3>>(drawn(options, *whole));
    const auto add = [&](const std::string& variant, const lesson_12::Options& own,
                         const std::shared_ptr<const PlannedScene>& assets) {
        const Difference difference = difference_of(*picture, drawn(own, *assets));
        add_variant(name, variant, frames_in_millions,
                    {{"RMS difference", difference.rms},
                     {"pixels that differ, %", difference.share_percent}},
                    [=] { drawn(own, *assets); });
    };
    add("as called for", options, whole);
    for (const auto& [effect, change] : ways()) {
        if (!whole->plan.any(effect)) continue;
        Scene scene = loaded(name);
        if (change) change(scene);
        const auto assets =
            std::make_shared<PlannedScene>(load_planned_scene(std::move(scene), options));
        if (effect == Effect::shadow) assets->lit_by.casts.fill(false);
        assets->is_drawing = whole->is_drawing;  // what lies behind is none of the effects
        add("without " + std::string(effect_names[static_cast<std::size_t>(effect)]), options,
            assets);
    }
    lesson_12::Options forced = options;
    forced.shading.all_effects = true;
    add("all effects", forced,
        std::make_shared<const PlannedScene>(load_planned_scene(loaded(name), forced)));
}

}  // namespace

int main(int argc, char** argv) {
    keep_freed_memory();
    for (const char* name : {"unlit.glb", "textured.gltf", "bumpy.glb", "toon.glb"})
        add_scene(name);
    return measure_variants(argc, argv);
}
