// SPDX-License-Identifier: MIT
/// @file
/// How fast a lesson draws a scene beside OpenGL on the same processor: Mesa's llvmpipe, without a
/// window. First the pictures are compared; then both draw by turns.
///
/// What is timed: the lesson's render(), which makes linear floats, shadow maps included; and
/// OpenGL's frame from its shadow maps to glFinish(). OpenGL has everything uploaded and compiled.
/// By default it stores textures and its picture as linear floats, too, so that both do the same
/// work; --gl-numbers bytes has it store them as most programs do, with a quarter of the memory to
/// read. Neither encodes floats for the screen. The lesson pushes its outlines anew in each frame;
/// OpenGL is given them pushed.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <malloc.h>
#include <sched.h>

#include <CLI/CLI.hpp>

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include "11_scenes/scene_camera.hpp"
#include "benchmarks/beside_opengl.hpp"
#include "common/app/memory.hpp"
#include "common/image/image_io.hpp"
#include "common/math/color.hpp"
#include "common/model/model_file.hpp"
#include "support/opengl.hpp"

using namespace rasterbook;

namespace {

struct Arguments {
    int lesson = 13, frames = 21;
    SceneRendererOptions options;
    GlOptions gl;
    std::vector<std::string> scenes;
    std::string save;  ///< A folder for the pictures; empty: none are written.
};

Arguments parsed(int argc, char** argv) {
    Arguments arguments;
    SceneRendererOptions& options = arguments.options;
    options.size = {1920, 1080}, options.threads.threads = 1;
    CLI::App app{"Draws scenes by a lesson and by OpenGL on llvmpipe, and compares speed."};
    std::string known = "Of these, or model files; all of these if none is named:";
    for (const BenchmarkScene& scene : benchmark_scenes()) {
        arguments.scenes.push_back(scene.name);
        known += "\n" + scene.name + ": " + scene.what;
    }
    app.add_option("scenes", arguments.scenes, known);
    app.add_option("--lesson", arguments.lesson)->check(CLI::IsMember({11, 12, 13}));
    app.add_option("--frames", arguments.frames, "Timed frames of each")
        ->check(CLI::Range(1, 10000));
    app.add_option("--threads", options.threads.threads, "With 1, all is pinned to one core")
        ->check(CLI::Range(1, 256));
    app.add_option("--width", options.size.x)->check(CLI::Range(1, 16384));
    app.add_option("--height", options.size.y)->check(CLI::Range(1, 16384));
    app.add_option("--shadow-size", options.shadow.size)->check(CLI::Range(16, 8192));
    app.add_option("--filter", options.texture.filter)
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, Filter>{{"nearest", Filter::nearest},
                                          {"bilinear", Filter::bilinear},
                                          {"trilinear", Filter::trilinear}}));
    app.add_option("--gl-numbers", arguments.gl.numbers, "What OpenGL's textures and picture hold")
        ->transform(CLI::CheckedTransformer(std::map<std::string, GlNumbers>{
            {"floats", GlNumbers::floats}, {"bytes", GlNumbers::bytes}}));
    app.add_flag("--gl-depth-first", arguments.gl.depth_first,
                 "OpenGL draws all depths before it shades anything");
    app.add_option("--save", arguments.save, "A folder for the pictures that are compared");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) { std::exit(app.exit(error)); }
    return arguments;
}

/// A frame takes the memory of the frame before, as OpenGL keeps its own. Else blocks beyond 32 MB,
/// a picture of 2560 x 1440 among them, go back to the system after each frame, and getting them
/// again by page faults takes longer than to draw a simple picture.
void keep_all_memory() {
    keep_freed_memory();
    mallopt(M_MMAP_MAX, 0);
}

/// To be called before OpenGL's context is made: llvmpipe starts its threads then.
void set_threads(int threads) {
    // With 0, llvmpipe starts none: the thread that calls glFinish() draws.
    setenv("LP_NUM_THREADS", std::to_string(threads == 1 ? 0 : threads).c_str(), 1);
    if (threads > 1) return;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(sched_getcpu()), &one);
    if (sched_setaffinity(0, sizeof one, &one) != 0)
        throw std::runtime_error("the program cannot be pinned to one core");
}

