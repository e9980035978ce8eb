// SPDX-License-Identifier: MIT
/// @file
/// Frames of lessons 12 and 13 on one thread, to be counted, compared and timed.
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "accuracy/accuracy.hpp"
#include "common/math/color.hpp"
#include "support/lesson_12.hpp"
#include "support/lesson_13.hpp"
#include "support/pictures.hpp"

namespace rasterbook::test {

using Assets = std::shared_ptr<const PlannedScene>;

constexpr double frames_in_millions = 1e6;  // so that nanoseconds become milliseconds

inline ThreadPool& one_thread() {
    static ThreadPool pool(1);
    return pool;
}

inline Image<vec3> frame(const lesson_12::Options& options, const PlannedScene& assets) {
    StepClock clock;
    return lesson_12::render(options, assets, one_thread(), clock);
}

inline Image<vec3> frame(const lesson_13::Options& options, const PlannedScene& assets) {
    StepClock clock;
    return lesson_13::render(options, assets, one_thread(), clock);
}

/// A frame, and what was done for it.
template <typename Options>
Drawn counted(const Options& options, const PlannedScene& assets) {
    return drawn(options, assets, [](const auto&... of) { return frame(of...); });
}

inline double pixels_of(const Image<vec3>& picture) {
    return static_cast<double>(picture.pixels().size());
}

/// The share of pixels that differ in any bit.
inline double differing_percent(const Image<vec3>& a, const Image<vec3>& b) {
    std::size_t differing = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i)
        differing += std::memcmp(&a.pixels()[i], &b.pixels()[i], sizeof(vec3)) != 0;
    return 100 * static_cast<double>(differing) / pixels_of(a);
}

/// The same of the pictures as files have them.
inline double differing_percent_of_files(const Image<vec3>& a, const Image<vec3>& b) {
    const Image<u8vec3> file_a = srgb8_from_linear(a), file_b = srgb8_from_linear(b);
    std::size_t differing = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i)
        differing += file_a.pixels()[i] != file_b.pixels()[i];
    return 100 * static_cast<double>(differing) / pixels_of(a);
}

inline double shadings_per_pixel(const Drawn& drawn) {
    return static_cast<double>(drawn.count(Counter::fragments_shaded)) / pixels_of(drawn.picture);
}

inline Assets assets_of(Scene scene, const lesson_12::Options& options) {
    return std::make_shared<const PlannedScene>(load_planned_scene(std::move(scene), options));
}

/// The four scenes of the repository.
struct NamedScene {
    std::string name;
    Assets assets;
};

inline const std::vector<NamedScene>& scenes() {
    static const std::vector<NamedScene> all = [] {
        std::vector<NamedScene> made;
        for (const char* name : {"unlit.glb", "textured.gltf", "bumpy.glb", "toon.glb"})
            made.push_back({name, assets_of(loaded(name), lesson_12::Options())});
        return made;
    }();
    return all;
}

/// @param reference  What the picture has to be.
template <typename Options>
void add_frames(const std::string& comparison, const std::string& variant, double units,
                const Options& options, const Assets& assets, const Image<vec3>& reference,
                Errors more = {}) {
    const Drawn drawn = counted(options, *assets);
    more["shadings a pixel"] = shadings_per_pixel(drawn);
    more["pixels that differ, %"] = differing_percent(drawn.picture, reference);
    add_variant(comparison, variant, units, std::move(more), [=] { frame(options, *assets); });
}

}  // namespace rasterbook::test
