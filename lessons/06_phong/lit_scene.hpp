// SPDX-License-Identifier: MIT
/// @file
/// A scene with lights and all that its materials ask for. Introduced in lesson 06.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "05_textures/textured_scene.hpp"
#include "06_phong/light.hpp"
#include "06_phong/many_samples.hpp"
#include "06_phong/normals.hpp"
#include "06_phong/phong.hpp"

namespace rasterbook {

/// What a material calls for; nothing else is computed for it.
struct Effects {
    bool light, highlight, diffuse_map, specular_map;
};

inline bool has_highlight(const Material& material) {
    return material.illumination >= 2 && material.specular != vec3(0);
}

/// A model whose every corner has a normal, and the textures and effects of its materials.
struct LitScene : TexturedScene {
    MaterialTextures specular_textures;  ///< map_Ks, plain numbers.
    std::vector<Effects> effects;        ///< For each material.

    /// @param options  Has TextureOptions `texture`; with shading.all_effects, a lit material has
    ///                 each effect: a white texture or a black highlight where it has none.
    template <typename Options>
    LitScene(Scene scene, const Options& options) : TexturedScene(std::move(scene), options) {
        for (Mesh& mesh : meshes) complete_normals(mesh);
        specular_textures = load_textures(
            &Material::specular_map, "map_Ks", options.texture,
            [](const Image<u8vec4>& picture, Wrap) { return plain_numbers(picture); },
            has_highlight);
        for (std::size_t i = 0; i < materials.size(); ++i) {
            const bool light = materials[i].illumination >= 1;
            effects.push_back({light, has_highlight(materials[i]), diffuse_textures[i] != nullptr,
                               specular_textures[i] != nullptr});
            if (options.shading.all_effects) add_neutral_effects(i);
        }
    }

  private:
    void add_neutral_effects(std::size_t i) {
        const auto white =
            std::make_shared<Texture>(make_texture(Image<vec4>({1, 1}, vec4(1)), Wrap::repeat));
        if (!effects[i].diffuse_map) diffuse_textures[i] = white;
        if (!effects[i].specular_map) specular_textures[i] = white;
        if (!effects[i].highlight) materials[i].specular = vec3(0);
        effects[i] = {effects[i].light, effects[i].light, true, effects[i].light};
    }
};

/// What a triangle's material makes of it.
struct TriangleSurface {
    const Material& material;
    Effects effects;
    const Texture *texture, *specular_texture;  ///< Null where the material names none.
    std::array<vec2, 3> uvs, specular_uvs;      ///< Only of what is read.
    SurfaceColor own_color;

    TriangleSurface(const LitScene& scene, const Mesh& mesh, const Triangle& triangle)
        : material(scene.materials[triangle.material]),
          effects(scene.effects[triangle.material]),
          texture(scene.diffuse_textures[triangle.material].get()),
          specular_texture(scene.specular_textures[triangle.material].get()),
          uvs(effects.diffuse_map ? uvs_of(mesh, triangle, material.diffuse_map)
                                  : std::array<vec2, 3>{}),
          specular_uvs(effects.specular_map ? uvs_of(mesh, triangle, material.specular_map)
                                            : std::array<vec2, 3>{}),
          own_color(surface_color(material)) {}

    /// The colours of fragments, of which textures are read as the effects say.
    template <typename CounterPolicy>
    std::array<SurfaceColor, most_points> colors(const ManyWeights& weights, Filter filter,
                                                 CounterPolicy& counters) const {
        std::array<SurfaceColor, most_points> colors;
        for (std::size_t i = 0; i < weights.count; ++i) colors[i] = own_color;
        if (effects.diffuse_map)
            sample_many(*texture, filter, uvs, weights, [&](std::size_t i, vec4 texel) {
                counters.add(Counter::texture_samples);
                colors[i].tint(vec3(texel));
            });
        if (effects.specular_map)
            sample_many(*specular_texture, filter, specular_uvs, weights,
                        [&](std::size_t i, vec4 texel) {
                            counters.add(Counter::texture_samples);
                            colors[i].specular *= vec3(texel);
                        });
        return colors;
    }
};

/// A warm key light from the upper left, and a cool one from behind that draws the rims.
///
/// @param key      The key light's kind.
/// @param bounds   Of the scene, world space.
/// @param key_way  Where the key light stands as seen from the scene's centre; of any length.
inline std::array<Light, 2> studio_lights(LightKind key, const Bounds& bounds,
                                          vec3 key_way = {-1.2f, 0.5f, 0.6f}) {
    const vec3 center = bounds.center();
    const float radius = bounds.radius();
    const vec3 toward_key = unit_or(key_way, vec3(0, 1, 0));
    const vec3 toward_rim = unit_or(vec3(0.95f, 0.38f, -0.55f), vec3(0, 1, 0));
    Light light{key, vec3(1.0f, 0.92f, 0.8f), toward_key};
    if (key != LightKind::directional) {
        light.position_world = center + 0.9f * radius * toward_key;
        light.half_distance = std::max(radius, std::numeric_limits<float>::min());
        light.color *= 2.4f;
    }
    if (key == LightKind::spot) {
        light.direction_world = -toward_key;
        light.cos_full = std::cos(glm::radians(18.0f));
        light.cos_none = std::cos(glm::radians(32.0f));
    }
    return {light, Light{LightKind::directional, vec3(0.6f, 0.82f, 1.15f), toward_rim}};
}

constexpr vec3 ambient_light(0.04f, 0.05f, 0.07f);  ///< From all around; linear.

}  // namespace rasterbook
