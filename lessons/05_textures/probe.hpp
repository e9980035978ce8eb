// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?": textures in one pixel, in this lesson and all later ones, for `--probe`.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "02_triangle_fill/flat_color.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/probe.hpp"
#include "04_mvp/projection.hpp"
#include "05_textures/load_textures.hpp"
#include "05_textures/textures.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// Says where on a triangle's surface a fragment lies.
inline void report_perspective(PixelReport& report, const ProjectedTriangle& projected,
                               const FragmentBarycentrics& on_surface) {
    const auto& [a, b, c] = projected.clipped;
    const vec3 inverse_w = 1.0f / vec3(a.position_clip.w, b.position_clip.w, c.position_clip.w);
    report.line("1/w of a, b, c",
                words(inverse_w.x) + ' ' + words(inverse_w.y) + ' ' + words(inverse_w.z),
                "Eq. 5.2");
    report.line("perspective-correct", on_surface.here, "Eq. 5.3");
}

/// Says which texels a sample is made of.
///
/// A texel's weight is what the sampler makes of a texture that is 1 in this texel and 0 elsewhere;
/// its four channels stand for four texels.
inline void report_texels(PixelReport& report, const Texture& texture, Filter filter,
                          const FragmentUv& uv, std::size_t finest, std::size_t coarsest) {
    const vec2 position = texture_position(uv.here, texture.wrap);
    Texture marked{texture.wrap, {}};
    for (std::size_t i = 0; i < texture.levels.size(); ++i) {
        const bool is_read = i == 0 || (i >= finest && i <= coarsest);
        const ivec2 size = is_read ? texture.levels[i].size : ivec2(1);
        marked.levels.push_back({size, Image<vec4>(size + 2, vec4(0))});
    }
    constexpr float least_shown = 0.01f;
    const char* equation = filter == Filter::nearest ? "" : "Eq. 5.6";
    float rest = 1;
    for (std::size_t i = finest; i <= coarsest; ++i) {
        const TextureLevel& level = texture.levels[i];
        const ivec2 first = glm::clamp(ivec2(position * vec2(level.size) + 0.5f), ivec2(0),
                                       level.size);  // of four, counted from the border's
        const auto texel = [&](int channel) { return first + ivec2(channel % 2, channel / 2); };
        for (int k = 0; k < 4; ++k) marked.levels[i].texels[texel(k)][k] = 1;
        const vec4 weights = sample(marked, filter, uv);
        for (int k = 0; k < 4; ++k) {
            marked.levels[i].texels[texel(k)] = vec4(0);
            if (!(weights[k] >= least_shown)) continue;
            rest -= weights[k];
            report.line("  texel",
                        words(vec3(level.texels[texel(k)])) + " times " + words(weights[k], 2) +
                            ", at " + words(texel(k) - 1) + " of level " + std::to_string(i),
                        equation);
            equation = "";
        }
    }
    if (!(std::abs(rest) < 0.001f)) report.line("  other texels", "times " + words(rest, 2));
}

/// Says how a texture is sampled.
///
/// @param name  Of the texture.
/// @return      The sample.
inline vec4 report_sample(PixelReport& report, const char* name, const Texture& texture,
                          Filter filter, const FragmentUv& uv) {
    const ivec2 size = texture.levels[0].size;
    const float level = level_of_detail(uv.ddx, uv.ddy, size);
    filter = filter_at(texture, filter, level);
    report.line(name, std::to_string(size.x) + "x" + std::to_string(size.y) + " texels");
    report.line("  uv", words(uv.here), "Eq. 5.1");
    report.line("  in the texture", words(texture_position(uv.here, texture.wrap)),
                "Eq. 5.4 and 5.5");
    std::size_t finest = 0, coarsest = 0;
    if (filter == Filter::trilinear) {
        const std::size_t last = texture.levels.size() - 1;
        finest = static_cast<std::size_t>(clamp(level, 0.0f, static_cast<float>(last)));
        coarsest = std::min(finest + 1, last);
        report.line("  mip level", words(level) + " of 0 to " + std::to_string(last), "Eq. 5.8");
    }
    report_texels(report, texture, filter, uv, finest, coarsest);
    const vec4 color = sample(texture, filter, uv);
    report.line("  sample", vec3(color), filter == Filter::trilinear ? "Eq. 5.10" : "");
    return color;
}

/// Explains pixels of this lesson's picture.
///
/// @param options,assets  Have to outlive the probe.
inline PixelProbe texture_probe(const TexturedSceneOptions& options, const TexturedScene& assets) {
    const Camera camera = orbit_camera(options.orbit, assets.scene.bounds());
    return [&options, &assets,
            triangles = projected_triangles(assets.scene, camera.clip_from_world(options.size),
                                            options.size)](ivec2 pixel, PixelReport& report) {
        const Scene& scene = assets.scene;
        const auto seen = report_triangles(report, triangles, Culling::back_faces, scene, pixel);
        if (!seen) return report_backdrop(report, pixel, options.size);
        const auto& [mesh, triangle] = std::tie(seen->projected->mesh, seen->projected->triangle);
        const Material& material = scene.materials[triangle.material];
        const FragmentBarycentrics on_surface =
            perspective_correct(perspective_setup(*seen->projected), seen->on_screen);
        report_perspective(report, *seen->projected, on_surface);
        vec3 color = flat_color(mesh, triangle, material);
        report.line("flat colour", color);
        if (const Texture* const texture = assets.textures[triangle.material].get()) {
            const FragmentUv uv =
                fragment_uv(uvs_of(mesh, triangle, material.diffuse_map, texture), on_surface);
            color *= vec3(report_sample(report, "texture", *texture, options.texture.filter, uv));
        }
        return color;
    };
}

}  // namespace rasterbook
