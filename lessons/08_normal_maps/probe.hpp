// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?" for this lesson's pictures: `--probe`.
#pragma once

#include "08_normal_maps/assets.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// Explains pixels of this lesson's picture.
///
/// @param options, assets  Have to outlive the probe.
PixelProbe normal_map_probe(const NormalMapSceneOptions& options, const NormalMapAssets& assets);

}  // namespace rasterbook
