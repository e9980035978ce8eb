// SPDX-License-Identifier: MIT
/// @file
/// Lesson 08's tangent basis on a hill, for the figure tangent_basis.js. What is shown is in the
/// figure's own units: x right, y down, the hill's foot a square of side 2 before it is turned.
#include <array>
#include <cmath>
#include <vector>

#include "04_mvp/transform.hpp"
#include "05_textures/interpolation.hpp"
#include "06_phong/normals.hpp"
#include "08_normal_maps/normal_map.hpp"
#include "08_normal_maps/tangent_frame.hpp"
#include "08_normal_maps/vertex_tangents.hpp"

namespace rasterbook {
namespace {

constexpr int cells = 14;  // of the mesh, along a side
constexpr int lines = 6;   // of the texture, for each 1 of u or v

vec3 position(vec2 p) { return {p.x, 0.42f * std::exp(-2.2f * glm::dot(p, p)), -p.y}; }

vec2 shown(vec3 world) {
    const vec4 view = rotation_x(0.72f) * rotation_y(-0.5f) * vec4(world, 1);
    return {view.x, -view.y};
}

Mesh mesh;
std::vector<vec2> uvs;  ///< Of the mesh's positions.

std::array<vec2, 3> uvs_of_triangle(const Triangle& triangle) {
    return {uvs[triangle.vertices[0].position], uvs[triangle.vertices[1].position],
            uvs[triangle.vertices[2].position]};
}

struct Line {
    vec2 from, to;
    float axis;  ///< 0: u is constant; 1: v is.
};
std::vector<Line> texture_lines;

/// Where u or v has a constant value on a triangle.
void add_lines(const Triangle& triangle, int axis) {
    const std::array<vec2, 3> uv = uvs_of_triangle(triangle);
    for (int k = -3 * lines; k <= 3 * lines; ++k) {
        const float value = (float(k) + 0.5f) / lines;
        std::vector<vec2> ends;
        for (std::size_t i = 0; i < 3; ++i) {
            const float a = uv[i][axis], b = uv[(i + 1) % 3][axis];
            if ((a < value) == (b < value)) continue;
            const vec3 p = mesh.positions[triangle.vertices[i].position];
            const vec3 q = mesh.positions[triangle.vertices[(i + 1) % 3].position];
            ends.push_back(shown(glm::mix(p, q, (value - a) / (b - a))));
        }
        if (ends.size() == 2) texture_lines.push_back({ends[0], ends[1], float(axis)});
    }
}

/// A point and the tips of vectors from it.
struct Shown {
    vec2 point;
    vec2 face_tangent, face_bitangent;  ///< Eq. 8.3, scaled to length 1.
    vec2 tangent, bitangent, normal;    ///< Eq. 8.5
    vec2 perturbed;                     ///< Eq. 8.7
    float face_angle;                   ///< Between the first two, degrees.
    float angle;                        ///< Between the tangent and the bitangent, degrees.
    float handedness;
};
Shown basis;

float degrees_between(vec3 a, vec3 b) {
    return glm::degrees(std::acos(glm::clamp(glm::dot(a, b), -1.0f, 1.0f)));
}

constexpr int disc_size = 64;
std::array<u8vec4, disc_size * disc_size> disc_pixels;

}  // namespace

/// Lays the texture onto the hill.
///
/// @param turn    Radians.
/// @param skew    How far u leans for each 1 of v.
/// @param mirror  -1 mirrors u; else 1.
extern "C" int lay_out(float turn, float skew, float mirror) {
    mesh = {};
    uvs.clear();
    for (int y = 0; y <= cells; ++y)
        for (int x = 0; x <= cells; ++x) {
            const vec2 p = 2.0f * vec2(x, y) / float(cells) - 1.0f;
            const vec2 turned = rotation_z(-turn) * vec4(p, 0, 1);
            mesh.positions.push_back(position(p));
            uvs.push_back({mirror * (turned.x + skew * turned.y), turned.y});
        }
    for (std::uint32_t y = 0; y < cells; ++y)
        for (std::uint32_t x = 0; x < cells; ++x) {
            const std::uint32_t a = y * (cells + 1) + x, c = a + cells + 2;
            mesh.triangles.push_back({{{{a}, {a + 1}, {c}}}, 0});
            mesh.triangles.push_back({{{{a}, {c}, {c - 1}}}, 0});
        }
    complete_normals(mesh);
    mesh.tangents = vertex_tangents(mesh, uvs_of_triangle);
    texture_lines.clear();
    for (const Triangle& triangle : mesh.triangles)
        for (const int axis : {0, 1}) add_lines(triangle, axis);
    return int(texture_lines.size());
}

extern "C" const Line* lines_shown() { return texture_lines.data(); }

/// The point of the hill's foot, from -1 to 1, whose point of the hill is shown nearest to (x, y).
extern "C" const vec2* nearest(float x, float y) {
    static vec2 best;
    float least = 1e30f;
    for (int i = -47; i <= 47; ++i)
        for (int j = -47; j <= 47; ++j) {
            const vec2 p = vec2(i, j) / 50.0f, away = shown(position(p)) - vec2(x, y);
            if (glm::dot(away, away) < least) least = glm::dot(away, away), best = p;
        }
    return &best;
}

/// The basis at a point of the hill.
///
/// @param x,y      Of the hill's foot, from -1 to 1.
/// @param map_x,map_y  Of the normal in the map; z makes its length 1.
/// @param length   Of the vectors shown.
extern "C" const Shown* basis_at(float x, float y, float map_x, float map_y, float length) {
    const vec2 in_cells = (vec2(x, y) + 1.0f) * (0.5f * cells);
    const ivec2 cell = glm::min(ivec2(in_cells), cells - 1);
    const vec2 in_cell = in_cells - vec2(cell);
    const bool upper = in_cell.y > in_cell.x;
    const Triangle& triangle = mesh.triangles[2 * (cell.y * cells + cell.x) + upper];
    const vec3 at = upper ? vec3(1 - in_cell.y, in_cell.x, in_cell.y - in_cell.x)
                          : vec3(1 - in_cell.x, in_cell.x - in_cell.y, in_cell.y);

    std::array<vec3, 3> positions, normals, tangents;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vertex& vertex = triangle.vertices[i];
        positions[i] = mesh.positions[vertex.position];
        normals[i] = mesh.normals[vertex.normal];
        tangents[i] = vec3(mesh.tangents[vertex.normal]);
    }
    const UvDirections face = uv_directions(positions, uvs_of_triangle(triangle));
    const vec3 normal = interpolate(normals, at);
    const TangentFrame frame =
        tangent_frame(interpolate(tangents, at), normal, float(face.handedness));
    const vec3 bent = glm::normalize(perturbed(frame, with_z(vec2(map_x, map_y)), normal));

