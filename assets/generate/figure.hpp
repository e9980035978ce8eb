// SPDX-License-Identifier: MIT
/// @file
/// A little robot of rounded shapes, that stands on a round platform and leans on a crate.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <string>
#include <utility>
#include <vector>

#include "assets/generate/model.hpp"
#include "assets/generate/models.hpp"

namespace rasterbook::assets {

/// The corners of a regular polygon on the unit circle: cosine and sine of n equal steps.
///
/// @param n  4 or 6 times a power of two: halving 90 or 60 degrees takes square roots alone.
inline std::vector<dvec2> circle(int n) {
    double cosine = n % 3 == 0 ? 0.5 : 0;
    for (int corners = n % 3 == 0 ? 6 : 4; corners < n; corners *= 2)
        cosine = std::sqrt((1 + cosine) / 2);
    const dvec2 step(cosine, std::sqrt((1 - cosine) * (1 + cosine)));
    std::vector<dvec2> corners{{1, 0}};
    while (std::ssize(corners) < n) {
        const dvec2 last = corners.back();
        corners.emplace_back(step.x * last.x - step.y * last.y, step.x * last.y + step.y * last.x);
    }
    return corners;
}

/// A point of a curve that turns about the y axis: x is its distance from the axis.
struct ProfilePoint {
    dvec2 place, normal;
};

using Profile = std::vector<ProfilePoint>;  ///< From below to above, outside on its right.

/// Where a shape is put: its axes with their lengths, and its origin.
struct Placement {
    dmat3 axes{1};
    dvec3 origin{0};
};

/// Adds an arc around a centre, from one direction to another less than half a turn away.
inline void add_arc(Profile& profile, dvec2 center, double radius, dvec2 from, dvec2 to,
                    int steps) {
    for (int i = 0; i <= steps; ++i) {
        const double t = double(i) / steps;
        const dvec2 normal = glm::normalize((1 - t) * from + t * to);
        profile.push_back({center + radius * normal, normal});
    }
}

/// Two spheres, one above the other, and the cone that touches both.
inline Profile capsule_profile(double lower_radius, double upper_radius, double distance,
                               int steps) {
    const double sine = (lower_radius - upper_radius) / distance;
    const dvec2 tangent(std::sqrt(1 - sine * sine), sine);
    Profile profile;
    add_arc(profile, {0, 0}, lower_radius, {0, -1}, tangent, steps);
    add_arc(profile, {0, distance}, upper_radius, tangent, {0, 1}, steps);
    return profile;
}

inline Profile sphere_profile(int rows) {
    Profile profile;
    const std::vector<dvec2> corners = circle(2 * rows);
    for (int i = 0; i <= rows; ++i) {  // from below: a quarter of a turn back
        const dvec2 on = corners[std::size_t((i + 2 * rows - rows / 2) % (2 * rows))];
        const dvec2 normal = i == 0 ? dvec2(0, -1) : i == rows ? dvec2(0, 1) : on;
        profile.push_back({normal, normal});
    }
    return profile;
}

inline Profile ring_profile(double radius, double thickness, int steps) {
    const std::vector<dvec2> corners = circle(steps);
    Profile profile;
    for (int i = 0; i <= steps; ++i) {
        const dvec2 normal = corners[std::size_t(i % steps)];
        profile.push_back({dvec2(radius, 0) + thickness * normal, normal});
    }
    return profile;
}

/// A disc of which the rim is round.
inline Profile disc_profile(double radius, double height, double rounding, int steps) {
    Profile profile{{{0, 0}, {0, -1}}};
    const double inner = radius - rounding;
    add_arc(profile, {inner, rounding}, rounding, {0, -1}, {1, 0}, steps);
    add_arc(profile, {inner, height - rounding}, rounding, {1, 0}, {0, 1}, steps);
    profile.push_back({{0, height}, {0, 1}});
    return profile;
}

/// The surface that a profile sweeps when it turns about the y axis.
inline Part revolved(const std::string& material, const Profile& profile, int columns,
                     const Placement& placement) {
    const std::vector<dvec2> around = circle(columns);
    const dmat3& axes = placement.axes;
    const dmat3 normal_axes(glm::cross(axes[1], axes[2]), glm::cross(axes[2], axes[0]),
                            glm::cross(axes[0], axes[1]));
    const auto vertex = [&](std::size_t row, int column, double u) {
        const dvec2 turn = around[std::size_t(column % columns)];
        const auto turned = [&](dvec2 p) { return dvec3(p.x * turn.y, p.y, p.x * turn.x); };
        return Vertex{placement.origin + axes * turned(profile[row].place),
                      {u / columns, double(row) / double(profile.size() - 1)},
                      glm::normalize(normal_axes * turned(profile[row].normal))};
    };
    const auto is_pole = [&](std::size_t row) { return profile[row].place.x < 1e-9; };
    Part part{"figure", material, {}};
    for (std::size_t row = 0; row + 1 < profile.size(); ++row) {
        if (glm::distance(profile[row].place, profile[row + 1].place) < 1e-9) continue;
        for (int i = 0; i < columns; ++i) {
            Polygon face;
            if (is_pole(row))
                face.push_back(vertex(row, i, i + 0.5));
            else
                face = {vertex(row, i, i), vertex(row, i + 1, i + 1)};
            if (is_pole(row + 1)) {
                face.push_back(vertex(row + 1, i, i + 0.5));
            } else {
                face.push_back(vertex(row + 1, i + 1, i + 1));
                face.push_back(vertex(row + 1, i, i));
            }
            part.faces.push_back(std::move(face));
        }
    }
    return part;
}

inline Part ellipsoid(const std::string& material, dvec3 center, dvec3 radii, int columns) {
    const dmat3 axes(dvec3(radii.x, 0, 0), dvec3(0, radii.y, 0), dvec3(0, 0, radii.z));
    return revolved(material, sphere_profile(columns / 2), columns, {axes, center});
}

/// A capsule between two points.
inline Part limb(const std::string& material, dvec3 from, dvec3 to, double from_radius,
                 double to_radius, int columns) {
    const dvec3 along = glm::normalize(to - from);
    const dvec3 across = glm::normalize(glm::cross(along, dvec3(0.36, 0.48, 0.8)));
    return revolved(material,
                    capsule_profile(from_radius, to_radius, glm::distance(from, to), columns / 4),
                    columns, {dmat3(across, along, glm::cross(across, along)), from});
}

/// The robot, the crate, and the platform on y = 0 on which they stand.
///
/// @param least_columns  Around each rounded shape, as circle() takes it; many have more.
inline std::vector<Part> figure(int least_columns = 8) {
    const auto ellipsoid = [=](const char* material, dvec3 center, dvec3 radii, int columns) {
        return assets::ellipsoid(material, center, radii, std::max(columns, least_columns));
    };
    const auto limb = [=](const char* material, dvec3 from, dvec3 to, double from_radius,
                          double to_radius, int columns) {
        return assets::limb(material, from, to, from_radius, to_radius,
                            std::max(columns, least_columns));
    };
    const auto ring = [](const char* material, dvec3 center, double radius, double thickness) {
        return revolved(material, ring_profile(radius, thickness, 8), 32, {dmat3(1), center});
    };
    std::vector<Part> parts = {
        limb("coat", {0, 1.2, 0}, {0, 1.72, 0}, 0.74, 0.54, 32),
        ellipsoid("panel", {0, 1.24, 0.56}, {0.48, 0.52, 0.28}, 24),
        ellipsoid("lamp", {0, 1.3, 0.8}, {0.11, 0.11, 0.09}, 12),
        ring("trim", {0, 2.14, 0}, 0.4, 0.12),
        ellipsoid("cream", {0, 2.78, 0}, {0.92, 0.7, 0.78}, 32),
        ellipsoid("glass", {0, 2.76, 0.5}, {0.7, 0.41, 0.45}, 24),
        limb("steel", {0, 3.4, 0}, {0.06, 3.68, 0}, 0.1, 0.1, 8),
        ellipsoid("lamp", {0.08, 3.82, 0}, {0.17, 0.17, 0.17}, 16),
        limb("coat", {-0.6, 1.8, 0}, {-1.08, 1.47, 0.2}, 0.19, 0.16, 16),
        ellipsoid("trim", {-1.2, 1.37, 0.25}, {0.24, 0.24, 0.24}, 16),
        limb("coat", {0.6, 1.8, 0}, {1.3, 2.24, 0.2}, 0.19, 0.16, 16),
        ellipsoid("trim", {1.42, 2.36, 0.24}, {0.24, 0.24, 0.24}, 16),
    };
    for (const double side : {-1.0, 1.0}) {
        parts.push_back(ellipsoid("eyes", {0.23 * side, 2.79, 0.91}, {0.14, 0.19, 0.16}, 12));
        parts.push_back(ellipsoid("trim", {0.92 * side, 2.78, 0}, {0.16, 0.3, 0.3}, 16));
        parts.push_back(
            limb("steel", {0.34 * side, 0.3, 0}, {0.32 * side, 0.9, 0}, 0.17, 0.17, 12));
        parts.push_back(ellipsoid("trim", {0.38 * side, 0.42, 0.14}, {0.32, 0.22, 0.46}, 16));
    }
    for (Part& part : parts) part = placed(std::move(part), 12.0 / 13, -5.0 / 13, {0.42, 0, 0});
    Part box = placed(crate("box"), 0.8, 0.6, {-2.4, 0.25, -2.2});
    for (Polygon& face : box.faces)
        for (Vertex& vertex : face)
            vertex.position =
                dvec3(-0.88, 0.25, -0.28) + 0.38 * (vertex.position - dvec3(-2.4, 0.25, -2.2));
    parts.push_back(std::move(box));
    Part platform = revolved("platform", disc_profile(1.75, 0.25, 0.03, 2), 48, {});
    platform.group = "platform";
    parts.push_back(std::move(platform));
    return parts;
}

}  // namespace rasterbook::assets
