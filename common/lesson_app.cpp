// SPDX-License-Identifier: MIT
#include "common/lesson_app.hpp"

#include <unistd.h>

#include <charconv>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <new>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include <CLI/CLI.hpp>

#include "common/backdrop.hpp"
#include "common/image_io.hpp"
#include "common/input_error.hpp"
#include "common/math/color.hpp"
#include "common/memory.hpp"
#include "common/model_file.hpp"

namespace rasterbook {

namespace {

constexpr int greatest_side = 16384;

/// Reads "1280x720"; anything else is a usage error.
ivec2 parse_size(const std::string& text) {
    ivec2 size;
    const char* const end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, size.x);
    const bool has_cross = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
    const auto height = has_cross ? std::from_chars(width.ptr + 1, end, size.y) : width;
    const auto is_side = [](int side) { return side >= 1 && side <= greatest_side; };
    if (!has_cross || height.ec != std::errc() || height.ptr != end || !is_side(size.x) ||
        !is_side(size.y))
        throw CLI::ValidationError("--size", "'" + text +
                                                 "' is not WIDTHxHEIGHT with sides from 1 to " +
                                                 std::to_string(greatest_side));
    return size;
}

/// The model as named, or else the one of that name among the course's models.
std::filesystem::path find_model(const std::filesystem::path& name) {
    const std::filesystem::path own = std::filesystem::path(RASTERBOOK_ASSETS) / "models" / name;
    std::error_code ignored;
    for (const auto& candidate : {name, own})
        if (!name.empty() && std::filesystem::exists(candidate, ignored)) return candidate;
    throw InputError(name, "there is no such file; tried " +
                               std::filesystem::absolute(name).string() +
                               (own == name ? "" : " and " + own.string()));
}

double elapsed_ms(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

void print_stats(const LessonProgram& program, ivec2 size, const Counters& counters, double load_ms,
                 double render_ms, double write_ms) {
    std::ostringstream json;
    json << "{\"lesson\": \"" << program.name << "\", \"width\": " << size.x
         << ", \"height\": " << size.y;
    for (std::size_t i = 0; i < counter_names.size(); ++i)
        json << ", \"" << counter_names[i] << "\": " << counters.values[i];
    json << ", \"load_ms\": " << load_ms << ", \"render_ms\": " << render_ms
         << ", \"write_ms\": " << write_ms << "}\n";
    std::cout << json.str() << std::flush;
}

/// "turn_0007.png" for frame 7 of "turn_%04d.png"; other names stay as they are.
std::filesystem::path name_of_frame(const std::filesystem::path& pattern, int frame) {
    const std::string name = pattern.string();
    const auto begin = name.find('%'), end = name.find_first_not_of("0123456789", begin + 1);
    if (begin == name.npos || end == name.npos || name[end] != 'd') return pattern;
    std::string number = std::to_string(frame);
    const std::size_t digits = std::strtoul(name.c_str() + begin + 1, nullptr, 10);
    if (number.size() < digits) number.insert(0, digits - number.size(), '0');
    return name.substr(0, begin) + number + name.substr(end + 1);
}

void make_pictures(const LessonProgram& program) {
    LessonOptions& options = program.options;
    const auto load_start = std::chrono::steady_clock::now();
    const Scene& scene = program.prepare(load_model(find_model(options.model)));
    const double load_ms = elapsed_ms(load_start);
    for (const std::string& warning : scene.warnings) std::cerr << "warning: " << warning << '\n';

    Counters counters;
    double render_ms = 0, write_ms = 0;
    bool is_empty = true;
    const ivec2 size = options.size;
    options.size *= options.samples_per_side;
    const float first_yaw_degrees = program.orbit ? program.orbit->yaw_degrees : 0;
    for (int frame = 0; frame < options.frames; ++frame) {
        if (program.orbit)
            program.orbit->yaw_degrees = first_yaw_degrees + 360.0f * static_cast<float>(frame) /
                                                                 static_cast<float>(options.frames);
        const auto render_start = std::chrono::steady_clock::now();
        Image<vec3> rendered = program.render(options.stats ? &counters : nullptr);
        is_empty = is_empty && is_backdrop(rendered);
        const Image<vec3> picture = averaged(std::move(rendered), options.samples_per_side);
        render_ms += elapsed_ms(render_start);

        const std::filesystem::path file =
            options.frames > 1 ? name_of_frame(options.out, frame) : options.out;
        const auto write_start = std::chrono::steady_clock::now();
        write_image(file, srgb8_from_linear(picture));
        write_ms += elapsed_ms(write_start);
        if (!options.stats && options.frames == 1) std::cout << "wrote " << file.string() << '\n';
        if (options.frames > 1 && isatty(STDERR_FILENO))
            std::cerr << "\rframe " << frame + 1 << " of " << options.frames << std::flush;
    }
    if (options.frames > 1 && isatty(STDERR_FILENO)) std::cerr << '\n';

    if (is_empty)
        std::cerr << "warning: " << options.model.string()
                  << ": nothing of it is to be seen; perhaps its faces are named clockwise or have "
                     "no area\n";
    if (options.stats)
        print_stats(program, size, counters, load_ms, render_ms, write_ms);
    else if (options.frames > 1)
        std::cout << "wrote " << options.frames << " pictures, "
                  << name_of_frame(options.out, 0).string() << " and so on\n";
}

}  // namespace

void Knobs::flag(const std::string& name, bool& value, const std::string& help) {
    command_line_.add_flag(name, value, help);
}

namespace {

template <typename Number>
void add_number(CLI::App& line, const std::string& name, Number& value, Number least, Number most,
                const std::string& help) {
    const auto in_words = [](Number number) {
        std::ostringstream words;
        words << number;
        return words.str();
    };
    const auto take = [=, &value](const std::string& word) {
        Number number;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
        if (error != std::errc() || end != word.data() + word.size() ||
            !(number >= least && number <= most))
            throw CLI::ValidationError(name, "'" + word + "' is not a number from " +
                                                 in_words(least) + " to " + in_words(most));
        value = number;
    };
    line.add_option_function<std::string>(name, take, help + " [" + in_words(value) + "]")
        ->type_name("NUMBER");
}

}  // namespace

void Knobs::number(const std::string& name, float& value, float least, float most,
                   const std::string& help) {
    add_number(command_line_, name, value, least, most, help);
}

void Knobs::number(const std::string& name, int& value, int least, int most,
                   const std::string& help) {
    add_number(command_line_, name, value, least, most, help);
}

void Knobs::add_choice(const std::string& name, const std::vector<std::string>& words,
                       const std::string& preset, const std::string& help,
                       std::function<void(std::size_t)> choose) {
    std::string all;
    for (const std::string& word : words) all += (all.empty() ? "" : "|") + word;
    const auto take = [=](const std::string& word) {
        for (std::size_t i = 0; i < words.size(); ++i)
            if (words[i] == word) return choose(i);
        throw CLI::ValidationError(name, "'" + word + "' is not one of " + all);
    };
    command_line_.add_option_function<std::string>(name, take, help + " [" + preset + "]")
        ->type_name(all);
}

int run_lesson_program(const LessonProgram& program, int argc, char** argv) {
    keep_freed_memory();
    LessonOptions& options = program.options;
    options.out = program.name + ".png";
    CLI::App line(program.title, program.name);
    line.add_option(
            "--model", options.model,
            "The model to draw: .obj, .gltf or .glb [" + options.model.string() + " of the course]")
        ->type_name("FILE");
    line.add_option("--out", options.out,
                    "The picture to write: .png, .bmp or .tga [" + options.out.string() + "]")
        ->type_name("FILE")
        ->check([](const std::string& name) {
            try {
                check_image_name(name);
                return std::string();
            } catch (const InputError& error) { return std::string(error.what()); }
        });
    line.add_option_function<std::string>(
            "--size", [&](const std::string& text) { options.size = parse_size(text); },
            "The picture's size in pixels [1280x720]")
        ->type_name("WIDTHxHEIGHT");
    line.add_flag("--stats", options.stats, "Print what was done and how long it took, as JSON");
    Knobs knobs(line);
    knobs.choice("--samples", options.samples_per_side, {{"1", 1}, {"4", 2}, {"16", 4}, {"64", 8}},
                 "Samples a pixel, averaged: smoother, and that many times the time and memory");
    if (program.orbit) {
        Orbit& orbit = *program.orbit;
        knobs.number("--yaw", orbit.yaw_degrees, -36000, 36000,
                     "The camera's way around the scene, in degrees");
        knobs.number("--pitch", orbit.pitch_degrees, -90, 90,
                     "Its height over the horizon, in degrees");
        knobs.number("--distance", orbit.distance, 0.01f, 1e6f,
                     "Its distance from the scene's centre, in radii of the scene");
        knobs.number("--fov", orbit.fov_degrees, 1, 170,
                     "What it sees from the lower to the upper border, in degrees");
        knobs.number("--frames", options.frames, 1, 9999,
                     "Pictures of one turn around the scene; --out then takes turn_%04d.png");
    }
    program.declare_knobs(knobs);

    try {
        line.parse(argc, argv);
        if (options.frames > 1 && line.count("--out") == 0)
            options.out = program.name + "_%04d.png";
        if (options.frames > 1 && name_of_frame(options.out, 0) == options.out)
            throw CLI::ValidationError("--out",
                                       "the name for several frames needs their number, as "
                                       "in turn_%04d.png");
        make_pictures(program);
        if (!std::cout.flush()) throw std::runtime_error("standard output cannot be written");
        return 0;
    } catch (const CLI::CallForHelp&) {
        std::cout << line.help();
        return 0;
    } catch (const CLI::ParseError& error) {
        std::cerr << "error: " << error.what() << " (--help lists what there is)\n";
        return 2;
    } catch (const std::bad_alloc&) {
        std::cerr << "error: not enough memory for this model at this size\n";
        return 1;
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << '\n';
        return 1;
    }
}

}  // namespace rasterbook