    const vec3 p = interpolate(positions, at);
    const auto tip = [&](vec3 vector) { return shown(p + length * vector); };
    basis = {shown(p),
             tip(face.tangent),
             tip(face.bitangent),
             tip(frame.tangent),
             tip(frame.bitangent),
             tip(frame.normal),
             tip(bent),
             degrees_between(face.tangent, face.bitangent),
             degrees_between(frame.tangent, frame.bitangent),
             float(face.handedness)};
    return &basis;
}

/// 64 x 64 texels of a normal map that hold all directions out of the surface; the others are
/// transparent.
extern "C" const u8vec4* disc() {
    for (int row = 0; row < disc_size; ++row)
        for (int column = 0; column < disc_size; ++column) {
            const vec2 p = (vec2(column, disc_size - 1 - row) + 0.5f) * (2.0f / disc_size) - 1.0f;
            const vec3 stored = glm::round(127.5f * (with_z(p) + 1.0f));  // the inverse of Eq. 8.1
            disc_pixels[row * disc_size + column] =
                glm::dot(p, p) < 1 ? u8vec4(stored, 255) : u8vec4(0);
        }
    return disc_pixels.data();
}

/// The shown corners of the hill's foot, and its outline: 4 * 14 points.
extern "C" const vec2* outline() {
    static std::array<vec2, 4 * cells> points;
    for (int i = 0; i < cells; ++i) {
        const float s = 2.0f * float(i) / cells - 1;
        points[i] = shown(position({s, -1}));
        points[cells + i] = shown(position({1, s}));
        points[2 * cells + i] = shown(position({-s, 1}));
        points[3 * cells + i] = shown(position({-1, -s}));
    }
    return points.data();
}

}  // namespace rasterbook
