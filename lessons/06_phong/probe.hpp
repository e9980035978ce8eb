// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?" for this lesson's pictures: `--probe`.
#pragma once

#include "05_textures/textures.hpp"
#include "06_phong/assets.hpp"
#include "06_phong/shading_variants.hpp"
#include "common/app/lesson_app.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// What phong_probe() is to know of a lesson's options, wherever they stand.
struct PhongProbeOptions {
    const ivec2& size;
    const Orbit& orbit;
    const TextureOptions& texture;
    const ShadingVariant& shading;
};

/// Explains pixels of this lesson's picture.
///
/// @param options, assets  What they refer to has to outlive the probe.
PixelProbe phong_probe(const PhongProbeOptions& options, const PhongAssets& assets);

/// Explains pixels by all options of a lesson.
template <typename Options>
PixelProbe phong_probe(const Options& options, const PhongAssets& assets) {
    return phong_probe(
        PhongProbeOptions{options.size, options.orbit, options.texture, options.shading}, assets);
}

}  // namespace rasterbook
