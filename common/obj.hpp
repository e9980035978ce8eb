// SPDX-License-Identifier: MIT
/// @file
/// Wavefront OBJ and MTL, as real exporters write them.
#pragma once

#include <filesystem>

#include "common/mesh.hpp"

namespace rasterbook {

/// Reads a model and the material libraries that it names.
///
/// Time is linear in the file's size. Statements that the course does not use are ignored. A missing
/// material library or an unknown material is a warning and gives the default material.
///
/// @return  One mesh for each group (`o` or `g`) that has faces; polygons as written and cut into
///          triangles.
/// @throws InputError  With file and line, when an index is 0 or out of range, a face has fewer than
///          3 corners, a number does not parse or is not finite, the file is not text, or there are
///          more elements than a 32-bit index holds; without line, when it is missing or not a
///          regular file.
Scene load_obj(const std::filesystem::path& file);

}  // namespace rasterbook
