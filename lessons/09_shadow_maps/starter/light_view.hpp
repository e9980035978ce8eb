// SPDX-License-Identifier: MIT
/// @file
/// How a light sees the scene: the matrices of its depth maps. Introduced in lesson 09;
/// derivation: docs/derivations/09_shadow_maps.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "04_mvp/clip.hpp"
#include "04_mvp/transform.hpp"
#include "06_phong/light.hpp"
#include "common/model/mesh.hpp"

namespace rasterbook {

/// The matrices under which a light's depth maps are drawn.
struct LightViews {
    std::array<mat4, 6> clip_from_world{};
    std::size_t count = 0;  ///< 0: nothing can cast a shadow on anything; 1; 6: see cube_face().
    bool is_perspective = false;
};

/// The orthographic projection of the box from `low` to `high` onto NDC: x and y from -1 to 1, z
/// from 0 to 1 (Eq. 9.2). It leaves w as it is, so that it can follow a perspective.
///
///     2/(h.x-l.x)  0            0            -(h.x+l.x)/(h.x-l.x)
///     0            2/(h.y-l.y)  0            -(h.y+l.y)/(h.y-l.y)
///     0            0            1/(h.z-l.z)  -l.z/(h.z-l.z)
///     0            0            0            1
///
/// @param low,high  low < high in each component.
inline dmat4 crop(dvec3 low, dvec3 high) {
    // TODO: Eq. 9.2.
    return dmat4(1);
}

/// Nearer to a point light or spotlight than this share of the farthest caster or receiver, nothing
/// casts.
constexpr double min_near_share = 0.001;

/// A spotlight whose light ends farther than this from its axis gets six maps, as a point light.
constexpr float widest_spot_radians = 75 * std::numbers::pi_v<float> / 180;

/// A box in the light's view: x right, y up, z towards the light. (Or a spotlight's box in NDC.)
struct LightBox {
    dvec3 low{std::numeric_limits<double>::infinity()};
    dvec3 high{-std::numeric_limits<double>::infinity()};

