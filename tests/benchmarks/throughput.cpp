// SPDX-License-Identifier: MIT
/// @file
/// How fast the stages are, one thread: pixels, triangles and bytes per second.
///
/// The picture has the course's default size; the inputs are random but the same in each run.
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <span>
#include <vector>

#include <benchmark/benchmark.h>

#include "01_bresenham_lines/line.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/projection.hpp"
#include "05_textures/interpolation.hpp"
#include "06_phong/assets.hpp"
#include "06_phong/light_options.hpp"
#include "06_phong/phong.hpp"
#include "06_phong/studio_lights.hpp"
#include "06_phong/surface.hpp"
#include "common/app/counters.hpp"
#include "common/app/memory.hpp"
#include "common/model/obj.hpp"
#include "common/model/triangulate.hpp"

using namespace rasterbook;

namespace {

constexpr ivec2 picture_size(1280, 720);

benchmark::Counter per_second(double count) {
    return {count, benchmark::Counter::kIsIterationInvariantRate};
}

/// Lines of 700 to 1280 pixels, in any direction.
template <typename Pixel>
void long_lines(benchmark::State& state) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> x(0, picture_size.x - 1), y(0, picture_size.y - 1);
    std::vector<std::pair<ivec2, ivec2>> lines;
    double pixels = 0;
    while (lines.size() < 1000) {
        const ivec2 a(x(random), y(random)), b(x(random), y(random));
        const int steps = std::max(std::abs(a.x - b.x), std::abs(a.y - b.y));
        if (steps < 699) continue;
        lines.emplace_back(a, b);
        pixels += steps + 1;
    }
    Image<Pixel> picture(picture_size);
    for (auto _ : state)
        for (const auto& [a, b] : lines) {
            draw_line(a, b, picture_size, LineEnd::included,
                      [&](ivec2 pixel) { picture[pixel] = Pixel(1); });
            benchmark::ClobberMemory();
        }
    state.counters["pixels"] = per_second(pixels);
}

struct Vertices {
    vec3 a, b, c;
};

/// Triangles of about `area` pixels, counter-clockwise, anywhere in the picture.
std::vector<Vertices> random_triangles(std::size_t count, float area) {
    constexpr float third = 2.0944f, greatest_jitter = 0.3f;
    std::mt19937 random(1);
    const float radius = std::sqrt(area / 1.27f);
    std::uniform_real_distribution<float> x(radius, picture_size.x - radius);
    std::uniform_real_distribution<float> y(radius, picture_size.y - radius);
    std::uniform_real_distribution<float> jitter(-greatest_jitter, greatest_jitter), any(0, 1);
    std::vector<Vertices> triangles(count);
    for (Vertices& t : triangles) {
        const vec2 center(x(random), y(random));
        const float start_radians = 3 * third * any(random);
        const auto vertex = [&](float number) {
            const float around_radians = start_radians - number * third + jitter(random);
            return vec3(center + radius * vec2(std::cos(around_radians), std::sin(around_radians)),
                        any(random));
        };
        t = {vertex(0), vertex(1), vertex(2)};
    }
    return triangles;
}

/// Argument: the area of a triangle in pixels. Snapping, facing and set-up are included.
template <bool with_depth>
void triangles(benchmark::State& state) {
    const auto input = random_triangles(4000, static_cast<float>(state.range(0)));
    Image<vec3> color(picture_size);
    DepthBuffer depth(picture_size);
    double covered = 0;
    for (const Vertices& t : input)
        fill_triangle(snap_triangle(t.a, t.b, t.c), picture_size, [&](ivec2, vec3) { ++covered; });

    for (auto _ : state) {
        state.PauseTiming();
        if (with_depth) depth = DepthBuffer(picture_size);
        state.ResumeTiming();
        for (const Vertices& t : input) {
            const ScreenTriangle on_screen = snap_triangle(t.a, t.b, t.c);
            if (!is_front_facing(on_screen)) continue;
            const TriangleDepth triangle_depth(vec3(t.a.z, t.b.z, t.c.z));
            fill_triangle(on_screen, picture_size, [&](ivec2 pixel, vec3 barycentrics) {
                if (with_depth && !depth.test_and_write(pixel, triangle_depth.at(barycentrics)))
                    return;
                color[pixel] = t.a;
            });
        }
        benchmark::ClobberMemory();
    }
    state.counters["pixels"] = per_second(covered);
    state.counters["triangles"] = per_second(static_cast<double>(input.size()));
    state.counters["pixels_per_triangle"] = covered / static_cast<double>(input.size());
}

