// SPDX-License-Identifier: MIT
/// @file
/// The program around a lesson's picture: command line, model, output, --stats, errors.
#pragma once

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/app/counters.hpp"
#include "common/app/image_sequence.hpp"
#include "common/image/image.hpp"
#include "common/model/mesh.hpp"
#include "common/probe/pixel_trace.hpp"

namespace rasterbook {

/// What every lesson can be asked for. A lesson adds its own options in a struct derived from this.
struct LessonOptions {
    std::filesystem::path model = "teapot.obj";
    std::filesystem::path out;  ///< By default NAME.png in the current folder.
    ivec2 size{1280, 720};      ///< Pixels to render, each side 1 to 16384 for one sample a pixel.
    int samples_per_side = 1;   ///< The picture is rendered this many times as wide and as high.
    LoadBudget budget;          ///< What the model's files may ask for.
    bool is_sandboxed = false;  ///< Only files in the model's folder are read.
    bool stats = false;
    std::optional<ivec2> probed;  ///< A pixel to explain; then no picture is written.
    Frames frames;
    int jobs = 0;  ///< Frames that are drawn and written at once; 0: as many as there are threads.
};

/// Where the camera stands and how wide it sees, from lesson 04 on: a lesson whose options have an
/// `Orbit orbit` is given its options, and --frames.
struct Orbit {
    float yaw_degrees = -30.0f;   ///< Around the scene, counter-clockwise as seen from above.
    float pitch_degrees = 27.0f;  ///< Above the horizon, -90 to 90.
    float distance = 1.4f;        ///< From the scene's centre, in radii of the scene, > 0.
    float fov_degrees = 36.0f;    ///< From the picture's lower to its upper border, 1 to 170.

    bool operator==(const Orbit&) const = default;
};

/// An option that takes one of several words, or a number.
struct Choice {
    std::string name, help, preset;
    std::vector<std::string> words;  ///< None: a number.
};

/// What takes the options' values: a command line, or the controls of a page.
class CommandLine;

/// Where a lesson declares its options: one line gives the flag, its help, its check and its
/// default. Texts have to outlive it, as literals do.
class OptionParser {
  public:
    explicit OptionParser(CommandLine& command_line) : command_line_(command_line) {}

    /// `--name`: sets `value` to true.
    void flag(const char* name, bool& value, const char* help);

    /// `--name NUMBER`: from `least` to `most`; `value` holds the default and takes the number.
    void number(const char* name, float& value, float least, float most, const char* help);
    void number(const char* name, int& value, int least, int most, const char* help);

    /// `--name TEXT`: any text; `value` holds the default and takes the text.
    void text(const char* name, std::string& value, const char* type, const char* help);

    /// `--name WORD`: one of the words; `value` holds the default and takes the choice.
    ///
    /// @tparam Value  An enumeration or a number.
    template <typename Value>
    void choice(const char* name, Value& value,
                std::initializer_list<std::pair<const char*, Value>> words, const char* help) {
        // Little is compiled for each Value and lesson: the rest works with numbers.
        for (const auto& [word, meaning] : words)
            add_word(word, static_cast<double>(meaning), meaning == value);
        add_choice(name, help, &value, [](void* to, double chosen) {
            *static_cast<Value*>(to) = static_cast<Value>(chosen);
        });
    }

    /// Calls one of the functions when its word is given. An option that is declared later is taken
    /// later.
    void choice(const char* name, const char* preset,
                std::vector<std::pair<const char*, std::function<void()>>> words, const char* help);

  private:
    void add_word(const char* word, double meaning, bool is_preset);
    void add_choice(const char* name, const char* help, void* value, void (*set)(void*, double));

    CommandLine& command_line_;
    std::vector<std::pair<const char*, double>> words_;  ///< Of the choice that is being declared.
    const char* preset_ = "";
};

/// Declares several groups of options, each by its `declare(OptionParser&)`.
template <typename... Groups>
void declare_all(OptionParser& parser, Groups&... groups) {
    (groups.declare(parser), ...);
}

/// What one frame has of its own; the rest is the same for all.
struct FrameOptions {
    float yaw_degrees;
    int threads;  ///< For those lessons that draw a picture with several.
};

/// A lesson, ready to run: lesson_program() fills it in.
struct LessonProgram {
    std::string name;        ///< NN_name
    std::string title;       ///< One sentence for --help.
    LessonOptions& options;  ///< They and the rest are kept by the functions below.
    Orbit* orbit;            ///< Of the options, or null.
    bool* show_depth;        ///< Of the options, or null.
    const int* threads;      ///< Of the options, or null: then one thread draws a picture.
    std::function<void(OptionParser&)> declare_options;
    std::function<const Scene&(Scene)> prepare;  ///< Called once, with the model as it was read.

    /// Called by several threads at once. What it counts is added to the calling thread's counters.
    std::function<Image<vec3>(const FrameOptions&)> render;

    bool fills_triangles;        ///< Else there is nothing that --probe could explain.
    bool is_probed = has_probe;  ///< Whether the program was built so that it can answer --probe.

