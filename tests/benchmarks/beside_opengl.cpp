// SPDX-License-Identifier: MIT
/// @file
/// How fast lesson 14 draws a scene beside OpenGL on the same processor: Mesa's llvmpipe, without a
/// window. First the pictures are compared; then both draw by turns, on one thread.
///
/// What is timed: the lesson's render(), which makes linear floats, shadow maps included; and
/// OpenGL's frame from its shadow maps to glFinish(). OpenGL has everything uploaded and compiled.
/// By default it stores textures and its picture as linear floats, too, so that both do the same
/// work; --gl-numbers bytes has it store them as most programs do, with a quarter of the memory to
/// read. Neither encodes floats for the screen. The lesson pushes its outlines anew in each frame;
/// OpenGL is given them pushed.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <malloc.h>
#include <sched.h>

#include <CLI/CLI.hpp>

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include "11_scenes/camera_choice.hpp"
#include "benchmarks/beside_opengl.hpp"
#include "common/app/memory.hpp"
#include "common/math/color.hpp"
#include "support/opengl.hpp"

using namespace rasterbook;

namespace {

struct Arguments {
    int frames = 21;
    GlOptions gl;
    std::vector<std::string> scenes;  ///< Empty: all.
};

Arguments parsed(int argc, char** argv) {
    Arguments arguments;
    CLI::App app{"Draws scenes by lesson 14 and by OpenGL on llvmpipe, and compares speed."};
    std::string known = "Of these; all of them if none is named:";
    for (const BenchmarkScene& scene : benchmark_scenes())
        known += "\n" + scene.name + ": " + scene.what;
    app.add_option("scenes", arguments.scenes, known);
    app.add_option("--frames", arguments.frames, "Timed frames of each")
        ->check(CLI::Range(1, 10000));
    app.add_option("--gl-numbers", arguments.gl.numbers, "What OpenGL's textures and picture hold")
        ->transform(CLI::CheckedTransformer(std::map<std::string, GlNumbers>{
            {"floats", GlNumbers::floats}, {"bytes", GlNumbers::bytes}}));
    app.add_flag("--gl-depth-first", arguments.gl.depth_first,
                 "OpenGL draws all depths before it shades anything");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) { std::exit(app.exit(error)); }
    return arguments;
}

/// Both draw with one thread, on one core. To be called before OpenGL's context is made: llvmpipe
/// starts its threads then.
void use_one_core() {
    setenv("LP_NUM_THREADS", "0", 1);  // the thread that calls glFinish() draws
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(sched_getcpu()), &one);
    if (sched_setaffinity(0, sizeof one, &one) != 0)
        throw std::runtime_error("the program cannot be pinned to one core");
    // A frame takes the memory of the frame before, as OpenGL keeps its own. Else blocks beyond
    // 32 MB go back to the system, and getting them again by page faults takes longer than to draw
    // a simple picture.
    keep_freed_memory();
    mallopt(M_MMAP_MAX, 0);
}

/// Milliseconds of the processor, of all threads.
double ms_of(const std::function<void()>& draw) {
    const auto now = [] {
        timespec time{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
        return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
    };
    const double start = now();
    draw();
    return now() - start;
}

/// The share of pixels of which a value differs by more than 8 of 255.
double share_that_differs(const Image<u8vec3>& a, const Image<u8vec3>& b) {
    double beyond = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
        const ivec3 difference = glm::abs(ivec3(a.pixels()[i]) - ivec3(b.pixels()[i]));
        beyond += std::max({difference.x, difference.y, difference.z}) > 8;
    }
    return beyond / static_cast<double>(a.pixels().size());
}

/// A cell of a table: median and quartiles.
void print_cell(std::vector<double> numbers) {
    std::ranges::sort(numbers);
    const auto at = [&](double share) {
        return numbers[static_cast<std::size_t>(share * static_cast<double>(numbers.size() - 1))];
    };
    std::printf(" %.2f (%.2f-%.2f) |", at(0.5), at(0.25), at(0.75));
}

/// A line of the table: both by turns; who begins changes, too.
///
/// @throws std::runtime_error  The pictures differ.
void compare(const BenchmarkScene& scene, const Arguments& arguments) {
    EffectsOptions options;
    options.size = {1920, 1080}, options.threads.threads = 1;
    const PlannedScene assets = load_planned_scene(scene.make(), options);
    const Camera camera = camera_of_picture(options, assets.scene).camera;
    const DrawFrame lesson = frame_of<14>(options, assets);
    const GlScene gl(assets, camera, options, arguments.gl);

    gl.draw();  // the driver compiles
    const double share = share_that_differs(srgb8_from_linear(lesson()), gl.picture());
    if (share > 0.02)
        throw std::runtime_error(scene.name +
                                 ": more than 2 % of the pixels differ by more than "
                                 "8 of 255; times of other pictures say nothing");
    std::vector<double> ours, theirs, ratios;
    for (int i = 0; i < arguments.frames; ++i) {
        if (i % 2 == 1) theirs.push_back(ms_of([&] { gl.draw(); }));
        ours.push_back(ms_of([&] { lesson(); }));
        if (i % 2 == 0) theirs.push_back(ms_of([&] { gl.draw(); }));
        ratios.push_back(theirs.back() / ours.back());
    }
    std::printf("| %s | %.3f %% |", scene.name.c_str(), 100 * share);
    print_cell(ours), print_cell(theirs), print_cell(ratios);
    std::printf("\n");
    std::fflush(stdout);
}

/// @return  Whether all scenes were timed.
bool run(const Arguments& arguments) {
    use_one_core();
    const test::OpenGl context;
    std::printf("%s; %d frames of 1920 x 1080 each; medians (quartiles) of CPU time, ms.\n\n",
                reinterpret_cast<const char*>(glGetString(GL_RENDERER)), arguments.frames);
    std::printf(
        "| scene | pixels > 8 | lesson 14 | OpenGL | times as fast |\n"
        "|---|---:|---:|---:|---:|\n");
    bool is_complete = true;
    for (const BenchmarkScene& scene : benchmark_scenes()) {
        if (!arguments.scenes.empty() &&
            std::ranges::find(arguments.scenes, scene.name) == arguments.scenes.end())
            continue;
        try {
            compare(scene, arguments);
        } catch (const std::exception& error) {
            is_complete = false;
            std::fprintf(stderr, "error: %s\n", error.what());
        }
    }
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
