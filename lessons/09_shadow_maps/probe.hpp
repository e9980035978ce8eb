// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?" for the pictures of this lesson and the next: `--probe`.
#pragma once

#include "05_textures/textures.hpp"
#include "06_phong/light_options.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "09_shadow_maps/assets.hpp"
#include "09_shadow_maps/shadows.hpp"
#include "common/app/lesson_app.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// What shadow_probe() is to know of a lesson's options, wherever they stand.
struct ShadowProbeOptions {
    const ivec2& size;
    const Orbit& orbit;
    const TextureOptions& texture;
    const LightOptions& shading;
    const NormalMapOptions& normal_map;
    const ShadowVariant& shadow;
};

/// Explains pixels of the pictures of this lesson and lesson 10, which are the same.
///
/// @param options, assets  What they refer to has to outlive the probe.
PixelProbe shadow_probe(const ShadowProbeOptions& options, const ShadowAssets& assets);

/// Explains pixels by all options of a lesson.
template <typename Options>
PixelProbe shadow_probe(const Options& options, const ShadowAssets& assets) {
    return shadow_probe(ShadowProbeOptions{options.size, options.orbit, options.texture,
                                           options.shading, options.normal_map, options.shadow},
                        assets);
}

}  // namespace rasterbook
