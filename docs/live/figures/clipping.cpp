// SPDX-License-Identifier: MIT
/// @file
/// Lesson 04's clipping of a triangle that lies in the plane y = 0 of view space, for the figure
/// clipping.js.
#include <array>
#include <vector>

#include "04_mvp/clip.hpp"
#include "04_mvp/transform.hpp"

namespace rasterbook {
namespace {

struct Vertex2 {
    vec2 view;  ///< x and z.
    vec2 ndc;   ///< x and z after the division by w.
};
std::vector<Vertex2> fan;  ///< Three for each triangle.
std::array<std::array<float, frustum_planes>, 3> distances;

}  // namespace

/// Clips the triangle.
///
/// @param half_fov   Of the camera, radians.
/// @param near       Distance of the near plane, > 0.
/// @param ax,az      A vertex in view space; the others likewise.
/// @return           Triangles left.
extern "C" int clip(float half_fov, float near, float ax, float az, float bx, float bz, float cx,
                    float cz) {
    const mat4 clip_from_view = perspective(2 * half_fov, 1.0f, near);
    const std::array<vec3, 3> vertices = {{{ax, 0, az}, {bx, 0, bz}, {cx, 0, cz}}};
    std::array<vec4, 3> positions_clip;
    for (std::size_t i = 0; i < 3; ++i) {
        positions_clip[i] = clip_from_view * vec4(vertices[i], 1);
        for (int plane = 0; plane < frustum_planes; ++plane)
            distances[i][plane] = plane_distance(plane, positions_clip[i]);
    }
    fan.clear();
    for (const ClippedTriangle& triangle : clip_triangle(positions_clip))
        for (const auto& [position_clip, barycentrics] : triangle) {
            const vec3 view = barycentrics.x * vertices[0] + barycentrics.y * vertices[1] +
                              barycentrics.z * vertices[2];
            const vec3 ndc = vec3(position_clip) / position_clip.w;
            fan.push_back({{view.x, view.z}, {ndc.x, ndc.z}});
        }
    return int(fan.size() / 3);
}

/// The triangles that the last call of clip() left.
extern "C" const Vertex2* clipped() { return fan.data(); }

/// plane_distance of its three vertices from the six planes.
extern "C" const float* plane_distances() { return distances[0].data(); }

}  // namespace rasterbook
