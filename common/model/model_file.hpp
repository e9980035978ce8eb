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
/// @throws InputError  As these do.
Scene load_model(const std::filesystem::path& file, const LoadBudget& budget = {});

}  // namespace rasterbook
