// SPDX-License-Identifier: MIT
/// @file
/// Why nothing of a model is to be seen.
#pragma once

#include <string>

#include "common/app/counters.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// Says of a picture that holds nothing but its background what became of the model: "3 triangles
/// lie behind the camera, 2 face away (named clockwise?)".
///
/// @param counters    Of the picture, or of several.
/// @param knows_area  triangles_without_area is counted; else these are among those culled by
///                    facing, as in lessons 02 and 03.
std::string why_empty(const Counters& counters, const Scene& scene, bool knows_area);

}  // namespace rasterbook
