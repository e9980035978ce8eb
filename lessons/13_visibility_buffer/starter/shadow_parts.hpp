// SPDX-License-Identifier: MIT
/// @file
/// Shadow maps of which a part is drawn when a pixel first asks for it. Introduced in lesson 13;
/// derivation: docs/derivations/13_visibility_buffer.md.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "09_shadow_maps/shadows.hpp"
#include "10_threading/binned_triangles.hpp"
#include "10_threading/split.hpp"
#include "10_threading/threaded_shadows.hpp"
#include "11_scenes/casters.hpp"
#include "common/app/counters.hpp"

namespace rasterbook {

/// A shadow map in square parts. Each is drawn by the thread that first asks for it; others that
/// ask meanwhile wait. If drawing throws, the next that asks tries again.
class ShadowMapParts {
  public:
    /// @param map      Of any depths; has to outlive this object.
    /// @param tiling   The parts: Split::tiles of map.size * map.size.
    /// @param casters  Binned by these parts.
    ShadowMapParts(ShadowMap& map, const Tiling& tiling, Casters casters)
        : map_(&map),
          tiling_(tiling),
          casters_(std::move(casters)),
          states_(std::make_unique<std::atomic<State>[]>(tiling.count())) {}

    /// Draws those parts that the taps around a texel lie in, if they are not drawn yet (Eq. 13.6).
    /// What lies around the map belongs to the parts at its border.
    ///
    /// @param middle  A texel of the map.
    /// @param radius  Of the PCF kernel.
    void draw_around(ivec2 middle, int radius) const {
        draw_in(PixelBox{middle - radius, middle + radius},
                [](auto&... what) { draw_tile(what...); });
    }

    /// Draws those parts that a box of texels lies in, if they are not drawn yet.
    ///
    /// @param fill  Draws a part, as draw_tile() of lesson 12.
    template <typename Fill>
    void draw_in(const PixelBox& texels, const Fill& fill) const {
        // TODO: step 3: tiling_.for_each_in() visits the parts that a box of texels lies in
        // (Eq. 13.6). Call draw() for those that are not drawn, until they are.
    }

    const ShadowMap& map() const { return *map_; }
    const Tiling& tiling() const { return tiling_; }
    bool is_drawn(std::size_t part) const {
        return states_[part].load(std::memory_order_acquire) == drawn;
    }

  private:
    enum State { not_asked, being_drawn, drawn };

    template <typename Fill>
    void draw(std::size_t part, const Fill& fill) const {
        // TODO: step 3: whoever changes the state from not_asked to being_drawn draws the part, by
        // fill(), which takes what draw_tile() takes; counts it as one of Counter::shadow_parts;
        // and then says so, by change(). Who comes later waits. If fill() throws, the state is
        // not_asked again, or the others would wait for ever; and the exception goes on.
    }

    void change(std::size_t part, State state) const {
        states_[part].store(state, std::memory_order_release);
        states_[part].notify_all();
    }

    ShadowMap* map_;
    Tiling tiling_;
    Casters casters_;
    std::unique_ptr<std::atomic<State>[]> states_;  ///< Of each part.
};

/// The shadow maps of all lights, of which nothing is drawn before it is asked for.
class ShadowMapsOnDemand {
  public:
    /// Finds what each map's parts are to be drawn from. Takes what draw_shadow_maps() takes.
    ///
    /// @param part_size  Texels along a part's side, at least 1.
    /// @param set_up     Does what project_triangles() of lesson 10 does.
    /// @param with_holes,filter  Of Casters.
    ShadowMapsOnDemand(Workers& pool, int part_size, const ShadowOptions& options,
                       const ShadowScene& of, ProjectTriangles* set_up = project_triangles,
                       const SceneAssets* with_holes = nullptr, Filter filter = {}) {
        const Tiling tiling(Split::tiles, ivec2(options.size), 1, part_size);
        maps_ = draw_shadow_maps(options, of, [&](ShadowMap& map, bool is_drawn) {
            Casters casters({}, with_holes, filter);
            if (is_drawn) casters.triangles = casters_of(pool, map, of.scene, tiling, set_up);
            parts_.emplace_back(map, tiling, std::move(casters));
        });
    }

    /// Makes the maps of a scene's lights, and bins the casters; light falls through their holes.
    ShadowMapsOnDemand(Workers& pool, int part_size, const SceneOptions& options,
                       const SceneAssets& assets, ProjectTriangles* set_up = project_triangles)
        : ShadowMapsOnDemand(pool, part_size, options.shadow,
                             shadow_scene(assets, options.shading.all_effects), set_up, &assets,
                             options.texture.filter) {}

    const ShadowMaps& maps() const { return maps_; }

    /// Of each map, counted through all lights.
    std::span<const ShadowMapParts> parts() const { return parts_; }

  private:
    ShadowMaps maps_{};
    std::vector<ShadowMapParts> parts_;
};

/// How much of a light reaches a point of a triangle, as in lesson 09. The parts of a map that it
/// reads are drawn first.
inline float light_visibility(const ShadowMapsOnDemand& on_demand, std::size_t l,
                              ShadowBiasCache& triangle, vec3 position, vec3 normal) {
    // TODO: step 3: lesson 09's light_visibility() takes a function that it calls with the map's
    // number and the kernel before it reads the map: there, draw what it is about to read.
    return 1;
}

}  // namespace rasterbook
