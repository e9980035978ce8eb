// SPDX-License-Identifier: MIT
/// @file
/// Model files of all kinds that the course reads.
#pragma once

#include <filesystem>

#include "common/model/mesh.hpp"

namespace rasterbook {

/// Reads a model: by load_gltf() where its name ends in .gltf, .glb or .vrm (in any case), else by
/// load_obj().
///
/// @throws InputError  As these do; and when the scene is too large or too small to be drawn: its
///          box's diagonal is above 2.5e37, or below 2.5e-42 and not 0.
Scene load_model(const std::filesystem::path& file, const LoadBudget& budget = {});

}  // namespace rasterbook
