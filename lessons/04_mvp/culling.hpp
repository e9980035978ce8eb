// SPDX-License-Identifier: MIT
/// @file
/// What is not drawn of a scene, and why: counted for `--stats`, and for the warning that a picture
/// is empty. Introduced in lesson 04; derivation: docs/derivations/04_mvp.md.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include <glm/vector_relational.hpp>

#include "02_triangle_fill/triangle.hpp"
#include "04_mvp/clip.hpp"
#include "common/app/counters.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// Which triangles are not drawn because of the side that they show.
enum class Culling { back_faces, none };

/// How many triangles are not drawn, by the reason.
struct CulledTriangles {
    std::size_t facing = 0, without_area = 0, outside_view = 0, behind_camera = 0, overflowing = 0;

    bool operator==(const CulledTriangles&) const = default;

    /// Counts a triangle of which clipping leaves nothing; or all of a mesh, by the corners of its
    /// box.
    void add_outside(std::span<const vec4> points_clip, std::size_t times = 1) {
        const auto is_finite = [](vec4 p) {
            return glm::all(glm::lessThan(glm::abs(p), vec4(clip_limit)));
        };
        if (!std::ranges::all_of(points_clip, is_finite))
            overflowing += times;
        else if (std::ranges::all_of(points_clip, [](vec4 p) { return p.w <= 0; }))
            behind_camera += times;
        else
            outside_view += times;
    }

    /// False for a piece that is culled. Counts it, or that it has no area; of a triangle that is
    /// cut into several, the first one.
    bool takes(const ScreenTriangle& piece, Culling culling, bool is_first) {
        if (is_front_facing(piece)) return true;
        const bool has_area = piece.twice_area != 0;
        if (is_first && !has_area) ++without_area;
        if (culling == Culling::none) return true;
        if (is_first && has_area) ++facing;
        return false;
    }

    void add(const CulledTriangles& others) {
        facing += others.facing, without_area += others.without_area;
        outside_view += others.outside_view, behind_camera += others.behind_camera;
        overflowing += others.overflowing;
    }

    template <typename CounterPolicy>
    void add_to(CounterPolicy& counters) const {
        counters.add(Counter::triangles_culled_by_facing, facing);
        counters.add(Counter::triangles_without_area, without_area);
        counters.add(Counter::triangles_outside_view, outside_view);
        counters.add(Counter::triangles_behind_camera, behind_camera);
        counters.add(Counter::triangles_overflowing, overflowing);
    }
};

/// Whether nothing of a mesh is in view, judged by its box; if so, it is counted.
template <typename CounterPolicy>
bool is_culled(const Mesh& mesh, const mat4& clip_from_model, CounterPolicy& counters) {
    counters.add(Counter::meshes_in);
    if (!is_outside_frustum(mesh.bounds, clip_from_model)) return false;
    counters.add(Counter::meshes_culled_by_frustum);
    const auto& [low, high] = mesh.bounds;
    std::array<vec4, 8> corners;
    for (unsigned i = 0; i < 8; ++i)
        corners[i] = clip_from_model * vec4(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y,
                                            i & 4 ? high.z : low.z, 1);
    CulledTriangles culled;
    culled.add_outside(corners, mesh.triangles.size());
    culled.add_to(counters);
    return true;
}

}  // namespace rasterbook
