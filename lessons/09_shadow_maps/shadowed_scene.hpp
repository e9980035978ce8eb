// SPDX-License-Identifier: MIT
/// @file
/// A scene whose things throw shadows on each other. Introduced in lesson 09.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "06_phong/lit_points.hpp"
#include "08_normal_maps/bumpy_scene.hpp"
#include "09_shadow_maps/light_view.hpp"
#include "09_shadow_maps/shadow_map.hpp"
#include "09_shadow_maps/shadow_variants.hpp"
#include "common/math/numerics.hpp"

namespace rasterbook {

/// A model, its normal maps, and what of it throws shadows and what gets them.
struct ShadowedScene : BumpyScene {
    Bounds casters, receivers;  ///< World space, of their triangles; empty where there are none.

    template <typename Options>
    ShadowedScene(Scene scene, const Options& options) : BumpyScene(std::move(scene), options) {
        for (const Mesh& mesh : meshes)
            for (const Triangle& triangle : mesh.triangles)
                for (const Corner& corner : triangle.corners) {
                    if (casts(triangle.material)) casters.add(mesh.positions[corner.position]);
                    if (effects[triangle.material].light)
                        receivers.add(mesh.positions[corner.position]);
                }
    }

    /// Whether a material stops light: where it is lit itself (a sky or a bulb, illum 0, is not),
    /// and where none passes through (d is 1).
    bool casts(std::size_t material) const {
        return effects[material].light && materials[material].opacity >= 1 &&
               materials[material].alpha != AlphaMode::blend;
    }
};

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
        light.cos_full = std::cos(glm::radians(19.0f));
        light.cos_none = std::cos(glm::radians(24.0f));
    }
    return {light, Light{LightKind::directional, vec3(0.13f, 0.18f, 0.27f), toward_sky}};
}

/// The key light throws shadows. The sky throws none: what comes from all sides has no edges.
constexpr std::array<bool, 2> light_casts = {true, false};

static_assert(margin_texels > most_pcf_radius);

constexpr std::size_t most_lights = 16;
constexpr std::size_t most_maps = 12;  ///< Of all lights: those of two lamps.

/// A light and its depth maps.
struct LightDepths {
    static constexpr std::size_t no_map = 6;

    Light light;
    std::vector<ShadowMap> maps;
    std::size_t first_map = 0;               ///< Counted through all lights.
    std::array<std::size_t, 6> map_of_view;  ///< no_map where nothing can be in shadow.
    bool is_drawn = false;                   ///< Else the maps are there, but empty.
    bool has_faces = false;                  ///< The views are those of cube_face().
};

/// The depth maps of all lights that call for some.
class Shadows {
  public:
    /// Draws them: for a light that casts, where in its view there are a caster and a receiver.
    ///
    /// @param all_effects  Gives the other lights maps, too, with nothing in them.
    template <typename CounterPolicy>
    Shadows(const ShadowVariant& variant, bool all_effects, const ShadowedScene& scene,
            std::span<const Light> lights, CounterPolicy& counters)
        : Shadows(
              variant, all_effects, scene, lights, counters, [&](ShadowMap& map, bool is_drawn) {
                  map.depths.clear(ivec2(0), map.depths.depths().size() - 1);
                  const auto casts = [&](std::size_t material) { return scene.casts(material); };
                  if (is_drawn)
                      for (const Mesh& mesh : scene.meshes)
                          draw_casters(map, mesh, casts, counters);
              }) {}

    /// The same, drawn as `draw` does it.
    ///
    /// @param lights  At most most_lights. One whose maps would be more than most_maps with those
    ///                before it has none, and throws no shadow.
    /// @param draw    Called as draw(ShadowMap&, bool is_drawn) for each map: clears its depths,
    ///                and draws the scene's casters, or nothing where a map stays empty.
    /// @param casts   For each light, whether it throws shadows.
    template <typename CounterPolicy, typename Draw>
    Shadows(const ShadowVariant& variant, bool all_effects, const ShadowedScene& scene,
            std::span<const Light> lights, CounterPolicy& counters, Draw&& draw,
            std::span<const bool> casts = light_casts)
        : radius_(variant.radius()), bias_(variant.bias), of_light_(lights.size()) {
        assert(lights.size() <= most_lights && casts.size() >= lights.size());
        std::size_t maps = 0;
        for (std::size_t l = 0; l < lights.size(); ++l) {
            of_light_[l].light = lights[l];
            if (casts[l])
                add_maps(of_light_[l], variant.size, scene, scene.casters, scene.receivers);
            of_light_[l].is_drawn = !of_light_[l].maps.empty();
            if (!of_light_[l].is_drawn && all_effects)
                add_maps(of_light_[l], variant.size, scene, scene.bounds(), scene.bounds());
            if (maps + of_light_[l].maps.size() > most_maps) {
                of_light_[l].maps.clear();
                of_light_[l].is_drawn = false;
            }
            of_light_[l].first_map = maps;
            maps += of_light_[l].maps.size();
            for (ShadowMap& map : of_light_[l].maps) {
                counters.add(Counter::shadow_passes);
                draw(map, of_light_[l].is_drawn);
            }
        }
        has_maps_ = maps > 0;
    }

    /// Whether any point can have to ask.
    bool has_maps() const { return has_maps_; }

  private:
    friend class TriangleShadows;

