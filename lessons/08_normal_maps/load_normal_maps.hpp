// SPDX-License-Identifier: MIT
/// @file
/// Reads the normal maps that a scene's materials name, and makes the tangents that they call for.
/// Introduced in lesson 08.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "05_textures/load_textures.hpp"
#include "06_phong/effects.hpp"
#include "06_phong/load_surface_textures.hpp"
#include "08_normal_maps/normal_map_options.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "08_normal_maps/vertex_tangents.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// @param all_effects  A lit material without a map is given one that changes nothing.
/// @param decoder      Makes normals of images, as NormalMapOptions does.
/// @throws InputError  As load_textures() has it.
template <typename Decoder>
NormalMaps load_normal_maps(Scene& scene, const TextureOptions& options, MapSpace space,
                            bool all_effects, const Decoder& decoder) {
    const auto calls_for_map = [&](const Material& material) {
        return is_lit(material) && space != MapSpace::none;
    };
    NormalMaps maps{
        load_textures(
            scene, &Material::normal_map, "norm", options,
            [&](const Image<u8vec4>& image, WrapModes) { return decoder.normals(image); },
            calls_for_map),
        std::vector<MapSpace>(scene.materials.size(), MapSpace::tangent)};
    const MaterialTextures bumps = load_textures(
        scene, &Material::bump_map, "map_Bump", options,
        [&](const Image<u8vec4>& image, WrapModes wrap) {
            return decoder.normals_of_bumps(image, wrap);
        },
        [&](const Material& material) {
            return calls_for_map(material) && material.normal_map.file.empty();
        });
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        if (maps.textures[i]) maps.spaces[i] = space;
        if (bumps[i]) maps.textures[i] = bumps[i];
        if (!maps.textures[i] && is_lit(scene.materials[i]) && all_effects)
            maps.textures[i] = constant_texture(vec4(0, 0, 1, 1));
    }
    return maps;
}

/// Gives tangents to each mesh that a normal map in tangent space calls for.
inline void make_tangents(Scene& scene, const NormalMaps& maps) {
    for (Mesh& mesh : scene.meshes)
        if (std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                        [&](const Triangle& triangle) {
                            return maps.textures[triangle.material] &&
                                   maps.spaces[triangle.material] == MapSpace::tangent;
                        }))
            mesh.tangents = vertex_tangents(mesh, [&](const Triangle& triangle) {
                return exact_uvs_of(mesh, triangle,
                                    normal_map_of(scene.materials[triangle.material]));
            });
}

}  // namespace rasterbook