double ms_of(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Of one frame, in milliseconds.
struct Times {
    double wall, process, caller;  ///< By the clock; of the processor by all threads, by this one.
};

Times timed(const std::function<void()>& draw) {
    const Times start{ms_of(CLOCK_MONOTONIC), ms_of(CLOCK_PROCESS_CPUTIME_ID),
                      ms_of(CLOCK_THREAD_CPUTIME_ID)};
    draw();
    return {ms_of(CLOCK_MONOTONIC) - start.wall, ms_of(CLOCK_PROCESS_CPUTIME_ID) - start.process,
            ms_of(CLOCK_THREAD_CPUTIME_ID) - start.caller};
}

/// That llvmpipe has no other thread at work.
///
/// @throws std::runtime_error  It has.
void check_that_caller_draws(const GlScene& scene) {
    const Times times = timed([&] { scene.draw(); });
    if (times.caller < 0.98 * times.process)
        throw std::runtime_error("llvmpipe does not draw with one thread: other threads took " +
                                 std::to_string(times.process - times.caller) + " of " +
                                 std::to_string(times.process) + " ms");
}

struct PictureComparison {
    double rms;           ///< Of all sRGB-encoded values, 0 to 255.
    double share_beyond;  ///< Of pixels of which a value differs by more than 8.
};

PictureComparison compared(const Image<u8vec3>& a, const Image<u8vec3>& b) {
    double squares = 0, beyond = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
        const ivec3 difference = glm::abs(ivec3(a.pixels()[i]) - ivec3(b.pixels()[i]));
        squares += glm::dot(dvec3(difference), dvec3(difference));
        beyond += std::max({difference.x, difference.y, difference.z}) > 8;
    }
    const auto pixels = static_cast<double>(a.pixels().size());
    return {std::sqrt(squares / (3 * pixels)), beyond / pixels};
}

/// Median and quartiles.
struct Quartiles {
    double low, median, high;

    explicit Quartiles(std::vector<double> numbers) {
        std::ranges::sort(numbers);
        const auto at = [&](double share) {
            const double place = share * static_cast<double>(numbers.size() - 1);
            const auto i = static_cast<std::size_t>(place);
            const double next = numbers[std::min(i + 1, numbers.size() - 1)];
            return numbers[i] + (place - std::floor(place)) * (next - numbers[i]);
        };
        low = at(0.25), median = at(0.5), high = at(0.75);
    }
};

void print_cell(std::vector<double> numbers, int digits) {
    const Quartiles q(std::move(numbers));
    std::printf(" %.*f (%.*f-%.*f) |", digits, q.median, digits, q.low, digits, q.high);
}

/// Both by turns; who begins changes, too. A line of a table: for each of the two clocks the
/// lesson's time, OpenGL's, and the ratio of neighbours.
void print_times(const std::function<void()>& lesson, const std::function<void()>& gl, int frames) {
    std::vector<Times> ours, theirs;
    for (int i = 0; i < frames; ++i) {
        if (i % 2 == 1) theirs.push_back(timed(gl));
        ours.push_back(timed(lesson));
        if (i % 2 == 0) theirs.push_back(timed(gl));
    }
    for (double Times::* const clock : {&Times::wall, &Times::process}) {
        std::array<std::vector<double>, 3> columns;
        for (std::size_t i = 0; i < ours.size(); ++i) {
            columns[0].push_back(ours[i].*clock);
            columns[1].push_back(theirs[i].*clock);
            columns[2].push_back(ours[i].*clock / (theirs[i].*clock));
        }
        print_cell(columns[0], 1), print_cell(columns[1], 1), print_cell(columns[2], 2);
    }
    std::printf("\n");
}

Scene scene_named(const std::string& name) {
    for (const BenchmarkScene& scene : benchmark_scenes())
        if (scene.name == name) return scene.make();
    return load_model(name);
}