    /// One for each view in which there can be a shadow.
    static void add_maps(LightDepths& of_light, int size, const ShadowedScene& scene,
                         const Bounds& casters, const Bounds& receivers) {
        const LightViews views = light_views(of_light.light, casters, receivers, size);
        of_light.map_of_view.fill(LightDepths::no_map);
        of_light.has_faces = views.count == 6;
        of_light.maps.reserve(views.count);
        for (std::size_t i = 0; i < views.count; ++i) {
            if (is_outside_frustum(casters, views.clip_from_world[i]) ||
                is_outside_frustum(receivers, views.clip_from_world[i]))
                continue;
            of_light.map_of_view[i] = of_light.maps.size();
            of_light.maps.emplace_back(views.clip_from_world[i], views.is_perspective, size,
                                       scene.bounds(),
                                       DepthBuffer(ivec2(size + 2 * most_pcf_radius), unset));
        }
    }

    float lit(const ShadowMap& map, const Receiver& receiver, vec3 position) const {
        switch (radius_) {
            case 0:
                return lit_share<0>(map, receiver, position);
            case 1:
                return lit_share<1>(map, receiver, position);
            case 2:
                return lit_share<2>(map, receiver, position);
            default:
                return lit_share<3>(map, receiver, position);
        }
    }

    int radius_;
    Bias bias_;
    bool has_maps_ = false;
    std::vector<LightDepths> of_light_;
};

/// A surface gets all of a light from this cosine on; from there to 0, where it turns away, less
/// and less (Eq. 9.16). Its relief may still lean towards the light, but stands in the shade.
constexpr float full_cosine = 0.1f;

/// How much of each light reaches points of a triangle.
///
/// A triangle has two sides. A point is on the one to which its normal leads, and the bias of that
/// side in a map is fitted at the first look-up there. It is the same whichever point is the first.
class TriangleShadows {
  public:
    TriangleShadows(const Shadows& shadows, const Mesh& mesh, const Triangle& triangle)
        : shadows_(shadows),
          corners_{mesh.positions[triangle.corners[0].position],
                   mesh.positions[triangle.corners[1].position],
                   mesh.positions[triangle.corners[2].position]},
          front_(0) {
        if (!shadows.has_maps()) return;
        const dvec3 a = corners_[0], b = corners_[1], c = corners_[2];
        front_ = normalize_or(glm::cross(b - a, c - a), dvec3(0));
    }

    /// Asks the maps for points with normals that are the surface's own, no relief's. None is asked
    /// where a surface is turned away from the light.
    template <typename CounterPolicy>
    void look_up(const LitPoints& points, CounterPolicy& counters) {
        for (std::size_t l = 0; l < shadows_.of_light_.size(); ++l) {
            if (shadows_.of_light_[l].maps.empty()) {
                shares_[l].fill(1);
                continue;
            }
            const Numbers cosine = cosines(shadows_.of_light_[l].light, points);
            for (std::size_t i = 0; i < points.count; ++i)
                shares_[l][i] =
                    share(l, points.position_world[i], points.normal_world[i], cosine[i], counters);
        }
    }

    /// As reflect_light() asks for it.
    float operator()(std::size_t light, std::size_t point) const { return shares_[light][point]; }

  private:
    /// Of the angles between points' normals and their ways to a light.
    static Numbers cosines(const Light& light, const LitPoints& points) {
        const bool is_sun = light.kind == LightKind::directional;
        const vec3 place = light.position_world, sun = light.direction_world;
        Numbers cosine;
        int unusable = 0;
        for (std::size_t i = 0; i < points.count; ++i) {
            const vec3 normal = points.normal_world[i], way = place - points.position_world[i];
            const vec3 toward = is_sun ? sun : way * one_over_length(way, unusable);
            cosine[i] = glm::dot(normal * one_over_length(normal, unusable), toward);
        }
        if (unusable == 0) return cosine;
        for (std::size_t i = 0; i < points.count; ++i) {
            const vec3 way = place - points.position_world[i];
            cosine[i] = glm::dot(unit_or(points.normal_world[i], vec3(0)),
                                 is_sun ? sun : unit_or(way, vec3(0, 1, 0)));
        }
        return cosine;
    }

    template <typename CounterPolicy>
    float share(std::size_t l, vec3 position, vec3 normal, float cosine, CounterPolicy& counters) {
        const LightDepths& of_light = shadows_.of_light_[l];
        if (!(cosine > 0)) return of_light.is_drawn ? 0 : 1;
        const vec3 way = position - of_light.light.position_world;
        const std::size_t map = of_light.map_of_view[of_light.has_faces ? cube_face(way) : 0];
        const float faded = of_light.is_drawn ? std::min(cosine / full_cosine, 1.0f) : 1;
        if (map == LightDepths::no_map) return faded;
        counters.add(Counter::shadow_lookups);
        const bool is_back = glm::dot(front_, normal) < 0;
        std::optional<Receiver>& of_side = receivers_[of_light.first_map + map][is_back];
        if (!of_side)  // most triangles of a lamp are seen in one map, and from one side
            of_side = receiver(of_light.maps[map], shadows_.bias_, shadows_.radius_, corners_,
                               is_back ? -front_ : front_);
        return faded * shadows_.lit(of_light.maps[map], *of_side, position);
    }

    const Shadows& shadows_;
    std::array<vec3, 3> corners_;
    vec3 front_;  ///< The flat triangle's normal, length 1; 0 without area or maps.
    /// By map and side: front, back.
    std::array<std::array<std::optional<Receiver>, 2>, most_maps> receivers_;
    std::array<Numbers, most_lights> shares_;  ///< By light.
};

}  // namespace rasterbook
