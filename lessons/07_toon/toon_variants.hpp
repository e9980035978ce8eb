// SPDX-License-Identifier: MIT
/// @file
/// How tones end and which outline there is, to see with `--smooth` and `--outline`, and
/// measured in docs/accuracy/07_toon.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "05_textures/interpolation.hpp"
#include "06_phong/light_options.hpp"
#include "06_phong/surface.hpp"
#include "07_toon/outline.hpp"
#include "07_toon/toon.hpp"

namespace rasterbook {

enum class Outline { none, facing, hull, edges };

struct ToonVariant : LightOptions {
    int tones = 4;
    bool smooth = false;  ///< Borders of tones are one pixel wide, not hard.
    Outline outline = Outline::edges;
    float outline_width_px = 3;  ///< Of the picture as it is written; hull and edges.
    float min_facing = 0.35f;

    ToonVariant() { key_light = LightKind::directional; }

    void declare(Knobs& knobs) {
        knobs.number("--tones", tones, 1, max_tones,
                     "Tones: the levels that light is quantised to");
        knobs.flag("--smooth", smooth, "Smooth the borders of tones over one pixel");
        knobs.choice("--outline", outline,
                     {{"none", Outline::none},
                      {"facing", Outline::facing},
                      {"hull", Outline::hull},
                      {"edges", Outline::edges}},
                     "Outlines by the facing ratio, an inverted hull, or edge detection in depth "
                     "and normals");
        knobs.number(
            "--outline-width", outline_width_px, 0, 64,
            "Of hull and edges, in pixels; of edges, rounded up to an even number of samples");
        knobs.number("--facing", min_facing, 0, 1, "The facing ratio below which there is ink");
        LightOptions::declare(knobs);
    }
};

/// The mean level of the tones over a pixel in which the brightness runs linearly from half of
/// `change` below `brightness` to half of it above (Eq. 7.5).
///
/// @param change  >= 0; for 0 and NaN there is nothing to smooth.
inline float smoothly_quantised(float brightness, float change, int tones) {
    const auto area = [tones](double b) {  // below the staircase, from 0 to b
        if (!(b > 0)) return 0.0;
        const double k = std::min(std::floor(b * tones), tones - 1.0);
        return (k * (k - 1) / 2 / tones + k * (b - k / tones)) / (tones - 1);
    };
    const double from = brightness - double{change} / 2, to = brightness + double{change} / 2;
    if (!(from < to) || tones == 1) return quantised(brightness, tones);  // also for NaN
    if (to <= 0 || from >= 1) return from >= 1 ? 1.0f : 0.0f;
    if (std::isinf(change)) return 0.5f;  // it reaches as far below all tones as above
    return static_cast<float>(std::clamp((area(to) - area(from)) / (to - from), 0.0, 1.0));
}

/// How much of a pixel lies in a highlight, 0 to 1, in the same way.
inline float highlight_share(float brightness, float change) {
    if (!(change > 0)) return brightness >= min_tone_highlight ? 1.0f : 0.0f;
    const float share = (brightness - min_tone_highlight) / change + 0.5f;
    return std::min(std::max(0.0f, share), 1.0f);  // 0 first: never NaN
}

/// What a fragment sends to the eye, its tones and highlight smoothed over one pixel.
///
/// @param light,right,below  In the fragment, a pixel to the right, and a pixel below.
inline vec3 smooth_toon(const SurfaceColor& color, vec3 from_all_around,
                        const ReflectedLight& light, const ReflectedLight& right,
                        const ReflectedLight& below, int tones) {
    const auto change = [&](auto&& brightness_of) {
        const float here = brightness_of(light);
        return std::abs(brightness_of(right) - here) + std::abs(brightness_of(below) - here);
    };
    const auto diffuse = [](const ReflectedLight& of) { return brightness(of.diffuse); };
    const auto specular = [&](const ReflectedLight& of) {
        return brightness(color.specular * of.specular);
    };
    const float level = smoothly_quantised(diffuse(light), change(diffuse), tones);
    return glm::mix(paint(color, from_all_around, level, false), vec3(1),
                    highlight_share(specular(light), change(specular)));
}

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
inline void add_to_outline(const ToonVariant& variant, const TriangleSurface& surface,
                           Barycentrics at, vec3 eye_world, ivec2 pixel, Image<vec3>& normals,
                           Image<vec3>& color) {
    if (variant.outline != Outline::facing && variant.outline != Outline::edges) return;
    const vec3 normal = unit_or(interpolate(surface.normals_world, at), vec3(0));
    if (variant.outline == Outline::edges) {
        normals[pixel] = normal;
        return;
    }
    count(Counter::outline_tests);
    const vec3 position = interpolate(surface.positions_world, at);
    const vec3 toward_eye = unit_or(eye_world - position, normal);
    if (!is_facing_outline(facing_ratio(normal, toward_eye), variant.min_facing)) return;
    count(Counter::outline_pixels);
    color[pixel] = ink;
}

/// Draws inverted hulls, or detects edges, when all else is drawn.
///
/// @param normals           Of what is visible, from add_to_outline().
/// @param samples_per_side  So many of this picture's pixels are in a row of a written pixel.
inline void draw_outlines(const ToonVariant& variant, const Scene& scene,
                          const HullNormals& hull_normals, const Camera& camera,
                          int samples_per_side, const Image<vec3>& normals, DepthBuffer& depth,
                          Image<vec3>& color) {
    const float width_px = variant.outline_width_px * static_cast<float>(samples_per_side);
    if (variant.outline == Outline::hull)
        for (std::size_t i = 0; i < scene.meshes.size(); ++i)
            draw_hull(scene.meshes[i], hull_normals[i], camera, width_px, depth, color);
    if (variant.outline == Outline::edges) draw_edges(depth, normals, camera, width_px, {}, color);
}

}  // namespace rasterbook
