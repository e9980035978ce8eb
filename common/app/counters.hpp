// SPDX-License-Identifier: MIT
/// @file
/// What a lesson did to make its picture, counted for --stats.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace rasterbook {

enum class Counter {
    lines,
    line_pixels,
    meshes_in,
    meshes_culled_by_frustum,
    triangles_in,
    triangles_culled_by_facing,
    fragments_tested,  ///< Compared with the depth buffer.
    fragments_shaded,  ///< Written into the picture.
    texture_samples,
    fragments_lit,
    highlights,      ///< Fragments for which highlights are computed.
    toon_fragments,  ///< Painted in tones.
    outline_tests,   ///< Of fragments or pixels, whether there is an outline.
    outline_pixels,  ///< Inked; some several times.
    normal_map_samples,
    meshes_with_tangents,
    shadow_passes,           ///< Depth maps drawn.
    shadow_parts,            ///< Of depth maps, drawn because a pixel asked for them.
    shadow_fragments,        ///< Compared with a depth map's texel.
    alpha_tested_texels,     ///< Of depth maps: asked whether a caster is there or a hole.
    shadow_tests,            ///< Points for which a depth map was asked, with all its texels.
    colored_fragments,       ///< Coloured by the colours of vertices.
    alpha_tested_fragments,  ///< Asked whether they are there or a hole.
    blended_fragments,       ///< Through which may be seen what lies behind.
    count
};

/// The counters' names in the order of Counter.
constexpr std::array<std::string_view, static_cast<std::size_t>(Counter::count)> counter_names = {
    "lines",
    "line_pixels",
    "meshes_in",
    "meshes_culled_by_frustum",
    "triangles_in",
    "triangles_culled_by_facing",
    "fragments_tested",
    "fragments_shaded",
    "texture_samples",
    "fragments_lit",
    "highlights",
    "toon_fragments",
    "outline_tests",
    "outline_pixels",
    "normal_map_samples",
    "meshes_with_tangents",
    "shadow_passes",
    "shadow_parts",
    "shadow_fragments",
    "alpha_tested_texels",
    "shadow_tests",
    "colored_fragments",
    "alpha_tested_fragments",
    "blended_fragments"};

/// Why triangles of a model are not drawn.
struct UndrawnTriangles {
    std::uint64_t behind_camera = 0;
    std::uint64_t outside_view = 0;  ///< Of the frustum, but not behind the camera.
    std::uint64_t overflowing = 0;   ///< In clip space, their numbers are too large.
    std::uint64_t without_area = 0;  ///< On the screen.
    std::uint64_t facing_away = 0;
};

/// Counts.
struct Counters {
    std::array<std::uint64_t, static_cast<std::size_t>(Counter::count)> values{};
    UndrawnTriangles* undrawn = nullptr;  ///< Counted where there is one: of an empty picture.

    void add(Counter counter, std::uint64_t times = 1) {
        values[static_cast<std::size_t>(counter)] += times;
    }
    void add(const Counters& others) {
        for (std::size_t i = 0; i < values.size(); ++i) values[i] += others.values[i];
    }
};

/// Takes the place of Counters where nothing is to be counted: compiles to nothing.
struct NoCounters {
    void add(Counter, std::uint64_t = 1) {}
    void add(const NoCounters&) {}
};

}  // namespace rasterbook
