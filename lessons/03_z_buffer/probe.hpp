// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?": the picture of lesson 03 in one pixel, for `--probe`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/probe.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "common/app/orthographic_view.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// Tests a fragment's depth, and notes how that ends.
///
/// @param nearest  Of the one pixel that is probed.
inline bool test_depth(DepthBuffer& nearest, const std::string& triangle,
                       std::optional<Barycentrics> on_screen, float depth, PixelHistory& history) {
    const float before = nearest.depths()[ivec2(0)];
    const bool is_nearer = nearest.test_and_write(ivec2(0), depth);
    if (is_nearer)
        history.written(triangle, on_screen, depth);
    else
        history.lost(triangle, on_screen, depth,
                     "behind: not nearer than " + words(before, 7) + " (Eq. 3.1)");
    return is_nearer;
}

/// Explains pixels of this lesson's picture.
///
/// @param options,scene  Have to outlive the probe.
inline PixelProbe depth_probe(const PaintOptions& options, const Scene& scene) {
    return [&](ivec2 pixel, PixelReport& report) {
        struct Seen {
            std::string name;
            ScreenTriangle on_screen;
            vec3 barycentrics, depths;
            vec3 normal, face_color;
        };
        const OrthographicView view(scene, options.size);
        DepthBuffer nearest(ivec2(1));
        PixelHistory history;
        std::optional<Seen> seen;
        for (const Mesh& mesh : scene.meshes) {
            const std::vector<vec3> positions_screen = view.screen_from_model(mesh.positions);
            for (const Triangle& triangle : mesh.triangles) {
                const vec3 a = positions_screen[triangle.vertices[0].position];
                const vec3 b = positions_screen[triangle.vertices[1].position];
                const vec3 c = positions_screen[triangle.vertices[2].position];
                const ScreenTriangle on_screen = snap_triangle(a, b, c);
                if (!box_holds(on_screen, pixel)) continue;
                const std::string name = name_of(mesh, triangle, scene.materials);
                const std::optional<vec3> at = covered(on_screen, pixel);
                if (!at) {
                    history.missed(name, why_not_covered(on_screen, pixel));
                    continue;
                }
                const vec3 depths(a.z, b.z, c.z);
                const float z = TriangleDepth(depths).at(*at);
                if (!is_front_facing(on_screen))
                    history.lost(name, *at, z, "faces away (Eq. 2.2)");
                else if (test_depth(nearest, name, *at, z, history))
                    seen = Seen{name,
                                on_screen,
                                *at,
                                depths,
                                flat_normal(mesh, triangle),
                                flat_color(mesh, triangle, scene.materials[triangle.material])};
            }
        }
        history.print(report, scene.meshes);
        if (!seen) return report_backdrop(report, pixel, options.size);
        report.section("seen: " + seen->name);
        report_coverage(report, seen->on_screen, seen->barycentrics);
        report.line("depths of a, b, c", seen->depths);
        const float depth = TriangleDepth(seen->depths).at(seen->barycentrics);
        report.line("depth", words(depth, 7), "Eq. 3.3");
        if (options.paint == Paint::barycentric) return seen->barycentrics;
        report.line("normal of the face", seen->normal);
        report.line("flat colour", seen->face_color);
        return seen->face_color;
    };
}

}  // namespace rasterbook
