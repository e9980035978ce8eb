// SPDX-License-Identifier: MIT
/// @file
/// Layers of known overdraw, drawn by lessons 11 and 12: how often a pixel is shaded, how long that
/// takes, and where the visibility buffer begins to pay.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

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
    if constexpr (std::is_same_v<Options, lesson_12::Options>)
        options.visibility.shadow_part = options.shadow.size;  // all of it, as lesson 11 draws it
    return options;
}

inline Assets assets_of(const Layers& layers) {
    SceneAssets assets =
        make_scene_assets(layered_scene(layers), options_of<lesson_11::Options>(layers));
    if (layers.look < LayerLook::shadow) {
        assets.lit_by.casts.fill(false);
        for (MaterialPlan& plan : assets.plan.materials) plan.set(Effect::shadow, false, "");
    }
    return std::make_shared<const SceneAssets>(std::move(assets));
}

/// What the layers' picture has to be: of a flat colour that of the nearest layer, else lesson 11's
/// picture of the same layers drawn from front to back.
inline Image<vec3> reference_of(Layers layers) {
    if (layers.look == LayerLook::flat) return Image<vec3>(layers.size, color_of_layer(0));
    layers.order = LayerOrder::front_to_back;
    return frame(options_of<lesson_11::Options>(layers), *assets_of(layers));
}

/// 1 + 1/2 + ... + 1/k (Eq. 12.4).
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
            add("11", options_of<lesson_11::Options>(layers));
            add("12", options_of<lesson_12::Options>(layers));
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
        add("11", options_of<lesson_11::Options>(layers));
        add("12", options_of<lesson_12::Options>(layers));
    }
}

inline double median_of(std::vector<double> values) {
    std::ranges::nth_element(values,
                             values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
    return values[values.size() / 2];
}

/// Frames that are timed by turns, each several times.
class Turns {
  public:
    /// @return  The number of the frame.
    std::size_t add(std::function<void()> frame) {
        frames_.push_back(std::move(frame));
        return frames_.size() - 1;
    }

    /// The median over the turns of the sum of factor times duration, in ns.
    double combined(const std::vector<std::pair<double, std::size_t>>& terms) {
        measure();
        std::vector<double> sums;
        for (const std::vector<double>& turn : ns_) {
            double sum = 0;
            for (const auto& [factor, which] : terms) sum += factor * turn[which];
            sums.push_back(sum);
        }
        return median_of(sums);
    }

  private:
    void measure() {
        constexpr int turns = 25;
        if (!ns_.empty()) return;
        for (const auto& frame : frames_) frame();  // fills the caches
        for (int turn = 0; turn < turns; ++turn) {
            std::vector<double>& ns = ns_.emplace_back();
            for (const auto& frame : frames_) {
                using Clock = std::chrono::steady_clock;
                const auto start = Clock::now();
                frame();
                ns.push_back(
                    std::chrono::duration<double, std::nano>(Clock::now() - start).count());
            }
        }
    }

    std::vector<std::function<void()>> frames_;
    std::vector<std::vector<double>> ns_;  ///< Of each turn.
};

/// How often lesson 11 has to shade a pixel for both lessons to take the same time: between two of
/// these pictures, the gain is taken to change evenly.
///
/// @param gains  Of lesson 12, by times shaded, in rising order.
inline double break_even_of(const std::vector<std::pair<double, double>>& gains) {
    for (std::size_t i = 0; i < gains.size(); ++i) {
        const auto [times, gain] = gains[i];
        if (gain < 0) continue;
        if (i == 0) return times;
        const auto [times_before, gain_before] = gains[i - 1];
        return times_before + (times - times_before) * gain_before / (gain_before - gain);
    }
    return gains.back().first;
}

/// The terms of Eq. 12.5 of one look, and whether they say which lesson is faster.
inline void add_break_even(LayerLook look) {
    Turns turns;
    const Layers front{.size = {512, 256},
                       .count = 4,
                       .cell = {32, 32},
                       .order = LayerOrder::front_to_back,
                       .look = look};
    const double pixels = front.size.x * front.size.y;
    const auto of_11 = options_of<lesson_11::Options>(front);
    const auto of_12 = options_of<lesson_12::Options>(front);
    struct Both {
        double times;  ///< That lesson 11 shades a pixel.
        std::size_t of_11, of_12;
    };
    const auto add = [&](LayerOrder order, double back_share) {
        Layers layers = front;
        layers.order = order, layers.back_share = back_share;
        const Assets assets = assets_of(layers);
        return Both{shadings_per_pixel(counted(of_11, *assets)),
                    turns.add([=] { frame(of_11, *assets); }),
                    turns.add([=] { frame(of_12, *assets); })};
    };
    const Both once = add(LayerOrder::front_to_back, 0);
    const Both always = add(LayerOrder::back_to_front, 0);
    const Both random = add(LayerOrder::random, 0);
    std::vector<Both> between = {once};
    for (const int cells : {1, 2, 4, 8, 16, 32})
        between.push_back(add(LayerOrder::some_back_to_front, cells / 128.0));

    const auto gain_of = [&](const Both& both) {
        return turns.combined({{1, both.of_11}, {-1, both.of_12}}) / pixels;
    };
    const double shade = turns.combined({{1, always.of_11}, {-1, once.of_11}}) / pixels /
                         (always.times - once.times);
    const double again = -gain_of(once);
    std::vector<std::pair<double, double>> gains;
    for (const Both& both : between) gains.emplace_back(both.times, gain_of(both));
    Layers in_random_order = front;
    in_random_order.order = LayerOrder::random;
    add_frames("break-even", look_names[static_cast<std::size_t>(look)], pixels, of_12,
               assets_of(in_random_order), reference_of(front),
               {{"t_s, ns", shade},
                {"t_v, ns", again},
                {"break-even s", 1 + again / shade},
                {"measured break-even s", break_even_of(gains)},
                {"s", random.times},
                {"predicted gain, ns", (random.times - 1) * shade - again},
                {"measured gain, ns", gain_of(random)}});
}

}  // namespace rasterbook::test
