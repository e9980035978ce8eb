// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?": the triangles of a camera's picture in one pixel, in this lesson and all
/// later ones, for `--probe`.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/probe.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "03_z_buffer/probe.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/instance.hpp"
#include "04_mvp/projection.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// A triangle that is seen in a pixel, and the pixel in it.
struct SeenFragment {
    const ProjectedTriangle* projected;
    Barycentrics on_screen;
    float depth;
};

/// A triangle's name; with a word about what clipping has made of it.
inline std::string name_of(const ProjectedTriangle& projected, const Scene& scene) {
    const ClippedTriangle& of = projected.clipped;
    const bool is_whole =
        mat3(of[0].barycentrics, of[1].barycentrics, of[2].barycentrics) == mat3(1);
    return name_of(projected.mesh, projected.triangle, scene.materials) +
           (is_whole ? "" : ", a clipped piece");
}

/// The triangle that is seen in a pixel: filled and tested there alone.
inline std::optional<SeenFragment> seen_in(std::span<const ProjectedTriangle> triangles,
                                           Culling culling, const Scene& scene, ivec2 pixel,
                                           PixelHistory& history) {
    DepthBuffer nearest(ivec2(1));
    std::optional<SeenFragment> seen;
    for (const ProjectedTriangle& projected : triangles) {
        if (!box_holds(projected.on_screen, pixel)) continue;
        const std::string name = name_of(projected, scene);
        const std::optional<Barycentrics> at = covered(projected.on_screen, pixel);
        if (!at) {
            history.missed(name, why_not_covered(projected.on_screen, pixel));
            continue;
        }
        const float depth = projected.depth.at(*at);
        if (projected.is_back_facing && culling == Culling::back_faces)
            history.lost(name, *at, depth, "faces away (Eq. 2.2)");
        else if (test_depth(nearest, name, *at, depth, history))
            seen = SeenFragment{&projected, *at, depth};
    }
    return seen;
}

/// Says where on the screen a fragment lies.
inline void report_fragment(PixelReport& report, const SeenFragment& seen, const Scene& scene) {
    const auto& [a, b, c] = seen.projected->clipped;
    report.section("seen: " + name_of(*seen.projected, scene));
    report.line("w of a, b, c", vec3(a.position_clip.w, b.position_clip.w, c.position_clip.w),
                "Eq. 4.8");
    report_coverage(report, seen.projected->on_screen, seen.on_screen);
    report.line("depth", words(seen.depth, 7), "Eq. 3.3");
}

/// Says what becomes of each triangle in a pixel, and where the one lies that is seen.
inline std::optional<SeenFragment> report_triangles(PixelReport& report,
                                                    std::span<const ProjectedTriangle> triangles,
                                                    Culling culling, const Scene& scene,
                                                    ivec2 pixel) {
    PixelHistory history;
    const std::optional<SeenFragment> seen = seen_in(triangles, culling, scene, pixel, history);
    history.print(report, scene.meshes);
    if (seen) report_fragment(report, *seen, scene);
    return seen;
}

/// All triangles of a scene that are on the screen, in drawing order, also those that face away.
inline std::vector<ProjectedTriangle> projected_triangles(const Scene& scene,
                                                          const mat4& clip_from_world, ivec2 size) {
    std::vector<ProjectedTriangle> triangles;
    for_each_visible_triangle(
        scene, clip_from_world, size, Culling::none,
        [&](const ProjectedTriangle& projected) { triangles.push_back(projected); });
    return triangles;
}

/// The colour of a face of an instance.
inline vec3 report_face(PixelReport& report, const Instance& instance, const Triangle& triangle,
                        const Scene& scene) {
    const mat3 normal_from_model = normal_matrix(mat3(instance.world_from_model));
    const vec3 normal =
        normalize_or(normal_from_model * flat_normal(instance.mesh, triangle), vec3(0, 1, 0));
    const vec3 color = flat_color(normal, scene.materials[triangle.material]);
    report.line("normal in the world", normal, "Eq. 4.15");
    report.line("flat colour", color);
    return color;
}

/// Explains pixels of this lesson's picture.
///
/// @param options,scene  Have to outlive the probe.
inline PixelProbe mvp_probe(const PotOptions& options, const Scene& scene,
                            std::vector<Instance> instances) {
    const mat4 clip_from_world =
        orbit_camera(options.orbit, scene.bounds()).clip_from_world(options.size);
    std::vector<ProjectedTriangle> triangles;
    std::vector<std::size_t> ends;  // of each instance's triangles
    for (const Instance& instance : instances) {
        for_each_visible_triangle(
            instance.mesh, clip_from_world * instance.world_from_model, options.size, Culling::none,
            [&](const ProjectedTriangle& projected) { triangles.push_back(projected); });
        ends.push_back(triangles.size());
    }
    return [&options, &scene, instances = std::move(instances), triangles = std::move(triangles),
            ends = std::move(ends)](ivec2 pixel, PixelReport& report) {
        const auto seen = report_triangles(report, triangles, Culling::back_faces, scene, pixel);
        if (!seen) return report_backdrop(report, pixel, options.size);
        std::size_t i = 0;
        while (seen->projected >= &triangles[0] + ends[i]) ++i;
        return report_face(report, instances[i], seen->projected->triangle, scene);
    };
}

}  // namespace rasterbook
