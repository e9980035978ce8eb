// SPDX-License-Identifier: MIT
// The program around a lesson's picture in a page: what lesson_app.cpp is on the command line. Its
// options become controls, the scene comes as bytes, and the picture goes to a canvas.
//
// The lesson's main() never returns: what it has made stays where it is, and the page calls the
// functions that are exported here. One picture is drawn at a time.
#include <algorithm>
#include <charconv>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <sstream>
#include <string>
#include <string_view>
#include <typeinfo>
#include <utility>
#include <vector>

#include "common/app/lesson_app.hpp"
#include "common/image/backdrop.hpp"
#include "common/image/input_error.hpp"
#include "common/math/color.hpp"
#include "common/model/load_budget.hpp"
#include "common/model/texture_file.hpp"
#include "common/probe/pixel_trace.hpp"
#include "docs/live/packed_scene.hpp"

#define EXPORTED(name) extern "C" __attribute__((export_name(#name)))
#define IMPORTED(name) extern "C" __attribute__((import_module("page"), import_name(#name)))

/// Leaves the lesson's main() for good.
IMPORTED(leave) [[noreturn]] void leave();

/// The lesson's main(), as clang calls it.
extern "C" int __main_argc_argv(int, char**);

/// Ends what the page has called: the text says what is wrong.
IMPORTED(fail) [[noreturn]] void fail(const char* text);

namespace rasterbook {

/// One of the page's controls.
struct Control {
    std::string name, help, preset;
    double least = 0, most = 0;
    bool is_whole = false;
    std::vector<std::string> words{};  ///< To choose from.
    const char* kind;                  ///< "flag", "number", "text" or "choice".

    /// Takes a value; true if it is one.
    std::function<bool(const std::string&)> set;
};

class CommandLine {
  public:
    std::vector<Control> controls;
};

void OptionParser::flag(const char* name, bool& value, const char* help) {
    command_line_.controls.push_back({.name = name,
                                      .help = help,
                                      .preset = value ? "true" : "false",
                                      .kind = "flag",
                                      .set = [&value](const std::string& given) {
                                          value = given == "true";
                                          return value || given == "false";
                                      }});
}

namespace {

template <typename Number>
void add_number(CommandLine& line, const char* name, Number& value, Number least, Number most,
                const char* help) {
    std::ostringstream preset;
    preset << value;
    line.controls.push_back({.name = name,
                             .help = help,
                             .preset = preset.str(),
                             .least = static_cast<double>(least),
                             .most = static_cast<double>(most),
                             .is_whole = std::is_integral_v<Number>,
                             .kind = "number",
                             .set = [=, &value](const std::string& given) {
                                 char* end = nullptr;
                                 const char* const text = given.c_str();
                                 Number number{};
                                 if constexpr (std::is_integral_v<Number>)
                                     number = static_cast<Number>(std::strtol(text, &end, 10));
                                 else
                                     number = std::strtof(text, &end);
                                 const bool is_number = !given.empty() && *end == '\0' &&
                                                        number >= least && number <= most;
                                 if (is_number) value = number;
                                 return is_number;
                             }});
}

}  // namespace

void OptionParser::number(const char* name, float& value, float least, float most,
                          const char* help) {
    add_number(command_line_, name, value, least, most, help);
}

void OptionParser::number(const char* name, int& value, int least, int most, const char* help) {
    add_number(command_line_, name, value, least, most, help);
}

void OptionParser::text(const char* name, std::string& value, const char*, const char* help) {
    command_line_.controls.push_back({.name = name,
                                      .help = help,
                                      .preset = value,
                                      .kind = "text",
                                      .set = [&value](const std::string& given) {
                                          value = given;
                                          return true;
                                      }});
}

void OptionParser::choice(const char* name, const char* preset,
                          std::vector<std::pair<const char*, std::function<void()>>> words,
                          const char* help) {
    std::vector<std::string> all;
    for (const auto& [word, call] : words) all.emplace_back(word);
    command_line_.controls.push_back({.name = name,
                                      .help = help,
                                      .preset = preset,
                                      .words = std::move(all),
                                      .kind = "choice",
                                      .set = [=](const std::string& given) {
                                          for (const auto& [word, call] : words)
                                              if (given == word) return call(), true;
                                          return false;
                                      }});
}

namespace {

/// What is made once, when the lesson's main() runs.
struct Page {
    const LessonProgram& program;
    bool is_lab;
    CommandLine line{};
    Scene model{};
    const Scene* scene = nullptr;  ///< As the lesson has prepared it.
    std::string given{};           ///< What the page has written.
    std::string answer{};
    std::vector<u8vec4> rgba{};
};
Page* page = nullptr;

/// As JSON has it.
std::string quoted(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') quoted += '\\';
        quoted += c;
    }
    return quoted + '"';
}

}  // namespace

namespace {

[[noreturn]] void show(const LessonProgram& program, bool is_lab) {
    page = new Page{program, is_lab};
    OptionParser parser(page->line);
    declare_picture_options(parser, program);
    leave();
}

}  // namespace

