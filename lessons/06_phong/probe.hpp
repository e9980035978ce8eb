// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?" for this lesson's pictures: `--probe`.
#pragma once

#include "06_phong/assets.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// Explains pixels of this lesson's picture.
///
/// @param options, assets  Have to outlive the probe.
PixelProbe phong_probe(const PhongOptions& options, const PhongAssets& assets);

}  // namespace rasterbook
