// SPDX-License-Identifier: MIT
/// @file
/// Light in tones, as in a comic. Introduced in lesson 07; derivation: docs/derivations/07_toon.md.
#pragma once

#include <algorithm>

#include "06_phong/phong.hpp"
#include "common/math/types.hpp"

namespace rasterbook {

constexpr int max_tones = 255;

/// Ambient light: all that the darkest tone has; linear.
constexpr vec3 toon_ambient_light(0.15f, 0.15f, 0.22f);

/// How bright a coloured light is: its largest component (Eq. 7.1).
///
/// @return  At least 0: a component that is NaN or negative counts as 0.
template <typename F>
F brightness(Vec3<F> light) {
    return max(light.b, max(light.g, max(light.r, F(0.0f))));
}

/// The tone that a brightness falls into: 0 to tones - 1 (Eq. 7.2).
///
/// The thresholds are k / tones, exactly, for k = 1 to tones - 1; a brightness on a threshold
/// belongs to the brighter tone.
///
/// @param brightness  Any number; below 0 and NaN count as 0, above 1 as 1.
/// @param tones       1 to max_tones.
inline int tone_of(float brightness, int tones) {
    // In double the product is exact; in float it may be rounded up to a threshold.
    const double steps = double{brightness} * tones;
    if (!(steps >= 1)) return 0;  // also for NaN
    return steps < tones ? static_cast<int>(steps) : tones - 1;
}

/// The level of a tone's light: 0, 1 / (tones - 1), ..., 1; for a single tone 1 (Eq. 7.3).
inline float level_of(int tone, int tones) {
    return tones == 1 ? 1.0f : static_cast<float>(tone) / static_cast<float>(tones - 1);
}

/// A brightness, quantised to the level of its tone.
///
/// @param brightness,tones  As for tone_of().
inline float quantised(float brightness, int tones) {
    trace("brightness", brightness, "Eq. 7.1");
    trace("tone", tone_of(brightness, tones), "Eq. 7.2");
    return level_of(tone_of(brightness, tones), tones);
}

/// From this brightness on a highlight is seen, and then it is white.
constexpr float min_tone_highlight = 0.5f;

/// The colour of a fragment whose light is known: white in a highlight, else the surface's own
/// colours in the light of a level (Eq. 7.4). The lights' colours do not count, so that a tone has
/// one colour.
///
/// @param color            Components from -1e37 to 1e37; of greater ones the sum may be infinite.
/// @param from_all_around  Ambient light, 0 to 1.
/// @param level            Of the diffuse light, 0 to 1.
/// @param is_highlight     Whether the fragment lies in a highlight.
inline vec3 paint(const SurfaceColor& color, vec3 from_all_around, float level, bool is_highlight) {
    if (is_highlight) return vec3(1);
    return color.emission + color.ambient * from_all_around + color.diffuse * level;
}

/// Whether a highlight can be seen in a fragment: what Phong's model would add is bright enough.
inline bool is_highlight(const SurfaceColor& color, const ReflectedLight& light) {
    trace("highlight", brightness(color.specular * light.specular), "Eq. 7.4");
    return brightness(color.specular * light.specular) >= min_tone_highlight;
}

/// The colour of a fragment, in place of phong() (Eq. 7.4).
///
/// @param tones  1 to max_tones.
inline vec3 toon(const SurfaceColor& color, vec3 from_all_around, const ReflectedLight& light,
                 int tones) {
    const float level = quantised(brightness(light.diffuse), tones);
    return paint(color, from_all_around, level, is_highlight(color, light));
}

/// The facing ratio: 1 where a surface is seen from straight above, 0 at a silhouette (Eq. 7.6).
///
/// @param normal,toward_eye  Length 1.
/// @return  0 to 1, but for rounding; 0 for NaN, and for normals that point away, as interpolated
///          ones may at a silhouette.
inline float facing_ratio(vec3 normal, vec3 toward_eye) {
    return std::max(0.0f, glm::dot(normal, toward_eye));
}

/// The outline by the facing ratio: where it is below `least` (Eq. 7.6). On a sphere that is a ring
/// whose width grows with the sphere (Eq. 7.7); a flat face is ink as a whole, or not at all.
///
/// @param least  0 to 1; 0: no outline.
inline bool is_facing_outline(float ratio, float least) { return ratio < least; }

}  // namespace rasterbook
