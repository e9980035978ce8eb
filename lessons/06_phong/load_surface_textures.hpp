// SPDX-License-Identifier: MIT
/// @file
/// Reads the textures that surfaces are shaded with. Introduced in lesson 06.
#pragma once

#include <cstddef>
#include <memory>

#include "05_textures/load_textures.hpp"
#include "06_phong/effects.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// @throws InputError  As load_textures() has it.
inline SurfaceTextures load_surface_textures(Scene& scene, const TextureOptions& options) {
    return {load_diffuse_textures(scene, options),
            load_textures(
                scene, &Material::specular_map, "map_Ks", options,
                [](const Image<u8vec4>& image, WrapModes) { return plain_numbers(image); },
                has_highlight),
            load_textures(
                scene, &Material::emission_map, "map_Ke", options,
                [&](const Image<u8vec4>& image, WrapModes) { return options.decoded(image); },
                [](const Material& material) { return material.emission != vec3(0); })};
}

/// A texture of one texel.
inline std::shared_ptr<const Texture> constant_texture(vec4 texel) {
    return std::make_shared<Texture>(make_texture(Image<vec4>({1, 1}, texel), Wrap::repeat));
}

/// For --all-effects: gives each material what every effect needs and what changes nothing, a white
/// texture and a black highlight.
inline void add_neutral_inputs(Scene& scene, SurfaceTextures& textures) {
    const auto white = constant_texture(vec4(1));
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        Material& material = scene.materials[i];
        if (!has_highlight(material)) material.specular = vec3(0);
        if (!textures.diffuse[i]) textures.diffuse[i] = white;
        if (!textures.emission[i]) textures.emission[i] = white;
        if (!textures.specular[i] && is_lit(material)) textures.specular[i] = white;
    }
}

}  // namespace rasterbook
