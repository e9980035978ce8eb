// SPDX-License-Identifier: MIT
/// @file
/// Layers of known overdraw, drawn by lessons 12 and 13: how often a pixel is shaded, how long that
/// takes, and where the visibility buffer begins to pay.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "accuracy/visibility_frames.hpp"
#include "support/layered_scene.hpp"

namespace rasterbook::test {

constexpr std::array order_names = {"back to front", "random order", "front to back"};
constexpr std::array look_names = {"flat colour", "texture", "texture, Phong",
                                   "texture, Phong, shadow"};

template <typename Options>
Options options_of(const Layers& layers) {
    Options options;
    options.size = layers.size;
    options.shadow.size = 512;  // so that the map is a small part of the frame
    if constexpr (std::is_same_v<Options, lesson_13::Options>)
        options.visibility.shadow_part = options.shadow.size;  // all of it, as lesson 12 draws it
    return options;
}

inline Assets assets_of(const Layers& layers) {
    PlannedScene assets =
        load_planned_scene(layered_scene(layers), options_of<lesson_12::Options>(layers));
    if (layers.look < LayerLook::shadow) {
        assets.lit_by.casts.fill(false);
        for (EffectMask& effects : assets.effects) effects.set(Effect::shadow, false);
    }
    return std::make_shared<const PlannedScene>(std::move(assets));
}

/// What the layers' picture has to be: of a flat colour that of the nearest layer, else lesson 12's
/// picture of the same layers drawn from front to back.
inline Image<vec3> reference_of(Layers layers) {
    if (layers.look == LayerLook::flat) return Image<vec3>(layers.size, color_of_layer(0));
    layers.order = LayerOrder::front_to_back;
    return frame(options_of<lesson_12::Options>(layers), *assets_of(layers));
}

/// 1 + 1/2 + ... + 1/k (Eq. 13.4).
inline double harmonic(int k) {
    double sum = 0;
    for (int i = 1; i <= k; ++i) sum += 1.0 / i;
    return sum;
}

inline void add_layers(const std::string& comparison, LayerLook look) {
    for (const int count : {1, 2, 4, 8, 16}) {
        Layers layers{{1024, 512}, count, {32, 32}, LayerOrder::back_to_front, 0, look};
        const Image<vec3> reference = reference_of(layers);
        for (std::size_t order = 0; order < order_names.size(); ++order) {
            layers.order = static_cast<LayerOrder>(order);
            const Assets assets = assets_of(layers);
            const auto add = [&](const std::string& lesson, const auto& options) {
                add_frames(
                    comparison, std::to_string(count) + ": " + lesson + ", " + order_names[order],
                    pixels_of(reference), options, assets, reference, {{"H_k", harmonic(count)}});
            };
            add("11", options_of<lesson_12::Options>(layers));
            add("12", options_of<lesson_13::Options>(layers));
        }
    }
}

/// Triangles of `area` pixels each.
inline void add_triangles(const std::string& name, LayerLook look, int count) {
    for (const auto& [area, cell] : {std::pair{1, ivec2(2, 1)},
                                     {4, {4, 2}},
                                     {16, {8, 4}},
                                     {64, {16, 8}},
                                     {256, {32, 16}},
                                     {1024, {64, 32}}}) {
        const Layers layers{{512, 256}, count, cell, LayerOrder::random, 0, look};
        const Image<vec3> reference = reference_of(layers);
        const Assets assets = assets_of(layers);
        const auto add = [&](const std::string& lesson, const auto& options) {
            add_frames("triangles", std::to_string(area) + ": " + lesson + ", " + name,
                       pixels_of(reference), options, assets, reference);
        };
        add("11", options_of<lesson_12::Options>(layers));
        add("12", options_of<lesson_13::Options>(layers));
    }
}

/// The terms of Eq. 13.5, and with them how often a pixel has to be shaded for both lessons to take
/// the same time. Frames of four layers are timed by turns.
inline void add_break_even(LayerLook look) {
    Layers layers{.size = {512, 256},
                  .count = 4,
                  .cell = {32, 32},
                  .order = LayerOrder::front_to_back,
                  .look = look};
    const Assets front = assets_of(layers);
    layers.order = LayerOrder::back_to_front;
    const Assets back = assets_of(layers);
    const auto of_12 = options_of<lesson_12::Options>(layers);
    const auto of_13 = options_of<lesson_13::Options>(layers);
    const auto ns_per_pixel = [&](const auto& options, const Assets& assets) {
        using Clock = std::chrono::steady_clock;
        const auto start = Clock::now();
        frame(options, *assets);
        const std::chrono::duration<double, std::nano> time = Clock::now() - start;
        return time.count() / (layers.size.x * layers.size.y);
    };
    constexpr int turns = 25;
    std::array<double, turns> shade, again;
    ns_per_pixel(of_13, back);  // fills the caches
    for (std::size_t i = 0; i < turns; ++i) {
        const double of_11_front = ns_per_pixel(of_12, front);
        shade[i] = (ns_per_pixel(of_12, back) - of_11_front) / (layers.count - 1);
        again[i] = ns_per_pixel(of_13, front) - of_11_front;
    }
    for (auto* const times : {&shade, &again}) std::ranges::sort(*times);
    const double t_s = shade[turns / 2], t_v = again[turns / 2];
    add_variant("break-even", look_names[static_cast<std::size_t>(look)], 1,
                {{"t_s, ns", t_s}, {"t_v, ns", t_v}, {"break-even s", 1 + t_v / t_s}}, [] {});
}

}  // namespace rasterbook::test
