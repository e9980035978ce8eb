// SPDX-License-Identifier: MIT
/// @file
/// The Utah teapot: from 32 Bezier patches to quads with uvs and normals.
#pragma once

#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "assets/generate/bezier.hpp"
#include "assets/generate/model.hpp"

namespace rasterbook::assets {

/// The length of one repeat of the texture on the body: four go around its radius of 2.
constexpr double pi = 3.14159265;

/// The patches of the data file, turned from z up to y up. The bottom stands on y = 0 already.
inline std::vector<Patch> read_patches(const nlohmann::json& data) {
    std::vector<Patch> patches;
    for (const auto& indices : data.at("patches")) {
        Patch patch;
        for (std::size_t i = 0; i < patch.size(); ++i) {
            const auto& point = data.at("control_points").at(indices.at(i).get<std::size_t>());
            const auto [x, y, z] = point.get<std::array<double, 3>>();
            patch[i] = {x, z, -y};
        }
        patches.push_back(patch);
    }
    return patches;
}

/// One row of patches around the pot, or around its handle or spout.
struct Band {
    std::size_t first_patch;
    int rows;  ///< Of quads.
    std::string material;
};

enum class VStartsAt { first_row, last_row };

/// Bands that meet along their rims, with one mapping of the texture.
struct Surface {
    std::string group;
    std::vector<Band> bands;
    int patches_around;
    int columns;            ///< Of quads, in one patch.
    int repeats;            ///< Of the texture around; whole, so that the seam does not show.
    double texture_side;    ///< The length that one repeat of the texture has along v.
    VStartsAt v_starts_at;  ///< The rim with v = 0.
    double v_sign;          ///< Of v away from there.
};

/// The whole teapot. The rows are chosen so that quads are about square on the large surfaces.
inline std::vector<Surface> teapot_surfaces() {
    using enum VStartsAt;
    return {
        {"body", {{0, 6, "gilt"}, {4, 8, "glaze"}, {8, 6, "glaze"}}, 4, 10, 4, pi, last_row, 1},
        {"body", {{28, 5, "glaze"}}, 4, 10, 4, pi, last_row, -1},
        {"lid", {{20, 8, "gilt"}}, 4, 10, 1, 2.0, last_row, 1},
        {"lid", {{24, 6, "glaze"}}, 4, 10, 3, 2.72, last_row, 1},
        {"handle", {{12, 10, "glaze"}, {14, 10, "glaze"}}, 2, 6, 1, 1.0, first_row, 1},
        {"spout", {{16, 10, "glaze"}, {18, 8, "gilt"}}, 2, 8, 1, 2.0, first_row, 1},
    };
}

/// A row of vertices around a surface.
struct Ring {
    std::size_t first_patch;
    Station row;
};

/// The rings from the first row of quads to the last, each rim between two bands once.
inline std::vector<Ring> rings_of(const Surface& surface) {
    std::vector<Ring> rings{{surface.bands[0].first_patch, {0, surface.bands[0].rows}}};
    for (const Band& band : surface.bands)
        for (int row = 1; row <= band.rows; ++row)
            rings.push_back({band.first_patch, {row, band.rows}});
    return rings;
}

inline std::pair<const Patch*, Station> patch_at(const std::vector<Patch>& patches,
                                                 const Surface& surface, const Ring& ring,
                                                 int column) {
    const int around = column % (surface.columns * surface.patches_around);
    const auto patch = ring.first_patch + std::size_t(around / surface.columns);
    return {&patches[patch], {around % surface.columns, surface.columns}};
}

/// The mean length of the surface between two rings.
inline double distance_between(const std::vector<Patch>& patches, const Surface& surface,
                               const Ring& from, const Ring& to) {
    const int columns = surface.columns * surface.patches_around;
    double sum = 0;
    for (int column = 0; column < columns; ++column) {
        const auto [patch_from, column_from] = patch_at(patches, surface, from, column);
        const auto [patch_to, column_to] = patch_at(patches, surface, to, column);
        sum += glm::length(point_on(*patch_to, to.row, column_to) -
                           point_on(*patch_from, from.row, column_from));
    }
    return sum / columns;
}

/// v of each ring, by length along the surface, so that texels are about square.
inline std::vector<double> v_of_rings(const std::vector<Patch>& patches, const Surface& surface,
                                      const std::vector<Ring>& rings) {
    std::vector<double> v{0.0};
    for (std::size_t i = 1; i < rings.size(); ++i)
        v.push_back(v.back() + distance_between(patches, surface, rings[i - 1], rings[i]) /
                                   surface.texture_side);
    const double start = surface.v_starts_at == VStartsAt::first_row ? 0.0 : v.back();
    for (double& value : v)
        value = surface.v_sign * (value > start ? value - start : start - value);
    return v;
}

/// The vertex at whole and half columns: a pole takes the u in the middle of its triangle.
inline Vertex vertex_at(const std::vector<Patch>& patches, const Surface& surface, const Ring& ring,
                        double v, int column, double u_offset = 0) {
    const auto [patch, station] = patch_at(patches, surface, ring, column);
    const double turns = (column + u_offset) / (surface.columns * surface.patches_around);
    // Where the rows run downwards the columns run to the left: both turn around.
    const bool upside_down = surface.v_starts_at == VStartsAt::last_row && surface.v_sign > 0;
    const double u = surface.repeats * (upside_down ? 1 - turns : turns);
    return {point_on(*patch, ring.row, station), {u, v}, normal_on(*patch, ring.row, station)};
}

/// The quads between two rings; triangles where the upper ring is a single point.
inline std::vector<Polygon> quads_between(const std::vector<Patch>& patches, const Surface& surface,
                                          const Ring& upper, const Ring& lower, dvec2 v) {
    std::vector<Polygon> quads;
    for (int column = 0; column < surface.columns * surface.patches_around; ++column) {
        Polygon quad{vertex_at(patches, surface, upper, v[0], column),
                     vertex_at(patches, surface, upper, v[0], column + 1),
                     vertex_at(patches, surface, lower, v[1], column + 1),
                     vertex_at(patches, surface, lower, v[1], column)};
        if (glm::distance(quad[0].position, quad[1].position) < 1e-9) {
            quad[0] = vertex_at(patches, surface, upper, v[0], column, 0.5);
            quad.erase(quad.begin() + 1);
        }
        quads.push_back(std::move(quad));
    }
    return quads;
}

/// All quads of a surface, one part for each band.
inline std::vector<Part> parts_of(const std::vector<Patch>& patches, const Surface& surface) {
    const std::vector<Ring> rings = rings_of(surface);
    const std::vector<double> v = v_of_rings(patches, surface, rings);
    std::vector<Part> parts;
    std::size_t ring = 0;
    for (const Band& band : surface.bands) {
        Part part{surface.group, band.material, {}};
        for (int row = 0; row < band.rows; ++row, ++ring)
            for (Polygon& quad : quads_between(patches, surface, rings[ring], rings[ring + 1],
                                               {v[ring], v[ring + 1]}))
                part.faces.push_back(std::move(quad));
        parts.push_back(std::move(part));
    }
    return parts;
}

/// The corners of one level ring, with the texture laid on from above.
inline std::vector<Vertex> level_ring(const std::vector<Patch>& patches, const Surface& surface,
                                      const Ring& ring) {
    std::vector<Vertex> corners;
    for (int column = 0; column <= surface.columns * surface.patches_around; ++column) {
        const dvec3 p = vertex_at(patches, surface, ring, 0, column).position;
        corners.push_back({p, dvec2(p.x, -p.z) / pi, {0, 1, 0}});
    }
    return corners;
}

/// Not in the original: a ledge across the gap between rim and lid, without which one looks into
/// the pot and, since the insides of its walls are back faces, right through it.
inline Part ledge(const std::vector<Patch>& patches, const Surface& body, const Surface& lid) {
    const auto outer = level_ring(patches, body, rings_of(body).front());
    const auto inner = level_ring(patches, lid, rings_of(lid).back());
    Part part{"ledge", "glaze", {}};
    for (std::size_t i = 0; i + 1 < outer.size(); ++i)
        part.faces.push_back({inner[i], inner[i + 1], outer[i + 1], outer[i]});
    return part;
}

/// Not in the original either: tea up to the mouth of the spout, in strips across it.
inline Part tea(const std::vector<Patch>& patches, const Surface& spout) {
    const auto mouth = level_ring(patches, spout, rings_of(spout).back());
    Part part{"tea", "tea", {}};
    const std::size_t last = mouth.size() - 1;  // the same point as 0
    for (std::size_t i = 0; i < last / 2; ++i) {
        Polygon strip{mouth[i], mouth[i + 1]};
        if (i + 1 < last / 2) strip.push_back(mouth[last - i - 1]);
        if (i > 0) strip.push_back(mouth[last - i]);
        part.faces.push_back(std::move(strip));
    }
    return part;
}

/// The faces of the teapot: spout towards +x, handle towards -x.
inline std::vector<Part> teapot_parts(const std::vector<Patch>& patches) {
    const std::vector<Surface> surfaces = teapot_surfaces();
    std::vector<Part> parts;
    for (const Surface& surface : surfaces)
        for (Part& part : parts_of(patches, surface)) parts.push_back(std::move(part));
    parts.push_back(ledge(patches, surfaces[0], surfaces[3]));
    parts.push_back(tea(patches, surfaces[5]));
    return parts;
}

}  // namespace rasterbook::assets