/// A hilly ground of 200,000 small triangles through the camera: transforming, clipping, facing,
/// set-up, filling, with depth.
void triangles_through_the_camera(benchmark::State& state) {
    constexpr int side = 317;  // 316 * 316 quads
    constexpr ivec2 size(1920, 1080);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> height(0, 0.02f);
    Scene scene;
    Mesh& ground = scene.meshes.emplace_back();
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            ground.positions.emplace_back(2.0f * static_cast<float>(x) / (side - 1) - 1,
                                          height(random),
                                          2.0f * static_cast<float>(y) / (side - 1) - 1);
            ground.bounds.add(ground.positions.back());
        }
    for (std::uint32_t i = 0; i < side * (side - 1); ++i) {
        if (i % side == side - 1) continue;
        const Vertex a{i}, b{i + side}, c{i + side + 1}, d{i + 1};
        ground.triangles.push_back({{a, b, c}, 0});
        ground.triangles.push_back({{a, c, d}, 0});
    }
    const Camera camera = orbit_camera({}, {vec3(-1, 0, -1), vec3(1, 0.02f, 1)});
    Image<vec3> color(size);
    DepthBuffer depth(size);
    for (auto _ : state) {
        state.PauseTiming();
        depth = DepthBuffer(size);
        state.ResumeTiming();
        for_each_visible_triangle(
            scene, camera.clip_from_world(size), size, Culling::back_faces,
            [&](const ProjectedTriangle& projected) {
                fill_triangle(projected.on_screen, size, [&](ivec2 pixel, Barycentrics at) {
                    if (depth.test_and_write(pixel, projected.depth.at(at)))
                        color[pixel] = projected.mesh.positions[0];
                });
            });
        benchmark::ClobberMemory();
    }
    state.counters["triangles"] = per_second(static_cast<double>(ground.triangles.size()));
}

/// What lessons 05 and 06 are told on the command line.
struct PictureKnobs {
    TextureOptions texture;
    LightOptions shading;
    Orbit orbit;
};

constexpr int large = 0, scene_obj = 1;  ///< What a picture of textured triangles shows.

/// Two triangles that reach beyond the picture's borders, with a texture about as fine as its
/// pixels; or the lessons' own scene, as they show it.
PhongAssets assets_to_draw(int what, PictureKnobs& knobs) {
    const std::filesystem::path models = RASTERBOOK_ASSETS "/models";
    if (what == scene_obj)
        return make_phong_assets(load_obj(models / "scene.obj"), knobs.texture, false);
    Scene scene;
    Material tiles;
    tiles.specular = vec3(0.2f), tiles.shininess = 60;
    tiles.diffuse_map.file = models / "../textures/tiles.png";
    tiles.diffuse_map.scale = vec3(12);  // a texel is about a pixel
    scene.materials.push_back(tiles);
    Mesh quad;
    quad.uvs = {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1)};
    for (const vec2 uv : quad.uvs) quad.positions.emplace_back(2 * uv.x - 1, 0, 1 - 2 * uv.y);
    for (const vec3 position : quad.positions) quad.bounds.add(position);
    const Vertex a{0, 0}, b{1, 1}, c{2, 2}, d{3, 3};
    quad.triangles = {{{a, b, c}, 0}, {{a, c, d}, 0}};
    scene.meshes.push_back(quad);
    knobs.orbit = {.pitch_degrees = 60, .distance = 0.35f};
    return make_phong_assets(scene, knobs.texture, false);
}

