// SPDX-License-Identifier: MIT
#include "common/app/lesson_app.hpp"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <mutex>
#include <new>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include <CLI/CLI.hpp>

#include "common/app/empty_picture.hpp"
#include "common/app/memory.hpp"
#include "common/app/threads.hpp"
#include "common/image/backdrop.hpp"
#include "common/image/image_io.hpp"
#include "common/image/input_error.hpp"
#include "common/image/interruption.hpp"
#include "common/math/color.hpp"
#include "common/model/model_file.hpp"

namespace rasterbook {

class CommandLine : public CLI::App {
  public:
    using CLI::App::App;
    std::vector<Choice> choices;
};

namespace {

constexpr int greatest_side = 16384;

/// Reads two whole numbers with a sign between them, and nothing else.
std::optional<ivec2> two_numbers(const std::string& text, char between) {
    ivec2 numbers;
    const char* const end = text.data() + text.size();
    const auto x = std::from_chars(text.data(), end, numbers.x);
    if (x.ec != std::errc() || x.ptr == end || *x.ptr != between) return {};
    const auto y = std::from_chars(x.ptr + 1, end, numbers.y);
    if (y.ec != std::errc() || y.ptr != end) return {};
    return numbers;
}

/// Reads "1280x720"; anything else is a usage error.
ivec2 parse_size(const std::string& text) {
    const auto is_side = [](int side) { return side >= 1 && side <= greatest_side; };
    const std::optional<ivec2> size = two_numbers(text, 'x');
    if (!size || !is_side(size->x) || !is_side(size->y))
        throw CLI::ValidationError("--size", "'" + text +
                                                 "' is not WIDTHxHEIGHT with sides from 1 to " +
                                                 std::to_string(greatest_side));
    return *size;
}

/// Reads "640,360"; anything else is a usage error.
ivec2 parse_pixel(const std::string& text) {
    const std::optional<ivec2> pixel = two_numbers(text, ',');
    if (!pixel)
        throw CLI::ValidationError("--probe", "'" + text + "' is not X,Y, a pixel of the picture");
    return *pixel;
}

/// @throws CLI::ParseError  When --probe asks for what there is not.
void check_probed(const LessonOptions& options) {
    if (!options.probed) return;
    const auto [x, y] = std::pair(options.probed->x, options.probed->y);
    if (x < 0 || y < 0 || x >= options.size.x || y >= options.size.y)
        throw CLI::ValidationError("--probe",
                                   "'" + std::to_string(x) + ',' + std::to_string(y) +
                                       "' is outside of the picture, which has X from 0 to " +
                                       std::to_string(options.size.x - 1) + " and Y from 0 to " +
                                       std::to_string(options.size.y - 1));
    if (options.frames.of_turn > 1)
        throw CLI::ValidationError("--probe", "a pixel of one picture, not of several --frames");
}

/// Reads "pixels=1000000"; anything else is a usage error.
void set_limit(LoadBudget& budget, const std::string& text) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const auto name = std::ranges::find(resource_names, text.substr(0, equals));
    const std::string number = text.substr(std::min(equals + 1, text.size()));
    const char* const end = number.data() + number.size();
    std::uint64_t most = 0;
    const auto read = std::from_chars(number.data(), end, most);
    if (name == resource_names.end() || read.ec != std::errc() || read.ptr != end) {
        std::string names;
        for (const std::string_view known : resource_names)
            names += (names.empty() ? "" : "|") + std::string(known);
        throw CLI::ValidationError("--limit",
                                   "'" + text + "' is not WHAT=NUMBER, where WHAT is " + names);
    }
    budget.set(static_cast<Resource>(name - resource_names.begin()), most);
}

/// Reads "90" or "0-29/90"; anything else is a usage error.
Frames parse_frames(const std::string& text) {
    try {
        return frames_from(text);
    } catch (const std::invalid_argument& error) {
        throw CLI::ValidationError("--frames", error.what());
    }
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

/// A message as it is printed: a file may have a name of a million letters.
std::string shortened(const std::string& message) {
    constexpr std::size_t longest = 1000;
    return message.size() <= longest ? message : message.substr(0, longest) + "...";
}

double elapsed_ms(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

/// What was done for one picture, or for several.
struct Tally {
    int pictures = 0;
    bool is_empty = true;  ///< Nothing of the model is to be seen in any.
    Counters counters;
    double render_ms = 0, write_ms = 0;  ///< Of each picture, added up.

    void add(const Tally& others) {
        pictures += others.pictures;
        is_empty = is_empty && others.is_empty;
        counters += others.counters;
        render_ms += others.render_ms;
        write_ms += others.write_ms;
    }
};

void print_stats(const LessonProgram& program, ivec2 size, const Tally& tally, double load_ms,
                 double total_ms) {
    std::ostringstream json;
    json << "{\"lesson\": \"" << program.name << "\", \"width\": " << size.x
         << ", \"height\": " << size.y;
    for (std::size_t i = 0; i < counter_names.size(); ++i)
        json << ", \"" << counter_names[i] << "\": " << tally.counters.values[i];
    json << ", \"load_ms\": " << load_ms << ", \"render_ms\": " << tally.render_ms
         << ", \"write_ms\": " << tally.write_ms << ", \"total_ms\": " << total_ms << "}\n";
    std::cout << json.str() << std::flush;
}

/// Renders a picture and writes it.
Tally make_picture(const LessonProgram& program, const FrameOptions& frame,
                   const std::filesystem::path& file) {
    const LessonOptions& options = program.options;
    Tally tally;
    const auto render_start = std::chrono::steady_clock::now();
    thread_counters = {};
    Image<vec3> rendered = program.render(frame);
    tally.counters = thread_counters;
    tally.is_empty = is_backdrop(rendered);
    const Image<vec3> picture = averaged(std::move(rendered), options.samples_per_side);
    tally.render_ms = elapsed_ms(render_start);

    const auto write_start = std::chrono::steady_clock::now();
    write_image(file, srgb8_from_linear(picture));
    tally.write_ms = elapsed_ms(write_start);
    tally.pictures = 1;
    return tally;
}

/// Prints why a pixel has its colour.
void print_probe(const LessonProgram& program, const Scene& scene) {
    if (!program.is_probed)
        throw std::runtime_error("--probe: this program is built without it; " + program.name +
                                 "_complete has it, and ./lessons/run builds that one");
    FrameOptions frame = program.frame();
    frame.threads = 1;
    std::cout << explained([&] { return program.render(frame); }, *program.options.probed,
                           program.options.samples_per_side, scene);
}

/// The file of one of the pictures.
std::filesystem::path file_of(const LessonOptions& options, int frame) {
    return options.frames.of_turn > 1 ? name_of_frame(options.out, frame) : options.out;
}

/// All pictures, several at once. Each depends on its number alone, not on what was drawn before.
Tally make_film(const LessonProgram& program) {
    const LessonOptions& options = program.options;
    const Frames& frames = options.frames;
    const int at_once = std::min(options.jobs, frames.count());
    const FrameOptions single = program.frame();
    const int threads = std::max(1, single.threads / at_once);
    const bool shows_progress = frames.count() > 1 && isatty(STDERR_FILENO);
    Tally tally;
    std::mutex mutex;
    const auto make_frame = [&](int frame) {
        const Tally done =
            make_picture(program, {single.yaw_degrees + degrees_at(frame, frames), threads},
                         file_of(options, frame));
        const std::lock_guard lock(mutex);
        tally.add(done);
        if (shows_progress)
            std::cerr << "\rframe " << tally.pictures << " of " << frames.count()
                      << (tally.pictures == frames.count() ? "\n" : "") << std::flush;
    };
    try {
        for_each_at_once(at_once, frames.first, frames.last, make_frame);
    } catch (...) {
        if (shows_progress && tally.pictures > 0) std::cerr << '\n';
        throw;
    }
    return tally;
}

/// Draws the first picture again, and counts why its triangles are not drawn.
std::string why_first_is_empty(const LessonProgram& program, const Scene& scene) {
    UndrawnTriangles undrawn;
    undrawn_triangles = &undrawn;
    thread_counters = {};
    FrameOptions first = program.frame();
    first.yaw_degrees += degrees_at(program.options.frames.first, program.options.frames);
    program.render(first);
    undrawn_triangles = nullptr;
    return why_empty(thread_counters, undrawn, scene);
}

void make_pictures(const LessonProgram& program) {
    LessonOptions& options = program.options;
    const auto start = std::chrono::steady_clock::now();
    const Scene& scene = program.prepare(read_model(options));
    const double load_ms = elapsed_ms(start);
    print_warnings(scene);

    const ivec2 size = options.size;
    options.size *= options.samples_per_side;
    if (options.probed) return print_probe(program, scene);
    const Tally tally = make_film(program);

    if (tally.is_empty)
        std::cerr << "warning: " << options.model.string()
                  << ": nothing of it is to be seen: " << why_first_is_empty(program, scene)
                  << '\n';
    if (options.stats)
        print_stats(program, size, tally, load_ms, elapsed_ms(start));
    else if (const std::string first = file_of(options, options.frames.first).string();
             tally.pictures > 1)
        std::cout << "wrote " << tally.pictures << " pictures, " << first << " and so on\n";
    else
        std::cout << "wrote " << first << '\n';
}

/// @throws std::runtime_error  When something that was said could not be written, now or before.
void flush_output() {
    if (!std::cout.flush() || std::ferror(stdout))
        throw std::runtime_error("standard output cannot be written");
}

}  // namespace

void OptionParser::flag(const char* name, bool& value, const char* help) {
    command_line_.add_flag(name, value, help);
}

namespace {

template <typename Number>
void add_number(CommandLine& line, const std::string& name, Number& value, Number least,
                Number most, const std::string& help) {
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
    line.choices.push_back({name, help, in_words(value), {}});
    line.add_option_function<std::string>(name, take, help + " [" + in_words(value) + "]")
        ->type_name("NUMBER");
}

}  // namespace

void OptionParser::number(const char* name, float& value, float least, float most,
                          const char* help) {
    add_number(command_line_, name, value, least, most, help);
}

void OptionParser::number(const char* name, int& value, int least, int most, const char* help) {
    add_number(command_line_, name, value, least, most, help);
}

void OptionParser::text(const char* name, std::string& value, const char* type, const char* help) {
    command_line_.add_option(name, value, help)->type_name(type);
}

void OptionParser::choice(const char* name, const char* preset,
                          std::vector<std::pair<const char*, std::function<void()>>> words,
                          const char* help) {
    std::string all;
    for (const auto& [word, call] : words) all += (all.empty() ? "" : "|") + std::string(word);
    const auto take = [=](const std::string& given) {
        for (const auto& [word, call] : words)
            if (given == word) return call();
        throw CLI::ValidationError(name, "'" + given + "' is not one of " + all);
    };
    command_line_.choices.push_back({name, help, preset, {}});
    for (const auto& [word, call] : words) command_line_.choices.back().words.emplace_back(word);
    command_line_
        .add_option_function<std::string>(name, take, std::string(help) + " [" + preset + "]")
        ->type_name(all);
}

std::optional<int> read_command_line(const LessonProgram& program, int argc, char** argv) {
    LessonOptions& options = program.options;
    options.jobs = threads_of_the_machine();
    options.out = program.name + ".png";
    CommandLine line(program.title, program.name);
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
    line.add_option_function<std::vector<std::string>>(
            "--limit",
            [&](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) set_limit(options.budget, text);
            },
            "How much the model's files may ask for, such as pixels=1000000000; or bytes, "
            "vertices, primitives, objects, materials, overdraw")
        ->type_name("WHAT=NUMBER");
    line.add_flag("--sandbox", options.is_sandboxed,
                  "Read no file that lies outside of the model's folder");
    line.add_flag("--stats", options.stats, "Print what was done and how long it took, as JSON");
    if (program.fills_triangles)
        line.add_option_function<std::string>(
                "--probe", [&](const std::string& text) { options.probed = parse_pixel(text); },
                "Write no picture, but say why this pixel has its colour; 0,0 is the upper left "
                "one")
            ->type_name("X,Y");
    OptionParser parser(line);
    if (program.orbit) {
        line.add_option_function<std::string>(
                "--frames", [&](const std::string& text) { options.frames = parse_frames(text); },
                "Pictures of one turn around the scene, or of a part of it; --out then takes "
                "turn_%04d.png [1]")
            ->type_name("N|A-B/N");
        parser.number("--jobs", options.jobs, 1, max_threads,
                      "Frames at once, each with its share of the threads; unasked, no more than "
                      "take 1 GiB");
    }
    declare_picture_options(parser, program);

    line.footer(
        "Exit status: 0 for success, 1 when something cannot be read or written, 2 for wrong "
        "usage");

    try {
        line.parse(argc, argv);
        check_probed(options);
        const bool is_film = options.frames.of_turn > 1;
        if (is_film && line.count("--out") == 0) options.out = program.name + "_%04d.png";
        if (is_film && name_of_frame(options.out, 0) == options.out)
            throw CLI::ValidationError("--out",
                                       "the name for several frames needs their number, as "
                                       "in turn_%04d.png");
        if (is_film && line.count("--jobs") == 0)
            options.jobs = frames_at_once(program.threads ? *program.threads : options.jobs,
                                          options.frames, options.size * options.samples_per_side);
        return {};
    } catch (const CLI::CallForHelp&) {
        std::cout << line.help();
        return 0;
    } catch (const CLI::ParseError& error) {
        std::cerr << "error: " << error.what() << " (--help lists what there is)\n";
        return 2;
    }
}

std::vector<Choice> choices_of(const LessonProgram& program) {
    CommandLine line;
    OptionParser parser(line);
    program.declare_options(parser);
    return line.choices;
}

Scene read_model(LessonOptions& options) {
    const std::filesystem::path model = find_model(options.model);
    if (options.is_sandboxed) options.budget.confine_to(model.parent_path());
    return load_model(model, options.budget);
}

void print_warnings(const Scene& scene) {
    constexpr std::size_t most_warnings = 200;
    for (std::size_t i = 0; i < std::min(scene.warnings.size(), most_warnings); ++i)
        std::cerr << "warning: " << shortened(scene.warnings[i]) << '\n';
    if (scene.warnings.size() > most_warnings)
        std::cerr << "warning: and " << scene.warnings.size() - most_warnings << " more\n";
}

int exit_status_of(const std::function<int()>& run) {
    protect_files();
    keep_freed_memory();
    try {
        const int status = run();
        if (status == 0) flush_output();
        return status;
    } catch (const std::bad_alloc&) {
        std::cerr << "error: not enough memory for this model at this size\n";
        return 1;
    } catch (const std::exception& error) {
        std::cerr << "error: " << shortened(error.what()) << '\n';
        return 1;
    }
}

int run_lesson_program(const LessonProgram& program, int argc, char** argv) {
    return exit_status_of([&] {
        if (const std::optional<int> status = read_command_line(program, argc, argv))
            return *status;
        make_pictures(program);
        return 0;
    });
}

}  // namespace rasterbook
