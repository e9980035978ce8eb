// SPDX-License-Identifier: MIT
/// @file
/// The plan of a picture in words: what runs, what does not and why, counters, and times.
#pragma once

#include <chrono>
#include <cstddef>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <syncstream>
#include <utility>
#include <vector>

#include "11_scenes/scene_assets.hpp"
#include "11_scenes/scene_camera.hpp"
#include "common/app/counters.hpp"
#include "common/image/image.hpp"

namespace rasterbook {

/// Takes the times of a picture's steps.
class StepClock {
  public:
    /// Ends the step before, if there is one.
    void begin(const std::string& step) {
        end();
        is_over_ = false;
        steps_.emplace_back(step, 0.0);
        start_ = std::chrono::steady_clock::now();
    }
    void end() {
        if (is_over_) return;
        const auto now = std::chrono::steady_clock::now();
        steps_.back().second = std::chrono::duration<double, std::milli>(now - start_).count();
        is_over_ = true;
    }

    /// Each step and its milliseconds.
    const std::vector<std::pair<std::string, double>>& steps() const { return steps_; }

  private:
    std::vector<std::pair<std::string, double>> steps_;
    std::chrono::steady_clock::time_point start_;
    bool is_over_ = true;
};

/// Takes its place where nobody asks for times: compiles to nothing.
struct NoClock {
    void begin(const char*) {}
    void end() {}
};

/// Adds a word to a list in words.
inline void add_word(std::string& words, const std::string& word) {
    words += (words.empty() ? "" : ", ") + word;
}

/// Writes what of a scene is drawn and what is not.
///
/// @param camera    Its name.
/// @param counters  Of the picture.
inline void explain(std::ostream& out, const SceneAssets& assets, const std::string& camera,
                    const Counters& counters, const StepClock& clock) {
    const Scene& scene = assets.scene;
    std::size_t triangles = 0;
    for (const Mesh& mesh : scene.meshes) triangles += mesh.triangles.size();
    out << scene.meshes.size() << " meshes, " << triangles << " triangles, "
        << scene.materials.size() << " materials\n";
    out << "camera: " << camera << '\n';
    const bool is_lit = assets.plan.any(Effect::light) || assets.plan.any(Effect::toon);
    if (!is_lit) out << "light: none is called for\n";
    for (std::size_t l = 0; is_lit && l < assets.lit_by.lights.size(); ++l) {
        constexpr const char* kinds[] = {"directional light", "point light", "spotlight"};
        const std::string& name = assets.lit_by.names[l];
        out << "light: " << (name.empty() ? "unnamed" : name) << ", a "
            << kinds[static_cast<std::size_t>(assets.lit_by.lights[l].kind)]
            << (assets.lit_by.casts[l] ? "" : ", throws no shadows") << '\n';
    }
    if (is_lit && assets.lit_by.exposure < 1)
        out << "light: taken down by " << 1 / assets.lit_by.exposure
            << ", so that the brightest is white\n";
    out << "\neffects\n";
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const MaterialPlan& plan = assets.plan.materials[i];
        if (!plan.is_seen) continue;
        std::string on;
        std::map<std::string, std::string> off;  // by the reason
        for (std::size_t e = 0; e < effect_count; ++e)
            if (plan[static_cast<Effect>(e)])
                add_word(on, std::string(effect_names[e]));
            else
                add_word(off[plan.why_not[e]], std::string(effect_names[e]));
        const std::string& name = scene.materials[i].name;
        out << "  " << (name.empty() ? "(no name)" : name) << ": "
            << (on.empty() ? "its own colour" : on) << "\n    skipped:";
        const char* between = " ";
        for (const auto& [reason, effects] : off) {
            out << between << effects << " (" << reason << ')';
            between = "; ";
        }
        out << '\n';
    }
    out << "\ncounters\n";
    for (std::size_t i = 0; i < counter_names.size(); ++i)
        out << "  " << counter_names[i] << ": " << counters.values[i] << '\n';
    out << "\nmilliseconds\n";
    for (const auto& [step, ms] : clock.steps()) {
        std::ostringstream number;
        number.precision(3);
        number << ms;
        out << "  " << step << ": " << number.str() << '\n';
    }
}

/// Draws a picture and explains it on standard output.
///
/// @param options   LessonOptions with an `Orbit orbit`, and `scene.camera`.
/// @param counters  Take what was counted, if they count.
/// @param draw      Called as draw(Counters&, StepClock&); gives the picture.
template <typename Options, typename CounterPolicy, typename Draw>
Image<vec3> explained(const Options& options, const SceneAssets& assets, CounterPolicy& counters,
                      const Draw& draw) {
    StepClock clock;
    Counters counted;
    Image<vec3> picture = draw(counted, clock);
    const auto [camera, name] = camera_of_picture(options, options.scene.camera, assets.scene);
    std::osyncstream out(std::cout);  // not between the words of another frame
    explain(out, assets, name, counted, clock);
    if constexpr (requires { counters.add(counted); }) counters.add(counted);
    return picture;
}

}  // namespace rasterbook
