// SPDX-License-Identifier: MIT
/// @file
/// Ways to split a picture: what they cost on one thread, what they bring on two, and what the
/// times of their tiles predict for up to 128. And meshes passed by value.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "04_mvp/camera.hpp"
#include "04_mvp/projection.hpp"
#include "06_phong/normals.hpp"
#include "10_threading/schedule.hpp"
#include "10_threading/thread_options.hpp"
#include "10_threading/thread_pool.hpp"
#include "accuracy/accuracy.hpp"
#include "common/app/memory.hpp"
#include "support/lesson_10.hpp"
#include "support/pictures.hpp"
#include "support/pretend_pool.hpp"

using namespace rasterbook;
using namespace rasterbook::test;

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// What a time is when nothing else on the machine makes it longer.
double least_of(const std::vector<double>& times) {
    return *std::min_element(times.begin(), times.end());
}

lesson_10::Options options_of(Split split, int tile) {
    lesson_10::Options options;
    options.size = {1920, 1080};
    options.threads.split = split, options.threads.tile = tile;
    return options;
}

const ShadowAssets& assets() {
    static const ShadowAssets made =
        lesson_10::make_assets(loaded("scene_bumpy.obj"), lesson_10::Options());
    return made;
}

double frame_ms(const lesson_10::Options& options, Workers& pool) {
    const auto start = Clock::now();
    const Image<vec3> picture = lesson_10::render(options, assets(), pool);
    return ms_since(start);
}

/// What a frame is made of, measured on one thread.
struct Frame {
    double serial_ms;  ///< Between jobs.
    std::vector<std::vector<double>> jobs_ms;

    double work_ms() const {
        double sum = serial_ms;
        for (const auto& job : jobs_ms) sum = std::accumulate(job.begin(), job.end(), sum);
        return sum;
    }
    double predicted_ms(std::size_t workers) const {
        double sum = serial_ms;
        for (const auto& job : jobs_ms) sum += schedule_of(job, workers).finish;
        return sum;
    }
};

/// The least of several frames, split for so many workers.
Frame measured_frame(const lesson_10::Options& options, std::size_t workers) {
    constexpr std::size_t frames = 9;
    std::vector<MeasuredPool> pools;
    std::vector<double> serial_ms;
    frame_ms(options, pools.emplace_back(workers));  // fills the caches
    pools.clear();
    for (std::size_t i = 0; i < frames; ++i) {
        pools.emplace_back(workers);
        const double ms = frame_ms(options, pools.back());
        serial_ms.push_back(ms - pools.back().in_jobs_ms);
    }
    Frame frame{least_of(serial_ms), pools[0].jobs_ms};
    for (std::size_t job = 0; job < frame.jobs_ms.size(); ++job)
        for (std::size_t task = 0; task < frame.jobs_ms[job].size(); ++task) {
            std::vector<double> times;
            for (const MeasuredPool& pool : pools) times.push_back(pool.jobs_ms[job][task]);
            frame.jobs_ms[job][task] = least_of(times);
        }
    return frame;
}

constexpr std::array<std::size_t, 7> worker_counts = {2, 4, 8, 16, 32, 64, 128};

void add_split(const std::string& name, Split split, int tile) {
    const lesson_10::Options options = options_of(split, tile);
    Errors errors;
    std::optional<Frame> tiles;  // rows are made anew for each number of workers
    double idle_of_16 = 0;
    for (const std::size_t workers : worker_counts) {
        if (!tiles || split != Split::tiles) tiles = measured_frame(options, workers);
        const double ms = tiles->predicted_ms(workers);
        errors["on " + std::to_string(workers) + ", ms"] = ms;
        if (workers != 16) continue;
        const std::vector<double>& drawing = tiles->jobs_ms.back();
        errors["idle on 16, %"] = 100 * schedule_of(drawing, 16).idle_share();
        idle_of_16 = 100 * (1 - tiles->work_ms() / (16 * ms));
        errors["idle on 16 in the whole frame, %"] = idle_of_16;
        errors["longest of its work, %"] =
            100 * schedule_of(drawing, 16).longest / schedule_of(drawing, 16).work;
        errors["serial, ms"] = tiles->serial_ms;
    }
    // By the clock, one and two threads by turns.
    ThreadPool one(1), two(2);
    std::vector<double> of_one, of_two;
    for (int i = 0; i < 25; ++i) {
        of_one.push_back(frame_ms(options, one));
        of_two.push_back(frame_ms(options, two));
    }
    errors["two threads, ms"] = least_of(of_two);
    errors["two against one"] = least_of(of_one) / least_of(of_two);
    add_variant("split", name, 1e6, errors, [=] {
        MeasuredPool pool(16);
        frame_ms(options, pool);
    });
}

/// What is done with a mesh once it has been passed: its triangles are transformed and those that
/// face the eye are counted.
std::size_t front_faces(const Mesh& mesh, const mat4& clip_from_world) {
    const std::vector<vec4> positions_clip = transform(clip_from_world, mesh.positions);
    std::size_t count = 0;
    for (const Triangle& triangle : mesh.triangles)
        for (const ClippedTriangle& clipped : clip_triangle(vertices_of(triangle, positions_clip)))
            count += !project(mesh, triangle, clipped, {1920, 1080}).is_back_facing;
    return count;
}

[[gnu::noinline]] std::size_t front_faces_by_reference(const Mesh& mesh, const mat4& m) {
    return front_faces(mesh, m);
}

[[gnu::noinline]] std::size_t front_faces_by_value(Mesh mesh, const mat4& m) {
    return front_faces(mesh, m);
}

void add_meshes(const std::string& name, const std::string& model) {
    Scene with_normals = loaded(model);
    complete_normals(with_normals);
    const auto scene = std::make_shared<const Scene>(std::move(with_normals));
    const mat4 clip_from_world =
        orbit_camera(Orbit(), scene->bounds()).clip_from_world({1920, 1080});
    double triangles = 0, bytes = 0;
    for (const Mesh& mesh : scene->meshes) {
        triangles += static_cast<double>(mesh.triangles.size());
        bytes += static_cast<double>(
            mesh.positions.size() * sizeof(vec3) + mesh.normals.size() * sizeof(vec3) +
            mesh.uvs.size() * sizeof(dvec2) + mesh.vertices.size() * sizeof(Vertex) +
            mesh.faces.size() * sizeof(Face) + mesh.triangles.size() * sizeof(Triangle));
    }
    const auto add = [&](const std::string& how, double copied, auto function) {
        add_variant("meshes", name + ", " + how, triangles, {{"bytes copied a triangle", copied}},
                    [=] {
                        std::size_t count = 0;
                        for (const Mesh& mesh : scene->meshes)
                            count += function(mesh, clip_from_world);
                        [[maybe_unused]] volatile std::size_t sink = count;
                    });
    };
    add("by reference", 0,
        [](const Mesh& mesh, const mat4& m) { return front_faces_by_reference(mesh, m); });
    add("by value", bytes / triangles,
        [](const Mesh& mesh, const mat4& m) { return front_faces_by_value(mesh, m); });
}

}  // namespace

int main(int argc, char** argv) {
    keep_freed_memory();
    add_split("rows", Split::rows, 64);
    add_split("interleaved", Split::interleaved, 64);
    for (const int tile : {8, 16, 32, 64, 128, 256})
        add_split("tiles of " + std::to_string(tile), Split::tiles, tile);
    add_meshes("scene", "scene_bumpy.obj");
    add_meshes("teapot", "teapot.obj");
    return measure_variants(argc, argv);
}
