// SPDX-License-Identifier: MIT
/// @file
/// The shadow maps of all lights, and how much of each light reaches a point. Introduced in lesson
/// 09; derivation: docs/derivations/09_shadow_maps.md.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <glm/trigonometric.hpp>

#include "04_mvp/projection.hpp"
#include "06_phong/effects.hpp"
#include "06_phong/light.hpp"
#include "09_shadow_maps/light_view.hpp"
#include "09_shadow_maps/shadow_map.hpp"
#include "09_shadow_maps/shadow_options.hpp"

namespace rasterbook {

/// Whether a material stops light: where it is lit itself (a sky or a bulb, illum 0, is not), and
/// where none passes through (d is 1). One with holes stops it beside them, whatever its opacity.
inline bool casts_shadows(const Material& material) {
    const bool is_opaque = material.opacity >= 1 && material.alpha != AlphaMode::blend;
    return is_lit(material) && (is_opaque || material.alpha == AlphaMode::mask);
}

/// What of a scene casts shadows, and what receives them.
struct ShadowBounds {
    Bounds casters, receivers;  ///< World space, of their triangles; empty where there are none.
};

inline ShadowBounds shadow_bounds(const Scene& scene) {
    ShadowBounds bounds;
    for (const Mesh& mesh : scene.meshes)
        for (const Triangle& triangle : mesh.triangles) {
            const Material& material = scene.materials[triangle.material];
            for (const Vertex& vertex : triangle.vertices) {
                const vec3 position = mesh.positions[vertex.position];
                if (casts_shadows(material)) bounds.casters.add(position);
                if (is_lit(material)) bounds.receivers.add(position);
            }
        }
    return bounds;
}

/// A warm light from the left, so low that shadows are long, and a cool one in front. The second
/// stands for the sky, whose light comes from all sides.
///
/// @param key     The warm light's kind.
/// @param bounds  Of the scene, world space.
inline std::array<Light, 2> raking_lights(LightKind key, const Bounds& bounds) {
    const vec3 center = bounds.center();
    const float radius = bounds.radius();
    const vec3 toward_key = unit_or(vec3(-0.9f, 0.5f, -0.2f), vec3(0, 1, 0));
    const vec3 toward_sky = unit_or(vec3(0.5f, 0.7f, 0.9f), vec3(0, 1, 0));
    Light light{key, 1.5f * vec3(1.0f, 0.87f, 0.68f), toward_key};
    if (key != LightKind::directional) {
        light.position_world = center + radius * vec3(-0.7f, 0.8f, 0.0f);
        light.half_distance = std::max(radius, std::numeric_limits<float>::min());
        light.color *= 2.0f;
    }
    if (key == LightKind::spot) {
        const vec3 target = center + radius * vec3(0.12f, -0.15f, 0.1f);
        light.direction_world = unit_or(target - light.position_world, -toward_key);
        light.cos_inner = std::cos(glm::radians(19.0f));
        light.cos_outer = std::cos(glm::radians(24.0f));
    }
    return {light, Light{LightKind::directional, vec3(0.13f, 0.18f, 0.27f), toward_sky}};
}

/// The key light casts shadows. The sky casts none: what comes from all sides has no edges.
constexpr std::array<bool, 2> light_casts = {true, false};

static_assert(margin_texels > max_pcf_radius);

constexpr std::size_t max_lights = 16;
constexpr std::size_t max_shadow_maps = 12;  ///< Of all lights: those of two point lights.

/// A light's shadow maps.
struct LightShadowMaps {
    static constexpr std::size_t no_map = 6;

