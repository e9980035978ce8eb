// SPDX-License-Identifier: MIT
/// @file
/// The camera of lessons 01 to 03: one fixed direction, no perspective. Lesson 04 replaces it.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "common/model/mesh.hpp"

namespace rasterbook {

/// Looks at a scene from the front, a little from the left and from above, and fits it into a
/// picture.
///
/// A point's place along an axis is its dot product with the axis; the three axes are the picture's
/// right, its up, and the way out of the picture, towards the eye.
class OrthographicView {
  public:
    /// @param scene  Holds at least one face.
    /// @param size   Width and height in pixels, >= 1.
    OrthographicView(const Scene& scene, ivec2 size) : middle_screen_(0.5 * dvec2(size)) {
        for (const Mesh& mesh : scene.meshes)
            for (const Vertex& vertex : mesh.vertices) {
                const dvec3 place = along_axes(mesh.positions[vertex.position]);
                min_ = glm::min(min_, place);
                max_ = glm::max(max_, place);
            }
        const dvec3 extent = glm::max(max_ - min_, dvec3(least_extent));
        pixels_per_unit_ = 0.8 * std::min(size.x / extent.x, size.y / extent.y);
    }

    /// @return  For each position: x right and y down in pixels, and the depth: 0.99 for the
    ///          nearest point of the scene to 0.01 for the farthest.
    std::vector<vec3> screen_from_model(const std::vector<vec3>& positions_model) const {
        const dvec3 middle = 0.5 * (min_ + max_);
        const double depth_extent = std::max(max_.z - min_.z, least_extent);
        std::vector<vec3> positions_screen;
        positions_screen.reserve(positions_model.size());
        for (const vec3 position : positions_model) {
            const dvec3 offset = along_axes(position) - middle;
            positions_screen.emplace_back(middle_screen_.x + pixels_per_unit_ * offset.x,
                                          middle_screen_.y - pixels_per_unit_ * offset.y,
                                          0.5 + 0.98 * offset.z / depth_extent);
        }
        return positions_screen;
    }

  private:
    static constexpr double least_extent = 1e-60;  ///< Far below all floats but 0.

    static dvec3 along_axes(vec3 position) {
        // The camera turned by 30 degrees to the side, then by 25 degrees down.
        constexpr double cos_yaw = 0.866025403784439, sin_yaw = 0.5;
        constexpr double cos_pitch = 0.906307787036650, sin_pitch = 0.422618261740699;
        const dvec3 p(position), right(cos_yaw, 0, sin_yaw),
            up(sin_pitch * sin_yaw, cos_pitch, -sin_pitch * cos_yaw),
            out(-cos_pitch * sin_yaw, sin_pitch, cos_pitch * cos_yaw);
        return {glm::dot(p, right), glm::dot(p, up), glm::dot(p, out)};
    }

    dvec3 min_{std::numeric_limits<double>::infinity()},
        max_{-std::numeric_limits<double>::infinity()};
    dvec2 middle_screen_;
    double pixels_per_unit_;
};

}  // namespace rasterbook
