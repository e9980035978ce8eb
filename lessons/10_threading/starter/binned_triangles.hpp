// SPDX-License-Identifier: MIT
/// @file
/// Triangles that are set up, and for each tile those that may reach into it: binning. Introduced
/// in lesson 10; derivation: docs/derivations/10_threading.md.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

#include "02_triangle_fill/triangle.hpp"
#include "04_mvp/projection.hpp"
#include "10_threading/split.hpp"
#include "common/app/counters.hpp"
#include "common/app/empty_picture.hpp"
#include "common/app/workers.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// A triangle that would be in more lists than this is in none: it is large, and all tiles look at
/// it.
constexpr std::size_t max_lists = 1024;

/// Triangles that follow each other in the scene, and for each tile those that may reach into it.
class TriangleBatch {
  public:
    std::vector<ProjectedTriangle> triangles;  ///< In the scene's order; each has an area.

    /// Lists the triangles by tiles.
    void bin(const Tiling& tiling) {
        begin_.assign(tiling.count() + 1, 0);
        large_.clear();
        [[maybe_unused]] const auto for_each_tile = [&](const ProjectedTriangle& ready,
                                                        auto&& take) {
            tiling.for_each_in(ready.on_screen, take);
        };
        // TODO: count the triangles of each list in begin_, add up, and fill indices_ from the last
        // triangle to the first; for_each_tile(triangle, take) calls take(tile). What would be in
        // more than max_lists lists goes into large_ instead.
    }

    /// Indices into `triangles` of those in a tile's list, ascending.
    std::span<const std::uint32_t> of(std::size_t tile) const {
        return {indices_.data() + begin_[tile], begin_[tile + 1] - begin_[tile]};
    }

    /// How many triangles may reach into a tile.
    std::size_t count_in(std::size_t tile) const { return of(tile).size() + large_.size(); }

    /// Calls take(projected) for each triangle that may reach into a tile, in the scene's order.
    template <typename Take>
    void for_each_in(std::size_t tile, Take&& take) const {
        auto next_large = large_.begin();
        for (const std::size_t i : of(tile)) {
            for (; next_large != large_.end() && *next_large < i; ++next_large)
                take(triangles[*next_large]);
            take(triangles[i]);
        }
        for (; next_large != large_.end(); ++next_large) take(triangles[*next_large]);
    }

  private:
    std::vector<std::size_t> begin_;  ///< Of each tile's list in indices_, and the last one's end.
    std::vector<std::uint32_t> indices_;
    std::vector<std::uint32_t> large_;  ///< Indices of the large triangles, ascending.
};

/// A batch has at most so many triangles or positions; beyond max_batches of these, batches grow. A
/// task for far fewer is not worth it.
constexpr std::size_t batch_size = 256;
/// More than this many batches would take memory for their lists, and hardly share out the work
/// better.
constexpr std::size_t max_batches = 64;

/// How many batches to make of so many things. It does not depend on the number of workers.
inline std::size_t batches_of(std::size_t things) {
    return std::min((things + batch_size - 1) / batch_size, max_batches);
}

/// The first thing of a batch; behind the last batch, the end of all.
inline std::size_t begin_of_batch(std::size_t batch, std::size_t things) {
    return batch * things / batches_of(things);
}

/// Clips, projects and culls triangles of a mesh, and leaves out what has no area.
///
/// @param positions_clip  The mesh's positions, in clip space.
/// @param size            Of the picture, in pixels.
/// @param projected       What is left is added to it, in the triangles' order.
/// @return                How many pieces were culled for the side that they show.
inline std::size_t project_triangles(const Mesh& mesh, std::span<const Triangle> triangles,
                                     const vec4* positions_clip, ivec2 size, Culling culling,
                                     std::vector<ProjectedTriangle>& projected) {
    std::size_t culled = 0;
    for (const Triangle& triangle : triangles) {
        const auto& [p, q, r] = triangle.vertices;
        for (const ClippedTriangle& clipped :
             clip_triangle({positions_clip[p.position], positions_clip[q.position],
                            positions_clip[r.position]})) {
            const ProjectedTriangle piece = project(mesh, triangle, clipped, size);
            if (piece.is_back_facing && culling == Culling::back_faces)
                ++culled;
            else if (piece.on_screen.twice_area != 0)
                projected.push_back(piece);
        }
    }
    return culled;
}
using ProjectTriangles = decltype(project_triangles);  ///< Such a function.

/// The meshes of a scene that may be in view; counts them all.
inline std::vector<const Mesh*> meshes_in_view(const Scene& scene, const mat4& clip_from_world) {
    std::vector<const Mesh*> meshes;
    for (const Mesh& mesh : scene.meshes) {
        count(Counter::meshes_in);
        count_undrawn_if_asked(mesh, clip_from_world);
        if (is_outside_frustum(mesh.bounds, clip_from_world)) {
            count(Counter::meshes_culled_by_frustum);
            continue;
        }
        if (!mesh.tangents.empty()) count(Counter::meshes_with_tangents);
        meshes.push_back(&mesh);
    }
    return meshes;
}

