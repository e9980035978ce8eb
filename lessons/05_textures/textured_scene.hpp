// SPDX-License-Identifier: MIT
/// @file
/// A scene with the pictures that its materials name. Introduced in lesson 05.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "05_textures/texture.hpp"
#include "05_textures/texture_variants.hpp"
#include "common/image_io.hpp"
#include "common/input_error.hpp"
#include "common/mesh.hpp"

namespace rasterbook {

/// A texture in place of a picture that cannot be read: a gaudy chessboard that nobody overlooks.
inline Image<u8vec4> placeholder_picture() {
    Image<u8vec4> picture({8, 8}, {255, 0, 255, 255});
    for (int i = 0; i < 64; ++i)
        if ((i / 8 + i) % 2 == 0) picture[{i % 8, i / 8}] = {0, 0, 0, 255};
    return picture;
}

/// A model and the textures of its materials, each picture read once.
struct TexturedScene : Scene {
    /// For each material its map_Kd; null without one.
    std::vector<std::shared_ptr<const Texture>> diffuse_textures;

    /// @throws InputError  When a picture cannot be read: names the statement of the material
    ///                     library that asks for it, and the picture. With variant.keep_going that
    ///                     is a warning, and a placeholder takes the picture's place.
    template <typename Options>
    TexturedScene(Scene scene, const Options& options) : Scene(std::move(scene)) {
        const TextureVariant& variant = options.texture;
        std::map<std::pair<std::filesystem::path, bool>, std::shared_ptr<const Texture>> loaded;
        for (const Material& material : materials) {
            const TextureMap& map = material.diffuse_map;
            std::shared_ptr<const Texture>& texture = diffuse_textures.emplace_back();
            if (map.file.empty()) continue;
            std::shared_ptr<const Texture>& known = loaded[{map.file, map.clamp}];
            if (!known)
                known = std::make_shared<Texture>(
                    make_texture(variant.decoded(read_picture(map, variant.keep_going)),
                                 map.clamp ? Wrap::clamp : variant.wrap));
            texture = known;
        }
    }

  private:
    Image<u8vec4> read_picture(const TextureMap& map, bool keep_going) {
        try {
            return read_image(map.file);
        } catch (const InputError& error) {
            const InputError named(map.library, map.line, std::string("map_Kd: ") + error.what());
            if (!keep_going) throw named;
            warnings.push_back(named.what());
            return placeholder_picture();
        }
    }
};

/// The texture coordinates of a triangle's corners, with the offset and scale of the map (-o, -s of
/// MTL). A corner that has none is given (0, 0).
inline std::array<vec2, 3> uvs_of(const Mesh& mesh, const Triangle& triangle,
                                  const TextureMap& map) {
    std::array<vec2, 3> uvs;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t index = triangle.corners[i].uv;
        const vec2 uv = index == no_index ? vec2(0) : mesh.uvs[index];
        uvs[i] = uv * vec2(map.scale) + vec2(map.offset);
    }
    return uvs;
}

}  // namespace rasterbook
