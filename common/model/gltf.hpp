// SPDX-License-Identifier: MIT
/// @file
/// Scenes in glTF 2.0 files, and VRM figures, which are such files; what is read: docs/gltf.md.
#pragma once

#include <filesystem>

#include "common/model/mesh.hpp"

namespace rasterbook {

/// Reads the default scene of a .gltf or .glb file: its meshes in world space, one for each node
/// that has one, its materials, cameras and lights.
///
/// A scene far from 0 is stored relative to Scene::origin. Points of equal positions (and colours)
/// are one point, as in OBJ. A mirrored node turns the winding. Textures' v points up afterwards.
/// Vertices of a primitive without normals get those of their faces. What cannot be drawn (points
/// and lines, morph targets, skins) is a warning.
///
/// @param budget  What the file may ask for.
/// @throws InputError  One line, "FILE: ...", when the file is damaged or needs an extension that
///          is not read, asks for more than is accepted, an index is out of range, a number is not
///          finite, nodes form a cycle, or nothing of it has a face.
Scene load_gltf(const std::filesystem::path& file, const LoadBudget& budget = {});

}  // namespace rasterbook
