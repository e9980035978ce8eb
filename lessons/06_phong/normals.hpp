// SPDX-License-Identifier: MIT
/// @file
/// Normals for models that come without. Introduced in lesson 06;
/// derivation: docs/derivations/06_phong.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "06_phong/face_normal.hpp"
#include "common/math/numerics.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// Cosine of 50 degrees: faces that meet at a greater angle meet in a sharp edge. Prisms of up to 7
/// sides keep their edges, those of 8 and more are round; no common solid sits at it.
constexpr float cos_sharp = 0.6427876f;

/// One of the faces that meet in a position.
struct FaceAround {
    vec3 normal;          ///< Length 1.
    float angle_radians;  ///< Between the face's sides there.
};

/// The normal of a triangle's vertex, before it is scaled, from the faces around it (Eq. 6.9).
class SmoothNormals {
  public:
    explicit SmoothNormals(const Mesh& mesh) : begin_(mesh.positions.size() + 1, 0) {
        for (const Triangle& triangle : mesh.triangles)
            for (const Vertex& vertex : triangle.vertices) ++begin_[vertex.position + 1];
        for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
        around_.resize(begin_.back());
        end_ = begin_;
        for (const Triangle& triangle : mesh.triangles)
            for (std::size_t i = 0; i < 3; ++i)
                around_[end_[triangle.vertices[i].position]++] = {
                    face_normal(mesh, triangle), vertex_angle_radians(mesh, triangle, i)};
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            if (end_[i] - begin_[i] > crowd_)
                end_[i] =
                    begin_[i] + merge(std::span(around_).subspan(begin_[i], end_[i] - begin_[i]));
    }

    /// The sum of the normals of the faces around a position, each times its angle there.
    ///
    /// @param position        Index into the mesh's positions. One that the file has twice is two
    ///                        positions, whose faces do not meet.
    /// @param normal_of_face  Of the face whose vertex it is; what lies beyond a sharp edge, as
    ///                        seen from this face, does not count.
    vec3 at(std::uint32_t position, vec3 normal_of_face) const {
        vec3 sum(0);
        for (std::size_t i = begin_[position]; i < end_[position]; ++i)
            if (glm::dot(around_[i].normal, normal_of_face) > cos_sharp)
                sum += around_[i].angle_radians * around_[i].normal;
        return sum;
    }

  private:
    /// Robust: each face around a position looks at all others there. Where more than this many
    /// meet, those whose normals lie in one cube of side 1/16 become one face with their mean.
    static constexpr std::size_t crowd_ = 1024;

    /// @return  How many faces are left, at the front.
    static std::size_t merge(std::span<FaceAround> faces) {
        std::map<std::array<float, 3>, dvec3> sum_of_cube;
        for (const auto& [normal, angle_radians] : faces) {
            const vec3 corner = glm::floor(16.0f * normal);
            const auto sum = sum_of_cube.try_emplace({corner.x, corner.y, corner.z}, dvec3(0));
            sum.first->second += double{angle_radians} * dvec3(normal);
        }
        std::size_t left = 0;
        for (const auto& [cube, sum] : sum_of_cube)
            faces[left++] = {vec3(normalize_or(sum, dvec3(0, 1, 0))),
                             static_cast<float>(glm::length(sum))};
        return left;
    }

    std::vector<std::size_t> begin_, end_;  ///< Of each position's faces in around_.
    std::vector<FaceAround> around_;
};

/// Gives each vertex a normal of length 1: the one of the file, or else the one that the faces
/// around it have. Where that is zero or not finite, it is that of the face.
///
/// A triangle of no area faces up: without normals of the file, its vertices get the mean of what
/// faces nearly up around them, or up.
///
/// @see Thuermer and Wuethrich, "Computing vertex normals from polygonal facets", 1998
inline void complete_normals(Mesh& mesh) {
    bool misses_one = false;
    for (const Triangle& triangle : mesh.triangles)
        for (const Vertex& vertex : triangle.vertices)
            misses_one = misses_one || vertex.normal == no_index;
    std::optional<SmoothNormals> smooth;
    if (misses_one) smooth.emplace(mesh);

    std::vector<vec3> normals;  // one for each vertex of each triangle
    normals.reserve(3 * mesh.triangles.size());
    for (Triangle& triangle : mesh.triangles) {
        const vec3 of_face = face_normal(mesh, triangle);
        for (Vertex& vertex : triangle.vertices) {
            const vec3 normal = vertex.normal != no_index ? mesh.normals[vertex.normal]
                                                          : smooth->at(vertex.position, of_face);
            vertex.normal = static_cast<std::uint32_t>(normals.size());
            normals.push_back(normalize_or(normal, of_face));
        }
    }
    mesh.normals = std::move(normals);
}

/// The same for all meshes of a scene.
inline void complete_normals(Scene& scene) {
    for (Mesh& mesh : scene.meshes) complete_normals(mesh);
}

}  // namespace rasterbook
