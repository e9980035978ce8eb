// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?": tones and outlines in one pixel, for `--probe`.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "04_mvp/camera.hpp"
#include "04_mvp/probe.hpp"
#include "06_phong/probe.hpp"
#include "06_phong/studio_lights.hpp"
#include "06_phong/surface.hpp"
#include "07_toon/assets.hpp"
#include "07_toon/toon_variants.hpp"
#include "common/app/counters.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// Says which tone a light falls into, and whether there is a highlight.
inline void report_tone(PixelReport& report, const SurfaceColor& color, const ReflectedLight& light,
                        int tones) {
    const float bright = brightness(light.diffuse);
    const int tone = tone_of(bright, tones);
    report.line("brightness", bright, "Eq. 7.1");
    report.line("tone", std::to_string(tone) + " of 0 to " + std::to_string(tones - 1), "Eq. 7.2");
    report.line("level", level_of(tone, tones), "Eq. 7.3");
    report.line("highlight",
                words(brightness(color.specular * light.specular)) +
                    (is_highlight(color, light) ? ": seen, white" : ": not seen"),
                "Eq. 7.4");
}

/// Draws the edges of a picture in one pixel, and says why it is inked.
///
/// @param width_px  As draw_edges() takes it.
/// @param depth_at,normal_at  Called with a pixel of the picture: what is seen there.
template <typename DepthAt, typename NormalAt>
void report_edges(PixelReport& report, const Camera& camera, float width_px, ivec2 pixel,
                  ivec2 size, const DepthAt& depth_at, const NormalAt& normal_at, vec3& color) {
    const int reach = static_cast<int>(std::ceil(width_px / 2));
    if (std::min(size.x, size.y) <= 2 * reach) return;
    // Only these nine pixels count: so a picture of no more is enough, with the first in a corner.
    const ivec2 center = glm::clamp(pixel, ivec2(reach), size - 1 - reach);
    DepthBuffer depth(ivec2(2 * reach + 1));
    Image<vec3> normals(ivec2(2 * reach + 1), vec3(0)), window(ivec2(2 * reach + 1), color);
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            const ivec2 offset = reach * ivec2(x, y);
            depth.depths()[offset + reach] = depth_at(center + offset);
            normals[offset + reach] = normal_at(center + offset);
        }
    const auto inverse_w_at = [&](ivec2 offset) {
        return inverse_w(depth.depths()[reach * (offset + 1)], camera);
    };
    const auto normal_beside = [&](ivec2 offset) { return normals[reach * (offset + 1)]; };
    const EdgeThresholds thresholds;
    report.line("1/w", inverse_w_at(ivec2(0)), "Eq. 7.11");
    report.line("bend of 1/w",
                words(second_difference(inverse_w_at, {1, 0})) + ' ' +
                    words(second_difference(inverse_w_at, {0, 1})) + "; an edge from " +
                    words(thresholds.depth * inverse_w_at(ivec2(0))),
                "Eq. 7.12");
    report.line("turn of normals",
                words(glm::length(sobel(normal_beside, {1, 0}))) + ' ' +
                    words(glm::length(sobel(normal_beside, {0, 1}))) + "; an edge from " +
                    words(thresholds.normals),
                "Eq. 7.13");
    NoCounters uncounted;
    draw_edges(depth, normals, camera, width_px, thresholds, window, uncounted);
    const vec3 drawn = window[pixel - center + reach];
    report.line("edge", drawn == ink ? "yes: inked" : "none", "Eq. 7.14");
    color = drawn;
}

/// Draws inverted hulls in one pixel, and says whether they ink it.
///
/// @param depth  Of what is seen; 1 where nothing is.
inline void report_hulls(PixelReport& report, const Scene& scene, const HullNormals& hull_normals,
                         const Camera& camera, float width_px, ivec2 pixel, ivec2 size, float depth,
                         vec3& color) {
    const mat4 clip_from_world = camera.clip_from_world(size);
    DepthBuffer nearest(ivec2(1));
    nearest.test_and_write(ivec2(0), depth);
    PixelHistory history;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        const Mesh& mesh = scene.meshes[m];
        std::vector<vec4> positions_clip = transform(clip_from_world, mesh.positions);
        for (std::size_t i = 0; i < positions_clip.size(); ++i)
            positions_clip[i] = pushed(
                positions_clip[i], clip_from_world * vec4(hull_normals[m][i], 0), width_px, size);
        for (const Triangle& triangle : mesh.triangles) {
            if (!is_seen_from_behind(mesh, triangle, camera.position_world)) continue;
            for (const ClippedTriangle& clipped :
                 clip_triangle(vertices_of(triangle, positions_clip))) {
                const ProjectedTriangle back = project(mesh, triangle, clipped, size);
                const auto at = covered(back.on_screen, pixel);
                if (at &&
                    test_depth(nearest, name_of(back, scene), *at, back.depth.at(*at), history))
                    color = ink;
            }
        }
    }
    history.print(report, "then the hull, in ink: faces that show their back (Eq. 7.9 and 7.10)");
}

