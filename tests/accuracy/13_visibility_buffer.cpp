// SPDX-License-Identifier: MIT
/// @file
/// Shading each pixel once against forward shading: by overdraw, by the cost of shading, by ids and
/// by the size of triangles. And barycentric coordinates found again in float, and shadow maps by
/// parts.
#include <string>

#include "accuracy/accuracy.hpp"
#include "accuracy/visibility_frames.hpp"
#include "accuracy/visibility_layers.hpp"
#include "accuracy/visibility_planes.hpp"
#include "common/app/memory.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

void add_scenes() {
    for (const auto& [name, assets] : scenes()) {
        const lesson_12::Options of_12;
        const lesson_13::Options of_13;
        const Drawn forward = counted(of_12, *assets);
        const double times =
            shadings_per_pixel(forward) / shadings_per_pixel(counted(of_13, *assets));
        const auto add = [&](const std::string& lesson, const auto& options) {
            add_frames("scenes", name + ": " + lesson, frames_in_millions, options, assets,
                       forward.picture, {{"s", times}});
        };
        add("11", of_12), add("12", of_13);
    }
}

/// By how many triangles of a tile can be told apart.
void add_ids(const std::string& comparison, lesson_13::Options options,
             const lesson_12::Options& of_12, const Assets& assets) {
    const Image<vec3> reference = frame(of_12, *assets);
    const auto add = [&](const std::string& name, const auto& of_lesson) {
        add_frames(comparison, name, frames_in_millions, of_lesson, assets, reference);
    };
    for (const int max_ids : {1, 15, 255, 65'535}) {
        options.visibility.max_ids = max_ids;
        add(std::to_string(max_ids), options);
    }
    options.visibility.max_ids = lesson_13::Options().visibility.max_ids;
    add("no limit", options);
    add("lesson 12", of_12);
}

void add_shadow_parts(const std::string& name, const Assets& assets) {
    const lesson_12::Options of_12;
    const Drawn forward = counted(of_12, *assets);
    const int size = of_12.shadow.size;
    const auto maps = static_cast<double>(forward.count(Counter::shadow_passes));
    for (const int part : {32, 64, 128, 256, 512, size}) {
        lesson_13::Options of_13;
        of_13.visibility.shadow_part = part;
        const auto parts =
            static_cast<double>(counted(of_13, *assets).count(Counter::shadow_parts));
        add_frames("parts", std::to_string(part) + ": " + name, frames_in_millions, of_13, assets,
                   forward.picture,
                   {{"texels, %", 100 * parts * part * part / (maps * size * size)}});
    }
}

}  // namespace

int main(int argc, char** argv) {
    keep_freed_memory();
    add_scenes();
    add_layers("flat", LayerLook::flat);
    add_layers("shadowed", LayerLook::shadow);
    for (const LayerLook look :
         {LayerLook::flat, LayerLook::textured, LayerLook::phong, LayerLook::shadow})
        add_break_even(look);
    add_triangles("flat", LayerLook::flat, 1);
    add_triangles("four layers", LayerLook::shadow, 4);
    add_ids("ids-bumpy", lesson_13::Options(), lesson_12::Options(), scenes()[2].assets);
    const Layers small{{128, 128}, 16, {2, 1}, LayerOrder::random, 0, LayerLook::shadow};
    add_ids("ids-small", options_of<lesson_13::Options>(small),
            options_of<lesson_12::Options>(small), assets_of(small));
    add_planes();
    for (const std::size_t scene : {1u, 2u, 3u})
        add_shadow_parts(scenes()[scene].name, scenes()[scene].assets);
    return measure_variants(argc, argv);
}
