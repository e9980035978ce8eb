// SPDX-License-Identifier: MIT
/// @file
/// Where lesson 13's time goes: what this machine can do at most, what the steps of a frame take,
/// and how the time grows with pixels, triangles and threads. roofline.py runs it, and writes
/// docs/roofline.md.
///
/// Each line that it writes is an object of JSON. Times of frames are the least of several: other
/// programs of the machine can only make a frame slower.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "10_threading/schedule.hpp"
#include "benchmarks/beside_opengl.hpp"
#include "benchmarks/roofline.hpp"
#include "common/app/memory.hpp"
#include "support/lesson_13.hpp"
#include "support/pictures.hpp"
#include "support/pretend_pool.hpp"

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

/// As many frames as fit into this time, within bounds.
struct Repetitions {
    int least = 1, most = 25;
    double ms = 500;
};

constexpr double slow_frame_ms = 2000;  ///< Frames that take longer are drawn once.

/// Calls frame(), which returns its milliseconds, again and again.
///
/// @return  The least of them.
template <typename Frame>
double least_ms(const Repetitions& repetitions, Frame&& frame) {
    double least = std::numeric_limits<double>::infinity(), sum = 0;
    for (int i = 0; i < repetitions.most && (i < repetitions.least || sum < repetitions.ms); ++i) {
        const double ms = frame();
        least = std::min(least, ms), sum += ms;
    }
    return least;
}

/// @throws std::runtime_error  So much memory is not free.
void ask_for_memory(double bytes, const std::string& what) {
    std::ifstream in("/proc/meminfo");
    for (std::string name, unit; in >> name;) {
        double kilobytes = 0;
        if (!(in >> kilobytes) || !std::getline(in, unit)) return;
        if (name != "MemAvailable:") continue;
        if (1024 * kilobytes < bytes)
            throw std::runtime_error(what + ": " + std::to_string(bytes / 1e9).substr(0, 4) +
                                     " GB of memory are needed, and " +
                                     std::to_string(1024 * kilobytes / 1e9).substr(0, 4) +
                                     " GB are free");
        return;
    }
}

SceneAssets assets_of(Scene scene, const SceneRendererOptions& options) {
    return make_scene_assets(std::move(scene), options);
}

lesson_13::Options options_of_size(ivec2 size) {
    lesson_13::Options options;
    options.size = size;
    options.threads.threads = 1;
    return options;
}

struct FrameTime {
    double wall, cpu;  ///< Milliseconds.

    void take_least(const FrameTime& other) {
        wall = std::min(wall, other.wall), cpu = std::min(cpu, other.cpu);
    }
};

FrameTime frame_time(const lesson_13::Options& options, const SceneAssets& assets, Workers& pool) {
    StepClock clock;
    const auto start = Clock::now();
    const double start_cpu = cpu_ms();
    const Image<vec3> picture = lesson_13::render(options, assets, pool, clock);
    return {ms_between(start, Clock::now()), cpu_ms() - start_cpu};
}

/// Milliseconds of a frame's parts; those of tiles, of each tile.
struct Parts {
    double casters = 0, outlines = 0, triangles = 0;
    std::vector<double> ids{}, shading{}, shading_again{}, rest{};

    static constexpr auto of_tiles = {&Parts::ids, &Parts::shading, &Parts::shading_again,
                                      &Parts::rest};

    /// Of each part the less.
    void take_least(const Parts& other) {
        casters = std::min(casters, other.casters);
        outlines = std::min(outlines, other.outlines);
        triangles = std::min(triangles, other.triangles);
        for (const auto member : of_tiles)
            std::ranges::transform(this->*member, other.*member, (this->*member).begin(),
                                   [](double a, double b) { return std::min(a, b); });
    }
};

