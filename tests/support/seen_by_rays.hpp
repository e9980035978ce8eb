// SPDX-License-Identifier: MIT
/// @file
/// Where the camera of lesson 04 sees points and triangles, found in long double and with none of
/// the course's functions.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "04_mvp/camera.hpp"
#include "common/math/types.hpp"

namespace rasterbook::test {

using real = long double;
using lvec3 = glm::vec<3, real>;

struct Place {
    real x, y;
};

/// A camera that looks at a point, both moved along each axis; y is up.
class ReferenceCamera {
  public:
    /// @param camera  Its place, angle and nothing else.
    ReferenceCamera(const Camera& camera, vec3 center, ivec2 size, double offset)
        : size_(size), offset_(offset), eye_(lvec3(camera.position_world) + offset_) {
        forward_ = glm::normalize(lvec3(center) + offset_ - eye_);
        right_ = glm::normalize(lvec3(-forward_.z, 0, forward_.x));
        up_ = glm::cross(right_, forward_);
        half_height_ = std::tan(static_cast<real>(camera.fov_y_radians) / 2);
    }

    /// Where a point in front of the camera is seen, in pixels.
    Place on_screen(vec3 point) const {
        const lvec3 way = lvec3(point) + offset_ - eye_;
        const real x = glm::dot(right_, way), y = glm::dot(up_, way);
        const real half_height = half_height_ * glm::dot(forward_, way);
        const real half_width = half_height * size_.x / size_.y;
        return {size_.x / 2 * (1 + x / half_width), size_.y / 2 * (1 - y / half_height)};
    }

  private:
    glm::vec<2, real> size_;
    real offset_, half_height_;
    lvec3 eye_, forward_, right_, up_;
};

using ClipVertices = std::array<vec4, 3>;

/// Whether a pixel's ray meets a triangle beyond the near plane. In clip space without
/// its z, which is what a camera at the origin sees, a pixel's ray is (x, y, 1) times w > 0.
class RaySeen {
  public:
    explicit RaySeen(const ClipVertices& vertices) : vertices_(vertices) {}

    /// @return  False where the triangle is seen clockwise.
    bool is_seen(ivec2 pixel, ivec2 size) const {
        return is_seen_at(pixel.x + 0.5L, pixel.y + 0.5L, size);
    }

    /// Whether what is seen changes within about so many pixels of a pixel's centre.
    bool is_near_border(ivec2 pixel, ivec2 size, real band_px) const {
        const bool here = is_seen(pixel, size);
        for (int i = 0; i < 8; ++i) {
            const real angle_radians = i * 0.785398163397448310L;
            if (is_seen_at(pixel.x + 0.5L + band_px * std::cos(angle_radians),
                           pixel.y + 0.5L + band_px * std::sin(angle_radians), size) != here)
                return true;
        }
        return false;
    }

  private:
    /// Moeller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997.
    bool is_seen_at(real x_px, real y_px, ivec2 size) const {
        const lvec3 ray(2 * x_px / size.x - 1, 1 - 2 * y_px / size.y, 1);
        const auto vertex = [&](std::size_t i) {
            return lvec3(vertices_[i].x, vertices_[i].y, vertices_[i].w);
        };
        const lvec3 u = vertex(1) - vertex(0), v = vertex(2) - vertex(0), p = glm::cross(ray, v);
        const real volume = glm::dot(u, p);
        if (!(volume < 0)) return false;  // the ray leaves through it, or passes beside
        const lvec3 s = -vertex(0), q = glm::cross(s, u);
        const real b = glm::dot(s, p) / volume, c = glm::dot(ray, q) / volume;
        if (!(b >= 0 && c >= 0 && b + c <= 1)) return false;
        const real w = glm::dot(v, q) / volume;
        const lvec3 depths(vertices_[0].z, vertices_[1].z, vertices_[2].z);
        const real z = depths[0] + b * (depths[1] - depths[0]) + c * (depths[2] - depths[0]);
        return w > 0 && 0 <= z && z <= w;
    }

    ClipVertices vertices_;
};

/// Of view space, by a camera that sees 90 degrees, from 1 on.
inline vec4 seen_from_origin(vec3 view) { return {view.x, view.y, 1, -view.z}; }

/// Turns the triangle round if it is seen clockwise from the origin.
inline ClipVertices front(std::array<vec3, 3> view) {
    if (glm::dot(view[0], glm::cross(view[1], view[2])) > 0) std::swap(view[1], view[2]);
    return {seen_from_origin(view[0]), seen_from_origin(view[1]), seen_from_origin(view[2])};
}

/// Triangles of a few pixels: three in five in the picture, the others across its border, across
/// the near plane, outside or behind.
inline std::vector<ClipVertices> small_triangles(int count) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> direction(-1.2f, 1.2f), about(-0.06f, 0.06f),
        octaves(-0.2f, 6.8f), share(0, 1);
    std::vector<ClipVertices> triangles;
    while (std::ssize(triangles) < count) {
        const float distance = std::exp2(octaves(random)) * (share(random) < 0.1f ? -1.0f : 1.0f);
        const vec3 center = distance * vec3(direction(random), direction(random), -1);
        std::array<vec3, 3> vertices;
        for (vec3& vertex : vertices)
            vertex = center + distance * vec3(about(random), about(random), about(random));
        triangles.push_back(front(vertices));
    }
    return triangles;
}

/// Triangles with vertices all around the camera: most of them cross the plane w = 0.
inline std::vector<ClipVertices> large_triangles(int count) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> any(-30, 30);
    std::vector<ClipVertices> triangles;
    while (std::ssize(triangles) < count) {
        std::array<vec3, 3> vertices;
        for (vec3& vertex : vertices) vertex = {any(random), any(random), any(random)};
        triangles.push_back(front(vertices));
    }
    return triangles;
}

}  // namespace rasterbook::test
