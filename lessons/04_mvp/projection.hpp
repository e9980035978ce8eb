// SPDX-License-Identifier: MIT
/// @file
/// From triangles of a mesh to triangles on the screen: culled, transformed, clipped, projected,
/// snapped. Introduced in lesson 04; derivation: docs/derivations/04_mvp.md.
#pragma once

#include <vector>

#include "02_triangle_fill/count_triangle.hpp"
#include "02_triangle_fill/triangle.hpp"
#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/clip.hpp"
#include "04_mvp/transform.hpp"
#include "common/app/counters.hpp"
#include "common/app/empty_picture.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// A triangle on the screen, or what clipping has left of it.
struct ProjectedTriangle {
    const Mesh& mesh;
    const Triangle& triangle;  ///< The whole one.
    ClippedTriangle clipped;   ///< Clip space, and barycentric coordinates in the whole one.
    ScreenTriangle on_screen;
    TriangleDepth depth;
    bool is_back_facing;  ///< Or of no area.
};

/// Divides by w, and snaps to the screen's grid (Eq. 4.9 and 2.8).
inline ProjectedTriangle project(const Mesh& mesh, const Triangle& triangle,
                                 const ClippedTriangle& clipped, ivec2 size) {
    const vec3 a = screen_from_clip(clipped[0].position_clip, size);
    const vec3 b = screen_from_clip(clipped[1].position_clip, size);
    const vec3 c = screen_from_clip(clipped[2].position_clip, size);
    const ScreenTriangle on_screen = snap_triangle(a, b, c);
    trace_triangle(mesh, triangle, on_screen, clipped);
    return {mesh,
            triangle,
            clipped,
            on_screen,
            TriangleDepth(vec3(a.z, b.z, c.z)),
            !is_front_facing(on_screen)};
}

/// Which triangles are not drawn because of the side that they show.
enum class Culling { back_faces, none };

/// Visits what may be visible of a mesh, in its order.
///
/// Counts the mesh and its triangles, and what of them is culled.
///
/// @param size   Of the picture, in pixels.
/// @param visit  Called as visit(const ProjectedTriangle&).
template <typename Visit>
void for_each_visible_triangle(const Mesh& mesh, const mat4& clip_from_model, ivec2 size,
                               Culling culling, Visit&& visit) {
    count(Counter::meshes_in);
    count_undrawn_if_asked(mesh, clip_from_model);
    if (is_outside_frustum(mesh.bounds, clip_from_model)) {
        count(Counter::meshes_culled_by_frustum);
        return;
    }
    if (!mesh.tangents.empty()) count(Counter::meshes_with_tangents);
    const std::vector<vec4> positions_clip = transform(clip_from_model, mesh.positions);
    for (const Triangle& triangle : mesh.triangles) {
        count(Counter::triangles_in);
        for (const ClippedTriangle& clipped :
             clip_triangle(vertices_of(triangle, positions_clip))) {
            const ProjectedTriangle projected = project(mesh, triangle, clipped, size);
            if (projected.is_back_facing && culling == Culling::back_faces)
                count(Counter::triangles_culled_by_facing);
            else
                visit(projected);
        }
    }
}

/// Visits what may be visible of a scene.
template <typename Visit>
void for_each_visible_triangle(const Scene& scene, const mat4& clip_from_world, ivec2 size,
                               Culling culling, Visit&& visit) {
    for (const Mesh& mesh : scene.meshes)
        for_each_visible_triangle(mesh, clip_from_world, size, culling, visit);
}

}  // namespace rasterbook
