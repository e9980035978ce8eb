// SPDX-License-Identifier: MIT
/// @file
/// How bands end and which outline there is, to be seen with `--smooth` and `--outline`, and
/// measured in docs/accuracy/07_toon.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "05_textures/interpolation.hpp"
#include "06_phong/fragments.hpp"
#include "06_phong/lit_scene.hpp"
#include "06_phong/shading_variants.hpp"
#include "07_toon/outline.hpp"
#include "07_toon/toon.hpp"

namespace rasterbook {

enum class Outline { none, facing, hull, edges };

struct ToonVariant : LightOptions {
    int bands = 4;
    bool smooth = false;  ///< Bands end over one pixel, not at once.
    Outline outline = Outline::edges;
    float outline_width_px = 3;  ///< Of the picture as it is written; hull and edges.
    float least_facing = 0.35f;

    ToonVariant() { key_light = LightKind::directional; }

    void declare(Knobs& knobs) {
        knobs.number("--bands", bands, 1, most_bands, "Levels of light");
        knobs.flag("--smooth", smooth, "Smooth the borders of bands over one pixel");
        knobs.choice("--outline", outline,
                     {{"none", Outline::none},
                      {"facing", Outline::facing},
                      {"hull", Outline::hull},
                      {"edges", Outline::edges}},
                     "Outlines by the facing ratio, by a hull, or by edges in depth and normals");
        knobs.number("--outline-width", outline_width_px, 0, 64,
                     "Of hull and edges, in pixels; of edges, rounded up to an even number");
        knobs.number("--facing", least_facing, 0, 1, "The facing ratio below which outline is");
        LightOptions::declare(knobs);
    }
};

/// A lit scene with what its outline needs.
struct ToonScene : LitScene {
    std::vector<std::vector<vec3>> normals_of_hulls;  ///< For each mesh, if there are hulls.

    template <typename Options>
    ToonScene(Scene scene, const Options& options) : LitScene(std::move(scene), options) {
        if (options.shading.outline == Outline::hull)
            for (const Mesh& mesh : meshes) normals_of_hulls.push_back(hull_normals(mesh));
    }
};

/// The mean light of the bands over a pixel in which the brightness runs evenly from half of
/// `change` below `brightness` to half of it above (Eq. 7.5).
///
/// @param change  >= 0; for 0 and NaN there is nothing to smooth.
inline float smoothly_banded(float brightness, float change, int bands) {
    const auto area = [bands](double b) {  // below the staircase, from 0 to b
        if (!(b > 0)) return 0.0;
        const double k = std::min(std::floor(b * bands), bands - 1.0);
        return (k * (k - 1) / 2 / bands + k * (b - k / bands)) / (bands - 1);
    };
    const double from = brightness - double{change} / 2, to = brightness + double{change} / 2;
    if (!(from < to) || bands == 1) return banded(brightness, bands);  // also for NaN
    if (to <= 0 || from >= 1) return from >= 1 ? 1.0f : 0.0f;
    if (!(to - from < 1e15)) return 0.5f;  // as far on both sides of all bands
    return static_cast<float>((area(to) - area(from)) / (to - from));
}

/// The share of a pixel that lies in a highlight, in the same way.
inline float highlight_share(float brightness, float change) {
    if (!(change > 0)) return brightness >= least_highlight ? 1.0f : 0.0f;
    const float share = (brightness - least_highlight) / change + 0.5f;
    return std::min(std::max(0.0f, share), 1.0f);  // 0 first: never NaN
}

/// Points of a surface that are lit together, and with --smooth those a pixel to the right and a
/// pixel below.
struct ToonPoints : LitPoints {
    LitPoints right, below;

    template <typename CounterPolicy>
    void add(const TriangleLight& triangle, const ManyWeights& weights, bool smooth,
             CounterPolicy& counters) {
        triangle.add(weights, *this, counters);
        if (!smooth) return;
        for (std::size_t i = 0; i < weights.count; ++i) {
            triangle.add(weights.here[i] + weights.step_x[i], right, counters);
            triangle.add(weights.here[i] + weights.step_y[i], below, counters);
        }
    }

