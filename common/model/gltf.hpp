// SPDX-License-Identifier: MIT
/// @file
/// Scenes in glTF 2.0 files, and VRM figures, which are such files; what is read: docs/gltf.md.
#pragma once

#include <cstddef>
#include <filesystem>

#include "common/model/mesh.hpp"

namespace rasterbook {

/// More vertices than any scene of the course's size has; some 1.5 GB of memory.
constexpr std::size_t max_gltf_vertices = 30'000'000;

/// Reads the default scene of a .gltf or .glb file: its meshes in world space, one for each node
/// that has one, its materials, cameras and lights.
///
/// Points of equal positions (and colours) are one point, as in OBJ. A mirrored node turns the
/// winding. Textures' v points up afterwards. Vertices of a primitive without normals get those of
/// their faces. What cannot be drawn (points and lines, morph targets, skins) is a warning.
///
/// @param max_vertices  As many vertices are accepted, all instances counted.
/// @throws InputError  One line, "FILE: ...", when the file is damaged or needs an extension that
///          is not read, an index is out of range, a number is not finite, nodes form a cycle, or
///          nothing of it has a face.
Scene load_gltf(const std::filesystem::path& file, std::size_t max_vertices = max_gltf_vertices);

}  // namespace rasterbook
