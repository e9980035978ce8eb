// SPDX-License-Identifier: MIT
/// @file
/// "Why this pixel?" for the pictures of this lesson and the next: `--probe`.
#pragma once

#include "09_shadow_maps/assets.hpp"
#include "common/probe/pixel_report.hpp"

namespace rasterbook {

/// Explains pixels of the pictures of this lesson and lesson 10, which are the same.
///
/// @param options, assets  Have to outlive the probe.
PixelProbe shadow_probe(const ShadowSceneOptions& options, const ShadowAssets& assets);

}  // namespace rasterbook
