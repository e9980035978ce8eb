// SPDX-License-Identifier: MIT
/// @file
/// The textures of a scene's materials. Introduced in lesson 05.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "05_textures/texture.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// For each material a texture; null where it names none.
using MaterialTextures = std::vector<std::shared_ptr<const Texture>>;

/// How a map is wrapped, across (0) or up (1).
inline Wrap wrap_of(const TextureMap& map, int axis) {
    return map.clamp[axis] ? Wrap::clamp : map.mirror[axis] ? Wrap::mirror : Wrap::repeat;
}

/// The texture coordinates of a triangle's vertices, with the offset and scale of the map (-o, -s
/// of MTL). A vertex that has none is given (0, 0).
inline std::array<dvec2, 3> exact_uvs_of(const Mesh& mesh, const Triangle& triangle,
                                         const TextureMap& map) {
    std::array<dvec2, 3> uvs;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t index = triangle.vertices[i].uv;
        const dvec2 uv = index == no_index ? dvec2(0) : mesh.uvs[index];
        uvs[i] = uv * dvec2(map.scale) + dvec2(map.offset);
    }
    return uvs;
}

/// How far a texture coordinate lies in copies of the texture: the whole number below it, an even
/// one where every other copy is mirrored. Where nothing repeats, 0.
inline double copies_below(double coordinate, Wrap wrap) {
    if (wrap == Wrap::clamp) return 0;
    const double period = wrap == Wrap::mirror ? 2 : 1;
    return period * std::floor(coordinate / period);
}

/// Robust: the same texture coordinates near 0, where floats lie close together: less the copies
/// below the first vertex, which look all the same.
///
/// @param texture  Null: none.
inline std::array<vec2, 3> uvs_of(const Mesh& mesh, const Triangle& triangle, const TextureMap& map,
                                  const Texture* texture) {
    const std::array<dvec2, 3> uvs = exact_uvs_of(mesh, triangle, map);
    const WrapModes wrap = texture ? texture->wrap : Wrap::repeat;
    const dvec2 copies(copies_below(uvs[0].x, wrap.u), copies_below(uvs[0].y, wrap.v));
    return {vec2(uvs[0] - copies), vec2(uvs[1] - copies), vec2(uvs[2] - copies)};
}

}  // namespace rasterbook
