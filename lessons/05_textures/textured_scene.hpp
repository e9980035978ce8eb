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

/// For each material a texture; null where it names none.
using MaterialTextures = std::vector<std::shared_ptr<const Texture>>;

/// A model and the textures of its materials.
struct TexturedScene : Scene {
    MaterialTextures diffuse_textures;  ///< map_Kd

    /// @param options  Has TextureOptions `texture`.
    /// @throws InputError  When a picture cannot be read: names the statement of the material
    ///                     library that asks for it, and the picture. With texture.keep_going that
    ///                     is a warning, and a placeholder takes the picture's place.
    template <typename Options>
    TexturedScene(Scene scene, const Options& options) : Scene(std::move(scene)) {
        diffuse_textures = load_textures(
            &Material::diffuse_map, "map_Kd", options.texture,
            [&](const Image<u8vec4>& picture, Wrap) { return options.texture.decoded(picture); },
            [](const Material&) { return true; });
    }

  protected:
    /// The textures that materials name by one statement, each picture read once; null for
    /// materials that no triangle has.
    ///
    /// @param decode     Called as decode(Image<u8vec4>, Wrap); gives an Image<vec4>.
    /// @param calls_for  Called as calls_for(Material): whether it needs its texture.
    template <typename Decode, typename CallsFor>
    MaterialTextures load_textures(TextureMap Material::* map_of, const char* statement,
                                   const TextureOptions& texture_options, Decode&& decode,
                                   CallsFor&& calls_for) {
        std::vector<bool> is_seen(materials.size());
        for (const Mesh& mesh : meshes)
            for (const Triangle& triangle : mesh.triangles) is_seen[triangle.material] = true;
        std::map<std::pair<std::filesystem::path, Wrap>, std::shared_ptr<const Texture>> loaded;
        MaterialTextures textures(materials.size());
        for (std::size_t i = 0; i < materials.size(); ++i) {
            const TextureMap& map = materials[i].*map_of;
            if (map.file.empty() || !is_seen[i] || !calls_for(materials[i])) continue;
            const Wrap wrap = map.clamp    ? Wrap::clamp
                              : map.mirror ? Wrap::mirror
                                           : texture_options.wrap;
            std::shared_ptr<const Texture>& texture = loaded[{map.file, wrap}];
            if (!texture)
                texture = std::make_shared<Texture>(make_texture(
                    decode(read_picture(map, statement, texture_options.keep_going), wrap), wrap));
            textures[i] = texture;
        }
        return textures;
    }

  private:
    Image<u8vec4> read_picture(const TextureMap& map, const char* statement, bool keep_going) {
        try {
            return map.embedded ? decode_image(*map.embedded, map.file) : read_image(map.file);
        } catch (const InputError& error) {
            const std::string asked_by = map.asked_by.empty() ? statement : map.asked_by;
            const InputError named(map.library, map.line, asked_by + ": " + error.what());
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