/// Explains pixels of this lesson's picture.
///
/// @param options  With TextureOptions `texture` and ToonVariant `shading`. Both have to outlive
///                 the probe.
template <typename Options>
PixelProbe toon_probe(const Options& options, const ToonAssets& assets) {
    const Camera camera = orbit_camera(options.orbit, assets.scene.bounds());
    return [&options, &assets, camera,
            triangles = projected_triangles(assets.scene, camera.clip_from_world(options.size),
                                            options.size)](ivec2 pixel, PixelReport& report) {
        const Scene& scene = assets.scene;
        const ToonVariant& shading = options.shading;
        NoCounters uncounted;
        const auto surface_of = [&](const SeenFragment& of) {
            return triangle_surface(scene, assets.textures,
                                    assets.effects[of.projected->triangle.material], *of.projected);
        };
        const auto seen = report_triangles(report, triangles, shading.culling(), scene, pixel);
        vec3 color = paper_color;
        if (!seen) report.section("seen: the paper, since no triangle is written here");
        if (seen) {
            const auto [surface, on_surface, base_color] =
                report_surface(report, *seen, surface_of(*seen), options.texture.filter);
            const std::array lights = studio_lights(shading.key_light, scene.bounds());
            const auto point_at = [&, &of = surface](Barycentrics at) {
                return surface_point(of, at, interpolate(of.normals_world, at),
                                     camera.position_world, uncounted);
            };
            const auto light_at = [&, &of = surface](Barycentrics at) {
                return reflected_light(lights, point_at(at), highlight_of(of));
            };
            color = unlit(base_color);
            if (surface.effects[Effect::light]) {
                const SurfacePoint<float> point = point_at(on_surface.here);
                const ReflectedLight light = light_at(on_surface.here);
                report_point(report, point);
                report_lights(report, lights, point, highlight_of(surface),
                              [](std::size_t) { return 1.0f; });
                report_tone(report, base_color, light, shading.tones);
                color = shading.smooth
                            ? smooth_toon(base_color, toon_ambient_light, light,
                                          light_at(on_surface.here + on_surface.ddx),
                                          light_at(on_surface.here + on_surface.ddy), shading.tones)
                            : toon(base_color, toon_ambient_light, light, shading.tones);
                report.line("paint", color, shading.smooth ? "Eq. 7.5" : "Eq. 7.4");
            }
            if (shading.outline == Outline::facing) {
                const SurfacePoint<float> point = point_at(on_surface.here);
                const vec3 toward_eye =
                    unit_or(camera.position_world - point.position_world, point.normal_world);
                report.line("facing ratio",
                            words(facing_ratio(point.normal_world, toward_eye)) + "; ink below " +
                                words(shading.min_facing),
                            "Eq. 7.6");
                Image<vec3> one(ivec2(1), color), no_normals;
                add_to_outline(shading, surface, on_surface.here, camera.position_world, ivec2(0),
                               no_normals, one, uncounted);
                color = one[ivec2(0)];
            }
        }
        const float width_px =
            shading.outline_width_px * static_cast<float>(options.samples_per_side);
        if (shading.outline == Outline::hull)
            report_hulls(report, scene, assets.hull_normals, camera, width_px, pixel, options.size,
                         seen ? seen->depth : DepthBuffer::cleared, color);
        if (shading.outline == Outline::edges) {
            const auto beside = [&](ivec2 at) {
                PixelHistory unused;
                return seen_in(triangles, shading.culling(), scene, at, unused);
            };
            report_edges(
                report, camera, width_px, pixel, options.size,
                [&](ivec2 at) {
                    const auto found = beside(at);
                    return found ? found->depth : DepthBuffer::cleared;
                },
                [&](ivec2 at) {
                    const auto found = beside(at);
                    if (!found) return vec3(0);
                    Image<vec3> normal(ivec2(1)), no_color;
                    add_to_outline(
                        shading, surface_of(*found),
                        perspective_correct(perspective_setup(*found->projected), found->on_screen)
                            .here,
                        camera.position_world, ivec2(0), normal, no_color, uncounted);
                    return normal[ivec2(0)];
                },
                color);
        }
        return color;
    };
}

}  // namespace rasterbook
