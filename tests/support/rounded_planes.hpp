// SPDX-License-Identifier: MIT
/// @file
/// Lesson 13's barycentric planes (Eq. 13.2) in rounded numbers, to be measured against whole ones.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "02_triangle_fill/triangle.hpp"
#include "10_threading/split.hpp"
#include "13_visibility_buffer/visibility_buffer.hpp"

namespace rasterbook::test {

/// From where a plane is evaluated.
enum class PlaneOrigin { picture, triangle };

/// What BarycentricPlanes gives, in numbers of type `F` alone: the planes are divided by the area
/// before any pixel is known, and each pixel takes two multiplications and two sums.
///
/// @tparam origin  The picture's upper left pixel, or that of the triangle's bounding box.
template <typename F, PlaneOrigin origin = PlaneOrigin::picture>
class RoundedPlanes {
  public:
    /// @param triangle  With an area.
    explicit RoundedPlanes(const ScreenTriangle& triangle)
        : first_(origin == PlaneOrigin::triangle ? box_around(triangle).first : ivec2(0)) {
        const int winding = triangle.twice_area > 0 ? 1 : -1;
        const F inv_area = 1 / std::abs(static_cast<F>(triangle.twice_area));
        for (std::size_t i = 0; i < 3; ++i) {
            const EdgeWalk edge(triangle.vertices[(i + 1) % 3], triangle.vertices[(i + 2) % 3],
                                winding, first_);
            at_first_[i] = static_cast<F>(edge.value) * inv_area;
            step_x_[i] = static_cast<F>(edge.step_x) * inv_area;
            step_y_[i] = static_cast<F>(edge.step_y) * inv_area;
        }
    }

    template <typename Take>
    void for_each_in(const PixelSpan& span, Take&& take) const {
        const ivec2 from_first = span.first - first_;
        std::array<F, 3> row;
        for (std::size_t i = 0; i < 3; ++i)
            row[i] = at_first_[i] + static_cast<F>(from_first.y) * step_y_[i];
        for (int x = 0; x < span.length; ++x) {
            const auto column = static_cast<F>(from_first.x + x);
            take(span.first + ivec2(x, 0),
                 Barycentrics(static_cast<float>(row[0] + column * step_x_[0]),
                              static_cast<float>(row[1] + column * step_x_[1]),
                              static_cast<float>(row[2] + column * step_x_[2])));
        }
    }

  private:
    ivec2 first_;
    std::array<F, 3> at_first_, step_x_, step_y_;
};

}  // namespace rasterbook::test
