// SPDX-License-Identifier: MIT
/// @file
/// Which camera a scene is seen from: one of its file, or the one that orbits it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "04_mvp/camera.hpp"
#include "11_scenes/scene_options.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// For --camera: the lessons' own camera; the same, but so far away that all is seen.
constexpr const char *orbit_name = "orbit", *fit_name = "fit";

/// Which of a file's cameras is asked for: by its name, or by its number from 0.
///
/// @param asked  What --camera says; empty: the first one, unless another orbit is asked for.
/// @return       None: the camera that orbits the scene.
/// @throws std::runtime_error  Where there is no such camera: names those that there are.
std::optional<std::size_t> chosen_camera(const Scene& scene, const std::string& asked,
                                         bool is_orbit_asked_for);

/// A picture's camera, and what it is called.
struct NamedCamera {
    Camera camera;
    std::string name;
};

/// As chosen_camera() has it. A glTF file without cameras is fitted into the picture, if no other
/// orbit is asked for; an OBJ file is seen as in the earlier lessons.
NamedCamera camera_of_picture(const SceneOptions& options, const Scene& scene);

}  // namespace rasterbook