    Light light;
    std::vector<ShadowMap> maps;
    std::size_t first_map = 0;               ///< Counted through all lights.
    std::array<std::size_t, 6> map_of_view;  ///< no_map where nothing can be in shadow.
    bool is_drawn = false;                   ///< Else the maps are there, but empty.
    bool has_faces = false;                  ///< The views are those of cube_face().
};

/// The shadow maps of all lights.
struct ShadowMaps {
    int radius;  ///< Of a test: 2 radius + 1 texels a side.
    Bias bias;
    std::vector<LightShadowMaps> of_light;
};

/// A light's maps, not yet drawn: one for each view in which there are light, a caster and a
/// receiver.
inline LightShadowMaps make_shadow_maps(const Light& light, int size, const ShadowBounds& bounds,
                                        const Bounds& reach) {
    LightShadowMaps made{.light = light, .maps = {}, .map_of_view = {}};
    const LightViews views = light_views(light, bounds.casters, bounds.receivers, size);
    made.map_of_view.fill(LightShadowMaps::no_map);
    made.has_faces = views.count == 6;
    made.maps.reserve(views.count);
    for (std::size_t i = 0; i < views.count; ++i) {
        if ((made.has_faces && !reaches_face(light, i)) ||
            is_outside_frustum(bounds.casters, views.clip_from_world[i]) ||
            is_outside_frustum(bounds.receivers, views.clip_from_world[i]))
            continue;
        made.map_of_view[i] = made.maps.size();
        made.maps.emplace_back(views.clip_from_world[i], views.is_perspective, size, reach,
                               DepthBuffer(ivec2(size + 2 * max_pcf_radius), unset));
    }
    return made;
}

/// A scene as shadow maps see it.
struct ShadowScene {
    const Scene& scene;
    const ShadowBounds& bounds;
    std::span<const Light> lights;  ///< At most max_lights.
    bool all_effects = false;  ///< Lights without shadows have maps, too, with nothing in them.
    std::span<const bool> casts = light_casts;  ///< For each light, whether it casts shadows.
};

/// The shadow maps of a scene, drawn as `draw` does it. A light whose maps would be more than
/// max_shadow_maps with those before it has none, and casts no shadow.
///
/// @param draw  Called as draw(ShadowMap&, bool is_drawn) for each map: clears its depths, and
///              draws the scene's casters, or nothing where a map stays empty.
template <typename Draw>
ShadowMaps draw_shadow_maps(const ShadowOptions& options, const ShadowScene& of, Draw&& draw) {
    assert(of.lights.size() <= max_lights && of.casts.size() >= of.lights.size());
    ShadowMaps shadow_maps{options.radius(), options.bias,
                           std::vector<LightShadowMaps>(of.lights.size())};
    const Bounds all = of.scene.bounds();
    std::size_t maps = 0;
    for (std::size_t l = 0; l < of.lights.size(); ++l) {
        const Light& light = of.lights[l];
        LightShadowMaps& of_light = shadow_maps.of_light[l];
        if (of.casts[l]) of_light = make_shadow_maps(light, options.size, of.bounds, all);
        of_light.is_drawn = !of_light.maps.empty();
        if (!of_light.is_drawn && of.all_effects)
            of_light = make_shadow_maps(light, options.size, {all, all}, all);
        if (maps + of_light.maps.size() > max_shadow_maps) of_light = {};
        of_light.light = light;
        of_light.first_map = maps;
        maps += of_light.maps.size();
        for (ShadowMap& map : of_light.maps) {
            count(Counter::shadow_passes);
            const Untraced shadow_map;
            draw(map, of_light.is_drawn);
        }
    }
    return shadow_maps;
}

/// The shadow maps of a scene, drawn one mesh after the other.
inline ShadowMaps draw_shadow_maps(const ShadowOptions& options, const ShadowScene& of) {
    const auto casts = [&](std::size_t material) {
        return casts_shadows(of.scene.materials[material]);
    };
    return draw_shadow_maps(options, of, [&](ShadowMap& map, bool is_drawn) {
        map.depths.clear(ivec2(0), map.depths.depths().size() - 1);
        if (is_drawn)
            for (const Mesh& mesh : of.scene.meshes) draw_casters(map, mesh, casts);
    });
}

/// A triangle on which shadows fall, and the biases that were fitted to it last.
///
/// A triangle has two sides. A point is on the one to which its normal points, and the bias of that
/// side in a map is fitted at the first test there. It does not depend on the point.
class ShadowBiasCache {
  public:
    /// @param vertices  World space.
    explicit ShadowBiasCache(const std::array<vec3, 3>& vertices)
        : vertices_(vertices),
          front_(glm::cross(dvec3(vertices[1]) - dvec3(vertices[0]),
                            dvec3(vertices[2]) - dvec3(vertices[0]))) {
        keys_.fill(no_key);
    }

    const std::array<vec3, 3>& vertices() const { return vertices_; }
    dvec3 front() const { return front_; }  ///< The flat triangle's normal, of any length.

    /// @param number   The map's, counted through all lights.
    /// @param is_back  Of which side.
    const ShadowBias& bias_in(const ShadowMap& map, std::size_t number, Bias bias, int radius,
                              bool is_back) {
        if (const ShadowBias* const known = known_bias(number, is_back)) return *known;
        last_ = (last_ + 1) % size;
        keys_[last_] = key_of(number, is_back);
        biases_[last_] = shadow_bias(map, bias, radius, vertices_, is_back ? -front_ : front_);
        return biases_[last_];
    }

    /// Null if it was not among the last that were asked for.
    const ShadowBias* known_bias(std::size_t number, bool is_back) const {
        for (std::size_t i = 0; i < size; ++i)
            if (keys_[i] == key_of(number, is_back)) return &biases_[i];
        return nullptr;
    }

