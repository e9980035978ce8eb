// SPDX-License-Identifier: MIT
#include "11_scenes/explain.hpp"

#include <cstddef>
#include <iostream>
#include <map>
#include <sstream>

namespace rasterbook {

namespace {

/// Adds a word to a list in words.
void add_word(std::string& words, const std::string& word) {
    words += (words.empty() ? "" : ", ") + word;
}

}  // namespace

void explain(const SceneAssets& assets, const std::string& camera, const Counters& counters,
             StepClock& clock) {
    clock.end();
    std::ostringstream out;
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
            << (assets.lit_by.casts[l] ? "" : ", casts no shadow") << '\n';
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
    std::cout << out.str();  // at once: not between the words of another frame
}

}  // namespace rasterbook
