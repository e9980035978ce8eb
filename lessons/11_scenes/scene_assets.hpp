// SPDX-License-Identifier: MIT
/// @file
/// A scene of any file, with all that it is drawn with. Introduced in lesson 11.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "06_phong/effects.hpp"
#include "06_phong/light.hpp"
#include "07_toon/material_outlines.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "10_threading/split.hpp"
#include "10_threading/threaded_shadows.hpp"
#include "11_scenes/scene_options.hpp"
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

/// Triangles that are drawn together: all opaque, or all glass; all seen from both sides, or all
/// from the front alone.
struct Pass {
    bool is_blended = false;      ///< They become transparent fragments.
    bool is_transparent = false;  ///< They would without --all-effects, too.
    Culling culling = Culling::back_faces;

    bool operator==(const Pass&) const = default;
};

struct SceneAssets {
    Scene scene;
    SurfaceTextures textures;
    NormalMaps normal_maps;
    std::vector<EffectMask> effects;  ///< Of each material.
    std::vector<Pass> passes;         ///< In which each material is drawn.
    ShadowBounds shadow_bounds;
    SceneLights lit_by;
    std::vector<OutlineHull> hulls;
    bool is_drawing;  ///< Paper lies behind it.
};

/// Whether a material is glass: what lies behind shines through.
inline bool is_transparent(const Material& material) {
    return material.alpha != AlphaMode::mask &&
           (material.alpha == AlphaMode::blend || material.opacity < 1);
}

/// The file's lights; where it has none, the raking lights of lesson 09.
///
/// @param key       Of these, the kind of the first.
/// @param warnings  Takes the names of the lights beyond max_lights: they are left out.
SceneLights lights_of(const Scene& scene, LightKind key, std::vector<std::string>& warnings);

/// Makes of a scene, as its file has it, all that is drawn.
///
/// @throws InputError  When an image cannot be read.
SceneAssets load_scene_assets(Scene scene, const SceneOptions& options);

/// Draws paper behind a part of a picture.
inline void draw_paper(Image<vec3>& color, const Tile& part) {
    for_each_strip(part, [&](const PixelBox& strip) {
        for (int y = strip.first.y; y <= strip.last.y; ++y)
            for (int x = strip.first.x; x <= strip.last.x; ++x) color[{x, y}] = paper_color;
    });
}

/// A scene as shadow maps see it, with all of its lights.
inline ShadowScene shadow_scene(const SceneAssets& assets, bool all_effects) {
    return {assets.scene, assets.shadow_bounds, assets.lit_by.lights, all_effects,
            assets.lit_by.casts};
}

/// Clears a tile and its depths. Behind a drawing lies paper.
inline void clear_tile(const SceneAssets& assets, Image<vec3>& color, DepthBuffer& depth,
                       const Tile& tile) {
    clear_tile(color, depth, tile);
    if (assets.is_drawing) draw_paper(color, tile);
}

}  // namespace rasterbook
