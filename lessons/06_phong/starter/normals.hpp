// SPDX-License-Identifier: MIT
/// @file
/// Normals for models that come without. Introduced in lesson 06;
/// derivation: docs/derivations/06_phong.md.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <tuple>
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
    std::uint32_t group;  ///< Its smoothing group.
};

/// The smoothing group of a mesh's triangle.
inline std::uint32_t smoothing_group(const Mesh& mesh, std::size_t triangle) {
    return mesh.smoothing_groups.empty() ? smooth_by_angle : mesh.smoothing_groups[triangle];
}

/// Where a position's faces are looked up: those of all meshes that share it.
inline std::uint32_t shared_position(const Mesh& mesh, std::uint32_t position) {
    return mesh.shared_positions.empty() ? position : mesh.shared_positions[position];
}

/// The normal of a triangle's vertex, before it is scaled, from the faces around it (Eq. 6.9).
class SmoothNormals {
  public:
    explicit SmoothNormals(const Mesh& mesh) : SmoothNormals(std::span(&mesh, 1)) {}

    /// @param meshes  A single one, or those that share positions.
    explicit SmoothNormals(std::span<const Mesh> meshes) {
        std::size_t positions = 0;
        for (const Mesh& mesh : meshes)
            for (std::uint32_t i = 0; i < mesh.positions.size(); ++i)
                positions = std::max(positions, std::size_t{shared_position(mesh, i)} + 1);
        begin_.assign(positions + 1, 0);
        for (const Mesh& mesh : meshes)
            for (const Triangle& triangle : mesh.triangles)
                for (const Vertex& vertex : triangle.vertices)
                    ++begin_[shared_position(mesh, vertex.position) + 1];
        for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
        around_.resize(begin_.back());
        end_ = begin_;
        for (const Mesh& mesh : meshes)
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t) add(mesh, t);
        for (std::size_t i = 0; i < positions; ++i) {
            const std::span faces = std::span(around_).subspan(begin_[i], end_[i] - begin_[i]);
            if (!std::ranges::is_sorted(faces, {}, &FaceAround::group)) {
                std::multimap<std::uint32_t, FaceAround> by_group;  // keeps a group's order
                for (const FaceAround& face : faces) by_group.emplace(face.group, face);
                for (std::size_t f = 0; const auto& [group, face] : by_group) faces[f++] = face;
            }
            if (faces.size() > crowd_) end_[i] = begin_[i] + merge(faces);
        }
    }

    /// The sum of the normals of the faces around a position, each times its angle there.
    ///
    /// @param position        Index into the mesh's positions, or shared_position(). One that the
    ///                        file has twice is two positions, whose faces do not meet.
    /// @param normal_of_face  Of the face whose vertex it is; what lies beyond a sharp edge, as
    ///                        seen from this face, does not count.
    /// @param group           Of that face: others do not count. Where the file gives one, it has
    ///                        no sharp edges.
    vec3 at(std::uint32_t position, vec3 normal_of_face,
            std::uint32_t group = smooth_by_angle) const {
        // TODO: Eq. 6.9, of faces_around(position, group); the sharp edges only count if the group
        // is smooth_by_angle.
        return normal_of_face;
    }

  private:
    /// Robust: each face around a position looks at all others there. Where more than this many
    /// meet, those whose normals lie in one cube of side 1/16 become one face with their mean.
    static constexpr std::size_t crowd_ = 1024;

    /// @return  How many faces are left, at the front.
    static std::size_t merge(std::span<FaceAround> faces) {
        std::map<std::tuple<std::uint32_t, float, float, float>, dvec3> sum_of_cube;
        for (const auto& [normal, angle_radians, group] : faces) {
            const vec3 corner = glm::floor(16.0f * normal);
            const auto sum =
                sum_of_cube.try_emplace({group, corner.x, corner.y, corner.z}, dvec3(0));
            sum.first->second += double{angle_radians} * dvec3(normal);
        }
        std::size_t left = 0;
        for (const auto& [cube, sum] : sum_of_cube)
            faces[left++] = {vec3(normalize_or(sum, dvec3(0, 1, 0))),
                             static_cast<float>(glm::length(sum)), std::get<0>(cube)};
        return left;
    }

    void add(const Mesh& mesh, std::size_t t) {
        const Triangle& triangle = mesh.triangles[t];
        for (std::size_t i = 0; i < 3; ++i)
            around_[end_[shared_position(mesh, triangle.vertices[i].position)]++] = {
                face_normal(mesh, triangle), vertex_angle_radians(mesh, triangle, i),
                smoothing_group(mesh, t)};
    }

    std::span<const FaceAround> faces_around(std::uint32_t position, std::uint32_t group) const {
        const std::span all =
            std::span(around_).subspan(begin_[position], end_[position] - begin_[position]);
        const auto same = std::ranges::equal_range(all, group, {}, &FaceAround::group);
        return {same.begin(), same.end()};
    }

    std::vector<std::size_t> begin_, end_;  ///< Of each position's faces in around_, by groups.
    std::vector<FaceAround> around_;
};

/// Gives each vertex a normal of length 1: the one of the file, or else the one that the faces
/// around it have; that of its face where the file says that it is flat. Where a normal is zero or
/// not finite, it is that of the face.
///
/// A triangle of no area faces up: without normals of the file, its vertices get the mean of what
/// faces nearly up around them, or up.
///
/// @param smooth  Of all faces; not used where no vertex lacks a normal.
/// @see Thuermer and Wuethrich, "Computing vertex normals from polygonal facets", 1998
inline void complete_normals(Mesh& mesh, const std::optional<SmoothNormals>& smooth) {
    std::vector<vec3> normals;  // one for each vertex of each triangle
    normals.reserve(3 * mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const vec3 of_face = face_normal(mesh, mesh.triangles[t]);
        [[maybe_unused]] const std::uint32_t group = smoothing_group(mesh, t);
        for (Vertex& vertex : mesh.triangles[t].vertices) {
            // TODO: the file's normal, mesh.normals[vertex.normal], if the vertex has one; else, if
            // `group` is not no_smoothing, what `smooth` has for its shared_position().
            const vec3 normal = of_face;
            vertex.normal = static_cast<std::uint32_t>(normals.size());
            normals.push_back(normalize_or(normal, of_face));
        }
    }
    mesh.normals = std::move(normals);
    mesh.smoothing_groups = mesh.shared_positions = {};  // needed no more
}

/// Completes the normals of a single mesh, or of all that share positions.
inline void complete_normals(std::span<Mesh> meshes) {
    std::optional<SmoothNormals> smooth;
    for (const Mesh& mesh : meshes)
        for (const Triangle& triangle : mesh.triangles)
            for (const Vertex& vertex : triangle.vertices)
                if (vertex.normal == no_index && !smooth) smooth.emplace(meshes);
    for (Mesh& mesh : meshes) complete_normals(mesh, smooth);
}
inline void complete_normals(Mesh& mesh) { complete_normals(std::span(&mesh, 1)); }

/// Gives normals to all meshes of a scene that have none.
inline void complete_normals(Scene& scene) {
    const bool share = !scene.meshes.empty() && !scene.meshes[0].shared_positions.empty();
    if (share) return complete_normals(std::span(scene.meshes));
    for (Mesh& mesh : scene.meshes) complete_normals(mesh);
}

}  // namespace rasterbook
