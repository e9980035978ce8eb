// SPDX-License-Identifier: MIT
/// @file
/// What a lesson does to make its picture, counted for --stats.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

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

/// How often each thing was done.
struct Counters {
    std::array<std::uint64_t, static_cast<std::size_t>(Counter::count)> values{};

    std::uint64_t operator[](Counter counter) const {
        return values[static_cast<std::size_t>(counter)];
    }
    Counters& operator+=(const Counters& others) {
        for (std::size_t i = 0; i < values.size(); ++i) values[i] += others.values[i];
        return *this;
    }
    bool operator==(const Counters&) const = default;
};

/// What this thread has counted.
inline thread_local constinit Counters thread_counters;

/// Counts that this thread has done something, so many times.
inline void count(Counter counter, std::uint64_t times = 1) {
    thread_counters.values[static_cast<std::size_t>(counter)] += times;
}

/// How many fragments this thread shades at once; in lesson 14, the lanes that stand for one.
inline thread_local constinit std::uint64_t fragments_at_once = 1;

/// Counts what is done to each fragment of an F.
///
/// @tparam F  float for one fragment; for those that are shaded at once, lesson 14's Floats.
template <typename F>
void count_each(Counter counter) {
    count(counter, std::is_same_v<F, float> ? 1 : fragments_at_once);
}

/// What the thread counts while there is one of these is forgotten.
class Uncounted {
  public:
    Uncounted() = default;
    Uncounted(const Uncounted&) = delete;
    Uncounted& operator=(const Uncounted&) = delete;
    ~Uncounted() { thread_counters = before_; }

  private:
    Counters before_ = thread_counters;
};

/// Why triangles of a model are not drawn.
struct UndrawnTriangles {
    std::uint64_t behind_camera = 0;
    std::uint64_t outside_view = 0;  ///< Of the frustum, but not behind the camera.
    std::uint64_t overflowing = 0;   ///< In clip space, their numbers are too large.
    std::uint64_t without_area = 0;  ///< On the screen.
    std::uint64_t facing_away = 0;
};

/// Where they are counted, if the thread is asked to: of an empty picture.
inline thread_local constinit UndrawnTriangles* undrawn_triangles = nullptr;

}  // namespace rasterbook
