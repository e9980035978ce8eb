// SPDX-License-Identifier: MIT
/// @file
/// Frames by how many pixels are drawn at a time, and what lesson 13 does without: estimates, fused
/// multiply-adds, other polynomials, and textures of 8-bit values.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "accuracy/accuracy.hpp"
#include "accuracy/simd_estimates.hpp"
#include "accuracy/simd_frames.hpp"
#include "accuracy/simd_numbers.hpp"
#include "accuracy/simd_polynomials.hpp"
#include "accuracy/simd_texels.hpp"
#include "accuracy/visibility_layers.hpp"
#include "common/app/memory.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr std::array widths = {1, 4, 8, 16};

/// The share of lanes that hold a pixel, when pixels are shaded so many at a time.
double lanes_counted(int width, const lesson_13::Options& options, const SceneAssets& assets) {
    const int counting = width == 4 ? counted_4 : width == 8 ? counted_8 : counted_16;
    batches_counted() = {};
    frame(of_width(counting, options), assets);
    return 100 * static_cast<double>(batches_counted().pixels) /
           (width * static_cast<double>(batches_counted().count));
}

// Whole frames.

template <typename Options>
void add_frame(const std::string& comparison, const std::string& variant, double units,
               const Options& options, const Assets& assets, const Image<vec3>& reference) {
    add_variant(comparison, variant, units,
                {{"pixels that differ, %", differing_percent(frame(options, *assets), reference)}},
                [=] { frame(options, *assets); });
}

void add_scenes() {
    for (const auto& [name, assets] : scenes()) {
        const Image<vec3> reference = frame(lesson_11::Options(), *assets);
        const auto add = [&](const std::string& variant, const auto& options) {
            add_frame("scenes", name + ": " + variant, frames_in_millions, options, assets,
                      reference);
        };
        add("11", lesson_11::Options());
        add("12", lesson_12::Options());
        for (const int width : widths) add(std::to_string(width), of_width(width));
        for (const int width : {4, 8, 16})
            add_variant("scene-lanes", name + ": " + std::to_string(width), 1,
                        {{"lanes, %", lanes_counted(width, lesson_13::Options(), *assets)}}, [] {});
    }
}

// Lanes.

/// What that share would be if each triangle had batches of its own, of n pixels (Eq. 13.4).
double lanes_used(const std::vector<int>& pixels, int width) {
    double used = 0, all = 0;
    for (const int n : pixels) {
        used += n;
        all += width * ((n + width - 1) / width);
    }
    return used / all;
}

void add_triangles() {
    for (const int side : {2, 4, 8, 16, 32, 64, 128, 256}) {
        const Layers layers{.size = {512, 256},
                            .count = 1,
                            .cell = ivec2(side),
                            .order = LayerOrder::front_to_back,
                            .look = LayerLook::phong};
        const Assets assets = assets_of(layers);
        const Image<vec3> reference = frame(options_of<lesson_11::Options>(layers), *assets);
        const auto options = options_of<lesson_13::Options>(layers);
        // The diagonal's pixels belong to one of a cell's two triangles; tiles have sides of 64.
        const int within_tile = std::min(side, options.threads.tile);
        const std::vector<int> of_cell = {within_tile * (within_tile + 1) / 2,
                                          within_tile * (within_tile - 1) / 2};
        const auto add = [&](const std::string& variant, const auto& of) {
            add_frame("triangles", std::to_string(side) + ": " + variant, pixels_of(reference), of,
                      assets, reference);
        };
        for (const int width : widths) {
            add(std::to_string(width), of_width(width, options));
            if (width == 1) continue;
            const auto add_lanes = [&](const std::string& name, double percent) {
                add_variant("lanes", std::to_string(side) + ": " + name + std::to_string(width), 1,
                            {{"lanes, %", percent}}, [] {});
            };
            add_lanes("", lanes_counted(width, options, *assets));
            add_lanes("alone, ", 100 * lanes_used(of_cell, width));
        }
    }
}

// Frames of other arithmetic.