DrawFrame frame_of_lesson(int lesson, const SceneRendererOptions& options,
                          const SceneAssets& assets) {
    return lesson == 11   ? frame_of<11>(options, assets)
           : lesson == 12 ? frame_of<12>(options, assets)
                          : frame_of<13>(options, assets);
}

/// A line of the table.
///
/// @throws std::runtime_error  The pictures differ.
void compare(const std::string& name, const Arguments& arguments) {
    const SceneRendererOptions& options = arguments.options;
    const SceneAssets assets = make_scene_assets(scene_named(name), options);
    const Camera camera = camera_of_picture(options, assets.scene).camera;
    const DrawFrame lesson = frame_of_lesson(arguments.lesson, options, assets);
    const GlScene gl(assets, camera, options, arguments.gl);

    const Image<u8vec3> ours = srgb8_from_linear(lesson());
    gl.draw();  // the driver compiles
    if (options.threads.threads == 1) check_that_caller_draws(gl);
    const Image<u8vec3> theirs = gl.picture();
    const std::filesystem::path folder = arguments.save;
    const std::string stem = std::filesystem::path(name).stem().string();
    if (!folder.empty()) {
        write_image(folder / (stem + "_lesson.png"), ours);
        write_image(folder / (stem + "_opengl.png"), theirs);
    }
    const auto [rms, share_beyond] = compared(ours, theirs);
    std::printf("| %s | %.2f | %.2f %% |", stem.c_str(), rms, 100 * share_beyond);
    if (share_beyond > 0.02) {
        std::printf("\n");
        throw std::runtime_error(name +
                                 ": more than 2 % of the pixels differ by more than 8 of "
                                 "255; times of other pictures say nothing");
    }
    print_times([&] { lesson(); }, [&] { gl.draw(); }, arguments.frames);
    std::fflush(stdout);
}

std::string processor() {
    std::ifstream in("/proc/cpuinfo");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown processor";
}

std::string load_of_machine() {
    std::array<double, 3> load{};
    getloadavg(load.data(), 3);
    return std::to_string(load[0]).substr(0, 4) + " (1 min), " +
           std::to_string(load[1]).substr(0, 4) + " (5 min)";
}

void print_head(const Arguments& arguments) {
    const auto gl_string = [](GLenum name) {
        return reinterpret_cast<const char*>(glGetString(name));
    };
    const int threads = arguments.options.threads.threads;
    std::printf("%s; load before %s\nOpenGL: %s, %s\n", processor().c_str(),
                load_of_machine().c_str(), gl_string(GL_RENDERER), gl_string(GL_VERSION));
    std::printf("Lesson %d; %d x %d; %d thread(s)%s; OpenGL's %s%s; %d frames each.\n",
                arguments.lesson, arguments.options.size.x, arguments.options.size.y, threads,
                threads == 1 ? " on one core" : "",
                arguments.gl.numbers == GlNumbers::floats ? "floats" : "bytes",
                arguments.gl.depth_first ? ", depths first" : "", arguments.frames);
    std::printf(
        "Medians (quartiles), ms: by the clock, and of all threads' CPU time.\n\n"
        "| scene | RMS | pixels > 8 | lesson | OpenGL | lesson / OpenGL "
        "| lesson, CPU | OpenGL, CPU | lesson / OpenGL, CPU |\n"
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|\n");
}

/// @return  Whether all scenes were timed.
bool run(const Arguments& arguments) {
    keep_all_memory();
    set_threads(arguments.options.threads.threads);
    const test::OpenGl context;
    print_head(arguments);
    bool is_complete = true;
    const auto compare_or_say_why_not = [&](const std::string& name) {
        try {
            compare(name, arguments);
        } catch (const std::exception& error) {
            is_complete = false;
            std::fflush(stdout);
            std::fprintf(stderr, "error: %s\n", error.what());
        }
    };
    std::ranges::for_each(arguments.scenes, compare_or_say_why_not);
    std::printf("\nload after %s\n", load_of_machine().c_str());
    return is_complete;
}

}  // namespace

int main(int argc, char** argv) {
    const Arguments arguments = parsed(argc, argv);
    try {
        return run(arguments) ? 0 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 1;
    }
}