/// The lesson's render() on one thread, with a clock between the two steps of a tile.
///
/// @param again  Whether the tiles are drawn once more, when all parts of shadow maps are there.
Image<vec3> render_in_parts(const lesson_13::Options& options, const SceneAssets& assets,
                            ThreadPool& pool, Parts& parts, bool again = true) {
    const auto& [scene, textures, normal_maps, bounds, lit_by, plan, hulls, is_on_paper] = assets;
    const Camera camera = camera_of_picture(options, scene).camera;
    const mat4 clip_from_world = camera.clip_from_world(options.size);
    const WideDrawing wide = drawing_of_width(options.wide.width);
    const double start = cpu_ms();
    const ShadowMapsOnDemand shadow_maps(pool, options.visibility.shadow_part, options, assets,
                                         wide.project_triangles);
    Image<vec3> color(options.size, unset);
    DepthBuffer depth(options.size, unset);
    VisibilityBuffer visible(options.visibility.most_ids(), TileDepths::padding);
    HeatMap heat(options.visibility.show, options.size);

    const double start_of_outlines = cpu_ms();
    const std::vector<Mesh> outlines = outlines_of(assets, camera);
    const std::vector<const Mesh*> meshes = seen_meshes(scene, outlines, clip_from_world);
    const double start_of_triangles = cpu_ms();
    const Tiling tiling = options.threads.tiling_of(options.size, pool.size());
    const BinnedPasses passes =
        bin_passes(pool, assets, meshes, clip_from_world, tiling, wide.project_triangles);
    parts.casters = start_of_outlines - start;
    parts.outlines = start_of_triangles - start_of_outlines;
    parts.triangles = cpu_ms() - start_of_triangles;

    const Frame frame = make_frame(options, assets, camera, shadow_maps, color, depth);
    const auto draw = [&](std::size_t i, std::vector<double>& ids, std::vector<double>& shading,
                          std::vector<double>& rest) {
        const auto start_of_ids = Clock::now();
        const Tile tile = tiling[i];
        TileDepths depths(tile);
        visible.begin(tile);
        for (const BinnedTriangles& pass : passes.opaque)
            pass.for_each_in(i, [&](const ProjectedTriangle& projected) {
                wide.draw_id(frame, projected, tile, depths, visible);
            });
        const auto start_of_shading = Clock::now();
        wide.shade_visible(frame, visible, options.visibility.show, heat);
        const auto start_of_rest = Clock::now();
        draw_background(color, tile, depths, is_on_paper);
        TransparentFragments transparent;
        for_each_part(tile, count_in(passes.blended, i), [&](const Tile& part) {
            for (const BinnedTriangles& pass : passes.blended)
                pass.for_each_in(i, [&](const ProjectedTriangle& projected) {
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
    if (!again) return color;
    const Uncounted once_more;
    std::vector<double> others;
    pool.run(tiling.count(),
             [&](std::size_t i, std::size_t) { draw(i, others, parts.shading_again, others); });
    return color;
}

constexpr ivec2 usual_size(1280, 720);

/// What the steps of a frame take.
void measure_passes(const Repetitions& repetitions) {
    ThreadPool one(1);
    for (const char* const name : {"unlit.glb", "textured.gltf", "bumpy.glb", "toon.glb"}) {
        const lesson_13::Options options = options_of_size(usual_size);
        const SceneAssets assets = assets_of(loaded(name), options);
        const Drawn expected = drawn(options, assets, [&](const auto&... of) {
            StepClock clock;
            return lesson_13::render(of..., one, clock);
        });
        Parts least;
        const Drawn in_parts = drawn(
            options, assets, [&](const auto&... of) { return render_in_parts(of..., one, least); });
        if (!are_the_same_bits(expected.picture, in_parts.picture) ||
            expected.counters != in_parts.counters)
            throw std::runtime_error(std::string(name) +
                                     ": lesson 13's render() draws another picture, or counts "
                                     "another work, than its copy in roofline.cpp");
        for (int i = 0; i < repetitions.most; ++i) {
            Parts parts;
            render_in_parts(options, assets, one, parts);
            least.take_least(parts);
        }
        const double frame =
            least_ms(repetitions, [&] { return frame_time(options, assets, one).cpu; });
        const auto sum = [](const std::vector<double>& ms) {
            return std::accumulate(ms.begin(), ms.end(), 0.0);
        };
        const auto count = [&](Counter counter) {
            return static_cast<double>(expected.count(counter));
        };
        std::printf(
            R"({"scene": "%s", "frame": %.6g, "casters": %.6g, "outlines": %.6g, "triangles": %.6g, "ids": %.6g, )"
            R"("shading": %.6g, "shading again": %.6g, "rest": %.6g, "tested": %.0f, )"
            R"("shaded": %.0f, "shadow fragments": %.0f, "samples": %.0f})"
            "\n",
            name, frame, least.casters, least.outlines, least.triangles, sum(least.ids),
            sum(least.shading), sum(least.shading_again), sum(least.rest),
            count(Counter::fragments_tested), count(Counter::fragments_shaded),
            count(Counter::shadow_fragments),
            count(Counter::texture_samples) + count(Counter::normal_map_samples));
        std::fflush(stdout);
    }
}

/// The least times of lessons 11 to 13.
///
/// @param of  What changes: "size" or "triangles"; `at` says how much of it.
void measure_lessons(const char* of, const std::string& name, double at,
                     const lesson_13::Options& options, const SceneAssets& assets,
                     const Repetitions& repetitions) {
    const auto by = [&](const DrawFrame& draw) {
        const auto frame = [&] {
            const double start = cpu_ms();
            draw();
            return cpu_ms() - start;
        };
        const double first = frame();  // fills the caches, and gets the memory
        return first > slow_frame_ms ? first : least_ms(repetitions, frame);
    };
    const double ms_11 = by(frame_of<11>(options, assets));
    const double ms_12 = by(frame_of<12>(options, assets));
    const double ms_13 = by(frame_of<13>(options, assets));
    std::printf(
        R"({"scaling": "%s", "scene": "%s", "at": %.0f, "11": %.6g, "12": %.6g, "13": %.6g})"
        "\n",
        of, name.c_str(), at, ms_11, ms_12, ms_13);
    std::fflush(stdout);
}

void measure_sizes(const Repetitions& repetitions) {
    constexpr double bytes_per_pixel = 64;  // colour, depth, and what is kept of other frames
    for (const char* const name : {"bumpy.glb", "toon.glb"})
        for (const ivec2 size : {ivec2(854, 480), ivec2(1280, 720), ivec2(1920, 1080),
                                 ivec2(3840, 2160), ivec2(7680, 4320)}) {
            const double pixels = 1.0 * size.x * size.y;
            ask_for_memory(bytes_per_pixel * pixels,
                           std::to_string(size.x) + " x " + std::to_string(size.y) + " pixels");
            const lesson_13::Options options = options_of_size(size);
            measure_lessons("size", name, pixels, options, assets_of(loaded(name), options),
                            repetitions);
        }
}

void measure_triangles(const Repetitions& repetitions) {
    constexpr double bytes_per_triangle = 450;  // the mesh, and what is projected and binned
    ThreadPool one(1);
    for (const int side : {22, 71, 224, 707, 2236}) {
        const double count = 2.0 * side * side;
        ask_for_memory(bytes_per_triangle * count + 5e8,
                       std::to_string(2 * side * side) + " triangles");
        const lesson_13::Options options = options_of_size(usual_size);
        const SceneAssets assets = assets_of(hills_of(side), options);
        measure_lessons("triangles", "hills", count, options, assets, repetitions);
        Parts parts;
        const auto draw = [&](Parts& of_frame) {
            const double start = cpu_ms();
            render_in_parts(options, assets, one, of_frame, false);
            return cpu_ms() - start;
        };
        const double first = draw(parts);
        const double frame = first > slow_frame_ms ? first : least_ms(repetitions, [&] {
            Parts of_frame;
            const double ms = draw(of_frame);
            parts.take_least(of_frame);
            return ms;
        });
        std::printf(R"({"steps": "hills", "at": %.0f, "casters": %.6g, "triangles": %.6g, )"
                    R"("picture": %.6g})"
                    "\n",
                    count, parts.casters, parts.triangles, frame - parts.casters - parts.triangles);
        std::fflush(stdout);
    }
}

/// One thread and two by the clock, by turns; sixteen foretold.
void measure_threads(const Repetitions& repetitions) {
    ThreadPool one(1), two(2);
    for (const char* const name : {"unlit.glb", "textured.gltf", "bumpy.glb", "toon.glb"}) {
        const lesson_13::Options options = options_of_size({1920, 1080});
        const SceneAssets assets = assets_of(loaded(name), options);
        FrameTime with_1 = frame_time(options, assets, one),
                  with_2 = frame_time(options, assets, two);
        double serial = std::numeric_limits<double>::infinity();
        std::vector<std::vector<double>> jobs;
        for (int i = 0; i < repetitions.most; ++i) {
            with_2.take_least(frame_time(options, assets, two));
            with_1.take_least(frame_time(options, assets, one));
            MeasuredPool measured(1);
            const double ms = frame_time(options, assets, measured).wall;
            serial = std::min(serial, ms - measured.in_jobs_ms);
            if (jobs.empty()) jobs = measured.jobs_ms;
            for (std::size_t job = 0; job < jobs.size(); ++job)
                std::ranges::transform(jobs[job], measured.jobs_ms[job], jobs[job].begin(),
                                       [](double a, double b) { return std::min(a, b); });
        }
        const auto by_schedule = [&](std::size_t workers) {
            double sum = serial;
            for (const auto& job : jobs) sum += schedule_of(job, workers).finish;
            return sum;
        };
        const double work = by_schedule(1), share = serial / work;
        std::printf(R"({"threads": "%s", "1": %.6g, "2": %.6g, "cpu 1": %.6g, "cpu 2": %.6g, )"
                    R"("serial": %.6g, "work": %.6g, "amdahl 2": %.6g, "amdahl 16": %.6g, )"
                    R"("schedule 2": %.6g, "schedule 16": %.6g})"
                    "\n",
                    name, with_1.wall, with_2.wall, with_1.cpu, with_2.cpu, serial, work,
                    work / amdahl_speedup(share, 2), work / amdahl_speedup(share, 16),
                    by_schedule(2), by_schedule(16));
        std::fflush(stdout);
    }
}

void keep_all_memory() {
    keep_freed_memory();
#ifdef __GLIBC__
    mallopt(M_MMAP_MAX, 0);  // also that of pictures beyond 32 MB
#endif
}

}  // namespace

/// @param argv  limits, passes, sizes, triangles, threads: only these; and --quick, with three
///              repetitions.
int main(int argc, char** argv) {
    std::vector<std::string_view> asked(argv + 1, argv + argc);
    const bool is_quick = std::erase(asked, "--quick") > 0;
    const Repetitions repetitions = is_quick ? Repetitions{1, 3, 100} : Repetitions{};
    const auto is_asked = [&](std::string_view part) {
        return asked.empty() || std::ranges::find(asked, part) != asked.end();
    };
    try {
        keep_all_memory();
        if (is_asked("limits")) measure_limits(is_quick ? 3 : 25);
        if (is_asked("passes")) measure_passes(repetitions);
        if (is_asked("threads")) measure_threads(repetitions);
        if (is_asked("sizes")) measure_sizes(repetitions);
        if (is_asked("triangles")) measure_triangles(repetitions);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 1;
    }
}
