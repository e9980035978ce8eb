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
    trace("paint", color[pixel], "Eq. 7.4");
    if (shading.outline != Outline::facing && shading.outline != Outline::edges) return;
    const vec3 normal = unit_or(interpolate(surface.normals_world, at), vec3(0));
    if (shading.outline == Outline::edges) {
        normals[pixel] = normal;
        return;
    }
    count(Counter::outline_tests);
    const vec3 position = interpolate(surface.positions_world, at);
    const float ratio = facing_ratio(normal, unit_or(eye_world - position, normal));
    if (is_traced())
        trace("facing ratio", words(ratio) + "; ink below " + words(shading.min_facing), "Eq. 7.6");
    if (!is_facing_outline(ratio, shading.min_facing)) return;
    count(Counter::outline_pixels);
    color[pixel] = ink;
}

/// Notes for `--probe` whether there is an edge.
///
/// @param width_px  As in draw_edges().
inline void trace_edges(const DepthBuffer& depth, const Image<vec3>& normals, const Camera& camera,
                        float width_px, const Image<vec3>& color) {
    const int reach = static_cast<int>(std::ceil(width_px / 2));
    const ivec2 size = depth.depths().size();
    if (!is_traced() || std::min(size.x, size.y) <= 2 * reach) return;
    const ivec2 center = glm::clamp(pixel_trace->pixel(), ivec2(reach), size - 1 - reach);
    const auto inverse_w_at = [&](ivec2 offset) {
        return inverse_w(depth.depths()[center + reach * offset], camera);
    };
    const auto normal_at = [&](ivec2 offset) { return normals[center + reach * offset]; };
    const EdgeThresholds thresholds;
    trace("1/w", inverse_w_at(ivec2(0)), "Eq. 7.11");
    trace("bend of 1/w",
          words(second_difference(inverse_w_at, {1, 0})) + ' ' +
              words(second_difference(inverse_w_at, {0, 1})) + "; an edge from " +
              words(thresholds.depth * inverse_w_at(ivec2(0))),
          "Eq. 7.12");
    trace("turn of normals",
          words(glm::length(sobel(normal_at, {1, 0}))) + ' ' +
              words(glm::length(sobel(normal_at, {0, 1}))) + "; an edge from " +
              words(thresholds.normals),
          "Eq. 7.13");
    trace("edge", color[pixel_trace->pixel()] == ink ? "yes: inked" : "none", "Eq. 7.14");
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
    if (shading.outline == Outline::hull) {
        trace_section("then the hull, in ink: faces that show their back (Eq. 7.9 and 7.10)");
        for (std::size_t i = 0; i < scene.meshes.size(); ++i)
            draw_hull(scene.meshes[i], hull_normals[i], camera, width_px, depth, color);
    }
    if (shading.outline == Outline::edges) {
        trace_section("then edges, in ink");
        draw_edges(depth, normals, camera, width_px, {}, color);
        trace_edges(depth, normals, camera, width_px, color);
    }
}

}  // namespace rasterbook