  private:
    static constexpr std::size_t size = 4;  // most are seen in one map of a light, from one side
    static constexpr std::uint32_t no_key = ~std::uint32_t{0};

    static std::uint32_t key_of(std::size_t number, bool is_back) {
        return 2 * static_cast<std::uint32_t>(number) + (is_back ? 1 : 0);
    }

    std::array<vec3, 3> vertices_;
    dvec3 front_;
    std::array<std::uint32_t, size> keys_;
    std::array<ShadowBias, size> biases_{};
    std::size_t last_ = 0;
};

/// Notes for `--probe` which depths a shadow test compares.
[[gnu::cold, gnu::noinline]] inline void note_shadow_test(const ShadowMap& map, float bias,
                                                          PcfKernel kernel, int radius, float faded,
                                                          float lit) {
    if (!kernel.is_in_map)
        return trace("  visibility", words(faded * lit) + ": outside of the shadow map");
    const float in_map = map.depths.depths()[kernel.middle + max_pcf_radius];
    const float depth = std::max(kernel.depth, DepthBuffer::cleared);
    const int side = 2 * radius + 1;
    const std::string size = std::to_string(map.size);
    trace("  shadow map", "texel " + words(kernel.middle) + " of " + size + 'x' + size, "Eq. 9.6");
    trace("  bias", bias, "Eq. 9.10");
    trace(
        "  depths compared",
        words(depth, 7) + (depth >= in_map ? " is not behind " : " is behind ") + words(in_map, 7),
        "Eq. 9.7");
    trace("  taps that say lit",
          std::to_string(std::lrint(lit * static_cast<float>(side * side))) + " of " +
              std::to_string(side * side),
          "Eq. 9.13");
    trace("  visibility", faded * lit, "Eq. 9.16");
}

/// A surface gets all of a light from this cosine on; from there to 0, where it turns away, less
/// and less (Eq. 9.16). A normal map may still tilt the normal towards the light, but the surface
/// is in shadow.
constexpr float full_cosine = 0.1f;

/// How much of a light reaches a point of a triangle: 0 to 1.
///
/// No map is asked where the surface is turned away from the light.
///
/// @param l       The light's number.
/// @param normal  The surface's own, not a normal map's; of any length.
/// @param before  Called as before(map, kernel) before the taps are read: the map's number, counted
///                through all lights, and a kernel that is in the map.
template <typename Before>
float light_visibility(const ShadowMaps& shadow_maps, std::size_t l, ShadowBiasCache& triangle,
                       vec3 position, vec3 normal, const Before& before) {
    const LightShadowMaps& of_light = shadow_maps.of_light[l];
    if (of_light.maps.empty()) {
        trace("  visibility", "1: the light casts no shadows");
        return 1;
    }
    const vec3 from_light = position - of_light.light.position_world;
    const vec3 toward_light = of_light.light.kind == LightKind::directional
                                  ? of_light.light.direction_world
                                  : unit_or(-from_light, vec3(0, 1, 0));
    const float cosine = glm::dot(unit_or(normal, vec3(0)), toward_light);
    if (!(cosine > 0)) {
        trace("  visibility", "0: the surface is turned away");
        return of_light.is_drawn ? 0.0f : 1.0f;
    }
    const std::size_t i = of_light.map_of_view[of_light.has_faces ? cube_face(from_light) : 0];
    const float faded = of_light.is_drawn ? min(cosine / full_cosine, 1.0f) : 1.0f;
    if (i == LightShadowMaps::no_map) {
        if constexpr (has_probe)
            if (is_traced()) trace("  visibility", words(faded) + ": outside of the shadow map");
        return faded;
    }
    count(Counter::shadow_tests);
    const ShadowMap& map = of_light.maps[i];
    const bool is_back = glm::dot(triangle.front(), dvec3(normal)) < 0;
    const ShadowBias& bias = triangle.bias_in(map, of_light.first_map + i, shadow_maps.bias,
                                              shadow_maps.radius, is_back);
    const PcfKernel kernel = pcf_kernel(map, bias, position);
    if (kernel.is_in_map) before(of_light.first_map + i, kernel);
    const float lit = pcf_visibility(map, shadow_maps.radius, kernel);
    if constexpr (has_probe)
        if (is_traced()) note_shadow_test(map, bias.bias, kernel, shadow_maps.radius, faded, lit);
    return faded * lit;
}

/// How much of a light reaches a point of a triangle, by maps that are drawn.
inline float light_visibility(const ShadowMaps& shadow_maps, std::size_t l,
                              ShadowBiasCache& triangle, vec3 position, vec3 normal) {
    return light_visibility(shadow_maps, l, triangle, position, normal,
                            [](std::size_t, const PcfKernel&) {});
}

}  // namespace rasterbook
