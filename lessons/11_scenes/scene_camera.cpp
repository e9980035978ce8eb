// SPDX-License-Identifier: MIT
#include "11_scenes/scene_camera.hpp"

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

namespace rasterbook {

Camera camera_of(const SceneCamera& from) {
    const dmat4 world_from_view(from.world_from_view);
    const vec3 eye(world_from_view[3]);
    return {eye,       mat4(glm::inverse(world_from_view)), from.fov_y_radians,
            from.near, eye - vec3(world_from_view[2]),      from.far};
}

/// How much of the picture's width and height a fitted scene takes at most.
constexpr double fitted_share = 0.9;

float fitting_distance(const Orbit& orbit, const Bounds& bounds, ivec2 size) {
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

NamedCamera camera_of_picture(const SceneRendererOptions& options, const Scene& scene) {
    const std::string& asked = options.scene.camera;
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
