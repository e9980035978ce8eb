// SPDX-License-Identifier: MIT
/// @file
/// One colour for a whole triangle, by the way it faces: a stand-in until lesson 06 derives
/// lighting.
#pragma once

#include <algorithm>

#include "02_triangle_fill/count_triangle.hpp"
#include "common/app/lesson_app.hpp"
#include "common/math/numerics.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// What a triangle's pixels show.
enum class Paint { flat, barycentric };

struct PaintOptions : LessonOptions {
    Paint paint = Paint::flat;

    void declare(OptionParser& parser) {
        parser.choice(
            "--paint", paint, {{"flat", Paint::flat}, {"barycentric", Paint::barycentric}},
            "One colour for each triangle, or its three barycentrics as red, green and blue");
    }
};

/// The direction that a triangle faces, length 1; up for a triangle without area.
inline vec3 flat_normal(const Mesh& mesh, const Triangle& triangle) {
    const auto [a, b, c] = triangle.vertices;
    const dvec3 origin = mesh.positions[a.position];  // double: a product of floats may overflow
    const dvec3 ab = dvec3(mesh.positions[b.position]) - origin;
    const dvec3 ac = dvec3(mesh.positions[c.position]) - origin;
    return vec3(normalize_or(glm::cross(ab, ac), dvec3(0, 1, 0)));
}

/// The material's diffuse colour under a warm directional light from the upper left and a cool
/// ambient light from above.
///
/// @param normal  World space, length 1.
/// @return        Linear colour.
inline vec3 flat_color(vec3 normal, const Material& material) {
    constexpr vec3 up(0, 1, 0), sunlight(1.05f, 0.97f, 0.86f), skylight(0.17f, 0.22f, 0.30f);
    const vec3 toward_sun = normalize_or(vec3(-0.75f, 0.85f, 0.3f), up);
    const float sun = std::max(glm::dot(normal, toward_sun), 0.0f);
    const float sky = 0.5f + 0.5f * normal.y;
    const vec3 color = material.diffuse * (sun * sunlight + sky * skylight);
    trace("normal of the face", normal);
    trace("flat colour", color);
    return color;
}

/// The flat colour of a triangle in the world, by the direction that it faces.
inline vec3 flat_color(const Mesh& mesh, const Triangle& triangle, const Material& material) {
    return flat_color(flat_normal(mesh, triangle), material);
}

}  // namespace rasterbook
