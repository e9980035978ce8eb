// SPDX-License-Identifier: MIT
/// @file
/// The materials of a glTF file as the course has them; what becomes of what: docs/gltf.md.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/model/gltf_document.hpp"
#include "common/model/mesh.hpp"
#include "common/model/mtl.hpp"

namespace rasterbook {

/// The number of an object of an extension, or `missing` when it has none of that name.
double number_in(const tinygltf::Value& object, const std::string& key, double missing);

/// The colours, maps and flags of all materials.
///
/// @param budget    Is charged with the images in the file, and with those read for their means.
/// @param warnings  Takes what is passed over.
/// @return          Material 0 is the default one; that of index i in the file is i + 1.
/// @throws InputError  When a material names a texture or picture that is not there, has a number
///          that is not finite, or there are more than are accepted.
std::vector<Material> gltf_materials(const tinygltf::Model& model,
                                     const std::filesystem::path& file, LoadBudget& budget,
                                     Warnings& warnings);

/// For messages: `material 3 "wood"`.
std::string name_of_material(const tinygltf::Model& model, int index);

/// Which of its sets of texture coordinates a material of the file takes, 0 for none.
int uv_set_of(const tinygltf::Material& material);

}  // namespace rasterbook
