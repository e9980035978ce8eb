// SPDX-License-Identifier: MIT
/// @file
/// What is left of a triangle after clipping, on the screen.
#pragma once

#include "04_mvp/projection.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook::test {

/// As project(), of a triangle that belongs to no mesh.
inline ProjectedTriangle projected(const ClippedTriangle& clipped, ivec2 size) {
    static const Mesh no_mesh;
    static const Triangle no_triangle{};
    return project(no_mesh, no_triangle, clipped, size);
}

}  // namespace rasterbook::test
