// SPDX-License-Identifier: MIT
/// @file
/// A scene of any file with all that it calls for. Introduced in lesson 11.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "04_mvp/camera.hpp"
#include "04_mvp/clip.hpp"
#include "05_textures/texture_options.hpp"
#include "06_phong/effects.hpp"
#include "06_phong/light.hpp"
#include "06_phong/light_options.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "10_threading/binned_triangles.hpp"
#include "10_threading/split.hpp"
#include "11_scenes/scene_plan.hpp"
#include "11_scenes/toon_material.hpp"
#include "common/image/backdrop.hpp"

namespace rasterbook {

/// All lights that a scene is drawn in.
struct SceneLights {
    std::vector<Light> lights;  ///< At most max_lights.
    std::vector<std::string> names;
    std::array<bool, max_lights> casts{};  ///< Whether each casts shadows.
    bool are_of_file = false;              ///< Else those of lesson 09.
    float exposure = 1;                    ///< By which the file's have been multiplied.
};

/// A scene, its lights, its plan and its outlines.
struct SceneAssets {
    Scene scene;
    SurfaceTextures textures;
    NormalMaps normal_maps;
    ShadowBounds shadow_bounds;
    SceneLights lit_by;
    ScenePlan plan;
    std::vector<OutlineHull> hulls;
    bool is_on_paper;  ///< All materials are toon ones, some with outlines: paper lies behind.
};

/// The file's lights; where it has none, the raking lights of lesson 09.
///
/// @param key       Of these, the kind of the first.
/// @param warnings  Takes the names of the lights beyond max_lights: they are left out.
SceneLights lights_of(const Scene& scene, LightKind key, std::vector<std::string>& warnings);

/// Adds the materials of outlines to a scene: behind all of its own, in their order.
Scene with_outline_materials(Scene scene);

/// The first of these materials: those before it are the scene's own.
std::size_t first_outline_material(std::span<const Material> materials);

/// The hulls of all meshes of a scene that has been given outlines' materials.
std::vector<OutlineHull> outline_hulls(const Scene& scene);

/// Makes of a scene, as its file has it, all that is drawn.
///
/// @param shadow_size  Texels along a shadow map's side.
SceneAssets make_scene_assets(Scene from, const TextureOptions& texture,
                              const LightOptions& shading, const NormalMapOptions& normal_map,
                              int shadow_size);

/// @param options  Has TextureOptions `texture`, NormalMapOptions `normal_map`, LightOptions
///                 `shading` and ShadowOptions `shadow`.
template <typename Options>
SceneAssets make_scene_assets(Scene from, const Options& options) {
    return make_scene_assets(std::move(from), options.texture, options.shading, options.normal_map,
                             options.shadow.size);
}

/// What a scene is lit by, in words: a string for each light, and one for an exposure below 1; or
/// that no material calls for light.
std::vector<std::string> lights_in_words(const SceneLights& lit_by, const ScenePlan& plan);

/// Draws paper behind a part of a picture.
inline void draw_paper(Image<vec3>& color, const Tile& part) {
    for_each_strip(part, [&](const PixelBox& strip) {
        for (int y = strip.first.y; y <= strip.last.y; ++y)
            for (int x = strip.first.x; x <= strip.last.x; ++x) color[{x, y}] = paper_color;
    });
}

/// The outlines as a camera is to see them.
std::vector<Mesh> outlines_of(const SceneAssets& assets, const Camera& camera);

/// What may be seen of a scene and its outlines. Only the scene's own meshes are counted.
inline std::vector<const Mesh*> seen_meshes(const Scene& scene, const std::vector<Mesh>& outlines,
                                            const mat4& clip_from_world) {
    std::vector<const Mesh*> meshes = meshes_in_view(scene, clip_from_world);
    for (const Mesh& mesh : outlines)
        if (!is_outside_frustum(mesh.bounds, clip_from_world)) meshes.push_back(&mesh);
    return meshes;
}

/// Triangles that are drawn together: all opaque, or all glass; all seen from both sides, or all
/// from the front alone.
struct Pass {
    bool is_blended;  ///< They become transparent: glass, and with all effects forced the others,
                      ///< too.
    bool is_transparent;
    Culling culling;
    std::vector<const Mesh*> meshes{};

    bool takes(const MaterialPlan& plan) const {
        return plan[Effect::blend] == is_blended && plan.is_transparent == is_transparent &&
               plan.two_sided == (culling == Culling::none);
    }
};

/// The passes that a scene calls for: what is opaque first, as glass is drawn over it.
///
/// @param meshes  Those in the camera's view: of the scene, and of outlines.
std::vector<Pass> passes_of(const ScenePlan& plan, const std::vector<const Mesh*>& meshes);

/// The triangles of a picture, binned by passes.
struct BinnedPasses {
    std::vector<BinnedTriangles> opaque, blended;
};

/// Transforms, clips and bins the triangles of each pass.
///
/// @param meshes    Those in the camera's view.
/// @param set_up    Does what project_triangles() does.
inline BinnedPasses bin_passes(Workers& pool, const SceneAssets& assets,
                               const std::vector<const Mesh*>& meshes, const mat4& clip_from_world,
                               const Tiling& tiling, ProjectTriangles* set_up = project_triangles) {
    BinnedPasses binned;
    for (const Pass& pass : passes_of(assets.plan, meshes))
        (pass.is_blended ? binned.blended : binned.opaque)
            .emplace_back(
                pool, assets.scene, pass.meshes, clip_from_world, tiling, pass.culling,
                [&](std::size_t material) { return pass.takes(assets.plan.materials[material]); },
                set_up);
    return binned;
}

/// How many triangles of several passes may reach into a tile.
inline std::size_t count_in(const std::vector<BinnedTriangles>& passes, std::size_t tile) {
    std::size_t count = 0;
    for (const BinnedTriangles& pass : passes) count += pass.count_in(tile);
    return count;
}

}  // namespace rasterbook