int run_lesson_program(const LessonProgram& program, int, char**) { show(program, false); }

int run_lab(const std::function<LessonProgram()>& make, const std::string&, int, char**) {
    const LessonProgram program = make();
    show(program, true);
}

/// To be called first. Does not return: see leave().
EXPORTED(start) void start() { __main_argc_argv(0, nullptr); }

/// Room for what the page hands over next.
EXPORTED(room) char* room(std::size_t bytes) {
    page->given.resize(bytes);
    return page->given.data();
}

/// The lesson's model and controls, as JSON; of a lab also which of them are its own.
EXPORTED(controls) const char* controls() {
    CommandLine methods;
    OptionParser parser(methods);
    if (page->is_lab) page->program.declare_options(parser);
    std::ostringstream json;
    json << "{\"model\": " << quoted(page->program.options.model.string())
         << ", \"hasProbe\": " << (page->program.fills_triangles ? "true" : "false")
         << ", \"methods\": [";
    const char* comma = "";
    for (const Control& method : methods.controls)
        json << std::exchange(comma, ", ") << quoted(method.name);
    json << "], \"controls\": [";
    comma = "";
    for (const Control& control : page->line.controls) {
        json << comma << "{\"name\": " << quoted(control.name) << ", \"kind\": \"" << control.kind
             << "\", \"help\": " << quoted(control.help)
             << ", \"preset\": " << quoted(control.preset) << ", \"least\": " << control.least
             << ", \"most\": " << control.most
             << ", \"isWhole\": " << (control.is_whole ? "true" : "false") << ", \"words\": [";
        const char* between = "";
        for (const std::string& word : control.words)
            json << std::exchange(between, ", ") << quoted(word);
        json << "]}";
        comma = ", ";
    }
    json << "]}";
    page->answer = json.str();
    return page->answer.c_str();
}

/// Sets the control of a number to the value that the page has written.
///
/// @return  Whether it is one of its values.
EXPORTED(set) bool set(std::size_t control) {
    return page->line.controls[control].set(page->given);
}

/// Takes the scene that the page has written.
EXPORTED(take_scene) void take_scene() {
    SceneReader reader{
        {reinterpret_cast<const std::uint8_t*>(page->given.data()), page->given.size()}, {}};
    page->model = Scene();
    transfer(reader, page->model);
    page->given = {};
}

/// Makes what the lesson makes once, of the scene and the values of its controls.
EXPORTED(prepare) void prepare() { page->scene = &page->program.prepare(page->model); }

/// @param width, height  Of the picture, in pixels.
/// @return               Its pixels as a canvas has them: four bytes each, row by row.
EXPORTED(draw) const u8vec4* draw(int width, int height) {
    LessonOptions& options = page->program.options;
    options.size = ivec2(width, height) * options.samples_per_side;
    Image<vec3> rendered = page->program.render({page->program.frame().yaw_degrees, 1});
    const Image<u8vec3> picture =
        srgb8_from_linear(averaged(std::move(rendered), options.samples_per_side));
    page->rgba.resize(picture.pixels().size());
    std::ranges::transform(picture.pixels(), page->rgba.begin(),
                           [](u8vec3 color) { return u8vec4(color, 255); });
    return page->rgba.data();
}

/// Draws the picture that was drawn last once more, and says why a pixel of it has its colour.
EXPORTED(probe) const char* probe(int x, int y) {
    const LessonProgram& program = page->program;
    page->answer = explained([&] { return program.render({program.frame().yaw_degrees, 1}); },
                             {x, y}, program.options.samples_per_side, *page->scene);
    return page->answer.c_str();
}

// In place of what reads files.
Image<u8vec4> read_texture_file(const TextureMap& map, LoadBudget&) {
    return unpacked(*map.embedded);
}
Image<u8vec4> read_texture_file(const TextureMap& map, const char*, bool, Scene&) {
    return unpacked(*map.embedded);
}
void LoadBudget::check_overdraw(double, ivec2, const std::filesystem::path&) const {}

}  // namespace rasterbook

// In place of exceptions, which the library is not compiled for: all that the course throws is a
// std::runtime_error or derived from one.
extern "C" void* __cxa_allocate_exception(std::size_t size) { return std::malloc(size); }
extern "C" [[noreturn]] void __cxa_throw(void* thrown, std::type_info*, void (*)(void*)) {
    fail(static_cast<std::exception*>(thrown)->what());
}

// A page's program does not end: nothing that a thread keeps is destroyed.
extern "C" int __cxa_thread_atexit(void (*)(void*), void*, void*) { return 0; }

// What the library itself would throw, in what the compiler of a page makes, such as "out_of_range
// was thrown ... with message "%s"".
void std::__libcpp_verbose_abort(const char* format, ...) {
    const std::string_view text(format);
    std::string said(text.substr(0, text.find(" was thrown")));
    std::va_list arguments;
    va_start(arguments, format);
    if (text.find("%s") != text.npos) said.append(": ").append(va_arg(arguments, const char*));
    fail(said.c_str());
}