    void add(dvec3 p) { low = glm::min(low, p), high = glm::max(high, p); }
    bool is_usable() const {  // false for NaN and infinity
        constexpr double most = std::numeric_limits<float>::max();
        return glm::all(glm::lessThanEqual(low, high)) &&
               glm::all(glm::lessThan(glm::max(glm::abs(low), glm::abs(high)), dvec3(most)));
    }
};

/// The box around a box's corners in another space.
inline LightBox box_in(const dmat4& view_from_world, const Bounds& bounds) {
    LightBox box;
    for (int i = 0; i < 8; ++i)
        box.add(view_from_world * dvec4(i & 1 ? bounds.max.x : bounds.min.x,
                                        i & 2 ? bounds.max.y : bounds.min.y,
                                        i & 4 ? bounds.max.z : bounds.min.z, 1));
    return box;
}

/// Where a shadow can begin and end: sideways where there are both casters and receivers, and from
/// the nearest caster to where casters or receivers end (Eq. 9.3).
///
/// z grows towards the light, in view space and in NDC.
///
/// @return  Not usable, low above high, where there can be no shadow.
inline LightBox shadow_region(const LightBox& casters, const LightBox& receivers) {
    // TODO: step 1: from dvec3(-10) to dvec3(10). Step 5: Eq. 9.3.
    return casters;
}

/// By so many texels, each map reaches on each side beyond its box or face: so all taps of a point
/// near the border lie in the map. One more than the largest PCF kernel takes.
constexpr int margin_texels = 4;

/// By how much the margin makes a map wider (Eq. 9.5).
///
/// @param size  Of the map in texels, > 2 margin_texels.
inline double widened_by_margin(int size) {
    // TODO: step 4: t of Eq. 9.5.
    return 1;
}

/// The box a little larger, so that rounding puts nothing outside, no side of it 0, and sideways
/// with a margin. z becomes larger as well.
inline LightBox widened(const LightBox& box, int size) {
    const dvec3 half = 0.5 * (box.high - box.low), middle = 0.5 * (box.high + box.low);
    const double largest = std::max({half.x, half.y, half.z});
    const double least = largest > 0 ? 1e-3 * largest : 1;
    const double margin = widened_by_margin(size);
    const dvec3 wider = dvec3(margin, margin, 1) * glm::max(1.002 * half, dvec3(least));
    return {middle - wider, middle + wider};
}

/// view_from_world of a camera at a position, looking along a direction. (In `eye + direction`, a
/// far eye would swallow the direction's digits.)
inline dmat4 looking(dvec3 eye, dvec3 direction) {
    return look_at(dvec3(0), direction, dvec3(0, 1, 0)) * translation(-eye);
}

/// A directional light's map: an orthographic projection along its rays, fitted to what casts on
/// what receives (Eq. 9.1).
///
/// @return  Of count 0 when no receiver lies behind a caster, as the light sees them.
inline LightViews directional_light_views(const Light& light, const Bounds& casters,
                                          const Bounds& receivers, int size) {
    // TODO: step 1: Eq. 9.1 by looking(), the two boxes in this view by box_in(), shadow_region()
    // and widened(); then crop(). Step 5: return {} where is_usable() is false for
    // one of the two boxes, or for the region before it is widened.
    return {{mat4(1)}, 1, false};
}

/// Distance of the near plane: that of the nearest caster, a little less so that rounding puts
/// nothing before it; or a thousandth of the farthest distance (Eq. 9.4, the second line).
///
/// @param nearest_caster  Along the map's axis; may be 0 or less.
/// @param farthest        Where casters or receivers end, whichever comes first, > 0.
inline double near_plane(double nearest_caster, double farthest) {
    // TODO: step 4: 0.1. Step 5: the second line of Eq. 9.4.
    return min_near_share;
}

/// A spotlight's map: all that its cone lights, fitted to what casts on what receives (Eq. 9.4).
///
/// @return  Of count 0 when in front of the light and in its cone no receiver lies behind a caster.
inline LightViews spotlight_views(const Light& light, const Bounds& casters,
                                  const Bounds& receivers, int size) {
    // TODO: step 4: P V, by perspective(), of the angle 2 acos(cos_outer), and looking();
    // near_plane() takes no notice yet of what it is given. Step 5: Eq. 9.4, where {} is returned
    // if there can be no shadow:
    // 1. Both boxes in the light's view, by box_in(). {} if one is not usable.
    // 2. A box reaches from -high.z to -low.z in front of the light. The map's farthest is the
    //    lesser of the two far ends. {} unless it is > 0 and the nearest caster is not farther.
    //    Then near_plane().
    // 3. Both boxes in NDC: the corners in the world times P V, divided by w, which box_in() does
    //    not do. A box that comes nearer than the near plane is all of NDC instead.
    // 4. shadow_region() of the two; x and y of low raised to at least -1, of high lowered to at
    //    most 1; z set to 0 to 1. {} if not usable.
    // 5. widened(), z set to 0 to 1 once more, and crop().
    return {{mat4(1)}, 1, true};
}

/// The face of a cube map that a vector from the light passes through: 0 to 5 for +x, -x, +y, -y,
/// +z, -z (Eq. 9.5). A 0 of either sign counts as positive: a zero-length vector is +x.
inline std::size_t cube_face(vec3 direction) {
    // TODO: step 4: the left of Eq. 9.5. Of equal components, x wins over y and y over z.
    return 0;
}

/// The cosine of the smallest angle between a direction and one that passes through a face of the
/// cube (Eq. 9.5): 1 where the direction itself does; 0 from 90 degrees on.
///
/// @param direction  Length 1.
inline double cosine_to_face(dvec3 direction, std::size_t face) {
    const auto axis = static_cast<int>(face / 2);
    const double along = face % 2 == 0 ? direction[axis] : -direction[axis];
    const double b = std::abs(direction[(axis + 1) % 3]), c = std::abs(direction[(axis + 2) % 3]);
    // The face's vectors have |b| and |c| up to their length along its axis. The nearest of them to
    // the direction is its projection on all of them, on one of the four sides, or on an edge.
    const double x = std::max({along, (along + std::max(b, c)) / 2, (along + b + c) / 3, 0.0});
    return glm::length(dvec3(x, std::min(b, x), std::min(c, x)));
}

/// Whether a light shines through a face of the cube: a spotlight may not (Eq. 6.7).
inline bool reaches_face(const Light& light, std::size_t face) {
    constexpr double rounding_of_cosines = 1e-6;
    return light.kind != LightKind::spot ||
           cosine_to_face(light.direction_world, face) > light.cos_outer - rounding_of_cosines;
}

/// A point light's six maps: along the axes, each 90 degrees wide and a margin (Eq. 9.5).
inline LightViews point_light_views(const Light& light, const Bounds& casters,
                                    const Bounds& receivers, int size) {
    // TODO: step 4: the right of Eq. 9.5, near_plane(), and a view along each axis by looking().
    // Step 5: distances from the light, in any direction. The nearest caster is at the point of the
    // casters' box that is nearest: the light's position, each coordinate clamped to the box. A box
    // ends at its farthest corner: for each coordinate, min or max, whichever is farther. The
    // lesser of the two boxes' ends is the map's. {} unless it is > 0 and below float's maximum,
    // and the nearest caster is not farther. near_plane() gets the nearest caster's distance
    // divided by sqrt(1 + 2 t^2).
    LightViews views{{}, 6, true};
    views.clip_from_world.fill(mat4(1));
    return views;
}

/// The matrices of a light's depth maps.
///
/// @param light      Finite numbers; one parallel to the y axis is as good as any.
/// @param casters    World space; with receivers, all that the maps have to show. May be empty.
/// @param receivers  World space; what lies outside of the maps is lit.
/// @param size       Of a map in texels, > 2 margin_texels.
inline LightViews light_views(const Light& light, const Bounds& casters, const Bounds& receivers,
                              int size) {
    const auto is_usable = [](const Bounds& b) { return LightBox{b.min, b.max}.is_usable(); };
    if (!is_usable(casters) || !is_usable(receivers)) return {};
    if (light.kind == LightKind::directional)
        return directional_light_views(light, casters, receivers, size);
    if (light.kind == LightKind::spot && light.cos_outer > std::cos(widest_spot_radians))
        return spotlight_views(light, casters, receivers, size);
    return point_light_views(light, casters, receivers, size);
}

}  // namespace rasterbook
