// SPDX-License-Identifier: MIT
/// @file
/// Why nothing of a model is to be seen.
#pragma once

#include <string>

#include "common/app/counters.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// Counts the triangles of a mesh that are clipped away, without area on the screen, or facing
/// away.
///
/// @param clip_from_model  Of a perspective; its planes are those of Eq. 4.10.
void count_undrawn(const Mesh& mesh, const mat4& clip_from_model, UndrawnTriangles& undrawn);

/// Counts a mesh's undrawn triangles if this thread is asked to.
inline void count_undrawn_if_asked(const Mesh& mesh, const mat4& clip_from_model) {
    if (undrawn_triangles) count_undrawn(mesh, clip_from_model, *undrawn_triangles);
}

/// Says of a picture that holds nothing but its background what became of the model: "3 triangles
/// lie behind the camera, 2 face away (named clockwise?)".
///
/// @param counters  Of the picture.
/// @param undrawn   Of the same; all 0 in lessons 02 and 03, which only cull by facing.
std::string why_empty(const Counters& counters, const UndrawnTriangles& undrawn,
                      const Scene& scene);

}  // namespace rasterbook