/// Beside the time of each stands what all of them do to the scene's picture.
void add_arithmetic(const std::string& comparison,
                    const std::vector<std::pair<std::string, int>>& variants) {
    for (const auto& [name, assets] : scenes()) {
        const Image<vec3> exact = frame(of_width(16), *assets);
        Errors errors;
        for (const auto& [variant, arithmetic] : variants) {
            const ValueDifference values(frame(of_width(arithmetic), *assets), exact);
            errors[variant + ", values"] = values.percent;
            errors[variant + ", greatest"] = values.greatest;
        }
        for (const auto& [variant, arithmetic] : variants) {
            const lesson_13::Options options = of_width(arithmetic);
            add_variant(comparison, name + ": " + variant, frames_in_millions, errors,
                        [=] { frame(options, *assets); });
        }
    }
}

// Reciprocals.

template <typename Estimate, int steps>
void add_estimate(const std::string& name) {
    constexpr int N = Estimate::width;
    const std::string variant = name + ", " + std::to_string(steps);
    const auto reciprocal = [](Floats<N> x) { return reciprocal_by<Estimate, steps>(x); };
    const auto root = [](Floats<N> x) { return reciprocal_sqrt_by<Estimate, steps>(x); };
    add_function<N>("reciprocals", variant, 1, 4,
                    errors_of_all<N>(1, 4, reciprocal, [](double x) { return 1 / x; }), reciprocal);
    add_function<N>("roots", variant, 1, 4,
                    errors_of_all<N>(1, 4, root, [](double x) { return 1 / std::sqrt(x); }), root);
}

template <typename Estimate>
void add_estimates(const std::string& name) {
    add_estimate<Estimate, 0>(name);
    add_estimate<Estimate, 1>(name);
    add_estimate<Estimate, 2>(name);
}

void add_reciprocals() {
    constexpr int N = native_width;
    const Floats<N> one(1.0f);
    const auto reciprocal = [=](Floats<N> x) { return one / x; };
    const auto root = [=](Floats<N> x) { return one / sqrt(x); };
    add_function<N>("reciprocals", "division", 1, 4,
                    errors_of_all<N>(1, 4, reciprocal, [](double x) { return 1 / x; }), reciprocal);
    add_function<N>("roots", "division", 1, 4,
                    errors_of_all<N>(1, 4, root, [](double x) { return 1 / std::sqrt(x); }), root);
#if defined(__SSE__)
    add_estimates<Rcpps>("rcpps");
#endif
#if defined(__AVX512F__)
    add_estimates<Rcp14>("rcp14");
#endif
    add_estimates<ByBits>("bits");
}

// Fused multiply-adds at an edge.

/// Twice the area of p, a, b, whose products are rounded or fused.
float area(bool is_fused, vec2 p, vec2 a, vec2 b) {
    const vec2 to_a = a - p, to_b = b - p;
    return is_fused ? std::fma(to_a.x, to_b.y, -(to_a.y * to_b.x))
                    : to_a.x * to_b.y - to_a.y * to_b.x;
}

/// Pixels beside an edge that two triangles share, each of which asks on which side they are.
void add_edges() {
    constexpr int count = 10'000'000;
    for (const bool is_fused : {false, true}) {
        std::mt19937 random(13);
        std::uniform_int_distribution<int> any(0, 1024 * 256 - 1);
        int twice = 0, never = 0;
        for (int i = 0; i < count; ++i) {
            const auto vertex = [&] { return vec2(any(random), any(random)) / 256.0f; };
            const vec2 a = vertex(), b = vertex();
            const float x = std::floor((a.x + b.x) / 2) + 0.5f;
            if (a.x == b.x) continue;
            const float y = a.y + (x - a.x) * (b.y - a.y) / (b.x - a.x);
            const vec2 pixel(x, std::floor(y) + 0.5f);
            const float left = area(is_fused, pixel, a, b), right = area(is_fused, pixel, b, a);
            twice += left > 0 && right > 0;
            never += left < 0 && right < 0;
        }
        const double millions = count / 1e6;
        add_variant("edges", is_fused ? "fused" : "rounded twice", 1,
                    {{"twice", twice / millions}, {"never", never / millions}}, [] {});
    }
}

}  // namespace

int main(int argc, char** argv) {
    keep_freed_memory();
    add_scenes();
    add_triangles();
    add_reciprocals();
    add_arithmetic("estimates", {{"13", 16},
                                 {"hardware, 0", hardware_0},
                                 {"hardware, 1", hardware_1},
                                 {"bits, 1", bits_1},
                                 {"bits, 2", bits_2}});
    add_arithmetic("contracted", {{"13", 16}, {"contracted", contracted}});
    add_edges();
    add_polynomials();
    add_storages();
    add_levels();
    return measure_variants(argc, argv);
}
