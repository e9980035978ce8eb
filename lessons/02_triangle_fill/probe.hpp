// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?": the picture of lesson 02 in one pixel, for `--probe`.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "02_triangle_fill/flat_color.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "common/app/orthographic_view.hpp"
#include "common/image/backdrop.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// Whether a pixel's centre lies in the bounding box of a triangle.
inline bool box_holds(const ScreenTriangle& triangle, ivec2 pixel) {
    const auto [a, b, c] = triangle.vertices;
    const ivec2 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
    const ivec2 center = pixel * subpixels + subpixels / 2;
    return glm::all(glm::lessThanEqual(low, center)) && glm::all(glm::lessThanEqual(center, high));
}

/// The barycentric coordinates of a pixel's centre; none where the triangle does not cover it.
inline std::optional<Barycentrics> covered(const ScreenTriangle& triangle, ivec2 pixel) {
    std::optional<Barycentrics> found;
    fill_triangle(triangle, pixel, pixel, [&](ivec2 filled, Barycentrics at) {
        if (filled == pixel) found = at;
    });
    return found;
}

/// The edges that keep a triangle from covering a pixel, and how far beyond them its centre lies.
inline std::string why_not_covered(const ScreenTriangle& triangle, ivec2 pixel) {
    if (triangle.twice_area == 0) return "has no area";
    constexpr std::array names = {"bc", "ca", "ab"};
    std::string outside, on;
    for (std::size_t i = 0; i < 3; ++i) {
        const ivec2 from = triangle.vertices[(i + 1) % 3], to = triangle.vertices[(i + 2) % 3];
        const EdgeWalk edge(from, to, is_front_facing(triangle) ? 1 : -1, pixel);
        if (edge.value >= edge.least) continue;
        if (edge.value == 0) {
            on = std::string("on edge ") + names[i] + ", neither a left nor a top one (Eq. 2.7)";
            continue;
        }
        const double length = glm::length(dvec2(to) - dvec2(from));
        const double distance_px = -static_cast<double>(edge.value) / (length * subpixels);
        outside += std::string(outside.empty() ? "outside of edge " : ", ") + names[i] + " by " +
                   words(static_cast<float>(distance_px), 3) + " px";
    }
    return outside.empty() ? on : outside + " (Eq. 2.2)";
}

/// Says where a triangle lies on the screen, and the pixel in it.
inline void report_coverage(PixelReport& report, const ScreenTriangle& triangle,
                            Barycentrics on_screen) {
    const auto [a, b, c] = triangle.vertices;
    const auto in_pixels = [](ivec2 vertex) { return words(vec2(vertex) / float{subpixels}); };
    report.line("vertices a, b, c, px", in_pixels(a) + ",  " + in_pixels(b) + ",  " + in_pixels(c),
                "Eq. 2.8");
    report.line("area, square px",
                static_cast<float>(triangle.twice_area) / (2.0f * subpixels * subpixels),
                "Eq. 2.2");
    report.line("barycentrics", on_screen, "Eq. 2.4");
}

/// Says that no triangle is seen in the pixel.
///
/// @return  The colour of the backdrop there.
inline vec3 report_backdrop(PixelReport& report, ivec2 pixel, ivec2 size) {
    report.section("seen: the backdrop, since no triangle is written here");
    return backdrop_color(pixel.y, size.y);
}

/// Explains pixels of this lesson's picture.
///
/// @param options,scene  Have to outlive the probe.
inline PixelProbe fill_probe(const PaintOptions& options, const Scene& scene) {
    return [&](ivec2 pixel, PixelReport& report) {
        struct Seen {
            std::string name;
            ScreenTriangle on_screen;
            vec3 barycentrics, normal, face_color;
        };
        const OrthographicView view(scene, options.size);
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
                const std::optional<vec3> at = covered(on_screen, pixel);
                const std::string name = name_of(mesh, triangle, scene.materials);
                if (!at) {
                    history.missed(name, why_not_covered(on_screen, pixel));
                } else if (!is_front_facing(on_screen)) {
                    history.lost(name, *at, {}, "faces away (Eq. 2.2)");
                } else {
                    history.written(name, *at, {});
                    seen = Seen{name, on_screen, *at, flat_normal(mesh, triangle),
                                flat_color(mesh, triangle, scene.materials[triangle.material])};
                }
            }
        }
        history.print(report, scene.meshes);
        if (!seen) return report_backdrop(report, pixel, options.size);
        report.section("seen: " + seen->name);
        report_coverage(report, seen->on_screen, seen->barycentrics);
        if (options.paint == Paint::barycentric) return seen->barycentrics;
        report.line("normal of the face", seen->normal);
        report.line("flat colour", seen->face_color);
        return seen->face_color;
    };
}

}  // namespace rasterbook