/// Textured fragments, or such lit by two lights, drawn as lessons 05 and 06 do. Arguments:
/// what is drawn, and the filter.
template <bool with_light>
void textured_and_lit(benchmark::State& state) {
    constexpr ivec2 size(1920, 1080);
    PictureKnobs knobs;
    knobs.texture.filter = state.range(1) ? Filter::trilinear : Filter::bilinear;
    const auto [scene, textures, effects] = assets_to_draw(static_cast<int>(state.range(0)), knobs);
    const Camera camera = orbit_camera(knobs.orbit, scene.bounds());
    const std::array lights = studio_lights(knobs.shading.key_light, scene.bounds());
    Image<vec3> color(size);
    DepthBuffer depth(size);

    const auto draw = [&] {
        const auto draw_triangle = [&](const ProjectedTriangle& projected) {
            const TriangleSurface surface =
                triangle_surface(scene, textures, effects[projected.triangle.material], projected);
            const PerspectiveSetup setup =
                perspective_setup(projected.on_screen, projected.clipped);
            const PhongHighlight highlight = highlight_of(surface);
            fill_triangle(projected.on_screen, size, [&](ivec2 pixel, Barycentrics on_screen) {
                if (!depth.test_and_write(pixel, projected.depth.at(on_screen))) return;
                count(Counter::fragments_shaded);
                const FragmentBarycentrics at = perspective_correct(setup, on_screen);
                if (!with_light) {
                    color[pixel] = surface.own_color.diffuse;
                    if (surface.texture != nullptr)
                        color[pixel] *= vec3(sample(*surface.texture, knobs.texture.filter,
                                                    fragment_uv(surface.uvs, at)));
                    return;
                }
                const SurfaceColor own = surface_color(surface, at, knobs.texture.filter);
                const vec3 normal = interpolate(surface.normals_world, at.here);
                const SurfacePoint<float> point =
                    surface_point(surface, at.here, normal, camera.position_world);
                color[pixel] = phong(own, ambient_light, reflected_light(lights, point, highlight));
            });
        };
        for_each_visible_triangle(scene, camera.clip_from_world(size), size, Culling::back_faces,
                                  draw_triangle);
    };

    thread_counters = {};
    draw();
    const auto fragments = static_cast<double>(thread_counters[Counter::fragments_shaded]);
    for (auto _ : state) {
        state.PauseTiming();
        depth = DepthBuffer(size);
        state.ResumeTiming();
        draw();
        benchmark::ClobberMemory();
    }
    state.counters["fragments"] = per_second(fragments);
    state.counters["fragments_per_picture"] = fragments;
}

/// What is drawn, and how it is filtered.
void textured_and_lit_arguments(benchmark::internal::Benchmark* benchmark) {
    benchmark->ArgNames({"scene.obj", "trilinear"});
    for (const int what : {large, scene_obj})
        for (const Filter filter : {Filter::bilinear, Filter::trilinear})
            benchmark->Args({what, filter == Filter::trilinear});
    benchmark->Unit(benchmark::kMillisecond);
}

/// A comb: a polygon of which every second vertex is a dent. Argument: the number of its vertices.
void concave_polygon(benchmark::State& state) {
    std::vector<vec3> comb;
    for (int i = 0; i < state.range(0) - 2; ++i) comb.emplace_back(i, i % 2 == 0 ? 0 : -1e6f, 0);
    comb.emplace_back(state.range(0), 1, 0);
    comb.emplace_back(-1, 1, 0);
    for (auto _ : state) benchmark::DoNotOptimize(triangulate(comb));
    state.counters["vertices"] = per_second(static_cast<double>(comb.size()));
}

/// A height field of quads with uvs and normals, about 30 MB of text, from a warm cache.
void obj_file(benchmark::State& state) {
    constexpr int side = 500;
    const auto file = std::filesystem::temp_directory_path() /
                      ("rasterbook_" + std::to_string(getpid()) + ".obj");
    std::ofstream out(file);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(-1, 1);
    for (int i = 0; i < side * side; ++i)
        out << "v " << i % side << ' ' << any(random) << ' ' << i / side << "\nvt " << any(random)
            << ' ' << any(random) << "\nvn " << any(random) << ' ' << any(random) << ' '
            << any(random) << '\n';
    for (int y = 1; y < side; ++y)
        for (int x = 1; x < side; ++x) {
            out << 'f';
            for (const int i :
                 {(y - 1) * side + x, (y - 1) * side + x + 1, y * side + x + 1, y * side + x})
                out << ' ' << i << '/' << i << '/' << i;
            out << '\n';
        }
    out.close();
    for (auto _ : state) benchmark::DoNotOptimize(load_obj(file));
    state.counters["bytes"] = per_second(static_cast<double>(std::filesystem::file_size(file)));
    std::filesystem::remove(file);
}

}  // namespace

BENCHMARK_TEMPLATE(long_lines, u8vec4)
    ->Name("long_lines/4_bytes_a_pixel")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(long_lines, vec3)
    ->Name("long_lines/12_bytes_a_pixel")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(triangles, false)
    ->Name("flat_triangles")
    ->Arg(5000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(triangles, true)
    ->Name("depth_tested_triangles")
    ->Arg(5000)
    ->Arg(10)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(triangles_through_the_camera)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(textured_and_lit, false)
    ->Name("textured_triangles")
    ->Apply(textured_and_lit_arguments);
BENCHMARK_TEMPLATE(textured_and_lit, true)
    ->Name("phong_triangles")
    ->Apply(textured_and_lit_arguments);
BENCHMARK(concave_polygon)->Arg(10'000)->Arg(100'000)->Unit(benchmark::kMillisecond);
BENCHMARK(obj_file)->Unit(benchmark::kMillisecond);

// As the lessons' program does.
int main(int argc, char** argv) {
    keep_freed_memory();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
}
