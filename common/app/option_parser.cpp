// SPDX-License-Identifier: MIT
// What a command line and a page's controls have in common.
#include "common/app/lesson_app.hpp"

namespace rasterbook {

void OptionParser::add_word(const char* word, double meaning, bool is_preset) {
    words_.emplace_back(word, meaning);
    if (is_preset) preset_ = word;
}

void OptionParser::add_choice(const char* name, const char* help, void* value,
                              void (*set)(void*, double)) {
    std::vector<std::pair<const char*, std::function<void()>>> calls;
    for (const auto& [word, meaning] : words_)
        calls.emplace_back(word, [=, chosen = meaning] { set(value, chosen); });
    choice(name, preset_, std::move(calls), help);
    words_.clear();
    preset_ = "";
}

void declare_picture_options(OptionParser& parser, const LessonProgram& program) {
    parser.choice(
        "--samples", program.options.samples_per_side, {{"1", 1}, {"4", 2}, {"16", 4}, {"64", 8}},
        "Samples per pixel (supersampling): smoother, and that many times the time and memory");
    if (program.orbit) {
        Orbit& orbit = *program.orbit;
        parser.number("--yaw", orbit.yaw_degrees, -36000, 36000,
                      "The camera's azimuth around the scene, in degrees");
        parser.number("--pitch", orbit.pitch_degrees, -90, 90,
                      "Its elevation above the horizon, in degrees");
        parser.number("--distance", orbit.distance, 0.01f, 1e6f,
                      "Its distance from the scene's centre, in radii of the scene");
        parser.number("--fov", orbit.fov_degrees, 1, 170, "Its vertical field of view, in degrees");
    }
    if (program.show_depth)
        parser.flag("--depth", *program.show_depth,
                    "Show the depth buffer: near is bright, nothing is black");
    program.declare_options(parser);
}

}  // namespace rasterbook
