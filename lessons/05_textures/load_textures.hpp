// SPDX-License-Identifier: MIT
/// @file
/// Reads the textures that a scene's materials name. Introduced in lesson 05.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "05_textures/texture.hpp"
#include "05_textures/texture_options.hpp"
#include "05_textures/textures.hpp"
#include "common/model/mesh.hpp"
#include "common/model/texture_file.hpp"

namespace rasterbook {

/// The textures that materials name by one statement, each file read once. Materials that no
/// triangle has get none.
///
/// @param scene      Takes warnings; its budget is charged.
/// @param decode     Makes texels of an image's stored values.
/// @param calls_for  Whether a material needs its texture.
/// @throws InputError  As read_texture_file() has it.
inline MaterialTextures load_textures(
    Scene& scene, TextureMap Material::* map_of, const char* statement,
    const TextureOptions& options,
    const std::function<Image<vec4>(const Image<u8vec4>&, WrapModes)>& decode,
    const std::function<bool(const Material&)>& calls_for) {
    std::vector<bool> is_used(scene.materials.size());
    for (const Mesh& mesh : scene.meshes)
        for (const Triangle& triangle : mesh.triangles) is_used[triangle.material] = true;
    using Key = std::tuple<std::filesystem::path, WrapModes, Filter, Filter>;
    std::map<Key, std::shared_ptr<const Texture>> loaded;
    MaterialTextures textures(scene.materials.size());
    for (std::size_t i = 0; i < textures.size(); ++i) {
        TextureMap& map = scene.materials[i].*map_of;
        if (map.file.empty() || !is_used[i] || !calls_for(scene.materials[i])) continue;
        for (int axis = 0; axis < 2; ++axis) {
            if (wrap_of(map, axis) != Wrap::repeat) continue;
            map.clamp[axis] = options.wrap == Wrap::clamp;
            map.mirror[axis] = options.wrap == Wrap::mirror;
        }
        const WrapModes wrap(wrap_of(map, 0), wrap_of(map, 1));
        const auto most = [](bool is_nearest) {
            return is_nearest ? Filter::nearest : Filter::trilinear;
        };
        const Filter magnified = most(map.nearest_magnified), minified = most(map.nearest_minified);
        std::shared_ptr<const Texture>& texture = loaded[{map.file, wrap, magnified, minified}];
        if (!texture) {
            const Image<u8vec4> image =
                read_texture_file(map, statement, options.keep_going, scene);
            Texture made = make_texture(decode(image, wrap), wrap);
            made.magnified = magnified, made.minified = minified;
            texture = std::make_shared<Texture>(std::move(made));
        }
        textures[i] = texture;
    }
    return textures;
}

/// Those of map_Kd.
inline MaterialTextures load_diffuse_textures(Scene& scene, const TextureOptions& options) {
    return load_textures(
        scene, &Material::diffuse_map, "map_Kd", options,
        [&](const Image<u8vec4>& image, WrapModes) { return options.decoded(image); },
        [](const Material&) { return true; });
}

struct TexturedSceneOptions : LessonOptions {
    Orbit orbit;
    bool show_depth = false;
    TextureOptions texture;

    TexturedSceneOptions() { model = "scene.obj"; }
    void declare(OptionParser& parser) { texture.declare(parser); }
};

/// What is made once, before the first frame.
struct TexturedScene {
    Scene scene;
    MaterialTextures textures;
};

inline TexturedScene load_textured_scene(Scene scene, const TexturedSceneOptions& options) {
    MaterialTextures textures = load_diffuse_textures(scene, options.texture);
    return {std::move(scene), std::move(textures)};
}

}  // namespace rasterbook
