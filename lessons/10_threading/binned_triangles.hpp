// SPDX-License-Identifier: MIT
/// @file
/// Triangles that are ready to be filled, and for each part of a picture those that may reach into
/// it. Introduced in lesson 10; derivation: docs/derivations/10_threading.md.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "02_triangle_fill/triangle.hpp"
#include "04_mvp/clip.hpp"
#include "10_threading/split.hpp"
#include "10_threading/thread_pool.hpp"
#include "common/counters.hpp"
#include "common/mesh.hpp"

namespace rasterbook {

/// A triangle, or a piece of one that was clipped, as it lies on the screen.
struct ReadyTriangle {
    const Mesh& mesh;
    const Triangle& triangle;
    ClippedTriangle clipped;
    ScreenTriangle on_screen;
    vec3 depths;  ///< Of the piece's corners.
    bool is_back;
};

/// Triangles that follow each other in the scene, and for each part those that may reach into it.
class Chunk {
  public:
    std::vector<ReadyTriangle> triangles;  ///< In the scene's order; each has an area.

    /// Lists the triangles by parts: those whose box has a pixel there.
    void bin(const Parts& parts) {
        begin_.assign(parts.count() + 1, 0);
        const auto for_each_part = [&](const ReadyTriangle& ready, auto&& take) {
            parts.for_each_in(box_around(ready.on_screen), take);
        };
        // Count, so that each list has its place; then write, each list from its end backwards.
        for (const ReadyTriangle& ready : triangles)
            for_each_part(ready, [&](std::size_t part) { ++begin_[part]; });
        for (std::size_t part = 1; part < begin_.size(); ++part) begin_[part] += begin_[part - 1];
        indices_.resize(begin_.back());
        for (std::size_t i = triangles.size(); i-- > 0;)
            for_each_part(triangles[i], [&](std::size_t part) {
                indices_[--begin_[part]] = static_cast<std::uint32_t>(i);
            });
    }

    /// Indices into `triangles` of those that may reach into a part, ascending.
    std::span<const std::uint32_t> of(std::size_t part) const {
        return {indices_.data() + begin_[part], indices_.data() + begin_[part + 1]};
    }

  private:
    std::vector<std::uint32_t>
        begin_;  ///< Of each part's list in indices_, and the last one's end.
    std::vector<std::uint32_t> indices_;
};

/// A chunk takes at least so many triangles or positions: less is not worth a task.
constexpr std::size_t least_in_chunk = 256;
/// More than this many chunks would take memory for their lists, and hardly share out the work
/// better.
constexpr std::size_t most_chunks = 64;

/// How many chunks to make of so many things. It does not depend on the number of workers.
inline std::size_t chunks_of(std::size_t things) {
    return std::min((things + least_in_chunk - 1) / least_in_chunk, most_chunks);
}

/// The first thing of a chunk; behind the last chunk, the end of all.
inline std::size_t begin_of_chunk(std::size_t chunk, std::size_t things) {
    return chunk * things / chunks_of(things);
}

/// The triangles of several meshes, on the screen, in chunks: in the first one are the scene's
/// first triangles, and so on. A part that is drawn chunk by chunk, and in each by its list, is
/// drawn in the scene's order (Eq. 10.7).
class BinnedTriangles {
  public:
    std::vector<Chunk> chunks;

