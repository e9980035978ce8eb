// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?" for this lesson's pictures: `--probe`.
#pragma once

#include "05_textures/textures.hpp"
#include "06_phong/light_options.hpp"
#include "08_normal_maps/assets.hpp"
#include "08_normal_maps/normal_mapping.hpp"
#include "common/app/lesson_app.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// What normal_map_probe() is to know of a lesson's options, wherever they stand.
struct NormalMapProbeOptions {
    const ivec2& size;
    const Orbit& orbit;
    const TextureOptions& texture;
    const LightOptions& shading;
    const NormalMapVariant& normal_map;
};

/// Explains pixels of this lesson's picture.
///
/// @param options, assets  What they refer to has to outlive the probe.
PixelProbe normal_map_probe(const NormalMapProbeOptions& options, const NormalMapAssets& assets);

/// Explains pixels by all options of a lesson.
template <typename Options>
PixelProbe normal_map_probe(const Options& options, const NormalMapAssets& assets) {
    return normal_map_probe(NormalMapProbeOptions{options.size, options.orbit, options.texture,
                                                  options.shading, options.normal_map},
                            assets);
}

}  // namespace rasterbook
