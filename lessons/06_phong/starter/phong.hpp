// SPDX-License-Identifier: MIT
/// @file
/// How much light a surface sends to the eye. Introduced in lesson 06;
/// derivation: docs/derivations/06_phong.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "06_phong/light.hpp"
#include "common/math/types.hpp"
#include "common/mesh.hpp"

namespace rasterbook {

/// The direction into which a mirror sends light that comes from `toward_light` (Eq. 6.2).
///
/// @param normal,toward_light  Length 1.
inline vec3 reflected(vec3 normal, vec3 toward_light) {
    // TODO: Eq. 6.2.
    return normal;
}

/// How a highlight falls off: by the angle between mirror direction and eye, or between the normal
/// and the direction halfway from light to eye.
enum class Highlight { phong, blinn };

/// The cosine that a highlight is a power of: 0 to 1 (Eq. 6.3 and 6.4). Whether light comes
/// from the front, N.L > 0, is not asked here but by reflected_light().
///
/// @param normal,toward_light,toward_eye  Length 1.
inline float highlight_cosine(Highlight highlight, vec3 normal, vec3 toward_light,
                              vec3 toward_eye) {
    // TODO: Eq. 6.3 and 6.4; mind a light opposite to the eye.
    return 0;
}

/// What a surface sends to the eye, before it is coloured by the material.
struct ReflectedLight {
    vec3 diffuse{0};
    vec3 specular{0};
};

/// A point of a surface, and who looks at it.
struct SurfacePoint {
    vec3 position_world;
    vec3 normal_world;  ///< Length 1.
    vec3 toward_eye;    ///< Length 1; of no meaning where there is no highlight.
};

/// The light of all lights, evenly reflected (Eq. 6.1) and as highlights (Eq. 6.3). None of it
/// comes from behind: only lights with N.L > 0 count.
///
/// @param power  Called as power(cosine) for each light that counts, with a cosine from 0 to 1; not
///               called if !has_highlight. The one of TriangleLight gives 0 for a highlight that
///               nobody could see.
template <typename Power>
ReflectedLight reflected_light(std::span<const Light> lights, const SurfacePoint& point,
                               bool has_highlight, Highlight highlight, Power&& power) {
    // TODO: the sum over all lights of incoming_light() by Eq. 6.1, and, where N.L > 0, of what it
    // is as a highlight: power(highlight_cosine()) times its colour.
    return {};
}

/// The colours of a surface in one fragment; linear.
struct SurfaceColor {
    vec3 ambient, diffuse, specular, emission;

    /// Colours what is reflected evenly: the same surface for light from lamps and from all around.
    void tint(vec3 color) { ambient *= color, diffuse *= color; }
};

/// A material's own colours. Of the light from all around it reflects at most as much as of a
/// lamp's: many exporters write Ka = 1 for everything.
inline SurfaceColor surface_color(const Material& material) {
    // TODO: what the text says about the material's Ka, behind Eq. 6.5.
    return {material.ambient, material.diffuse, material.specular, material.emission};
}

/// What a fragment of illum 0 sends to the eye: its colour, whatever the light.
inline vec3 unlit(const SurfaceColor& color) { return color.emission + color.diffuse; }

/// All the light that a fragment sends to the eye (Eq. 6.5); it may exceed 1.
///
/// @param color          Each number from -1e37 to 1e37; of greater ones the sum may be infinite.
/// @param ambient_light  0 to 1.
/// @param light          0 to 10.
inline vec3 phong(const SurfaceColor& color, vec3 ambient_light, const ReflectedLight& light) {
    // TODO: Eq. 6.5. Until then, the surface's own colour.
    return unlit(color);
}

}  // namespace rasterbook
