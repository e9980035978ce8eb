// SPDX-License-Identifier: MIT
/// @file
/// A frame of lesson 14 with a place on each lesson's knob, for costs.cpp.
#pragma once

#include <cstddef>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "10_threading/thread_pool.hpp"
#include "12_effects/planned_scene.hpp"
#include "support/lesson_14.hpp"
#include "support/pictures.hpp"

namespace rasterbook::test {

namespace {  // as the lesson's options are

/// A place on each knob.
struct Settings : lesson_14::Options {
    bool has_shadows = true;
    bool is_moved = false;  ///< The camera: by half a pixel or so.
};

/// So far does the camera move to the right and up, as seen from the scene's centre.
constexpr vec2 way_radians(0.00045f, 0.0003f);

/// The scene as settings have it. Those that need no other scene share one.
const PlannedScene& assets_of(const Settings& settings) {
    static std::map<std::tuple<Decoding, bool, bool>, PlannedScene> known;
    const std::tuple key{settings.texture.decoding, settings.has_shadows, settings.is_moved};
    if (const auto same = known.find(key); same != known.end()) return same->second;
    PlannedScene assets = load_planned_scene(loaded(settings.model.string()), settings);
    if (!settings.has_shadows) {
        assets.lit_by.casts.fill(false);
        for (EffectMask& effects : assets.effects) effects.set(Effect::shadow, false);
    }
    if (settings.is_moved)
        for (SceneCamera& camera : assets.scene.cameras) {
            mat4& from = camera.world_from_view;
            const vec3 center = assets.scene.bounds().center();
            const vec2 way = way_radians * glm::distance(vec3(from[3]), center);
            from[3] += from[0] * way.x + from[1] * way.y;
        }
    return known.emplace(key, std::move(assets)).first->second;
}

Image<vec3> picture_of(Settings settings, ThreadPool& pool) {
    settings.size *= settings.samples_per_side;
    StepClock clock;
    return averaged(lesson_14::render(settings, assets_of(settings), pool, clock),
                    settings.samples_per_side);
}

/// One way to make a choice.
struct Level {
    const char* name;
    void (*set)(Settings&);
};

/// A choice.
struct Knob {
    const char* name;
    const char* lesson;
    std::size_t cheapest, most_exact;  ///< Which of its levels.
    std::vector<Level> levels;         ///< Each at least as exact as the one before, by its lesson.
};

constexpr std::size_t samples = 0, textures = 1, maps = 2, texels = 3;  ///< Indices into knobs().

const std::vector<Knob>& knobs() {
    using S = Settings;
    static const std::vector<Knob> all = {
        {"samples per pixel",
         "02",
         0,
         2,
         {{"1", [](S& s) { s.samples_per_side = 1; }},
          {"4", [](S& s) { s.samples_per_side = 2; }},
          {"16", [](S& s) { s.samples_per_side = 4; }}}},
        {"texture filter",
         "05",
         0,
         2,
         {{"nearest", [](S& s) { s.texture.filter = Filter::nearest; }},
          {"bilinear", [](S& s) { s.texture.filter = Filter::bilinear; }},
          {"trilinear", [](S& s) { s.texture.filter = Filter::trilinear; }}}},
        {"shadow map",
         "09",
         1,
         4,
         {{"none", [](S& s) { s.has_shadows = false; }},
          {"512", [](S& s) { s.shadow.size = 512; }},
          {"1024", [](S& s) { s.shadow.size = 1024; }},
          {"2048", [](S& s) { s.shadow.size = 2048; }},
          {"4096", [](S& s) { s.shadow.size = 4096; }}}},
        {"PCF taps",
         "09",
         0,
         1,
         {{"1", [](S& s) { s.shadow.pcf = 1; }},
          {"9", [](S& s) { s.shadow.pcf = 3; }},
          {"25", [](S& s) { s.shadow.pcf = 5; }}}},
        {"bias",
         "09",
         2,
         2,
         {{"none", [](S& s) { s.shadow.bias = Bias::none; }},
          {"constant", [](S& s) { s.shadow.bias = Bias::constant; }},
          {"slope", [](S& s) { s.shadow.bias = Bias::slope; }}}},
        {"sRGB values",
         "05",
         1,
         1,
         {{"ignored", [](S& s) { s.texture.decoding = Decoding::ignored; }},
          {"decoded", [](S& s) { s.texture.decoding = Decoding::srgb; }}}}};
    return all;
}

/// For each knob the index of its level.
using Choices = std::vector<std::size_t>;

Choices with(Choices choices, std::size_t knob, std::size_t level) {
    choices[knob] = level;
    return choices;
}

Settings settings_of(const Choices& choices) {
    Settings settings;
    for (std::size_t i = 0; i < choices.size(); ++i) knobs()[i].levels[choices[i]].set(settings);
    return settings;
}

}  // namespace
}  // namespace rasterbook::test