    void compute(const TriangleLight& triangle, bool smooth) {
        triangle.compute(*this);
        if (smooth) triangle.compute(right), triangle.compute(below);
    }

    template <typename CounterPolicy>
    vec3 painted(std::size_t i, const ToonVariant& variant, const SurfaceColor& color,
                 CounterPolicy& counters) const {
        counters.add(Counter::toon_fragments);
        if (!variant.smooth) return toon(color, toon_ambient_light, light(i), variant.bands);
        const auto change = [&](auto&& brightness_of) {
            const float here = brightness_of(light(i));
            return std::abs(brightness_of(right.light(i)) - here) +
                   std::abs(brightness_of(below.light(i)) - here);
        };
        const auto evenly = [](const ReflectedLight& of) { return brightness(of.diffuse); };
        const auto mirrored = [&](const ReflectedLight& of) {
            return brightness(color.specular * of.specular);
        };
        const float level = smoothly_banded(evenly(light(i)), change(evenly), variant.bands);
        return glm::mix(paint(color, toon_ambient_light, level, false), vec3(1),
                        highlight_share(mirrored(light(i)), change(mirrored)));
    }
};

/// The outline of a picture: what it needs of fragments, and the drawing of it.
class Outlines {
  public:
    Outlines(const ToonVariant& variant, const Camera& camera, ivec2 size)
        : variant_(variant), camera_(camera) {
        if (variant.outline == Outline::edges) normals_ = Image<vec3>(size, vec3(0));
    }

    bool need_fragments() const {
        return variant_.outline == Outline::facing || variant_.outline == Outline::edges;
    }

    /// @param weights  Of a fragment that is painted already.
    /// @param is_back  The triangle is seen from behind: its normals point to the other side.
    template <typename CounterPolicy>
    void add(ivec2 pixel, const Mesh& mesh, const Triangle& triangle, bool is_back, vec3 weights,
             Image<vec3>& color, CounterPolicy& counters) {
        vec3 position(0), mixed(0);
        for (int i = 0; i < 3; ++i) {
            const Corner corner = triangle.corners[static_cast<std::size_t>(i)];
            position += weights[i] * mesh.positions[corner.position];
            mixed += weights[i] * mesh.normals[corner.normal];
        }
        const vec3 normal = unit_or(is_back ? -mixed : mixed, vec3(0));
        if (variant_.outline == Outline::edges) {
            normals_[pixel] = normal;
            return;
        }
        counters.add(Counter::outline_tests);
        const vec3 toward_eye = unit_or(camera_.position_world - position, normal);
        if (!is_facing_outline(facing_ratio(normal, toward_eye), variant_.least_facing)) return;
        counters.add(Counter::outline_pixels);
        color[pixel] = ink;
    }

    /// Hulls and edges, when all else is drawn.
    ///
    /// @param samples_per_side  Of the picture in a pixel of that which is written.
    template <typename CounterPolicy>
    void draw(const ToonScene& scene, int samples_per_side, DepthBuffer& depth, Image<vec3>& color,
              CounterPolicy& counters) const {
        const float width_px = variant_.outline_width_px * static_cast<float>(samples_per_side);
        if (variant_.outline == Outline::hull)
            for (std::size_t i = 0; i < scene.meshes.size(); ++i)
                draw_hull(scene.meshes[i], scene.normals_of_hulls[i], camera_, width_px, depth,
                          color, counters);
        if (variant_.outline == Outline::edges)
            draw_edges(depth, normals_, camera_, width_px, {}, color, counters);
    }

  private:
    ToonVariant variant_;
    Camera camera_;
    Image<vec3> normals_;  ///< Of what is seen, for edges.
};

}  // namespace rasterbook
