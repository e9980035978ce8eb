// SPDX-License-Identifier: MIT
/// @file
/// All shadow maps of a light on a few meshes, and what a shadow test at a point finds in them.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "09_shadow_maps/light_view.hpp"
#include "09_shadow_maps/shadow_map.hpp"

namespace rasterbook::test {

/// With these, no lit plane shadows itself.
inline constexpr std::array fitted_biases = {Bias::slope, Bias::plane, Bias::normal};

using Vertices = std::array<vec3, 3>;

inline Vertices vertices_in(const Mesh& mesh, const Triangle& triangle) {
    return {mesh.positions[triangle.vertices[0].position],
            mesh.positions[triangle.vertices[1].position],
            mesh.positions[triangle.vertices[2].position]};
}

inline Light point_light(vec3 position) {
    return {LightKind::point, vec3(1), vec3(0, 1, 0), position};
}

/// Shadow maps in which all of the meshes cast shadows.
struct LightMaps {
    Light light;
    std::vector<ShadowMap> maps;  ///< None, one, or six.

    /// @param around  Casters and receivers may reach as far as this, too; empty: no farther than
    ///                the meshes.
    LightMaps(const Light& of, std::span<const Mesh> meshes, int size, const Bounds& around = {})
        : light(of) {
        Bounds all = around;
        for (const Mesh& mesh : meshes) all.add(mesh.bounds.min), all.add(mesh.bounds.max);
        const LightViews views = light_views(light, all, all, size);
        for (std::size_t i = 0; i < views.count; ++i) {
            const bool is_empty = is_outside_frustum(all, views.clip_from_world[i]);
            maps.emplace_back(views.clip_from_world[i], views.is_perspective, is_empty ? 1 : size,
                              all);
            for (const Mesh& mesh : meshes)
                draw_casters(maps.back(), mesh, [](std::size_t) { return true; });
        }
    }

    const ShadowMap& map_for(vec3 point) const {
        return maps[maps.size() == 6 ? cube_face(point - light.position_world) : 0];
    }

    vec3 toward(vec3 point) const {
        return light.kind == LightKind::directional ? light.direction_world
                                                    : light.position_world - point;
    }

    /// @param radius  0 to max_pcf_radius.
    float visibility(Bias bias, int radius, const Vertices& vertices, vec3 point) const {
        const ShadowMap& map = map_for(point);
        const ShadowBias fitted = shadow_bias(map, bias, radius, vertices, toward(point));
        return pcf_visibility(map, radius, pcf_kernel(map, fitted, point));
    }
};

}  // namespace rasterbook::test
