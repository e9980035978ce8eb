// SPDX-License-Identifier: MIT
/// @file
/// Where lesson 14's time goes: what this machine can do at most, and what the steps of a frame
/// take. roofline.py runs it, and writes docs/roofline.md.
///
/// Each line that it writes is an object of JSON. Times of frames are the least of several: other
/// programs of the machine can only make a frame slower.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <exception>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "benchmarks/roofline.hpp"
#include "common/app/memory.hpp"
#include "support/lesson_14.hpp"
#include "support/pictures.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

using Clock = std::chrono::steady_clock;

/// Of the processor, by all threads: unlike time by the clock, it does not run on while other
/// programs have the core.
double cpu_ms() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

double ms_between(Clock::time_point start, Clock::time_point end) {
    return std::chrono::duration<double, std::milli>(end - start).count();
}

/// Milliseconds of a frame's parts; those of tiles, of each tile.
struct Parts {
    double casters = 0, triangles = 0;
    std::vector<double> ids{}, shading{}, shading_again{}, rest{};

    static constexpr auto of_tiles = {&Parts::ids, &Parts::shading, &Parts::shading_again,
                                      &Parts::rest};

    /// Of each part the less.
    void take_least(const Parts& other) {
        casters = std::min(casters, other.casters);
        triangles = std::min(triangles, other.triangles);
        for (const auto member : of_tiles)
            std::ranges::transform(this->*member, other.*member, (this->*member).begin(),
                                   [](double a, double b) { return std::min(a, b); });
    }
};

/// The lesson's render() on one thread, with a clock between the two steps of a tile.
///
/// The tiles are drawn once more, when all parts of shadow maps are there.
Image<vec3> render_in_parts(const lesson_14::Options& options, const PlannedScene& assets,
                            ThreadPool& pool, Parts& parts) {
    const Camera camera = camera_of_picture(options, assets.scene).camera;
    const WideDrawing wide = drawing_of_width(options.wide.width);
    const double start = cpu_ms();
    const ShadowMapsOnDemand shadow_maps(pool, options.visibility.shadow_part, options, assets,
                                         wide.project_triangles);
    Image<vec3> color(options.size, unset);
    DepthBuffer depth(options.size, unset);
    VisibilityBuffer visible(options.visibility.most_ids(), TileDepths::padding);
    HeatMap heat(options.visibility.show, options.size);

    const double start_of_triangles = cpu_ms();
    const Tiling tiling = options.threads.tiling_of(options.size, pool.size());
    const BinnedPasses triangles(pool, assets, camera, tiling, wide.project_triangles);
    parts.casters = start_of_triangles - start;
    parts.triangles = cpu_ms() - start_of_triangles;

    const Frame frame = make_frame(options, assets, camera, shadow_maps, color, depth);
    const auto draw = [&](std::size_t i, std::vector<double>& ids, std::vector<double>& shading,
                          std::vector<double>& rest) {
        const auto start_of_ids = Clock::now();
        const Tile tile = tiling[i];
        TileDepths depths(tile);
        visible.begin(tile);
        triangles.for_each_opaque_in(i, [&](const ProjectedTriangle& projected) {
            wide.draw_id(frame, projected, tile, depths, visible);
        });
        const auto start_of_shading = Clock::now();
        wide.shade_visible(frame, visible, options.visibility.show, heat);
        const auto start_of_rest = Clock::now();
        draw_background(color, tile, depths, assets.is_drawing);
        TransparentFragments transparent;
        for_each_part(tile, triangles.count_blended_in(i), [&](const Tile& part) {
            triangles.for_each_blended_in(i, [&](const ProjectedTriangle& projected) {
                wide.draw_transparent(frame, projected, part, depths, transparent, heat);
            });
            transparent.blend_over(color);
        });
        const auto end = Clock::now();
        ids.push_back(ms_between(start_of_ids, start_of_shading));
        shading.push_back(ms_between(start_of_shading, start_of_rest));
        rest.push_back(ms_between(start_of_rest, end));
    };
    pool.run(tiling.count(),
             [&](std::size_t i, std::size_t) { draw(i, parts.ids, parts.shading, parts.rest); });
    const Uncounted once_more;
    std::vector<double> others;
    pool.run(tiling.count(),
             [&](std::size_t i, std::size_t) { draw(i, others, parts.shading_again, others); });
    return color;
}

/// What the steps of a frame take.
void measure_passes(int repetitions) {
    ThreadPool one(1);
    for (const char* const name : {"unlit.glb", "textured.gltf", "bumpy.glb", "toon.glb"}) {
        const lesson_14::Options options;
        const PlannedScene assets = load_planned_scene(loaded(name), options);
        const Drawn expected = drawn(options, assets, [&](const auto&... of) {
            StepClock clock;
            return lesson_14::render(of..., one, clock);
        });
        Parts least;
        const Drawn in_parts = drawn(
            options, assets, [&](const auto&... of) { return render_in_parts(of..., one, least); });
        if (!are_the_same_bits(expected.picture, in_parts.picture) ||
            expected.counters != in_parts.counters)
            throw std::runtime_error(std::string(name) +
                                     ": lesson 14's render() draws another picture, or counts "
                                     "another work, than its copy in roofline.cpp");
        double frame = std::numeric_limits<double>::infinity();
        for (int i = 0; i < repetitions; ++i) {
            Parts parts;
            render_in_parts(options, assets, one, parts);
            least.take_least(parts);
            StepClock clock;
            const double start = cpu_ms();
            lesson_14::render(options, assets, one, clock);
            frame = std::min(frame, cpu_ms() - start);
        }
        const auto sum = [](const std::vector<double>& ms) {
            return std::accumulate(ms.begin(), ms.end(), 0.0);
        };
        const auto count = [&](Counter counter) {
            return static_cast<double>(expected.count(counter));
        };
        std::printf(
            R"({"scene": "%s", "frame": %.6g, "casters": %.6g, "triangles": %.6g, "ids": %.6g, )"
            R"("shading": %.6g, "shading again": %.6g, "rest": %.6g, "tested": %.0f, )"
            R"("shaded": %.0f, "shadow fragments": %.0f, "samples": %.0f})"
            "\n",
            name, frame, least.casters, least.triangles, sum(least.ids), sum(least.shading),
            sum(least.shading_again), sum(least.rest), count(Counter::fragments_tested),
            count(Counter::fragments_shaded), count(Counter::shadow_fragments),
            count(Counter::texture_samples) + count(Counter::normal_map_samples));
        std::fflush(stdout);
    }
}

}  // namespace

/// @param argv  --quick: three repetitions.
int main(int argc, char** argv) {
    const bool is_quick = argc > 1 && std::string_view(argv[1]) == "--quick";
    keep_freed_memory();
    const int repetitions = is_quick ? 3 : 25;
    try {
        measure_limits(repetitions);
        measure_passes(repetitions);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 1;
    }
}
