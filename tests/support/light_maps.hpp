// SPDX-License-Identifier: MIT
/// @file
/// All depth maps of a light on a few meshes, and what they say of a point.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "09_shadow_maps/light_view.hpp"
#include "09_shadow_maps/shadow_map.hpp"
#include "common/counters.hpp"

namespace rasterbook::test {

using Corners = std::array<vec3, 3>;

inline Corners corners_in(const Mesh& mesh, const Triangle& triangle) {
    return {mesh.positions[triangle.corners[0].position],
            mesh.positions[triangle.corners[1].position],
            mesh.positions[triangle.corners[2].position]};
}

/// Maps that all of the meshes throw shadows in.
struct LightMaps {
    Light light;
    std::vector<ShadowMap> maps;  ///< None, one, or six.

    /// @param around  Casters and receivers reach so far as well; empty for no farther than meshes.
    LightMaps(const Light& of, std::span<const Mesh> meshes, int size, const Bounds& around = {})
        : light(of) {
        Bounds all = around;
        for (const Mesh& mesh : meshes) all.add(mesh.bounds.min), all.add(mesh.bounds.max);
        const LightViews views = light_views(light, all, all, size);
        NoCounters none;
        for (std::size_t i = 0; i < views.count; ++i) {
            const bool is_empty = is_outside_frustum(all, views.clip_from_world[i]);
            maps.emplace_back(views.clip_from_world[i], views.is_perspective, is_empty ? 1 : size,
                              all);
            for (const Mesh& mesh : meshes)
                draw_casters(maps.back(), mesh, [](std::size_t) { return true; }, none);
        }
    }

    const ShadowMap& map_for(vec3 point) const {
        return maps[maps.size() == 6 ? cube_face(point - light.position_world) : 0];
    }

    vec3 toward(vec3 point) const {
        return light.kind == LightKind::directional ? light.direction_world
                                                    : light.position_world - point;
    }

    /// @param radius  0 to most_pcf_radius.
    float share(Bias bias, int radius, const Corners& corners, vec3 point) const {
        const ShadowMap& map = map_for(point);
        const Receiver at = receiver(map, bias, radius, corners, toward(point));
        switch (radius) {
            case 0:
                return lit_share<0>(map, at, point);
            case 1:
                return lit_share<1>(map, at, point);
            case 2:
                return lit_share<2>(map, at, point);
            default:
                return lit_share<3>(map, at, point);
        }
    }
};

}  // namespace rasterbook::test