    /// A single picture's, as the options say.
    FrameOptions frame() const { return {orbit ? orbit->yaw_degrees : 0, threads ? *threads : 1}; }
};

/// The scene in what a lesson draws.
inline const Scene& scene_of(const Scene& scene) { return scene; }
template <typename Assets>
const Scene& scene_of(const Assets& assets) {
    return assets.scene;
}

/// Declares the options of a picture that all lessons have, each as far as it has it: samples,
/// orbit, depth; then the program's own.
void declare_picture_options(OptionParser& parser, const LessonProgram& program);

/// Reads the command line into the program's options.
///
/// @return  The exit status, where that is all: 0 after --help, 2 for bad usage, which is one line
///          on stderr. Else none.
std::optional<int> read_command_line(const LessonProgram& program, int argc, char** argv);

/// The choices among the program's own options.
std::vector<Choice> choices_of(const LessonProgram& program);

/// Reads the model that the options name.
///
/// @throws std::runtime_error  Names the file and what is wrong with it.
Scene read_model(LessonOptions& options);

/// Prints the scene's warnings on stderr, a line each.
void print_warnings(const Scene& scene);

/// The exit status of a program: what `run` returns, or 1 where it throws, after one line on
/// stderr. SIGINT, SIGTERM and SIGHUP end the program as always, but between files
/// (protect_files()).
int exit_status_of(const std::function<int()>& run);

/// @return  The exit status: 0, 1 for bad input or what cannot be written, 2 for bad usage; errors
///          are one line on stderr.
int run_lesson_program(const LessonProgram& program, int argc, char** argv);

/// Whether a program compares what it draws with different options: a lesson's laboratory.
#ifdef RASTERBOOK_LAB
constexpr bool is_lab = true;
#else
constexpr bool is_lab = false;
#endif

/// Runs a lesson's laboratory.
///
/// Without arguments it lists what one can choose. Where options are given several words each, as
/// in `--line bresenham,wu`, it draws a picture for each combination, by turns, and prints how far
/// each is from the reference and how long it takes; else it draws one picture, like a lesson.
///
/// @param make       Called for each picture: a program, with options of its own.
/// @param reference  Options that draw what errors are measured against, such as
///                   "--line bresenham"; nothing: what the program draws unasked.
/// @return           The exit status: 0, 1 for bad input or what cannot be written, 2 for bad
///                   usage; errors are one line on stderr.
int run_lab(const std::function<LessonProgram()>& make, const std::string& reference, int argc,
            char** argv);

/// A lesson's program, with options of its own at their defaults.
///
/// @tparam Options     Derived from LessonOptions; may have `void declare(OptionParser&)`,
///                     `Orbit orbit`, `bool show_depth`, and `threads.threads`, the number of
///                     threads that draw.
/// @param make_assets  Called once as make_assets(Scene, const Options&): gives what is drawn, with
///                     a Scene `scene`.
/// @param render       Called for each picture as render(const Options&, const Assets&); gives it
///                     in linear colour. Where there are several pictures, several threads call it
///                     at once: what it keeps from one to the next must be thread_local.
template <typename Options, typename MakeAssets, typename Render>
LessonProgram lesson_program(std::string name, std::string title, MakeAssets make_assets,
                             Render render) {
    struct State {
        Options options;
        std::optional<std::invoke_result_t<MakeAssets, Scene, const Options&>> assets;
    };
    const auto state = std::make_shared<State>();
    Options& options = state->options;
    Orbit* orbit = nullptr;
    bool* show_depth = nullptr;
    const int* threads = nullptr;
    if constexpr (requires { options.show_depth; }) show_depth = &options.show_depth;
    if constexpr (requires { options.orbit; }) orbit = &options.orbit;
    if constexpr (requires { options.threads.threads; }) threads = &options.threads.threads;
    return {std::move(name),
            std::move(title),
            options,
            orbit,
            show_depth,
            threads,
            [=](OptionParser& parser) {
                if constexpr (requires { state->options.declare(parser); })
                    state->options.declare(parser);
            },
            [=](Scene model) -> const Scene& {
                state->assets.emplace(make_assets(std::move(model), state->options));
                return scene_of(*state->assets);
            },
            [=](const FrameOptions& frame) {
                Options own = state->options;
                if constexpr (requires { own.orbit; }) own.orbit.yaw_degrees = frame.yaw_degrees;
                if constexpr (requires { own.threads.threads; })
                    own.threads.threads = frame.threads;
                return render(own, *state->assets);
            },
            !std::is_same_v<Options, LessonOptions>};  // lesson 01 draws lines
}

/// Draws the scene as it was read.
template <typename Options>
Scene just_the_scene(Scene scene, const Options&) {
    return scene;
}

/// Runs a lesson: reads the command line and the model, renders, writes the picture. Parameters:
/// those of lesson_program().
template <typename Options, typename MakeAssets, typename Render>
int run_lesson(int argc, char** argv, std::string name, std::string title, MakeAssets make_assets,
               Render render) {
    if constexpr (is_lab) {
        const auto make = [&] {
            return lesson_program<Options>("lab_" + name, title, make_assets, render);
        };
        return run_lab(make, "", argc, argv);
    } else {
        return run_lesson_program(
            lesson_program<Options>(std::move(name), std::move(title), make_assets, render), argc,
            argv);
    }
}

/// Runs a lesson that draws the scene as it was read.
template <typename Options, typename Render>
int run_lesson(int argc, char** argv, std::string name, std::string title, Render render) {
    return run_lesson<Options>(argc, argv, std::move(name), std::move(title),
                               just_the_scene<Options>, render);
}

}  // namespace rasterbook
