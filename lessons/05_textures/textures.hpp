// SPDX-License-Identifier: MIT
/// @file
/// The textures of a scene's materials. Introduced in lesson 05.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "05_textures/texture.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// For each material a texture; null where it names none.
using MaterialTextures = std::vector<std::shared_ptr<const Texture>>;

/// The texture coordinates of a triangle's vertices, with the offset and scale of the map (-o, -s
/// of MTL). A vertex that has none is given (0, 0).
inline std::array<vec2, 3> uvs_of(const Mesh& mesh, const Triangle& triangle,
                                  const TextureMap& map) {
    std::array<vec2, 3> uvs;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t index = triangle.vertices[i].uv;
        const vec2 uv = index == no_index ? vec2(0) : mesh.uvs[index];
        uvs[i] = uv * vec2(map.scale) + vec2(map.offset);
    }
    return uvs;
}

}  // namespace rasterbook
