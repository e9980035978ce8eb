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

#include "04_mvp/camera.hpp"
#include "common/math/types.hpp"

namespace rasterbook::test {

struct Place {
    long double x, y;
};

/// A camera that looks at a point, both moved along each axis; y is up.
class ReferenceCamera {
  public:
    /// @param camera  Its place, angle and nothing else.
    ReferenceCamera(const Camera& camera, vec3 center, ivec2 size, double offset)
        : width_(size.x), height_(size.y), offset_(offset) {
        long double toward[3], length = 0;
        for (int i = 0; i < 3; ++i) {
            eye_[i] = static_cast<long double>(camera.position_world[i]) + offset;
            toward[i] = static_cast<long double>(center[i]) + offset - eye_[i];
            length += toward[i] * toward[i];
        }
        for (int i = 0; i < 3; ++i) forward_[i] = toward[i] / std::sqrt(length);
        const long double level = std::hypot(forward_[0], forward_[2]);
        right_[0] = -forward_[2] / level, right_[1] = 0, right_[2] = forward_[0] / level;
        up_[0] = -forward_[1] * forward_[0] / level;
        up_[1] = level;
        up_[2] = -forward_[1] * forward_[2] / level;
        half_height_ = std::tan(static_cast<long double>(camera.fov_y_radians) / 2);
    }

    /// Where a point in front of the camera is seen, in pixels.
    Place on_screen(vec3 point) const {
        long double x = 0, y = 0, z = 0;
        for (int i = 0; i < 3; ++i) {
            const long double way = static_cast<long double>(point[i]) + offset_ - eye_[i];
            x += right_[i] * way, y += up_[i] * way, z += forward_[i] * way;
        }
        const long double half_width = half_height_ * width_ / height_;
        return {width_ / 2 * (1 + x / (z * half_width)),
                height_ / 2 * (1 - y / (z * half_height_))};
    }

  private:
    long double width_, height_, offset_, half_height_;
    long double eye_[3], forward_[3], right_[3], up_[3];
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
    bool is_near_border(ivec2 pixel, ivec2 size, long double band_px) const {
        const bool here = is_seen(pixel, size);
        for (int i = 0; i < 8; ++i) {
            const long double angle_radians = i * 0.785398163397448310L;
            if (is_seen_at(pixel.x + 0.5L + band_px * std::cos(angle_radians),
                           pixel.y + 0.5L + band_px * std::sin(angle_radians), size) != here)
                return true;
        }
        return false;
    }

  private:
    bool is_seen_at(long double x, long double y, ivec2 size) const {
        Crossing crossing;
        return cross(2 * x / size.x - 1, 1 - 2 * y / size.y, crossing) && 0 <= crossing.z &&
               crossing.z <= crossing.w;
    }

    struct Crossing {
        long double w, z;
    };

    /// Moeller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997.
    bool cross(long double x, long double y, Crossing& crossing) const {
        const auto side = [&](std::size_t to, int axis) {
            const int component = axis < 2 ? axis : 3;
            return static_cast<long double>(vertices_[to][component]) - vertices_[0][component];
        };
        const long double u[3] = {side(1, 0), side(1, 1), side(1, 2)};
        const long double v[3] = {side(2, 0), side(2, 1), side(2, 2)};
        const long double p[3] = {y * v[2] - v[1], v[0] - x * v[2], x * v[1] - y * v[0]};
        const long double volume = u[0] * p[0] + u[1] * p[1] + u[2] * p[2];
        if (!(volume < 0)) return false;  // the ray leaves through it, or passes beside
        const long double s[3] = {-static_cast<long double>(vertices_[0].x),
                                  -static_cast<long double>(vertices_[0].y),
                                  -static_cast<long double>(vertices_[0].w)};
        const long double b = (s[0] * p[0] + s[1] * p[1] + s[2] * p[2]) / volume;
        const long double q[3] = {s[1] * u[2] - s[2] * u[1], s[2] * u[0] - s[0] * u[2],
                                  s[0] * u[1] - s[1] * u[0]};
        const long double c = (x * q[0] + y * q[1] + q[2]) / volume;
        if (!(b >= 0 && c >= 0 && b + c <= 1)) return false;
        crossing.w = (v[0] * q[0] + v[1] * q[1] + v[2] * q[2]) / volume;
        const auto z = [&](std::size_t i) { return static_cast<long double>(vertices_[i].z); };
        crossing.z = z(0) + b * (z(1) - z(0)) + c * (z(2) - z(0));
        return crossing.w > 0;
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