/// The triangles of several meshes, on the screen, in batches: in the first one are the scene's
/// first triangles, and so on.
class BinnedTriangles {
  public:
    std::vector<TriangleBatch> batches;

    BinnedTriangles() = default;  ///< None.

    /// Transforms, clips and bins them.
    ///
    /// Counts as the earlier lessons do: triangles_in each one that is taken, and
    /// triangles_culled_by_facing each piece that is culled for the side that it shows.
    ///
    /// @param culling    Whether pieces seen from behind are left out.
    /// @throws InputError  When drawing them would take more than the scene's budget has.
    BinnedTriangles(Workers& pool, const Scene& scene, const std::vector<const Mesh*>& meshes,
                    const mat4& clip_from_world, const Tiling& tiling, Culling culling)
        : BinnedTriangles(pool, scene, meshes, clip_from_world, tiling, culling,
                          [](std::size_t) { return true; }) {}

    /// Transforms, clips and bins the triangles of some materials.
    ///
    /// @param takes      Called as takes(material), an index into Scene::materials: whether
    ///                   triangles of it are taken.
    /// @param set_up     Does what project_triangles() does.
    template <typename Takes>
    BinnedTriangles(Workers& pool, const Scene& scene, const std::vector<const Mesh*>& meshes,
                    const mat4& clip_from_world, const Tiling& tiling, Culling culling,
                    const Takes& takes, ProjectTriangles* set_up = project_triangles) {
        std::vector<std::size_t> first_position = {0}, first_triangle = {0};
        for (const Mesh* mesh : meshes) {
            first_position.push_back(first_position.back() + mesh->positions.size());
            first_triangle.push_back(first_triangle.back() + mesh->triangles.size());
        }
        const auto positions_clip = std::make_unique_for_overwrite<vec4[]>(first_position.back());
        pool.run(batches_of(first_position.back()), [&](std::size_t batch, std::size_t) {
            for_each_run(first_position, batch,
                         [&](std::size_t mesh, std::size_t i, std::size_t end) {
                             for (; i < end; ++i)
                                 positions_clip[first_position[mesh] + i] =
                                     clip_from_world * vec4(meshes[mesh]->positions[i], 1);
                         });
        });
        batches.resize(batches_of(first_triangle.back()));
        std::vector<double> work(batches.size(), 0.0);
        pool.run(batches.size(), [&](std::size_t batch, std::size_t) {
            std::vector<ProjectedTriangle>& triangles = batches[batch].triangles;
            triangles.reserve(begin_of_batch(batch + 1, first_triangle.back()) -
                              begin_of_batch(batch, first_triangle.back()));
            for_each_run(first_triangle, batch,
                         [&](std::size_t mesh, std::size_t i, std::size_t end) {
                             const std::vector<Triangle>& of_mesh = meshes[mesh]->triangles;
                             for (std::size_t next = i; i < end; i = next) {
                                 const std::size_t material = of_mesh[i].material;
                                 while (next < end && of_mesh[next].material == material) ++next;
                                 if (!takes(material)) continue;
                                 count(Counter::triangles_in, next - i);
                                 count(Counter::triangles_culled_by_facing,
                                       set_up(*meshes[mesh], {&of_mesh[i], next - i},
                                              &positions_clip[first_position[mesh]], tiling.size(),
                                              culling, triangles));
                             }
                         });
            for (const ProjectedTriangle& projected : triangles)
                work[batch] += drawing_work(projected.on_screen);
        });
        scene.budget.check_overdraw(std::reduce(work.begin(), work.end()), tiling.size(),
                                    scene.file);
        pool.run(batches.size(),
                 [&](std::size_t batch, std::size_t) { batches[batch].bin(tiling); });
    }

    /// Calls take(projected) for each triangle that may reach into a tile, in the scene's order: it
    /// is that of the batches, and in each of them that of its list (Eq. 10.7).
    template <typename Take>
    void for_each_in(std::size_t tile, Take&& take) const {
        for (const TriangleBatch& batch : batches) batch.for_each_in(tile, take);
    }

    /// How many triangles may reach into a tile.
    std::size_t count_in(std::size_t tile) const {
        std::size_t count = 0;
        for (const TriangleBatch& batch : batches) count += batch.count_in(tile);
        return count;
    }

  private:
    /// Visits the things of one batch: in each mesh, those that follow each other.
    ///
    /// @param first  Of each mesh's things, counted through all meshes, and the last one's end.
    /// @param visit  Called as visit(mesh, i, end) for things i to end - 1 of a mesh, i < end.
    template <typename Visit>
    static void for_each_run(const std::vector<std::size_t>& first, std::size_t batch,
                             const Visit& visit) {
        for (std::size_t mesh = 0; mesh + 1 < first.size(); ++mesh) {
            const std::size_t begin = std::max(begin_of_batch(batch, first.back()), first[mesh]);
            const std::size_t end =
                std::min(begin_of_batch(batch + 1, first.back()), first[mesh + 1]);
            if (begin < end) visit(mesh, begin - first[mesh], end - first[mesh]);
        }
    }
};

}  // namespace rasterbook
