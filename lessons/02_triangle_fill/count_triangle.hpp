// SPDX-License-Identifier: MIT
/// @file
/// A triangle is counted for `--stats`, and noted for `--probe`, before it is filled.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include <glm/geometric.hpp>

#include "02_triangle_fill/triangle.hpp"
#include "common/app/counters.hpp"
#include "common/model/mesh.hpp"
#include "common/probe/pixel_trace.hpp"

namespace rasterbook {

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

/// Where a triangle lies on the screen, and the pixel in it.
///
/// @param w         Of its vertices; none where there is no perspective.
/// @param is_whole  Else clipping has cut it off.
[[gnu::cold, gnu::noinline]] inline void note_triangle(PixelTrace& notes, const Mesh& mesh,
                                                       const Triangle& triangle,
                                                       const ScreenTriangle& on_screen,
                                                       std::optional<vec3> w, bool is_whole) {
    const ivec2 pixel = notes.pixel(), center = pixel * subpixels + subpixels / 2;
    const auto [a, b, c] = on_screen.vertices;
    const ivec2 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
    const bool is_in_box =
        low.x <= center.x && low.y <= center.y && center.x <= high.x && center.y <= high.y;
    if (!is_in_box) return notes.leave();
    TriangleInPixel of{notes.name_of(mesh, triangle) + (is_whole ? "" : ", a clipped piece"),
                       on_screen.vertices, 1.0f / w.value_or(vec3(1)), is_front_facing(on_screen)};
    fill_triangle(on_screen, pixel, pixel, [&](ivec2 filled, Barycentrics at) {
        if (filled == pixel) of.barycentrics = at;
    });
    if (!of.barycentrics) of.fate = why_not_covered(on_screen, pixel);
    notes.add(of);
    if (!is_traced()) return;
    const auto in_pixels = [](ivec2 vertex) { return words(vec2(vertex) / float{subpixels}); };
    if (w) trace("w of a, b, c", *w, "Eq. 4.8");
    trace("vertices a, b, c, px", in_pixels(a) + ",  " + in_pixels(b) + ",  " + in_pixels(c),
          "Eq. 2.8");
    trace("area, square px",
          static_cast<float>(on_screen.twice_area) / (2.0f * subpixels * subpixels), "Eq. 2.2");
    trace("barycentrics", *of.barycentrics, "Eq. 2.4");
}

inline void trace_triangle(const Mesh& mesh, const Triangle& triangle,
                           const ScreenTriangle& on_screen) {
    if constexpr (has_probe)
        if (pixel_trace && !pixel_trace->is_muted())
            note_triangle(*pixel_trace, mesh, triangle, on_screen, std::nullopt, true);
}

/// @param clipped  Lesson 04's ClippedTriangle.
template <typename Clipped>
void trace_triangle(const Mesh& mesh, const Triangle& triangle, const ScreenTriangle& on_screen,
                    const Clipped& clipped) {
    if constexpr (has_probe) {
        if (!pixel_trace || pixel_trace->is_muted()) return;
        const vec3 w(clipped[0].position_clip.w, clipped[1].position_clip.w,
                     clipped[2].position_clip.w);
        const bool is_whole = mat3(clipped[0].barycentrics, clipped[1].barycentrics,
                                   clipped[2].barycentrics) == mat3(1);
        note_triangle(*pixel_trace, mesh, triangle, on_screen, w, is_whole);
    }
}

/// Counts a triangle for `--stats`, and whether it is culled because it faces away; notes it for
/// `--probe`.
inline void count_triangle(const Mesh& mesh, const Triangle& triangle,
                           const ScreenTriangle& on_screen) {
    count(Counter::triangles_in);
    if (!is_front_facing(on_screen)) count(Counter::triangles_culled_by_facing);
    trace_triangle(mesh, triangle, on_screen);
}

}  // namespace rasterbook
