// SPDX-License-Identifier: MIT
/// @file
/// How much of a pixel a shape covers: the area itself, no samples.
#pragma once

#include <vector>

#include "common/math/types.hpp"

namespace rasterbook::test {

/// The part of a convex polygon where coordinate `axis` times `sign` is at least `limit`.
inline std::vector<dvec2> cut(const std::vector<dvec2>& polygon, int axis, double sign,
                              double limit) {
    std::vector<dvec2> rest;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const dvec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
        const double p_inside = sign * p[axis] - limit, q_inside = sign * q[axis] - limit;
        if (p_inside >= 0) rest.push_back(p);
        if ((p_inside > 0 && q_inside < 0) || (p_inside < 0 && q_inside > 0))
            rest.push_back(p + (q - p) * (p_inside / (p_inside - q_inside)));
    }
    return rest;
}

/// The area that a convex polygon covers of a pixel, 0 to 1, in double precision.
/// @see Sutherland and Hodgman, "Reentrant polygon clipping", 1974
inline double area_in_pixel(std::vector<dvec2> polygon, ivec2 pixel) {
    for (const int axis : {0, 1}) {
        polygon = cut(polygon, axis, 1, pixel[axis]);
        polygon = cut(polygon, axis, -1, -(pixel[axis] + 1.0));
    }
    double twice_area = 0;  // from the pixel's corner, so that nothing large cancels
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const dvec2 p = polygon[i] - dvec2(pixel);
        const dvec2 q = polygon[(i + 1) % polygon.size()] - dvec2(pixel);
        twice_area += p.x * q.y - p.y * q.x;
    }
    return 0.5 * (twice_area < 0 ? -twice_area : twice_area);
}

}  // namespace rasterbook::test
