// SPDX-License-Identifier: MIT
/// @file
/// Bicubic Bezier patches: points and analytic normals.
#pragma once

#include <array>
#include <cstddef>
#include <glm/geometric.hpp>

#include "common/math/types.hpp"

namespace rasterbook::assets {

/// 4 x 4 control points, row after row.
using Patch = std::array<dvec3, 16>;

/// A place along one side of a patch: step of steps, both whole so that ends are met exactly.
struct Station {
    int step;
    int steps;
};

/// The cubic Bernstein polynomials.
inline std::array<double, 4> bernstein(Station at) {
    const double t = double(at.step) / at.steps;
    const double r = double(at.steps - at.step) / at.steps;
    return {r * r * r, 3 * r * r * t, 3 * r * t * t, t * t * t};
}

/// Their derivatives.
inline std::array<double, 4> bernstein_slope(Station at) {
    const double t = double(at.step) / at.steps;
    const double r = double(at.steps - at.step) / at.steps;
    return {-3 * r * r, 3 * r * (r - 2 * t), 3 * t * (2 * r - t), 3 * t * t};
}

inline dvec3 blend(const Patch& patch, const std::array<double, 4>& rows,
                   const std::array<double, 4>& columns) {
    dvec3 sum(0.0);
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) sum += patch[4 * i + j] * (rows[i] * columns[j]);
    return sum;
}

inline dvec3 point_on(const Patch& patch, Station row, Station column) {
    return blend(patch, bernstein(row), bernstein(column));
}

/// The unit normal: columns x rows points outwards in all of Newell's patches.
///
/// Where a row of control points is one point (the poles), the derivative along the row vanishes;
/// the mixed derivative is its direction in the limit.
inline dvec3 normal_on(const Patch& patch, Station row, Station column) {
    const dvec3 along_rows = blend(patch, bernstein_slope(row), bernstein(column));
    dvec3 along_columns = blend(patch, bernstein(row), bernstein_slope(column));
    if (glm::dot(along_columns, along_columns) < 1e-12)
        along_columns = blend(patch, bernstein_slope(row), bernstein_slope(column));
    return glm::normalize(glm::cross(along_columns, along_rows));
}

}  // namespace rasterbook::assets
