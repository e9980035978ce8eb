// SPDX-License-Identifier: MIT
/// @file
/// Shading each pixel once against forward shading: by overdraw, by the cost of shading, by ids and
/// by the size of triangles. And barycentric coordinates found again in rounded numbers, and shadow
/// maps by parts.
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "accuracy/accuracy.hpp"
#include "accuracy/visibility_frames.hpp"
#include "accuracy/visibility_layers.hpp"
#include "accuracy/visibility_planes.hpp"
#include "common/app/memory.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

// Whole frames.

void add_scenes() {
    for (const auto& [name, assets] : scenes()) {
        const lesson_11::Options of_11;
        const lesson_12::Options of_12;
        lesson_11::Options large_tiles = of_11;
        large_tiles.threads.tile = of_12.threads.tile;
        lesson_12::Options small_tiles = of_12;
        small_tiles.threads.tile = of_11.threads.tile;
        const Drawn forward = counted(of_11, *assets);
        const double times =
            shadings_per_pixel(forward) / shadings_per_pixel(counted(of_12, *assets));
        const auto add = [&](const std::string& variant, const auto& options) {
            add_frames("scenes", name + ": " + variant, frames_in_millions, options, assets,
                       forward.picture, {{"s", times}});
        };
        add("11", of_11), add("12", of_12);
        add("11, tiles of 64", large_tiles), add("12, tiles of 32", small_tiles);
    }
}

// Ids.

/// The longest list of opaque triangles that a tile has.
std::size_t most_triangles(const lesson_12::Options& options, const SceneAssets& assets) {
    ThreadPool& pool = one_thread();
    const Camera camera = camera_of_picture(options, assets.scene).camera;
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    const std::vector<Mesh> outlines = outlines_of(assets, camera);
    const Tiling tiling = options.threads.tiling_of(options.size, pool.size());
    const BinnedPasses passes =
        bin_passes(pool, assets, seen_meshes(assets.scene, outlines, clip_from_world),
                   clip_from_world, tiling);
    std::size_t most = 0;
    for (std::size_t tile = 0; tile < tiling.count(); ++tile)
        most = std::max(most, count_in(passes.opaque, tile));
    return most;
}

/// @param kept_in  Bits of the type that holds an id.
double kib_of_a_tile(const lesson_12::Options& options, int kept_in) {
    return options.threads.tile * options.threads.tile * kept_in / (8 * 1024.0);
}

/// One value of an id says that there is no triangle.
void add_ids(const std::string& comparison, lesson_12::Options options,
             const lesson_11::Options& of_11, const Assets& assets) {
    const Image<vec3> reference = frame(of_11, *assets);
    const std::size_t longest = most_triangles(options, *assets);
    const auto add = [&](const std::string& name, int max_ids, int kept_in) {
        options.visibility.max_ids = max_ids;
        add_frames(comparison, name, frames_in_millions, options, assets, reference,
                   {{"bits", std::bit_width(std::min(longest, options.visibility.most_ids()))},
                    {"longest list", static_cast<double>(longest)},
                    {"kept in, bits", kept_in},
                    {"KiB a tile", kib_of_a_tile(options, kept_in)}});
    };
    for (const int max_ids : {1, 3, 7, 15, 63, 255}) add(std::to_string(max_ids), max_ids, 8);
    add("65535", 65'535, 16);
    add("16777215", 16'777'215, 24);
    add("no limit", lesson_12::Options().visibility.max_ids, 32);
    add_frames(comparison, "lesson 11", frames_in_millions, of_11, assets, reference,
               {{"bits", 0},
                {"longest list", static_cast<double>(longest)},
                {"kept in, bits", 0},
                {"KiB a tile", 0}});
}

// Parts of shadow maps.

void add_shadow_parts(const std::string& view, const Assets& assets,
                      const std::function<void(lesson_11::Options&)>& set) {
    constexpr double million = 1e6;
    lesson_11::Options of_11;
    set(of_11);
    const Drawn forward = counted(of_11, *assets);
    const int size = of_11.shadow.size;
    const double all_texels =
        static_cast<double>(forward.count(Counter::shadow_passes)) * size * size;
    const auto all_fragments = static_cast<double>(forward.count(Counter::shadow_fragments));
    const auto add = [&](const std::string& x, const auto& options, double parts, double texels,
                         double fragments) {
        add_frames("parts", x + ": " + view, frames_in_millions, options, assets, forward.picture,
                   {{"parts", parts},
                    {"texels, millions", texels / million},
                    {"texels, %", 100 * texels / all_texels},
                    {"fragments, millions", fragments / million},
                    {"fragments, %", 100 * fragments / all_fragments}});
    };
    for (const int part : {32, 64, 128, 256, 512, size}) {
        lesson_12::Options of_12;
        const ThreadOptions own = of_12.threads;
        static_cast<lesson_11::Options&>(of_12) = of_11;
        of_12.threads = own;
        of_12.visibility.shadow_part = part;
        const Drawn drawn = counted(of_12, *assets);
        const auto parts = static_cast<double>(drawn.count(Counter::shadow_parts));
        add(std::to_string(part), of_12, parts, parts * part * part,
            static_cast<double>(drawn.count(Counter::shadow_fragments)));
    }
    add("lesson 11", of_11, static_cast<double>(forward.count(Counter::shadow_passes)), all_texels,
        all_fragments);
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
    add_triangles("shadowed", LayerLook::shadow, 1);
    add_triangles("four layers", LayerLook::shadow, 4);
    add_ids("ids-bumpy", lesson_12::Options(), lesson_11::Options(), scenes()[2].assets);
    const Layers small{{128, 128}, 16, {2, 1}, LayerOrder::random, 0, LayerLook::shadow};
    add_ids("ids-small", options_of<lesson_12::Options>(small),
            options_of<lesson_11::Options>(small), assets_of(small));
    add_all_planes();
    const auto at_distance = [](float distance) {
        return [=](lesson_11::Options& options) { options.orbit.distance = distance; };
    };
    for (const std::size_t scene : {1u, 2u, 3u}) {
        const auto& [name, assets] = scenes()[scene];
        add_shadow_parts(name, assets, [](auto&) {});
        add_shadow_parts(name + ", near", assets, at_distance(0.4f));
    }
    add_shadow_parts("bumpy.glb, far", scenes()[2].assets, at_distance(10));
    return measure_variants(argc, argv);
}
