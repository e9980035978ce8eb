// SPDX-License-Identifier: MIT
/// @file
/// In which order the triangles of a scene are drawn: what is opaque first, as glass is drawn over
/// it. Introduced in lesson 11.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "04_mvp/clip.hpp"
#include "10_threading/binned_triangles.hpp"
#include "11_scenes/scene_assets.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// All passes that there can be, in their order.
constexpr Pass all_passes[] = {{false, false, Culling::back_faces}, {false, false, Culling::none},
                               {true, false, Culling::back_faces},  {true, false, Culling::none},
                               {true, true, Culling::back_faces},   {true, true, Culling::none}};

/// The triangles of a picture, binned by passes.
class BinnedPasses {
  public:
    /// Transforms, clips and bins the triangles of each pass, outlines with them.
    ///
    /// @param set_up  Does what project_triangles() does.
    BinnedPasses(Workers& pool, const SceneAssets& assets, const Camera& camera,
                 const Tiling& tiling, ProjectTriangles* set_up = project_triangles) {
        const mat4 clip_from_world = camera.clip_from_world(tiling.size());
        for (const OutlineHull& hull : assets.hulls) outlines_.push_back(pushed(hull, camera));
        std::vector<const Mesh*> meshes = meshes_in_view(assets.scene, clip_from_world);
        for (const Mesh& mesh : outlines_)
            if (!is_outside_frustum(mesh.bounds, clip_from_world)) meshes.push_back(&mesh);
        for (const Pass& pass : all_passes) {
            const auto takes = [&](std::size_t material) {
                return assets.passes[material] == pass;
            };
            if (std::ranges::find(assets.passes, pass) == assets.passes.end()) continue;
            std::vector<const Mesh*> some;
            for (const Mesh* const mesh : meshes)
                if (std::ranges::any_of(mesh->triangles, [&](const Triangle& triangle) {
                        return takes(triangle.material);
                    }))
                    some.push_back(mesh);
            if (!some.empty())
                (pass.is_blended ? blended_ : opaque_)
                    .emplace_back(pool, assets.scene, some, clip_from_world, tiling, pass.culling,
                                  takes, set_up);
        }
    }

    /// Calls take(projected) for each opaque triangle that may reach into a tile.
    template <typename Take>
    void for_each_opaque_in(std::size_t tile, const Take& take) const {
        for (const BinnedTriangles& pass : opaque_) pass.for_each_in(tile, take);
    }

    /// Calls take(projected) for each of the others.
    template <typename Take>
    void for_each_blended_in(std::size_t tile, const Take& take) const {
        for (const BinnedTriangles& pass : blended_) pass.for_each_in(tile, take);
    }

    /// How many of the others there are.
    std::size_t count_blended_in(std::size_t tile) const {
        std::size_t count = 0;
        for (const BinnedTriangles& pass : blended_) count += pass.count_in(tile);
        return count;
    }

    BinnedPasses(const BinnedPasses&) = delete;  // its triangles point into its outlines
    BinnedPasses& operator=(const BinnedPasses&) = delete;

  private:
    std::vector<Mesh> outlines_;  ///< As the camera is to see them.
    std::vector<BinnedTriangles> opaque_, blended_;
};

}  // namespace rasterbook
