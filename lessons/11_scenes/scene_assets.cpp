// SPDX-License-Identifier: MIT
#include "11_scenes/scene_assets.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include "08_normal_maps/assets.hpp"
#include "11_scenes/scene_lights.hpp"

namespace rasterbook {

namespace {

/// Lights for whose maps there is no room cast no shadows, and a warning names them.
void leave_out_shadows(SceneLights& lit_by, const ShadowBounds& bounds, int shadow_size,
                       Scene& scene) {
    std::size_t count = 0;
    for (std::size_t l = 0; l < lit_by.lights.size(); ++l) {
        if (!lit_by.casts[l]) continue;
        const std::size_t maps =
            make_shadow_maps(lit_by.lights[l], shadow_size, bounds, scene.bounds()).maps.size();
        lit_by.casts[l] = count + maps <= max_shadow_maps;
        if (lit_by.casts[l])
            count += maps;
        else
            scene.warnings.push_back("light \"" + lit_by.names[l] +
                                     "\" casts no shadows: no more than " +
                                     std::to_string(max_shadow_maps) + " shadow maps are drawn");
    }
}

/// What a material calls for beside what lesson 08 knows of. (Toon materials have no highlights.)
void add_effects_of_scenes(EffectMask& effects, const Material& material) {
    effects.set(Effect::mask, material.alpha == AlphaMode::mask);
    effects.set(Effect::blend, is_transparent(material));
    if (!material.toon) return;
    effects.set(Effect::toon);
    effects.set(Effect::light);
    effects.set(Effect::highlight, false);
    effects.set(Effect::specular_map, false);
}

}  // namespace

SceneLights lights_of(const Scene& scene, LightKind key, std::vector<std::string>& warnings) {
    SceneLights all;
    const Bounds bounds = scene.bounds();
    if (scene.lights.empty()) {
        const std::array raking = raking_lights(key, bounds);
        all.lights.assign(raking.begin(), raking.end());
        all.names = {"key light of the lesson", "sky of the lesson"};
        std::copy(light_casts.begin(), light_casts.end(), all.casts.begin());
        return all;
    }
    all.are_of_file = true;
    all.exposure = exposure_of(scene.lights, bounds);
    for (SceneLight light : scene.lights) {
        if (all.lights.size() == max_lights) {
            warnings.push_back("light \"" + light.name + "\" is left out: no more than " +
                               std::to_string(max_lights) + " lights are drawn with");
            continue;
        }
        all.casts[all.lights.size()] = true;
        light.color *= all.exposure;
        all.lights.push_back(light_of(light, bounds.radius()));
        all.names.push_back(light.name);
    }
    return all;
}

SceneAssets load_scene_assets(Scene from, const SceneOptions& options) {
    NormalMapAssets made =
        make_normal_map_assets(with_outline_materials(std::move(from)), options.texture,
                               options.shading.all_effects, options.normal_map);
    Scene& scene = made.scene;
    const bool is_on_paper = is_drawing(scene);
    const ShadowBounds bounds = shadow_bounds(scene);
    SceneLights lit_by = lights_of(scene, options.shading.key_light, scene.warnings);
    leave_out_shadows(lit_by, bounds, options.shadow.size, scene);
    std::vector<OutlineHull> hulls = outline_hulls(scene);
    std::vector<Pass> passes;
    const std::size_t first_outline = first_outline_material(scene.materials);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        add_effects_of_scenes(made.effects[i], material);
        const bool two_sided = material.two_sided || options.shading.two_sided;
        passes.push_back({is_transparent(material), is_transparent(material),
                          two_sided && i < first_outline ? Culling::none : Culling::back_faces});
        if (!material.opacity_map.file.empty())
            scene.warnings.push_back("material \"" + material.name +
                                     "\": map_d is ignored: an alpha test is made for glTF files "
                                     "only, by the alpha of their textures");
    }
    return {std::move(scene),        std::move(made.textures), std::move(made.normal_maps),
            std::move(made.effects), std::move(passes),        bounds,
            std::move(lit_by),       std::move(hulls),         is_on_paper};
}

}  // namespace rasterbook
