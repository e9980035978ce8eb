// SPDX-License-Identifier: MIT
/// @file
/// Which camera a scene is seen from: one of its file, or the one that orbits it. Introduced in
/// lesson 11; derivation: docs/derivations/11_scenes.md.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>

#include <glm/matrix.hpp>

#include "04_mvp/camera.hpp"
#include "common/lesson_app.hpp"
#include "common/mesh.hpp"

namespace rasterbook {

/// A file's camera. It only turns and moves, so its inverse is as exact as its numbers.
inline Camera camera_of(const SceneCamera& from) {
    const dmat4 world_from_view(from.world_from_view);
    const vec3 eye(world_from_view[3]);
    return {eye,      mat4(glm::inverse(world_from_view)), from.fov_y_radians, from.near,
            from.far, eye - vec3(world_from_view[2])};
}

/// For --camera: the lessons' own camera.
constexpr const char* orbit_name = "orbit";

/// Which of a file's cameras is asked for: by its name, or by its number from 0.
///
/// @param asked  What --camera says; empty: the first one, unless another orbit is asked for.
/// @return       None: the camera that orbits the scene.
/// @throws std::runtime_error  Where there is no such camera: names those that there are.
inline std::optional<std::size_t> chosen_camera(const Scene& scene, const std::string& asked,
                                                bool is_orbit_asked_for) {
    if (asked == orbit_name) return {};
    if (asked.empty()) {
        if (scene.cameras.empty() || is_orbit_asked_for) return {};
        return 0;
    }
    std::string names;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        if (asked == scene.cameras[i].name || asked == std::to_string(i)) return i;
        names += (i == 0 ? "" : ", ") + std::to_string(i) + " \"" + scene.cameras[i].name + "\"";
    }
    throw std::runtime_error("there is no camera '" + asked + "'; the file has " +
                             (names.empty() ? "none" : names) + "; or --camera " + orbit_name);
}

/// Which camera a picture is taken by, as chosen_camera() has it.
///
/// @param options  LessonOptions with an `Orbit orbit`.
template <typename Options>
std::optional<std::size_t> camera_of_picture(const Options& options, const std::string& asked,
                                             const Scene& scene) {
    return chosen_camera(scene, asked, options.frames > 1 || options.orbit != Orbit());
}

template <typename Options>
Camera scene_camera(const Options& options, const std::string& asked, const Scene& scene) {
    const auto chosen = camera_of_picture(options, asked, scene);
    return chosen ? camera_of(scene.cameras[*chosen]) : orbit_camera(options.orbit, scene.bounds());
}

/// For --explain.
template <typename Options>
std::string camera_name(const Options& options, const std::string& asked, const Scene& scene) {
    const auto chosen = camera_of_picture(options, asked, scene);
    if (!chosen) return "the lesson's own, around the scene";
    return std::to_string(*chosen) + " \"" + scene.cameras[*chosen].name + "\" of the file";
}

}  // namespace rasterbook
