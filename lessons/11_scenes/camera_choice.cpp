// SPDX-License-Identifier: MIT
#include "11_scenes/camera_choice.hpp"

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>

#include "11_scenes/scene_camera.hpp"

namespace rasterbook {

std::optional<std::size_t> chosen_camera(const Scene& scene, const std::string& asked,
                                         bool is_orbit_asked_for) {
    if (asked == orbit_name || asked == fit_name) return {};
    if (asked.empty()) {
        if (scene.cameras.empty() || is_orbit_asked_for) return {};
        return 0;
    }
    constexpr std::size_t most_named = 20;
    std::string names;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        if (asked == scene.cameras[i].name || asked == std::to_string(i)) return i;
        if (i < most_named)
            names +=
                (i == 0 ? "" : ", ") + std::to_string(i) + " \"" + scene.cameras[i].name + "\"";
        if (i == most_named) names += " and more";
    }
    throw std::runtime_error("there is no camera '" + asked + "'; the file has " +
                             (names.empty() ? "none" : names) + "; or --camera " + orbit_name +
                             "|" + fit_name);
}

NamedCamera camera_of_picture(const SceneOptions& options, const Scene& scene) {
    const std::string& asked = options.camera;
    const bool is_orbit_asked_for = options.frames.of_turn > 1 || options.orbit != Orbit();
    if (const auto chosen = chosen_camera(scene, asked, is_orbit_asked_for))
        return {camera_of(scene.cameras[*chosen]),
                std::to_string(*chosen) + " \"" + scene.cameras[*chosen].name + "\" of the file"};
    Orbit orbit = options.orbit;
    const bool is_fitted =
        asked == fit_name || (asked.empty() && scene.is_gltf && !is_orbit_asked_for);
    if (is_fitted) orbit.distance = fitting_distance(orbit, scene.bounds(), options.size);
    return {orbit_camera(orbit, scene.bounds()),
            is_fitted ? "the lesson's own, so far away that all is seen"
                      : "the lesson's own, around the scene"};
}

}  // namespace rasterbook
