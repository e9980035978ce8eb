// SPDX-License-Identifier: MIT
#include "12_effects/planned_scene.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace rasterbook {

namespace {

/// For --all-effects, beside what lessons 06 and 08 add: unlit materials become toon materials of
/// one colour, and vertices get white colours.
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

}  // namespace

PlannedScene load_planned_scene(Scene from, const EffectsOptions& options) {
    PlannedScene made{load_scene_assets(std::move(from), options), {}};
    const bool all_effects = options.shading.all_effects;
    if (all_effects) add_neutral_inputs(made.scene);
    const std::size_t count = made.scene.materials.size();
    std::vector<bool> is_seen(count), has_colors(count);
    for (const Mesh& mesh : made.scene.meshes)
        for (const Triangle& triangle : mesh.triangles) {
            is_seen[triangle.material] = true;
            if (!mesh.colors.empty()) has_colors[triangle.material] = true;
        }
    const auto& [casters, receivers] = made.shadow_bounds;
    for (std::size_t i = 0; i < count; ++i) {
        MaterialPlan plan = plan_material(
            made.scene.materials[i],
            {.has = made.effects[i],
             .has_colors = has_colors[i],
             .has_shadows = casters.min.x <= casters.max.x && receivers.min.x <= receivers.max.x,
             .has_normal_maps = options.normal_map.space != MapSpace::none,
             .all_effects = all_effects});
        plan.is_seen = is_seen[i];
        made.effects[i] = plan.effects;
        made.passes[i].is_blended = plan[Effect::blend];
        made.plan.materials.push_back(plan);
    }
    return made;
}

}  // namespace rasterbook
