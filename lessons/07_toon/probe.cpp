// SPDX-License-Identifier: MIT
#include "07_toon/probe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "04_mvp/camera.hpp"
#include "04_mvp/probe.hpp"
#include "06_phong/report.hpp"
#include "06_phong/studio_lights.hpp"
#include "06_phong/surface.hpp"

namespace rasterbook {

namespace {

/// Says which tone a light falls into, and whether there is a highlight.
void report_tone(PixelReport& report, const SurfaceColor& color, const ReflectedLight& light,
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

/// What edge detection reads in a pixel.
struct EdgeInputs {
    float depth = DepthBuffer::cleared;
    vec3 normal{0};
};

/// Draws the edges of a picture in one pixel, and says why it is inked.
///
/// @param width_px  As draw_edges() takes it.
/// @param inputs    Called as inputs(pixel) for pixels of the picture; gives EdgeInputs.
template <typename Inputs>
void report_edges(PixelReport& report, const Camera& camera, float width_px, ivec2 pixel,
                  ivec2 size, const Inputs& inputs, vec3& color) {
    const int reach = static_cast<int>(std::ceil(width_px / 2));
    if (std::min(size.x, size.y) <= 2 * reach) return;
    // draw_edges() reads nine pixels: a window of the picture with these at its border is enough.
    const ivec2 center = glm::clamp(pixel, ivec2(reach), size - 1 - reach);
    DepthBuffer depth(ivec2(2 * reach + 1));
    Image<vec3> normals(ivec2(2 * reach + 1), vec3(0)), window(ivec2(2 * reach + 1), color);
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            const ivec2 offset = reach * ivec2(x, y);
            const EdgeInputs there = inputs(center + offset);
            depth.depths()[offset + reach] = there.depth;
            normals[offset + reach] = there.normal;
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
    draw_edges(depth, normals, camera, width_px, thresholds, window);
    const vec3 drawn = window[pixel - center + reach];
    report.line("edge", drawn == ink ? "yes: inked" : "none", "Eq. 7.14");
    color = drawn;
}

/// Draws inverted hulls in one pixel, and says whether they ink it.
///
/// @param depth  Of what is seen; 0 where nothing is.
void report_hulls(PixelReport& report, const Scene& scene, const HullNormals& hull_normals,
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

/// Says how the light of a fragment becomes paint.
vec3 report_paint(PixelReport& report, const ToonOptions& options, const Scene& scene,
                  vec3 eye_world, const SeenSurface& seen) {
    const auto& [surface, on_surface, base_color] = seen;
    const std::array lights = studio_lights(options.shading.key_light, scene.bounds());
    const vec3 normal = interpolate(surface.normals_world, on_surface.here);
    const SurfacePoint<float> point = surface_point(surface, on_surface.here, normal, eye_world);
    const ReflectedLight light = reflected_light(lights, point, highlight_of(surface));
    const int tones = options.shading.tones;
    report_point(report, point, scene.origin);
    report_lights(report, lights, point, highlight_of(surface), [](std::size_t) { return 1.0f; });
    report_tone(report, base_color, light, tones);
    const vec3 color = toon(base_color, toon_ambient_light, light, tones);
    report.line("paint", color, "Eq. 7.4");
    return color;
}

/// Says whether the facing ratio makes an outline.
void report_facing(PixelReport& report, const ToonShading& shading, vec3 eye_world,
                   const SeenSurface& seen, vec3& color) {
    const auto& [surface, on_surface, base_color] = seen;
    const vec3 normal = unit_or(interpolate(surface.normals_world, on_surface.here), vec3(0));
    const vec3 position = interpolate(surface.positions_world, on_surface.here);
    report.line("facing ratio",
                words(facing_ratio(normal, unit_or(eye_world - position, normal))) +
                    "; ink below " + words(shading.min_facing),
                "Eq. 7.6");
    Image<vec3> one(ivec2(1), color), no_normals;
    add_to_outline(shading, surface, on_surface.here, eye_world, ivec2(0), no_normals, one);
    color = one[ivec2(0)];
}

}  // namespace

PixelProbe toon_probe(const ToonOptions& options, const ToonAssets& assets) {
    const Camera camera = orbit_camera(options.orbit, assets.scene.bounds());
    return [&options, &assets, camera,
            triangles = projected_triangles(assets.scene, camera.clip_from_world(options.size),
                                            options.size)](ivec2 pixel, PixelReport& report) {
        const Scene& scene = assets.scene;
        const ToonShading& shading = options.shading;
        const vec3 eye_world = camera.position_world;
        const auto surface_of = [&](const SeenFragment& of) {
            const EffectMask effects = assets.effects[of.projected->triangle.material];
            return triangle_surface(scene, assets.textures, effects, *of.projected);
        };
        const auto edge_inputs = [&](ivec2 at) {
            PixelHistory unused;
            const auto there = seen_in(triangles, shading.culling(), scene, at, unused);
            if (!there) return EdgeInputs();
            Image<vec3> normal(ivec2(1)), no_color;
            const FragmentBarycentrics on_surface =
                perspective_correct(perspective_setup(*there->projected), there->on_screen);
            add_to_outline(shading, surface_of(*there), on_surface.here, eye_world, ivec2(0),
                           normal, no_color);
            return EdgeInputs{there->depth, normal[ivec2(0)]};
        };
        const auto seen = report_triangles(report, triangles, shading.culling(), scene, pixel);
        vec3 color = paper_color;
        if (!seen) {
            report.section("seen: the paper, since no triangle is written here");
        } else {
            const SeenSurface surface =
                report_surface(report, *seen, surface_of(*seen), options.texture.filter);
            color = surface.surface.effects[Effect::light]
                        ? report_paint(report, options, scene, eye_world, surface)
                        : report_unlit(report, surface.base_color);
            if (shading.outline == Outline::facing)
                report_facing(report, shading, eye_world, surface, color);
        }
        const float width_px =
            shading.outline_width_px * static_cast<float>(options.samples_per_side);
        if (shading.outline == Outline::hull)
            report_hulls(report, scene, assets.hull_normals, camera, width_px, pixel, options.size,
                         seen ? seen->depth : DepthBuffer::cleared, color);
        if (shading.outline == Outline::edges)
            report_edges(report, camera, width_px, pixel, options.size, edge_inputs, color);
        return color;
    };
}

}  // namespace rasterbook
