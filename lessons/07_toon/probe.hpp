// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?": tones and outlines in one pixel, for `--probe`.
#pragma once

#include "07_toon/assets.hpp"
#include "07_toon/toon_variants.hpp"
#include "common/app/lesson_app.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// What toon_probe() is to know of a lesson's options, wherever they stand.
struct ToonProbeOptions {
    const ivec2& size;
    const int& samples_per_side;
    const Orbit& orbit;
    const TextureOptions& texture;
    const ToonVariant& shading;
};

/// Explains pixels of this lesson's picture.
///
/// @param options, assets  What they refer to has to outlive the probe.
PixelProbe toon_probe(const ToonProbeOptions& options, const ToonAssets& assets);

/// Explains pixels by all options of a lesson.
template <typename Options>
PixelProbe toon_probe(const Options& options, const ToonAssets& assets) {
    return toon_probe(ToonProbeOptions{options.size, options.samples_per_side, options.orbit,
                                       options.texture, options.shading},
                      assets);
}

}  // namespace rasterbook
