// SPDX-License-Identifier: MIT
/// @file
/// Tones and outlines as `--tones`, `--outline`, `--outline-width` and `--facing` ask for them.
#pragma once

#include <cstddef>
#include <vector>

#include "05_textures/interpolation.hpp"
#include "06_phong/light_options.hpp"
#include "06_phong/surface.hpp"
#include "07_toon/outline.hpp"
#include "07_toon/toon.hpp"

namespace rasterbook {

enum class Outline { none, facing, hull, edges };

/// How a scene is drawn as a comic does.
struct ToonShading : LightOptions {
    int tones = 4;
    Outline outline = Outline::edges;
    float outline_width_px = 3;  ///< Of the picture as it is written; hull and edges.
    float min_facing = 0.35f;

    ToonShading() { key_light = LightKind::directional; }

    void declare(OptionParser& parser) {
        parser.number("--tones", tones, 1, max_tones,
                      "Tones: the levels that light is quantised to");
        parser.choice("--outline", outline,
                      {{"none", Outline::none},
                       {"facing", Outline::facing},
                       {"hull", Outline::hull},
                       {"edges", Outline::edges}},
                      "Outlines by the facing ratio, an inverted hull, or edge detection in depth "
                      "and normals");
        parser.number(
            "--outline-width", outline_width_px, 0, 64,
            "Of hull and edges, in pixels; of edges, rounded up to an even number of samples");
        parser.number("--facing", min_facing, 0, 1, "The facing ratio below which there is ink");
        LightOptions::declare(parser);
    }
};

/// For each mesh the directions of its hull; empty where there is no hull.
using HullNormals = std::vector<std::vector<vec3>>;

inline HullNormals make_hull_normals(const Scene& scene, Outline outline) {
    HullNormals normals;
    if (outline == Outline::hull)
        for (const Mesh& mesh : scene.meshes) normals.push_back(hull_normals(mesh));
    return normals;
}

/// What outlines need of a fragment that has its colour already: edge detection its normal; and by
/// the facing ratio, the outline itself.
///
/// @param normals  Takes the normal; only with Outline::edges.
inline void add_to_outline(const ToonShading& shading, const TriangleSurface& surface,
                           Barycentrics at, vec3 eye_world, ivec2 pixel, Image<vec3>& normals,
                           Image<vec3>& color) {
    if (shading.outline != Outline::facing && shading.outline != Outline::edges) return;
    const vec3 normal = unit_or(interpolate(surface.normals_world, at), vec3(0));
    if (shading.outline == Outline::edges) {
        normals[pixel] = normal;
        return;
    }
    count(Counter::outline_tests);
    const vec3 position = interpolate(surface.positions_world, at);
    const vec3 toward_eye = unit_or(eye_world - position, normal);
    if (!is_facing_outline(facing_ratio(normal, toward_eye), shading.min_facing)) return;
    count(Counter::outline_pixels);
    color[pixel] = ink;
}

/// Draws inverted hulls, or detects edges, when all else is drawn.
///
/// @param normals           Of what is visible, from add_to_outline().
/// @param samples_per_side  So many of this picture's pixels are in a row of a written pixel.
inline void draw_outlines(const ToonShading& shading, const Scene& scene,
                          const HullNormals& hull_normals, const Camera& camera,
                          int samples_per_side, const Image<vec3>& normals, DepthBuffer& depth,
                          Image<vec3>& color) {
    const float width_px = shading.outline_width_px * static_cast<float>(samples_per_side);
    if (shading.outline == Outline::hull)
        for (std::size_t i = 0; i < scene.meshes.size(); ++i)
            draw_hull(scene.meshes[i], hull_normals[i], camera, width_px, depth, color);
    if (shading.outline == Outline::edges) draw_edges(depth, normals, camera, width_px, {}, color);
}

}  // namespace rasterbook
