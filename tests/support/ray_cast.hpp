// SPDX-License-Identifier: MIT
/// @file
/// Which triangles stand in a ray's way, exactly but for roundings of double: the reference for
/// shadows. Shares nothing with the lessons but the mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "common/math/types.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook::test {

using RayTriangle = std::array<dvec3, 3>;

struct Ray {
    dvec3 origin, direction;  ///< Of any length; distances are in it.
    double from = 0, to = std::numeric_limits<double>::infinity();
};

/// How far along the ray it meets a triangle, front or back; its border counts.
///
/// @see Moeller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997
inline std::optional<double> distance_to(const Ray& ray, const RayTriangle& triangle) {
    const dvec3 u = triangle[1] - triangle[0], v = triangle[2] - triangle[0];
    const dvec3 p = glm::cross(ray.direction, v);
    const double volume = glm::dot(u, p);
    if (volume == 0) return {};
    const dvec3 s = ray.origin - triangle[0], q = glm::cross(s, u);
    const double b = glm::dot(s, p) / volume, c = glm::dot(ray.direction, q) / volume;
    constexpr double border = 1e-12;  // so that a ray does not slip through between two triangles
    if (!(b >= -border && c >= -border && b + c <= 1 + border)) return {};
    const double distance = glm::dot(v, q) / volume;
    if (!(distance >= ray.from && distance <= ray.to)) return {};
    return distance;
}

/// Triangles in a hierarchy of boxes: a ray looks only into the boxes that it meets.
class RayCaster {
  public:
    explicit RayCaster(std::vector<RayTriangle> triangles) : triangles_(std::move(triangles)) {
        if (!triangles_.empty()) add_node(0, triangles_.size());
    }

    /// Of all triangles for which casts(material) is true.
    template <typename Casts>
    static RayCaster of(std::span<const Mesh> meshes, Casts&& casts) {
        std::vector<RayTriangle> triangles;
        for (const Mesh& mesh : meshes)
            for (const Triangle& triangle : mesh.triangles)
                if (casts(triangle.material))
                    triangles.push_back({dvec3(mesh.positions[triangle.vertices[0].position]),
                                         dvec3(mesh.positions[triangle.vertices[1].position]),
                                         dvec3(mesh.positions[triangle.vertices[2].position])});
        return RayCaster(std::move(triangles));
    }

    /// How far it is to the first triangle.
    std::optional<double> nearest(Ray ray) const {
        std::optional<double> found;
        std::array<std::size_t, 64> stack;
        std::size_t count = 0;
        if (!nodes_.empty()) stack[count++] = 0;
        while (count > 0) {
            const std::size_t index = stack[--count];
            const Node& node = nodes_[index];
            if (!meets(ray, node)) continue;
            if (node.right != 0) {
                stack[count++] = node.right, stack[count++] = index + 1;
                continue;
            }
            for (std::size_t i = node.begin; i < node.end; ++i)
                if (const auto distance = distance_to(ray, triangles_[i]))
                    found = distance, ray.to = *distance;
        }
        return found;
    }

    std::span<const RayTriangle> triangles() const { return triangles_; }

  private:
    struct Node {
        dvec3 low, high;
        std::size_t begin, end;  ///< Triangles.
        std::size_t right;       ///< Node; the left one is the next. 0 for a leaf.
    };

    std::size_t add_node(std::size_t begin, std::size_t end) {
        const std::size_t index = nodes_.size();
        nodes_.push_back({dvec3(INFINITY), dvec3(-INFINITY), begin, end, 0});
        dvec3 low(INFINITY), high(-INFINITY);
        for (std::size_t i = begin; i < end; ++i)
            for (const dvec3 vertex : triangles_[i])
                low = glm::min(low, vertex), high = glm::max(high, vertex);
        const dvec3 size = high - low;
        // Rounding must not put a triangle's hit outside of its box.
        const dvec3 margin(1e-9 * (size.x + size.y + size.z) + 1e-300);
        nodes_[index].low = low - margin, nodes_[index].high = high + margin;
        constexpr std::size_t leaf = 4;
        if (end - begin <= leaf) return index;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::size_t middle = begin + (end - begin) / 2;
        const auto at = [&](std::size_t i) {
            return triangles_.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(at(begin), at(middle), at(end),
                         [&](const RayTriangle& a, const RayTriangle& b) {
                             return (a[0] + a[1] + a[2])[axis] < (b[0] + b[1] + b[2])[axis];
                         });
        add_node(begin, middle);
        nodes_[index].right = add_node(middle, end);
        return index;
    }

    static bool meets(const Ray& ray, const Node& node) {
        double from = ray.from, to = ray.to;
        for (int axis = 0; axis < 3; ++axis) {
            const double origin = ray.origin[axis], way = ray.direction[axis];
            if (way == 0) {
                if (origin < node.low[axis] || origin > node.high[axis]) return false;
                continue;
            }
            const double a = (node.low[axis] - origin) / way, b = (node.high[axis] - origin) / way;
            from = std::max(from, std::min(a, b)), to = std::min(to, std::max(a, b));
        }
        return from <= to;
    }

    std::vector<RayTriangle> triangles_;
    std::vector<Node> nodes_;
};

}  // namespace rasterbook::test
