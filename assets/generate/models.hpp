// SPDX-License-Identifier: MIT
/// @file
/// Crate, floor, and the scenes that the lessons render.
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <string>
#include <utility>
#include <vector>

#include "assets/generate/model.hpp"

namespace rasterbook::assets {

/// The flat quad from `corner` along `right` and `up`, once the texture across.
inline Polygon quad(dvec3 corner, dvec3 right, dvec3 up) {
    const dvec3 normal = glm::normalize(glm::cross(right, up));
    return {{corner, {0, 0}, normal},
            {corner + right, {1, 0}, normal},
            {corner + right + up, {1, 1}, normal},
            {corner + up, {0, 1}, normal}};
}

/// A cube that stands on y = 0 around the y axis. On its sides the texture is upright; its top is
/// seen from the front, its bottom from the front after a fall backwards.
inline Part crate(const std::string& material) {
    const double side = 2.4, h = side / 2;
    const dvec3 x(side, 0, 0), y(0, side, 0), z(0, 0, side);
    return {"crate",
            material,
            {quad({-h, 0, h}, x, y), quad({h, 0, h}, -z, y), quad({h, 0, -h}, -x, y),
             quad({-h, 0, -h}, z, y), quad({-h, side, h}, x, -z), quad({-h, 0, -h}, x, z)}};
}

/// A square of quads on y = 0 around the origin; u along +x, v along -z.
///
/// @param side          Of the whole floor.
/// @param texture_size  Of one repeat of the texture.
inline Part floor(const std::string& material, double side, double texture_size) {
    const int quads = 8;
    Part part{"floor", material, {}};
    const auto vertex = [&](int column, int row) {
        const dvec2 across(side * (column - quads / 2) / quads, side * (row - quads / 2) / quads);
        return Vertex{{across.x, 0, -across.y}, across / texture_size, {0, 1, 0}};
    };
    for (int row = 0; row < quads; ++row)
        for (int column = 0; column < quads; ++column)
            part.faces.push_back({vertex(column, row), vertex(column + 1, row),
                                  vertex(column + 1, row + 1), vertex(column, row + 1)});
    return part;
}

/// Every second face of a floor, as on a chessboard, in another material of the same group.
inline std::vector<Part> chessboard(Part part, const std::string& other_material) {
    Part other{part.group, other_material, {}}, rest{part.group, part.material, {}};
    const auto quads = static_cast<std::size_t>(std::lround(std::sqrt(part.faces.size())));
    for (std::size_t i = 0; i < part.faces.size(); ++i)
        ((i / quads + i % quads) % 2 == 0 ? rest : other).faces.push_back(part.faces[i]);
    return {rest, other};
}

/// One triangle that faces the fixed view of the first lessons.
inline Part triangle(const std::string& material) {
    const dvec3 right(0.866, 0, 0.5), up(0.211, 0.906, -0.366);
    const dvec3 normal = glm::normalize(glm::cross(right, up));
    return {"triangle",
            material,
            {{{-right - 0.7 * up, {0, 0}, normal},
              {right - 0.7 * up, {1, 0}, normal},
              {up, {0.5, 1}, normal}}}};
}

/// The part turned about the y axis from x towards -z, then moved.
inline Part placed(Part part, double cosine, double sine, dvec3 offset) {
    const auto turned = [&](dvec3 v) {
        return dvec3(cosine * v.x + sine * v.z, v.y, cosine * v.z - sine * v.x);
    };
    for (Polygon& polygon : part.faces)
        for (Vertex& vertex : polygon) {
            vertex.position = turned(vertex.position) + offset;
            vertex.normal = turned(vertex.normal);
        }
    return part;
}

/// Teapot in front, crate behind its handle, floor below: one group each.
///
/// @param coat  The material of the whole pot (gilt edges too); empty: as it is.
inline std::vector<Part> scene(std::vector<Part> teapot, const std::string& coat,
                               const std::string& crate_material,
                               const std::string& floor_material) {
    std::vector<Part> parts;
    for (Part& part : teapot) {
        part.group = "teapot";
        if (!coat.empty() && part.material != "tea") part.material = coat;
        parts.push_back(std::move(part));
    }
    parts.push_back(placed(crate(crate_material), 0.8, 0.6, {-3.7, 0, -2.6}));
    for (Part& part : chessboard(floor(floor_material, 12, 3), "dark_" + floor_material))
        parts.push_back(std::move(part));
    return parts;
}

}  // namespace rasterbook::assets
