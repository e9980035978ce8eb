// SPDX-License-Identifier: MIT
/// @file
/// Which camera a scene is seen from: one of its file, or the one that orbits it. Introduced in
/// lesson 11; derivation: docs/derivations/11_scenes.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "04_mvp/camera.hpp"
#include "common/app/lesson_app.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// A file's camera. It only turns and moves, so its inverse is as exact as its numbers.
inline Camera camera_of(const SceneCamera& from) {
    const dmat4 world_from_view(from.world_from_view);
    const vec3 eye(world_from_view[3]);
    return {eye,      mat4(glm::inverse(world_from_view)), from.fov_y_radians, from.near,
            from.far, eye - vec3(world_from_view[2])};
}

/// How much of the picture's width and height a fitted scene takes at most.
constexpr double fitted_share = 0.9;

/// From how far away a camera on the orbit just sees all of a box (Eq. 11.11).
///
/// @param bounds  World space.
/// @param size    Of the picture.
/// @return        In radii of the box; orbit.distance for an empty box, or one of no size.
inline float fitting_distance(const Orbit& orbit, const Bounds& bounds, ivec2 size) {
    const float yaw_radians = glm::radians(orbit.yaw_degrees);
    const float pitch_radians = glm::radians(orbit.pitch_degrees);
    const dvec3 back = direction_from_angles(yaw_radians, pitch_radians);
    const dvec3 up = direction_from_angles(yaw_radians, pitch_radians + glm::radians(90.0f));
    const dvec3 right = glm::cross(up, back);
    const double tangent_y = fitted_share * std::tan(double{glm::radians(orbit.fov_degrees)} / 2);
    const double tangent_x = tangent_y * size.x / size.y;
    double distance = 0;
    for (int i = 0; i < 8; ++i) {
        const dvec3 corner(i & 1 ? bounds.max.x : bounds.min.x, i & 2 ? bounds.max.y : bounds.min.y,
                           i & 4 ? bounds.max.z : bounds.min.z);
        const dvec3 from_center = corner - dvec3(bounds.center());
        const double x = std::abs(glm::dot(from_center, right)) / tangent_x;
        const double y = std::abs(glm::dot(from_center, up)) / tangent_y;
        distance = std::max(distance, glm::dot(from_center, back) + std::max(x, y));
    }
    const bool is_usable = distance > 0 && distance <= std::numeric_limits<float>::max();
    return is_usable ? static_cast<float>(distance / bounds.radius()) : orbit.distance;
}

/// For --camera: the lessons' own camera; the same, but so far away that all is seen.
constexpr const char *orbit_name = "orbit", *fit_name = "fit";

/// Which of a file's cameras is asked for: by its name, or by its number from 0.
///
/// @param asked  What --camera says; empty: the first one, unless another orbit is asked for.
/// @return       None: the camera that orbits the scene.
/// @throws std::runtime_error  Where there is no such camera: names those that there are.
inline std::optional<std::size_t> chosen_camera(const Scene& scene, const std::string& asked,
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

/// A picture's camera, and what it is called.
struct NamedCamera {
    Camera camera;
    std::string name;
};

/// As chosen_camera() has it. A glTF file without cameras is fitted into the picture, if no other
/// orbit is asked for; an OBJ file is seen as in the earlier lessons.
///
/// @param options  LessonOptions with an `Orbit orbit`.
/// @param asked    What --camera says.
template <typename Options>
NamedCamera camera_of_picture(const Options& options, const std::string& asked,
                              const Scene& scene) {
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
