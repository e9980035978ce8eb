// SPDX-License-Identifier: MIT
/// @file
/// Frames by how many pixels are drawn at a time, and by the size of triangles; and what lesson 14
/// does without: estimates and fused multiply-adds.
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "accuracy/accuracy.hpp"
#include "accuracy/simd_frames.hpp"
#include "accuracy/visibility_layers.hpp"
#include "common/app/memory.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

constexpr std::array widths = {1, 4, 8, 16};

template <typename Options>
void add_frame(const std::string& comparison, const std::string& variant, double units,
               const Options& options, const Assets& assets, const Image<vec3>& reference) {
    add_variant(comparison, variant, units,
                {{"pixels that differ, %", differing_percent(frame(options, *assets), reference)}},
                [=] { frame(options, *assets); });
}

void add_scenes() {
    for (const auto& [name, assets] : scenes()) {
        const Image<vec3> reference = frame(lesson_12::Options(), *assets);
        const auto add = [&](const std::string& variant, const auto& options) {
            add_frame("scenes", name + ": " + variant, frames_in_millions, options, assets,
                      reference);
        };
        add("11", lesson_12::Options());
        add("12", lesson_13::Options());
        for (const int width : widths) add(std::to_string(width), of_width(width));
    }
}

/// A layer of right triangles.
void add_triangles() {
    for (const int side : {2, 4, 8, 16, 32, 64, 128, 256}) {
        const Layers layers{.size = {512, 256},
                            .count = 1,
                            .cell = ivec2(side),
                            .order = LayerOrder::front_to_back,
                            .look = LayerLook::phong};
        const Assets assets = assets_of(layers);
        const Image<vec3> reference = frame(options_of<lesson_12::Options>(layers), *assets);
        for (const int width : widths)
            add_frame("triangles", std::to_string(side) + ": " + std::to_string(width),
                      pixels_of(reference), of_width(width, options_of<lesson_14::Options>(layers)),
                      assets, reference);
    }
}

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
            const lesson_14::Options options = of_width(arithmetic);
            add_variant(comparison, name + ": " + variant, frames_in_millions, errors,
                        [=] { frame(options, *assets); });
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    keep_freed_memory();
    add_scenes();
    add_triangles();
    add_arithmetic("estimates",
                   {{"13", 16}, {"hardware, 0", hardware_0}, {"hardware, 1", hardware_1}});
    add_arithmetic("contracted", {{"13", 16}, {"contracted", contracted}});
    return measure_variants(argc, argv);
}
