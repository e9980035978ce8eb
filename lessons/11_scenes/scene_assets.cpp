// SPDX-License-Identifier: MIT
#include "11_scenes/scene_assets.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "07_toon/outline.hpp"
#include "08_normal_maps/assets.hpp"
#include "11_scenes/scene_lights.hpp"

namespace rasterbook {

namespace {

/// The material of a toon material's outline: unlit, of its colour.
Material outline_material(const Material& of) {
    Material material;
    material.name = "outline of " + of.name;
    material.illumination = 0;
    material.diffuse = material.ambient = of.toon->outline_color;
    return material;
}

/// Whether all that is seen of a scene has toon materials, and some of it an outline.
bool is_all_toon(const Scene& scene) {
    bool has_outlines = false;
    for (const Mesh& mesh : scene.meshes)
        for (const Triangle& triangle : mesh.triangles) {
            const Material& material = scene.materials[triangle.material];
            if (!material.toon) return false;
            has_outlines = has_outlines || has_outline(material);
        }
    return has_outlines;
}

/// For --all-effects, beside what lesson 06 adds: unlit materials become toon materials of one
/// colour, and vertices get white colours.
void add_neutral_inputs(Scene& scene) {
    for (Mesh& mesh : scene.meshes) {
        for (const Triangle& triangle : mesh.triangles) {
            Material& material = scene.materials[triangle.material];
            if (!is_lit(material) && !material.toon)
                material.toon = ToonMaterial{.shade = material.diffuse};
        }
        if (mesh.colors.empty()) mesh.colors.assign(mesh.positions.size(), vec4(1));
    }
}

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

Scene with_outline_materials(Scene scene) {
    const std::size_t count = scene.materials.size();
    for (std::size_t i = 0; i < count; ++i)
        if (has_outline(scene.materials[i]))
            scene.materials.push_back(outline_material(scene.materials[i]));
    return scene;
}

std::size_t first_outline_material(std::span<const Material> materials) {
    return materials.size() -
           static_cast<std::size_t>(std::count_if(materials.begin(), materials.end(), has_outline));
}

std::vector<OutlineHull> outline_hulls(const Scene& scene) {
    constexpr std::uint32_t none = 0;  // they come last, behind the scene's own materials
    std::vector<std::uint32_t> outline_of(scene.materials.size(), none);
    for (std::size_t i = 0, next = first_outline_material(scene.materials);
         i < scene.materials.size(); ++i)
        if (has_outline(scene.materials[i])) outline_of[i] = static_cast<std::uint32_t>(next++);
    std::vector<OutlineHull> hulls;
    for (const Mesh& mesh : scene.meshes) {
        OutlineHull hull;
        hull.widths.assign(mesh.positions.size(), 0.0f);
        hull.on_screen.assign(mesh.positions.size(), false);
        for (const Triangle& triangle : mesh.triangles) {
            const std::uint32_t outline = outline_of[triangle.material];
            if (outline == none) continue;
            const auto& [a, b, c] = triangle.vertices;
            const Vertex p{a.position}, q{b.position}, r{c.position};
            hull.mesh.triangles.push_back({{p, r, q}, outline});
            const ToonMaterial& look = *scene.materials[triangle.material].toon;
            for (const Vertex vertex : {p, q, r}) {
                hull.widths[vertex.position] = look.outline_width;
                hull.on_screen[vertex.position] = look.outline == ToonMaterial::Outline::screen;
            }
        }
        if (hull.mesh.triangles.empty()) continue;
        hull.mesh.name = "outline of " + mesh.name;
        hull.mesh.positions = hull.places = mesh.positions;
        hull.normals = hull_normals(mesh);
        hulls.push_back(std::move(hull));
    }
    return hulls;
}

ScenePlan plan_scene(const Scene& scene, const SurfaceTextures& textures,
                     const NormalMaps& normal_maps, const PlanInputs& inputs) {
    ScenePlan scene_plan{std::vector<MaterialPlan>(scene.materials.size())};
    const std::vector<EffectMask> effects =
        plan_effects(scene, textures, normal_maps, inputs.all_effects);
    std::vector<bool> has_colors(scene.materials.size());
    for (const Mesh& mesh : scene.meshes)
        for (const Triangle& triangle : mesh.triangles) {
            scene_plan.materials[triangle.material].is_seen = true;
            if (!mesh.colors.empty()) has_colors[triangle.material] = true;
        }
    const std::size_t first_outline = first_outline_material(scene.materials);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        MaterialPlan& plan = scene_plan.materials[i];
        const Material& material = scene.materials[i];
        const bool is_unlit = !is_lit(material), is_toon = material.toon.has_value();
        const bool is_phong = !is_unlit && !is_toon;
        const bool is_outline = i >= first_outline;
        const char* const unlit = is_toon ? "a comic's paint" : "unlit";
        plan.two_sided = !is_outline && (material.two_sided || inputs.two_sided);
        plan.set(Effect::light, is_phong && inputs.has_lights, is_phong ? "no lights" : unlit);
        plan.set(Effect::highlight, is_phong && effects[i][Effect::highlight],
                 !is_phong                    ? unlit
                 : material.illumination == 1 ? "illum 1"
                                              : "black");
        plan.set(Effect::texture, effects[i][Effect::texture], "names no picture");
        plan.set(Effect::specular_map, is_phong && effects[i][Effect::specular_map],
                 is_phong ? "names no picture" : unlit);
        plan.set(Effect::emission_map, effects[i][Effect::emission_map], "names no picture");
        plan.set(Effect::vertex_colors, has_colors[i] || inputs.all_effects, "vertices have none");
        plan.set(Effect::normal_map, !is_unlit && effects[i][Effect::normal_map],
                 is_unlit              ? "unlit"
                 : !inputs.normal_maps ? "none are read"
                                       : "names none");
        plan.set(Effect::shadow, !is_unlit && (inputs.has_shadows || inputs.all_effects),
                 is_unlit ? "unlit" : "nothing casts one");
        plan.set(Effect::toon, is_toon, "not asked for");
        plan.set(Effect::outline, has_outline(material), "not asked for");
        const bool is_masked = material.alpha == AlphaMode::mask;
        plan.is_transparent =
            !is_masked && (material.alpha == AlphaMode::blend || material.opacity < 1);
        plan.set(Effect::mask, is_masked, plan.is_transparent ? "no holes" : "opaque");
        plan.set(Effect::blend, plan.is_transparent || inputs.all_effects,
                 is_masked ? "holes only" : "opaque");
    }
    return scene_plan;
}

SceneAssets make_scene_assets(Scene from, const TextureOptions& texture,
                              const LightOptions& shading, const NormalMapOptions& normal_map,
                              int shadow_size) {
    const bool all_effects = shading.all_effects;
    NormalMapAssets made = make_normal_map_assets(with_outline_materials(std::move(from)), texture,
                                                  all_effects, normal_map);
    Scene& scene = made.scene;
    const bool is_on_paper = is_all_toon(scene);
    if (all_effects) add_neutral_inputs(scene);
    const ShadowBounds bounds = shadow_bounds(scene);
    SceneLights lit_by = lights_of(scene, shading.key_light, scene.warnings);
    leave_out_shadows(lit_by, bounds, shadow_size, scene);
    const PlanInputs inputs{.has_lights = !lit_by.lights.empty(),
                            .has_shadows = bounds.casters.min.x <= bounds.casters.max.x &&
                                           bounds.receivers.min.x <= bounds.receivers.max.x,
                            .normal_maps = normal_map.space != MapSpace::none,
                            .two_sided = shading.two_sided,
                            .all_effects = all_effects};
    ScenePlan plan = plan_scene(scene, made.textures, made.normal_maps, inputs);
    std::vector<OutlineHull> hulls = outline_hulls(scene);
    for (const Material& material : scene.materials)
        if (!material.opacity_map.file.empty())
            scene.warnings.push_back("material \"" + material.name +
                                     "\": map_d is ignored: an alpha test is made for glTF files "
                                     "only, by the alpha of their textures");
    return {std::move(scene),
            std::move(made.textures),
            std::move(made.normal_maps),
            bounds,
            std::move(lit_by),
            std::move(plan),
            std::move(hulls),
            is_on_paper};
}

std::vector<std::string> lights_in_words(const SceneLights& lit_by, const ScenePlan& plan) {
    if (!plan.any(Effect::light) && !plan.any(Effect::toon)) return {"none is called for"};
    constexpr const char* kinds[] = {"directional light", "point light", "spotlight"};
    std::vector<std::string> words;
    for (std::size_t l = 0; l < lit_by.lights.size(); ++l) {
        const std::string& name = lit_by.names[l];
        words.push_back((name.empty() ? "unnamed" : name) + ", a " +
                        kinds[static_cast<std::size_t>(lit_by.lights[l].kind)] +
                        (lit_by.casts[l] ? "" : ", casts no shadow"));
    }
    if (lit_by.exposure < 1) {
        std::ostringstream times;
        times << 1 / lit_by.exposure;
        words.push_back("taken down by " + times.str() + ", so that the brightest is white");
    }
    return words;
}

std::vector<Mesh> outlines_of(const SceneAssets& assets, const Camera& camera) {
    std::vector<Mesh> outlines;
    outlines.reserve(assets.hulls.size());
    for (const OutlineHull& hull : assets.hulls) outlines.push_back(pushed(hull, camera));
    return outlines;
}

std::vector<Pass> passes_of(const ScenePlan& plan, const std::vector<const Mesh*>& meshes) {
    std::vector<Pass> passes;
    for (const auto& [is_blended, is_transparent] :
         {std::pair{false, false}, {true, false}, {true, true}})
        for (const Culling culling : {Culling::back_faces, Culling::none}) {
            Pass pass{is_blended, is_transparent, culling};
            if (std::none_of(plan.materials.begin(), plan.materials.end(),
                             [&](const MaterialPlan& material) { return pass.takes(material); }))
                continue;  // no need to look at all triangles
            for (const Mesh* const mesh : meshes)
                if (std::any_of(mesh->triangles.begin(), mesh->triangles.end(),
                                [&](const Triangle& triangle) {
                                    return pass.takes(plan.materials[triangle.material]);
                                }))
                    pass.meshes.push_back(mesh);
            if (!pass.meshes.empty()) passes.push_back(std::move(pass));
        }
    return passes;
}

}  // namespace rasterbook
