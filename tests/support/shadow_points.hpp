// SPDX-License-Identifier: MIT
/// @file
/// The points of a scene that a camera sees, and whether a light reaches them, by rays in double.
#pragma once

#include <cmath>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "03_z_buffer/depth_buffer.hpp"
#include "04_mvp/camera.hpp"
#include "04_mvp/projection.hpp"
#include "05_textures/interpolation.hpp"
#include "06_phong/light.hpp"
#include "common/image/image.hpp"
#include "common/math/functions.hpp"
#include "common/model/mesh.hpp"
#include "support/light_maps.hpp"
#include "support/ray_cast.hpp"

namespace rasterbook::test {

struct SeenPoint {
    ivec2 pixel;
    vec3 position, normal;  ///< World space; the normal is interpolated, and of length 1.
    Vertices vertices;      ///< Of its triangle.
};

/// What is seen in each pixel of which something is.
///
/// @param scene  Each vertex has a normal.
inline std::vector<SeenPoint> seen_points(const Scene& scene, const Camera& camera, ivec2 size) {
    DepthBuffer depth(size);
    Image<std::optional<SeenPoint>> seen(size);
    for_each_visible_triangle(
        scene, camera.clip_from_world(size), size, Culling::back_faces,
        [&](const ProjectedTriangle& projected) {
            const auto& [mesh, triangle] = std::tie(projected.mesh, projected.triangle);
            const Vertices vertices = vertices_in(mesh, triangle);
            const Vertices normals = {mesh.normals[triangle.vertices[0].normal],
                                      mesh.normals[triangle.vertices[1].normal],
                                      mesh.normals[triangle.vertices[2].normal]};
            const PerspectiveSetup setup =
                perspective_setup(projected.on_screen, projected.clipped);
            fill_triangle(projected.on_screen, size, [&](ivec2 pixel, Barycentrics on_screen) {
                if (!depth.test_and_write(pixel, projected.depth.at(on_screen))) return;
                const Barycentrics at = perspective_correct(setup, on_screen).here;
                seen[pixel] = {pixel, interpolate(vertices, at),
                               unit_or(interpolate(normals, at), normals[0]), vertices};
            });
        });
    std::vector<SeenPoint> points;
    for (const auto& point : seen.pixels())
        if (point) points.push_back(*point);
    return points;
}

/// Whether a light reaches a point.
class LightRays {
  public:
    /// @param size  Of the scene: a ray begins a hundred-thousandth of it away from its point, so
    ///              that the surface on which this lies does not stand in its way.
    LightRays(const Light& light, RayCaster caster, double size)
        : light_(light), caster_(std::move(caster)), begin_(1e-5 * size) {}

    bool is_lit(dvec3 point) const { return !distance_to_caster(point); }

    /// How far from the point, on the way to the light, the first caster stands.
    std::optional<double> distance_to_caster(dvec3 point) const {
        if (light_.kind == LightKind::directional)
            return caster_.nearest({point, glm::normalize(dvec3(light_.direction_world)), begin_});
        const dvec3 way = dvec3(light_.position_world) - point;
        const double length = glm::length(way);
        return caster_.nearest({point, way / length, begin_, length});
    }

    /// Whether the same is seen from a circle around the point, in the plane of its normal.
    bool is_far_from_edges(dvec3 point, dvec3 normal, double radius) const {
        const bool is_lit_here = is_lit(point);
        const dvec3 size = glm::abs(normal);
        const dvec3 axis = size.x < size.y && size.x < size.z ? dvec3(1, 0, 0)
                           : size.y < size.z                  ? dvec3(0, 1, 0)
                                                              : dvec3(0, 0, 1);
        const dvec3 u = glm::normalize(glm::cross(normal, axis)), v = glm::cross(normal, u);
        for (const double share : {0.5, 1.0})
            for (int i = 0; i < 8; ++i) {
                const double angle_radians = i * 0.785398163397448;
                const dvec3 beside =
                    point +
                    share * radius * (std::cos(angle_radians) * u + std::sin(angle_radians) * v);
                if (is_lit(beside) != is_lit_here) return false;
            }
        return true;
    }

  private:
    Light light_;
    RayCaster caster_;
    double begin_;
};

}  // namespace rasterbook::test
