// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?": tones and outlines in one pixel, for `--probe`.
#pragma once

#include "07_toon/assets.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// Explains pixels of this lesson's picture.
///
/// @param options, assets  Have to outlive the probe.
PixelProbe toon_probe(const ToonOptions& options, const ToonAssets& assets);

}  // namespace rasterbook
