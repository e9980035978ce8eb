// SPDX-License-Identifier: MIT
#include "12_effects/explain.hpp"

#include <cmath>
#include <cstddef>
#include <iostream>
#include <map>
#include <sstream>
#include <string_view>

#include "common/probe/pixel_trace.hpp"

namespace rasterbook {

namespace {

/// Adds a word to a list in words.
void add_word(std::string& words, std::string_view word) {
    if (!words.empty()) words += ", ";
    words += word;
}

}  // namespace

std::vector<std::string> lights_in_words(const SceneLights& lit_by, const ScenePlan& plan) {
    if (!plan.any(Effect::light) && !plan.any(Effect::toon)) return {"none is called for"};
    constexpr const char* kinds[] = {"directional light", "point light", "spotlight"};
    std::vector<std::string> words;
    for (std::size_t l = 0; l < lit_by.lights.size(); ++l) {
        const std::string& name = lit_by.names[l];
        words.push_back((name.empty() ? "unnamed" : name) + ", a " +
                        kinds[static_cast<std::size_t>(lit_by.lights[l].kind)] +
                        (lit_by.casts[l] ? "" : ", casts no shadow"));
    }
    if (lit_by.exposure < 1) {
        std::ostringstream times;
        times << 1 / lit_by.exposure;
        words.push_back("taken down by " + times.str() + ", so that the brightest is white");
    }
    return words;
}

void explain(const PlannedScene& assets, const std::string& camera, StepClock& clock) {
    const Scene& scene = assets.scene;
    const ScenePlan& plan = assets.plan;
    clock.end();
    std::ostringstream out;
    std::size_t triangles = 0;
    for (const Mesh& mesh : scene.meshes) triangles += mesh.triangles.size();
    out << scene.meshes.size() << " meshes, " << triangles << " triangles, "
        << scene.materials.size() << " materials\n";
    if (const dvec3 at = scene.origin; at != dvec3(0))
        out << "far from 0: stored relative to " << words(at) << '\n';
    out << "camera: " << camera << '\n';
    for (const std::string& light : lights_in_words(assets.lit_by, plan))
        out << "light: " << light << '\n';
    out << "\neffects\n";
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const MaterialPlan& material = plan.materials[i];
        if (!material.is_seen) continue;
        std::string on;
        std::map<std::string_view, std::string> off;  // by the reason
        for (std::size_t e = 0; e < effect_count; ++e)
            if (material[static_cast<Effect>(e)])
                add_word(on, effect_names[e]);
            else
                add_word(off[material.why_not[e]], effect_names[e]);
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
        out << "  " << counter_names[i] << ": " << thread_counters.values[i] << '\n';
    out << "\nmilliseconds\n";
    for (const auto& [step, ms] : clock.steps()) {
        std::ostringstream number;
        number.precision(3);
        if (ms < 100)
            number << ms;
        else
            number << std::llround(ms);  // 1234, not 1.23e+03
        out << "  " << step << ": " << number.str() << '\n';
    }
    std::cout << out.str();  // at once: not between the words of another frame
}

}  // namespace rasterbook
