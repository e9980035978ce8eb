// SPDX-License-Identifier: MIT
/// @file
/// How fast the stages are, one thread: pixels and triangles per second.
///
/// Its picture is 1920x1080; the inputs are random but the same in each run.
#include <cmath>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "01_bresenham_lines/line.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"

using namespace rasterbook;

namespace {

constexpr ivec2 picture_size(1920, 1080);

struct Corners {
    vec3 a, b, c;
};

/// Triangles of about `area` pixels, counter-clockwise, anywhere in the picture.
std::vector<Corners> random_triangles(std::size_t count, float area) {
    std::mt19937 random(1);
    const float radius = std::sqrt(area / 0.9f);
    std::uniform_real_distribution<float> x(radius, picture_size.x - radius),
        y(radius, picture_size.y - radius);
    std::uniform_real_distribution<float> jitter(-0.3f, 0.3f), depth(0.0f, 1.0f), turn(0.0f, 6.28f);
    std::vector<Corners> triangles(count);
    for (Corners& t : triangles) {
        const vec2 center(x(random), y(random));
        const float start = turn(random);
        const auto corner = [&](float third) {
            const float angle = start - third * 2.0944f + jitter(random);
            return vec3(center + radius * vec2(std::cos(angle), std::sin(angle)), depth(random));
        };
        t = {corner(0), corner(1), corner(2)};
    }
    return triangles;
}

void lines_of_1000_pixels(benchmark::State& state) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> x(0, picture_size.x - 1), y(0, picture_size.y - 1);
    std::vector<std::pair<ivec2, ivec2>> lines;
    while (lines.size() < 1000) {
        const ivec2 a(x(random), y(random)), b(x(random), y(random));
        if (std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)) >= 700) lines.emplace_back(a, b);
    }
    Image<vec3> color(picture_size);
    std::int64_t pixels = 0;
    for (auto _ : state)
        for (const auto& [a, b] : lines) {
            draw_line(a, b, picture_size, LineEnd::included, [&](ivec2 pixel) { color[pixel] = vec3(1.0f); });
            pixels += std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)) + 1;
            benchmark::ClobberMemory();
        }
    state.counters["pixels/s"] =
        benchmark::Counter(static_cast<double>(pixels), benchmark::Counter::kIsRate);
}

template <bool with_depth>
void triangles(benchmark::State& state) {
    const auto input = random_triangles(4000, static_cast<float>(state.range(0)));
    Image<vec3> color(picture_size);
    DepthBuffer depth(picture_size);
    std::int64_t covered = 0;
    for (const Corners& t : input)
        fill_triangle(snap_triangle(t.a, t.b, t.c), picture_size, [&](ivec2, vec3) { ++covered; });

    for (auto _ : state) {
        state.PauseTiming();
        if (with_depth) depth = DepthBuffer(picture_size);
        state.ResumeTiming();
        for (const Corners& t : input) {
            const ScreenTriangle on_screen = snap_triangle(t.a, t.b, t.c);
            if (!is_front_facing(on_screen)) continue;
            const TriangleDepth triangle_depth(vec3(t.a.z, t.b.z, t.c.z));
            fill_triangle(on_screen, picture_size, [&](ivec2 pixel, vec3 weights) {
                if (with_depth && !depth.test_and_write(pixel, triangle_depth.at(weights))) return;
                color[pixel] = t.a;
            });
        }
        benchmark::ClobberMemory();
    }
    const auto runs = static_cast<double>(state.iterations());
    state.counters["pixels/s"] =
        benchmark::Counter(runs * static_cast<double>(covered), benchmark::Counter::kIsRate);
    state.counters["triangles/s"] =
        benchmark::Counter(runs * static_cast<double>(input.size()), benchmark::Counter::kIsRate);
    state.counters["pixels/triangle"] =
        static_cast<double>(covered) / static_cast<double>(input.size());
}

}  // namespace

BENCHMARK(lines_of_1000_pixels)->Unit(benchmark::kMillisecond);
BENCHMARK(triangles<false>)
    ->Name("flat_triangles_of_area")
    ->Arg(5000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(triangles<true>)
    ->Name("depth_tested_triangles_of_area")
    ->Arg(5000)
    ->Arg(10)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_MAIN();
