// SPDX-License-Identifier: MIT
/// @file
/// The outlines of toon materials: inverted hulls, as meshes of their own. Drawn from lesson 11 on;
/// explained in lessons/07_toon/toon_materials.md.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "04_mvp/camera.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// A mesh's outline: its faces turned inside out, of the outline's colour, to be pushed outwards.
struct OutlineHull {
    Mesh mesh;
    std::vector<vec3> places, normals;  ///< Of each position before it is pushed; of the push.
    std::vector<float> widths;          ///< World space, or in heights of the picture.
    std::vector<bool> on_screen;        ///< Whether its width is in heights of the picture.
};

/// Whether a material has an outline of its own.
inline bool has_outline(const Material& material) {
    return material.toon && material.toon->outline != ToonMaterial::Outline::none &&
           material.toon->outline_width > 0;
}

/// Whether all that is seen of a scene has toon materials, and some of it an outline: a drawing.
bool is_drawing(const Scene& scene);

/// Adds the materials of outlines to a scene: behind all of its own, in their order.
Scene with_outline_materials(Scene scene);

/// The first of these materials: those before it are the scene's own.
std::size_t first_outline_material(std::span<const Material> materials);

/// The hulls of all meshes of a scene that has been given outlines' materials.
std::vector<OutlineHull> outline_hulls(const Scene& scene);

/// A hull as a camera is to see it: each point is pushed along its normal, by the outline's width
/// in the world, or by the length that looks so wide where the point is (Eq. 7.17).
Mesh pushed(const OutlineHull& hull, const Camera& camera);

}  // namespace rasterbook