    /// Transforms, clips and bins them.
    ///
    /// Counts as the earlier lessons do: triangles_in each one that is taken, and
    /// triangles_culled_by_facing each piece that is not kept.
    ///
    /// @param pool       Has size() and run() as ThreadPool does.
    /// @param two_sided  Whether pieces seen from behind are kept.
    /// @param takes      Called as takes(material), an index into Scene::materials: whether
    ///                   triangles of it are taken.
    /// @param counters   One for each worker of the pool.
    template <typename Pool, typename Takes, typename CounterPolicy>
    BinnedTriangles(Pool& pool, std::span<const Mesh* const> meshes, const mat4& clip_from_world,
                    const Parts& parts, bool two_sided, const Takes& takes,
                    WorkerCounters<CounterPolicy>& counters) {
        std::vector<std::size_t> first_position = {0}, first_triangle = {0};
        for (const Mesh* mesh : meshes) {
            first_position.push_back(first_position.back() + mesh->positions.size());
            first_triangle.push_back(first_triangle.back() + mesh->triangles.size());
        }
        const auto positions_clip = std::make_unique_for_overwrite<vec4[]>(first_position.back());
        pool.run(chunks_of(first_position.back()), [&](std::size_t chunk, std::size_t) {
            for_each_run(first_position, chunk,
                         [&](std::size_t mesh, std::size_t i, std::size_t end) {
                             for (; i < end; ++i)
                                 positions_clip[first_position[mesh] + i] =
                                     clip_from_world * vec4(meshes[mesh]->positions[i], 1);
                         });
        });
        chunks.resize(chunks_of(first_triangle.back()));
        pool.run(chunks.size(), [&](std::size_t chunk, std::size_t worker) {
            std::vector<ReadyTriangle>& triangles = chunks[chunk].triangles;
            triangles.reserve(begin_of_chunk(chunk + 1, first_triangle.back()) -
                              begin_of_chunk(chunk, first_triangle.back()));
            for_each_run(first_triangle, chunk,
                         [&](std::size_t mesh, std::size_t i, std::size_t end) {
                             const vec4* const positions = &positions_clip[first_position[mesh]];
                             for (; i < end; ++i) {
                                 const Triangle& triangle = meshes[mesh]->triangles[i];
                                 if (!takes(triangle.material)) continue;
                                 counters[worker].add(Counter::triangles_in);
                                 add(*meshes[mesh], triangle, positions, parts.size(), two_sided,
                                     triangles, counters[worker]);
                             }
                         });
            chunks[chunk].bin(parts);
        });
    }

  private:
    template <typename CounterPolicy>
    static void add(const Mesh& mesh, const Triangle& triangle, const vec4* positions_clip,
                    ivec2 size, bool two_sided, std::vector<ReadyTriangle>& triangles,
                    CounterPolicy& counters) {
        const auto& [p, q, r] = triangle.corners;
        for (const ClippedTriangle& clipped :
             clip_triangle({positions_clip[p.position], positions_clip[q.position],
                            positions_clip[r.position]})) {
            const vec3 a = screen_from_clip(clipped[0].position_clip, size);
            const vec3 b = screen_from_clip(clipped[1].position_clip, size);
            const vec3 c = screen_from_clip(clipped[2].position_clip, size);
            const ScreenTriangle on_screen = snap_triangle(a, b, c);
            const bool is_back = !is_front_facing(on_screen);
            if (is_back && !two_sided)
                counters.add(Counter::triangles_culled_by_facing);
            else if (on_screen.twice_area != 0)
                triangles.push_back(
                    {mesh, triangle, clipped, on_screen, vec3(a.z, b.z, c.z), is_back});
        }
    }

    /// Visits the things of one chunk: in each mesh, those that follow each other.
    ///
    /// @param first  Of each mesh's things, counted through all meshes, and the last one's end.
    /// @param visit  Called as visit(mesh, i, end) for things i to end - 1 of a mesh, i < end.
    template <typename Visit>
    static void for_each_run(const std::vector<std::size_t>& first, std::size_t chunk,
                             const Visit& visit) {
        for (std::size_t mesh = 0; mesh + 1 < first.size(); ++mesh) {
            const std::size_t begin = std::max(begin_of_chunk(chunk, first.back()), first[mesh]);
            const std::size_t end =
                std::min(begin_of_chunk(chunk + 1, first.back()), first[mesh + 1]);
            if (begin < end) visit(mesh, begin - first[mesh], end - first[mesh]);
        }
    }
};

}  // namespace rasterbook
