// SPDX-License-Identifier: MIT
/// @file
/// A scene of any file with all that it calls for. Introduced in lesson 11.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "09_shadow_maps/shadowed_scene.hpp"
#include "10_threading/split.hpp"
#include "11_scenes/scene_lights.hpp"
#include "11_scenes/scene_plan.hpp"
#include "11_scenes/toon_look.hpp"
#include "common/backdrop.hpp"
#include "common/counters.hpp"

namespace rasterbook {

/// A scene, its lights, its plan and its outlines.
struct FinishedScene : ShadowedScene {
    SceneLights lit_by;
    ScenePlan plan;
    std::vector<OutlineHull> hulls;
    bool is_on_paper;  ///< All of it is a comic, with dark outlines: paper lies behind.

    /// @param options  As of ShadowedScene, with LightOptions `shading`.
    template <typename Options>
    FinishedScene(Scene scene, const Options& options)
        : ShadowedScene(with_outline_materials(std::move(scene)), options),
          lit_by(lights_of(*this, options.shading.key_light, warnings)),
          plan(*this, !lit_by.lights.empty(), has_shadows(),
               options.normal_map.space != MapSpace::none, options.shading),
          hulls(outline_hulls(*this)),
          is_on_paper(is_comic()) {
        for (const Material& material : materials)
            if (!material.opacity_map.file.empty())
                warnings.push_back("material \"" + material.name +
                                   "\": map_d is passed over: holes are drawn for glTF files, by "
                                   "the fourth number of their colour");
        // What all_effects forces needs something to work on.
        for (std::size_t i = 0; i < materials.size(); ++i)
            if (plan.materials[i][Effect::toon] && !materials[i].toon)
                materials[i].toon = ToonLook{.shade = materials[i].diffuse};
        if (options.shading.all_effects)
            for (Mesh& mesh : meshes)
                if (mesh.colors.empty()) mesh.colors.assign(mesh.positions.size(), vec4(1));
    }

  private:
    bool is_comic() const {
        for (std::size_t i = 0; i < materials.size(); ++i)
            if (plan.materials[i].is_seen && !materials[i].toon) return false;
        return plan.any(Effect::outline);
    }

    bool has_shadows() const {
        return casters.min.x <= casters.max.x && receivers.min.x <= receivers.max.x;
    }
};

/// Draws paper behind a part of a picture.
inline void draw_paper(Image<vec3>& color, const Part& part) {
    for_each_strip(part, [&](const PixelBox& strip) {
        for (int y = strip.first.y; y <= strip.last.y; ++y)
            for (int x = strip.first.x; x <= strip.last.x; ++x) color[{x, y}] = paper_color;
    });
}

/// The outlines as a camera is to see them.
inline std::vector<Mesh> outlines_of(const FinishedScene& scene, const Camera& camera) {
    std::vector<Mesh> outlines;
    outlines.reserve(scene.hulls.size());
    for (const OutlineHull& hull : scene.hulls) outlines.push_back(pushed(hull, camera));
    return outlines;
}

/// What may be seen of a scene and its outlines. Only the scene's own meshes are counted.
template <typename CounterPolicy>
std::vector<const Mesh*> seen_meshes(const FinishedScene& scene, std::span<const Mesh> outlines,
                                     const mat4& clip_from_world, CounterPolicy& counters) {
    std::vector<const Mesh*> meshes;
    for (const Mesh& mesh : scene.meshes) {
        counters.add(Counter::meshes_in);
        if (is_outside_frustum(mesh.bounds, clip_from_world)) {
            counters.add(Counter::meshes_culled_by_frustum);
            continue;
        }
        if (!scene.tangents_of(mesh).empty()) counters.add(Counter::meshes_with_tangents);
        meshes.push_back(&mesh);
    }
    for (const Mesh& mesh : outlines)
        if (!is_outside_frustum(mesh.bounds, clip_from_world)) meshes.push_back(&mesh);
    return meshes;
}

/// Triangles that are drawn together: those of materials that are opaque, or are glass, and that
/// are seen from both sides or from the front alone.
struct Pass {
    bool is_blended;  ///< They become layers: glass, and with all effects forced the others, too.
    bool is_glass, two_sided;
    std::vector<const Mesh*> meshes{};

    bool takes(const FinishedScene& scene, std::size_t material) const {
        const MaterialPlan& plan = scene.plan.materials[material];
        return plan[Effect::blend] == is_blended && plan.is_glass == is_glass &&
               plan.two_sided == two_sided;
    }
};

/// The passes that a scene calls for: what is opaque first, as glass is drawn over it.
///
/// @param meshes  Those in the camera's view: of the scene, and of outlines.
inline std::vector<Pass> passes_of(const FinishedScene& scene,
                                   std::span<const Mesh* const> meshes) {
    std::vector<Pass> passes;
    for (const auto& [is_blended, is_glass] :
         {std::pair{false, false}, {true, false}, {true, true}})
        for (const bool two_sided : {false, true}) {
            Pass pass{is_blended, is_glass, two_sided};
            for (const Mesh* const mesh : meshes)
                if (std::ranges::any_of(mesh->triangles, [&](const Triangle& triangle) {
                        return pass.takes(scene, triangle.material);
                    }))
                    pass.meshes.push_back(mesh);
            if (!pass.meshes.empty()) passes.push_back(std::move(pass));
        }
    return passes;
}

}  // namespace rasterbook
