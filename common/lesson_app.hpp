// SPDX-License-Identifier: MIT
/// @file
/// The program around a lesson's picture: command line, model, output, --stats, errors.
#pragma once

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/counters.hpp"
#include "common/film.hpp"
#include "common/image.hpp"
#include "common/mesh.hpp"
#include "common/threads.hpp"

namespace CLI {
class App;
}

namespace rasterbook {

/// What every lesson can be asked for. A lesson adds its own knobs in a struct derived from this.
struct LessonOptions {
    std::filesystem::path model = "teapot.obj";
    std::filesystem::path out;  ///< By default NAME.png in the current folder.
    ivec2 size{1280, 720};      ///< Pixels to render, each side 1 to 16384 for one sample a pixel.
    int samples_per_side = 1;   ///< The picture is rendered this many times as wide and as high.
    bool stats = false;
    Frames frames;
    int jobs = threads_of_the_machine();  ///< Frames that are drawn and written at once.
};

/// Where the camera stands and how wide it sees, from lesson 04 on: a lesson whose options have an
/// `Orbit orbit` is given the knobs for it, and --frames.
struct Orbit {
    float yaw_degrees = -30.0f;   ///< Around the scene, counter-clockwise as seen from above.
    float pitch_degrees = 27.0f;  ///< Above the horizon, -90 to 90.
    float distance = 1.4f;        ///< From the scene's centre, in radii of the scene, > 0.
    float fov_degrees = 36.0f;    ///< From the picture's lower to its upper border, 1 to 170.

    bool operator==(const Orbit&) const = default;
};

/// Where a lesson declares its knobs: one line gives the flag, its help, its check and its default.
class Knobs {
  public:
    explicit Knobs(CLI::App& command_line) : command_line_(command_line) {}

    /// `--name`: sets `value` to true.
    void flag(const std::string& name, bool& value, const std::string& help);

    /// `--name NUMBER`: from `least` to `most`; `value` holds the default and takes the number.
    void number(const std::string& name, float& value, float least, float most,
                const std::string& help);
    void number(const std::string& name, int& value, int least, int most, const std::string& help);

    /// `--name TEXT`: any text; `value` holds the default and takes the text.
    void text(const std::string& name, std::string& value, const std::string& type,
              const std::string& help);

    /// `--name WORD`: one of the words; `value` holds the default and takes the choice.
    template <typename Value>
    void choice(const std::string& name, Value& value,
                std::initializer_list<std::pair<std::string, Value>> words,
                const std::string& help) {
        std::vector<std::string> names;
        std::string preset;
        for (const auto& [word, meaning] : words) {
            names.push_back(word);
            if (meaning == value) preset = word;
        }
        const std::vector<std::pair<std::string, Value>> table(words);
        add_choice(name, names, preset, help,
                   [&value, table](std::size_t chosen) { value = table[chosen].second; });
    }

    /// Calls one of the functions when its word is given. A knob that is declared later is taken
    /// later.
    void choice(const std::string& name, const std::string& preset,
                const std::vector<std::pair<std::string, std::function<void()>>>& words,
                const std::string& help) {
        std::vector<std::string> names;
        for (const auto& [word, call] : words) names.push_back(word);
        add_choice(name, names, preset, help,
                   [words](std::size_t chosen) { words[chosen].second(); });
    }

  private:
    void add_choice(const std::string& name, const std::vector<std::string>& words,
                    const std::string& preset, const std::string& help,
                    std::function<void(std::size_t)> choose);

    CLI::App& command_line_;
};

/// What one frame has of its own; the rest is the same for all.
struct FrameOptions {
    float yaw_degrees;
    int threads;  ///< For those lessons that draw a picture with several.
};

/// A lesson, ready to run: run_lesson fills it in.
struct LessonProgram {
    std::string name;   ///< NN_name
    std::string title;  ///< One sentence for --help.
    LessonOptions& options;
    Orbit* orbit;        ///< Of the options, or null.
    const int* threads;  ///< Of the options, or null: then one thread draws a picture.
    std::function<void(Knobs&)> declare_knobs;
    std::function<const Scene&(Scene)> prepare;  ///< Called once, with the model as it was read.

    /// Called by several threads at once; counts when not null.
    std::function<Image<vec3>(const FrameOptions&, Counters*)> render;
};

/// @return  The exit status: 0, 1 for bad input, 2 for bad usage; errors are one line on stderr.
int run_lesson_program(const LessonProgram& program, int argc, char** argv);

/// Runs a lesson: reads the command line and the model, renders, writes the picture.
///
/// @tparam Options      Derived from LessonOptions; may have `void declare(Knobs&)`, an `Orbit
///                      orbit`, and `threads.threads`, the number of threads that draw.
/// @tparam LessonScene  Scene, or derived from it and made once as LessonScene(Scene, Options).
/// @param render        Called for each picture as render(const Options&, const LessonScene&,
///                      counters), where counters is a Counters or a NoCounters; gives the picture
///                      in linear colour. Where there are several pictures, several threads call
///                      it at once: what it keeps from one to the next must be thread_local.
template <typename Options, typename LessonScene = Scene, typename Render>
int run_lesson(int argc, char** argv, std::string name, std::string title, Render render) {
    Options options;
    std::optional<LessonScene> scene;
    Orbit* orbit = nullptr;
    const int* threads = nullptr;
    if constexpr (requires { options.orbit; }) orbit = &options.orbit;
    if constexpr (requires { options.threads.threads; }) threads = &options.threads.threads;
    return run_lesson_program({std::move(name), std::move(title), options, orbit, threads,
                               [&](Knobs& knobs) {
                                   if constexpr (requires { options.declare(knobs); })
                                       options.declare(knobs);
                               },
                               [&](Scene model) -> const Scene& {
                                   if constexpr (std::is_same_v<LessonScene, Scene>)
                                       return scene.emplace(std::move(model));
                                   else
                                       return scene.emplace(std::move(model), options);
                               },
                               [&](const FrameOptions& frame, Counters* counters) {
                                   Options own = options;
                                   if constexpr (requires { own.orbit; })
                                       own.orbit.yaw_degrees = frame.yaw_degrees;
                                   if constexpr (requires { own.threads.threads; })
                                       own.threads.threads = frame.threads;
                                   NoCounters none;
                                   return counters ? render(own, *scene, *counters)
                                                   : render(own, *scene, none);
                               }},
                              argc, argv);
}

}  // namespace rasterbook
